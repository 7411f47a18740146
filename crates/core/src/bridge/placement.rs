//! Where a vehicle stands on the track at one instant.
//!
//! Knows the cell of the deck under each point, and what of a patch is on the bridge. Does not know weights, masses or
//! solvers.

use super::Track;
use super::track::DeckCell;
use crate::fem::SparseRow;
use crate::traffic::Drive;
use crate::vehicle::{Patch, Vehicle, WheelPoint};

/// Where the front of a vehicle is and how it moves along x.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Heading {
    /// Place of the front `[m]`.
    pub front_x_m: f64,
    /// Speed along x, below 0 toward x = 0 `[m/s]`.
    pub speed_m_s: f64,
    /// Acceleration along x `[m/s^2]`.
    pub acceleration_m_s2: f64,
    /// Whether it drives toward x = 0.
    pub backward: bool,
}

impl Heading {
    /// That of a vehicle at a time.
    #[inline(always)]
    pub(crate) fn of(track: &Track, drive: &Drive, time_s: f64) -> Self {
        let now = drive.at(time_s);
        let (from_m, sign) = if drive.backward {
            (track.length_m(), -1.0)
        } else {
            (0.0, 1.0)
        };
        Self {
            front_x_m: from_m + sign * now.way_m,
            speed_m_s: sign * now.speed_m_s,
            acceleration_m_s2: sign * now.acceleration_m_s2,
            backward: drive.backward,
        }
    }

    /// A vehicle that stands with its front at a place.
    pub(crate) fn standing(front_x_m: f64) -> Self {
        Self {
            front_x_m,
            ..Self::default()
        }
    }
}

/// How long a point has to be on a module before its contact force tells anything `[s]`. It comes onto the module at rest, with
/// a contact force that hangs on the time step; what that leaves has died away to a thousandth by then.
const SETTLING_S: f64 = 0.05;

/// A vehicle's place on the track.
/// Equation (V1).
#[derive(Debug, Clone, Default)]
pub(crate) struct VehiclePlacement {
    /// Where its front is and how it moves.
    pub heading: Heading,
    /// The cell at each of the vehicle's places along; none off the bridge.
    cells: Vec<Option<DeckCell>>,
    /// Distance that a point covers on a module while its contact force settles `[m]`.
    settling_m: f64,
}

impl VehiclePlacement {
    /// A vehicle where it is heading.
    pub(crate) fn new(track: &Track, vehicle: &Vehicle, heading: Heading) -> Self {
        let mut placement = Self::default();
        placement.place(track, vehicle, heading);
        placement
    }

    /// Puts the vehicle where it is heading.
    #[inline(always)]
    pub(crate) fn place(&mut self, track: &Track, vehicle: &Vehicle, heading: Heading) {
        self.heading = heading;
        self.settling_m = SETTLING_S * heading.speed_m_s.abs();
        self.cells.clear();
        for ahead_m in &vehicle.along_m {
            let cell = if heading.backward {
                track.cell_before(heading.front_x_m - ahead_m)
            } else {
                track.cell(heading.front_x_m + ahead_m)
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
            if self.heading.backward {
                cell.module_m - cell.in_module_m
            } else {
                cell.in_module_m
            }
        };
        self.cells[along].is_some_and(|cell| covered_m(cell) >= self.settling_m)
    }

    /// Whether all points of a patch are on the bridge.
    pub(crate) fn is_on(&self, patch: &Patch) -> bool {
        patch.points.iter().all(|point| self.cells[point.along].is_some())
    }

    /// Whether the contact force under a patch tells anything: of a mass on the deck once it has settled.
    #[inline(always)]
    pub(crate) fn tells(&self, patch: &Patch) -> bool {
        if patch.rigid == 0.0 {
            return self.is_on(patch);
        }
        patch.points.iter().all(|point| self.is_settled(point.along))
    }

    /// Place of a point along the bridge `[m]`.
    pub(crate) fn x_m(&self, point: &WheelPoint) -> f64 {
        self.place_m(point.ahead_m)
    }

    /// The place so far ahead of the front `[m]`.
    #[inline(always)]
    pub(crate) fn place_m(&self, ahead_m: f64) -> f64 {
        if self.heading.backward {
            self.heading.front_x_m - ahead_m
        } else {
            self.heading.front_x_m + ahead_m
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
