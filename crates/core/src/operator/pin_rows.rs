//! The rows of a bridge's pins: a module's matrices at its hinges, on the modes and on what they leave out (O9).
//!
//! Knows rows, modes and a factor. Does not know crossings.

use super::columns::ColumnSolver;
use super::panel::Panel;
use super::residual_rows::{ResidualRows, dot};
use crate::bridge::{Bridge, Track};
use crate::fem::{FemError, SparseRow};
use crate::stop::Stop;
use faer::Mat;
use nalgebra::DMatrix;

/// The rows of all pins, three a pin (J6), (O9).
#[derive(Debug, Clone, Default)]
pub(super) struct PinRows {
    /// Joint and place across of each pin.
    pub(super) places: Vec<(usize, f64)>,
    /// Stiffness and mass of the modules on the modes, rows x modes.
    pub(super) stiffness: DMatrix<f64>,
    pub(super) mass: DMatrix<f64>,
    /// What of the stiffness the water has, rows x modes.
    pub(super) water: DMatrix<f64>,
    /// What they see of the connectors beside the modes, rows x connectors.
    pub(super) connectors: DMatrix<f64>,
}

/// The rows of a bridge's pins, and what they see of each track column beside the modes, one column after the other.
pub(super) fn pin_rows(
    bridge: &Bridge,
    solver: &ColumnSolver<'_>,
    track: &Track,
    (lambda, shift): (&[f64], f64),
    (shapes, connectors): (&Mat<f64>, &ResidualRows<'_>),
    stop: Stop<'_>,
) -> Result<(PinRows, Vec<f64>), FemError> {
    let (m, nc) = (lambda.len(), bridge.links.len());
    let each = || bridge.pins.iter().flat_map(|pin| &pin.rows);
    let stiffness: Vec<SparseRow> = each().map(|row| row.stiffness.clone()).collect();
    let count = stiffness.len();
    let mass: Vec<&SparseRow> = each().map(|row| &row.mass).collect();
    let water: Vec<&SparseRow> = each().map(|row| &row.water).collect();
    let all = ResidualRows::new(solver, stiffness, (lambda, shift), shapes, stop)?;
    let mut deck: Vec<f64> = Vec::with_capacity(track.columns() * count);
    for influence in all.deck(track)?.chunks_exact((m + count).max(1)) {
        deck.extend(&influence[m..]);
    }
    // what presses on the freedom itself is no force of the pin
    for (i, row) in each().enumerate() {
        row.columns.iter().for_each(|column| deck[column * count + i] -= 1.0);
    }
    let rows = PinRows {
        places: pin_places(bridge),
        mass: DMatrix::from_fn(count, m, |i, k| dot(mass[i], shapes, k)),
        water: DMatrix::from_fn(count, m, |i, k| dot(water[i], shapes, k)),
        connectors: all.seen_by(connectors, nc),
        stiffness: all.phi,
    };
    Ok((rows, deck))
}

/// Joint and place across of each pin of a bridge `[m]`.
pub(super) fn pin_places(bridge: &Bridge) -> Vec<(usize, f64)> {
    bridge.pins.iter().map(|pin| (pin.joint, pin.y_m)).collect()
}

impl PinRows {
    /// `[v_K Phi, v_M Phi, -R]`: a product with the motion at the balance and the connectors' forces.
    pub(super) fn panel(&self) -> Panel {
        let (rows, m) = self.stiffness.shape();
        Panel::new(rows, 2 * m + self.connectors.ncols(), |i, k| match k {
            k if k < m => self.stiffness[(i, k)],
            k if k < 2 * m => self.mass[(i, k - m)],
            k => -self.connectors[(i, k - 2 * m)],
        })
    }
}
