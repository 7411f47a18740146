//! Block Lanczos on a symmetric operator, every block orthogonalised against all before it.
//!
//! Knows an operator on blocks of vectors. Does not know what it stands for, nor how many pairs are wanted.
//!
//! A block finds as many copies of a repeated eigenvalue as it has columns; further copies enter with fresh directions
//! ([`BlockLanczos::widen`]), which whoever knows the true number of eigenvalues asks for.

use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, MatMut, MatRef, Par};

/// A square symmetric operator.
pub(super) trait SymmetricOperator {
    /// Its order.
    fn order(&self) -> usize;
    /// `X := A X`, column-major.
    fn apply(&self, x: MatMut<'_, f64>);
}

/// Columns of a new block.
const BLOCK: usize = 8;

/// A column that shrinks below this share of its length holds rounding alone and makes room for a fresh direction.
const NOTHING_LEFT: f64 = 1e-14;

/// An orthonormal basis Q, grown block by block, and the operator projected on it: `A Q = Q T + V R e_last^T`.
pub(super) struct BlockLanczos<'a, A> {
    operator: &'a A,
    /// Q with the next block V behind it, column-major.
    basis: Vec<f64>,
    /// Columns of Q, on which the operator has been.
    seen: usize,
    /// Columns of the next block.
    block: usize,
    /// T by columns: entry `(i, j)`, `i <= j`, is `projected[j][i]`.
    projected: Vec<Vec<f64>>,
    /// R, `block` x (columns of the last block of Q).
    coupling: Mat<f64>,
    /// Number of fresh directions drawn.
    drawn: u64,
}

/// Eigenpairs of T in falling order of value.
pub(super) struct Ritz {
    /// Values.
    pub values: Vec<f64>,
    /// `|A y - theta y|` of each pair.
    pub residuals: Vec<f64>,
    vectors: Mat<f64>,
}

impl<'a, A: SymmetricOperator> BlockLanczos<'a, A> {
    /// A basis that is empty yet but for its first block.
    pub(super) fn new(operator: &'a A) -> Self {
        let mut lanczos = Self {
            operator,
            basis: Vec::new(),
            seen: 0,
            block: 0,
            projected: Vec::new(),
            coupling: Mat::zeros(0, 0),
            drawn: 0,
        };
        lanczos.widen();
        lanczos
    }

    /// Columns of Q.
    pub(super) fn size(&self) -> usize {
        self.seen
    }

    /// Whether Q can take the next block and leave room for another.
    pub(super) fn can_grow(&self) -> bool {
        self.seen + 2 * self.block <= self.operator.order()
    }

    /// Adds fresh directions to the next block, against eigenvectors that Q is blind to.
    pub(super) fn widen(&mut self) {
        let n = self.operator.order();
        let fresh = BLOCK.min(n - self.seen - self.block);
        let start = self.basis.len();
        self.basis.resize(start + n * fresh, 0.0);
        let (old, new) = self.basis.split_at_mut(start);
        let columns = self.seen + self.block;
        orthonormalise(
            MatRef::from_column_major_slice(old, n, columns),
            new,
            n,
            &mut self.drawn,
        );
        let mut coupling = Mat::zeros(self.block + fresh, self.coupling.ncols());
        coupling.as_mut().subrows_mut(0, self.block).copy_from(&self.coupling);
        self.coupling = coupling;
        self.block += fresh;
    }

    /// Takes the next block into Q and finds the one after.
    pub(super) fn grow(&mut self) {
        let (n, b, seen) = (self.operator.order(), self.block, self.seen + self.block);
        let mut next = self.basis[n * self.seen..].to_vec();
        self.operator
            .apply(MatMut::from_column_major_slice_mut(&mut next, n, b));
        let q = MatRef::from_column_major_slice(&self.basis, n, seen);
        let t = project_out(q, MatMut::from_column_major_slice_mut(&mut next, n, b));
        for j in 0..b {
            let place = self.seen + j;
            // within the block the two halves differ by rounding
            let half = |i: usize| {
                if i < self.seen {
                    t[(i, j)]
                } else {
                    0.5 * (t[(i, j)] + t[(place, i - self.seen)])
                }
            };
            self.projected.push((0..=place).map(half).collect());
        }
        self.coupling = orthonormalise(q, &mut next, n, &mut self.drawn);
        self.basis.extend_from_slice(&next);
        self.seen = seen;
    }

    /// Eigenpairs of T; none where the dense solver fails.
    pub(super) fn ritz(&self) -> Option<Ritz> {
        let size = self.seen;
        let t = Mat::from_fn(size, size, |i, j| {
            if i <= j {
                self.projected[j][i]
            } else {
                self.projected[i][j]
            }
        });
        let evd = t.self_adjoint_eigen(faer::Side::Lower).ok()?;
        let vectors = Mat::from_fn(size, size, |i, j| evd.U()[(i, size - 1 - j)]);
        let values = (0..size).map(|j| evd.S().column_vector()[size - 1 - j]).collect();
        let last = self.coupling.ncols();
        let tail = &self.coupling * vectors.as_ref().subrows(size - last, last);
        let residuals = (0..size).map(|j| tail.col(j).norm_l2()).collect();
        Some(Ritz {
            values,
            residuals,
            vectors,
        })
    }

    /// The Ritz vectors `Q s` of some pairs.
    pub(super) fn chosen(&self, ritz: &Ritz, pairs: &[usize]) -> Mat<f64> {
        let s = Mat::from_fn(self.seen, pairs.len(), |i, j| ritz.vectors[(i, pairs[j])]);
        let ritz = Ritz {
            values: Vec::new(),
            residuals: Vec::new(),
            vectors: s,
        };
        self.vectors(&ritz, pairs.len())
    }

    /// The first `count` Ritz vectors `Q s`.
    pub(super) fn vectors(&self, ritz: &Ritz, count: usize) -> Mat<f64> {
        let n = self.operator.order();
        let q = MatRef::from_column_major_slice(&self.basis[..n * self.seen], n, self.seen);
        let mut y = Mat::zeros(n, count);
        matmul(
            y.as_mut(),
            Accum::Replace,
            q,
            ritz.vectors.as_ref().subcols(0, count),
            1.0,
            Par::Seq,
        );
        y
    }
}

/// `X := X - Q Q^T X`; returns `Q^T X`.
fn project_out(q: MatRef<'_, f64>, mut x: MatMut<'_, f64>) -> Mat<f64> {
    let mut t = Mat::zeros(q.ncols(), x.ncols());
    matmul(t.as_mut(), Accum::Replace, q.transpose(), x.as_ref(), 1.0, Par::Seq);
    matmul(x.as_mut(), Accum::Add, q, t.as_ref(), -1.0, Par::Seq);
    t
}

/// `X = V R` with V orthonormal and orthogonal to Q; V replaces X. X is taken to be orthogonal to Q but for rounding,
/// which counts where a column is short: hence a second round.
fn orthonormalise(q: MatRef<'_, f64>, x: &mut [f64], n: usize, drawn: &mut u64) -> Mat<f64> {
    let columns = x.len() / n;
    let first = gram_schmidt(q, x, n, drawn);
    project_out(q, MatMut::from_column_major_slice_mut(x, n, columns));
    gram_schmidt(q, x, n, drawn) * first
}

/// `X = V R` column by column; a column with nothing left becomes a fresh direction and has zeros in R.
fn gram_schmidt(q: MatRef<'_, f64>, x: &mut [f64], n: usize, drawn: &mut u64) -> Mat<f64> {
    let columns = x.len() / n;
    let mut r = Mat::<f64>::zeros(columns, columns);
    for j in 0..columns {
        let (before, rest) = x.split_at_mut(j * n);
        let column = &mut rest[..n];
        let mut genuine = true;
        loop {
            for _ in 0..2 {
                for (i, v) in before.chunks_exact(n).enumerate() {
                    let c = dot(v, column);
                    v.iter().zip(column.iter_mut()).for_each(|(v, x)| *x -= c * v);
                    if genuine {
                        r[(i, j)] += c;
                    }
                }
            }
            let norm = dot(column, column).sqrt();
            if norm > NOTHING_LEFT {
                column.iter_mut().for_each(|x| *x /= norm);
                r[(j, j)] = if genuine { norm } else { 0.0 };
                break;
            }
            genuine = false;
            fill(column, drawn);
            project_out(q, MatMut::from_column_major_slice_mut(column, n, 1));
        }
    }
    r
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// A direction without symmetry, the same in every run: counters scrambled to (-1/2, 1/2).
fn fill(x: &mut [f64], drawn: &mut u64) {
    *drawn += 1;
    for (i, x) in x.iter_mut().enumerate() {
        let mut z = (i as u64 ^ (*drawn << 40))
            .wrapping_add(1)
            .wrapping_mul(0x9E37_79B9_7F4A_7C15);
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        *x = ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64 - 0.5;
    }
}
