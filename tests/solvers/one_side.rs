//! A crossing that is its own mirror image is solved on one side of a bridge that is, and is the crossing of the whole bridge.

#![allow(clippy::expect_used)]

use pontoon_core::analysis::crossing::OperatorSolver;
use pontoon_core::bridge::{BridgeDesign, Model};
use pontoon_core::connector::{ConnectorLaw, EndStop, Truss};
use pontoon_core::operator::{BridgeOperator, Followed};
use pontoon_core::response::{BodyMotion, CrossingResponse, ForcePeaks, MotionPeaks, Record, Subject};
use pontoon_core::road::{IsoClass, Road, RoadDesign, RoadLines, Ways};
use pontoon_core::stop::Stop;
use pontoon_core::traffic::{Drive, Driven, Traffic};
use pontoon_core::vehicle::{Axle, Inertia, Vehicle};
use pontoon_tests::operated::*;
use pontoon_tests::*;
use std::sync::Arc;

/// Rounding of sums in another order, over some hundred steps and a few impacts.
const ROUNDING: f64 = 1e-8;

fn ready_with(change: impl FnOnce(&mut BridgeDesign)) -> Ready {
    Ready::new(&with(&design("smoke"), change), Model::SuperElement)
}

/// The solver that uses the side, and the one that does not.
fn solvers(ready: &Ready) -> [OperatorSolver; 2] {
    let settings = settings(ready.rayleigh(), 0.02, 0.9);
    let followed = Followed {
        pins: true,
        places_x_m: Vec::new(),
    };
    let operator = BridgeOperator::new_unless(&ready.bridge, 3e-3, &followed, Stop::never());
    let operator = Arc::new(operator.expect("an operator"));
    let new = || OperatorSolver::new(&ready.bridge, &operator, &settings);
    [new(), new().without_sides()]
}

fn crossing(ready: &Ready) -> SingleCrossing {
    let mut crossing = ready.crossing(gaps(0.002, 0.001), PAPER_LOAD_N, 12.0);
    crossing.tail_s = 1.0;
    crossing.record = Record {
        positions: vec![2],
        joints: vec![2],
        more: vec![
            Subject::Connector { joint: 2, index: 0 },
            Subject::Connector { joint: 2, index: 1 },
        ],
        corners: true,
        pins: true,
        sections: true,
        ..Record::default()
    };
    crossing
}

/// The largest difference between two answers, over the largest number of each kind.
fn apart(a: &CrossingResponse, b: &CrossingResponse) -> f64 {
    let forces = |of: &ForcePeaks| [of.compression.value, of.tension.value];
    let lists = |of: &CrossingResponse| -> Vec<Vec<f64>> {
        let joints = of.joints.iter().flat_map(|joint| {
            let connectors = joint.connectors.iter().flat_map(|(_, peaks)| forces(peaks));
            forces(&joint.sum).into_iter().chain(connectors).collect::<Vec<_>>()
        });
        let histories = of.recorded.histories.iter().map(|history| history.values.clone());
        let mut lists = vec![
            of.positions
                .iter()
                .flat_map(|position| [position.deflection.value, position.uplift.value])
                .collect(),
            joints.collect(),
            of.pins
                .iter()
                .flat_map(|pin| pin.extremes.components.iter().flat_map(forces))
                .collect(),
            of.recorded.sections.iter().flat_map(|of| forces(&of.peaks)).collect(),
            vec![of.peak_edge.value],
            vec![of.peak_trim.value],
            vec![if of.least_contact.axle.is_some() {
                of.least_contact.force_n
            } else {
                0.0
            }],
            of.recorded.corners.iter().map(|corner| corner.value).collect(),
        ];
        lists.extend(histories);
        lists
    };
    let (a, b) = (lists(a), lists(b));
    assert_eq!(a.len(), b.len());
    let of_list = |(a, b): (&Vec<f64>, &Vec<f64>)| {
        assert_eq!(a.len(), b.len());
        let most = b.iter().fold(0.0_f64, |most, x| most.max(x.abs())).max(1e-30);
        a.iter().zip(b).map(|(a, b)| (a - b).abs() / most).fold(0.0, f64::max)
    };
    a.iter().zip(&b).map(of_list).fold(0.0, f64::max)
}

fn answers(solvers: &[OperatorSolver; 2], vehicle: &Vehicle, crossing: &SingleCrossing) -> [CrossingResponse; 2] {
    let of = |solver: &OperatorSolver| solver.solve_single(vehicle, crossing).expect("a crossing");
    [of(&solvers[0]), of(&solvers[1])]
}

fn is_on_one_side(solver: &OperatorSolver, vehicle: &Vehicle, crossing: &SingleCrossing) -> bool {
    solver.is_on_one_side(&crossing.traffic(vehicle), &crossing.crossing())
}

/// Each kind of inertia, one patch on the centre line, patches of a width; peaks, energies, histories of both sides' connectors.
/// A load that is 5 % off is found.
#[test]
fn one_side_is_the_whole_bridge() {
    let ready = ready_with(|design| design.modules = 6);
    let solvers = solvers(&ready);
    let crossing = crossing(&ready);
    for inertia in [Inertia::None, Inertia::Local, Inertia::Convective] {
        for vehicle in [
            footprint(&[-1.4, 1.4], inertia),
            footprint(&[-1.4, 0.0, 1.4], inertia),
            wide_axles(
                &[(0.2, 0.4, 0.5, 0.3, [-1.4, 1.4]), (3.0, 0.6, 0.5, 0.2, [-1.2, 1.2])],
                inertia,
                3,
            ),
        ] {
            assert!(is_on_one_side(&solvers[0], &vehicle, &crossing));
            assert!(!is_on_one_side(&solvers[1], &vehicle, &crossing));
            let whole = solvers[0].operator().cutoff().modes;
            assert!(solvers[0].one_side_modes().is_some_and(|modes| modes < whole));
            let [side, whole] = answers(&solvers, &vehicle, &crossing);
            let off = apart(&side, &whole);
            assert!(off < ROUNDING, "{inertia:?}: {off:e}");
            assert_eq!(
                side.statistics.contact_switches, whole.statistics.contact_switches,
                "{inertia:?}"
            );
            assert!(side.energy.energy_residual < 1e-11 && side.peak_roll.value == 0.0);
            let heavier = SingleCrossing {
                load_n: 1.05 * crossing.load_n,
                ..crossing.clone()
            };
            let [wrong, _] = answers(&solvers, &vehicle, &heavier);
            assert!(apart(&wrong, &whole) > 1e-3, "{inertia:?}: a wrong load passes");
        }
    }
}

/// A truck on springs in the middle, its suspensions multiplied by `factor`; without tyres the masses of its axles lie on the deck.
fn truck(factor: f64, inertia: Inertia, has_tyres: bool) -> Vehicle {
    let change_axle = |axle: &mut Axle| {
        (axle.track_y_m, axle.patch_width_m) = (vec![-1.1, 1.1], 0.2);
        if !has_tyres {
            (axle.tyre_stiffness_n_m, axle.tyre_damping_n_s_m) = (None, None);
        }
    };
    sprung_truck(factor, |design| design.inertia = inertia, change_axle)
}

/// A road of class E, so rough that wheels leave it.
fn rough(ready: &Ready, lines: RoadLines) -> Arc<Road> {
    let design = RoadDesign {
        iso_8608: Some(IsoClass::E),
        seed: Some(7),
        lines: Some(lines),
        run_in_m: Some(30.0),
        ..RoadDesign::default()
    };
    let ways = Ways {
        length_m: ready.design.length_m(),
        beyond_m: 10.0,
        y_m: &[-1.1, 1.1],
    };
    Arc::new(design.road(&ways).expect("a road"))
}

/// Two trucks on springs, with tyres and with the masses of the axles on the deck, braking, on a road that wheels leave: what each
/// wheel and body does as well, and energies. A road of two lines that differ takes the whole bridge. Springs 5 % off are found.
#[test]
fn trucks_on_springs_are_those_of_the_whole_bridge() {
    let ready = ready_with(|design| design.modules = 6);
    let solvers = solvers(&ready);
    let mut crossing = crossing(&ready).crossing();
    for wheel in 0..4 {
        crossing.record.more.push(Subject::Wheel { vehicle: 1, wheel });
    }
    for motion in [BodyMotion::Bounce, BodyMotion::Pitch] {
        crossing.record.more.push(Subject::Body { vehicle: 0, motion });
    }
    for (inertia, has_tyres) in [
        (Inertia::None, true),
        (Inertia::Local, false),
        (Inertia::Convective, false),
    ] {
        let traffic = |factor: f64, lines: RoadLines| {
            let of = |start_s: f64| Driven {
                load_n: 150e3,
                vehicle: Arc::new(truck(factor, inertia, has_tyres)),
                drive: Drive {
                    start_s,
                    ..Drive::steady(12.0)
                },
            };
            Traffic {
                vehicles: vec![of(0.0), of(1.2)],
                road: Some(rough(&ready, lines)),
            }
        };
        let own = traffic(1.0, RoadLines::Shared);
        assert!(solvers[0].is_on_one_side(&own, &crossing));
        assert!(!solvers[0].is_on_one_side(&traffic(1.0, RoadLines::Own), &crossing));
        let solve = |solver: &OperatorSolver, traffic: &Traffic| solver.solve(traffic, &crossing).expect("a crossing");
        let [side, whole] = [0, 1].map(|i| solve(&solvers[i], &own));
        let off = apart(&side, &whole).max(rides_apart(&side, &whole));
        assert!(off < ROUNDING, "{inertia:?}: {off:e}");
        assert!(side.energy.energy_residual < 1e-11);
        assert_eq!(side.recorded.contact_lost_s, whole.recorded.contact_lost_s);
        assert_eq!(side.recorded.wheels.len(), 8);
        assert!(
            side.recorded.contact_lost_s > Some(0.05),
            "{inertia:?}: no wheel has left the road"
        );
        let wrong = solve(&solvers[0], &traffic(1.05, RoadLines::Shared));
        assert!(rides_apart(&wrong, &whole) > 1e-4, "{inertia:?}: wrong springs pass");
    }
}

/// The largest difference between wheels' forces and bodies' motions, over the largest number of each kind.
fn rides_apart(a: &CrossingResponse, b: &CrossingResponse) -> f64 {
    let lists = |of: &CrossingResponse| -> [Vec<f64>; 3] {
        let (wheels, motions) = (&of.recorded.wheels, &of.recorded.motions);
        let up_down = |m: &MotionPeaks| [m.up.value, m.down.value];
        [
            wheels
                .iter()
                .flat_map(|of| [of.largest.value, of.least.value])
                .collect(),
            motions.iter().flat_map(up_down).collect(),
            motions.iter().map(|of| of.acceleration.value).collect(),
        ]
    };
    let apart = |(a, b): (Vec<f64>, Vec<f64>)| {
        let most = b.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        a.iter().zip(&b).map(|(a, b)| (a - b).abs() / most).fold(0.0, f64::max)
    };
    lists(a).into_iter().zip(lists(b)).map(apart).fold(0.0, f64::max)
}

/// Joints with buffers, stops and dashpots of their own, alike on both sides; unlike sides are those of no mirror.
#[test]
fn laws_of_both_sides_have_to_be_alike() {
    let ready = ready_with(|design| design.modules = 6);
    let solvers = solvers(&ready);
    let vehicle = footprint(&[-1.4, 1.4], Inertia::Local);
    let law = |gap_m: f64| ConnectorLaw::Gaps {
        tension: Truss {
            stiffness_n_m: 2e7,
            gap_m,
            damping_n_s_m: 2e5,
            stop: Some(EndStop {
                gap_m: gap_m + 0.001,
                stiffness_n_m: 6e7,
            }),
        },
        compression: Truss {
            stiffness_n_m: 3e7,
            gap_m: 0.001,
            damping_n_s_m: 0.0,
            stop: None,
        },
    };
    let with_laws = |gaps_m: [f64; 2]| SingleCrossing {
        own_laws: Arc::from([(2, law(gaps_m[0])), (3, law(gaps_m[1]))]),
        ..crossing(&ready)
    };
    let alike = with_laws([0.003; 2]);
    assert!(is_on_one_side(&solvers[0], &vehicle, &alike));
    let [side, whole] = answers(&solvers, &vehicle, &alike);
    let off = apart(&side, &whole);
    assert!(off < ROUNDING, "{off:e}");
    let unlike = with_laws([0.003, 0.003_f64.next_up()]);
    assert!(!is_on_one_side(&solvers[0], &vehicle, &unlike));
    let [one, other] = answers(&solvers, &vehicle, &unlike);
    assert_eq!(one, other);
}

/// The least asymmetry of bridge or vehicle takes the whole bridge.
#[test]
fn what_is_not_its_own_image_takes_the_whole_bridge() {
    let ready = ready_with(|_| {});
    let [solver, _] = solvers(&ready);
    let (vehicle, own) = (footprint(&[-1.4, 1.4], Inertia::Local), crossing(&ready));
    assert!(is_on_one_side(&solver, &vehicle, &own));
    assert!(!is_on_one_side(
        &solver,
        &footprint(&[-1.4, 1.4_f64.next_up()], Inertia::Local),
        &own
    ));
    let y_m = ready.design.connectors.y_m.clone();
    let shifted = ready_with(|design| design.connectors.y_m = vec![y_m[0], y_m[1].next_up()]);
    let [solver, _] = solvers(&shifted);
    assert!(!is_on_one_side(&solver, &vehicle, &own));
}
