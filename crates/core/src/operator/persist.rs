//! Plain numbers that are read one list after the other.
//!
//! Knows reals. Does not know what they are, nor files.

use nalgebra::DMatrix;

/// What the numbers of an operator, or of anything else that this crate computes, belong to: a hash of the crate's sources.
pub const SOURCES: &str = env!("PONTOON_CORE_SOURCES");

/// Takes numbers off the front.
pub(super) struct NumberReader<'a>(&'a [f64]);

impl<'a> NumberReader<'a> {
    pub(super) fn new(numbers: &'a [f64]) -> Self {
        Self(numbers)
    }

    /// Whether all have been taken.
    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    pub(super) fn list(&mut self, n: usize) -> Option<Vec<f64>> {
        let (own, rest) = self.0.split_at_checked(n)?;
        self.0 = rest;
        Some(own.to_vec())
    }

    pub(super) fn matrix(&mut self, rows: usize, columns: usize) -> Option<DMatrix<f64>> {
        Some(DMatrix::from_vec(rows, columns, self.list(rows * columns)?))
    }
}
