//! Quantities: numbers taken from results, as a reference writes them.
//!
//! Knows their keys and types. Does not know which columns or jobs results have.

use pontoon_plan::input::filter::Filter;
use pontoon_results::TableName;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

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
    /// What it is of, as `deflection_m` or `force_n`.
    pub quantity: String,
    /// Position or joint number.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub position: Option<usize>,
    /// Place of a deflection in place of a position `[m]`, of `record.places_x_m`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub x_m: Option<f64>,
    /// Place across of a pin `[m]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub y_m: Option<f64>,
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
    pub(crate) fn looks_at_results(&self) -> bool {
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

impl Quantity {
    /// The filters of all its parts that look at results, each with what `outer` says of columns that it does not name.
    pub fn filters(&self, outer: &Filter) -> Vec<Filter> {
        match self {
            Self::Number(_) => Vec::new(),
            Self::Select(select) => vec![select.filter.within(outer)],
            Self::History(history) => vec![history.filter.within(outer)],
            _ => {
                let parts = self.parts().into_iter();
                parts.flat_map(|(_, part)| part.filters(outer)).collect()
            }
        }
    }
}

/// How far a number may be off: `|got - expected| <= max(relative_tolerance |expected|, absolute_tolerance)`.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Tolerance {
    /// As a share of what is expected.
    pub relative: Option<f64>,
    /// In the unit of what is expected.
    pub absolute: Option<f64>,
}

impl Tolerance {
    /// How far a value may be from what is expected, in its own unit; nothing where no tolerance is given.
    pub fn allowed(&self, expected: f64) -> f64 {
        let relative = self.relative.map(|share| share * expected.abs());
        relative.into_iter().chain(self.absolute).fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

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
}
