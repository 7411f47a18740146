//! The JSON Schema of what a person writes.
//!
//! Knows which type stands for which file. Does not know more than those types: cross-checks (a track on the deck, a
//! time step within a module's passage) are not expressible there.

use crate::calibrate::ParametersSpec;
use crate::reference::ReferenceSpec;
use crate::spec::StudySpec;
use pontoon_core::bridge::BridgeDesign;
use serde_json::Value;

/// The schema of a study file.
pub fn study() -> Value {
    titled(schemars::schema_for!(StudySpec), "pontoon study")
}

/// The schema of a bridge file.
pub fn bridge() -> Value {
    titled(schemars::schema_for!(BridgeDesign), "pontoon bridge")
}

/// The schema of a file of parameters.
pub fn parameters() -> Value {
    titled(schemars::schema_for!(ParametersSpec), "pontoon parameters")
}

/// The schema of a reference file.
pub fn reference() -> Value {
    titled(schemars::schema_for!(ReferenceSpec), "pontoon reference")
}

fn titled(mut schema: schemars::Schema, title: &str) -> Value {
    schema.insert("title".to_owned(), title.into());
    schema.to_value()
}
