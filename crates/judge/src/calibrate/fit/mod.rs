//! Bounded nonlinear least squares: parameters between bounds, a model that answers with scaled residuals, the best
//! fit.
//!
//! Sought is the minimum of the sum of squares `sum_i r_i(x)^2`, `lower <= x <= upper`. The method is Levenberg and
//! Marquardt's as MINPACK has it (More 1978; crate `levenberg-marquardt`), in a variable `u` without bounds,
//!
//! ```text
//! x = lower + (upper - lower) t,    t = (1 + sin u) / 2,    dr/du = dr/dt cos(u) / 2
//! ```
//!
//! (MINUIT reference manual; lmfit, "Bounds Implementation"). All steps, differences and shares are of the width
//! between the bounds, so the bounds say what a large change of a parameter is. Derivatives are
//! formed by differences, all points of a Jacobian in one batch. No point outside the bounds is ever asked for, and
//! none twice.
//!
//! | module | charter |
//! |---|---|
//! | `input` | what is asked: parameters, settings, what is refused |
//! | `evaluation` | calls of the model: batches, counts, failures, differences |
//! | `variable` | the change of variable that takes the bounds away |
//! | `problem` | the optimiser's view of the model |
//! | `search` | from the start to the best point, parameters onto their bounds and off them |
//! | `statistics` | what the Jacobian at the best point says: standard errors, correlation, what is undetermined |
//!
//! Knows numbers. Does not know bridges, files, threads or the clock, and prints nothing: same input, same bits.

#[cfg(test)]
mod bound_tests;
mod evaluation;
#[cfg(test)]
mod failure_tests;
mod input;
mod problem;
mod search;
mod statistics;
#[cfg(test)]
mod tests;
mod variable;

use evaluation::ModelEvaluator;
pub use evaluation::{FailedPoint, Purpose};
pub use input::{Differences, FitError, ModelError, Parameter, Settings};
use problem::{PULL, outward_cosine};
use search::SearchResult;
pub use search::StopReason;
use statistics::FitStatistics;
pub use statistics::{Component, ErrorScale, ParameterDirection};

/// The model: a batch of points, each with one value a parameter, to as many answers, each with the scaled residuals
/// (measured less computed, over the standard deviation of the measurement) or why there are none.
pub type ModelFn<'a> = dyn Fn(&[Vec<f64>]) -> Vec<Result<Vec<f64>, ModelError>> + Sync + 'a;

/// A bound of a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bound {
    /// The least value.
    Lower,
    /// The largest value.
    Upper,
}

/// A parameter after the fit.
#[derive(Clone, Debug, PartialEq)]
pub struct FittedParameter {
    /// Name as given.
    pub name: String,
    /// Start as given.
    pub start: f64,
    /// Best value found.
    pub best: f64,
    /// Standard error; `None` if the parameter is held at a bound, is not determined within its bounds, or has no
    /// derivative.
    pub standard_error: Option<f64>,
    /// The bound it lies on. If the residuals push it there, the minimum is outside, and the statistics are those of
    /// the other parameters with this one held fixed.
    pub at_bound: Option<Bound>,
    /// False if the model failed on both sides of the best point: nothing is known of this parameter's influence.
    pub has_derivative: bool,
}

/// Outcome of a fit. All lists by parameter have the order of the parameters given.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit {
    /// The parameters.
    pub parameters: Vec<FittedParameter>,
    /// Residuals at the start.
    pub residuals_start: Vec<f64>,
    /// Residuals at the best point.
    pub residuals_best: Vec<f64>,
    /// Sum of the squared residuals at the start.
    pub sum_of_squares_start: f64,
    /// Sum of the squared residuals at the best point.
    pub sum_of_squares_best: f64,
    /// Points at which the model was asked.
    pub evaluations: usize,
    /// Why the search ended.
    pub ending: StopReason,
    /// Derivatives at the best point, `jacobian[residual][parameter]`, each in one over the unit of the parameter; zero
    /// for a parameter that has no derivative.
    pub jacobian: Vec<Vec<f64>>,
    /// Correlation of the parameters; `None` where one of the two has no standard error.
    pub correlation: Vec<Vec<Option<f64>>>,
    /// Variance that the standard errors are built on.
    pub error_scale: ErrorScale,
    /// Singular values of the Jacobian by parameters in widths between bounds, parameters held at a bound left out,
    /// descending.
    pub singular_values: Vec<f64>,
    /// Combinations of parameters that the residuals do not determine.
    pub undetermined: Vec<ParameterDirection>,
    /// Points at which the model failed, in the order asked for.
    pub failed: Vec<FailedPoint>,
}

/// Fits `parameters` so that the sum of squares of the residuals of `model` is least.
///
/// The best point is the best of all that the search tried: never worse than the start. Parameters close to a bound
/// are moved onto it if that is better. A point where the model fails inside the bounds is a step refused, listed in
/// the outcome.
///
/// # Errors
///
/// Parameters or settings out of range, and a model that fails at the start. Verified by `tests.rs` beside this file.
pub fn fit(parameters: &[Parameter], model: &ModelFn<'_>, settings: &Settings) -> Result<Fit, FitError> {
    input::check(parameters, settings)?;
    let mut evaluator = ModelEvaluator::new(parameters, model, settings);
    let found = search::search(&mut evaluator, settings)?;
    let at_bound: Vec<Option<Bound>> = parameters
        .iter()
        .zip(&found.best.point)
        .map(|(parameter, &x)| variable::bound_at(parameter, x))
        .collect();
    let free = free(parameters, &found, &at_bound);
    let columns: Vec<&[f64]> = free.iter().filter_map(|&k| found.columns[k].as_deref()).collect();
    let sum_of_squares_best = sum_of_squares(&found.best.residuals);
    let statistics = statistics::statistics(
        &columns,
        &free,
        found.best.residuals.len(),
        sum_of_squares_best,
        settings.undetermined_share,
    );
    let standard_errors = standard_errors(parameters, &free, &statistics);
    Ok(Fit {
        parameters: (0..parameters.len())
            .map(|k| FittedParameter {
                name: parameters[k].name.clone(),
                start: parameters[k].start,
                best: found.best.point[k],
                standard_error: standard_errors[k],
                at_bound: at_bound[k],
                has_derivative: found.columns[k].is_some(),
            })
            .collect(),
        jacobian: jacobian(parameters, &found),
        correlation: correlation(parameters.len(), &free, &statistics),
        sum_of_squares_start: sum_of_squares(&found.start.residuals),
        sum_of_squares_best,
        residuals_start: found.start.residuals,
        residuals_best: found.best.residuals,
        evaluations: evaluator.evaluations,
        ending: found.ending,
        error_scale: statistics.error_scale,
        singular_values: statistics.singular_values,
        undetermined: statistics.undetermined,
        failed: evaluator.failed,
    })
}

/// Lists the parameters that the statistics are of: those with a derivative that are not held at a bound.
fn free(parameters: &[Parameter], found: &SearchResult, at_bound: &[Option<Bound>]) -> Vec<usize> {
    // On a bound and pushed there: held fixed. On a bound with no push: free like any other.
    let is_held = |k: usize| {
        let (x, column) = (found.best.point[k], found.columns[k].as_deref());
        at_bound[k].is_some() && outward_cosine(&parameters[k], x, column, &found.best.residuals) > PULL
    };
    (0..parameters.len())
        .filter(|&k| found.columns[k].is_some() && !is_held(k))
        .collect()
}

/// Gives the standard errors of all parameters in their own units, from those of the free ones in widths between bounds.
fn standard_errors(parameters: &[Parameter], free: &[usize], statistics: &FitStatistics) -> Vec<Option<f64>> {
    let mut standard_errors = vec![None; parameters.len()];
    for (i, &k) in free.iter().enumerate() {
        standard_errors[k] = statistics.standard_errors[i].map(|error| error * parameters[k].width());
    }
    standard_errors
}

/// Gives the correlation of all `count` parameters from that of the free ones.
fn correlation(count: usize, free: &[usize], statistics: &FitStatistics) -> Vec<Vec<Option<f64>>> {
    let mut correlation = vec![vec![None; count]; count];
    for (i, &k) in free.iter().enumerate() {
        for (j, &l) in free.iter().enumerate() {
            correlation[k][l] = statistics.correlation[i][j];
        }
    }
    correlation
}

/// Gives [`Fit::jacobian`] from the columns by widths between bounds.
fn jacobian(parameters: &[Parameter], found: &SearchResult) -> Vec<Vec<f64>> {
    let slope = |row: usize, k: usize| {
        found.columns[k]
            .as_ref()
            .map_or(0.0, |c| c[row] / parameters[k].width())
    };
    (0..found.best.residuals.len())
        .map(|row| (0..parameters.len()).map(|k| slope(row, k)).collect())
        .collect()
}

/// Sum of the squares, in the order given.
fn sum_of_squares(residuals: &[f64]) -> f64 {
    residuals.iter().map(|r| r * r).sum()
}
