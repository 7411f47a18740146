//! The `where` of a design: what a point must meet to become a job.
//!
//! Knows how conditions are written and when the values of a point meet them. Does not know how points are made.

use super::axes::Axis;
use crate::input::filter::{Allowed, NoFilter, entries};
use crate::input::{Cell, Refusal};
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Deserialize, Deserializer};
use serde_json::{Map, Value, json};
use std::borrow::Cow;
use std::path::Path;

/// Conditions by the name of their axis, in the order of the file; a point meets all of them.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Conditions(pub Vec<(String, Condition)>);

/// What the value of an axis must meet: what it may be, and how it stands to the values of other axes.
#[derive(Debug, Clone, PartialEq)]
pub struct Condition {
    /// What it may be; anything where absent.
    pub allowed: Option<Allowed>,
    /// How it stands to the axes of these names.
    pub compared: Vec<(Relation, String)>,
}

/// How a number stands to another one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Relation {
    /// Not less.
    AtLeast,
    /// Not more.
    AtMost,
    /// More.
    Above,
    /// Less.
    Below,
}

impl Relation {
    const ALL: [Self; 4] = [Self::AtLeast, Self::AtMost, Self::Above, Self::Below];

    /// The key that says it.
    pub fn key(self) -> &'static str {
        match self {
            Self::AtLeast => "at_least",
            Self::AtMost => "at_most",
            Self::Above => "above",
            Self::Below => "below",
        }
    }

    /// Whether `a` stands to `b` so. Equal is what is one job.
    pub fn holds(self, a: f64, b: f64) -> bool {
        match self {
            Self::AtLeast => a >= b,
            Self::AtMost => a <= b,
            Self::Above => a > b,
            Self::Below => a < b,
        }
    }
}

impl Condition {
    fn read(written: &Value) -> Result<Self, NoFilter> {
        let Value::Object(map) = written else {
            let allowed = Some(Allowed::read(written)?);
            let compared = Vec::new();
            return Ok(Self { allowed, compared });
        };
        let relation = |key: &str| Relation::ALL.into_iter().find(|relation| relation.key() == key);
        let (mut bounds, mut compared) = (Map::new(), Vec::new());
        for (key, value) in map {
            match (relation(key), value) {
                (Some(relation), Value::String(axis)) => compared.push((relation, axis.clone())),
                (Some(_), value) => {
                    let allowed = "the name of another axis (the keys of numbers are from and to)";
                    return Err(NoFilter::new(format!("{value} as {key}"), allowed));
                }
                (None, value) if key == "from" || key == "to" => {
                    bounds.insert(key.clone(), value.clone());
                }
                (None, _) => return Err(NoFilter::UnknownKey(key.clone(), &KEYS)),
            }
        }
        let allowed = if bounds.is_empty() && !compared.is_empty() {
            None
        } else {
            Some(Allowed::read(&bounds.into())?)
        };
        Ok(Self { allowed, compared })
    }
}

/// The keys of a condition.
const KEYS: [&str; 6] = ["from", "to", "at_least", "at_most", "above", "below"];

impl Conditions {
    /// Whether every point meets them.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Refuses a name that is none of the `axes` of the design; `key` is where the conditions stand.
    pub(super) fn check(&self, file: &Path, key: &str, axes: &[Axis]) -> Result<(), Refusal> {
        let is_axis = |name: &str| axes.iter().any(|axis| axis.sets_what(name));
        let known = || axes.iter().map(|axis| axis.name.clone()).collect::<Vec<_>>();
        for (name, condition) in &self.0 {
            let path = format!("{key}.{name}");
            if !is_axis(name) {
                return Err(Refusal::unknown_key(file, path, name, &known()));
            }
            for (relation, other) in &condition.compared {
                if !is_axis(other) {
                    let path = format!("{path}.{}", relation.key());
                    return Err(Refusal::unknown(file, path, other, &known()));
                }
            }
        }
        Ok(())
    }

    /// The conditions on the points of a block with these axes.
    pub(super) fn on(&self, axes: &[Axis]) -> Vec<Test> {
        let place = |name: &str| axes.iter().position(|axis| axis.sets_what(name));
        let test = |(name, condition): &(String, Condition)| Test {
            axis: place(name),
            allowed: condition.allowed.clone(),
            compared: condition
                .compared
                .iter()
                .map(|(relation, other)| (*relation, place(other)))
                .collect(),
        };
        self.0.iter().map(test).collect()
    }
}

/// A condition with its axes by their places in a block; an axis that the block does not have is null.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Test {
    axis: Option<usize>,
    allowed: Option<Allowed>,
    compared: Vec<(Relation, Option<usize>)>,
}

impl Test {
    /// Whether a point meets the condition, `of_axis` its value of an axis. What is no number stands in no relation.
    pub(super) fn met<'a>(&self, of_axis: impl Fn(usize) -> Cell<'a>) -> bool {
        let value = |axis: Option<usize>| axis.map_or(Cell::Nothing, &of_axis);
        let own = value(self.axis);
        let stands = |&(relation, other): &(Relation, Option<usize>)| matches!((own.number(), value(other).number()), (Some(a), Some(b)) if relation.holds(a, b));
        self.allowed.as_ref().is_none_or(|allowed| allowed.allows_exactly(&own)) && self.compared.iter().all(stands)
    }

    /// The condition in parts that speak of at most two axes each.
    pub(super) fn parts(&self) -> impl Iterator<Item = Self> {
        let own = Self {
            compared: Vec::new(),
            ..self.clone()
        };
        let pairs = self.compared.iter().map(|compared| Self {
            axis: self.axis,
            allowed: None,
            compared: vec![*compared],
        });
        std::iter::once(own).chain(pairs)
    }

    /// The axes that it speaks of, each once.
    pub(super) fn axes(&self) -> Vec<usize> {
        let mut axes: Vec<usize> = self.axis.into_iter().collect();
        for axis in self.compared.iter().filter_map(|(_, other)| *other) {
            if !axes.contains(&axis) {
                axes.push(axis);
            }
        }
        axes
    }
}

impl<'de> Deserialize<'de> for Conditions {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        entries(deserializer).map(Self)
    }
}

impl<'de> Deserialize<'de> for Condition {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Self::read(&Value::deserialize(deserializer)?).map_err(NoFilter::of_reader)
    }
}

impl JsonSchema for Conditions {
    fn schema_name() -> Cow<'static, str> {
        "Conditions".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let single = json!({ "type": ["number", "string", "boolean", "null"] });
        let bound = |text: &str| json!({ "type": "number", "description": text });
        let other = |text: &str| json!({ "type": "string", "description": text });
        let keys = json!({
            "from": bound("It is a number of at least this."),
            "to": bound("It is a number of at most this."),
            "at_least": other("It is not less than the axis of this name."),
            "at_most": other("It is not more than the axis of this name."),
            "above": other("It is more than the axis of this name."),
            "below": other("It is less than the axis of this name."),
        });
        let schema = json!({
            "type": "object",
            "description": "For each of some axes of the design a value, a list of values, or bounds: numbers, both ends \
                            included, and other axes. A point that does not meet all of them is left out; an axis that a \
                            case does not have is null.",
            "additionalProperties": { "anyOf": [
                single,
                { "type": "array", "minItems": 1, "items": single },
                { "type": "object", "additionalProperties": false, "minProperties": 1, "properties": keys },
            ] }
        });
        Schema::try_from(schema).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(value: Value) -> Result<Conditions, serde_json::Error> {
        serde_json::from_value(value)
    }

    #[test]
    fn what_is_no_condition_is_refused_and_what_is_one_is_written_as_it_was_read() {
        for bad in [
            json!({"a": []}),
            json!({"a": {}}),
            json!({"a": {"over": "b"}}),
            json!({"a": {"at_least": 1}}),
            json!({"a": {"above": null}}),
            json!({"a": {"from": "b"}}),
            json!({"a": {"from": 2, "to": 1, "above": "b"}}),
            json!(["a"]),
        ] {
            assert!(read(bad.clone()).is_err(), "{bad}");
        }
        let written = json!({"a": 1, "b": ["x", null], "c": {"from": 0.0, "to": 1.0}, "d": {"at_least": "a"},
                             "e": {"to": 3.0, "above": "a", "below": "b"}});
        let Conditions(conditions) = read(written).unwrap();
        let names: Vec<&str> = conditions.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, ["a", "b", "c", "d", "e"]);
        let [.., (_, compared), (_, both)] = conditions.as_slice() else {
            panic!("{conditions:?}")
        };
        assert_eq!(
            (compared.allowed.is_none(), compared.compared.as_slice()),
            (true, &[(Relation::AtLeast, "a".to_owned())][..])
        );
        assert_eq!(both.allowed, Some(Allowed::Range(None, Some(3.0))));
        assert_eq!(both.compared.len(), 2);
    }

    #[test]
    fn relations_take_for_equal_what_is_one_job() {
        for (relation, less, equal, more) in [
            (Relation::AtLeast, false, true, true),
            (Relation::AtMost, true, true, false),
            (Relation::Above, false, false, true),
            (Relation::Below, true, false, false),
        ] {
            for (a, expected) in [(0.2, less), (0.3, equal), (0.1 + 0.2, more), (0.4, more)] {
                assert_eq!(relation.holds(a, 0.3), expected, "{relation:?} {a}");
            }
        }
        let Conditions(conditions) = read(json!({"a": 0.3, "b": {"to": 0.3}})).unwrap();
        for (_, condition) in conditions {
            let test = Test {
                axis: Some(0),
                allowed: condition.allowed,
                compared: Vec::new(),
            };
            assert!(test.met(|_| Cell::Number(0.3)) && !test.met(|_| Cell::Number(0.1 + 0.2)));
        }
    }
}
