//! Sparse Cholesky factorisation, probed.
//!
//! Knows how to solve with a symmetric positive definite matrix. Does not know where it comes from. Runs on one thread:
//! the library's parallel kernels give bits that depend on the number of threads.

use super::probe::{allowed, backward_error, diagonal, hold, sizes};
use super::{FemError, SymmetricMatrix};
use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::linalg::cholesky::llt::factor::LltError as Pivot;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky, supernodal::SupernodalLltRef,
};
use faer::{Conj, MatMut, Par, Side};
use std::sync::Arc;

/// `P A P^T = L L^T` of a symmetric positive definite matrix.
#[derive(Debug)]
pub struct Factor {
    symbolic: FactorOrder,
    values: Vec<f64>,
}

impl Factor {
    /// Factorises and probes; `name` is what an error calls the matrix.
    ///
    /// # Errors
    /// [`FemError::NotPositiveDefinite`], [`FemError::BadFactor`] as [`Factor::probe`], [`FemError::OutOfMemory`].
    pub fn new(name: &'static str, a: &SymmetricMatrix) -> Result<Self, FemError> {
        let factor = Self::unprobed(a)?;
        factor.probe(name, a)?;
        Ok(factor)
    }

    fn unprobed(a: &SymmetricMatrix) -> Result<Self, FemError> {
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
        Ok(Self { symbolic, values })
    }

    /// Solves one system with `a`, a matrix of its order; gives the backward error, the largest entry of `A x - b` over
    /// `|A| |x| + |b|` with each degree of freedom divided by the root of its diagonal entry, as a share of the
    /// `100 sqrt(n) eps` that are allowed.
    ///
    /// # Errors
    /// [`FemError::BadFactor`] where it is above: this is no factor of `a`.
    pub fn probe(&self, name: &'static str, a: &SymmetricMatrix) -> Result<f64, FemError> {
        let error = backward_error(a, &sizes(diagonal(a)), |x| self.solve(x));
        hold(name, a.order(), error, allowed(a.order()))
    }

    /// Its order and pattern.
    pub(super) fn order_of_factor(&self) -> &FactorOrder {
        &self.symbolic
    }

    /// Order of the matrix.
    pub fn order(&self) -> usize {
        self.symbolic.nrows()
    }

    /// `x := A^-1 x`.
    pub fn solve(&self, x: &mut [f64]) {
        let n = x.len();
        self.solve_columns(MatMut::from_column_major_slice_mut(x, n, 1));
    }

    /// `X := A^-1 X` for a block of columns.
    pub(crate) fn solve_columns(&self, x: MatMut<'_, f64>) {
        self.solve_columns_in(x, &mut SolveMemory::default());
    }

    /// [`Factor::solve_columns`] in memory that is kept for the next block.
    pub(crate) fn solve_columns_in(&self, x: MatMut<'_, f64>, memory: &mut SolveMemory) {
        let stack = memory.of(self.symbolic.solve_in_place_scratch::<f64>(x.ncols(), Par::Seq));
        LltRef::new(&self.symbolic, &self.values).solve_in_place_with_conj(Conj::No, x, Par::Seq, stack);
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

/// What a solution needs beside its columns, kept from one to the next: the kernel takes longer to hand out fresh memory for
/// a block of hundreds of columns than its products take.
#[derive(Default)]
pub(crate) struct SolveMemory(Option<(usize, MemBuffer)>);

impl SolveMemory {
    fn of(&mut self, needed: StackReq) -> &mut MemStack {
        let bytes = needed.size_bytes();
        let kept = self.0.take().filter(|(kept, _)| *kept >= bytes);
        let (_, memory) = self.0.insert(kept.unwrap_or_else(|| (bytes, MemBuffer::new(needed))));
        MemStack::new(memory)
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

/// The fill-reducing order and the pattern of the factor, in supernodal form for any order above 0. Matrices of one pattern
/// share it.
pub(super) type FactorOrder = Arc<SymbolicCholesky<usize>>;

/// Analyses the pattern of a matrix.
pub(super) fn analyse(a: &SymmetricMatrix) -> Result<FactorOrder, FemError> {
    let params = CholeskySymbolicParams {
        supernodal_flop_ratio_threshold: ALWAYS_SUPERNODAL,
        ..Default::default()
    };
    factorize_symbolic_cholesky(a.as_faer().symbolic(), Side::Lower, SymmetricOrdering::Amd, params)
        .map(Arc::new)
        .map_err(|_| FemError::OutOfMemory { dofs: a.order() })
}

#[cfg(test)]
#[allow(clippy::expect_used)]
mod tests {
    use super::*;

    /// A plate of springs, `n` x `n` places, each held softly; places count in units that differ by up to a thousand.
    fn plate(n: usize) -> SymmetricMatrix {
        let unit = |i: usize| 10_f64.powi((i % 4) as i32 - 1);
        let mut entries = Vec::new();
        for i in 0..n * n {
            entries.push((i, i, 1e-3 * unit(i).powi(2)));
            let neighbours = [(i % n + 1 < n, i + 1), (i + n < n * n, i + n)];
            for (_, j) in neighbours.into_iter().filter(|e| e.0) {
                let ends = [(i, unit(i)), (j, -unit(j))];
                entries.extend(ends.iter().flat_map(|a| ends.iter().map(|b| (a.0, b.0, a.1 * b.1))));
            }
        }
        SymmetricMatrix::from_entries(n * n, &entries).expect("a matrix")
    }

    /// 5 % off in any entry of a factor is refused. Entries that no solution reads (above the diagonal of a dense block) are
    /// told by just that.
    #[test]
    fn a_factor_with_one_wrong_entry_is_refused() {
        for n in [1, 2, 5, 12] {
            let a = plate(n);
            let mut factor = Factor::unprobed(&a).expect("a factor");
            assert!(factor.probe("plate", &a).expect("sound") < 0.01);
            let solution = |factor: &Factor| {
                let mut x: Vec<f64> = (0..n * n).map(|i| 1.0 + i as f64).collect();
                factor.solve(&mut x);
                x
            };
            let (sound, mut refused) = (solution(&factor), 0);
            for i in 0..factor.values.len() {
                let right = factor.values[i];
                factor.values[i] = 1.05 * right;
                match factor.probe("plate", &a) {
                    Err(FemError::BadFactor { name: "plate", .. }) => refused += 1,
                    other => assert_eq!(solution(&factor), sound, "entry {i}, {right:e}: {other:?}"),
                }
                factor.values[i] = right;
            }
            assert!(refused >= n * n, "{refused}");
        }
    }
}
