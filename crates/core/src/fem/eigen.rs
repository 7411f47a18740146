//! The lowest modes of `K x = lambda M x`.
//!
//! Knows K symmetric positive semidefinite and M symmetric positive semidefinite. Does not know what vibrates.

use super::inertia::ShiftedFactor;
use super::lanczos::{BlockLanczos, Ritz, SymmetricOperator};
use super::probe::{diagonal, largest, sizes};
use super::{Factor, FemError, SymmetricMatrix, go_on};
use crate::stop::Stop;
use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, MatMut, Par};
use std::ops::Range;

/// Modes in rising order of eigenvalue.
#[derive(Debug, Clone)]
pub struct EigenPairs {
    /// Eigenvalues lambda `[1/s^2 where K and M are a stiffness and a mass]`.
    pub lambda: Vec<f64>,
    /// Shapes, a column each, `x^T M x = 1`.
    pub shapes: Mat<f64>,
}

/// Residual `|A y - mu y| / mu` at which a pair has converged; its eigenvalue is then exact to the square of it.
const CONVERGED: f64 = 1e-9;

/// Residual that rounding leaves of an operator of norm 1: no pair is asked for more.
pub(super) const ROUNDING: f64 = 1e-14;

/// How far above rounding and the eigensolver's own limits a pair's errors may be.
const PAIR_MARGIN: f64 = 100.0;

/// Pairs that converge beyond those asked for, so that a gap can be found above the last.
const GUARD: usize = 2;

/// Relative distance of neighbouring eigenvalues from which a shift between them tells them apart.
pub(super) const GAP: f64 = 1e-6;

/// Inverse eigenvalues `mu = s / (lambda + s)` below this belong to a mass that is not there.
pub(super) const MASSLESS: f64 = 1e-13;

impl EigenPairs {
    /// Measures each pair of `K x = lambda M x` against K and M themselves and refuses the set where one is off; gives the
    /// largest error as a share of what is allowed.
    ///
    /// With `mu = s / (lambda + s)`, D^2 the diagonal of `K + s M` and `|x|^2 = x^T D^2 x / (lambda + s)`, the errors
    ///
    /// - residual, `|D^-1 (K x - lambda M x)| / sqrt(lambda + s)`, in which [`lowest_modes`] converges,
    /// - eigenvalue, `|x^T K x - lambda| / (lambda + s)`,
    /// - orthonormality, the entries of `X^T M X - I` up to the pair's column
    ///
    /// may each be `100 (1e-9 + 1e-14 / mu + eps |x|^2)`: where a pair has converged, the rounding of the operator that was
    /// solved and that of the products taken here, each a hundred times. The last counts where a shape hardly strains plates
    /// that are stiff: |x|^2 is how much the energies of its parts exceed that of the whole. Found on the bridges of
    /// `studies/bridges` is a three-hundredth of it or less. Verified by `tests/solvers/probe.rs`.
    ///
    /// # Errors
    /// [`FemError::BadPair`].
    pub fn probe(&self, k: &SymmetricMatrix, m: &SymmetricMatrix, s: f64) -> Result<f64, FemError> {
        self.probe_of(0..self.lambda.len(), k, m, s)
    }

    /// The probe of some pairs, against all up to the last of them.
    pub(super) fn probe_of(
        &self,
        pairs: Range<usize>,
        k: &SymmetricMatrix,
        m: &SymmetricMatrix,
        s: f64,
    ) -> Result<f64, FemError> {
        let (dofs, first, count) = (k.order(), pairs.start, pairs.len());
        let probed = self.shapes.as_ref().subcols(first, count);
        let product = |a: &SymmetricMatrix| {
            let mut ax = Mat::<f64>::zeros(dofs, count);
            a.multiply_columns(probed, ax.as_mut());
            ax
        };
        let (kx, mx) = (product(k), product(m));
        let sizes = sizes(diagonal(k).zip(diagonal(m)).map(|(k, m)| k + s * m));
        let mut gram = Mat::<f64>::zeros(pairs.end, count);
        let shapes_t = self.shapes.as_ref().subcols(0, pairs.end).transpose();
        matmul(gram.as_mut(), Accum::Replace, shapes_t, mx.as_ref(), 1.0, Par::Seq);
        let mut share: f64 = 0.0;
        for (j, lambda) in self.lambda[pairs.clone()].iter().enumerate() {
            let (mut left, mut energy, mut parts) = (0.0, 0.0, 0.0);
            for (i, size) in sizes.iter().enumerate() {
                let (x, kx) = (probed[(i, j)], kx[(i, j)]);
                left += ((kx - lambda * mx[(i, j)]) / size).powi(2);
                energy += x * kx;
                parts += (x * size).powi(2);
            }
            let scale = lambda + s;
            let unit = |i: usize| if i == first + j { 1.0 } else { 0.0 };
            let allowed = PAIR_MARGIN * (CONVERGED + ROUNDING * scale / s + f64::EPSILON * parts / scale);
            for (measure, found) in [
                ("residual", (left / scale).sqrt()),
                ("eigenvalue", (energy - lambda).abs() / scale),
                (
                    "orthonormality",
                    largest((0..=first + j).map(|i| gram[(i, j)] - unit(i))),
                ),
            ] {
                let holds = found <= allowed;
                if !holds {
                    return Err(FemError::BadPair {
                        mode: first + j + 1,
                        dofs,
                        measure,
                        found,
                        allowed,
                    });
                }
                share = share.max(found / allowed);
            }
        }
        Ok(share)
    }
}

/// The `count` lowest modes by shift-invert block Lanczos: with `K + s M = L L^T`, the largest eigenvalues of
/// `A = s L^-1 M L^-T` are `mu = s / (lambda + s)`. A shift `s > 0` admits a K that is singular (a body floating free);
/// it should be of the size of the lowest non-zero eigenvalue.
///
/// That no mode is missed, however many lie close together, is checked by Sylvester's law of inertia: `K - sigma M`
/// must have as many negative pivots as modes were found below sigma. Where it has more, the search goes on with fresh
/// directions. Verified by `tests/analytic/fem_eigen.rs`.
///
/// # Errors
/// [`FemError::Shift`], [`FemError::NotPositiveDefinite`] where `K + s M` is not, [`FemError::Eigen`] where not all
/// converge or M has fewer modes, [`FemError::BadFactor`] where the check finds no sigma at which it can count,
/// [`FemError::BadPair`] where a mode fails [`EigenPairs::probe`].
pub fn lowest_modes(k: &SymmetricMatrix, m: &SymmetricMatrix, count: usize, s: f64) -> Result<EigenPairs, FemError> {
    lowest_modes_unless(k, m, count, s, Stop::never())
}

/// [`lowest_modes`] unless a stop is asked for.
pub(crate) fn lowest_modes_unless(
    k: &SymmetricMatrix,
    m: &SymmetricMatrix,
    count: usize,
    s: f64,
    stop: Stop<'_>,
) -> Result<EigenPairs, FemError> {
    let n = k.order();
    if !(s.is_finite() && s > 0.0) {
        return Err(FemError::Shift { value: s });
    }
    let factor = Factor::new("K + s M of modes", &SymmetricMatrix::combine(&[(1.0, k), (s, m)])?)?;
    let operator = ShiftInvert { m, factor: &factor, s };
    let count = count.min(n);
    let (mu, mut shapes) = if is_small(n, count) {
        dense(&operator, count)?
    } else {
        krylov(k, &operator, count, stop)?
    };
    let modes = mu.iter().filter(|&&mu| mu > MASSLESS).count();
    if modes < count {
        return Err(FemError::Eigen {
            asked: count,
            converged: modes,
        });
    }
    factor.backward(shapes.as_mut());
    normalise(m, &mut shapes);
    let pairs = EigenPairs {
        lambda: mu.iter().map(|mu| s / mu - s).collect(),
        shapes,
    };
    pairs.probe(k, m, s)?;
    Ok(pairs)
}

/// Makes `x^T M x = 1` of each column.
pub(super) fn normalise(m: &SymmetricMatrix, shapes: &mut Mat<f64>) {
    let columns: Vec<Vec<f64>> = shapes.col_iter().map(|x| x.iter().copied().collect()).collect();
    let columns: Vec<&[f64]> = columns.iter().map(Vec::as_slice).collect();
    for (x, form) in shapes.col_iter_mut().zip(m.forms(&columns)) {
        let norm = form.sqrt();
        x.iter_mut().for_each(|x| *x /= norm);
    }
}

/// Whether all eigenvalues are computed at once.
pub(super) fn is_small(n: usize, count: usize) -> bool {
    n < 4 * count + 240
}

/// The largest eigenvalues of the operator, counted, and their vectors.
fn krylov(
    k: &SymmetricMatrix,
    operator: &ShiftInvert<'_>,
    count: usize,
    stop: Stop<'_>,
) -> Result<(Vec<f64>, Mat<f64>), FemError> {
    let most = 10 * count + 400;
    // a Ritz problem costs the cube of the basis: one after each growth by a seventh costs less than the growth
    let mut next = count + count / 4 + 8 * GUARD;
    let mut lanczos = BlockLanczos::new(operator);
    let mut converged = 0;
    while lanczos.size() < most && lanczos.can_grow() {
        while lanczos.size() < next && lanczos.can_grow() {
            go_on(stop)?;
            lanczos.grow();
        }
        next = lanczos.size() + lanczos.size() / 7;
        let ritz = lanczos.ritz().ok_or(FemError::Eigen {
            asked: count,
            converged: 0,
        })?;
        converged = leading_converged(&ritz);
        // a mass of low rank ends the search: nothing but zeros is left
        let exhausted = ritz.values[..converged].iter().any(|&mu| mu < MASSLESS);
        converged = ritz.values[..converged]
            .iter()
            .take_while(|&&mu| mu >= MASSLESS)
            .count();
        if converged < if exhausted { count } else { count + GUARD } {
            if exhausted {
                break;
            }
            continue;
        }
        let mut lambda: Vec<f64> = ritz.values[..converged]
            .iter()
            .map(|mu| operator.s / mu - operator.s)
            .collect();
        if exhausted {
            // there is none beyond the last, so any number will do for the next
            lambda.extend(lambda.last().map(|last| 2.0 * last + operator.s));
        }
        if complete(k, operator, &lambda, count)? {
            return Ok((ritz.values[..count].to_vec(), lanczos.vectors(&ritz, count)));
        }
        lanczos.widen();
    }
    Err(FemError::Eigen {
        asked: count,
        converged: converged.min(count),
    })
}

fn leading_converged(ritz: &Ritz) -> usize {
    let small = |(mu, residual): &(&f64, &f64)| **residual <= (CONVERGED * **mu).max(ROUNDING);
    ritz.values.iter().zip(&ritz.residuals).take_while(small).count()
}

/// Whether as many modes lie below a gap as were found there: above the last mode asked for, or, where that one lies
/// amid close neighbours, below them.
fn complete(k: &SymmetricMatrix, operator: &ShiftInvert<'_>, lambda: &[f64], count: usize) -> Result<bool, FemError> {
    let gap = |j: usize| (lambda[j] - lambda[j - 1]) / (lambda[j] + operator.s);
    let above = (count..lambda.len())
        .max_by(|&i, &j| gap(i).total_cmp(&gap(j)))
        .filter(|&j| gap(j) > GAP);
    let Some(found) = above.or_else(|| (1..count.min(lambda.len())).rev().find(|&j| gap(j) > GAP)) else {
        return Ok(true);
    };
    let mut failure = None;
    for share in [0.5, 0.3, 0.7] {
        let sigma = lambda[found - 1] + share * (lambda[found] - lambda[found - 1]);
        match ShiftedFactor::new(k, operator.m, sigma, operator.factor.order_of_factor()).map(|factor| factor.below()) {
            Ok(counted) if counted == found => return Ok(true),
            Ok(counted) if counted > found => return Ok(false),
            Ok(counted) => {
                failure = Some(FemError::Eigen {
                    asked: found,
                    converged: counted,
                })
            }
            Err(error) => failure = Some(error),
        }
    }
    failure.map_or(Ok(true), Err)
}

/// Small problems: all eigenvalues of the operator written out.
fn dense(operator: &ShiftInvert<'_>, count: usize) -> Result<(Vec<f64>, Mat<f64>), FemError> {
    let n = operator.order();
    let mut a = Mat::<f64>::identity(n, n);
    operator.apply(a.as_mut());
    let evd = a.self_adjoint_eigen(faer::Side::Lower).map_err(|_| FemError::Eigen {
        asked: count,
        converged: 0,
    })?;
    let mu = (0..count).map(|j| evd.S().column_vector()[n - 1 - j]).collect();
    Ok((mu, Mat::from_fn(n, count, |i, j| evd.U()[(i, n - 1 - j)])))
}

/// `s L^-1 P M P^T L^-T`.
#[derive(Debug)]
struct ShiftInvert<'a> {
    m: &'a SymmetricMatrix,
    factor: &'a Factor,
    s: f64,
}

impl SymmetricOperator for ShiftInvert<'_> {
    fn order(&self) -> usize {
        self.m.order()
    }

    fn apply(&self, mut x: MatMut<'_, f64>) {
        self.factor.backward(x.as_mut());
        let mut y = Mat::zeros(x.nrows(), x.ncols());
        self.m.multiply_columns(x.as_ref(), y.as_mut());
        self.factor.forward(y.as_mut());
        x.copy_from(faer::Scale(self.s) * &y);
    }
}
