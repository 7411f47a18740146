//! A check of a measured value: a quantity lies within its uncertainty.

use super::finding::{Finding, with_tolerance};
use super::kind::{CheckKind, Expectation, OneValue};
use crate::quantity::{CheckInput, Evaluator, NoValue, Place, Quantity, Tolerance};
use pontoon_plan::input::Refusal;
use pontoon_plan::input::filter::Filter;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

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

impl MeasuredCheck {
    fn band(&self) -> Tolerance {
        Tolerance {
            relative: None,
            absolute: Some(self.uncertainty),
        }
    }
}

impl CheckKind for MeasuredCheck {
    fn refuse(&self, place: &Place<'_>) -> Result<(), Refusal> {
        if self.uncertainty < 0.0 {
            return Err(place.refuse("measured.uncertainty", self.uncertainty, "a number of at least 0"));
        }
        place.quantity("measured.of", &self.of, None)
    }

    fn select(&self, input: &CheckInput<'_>) -> Result<(), Refusal> {
        input.quantity("measured.of", &self.of)
    }

    fn evaluate(&self, on: &Evaluator<'_>, filter: &Filter) -> Result<Finding, NoValue> {
        Ok(Finding::held(on.value(&self.of, filter)?, self.value, self.band()))
    }

    fn expected(&self) -> (String, Option<f64>) {
        (with_tolerance(self.value, self.band()), Some(self.value))
    }

    fn one_value(&self) -> Option<OneValue> {
        Some(OneValue {
            of: self.of.clone(),
            expected: Some(self.value),
            tolerance: self.uncertainty,
        })
    }

    fn expectation(&self) -> Expectation<'_> {
        Expectation::of_quantity(&self.of, self.value, true)
    }
}
