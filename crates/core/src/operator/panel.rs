//! Dense matrices laid out for lanes: each entry is met by a vector of lanes, eight rows at a time.
//!
//! Knows rows, columns and vectors of lanes. Does not know what the numbers mean.

use super::vector::Ops;
use crate::scheme::Arithmetic;
use pulp::{Arch, Simd, WithSimd};

/// More lanes than any vector has.
pub(super) const MOST_LANES: usize = 16;

/// Rows that are summed side by side, and where four or fewer are left.
const ROWS: usize = 8;
const LAST_ROWS: usize = 4;

/// A matrix in blocks of eight rows, the last one of four where these are enough, each block column by column.
#[derive(Debug, Clone, Default)]
pub(super) struct Panel {
    rows: usize,
    columns: usize,
    data: Vec<f64>,
}

impl Panel {
    /// The matrix with entries `of(row, column)`.
    pub(super) fn new(rows: usize, columns: usize, of: impl Fn(usize, usize) -> f64) -> Self {
        let mut data = Vec::new();
        let mut first = 0;
        while first < rows {
            let many = if rows - first > LAST_ROWS { ROWS } else { LAST_ROWS };
            for column in 0..columns {
                let entry = |row: usize| if row < rows { of(row, column) } else { 0.0 };
                data.extend((first..first + many).map(entry));
            }
            first += many;
        }
        Self { rows, columns, data }
    }

    /// Number of rows.
    pub(super) fn rows(&self) -> usize {
        self.rows
    }

    /// `y := A x`.
    #[inline(always)]
    pub(super) fn multiply<S: Simd>(&self, o: Ops<S>, x: &[S::f64s], y: &mut [S::f64s]) {
        let (x, y, mut data) = (&x[..self.columns], &mut y[..self.rows], &self.data[..]);
        let mut from = 0;
        while from + LAST_ROWS < y.len() {
            let (block, rest) = data.split_at(ROWS * x.len());
            let end = (from + ROWS).min(y.len());
            multiply_block::<S, ROWS>(o, block, x, &mut y[from..end]);
            (data, from) = (rest, end);
        }
        if from < y.len() {
            multiply_block::<S, LAST_ROWS>(o, data, x, &mut y[from..]);
        }
    }

    /// `y := A x` over the listed columns, in the list's order.
    #[inline(always)]
    pub(super) fn multiply_listed<S: Simd>(&self, o: Ops<S>, list: &[usize], x: &[S::f64s], y: &mut [S::f64s]) {
        let (y, mut data) = (&mut y[..self.rows], &self.data[..]);
        let mut from = 0;
        while from + LAST_ROWS < y.len() {
            let (block, rest) = data.split_at(ROWS * self.columns);
            let end = (from + ROWS).min(y.len());
            multiply_listed_block::<S, ROWS>(o, block, (list, x), &mut y[from..end]);
            (data, from) = (rest, end);
        }
        if from < y.len() {
            multiply_listed_block::<S, LAST_ROWS>(o, data, (list, x), &mut y[from..]);
        }
    }
}

/// The product of one block.
#[inline(always)]
fn multiply_block<S: Simd, const MANY: usize>(o: Ops<S>, block: &[f64], x: &[S::f64s], y: &mut [S::f64s]) {
    let mut sum = [o.splat(0.0); MANY];
    for (a, &x) in block.as_chunks::<MANY>().0.iter().zip(x) {
        for row in 0..MANY {
            sum[row] = o.fma(o.splat(a[row]), x, sum[row]);
        }
    }
    write_sums(&sum, y);
}

/// The product of one block over the listed columns.
#[inline(always)]
fn multiply_listed_block<S: Simd, const MANY: usize>(
    o: Ops<S>,
    block: &[f64],
    (list, x): (&[usize], &[S::f64s]),
    y: &mut [S::f64s],
) {
    let mut sum = [o.splat(0.0); MANY];
    let block = block.as_chunks::<MANY>().0;
    for &column in list {
        let (a, x) = (&block[column], x[column]);
        for row in 0..MANY {
            sum[row] = o.fma(o.splat(a[row]), x, sum[row]);
        }
    }
    write_sums(&sum, y);
}

/// Writes as many sums as are asked for. A copy of unknown length is a call for each block.
#[inline(always)]
pub(super) fn write_sums<T: Copy, const MANY: usize>(sums: &[T; MANY], to: &mut [T]) {
    if let Some(to) = to.first_chunk_mut::<MANY>() {
        *to = *sums;
        return;
    }
    let (fours, rest) = to.as_chunks_mut::<4>();
    for (to, sums) in fours.iter_mut().zip(sums.as_chunks::<4>().0) {
        *to = *sums;
    }
    let from = MANY.min(4 * fours.len());
    for (to, sum) in rest.iter_mut().zip(&sums[from..]) {
        *to = *sum;
    }
}

/// Numbers as vectors of lanes.
#[inline(always)]
pub(super) fn lanes<S: Simd>(numbers: &[f64]) -> &[S::f64s] {
    S::as_simd_f64s(numbers).0
}

/// Numbers as vectors of lanes, to be written.
#[inline(always)]
pub(super) fn lanes_mut<S: Simd>(numbers: &mut [f64]) -> &mut [S::f64s] {
    S::as_mut_simd_f64s(numbers).0
}

/// The instructions that this machine's lanes run on. Every operation on lanes is one that IEEE 754 rounds correctly,
/// fused multiply-add included, so that all paths give the same bits; a path without the instruction is slow.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct InstructionPath {
    /// Its name.
    pub name: &'static str,
    /// Crossings side by side.
    pub lanes: usize,
}

impl InstructionPath {
    /// The path that will be taken.
    pub fn of_this_machine() -> Self {
        struct Ask;
        impl WithSimd for Ask {
            type Output = InstructionPath;
            fn with_simd<S: Simd>(self, _: S) -> InstructionPath {
                let name = match (cfg!(target_arch = "x86_64"), S::F64_LANES) {
                    (true, 4) => "x86-64 avx2 fma",
                    (true, 8) => "x86-64 avx512",
                    (_, 2) => "128 bit",
                    _ => "scalar",
                };
                InstructionPath {
                    name,
                    lanes: S::F64_LANES,
                }
            }
        }
        Arch::new().dispatch(Ask)
    }
}

#[cfg(test)]
mod tests {
    use super::{InstructionPath, Panel, lanes, lanes_mut};
    use crate::operator::vector::Ops;
    use pulp::{Arch, Simd, WithSimd};

    fn entry(row: usize, column: usize) -> f64 {
        (row as f64 + 2.7 * column as f64 + 0.4).sin()
    }

    /// Products of a panel with numbers x, over all columns or those listed.
    struct Product<'a> {
        panel: &'a Panel,
        list: Option<&'a [usize]>,
        x: &'a [f64],
        y: &'a mut [f64],
    }

    impl WithSimd for Product<'_> {
        type Output = ();

        fn with_simd<S: Simd>(self, simd: S) {
            let (x, y) = (lanes::<S>(self.x), lanes_mut::<S>(self.y));
            match self.list {
                None => self.panel.multiply(Ops(simd), x, y),
                Some(list) => self.panel.multiply_listed(Ops(simd), list, x, y),
            }
        }
    }

    /// Largest difference from the plain product, in which `factor` multiplies the entry (0, 0).
    fn apart(rows: usize, columns: usize, list: Option<&[usize]>, factor: f64) -> f64 {
        let width = InstructionPath::of_this_machine().lanes;
        let x: Vec<f64> = (0..columns * width).map(|i| 1.0 + (0.7 * i as f64).cos()).collect();
        let mut y = vec![f64::NAN; rows * width];
        Arch::new().dispatch(Product {
            panel: &Panel::new(rows, columns, entry),
            list,
            x: &x,
            y: &mut y,
        });
        let all: Vec<usize> = (0..columns).collect();
        let mut apart = 0.0_f64;
        for row in 0..rows {
            for lane in 0..width {
                let term = |&k: &usize| {
                    let by = if (row, k) == (0, 0) { factor } else { 1.0 };
                    by * entry(row, k) * x[k * width + lane]
                };
                let plain: f64 = list.unwrap_or(&all).iter().map(term).sum();
                apart = apart.max((y[row * width + lane] - plain).abs());
            }
        }
        apart
    }

    /// Each lane has its own product, whole blocks of rows or not; 1e-13: rounding of sums of at most 20 numbers near 1. An
    /// entry that is 5 % off is found.
    #[test]
    fn product_of_each_lane_is_the_plain_one() {
        for (rows, columns) in [
            (1, 1),
            (4, 6),
            (5, 2),
            (7, 3),
            (8, 20),
            (9, 5),
            (12, 3),
            (13, 2),
            (24, 1),
        ] {
            for list in [None, Some(&[0][..])] {
                let off = apart(rows, columns, list, 1.0);
                assert!(off < 1e-13, "{rows} x {columns}, {list:?}: {off:e}");
            }
        }
        assert!(apart(9, 5, Some(&[4, 0, 2]), 1.0) < 1e-13);
        assert!(apart(9, 5, None, 1.05) > 1e-3, "a wrong entry passes");
    }
}
