//! The JSON Schema of study, bridge and vehicle files.
//!
//! Knows which type stands for which file. Does not know more than those types: cross-checks (a track on the deck, a
//! time step within a module's passage) are not expressible there.

use crate::study_file::StudySpec;
use crate::water_file::WaterFile;
use pontoon_core::bridge::BridgeDesign;
use pontoon_core::vehicle::VehicleDesign;
use serde_json::{Value, json};

/// Of a study file.
pub fn study() -> Value {
    titled(schemars::schema_for!(StudySpec), "pontoon study")
}

/// Of a bridge file.
pub fn bridge() -> Value {
    titled(schemars::schema_for!(BridgeDesign), "pontoon bridge")
}

/// Of a vehicle file.
pub fn vehicle() -> Value {
    titled(schemars::schema_for!(VehicleDesign), "pontoon vehicle")
}

/// The JSON Schema of a water file.
pub fn water() -> Value {
    let mut schema = titled(schemars::schema_for!(WaterFile), "pontoon water");
    if let Some(required) = schema["required"].as_array_mut()
        && !required.iter().any(|key| key == "depth_m")
    {
        required.push("depth_m".into());
    }
    schema
}

/// A schema with its title, which a file may name.
pub fn titled(mut schema: schemars::Schema, title: &str) -> Value {
    schema.insert("title".to_owned(), title.into());
    let mut schema = schema.to_value();
    let text = "Address of this schema, for an editor; nothing is read from it.";
    schema["properties"]["$schema"] = json!({ "type": "string", "description": text });
    schema
}
