//! Where a vehicle stands on the track at one instant.
//!
//! Knows the cell of the deck under each point, and what of a patch is on the bridge. Does not know weights, masses or
//! solvers.

use super::Track;
use super::track::DeckCell;
use crate::fem::SparseRow;
use crate::vehicle::{Patch, Vehicle, WheelPoint};

/// A vehicle's place on the track.
/// Equation (V1).
#[derive(Debug, Clone, Default)]
pub(crate) struct VehiclePlacement {
    /// Place of the vehicle's front `[m]`.
    pub front_x_m: f64,
    /// The cell at each of the vehicle's places along; none off the bridge.
    cells: Vec<Option<DeckCell>>,
}

impl VehiclePlacement {
    /// A vehicle with its front at `front_x_m`.
    pub(crate) fn new(track: &Track, vehicle: &Vehicle, front_x_m: f64) -> Self {
        let mut placement = Self::default();
        placement.place(track, vehicle, front_x_m);
        placement
    }

    /// Puts the vehicle's front at `front_x_m`.
    #[inline(always)]
    pub(crate) fn place(&mut self, track: &Track, vehicle: &Vehicle, front_x_m: f64) {
        self.front_x_m = front_x_m;
        self.cells.clear();
        for ahead_m in &vehicle.along_m {
            self.cells.push(track.cell(front_x_m + ahead_m));
        }
    }

    /// The cell at one of the vehicle's places along; none off the bridge.
    #[inline(always)]
    pub(crate) fn cell(&self, along: usize) -> Option<DeckCell> {
        self.cells[along]
    }

    /// Place of a point along the bridge `[m]`.
    pub(crate) fn x_m(&self, point: &WheelPoint) -> f64 {
        self.front_x_m + point.ahead_m
    }

    /// The track's row under a point; none off the bridge.
    pub(crate) fn row(&self, track: &Track, point: &WheelPoint) -> Option<SparseRow> {
        self.cell(point.along).map(|cell| track.row_in(cell, point.y_m))
    }

    /// Share of the vehicle's weight on the points of a patch that are on the bridge.
    #[inline(always)]
    pub(crate) fn share_on(&self, patch: &Patch) -> f64 {
        let on = patch.points.iter().filter(|p| self.cell(p.along).is_some());
        on.map(|p| p.share).sum()
    }

    /// Ends of the part of a patch that is on the bridge, left and right `[m]`.
    #[inline(always)]
    pub(crate) fn ends_m(&self, track: &Track, patch: &Patch) -> [f64; 2] {
        let centre = self.front_x_m + patch.ahead_m;
        [-0.5, 0.5].map(|end| (centre + end * patch.length_m).clamp(0.0, track.length_m()))
    }
}
