//! One residual after each factorisation: whether what was made belongs to the matrix that it was made from.
//!
//! Knows matrices, solutions and what rounding may leave of them. Does not know how anything is factorised.
//!
//! All is measured with every degree of freedom divided by its size, the root of the matrix's diagonal: metres and radians,
//! stiff plates and soft water then count alike, and a matrix that is positive definite has no entry above 1.

use super::{FemError, SymmetricMatrix};

/// Backward error that a factorisation of order n may leave, `100 sqrt(n) eps`: what rounding adds up to by chance (Higham,
/// Mary: SIAM J. Sci. Comput. 41, 2019, A2815-A2835), a hundred times. Found on the bridges of `studies/bridges`, condensed
/// and full, are 1e-16 to 6e-16 at any order from 200 to 24,000: a seven-hundredth or less of what is allowed.
pub(crate) fn allowed(n: usize) -> f64 {
    100.0 * f64::EPSILON * (n as f64).sqrt()
}

/// How much more than that where pivots are not positive: chosen among few, they may be poor, and rounding grows by them. On
/// those bridges it does not; where it grows by more, eigenvalues are counted at another sigma.
pub(super) const INDEFINITE_GROWTH: f64 = 100.0;

/// Entry i of the probe: between 1/2 and 1 of either sign, without period and without clusters, after the two-dimensional
/// sequence of the plastic number.
pub(crate) fn pattern(i: usize) -> f64 {
    let place = |step: f64| ((i + 1) as f64 * step).fract();
    let value = 0.5 + 0.5 * place(0.754_877_666_246_692_7);
    if place(0.569_840_290_998_053_2) < 0.5 {
        value
    } else {
        -value
    }
}

/// The roots of a diagonal; 1 where it is not positive.
pub(crate) fn sizes(diagonal: impl Iterator<Item = f64>) -> Vec<f64> {
    diagonal.map(|d| if d > 0.0 { d.sqrt() } else { 1.0 }).collect()
}

/// The diagonal of a matrix.
pub(crate) fn diagonal(a: &SymmetricMatrix) -> impl Iterator<Item = f64> + '_ {
    (0..a.order()).map(|j| a.column(j).filter(|e| e.0 == j).map(|e| e.1).sum())
}

/// `|A' x' - b'| / (|A'| |x'| + |b'|)` in the largest norm, `A' = D^-1 A D^-1`, `x' = D x`, `b' = D^-1 b` with D the
/// `sizes`; infinite where x is not finite.
///
/// The right-hand side is `b' = A' p` with a fixed pattern p. So the solution is about p and each entry of A' counts as much
/// as it is large; under a load of ones it would be little more than the softest motion, in which a wrong entry among stiff
/// ones is not seen.
pub(super) fn backward_error(a: &SymmetricMatrix, sizes: &[f64], solve: impl FnOnce(&mut [f64])) -> f64 {
    let n = a.order();
    let given: Vec<f64> = (0..n).map(|i| pattern(i) / sizes[i]).collect();
    let mut b = vec![0.0; n];
    a.multiply(&given, &mut b);
    let mut x = b.clone();
    solve(&mut x);
    residual(a, sizes, &x, &b)
}

/// The probe of any x and b.
pub(crate) fn residual(a: &SymmetricMatrix, sizes: &[f64], x: &[f64], b: &[f64]) -> f64 {
    let n = a.order();
    let mut ax = vec![0.0; n];
    a.multiply(x, &mut ax);
    let row = |j: usize| a.column(j).map(|(i, v)| v.abs() / sizes[i]).sum::<f64>() / sizes[j];
    let norm = largest((0..n).map(row));
    let scale = norm * largest((0..n).map(|i| x[i] * sizes[i])) + largest((0..n).map(|i| b[i] / sizes[i]));
    let left = largest((0..n).map(|i| (ax[i] - b[i]) / sizes[i]));
    match left {
        0.0 => 0.0,
        left if scale.is_finite() => left / scale,
        _ => f64::INFINITY,
    }
}

/// The largest absolute value; infinite where one is not a number.
pub(super) fn largest(values: impl Iterator<Item = f64>) -> f64 {
    let more = |m: f64, x: f64| if x.is_nan() { f64::INFINITY } else { m.max(x.abs()) };
    values.fold(0.0, more)
}

/// Refuses a residual above what is allowed; gives its share of it.
pub(crate) fn hold(name: &'static str, dofs: usize, residual: f64, allowed: f64) -> Result<f64, FemError> {
    if residual <= allowed {
        // a matrix of order 0 leaves nothing and may leave nothing
        return Ok(residual / allowed.max(f64::MIN_POSITIVE));
    }
    Err(FemError::BadFactor {
        name,
        dofs,
        residual,
        allowed,
    })
}
