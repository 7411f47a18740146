//! The JSON Schema of files that results are judged by.
//!
//! Knows which type stands for which file. Does not know more than those types: cross-checks between checks and studies
//! are not expressible there.

use crate::calibrate::ParametersSpec;
use crate::reference::ReferenceSpec;
use pontoon_plan::schema::titled;
use serde_json::Value;

/// The schema of a file of parameters.
pub fn parameters() -> Value {
    titled(schemars::schema_for!(ParametersSpec), "pontoon parameters")
}

/// The schema of a reference file.
pub fn reference() -> Value {
    titled(schemars::schema_for!(ReferenceSpec), "pontoon reference")
}
