//! Rows of vehicles on springs: forces of their wheels, motion of their bodies.
//!
//! Knows which numbers a wheel and a body leave. Does not know tables.

use super::extreme::Extreme;
use pontoon_plan::job::{Job, SpringWheelPlace, on_springs};
use serde::{Deserialize, Serialize};

/// A row of the table of wheels.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct WheelRow {
    /// Number of its vehicle, from 1.
    pub vehicle: usize,
    /// Number of its axle, from 1 at the front.
    pub axle: usize,
    /// Place across `[m]`.
    pub y_m: f64,
    /// Largest force `[N]`.
    pub largest: Extreme,
    /// Smallest force `[N]`; null where it was never on the bridge.
    pub least: Extreme,
    /// For how long it had left the deck `[s]`.
    pub lost_s: Option<f64>,
}

/// A row of the table of bodies.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BodyRow {
    /// Number of its vehicle, from 1.
    pub vehicle: usize,
    /// Which motion, by its word, which has its unit.
    pub quantity: String,
    /// Largest upward, and downward.
    pub sides: [Extreme; 2],
    /// Largest acceleration, in that unit a second squared.
    pub acceleration: Extreme,
}

/// The rows of the wheels and bodies of a job that failed.
pub(super) fn vehicle_rows_of_none(job: &Job) -> (Vec<WheelRow>, Vec<BodyRow>) {
    let none = Extreme::default();
    let (wheels, bodies) = on_springs(job);
    let wheel = |of: SpringWheelPlace| WheelRow {
        vehicle: of.vehicle,
        axle: of.axle,
        y_m: of.y_m,
        largest: none,
        least: none,
        lost_s: None,
    };
    let body = |(vehicle, quantity): (usize, &str)| BodyRow {
        vehicle,
        quantity: quantity.to_owned(),
        sides: [none; 2],
        acceleration: none,
    };
    (
        wheels.into_iter().map(wheel).collect(),
        bodies.into_iter().map(body).collect(),
    )
}
