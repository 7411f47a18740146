//! What each kind of check can do.
//!
//! Knows what is asked of a kind. Does not know the kinds.

use super::finding::Finding;
use crate::quantity::{CheckInput, Evaluator, NoValue, Place, Quantity, SelectQuantity};
use pontoon_plan::input::Refusal;
use pontoon_plan::input::filter::Filter;
use pontoon_results::TableName;

/// What a kind of check can do, beside being read by its keys.
pub(crate) trait CheckKind {
    /// Refuses what cannot be a check, whatever the results.
    fn refuse(&self, place: &Place<'_>) -> Result<(), Refusal>;

    /// Refuses what the results cannot have.
    fn select(&self, input: &CheckInput<'_>) -> Result<(), Refusal>;

    /// What it finds on the rows that a filter means.
    fn evaluate(&self, on: &Evaluator<'_>, filter: &Filter) -> Result<Finding, NoValue>;

    /// What it expects, for people, and its value where it is one.
    fn expected(&self) -> (String, Option<f64>);

    /// The one value that it is of, where it is of one.
    fn one_value(&self) -> Option<OneValue> {
        None
    }

    /// What it says that a chart can show.
    fn expectation(&self) -> Expectation<'_> {
        Expectation::None
    }
}

/// The one value that a check is of.
#[derive(Debug, Clone, PartialEq)]
pub struct OneValue {
    /// What is looked at.
    pub of: Quantity,
    /// What it should be, in its own unit; none where a record is kept of it.
    pub expected: Option<f64>,
    /// How far it may be off, in the same unit.
    pub tolerance: f64,
}

/// What a check says that a chart can show.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Expectation<'a> {
    /// Nothing.
    None,
    /// The value of a column of some rows.
    Value {
        /// The column and its rows.
        select: &'a SelectQuantity,
        /// The value.
        value: f64,
        /// Whether it was measured.
        measured: bool,
    },
    /// Points of a curve.
    Curve(CheckCurve<'a>),
    /// A natural frequency.
    Mode {
        /// Name of the shape.
        shape: &'a str,
        /// The frequency `[Hz]`.
        frequency_hz: f64,
    },
}

/// Points along which a column runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CheckCurve<'a> {
    /// The table.
    pub table: TableName,
    /// The column that runs along them.
    pub column: &'a str,
    /// The column against which it runs.
    pub against: &'a str,
    /// The points, each of the second column and of the first.
    pub points: &'a [[f64; 2]],
}

impl<'a> Expectation<'a> {
    /// A value of a quantity, where that is a column of some rows.
    pub(super) fn of_quantity(quantity: &'a Quantity, value: f64, measured: bool) -> Self {
        match quantity {
            Quantity::Select(select) => Self::Value {
                select,
                value,
                measured,
            },
            _ => Self::None,
        }
    }
}
