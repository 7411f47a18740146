//! A table in memory: columns of numbers, words, or yes and no, any of which may be empty.
//!
//! Knows cells by column and row. Does not know files or what a column means.

use super::arrays::{self, Columns};
use super::frame::ArrowFrame;
use polars_arrow::array::{Array, BooleanArray, PrimitiveArray, Utf8ViewArray};
use polars_arrow::datatypes::ArrowDataType;
use pontoon_plan::input::Cell;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use std::hash::Hash;
use std::io;

/// A table of the results.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum TableName {
    /// One row a job.
    Jobs,
    /// One row a position of a job.
    Positions,
    /// One row a joint or connector of a job.
    Connectors,
    /// One row a time of a history.
    Histories,
    /// One row a mode of a job.
    Modes,
    /// One row a joint of a job whose joints are worn.
    Joints,
    /// One row a pin of a job, or a joint with its pins added.
    Pins,
    /// One row a section force or angle of a joint of a job.
    Sections,
    /// One row a recorded place of a job.
    Places,
    /// One row a number of a job at the instant of a peak.
    AtPeaks,
    /// One row a bank of a job, or one of its places across.
    Banks,
    /// One row a number of a job at rest, before its vehicle comes.
    Dead,
    /// One row a corner of a module's deck of a job.
    Freeboards,
    /// One row a wheel of a vehicle on springs of a job.
    Wheels,
    /// One row a motion of the body of a vehicle on springs of a job.
    Bodies,
    /// One row a limit of a crossing.
    Limits,
}

impl TableName {
    /// All tables.
    pub const ALL: [Self; 16] = [
        Self::Jobs,
        Self::Positions,
        Self::Connectors,
        Self::Histories,
        Self::Modes,
        Self::Joints,
        Self::Pins,
        Self::Sections,
        Self::Places,
        Self::AtPeaks,
        Self::Banks,
        Self::Dead,
        Self::Freeboards,
        Self::Wheels,
        Self::Bodies,
        Self::Limits,
    ];

    /// Its name as files and references have it.
    pub fn word(self) -> &'static str {
        match self {
            Self::Jobs => "jobs",
            Self::Positions => "positions",
            Self::Connectors => "connectors",
            Self::Histories => "histories",
            Self::Modes => "modes",
            Self::Joints => "joints",
            Self::Pins => "pins",
            Self::Sections => "sections",
            Self::Places => "places",
            Self::AtPeaks => "at_peaks",
            Self::Banks => "banks",
            Self::Dead => "dead",
            Self::Freeboards => "freeboards",
            Self::Wheels => "wheels",
            Self::Bodies => "bodies",
            Self::Limits => "limits",
        }
    }

    /// The name of its file.
    pub fn file(self) -> String {
        format!("{}.parquet", self.word())
    }
}

/// A table in memory.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Table {
    rows: usize,
    columns: Vec<(String, ColumnCells)>,
}

#[derive(Debug, Clone, PartialEq)]
enum ColumnCells {
    Numbers(Vec<Option<f64>>),
    Words(Vec<Option<String>>),
    Flags(Vec<Option<bool>>),
}

impl ColumnCells {
    /// The cells of an array.
    fn of(name: &str, array: &dyn Array) -> io::Result<Self> {
        let mut cells = match array.dtype() {
            ArrowDataType::Float64 | ArrowDataType::Int64 => Self::Numbers(Vec::new()),
            ArrowDataType::Utf8View => Self::Words(Vec::new()),
            ArrowDataType::Boolean => Self::Flags(Vec::new()),
            other => return Err(io::Error::other(format!("column {name} of type {other:?}"))),
        };
        cells.append(name, array)?;
        Ok(cells)
    }

    /// Appends the cells of an array of the same type.
    fn append(&mut self, name: &str, array: &dyn Array) -> io::Result<()> {
        let array = array.as_any();
        if let (Self::Numbers(cells), Some(more)) = (&mut *self, array.downcast_ref::<PrimitiveArray<f64>>()) {
            if more.iter().flatten().any(|x| !x.is_finite()) {
                let text = format!("column {name} holds what is no finite number");
                return Err(io::Error::other(text));
            }
            cells.extend(more.iter().map(|x| x.copied()));
        } else if let (Self::Numbers(cells), Some(more)) = (&mut *self, array.downcast_ref::<PrimitiveArray<i64>>()) {
            cells.extend(more.iter().map(|x| x.map(|x| *x as f64)));
        } else if let (Self::Words(cells), Some(more)) = (&mut *self, array.downcast_ref::<Utf8ViewArray>()) {
            cells.extend(more.iter().map(|word| word.map(str::to_owned)));
        } else if let (Self::Flags(cells), Some(more)) = (self, array.downcast_ref::<BooleanArray>()) {
            cells.extend(more.iter());
        } else {
            return Err(io::Error::other(format!("column {name} of several types")));
        }
        Ok(())
    }
}

/// What the cells of a column are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ColumnKind {
    /// Numbers.
    Numbers,
    /// Words.
    Words,
    /// Yes and no.
    Flags,
}

impl ColumnKind {
    /// What a file writes in such a column's place.
    pub fn word(self) -> &'static str {
        match self {
            Self::Numbers => "numbers",
            Self::Words => "words",
            Self::Flags => "true and false",
        }
    }
}

impl Table {
    /// The table of frames, one below the other, of the columns of the first.
    ///
    /// # Errors
    /// Where a column is of none of the types that tables have, or a number is not finite.
    pub(super) fn from_frames(frames: &[ArrowFrame]) -> io::Result<Self> {
        let mut columns: Vec<(String, ColumnCells)> = Vec::new();
        for (column, (name, array)) in frames.iter().flat_map(|frame| frame.columns().enumerate()) {
            match columns.get_mut(column) {
                Some((_, cells)) => cells.append(name, array)?,
                None => columns.push((name.to_owned(), ColumnCells::of(name, array)?)),
            }
        }
        Ok(Self {
            rows: frames.iter().map(ArrowFrame::rows).sum(),
            columns,
        })
    }

    /// The table of columns.
    pub(super) fn from_columns(columns: Columns<'_>) -> Self {
        let cells = |cells: arrays::ColumnBuilder<'_>| match cells {
            arrays::ColumnBuilder::Numbers(numbers) => ColumnCells::Numbers(numbers),
            arrays::ColumnBuilder::Counts(counts) => {
                ColumnCells::Numbers(counts.iter().map(|x| x.map(|x| x as f64)).collect())
            }
            arrays::ColumnBuilder::Flags(flags) => ColumnCells::Flags(flags),
            arrays::ColumnBuilder::Values(values) => ColumnCells::Words(values),
            arrays::ColumnBuilder::Words(words) => {
                let words = words.into_iter();
                ColumnCells::Words(words.map(|word| word.map(|word| word.into_owned())).collect())
            }
        };
        let columns: Vec<(String, ColumnCells)> = columns.0.into_iter().map(|(name, own)| (name, cells(own))).collect();
        let rows = columns.first().map_or(0, |(_, cells)| match cells {
            ColumnCells::Numbers(list) => list.len(),
            ColumnCells::Words(list) => list.len(),
            ColumnCells::Flags(list) => list.len(),
        });
        Self { rows, columns }
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Names of the columns in their order.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.columns.iter().map(|(name, _)| name.as_str())
    }

    /// Whether there is a column of a name.
    pub fn has(&self, column: &str) -> bool {
        self.names().any(|name| name == column)
    }

    /// What a column holds; none where it is empty in all rows, as its type then says nothing, or not there.
    pub fn kind(&self, column: &str) -> Option<ColumnKind> {
        let (any, kind) = match self.cells(column)? {
            ColumnCells::Numbers(list) => (list.iter().any(Option::is_some), ColumnKind::Numbers),
            ColumnCells::Words(list) => (list.iter().any(Option::is_some), ColumnKind::Words),
            ColumnCells::Flags(list) => (list.iter().any(Option::is_some), ColumnKind::Flags),
        };
        any.then_some(kind)
    }

    /// Whether a column's cells can be had as numbers.
    pub fn is_number(&self, column: &str) -> bool {
        matches!(
            self.cells(column),
            Some(ColumnCells::Numbers(_) | ColumnCells::Flags(_))
        )
    }

    fn cells(&self, column: &str) -> Option<&ColumnCells> {
        self.columns
            .iter()
            .find(|(name, _)| name == column)
            .map(|(_, cells)| cells)
    }

    /// A cell as a number; none where it is empty or no number. Yes is 1, no is 0.
    pub fn number(&self, column: &str, row: usize) -> Option<f64> {
        match self.cells(column)? {
            ColumnCells::Numbers(list) => *list.get(row)?,
            ColumnCells::Flags(list) => (*list.get(row)?).map(|yes| if yes { 1.0 } else { 0.0 }),
            ColumnCells::Words(_) => None,
        }
    }

    /// The numbers of a column; none where it holds others or is not there.
    pub fn numbers(&self, column: &str) -> Option<&[Option<f64>]> {
        match self.cells(column)? {
            ColumnCells::Numbers(list) => Some(list),
            _ => None,
        }
    }

    /// The words of a column; none where it holds others or is not there.
    pub fn word_cells(&self, column: &str) -> Option<&[Option<String>]> {
        match self.cells(column)? {
            ColumnCells::Words(list) => Some(list),
            _ => None,
        }
    }

    /// A cell; nothing where it is empty or not there.
    pub fn cell(&self, column: &str, row: usize) -> Cell<'_> {
        let cell = self.cells(column).and_then(|cells| match cells {
            ColumnCells::Numbers(list) => list.get(row)?.map(Cell::Number),
            ColumnCells::Words(list) => list.get(row)?.as_deref().map(Cell::from),
            ColumnCells::Flags(list) => list.get(row)?.map(Cell::Flag),
        });
        cell.unwrap_or_default()
    }

    /// Which of a column's distinct cells each row has, by their numbers from 0 in the order of their first row; none where
    /// the cell is empty or the column not there.
    pub fn codes(&self, column: &str) -> Vec<Option<u32>> {
        match self.cells(column) {
            // 0 and -0 are one number
            Some(ColumnCells::Numbers(list)) => numbered(list.iter().map(|cell| cell.map(|x| (x + 0.0).to_bits()))),
            Some(ColumnCells::Words(list)) => numbered(list.iter().map(Option::as_deref)),
            Some(ColumnCells::Flags(list)) => numbered(list.iter().copied()),
            None => vec![None; self.rows],
        }
    }

    /// The distinct words of a column in the order of their first row; none where it holds no words.
    pub fn words(&self, column: &str) -> Vec<&str> {
        let mut words: Vec<&str> = Vec::new();
        if let Some(ColumnCells::Words(list)) = self.cells(column) {
            for word in list.iter().flatten() {
                if !words.contains(&word.as_str()) {
                    words.push(word);
                }
            }
        }
        words
    }
}

/// Numbers distinct keys in the order in which they come.
fn numbered<K: Eq + Hash>(keys: impl Iterator<Item = Option<K>>) -> Vec<Option<u32>> {
    let mut known: HashMap<K, u32> = HashMap::new();
    let mut number = |key: K| {
        let next = known.len() as u32;
        *known.entry(key).or_insert(next)
    };
    keys.map(|key| key.map(&mut number)).collect()
}
