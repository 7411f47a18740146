//! A factor of `K - sigma M`, which is not positive definite, and how many eigenvalues lie below sigma.
//!
//! Knows Sylvester's law of inertia. Does not know eigenvectors.

use super::factor::{FactorOrder, analyse};
use super::probe::{INDEFINITE_GROWTH, allowed, backward_error, diagonal, hold, sizes};
use super::{FemError, SymmetricMatrix};
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::perm::PermRef;
use faer::sparse::linalg::cholesky::supernodal::SupernodalIntranodeLbltRef;
use faer::sparse::linalg::cholesky::{IntranodeLbltRef, SymbolicCholesky, SymbolicCholeskyRaw};
use faer::{Conj, MatMut, Par, Side};
use std::sync::Arc;

/// `P (K - sigma M) P^T = L B L^T`, B of blocks of one or two. The pivots are chosen within supernodes, so a probe tells
/// whether they were good.
#[derive(Debug)]
pub(super) struct ShiftedFactor {
    symbolic: Arc<SymbolicCholesky<usize>>,
    values: Vec<f64>,
    below_diagonal: Vec<f64>,
    /// The order of the pivots and its inverse.
    orders: [Vec<usize>; 2],
}

impl ShiftedFactor {
    /// Factorises and probes; `order` is that of a factor of `K + s M`, whose pattern is the same at any s.
    ///
    /// # Errors
    /// [`FemError::BadFactor`] where sigma is so close to an eigenvalue that the factor is useless,
    /// [`FemError::OutOfMemory`].
    pub(super) fn new(
        k: &SymmetricMatrix,
        m: &SymmetricMatrix,
        sigma: f64,
        order: &FactorOrder,
    ) -> Result<Self, FemError> {
        let a = SymmetricMatrix::combine(&[(1.0, k), (-sigma, m)])?;
        let (n, symbolic) = (a.order(), Arc::clone(order));
        let mut values = vec![0.0; symbolic.len_val()];
        let (mut below_diagonal, mut forward, mut inverse) = (vec![0.0; n], vec![0; n], vec![0; n]);
        let scratch = symbolic.factorize_numeric_intranode_lblt_scratch::<f64>(Par::Seq, Default::default());
        let mut memory = MemBuffer::try_new(scratch).map_err(|_| FemError::OutOfMemory { dofs: n })?;
        symbolic.factorize_numeric_intranode_lblt(
            &mut values,
            &mut below_diagonal,
            &mut forward,
            &mut inverse,
            a.as_faer(),
            Side::Lower,
            Par::Seq,
            MemStack::new(&mut memory),
            Default::default(),
        );
        let factor = Self {
            symbolic,
            values,
            below_diagonal,
            orders: [forward, inverse],
        };
        // a diagonal of differences may be anything; no entry is larger than the root of these
        let sizes = sizes(diagonal(k).zip(diagonal(m)).map(|(k, m)| k + sigma.abs() * m));
        let solve = |x: &mut [f64]| factor.solve_columns(MatMut::from_column_major_slice_mut(x, n, 1));
        let residual = backward_error(&a, &sizes, solve);
        hold("K - sigma M", n, residual, INDEFINITE_GROWTH * allowed(n))?;
        Ok(factor)
    }

    fn order_of_pivots(&self) -> PermRef<'_, usize> {
        PermRef::new_checked(&self.orders[0], &self.orders[1], self.orders[0].len())
    }

    /// `X := (K - sigma M)^-1 X` for a block of columns.
    pub(super) fn solve_columns(&self, x: MatMut<'_, f64>) {
        let mut memory = MemBuffer::new(self.symbolic.solve_in_place_scratch::<f64>(x.ncols(), Par::Seq));
        let pivots = self.order_of_pivots();
        let factor = IntranodeLbltRef::new(&self.symbolic, &self.values, &self.below_diagonal, pivots);
        factor.solve_in_place_with_conj(Conj::No, x, Par::Seq, MemStack::new(&mut memory));
    }

    /// Number of eigenvalues of `K x = lambda M x` below sigma: the negative eigenvalues of B (Bathe: Finite Element
    /// Procedures, 1996, section 11.4.3).
    pub(super) fn below(&self) -> usize {
        let SymbolicCholeskyRaw::Supernodal(supernodes) = self.symbolic.raw() else {
            return 0; // of order 0
        };
        let (below_diagonal, pivots) = (&self.below_diagonal, self.order_of_pivots());
        let factor = SupernodalIntranodeLbltRef::new(supernodes, &self.values, below_diagonal, pivots);
        let mut negative = 0;
        for s in 0..supernodes.n_supernodes() {
            let node = factor.supernode(s);
            let (b, start) = (node.val(), node.start());
            let mut i = 0;
            while i < b.ncols() {
                let c = below_diagonal[start + i];
                if c == 0.0 {
                    negative += usize::from(b[(i, i)] < 0.0);
                    i += 1;
                } else {
                    let (p, q) = (b[(i, i)], b[(i + 1, i + 1)]);
                    negative += match p * q - c * c {
                        det if det < 0.0 => 1,
                        _ if p + q < 0.0 => 2,
                        _ => 0,
                    };
                    i += 2;
                }
            }
        }
        negative
    }
}

/// Number of eigenvalues of `K x = lambda M x` below `sigma`, M positive semidefinite.
///
/// # Errors
/// [`FemError::BadFactor`] where sigma is so close to an eigenvalue that its factor is useless,
/// [`FemError::OutOfMemory`].
pub fn count_below(k: &SymmetricMatrix, m: &SymmetricMatrix, sigma: f64) -> Result<usize, FemError> {
    let order = analyse(&SymmetricMatrix::combine(&[(1.0, k), (-sigma, m)])?)?;
    Ok(ShiftedFactor::new(k, m, sigma, &order)?.below())
}
