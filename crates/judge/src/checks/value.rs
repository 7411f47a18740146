//! A check of a value: `|of - expected|` is within a tolerance.

use super::finding::{Finding, with_tolerance};
use super::kind::{CheckKind, Expectation, OneValue};
use crate::quantity::{CheckInput, Evaluator, NoValue, Place, Quantity, Tolerance};
use pontoon_plan::input::filter::Filter;
use pontoon_plan::input::{FoundValue, Refusal};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

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

impl ValueCheck {
    fn tolerance(&self) -> Tolerance {
        Tolerance {
            relative: self.relative_tolerance,
            absolute: self.absolute_tolerance,
        }
    }
}

impl CheckKind for ValueCheck {
    fn refuse(&self, place: &Place<'_>) -> Result<(), Refusal> {
        if place.decides && self.expected.is_none() {
            return Err(place.refuse(
                "value.expected",
                FoundValue::NOTHING,
                "a number; only a record needs none",
            ));
        }
        place.tolerance("value", self.tolerance())?;
        place.quantity("value.of", &self.of, None)
    }

    fn select(&self, input: &CheckInput<'_>) -> Result<(), Refusal> {
        input.quantity("value.of", &self.of)
    }

    fn evaluate(&self, on: &Evaluator<'_>, filter: &Filter) -> Result<Finding, NoValue> {
        let got = on.value(&self.of, filter)?;
        Ok(match self.expected {
            Some(expected) => Finding::held(got, expected, self.tolerance()),
            None => Finding::of(got),
        })
    }

    fn expected(&self) -> (String, Option<f64>) {
        match self.expected {
            Some(expected) => (with_tolerance(expected, self.tolerance()), Some(expected)),
            None => ("-".to_owned(), None),
        }
    }

    fn one_value(&self) -> Option<OneValue> {
        Some(OneValue {
            of: self.of.clone(),
            expected: self.expected,
            tolerance: self.expected.map_or(0.0, |expected| self.tolerance().allowed(expected)),
        })
    }

    fn expectation(&self) -> Expectation<'_> {
        match self.expected {
            Some(expected) => Expectation::of_quantity(&self.of, expected, false),
            None => Expectation::None,
        }
    }
}
