//! Sparse symmetric matrices and sparse rows.
//!
//! Knows storage and products. Does not know what the numbers mean.

use super::FemError;
use faer::prelude::ReborrowMut;
use faer::sparse::{SparseColMat, SparseColMatRef, SymbolicSparseColMat, Triplet};
use faer::{MatMut, MatRef};
use pulp::{Arch, Simd, WithSimd};

/// Columns of a product that are computed side by side.
const BLOCK: usize = 8;

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

    /// `sum of c_i A_i` of matrices of one order, each entry summed in the order of the terms.
    ///
    /// # Errors
    /// [`FemError::OutOfMemory`].
    pub fn combine(terms: &[(f64, &Self)]) -> Result<Self, FemError> {
        let n = terms.first().map_or(0, |(_, a)| a.order());
        let most: usize = terms.iter().map(|(_, a)| a.nnz()).sum();
        let (mut starts, mut rows, mut values) = (vec![0], Vec::with_capacity(most), Vec::with_capacity(most));
        for j in 0..n {
            let mut left: Vec<_> = terms.iter().map(|(c, a)| (c, a.column(j).peekable())).collect();
            while let Some(row) = left
                .iter_mut()
                .filter_map(|(_, entries)| entries.peek())
                .map(|e| e.0)
                .min()
            {
                let here = left.iter_mut().filter_map(|(c, entries)| {
                    let entry = entries.next_if(|entry| entry.0 == row)?;
                    Some(**c * entry.1)
                });
                rows.push(row);
                values.push(here.reduce(|sum, v| sum + v).unwrap_or_default());
            }
            starts.push(rows.len());
        }
        let symbolic = SymbolicSparseColMat::new_checked(n, n, starts, None, rows);
        Ok(Self {
            inner: SparseColMat::new(symbolic, values),
        })
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

    /// `Y = A X`, each column as [`SymmetricMatrix::multiply`] has it to the last bit.
    pub fn multiply_columns(&self, x: MatRef<'_, f64>, mut y: MatMut<'_, f64>) {
        let (n, mut side_by_side) = (self.order(), Vec::new());
        let mut product = vec![[0.0; BLOCK]; n];
        for first in (0..x.ncols()).step_by(BLOCK) {
            let many = BLOCK.min(x.ncols() - first);
            side_by_side.clear();
            side_by_side.resize(n, [0.0; BLOCK]);
            for c in 0..many {
                let column = side_by_side.iter_mut().zip(x.col(first + c).iter());
                column.for_each(|(row, x)| row[c] = *x);
            }
            Arch::new().dispatch(MultiplyBlock(self, &side_by_side, &mut product));
            for c in 0..many {
                let column = y.rb_mut().col_mut(first + c);
                column.iter_mut().zip(&product).for_each(|(y, row)| *y = row[c]);
            }
        }
    }

    /// `Y = A X` of columns side by side.
    #[inline(always)]
    fn multiply_block(&self, x: &[[f64; BLOCK]], y: &mut [[f64; BLOCK]]) {
        let (starts, rows, values) = (self.inner.col_ptr(), self.inner.row_idx(), self.inner.val());
        for (j, y) in y.iter_mut().enumerate() {
            let range = starts[j]..starts[j + 1];
            let (rows, rows_left) = rows[range.clone()].as_chunks::<4>();
            let (values, values_left) = values[range].as_chunks::<4>();
            let mut sums = [[0.0; BLOCK]; 4];
            for (rows, values) in rows.iter().zip(values) {
                for i in 0..4 {
                    let x = &x[rows[i]];
                    for c in 0..BLOCK {
                        sums[i][c] += values[i] * x[c];
                    }
                }
            }
            let mut left = [-0.0; BLOCK];
            for (&row, value) in rows_left.iter().zip(values_left) {
                for c in 0..BLOCK {
                    left[c] += value * x[row][c];
                }
            }
            for c in 0..BLOCK {
                y[c] = (sums[0][c] + sums[1][c]) + (sums[2][c] + sums[3][c]) + left[c];
            }
        }
    }

    /// `x^T A y`.
    pub fn form(&self, x: &[f64], y: &[f64]) -> f64 {
        (0..self.order())
            .map(|j| y[j] * self.column(j).map(|(i, v)| v * x[i]).sum::<f64>())
            .sum()
    }

    /// `x^T A x` of columns, each as [`SymmetricMatrix::form`] has it to the last bit.
    pub(crate) fn forms(&self, columns: &[&[f64]]) -> Vec<f64> {
        let mut forms = Vec::with_capacity(columns.len());
        let mut x = vec![[0.0; BLOCK]; self.order()];
        for columns in columns.chunks(BLOCK) {
            for (c, column) in columns.iter().enumerate() {
                x.iter_mut().zip(*column).for_each(|(row, x)| row[c] = *x);
            }
            let of_block = Arch::new().dispatch(FormsOfBlock(self, &x));
            forms.extend_from_slice(&of_block[..columns.len()]);
        }
        forms
    }

    /// `x^T A x` of columns side by side.
    #[inline(always)]
    fn forms_of_block(&self, x: &[[f64; BLOCK]]) -> [f64; BLOCK] {
        let (starts, rows, values) = (self.inner.col_ptr(), self.inner.row_idx(), self.inner.val());
        let mut forms = [-0.0; BLOCK];
        for (j, own) in x.iter().enumerate() {
            let range = starts[j]..starts[j + 1];
            let mut product = [-0.0; BLOCK];
            for (&row, value) in rows[range.clone()].iter().zip(&values[range]) {
                for c in 0..BLOCK {
                    product[c] += value * x[row][c];
                }
            }
            for c in 0..BLOCK {
                forms[c] += own[c] * product[c];
            }
        }
        forms
    }

    /// The library's view.
    pub(super) fn as_faer(&self) -> SparseColMatRef<'_, usize, f64> {
        self.inner.as_ref()
    }
}

/// [`SymmetricMatrix::multiply_block`] with the machine's vectors; a closure would leave their instructions behind.
struct MultiplyBlock<'a>(&'a SymmetricMatrix, &'a [[f64; BLOCK]], &'a mut [[f64; BLOCK]]);

impl WithSimd for MultiplyBlock<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        self.0.multiply_block(self.1, self.2);
    }
}

/// [`SymmetricMatrix::forms_of_block`] with the machine's vectors.
struct FormsOfBlock<'a>(&'a SymmetricMatrix, &'a [[f64; BLOCK]]);

impl WithSimd for FormsOfBlock<'_> {
    type Output = [f64; BLOCK];

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> [f64; BLOCK] {
        self.0.forms_of_block(self.1)
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
