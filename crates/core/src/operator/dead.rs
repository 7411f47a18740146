//! The dead state of one lane's crossing: the structure feels what the links' forces are beyond those at rest.
//!
//! Knows the forces at rest and what they would undo in a step. Does not know how the dead state was found.

use super::lane_array::LaneArray;
use super::rider_block::RiderBlock;
use crate::response::DeadState;
use nalgebra::{DMatrix, DVector};
use std::sync::Arc;

/// A dead state and what a step of one length needs of it.
#[derive(Debug)]
pub(super) struct LaneDead {
    pub(super) state: Arc<DeadState>,
    /// Weight of the new force in the balance, and the step length for which the rest was made `[s]`.
    weight: f64,
    step_s: f64,
    /// Scaled forces at rest `N' = weight N` `[N]`, and elongations that they would undo `[m]`.
    scaled: DVector<f64>,
    held: DVector<f64>,
}

impl LaneDead {
    /// Of a crossing that starts from `state`.
    pub(super) fn new(state: &Arc<DeadState>) -> Self {
        let links = state.forces_n.len();
        Self {
            state: Arc::clone(state),
            weight: 0.0,
            step_s: 0.0,
            scaled: DVector::zeros(links),
            held: DVector::zeros(links),
        }
    }

    /// Takes the forces at rest out of the small system of a step (D3): `e` and the riders' measures are then those without more
    /// forces than at rest.
    // the step of a crossing without a dead load stays short
    #[inline(never)]
    pub(super) fn begin_step(
        &mut self,
        (step_s, weight): (f64, f64),
        compliance: &DMatrix<f64>,
        (lane, e): (usize, &mut LaneArray),
        riders: &mut RiderBlock,
    ) {
        if self.step_s != step_s || self.weight != weight {
            (self.step_s, self.weight) = (step_s, weight);
            for (scaled, n) in self.scaled.iter_mut().zip(&self.state.forces_n) {
                *scaled = weight * n;
            }
            self.held = compliance * &self.scaled;
        }
        for (e, held) in e.lane_mut(lane).zip(self.held.iter()) {
            *e += held;
        }
        riders.add_links(lane, self.scaled.as_slice());
    }

    /// Leaves of the scaled forces found what they are beyond those at rest.
    #[inline(never)]
    pub(super) fn end_step(&self, lane: usize, forces: &mut LaneArray) {
        for (force, at_rest) in forces.lane_mut(lane).zip(self.scaled.iter()) {
            *force -= at_rest;
        }
    }
}
