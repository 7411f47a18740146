//! The `design` of a study as it is written.
//!
//! Knows its forms and their schema. Does not know what an axis may be called or what it expands to.

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value, json};
use std::borrow::Cow;

/// One design. The designs of a study are united in the order of the file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Design {
    /// Every combination of the axes' values; the first axis changes slowest.
    Grid(AxisMap),
    /// Single points, each axis with one value.
    #[schemars(with = "Vec<Case>")]
    Cases(Vec<Map<String, Value>>),
}

/// Axes by name, in the order of the file.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct AxisMap(pub Map<String, Value>);

/// Pattern of the axes that are named by their path.
const PATH_PATTERN: &str = r"^(bridge|vehicle|analysis)\.[a-z0-9_]+(\.[a-z0-9_]+|\[[0-9]+\])*$";

/// The schema of an object of axes, where `number` and `word` are the schemas of one axis of numbers and of words.
fn object_of(number: &Value, word: &Value, any: &Value) -> Schema {
    let schema = json!({
        "type": "object",
        "properties": {
            "connection": word, "gap_tension_m": number, "gap_compression_m": number, "speed_m_s": number,
            "load_n": number, "load_position": number, "load_x_m": number
        },
        "patternProperties": { PATH_PATTERN: any },
        "additionalProperties": false
    });
    schema.try_into().unwrap_or_default()
}

impl JsonSchema for AxisMap {
    fn schema_name() -> Cow<'static, str> {
        "Axes".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let range = |key: &str, text: &str| {
            let ends = json!([{ "type": "number" }, { "type": "number" }, { "type": "integer", "minimum": 2 }]);
            json!({
                "type": "object", "description": text, "required": [key], "additionalProperties": false,
                "properties": { key: { "type": "array", "prefixItems": ends, "minItems": 3, "maxItems": 3 } }
            })
        };
        let forms = |item: Value| {
            [
                json!({ "type": "array", "items": item, "minItems": 1 }),
                range("linspace", "[from, to, count], evenly spaced, both ends included"),
                range("geomspace", "[from, to, count], in even ratios, both ends included"),
            ]
        };
        let with = |forms: [Value; 3], more: Value| {
            let forms: Vec<Value> = forms.into_iter().chain([more]).collect();
            json!({ "anyOf": forms })
        };
        let words = json!({ "enum": ["linear", "nonlinear"] });
        object_of(
            &with(forms(json!({ "type": "number" })), json!({ "type": "number" })),
            &json!({ "anyOf": [words, { "type": "array", "items": words, "minItems": 1 }] }),
            &with(forms(json!(true)), json!({ "type": ["number", "string", "boolean"] })),
        )
    }
}

/// One point, written axis by axis.
struct Case;

impl JsonSchema for Case {
    fn schema_name() -> Cow<'static, str> {
        "Case".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        object_of(
            &json!({ "type": "number" }),
            &json!({ "enum": ["linear", "nonlinear"] }),
            &json!(true),
        )
    }
}
