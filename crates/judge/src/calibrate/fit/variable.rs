//! The change of variable that takes the bounds away: x = lower + (upper - lower) (1 + sin u) / 2.
//!
//! Knows one parameter at a time. Does not know the model nor the search.

use std::f64::consts::TAU;

use super::{Bound, Parameter};

/// A start closer to a bound than this share of the width is moved to there: on the bound, cos(u) = 0.
const NUDGE_SHARE: f64 = 0.01;

/// `x`, moved inside if it lies on a bound or next to it.
pub(super) fn nudged(parameter: &Parameter, x: f64) -> f64 {
    let margin = NUDGE_SHARE * parameter.width();
    x.clamp(parameter.lower + margin, parameter.upper - margin)
}

/// The parameter at `u`, never outside its bounds.
pub(super) fn bounded(parameter: &Parameter, u: f64) -> f64 {
    let t = (1.0 + u.sin()) / 2.0;
    (parameter.lower + parameter.width() * t).clamp(parameter.lower, parameter.upper)
}

/// The `u` of `x`, on the branch around 2 pi: u is then of one size for all parameters, and never zero, so that the
/// optimiser's steps and tolerances, which are relative to it, are shares of the range.
pub(super) fn unbounded(parameter: &Parameter, x: f64) -> f64 {
    TAU + (2.0 * (x - parameter.lower) / parameter.width() - 1.0)
        .clamp(-1.0, 1.0)
        .asin()
}

/// The bound that `x` lies on, up to rounding.
pub(super) fn bound_at(parameter: &Parameter, x: f64) -> Option<Bound> {
    let slack = 1e-9 * parameter.width();
    if x - parameter.lower <= slack {
        Some(Bound::Lower)
    } else if parameter.upper - x <= slack {
        Some(Bound::Upper)
    } else {
        None
    }
}
