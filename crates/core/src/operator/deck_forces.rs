//! Forces on the deck, of one lane and of all.
//!
//! Knows lines, stations and nodes. Does not know who exerts forces.

use super::lane_array::LaneArray;
use super::wheel_lines::DeckNode;

/// A force on a station of a line of the deck: line, station, downward force `[N]`.
pub(super) type StationForce = (usize, usize, f64);

/// Nodes and a row of forces for each of them.
#[derive(Debug, Clone, Copy)]
pub(super) struct NodeForces<'a> {
    pub nodes: &'a [DeckNode],
    pub forces: &'a LaneArray,
    /// What the forces are multiplied by.
    pub factor: f64,
}
