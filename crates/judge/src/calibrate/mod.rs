//! Identifying a bridge's numbers from checks.
//!
//! | module | charter |
//! |---|---|
//! | `parameters` | the file that names what may move, between which bounds, and what is fitted |
//! | `candidate` | a point of the parameters made into a bridge |
//! | `model` | candidates to residuals: only the jobs that the checks need, all candidates together |
//! | `outcome` | what a fit comes to, and the bridge with its provenance |
//! | [`fit`] | bounded least squares: numbers alone |
//!
//! Knows studies, references and bridges. Does not know how an outcome is written down.

mod candidate;
pub mod fit;
mod model;
mod outcome;
mod parameters;
mod quantities;

pub use outcome::{Calibration, FittedCheck, Identified};
pub use parameters::{Parameters, ParametersSpec};

use crate::reference::Reference;
use candidate::Candidate;
use fit::{FitError, Parameter};
use model::CalibrationModel;
use pontoon_plan::input::Refusal;
use pontoon_plan::study_file::BridgeFile;
use pontoon_study::run::{PoolError, on_threads};
use thiserror::Error;

/// Why there is no fit.
#[derive(Debug, Error)]
pub enum CalibrateError {
    /// The input is refused.
    #[error(transparent)]
    Refused(#[from] Refusal),
    /// The bridge that the search starts from, or the one next to it that lies off the bounds, gives no residuals.
    #[error("the bridge to start from fails, at {at}: {reason}")]
    Start {
        /// The parameters.
        at: String,
        /// What failed.
        reason: String,
    },
    /// The fit could not begin.
    #[error(transparent)]
    Fit(FitError),
    /// No pool of threads.
    #[error(transparent)]
    Pool(#[from] PoolError),
}

/// A calibration whose input has been checked as far as can be without computing anything.
pub struct CalibrationTask<'a> {
    bridge: &'a BridgeFile,
    parameters: &'a Parameters,
    starts: Vec<Parameter>,
    model: CalibrationModel<'a>,
}

impl<'a> CalibrationTask<'a> {
    /// The fit of the parameters of a bridge to the checks of references. `told` is told of each batch: candidates so
    /// far, the least sum of squares among them.
    ///
    /// # Errors
    /// [`Refusal`].
    pub fn new(
        bridge: &'a BridgeFile,
        references: &'a [Reference],
        parameters: &'a Parameters,
        told: &'a (dyn Fn(usize, f64) + Sync),
    ) -> Result<Self, Refusal> {
        Ok(Self {
            bridge,
            parameters,
            starts: parameters.starts(bridge)?,
            model: CalibrationModel::new(bridge, references, parameters, told)?,
        })
    }

    /// Fits on `threads` threads (0: as many as the machine has).
    ///
    /// # Errors
    /// [`CalibrateError`]; it is the input that is refused where the bridge to start from names what cannot be.
    pub fn fit(&self, threads: usize) -> Result<Calibration, CalibrateError> {
        let residuals = |points: &[Vec<f64>]| self.model.residuals(points);
        let fitted = on_threads(threads, || {
            fit::fit(&self.starts, &residuals, self.parameters.settings())
        })?;
        let fitted = fitted.map_err(|error| self.explained(error))?;
        let best: Vec<f64> = fitted.parameters.iter().map(|p| p.best).collect();
        let best = Candidate::new(self.parameters, self.bridge, &best)?;
        Ok(outcome::calibration(&self.model, fitted, best))
    }

    fn explained(&self, error: FitError) -> CalibrateError {
        match error {
            FitError::Start { parameters, reason } => match self.model.refused_at_start() {
                Some(refusal) => refusal.into(),
                None => CalibrateError::Start {
                    at: self.parameters.point(&parameters),
                    reason,
                },
            },
            other => CalibrateError::Fit(other),
        }
    }
}
