//! What a crossing reports, gathered step by step.
//!
//! Knows the bridge's observed rows and what is kept of each. Does not know the scheme.

use super::Crossing;
use super::step::Motion;
use crate::bridge::{Bridge, joint_parts};
use crate::contact::rest_force_n;
use crate::fem::SparseRow;
use crate::response::{
    AxlePlace, CrossingResponse, DeadState, EnergyBalance, ForcePeaks, JointPeaks, JointReading, LeastContact, Peak,
    PinExtremes, PinPeaks, PlacedPeak, PositionPeaks, Reading, Recorder, RideReading, Statistics,
};
use crate::traffic::Traffic;
use std::sync::Arc;

/// Gathers the response of one crossing.
#[derive(Debug)]
pub(super) struct Observer<'a> {
    bridge: &'a Bridge,
    traffic: &'a Traffic,
    positions: Vec<PositionPeaks>,
    joints: Vec<JointPeaks>,
    pins: PinWatch,
    edge: PlacedPeak,
    roll: PlacedPeak,
    trim: PlacedPeak,
    least_contact: LeastContact,
    bottom_emerged: Option<bool>,
    deck_submerged: Option<bool>,
    statistics: Statistics,
    energy: EnergyBalance,
    dead: Option<Arc<DeadState>>,
    /// Rows of the places that are followed.
    places: Vec<SparseRow>,
    recorder: Recorder,
}

impl<'a> Observer<'a> {
    pub(super) fn new(bridge: &'a Bridge, traffic: &'a Traffic, crossing: &Crossing, from_s: f64) -> Self {
        let (design, record) = (bridge.design(), &crossing.record);
        let positions = (1..=design.positions())
            .map(|position| PositionPeaks {
                position,
                x_m: design.position_x_m(position),
                deflection: Peak::default(),
                uplift: Peak::default(),
            })
            .collect();
        let per_joint = |y: &Vec<f64>| y.iter().map(|&y| (y, ForcePeaks::default())).collect();
        let joints = (2..=design.modules)
            .map(|joint| JointPeaks {
                joint,
                sum: ForcePeaks::default(),
                connectors: per_joint(&design.connectors.y_m),
            })
            .collect();
        Self {
            bridge,
            traffic,
            positions,
            joints,
            pins: PinWatch::new(bridge, record.needs_pins()),
            edge: PlacedPeak::default(),
            roll: PlacedPeak::default(),
            trim: PlacedPeak::default(),
            least_contact: LeastContact::default(),
            bottom_emerged: bridge.least_draft_m().map(|_| false),
            deck_submerged: bridge.least_freeboard_m().map(|_| false),
            statistics: Statistics::default(),
            energy: EnergyBalance::default(),
            dead: crossing.dead.clone(),
            places: record.places_x_m.iter().map(|&x_m| bridge.place(x_m)).collect(),
            recorder: Recorder::new(
                design.positions(),
                (joint_parts(design), bridge.bank_parts()),
                (traffic.ride_parts(), from_s),
                record,
            ),
        }
    }

    /// Takes note of a halved step and the Newton solutions it cost.
    pub(super) fn record_bisection(&mut self, iterations: usize) {
        self.statistics.bisections += 1;
        self.statistics.newton_iterations += iterations;
    }

    /// Takes note of the motion after an accepted step.
    pub(super) fn record_step(&mut self, old: &Motion, new: &Motion) {
        self.statistics.steps += 1;
        self.statistics.newton_iterations += new.newton_iterations;
        self.statistics.contact_switches += old.states.iter().zip(&new.states).filter(|(a, b)| a != b).count();
        self.energy.take(&new.spent);
        self.record_peaks(new);
        if let Some(balance) = &new.balance {
            self.pins.take(&balance.pins_n, balance.time_s);
        }
        self.recorder.take(&MotionReading {
            bridge: self.bridge,
            traffic: self.traffic,
            places: &self.places,
            now: new,
            dead: self.dead.as_deref(),
        });
    }

    fn record_peaks(&mut self, now: &Motion) {
        let (t, u) = (now.time_s, &now.u);
        for (peaks, row) in self.positions.iter_mut().zip(&self.bridge.positions) {
            let z = row.dot(u);
            peaks.deflection.take(-z, t);
            peaks.uplift.take(z, t);
        }
        let per_joint = self.bridge.design().connectors.y_m.len();
        for (joint, forces) in self.joints.iter_mut().zip(now.connector_forces().chunks(per_joint)) {
            joint.sum.take(forces.iter().sum(), t);
            for ((_, peaks), &force) in joint.connectors.iter_mut().zip(forces) {
                peaks.take(force, t);
            }
        }
        for (position, row) in &self.bridge.edges {
            self.edge.take(-row.dot(u), t, *position);
        }
        for (position, row) in &self.bridge.rolls {
            self.roll.take(row.dot(u).abs(), t, *position);
        }
        for (module, row) in (1..).zip(&self.bridge.trims) {
            self.trim.take(row.dot(u).abs(), t, module);
        }
        let ever = |before: Option<bool>, now: Option<bool>| before.zip(now).map(|(before, now)| before || now);
        let dead = self.dead.as_deref();
        self.bottom_emerged = ever(self.bottom_emerged, self.bridge.bottom_emerges(u, dead));
        self.deck_submerged = ever(self.deck_submerged, self.bridge.deck_submerges(u, dead));
        for (vehicle, axles) in now.load.axles.iter().enumerate() {
            for (axle, &(weight, whole)) in axles.iter().enumerate() {
                if whole {
                    let riders = now.load.riders.iter().zip(&now.rider_forces);
                    let of_axle = riders.filter(|(r, _)| r.vehicle == vehicle && r.axle == axle);
                    let force: f64 = of_axle.map(|(_, q)| q).sum();
                    let place = || AxlePlace {
                        vehicle: vehicle + 1,
                        axle: axle + 1,
                    };
                    self.least_contact.take(weight + force, t, place);
                }
            }
        }
    }

    /// Records the histories asked for at a whole step.
    pub(super) fn record_history(&mut self, now: &Motion) {
        self.recorder.note(&MotionReading {
            bridge: self.bridge,
            traffic: self.traffic,
            places: &self.places,
            now,
            dead: self.dead.as_deref(),
        });
    }

    pub(super) fn finish(mut self) -> CrossingResponse {
        CrossingResponse {
            positions: self.positions,
            joints: self.joints,
            pins: self.pins.peaks,
            peak_edge: self.edge,
            peak_roll: self.roll,
            peak_trim: self.trim,
            least_contact: self.least_contact,
            bottom_emerged: self.bottom_emerged,
            deck_submerged: self.deck_submerged,
            statistics: self.statistics,
            energy: self.energy.summary(),
            recorded: self.recorder.finish(),
        }
    }
}

/// A motion, to be read.
struct MotionReading<'a> {
    bridge: &'a Bridge,
    traffic: &'a Traffic,
    places: &'a [SparseRow],
    now: &'a Motion,
    dead: Option<&'a DeadState>,
}

impl Reading for MotionReading<'_> {
    fn times_s(&self) -> [f64; 2] {
        let now_s = self.now.time_s;
        [now_s, self.now.balance.as_ref().map_or(now_s, |balance| balance.time_s)]
    }

    fn position_m(&self, index: usize) -> f64 {
        // nothing is 0, not -0
        0.0 - self.bridge.positions[index].dot(&self.now.u)
    }

    fn place_m(&self, index: usize) -> f64 {
        0.0 - self.places[index].dot(&self.now.u)
    }

    fn corner_m(&self, index: usize) -> f64 {
        0.0 - self.bridge.deck_corners[index].dot(&self.now.u)
    }

    fn ride(&self, vehicle: usize) -> Option<RideReading<'_>> {
        let mut riders = self.now.load.riders.iter();
        riders.find(|rider| rider.vehicle == vehicle && rider.is_spring())?;
        let driven = &self.traffic.vehicles[vehicle];
        Some(self.now.rides[vehicle].reading(driven.vehicle.springs.as_ref()?, driven.scale()))
    }

    fn is_on(&self, vehicle: usize, wheel: usize) -> bool {
        let (placement, of) = (
            &self.now.load.placements[vehicle],
            &self.traffic.vehicles[vehicle].vehicle,
        );
        placement.is_on(&of.patches[wheel])
    }
}

impl JointReading for MotionReading<'_> {
    fn connector_n(&self, connector: usize) -> [f64; 2] {
        let at_balance = self.now.balance.as_ref().and_then(|of| of.connectors_n.get(connector));
        [
            self.now.connector_forces()[connector],
            at_balance
                .copied()
                .unwrap_or_else(|| rest_force_n(self.dead, connector)),
        ]
    }

    fn elongation_m(&self, connector: usize) -> f64 {
        self.now.elongations[connector] + self.dead.map_or(0.0, |dead| dead.elongations_m[connector])
    }

    fn spring_m(&self, spring: usize) -> f64 {
        self.bridge.springs[spring].row.dot(&self.now.u) + self.dead.map_or(0.0, |dead| dead.springs_m[spring])
    }

    fn pin_n(&self, pin: usize) -> [f64; 3] {
        match &self.now.balance {
            Some(of) => of.pins_n.get(pin).copied().unwrap_or_default(),
            None => self.dead.map_or([0.0; 3], |dead| dead.pins_n[pin]),
        }
    }
}

/// Watches the pins: each joint's, then their sum.
#[derive(Debug)]
pub(super) struct PinWatch {
    /// Nothing where nobody asks.
    pub(super) peaks: Vec<PinPeaks>,
}

impl PinWatch {
    pub(super) fn new(bridge: &Bridge, wanted: bool) -> Self {
        let mut peaks = Vec::new();
        for joint in bridge
            .pins
            .chunk_by(|a, b| wanted && a.joint == b.joint)
            .filter(|_| wanted)
        {
            let places = joint.iter().map(|pin| Some(pin.y_m)).chain([None]);
            peaks.extend(places.map(|y_m| PinPeaks {
                joint: joint[0].joint,
                y_m,
                extremes: PinExtremes::default(),
            }));
        }
        Self { peaks }
    }

    /// Takes the forces of all pins, joint after joint, at `time_s`.
    pub(super) fn take(&mut self, forces_n: &[[f64; 3]], time_s: f64) {
        let (mut forces, mut sum) = (forces_n.iter(), [0.0; 3]);
        for peaks in &mut self.peaks {
            let force = match peaks.y_m {
                None => std::mem::take(&mut sum),
                Some(_) => {
                    let force = *forces.next().unwrap_or(&[0.0; 3]);
                    (0..3).for_each(|d| sum[d] += force[d]);
                    force
                }
            };
            peaks.extremes.take(force, time_s);
        }
    }
}
