//! Columns of a table under way: cells are put in one after the other, and become arrays of the table library or a table in
//! memory.
//!
//! Knows the few types of columns. Does not know what a column means.

use super::frame::ArrowFrame;
use polars_arrow::array::{Array, BooleanArray, PrimitiveArray, Utf8ViewArray};
use pontoon_plan::input::Cell;
use serde::Serialize;
use std::borrow::Cow;
use std::io;

/// What the cells of a column are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(tag = "cells", content = "words", rename_all = "snake_case")]
pub enum CellKind {
    /// Numbers.
    Numbers,
    /// Whole numbers.
    Counts,
    /// True and false.
    Flags,
    /// One of these words.
    Words(&'static [&'static str]),
    /// Any text.
    Texts,
    /// Values of several types, each as JSON.
    Values,
}

/// The type of an axis's column: whole numbers where all its values are of such a type, numbers where all are numbers, words
/// where all are words, yes and no where all are, else texts: each value as JSON. Nothing is of any type.
pub(super) fn type_of<'a>(values: impl Iterator<Item = Cell<'a>>) -> CellKind {
    let (mut any, mut counts, mut numbers, mut words, mut flags) = (false, true, true, true, true);
    for cell in values.filter(|cell| !cell.is_nothing()) {
        any = true;
        counts &= matches!(cell, Cell::Whole(whole) if whole >= 0);
        numbers &= cell.number().is_some();
        words &= cell.word().is_some();
        flags &= matches!(cell, Cell::Flag(_));
    }
    match () {
        () if any && counts => CellKind::Counts,
        () if numbers => CellKind::Numbers,
        () if words => CellKind::Words(&[]),
        () if flags => CellKind::Flags,
        () => CellKind::Values,
    }
}

/// The cells of a column under way.
#[derive(Debug, Clone)]
pub(super) enum ColumnBuilder<'a> {
    Numbers(Vec<Option<f64>>),
    Counts(Vec<Option<i64>>),
    Words(Vec<Option<Cow<'a, str>>>),
    Values(Vec<Option<String>>),
    Flags(Vec<Option<bool>>),
}

impl<'a> ColumnBuilder<'a> {
    /// None yet.
    pub(super) fn of(kind: CellKind) -> Self {
        match kind {
            CellKind::Numbers => Self::Numbers(Vec::new()),
            CellKind::Counts => Self::Counts(Vec::new()),
            CellKind::Flags => Self::Flags(Vec::new()),
            CellKind::Words(_) | CellKind::Texts => Self::Words(Vec::new()),
            CellKind::Values => Self::Values(Vec::new()),
        }
    }

    /// Appends a cell; one of another type leaves nothing, but that a text holds anything as JSON.
    pub(super) fn push(&mut self, cell: Cell<'a>) {
        match self {
            Self::Numbers(numbers) => numbers.push(cell.number()),
            Self::Counts(counts) => counts.push(match cell {
                Cell::Whole(whole) => Some(whole),
                _ => None,
            }),
            Self::Flags(flags) => flags.push(match cell {
                Cell::Flag(yes) => Some(yes),
                _ => None,
            }),
            Self::Words(words) => words.push(match cell {
                Cell::Nothing => None,
                Cell::Word(word) => Some(word),
                other => Some(Cow::Owned(other.to_string())),
            }),
            Self::Values(values) => values.push((!cell.is_nothing()).then(|| cell.to_string())),
        }
    }

    /// The cells as numbers, no number as nan, yes as 1 and no as 0; none of words.
    pub(super) fn numbers(&self) -> Option<Vec<f64>> {
        fn of<T: Copy>(cells: &[Option<T>], number: fn(T) -> f64) -> Option<Vec<f64>> {
            Some(cells.iter().map(|cell| cell.map_or(f64::NAN, number)).collect())
        }
        match self {
            Self::Numbers(numbers) => of(numbers, |x| x),
            Self::Counts(counts) => of(counts, |x| x as f64),
            Self::Flags(flags) => of(flags, f64::from),
            Self::Words(_) | Self::Values(_) => None,
        }
    }

    fn array(&self) -> Box<dyn Array> {
        let array: Box<dyn Array> = match self {
            Self::Numbers(numbers) => Box::new(PrimitiveArray::<f64>::from(numbers.as_slice())),
            Self::Counts(counts) => Box::new(PrimitiveArray::<i64>::from(counts.as_slice())),
            Self::Flags(flags) => Box::new(BooleanArray::from(flags.as_slice())),
            Self::Values(values) => Box::new(Utf8ViewArray::from_slice(values)),
            Self::Words(words) => {
                let words: Vec<Option<&str>> = words.iter().map(Option::as_deref).collect();
                Box::new(Utf8ViewArray::from_slice(words))
            }
        };
        // a column that no cell is missing from says so by saying nothing of missing cells
        let cells = array.validity().filter(|_| array.null_count() > 0).cloned();
        array.with_validity(cells)
    }
}

/// The columns of a table under way.
#[derive(Debug, Clone, Default)]
pub(super) struct Columns<'a>(pub(super) Vec<(String, ColumnBuilder<'a>)>);

impl<'a> Columns<'a> {
    /// Appends a column.
    pub(super) fn push(&mut self, name: &str, kind: CellKind, cells: impl Iterator<Item = Cell<'a>>) {
        let mut column = ColumnBuilder::of(kind);
        cells.for_each(|cell| column.push(cell));
        self.0.push((name.to_owned(), column));
    }

    /// The columns as arrays.
    pub(super) fn frame(&self) -> io::Result<ArrowFrame> {
        let array = |(name, cells): &(String, ColumnBuilder<'_>)| (name.clone(), cells.array());
        ArrowFrame::new(self.0.iter().map(array).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use polars_arrow::datatypes::ArrowDataType;
    use serde_json::{Value, json};

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
            let cells = |of: &'_ [Value]| of.iter().map(Cell::from).collect::<Vec<_>>();
            let kind = type_of(cells(&values).into_iter());
            for part in [&values[..], &values[..1], &[]] {
                let mut columns = Columns::default();
                columns.push("a", kind, cells(part).into_iter());
                assert_eq!(columns.frame().unwrap().types(), [("a", &expected)], "{part:?}");
            }
        }
    }

    #[test]
    fn values_of_several_types_are_json_and_words_alone_are_not() {
        fn column(values: &[Value]) -> ColumnBuilder<'_> {
            let cells: Vec<Cell<'_>> = values.iter().map(Cell::of).collect();
            let mut columns = Columns::default();
            columns.push("a", type_of(cells.iter().cloned()), cells.into_iter());
            columns.0.remove(0).1
        }
        let texts = match column(&[json!("auto"), json!(0.02), json!(null)]) {
            ColumnBuilder::Values(texts) => texts,
            other => panic!("{other:?}"),
        };
        assert_eq!(texts, [Some("\"auto\"".to_owned()), Some("0.02".to_owned()), None]);
        assert!(
            matches!(column(&[json!("auto"), json!("b")]), ColumnBuilder::Words(words) if words[0].as_deref() == Some("auto"))
        );
    }
}
