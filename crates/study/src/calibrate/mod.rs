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

pub use outcome::{Calibration, FittedCheck, Identified};
pub use parameters::{Parameters, ParametersSpec};

use crate::reference::Reference;
use crate::refusal::Refusal;
use crate::spec::BridgeFile;
use fit::FitError;
use model::Model;
use thiserror::Error;

/// Why there is no fit.
#[derive(Debug, Error)]
pub enum CalibrateError {
    /// The input is refused.
    #[error(transparent)]
    Refused(#[from] Refusal),
    /// The fit could not begin.
    #[error(transparent)]
    Fit(#[from] FitError),
    /// No pool of threads.
    #[error("no pool of threads: {0}")]
    Pool(#[from] rayon::ThreadPoolBuildError),
}

/// Fits the parameters of a bridge to the checks of references on `threads` threads (0: as many as the machine has). `told`
/// is told of each batch: candidates so far, the least sum of squares among them.
///
/// # Errors
/// [`CalibrateError`].
pub fn calibrate(
    bridge: &BridgeFile,
    references: &[Reference],
    parameters: &Parameters,
    threads: usize,
    told: &(dyn Fn(usize, f64) + Sync),
) -> Result<Calibration, CalibrateError> {
    let starts = parameters.starts(bridge)?;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
    let model = Model::new(bridge, references, parameters, told)?;
    let fitted = pool.install(|| fit::fit(&starts, &|points| model.residuals(points), &parameters.settings()));
    if let Some(refusal) = model.refusal() {
        return Err(refusal.into());
    }
    let fitted = fitted?;
    let best: Vec<f64> = fitted.parameters.iter().map(|p| p.best).collect();
    Ok(outcome::calibration(
        &model,
        fitted,
        parameters.candidate(bridge, &best)?,
    ))
}
