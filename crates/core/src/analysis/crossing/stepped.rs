//! An operator at the step lengths of a solver.
//!
//! Knows operators and step lengths. Does not know crossings.

use super::CrossingSettings;
use crate::operator::{BridgeOperator, StepConstants};
use std::sync::{Arc, OnceLock};

/// How often a whole crossing may be asked for at half the time step.
pub const REFINEMENTS: usize = 6;

/// An operator, and what each step length makes of it.
#[derive(Debug)]
pub(super) struct Stepped {
    operator: Arc<BridgeOperator>,
    settings: CrossingSettings,
    constants: Vec<OnceLock<StepConstants>>,
}

impl Stepped {
    /// An operator at one time step and its halves.
    pub(super) fn new(operator: Arc<BridgeOperator>, settings: &CrossingSettings) -> Self {
        Self {
            operator,
            settings: *settings,
            constants: (0..=settings.bisection_limit + REFINEMENTS)
                .map(|_| OnceLock::new())
                .collect(),
        }
    }

    pub(super) fn operator(&self) -> &BridgeOperator {
        &self.operator
    }

    /// Step lengths that there may be.
    pub(super) fn levels(&self) -> usize {
        self.constants.len()
    }

    /// The time step after some halvings `[s]`.
    pub(super) fn time_step_s(&self, halvings: usize) -> f64 {
        self.settings.time_step_s / (1_u64 << halvings) as f64
    }

    pub(super) fn constants(&self, halvings: usize) -> &StepConstants {
        self.constants[halvings].get_or_init(|| {
            let CrossingSettings {
                spectral_radius,
                rayleigh,
                ..
            } = self.settings;
            StepConstants::new(&self.operator, self.time_step_s(halvings), spectral_radius, rayleigh)
        })
    }
}
