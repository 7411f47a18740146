//! Which rows or points are meant: a value, a list of values or a range for each of some columns or axes.
//!
//! Knows the forms and when a cell is meant. Does not know which columns or axes there are.

use super::cell::Cell;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::de::{Error as DeError, MapAccess, Unexpected, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::{Map, Value, json};
use std::borrow::Cow;
use std::fmt;
use std::marker::PhantomData;

/// Columns with what they may hold, in the order of the file.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Filter(pub Vec<(String, Allowed)>);

/// What a cell may hold.
#[derive(Debug, Clone, PartialEq)]
pub enum Allowed {
    /// One of these: numbers, words, yes and no, or nothing.
    OneOf(Vec<Cell<'static>>),
    /// A number from the first to the second, both included; no bound where absent.
    Range(Option<f64>, Option<f64>),
}

/// A number of a file means those of a table that are closer to it than this share of them: a table holds numbers that were
/// computed, as the place of a position is, whose last digits nobody writes.
const MEANT: f64 = 1e-9;

impl Allowed {
    /// One value.
    pub fn one(value: &Cell<'_>) -> Self {
        Self::OneOf(vec![value.owned()])
    }

    /// Whether a cell of a table is meant, whose number may differ from a written one in its last digits.
    pub fn allows(&self, cell: &Cell<'_>) -> bool {
        self.allows_where(cell, |a, b| (a - b).abs() <= MEANT * a.abs().max(b.abs()))
    }

    /// Whether the value of an axis is meant: numbers are equal where their jobs are one.
    pub fn allows_exactly(&self, cell: &Cell<'_>) -> bool {
        self.allows_where(cell, |a, b| a == b)
    }

    fn allows_where(&self, cell: &Cell<'_>, same: fn(f64, f64) -> bool) -> bool {
        match (self, cell.number()) {
            (Self::OneOf(values), Some(x)) => values.iter().filter_map(Cell::number).any(|v| same(v, x)),
            (Self::OneOf(values), None) => values.contains(cell),
            (Self::Range(from, to), Some(x)) => {
                from.is_none_or(|from| x >= from || same(from, x)) && to.is_none_or(|to| x <= to || same(to, x))
            }
            (Self::Range(..), None) => false,
        }
    }

    /// The one value, where it is one.
    pub fn single(&self) -> Option<&Cell<'static>> {
        match self {
            Self::OneOf(values) => match values.as_slice() {
                [single] => Some(single),
                _ => None,
            },
            Self::Range(..) => None,
        }
    }

    /// The words among the values.
    pub fn words(&self) -> impl Iterator<Item = &str> {
        let values: &[Cell<'static>] = match self {
            Self::OneOf(values) => values,
            Self::Range(..) => &[],
        };
        values.iter().filter_map(Cell::word)
    }

    /// What a file writes.
    ///
    /// # Errors
    /// [`NoFilter`] where it is no filter.
    pub fn read(written: &Value) -> Result<Self, NoFilter> {
        let no_form = |found: &str| Err(NoFilter::new(found, FORMS));
        match written {
            Value::Array(list) if list.is_empty() => no_form("an empty list"),
            Value::Array(list) if list.iter().any(|v| v.is_array() || v.is_object()) => no_form("a list in a list"),
            Value::Array(list) => Ok(Self::OneOf(list.iter().map(Cell::from).collect())),
            Value::Object(map) => {
                if let Some(key) = map.keys().find(|key| !ENDS.contains(&key.as_str())) {
                    return Err(NoFilter::UnknownKey(key.clone(), &ENDS));
                }
                let end = |key: &str| match map.get(key) {
                    None => Ok(None),
                    Some(value) => value
                        .as_f64()
                        .map(Some)
                        .ok_or_else(|| NoFilter::new(format!("{value} as {key}"), "a number")),
                };
                match (end("from")?, end("to")?) {
                    (None, None) => no_form("an empty object"),
                    (Some(from), Some(to)) if from > to => {
                        Err(NoFilter::new(format!("a range from {from} to {to}"), "from at most to"))
                    }
                    (from, to) => Ok(Self::Range(from, to)),
                }
            }
            single => Ok(Self::OneOf(vec![single.into()])),
        }
    }

    /// As a file writes it.
    pub fn written(&self) -> Value {
        match self {
            Self::OneOf(values) => match values.as_slice() {
                [single] => single.value(),
                several => several.iter().map(Cell::value).collect(),
            },
            Self::Range(from, to) => {
                let ends = [("from", from), ("to", to)];
                let given = ends
                    .iter()
                    .filter_map(|(key, end)| end.map(|end| ((*key).to_owned(), json!(end))));
                given.collect::<Map<_, _>>().into()
            }
        }
    }
}

/// The forms of a filter.
const FORMS: &str = "a value, a list of values or {\"from\": .., \"to\": ..}";

/// The keys of a range.
const ENDS: [&str; 2] = ["from", "to"];

/// What is no filter.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum NoFilter {
    /// A key that a range does not have, and those that it may have.
    UnknownKey(String, &'static [&'static str]),
    /// Anything else: what was found and what is allowed.
    NotAllowed {
        /// What was found, in words.
        found: String,
        /// What is allowed.
        allowed: String,
    },
}

impl NoFilter {
    pub(crate) fn new(found: impl Into<String>, allowed: impl Into<String>) -> Self {
        Self::NotAllowed {
            found: found.into(),
            allowed: allowed.into(),
        }
    }

    /// The reason as an error of a reader.
    pub(crate) fn of_reader<E: DeError>(self) -> E {
        match self {
            Self::UnknownKey(key, known) => E::unknown_field(&key, known),
            Self::NotAllowed { found, allowed } => E::invalid_value(Unexpected::Other(&found), &allowed.as_str()),
        }
    }
}

impl Filter {
    /// Whether every row is meant.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// What a column may hold, where it is named.
    pub fn of(&self, column: &str) -> Option<&Allowed> {
        self.0
            .iter()
            .find(|(name, _)| name == column)
            .map(|(_, allowed)| allowed)
    }

    /// This filter, and of columns that it does not name what `outer` says of them.
    #[must_use]
    pub fn within(&self, outer: &Self) -> Self {
        let more = outer.0.iter().filter(|(name, _)| self.of(name).is_none());
        Self(self.0.iter().chain(more).cloned().collect())
    }

    /// The filter with a column fixed to one value.
    #[must_use]
    pub fn fixed(&self, column: &str, value: &Cell<'_>) -> Self {
        let others = self.0.iter().filter(|(name, _)| name != column).cloned();
        Self(others.chain([(column.to_owned(), Allowed::one(value))]).collect())
    }
}

impl Serialize for Filter {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let map: Map<String, Value> = self.0.iter().map(|(name, a)| (name.clone(), a.written())).collect();
        map.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Filter {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        entries(deserializer).map(Self)
    }
}

/// The entries of an object in the order of the file, read one by one, so that a mistake is told with the path of its
/// entry.
pub fn entries<'de, D: Deserializer<'de>, T: Deserialize<'de>>(deserializer: D) -> Result<Vec<(String, T)>, D::Error> {
    deserializer.deserialize_map(EntriesVisitor(PhantomData))
}

struct EntriesVisitor<T>(PhantomData<T>);

impl<'de, T: Deserialize<'de>> Visitor<'de> for EntriesVisitor<T> {
    type Value = Vec<(String, T)>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an object of names and what is allowed for each")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
        let mut read = Vec::new();
        while let Some(entry) = map.next_entry()? {
            read.push(entry);
        }
        Ok(read)
    }
}

impl<'de> Deserialize<'de> for Allowed {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Self::read(&Value::deserialize(deserializer)?).map_err(NoFilter::of_reader)
    }
}

impl JsonSchema for Filter {
    fn schema_name() -> Cow<'static, str> {
        "Filter".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let single = json!({ "type": ["number", "string", "boolean", "null"] });
        let ends = json!({ "from": { "type": "number" }, "to": { "type": "number" } });
        let schema = json!({
            "type": "object",
            "description": "For each of some columns a value, a list of values or a range, both ends included.",
            "additionalProperties": { "anyOf": [
                single,
                { "type": "array", "minItems": 1, "items": single },
                { "type": "object", "additionalProperties": false, "minProperties": 1, "properties": ends },
            ] }
        });
        Schema::try_from(schema).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn filter(value: Value) -> Filter {
        serde_json::from_value(value).unwrap()
    }

    #[test]
    fn values_lists_ranges_and_nothing_are_told_apart() {
        let f = filter(json!({"a": 0.1, "b": ["x", null], "c": {"from": 2}, "d": true}));
        let allows = |column: &str, cell: Value| f.of(column).unwrap().allows(&Cell::from(&cell));
        assert!(allows("a", json!(0.1 + 1e-12)) && !allows("a", json!(0.1001)) && !allows("a", json!(null)));
        assert!(allows("b", json!("x")) && allows("b", json!(null)) && !allows("b", json!("y")));
        assert!(allows("c", json!(2)) && !allows("c", json!(1.999)) && !allows("c", json!(null)));
        assert!(allows("d", json!(true)) && !allows("d", json!(false)));
    }

    #[test]
    fn an_inner_filter_has_the_last_word() {
        let (inner, outer) = (filter(json!({"a": 1})), filter(json!({"a": 2, "b": 3})));
        assert_eq!(inner.within(&outer), filter(json!({"a": 1, "b": 3})));
        assert_eq!(outer.fixed("a", &Cell::Whole(5)), filter(json!({"b": 3, "a": 5})));
    }

    #[test]
    fn what_is_no_filter_is_refused_and_what_is_one_is_written_as_it_was_read() {
        for bad in [
            json!({"a": []}),
            json!({"a": [[1]]}),
            json!({"a": {}}),
            json!({"a": {"over": 1}}),
            json!({"a": {"to": "x"}}),
            json!({"a": {"from": 2, "to": 1}}),
            json!([1]),
            json!("a"),
        ] {
            assert!(serde_json::from_value::<Filter>(bad.clone()).is_err(), "{bad}");
        }
        let written = json!({"a": 1, "b": [1, 2], "c": {"from": 0.0, "to": 1.0}, "d": null});
        assert_eq!(serde_json::to_value(filter(written.clone())).unwrap(), written);
    }
}
