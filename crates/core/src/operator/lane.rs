//! One crossing in its lane: its vehicle, law and speed, and what it has beside the numbers of [`super::motion`].
//!
//! Knows where the vehicle is and what it weighs on. Does not know the lanes beside it.

use super::riders::Riders;
use super::settle::{Small, Unsettled};
use super::wheels::{Ride, Wheels};
use crate::connector::Law;
use crate::response::Statistics;
use std::sync::Arc;

/// One crossing as its lane knows it.
#[derive(Debug, Clone)]
pub(crate) struct Passage {
    /// The vehicle on the deck.
    pub wheels: Arc<Wheels>,
    /// Its small flexibilities at the step length.
    pub ride: Arc<Ride>,
    /// The connectors' law.
    pub law: Law,
    /// Weight of the vehicle `[N]`.
    pub load_n: f64,
    /// Speed `[m/s]`.
    pub speed_m_s: f64,
}

/// What a lane has beside its numbers.
#[derive(Debug)]
pub(super) struct Lane {
    pub passage: Option<Passage>,
    /// Place of the vehicle's front at the end of the step under way `[m]`, and the time then `[s]`.
    pub front_x_m: f64,
    pub time_s: f64,
    pub small: Small,
    pub riders: Riders,
    /// Weight on each axle that is on the bridge `[N]`, and whether all its points are.
    pub axles: Vec<(f64, bool)>,
    pub inertia: Vec<f64>,
    /// Downward forces on stations: line, station, force; lines of the weights, then of the masses.
    pub weights: Vec<(usize, usize, f64)>,
    pub masses: Vec<(usize, usize, f64)>,
    /// Steps since the vehicle left, up to two: by then all traces of its load are zero.
    pub unloaded: u8,
    pub statistics: Statistics,
    pub unsettled: Option<Unsettled>,
}

impl Lane {
    /// A free lane, with room for vehicles of at most `most_nodes` nodes.
    pub(super) fn new(connectors: usize, most_nodes: usize, newton_limit: usize) -> Self {
        Self {
            passage: None,
            front_x_m: 0.0,
            time_s: 0.0,
            small: Small::new(connectors, most_nodes, newton_limit),
            riders: Riders::new(connectors, most_nodes),
            axles: Vec::new(),
            inertia: Vec::new(),
            weights: Vec::with_capacity(most_nodes),
            masses: Vec::with_capacity(most_nodes),
            unloaded: 0,
            statistics: Statistics::default(),
            unsettled: None,
        }
    }
}
