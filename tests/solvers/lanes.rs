//! Three dimensions for real: a vehicle in one lane, tracks at y = 1.0 and 3.0 m.

#![allow(clippy::expect_used)]

use pontoon_core::bridge::Model;
use pontoon_core::connector::Connection;
use pontoon_core::response::{CrossingResponse, StaticResponse};
use pontoon_core::vehicle::{Inertia, Vehicle};
use pontoon_tests::*;
use std::sync::OnceLock;

/// Weight of the vehicle `[N]`.
const LOAD_N: f64 = PAPER_LOAD_N;

fn lane(side: f64) -> Vehicle {
    footprint(&[side * 1.0, side * 3.0], Inertia::Local)
}

/// Gaps narrow enough that all connectors of the short bridge work.
const NARROW: Connection = gaps(0.001, 0.0005);

struct Answers {
    /// Edge deflection `[m]` and roll `[rad]`.
    edge_and_roll: [f64; 2],
    /// Each connector's force, or its largest compression and tension `[N]`.
    forces: Vec<f64>,
}

impl From<StaticResponse> for Answers {
    fn from(r: StaticResponse) -> Self {
        Self {
            edge_and_roll: [r.peak_edge_deflection_m, r.peak_roll_rad],
            forces: r.joints.iter().flat_map(|j| &j.connectors).map(|c| c.1).collect(),
        }
    }
}

impl From<CrossingResponse> for Answers {
    fn from(r: CrossingResponse) -> Self {
        let each = r.joints.iter().flat_map(|j| &j.connectors);
        Self {
            edge_and_roll: [r.peak_edge.value, r.peak_roll.value],
            forces: each.flat_map(|c| [c.1.compression.value, c.1.tension.value]).collect(),
        }
    }
}

impl Answers {
    /// Largest miss of edge deflection and roll, and of the forces, each over its own size: over a hundredth of the
    /// largest where it is smaller, so that a force of nothing is not compared with nothing.
    fn miss(&self, expected: &Self) -> [f64; 2] {
        let biggest = largest(expected.forces.iter().map(|f| f.abs()));
        let force = |(a, b): (&f64, &f64)| (a - b).abs() / b.abs().max(0.01 * biggest);
        [
            largest((0..2).map(|i| miss(self.edge_and_roll[i], expected.edge_and_roll[i]))),
            largest(self.forces.iter().zip(&expected.forces).map(force)),
        ]
    }

    /// Exchanges the two connectors of each joint, `each` numbers a connector.
    fn mirrored(mut self, each: usize) -> Self {
        self.forces
            .chunks_mut(2 * each)
            .for_each(|joint| joint.rotate_left(each));
        self
    }
}

fn static_answer(ready: &Ready, side: f64, connection: Connection, load_n: f64, x: f64) -> StaticResponse {
    let case = ready.case(connection, load_n, x);
    ready.statics(&lane(side)).solve(&case).expect("solved")
}

fn crossing_answer(ready: &Ready, side: f64, connection: Connection, load_n: f64) -> CrossingResponse {
    let solver = ready.crossings(&lane(side), &settings(ready.rayleigh(), 0.01, 0.9));
    solver.solve(&ready.crossing(connection, load_n, 8.0)).expect("solved")
}

fn pair(name: &str) -> [Ready; 2] {
    [Model::SuperElement, Model::Full].map(|model| Ready::new(&design(name), model))
}

fn smoke() -> &'static [Ready; 2] {
    static READY: OnceLock<[Ready; 2]> = OnceLock::new();
    READY.get_or_init(|| pair("smoke"))
}

fn fu2005() -> &'static [Ready; 2] {
    static READY: OnceLock<[Ready; 2]> = OnceLock::new();
    READY.get_or_init(|| pair("fu2005"))
}

/// Half a per cent and one per cent: what is asked for; the static condensation is exact and leaves 1e-11 here, the
/// crossing 1e-4, so a tenth of that is held. Twin: the vehicle 5 % heavier.
const EDGE_AND_ROLL: f64 = 5e-4;
/// Largest deviation of forces, by the reasons of [`EDGE_AND_ROLL`].
const FORCES: f64 = 1e-3;

fn hold(what: &str, right: &Answers, heavy: &Answers, expected: &Answers) {
    let [right, heavy] = [right, heavy].map(|a| a.miss(expected));
    held(&format!("{what}, edge and roll"), EDGE_AND_ROLL, right[0], heavy[0]);
    held(&format!("{what}, forces"), FORCES, right[1], heavy[1]);
}

#[test]
fn super_element_follows_the_full_model_in_statics() {
    for (name, [condensed, full], connections, x) in [
        ("smoke", smoke(), [Connection::Linear, NARROW], 8.0),
        ("fu2005", fu2005(), [Connection::Linear, PAPER_GAPS], 40.2),
    ] {
        for connection in connections {
            let answer = |ready: &Ready, load_n: f64| Answers::from(static_answer(ready, 1.0, connection, load_n, x));
            let (right, heavy) = (answer(condensed, LOAD_N), answer(condensed, 1.05 * LOAD_N));
            hold(
                &format!("{name}, {connection:?}"),
                &right,
                &heavy,
                &answer(full, LOAD_N),
            );
        }
    }
}

#[test]
fn super_element_follows_the_full_model_in_a_crossing() {
    let [condensed, full] = smoke();
    for connection in [Connection::Linear, NARROW] {
        let answer = |ready: &Ready, load_n: f64| Answers::from(crossing_answer(ready, 1.0, connection, load_n));
        let (right, heavy) = (answer(condensed, LOAD_N), answer(condensed, 1.05 * LOAD_N));
        hold(&format!("{connection:?}"), &right, &heavy, &answer(full, LOAD_N));
    }
}

/// 1e-8: rounding grows over some hundred steps and is measured at 1e-12. Twin: connectors 5 % off their places on one side.
#[test]
fn mirrored_lane_gives_the_mirrored_result() {
    let [condensed, _] = smoke();
    let skew = Ready::new(
        &with(&condensed.design, |d| d.connectors.y_m[1] *= 1.05),
        Model::SuperElement,
    );
    for connection in [Connection::Linear, NARROW] {
        let still = |ready: &Ready| {
            let [here, there] = [1.0, -1.0].map(|s| Answers::from(static_answer(ready, s, connection, LOAD_N, 8.0)));
            largest(there.mirrored(1).miss(&here))
        };
        let moving = |ready: &Ready| {
            let [here, there] = [1.0, -1.0].map(|s| Answers::from(crossing_answer(ready, s, connection, LOAD_N)));
            largest(there.mirrored(2).miss(&here))
        };
        held("mirrored statics", 1e-8, still(condensed), still(&skew));
        held("mirrored crossing", 1e-8, moving(condensed), moving(&skew));
    }
}

/// 1e-8 of the load and of each of its moments: rounding of the factorisation, measured at 2e-11. Twin: a load 5 % heavier
/// than the one that was carried. The load's own resultants are held against the hand: W, 2 m W, x W.
#[test]
fn water_and_supports_carry_the_load_and_its_moments() {
    let x = 38.0;
    let all = || smoke().iter().map(|r| (r, 8.0)).chain(fu2005().iter().map(|r| (r, x)));
    for (ready, x) in all() {
        for connection in [Connection::Linear, PAPER_GAPS] {
            let q = static_answer(ready, 1.0, connection, LOAD_N, x).equilibrium;
            let by_hand = [-LOAD_N, -2.0 * LOAD_N, x * LOAD_N];
            let left = |factor: f64| {
                largest((0..3).map(|i| (factor * by_hand[i] + q.water[i] + q.supports[i]).abs() / by_hand[i].abs()))
            };
            held("load, water and supports", 1e-8, left(1.0), left(1.05));
            held(
                "load by hand",
                1e-12,
                apart(&q.load, &by_hand),
                apart(&q.load, &by_hand.map(|q| 1.05 * q)),
            );
        }
    }
}
