//! When and where the largest values of a lane occurred: of the deck's edges, of roll, of trim, and the smallest contact force.
//!
//! Knows one lane's deck corners in plain numbers. Does not know vectors: these tell when there is something to note.

use super::lane_array::LaneArray;
use super::lane_group::LaneGroup;
use super::wheel_lines::WheelLines;
use crate::response::{LeastContact, PlacedPeak};

/// Largest values of a lane with time and place. Carried from step to step.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Placed {
    /// Of the deck's edges `[m]`, a position.
    pub edge: PlacedPeak,
    /// Of a module end's roll `[rad]`, its position.
    pub roll: PlacedPeak,
    /// Of a module's trim `[rad]`, the module.
    pub trim: PlacedPeak,
    /// Smallest contact force of an axle.
    pub least_contact: LeastContact,
}

impl Placed {
    /// Notes the lowest of the deck's corners, which come module after module: left and right end, right and left edge.
    pub(super) fn note_edge(&mut self, time_s: f64, corners: &[f64]) {
        for (i, z) in corners.iter().enumerate() {
            self.edge.take(-z, time_s, position_of(i / 2));
        }
    }

    /// Notes the largest roll of an end. In the operations of the vectors, so that both find one number.
    pub(super) fn note_roll(&mut self, time_s: f64, corners: &[f64], per_m: f64) {
        for (end, z) in corners.chunks_exact(2).enumerate() {
            self.roll.take(((z[1] - z[0]) * per_m).abs(), time_s, position_of(end));
        }
    }

    /// Notes the largest trim of a module, each with half of one over its length; as [`Self::note_roll`].
    pub(super) fn note_trim(&mut self, time_s: f64, corners: &[f64], half_per_m: &[f64]) {
        for (module, (z, half)) in (1..).zip(corners.chunks_exact(4).zip(half_per_m)) {
            let trim = ((z[2] + z[3]) - (z[0] + z[1])) * half;
            self.trim.take(trim.abs(), time_s, module);
        }
    }

    /// Notes the smallest force of an axle that is whole on the bridge in a lane of a group: its weight, and what is beyond that.
    #[inline(always)]
    pub(super) fn note_axles(
        &mut self,
        time_s: f64,
        wheels: &WheelLines,
        (lane, group): (usize, &LaneGroup),
        beyond: &LaneArray,
    ) {
        for (axle, of) in group.axles.iter().enumerate() {
            if of.is_settled {
                let force_n = of.share * group.load_in(of.vehicle, lane) + beyond.at(axle, lane);
                self.least_contact.take(force_n, time_s, || wheels.axle_place(axle));
            }
        }
    }
}

/// The position of an end, which come module after module, the left one first.
fn position_of(end: usize) -> usize {
    end.div_ceil(2) + 1
}
