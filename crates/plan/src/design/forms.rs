//! The `design` of a study as it is written.
//!
//! Knows its forms and their schema. Does not know what an axis may be called or what it expands to.

use super::axes::{AxisValues, NAMED_AXES};
use super::cases::Cases;
use super::condition::Conditions;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::Deserialize;
use serde_json::{Map, Value, json};
use std::borrow::Cow;

/// One design: exactly one of `grid`, `zip`, `cases`, `latin_hypercube`, `sobol`, `saltelli` and `morris` says which points it
/// has. The designs of a study are united in the order of the file.
#[derive(Debug, Clone, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("oneOf" = Form::NAMES.map(|name| json!({ "required": [name] }))))]
pub struct Design {
    /// Every combination of the axes' values; the first axis changes slowest.
    #[serde(default)]
    #[schemars(with = "AxisMap")]
    pub grid: Option<AxisMap>,
    /// The axes' first values, then their second ones, and so on: all axes have equally many, or one that stands for all.
    #[serde(default)]
    #[schemars(with = "AxisMap")]
    pub zip: Option<AxisMap>,
    /// Single points, each axis with one value.
    #[serde(default)]
    #[schemars(with = "Vec<CaseForm>")]
    pub cases: Option<Cases>,
    /// Points drawn at random, one in each of `count` equal parts of each range.
    #[serde(default)]
    #[schemars(with = "SampleSpec")]
    pub latin_hypercube: Option<SampleSpec>,
    /// Points of the scrambled Sobol' sequence, which fills the ranges evenly at every length: a longer design of the same
    /// seed begins with the points of a shorter one. Best at a power of two.
    #[serde(default)]
    #[schemars(with = "SampleSpec")]
    pub sobol: Option<SampleSpec>,
    /// Points from which `pontoon indices` computes Sobol' indices: two samples A and B of `count` rows, and of each row the
    /// points that have one factor of the other sample.
    #[serde(default)]
    #[schemars(with = "SaltelliSpec")]
    pub saltelli: Option<SaltelliSpec>,
    /// Points from which `pontoon indices` computes elementary effects: trajectories of Morris.
    #[serde(default)]
    #[schemars(with = "MorrisSpec")]
    pub morris: Option<MorrisSpec>,
    /// What a point must meet to become a job.
    #[serde(default, rename = "where")]
    pub conditions: Conditions,
}

/// The one form of a design.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Form<'a> {
    /// Every combination.
    Grid(&'a AxisMap),
    /// Value by value.
    Zip(&'a AxisMap),
    /// Point by point.
    Cases(&'a Cases),
    /// Drawn at random, one in each part of each range.
    LatinHypercube(&'a SampleSpec),
    /// Points of a sequence.
    Sobol(&'a SampleSpec),
    /// Two samples and what is made of their rows.
    Saltelli(&'a SaltelliSpec),
    /// Trajectories.
    Morris(&'a MorrisSpec),
}

impl Form<'_> {
    /// The keys of the forms.
    pub const NAMES: [&'static str; 7] = ["grid", "zip", "cases", "latin_hypercube", "sobol", "saltelli", "morris"];
}

impl Design {
    /// The seed of its form, where it draws.
    pub fn seed(&self) -> Option<u64> {
        match self.form().ok()? {
            Form::Grid(_) | Form::Zip(_) | Form::Cases(_) => None,
            Form::LatinHypercube(spec) | Form::Sobol(spec) => Some(spec.seed),
            Form::Saltelli(spec) => Some(spec.seed),
            Form::Morris(spec) => Some(spec.seed),
        }
    }

    /// The form.
    ///
    /// # Errors
    /// The keys that were found where there is not exactly one.
    pub fn form(&self) -> Result<Form<'_>, Vec<&'static str>> {
        let forms = [
            self.grid.as_ref().map(Form::Grid),
            self.zip.as_ref().map(Form::Zip),
            self.cases.as_ref().map(Form::Cases),
            self.latin_hypercube.as_ref().map(Form::LatinHypercube),
            self.sobol.as_ref().map(Form::Sobol),
            self.saltelli.as_ref().map(Form::Saltelli),
            self.morris.as_ref().map(Form::Morris),
        ];
        let found: Vec<(&str, Form<'_>)> = Form::NAMES
            .into_iter()
            .zip(forms)
            .filter_map(|(name, form)| Some((name, form?)))
            .collect();
        match found.as_slice() {
            [(_, form)] => Ok(*form),
            several => Err(several.iter().map(|(name, _)| *name).collect()),
        }
    }
}

/// Axes by name, in the order of the file.
#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
#[serde(transparent)]
pub struct AxisMap(pub Map<String, Value>);

/// Points drawn from ranges.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SampleSpec {
    /// Number of points.
    #[schemars(range(min = 1, max = 10_000_000))]
    pub count: usize,
    /// Equal seeds give equal points, another one others.
    pub seed: u64,
    /// The axes with their ranges.
    pub ranges: RangeMap,
}

/// Points for Sobol' indices.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SaltelliSpec {
    /// Number of rows of the base sample, best a power of two. Of k drawn axes each row makes k + 2 points, with `second_order`
    /// 2 k + 2.
    #[schemars(range(min = 2, max = 10_000_000))]
    pub count: usize,
    /// Equal seeds give equal points, another one others.
    pub seed: u64,
    /// The axes with their ranges, at most 50 of them drawn.
    pub ranges: RangeMap,
    /// Whether there are points for indices of pairs; none where absent.
    #[serde(default)]
    pub second_order: bool,
}

/// Points for elementary effects.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MorrisSpec {
    /// Number of trajectories. Of k drawn axes each has k + 1 points.
    #[schemars(range(min = 2, max = 10_000_000))]
    pub trajectories: usize,
    /// Number of levels that each range is divided into, ends included: an even number; 4 where absent.
    #[serde(default = "default_levels")]
    #[schemars(range(min = 2, max = 1000), extend("multipleOf" = 2))]
    pub levels: usize,
    /// Equal seeds give equal points, another one others.
    pub seed: u64,
    /// The axes with their ranges.
    pub ranges: RangeMap,
}

fn default_levels() -> usize {
    4
}

/// Ranges and constants by the name of their axis, in the order of the file.
#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
#[serde(transparent)]
pub struct RangeMap(pub Map<String, Value>);

/// Pattern of the axes that are named by their path.
const PATH_PATTERN: &str =
    r"^(bridge|vehicle|analysis|wear|traffic|column|roughness)(\.[a-z0-9_]+|\[[0-9]+(\.\.[0-9]+)?\])+$";

/// The schema of an object of axes, where `number` and `word` make the schemas of one axis of numbers and of words.
fn object_of(text: &str, number: &Value, word: &dyn Fn(Value) -> Value, any: &Value) -> Schema {
    let property = |values: AxisValues| match values {
        AxisValues::Numbers | AxisValues::Counts => number.clone(),
        AxisValues::Words(words) => word(json!({ "enum": words })),
        AxisValues::Names => word(json!({ "type": "string" })),
    };
    let named = NAMED_AXES.iter();
    let properties: Map<String, Value> = named
        .map(|axis| (axis.name.to_owned(), property(axis.values)))
        .collect();
    let schema = json!({
        "type": "object",
        "description": text,
        "properties": properties,
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
        object_of(
            "Axes by name, each a list of values, one value or a spaced range.",
            &with(forms(json!({ "type": "number" })), json!({ "type": "number" })),
            &|words| json!({ "anyOf": [words, { "type": "array", "items": words, "minItems": 1 }] }),
            &with(forms(json!(true)), json!({ "type": ["number", "string", "boolean"] })),
        )
    }
}

impl JsonSchema for RangeMap {
    fn schema_name() -> Cow<'static, str> {
        "Ranges".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let or = |constant: Value| {
            let ends = json!({
                "type": "array", "description": "[from, to], from below to",
                "items": { "type": "number" }, "minItems": 2, "maxItems": 2
            });
            let whole = json!({
                "type": "object", "description": "A whole number from one to another, both included, each as likely.",
                "required": ["whole"], "additionalProperties": false,
                "properties": { "whole": { "type": "array", "items": { "type": "integer" }, "minItems": 2, "maxItems": 2 } }
            });
            let values = json!({
                "type": "object", "description": "One of these values, each as likely.",
                "required": ["values"], "additionalProperties": false,
                "properties": { "values": { "type": "array", "minItems": 1 } }
            });
            json!({ "anyOf": [ends, whole, values, constant] })
        };
        object_of(
            "Axes by name, each a range [from, to], whole numbers, a list of values, or one value that all points have; at least one is drawn.",
            &or(json!({ "type": "number" })),
            &|words| {
                let values = json!({ "type": "array", "items": words, "minItems": 1 });
                let drawn = json!({ "type": "object", "required": ["values"], "additionalProperties": false,
                                    "properties": { "values": values } });
                json!({ "anyOf": [words, drawn] })
            },
            &or(json!({ "type": ["number", "string", "boolean"] })),
        )
    }
}

/// One point, written axis by axis.
struct CaseForm;

impl JsonSchema for CaseForm {
    fn schema_name() -> Cow<'static, str> {
        "Case".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        object_of(
            "One point: a value for each axis.",
            &json!({ "type": "number" }),
            &|words| words,
            &json!(true),
        )
    }
}
