//! Exponentials from samples of a kernel: the eigensystem realisation of its Hankel matrix.
//!
//! Knows symmetric matrices at equal steps of time. Does not know what they are samples of.

use super::exponentials::Exponentials;
use faer::diag::DiagRef;
use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, MatRef, Par, Side, c64};
use nalgebra::DMatrix;
use std::f64::consts::SQRT_2;
use thiserror::Error;

/// Distance of two eigenvalues of the step, which are at most about 1, that are one; of a real one from its conjugate.
const ONE_EIGENVALUE: f64 = 1e-6;

/// How far from conjugate two shapes may be.
const CONJUGATE: f64 = 1e-4;

/// Why samples have no exponentials.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum HankelError {
    /// There are fewer than four samples: the Hankel matrix and its shifted one need them.
    #[error("{found} samples of the kernel, at least 4 are needed")]
    Samples {
        /// How many there are.
        found: usize,
    },
    /// An eigenvalue problem of this order did not converge.
    #[error("the eigenvalues of a matrix of order {order} were not found")]
    Eigen {
        /// The matrix's order.
        order: usize,
    },
    /// An exponential has no residue of the form c c^T.
    #[error("one of {states} exponentials has no symmetric residue")]
    Defective {
        /// How many there are.
        states: usize,
    },
}

/// The exponentials of samples `k(i dt_s)`, symmetric n x n.
///
/// The block Hankel matrix H0, of blocks `k((i + j) dt)` with i, j below `m = (count - 1) / 2`, is symmetric: `H0 = U L U^T`. Its
/// eigenvalues of at least `tolerance` times the largest are kept. With H1 of blocks `k((i + j + 1) dt)` the step is
/// `A_d = |L|^(-1/2) U^T H1 U |L|^(-1/2) sgn L = T diag(mu) T^-1`; then `s = ln(mu) / dt`, and with the first block row U_1 of U
/// the shapes are the columns of `U_1 |L|^(1/2) T`, of residue c c^T where `T^T sgn(L) T = I`. Source: J.-N. Juang and R. S.
/// Pappa, An eigensystem realization algorithm for modal parameter identification and model reduction (1985).
pub(super) fn exponentials(samples: &[DMatrix<f64>], dt_s: f64, tolerance: f64) -> Result<Exponentials, HankelError> {
    let found = samples.len();
    let (blocks, n) = match samples.first() {
        Some(first) if found >= 4 => ((found - 1) / 2, first.nrows()),
        _ => return Err(HankelError::Samples { found }),
    };
    let order = blocks * n;
    let hankel = |shift: usize| Mat::from_fn(order, order, |i, j| samples[i / n + j / n + shift][(i % n, j % n)]);
    let eigen = hankel(0)
        .self_adjoint_eigen(Side::Lower)
        .map_err(|_| HankelError::Eigen { order })?;
    let (values, vectors) = (eigen.S(), eigen.U());
    let size = |i: &usize| values[*i].abs();
    let largest = (0..order).map(|i| size(&i)).fold(0.0, f64::max);
    let mut kept: Vec<usize> = (0..order).filter(|i| size(i) > tolerance * largest).collect();
    kept.sort_by(|i, j| size(j).total_cmp(&size(i)));
    let states = kept.len();
    if states == 0 {
        return Ok(Exponentials {
            poles_1_s: Vec::new(),
            shapes: DMatrix::zeros(n, 0),
        });
    }
    let roots: Vec<f64> = kept.iter().map(|i| size(i).sqrt()).collect();
    let signs: Vec<f64> = kept.iter().map(|&i| values[i].signum()).collect();
    let u = Mat::from_fn(order, states, |i, j| vectors[(i, kept[j])]);
    let moved = product(hankel(1).as_ref(), u.as_ref());
    let inner = product(u.transpose(), moved.as_ref());
    // as a complex matrix: of a real one the solver loses the vectors of pairs that are equal
    let step = Mat::from_fn(states, states, |i, j| {
        c64::new(inner[(i, j)] / (roots[i] * roots[j]) * signs[j], 0.0)
    });
    let eigen = step.eigen().map_err(|_| HankelError::Eigen { order: states })?;
    let t = conjugate_directions(eigen.U(), eigen.S(), &signs).ok_or(HankelError::Defective { states })?;
    let left = Mat::from_fn(n, states, |i, j| c64::new(u[(i, j)] * roots[j], 0.0));
    let shapes = &left * &t;
    let kept: Vec<usize> = (0..states).filter(|&i| eigen.S()[i].im > -ONE_EIGENVALUE).collect();
    let is_pair = |i: usize| eigen.S()[i].im >= ONE_EIGENVALUE;
    let pole = |&i: &usize| {
        let mu = eigen.S()[i];
        let im = if is_pair(i) { mu.im } else { 0.0 };
        c64::new(libm::log(libm::hypot(mu.re, im)), libm::atan2(im, mu.re)) / dt_s
    };
    // a pair stands once, and Re (2 c c^T e^(s t)) is both
    let weight = |i: usize| if is_pair(i) { SQRT_2 } else { 1.0 };
    Ok(Exponentials {
        poles_1_s: kept.iter().map(pole).collect(),
        shapes: DMatrix::from_fn(n, kept.len(), |row, i| shapes[(row, kept[i])] * weight(kept[i])),
    })
}

/// Eigenvectors with `T^T sgn(L) T = I`. Those of eigenvalues that differ are conjugate under sgn(L), because A_d sgn(L) is
/// symmetric; those of one eigenvalue are made so one after the other. None where that fails.
fn conjugate_directions(vectors: MatRef<'_, c64>, values: DiagRef<'_, c64>, signs: &[f64]) -> Option<Mat<c64>> {
    let mut t = vectors.to_owned();
    let form = |t: &Mat<c64>, i: usize, j: usize| -> c64 {
        signs
            .iter()
            .enumerate()
            .map(|(row, &sign)| t[(row, i)] * t[(row, j)] * sign)
            .sum()
    };
    for i in 0..signs.len() {
        for j in (0..i).filter(|&j| (values[i] - values[j]).norm() < ONE_EIGENVALUE) {
            let along = form(&t, j, i);
            for row in 0..signs.len() {
                let step = t[(row, j)] * along;
                t[(row, i)] -= step;
            }
        }
        let factor = form(&t, i, i).sqrt().inv();
        if !(factor.re.is_finite() && factor.im.is_finite()) {
            return None;
        }
        for row in 0..signs.len() {
            t[(row, i)] *= factor;
        }
    }
    let pairs = (0..signs.len()).flat_map(|i| (0..i).map(move |j| (i, j)));
    let worst = pairs.map(|(i, j)| form(&t, i, j).norm()).fold(0.0, f64::max);
    (worst < CONJUGATE).then_some(t)
}

fn product(a: MatRef<'_, f64>, b: MatRef<'_, f64>) -> Mat<f64> {
    let mut product = Mat::zeros(a.nrows(), b.ncols());
    matmul(product.as_mut(), Accum::Replace, a, b, 1.0, Par::Seq);
    product
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_exponential_is_one_state() {
        let shape = DMatrix::from_column_slice(2, 1, &[3.0, -1.0]);
        let samples: Vec<_> = (0..60)
            .map(|i| &shape * shape.transpose() * (-1.2 * 0.1 * f64::from(i)).exp())
            .collect();
        let found = exponentials(&samples, 0.1, 1e-9).unwrap();
        assert_eq!(found.poles_1_s.len(), 1);
        assert!((found.poles_1_s[0] + 1.2).norm() < 1e-10);
        let c = &found.shapes;
        assert!((c[(0, 0)] * c[(0, 0)] - 9.0).norm() < 1e-9 && (c[(0, 0)] * c[(1, 0)] + 3.0).norm() < 1e-9);
    }

    #[test]
    fn pairs_and_negative_residues_are_found() {
        // 4 e^-t cos(3 t + 0.5) - 2 e^-0.4t in one freedom: a pair and a real pole of negative residue
        let errors = |decay: f64| {
            let k = |t: f64| 4.0 * (-t).exp() * (3.0 * t + 0.5).cos() - 2.0 * (-decay * t).exp();
            let samples: Vec<_> = (0..80)
                .map(|i| DMatrix::from_element(1, 1, k(0.1 * f64::from(i))))
                .collect();
            let found = exponentials(&samples, 0.1, 1e-10).unwrap();
            assert_eq!(found.poles_1_s.len(), 2);
            let states = found.poles_1_s.iter().zip(found.shapes.iter());
            let error = states.map(|(&s, &c)| {
                let (pole, residue) = if s.im > 1.0 {
                    (c64::new(-1.0, 3.0), c64::new(0.5_f64.cos(), 0.5_f64.sin()) * 4.0)
                } else {
                    (c64::new(-0.4, 0.0), c64::new(-2.0, 0.0))
                };
                (s - pole).norm() + (c * c - residue).norm()
            });
            error.fold(0.0, f64::max)
        };
        assert!(errors(0.4) < 1e-7, "{}", errors(0.4));
        assert!(errors(0.4 * 1.05) > 1e-2);
    }

    #[test]
    fn equal_freedoms_have_equal_poles_and_their_own_shapes() {
        let k = |t: f64| 4.0 * (-t).exp() * (3.0 * t + 0.5).cos() - 2.0 * (-0.4 * t).exp();
        let mix = DMatrix::from_row_slice(3, 3, &[2.0, 0.5, 0.1, 0.5, 1.0, 0.3, 0.1, 0.3, 2.0]);
        let samples: Vec<_> = (0..80).map(|i| &mix * k(0.1 * f64::from(i))).collect();
        let found = exponentials(&samples, 0.1, 1e-9).unwrap();
        assert_eq!(found.poles_1_s.len(), 6);
        for t in [0.0, 0.33, 2.0] {
            let error = |factor: f64| {
                let mut sum = &mix * (-factor * k(t));
                for (s, c) in found.poles_1_s.iter().zip(found.shapes.column_iter()) {
                    sum += (c * c.transpose() * (s * t).exp()).map(|x| x.re);
                }
                sum.amax()
            };
            assert!(error(1.0) < 1e-6, "{t}: {}", error(1.0));
            assert!(error(1.05) > 1e-3);
        }
    }

    #[test]
    fn nothing_has_no_states_and_too_little_is_refused() {
        let zero = vec![DMatrix::zeros(2, 2); 10];
        assert!(exponentials(&zero, 0.1, 1e-2).unwrap().poles_1_s.is_empty());
        assert_eq!(
            exponentials(&zero[..3], 0.1, 1e-2).unwrap_err(),
            HankelError::Samples { found: 3 }
        );
    }
}
