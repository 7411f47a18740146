//! Sparse Cholesky factorisation, probed.
//!
//! Knows how to solve with a symmetric positive definite matrix. Does not know where it comes from. Runs on one thread:
//! the library's parallel kernels give bits that depend on the number of threads.

use super::{FemError, SymmetricMatrix};
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltError as Pivot;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky, supernodal::SupernodalLltRef,
};
use faer::{Conj, MatMut, Par, Side};

/// `P A P^T = L L^T` of a symmetric positive definite matrix.
#[derive(Debug)]
pub struct Factor {
    symbolic: SymbolicCholesky<usize>,
    values: Vec<f64>,
}

/// Relative residual allowed in the probe solution, far above rounding (1e-16 times the fill) and far below what a
/// wrong factor leaves.
pub(super) const PROBE_ALLOWED: f64 = 1e-6;

impl Factor {
    /// Factorises and solves one probe.
    ///
    /// # Errors
    /// [`FemError::NotPositiveDefinite`], [`FemError::BadFactor`] where the probe's residual `|A x - b| / (|A| |x|)` is
    /// too large, [`FemError::OutOfMemory`].
    pub fn new(a: &SymmetricMatrix) -> Result<Self, FemError> {
        let dofs = a.order();
        let symbolic = analyse(a)?;
        let mut values = vec![0.0; symbolic.len_val()];
        let scratch = symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default());
        let mut memory = MemBuffer::try_new(scratch).map_err(|_| FemError::OutOfMemory { dofs })?;
        symbolic
            .factorize_numeric_llt(
                &mut values,
                a.as_faer(),
                Side::Lower,
                Default::default(),
                Par::Seq,
                MemStack::new(&mut memory),
                Default::default(),
            )
            .map_err(|Pivot::NonPositivePivot { index }| FemError::NotPositiveDefinite { dofs, pivot: index })?;
        let factor = Self { symbolic, values };
        let residual = probe(a, |x| factor.solve(x));
        if residual > PROBE_ALLOWED {
            return Err(FemError::BadFactor {
                dofs,
                residual,
                allowed: PROBE_ALLOWED,
            });
        }
        Ok(factor)
    }

    /// Order of the matrix.
    pub fn order(&self) -> usize {
        self.symbolic.nrows()
    }

    /// Entries of the factor.
    pub fn nnz(&self) -> usize {
        self.values.len()
    }

    /// `x := A^-1 x`.
    pub fn solve(&self, x: &mut [f64]) {
        let n = x.len();
        self.solve_columns(MatMut::from_column_major_slice_mut(x, n, 1));
    }

    /// `X := A^-1 X` for a block of columns.
    pub fn solve_columns(&self, x: MatMut<'_, f64>) {
        let mut memory = MemBuffer::new(self.symbolic.solve_in_place_scratch::<f64>(x.ncols(), Par::Seq));
        LltRef::new(&self.symbolic, &self.values).solve_in_place_with_conj(
            Conj::No,
            x,
            Par::Seq,
            MemStack::new(&mut memory),
        );
    }

    /// `X := L^-1 P X`.
    pub(super) fn forward(&self, mut x: MatMut<'_, f64>) {
        if let Some(perm) = self.symbolic.perm() {
            permute(x.as_mut(), perm.arrays().0);
        }
        self.half(x, false);
    }

    /// `X := P^T L^-T X`.
    pub(super) fn backward(&self, mut x: MatMut<'_, f64>) {
        self.half(x.as_mut(), true);
        if let Some(perm) = self.symbolic.perm() {
            permute(x, perm.arrays().1);
        }
    }

    fn half(&self, x: MatMut<'_, f64>, transpose: bool) {
        let mut memory = MemBuffer::new(self.symbolic.solve_in_place_scratch::<f64>(x.ncols(), Par::Seq));
        let stack = MemStack::new(&mut memory);
        match self.symbolic.raw() {
            SymbolicCholeskyRaw::Supernodal(symbolic) => {
                let l = SupernodalLltRef::new(symbolic, &self.values);
                if transpose {
                    l.l_transpose_solve_with_conj(Conj::No, x, Par::Seq, stack);
                } else {
                    l.l_solve_with_conj(Conj::No, x, Par::Seq, stack);
                }
            }
            SymbolicCholeskyRaw::Simplicial(_) => {} // of order 0
        }
    }
}

/// Row i of X becomes what row `from[i]` was.
fn permute(mut x: MatMut<'_, f64>, from: &[usize]) {
    let mut old = vec![0.0; x.nrows()];
    for j in 0..x.ncols() {
        old.iter_mut().enumerate().for_each(|(i, old)| *old = x[(i, j)]);
        from.iter().enumerate().for_each(|(i, &from)| x[(i, j)] = old[from]);
    }
}

/// Flops per entry of the factor above which it is supernodal. The library's own zero leaves out diagonal matrices,
/// which have none.
const ALWAYS_SUPERNODAL: SupernodalThreshold = SupernodalThreshold(-1.0);

/// The fill-reducing order and the pattern of the factor, in supernodal form for any order above 0.
pub(super) fn analyse(a: &SymmetricMatrix) -> Result<SymbolicCholesky<usize>, FemError> {
    let params = CholeskySymbolicParams {
        supernodal_flop_ratio_threshold: ALWAYS_SUPERNODAL,
        ..Default::default()
    };
    factorize_symbolic_cholesky(a.as_faer().symbolic(), Side::Lower, SymmetricOrdering::Amd, params)
        .map_err(|_| FemError::OutOfMemory { dofs: a.order() })
}

/// `|A x - b| / (|A| |x| + |b|)` in the largest norm for a right-hand side of ones and minus ones; infinite where x is
/// not finite.
pub(super) fn probe(a: &SymmetricMatrix, solve: impl FnOnce(&mut [f64])) -> f64 {
    let n = a.order();
    let b: Vec<f64> = (0..n).map(|i| if i % 3 == 1 { -1.0 } else { 1.0 }).collect();
    let mut x = b.clone();
    solve(&mut x);
    let mut ax = vec![0.0; n];
    a.multiply(&x, &mut ax);
    let row_sum = (0..n)
        .map(|j| a.column(j).map(|(_, v)| v.abs()).sum::<f64>())
        .fold(0.0, f64::max);
    let scale = row_sum * largest(&x) + 1.0;
    ax.iter_mut().zip(&b).for_each(|(ax, b)| *ax -= b);
    largest(&ax) / scale
}

/// The largest absolute value; infinite where one is not a number.
fn largest(v: &[f64]) -> f64 {
    v.iter()
        .fold(0.0, |m, x| if x.is_nan() { f64::INFINITY } else { m.max(x.abs()) })
}
