//! Numbers of several crossings side by side: rows, in each of them one number a lane.
//!
//! Knows rows and lanes. Does not know what the numbers mean.

use super::step_constants::ResidualRule;
use super::vector::Ops;
use crate::scheme::Newmark;
use pulp::Simd;

/// Rows of one number a lane.
#[derive(Debug, Clone, Default)]
pub(super) struct LaneArray {
    numbers: Vec<f64>,
    lanes: usize,
}

impl LaneArray {
    /// Zeros.
    pub(super) fn new(rows: usize, lanes: usize) -> Self {
        Self {
            numbers: vec![0.0; rows * lanes],
            lanes,
        }
    }

    /// Has room for so many rows.
    pub(super) fn ensure_rows(&mut self, rows: usize) {
        if self.rows() < rows {
            self.numbers.resize(rows * self.lanes, 0.0);
        }
    }

    /// Number of rows.
    pub(super) fn rows(&self) -> usize {
        self.numbers.len() / self.lanes.max(1)
    }

    /// The rows as vectors of lanes.
    #[inline(always)]
    pub(super) fn vectors<S: Simd>(&self) -> &[S::f64s] {
        S::as_simd_f64s(&self.numbers).0
    }

    /// The rows as vectors of lanes, to be written.
    #[inline(always)]
    pub(super) fn vectors_mut<S: Simd>(&mut self) -> &mut [S::f64s] {
        S::as_mut_simd_f64s(&mut self.numbers).0
    }

    /// A lane's number in a row.
    #[inline(always)]
    pub(super) fn at(&self, row: usize, lane: usize) -> f64 {
        self.numbers[row * self.lanes + lane]
    }

    /// A lane's number in a row, to be written.
    #[inline(always)]
    pub(super) fn at_mut(&mut self, row: usize, lane: usize) -> &mut f64 {
        &mut self.numbers[row * self.lanes + lane]
    }

    /// A row, to be written lane by lane.
    #[inline(always)]
    pub(super) fn row_mut(&mut self, row: usize) -> &mut [f64] {
        &mut self.numbers[row * self.lanes..][..self.lanes]
    }

    /// Zeros in the first so many rows.
    #[inline(always)]
    pub(super) fn clear_rows(&mut self, rows: usize) {
        self.numbers[..rows * self.lanes].fill(0.0);
    }

    /// Takes a lane's numbers in the first so many rows from a lane of another array.
    #[inline(always)]
    pub(super) fn take_lane(&mut self, lane: usize, rows: usize, (from, of): (&Self, usize)) {
        let from_rows = from.numbers.chunks_exact(from.lanes);
        for (to, from) in self.numbers.chunks_exact_mut(self.lanes).zip(from_rows).take(rows) {
            to[lane] = from[of];
        }
    }

    /// A lane's numbers, row after row.
    #[inline(always)]
    pub(super) fn lane(&self, lane: usize) -> impl Iterator<Item = f64> {
        self.numbers.iter().skip(lane).step_by(self.lanes).copied()
    }

    /// A lane's numbers, to be written.
    #[inline(always)]
    pub(super) fn lane_mut(&mut self, lane: usize) -> impl Iterator<Item = &mut f64> {
        self.numbers.iter_mut().skip(lane).step_by(self.lanes)
    }

    /// Rows from `first` on, to be written lane by lane.
    #[inline(always)]
    pub(super) fn rows_from_mut(&mut self, first: usize) -> impl Iterator<Item = &mut [f64]> {
        self.numbers[first * self.lanes..].chunks_exact_mut(self.lanes)
    }

    /// Writes a lane's numbers between those of the others.
    #[inline(always)]
    pub(super) fn scatter(&mut self, lane: usize, from: &[f64]) {
        for (row, x) in self.numbers.chunks_exact_mut(self.lanes).zip(from) {
            row[lane] = *x;
        }
    }

    /// Writes the one row of an array lane by lane.
    #[inline(always)]
    pub(super) fn write_row(&mut self, row: impl Iterator<Item = f64>) {
        self.numbers.iter_mut().zip(row).for_each(|(to, x)| *to = x);
    }

    /// Zeros in a lane.
    pub(super) fn clear(&mut self, lane: usize) {
        self.lane_mut(lane).for_each(|x| *x = 0.0);
    }

    /// Takes the numbers of another array of as many rows and lanes.
    pub(super) fn copy_all(&mut self, from: &Self) {
        self.numbers.copy_from_slice(&from.numbers);
    }

    /// Writes the rows of others, one array after the other.
    #[inline(always)]
    pub(super) fn join(&mut self, [first, second]: [&Self; 2]) {
        let (a, b) = self.numbers.split_at_mut(first.numbers.len());
        a.copy_from_slice(&first.numbers);
        b.copy_from_slice(&second.numbers);
    }
}

/// What is carried from step to step of a quantity without mass: `x, x', x''`.
#[derive(Debug, Clone, Default)]
pub(super) struct Trace {
    pub(super) x: LaneArray,
    pub(super) x1: LaneArray,
    pub(super) x2: LaneArray,
}

/// The rows of a [`Trace`] as vectors.
#[derive(Debug)]
pub(super) struct TraceRows<'a, S: Simd> {
    x: &'a mut [S::f64s],
    x1: &'a mut [S::f64s],
    x2: &'a mut [S::f64s],
}

impl Trace {
    /// Zeros.
    pub(super) fn new(rows: usize, lanes: usize) -> Self {
        let zeros = || LaneArray::new(rows, lanes);
        Self {
            x: zeros(),
            x1: zeros(),
            x2: zeros(),
        }
    }

    /// Its arrays.
    pub(super) fn all(&mut self) -> [&mut LaneArray; 3] {
        [&mut self.x, &mut self.x1, &mut self.x2]
    }

    /// Its arrays, to be read.
    pub(super) fn each(&self) -> [&LaneArray; 3] {
        [&self.x, &self.x1, &self.x2]
    }

    /// Row i.
    #[inline(always)]
    pub(super) fn row<S: Simd>(&self, i: usize) -> [S::f64s; 3] {
        [
            self.x.vectors::<S>()[i],
            self.x1.vectors::<S>()[i],
            self.x2.vectors::<S>()[i],
        ]
    }

    /// Its first rows as vectors: slices whose length a loop knows are looked at once, and not in each row.
    #[inline(always)]
    pub(super) fn first_mut<S: Simd>(&mut self, rows: usize) -> TraceRows<'_, S> {
        TraceRows {
            x: &mut self.x.vectors_mut::<S>()[..rows],
            x1: &mut self.x1.vectors_mut::<S>()[..rows],
            x2: &mut self.x2.vectors_mut::<S>()[..rows],
        }
    }
}

impl<S: Simd> TraceRows<'_, S> {
    /// The change of row i under a force, by the rule of what has no mass.
    #[inline(always)]
    pub(super) fn change(&self, o: Ops<S>, rule: &ResidualRule<Ops<S>>, i: usize, force: S::f64s) -> S::f64s {
        rule.change(o, force, [self.x[i], self.x1[i], self.x2[i]])
    }

    /// Row i and its derivative.
    #[inline(always)]
    pub(super) fn at(&self, i: usize) -> [S::f64s; 2] {
        [self.x[i], self.x1[i]]
    }

    /// Takes row i to the end of a step in which it changes by `d`, in the lanes of a mask.
    #[inline(always)]
    pub(super) fn advance_where(&mut self, o: Ops<S>, mask: S::m64s, by: &Newmark<Ops<S>>, i: usize, d: S::f64s) {
        let old = [self.x[i], self.x1[i], self.x2[i]];
        let new = by.advance(o, d, old);
        self.x[i] = o.0.select_f64s(mask, new[0], old[0]);
        self.x1[i] = o.0.select_f64s(mask, new[1], old[1]);
        self.x2[i] = o.0.select_f64s(mask, new[2], old[2]);
    }

    /// Takes row i to the end of a step in which it changes by `d`.
    #[inline(always)]
    pub(super) fn advance(&mut self, o: Ops<S>, by: &Newmark<Ops<S>>, i: usize, d: S::f64s) {
        [self.x[i], self.x1[i], self.x2[i]] = by.advance(o, d, [self.x[i], self.x1[i], self.x2[i]]);
    }
}
