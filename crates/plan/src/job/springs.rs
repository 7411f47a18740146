//! What of a crossing rides on springs: its wheels and the motions of its bodies, with their numbers and words.
//!
//! Knows how vehicles, axles and motions are named. Does not know what they do.

use super::Job;
use pontoon_core::response::BodyMotion;

/// The words of a body's motions.
pub const BODY_QUANTITIES: [&str; 3] = ["bounce_m", "pitch_rad", "roll_rad"];

/// The word of a body's motion.
pub fn body_word(motion: BodyMotion) -> &'static str {
    BODY_QUANTITIES[motion as usize]
}

/// A wheel on its spring.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpringWheelPlace {
    /// Number of its vehicle, from 1.
    pub vehicle: usize,
    /// Number of its axle, from 1 at the front.
    pub axle: usize,
    /// Place across `[m]`.
    pub y_m: f64,
}

/// Whether any vehicle of a crossing rides on springs.
pub fn has_springs(job: &Job) -> bool {
    let Some(crossing) = job.as_crossing() else {
        return false;
    };
    match &crossing.job.traffic {
        None => job.shared.vehicle.vehicle.springs.is_some(),
        Some(traffic) => traffic
            .traffic
            .vehicles
            .iter()
            .any(|driven| driven.vehicle.springs.is_some()),
    }
}

/// The wheels of a crossing's vehicles on springs, and each such vehicle's number with the words of its body's motions.
pub fn on_springs(job: &Job) -> (Vec<SpringWheelPlace>, Vec<(usize, &'static str)>) {
    let (mut wheels, mut bodies) = (Vec::new(), Vec::new());
    let Some(crossing) = job.as_crossing().filter(|_| has_springs(job)) else {
        return (wheels, bodies);
    };
    for (vehicle, driven) in (1..).zip(&crossing.traffic().vehicles) {
        let Some(springs) = &driven.vehicle.springs else {
            continue;
        };
        wheels.extend(driven.vehicle.patches.iter().map(|patch| SpringWheelPlace {
            vehicle,
            axle: patch.axle + 1,
            y_m: patch.y_m,
        }));
        bodies.extend(springs.body.iter().map(|(motion, _)| (vehicle, body_word(*motion))));
    }
    (wheels, bodies)
}
