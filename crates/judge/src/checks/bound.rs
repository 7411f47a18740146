//! A check of bounds: a quantity keeps within them.

use super::finding::{Finding, scale};
use super::kind::CheckKind;
use crate::quantity::{CheckInput, Evaluator, NoValue, Place, Quantity};
use pontoon_plan::input::filter::Filter;
use pontoon_plan::input::{Refusal, RefusalKind};
use pontoon_results::labels::as_written;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

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

impl BoundCheck {
    /// The lower bound, whether it is allowed itself or not.
    fn lower(&self) -> Option<f64> {
        self.at_least.or(self.above)
    }

    /// The upper bound, whether it is allowed itself or not.
    fn upper(&self) -> Option<f64> {
        self.at_most.or(self.below)
    }

    /// Refuses no bound, bounds that nothing is within, and two of one side.
    fn refuse_bounds(&self, place: &Place<'_>) -> Result<(), Refusal> {
        match (self.lower(), self.upper()) {
            (None, None) => {
                let allowed = "at_least, above, at_most, below, one or two of them";
                return Err(place.refuse("bound", "no bound", allowed).because(RefusalKind::Missing));
            }
            (Some(least), Some(most)) if least > most => {
                let key = if self.at_least.is_some() {
                    "bound.at_least"
                } else {
                    "bound.above"
                };
                let refused = place.refuse(key, least, &format!("at most the upper bound, {most}"));
                return Err(refused.because(RefusalKind::Conflict));
            }
            _ => {}
        }
        for (first, second, names) in [
            (self.at_least, self.above, "at_least and above"),
            (self.at_most, self.below, "at_most and below"),
        ] {
            if first.is_some() && second.is_some() {
                let refused = place.refuse("bound", names, "one of the two");
                return Err(refused.because(RefusalKind::Misplaced));
            }
        }
        Ok(())
    }
}

impl CheckKind for BoundCheck {
    fn refuse(&self, place: &Place<'_>) -> Result<(), Refusal> {
        self.refuse_bounds(place)?;
        place.quantity("bound.of", &self.of, None)
    }

    fn select(&self, input: &CheckInput<'_>) -> Result<(), Refusal> {
        input.quantity("bound.of", &self.of)
    }

    fn evaluate(&self, on: &Evaluator<'_>, filter: &Filter) -> Result<Finding, NoValue> {
        let got = on.value(&self.of, filter)?;
        let lower = self.lower().map(|bound| (got - bound) / scale(bound));
        let upper = self.upper().map(|bound| (bound - got) / scale(bound));
        let margin = lower.into_iter().chain(upper).fold(f64::INFINITY, f64::min);
        let holds = self.at_least.is_none_or(|bound| got >= bound)
            && self.above.is_none_or(|bound| got > bound)
            && self.at_most.is_none_or(|bound| got <= bound)
            && self.below.is_none_or(|bound| got < bound);
        Ok(Finding {
            values: vec![got],
            margin: Some(margin),
            holds,
            ..Finding::default()
        })
    }

    fn expected(&self) -> (String, Option<f64>) {
        let bounds = [
            (">=", self.at_least),
            (">", self.above),
            ("<=", self.at_most),
            ("<", self.below),
        ];
        let given = bounds
            .iter()
            .filter_map(|(sign, x)| x.map(|x| format!("{sign} {}", as_written(x))));
        (given.collect::<Vec<_>>().join(", "), None)
    }
}
