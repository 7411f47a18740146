//! A check of a trend: what a quantity does along an axis of the jobs.

use super::finding::{Finding, scale};
use super::kind::CheckKind;
use crate::quantity::{CheckInput, Evaluator, NoValue, Place, Quantity};
use pontoon_plan::input::filter::Filter;
use pontoon_plan::input::{Cell, FoundValue, Refusal, RefusalKind};
use pontoon_results::labels::as_written;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

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

impl TrendCheck {
    /// Values of the axis that the jobs of a filter have, rising; at least two.
    fn axis(&self, on: &Evaluator<'_>, filter: &Filter) -> Result<Vec<f64>, NoValue> {
        let jobs = on.results.jobs();
        let meant = on.jobs(filter);
        let along = meant.iter().map(|&row| jobs.number(&self.along, row));
        let along = along.collect::<Option<Vec<f64>>>();
        let mut axis = along.ok_or_else(|| NoValue::NoAxis(self.along.clone()))?;
        axis.sort_by(f64::total_cmp);
        axis.dedup();
        if axis.len() < 2 {
            return Err(NoValue::FewValues {
                values: axis.len(),
                along: self.along.clone(),
            });
        }
        Ok(axis)
    }

    /// How much is left, and whether the trend holds, of values along the axis.
    fn margin(&self, values: &[f64]) -> (f64, bool) {
        let (least, most) = (
            values.iter().copied().fold(f64::INFINITY, f64::min),
            values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        );
        let steps = |sign: f64| {
            let step = |w: &[f64]| sign * (w[1] - w[0]) / scale(w[0].abs().max(w[1].abs()));
            values.windows(2).map(step).fold(f64::INFINITY, f64::min)
        };
        let size = scale(least.abs().max(most.abs()));
        match self.trend {
            Trend::Rises => (steps(1.0), steps(1.0) > 0.0),
            Trend::Falls => (steps(-1.0), steps(-1.0) > 0.0),
            Trend::Positive => (least / size, least > 0.0),
            Trend::Negative => (-most / size, most < 0.0),
            Trend::Flat => {
                let margin = self.within.unwrap_or(0.0) - (most - least) / scale(least);
                (margin, margin >= 0.0)
            }
        }
    }
}

impl CheckKind for TrendCheck {
    fn refuse(&self, place: &Place<'_>) -> Result<(), Refusal> {
        match (self.trend, self.within) {
            (Trend::Flat, None) => {
                let allowed = "a share: the trend is flat within it";
                return Err(place.refuse("trend.within", FoundValue::NOTHING, allowed));
            }
            (Trend::Flat, Some(within)) if within < 0.0 => {
                return Err(place.refuse("trend.within", within, "a number of at least 0"));
            }
            (Trend::Flat, Some(_)) | (_, None) => {}
            (_, Some(within)) => {
                let refused = place.refuse("trend.within", within, "nothing, unless the trend is flat");
                return Err(refused.because(RefusalKind::Misplaced));
            }
        }
        place.quantity("trend.of", &self.of, Some(&self.along))
    }

    fn select(&self, input: &CheckInput<'_>) -> Result<(), Refusal> {
        input.number_column(&input.at("trend.along"), input.results.jobs(), &self.along)?;
        input.quantity("trend.of", &self.of)
    }

    fn evaluate(&self, on: &Evaluator<'_>, filter: &Filter) -> Result<Finding, NoValue> {
        let at = |x: f64| on.value(&self.of, &filter.fixed(&self.along, &Cell::Number(x)));
        let axis = self.axis(on, filter)?.into_iter();
        let values = axis.map(at).collect::<Result<Vec<f64>, NoValue>>()?;
        let (margin, holds) = self.margin(&values);
        Ok(Finding {
            values,
            margin: Some(margin),
            holds,
            ..Finding::default()
        })
    }

    fn expected(&self) -> (String, Option<f64>) {
        let what = match self.trend {
            Trend::Rises => "rises".to_owned(),
            Trend::Falls => "falls".to_owned(),
            Trend::Positive => "positive".to_owned(),
            Trend::Negative => "negative".to_owned(),
            Trend::Flat => format!("flat within {} %", as_written(100.0 * self.within.unwrap_or(0.0))),
        };
        (format!("{what} over {}", self.along), None)
    }
}
