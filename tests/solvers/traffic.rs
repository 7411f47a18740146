//! Traffic in both solvers: vehicles on springs, several at once, from both ends, that brake, on uneven roads.
//!
//! Knows what two solvers must answer alike and what a traffic must equal. Does not know studies.

#![allow(clippy::expect_used)]

use pontoon_core::analysis::crossing::{Crossing, CrossingSolver};
use pontoon_core::bridge::Model;
use pontoon_core::connector::Connection;
use pontoon_core::response::{CrossingResponse, Quantity};
use pontoon_core::road::{IsoClass, RoadDesign, RoadLines, Ways};
use pontoon_core::traffic::{ColumnDesign, Deck, Drive, Driven, SpacingFrom, StudyVehicle, Traffic, TrafficDesign};
use pontoon_core::vehicle::{Axle, Body, Inertia, Vehicle, VehicleDesign, VehicleMotion};
use pontoon_tests::operated::*;
use pontoon_tests::*;
use std::sync::{Arc, OnceLock};

/// Rounding, as of rigid vehicles.
const ROUNDING: f64 = 1e-9;
const BREADTH_M: f64 = 8.082;

/// A truck of 132.3 kN on springs and tyres with tracks at `y_m`, its suspensions multiplied by `factor`.
fn truck(factor: f64, y_m: [f64; 2]) -> Vehicle {
    sprung_truck(factor, |_| {}, |axle| axle.track_y_m = y_m.to_vec())
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

/// A traffic whose springs are multiplied by a factor.
type TrafficOf = Box<dyn Fn(f64) -> Traffic>;

/// Every mode in the operator: the same motion through both solvers, the same solutions and switches, energies that close with the
/// vehicles inside. Tolerance: rounding. Twins: springs 5 % off in the operator's crossing, a road of
/// another seed.
#[test]
fn operator_takes_traffic_as_the_reference_does() {
    let (ready, both) = four();
    let cases: Vec<(&str, Connection, TrafficOf)> = vec![
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

/// How far two answers to one traffic are apart in what wheels and bodies tell, over the weight of the vehicle and the largest
/// motion.
fn rides_apart(found: &CrossingResponse, expected: &CrossingResponse) -> f64 {
    let wheels = |r: &CrossingResponse| -> Vec<f64> {
        let each = r.recorded.wheels.iter();
        each.flat_map(|w| [w.largest.value, w.least.value, 1e4 * w.lost_s])
            .collect()
    };
    let motions = |r: &CrossingResponse| -> Vec<f64> {
        let each = r.recorded.motions.iter();
        each.flat_map(|m| [m.up.value, m.down.value, 1e-2 * m.acceleration.value])
            .collect()
    };
    apart(&wheels(found), &wheels(expected)).max(apart(&motions(found), &motions(expected)))
}

/// Wheels and bodies by both solvers, on a rough road that wheels leave. Tolerance: rounding. Twin: springs 5 % off.
#[test]
fn wheels_and_bodies_are_those_of_the_reference() {
    let (ready, both) = four();
    let crossing = asked(ready, PAPER_GAPS);
    let traffic = |factor: f64| {
        let mut traffic = on([
            driven(&truck(factor, [-1.2, 1.0]), Drive::steady(12.0)),
            driven(&truck(factor, [-1.2, 1.0]), late(12.0, 1.2)),
        ]);
        traffic.road = rough(ready, RoadLines::Own, 7);
        traffic
    };
    let [found, expected] = answers(both, &traffic(1.0), &crossing);
    let wrong = both.operated.solve(&traffic(1.05), &crossing).expect("solved");
    let [of, twin] = [&found, &wrong].map(|r| rides_apart(r, &expected));
    held("wheels and bodies", ROUNDING, of, twin);
    assert!(
        found.recorded.wheels.iter().any(|wheel| wheel.lost_s > 0.0),
        "no wheel has left"
    );
    assert_eq!(found.recorded.motions.len(), 6);
}

/// Where the balance of a step holds, the wheels press with the weight less the inertia of body and axles: 1e-10 of the weight,
/// rounding of some hundred steps. Twin: the body's mass 5 % off.
#[test]
fn body_and_wheels_are_in_equilibrium_at_every_step() {
    let (ready, _) = four();
    let settings = settings(ready.rayleigh(), 0.01, 0.9);
    let solver = CrossingSolver::new(&ready.bridge, &settings).expect("factors");
    let vehicle = truck(1.0, [-1.2, 1.0]);
    let springs = vehicle.springs.as_deref().expect("springs");
    let traffic = on([driven(&vehicle, Drive::steady(9.0))]);
    let crossing = asked(ready, PAPER_GAPS);
    let mut run = solver.begin(&traffic, &crossing);
    let mut states = vec![run.snapshot()];
    while run.step().expect("a step") {
        states.push(run.snapshot());
    }
    // of the spectral radius 0.9
    let (old_m, old_f) = (0.8 / 1.9, 0.9 / 1.9);
    let rises = |motion: &VehicleMotion| matches!(motion, VehicleMotion::Bounce | VehicleMotion::Hop { .. });
    let masses = |factor: f64| -> Vec<f64> {
        let each = springs.motions.iter().zip(&springs.inertia);
        let mass = |(motion, mass): (&VehicleMotion, &f64)| match motion {
            VehicleMotion::Bounce => factor * mass,
            motion if rises(motion) => *mass,
            _ => 0.0,
        };
        each.map(mass).collect()
    };
    let off = |factor: f64| {
        let masses = masses(factor);
        largest(states.windows(2).filter_map(|pair| {
            let [old, new] = [pair[0].rides.first()?, pair[1].rides.first()?];
            // it has left once it stands still
            (old.moved != new.moved).then(|| {
                let sum = |of: &[f64], weights: &[f64]| of.iter().zip(weights).map(|(a, b)| a * b).sum::<f64>();
                let ones = vec![1.0; new.wheels_n.len()];
                let pressed = (1.0 - old_f) * sum(&new.wheels_n, &ones) + old_f * sum(&old.wheels_n, &ones);
                let inertia =
                    (1.0 - old_m) * sum(&new.accelerations, &masses) + old_m * sum(&old.accelerations, &masses);
                (pressed - vehicle.weight_n.unwrap_or(0.0) - inertia).abs() / 132_300.0
            })
        }))
    };
    held("wheels less weight and inertia", 1e-10, off(1.0), off(1.05));
}

/// Weight alone on a linear bridge: two vehicles do what each does alone, added up. 1e-12 of the largest deflection. Twin: one of
/// them 5 % heavier.
#[test]
fn weights_of_two_vehicles_add_up() {
    let (ready, both) = four();
    let vehicles = [
        driven(&footprint(&[-3.0, -1.0], Inertia::None), Drive::steady(7.0)),
        driven(&footprint(&[1.0, 3.4], Inertia::None), late(-7.0, 0.5)),
    ];
    let mut crossing = asked(ready, Connection::Linear);
    // single crossings begin and end elsewhere: one long enough, read between the ends of both
    crossing.tail_s = 4.0;
    let together = answers(both, &on(vehicles.clone()), &crossing);
    let single: Vec<[CrossingResponse; 2]> = vehicles
        .iter()
        .map(|one| answers(both, &on([one.clone()]), &crossing))
        .collect();
    for solver in 0..2 {
        let at = |r: &CrossingResponse, t: f64| -> Vec<f64> {
            let times = &r.recorded.history_time_s;
            let Some(i) = times.iter().position(|time| (time - t).abs() < 1e-6) else {
                return vec![0.0; 5];
            };
            (1..=5)
                .map(|position| history(r, Quantity::Deflection, position)[i])
                .collect()
        };
        let times: Vec<f64> = (0..600).map(|i| 0.01 * f64::from(i)).collect();
        let sum = |factor: f64| -> Vec<f64> {
            let both = |t: &f64| {
                let [a, b] = [0, 1].map(|i| at(&single[i][solver], *t));
                a.into_iter()
                    .zip(b)
                    .map(move |(a, b)| a + factor * b)
                    .collect::<Vec<_>>()
            };
            times.iter().flat_map(both).collect()
        };
        let found: Vec<f64> = times.iter().flat_map(|t| at(&together[solver], *t)).collect();
        held(
            "two weights",
            1e-12,
            apart(&found, &sum(1.0)),
            apart(&found, &sum(1.05)),
        );
    }
}

/// Mirrored traffic leaves mirrored peaks: positions and joints in the other order. Tolerance: rounding. Twin: one of the vehicles
/// starts 50 ms later.
#[test]
fn mirrored_traffic_leaves_mirrored_peaks() {
    // x is held at one end
    let mirrored = with(&four().0.design, |d| {
        std::mem::swap(&mut d.supports.left, &mut d.supports.right)
    });
    let mirrored = Ready::new(&mirrored, Model::SuperElement);
    let of_mirrored = Both::new(
        &mirrored,
        &operator(&mirrored, 0.0),
        &settings(mirrored.rayleigh(), 0.01, 0.9),
    );
    let (ready, both) = four();
    let crossing = asked(ready, PAPER_GAPS);
    let traffic = |sign: f64, start_s: f64| {
        let side = |of: Vehicle, turned: bool| in_lane(&of, -2.0, turned);
        on([
            driven(&side(truck(1.0, [-1.0, 1.0]), sign < 0.0), Drive::steady(sign * 7.0)),
            driven(&footprint(&[0.9, 3.0], Inertia::Convective), late(sign * -6.0, start_s)),
        ])
    };
    let [there, back, wrong] = [(1.0, 0.7), (-1.0, 0.7), (-1.0, 0.75)].map(|(sign, start_s)| {
        let solvers = if sign > 0.0 { both } else { &of_mirrored };
        answers(solvers, &traffic(sign, start_s), &crossing)
    });
    for solver in 0..2 {
        let peaks = |r: &CrossingResponse, mirrored: bool| -> Vec<f64> {
            let mut positions: Vec<f64> = r.positions.iter().map(|p| p.deflection.value).collect();
            let mut joints: Vec<f64> = r.joints.iter().map(|j| 1e-7 * j.sum.compression.value).collect();
            if mirrored {
                positions.reverse();
                joints.reverse();
            }
            positions.into_iter().chain(joints).collect()
        };
        let expected = peaks(&there[solver], false);
        let [of, twin] = [&back, &wrong].map(|r| apart(&peaks(&r[solver], true), &expected));
        held("mirrored", 1e-9, of, twin);
    }
}

/// Two vehicles of one wheel each, nine tenths of a bridge apart on one line: all stations between them are near, which are more than the
/// vehicles have nodes. Twin: a second vehicle that is 5 % heavier.
#[test]
fn vehicles_far_behind_one_another_ride_on_one_line() {
    let ready = Ready::new(&with(&design("smoke"), |d| d.modules = 8), Model::SuperElement);
    let both = Both::new(&ready, &operator(&ready, 0.0), &settings(ready.rayleigh(), 0.02, 0.9));
    let axle = Axle {
        share: Some(1.0),
        patch_length_m: 0.1,
        track_y_m: vec![0.5],
        ..Axle::default()
    };
    let design = VehicleDesign {
        axles: Some(vec![axle]),
        inertia: Inertia::Local,
        patch_points: 1,
        ..VehicleDesign::default()
    };
    let vehicle = design.check(BREADTH_M).expect("a vehicle");
    let apart_s = 0.9 * ready.design.length_m() / 12.0;
    let column = |factor: f64| {
        let second = Driven {
            load_n: factor * 1e5,
            ..driven(&vehicle, late(12.0, apart_s))
        };
        let first = Driven {
            load_n: 1e5,
            ..driven(&vehicle, Drive::steady(12.0))
        };
        on([first, second])
    };
    let crossing = ready.crossing(PAPER_GAPS, 1.0, 1.0).crossing();
    let [found, expected] = answers(&both, &column(1.0), &crossing);
    let wrong = both.operated.solve(&column(1.05), &crossing).expect("solved");
    let off = |r: &CrossingResponse| {
        let all = |r: &CrossingResponse| -> Vec<f64> {
            r.positions.iter().map(|position| position.deflection.value).collect()
        };
        apart(&all(r), &all(&expected))
    };
    held("operator", ROUNDING, off(&found), off(&wrong));
}

/// A column is its vehicles written as one with many axles, where masses are on the deck and where they are not; vehicles farther
/// apart than the bridge is long leave what one leaves, but for what still swings. Twin: a spacing that is 5 % off.
#[test]
fn a_column_is_a_long_list_of_axles() {
    let (ready, both) = four();
    let deck = Deck {
        length_m: ready.design.length_m(),
        breadth_m: BREADTH_M,
    };
    let axle = |behind_front_m: f64, share: f64| Axle {
        behind_front_m,
        share: Some(share),
        patch_length_m: 0.6,
        track_y_m: vec![-1.0, 1.4],
        ..Axle::default()
    };
    for inertia in [Inertia::None, Inertia::Convective] {
        let design = |axles: Vec<Axle>| VehicleDesign {
            axles: Some(axles),
            inertia,
            ..VehicleDesign::default()
        };
        let own = design(vec![axle(0.0, 0.4), axle(3.0, 0.6)]);
        let column = |spacing_m: f64, speed_m_s: f64| {
            let column = ColumnDesign {
                vehicle: None,
                count: 3,
                spacing_m,
                spacing_from: SpacingFrom::TailToHead,
                load_n: None,
                speed_m_s: None,
                y_m: None,
                direction: None,
            };
            let written = TrafficDesign {
                column: Some(column),
                ..TrafficDesign::default()
            };
            let study = StudyVehicle {
                design: &own,
                load_n: Some(1e5),
                speed_m_s: Some(speed_m_s),
            };
            written.traffic(study, deck).expect("a column")
        };
        // 3.6 m from the head of the first patch to the tail of the last
        let axles = (0..3).flat_map(|i| {
            let behind = f64::from(i) * (4.0 + 3.6);
            [axle(behind, 0.4 / 3.0), axle(3.0 + behind, 0.6 / 3.0)]
        });
        let long = design(axles.collect()).check(BREADTH_M).expect("a vehicle");
        let crossing = asked(ready, PAPER_GAPS);
        let [_, expected] = answers(both, &Traffic::single(&long, 3e5, 8.0), &crossing);
        for (what, found) in ["operator", "reference"]
            .into_iter()
            .zip(answers(both, &column(4.0, 8.0), &crossing))
        {
            let wrong = both.operated.solve(&column(4.2, 8.0), &crossing).expect("solved");
            let positions = |r: &CrossingResponse| deflections(r);
            let [of, twin] = [&found, &wrong]
                .map(|r| apart(&positions(r), &positions(&expected)).max(apart(&forces(r), &forces(&expected))));
            held(&format!("{inertia:?}, {what}"), ROUNDING, of, twin);
        }
        // 250 s apart, whole steps, and no end of a patch is at a joint at the end of one
        let single = Traffic::single(&own.check(BREADTH_M).expect("one"), 1e5, 7.9);
        let [one, far, near] = [single, column(1971.4, 7.9), column(4.0, 7.9)]
            .map(|traffic| both.operated.solve(&traffic, &crossing).expect("solved"));
        let [of, twin] = [&far, &near].map(|r| apart(&deflections(r), &deflections(&one)));
        held(&format!("{inertia:?}, far apart"), ROUNDING, of, twin);
    }
}
