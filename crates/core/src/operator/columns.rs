//! Solutions with the bridge's matrix for many rows, a block at a time.
//!
//! Knows a factor, rows and memory that is used again. Does not know what solutions are for, nor who shares the blocks.

use crate::fem::{Factor, FemError, SolveMemory, SparseRow, go_on};
use crate::stop::Stop;
use faer::MatMut;
use std::sync::{Mutex, PoisonError};

/// Rows of a block. The library blocks its products by their number, so that the bits of a solution hang on it a little.
pub(super) const SOLVED_AT_ONCE: usize = 512;

/// `A^-1 r^T` of rows, from any thread.
pub(super) struct ColumnSolver<'a> {
    factor: &'a Factor,
    stop: Stop<'a>,
    /// What blocks have used, as many as were ever under way at once.
    spare: Mutex<Vec<Spare>>,
}

#[derive(Default)]
struct Spare {
    columns: Vec<f64>,
    memory: SolveMemory,
}

impl<'a> ColumnSolver<'a> {
    pub(super) fn new(factor: &'a Factor, stop: Stop<'a>) -> Self {
        Self {
            factor,
            stop,
            spare: Mutex::new(Vec::new()),
        }
    }

    /// Entries of a column.
    pub(super) fn order(&self) -> usize {
        self.factor.order()
    }

    /// Hands the columns of rows, one behind the other, to who reads them once.
    ///
    /// # Errors
    /// [`FemError::Stopped`], as of everything here that may fail.
    pub(super) fn read<T>(&self, rows: &[SparseRow], read: impl FnOnce(&[f64]) -> T) -> Result<T, FemError> {
        self.with_spare(|Spare { columns, memory }| {
            columns.clear();
            columns.resize(self.order() * rows.len(), 0.0);
            self.solve(rows, columns, memory);
            read(columns)
        })
    }

    /// Writes the columns of rows into zeros.
    pub(super) fn write(&self, rows: &[SparseRow], columns: &mut [f64]) -> Result<(), FemError> {
        self.with_spare(|spare| self.solve(rows, columns, &mut spare.memory))
    }

    fn with_spare<T>(&self, work: impl FnOnce(&mut Spare) -> T) -> Result<T, FemError> {
        go_on(self.stop)?;
        let lock = || self.spare.lock().unwrap_or_else(PoisonError::into_inner);
        let taken = lock().pop();
        let mut spare = taken.unwrap_or_default();
        let done = work(&mut spare);
        lock().push(spare);
        Ok(done)
    }

    fn solve(&self, rows: &[SparseRow], columns: &mut [f64], memory: &mut SolveMemory) {
        let order = self.order();
        for (column, row) in columns.chunks_exact_mut(order).zip(rows) {
            row.add_to(1.0, column);
        }
        let x = MatMut::from_column_major_slice_mut(columns, order, rows.len());
        self.factor.solve_columns_in(x, memory);
    }
}
