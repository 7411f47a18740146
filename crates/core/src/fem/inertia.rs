//! How many eigenvalues lie below a number, without computing any.
//!
//! Knows Sylvester's law of inertia. Does not know eigenvectors.

use super::factor::analyse;
use super::probe::{INDEFINITE_GROWTH, allowed, backward_error, diagonal, hold, sizes};
use super::{FemError, SymmetricMatrix};
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::linalg::cholesky::supernodal::SupernodalIntranodeLbltRef;
use faer::sparse::linalg::cholesky::{IntranodeLbltRef, SymbolicCholeskyRaw};
use faer::{Conj, MatMut, Par, Side};

/// Number of eigenvalues of `K x = lambda M x` below `sigma`, M positive semidefinite: the negative eigenvalues of the
/// blocks of B in `P (K - sigma M) P^T = L B L^T` (Bathe: Finite Element Procedures, 1996, section 11.4.3). The pivots
/// are chosen within supernodes, so a probe tells whether they were good.
///
/// # Errors
/// [`FemError::BadFactor`] where sigma is so close to an eigenvalue that the factor is useless,
/// [`FemError::OutOfMemory`].
pub fn count_below(k: &SymmetricMatrix, m: &SymmetricMatrix, sigma: f64) -> Result<usize, FemError> {
    let a = SymmetricMatrix::combine(&[(1.0, k), (-sigma, m)])?;
    let n = a.order();
    let symbolic = analyse(&a)?;
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
    let perm = faer::perm::PermRef::new_checked(&forward, &inverse, n);
    // a diagonal of differences may be anything; no entry is larger than the root of these
    let sizes = sizes(diagonal(k).zip(diagonal(m)).map(|(k, m)| k + sigma.abs() * m));
    let residual = backward_error(&a, &sizes, |x| {
        let mut memory = MemBuffer::new(symbolic.solve_in_place_scratch::<f64>(1, Par::Seq));
        let x = MatMut::from_column_major_slice_mut(x, n, 1);
        let factor = IntranodeLbltRef::new(&symbolic, &values, &below_diagonal, perm);
        factor.solve_in_place_with_conj(Conj::No, x, Par::Seq, MemStack::new(&mut memory));
    });
    hold("K - sigma M", n, residual, INDEFINITE_GROWTH * allowed(n))?;
    let SymbolicCholeskyRaw::Supernodal(supernodes) = symbolic.raw() else {
        return Ok(0); // of order 0
    };
    let factor = SupernodalIntranodeLbltRef::new(supernodes, &values, &below_diagonal, perm);
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
    Ok(negative)
}
