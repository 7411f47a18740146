//! Vehicles on springs in one lane: their motion, and what their wheels' springs ask of the deck.
//!
//! Knows one vehicle beside the deck. Does not know modes, nor where the deck is under its wheels.

use crate::bridge::VehiclePlacement;
use crate::response::RideReading;
use crate::riding::{FreeRide, Ride, RideEnergies, RidingStep, UnderWheels};
use crate::traffic::{Presence, Traffic};
use std::sync::Arc;

/// A vehicle on springs in a lane.
#[derive(Debug, Clone)]
pub(super) struct LaneRide {
    /// Its number among the vehicles.
    pub(super) vehicle: usize,
    traffic: Arc<Traffic>,
    presence: Presence,
    step: Arc<RidingStep>,
    /// What its masses and springs are multiplied by.
    scale: f64,
    pub(super) ride: Ride,
    free: FreeRide,
    /// Whether it is there at the end of the step under way.
    awake: bool,
    /// Height of deck and road under its wheels at the step's end, and the rate `[m, m/s]`.
    height_m: Vec<f64>,
    rate_m_s: Vec<f64>,
}

/// The spring of a wheel as a row of the small system, with `kappa = k + c_v c`:
/// `own lambda' + S lambda' + g A^-1 r^T lambda' = (k/kappa) r u_free + (c/kappa) (r u'_free + V r_x u_free) + known`,
/// `g = r + (c V/kappa) r_x`, u_free and its rate at the step's end without new forces. Equation (V5).
#[derive(Debug, Clone, Copy)]
pub(super) struct WheelOnDeck {
    /// `1 / ((1 - alpha_f) kappa)`.
    pub own: f64,
    /// `k/kappa`, `c/kappa`, `c V/kappa`.
    pub of_spring: f64,
    pub of_damper: f64,
    pub by_slope: f64,
    /// What road and vehicle add.
    pub known: f64,
    /// Height of the road and its rate under the wheel `[m, m/s]`.
    road: [f64; 2],
}

impl LaneRide {
    /// The vehicles on springs of a traffic, at rest.
    pub(super) fn all(traffic: &Arc<Traffic>, steps: &[Option<Arc<RidingStep>>], length_m: f64) -> Vec<Self> {
        let mut rides = Vec::new();
        for (vehicle, presence) in traffic.presences(length_m).into_iter().enumerate() {
            let Some(step) = &steps[vehicle] else { continue };
            let (driven, wheels) = (&traffic.vehicles[vehicle], step.springs().wheels.len());
            rides.push(Self {
                vehicle,
                traffic: Arc::clone(traffic),
                presence,
                scale: driven.scale(),
                ride: Ride::at_rest(step.springs(), traffic.level_m(driven.drive.backward)),
                free: FreeRide::new(step.springs()),
                step: Arc::clone(step),
                awake: false,
                height_m: vec![0.0; wheels],
                rate_m_s: vec![0.0; wheels],
            });
        }
        rides
    }

    /// Takes another step length.
    pub(super) fn take_step(&mut self, step: &Arc<RidingStep>) {
        self.step = Arc::clone(step);
    }

    /// Looks whether it is there at a time, the end of the coming step.
    #[inline(always)]
    pub(super) fn wake(&mut self, time_s: f64) {
        self.awake = self.presence.holds(time_s);
    }

    /// Begins a step: the vehicle's motion without new forces of its wheels.
    #[inline(always)]
    pub(super) fn begin_step(&mut self, placement: &VehiclePlacement) {
        if self.awake {
            self.step.predict(&self.ride, driven_m_s2(placement), &mut self.free);
        }
    }

    /// The vehicle as it is, to be read; none while it is not there.
    pub(super) fn reading(&self) -> Option<RideReading<'_>> {
        self.awake.then(|| self.ride.reading(self.step.springs(), self.scale))
    }

    /// Whether it is there.
    #[inline(always)]
    pub(super) fn is_awake(&self) -> bool {
        self.awake
    }

    /// Number of its wheels.
    #[inline(always)]
    pub(super) fn wheels(&self) -> usize {
        self.height_m.len()
    }

    /// A wheel's row.
    #[inline(always)]
    pub(super) fn wheel(&self, wheel: usize, placement: &VehiclePlacement) -> WheelOnDeck {
        let (of, kappa) = (&self.step.springs().wheels[wheel], self.step.kappa[wheel]);
        let speed_m_s = placement.heading.speed_m_s;
        let [height, slope] = self
            .traffic
            .under(self.vehicle, wheel, |ahead_m| placement.place_m(ahead_m));
        let (of_spring, of_damper) = (of.stiffness_n_m / kappa, of.damping_n_s_m / kappa);
        let road = [height, speed_m_s * slope];
        WheelOnDeck {
            own: 1.0 / (self.step.unscaling() * kappa * self.scale),
            of_spring,
            of_damper,
            by_slope: of_damper * speed_m_s,
            known: of_spring * (road[0] - self.free.y[wheel]) + of_damper * (road[1] - self.free.rate[wheel]),
            road,
        }
    }

    /// What a wheel sees of another of the vehicle's wheels beside the deck (V4).
    #[inline(always)]
    pub(super) fn among(&self, wheel: usize, other: usize) -> f64 {
        self.step.among[(wheel, other)] / self.scale
    }

    /// Whether each wheel pressed at the last step.
    #[inline(always)]
    pub(super) fn pressing(&self) -> impl Iterator<Item = bool> {
        self.ride.wheels_n.iter().map(|force| *force > 0.0)
    }

    /// Takes note of the deck under a wheel at the step's end.
    #[inline(always)]
    pub(super) fn note_deck(&mut self, wheel: usize, [height_m, rate_m_s]: [f64; 2], on_deck: &WheelOnDeck) {
        self.height_m[wheel] = height_m + on_deck.road[0];
        self.rate_m_s[wheel] = rate_m_s + on_deck.road[1];
    }

    /// Takes the vehicle to the step's end under the scaled forces of its wheels; energies beside the work on the deck.
    #[inline(always)]
    pub(super) fn end_step(&mut self, scaled: &[f64], placement: &VehiclePlacement) -> RideEnergies {
        let Self {
            step,
            ride,
            free,
            height_m,
            rate_m_s,
            scale,
            ..
        } = self;
        let under = UnderWheels {
            height_m,
            rate_m_s,
            on_deck_j: 0.0,
        };
        let per_scale = 1.0 / *scale;
        let energies = step.finish(
            ride,
            free,
            |wheel| scaled[wheel] * per_scale,
            under,
            driven_m_s2(placement),
        );
        energies.scaled(*scale)
    }
}

/// Acceleration along a vehicle's own direction.
fn driven_m_s2(placement: &VehiclePlacement) -> f64 {
    let heading = placement.heading;
    if heading.backward {
        -heading.acceleration_m_s2
    } else {
        heading.acceleration_m_s2
    }
}
