//! From a document to a type, with errors that say which place is wrong, what kind of fault it is and what is allowed there.
//!
//! Knows where a document stands in its file. Does not know the types of files. `serde_json` tells a wrong type in words alone:
//! `reader` goes through a canonical text and keeps what is wrong as values.

use super::document::Document;
use super::reader::CanonicalReader;
use super::refusal::Refusal;
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value;
use std::path::Path;

/// Reads a document as a type; `prefix` is where the document stands in `file`. A whole number may be written `3.0`.
///
/// # Errors
/// [`Refusal`] with the path in the file.
pub fn typed<T: DeserializeOwned>(file: &Path, prefix: &str, document: &Document) -> Result<T, Refusal> {
    T::deserialize(&mut CanonicalReader::new(document.text())).map_err(|trouble| trouble.refusal(file, prefix))
}

/// Reads a tree of values as a type.
///
/// # Errors
/// As above.
pub fn typed_value<T: DeserializeOwned>(file: &Path, prefix: &str, value: &Value) -> Result<T, Refusal> {
    typed(file, prefix, &Document::from(value))
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
        typed_value::<BridgeDesign>(Path::new("b.json"), "", value).unwrap_err()
    }

    #[test]
    fn the_base_is_accepted() {
        assert!(typed_value::<BridgeDesign>(Path::new("b.json"), "", &bridge()).is_ok());
    }

    #[test]
    fn a_list_does_not_stand_for_an_object() {
        let mut value = bridge();
        value["module"]["material"] = json!([2e11, 0.3, 7850]);
        let e = refused(&value);
        assert_eq!(
            (e.path.as_str(), e.allowed.as_str()),
            ("module.material", "an object"),
            "{e}"
        );
        assert_eq!(refused(&json!([1])).allowed, "an object");
    }

    #[test]
    fn a_whole_number_may_be_written_with_a_point() {
        let mut value = bridge();
        value["modules"] = json!(3.0);
        assert_eq!(
            typed_value::<BridgeDesign>(Path::new("b.json"), "", &value)
                .unwrap()
                .modules,
            3
        );
    }

    #[test]
    fn an_unknown_key_at_depth_names_its_path_and_the_nearest() {
        let mut value = bridge();
        value["module"]["material"]["youngs_modulus"] = json!(2e11);
        let e = refused(&value);
        assert_eq!(e.path, "module.material.youngs_modulus", "{e}");
        assert_eq!(e.nearest.as_deref(), Some("youngs_modulus_pa"), "{e}");
    }

    #[test]
    fn a_missing_key_a_wrong_type_and_a_wrong_word_name_their_paths() {
        let mut value = bridge();
        value["module"].as_object_mut().unwrap().remove("depth_m");
        assert_eq!(refused(&value).path, "module.depth_m");

        let mut value = bridge();
        value["hinges"]["y_m"] = json!([0, "left"]);
        let e = refused(&value);
        assert_eq!(
            (e.path.as_str(), e.allowed.as_str()),
            ("hinges.y_m[1]", "a number"),
            "{e}"
        );

        for (found, word) in [
            (json!(-3), "-3"),
            (json!(3.5), "3.5"),
            (json!("three"), "\"three\""),
            (json!({}), "an object"),
            (json!(null), "null"),
            (json!(true), "true"),
        ] {
            let mut value = bridge();
            value["modules"] = found;
            let e = refused(&value);
            assert_eq!(
                (e.path.as_str(), e.found.text().as_str(), e.allowed.as_str()),
                ("modules", word, "a whole number of at least 0, or a list of modules"),
                "{e}"
            );
        }

        let mut value = bridge();
        value["water_distribution"] = json!("lumpd");
        let e = refused(&value);
        assert_eq!(
            (e.path.as_str(), e.nearest.as_deref()),
            ("water_distribution", Some("lumped")),
            "{e}"
        );
    }
}
