//! Where a vehicle stands on the track at one instant.
//!
//! Knows the cell of the deck under each point, and what of a patch is on the bridge. Does not know weights, masses or
//! solvers.

use super::Track;
use super::track::DeckCell;
use crate::fem::SparseRow;
use crate::vehicle::{Patch, Vehicle, WheelPoint};

/// Where the front of a vehicle is at a time, which is at the end of the bridge that it comes from at time 0 `[m]`.
#[inline(always)]
pub(crate) fn front_x_m(track: &Track, speed_m_s: f64, time_s: f64) -> f64 {
    let from_m = if speed_m_s < 0.0 { track.length_m() } else { 0.0 };
    from_m + speed_m_s * time_s
}

/// How long a point has to be on a module before its contact force tells anything `[s]`. It comes onto the module at rest, with
/// a contact force that hangs on the time step; what that leaves has died away to a thousandth by then.
const SETTLING_S: f64 = 0.05;

/// A vehicle's place on the track.
/// Equation (V1).
#[derive(Debug, Clone, Default)]
pub(crate) struct VehiclePlacement {
    /// Place of the vehicle's front `[m]`.
    pub front_x_m: f64,
    /// The cell at each of the vehicle's places along; none off the bridge.
    cells: Vec<Option<DeckCell>>,
    /// Distance that a point covers on a module while its contact force settles `[m]`.
    settling_m: f64,
    /// Whether it drives toward x = 0.
    backward: bool,
}

impl VehiclePlacement {
    /// A vehicle with its front at `front_x_m`, moving at `speed_m_s`; a vehicle of a speed below 0 drives toward x = 0.
    pub(crate) fn new(track: &Track, vehicle: &Vehicle, front_x_m: f64, speed_m_s: f64) -> Self {
        let mut placement = Self::default();
        placement.place(track, vehicle, front_x_m, speed_m_s);
        placement
    }

    /// Puts the vehicle's front at `front_x_m`, moving at `speed_m_s`.
    #[inline(always)]
    pub(crate) fn place(&mut self, track: &Track, vehicle: &Vehicle, front_x_m: f64, speed_m_s: f64) {
        self.front_x_m = front_x_m;
        self.settling_m = SETTLING_S * speed_m_s.abs();
        self.backward = speed_m_s < 0.0;
        self.cells.clear();
        for ahead_m in &vehicle.along_m {
            let cell = if self.backward {
                track.cell_before(front_x_m - ahead_m)
            } else {
                track.cell(front_x_m + ahead_m)
            };
            self.cells.push(cell);
        }
    }

    /// The cell at one of the vehicle's places along; none off the bridge.
    #[inline(always)]
    pub(crate) fn cell(&self, along: usize) -> Option<DeckCell> {
        self.cells[along]
    }

    /// Whether the contact force at one of the vehicle's places along has settled since it came onto its module.
    #[inline(always)]
    pub(crate) fn is_settled(&self, along: usize) -> bool {
        let covered_m = |cell: DeckCell| {
            if self.backward {
                cell.module_m - cell.in_module_m
            } else {
                cell.in_module_m
            }
        };
        self.cells[along].is_some_and(|cell| covered_m(cell) >= self.settling_m)
    }

    /// Place of a point along the bridge `[m]`.
    pub(crate) fn x_m(&self, point: &WheelPoint) -> f64 {
        self.place_m(point.ahead_m)
    }

    /// The place so far ahead of the front `[m]`.
    #[inline(always)]
    fn place_m(&self, ahead_m: f64) -> f64 {
        if self.backward {
            self.front_x_m - ahead_m
        } else {
            self.front_x_m + ahead_m
        }
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
        let centre = self.place_m(patch.ahead_m);
        [-0.5, 0.5].map(|end| (centre + end * patch.length_m).clamp(0.0, track.length_m()))
    }
}
