//! Sparse symmetric matrices and sparse rows.
//!
//! Knows storage and products. Does not know what the numbers mean.

use super::FemError;
use faer::prelude::ReborrowMut;
use faer::sparse::{SparseColMat, SparseColMatRef, Triplet};
use faer::{MatMut, MatRef};

/// A symmetric matrix, both triangles stored by columns.
#[derive(Debug, Clone)]
pub struct SymmetricMatrix {
    inner: SparseColMat<usize, f64>,
}

impl SymmetricMatrix {
    /// Sums `(row, column, value)` entries, both triangles given, into a matrix of order `n`.
    ///
    /// # Errors
    /// [`FemError::OutOfMemory`].
    ///
    /// # Panics
    /// Where an entry lies outside the matrix.
    pub fn from_entries(n: usize, entries: &[(usize, usize, f64)]) -> Result<Self, FemError> {
        let triplets: Vec<_> = entries
            .iter()
            .map(|&(row, col, val)| Triplet { row, col, val })
            .collect();
        let inner =
            SparseColMat::try_new_from_triplets(n, n, &triplets).map_err(|_| FemError::OutOfMemory { dofs: n })?;
        Ok(Self { inner })
    }

    /// `sum of c_i A_i` of matrices of one order.
    ///
    /// # Errors
    /// [`FemError::OutOfMemory`].
    pub fn combine(terms: &[(f64, &Self)]) -> Result<Self, FemError> {
        let n = terms.first().map_or(0, |(_, a)| a.order());
        let entries: Vec<_> = terms
            .iter()
            .flat_map(|&(c, a)| a.entries().map(move |(i, j, v)| (i, j, c * v)))
            .collect();
        Self::from_entries(n, &entries)
    }

    /// Order n.
    pub fn order(&self) -> usize {
        self.inner.ncols()
    }

    /// Stored entries.
    pub(crate) fn nnz(&self) -> usize {
        self.inner.val().len()
    }

    /// All stored entries `(row, column, value)`, column after column.
    pub fn entries(&self) -> impl Iterator<Item = (usize, usize, f64)> + '_ {
        (0..self.order()).flat_map(move |j| self.column(j).map(move |(i, v)| (i, j, v)))
    }

    /// Stored entries `(row, value)` of a column, which are also those of the row of the same number.
    pub fn column(&self, j: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let a = self.inner.as_ref();
        a.row_idx_of_col(j).zip(a.val_of_col(j).iter().copied())
    }

    /// `y = A x`.
    ///
    /// # Panics
    /// Where lengths differ.
    pub fn multiply(&self, x: &[f64], y: &mut [f64]) {
        assert_eq!((x.len(), y.len()), (self.order(), self.order()));
        let (starts, rows, values) = (self.inner.col_ptr(), self.inner.row_idx(), self.inner.val());
        for (j, y) in y.iter_mut().enumerate() {
            let range = starts[j]..starts[j + 1];
            *y = gathered_dot(&rows[range.clone()], &values[range], x);
        }
    }

    /// `y = A x`, column by column.
    pub fn multiply_columns(&self, x: MatRef<'_, f64>, mut y: MatMut<'_, f64>) {
        let mut product = vec![0.0; self.order()];
        for c in 0..x.ncols() {
            let column: Vec<f64> = x.col(c).iter().copied().collect();
            self.multiply(&column, &mut product);
            y.rb_mut()
                .col_mut(c)
                .iter_mut()
                .zip(&product)
                .for_each(|(y, p)| *y = *p);
        }
    }

    /// `x^T A y`.
    pub fn form(&self, x: &[f64], y: &[f64]) -> f64 {
        (0..self.order())
            .map(|j| y[j] * self.column(j).map(|(i, v)| v * x[i]).sum::<f64>())
            .sum()
    }

    /// The library's view.
    pub(super) fn as_faer(&self) -> SparseColMatRef<'_, usize, f64> {
        self.inner.as_ref()
    }
}

/// `sum of v_i x[rows_i]`, in four sums that do not wait for each other.
fn gathered_dot(rows: &[usize], values: &[f64], x: &[f64]) -> f64 {
    let (rows, rows_left) = rows.as_chunks::<4>();
    let (values, values_left) = values.as_chunks::<4>();
    let mut sums = [0.0; 4];
    for (rows, values) in rows.iter().zip(values) {
        for lane in 0..4 {
            sums[lane] += values[lane] * x[rows[lane]];
        }
    }
    let left: f64 = rows_left.iter().zip(values_left).map(|(&i, v)| v * x[i]).sum();
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + left
}

/// A row of few entries `(place, value)`, in rising order of place.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SparseRow(pub Vec<(usize, f64)>);

impl SparseRow {
    /// Sums entries of equal place and sorts them; entries that cancel stay as zeros.
    pub fn from_entries(mut entries: Vec<(usize, f64)>) -> Self {
        entries.sort_by_key(|e| e.0);
        let mut row: Vec<(usize, f64)> = Vec::with_capacity(entries.len());
        for (i, v) in entries {
            match row.last_mut() {
                Some(last) if last.0 == i => last.1 += v,
                _ => row.push((i, v)),
            }
        }
        Self(row)
    }

    /// `sum of c_i row_i`.
    pub fn combine(terms: &[(f64, &Self)]) -> Self {
        Self::from_entries(
            terms
                .iter()
                .flat_map(|&(c, r)| r.0.iter().map(move |&(i, v)| (i, c * v)))
                .collect(),
        )
    }

    /// `row . x`.
    #[inline]
    pub fn dot(&self, x: &[f64]) -> f64 {
        self.0.iter().map(|&(i, v)| v * x[i]).sum()
    }

    /// `x += c row^T`.
    #[inline]
    pub(crate) fn add_to(&self, c: f64, x: &mut [f64]) {
        for &(i, v) in &self.0 {
            x[i] += c * v;
        }
    }
}
