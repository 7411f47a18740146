//! Why a quantity has no value on results.
//!
//! Knows what can be missing. Does not know which check asked.

use pontoon_plan::input::{Obstacle, Refusal};
use pontoon_results::TableName;
use thiserror::Error;

/// Why a quantity has no value on results.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum NoValue {
    /// The results hold no such table.
    #[error("the results hold no table of {}", .0.word())]
    NoTable(TableName),
    /// No job is meant.
    #[error("no job matches")]
    NoJob,
    /// All jobs that are meant failed.
    #[error("only failed jobs match, {0} of them")]
    OnlyFailed(usize),
    /// Some of the jobs that are meant failed, so that nothing can be said of all.
    #[error("{} among those that match", failed_jobs(*.0))]
    FailedAmong(usize),
    /// No row of a table is meant.
    #[error("no row of {} matches", .0.word())]
    NoRow(TableName),
    /// Several rows are meant where one is needed.
    #[error("{0} rows match where one is meant")]
    SeveralRows(usize),
    /// Several jobs are meant where one history is needed.
    #[error("several jobs match where one history is meant")]
    SeveralJobs,
    /// A column is empty in all rows that are meant.
    #[error("{column} empty in all {rows} rows that match")]
    Empty {
        /// The column.
        column: String,
        /// How many rows.
        rows: usize,
    },
    /// A column is empty in a row that is meant.
    #[error("{0} is empty in a row that matches")]
    EmptyRow(String),
    /// Jobs that are meant have no value of an axis.
    #[error("jobs that match have no {0}")]
    NoAxis(String),
    /// An axis has too few values for a trend.
    #[error("{values} values of {along} match, a trend needs two")]
    FewValues {
        /// How many.
        values: usize,
        /// The axis.
        along: String,
    },
    /// Several rows stand at one place of a curve.
    #[error("several rows with one {0}: several jobs match")]
    SeveralAt(String),
    /// A point of a curve lies outside the rows that are meant.
    #[error("{against} {x} lies outside the rows that match")]
    Outside {
        /// What the curve runs against.
        against: String,
        /// The point's place.
        x: f64,
    },
    /// No such history was recorded.
    #[error("no history of {quantity} at {place} was recorded")]
    NoHistory {
        /// What it would be of.
        quantity: String,
        /// Position, joint or place.
        place: String,
    },
    /// A history has empty values.
    #[error("a history with empty values")]
    BrokenHistory,
    /// A history does not reach as far as is asked for.
    #[error("the history does not reach from {from_s:.3} to {to_s:.3} s")]
    ShortHistory {
        /// From `[s]`.
        from_s: f64,
        /// To `[s]`.
        to_s: f64,
    },
    /// A history has too few values in the part that is asked for.
    #[error("the history has {values} values between {from_s:.3} and {to_s:.3} s")]
    ThinHistory {
        /// How many.
        values: usize,
        /// From `[s]`.
        from_s: f64,
        /// To `[s]`.
        to_s: f64,
    },
    /// A history crosses zero too seldom for a period.
    #[error("{0} zero crossings, no period")]
    NoPeriod(usize),
    /// A history does not cross zero on both sides of its largest value.
    #[error("no zero crossing on both sides of the hump")]
    NoHump,
    /// A history does not reach far enough about the arrival.
    #[error("the history does not reach {0} m before and behind the arrival")]
    ShortAbout(f64),
    /// A history has no positive value about the arrival.
    #[error("no hump about the arrival")]
    NoHumpAbout,
    /// A job has no speed.
    #[error("no speed: histories are those of crossings")]
    NoSpeed,
    /// An axis is no path.
    #[error("no path: {0}")]
    NoPath(String),
    /// The value of an axis has no place in its document.
    #[error(transparent)]
    NoPlace(#[from] Obstacle),
    /// The study's documents are not read any more.
    #[error("{0}")]
    Document(Box<Refusal>),
    /// The value is not finite.
    #[error("not a finite number: {0}")]
    NotFinite(f64),
    /// The check is of no single value.
    #[error("not a check of one value")]
    NotOneValue,
}

impl From<Refusal> for NoValue {
    fn from(refusal: Refusal) -> Self {
        Self::Document(Box::new(refusal))
    }
}

/// A number of failed jobs, in words.
pub(super) fn failed_jobs(count: usize) -> String {
    match count {
        1 => "1 failed job".to_owned(),
        n => format!("{n} failed jobs"),
    }
}
