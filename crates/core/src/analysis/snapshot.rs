//! The whole state of a bridge under a vehicle at one time, for who wants to see it and not only its peaks.
//!
//! Knows what moves, what the connectors do and with which force each wheel point stands on the deck. Does not know which
//! solver found it, nor where nodes are.

use crate::bridge::{Bridge, Load, PinRow, Track};
use crate::connector::State;
use crate::fem::SparseRow;
use crate::response::DeadState;
use crate::vehicle::{Inertia, Vehicle};
use std::sync::Arc;

/// A bridge under a vehicle at one time.
#[derive(Debug, Clone, PartialEq)]
pub struct Snapshot {
    /// The time `[s]`; 0 of a static case.
    pub time_s: f64,
    /// Displacement of each dof of the bridge `[m or rad]`.
    pub u: Vec<f64>,
    /// What the stiffness acts on, `u + a u'` with the damping's a.
    pub elastic: Vec<f64>,
    /// What the mass acts on, `u'' + b u'`; none of a static case.
    pub inertial: Option<Vec<f64>>,
    /// The connectors in the bridge's order.
    pub connectors: Vec<ConnectorNow>,
    /// The vehicle's points, patch after patch.
    pub wheels: Vec<WheelNow>,
    /// The dead state, which the motion contains.
    pub dead: Option<Arc<DeadState>>,
}

impl Snapshot {
    /// Force of each pin of a bridge on the module left of it, along, across and up, joint after joint `[N]`. At the end of a step of
    /// a crossing the two sides of a pin differ, as the balance holds before it.
    /// Equation (J6).
    pub fn pin_forces_n(&self, bridge: &Bridge) -> Vec<[f64; 3]> {
        let pressed = |wheel: &WheelNow| Some(SparseRow::combine(&[(wheel.contact_force_n, wheel.row.as_ref()?)]));
        let down: Vec<SparseRow> = self.wheels.iter().filter_map(pressed).collect();
        let mut elastic = self.elastic.clone();
        if let Some(dead) = &self.dead {
            elastic
                .iter_mut()
                .zip(&dead.displacements)
                .for_each(|(u, at_rest)| *u -= at_rest);
        }
        let row = |row: &PinRow| row.force_n(&elastic, self.inertial.as_deref(), &down);
        let moved = bridge.pins.iter().map(|pin| pin.rows.each_ref().map(row));
        match &self.dead {
            None => moved.collect(),
            Some(dead) => moved
                .zip(&dead.pins_n)
                .map(|(moved, rest)| [0, 1, 2].map(|d| moved[d] + rest[d]))
                .collect(),
        }
    }
}

/// A connector at one time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ConnectorNow {
    /// Which truss is at work.
    pub state: State,
    /// Force, tension positive `[N]`.
    pub force_n: f64,
    /// Elongation `[m]`.
    pub elongation_m: f64,
}

/// A point of the vehicle at one time.
#[derive(Debug, Clone, PartialEq)]
pub struct WheelNow {
    /// Number of its axle, from 0.
    pub axle: usize,
    /// Number of its patch, from 0.
    pub patch: usize,
    /// Place along the bridge `[m]`.
    pub x_m: f64,
    /// Place across `[m]`.
    pub y_m: f64,
    /// The track's row under it; none off the bridge.
    pub row: Option<SparseRow>,
    /// Force between it and the deck, weight and inertia, downward on the deck positive `[N]`; 0 off the bridge.
    pub contact_force_n: f64,
}

pub(super) fn connectors(states: &[State], forces: &[f64], elongations: &[f64]) -> Vec<ConnectorNow> {
    let each = states.iter().zip(forces).zip(elongations);
    each.map(|((&state, &force_n), &elongation_m)| ConnectorNow {
        state,
        force_n,
        elongation_m,
    })
    .collect()
}

/// The points of a vehicle of weight `load_n` whose load on the track is `load`; `inertia` is the inertia force of each of the
/// load's riders `[N]`: a point's own, or its share of the patch's.
pub(super) fn wheels(track: &Track, vehicle: &Vehicle, load_n: f64, load: &Load, inertia: &[f64]) -> Vec<WheelNow> {
    debug_assert_eq!(load.riders.len(), inertia.len());
    let placement = &load.placement;
    let mut inertia = inertia.iter().copied();
    let mut wheels = Vec::new();
    for (number, patch) in vehicle.patches.iter().enumerate() {
        let share_on = placement.share_on(patch);
        let of_patch = if vehicle.inertia == Inertia::Convective && share_on > 0.0 {
            inertia.next().unwrap_or_default()
        } else {
            0.0
        };
        for point in &patch.points {
            let row = placement.row(track, point);
            let contact_force_n = match (&row, vehicle.inertia) {
                (None, _) => 0.0,
                (Some(_), Inertia::None) => load_n * point.share,
                (Some(_), Inertia::Local) => load_n * point.share + inertia.next().unwrap_or_default(),
                (Some(_), Inertia::Convective) => (load_n + of_patch / share_on) * point.share,
            };
            wheels.push(WheelNow {
                axle: patch.axle,
                patch: number,
                x_m: placement.x_m(point),
                y_m: point.y_m,
                row,
                contact_force_n,
            });
        }
    }
    wheels
}
