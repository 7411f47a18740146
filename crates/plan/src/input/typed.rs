//! From a JSON value to a type, with errors that a person can act on.
//!
//! Knows how serde words its errors and turns them into key path, found, allowed and the nearest known name. Does not
//! know the types.

use super::canonical;
use crate::input::Refusal;
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value;
use std::path::Path;

/// Reads a value as a type; `prefix` is where the value stands in `file`. A whole number may be written `3.0`.
///
/// # Errors
/// [`Refusal`] with the key's path in the file.
pub fn typed<T: DeserializeOwned + Serialize>(file: &Path, prefix: &str, value: &Value) -> Result<T, Refusal> {
    let read: T = serde_path_to_error::deserialize(canonical(value)).map_err(|error| {
        let path = error.path().to_string();
        let key = join(prefix, if path == "." { "" } else { &path });
        translate(file, key, &error.inner().to_string())
    })?;
    let back = serde_json::to_value(&read).unwrap_or_default();
    match list_for_object(prefix, value, &back) {
        Some(key) => Err(Refusal::new(file, key, "a list", "an object")),
        None => Ok(read),
    }
}

/// Where a list stands for an object: serde would take its entries for the object's values in their order.
fn list_for_object(at: &str, written: &Value, read: &Value) -> Option<String> {
    match (written, read) {
        (Value::Array(_), Value::Object(_)) => Some(at.to_owned()),
        (Value::Array(written), Value::Array(read)) => (0..)
            .zip(written.iter().zip(read))
            .find_map(|(i, (w, r))| list_for_object(&join(at, &format!("[{i}]")), w, r)),
        (Value::Object(written), Value::Object(read)) => written
            .iter()
            .find_map(|(key, w)| list_for_object(&join(at, key), w, read.get(key)?)),
        _ => None,
    }
}

/// Two key paths one after the other.
pub(super) fn join(prefix: &str, path: &str) -> String {
    match (prefix.is_empty(), path.is_empty()) {
        (true, _) => path.to_owned(),
        (_, true) => prefix.to_owned(),
        _ if path.starts_with('[') => format!("{prefix}{path}"),
        _ => format!("{prefix}.{path}"),
    }
}

fn translate(file: &Path, key: String, message: &str) -> Refusal {
    let quoted: Vec<String> = message.split('`').skip(1).step_by(2).map(str::to_owned).collect();
    let under = |name: &str| {
        if key == name || key.ends_with(&format!(".{name}")) {
            key.clone()
        } else {
            join(&key, name)
        }
    };
    match (message, quoted.split_first()) {
        (m, Some((name, known))) if m.starts_with("unknown field") => Refusal {
            found: format!("unknown key '{name}'"),
            ..Refusal::unknown(file, under(name), name, known)
        },
        (m, Some((name, known))) if m.starts_with("unknown variant") => Refusal {
            found: format!("'{name}'"),
            ..Refusal::unknown(file, key, name, known)
        },
        (m, Some((name, _))) if m.starts_with("missing field") => {
            Refusal::new(file, under(name), "nothing", "a value: this key is required")
        }
        // a type's own words
        (m, _) if let Some((found, allowed)) = own_words(m) => Refusal::new(file, key, found, allowed),
        (m, _) => match m.split_once(", expected ") {
            Some((found, expected)) => Refusal::new(file, key, plain_found(found), plain(expected)),
            None => Refusal::new(file, key, m, "a document after `pontoon schema`"),
        },
    }
}

/// What was found and what is allowed, where a type says it itself.
fn own_words(message: &str) -> Option<(&str, &str)> {
    message.strip_prefix("found ")?.split_once(", allowed: ")
}

/// What serde found, in the words of JSON.
fn plain_found(found: &str) -> String {
    let value = found
        .split_once(": ")
        .map_or(found, |(_, value)| value)
        .replace('`', "");
    match value.split_once(' ') {
        Some(("string" | "integer" | "boolean", text)) => text.to_owned(),
        Some(("floating", text)) => text.trim_start_matches("point ").to_owned(),
        Some(("invalid", text)) => text.replace("length", "a list of length"),
        _ => match value.as_str() {
            "map" => "an object".to_owned(),
            "sequence" => "a list".to_owned(),
            _ => value,
        },
    }
}

/// serde's word for a type in plain words.
fn plain(expected: &str) -> String {
    match expected {
        "f64" => "a number".to_owned(),
        "usize" | "u64" => "a whole number of at least 0".to_owned(),
        "a boolean" => "true or false".to_owned(),
        "a sequence" => "a list".to_owned(),
        "a map" => "an object".to_owned(),
        "string or map" => "a word or an object".to_owned(),
        "fewer elements in array" => "fewer".to_owned(),
        "map with a single key" => "an object with a single key".to_owned(),
        other if other.starts_with("struct ") => "an object".to_owned(),
        other if other.starts_with("an array of") => other.replace("an array", "a list"),
        other => other.to_owned(),
    }
}

/// A value of a type that always is one.
pub fn to_value<T: Serialize>(value: &T) -> Value {
    serde_json::to_value(value).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use pontoon_core::bridge::BridgeDesign;
    use serde_json::json;

    fn bridge() -> Value {
        json!({
            "name": "b", "modules": 3,
            "module": {
                "length_m": 6.7, "breadth_m": 8.0, "depth_m": 1.0, "deck_thickness_m": 0.003,
                "bottom_thickness_m": 0.003, "side_thickness_m": 0.003, "end_thickness_m": 0.003,
                "material": { "youngs_modulus_pa": 2e11, "poissons_ratio": 0.3, "density_kg_m3": 7850 },
                "mesh": { "elements_along": 4, "elements_over_depth": 1 }
            },
            "hydrostatic_stiffness_pa_m": 7486, "added_mass_kg_m": 11135,
            "hinges": { "y_m": [0] },
            "connectors": { "y_m": [0], "stiffness_n_m": 1e7, "gap_tension_m": 0, "gap_compression_m": 0 }
        })
    }

    fn refused(value: &Value) -> Refusal {
        typed::<BridgeDesign>(Path::new("b.json"), "", value).unwrap_err()
    }

    #[test]
    fn the_base_is_accepted() {
        assert!(typed::<BridgeDesign>(Path::new("b.json"), "", &bridge()).is_ok());
    }

    #[test]
    fn a_list_does_not_stand_for_an_object() {
        let mut value = bridge();
        value["module"]["material"] = json!([2e11, 0.3, 7850]);
        let e = refused(&value);
        assert_eq!(
            (e.key.as_str(), e.allowed.as_str()),
            ("module.material", "an object"),
            "{e}"
        );
        assert_eq!(refused(&json!([1])).key, "[0]");
    }

    #[test]
    fn a_whole_number_may_be_written_with_a_point() {
        let mut value = bridge();
        value["modules"] = json!(3.0);
        assert_eq!(
            typed::<BridgeDesign>(Path::new("b.json"), "", &value).unwrap().modules,
            3
        );
    }

    #[test]
    fn an_unknown_key_at_depth_names_its_path_and_the_nearest() {
        let mut value = bridge();
        value["module"]["material"]["youngs_modulus"] = json!(2e11);
        let e = refused(&value);
        assert_eq!(e.key, "module.material.youngs_modulus", "{e}");
        assert_eq!(e.nearest.as_deref(), Some("youngs_modulus_pa"), "{e}");
    }

    #[test]
    fn a_missing_key_a_wrong_type_and_a_wrong_word_name_their_paths() {
        let mut value = bridge();
        value["module"].as_object_mut().unwrap().remove("depth_m");
        assert_eq!(refused(&value).key, "module.depth_m");

        let mut value = bridge();
        value["hinges"]["y_m"] = json!([0, "left"]);
        let e = refused(&value);
        assert_eq!(
            (e.key.as_str(), e.allowed.as_str()),
            ("hinges.y_m[1]", "a number"),
            "{e}"
        );

        for (found, word) in [
            (json!(-3), "-3"),
            (json!(3.5), "3.5"),
            (json!("three"), "\"three\""),
            (json!([3]), "a list"),
            (json!({}), "an object"),
            (json!(null), "null"),
            (json!(true), "true"),
        ] {
            let mut value = bridge();
            value["modules"] = found;
            let e = refused(&value);
            assert_eq!(
                (e.key.as_str(), e.found.as_str(), e.allowed.as_str()),
                ("modules", word, "a whole number of at least 0"),
                "{e}"
            );
        }

        let mut value = bridge();
        value["water_distribution"] = json!("lumpd");
        let e = refused(&value);
        assert_eq!(
            (e.key.as_str(), e.nearest.as_deref()),
            ("water_distribution", Some("lumped")),
            "{e}"
        );
    }
}
