//! A small dense matrix that is factored without pivots, in memory laid out once.
//!
//! Knows rows and factors. Does not know what the numbers mean.

/// Entries that are computed at once.
const CHUNK: usize = 4;

/// Room for a matrix of the largest order, and for its factors. Rows are `stride` apart, a multiple of [`CHUNK`]. Row
/// operations run over whole chunks: what they do beyond the order asked for is never read.
#[derive(Debug)]
pub(super) struct SmallMatrix {
    /// The matrix, then U.
    entries: Vec<f64>,
    /// L by columns, without its unit diagonal.
    lower: Vec<f64>,
    stride: usize,
}

impl SmallMatrix {
    /// Room for matrices up to an order.
    pub(super) fn new(order: usize) -> Self {
        let stride = order.next_multiple_of(CHUNK);
        Self {
            entries: vec![0.0; stride * stride],
            lower: vec![0.0; stride * stride],
            stride,
        }
    }

    /// The first `n` entries of a row, to be written.
    #[inline(always)]
    pub(super) fn row_mut(&mut self, i: usize, n: usize) -> &mut [f64] {
        &mut self.entries[i * self.stride..][..n]
    }

    /// `A = L U` of the matrix of order `n` that was written. Of a symmetric one the upper half is enough.
    #[inline(always)]
    pub(super) fn factor(&mut self, n: usize, symmetric: bool) {
        let (a, lower) = (&mut self.entries[..], &mut self.lower[..]);
        if symmetric {
            factor_symmetric(a, lower, self.stride, n);
        } else {
            factor(a, lower, self.stride, n);
        }
    }

    /// `x := (L U)^-1 x`, of the order that x has.
    #[inline(always)]
    pub(super) fn solve(&self, x: &mut [f64]) {
        let (n, stride) = (x.len(), self.stride);
        for p in 0..n {
            let (known, left) = x.split_at_mut(p + 1);
            subtract(left, known[p], &self.lower[p * stride + p + 1..][..n - p - 1]);
        }
        for i in (0..n).rev() {
            let row = &self.entries[i * stride..][..n];
            let sum = dot_in_chunks(&row[i + 1..], &x[i + 1..]);
            x[i] = (x[i] - sum) / row[i];
        }
    }
}

/// `x := x - w y`.
#[inline(always)]
pub(super) fn subtract(x: &mut [f64], w: f64, y: &[f64]) {
    for (x, y) in x.iter_mut().zip(y) {
        *x = (-w).mul_add(*y, *x);
    }
}

/// `a . x` in as many running sums as a chunk has.
#[inline(always)]
fn dot_in_chunks(a: &[f64], x: &[f64]) -> f64 {
    let mut sums = [0.0; CHUNK];
    let (a, a_rest) = a.as_chunks::<CHUNK>();
    let (x, x_rest) = x.as_chunks::<CHUNK>();
    for (a, x) in a.iter().zip(x) {
        for k in 0..CHUNK {
            sums[k] = f64::mul_add(a[k], x[k], sums[k]);
        }
    }
    let mut sum = (sums[0] + sums[1]) + (sums[2] + sums[3]);
    for (a, x) in a_rest.iter().zip(x_rest) {
        sum = a.mul_add(*x, sum);
    }
    sum
}

/// `A = L U` of any matrix whose leading minors are not zero.
#[inline(always)]
fn factor(a: &mut [f64], lower: &mut [f64], stride: usize, n: usize) {
    for p in 0..n {
        let (above, below) = a.split_at_mut((p + 1) * stride);
        let chunks = (p + 1) / CHUNK * CHUNK..n.next_multiple_of(CHUNK).max(p + 1);
        let pivot_row = &above[p * stride..][..stride];
        let reciprocal = 1.0 / pivot_row[p];
        let column = &mut lower[p * stride..][..n];
        let pivots = pivot_row[chunks.clone()].as_chunks::<CHUNK>().0;
        for (row, ratio_kept) in below.chunks_exact_mut(stride).zip(&mut column[p + 1..]) {
            let ratio = row[p] * reciprocal;
            *ratio_kept = ratio;
            subtract_chunks(row[chunks.clone()].as_chunks_mut::<CHUNK>().0, ratio, pivots);
        }
    }
}

/// `A = L U` of a symmetric matrix from its upper half.
#[inline(always)]
fn factor_symmetric(a: &mut [f64], lower: &mut [f64], stride: usize, n: usize) {
    let end = n.next_multiple_of(CHUNK);
    for p in 0..n {
        let (above, below) = a.split_at_mut((p + 1) * stride);
        let pivot_row = &above[p * stride..][..stride];
        let reciprocal = 1.0 / pivot_row[p];
        let column = &mut lower[p * stride..][..stride];
        for ((row, ratio_kept), i) in below.chunks_exact_mut(stride).zip(&mut column[p + 1..n]).zip(p + 1..) {
            let ratio = pivot_row[i] * reciprocal;
            *ratio_kept = ratio;
            let chunks = i / CHUNK * CHUNK..end;
            let pivots = pivot_row[chunks.clone()].as_chunks::<CHUNK>().0;
            subtract_chunks(row[chunks].as_chunks_mut::<CHUNK>().0, ratio, pivots);
        }
    }
}

/// `row := row - ratio pivots`.
#[inline(always)]
fn subtract_chunks(row: &mut [[f64; CHUNK]], ratio: f64, pivots: &[[f64; CHUNK]]) {
    for (entries, pivots) in row.iter_mut().zip(pivots) {
        for k in 0..CHUNK {
            entries[k] = (-ratio).mul_add(pivots[k], entries[k]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::SmallMatrix;
    use nalgebra::{DMatrix, DVector};

    /// A matrix of order `n` with a heavy diagonal, so that no pivots are needed, and a right side.
    fn system(n: usize, symmetric: bool) -> (DMatrix<f64>, DVector<f64>) {
        let entry = |i: usize, j: usize| ((3 * i + 7 * j) as f64).sin();
        let a = DMatrix::from_fn(n, n, |i, j| {
            let own = if i == j { 2.0 * n as f64 } else { 0.0 };
            let other = if symmetric { entry(j, i) } else { 0.0 };
            own + entry(i, j) + other
        });
        (a, DVector::from_fn(n, |i, _| (i as f64 + 0.3).cos()))
    }

    /// Largest residual `|A x - b|` of a solution in room for a larger matrix, that was used before.
    fn residual(n: usize, symmetric: bool, factor: f64) -> f64 {
        let mut small = SmallMatrix::new(n + 3);
        for i in 0..n + 3 {
            small.row_mut(i, n + 3).fill(1e3);
        }
        let (a, b) = system(n, symmetric);
        for i in 0..n {
            let from = if symmetric { i } else { 0 };
            for j in from..n {
                small.row_mut(i, n)[j] = a[(i, j)];
            }
        }
        if n > 1 {
            small.row_mut(0, n)[1] *= factor;
        }
        small.factor(n, symmetric);
        let mut x = b.as_slice().to_vec();
        small.solve(&mut x);
        (a * DVector::from_vec(x) - b).amax()
    }

    /// Both kinds of factors solve their system at every remainder of the order by the chunk, whatever lies beside it;
    /// 1e-14: rounding of order n of numbers below 1. An entry that is 5 % off is found.
    #[test]
    fn factors_solve_their_system() {
        for n in 0..=13 {
            for symmetric in [true, false] {
                let off = residual(n, symmetric, 1.0);
                assert!(off < 1e-14, "order {n}, symmetric {symmetric}: {off:e}");
                let wrong = residual(n, symmetric, 1.05);
                assert!(n < 2 || wrong > 1e-6, "order {n}: a wrong entry passes, {wrong:e}");
            }
        }
    }
}
