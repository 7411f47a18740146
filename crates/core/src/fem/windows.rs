//! More modes, window after window of the spectrum.
//!
//! Knows the lowest modes and finds those that follow. Does not know how many are wanted. The cost of a window hangs on the
//! modes in it and on the order of the matrices, so that the modes of a chain cost the square of its length, where one
//! search for all of them costs the cube.

use super::eigen::lowest_modes_unless;
use super::eigen::{EigenPairs, GAP, is_small, normalise};
use super::factor::FactorOrder;
use super::inertia::ShiftedFactor;
use super::lanczos::{BlockLanczos, Ritz, SymmetricOperator};
use super::{Factor, FemError, SymmetricMatrix, go_on};
use crate::stop::Stop;
use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, MatMut, MatRef, Par};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::Arc;

/// Modes up to which one search for all is cheaper than windows.
pub const ONE_SEARCH: usize = 128;

/// Modes that a window should have.
const WINDOW: usize = 96;

/// Fewest and most of them.
const FEWEST: usize = WINDOW / 2;
const MOST: usize = WINDOW * 3 / 2;

/// Residual of the operator at which a pair of a window has converged, over its value.
const CONVERGED: f64 = 1e-11;

/// Trials for the end of a window.
const TRIALS: usize = 24;

/// The modes of `K x = lambda M x` in rising order, as many as were searched for.
#[derive(Debug)]
pub struct ModeSearch<'a> {
    k: &'a SymmetricMatrix,
    m: &'a SymmetricMatrix,
    s: f64,
    stop: Stop<'a>,
    pairs: EigenPairs,
    /// Of large problems `K + s M`, and its factor.
    shifted: Option<Arc<(SymmetricMatrix, Factor)>>,
}

/// A window of the spectrum: modes between two numbers at which they were counted.
#[derive(Debug, Clone, Copy)]
struct Window {
    /// lambda of its ends, and how many modes lie below each.
    ends: [f64; 2],
    below: [usize; 2],
}

impl<'a> ModeSearch<'a> {
    /// The `count` lowest modes, as [`lowest_modes`](super::lowest_modes) finds them with the shift `s`.
    ///
    /// # Errors
    /// As [`lowest_modes`](super::lowest_modes), and [`FemError::Stopped`].
    pub fn new(
        k: &'a SymmetricMatrix,
        m: &'a SymmetricMatrix,
        count: usize,
        s: f64,
        stop: Stop<'a>,
    ) -> Result<Self, FemError> {
        Ok(Self {
            k,
            m,
            s,
            stop,
            pairs: lowest_modes_unless(k, m, count, s, stop)?,
            shifted: None,
        })
    }

    /// The modes found, none missed among them.
    pub fn pairs(&self) -> &EigenPairs {
        &self.pairs
    }

    /// Finds more modes: of a small problem twice as many, of a large one those of the next two windows. Verified by
    /// `tests/analytic/fem_eigen.rs`.
    ///
    /// # Errors
    /// As [`ModeSearch::new`].
    pub fn extend(&mut self) -> Result<(), FemError> {
        let (n, twice) = (self.k.order(), 2 * self.pairs.lambda.len());
        if twice <= ONE_SEARCH || is_small(n, twice) {
            self.pairs = lowest_modes_unless(self.k, self.m, twice.min(n), self.s, self.stop)?;
            return Ok(());
        }
        let shifted = self.shifted()?;
        let (c, factor) = (&shifted.0, &shifted.1);
        let first = self.window(self.begin()?, factor.order_of_factor())?;
        let second = self.window((first.ends[1], first.below[1]), factor.order_of_factor());
        let solve = |window: Window| {
            let (lambda, mut shapes) = self.solve(window, c, factor)?;
            factor.backward(shapes.as_mut());
            Ok((lambda, shapes))
        };
        // where no second one is found, the first has the last modes that there are
        let (found, more) = rayon::join(|| solve(first), || second.ok().map(solve));
        let found = std::iter::once(found).chain(more);
        self.append(first.below[0], found.collect::<Result<_, FemError>>()?)
    }

    /// `K + s M` and its factor, made when first needed.
    fn shifted(&mut self) -> Result<Arc<(SymmetricMatrix, Factor)>, FemError> {
        if let Some(shifted) = &self.shifted {
            return Ok(Arc::clone(shifted));
        }
        let c = SymmetricMatrix::combine(&[(1.0, self.k), (self.s, self.m)])?;
        let factor = Factor::new("K + s M of modes", &c)?;
        Ok(Arc::clone(self.shifted.insert(Arc::new((c, factor)))))
    }

    /// Where the next window begins: the widest gap among the last modes found, with the modes below it.
    fn begin(&self) -> Result<(f64, usize), FemError> {
        let lambda = &self.pairs.lambda;
        let gap = |j: usize| (lambda[j] - lambda[j - 1]) / (lambda[j] + self.s);
        let last = lambda.len().saturating_sub(FEWEST / 4).max(1)..lambda.len();
        let widest = last
            .max_by(|&i, &j| gap(i).total_cmp(&gap(j)))
            .filter(|&j| gap(j) > GAP);
        // amid close neighbours: the gap below them
        let widest = widest.or_else(|| (1..lambda.len()).rev().find(|&j| gap(j) > GAP));
        let none = FemError::Eigen {
            asked: lambda.len() + WINDOW,
            converged: lambda.len(),
        };
        let kept = widest.ok_or(none)?;
        Ok((0.5 * (lambda[kept - 1] + lambda[kept]), kept))
    }

    /// A window of a good number of modes.
    fn window(&self, (start, below): (f64, usize), order: &FactorOrder) -> Result<Window, FemError> {
        let lambda = &self.pairs.lambda;
        // the density of the last modes, in frequency
        let half = (below / 2).min(lambda.len() - 1);
        let root = |x: f64| x.max(0.0).sqrt();
        let mut width = WINDOW as f64 * (root(start) - root(lambda[half])) / (below - half).max(1) as f64;
        let (mut narrow, mut wide) = (0.0, f64::INFINITY);
        let mut failure = FemError::Eigen {
            asked: below + WINDOW,
            converged: below,
        };
        for _ in 0..TRIALS {
            go_on(self.stop)?;
            let end = (root(start) + width).powi(2);
            match ShiftedFactor::new(self.k, self.m, end, order) {
                Err(error) => {
                    failure = error;
                    width *= 1.01;
                    continue;
                }
                Ok(factor) => {
                    let count = factor.below();
                    let inside = count.saturating_sub(below);
                    if (FEWEST..=MOST).contains(&inside) || (count >= self.rank() && inside > 0) {
                        return Ok(Window {
                            ends: [start, end],
                            below: [below, count],
                        });
                    }
                    if inside > MOST {
                        wide = width;
                    } else {
                        narrow = width;
                    }
                    let guess = width * WINDOW as f64 / inside.max(8) as f64;
                    let bracketed = narrow < guess && guess < wide;
                    width = match (bracketed, wide.is_finite()) {
                        (true, _) => guess,
                        (false, true) => 0.5 * (narrow + wide),
                        (false, false) => 2.0 * width,
                    };
                }
            }
        }
        Err(failure)
    }

    /// Dofs with mass: no more modes than these.
    fn rank(&self) -> usize {
        super::probe::diagonal(self.m).filter(|m| *m > 0.0).count()
    }

    /// The modes of a window in rising order, each with its vector y of `s L^-1 M L^-T`.
    fn solve(&self, window: Window, c: &SymmetricMatrix, factor: &Factor) -> Result<(Vec<f64>, Mat<f64>), FemError> {
        let sigma = 0.5 * (window.ends[0] + window.ends[1]);
        let (sigma, shifted) = self.near(sigma, factor.order_of_factor())?;
        let operator = ShiftInverted {
            m: self.m,
            c,
            factor,
            shifted,
            sigma,
        };
        let count = window.below[1] - window.below[0];
        let mut lanczos = BlockLanczos::new(&operator);
        let mut next = 2 * count + 32;
        let most = 8 * count + 400;
        let mut converged = 0;
        while lanczos.size() < most && lanczos.can_grow() {
            while lanczos.size() < next && lanczos.can_grow() {
                go_on(self.stop)?;
                lanczos.grow();
            }
            next = lanczos.size() + lanczos.size() / 7;
            let Some(ritz) = lanczos.ritz() else {
                break;
            };
            let (all, inside) = operator.inside(&ritz, window.ends);
            converged = inside.len();
            if converged == count {
                let columns: Vec<usize> = inside.iter().map(|(_, j)| *j).collect();
                let lambda = inside.iter().map(|(lambda, _)| *lambda).collect();
                return Ok((lambda, lanczos.chosen(&ritz, &columns)));
            }
            // more copies of a value than the blocks have columns
            if converged == all {
                lanczos.widen();
            }
        }
        Err(FemError::Eigen {
            asked: window.below[1],
            converged: window.below[0] + converged,
        })
    }

    /// Sigma, or a number close by at which the pivots are good, with the factor there.
    fn near(&self, sigma: f64, order: &FactorOrder) -> Result<(f64, ShiftedFactor), FemError> {
        let mut last = None;
        for step in 0..8 {
            let sigma = sigma * (1.0 + 1e-3 * f64::from(step));
            match ShiftedFactor::new(self.k, self.m, sigma, order) {
                Ok(factor) => return Ok((sigma, factor)),
                Err(error) => last = Some(error),
            }
        }
        Err(last.unwrap_or(FemError::Shift { value: sigma }))
    }

    /// Puts the modes of windows behind the first `kept`, each free of what is left in it of those before.
    fn append(&mut self, kept: usize, found: Vec<(Vec<f64>, Mat<f64>)>) -> Result<(), FemError> {
        let all = kept + found.iter().map(|(lambda, _)| lambda.len()).sum::<usize>();
        let mut shapes = Mat::<f64>::zeros(self.k.order(), all);
        let old = self.pairs.shapes.as_ref().subcols(0, kept);
        shapes.as_mut().subcols_mut(0, kept).copy_from(old);
        self.pairs.lambda.truncate(kept);
        let mut windows = Vec::new();
        for (lambda, mut y) in found {
            let (before, new) = (self.pairs.lambda.len(), lambda.len());
            // a vector that is close to another in frequency holds a little of it
            let near = before.saturating_sub(MOST)..before;
            m_orthogonalise(self.m, shapes.as_ref().subcols(near.start, near.len()), y.as_mut());
            normalise(self.m, &mut y);
            shapes.as_mut().subcols_mut(before, new).copy_from(&y);
            self.pairs.lambda.extend(lambda);
            windows.push(before..before + new);
        }
        self.pairs.shapes = shapes;
        let probe = |window: Range<usize>| self.pairs.probe_of(window, self.k, self.m, self.s).map(|_| ());
        // the first failure is told, on any number of threads
        let probed: Vec<Result<(), FemError>> = windows.into_par_iter().with_max_len(1).map(probe).collect();
        probed.into_iter().collect()
    }
}

/// `Y := Y - X X^T M Y`.
fn m_orthogonalise(m: &SymmetricMatrix, x: MatRef<'_, f64>, y: MatMut<'_, f64>) {
    let mut my = Mat::<f64>::zeros(y.nrows(), y.ncols());
    m.multiply_columns(y.as_ref(), my.as_mut());
    let mut t = Mat::<f64>::zeros(x.ncols(), y.ncols());
    matmul(t.as_mut(), Accum::Replace, x.transpose(), my.as_ref(), 1.0, Par::Seq);
    matmul(y, Accum::Add, x, t.as_ref(), -1.0, Par::Seq);
}

/// `L^T (K - sigma M)^-1 M L^-T` with `K + s M = C = L L^T`: symmetric, with the vectors y of the operator of
/// [`lowest_modes`](super::lowest_modes) and the values `1 / (lambda - sigma)`. `L^T x = L^-1 C x`.
#[derive(Debug)]
struct ShiftInverted<'a> {
    m: &'a SymmetricMatrix,
    c: &'a SymmetricMatrix,
    factor: &'a Factor,
    shifted: ShiftedFactor,
    sigma: f64,
}

impl ShiftInverted<'_> {
    /// How many pairs lie between two numbers, and those of them that have converged, in rising order of lambda.
    fn inside(&self, ritz: &Ritz, [low, high]: [f64; 2]) -> (usize, Vec<(f64, usize)>) {
        let (mut all, mut inside) = (0, Vec::new());
        for (j, (theta, residual)) in ritz.values.iter().zip(&ritz.residuals).enumerate() {
            let lambda = self.sigma + 1.0 / theta;
            if low < lambda && lambda < high {
                all += 1;
                if *residual <= CONVERGED * theta.abs() {
                    inside.push((lambda, j));
                }
            }
        }
        inside.sort_by(|a, b| a.0.total_cmp(&b.0));
        (all, inside)
    }
}

impl SymmetricOperator for ShiftInverted<'_> {
    fn order(&self) -> usize {
        self.c.order()
    }

    fn apply(&self, mut x: MatMut<'_, f64>) {
        let mut y = Mat::zeros(x.nrows(), x.ncols());
        self.factor.backward(x.as_mut());
        self.m.multiply_columns(x.as_ref(), y.as_mut());
        self.shifted.solve_columns(y.as_mut());
        self.c.multiply_columns(y.as_ref(), x.as_mut());
        self.factor.forward(x.as_mut());
    }
}
