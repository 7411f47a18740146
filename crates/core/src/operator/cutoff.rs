//! How many modes an operator needs.
//!
//! Knows the dynamic part of what the modes leave out, at connectors and deck. Does not know crossings.

use crate::fem::EigenPairs;
use faer::Mat;
use std::f64::consts::PI;

/// Forces up to this frequency are what the stated error is about `[Hz]`: ten times the band in which the bridge heaves and
/// rolls, the pace at which contacts open and close.
const REFERENCE_HZ: f64 = 5.0;

/// What an operator left out and how much it matters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cutoff {
    /// Modes kept.
    pub modes: usize,
    /// Frequency of the highest one `[Hz]`.
    pub frequency_hz: f64,
    /// Error asked for.
    pub tolerance: f64,
    /// Largest `omega^2 D / F` over connectors and deck nodes at 5 Hz: F the whole flexibility of a row, D the
    /// part `r K^-1 M K^-1 r^T - sum of phi^2 / omega_k^4` by which the residual flexibility would answer otherwise than
    /// statically.
    pub error: f64,
}

/// The rows by which the cut-off is judged: their modal values and their whole flexibilities.
pub(super) struct CutoffJudge {
    /// `r K^-1 r^T` of each row.
    pub flexibility: Vec<f64>,
    /// `r K^-1 M K^-1 r^T` of each row.
    pub dynamic: Vec<f64>,
    /// `r Phi`, rows x modes.
    pub shapes: Mat<f64>,
}

impl CutoffJudge {
    /// The fewest of the pairs whose error is within `tolerance`; none where all are not enough. `shift` is that of the
    /// flexibilities.
    /// Equation (O5).
    pub(super) fn fewest(&self, pairs: &EigenPairs, shift: f64, tolerance: f64) -> Result<Cutoff, Cutoff> {
        let omega2 = (2.0 * PI * REFERENCE_HZ).powi(2);
        let mut left = self.dynamic.clone();
        let mut cutoff = Cutoff {
            modes: 0,
            frequency_hz: 0.0,
            tolerance,
            error: f64::INFINITY,
        };
        for (k, lambda) in pairs.lambda.iter().enumerate() {
            for (i, d) in left.iter_mut().enumerate() {
                *d -= (self.shapes[(i, k)] / (lambda + shift)).powi(2);
            }
            let of_each = left.iter().zip(&self.flexibility).map(|(d, f)| omega2 * d.max(0.0) / f);
            cutoff.modes = k + 1;
            cutoff.frequency_hz = lambda.max(0.0).sqrt() / (2.0 * PI);
            cutoff.error = of_each.fold(0.0, f64::max);
            if cutoff.error <= tolerance {
                return Ok(cutoff);
            }
        }
        Err(cutoff)
    }
}

#[cfg(test)]
#[allow(clippy::expect_used)]
mod tests {
    use super::*;
    use crate::fem::{SymmetricMatrix, lowest_modes};
    use nalgebra::{DMatrix, DVector};

    /// The error stated against what it stands for, by other means: a chain of masses on springs and ground, its answer to a
    /// unit force at 5 Hz by a dense solution of `K - omega^2 M`, less that of the modes kept and less the static answer of
    /// the rest. The error is the first term of a series in `omega^2 / lambda` of the modes left out, of which all are
    /// positive: the ratio lies between 1 and `1 / (1 - omega^2 / lambda)` of the first of them, here 1.01. Twin: an error
    /// 5 % larger.
    #[test]
    fn error_is_the_dynamic_part_of_what_is_left_out() {
        let (n, spring, ground) = (30, 6e5, 2e3);
        let mass = |i: usize| 20.0 + 3.0 * (i % 4) as f64;
        let mut k = DMatrix::<f64>::from_diagonal_element(n, n, ground);
        for i in 1..n {
            for (a, b, sign) in [(i, i, 1.0), (i - 1, i - 1, 1.0), (i, i - 1, -1.0), (i - 1, i, -1.0)] {
                k[(a, b)] += sign * spring;
            }
        }
        let m = DMatrix::from_diagonal(&DVector::from_fn(n, |i, _| mass(i)));
        let sparse = |a: &DMatrix<f64>| {
            let entries: Vec<_> = (0..n)
                .flat_map(|j| (0..n).map(move |i| (i, j)))
                .map(|(i, j)| (i, j, a[(i, j)]))
                .collect();
            SymmetricMatrix::from_entries(n, &entries).expect("a matrix")
        };
        let inverse = k.clone().try_inverse().expect("grounded");
        let pairs = lowest_modes(&sparse(&k), &sparse(&m), n, 1.0).expect("modes");
        let judge = CutoffJudge {
            flexibility: (0..n).map(|i| inverse[(i, i)]).collect(),
            dynamic: (0..n)
                .map(|i| (0..n).map(|j| mass(j) * inverse[(j, i)].powi(2)).sum())
                .collect(),
            shapes: pairs.shapes.clone(),
        };
        let cutoff = judge.fewest(&pairs, 0.0, 5e-5).expect("enough modes");
        assert!(cutoff.error <= cutoff.tolerance && cutoff.modes < n, "{cutoff:?}");

        let omega2 = (2.0 * PI * REFERENCE_HZ).powi(2);
        let harmonic = (&k - omega2 * &m).try_inverse().expect("no resonance at 5 Hz");
        let exact = |kept: usize| {
            let of_row = |i: usize| {
                let of_modes = |by: f64| {
                    (0..kept)
                        .map(|p| pairs.shapes[(i, p)].powi(2) / (pairs.lambda[p] - by))
                        .sum::<f64>()
                };
                let left_out = harmonic[(i, i)] - of_modes(omega2);
                let at_rest = inverse[(i, i)] - of_modes(0.0);
                (left_out - at_rest) / inverse[(i, i)]
            };
            (0..n).map(of_row).fold(0.0, f64::max)
        };
        let most = 1.0 / (1.0 - omega2 / pairs.lambda[cutoff.modes]);
        let within = |error: f64| (1.0..=most).contains(&(exact(cutoff.modes) / error));
        assert!(
            most < 1.05 && within(cutoff.error),
            "{cutoff:?}, {:e}",
            exact(cutoff.modes)
        );
        assert!(!within(1.05 * cutoff.error), "an error 5 % larger passes");
        assert!(exact(cutoff.modes - 1) > cutoff.tolerance, "one mode fewer would do");
    }
}
