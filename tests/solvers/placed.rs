//! When and where the largest values of a crossing occurred: edges, roll, trim, and the smallest contact force.
//!
//! Knows what the states of the reference solver show, and closed forms. Operator and reference are held against each other in
//! `operator.rs`, over many crossings.

#![allow(clippy::expect_used)]

use pontoon_core::analysis::crossing::{Crossing, OperatorSolver};
use pontoon_core::analysis::modes::Rayleigh;
use pontoon_core::bridge::{BridgeDesign, Model, Track};
use pontoon_core::connector::Connection;
use pontoon_core::response::{AxlePlace, CrossingResponse, LeastContact, PlacedPeak, Record};
use pontoon_core::traffic::{Drive, Driven, Traffic};
use pontoon_core::vehicle::{Inertia, Vehicle};
use pontoon_core::water::WaterDistribution;
use pontoon_tests::operated::*;
use pontoon_tests::*;
use std::sync::Arc;

/// Weight of the vehicle `[N]`.
const LOAD_N: f64 = PAPER_LOAD_N;

fn smoke(modules: usize) -> BridgeDesign {
    with(&design("smoke"), |d| d.modules = modules)
}

/// Edge, roll and trim of a crossing from the deck's nodes in every state of the reference solver, length and breadth multiplied
/// by `factor`.
fn from_states(design: &BridgeDesign, (states, track): (&[Vec<f64>], &Track), h: f64, factor: f64) -> [PlacedPeak; 3] {
    let [length_m, breadth_m] = [design.module.length_m, design.module.breadth_m].map(|size| factor * size);
    let stations = track.columns() / track.lines();
    let own = stations / design.modules;
    let lines = [0, track.lines() - 1];
    let mut peaks = [PlacedPeak::default(); 3];
    for (step, u) in states.iter().enumerate() {
        let t = step as f64 * h;
        let z = |station: usize| lines.map(|line| u[track.dof(line * stations + station)]);
        for module in 1..=design.modules {
            let ends = [(module - 1) * own, module * own - 1];
            for station in ends[0]..=ends[1] {
                let is_right = 2 * (station - ends[0]) > own - 1;
                let lowest = z(station).into_iter().fold(f64::INFINITY, f64::min);
                peaks[0].take(-lowest, t, module + usize::from(is_right));
            }
            let mut mean_m = [0.0; 2];
            for end in 0..2 {
                let [right, left] = z(ends[end]);
                peaks[1].take(((left - right) / breadth_m).abs(), t, module + end);
                mean_m[end] = 0.5 * (right + left);
            }
            peaks[2].take(((mean_m[1] - mean_m[0]) / length_m).abs(), t, module);
        }
    }
    peaks
}

fn placed(r: &CrossingResponse) -> [PlacedPeak; 3] {
    [r.peak_edge, r.peak_roll, r.peak_trim]
}

/// A vehicle off the centre, one on the edge of a soft deck whose lowest place is inside a module, one with several lines there,
/// connectors with gaps. Values
/// 1e-9: sums of the same nodes in another order. Time and place are exact. Twins: length and breadth of a module, 5 % off; for
/// the edge, which has no such factor, the load.
#[test]
fn peaks_are_those_of_the_states() {
    let soft = with(&smoke(3), |d| d.module.deck_thickness_m *= 0.5);
    for (what, design, vehicle, connection) in [
        (
            "off the centre",
            smoke(4),
            footprint(&[0.3, 3.7], Inertia::Local),
            gaps(0.001, 0.0005),
        ),
        (
            "inside a module",
            soft.clone(),
            footprint(&[4.041], Inertia::None),
            Connection::Linear,
        ),
        (
            "several lines beside the edge",
            soft,
            wide_axles(&[(0.2, 1.0, 0.1, 0.0, [4.0, 4.041])], Inertia::None, 1),
            Connection::Linear,
        ),
    ] {
        let ready = Ready::new(&design, Model::SuperElement);
        let (h, track) = (0.01, Track::new(&ready.bridge));
        let both = Both::new(&ready, &operator(&ready, 0.0), &settings(ready.rayleigh(), h, 0.9));
        let crossing = ready.crossing(connection, LOAD_N, 9.0);
        let (traffic, asked) = (crossing.traffic(&vehicle), crossing.crossing());
        let mut run = both.reference.begin(&traffic, &asked);
        let mut states = vec![run.snapshot()];
        while run.step().expect("a step") {
            states.push(run.snapshot());
        }
        let from_s = states[0].time_s;
        let motion: Vec<Vec<f64>> = states.into_iter().map(|state| state.u).collect();
        let [expected, wrong] = [1.0, 1.05].map(|factor| from_states(&design, (&motion, &track), h, factor));
        let heavy = SingleCrossing {
            load_n: 1.05 * LOAD_N,
            ..crossing.clone()
        };
        let heavy = both.operated.solve_single(&vehicle, &heavy).expect("solved");
        let reference = run.finish();
        assert_eq!(
            reference.statistics.bisections, 0,
            "{what}: a state lies between two steps"
        );
        for found in [
            both.operated.solve_single(&vehicle, &crossing).expect("solved"),
            reference,
        ] {
            println!("{what}: {:?}", placed(&found));
            for (i, of) in placed(&found).into_iter().enumerate() {
                let wrong = if i == 0 { heavy.peak_edge } else { wrong[i] };
                let off = [expected[i].value, wrong.value].map(|value| miss(value, of.value));
                held(
                    &format!("{what}, {}", ["edge", "roll", "trim"][i]),
                    1e-9,
                    off[0],
                    off[1],
                );
                assert_eq!(of.at, expected[i].at, "{what}: place of {i}");
                // counted in steps here and there
                let apart_s = (of.time_s - from_s - expected[i].time_s).abs();
                assert!(apart_s < 1e-9, "{what}: time of {i} is {apart_s} off");
            }
        }
    }
}

/// Wheels near the edge, a joint in the middle of the bridge: the lowest place is a corner, whose own peak is recorded beside.
/// Exact: it is one number. Twin: the same end's corner at the other edge, more than 5 % less low.
#[test]
fn lowest_edge_is_the_lowest_of_the_corners() {
    let ready = Ready::new(&smoke(4), Model::SuperElement);
    let both = Both::new(&ready, &operator(&ready, 0.0), &settings(ready.rayleigh(), 0.01, 0.9));
    let mut crossing = ready.crossing(gaps(0.001, 0.0005), LOAD_N, 9.0);
    crossing.record = Record {
        corners: true,
        ..Record::default()
    };
    for found in both
        .solve(&footprint(&[2.0, 4.0], Inertia::Local), &crossing)
        .expect("solved")
    {
        let corners = found.recorded.corners.iter().enumerate();
        let (lowest, peak) = corners.max_by(|a, b| a.1.value.total_cmp(&b.1.value)).expect("corners");
        let edge = found.peak_edge;
        println!("{edge:?}, corner {lowest}");
        assert_eq!((edge.value, edge.time_s), (peak.value, peak.time_s));
        // left and right end, in each of them the right and the left edge
        assert_eq!(edge.at, lowest / 4 + 1 + lowest % 4 / 2);
        let beside = found.recorded.corners[lowest ^ 1].value;
        println!("{beside} beside");
        assert!(beside < 0.95 * edge.value, "{beside} beside {}", edge.value);
    }
}

/// A rigid module that floats free, under a point that creeps over it at y: `W / (p_b B L)` down,
/// `W (x - L/2) 12 / (p_b B L^3)` of trim, `W y 12 / (p_b L B^3)` of roll. All are largest at the right end, as the load leaves. The
/// damping is above the critical one and the module follows by `a v / omega^2`, 8 mm of 3.35 m, later, and a step: 1 % (measured: 0.24 %).
/// Twin: the weight.
#[test]
fn a_creeping_load_trims_a_module_as_by_hand() {
    let d = with(&with_e(&design("smoke"), 1e3), |d| {
        d.modules = 1;
        d.water_distribution = WaterDistribution::Consistent;
    });
    let ready = Ready::new(&d, Model::SuperElement);
    let (l, b, y_m) = (d.module.length_m, d.module.breadth_m, 1.5);
    let (speed_m_s, h) = (0.002, 0.5);
    let settings = settings(Rayleigh::new(4.0, 0.0), h, 0.9);
    let free = Ready {
        bridge: Arc::clone(&ready.free),
        ..ready
    };
    let both = Both::new(&free, &operator(&free, 0.0), &settings);
    let vehicle = wide_axles(&[(0.0, 1.0, 0.0, 0.0, [y_m - 1.0, y_m + 1.0])], Inertia::None, 1);
    let crossing = free.crossing(Connection::Linear, 1e4, speed_m_s);
    let by_hand = |load_n: f64| {
        let per_area = load_n / (d.p_b() * b * l);
        let (trim, roll) = (per_area * 6.0 / l, per_area * 12.0 * y_m / b.powi(2));
        [per_area + 0.5 * trim * l + 0.5 * roll * b, roll, trim]
    };
    for found in both.solve(&vehicle, &crossing).expect("solved") {
        println!("{:?} {:?}", placed(&found), by_hand(1e4));
        for (i, of) in placed(&found).into_iter().enumerate() {
            let [right, wrong] = [1e4, 1.05e4].map(|load_n| miss(by_hand(load_n)[i], of.value));
            held(["edge", "roll", "trim"][i], 1e-2, right, wrong);
        }
        // the right end, and the only module
        assert_eq!([found.peak_edge.at, found.peak_trim.at], [2, 1]);
        for time_s in [found.peak_edge.time_s, found.peak_trim.time_s] {
            assert!((time_s - l / speed_m_s).abs() <= 2.0 * h, "at {time_s} s");
        }
    }
}

/// A vehicle from the other end of the mirrored bridge: positions and modules in the other order, times as they were. Values 1e-9,
/// rounding that grows over some hundred steps; times, rounding. Three modules, so that no position is its own mirror image; a
/// speed at which no point is on a joint at the end of a step, where it would be on the module at the right both times. Twin: a load
/// 5 % heavier.
#[test]
fn a_mirrored_crossing_has_mirrored_places() {
    let there = smoke(3);
    // x is held at one end
    let back = with(&there, |d| std::mem::swap(&mut d.supports.left, &mut d.supports.right));
    let vehicle = wide_axles(
        &[(0.0, 0.3, 0.4, 0.0, [-0.4, 3.0]), (4.0, 0.7, 0.4, 0.0, [-0.4, 3.0])],
        Inertia::Local,
        4,
    );
    let solve = |design: &BridgeDesign, load_n: f64, speed_m_s: f64| {
        let ready = Ready::new(design, Model::SuperElement);
        let crossing = ready.crossing(gaps(0.001, 0.0005), load_n, speed_m_s);
        by_both(&ready, 0.01, &crossing.traffic(&vehicle), &crossing.crossing())
    };
    let [there, back, heavy] = [
        solve(&there, LOAD_N, 8.93),
        solve(&back, LOAD_N, -8.93),
        solve(&back, 1.05 * LOAD_N, -8.93),
    ];
    for ((there, back), heavy) in there.iter().zip(&back).zip(&heavy) {
        let mirrored = [5, 5, 4];
        for (i, mirrored) in mirrored.into_iter().enumerate() {
            let [there, back, heavy] = [there, back, heavy].map(|r| placed(r)[i]);
            println!("{there:?} {back:?}");
            held(
                "largest value",
                1e-9,
                miss(back.value, there.value),
                miss(heavy.value, there.value),
            );
            assert_eq!(back.at, mirrored - there.at);
            assert!((back.time_s - there.time_s).abs() < 1e-9);
        }
        assert_ne!(there.peak_trim.at, back.peak_trim.at, "the middle is its own image");
        let least = [there, back].map(|r| r.least_contact);
        println!("{least:?}");
        assert_eq!(least[0].axle, least[1].axle);
        assert!((least[0].time_s - least[1].time_s).abs() < 1e-9, "{least:?}");
    }
}

fn late(vehicle: &Vehicle, load_n: f64, speed_m_s: f64, start_s: f64) -> Driven {
    Driven {
        load_n,
        vehicle: Arc::new(vehicle.clone()),
        drive: Drive {
            start_s,
            ..Drive::steady(speed_m_s)
        },
    }
}

fn by_both(bridge: &Ready, h: f64, traffic: &Traffic, crossing: &Crossing) -> [CrossingResponse; 2] {
    let both = Both::new(bridge, &operator(bridge, 0.0), &settings(bridge.rayleigh(), h, 0.9));
    let operated = both.operated.solve(traffic, crossing).expect("solved");
    [operated, both.reference.solve(traffic, crossing).expect("solved")]
}

/// Weights alone: the smallest force is that of the lightest axle, the rear one of the second vehicle, from 50 ms after the last
/// point of its patch came onto the bridge; it stays the same, and the first time counts. Force: rounding. Time: a step, and
/// rounding. Twin: the share of the axle.
#[test]
fn smallest_contact_force_of_weights_is_the_lightest_axles() {
    let ready = Ready::new(&smoke(3), Model::SuperElement);
    let (h, speed_m_s, start_s, patch_m) = (0.01, 5.0, 1.3, 0.4);
    let of = |shares: [f64; 2]| {
        let wide = [
            (0.2, shares[0], patch_m, 0.6, [0.0, 2.0]),
            (3.0, shares[1], patch_m, 0.6, [0.0, 2.0]),
        ];
        wide_axles(&wide, Inertia::None, 4)
    };
    let traffic = Traffic {
        vehicles: vec![
            late(&of([0.45, 0.55]), LOAD_N, speed_m_s, 0.0),
            late(&of([0.6, 0.4]), LOAD_N, speed_m_s, start_s),
        ],
        road: None,
    };
    let crossing = ready.crossing(PAPER_GAPS, 1.0, 1.0).crossing();
    let points = traffic.vehicles[1].vehicle.points().map(|point| point.ahead_m);
    let last_m = -points.fold(f64::INFINITY, f64::min);
    for found in by_both(&ready, h, &traffic, &crossing) {
        let least = found.least_contact;
        println!("{least:?}");
        let [right, wrong] = [0.4, 0.42].map(|share| miss(share * LOAD_N, least.force_n));
        held("force", 1e-12, right, wrong);
        assert_eq!(least.axle, Some(AxlePlace { vehicle: 2, axle: 2 }));
        let after_s = least.time_s - (start_s + last_m / speed_m_s + 0.05);
        assert!((-1e-9..h + 1e-9).contains(&after_s), "{after_s} s after it has settled");
    }
}

/// A patch longer than the bridge never has all its points on it: no axle, and an infinite force. Exact.
#[test]
fn no_axle_has_settled() {
    let ready = Ready::new(&smoke(2), Model::SuperElement);
    let vehicle = axles(&[(0.0, 1.0, 30.0)], Inertia::Local, 12);
    let crossing = ready.crossing(PAPER_GAPS, LOAD_N, 9.0);
    for found in by_both(&ready, 0.01, &crossing.traffic(&vehicle), &crossing.crossing()) {
        assert_eq!(found.least_contact, LeastContact::default());
        assert_eq!(
            (found.least_contact.force_n, found.least_contact.axle),
            (f64::INFINITY, None)
        );
        assert!(found.peak_edge.at > 0);
    }
}

/// Corners are looked at only where a bound allows a larger value. Asked for after every step they tell the same, to the last bit,
/// from small motions to bottoms out of the water. The load 5 % off is found.
#[test]
fn corners_asked_for_in_every_step_tell_the_same() {
    let ready = Ready::new(&smoke(8), Model::SuperElement);
    let solver = OperatorSolver::new(
        &ready.bridge,
        &operator(&ready, 3e-3),
        &settings(ready.rayleigh(), 0.01, 0.9),
    );
    let told = |of: &CrossingResponse| (placed(of), of.bottom_emerged, of.deck_submerged);
    for vehicle in [
        footprint(&[-1.4, 1.4], Inertia::Local),
        footprint(&[0.3, 3.7], Inertia::Convective),
        footprint(&[4.041], Inertia::None),
    ] {
        for (connection, load_n, speed_m_s) in [
            (PAPER_GAPS, PAPER_LOAD_N, 15.0),
            (gaps(0.03, 0.01), 4.0 * PAPER_LOAD_N, 7.0),
            (Connection::Linear, 1e3, 3.0),
        ] {
            let solve = |corners: bool, load_n: f64| {
                let mut crossing = ready.crossing(connection, load_n, speed_m_s);
                (crossing.tail_s, crossing.record.corners) = (3.0, corners);
                solver.solve_single(&vehicle, &crossing).expect("a crossing")
            };
            let [seldom, always, wrong] =
                [(false, 1.0), (true, 1.0), (false, 1.05)].map(|(corners, factor)| solve(corners, factor * load_n));
            assert_eq!(told(&seldom), told(&always), "{connection:?} {load_n} {speed_m_s}");
            assert_ne!(told(&wrong).0, told(&always).0);
        }
    }
}
