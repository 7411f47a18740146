//! Traffic in both solvers: vehicles on springs, several at once, from both ends, that brake, on uneven roads.
//!
//! Knows what two solvers must answer alike and what a traffic must equal. Does not know studies.

#![allow(clippy::expect_used)]

use pontoon_core::analysis::crossing::Crossing;
use pontoon_core::bridge::Model;
use pontoon_core::connector::Connection;
use pontoon_core::response::CrossingResponse;
use pontoon_core::road::{IsoClass, RoadDesign, RoadLines, Ways};
use pontoon_core::traffic::{Drive, Driven, Traffic};
use pontoon_core::vehicle::{Axle, Body, Inertia, Vehicle, VehicleDesign};
use pontoon_tests::operated::*;
use pontoon_tests::*;
use std::sync::{Arc, OnceLock};

/// Rounding, as of rigid vehicles.
const ROUNDING: f64 = 1e-9;
const BREADTH_M: f64 = 8.082;

/// A truck of 132.3 kN: two axles 4.5 m apart on springs and tyres, its springs multiplied by `factor`.
fn truck(factor: f64, y_m: [f64; 2]) -> Vehicle {
    let axle = |behind_front_m: f64, mass: f64, suspension: [f64; 2], tyre: [f64; 2]| Axle {
        behind_front_m,
        patch_length_m: 0.3,
        track_y_m: y_m.to_vec(),
        unsprung_mass_kg: Some(mass),
        suspension_stiffness_n_m: Some(factor * suspension[0]),
        suspension_damping_n_s_m: Some(suspension[1]),
        tyre_stiffness_n_m: Some(tyre[0]),
        tyre_damping_n_s_m: Some(tyre[1]),
        ..Axle::default()
    };
    let design = VehicleDesign {
        axles: Some(vec![
            axle(0.0, 600.0, [4e5, 1e4], [1.5e6, 3e3]),
            axle(4.5, 1000.0, [1e6, 2e4], [3e6, 6e3]),
        ]),
        body: Some(Body {
            mass_kg: 11_890.8,
            behind_front_m: 2.940,
            pitch_inertia_kg_m2: Some(5e4),
            roll_inertia_kg_m2: Some(1.2e4),
            height_m: Some(1.4),
        }),
        patch_points: 4,
        ..VehicleDesign::default()
    };
    design.check(BREADTH_M).expect("a truck")
}

/// A vehicle of 200 kN, its axles' masses on the deck and its body on springs without tyres.
fn on_rigid_wheels(inertia: Inertia, factor: f64) -> Vehicle {
    let axle = |behind_front_m: f64| Axle {
        behind_front_m,
        patch_length_m: 0.6,
        track_y_m: vec![-2.0, 0.4],
        unsprung_mass_kg: Some(1500.0),
        suspension_stiffness_n_m: Some(factor * 2e6),
        suspension_damping_n_s_m: Some(3e4),
        ..Axle::default()
    };
    let design = VehicleDesign {
        axles: Some(vec![axle(0.0), axle(3.0)]),
        body: Some(Body {
            mass_kg: 17_000.0,
            behind_front_m: 1.6,
            pitch_inertia_kg_m2: Some(4e4),
            roll_inertia_kg_m2: None,
            height_m: None,
        }),
        inertia,
        ..VehicleDesign::default()
    };
    design.check(BREADTH_M).expect("a vehicle")
}

fn driven(vehicle: &Vehicle, drive: Drive) -> Driven {
    Driven {
        load_n: vehicle.weight_n.unwrap_or(PAPER_LOAD_N),
        vehicle: Arc::new(vehicle.clone()),
        drive,
    }
}

fn in_lane(vehicle: &Vehicle, y_m: f64, turned: bool) -> Vehicle {
    vehicle.in_lane(y_m, turned, BREADTH_M).expect("a lane")
}

fn late(speed_m_s: f64, start_s: f64) -> Drive {
    Drive {
        start_s,
        ..Drive::steady(speed_m_s)
    }
}

fn on(vehicles: impl Into<Vec<Driven>>) -> Traffic {
    Traffic {
        vehicles: vehicles.into(),
        road: None,
    }
}

/// A bridge of four modules and its operator of every mode.
fn four() -> &'static (Ready, Both) {
    static BOTH: OnceLock<(Ready, Both)> = OnceLock::new();
    BOTH.get_or_init(|| {
        let ready = Ready::new(&with(&design("smoke"), |d| d.modules = 4), Model::SuperElement);
        let both = Both::new(&ready, &operator(&ready, 0.0), &settings(ready.rayleigh(), 0.01, 0.9));
        (ready, both)
    })
}

fn asked(ready: &Ready, connection: Connection) -> Crossing {
    let mut crossing = ready.crossing(connection, 1.0, 1.0).crossing();
    crossing.record.positions = (1..=5).collect();
    crossing.record.joints = (2..=4).collect();
    crossing
}

/// A road of class E, so rough that wheels leave it.
fn rough(ready: &Ready, lines: RoadLines, seed: u64) -> Option<Arc<pontoon_core::road::Road>> {
    let design = RoadDesign {
        iso_8608: Some(IsoClass::E),
        seed: Some(seed),
        lines: Some(lines),
        run_in_m: Some(30.0),
        ..RoadDesign::default()
    };
    let ways = Ways {
        length_m: ready.design.length_m(),
        beyond_m: 10.0,
        y_m: &[-1.2, 1.0, -2.0, 0.4],
    };
    Some(Arc::new(design.road(&ways).expect("a road")))
}

/// Every mode in the operator: the same motion through both solvers, the same solutions and switches, energies that close with the
/// vehicles inside. Tolerance: rounding. Twins: springs 5 % off in the operator's crossing, a road of
/// another seed.
#[test]
fn operator_takes_traffic_as_the_reference_does() {
    let (ready, both) = four();
    let cases: Vec<(&str, Connection, Box<dyn Fn(f64) -> Traffic>)> = vec![
        (
            "a truck",
            PAPER_GAPS,
            Box::new(|factor| on([driven(&truck(factor, [-1.2, 1.0]), Drive::steady(6.09))])),
        ),
        (
            "a truck from the right, twice as heavy",
            Connection::Linear,
            Box::new(|factor| {
                let mut one = driven(&truck(factor, [-1.2, 1.0]), Drive::steady(-9.0));
                one.load_n *= 2.0;
                on([one])
            }),
        ),
        (
            "springs without tyres, local",
            PAPER_GAPS,
            Box::new(|factor| on([driven(&on_rigid_wheels(Inertia::Local, factor), Drive::steady(8.0))])),
        ),
        (
            "springs without tyres, convective",
            PAPER_GAPS,
            Box::new(|factor| {
                on([driven(
                    &on_rigid_wheels(Inertia::Convective, factor),
                    Drive::steady(8.0),
                )])
            }),
        ),
        (
            "five that meet and follow",
            PAPER_GAPS,
            Box::new(|factor| {
                let side = in_lane(&truck(factor, [-1.0, 1.0]), 2.0, true);
                on([
                    driven(&in_lane(&truck(factor, [-1.1, 1.1]), -2.1, false), Drive::steady(7.0)),
                    driven(&side, late(-6.0, 1.3)),
                    driven(&footprint(&[-3.0, -1.0], Inertia::Local), late(7.0, 1.9)),
                    driven(&footprint(&[0.9, 3.0], Inertia::Convective), late(-6.0, 3.3)),
                    driven(&footprint(&[-3.0, -1.0], Inertia::None), late(7.0, 3.9)),
                ])
            }),
        ),
        (
            "one that brakes and stands, one that speeds up",
            PAPER_GAPS,
            Box::new(|factor| {
                let stops = Drive {
                    acceleration_m_s2: -3.0,
                    stop_way_m: Some(15.0),
                    ..Drive::steady(8.0)
                };
                let faster = Drive {
                    acceleration_m_s2: 1.5,
                    start_s: 0.5,
                    ..Drive::steady(-4.0)
                };
                on([
                    driven(&in_lane(&truck(factor, [-1.1, 1.1]), -2.1, false), stops),
                    driven(&footprint(&[1.0, 3.0], Inertia::Convective), faster),
                ])
            }),
        ),
    ];
    let mut worst = 0.0_f64;
    for (what, connection, traffic) in &cases {
        let crossing = asked(ready, *connection);
        let [found, expected] = answers(both, &traffic(1.0), &crossing);
        let wrong = both.operated.solve(&traffic(1.05), &crossing).expect("solved");
        let [of, twin] = [&found, &wrong].map(|r| Apart::of(r, &expected, PAPER_LOAD_N).most());
        held(what, ROUNDING, of, twin);
        same_account(what, &found, &expected);
        worst = worst.max(of);
    }
    for lines in [RoadLines::Shared, RoadLines::Own] {
        let mut traffic = on([
            driven(&truck(1.0, [-1.2, 1.0]), Drive::steady(13.0)),
            driven(&truck(1.0, [-1.2, 1.0]), late(13.0, 1.0)),
        ]);
        traffic.road = rough(ready, lines, 7);
        let crossing = asked(ready, Connection::Linear);
        let [found, expected] = answers(both, &traffic, &crossing);
        traffic.road = rough(ready, lines, 8);
        let other = both.operated.solve(&traffic, &crossing).expect("solved");
        let [of, twin] = [&found, &other].map(|r| Apart::of(r, &expected, PAPER_LOAD_N).most());
        held(&format!("a rough road, {lines:?}"), ROUNDING, of, twin);
        same_account("a rough road", &found, &expected);
        assert!(found.recorded.contact_lost_s > Some(0.05), "no wheel has left the road");
    }
}

fn answers(both: &Both, traffic: &Traffic, crossing: &Crossing) -> [CrossingResponse; 2] {
    let operated = both.operated.solve(traffic, crossing).expect("solved");
    [operated, both.reference.solve(traffic, crossing).expect("solved")]
}

/// The same statistics, and energies that close.
fn same_account(what: &str, found: &CrossingResponse, expected: &CrossingResponse) {
    assert_eq!(found.statistics, expected.statistics, "{what}");
    for r in [found, expected] {
        println!("{what}: {:?} {:?}", r.energy, r.statistics);
        assert!(r.energy.energy_residual < 1e-10, "{what}: {:?}", r.energy);
    }
    let dissipation = (found.energy.numerical_dissipation - expected.energy.numerical_dissipation).abs();
    assert!(dissipation < ROUNDING, "{what}: {dissipation:e}");
}
