//! What vehicles on springs leave behind: extremes of their wheels' forces and of their bodies' motion.
//!
//! Knows what is kept of each. Does not know how a vehicle moves.

use super::peaks::Peak;
use super::ride::{BodyMotion, RideReading};

/// What a vehicle on springs consists of.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct RidePart {
    /// Its number, from 0.
    pub vehicle: usize,
    /// Axle, from 0, and place across `[m]` of each wheel.
    pub wheels: Vec<(usize, f64)>,
    /// The motions of its body, each with its place among those of the vehicle.
    pub motions: Vec<(BodyMotion, usize)>,
}

/// Extremes of a wheel's force while all its points are on the bridge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WheelPeaks {
    /// Its vehicle and axle, from 0.
    pub vehicle: usize,
    /// Axle, from 0.
    pub axle: usize,
    /// Place across `[m]`.
    pub y_m: f64,
    /// Largest force `[N]`.
    pub largest: Peak,
    /// Smallest force and when; infinite where the wheel was never on the bridge `[N]`.
    pub least: Peak,
    /// For how long it had left the deck `[s]`.
    pub lost_s: f64,
}

/// Extremes of a body's motion while one of its wheels is on the bridge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotionPeaks {
    /// The vehicle, from 0.
    pub vehicle: usize,
    /// Which motion.
    pub motion: BodyMotion,
    /// Largest upward and downward from rest on a level road.
    pub up: Peak,
    /// Downward.
    pub down: Peak,
    /// Largest acceleration, either sense.
    pub acceleration: Peak,
}

/// Watches the vehicles on springs of a crossing.
#[derive(Debug, Clone, Default)]
pub(crate) struct RideWatch {
    parts: Vec<RidePart>,
    pub(crate) wheels: Vec<WheelPeaks>,
    pub(crate) motions: Vec<MotionPeaks>,
    /// For how long any wheel had left the deck `[s]`.
    pub(crate) lost_s: f64,
    last_s: f64,
}

impl RideWatch {
    /// Watches from a time on.
    pub(crate) fn new(parts: Vec<RidePart>, from_s: f64) -> Self {
        let wheel = |part: &RidePart, &(axle, y_m): &(usize, f64)| WheelPeaks {
            vehicle: part.vehicle,
            axle,
            y_m,
            largest: Peak::default(),
            least: Peak {
                value: f64::INFINITY,
                time_s: 0.0,
            },
            lost_s: 0.0,
        };
        let motion = |part: &RidePart, &(motion, _): &(BodyMotion, usize)| MotionPeaks {
            vehicle: part.vehicle,
            motion,
            up: Peak::default(),
            down: Peak::default(),
            acceleration: Peak::default(),
        };
        Self {
            wheels: parts
                .iter()
                .flat_map(|part| part.wheels.iter().map(move |of| wheel(part, of)))
                .collect(),
            motions: parts
                .iter()
                .flat_map(|part| part.motions.iter().map(move |of| motion(part, of)))
                .collect(),
            parts,
            lost_s: 0.0,
            last_s: from_s,
        }
    }

    /// Whether there is nothing to watch.
    #[inline]
    pub(crate) fn is_empty(&self) -> bool {
        self.parts.is_empty()
    }

    /// Takes note of a step's end; `read` gives a vehicle, none while it is not there, `is_on` whether all points of a wheel are on
    /// the bridge.
    pub(crate) fn take<'a>(
        &mut self,
        now_s: f64,
        read: impl Fn(usize) -> Option<RideReading<'a>>,
        is_on: impl Fn(usize, usize) -> bool,
    ) {
        let passed_s = now_s - std::mem::replace(&mut self.last_s, now_s);
        let (mut wheels, mut motions) = (self.wheels.iter_mut(), self.motions.iter_mut());
        let mut any_lost = false;
        for part in &self.parts {
            let ride = read(part.vehicle);
            let mut any_on = false;
            for (number, peaks) in (0..part.wheels.len()).zip(&mut wheels) {
                let Some(ride) = ride.filter(|_| is_on(part.vehicle, number)) else {
                    continue;
                };
                any_on = true;
                let force_n = ride.wheel_n(number);
                peaks.largest.take(force_n, now_s);
                if force_n < peaks.least.value {
                    peaks.least = Peak {
                        value: force_n,
                        time_s: now_s,
                    };
                }
                if force_n == 0.0 {
                    peaks.lost_s += passed_s;
                    any_lost = true;
                }
            }
            for (&(_, place), peaks) in part.motions.iter().zip(&mut motions) {
                let Some(ride) = ride.filter(|_| any_on) else { continue };
                let moved = ride.state[place] - ride.rest[place];
                peaks.up.take(moved, now_s);
                peaks.down.take(-moved, now_s);
                peaks.acceleration.take(ride.accelerations[place].abs(), now_s);
            }
        }
        if any_lost {
            self.lost_s += passed_s;
        }
    }
}
