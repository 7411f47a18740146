//! Columns of a table, one after the other.
//!
//! Knows the few column types that tables have. Does not know what a column means.

use super::frame::Frame;
use polars_arrow::array::{Array, BooleanArray, PrimitiveArray, Utf8ViewArray};
use pontoon_plan::input::canonical_text;
use serde_json::Value;
use std::io;

/// The type of an axis's column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum AxisType {
    /// Whole numbers.
    Counts,
    /// Numbers.
    Numbers,
    /// Words.
    Words,
    /// Yes and no.
    Flags,
    /// JSON texts of whatever the values are.
    Texts,
}

impl AxisType {
    /// The type of an axis of these values: whole numbers where all its values are of such a type, numbers where all are
    /// numbers, words where all are words, yes and no where all are, else each value's JSON text. Nulls are of any type.
    pub(super) fn of(values: impl Iterator<Item = Value>) -> Self {
        let (mut any, mut counts, mut numbers, mut words, mut flags) = (false, true, true, true, true);
        for value in values.filter(|value| !value.is_null()) {
            any = true;
            counts &= value.is_u64();
            numbers &= value.is_number();
            words &= value.is_string();
            flags &= value.is_boolean();
        }
        match () {
            () if any && counts => Self::Counts,
            () if numbers => Self::Numbers,
            () if words => Self::Words,
            () if flags => Self::Flags,
            () => Self::Texts,
        }
    }
}

/// The columns of a table under way.
#[derive(Debug, Default)]
pub(super) struct Columns(Vec<(String, Box<dyn Array>)>);

impl Columns {
    fn push(&mut self, name: &str, array: &dyn Array) -> &mut Self {
        // a column that no cell is missing from says so by saying nothing of missing cells
        let cells = array.validity().filter(|_| array.null_count() > 0).cloned();
        self.0.push((name.to_owned(), array.with_validity(cells)));
        self
    }

    /// A column of numbers.
    pub(super) fn number(&mut self, name: &str, values: impl Iterator<Item = Option<f64>>) -> &mut Self {
        self.push(name, &PrimitiveArray::<f64>::from(values.collect::<Vec<_>>()))
    }

    /// A column of whole numbers.
    pub(super) fn count(&mut self, name: &str, values: impl Iterator<Item = Option<usize>>) -> &mut Self {
        let values = values.map(|v| v.and_then(|v| i64::try_from(v).ok()));
        self.push(name, &PrimitiveArray::<i64>::from(values.collect::<Vec<_>>()))
    }

    /// A column of words.
    pub(super) fn word<'a>(&mut self, name: &str, values: impl Iterator<Item = Option<&'a str>>) -> &mut Self {
        self.push(name, &Utf8ViewArray::from_slice(values.collect::<Vec<_>>()))
    }

    /// A column of yes and no.
    pub(super) fn flag(&mut self, name: &str, values: impl Iterator<Item = Option<bool>>) -> &mut Self {
        self.push(name, &BooleanArray::from(values.collect::<Vec<_>>()))
    }

    /// A column of an axis of a type that all `values` are of.
    pub(super) fn axis(&mut self, name: &str, of: AxisType, values: &[Value]) -> &mut Self {
        let count = |v: &Value| v.as_u64().and_then(|v| usize::try_from(v).ok());
        match of {
            AxisType::Counts => self.count(name, values.iter().map(count)),
            AxisType::Numbers => self.number(name, values.iter().map(Value::as_f64)),
            AxisType::Words => self.word(name, values.iter().map(Value::as_str)),
            AxisType::Flags => self.flag(name, values.iter().map(Value::as_bool)),
            AxisType::Texts => {
                let text = |v: &Value| (!v.is_null()).then(|| canonical_text(v));
                let texts: Vec<Option<String>> = values.iter().map(text).collect();
                self.word(name, texts.iter().map(Option::as_deref))
            }
        }
    }

    /// The table.
    pub(super) fn frame(&mut self) -> io::Result<Frame> {
        Frame::new(std::mem::take(&mut self.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use polars_arrow::datatypes::ArrowDataType;
    use serde_json::json;

    #[test]
    fn an_axis_has_the_type_of_its_values() {
        for (values, expected) in [
            (vec![json!(1), json!(null)], ArrowDataType::Int64),
            (vec![json!(1.0), json!(null)], ArrowDataType::Float64),
            (vec![json!(null)], ArrowDataType::Float64),
            (vec![json!("a")], ArrowDataType::Utf8View),
            (vec![json!(true)], ArrowDataType::Boolean),
            (vec![json!([1.0, 2.5]), json!(3)], ArrowDataType::Utf8View),
        ] {
            let of = AxisType::of(values.iter().cloned());
            for part in [&values[..], &values[..1], &[]] {
                let frame = Columns::default().axis("a", of, part).frame().unwrap();
                assert_eq!(frame.types(), [("a", &expected)], "{part:?}");
            }
        }
    }
}
