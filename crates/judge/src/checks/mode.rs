//! A check of a natural frequency by the name of its shape.

use super::finding::{Finding, with_tolerance};
use super::kind::{CheckKind, Expectation, OneValue};
use crate::quantity::{CheckInput, Evaluator, NoValue, Place, Quantity, Reduction, SelectQuantity, Tolerance};
use pontoon_plan::input::filter::{Allowed, Filter};
use pontoon_plan::input::{Cell, Refusal};
use pontoon_results::TableName;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

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

impl ModeCheck {
    fn tolerance(&self) -> Tolerance {
        Tolerance {
            relative: self.relative_tolerance,
            absolute: None,
        }
    }

    fn of_shape(&self) -> Allowed {
        Allowed::one(&Cell::from(self.shape.as_str()))
    }

    /// The frequency that it looks at.
    fn frequency(&self) -> Quantity {
        Quantity::Select(SelectQuantity {
            table: TableName::Modes,
            column: "frequency_hz".to_owned(),
            filter: Filter(vec![("shape".to_owned(), self.of_shape())]),
            reduce: Reduction::Only,
        })
    }
}

impl CheckKind for ModeCheck {
    fn refuse(&self, place: &Place<'_>) -> Result<(), Refusal> {
        if self.expected_hz.is_nan() || self.expected_hz <= 0.0 {
            return Err(place.refuse("mode.expected_hz", self.expected_hz, "a number above 0"));
        }
        place.tolerance("mode", self.tolerance())
    }

    fn select(&self, input: &CheckInput<'_>) -> Result<(), Refusal> {
        let modes = input.table(&input.at("mode"), TableName::Modes)?;
        input.allowed(&input.at("mode.shape"), Some(modes), "shape", &self.of_shape())?;
        input.filters(&input.at("mode"), &Filter::default(), Some(modes))
    }

    fn evaluate(&self, on: &Evaluator<'_>, filter: &Filter) -> Result<Finding, NoValue> {
        let got = on.value(&self.frequency(), filter)?;
        Ok(Finding::held(got, self.expected_hz, self.tolerance()))
    }

    fn expected(&self) -> (String, Option<f64>) {
        let text = with_tolerance(self.expected_hz, self.tolerance());
        (text, Some(self.expected_hz))
    }

    fn one_value(&self) -> Option<OneValue> {
        Some(OneValue {
            of: self.frequency(),
            expected: Some(self.expected_hz),
            tolerance: self.tolerance().allowed(self.expected_hz),
        })
    }

    fn expectation(&self) -> Expectation<'_> {
        Expectation::Mode {
            shape: &self.shape,
            frequency_hz: self.expected_hz,
        }
    }
}
