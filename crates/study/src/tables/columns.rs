//! Columns of a table, one after the other.
//!
//! Knows the few column types that tables have. Does not know what a column means.

use crate::document::canonical_text;
use polars::prelude::{Column, DataFrame, NamedFrom, Series};
use serde_json::Value;

/// The columns of a table under way.
#[derive(Debug, Default)]
pub(super) struct Columns(Vec<Column>);

impl Columns {
    fn push(&mut self, series: Series) -> &mut Self {
        self.0.push(series.into());
        self
    }

    /// A column of numbers.
    pub(super) fn number(&mut self, name: &str, values: impl Iterator<Item = Option<f64>>) -> &mut Self {
        self.push(Series::new(name.into(), values.collect::<Vec<_>>()))
    }

    /// A column of whole numbers.
    pub(super) fn count(&mut self, name: &str, values: impl Iterator<Item = Option<usize>>) -> &mut Self {
        let values = values.map(|v| v.and_then(|v| i64::try_from(v).ok()));
        self.push(Series::new(name.into(), values.collect::<Vec<_>>()))
    }

    /// A column of words.
    pub(super) fn word<'a>(&mut self, name: &str, values: impl Iterator<Item = Option<&'a str>>) -> &mut Self {
        self.push(Series::new(name.into(), values.collect::<Vec<_>>()))
    }

    /// A column of yes and no.
    pub(super) fn flag(&mut self, name: &str, values: impl Iterator<Item = Option<bool>>) -> &mut Self {
        self.push(Series::new(name.into(), values.collect::<Vec<_>>()))
    }

    /// A column of an axis: whole numbers where all its values are of such a type, numbers where all are numbers, words
    /// where all are words, yes and no where all are, else each value's JSON text.
    pub(super) fn axis(&mut self, name: &str, values: &[Value]) -> &mut Self {
        let all = |is: fn(&Value) -> bool| values.iter().all(|v| v.is_null() || is(v));
        if !all(Value::is_null) && all(Value::is_u64) {
            self.count(
                name,
                values.iter().map(|v| v.as_u64().and_then(|v| usize::try_from(v).ok())),
            )
        } else if all(Value::is_number) {
            self.number(name, values.iter().map(Value::as_f64))
        } else if all(Value::is_string) {
            self.word(name, values.iter().map(Value::as_str))
        } else if all(Value::is_boolean) {
            self.flag(name, values.iter().map(Value::as_bool))
        } else {
            let texts: Vec<Option<String>> = values
                .iter()
                .map(|v| (!v.is_null()).then(|| canonical_text(v)))
                .collect();
            self.word(name, texts.iter().map(Option::as_deref))
        }
    }

    /// The table.
    pub(super) fn frame(&mut self) -> polars::prelude::PolarsResult<DataFrame> {
        DataFrame::new_infer_height(std::mem::take(&mut self.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use polars::prelude::DataType;
    use serde_json::json;

    #[test]
    fn an_axis_has_the_type_of_its_values() {
        for (values, expected) in [
            (vec![json!(1), json!(null)], DataType::Int64),
            (vec![json!(1.0), json!(null)], DataType::Float64),
            (vec![json!(null)], DataType::Float64),
            (vec![json!("a")], DataType::String),
            (vec![json!(true)], DataType::Boolean),
            (vec![json!([1.0, 2.5]), json!(3)], DataType::String),
        ] {
            let frame = Columns::default().axis("a", &values).frame().unwrap();
            assert_eq!(frame.column("a").unwrap().dtype(), &expected, "{values:?}");
        }
    }
}
