//! The keys of a reference file.
//!
//! Knows their types and meaning. Does not know which combinations make sense.

use super::Filter;
use super::measured::MeasuredSpec;
use pontoon_results::TableName;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A reference as its file writes it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ReferenceSpec {
    /// Name of the reference.
    pub name: String,
    /// Where its numbers come from.
    pub source: String,
    /// Path of the study whose results it holds, relative to this file; results of another study are refused. Any results
    /// where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub study: Option<String>,
    /// The checks, each with an id of its own.
    #[schemars(length(min = 1))]
    pub checks: Vec<CheckSpec>,
    /// Points that were measured, each group with an id of its own: drawn as marks, never judged.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub measured: Vec<MeasuredSpec>,
}

impl ReferenceSpec {
    /// What results are judged by: the reference without the measured points, which no verdict and no fit depends on.
    #[must_use]
    pub fn judged(&self) -> Self {
        let mut judged = self.clone();
        judged.measured.clear();
        judged
    }
}

/// What becomes of a check.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Role {
    /// It must hold.
    #[default]
    Hold,
    /// It is run and expected to fail; that it holds is told as a change.
    ExpectedFail,
    /// It is printed beside what is expected and never judged; but where nothing is found it falls short like any other.
    Record,
}

/// One check. Exactly one of `value`, `bound`, `trend`, `mode`, `curve` and `measured` says what is checked.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CheckSpec {
    /// Its id, unlike any other's.
    pub id: String,
    /// The statement it checks, as its source has it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub statement: Option<String>,
    /// How the statement is measured, and whatever else a reader should know.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub note: Option<String>,
    /// What becomes of it.
    #[serde(default)]
    pub role: Role,
    /// Which rows all quantities of the check are taken from.
    #[serde(default, rename = "where", skip_serializing_if = "Filter::is_empty")]
    pub filter: Filter,
    /// Columns of the table of jobs: the check is made for each combination of their values, and the worst decides.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub each: Vec<String>,
    /// A quantity has a value.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub value: Option<ValueCheck>,
    /// A quantity keeps within bounds.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bound: Option<BoundCheck>,
    /// A quantity has a trend over an axis.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub trend: Option<TrendCheck>,
    /// A mode, by the name of its shape, has a frequency.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mode: Option<ModeCheck>,
    /// A column runs along a curve.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub curve: Option<CurveCheck>,
    /// A quantity lies within the uncertainty of a measurement.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub measured: Option<MeasuredCheck>,
}

/// The one kind of a check.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum CheckKind<'a> {
    /// See [`ValueCheck`].
    Value(&'a ValueCheck),
    /// See [`BoundCheck`].
    Bound(&'a BoundCheck),
    /// See [`TrendCheck`].
    Trend(&'a TrendCheck),
    /// See [`ModeCheck`].
    Mode(&'a ModeCheck),
    /// See [`CurveCheck`].
    Curve(&'a CurveCheck),
    /// See [`MeasuredCheck`].
    Measured(&'a MeasuredCheck),
}

/// How far a number may be off: `|got - expected| <= max(relative_tolerance |expected|, absolute_tolerance)`.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Tolerance {
    /// As a share of what is expected.
    pub relative: Option<f64>,
    /// In the unit of what is expected.
    pub absolute: Option<f64>,
}

/// `|of - expected|` is within a tolerance.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ValueCheck {
    /// What is looked at.
    pub of: Quantity,
    /// What it should be, in the unit of its column; may be absent where a record is kept.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub expected: Option<f64>,
    /// How far it may be off as a share of `expected`; may be absent where a record is kept.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0))]
    pub relative_tolerance: Option<f64>,
    /// How far it may be off in its own unit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0))]
    pub absolute_tolerance: Option<f64>,
}

/// Bounds, at least one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BoundCheck {
    /// What is looked at.
    pub of: Quantity,
    /// Least value allowed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at_least: Option<f64>,
    /// Largest value allowed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at_most: Option<f64>,
    /// What it must be larger than.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub above: Option<f64>,
    /// What it must be smaller than.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub below: Option<f64>,
}

/// A trend over an axis of the jobs, from the axis's least value to its largest.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TrendCheck {
    /// What is looked at.
    pub of: Quantity,
    /// The column of the table of jobs along which it runs; at least two values.
    pub along: String,
    /// What it does.
    pub trend: Trend,
    /// Where it is `flat`: how far the largest may be above the smallest, as a share of the smallest's magnitude.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub within: Option<f64>,
}

/// What a quantity does along an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Trend {
    /// Each value is above the one before.
    Rises,
    /// Each value is below the one before.
    Falls,
    /// All values are within a share of each other.
    Flat,
    /// Each value is above zero.
    Positive,
    /// Each value is below zero.
    Negative,
}

/// A natural frequency by the name of its shape, from the table of modes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ModeCheck {
    /// Name of the shape, as `pontoon modes` gives it.
    pub shape: String,
    /// The frequency expected `[Hz]`.
    pub expected_hz: f64,
    /// How far it may be off as a share; may be absent where a record is kept.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub relative_tolerance: Option<f64>,
}

/// A curve through points, held against a column with linear interpolation between its rows.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CurveCheck {
    /// The table.
    pub table: TableName,
    /// The column that runs along the curve.
    pub column: String,
    /// The column against which it runs: `position`, `x_m`, `time_s`, ...
    pub against: String,
    /// Points `[against, column]`, increasing in the first.
    #[schemars(length(min = 1))]
    pub points: Vec<[f64; 2]>,
    /// How far any point may be off as a share of the largest magnitude of the points.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub relative_tolerance: Option<f64>,
    /// How far any point may be off in its own unit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub absolute_tolerance: Option<f64>,
}

/// A measured value with its uncertainty: the quantity lies within `value - uncertainty` and `value + uncertainty`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MeasuredCheck {
    /// What is looked at.
    pub of: Quantity,
    /// What was measured, in the unit of its column.
    pub value: f64,
    /// Half the width of its band, in the same unit.
    pub uncertainty: f64,
}

/// A number taken from results.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// A column's rows, reduced to one number.
    Select(SelectQuantity),
    /// A history, reduced to one number.
    History(HistoryQuantity),
    /// The first over the second.
    Ratio(Box<[Quantity; 2]>),
    /// The first less the second.
    Difference(Box<[Quantity; 2]>),
    /// The largest of a list.
    Largest(Vec<Quantity>),
    /// The smallest of a list.
    Smallest(Vec<Quantity>),
    /// A number that stands in the reference itself.
    Number(f64),
}

/// A column's rows, reduced to one number.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SelectQuantity {
    /// The table.
    pub table: TableName,
    /// The column.
    pub column: String,
    /// Which rows, beside the check's own; keys are columns of the table or of the table of jobs.
    #[serde(default, rename = "where", skip_serializing_if = "Filter::is_empty")]
    pub filter: Filter,
    /// What is made of them.
    #[serde(default)]
    pub reduce: Reduction,
}

/// What is made of several rows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Reduction {
    /// There must be one row.
    #[default]
    Only,
    /// The largest.
    Max,
    /// The smallest.
    Min,
    /// The mean.
    Mean,
    /// How many rows have a value.
    Count,
}

/// A history of one job, or a part of it, reduced to one number.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HistoryQuantity {
    /// `deflection_m` or `force_n`.
    pub quantity: String,
    /// Position or joint number.
    pub position: usize,
    /// Which job, beside the check's own rows; keys are columns of the table of jobs.
    #[serde(default, rename = "where", skip_serializing_if = "Filter::is_empty")]
    pub filter: Filter,
    /// Where the part begins; at the beginning where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from: Option<Edge>,
    /// Where the part ends; at the end where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to: Option<Edge>,
    /// What is made of it.
    pub reduce: HistoryReduction,
}

/// A moment of a crossing.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Edge {
    /// A time `[s]`.
    TimeS(f64),
    /// When the vehicle's centre is this far beyond the history's position `[m]`; negative before it.
    CentrePastM(f64),
    /// This long after the vehicle's last point has left the bridge `[s]`.
    AfterLeavingS(f64),
}

/// What is made of a history.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum HistoryReduction {
    /// Its largest value.
    Max,
    /// Its smallest value.
    Min,
    /// Its largest magnitude.
    MaxAbs,
    /// The largest value of its negative: the largest uplift of a deflection, the largest compression of a force.
    MaxNegative,
    /// Half the distance from its largest to its smallest value.
    Amplitude,
    /// Twice the mean time between its zero crossings `[s]`.
    PeriodS,
    /// Time from the zero crossing before its largest value to the one after it `[s]`.
    HumpDurationS,
    /// The largest `|w(t_a - s) - w(t_a + s)|` for `V s` up to this length `[m]`, over the largest value; t_a is when the
    /// vehicle's centre is at the history's position.
    AsymmetryWithinM(f64),
}

impl CheckSpec {
    /// What is checked; none where the file says nothing or several things, which reading refuses.
    pub fn kind(&self) -> Option<CheckKind<'_>> {
        let mut kinds = self.kinds();
        kinds.next().filter(|_| kinds.next().is_none())
    }

    /// What a check of one value expects and how far it may be off, in the unit of what it looks at; none of another kind.
    pub fn expected_and_tolerance(&self) -> Option<(f64, f64)> {
        match self.kind()? {
            CheckKind::Value(v) => v.expected.map(|expected| (expected, v.tolerance().allowed(expected))),
            CheckKind::Mode(m) => Some((m.expected_hz, m.tolerance().allowed(m.expected_hz))),
            CheckKind::Measured(m) => Some((m.value, m.uncertainty)),
            CheckKind::Bound(_) | CheckKind::Trend(_) | CheckKind::Curve(_) => None,
        }
    }

    /// All that the file says is checked.
    pub(super) fn kinds(&self) -> impl Iterator<Item = CheckKind<'_>> {
        [
            self.value.as_ref().map(CheckKind::Value),
            self.bound.as_ref().map(CheckKind::Bound),
            self.trend.as_ref().map(CheckKind::Trend),
            self.mode.as_ref().map(CheckKind::Mode),
            self.curve.as_ref().map(CheckKind::Curve),
            self.measured.as_ref().map(CheckKind::Measured),
        ]
        .into_iter()
        .flatten()
    }
}

impl Quantity {
    /// Its parts with their places.
    pub fn parts(&self) -> Vec<(String, &Self)> {
        let (name, list): (&str, &[Self]) = match self {
            Self::Ratio(two) => ("ratio", two.as_slice()),
            Self::Difference(two) => ("difference", two.as_slice()),
            Self::Largest(list) => ("largest", list),
            Self::Smallest(list) => ("smallest", list),
            Self::Select(_) | Self::History(_) | Self::Number(_) => ("", &[]),
        };
        list.iter()
            .enumerate()
            .map(|(i, part)| (format!("{name}[{i}]"), part))
            .collect()
    }

    /// Whether some part of it looks at results.
    pub(super) fn looks_at_results(&self) -> bool {
        match self {
            Self::Select(_) | Self::History(_) => true,
            Self::Number(_) => false,
            _ => self.parts().iter().any(|(_, part)| part.looks_at_results()),
        }
    }
}

impl HistoryQuantity {
    /// Whether it matters when the vehicle is where.
    pub fn needs_moments(&self) -> bool {
        let whole = self.from.is_none() && self.to.is_none();
        !whole || matches!(self.reduce, HistoryReduction::AsymmetryWithinM(_))
    }
}

impl BoundCheck {
    /// The lower bound, whether it is allowed itself or not.
    pub fn lower(&self) -> Option<f64> {
        self.at_least.or(self.above)
    }

    /// The upper bound, whether it is allowed itself or not.
    pub fn upper(&self) -> Option<f64> {
        self.at_most.or(self.below)
    }
}

impl Tolerance {
    /// How far a value may be from what is expected, in its own unit; nothing where no tolerance is given.
    pub fn allowed(&self, expected: f64) -> f64 {
        let relative = self.relative.map(|share| share * expected.abs());
        relative.into_iter().chain(self.absolute).fold(0.0, f64::max)
    }
}

impl ValueCheck {
    /// Its tolerance.
    pub fn tolerance(&self) -> Tolerance {
        Tolerance {
            relative: self.relative_tolerance,
            absolute: self.absolute_tolerance,
        }
    }
}

impl ModeCheck {
    /// Its tolerance.
    pub fn tolerance(&self) -> Tolerance {
        Tolerance {
            relative: self.relative_tolerance,
            absolute: None,
        }
    }
}

impl CurveCheck {
    /// Its tolerance.
    pub fn tolerance(&self) -> Tolerance {
        Tolerance {
            relative: self.relative_tolerance,
            absolute: self.absolute_tolerance,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::{Value, json};

    #[test]
    fn quantities_are_written_as_they_were_read() {
        let select =
            json!({ "select": { "table": "jobs", "column": "steps", "where": { "job": 1 }, "reduce": "max" } });
        let history = json!({ "history": { "quantity": "force_n", "position": 7, "from": { "centre_past_m": -3.0 },
            "to": { "after_leaving_s": 1.0 }, "reduce": { "asymmetry_within_m": 18.0 } } });
        for written in [
            json!({ "ratio": [select, { "number": 2.0 }] }),
            json!({ "difference": [history, { "largest": [select] }] }),
            json!({ "smallest": [select, history] }),
        ] {
            let read: Quantity = serde_json::from_value(written.clone()).unwrap();
            assert_eq!(serde_json::to_value(read).unwrap(), written);
        }
    }

    #[test]
    fn what_is_no_quantity_is_not_read() {
        for bad in [
            json!(1),
            json!("number"),
            json!({}),
            json!({ "number": 1, "select": {} }),
            json!({ "number": null }),
            json!({ "ratio": [{ "number": 1 }] }),
            json!({ "select": { "table": "jobs" } }),
            json!({ "select": { "table": "jobs", "column": "steps", "reduce": "sum" } }),
            json!({ "history": { "quantity": "force_n", "position": 7 } }),
            json!({ "history": { "quantity": "force_n", "position": 7, "reduce": "max", "from": 3 } }),
        ] {
            assert!(serde_json::from_value::<Quantity>(bad.clone()).is_err(), "{bad}");
        }
    }

    #[test]
    fn what_is_left_out_of_a_check_is_held_everywhere() {
        let check: CheckSpec = serde_json::from_value(json!({ "id": "a" })).unwrap();
        assert_eq!(
            (check.role, check.filter.is_empty(), check.each.len()),
            (Role::Hold, true, 0)
        );
        let back: Value = serde_json::to_value(&check).unwrap();
        assert_eq!(back, json!({ "id": "a", "role": "hold" }));
    }
}
