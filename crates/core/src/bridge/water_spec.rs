//! The water with memory under a bridge, as its file names it.
//!
//! Knows the name of a water file, what of it is accepted, and the water once it is read. Does not know files.

use crate::radiation::Radiation;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Water with memory: added mass and damping of radiated waves over the frequency, in place of a constant added mass.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WaterSpec {
    /// The water file, relative to the bridge file; `pontoon water` makes it of what a BEM code writes.
    pub file: String,
    /// Names of checks that may refuse the water, and whose figures are accepted.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub accept: Vec<String>,
    /// The blake3 hash of the water file; another file is refused. Absent: any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub blake3: Option<String>,
    /// The water, once the file is read.
    #[serde(skip)]
    pub radiation: Option<Arc<Radiation>>,
}
