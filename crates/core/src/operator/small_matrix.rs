//! Small dense matrices side by side, one a lane, that are factored without pivots in memory laid out once.
//!
//! Knows rows and factors. Does not know what the numbers mean.
//!
//! A row and column that couple with no other change nothing else, to the last bit: a lane may leave unknowns out by them.

use super::lane_array::LaneArray;
use super::vector::Ops;
use crate::scheme::Arithmetic;
use pulp::Simd;

/// Room for matrices of the largest order, and for their factors.
#[derive(Debug)]
pub(super) struct SmallMatrix {
    /// The matrix, then U with L below it, without its unit diagonal.
    entries: LaneArray,
    /// One over the diagonal of U.
    inverse: LaneArray,
    stride: usize,
}

impl SmallMatrix {
    /// Room for matrices up to an order.
    pub(super) fn new(order: usize, lanes: usize) -> Self {
        Self {
            entries: LaneArray::new(order * order, lanes),
            inverse: LaneArray::new(order, lanes),
            stride: order,
        }
    }

    /// The first `n` entries of a row, to be written.
    #[inline(always)]
    pub(super) fn row_mut<S: Simd>(&mut self, i: usize, n: usize) -> &mut [S::f64s] {
        &mut self.entries.vectors_mut::<S>()[i * self.stride..][..n]
    }

    /// `A = L U` of the matrices of order `n` that were written. Of symmetric ones the upper half is enough.
    #[inline(always)]
    pub(super) fn factor<S: Simd>(&mut self, o: Ops<S>, n: usize, symmetric: bool) {
        let (stride, one) = (self.stride, o.splat(1.0));
        let (a, inverse) = (self.entries.vectors_mut::<S>(), self.inverse.vectors_mut::<S>());
        for i in 0..n {
            let (above, row) = a.split_at_mut(i * stride);
            let row = &mut row[..n];
            if symmetric {
                for p in 0..i {
                    row[p] = o.mul(above[p * stride + i], inverse[p]);
                }
                let (l, rest) = row.split_at_mut(i);
                take_rows(o, above, stride, (l, i), rest);
            } else {
                for p in 0..i {
                    let l = o.mul(row[p], inverse[p]);
                    row[p] = l;
                    for (x, y) in row[p + 1..].iter_mut().zip(&above[p * stride + p + 1..]) {
                        *x = o.less(*x, l, *y);
                    }
                }
            }
            inverse[i] = o.0.div_f64s(one, row[i]);
        }
    }

    /// `x := (L U)^-1 x`, of the order that x has. Unknown after unknown, so that one that is left out does not change the order of
    /// a sum.
    #[inline(always)]
    pub(super) fn solve<S: Simd>(&self, o: Ops<S>, x: &mut [S::f64s]) {
        let (n, stride) = (x.len(), self.stride);
        let (a, inverse) = (self.entries.vectors::<S>(), self.inverse.vectors::<S>());
        for p in 0..n {
            let known = x[p];
            for i in p + 1..n {
                x[i] = o.less(x[i], a[i * stride + p], known);
            }
        }
        for i in (0..n).rev() {
            let known = o.mul(x[i], inverse[i]);
            x[i] = known;
            for j in 0..i {
                x[j] = o.less(x[j], a[j * stride + i], known);
            }
        }
    }
}

/// Takes the rows above from the entries of a row from column `first` on, each times its factor. As many entries at once as
/// registers hold.
#[inline(always)]
fn take_rows<S: Simd>(
    o: Ops<S>,
    above: &[S::f64s],
    stride: usize,
    (factors, first): (&[S::f64s], usize),
    row: &mut [S::f64s],
) {
    let mut at = 0;
    while at + 8 <= row.len() {
        take_entries::<S, 8>(o, above, stride, (factors, first + at), &mut row[at..]);
        at += 8;
    }
    if at + 4 <= row.len() {
        take_entries::<S, 4>(o, above, stride, (factors, first + at), &mut row[at..]);
        at += 4;
    }
    if at + 2 <= row.len() {
        take_entries::<S, 2>(o, above, stride, (factors, first + at), &mut row[at..]);
        at += 2;
    }
    if at < row.len() {
        take_entries::<S, 1>(o, above, stride, (factors, first + at), &mut row[at..]);
    }
}

/// As [`take_rows`], the first `MANY` entries.
#[inline(always)]
fn take_entries<S: Simd, const MANY: usize>(
    o: Ops<S>,
    above: &[S::f64s],
    stride: usize,
    (factors, first): (&[S::f64s], usize),
    row: &mut [S::f64s],
) {
    let mut sums = [o.splat(0.0); MANY];
    sums.copy_from_slice(&row[..MANY]);
    for (p, factor) in factors.iter().enumerate() {
        let of = &above[p * stride + first..][..MANY];
        for i in 0..MANY {
            sums[i] = o.less(sums[i], *factor, of[i]);
        }
    }
    row[..MANY].copy_from_slice(&sums);
}

#[cfg(test)]
mod tests {
    use super::SmallMatrix;
    use crate::operator::lane_array::LaneArray;
    use crate::operator::vector::Ops;
    use crate::scheme::Arithmetic;
    use nalgebra::{DMatrix, DVector};
    use pulp::{Arch, Simd, WithSimd};

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

    /// Solves a system in every lane, in room for a larger one that was used before; the unknowns in `out` are left out.
    struct Solution<'a> {
        a: &'a DMatrix<f64>,
        b: &'a DVector<f64>,
        symmetric: bool,
        out: &'a [usize],
    }

    impl WithSimd for Solution<'_> {
        type Output = Vec<f64>;

        fn with_simd<S: Simd>(self, simd: S) -> Vec<f64> {
            let (o, n) = (Ops(simd), self.b.len());
            let mut small = SmallMatrix::new(n + 3, S::F64_LANES);
            for i in 0..n + 3 {
                small.row_mut::<S>(i, n + 3).fill(o.splat(1e3));
            }
            let is_out = |i: usize| self.out.contains(&i);
            for i in 0..n {
                let from = if self.symmetric { i } else { 0 };
                for j in from..n {
                    let coupled = if is_out(i) || is_out(j) { 0.0 } else { self.a[(i, j)] };
                    let entry = if i == j && is_out(i) { 1.0 } else { coupled };
                    small.row_mut::<S>(i, n)[j] = o.splat(entry);
                }
            }
            small.factor(o, n, self.symmetric);
            let mut x = LaneArray::new(n, S::F64_LANES);
            for i in 0..n {
                x.vectors_mut::<S>()[i] = o.splat(if is_out(i) { 0.0 } else { self.b[i] });
            }
            small.solve(o, &mut x.vectors_mut::<S>()[..n]);
            x.lane(S::F64_LANES - 1).collect()
        }
    }

    /// Largest residual `|A x - b|`, in which `factor` multiplies an entry.
    fn residual(n: usize, symmetric: bool, factor: f64) -> f64 {
        let (a, b) = system(n, symmetric);
        let mut wrong = a.clone();
        if n > 1 {
            wrong[(0, 1)] *= factor;
        }
        let solution = Solution {
            a: &wrong,
            b: &b,
            symmetric,
            out: &[],
        };
        (a * DVector::from_vec(Arch::new().dispatch(solution)) - b).amax()
    }

    /// Both kinds of factors solve their system, whatever lies beside it; 1e-14: rounding of order n of numbers below 1. An entry
    /// that is 5 % off is found.
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

    /// To the last bit: lanes with other unknowns are solved together.
    #[test]
    fn unknowns_that_are_left_out_change_nothing() {
        for symmetric in [true, false] {
            let (a, b) = system(7, symmetric);
            let solve = |a: &DMatrix<f64>, b: &DVector<f64>, out: &[usize]| {
                Arch::new().dispatch(Solution { a, b, symmetric, out })
            };
            let with = solve(&a, &b, &[2, 5]);
            let kept = [0, 1, 3, 4, 6];
            let alone = solve(&a.select_rows(&kept).select_columns(&kept), &b.select_rows(&kept), &[]);
            let of_kept: Vec<f64> = kept.iter().map(|&i| with[i]).collect();
            assert_eq!(of_kept, alone, "symmetric {symmetric}");
            assert_eq!((with[2], with[5]), (0.0, 0.0));
        }
    }
}
