//! What is asked of a fit: parameters, settings, and what of them is refused.
//!
//! Knows numbers and names. Does not know the model nor the method.

/// A parameter to be fitted, in the unit of its own.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Name, for errors and for the outcome.
    pub name: String,
    /// Where the search starts, `lower <= start <= upper`.
    pub start: f64,
    /// Least value that the model is asked for.
    pub lower: f64,
    /// Largest value that the model is asked for.
    pub upper: f64,
}

impl Parameter {
    /// Width between the bounds.
    pub(super) fn width(&self) -> f64 {
        self.upper - self.lower
    }

    /// The bound that `x` is closer to.
    pub(super) fn nearer_bound(&self, x: f64) -> f64 {
        if x - self.lower < self.upper - x {
            self.lower
        } else {
            self.upper
        }
    }

    /// How far `x` is from the bound that it is closer to, as a share of the width.
    pub(super) fn share_from_bound(&self, x: f64) -> f64 {
        (x - self.nearer_bound(x)).abs() / self.width()
    }
}

/// How derivatives are formed by differences.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Differences {
    /// One point a parameter, on the upper side where there is room and an answer, else on the lower; error of first
    /// order.
    Forward,
    /// Two points a parameter; error of second order; one-sided where a side has no room or no answer.
    Central,
}

/// What steers a fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Evaluations of the model after which no new batch is asked for, 1 or more. On top come points on the
    /// other side of failed differences and, at the end, parameters moved onto bounds and the Jacobian at the best
    /// point.
    pub evaluations_limit: usize,
    /// Step of the differences, as a share of the width between the bounds, above 0 and up to 0.25.
    pub difference_share: f64,
    /// How the differences are taken.
    pub differences: Differences,
    /// Relative change of the sum of squares, share of the range by which a step moves, and cosine between residuals
    /// and Jacobian columns, at which the search ends; from 1e-14 to 0.1.
    pub tolerance: f64,
    /// Singular values of the Jacobian below this share of the largest count as undetermined; above 0 and below 1.
    pub undetermined_share: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            evaluations_limit: 500,
            difference_share: 1e-3,
            differences: Differences::Forward,
            tolerance: 1e-6,
            undetermined_share: 1e-3,
        }
    }
}

/// Why the model has no residuals at a point.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct ModelError(pub String);

impl From<&str> for ModelError {
    fn from(reason: &str) -> Self {
        Self(reason.to_owned())
    }
}

/// Why there is no fit.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FitError {
    /// Nothing to fit.
    #[error("a fit needs at least one parameter")]
    NoParameters,
    /// Bounds that are not finite or not in order.
    #[error("parameter `{name}` has bounds {lower} to {upper}: finite numbers wanted, the lower below the upper")]
    Bounds {
        /// Name of the parameter.
        name: String,
        /// Its lower bound.
        lower: f64,
        /// Its upper bound.
        upper: f64,
    },
    /// A start that is not between the bounds.
    #[error("parameter `{name}` starts at {start}, outside its bounds {lower} to {upper}")]
    OutsideBounds {
        /// Name of the parameter.
        name: String,
        /// Its start.
        start: f64,
        /// Its lower bound.
        lower: f64,
        /// Its upper bound.
        upper: f64,
    },
    /// A setting out of its range.
    #[error("setting `{name}` is {found}, allowed is {least} to {most}")]
    Setting {
        /// Name of the setting.
        name: &'static str,
        /// Its value.
        found: f64,
        /// Least value allowed (not itself allowed where it is zero).
        least: f64,
        /// Largest value allowed.
        most: f64,
    },
    /// The model answers at the start with no residual.
    #[error("the model gives no residuals at the start")]
    NoResiduals,
    /// The model fails at the start, or at the point that a start on a bound is moved to.
    #[error("the model fails at the start {parameters:?}: {reason}")]
    Start {
        /// The point.
        parameters: Vec<f64>,
        /// What the model said.
        reason: String,
    },
}

/// Refuses parameters and settings out of range.
pub(super) fn check(parameters: &[Parameter], settings: &Settings) -> Result<(), FitError> {
    if parameters.is_empty() {
        return Err(FitError::NoParameters);
    }
    for Parameter {
        name,
        start,
        lower,
        upper,
    } in parameters
    {
        let (name, start, lower, upper) = (name.clone(), *start, *lower, *upper);
        if !(lower.is_finite() && upper.is_finite() && (upper - lower).is_finite() && lower < upper) {
            return Err(FitError::Bounds { name, lower, upper });
        }
        if !(lower..=upper).contains(&start) {
            return Err(FitError::OutsideBounds {
                name,
                start,
                lower,
                upper,
            });
        }
    }
    let ranges = [
        (
            "evaluations_limit",
            settings.evaluations_limit as f64,
            1.0,
            f64::INFINITY,
        ),
        ("difference_share", settings.difference_share, 0.0, 0.25),
        ("tolerance", settings.tolerance, 1e-14, 0.1),
        ("undetermined_share", settings.undetermined_share, 0.0, 1.0),
    ];
    for (name, found, least, most) in ranges {
        if !(least..=most).contains(&found) || found == 0.0 {
            return Err(FitError::Setting {
                name,
                found,
                least,
                most,
            });
        }
    }
    Ok(())
}
