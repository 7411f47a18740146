//! A factorised bridge matrix and its flexibility at the places where forces act: connectors and track.
//!
//! Knows `A^-1 B^T` and `A^-1` at the deck's z along the track, computed once. Does not know what A stands for: the
//! stiffness of a static case or the matrix of a time step.

use crate::bridge::{Bridge, Track};
use crate::fem::{Factor, FemError, SparseRow, SymmetricMatrix};
use faer::{Mat, MatMut};

/// Columns solved at once.
const BLOCK: usize = 64;

/// The factor of A, the columns `A^-1 [B^T  E]` (E: unit loads on the track's z) and their values at connectors and track.
///
/// Places are numbered connectors first, then track columns.
#[derive(Debug)]
pub struct Flexibility {
    /// The factor of A.
    pub factor: Factor,
    connectors: usize,
    track_dofs: Vec<usize>,
    /// `A^-1 [B^T E]`, a column for each place.
    columns: Mat<f64>,
    /// `[B; E^T] A^-1 [B^T E]`.
    values: Mat<f64>,
}

impl Flexibility {
    /// Factorises `a` and solves for all places.
    ///
    /// # Errors
    /// [`FemError`] where `a` is not positive definite.
    pub fn new(a: &SymmetricMatrix, bridge: &Bridge, track: &Track) -> Result<Self, FemError> {
        let factor = Factor::new(a)?;
        let n = a.order();
        let unit = |&dof: &usize| SparseRow(vec![(dof, 1.0)]);
        let rows: Vec<SparseRow> = bridge
            .connectors
            .iter()
            .map(|c| c.row.clone())
            .chain(track.dofs.iter().map(unit))
            .collect();
        let mut columns = Mat::<f64>::zeros(n, rows.len());
        for (j, row) in rows.iter().enumerate() {
            for &(i, v) in &row.0 {
                columns[(i, j)] = v;
            }
        }
        for start in (0..rows.len()).step_by(BLOCK) {
            let width = BLOCK.min(rows.len() - start);
            let block: MatMut<'_, f64> = columns.as_mut().subcols_mut(start, width);
            factor.solve_columns(block);
        }
        let values = Mat::from_fn(rows.len(), rows.len(), |i, j| {
            // read from the lower triangle alone, so that the matrix is symmetric to the last bit
            let (i, j) = (i.max(j), i.min(j));
            rows[i].0.iter().map(|&(k, v)| v * columns[(k, j)]).sum()
        });
        Ok(Self {
            factor,
            connectors: bridge.connectors.len(),
            track_dofs: track.dofs.clone(),
            columns,
            values,
        })
    }

    /// Displacement at place `i` from a unit force at place `j`.
    #[inline]
    pub fn value(&self, i: usize, j: usize) -> f64 {
        self.values[(i, j)]
    }

    /// Place of a track column.
    fn track_place(&self, column: usize) -> usize {
        self.connectors + column
    }

    /// Dof behind a track column.
    #[inline]
    pub fn track_dof(&self, column: usize) -> usize {
        self.track_dofs[column]
    }

    /// Displacement at connector `i` from a unit of a track row.
    pub fn connector_to_track(&self, i: usize, row: &SparseRow) -> f64 {
        row.0.iter().map(|&(c, v)| v * self.value(i, self.track_place(c))).sum()
    }

    /// `row_a . A^-1 row_b^T` of two track rows.
    pub fn track_to_track(&self, a: &SparseRow, b: &SparseRow) -> f64 {
        let inner = |c: usize| {
            b.0.iter()
                .map(|&(d, w)| w * self.value(self.track_place(c), self.track_place(d)))
                .sum::<f64>()
        };
        a.0.iter().map(|&(c, v)| v * inner(c)).sum()
    }

    /// A track row on a vector of the bridge's dofs.
    pub fn track_dot(&self, row: &SparseRow, u: &[f64]) -> f64 {
        row.0.iter().map(|&(c, v)| v * u[self.track_dofs[c]]).sum()
    }

    /// `f += force * row^T`.
    pub fn add_track_force(&self, row: &SparseRow, force: f64, f: &mut [f64]) {
        for &(c, v) in &row.0 {
            f[self.track_dofs[c]] += force * v;
        }
    }

    /// `u += A^-1 row^T` of a track row.
    pub fn add_track_response(&self, row: &SparseRow, u: &mut [f64]) {
        for &(c, v) in &row.0 {
            self.add_column(self.track_place(c), v, u);
        }
    }

    /// `u += force A^-1 b^T` of a connector.
    pub fn add_connector_response(&self, connector: usize, force: f64, u: &mut [f64]) {
        if force != 0.0 {
            self.add_column(connector, force, u);
        }
    }

    fn add_column(&self, place: usize, force: f64, u: &mut [f64]) {
        for (u, x) in u.iter_mut().zip(self.columns.col(place).iter()) {
            *u += force * x;
        }
    }

    /// `row . A^-1 [B^T E]`: what an observed row sees of a unit force at each place.
    pub fn observe(&self, row: &SparseRow) -> Vec<f64> {
        (0..self.columns.ncols())
            .map(|j| row.0.iter().map(|&(i, v)| v * self.columns[(i, j)]).sum())
            .collect()
    }
}
