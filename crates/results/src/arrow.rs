//! Tables as arrays in memory, for other libraries to take without a copy.
//!
//! Knows the arrays of the table library. Does not know who takes them.

use super::arrays::{Columns, type_of};
use super::frame::ArrowFrame;
use super::layout::Layout;
use super::table::{Table, TableName};
use crate::JobRecord;
use polars_arrow::array::{Array, BooleanArray, PrimitiveArray, StructArray, Utf8ViewArray};
use polars_arrow::datatypes::{ArrowDataType, Field};
use pontoon_plan::input::Cell;
use pontoon_plan::job::Job;
use pontoon_plan::study_file::Study;
use serde_json::Value;
use std::collections::BTreeMap;
use std::io;

/// A table as arrays, one part below the other.
#[derive(Debug, Clone)]
pub struct ArrowTable {
    empty: ArrowFrame,
    parts: Vec<ArrowFrame>,
}

impl ArrowTable {
    /// Parts of equal columns; `empty` has the columns and no rows.
    pub(super) fn new(empty: ArrowFrame, parts: Vec<ArrowFrame>) -> Self {
        Self { empty, parts }
    }

    /// The table of objects with their keys as columns, in the order in which keys come; what is no number, word or flag
    /// stands as JSON.
    ///
    /// # Errors
    /// None, as columns are made of equal length.
    pub fn of_objects(objects: &[Value]) -> io::Result<Self> {
        let mut names: Vec<&String> = Vec::new();
        for name in objects.iter().filter_map(Value::as_object).flat_map(|keys| keys.keys()) {
            if !names.contains(&name) {
                names.push(name);
            }
        }
        let mut columns = Columns::default();
        for name in names {
            let cells = || {
                objects
                    .iter()
                    .map(|object| object.get(name).map_or(Cell::Nothing, Cell::of))
            };
            columns.push(name, type_of(cells()), cells());
        }
        let frame = columns.frame()?;
        Ok(Self::new(frame.without_rows(), vec![frame]))
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.parts.iter().map(ArrowFrame::rows).sum()
    }

    /// Names of the columns in their order.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.empty.columns().map(|(name, _)| name)
    }

    /// The type of a row.
    pub fn field(&self) -> Field {
        let field = |(name, array): (&str, &dyn Array)| Field::new(name.into(), array.dtype().clone(), true);
        let columns: Vec<Field> = self.empty.columns().map(field).collect();
        Field::new("".into(), ArrowDataType::Struct(columns), false)
    }

    /// The parts, each an array of rows.
    pub fn arrays(&self) -> Vec<Box<dyn Array>> {
        let row = self.field().dtype;
        let array = |part: &ArrowFrame| -> Box<dyn Array> {
            let columns = part.columns().map(|(_, array)| array.to_boxed()).collect();
            Box::new(StructArray::new(row.clone(), part.rows(), columns, None))
        };
        self.parts.iter().map(array).collect()
    }

    /// Whether a column holds whole numbers alone.
    pub fn is_whole(&self, name: &str) -> bool {
        let mut columns = self.empty.columns();
        columns.any(|(column, array)| column == name && array.dtype() == &ArrowDataType::Int64)
    }

    /// A column as numbers, no number as nan, yes as 1 and no as 0; none where it holds others or is not there.
    pub fn numbers(&self, name: &str) -> Option<Vec<f64>> {
        let (_, empty) = self.empty.columns().find(|(column, _)| *column == name)?;
        let types = [ArrowDataType::Float64, ArrowDataType::Int64, ArrowDataType::Boolean];
        types.iter().find(|known| *known == empty.dtype())?;
        let mut numbers = Vec::with_capacity(self.rows());
        for part in &self.parts {
            let (_, array) = part.columns().find(|(column, _)| *column == name)?;
            let array = array.as_any();
            if let Some(of) = array.downcast_ref::<PrimitiveArray<f64>>() {
                numbers.extend(of.iter().map(|x| x.copied().unwrap_or(f64::NAN)));
            } else if let Some(of) = array.downcast_ref::<PrimitiveArray<i64>>() {
                numbers.extend(of.iter().map(|x| x.map_or(f64::NAN, |&x| x as f64)));
            } else if let Some(of) = array.downcast_ref::<BooleanArray>() {
                numbers.extend(of.iter().map(|x| x.map_or(f64::NAN, f64::from)));
            } else {
                return None;
            }
        }
        Some(numbers)
    }

    /// The cells of a column of words; none where it holds others or is not there.
    pub fn words(&self, name: &str) -> Option<Vec<Option<&str>>> {
        let mut words = Vec::with_capacity(self.rows());
        for part in &self.parts {
            let (_, array) = part.columns().find(|(column, _)| *column == name)?;
            words.extend(array.as_any().downcast_ref::<Utf8ViewArray>()?.iter());
        }
        Some(words)
    }

    /// The table for whoever reads single cells.
    ///
    /// # Errors
    /// Where a number is not finite.
    pub fn cells(&self) -> io::Result<Table> {
        let parts = std::iter::once(&self.empty).chain(&self.parts);
        Table::from_frames(&parts.cloned().collect::<Vec<_>>())
    }
}

/// The tables of a study as its records come, in memory.
pub struct MemoryTables {
    layout: Layout,
    tables: BTreeMap<TableName, ArrowTable>,
}

impl MemoryTables {
    /// The tables of a study with all its jobs.
    ///
    /// # Errors
    /// None, as columns are made of equal length.
    pub fn begin(study: &Study, jobs: &[Job]) -> io::Result<Self> {
        let layout = Layout::new(study, jobs);
        let empty = |name| Ok((name, ArrowTable::new(layout.frame(name, &[], &[])?, Vec::new())));
        Ok(Self {
            tables: layout.tables().map(empty).collect::<io::Result<_>>()?,
            layout,
        })
    }

    /// Appends the rows of the next jobs.
    ///
    /// # Errors
    /// As [`Self::begin`].
    pub fn append(&mut self, jobs: &[Job], records: &[JobRecord]) -> io::Result<()> {
        for (name, table) in &mut self.tables {
            let part = self.layout.frame(*name, jobs, records)?;
            if part.rows() > 0 {
                table.parts.push(part);
            }
        }
        Ok(())
    }

    /// The tables.
    pub fn finish(self) -> BTreeMap<TableName, ArrowTable> {
        self.tables
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn objects_are_rows_and_their_keys_columns() {
        let rows = [
            json!({ "a": 1.5, "b": "x" }),
            json!({ "b": "y", "c": [1, 2] }),
            json!({ "a": null, "d": true }),
        ];
        let table = ArrowTable::of_objects(&rows).unwrap();
        assert_eq!(
            (table.rows(), table.names().collect::<Vec<_>>()),
            (3, vec!["a", "b", "c", "d"])
        );
        let numbers = table.numbers("a").unwrap();
        assert!(
            numbers[0] == 1.5 && numbers[1].is_nan() && numbers[2].is_nan(),
            "{numbers:?}"
        );
        assert_eq!(table.numbers("b"), None);
        assert_eq!(table.words("b").unwrap(), [Some("x"), Some("y"), None]);
        let cells = table.cells().unwrap();
        assert_eq!((cells.cell("b", 1), cells.cell("c", 1)), ("y".into(), "[1,2]".into()));
        assert_eq!(table.arrays()[0].len(), 3);
    }
}
