//! What a check finds in one case.
//!
//! Knows margins and deviations. Does not know the kinds of checks.

use crate::quantity::Tolerance;
use pontoon_results::labels::as_written;

/// What a check finds in one case.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct Finding {
    /// One value, or one for each step of a trend.
    pub(crate) values: Vec<f64>,
    /// How far it is off, as a share of what is expected.
    pub(crate) deviation: Option<f64>,
    /// How much is left, as a share.
    pub(crate) margin: Option<f64>,
    /// Whether it holds.
    pub(crate) holds: bool,
    /// What else is to be said.
    pub(crate) reason: Option<String>,
}

impl Finding {
    /// A value of which nothing is expected.
    pub(super) fn of(got: f64) -> Self {
        Self {
            values: vec![got],
            holds: true,
            ..Self::default()
        }
    }

    /// A value held against what is expected: `|got - expected|` within a tolerance.
    pub(super) fn held(got: f64, expected: f64, tolerance: Tolerance) -> Self {
        let (off, allowed) = (got - expected, tolerance.allowed(expected));
        let margin = (allowed - off.abs()) / scale(expected);
        Self {
            values: vec![got],
            deviation: Some(off / scale(expected)),
            margin: (tolerance != Tolerance::default()).then_some(margin),
            holds: off.abs() <= allowed,
            reason: None,
        }
    }
}

/// What a share is taken of; a share of nothing is taken in the unit itself.
pub(super) fn scale(x: f64) -> f64 {
    if x == 0.0 { 1.0 } else { x.abs() }
}

/// A value with its tolerance, as a person wrote them: `0.141 +- 2 %`.
pub(super) fn with_tolerance(value: f64, tolerance: Tolerance) -> String {
    format!("{}{}", as_written(value), tolerance_text(tolerance))
}

/// A tolerance behind its value: ` +- 2 % or +- 3`.
pub(super) fn tolerance_text(tolerance: Tolerance) -> String {
    let relative = tolerance
        .relative
        .map(|share| format!(" +- {} %", as_written(100.0 * share)));
    let absolute = tolerance.absolute.map(|x| format!(" +- {}", as_written(x)));
    relative.into_iter().chain(absolute).collect::<Vec<_>>().join(" or")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tolerance(relative: Option<f64>, absolute: Option<f64>) -> Tolerance {
        Tolerance { relative, absolute }
    }

    #[test]
    fn a_margin_is_what_the_tolerance_leaves() {
        let within = Finding::held(1.02, 1.0, tolerance(Some(0.05), None));
        assert!(within.holds && (within.margin.unwrap() - 0.03).abs() < 1e-12);
        let beyond = Finding::held(0.94, 1.0, tolerance(Some(0.05), None));
        assert!(!beyond.holds && (beyond.margin.unwrap() + 0.01).abs() < 1e-12);
        assert!((beyond.deviation.unwrap() + 0.06).abs() < 1e-12);
        // a share of the magnitude: what is expected below zero has the same room
        assert!(Finding::held(-1.04, -1.0, tolerance(Some(0.05), None)).holds);
        // on the edge it holds still
        assert!(Finding::held(1.5, 1.0, tolerance(None, Some(0.5))).holds);
    }

    #[test]
    fn the_wider_tolerance_counts_and_nothing_is_expected_in_its_own_unit() {
        assert!(Finding::held(1.04, 1.0, tolerance(Some(0.01), Some(0.05))).holds);
        assert!(Finding::held(1.04, 1.0, tolerance(Some(0.05), Some(0.01))).holds);
        let of_nothing = Finding::held(0.02, 0.0, tolerance(Some(0.5), Some(0.03)));
        assert!(of_nothing.holds && (of_nothing.margin.unwrap() - 0.01).abs() < 1e-12);
        assert!(!Finding::held(1e-9, 0.0, tolerance(Some(0.5), None)).holds);
    }

    #[test]
    fn without_a_tolerance_there_is_no_margin() {
        let record = Finding::held(1.3, 1.0, Tolerance::default());
        assert!(record.margin.is_none() && (record.deviation.unwrap() - 0.3).abs() < 1e-12);
    }
}
