//! A factorised bridge matrix and its flexibility at the places where forces act: connectors and track.
//!
//! Knows `A^-1 B^T` and `A^-1` at the deck's nodes, each line of the deck computed once, when a wheel first needs it. Does
//! not know what A stands for: the stiffness of a static case or the matrix of a time step.

use crate::bridge::{Bridge, Track};
use crate::fem::{Factor, FemError, SparseRow, SymmetricMatrix};
use faer::{Mat, MatRef};
use nalgebra::DMatrix;
use std::sync::OnceLock;

/// The factor of A, the columns `A^-1 B^T` of the connectors and, line by line, `A^-1 E` of unit loads on the deck's z.
/// Shared read-only between jobs and threads.
#[derive(Debug)]
pub(crate) struct Flexibility {
    factor: Factor,
    track: Track,
    /// `A^-1 B^T`.
    connectors: Mat<f64>,
    /// `B A^-1 B^T`.
    among: DMatrix<f64>,
    /// `A^-1 E` of each line of the track.
    lines: Vec<OnceLock<Mat<f64>>>,
}

impl Flexibility {
    /// Factorises `a`, which errors call by its `name`, and solves for the connectors.
    ///
    /// # Errors
    /// [`FemError`] where `a` is not positive definite or its factor fails [`Factor::probe`].
    pub(crate) fn new(name: &'static str, a: &SymmetricMatrix, bridge: &Bridge) -> Result<Self, FemError> {
        let factor = Factor::new(name, a)?;
        let track = Track::new(bridge);
        let connectors = responses(&factor, bridge.links.iter().map(|c| &c.row));
        let nc = connectors.ncols();
        let among = DMatrix::from_fn(nc, nc, |i, j| {
            // always from the later column, so that the matrix is symmetric to the last bit
            let row = &bridge.links[i.min(j)].row;
            row.0.iter().map(|&(k, v)| v * connectors[(k, i.max(j))]).sum()
        });
        let lines = (0..track.lines()).map(|_| OnceLock::new()).collect();
        Ok(Self {
            factor,
            track,
            connectors,
            among,
            lines,
        })
    }

    /// The track on which rows are given.
    pub(crate) fn track(&self) -> &Track {
        &self.track
    }

    /// `x := A^-1 x`.
    pub(crate) fn solve(&self, x: &mut [f64]) {
        self.factor.solve(x);
    }

    /// The line of a column and its place in it.
    fn column(&self, column: usize) -> (MatRef<'_, f64>, usize) {
        let stations = self.track.stations();
        let (line, station) = (column / stations, column % stations);
        let columns = self.lines[line].get_or_init(|| {
            let mut columns = Mat::<f64>::zeros(self.factor.order(), stations);
            for j in 0..stations {
                columns[(self.track.dof(line * stations + j), j)] = 1.0;
            }
            self.factor.solve_columns(columns.as_mut());
            columns
        });
        (columns.as_ref(), station)
    }

    /// `B A^-1 B^T` among the connectors, symmetric to the last bit.
    pub(crate) fn among_connectors(&self) -> &DMatrix<f64> {
        &self.among
    }

    /// `b_i . A^-1 row^T` of a connector and a track row.
    pub(crate) fn connector_to_track(&self, i: usize, row: &SparseRow) -> f64 {
        row.0
            .iter()
            .map(|&(c, v)| v * self.connectors[(self.track.dof(c), i)])
            .sum()
    }

    /// `row_a . A^-1 row_b^T` of two track rows.
    pub(crate) fn track_to_track(&self, a: &SparseRow, b: &SparseRow) -> f64 {
        let column = |c: usize, w: f64| {
            let (columns, j) = self.column(c);
            w * a
                .0
                .iter()
                .map(|&(d, v)| v * columns[(self.track.dof(d), j)])
                .sum::<f64>()
        };
        b.0.iter().map(|&(c, w)| column(c, w)).sum()
    }

    /// A track row on a vector of the bridge's dofs.
    pub(crate) fn track_dot(&self, row: &SparseRow, u: &[f64]) -> f64 {
        row.0.iter().map(|&(c, v)| v * u[self.track.dof(c)]).sum()
    }

    /// `f += force * row^T` of a track row.
    pub(crate) fn add_track_force(&self, row: &SparseRow, force: f64, f: &mut [f64]) {
        for &(c, v) in &row.0 {
            f[self.track.dof(c)] += force * v;
        }
    }

    /// `u += A^-1 row^T` of a track row.
    pub(crate) fn add_track_response(&self, row: &SparseRow, u: &mut [f64]) {
        for &(c, v) in &row.0 {
            let (columns, j) = self.column(c);
            add_column(columns, j, v, u);
        }
    }

    /// `u += force A^-1 b^T` of a connector.
    pub(crate) fn add_connector_response(&self, connector: usize, force: f64, u: &mut [f64]) {
        if force != 0.0 {
            add_column(self.connectors.as_ref(), connector, force, u);
        }
    }

    /// `row . A^-1 B^T`: what an observed row sees of unit forces at the connectors.
    pub(crate) fn observe_connectors(&self, row: &SparseRow) -> Vec<f64> {
        (0..self.connectors.ncols())
            .map(|j| row.0.iter().map(|&(i, v)| v * self.connectors[(i, j)]).sum())
            .collect()
    }

    /// `[B; rows] A^-1 E`: what each connector and below them each observed row sees of a unit force on each column of the
    /// track, (connectors + rows) x columns. By Maxwell-Betti from `A^-1 rows^T`, so that no column is solved for.
    pub(crate) fn influence(&self, rows: &[SparseRow]) -> DMatrix<f64> {
        let observed = responses(&self.factor, rows.iter());
        let nc = self.connectors.ncols();
        DMatrix::from_fn(nc + rows.len(), self.track.columns(), |i, column| {
            let (seen, j) = if i < nc {
                (&self.connectors, i)
            } else {
                (&observed, i - nc)
            };
            seen[(self.track.dof(column), j)]
        })
    }
}

/// `A^-1 rows^T`.
fn responses<'a>(factor: &Factor, rows: impl ExactSizeIterator<Item = &'a SparseRow>) -> Mat<f64> {
    let mut columns = Mat::<f64>::zeros(factor.order(), rows.len());
    for (j, row) in rows.enumerate() {
        for &(i, v) in &row.0 {
            columns[(i, j)] = v;
        }
    }
    factor.solve_columns(columns.as_mut());
    columns
}

fn add_column(columns: MatRef<'_, f64>, j: usize, force: f64, u: &mut [f64]) {
    for (u, x) in u.iter_mut().zip(columns.col(j).iter()) {
        *u += force * x;
    }
}

#[cfg(test)]
#[allow(clippy::expect_used)]
mod tests {
    use crate::bridge::{Bridge, BridgeDesign, Ends, Model, PreparedModule};
    use crate::fem::{Factor, FemError, SymmetricMatrix, lowest_modes};
    use crate::scheme::Scheme;

    /// What is factorised of the repository's bridges leaves less than a hundredth of what is allowed. Twins: the diagonal
    /// entry of a dof, and the eigenvalue of a mode, 5 % off.
    #[test]
    fn margins_of_the_probes_on_bridges() {
        let (smoke, fu2005) = (
            include_str!("../../../studies/bridges/smoke.json"),
            include_str!("../../../studies/bridges/fu2005.json"),
        );
        for (text, model) in [
            (smoke, Model::SuperElement),
            (smoke, Model::Full),
            (fu2005, Model::SuperElement),
        ] {
            let design: BridgeDesign = serde_json::from_str(text).expect("a design");
            let module = PreparedModule::new(&design, model).expect("a module");
            let bridge = Bridge::new(&design, &module, Ends::Supported).expect("a bridge");
            let (k, m) = (&bridge.k, &bridge.m);
            let sum = |on_m: f64, on_k: f64| SymmetricMatrix::combine(&[(on_m, m), (on_k, k)]).expect("a matrix");
            let (c_m, c_c, c_k) = Scheme::new(0.01, 0.9).effective();
            for a in [sum(0.0, 1.0), sum(c_m, c_k + 0.02 * c_c), sum(0.4, 1.0)] {
                let factor = Factor::new("a", &a).expect("a factor");
                let share = factor.probe("a", &a).expect("its own");
                assert!(share < 0.01, "{} {model:?}: {share:.1e}", design.name);
                for at in [0, a.order() / 2, a.order() - 1] {
                    let off = |(i, j, v)| (i, j, if i == at && j == at { 1.05 * v } else { v });
                    let entries: Vec<_> = a.entries().map(off).collect();
                    let other = SymmetricMatrix::from_entries(a.order(), &entries).expect("a matrix");
                    let told = factor.probe("a", &other);
                    assert!(matches!(told, Err(FemError::BadFactor { .. })), "{told:?}");
                }
            }
            let mut pairs = lowest_modes(k, m, 24, 0.4).expect("modes");
            let share = pairs.probe(k, m, 0.4).expect("modes");
            assert!(share < 0.01, "{} {model:?}: {share:.1e}", design.name);
            pairs.lambda[20] *= 1.05;
            let told = pairs.probe(k, m, 0.4);
            assert!(matches!(told, Err(FemError::BadPair { mode: 21, .. })), "{told:?}");
        }
    }
}
