//! The whole state of a bridge under a vehicle at one time, for who wants to see it and not only its peaks.
//!
//! Knows what moves, what the connectors do and with which force each wheel point stands on the deck. Does not know which
//! solver found it, nor where nodes are.

use crate::bridge::{Acting, Bridge, Load, PinRow, Rider, Track};
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
    /// What the water's springs do not feel of it, where damping is the structure's alone.
    pub beyond_water: Option<Vec<f64>>,
    /// Forces of water with memory on heave, pitch and roll of each module `[N, N m]`; none of other waters.
    pub waves: Option<Vec<f64>>,
    /// What the mass acts on, `u'' + b u'`; none of a static case.
    pub inertial: Option<Vec<f64>>,
    /// The connectors in the bridge's order.
    pub connectors: Vec<ConnectorNow>,
    /// The vehicles' points, patch after patch.
    pub wheels: Vec<WheelNow>,
    /// The vehicles on springs.
    pub rides: Vec<RideNow>,
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
        let acting = Acting {
            elastic: &elastic,
            beyond_water: self.beyond_water.as_deref(),
            inertial: self.inertial.as_deref(),
            waves: self.waves.as_deref(),
            down: &down,
        };
        let row = |row: &PinRow| row.force_n(&acting);
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

/// A vehicle on springs at one time.
#[derive(Debug, Clone, PartialEq)]
pub struct RideNow {
    /// Its number, from 0.
    pub vehicle: usize,
    /// How far each of its motions is from rest on a level road, in their order, upward `[m, rad]`.
    pub moved: Vec<f64>,
    /// Their accelerations `[m/s^2, rad/s^2]`.
    pub accelerations: Vec<f64>,
    /// Force of each wheel's spring on the deck or the road beside it `[N]`.
    pub wheels_n: Vec<f64>,
}

/// A point of a vehicle at one time.
#[derive(Debug, Clone, PartialEq)]
pub struct WheelNow {
    /// Number of its vehicle, from 0.
    pub vehicle: usize,
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

/// The points of vehicles and their weights whose load on the track is `load`; `forces` are those of each of the load's riders
/// `[N]`: a point's own, or to be shared by the points of a patch.
pub(super) fn wheels<'a>(
    track: &Track,
    vehicles: impl IntoIterator<Item = (&'a Vehicle, f64)>,
    load: &Load,
    forces: &[f64],
) -> Vec<WheelNow> {
    debug_assert_eq!(load.riders.len(), forces.len());
    let mut riders = load.riders.iter().zip(forces).peekable();
    let mut wheels = Vec::new();
    for (number, (vehicle, load_n)) in vehicles.into_iter().enumerate() {
        let placement = &load.placements[number];
        for (patch_number, patch) in vehicle.patches.iter().enumerate() {
            let points: Vec<Option<SparseRow>> = patch.points.iter().map(|p| placement.row(track, p)).collect();
            // a rider a point where its mass moves with the deck under that
            let mut of_points = vec![0.0; points.len()];
            if vehicle.inertia == Inertia::Local && patch.rigid > 0.0 {
                let on = of_points.iter_mut().zip(&points).filter(|(_, row)| row.is_some());
                on.for_each(|(to, _)| *to = riders.next().map_or(0.0, |(_, force)| *force));
            }
            let share_on = placement.share_on(patch);
            let mut shared = |is: fn(&Rider) -> bool, shares: f64| {
                riders
                    .next_if(|(rider, _)| rider.vehicle == number && is(rider))
                    .map_or(0.0, |(_, force)| force / shares)
            };
            let mut per_share = 0.0;
            if vehicle.inertia == Inertia::Convective && patch.rigid > 0.0 && share_on > 0.0 {
                per_share += shared(|rider| !rider.is_spring(), share_on);
            }
            let rigid = load_n * patch.rigid + per_share;
            let spring = if vehicle.springs.is_some() {
                shared(Rider::is_spring, patch.share)
            } else {
                0.0
            };
            for ((point, row), own) in patch.points.iter().zip(points).zip(of_points) {
                let contact_force_n = match row {
                    None => 0.0,
                    Some(_) => (rigid + spring) * point.share + own,
                };
                wheels.push(WheelNow {
                    vehicle: number,
                    axle: patch.axle,
                    patch: patch_number,
                    x_m: placement.x_m(point),
                    y_m: point.y_m,
                    row,
                    contact_force_n,
                });
            }
        }
    }
    wheels
}
