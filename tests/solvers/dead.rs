//! The dead state: ballast, preloads and a risen river by hand, beside each other, and as the start of crossings.
//!
//! Knows a bridge of boxes and the plane chain. Does not know studies.

#![allow(clippy::expect_used)]

use pontoon_core::analysis::modes::Rayleigh;
use pontoon_core::analysis::statics::{DeadCase, StaticCase, StaticSolver};
use pontoon_core::analysis::{AnalysisError, DeadFault};
use pontoon_core::bridge::{
    BallastSpec, BankPlace, BankSpec, BridgeDesign, BridgeEnd, Direction, Model, Supports, Toward,
};
use pontoon_core::connector::Connection;
use pontoon_core::operator::{BridgeOperator, Followed};
use pontoon_core::response::{Axis, CrossingResponse, DeadState, Record, Section, Subject};
use pontoon_core::stop::Stop;
use pontoon_core::vehicle::Inertia;
use pontoon_tests::operated::{Both, deflections, forces, operator};
use pontoon_tests::*;
use std::sync::Arc;

pub(crate) const GAPS: Connection = Connection::Nonlinear {
    gap_tension_m: 0.002,
    gap_compression_m: 0.001,
};

fn dead(ready: &Ready, connection: Connection) -> Result<Option<Arc<DeadState>>, AnalysisError> {
    let solver = StaticSolver::new(&ready.bridge).expect("statics");
    let own_laws = ready.design.own_laws(connection, None).expect("laws");
    solver.dead_state(&DeadCase::new(&ready.design, connection, own_laws))
}

pub(crate) fn standing(ready: &Ready, connection: Connection, load_n: f64, x_m: f64) -> StaticCase {
    StaticCase {
        own_laws: ready.design.own_laws(connection, None).expect("laws"),
        dead: dead(ready, connection).expect("a dead state"),
        ..ready.case(connection, load_n, x_m)
    }
}

pub(crate) fn moving(ready: &Ready, connection: Connection, load_n: f64) -> SingleCrossing {
    SingleCrossing {
        own_laws: ready.design.own_laws(connection, None).expect("laws"),
        dead: dead(ready, connection).expect("a dead state"),
        ..ready.crossing(connection, load_n, 9.0)
    }
}

fn ballast(module: usize, x_m: f64, y_m: f64, weight_n: f64) -> BallastSpec {
    BallastSpec {
        module,
        x_m,
        y_m,
        weight_n,
    }
}

/// Smoke's bridge on banks that press, with ballast, under a river that has risen.
fn on_banks(factor: f64) -> BridgeDesign {
    let spec = |at: BridgeEnd, stiffness_n_m: f64| BankSpec {
        at: BankPlace::End(at),
        direction: Direction::Z,
        stiffness_n_m,
        one_sided: true,
        toward: None,
        clearance_m: 0.0,
        preload_n: None,
        damping_n_s_m: 0.0,
        y_m: None,
    };
    with(&design("smoke"), |d| {
        d.supports = Supports {
            left: vec![Direction::X, Direction::Y],
            right: vec![Direction::Y],
        };
        d.banks = vec![
            BankSpec {
                preload_n: Some(factor * 3e4),
                damping_n_s_m: 2e4,
                ..spec(BridgeEnd::Left, 6e6)
            },
            BankSpec {
                clearance_m: 0.004,
                ..spec(BridgeEnd::Right, 4e6)
            },
            BankSpec {
                one_sided: false,
                y_m: Some(vec![-1.125]),
                ..spec(BridgeEnd::Right, 2e5)
            },
        ];
        d.dead.ballast = vec![
            ballast(1, 2.0, 1.3, factor * 2e4),
            ballast(3, 4.1, -0.4, factor * 1.5e4),
        ];
        d.water_level_m = Some(factor * 0.03);
    })
}

/// The largest entry of a list of numbers.
pub(crate) fn most(list: &[f64]) -> f64 {
    list.iter().fold(0.0, |most, x| most.max(x.abs()))
}

/// A box alone on the water under an eccentric ballast, its water a spring of p_b over the bottom: sinkage W / (p_b A), heel
/// W y / (p_b I_x), trim -W x / (p_b I_y) about the middle, where the second moments of the bottom are those of the lumped water,
/// `I = A b^2 (1/12 + 1/(6 n^2))` for n even strips of the breadth b. A box of stiff plates is rigid to some 1e-7 at 3e4 times its E, which leaves as much of rounding.
/// Twin: the ballast 5 % off.
#[test]
fn a_box_heels_and_trims_by_hand() {
    let with_ballast = |factor: f64| {
        let design = with(&with_e(&design("smoke"), 3e4), |d| {
            d.modules = 1;
            d.water_distribution = pontoon_core::water::WaterDistribution::Consistent;
            d.supports = Supports {
                left: vec![Direction::X, Direction::Y],
                right: vec![Direction::Y],
            };
            d.dead.ballast = vec![ballast(1, 1.7, 0.9, factor * 1e4)];
        });
        let ready = Ready::new(&design, Model::Full);
        let state = dead(&ready, Connection::Linear)
            .expect("a dead state")
            .expect("a dead load");
        (design, state)
    };
    let (design, state) = with_ballast(1.0);
    let (l, b, p_b) = (design.module.length_m, design.module.breadth_m, design.p_b());
    let area = l * b;
    let (x, y) = (1.7 - 0.5 * l, 0.9);
    let by_hand = [
        1e4 / (p_b * area),
        -1e4 * x / (p_b * area * l * l / 12.0),
        -1e4 * y / (p_b * area * b * b / 12.0),
    ];
    let found = |state: &DeadState| {
        let of = state.modules[0];
        [of.sinkage_m, of.trim_rad, of.heel_rad]
    };
    let [right, wrong] = [found(&state), found(&with_ballast(1.05).1)].map(|found| apart(&found, &by_hand));
    held("sinkage, trim and heel", 1e-6, right, wrong);
}

/// Reactions and buoyancy add up to what lies on the bridge, force and both moments, at rest and under a load: 1e-10 of the weight,
/// and of it times the length. Twin: the answer of supports and banks 5 % off.
#[test]
fn what_lies_on_a_bridge_is_carried() {
    for design in [
        on_banks(1.0),
        with(&design("smoke"), |d| {
            d.dead.ballast = vec![ballast(2, 3.0, 1.0, 4e4)];
            d.water_level_m = Some(-0.02);
        }),
    ] {
        let ready = Ready::new(&design, Model::SuperElement);
        let case = standing(&ready, GAPS, 1e5, 6.0);
        let at_rest = case.dead.as_ref().expect("a dead load").equilibrium;
        let loaded = ready
            .statics(&footprint(&[-1.4, 1.4], Inertia::None))
            .solve(&case)
            .expect("solved");
        for equilibrium in [at_rest, loaded.equilibrium] {
            let scale = [1.0, design.length_m(), design.length_m()];
            let sum = |factor: f64| {
                let of = |i: usize| {
                    let held = equilibrium.supports[i] + equilibrium.banks[i];
                    (equilibrium.load[i] + equilibrium.water[i] + factor * held) / scale[i]
                };
                most(&[of(0), of(1), of(2)]) / equilibrium.load[0].abs()
            };
            held("dead loads and what carries them", 1e-10, sum(1.0), sum(1.05));
        }
    }
}

/// What is there first changes nothing: ballast A and then a vehicle of weight B come to where ballast A + B comes, gaps, banks and
/// preloads at work. A vehicle of two points where the ballast lies. 1e-9 of the largest. Twin: 5 % more ballast.
#[test]
fn loads_come_in_any_order() {
    let vehicle = axles(&[(0.0, 1.0, 0.0)], Inertia::None, 1);
    let total = |first_n: f64, then_n: f64, factor: f64| -> Vec<f64> {
        let design = with(&on_banks(factor), |d| {
            if first_n > 0.0 {
                let half = |y_m: f64| ballast(2, 3.2, y_m, 0.5 * first_n);
                d.dead.ballast.extend([half(-1.4), half(1.4)]);
            }
        });
        let ready = Ready::new(&design, Model::SuperElement);
        let case = standing(&ready, GAPS, then_n, design.position_x_m(2) + 3.2);
        let at_rest = case.dead.clone().expect("a dead load");
        let solved = ready.statics(&vehicle).solve(&case).expect("solved");
        let moved = solved
            .deflection_m
            .iter()
            .zip(&at_rest.deflection_m)
            .map(|(w, rest)| w + rest);
        let forces = solved.joints.iter().map(|j| 1e-7 * j.sum_n);
        let banks = solved.banks.iter().map(|of| 1e-7 * of.2);
        let pins = solved.pins_n.iter().flatten().map(|n| 1e-7 * n);
        let sections = solved.sections.iter().map(|s| s[0]);
        moved.chain(forces).chain(banks).chain(pins).chain(sections).collect()
    };
    let expected = total(9e4, 6e4, 1.0);
    let [right, wrong] = [1.0, 1.05].map(|factor| apart(&total(3e4, 12e4, factor), &expected));
    held("order of loads", 1e-9, right, wrong);
}

/// A bridge that nothing crosses rests: under a vehicle of 1e-6 N nothing moves, and all forces stay those at rest, in both solvers.
/// 1e-9 of the largest forces. Twin: a dead state of 5 % more.
#[test]
fn a_bridge_at_rest_stays_there() {
    let design = on_banks(1.0);
    let ready = Ready::new(&design, Model::SuperElement);
    let vehicle = footprint(&[-1.4, 1.4], Inertia::Convective);
    let settings = settings(ready.rayleigh(), 0.01, 0.9);
    let crossing = |factor: f64| {
        let state = dead(&Ready::new(&on_banks(factor), Model::SuperElement), GAPS);
        SingleCrossing {
            dead: state.expect("a dead state"),
            ..moving(&ready, GAPS, 1e-6)
        }
    };
    let both = Both::new(&ready, &operator(&ready, 0.0), &settings);
    let at_rest = crossing(1.0).dead.expect("a dead load");
    let expected = most(&at_rest.forces_n);
    let moved = |r: &CrossingResponse| {
        let positions = r.positions.iter().flat_map(|p| [p.deflection.value, p.uplift.value]);
        most(&positions.collect::<Vec<_>>())
    };
    let sums = |r: &CrossingResponse| -> Vec<f64> {
        r.joints
            .iter()
            .map(|j| j.sum.tension.value - j.sum.compression.value)
            .collect()
    };
    let per_joint = design.connectors.y_m.len();
    let sums_at_rest: Vec<f64> = at_rest.forces_n[..2 * per_joint]
        .chunks(per_joint)
        .map(|f| f.iter().sum())
        .collect();
    let off = |r: &CrossingResponse| {
        let forces: Vec<f64> = sums(r).iter().zip(&sums_at_rest).map(|(a, b)| a - b).collect();
        (most(&forces) / expected).max(moved(r) / 0.1)
    };
    for solver in 0..2 {
        let [right, wrong] =
            [1.0, 1.05].map(|factor| off(&both.solve(&vehicle, &crossing(factor)).expect("solved")[solver]));
        held("a bridge at rest", 1e-9, right, wrong);
    }
}

/// What a crossing records: pins, sections and the springs of banks.
fn record() -> Record {
    let sections = Section::ALL.map(|of| Subject::Section { joint: 2, of });
    let pins = Axis::ALL.map(|axis| Subject::Pin {
        joint: 3,
        index: 1,
        axis,
    });
    Record {
        more: sections.into_iter().chain(pins).collect(),
        pins: true,
        ..Record::default()
    }
}

/// Both solvers from one dead state on, through gaps, banks under preload with a dashpot and a cable with slack, three inertias: all
/// modes kept to 1e-8 of the largest; the energy balances. Twin: the operator's dead state of 5 % more.
#[test]
fn operator_starts_where_the_reference_solver_does() {
    let design = on_banks(1.0);
    let ready = Ready::new(&design, Model::SuperElement);
    let settings = settings(ready.rayleigh(), 0.01, 0.9);
    let followed = Followed {
        pins: true,
        places_x_m: Vec::new(),
    };
    let operator = BridgeOperator::new_unless(&ready.bridge, 0.0, &followed, Stop::never()).expect("an operator");
    let both = Both::new(&ready, &Arc::new(operator), &settings);
    for inertia in [Inertia::None, Inertia::Local, Inertia::Convective] {
        let vehicle = footprint(&[-0.4, 2.4], inertia);
        let crossing = SingleCrossing {
            record: record(),
            ..moving(&ready, GAPS, PAPER_LOAD_N)
        };
        let [found, expected] = both.solve(&vehicle, &crossing).expect("solved");
        assert!(expected.statistics.contact_switches > 20, "{:?}", expected.statistics);
        for of in [&found, &expected] {
            assert!(of.energy.energy_residual < 1e-10, "{:?}", of.energy);
        }
        let numbers = |r: &CrossingResponse| -> Vec<Vec<f64>> {
            let banks = r
                .recorded
                .banks
                .iter()
                .flat_map(|b| [b.force.compression.value, b.force.tension.value]);
            let pins = r
                .pins
                .iter()
                .flat_map(|p| p.extremes.components.map(|c| [c.compression.value, c.tension.value]));
            let histories = r.recorded.histories.iter().map(|h| h.values.clone());
            [deflections(r), forces(r), banks.collect(), pins.flatten().collect()]
                .into_iter()
                .chain(histories)
                .collect()
        };
        let wrong = SingleCrossing {
            dead: dead(&Ready::new(&on_banks(1.05), Model::SuperElement), GAPS).expect("a dead state"),
            ..crossing
        };
        let wrong = both.operated.solve_single(&vehicle, &wrong).expect("solved");
        let off = |found: &CrossingResponse| {
            let pairs = numbers(found).into_iter().zip(numbers(&expected));
            largest(pairs.map(|(a, b)| if a == b { 0.0 } else { apart(&a, &b) }))
        };
        held("operator from a dead state", 1e-8, off(&found), off(&wrong));
        assert_eq!(found.bottom_emerged, expected.bottom_emerged);
        assert_eq!(found.deck_submerged, expected.deck_submerged);
    }
}

/// Where nothing is nonlinear a dead load changes nothing but the forces it brings: with springs that hold both ways and the linear
/// connection a crossing under a risen river is that without, its forces those and the ones at rest. 1e-9 of the largest, in both
/// solvers. Twin: the river 5 % higher.
#[test]
fn a_linear_bridge_superposes() {
    let level = |water_level_m: f64| with(&design("smoke"), |d| d.water_level_m = Some(water_level_m));
    let [dry, risen, higher] = [0.0, 0.05, 0.0525].map(|h| Ready::new(&level(h), Model::SuperElement));
    let settings = settings(dry.rayleigh(), 0.01, 0.9);
    let vehicle = footprint(&[-0.4, 2.4], Inertia::Local);
    let both = Both::new(&dry, &operator(&dry, 0.0), &settings);
    let record = || Record {
        joints: vec![2, 3],
        ..Record::default()
    };
    let crossing = |ready: &Ready| SingleCrossing {
        record: record(),
        ..moving(ready, Connection::Linear, PAPER_LOAD_N)
    };
    let expected = both.solve(&vehicle, &crossing(&dry)).expect("solved");
    let at_rest = dead(&risen, Connection::Linear)
        .expect("a dead state")
        .expect("a dead load");
    let per_joint = dry.design.connectors.y_m.len();
    let sums: Vec<f64> = at_rest.forces_n.chunks(per_joint).map(|f| f.iter().sum()).collect();
    for (solver, expected) in expected.iter().enumerate() {
        let off = |ready: &Ready| {
            let found = &both.solve(&vehicle, &crossing(ready)).expect("solved")[solver];
            let histories = found.recorded.histories.iter().zip(&expected.recorded.histories);
            let forces = histories.zip(&sums).map(|((found, expected), rest)| {
                let without: Vec<f64> = found.values.iter().map(|n| n - rest).collect();
                apart(&without, &expected.values)
            });
            largest(forces.chain([apart(&deflections(found), &deflections(expected))]))
        };
        held("superposition", 1e-9, off(&risen), off(&higher));
    }
}

/// Half a bridge of dry boxes has no dead state where nothing holds it, and a box whose ballast is more than it carries sinks.
#[test]
fn what_does_not_exist_is_said() {
    let heavy = with(&design("smoke"), |d| d.dead.ballast = vec![ballast(2, 3.0, 1.0, 3e6)]);
    let sinks = dead(&Ready::new(&heavy, Model::SuperElement), GAPS);
    let Err(AnalysisError::NoDeadState(DeadFault::Sinks { module, under_m })) = sinks else {
        panic!("{sinks:?}")
    };
    // the first of those whose decks are under
    assert_eq!(module, 1);
    assert!(under_m > 0.1, "{under_m} m");
}

/// A bridge that nothing linear holds along, between two preloaded guys that never go slack: statics and crossings of the bridge on
/// springs of those stiffnesses that hold both ways, in the linear connection. Reactions at rest 1e-8 of the largest, deflections
/// 1e-9, in both solvers. Twin: the guys 5 % stiffer.
#[test]
fn guys_under_preload_are_springs() {
    let guyed = |one_sided: bool, factor: f64| {
        with(&design("smoke"), |d| {
            d.supports.left.retain(|held| *held != Direction::X);
            let guy = |at: BridgeEnd, stiffness_n_m: f64| BankSpec {
                at: BankPlace::End(at),
                direction: Direction::X,
                stiffness_n_m: factor * stiffness_n_m,
                one_sided,
                toward: one_sided.then_some(if at == BridgeEnd::Left {
                    Toward::Minus
                } else {
                    Toward::Plus
                }),
                clearance_m: 0.0,
                preload_n: one_sided.then_some(2e5),
                damping_n_s_m: 0.0,
                y_m: None,
            };
            d.banks = vec![guy(BridgeEnd::Left, 4e6), guy(BridgeEnd::Right, 2e6)];
        })
    };
    let vehicle = footprint(&[-1.4, 1.4], Inertia::Local);
    // the damping of springs in K is not that of links
    let settings = settings(Rayleigh::new(0.0, 0.2), 0.01, 0.9);
    // reactions beyond those at rest: standing, then moving by both solvers
    let solve = |design: &BridgeDesign| -> [Vec<f64>; 3] {
        let ready = Ready::new(design, Model::SuperElement);
        let case = standing(&ready, Connection::Linear, PAPER_LOAD_N, 6.0);
        let at_rest: Vec<f64> = match &case.dead {
            Some(dead) => dead.banks.iter().map(|of| of.2).collect(),
            None => vec![0.0; 6],
        };
        let beyond = |forces_n: &[f64], signs: [f64; 2]| -> Vec<f64> {
            let each = forces_n.iter().zip(&at_rest).enumerate();
            each.map(|(i, (force, rest))| signs[i / 3] * (force - rest)).collect()
        };
        // a guy's sense is outward, that of a spring that holds both ways inward
        let signs = if design.banks[0].one_sided {
            [-1.0, 1.0]
        } else {
            [1.0, -1.0]
        };
        let stood = ready.statics(&vehicle).solve(&case).expect("solved");
        let stood: Vec<f64> = stood.banks.iter().map(|of| of.2).collect();
        let both = Both::new(&ready, &operator(&ready, 0.0), &settings);
        let crossing = moving(&ready, Connection::Linear, PAPER_LOAD_N);
        let [operated, direct] = both.solve(&vehicle, &crossing).expect("solved");
        [beyond(&stood, signs), deflections(&direct), deflections(&operated)]
    };
    let expected = solve(&guyed(false, 1.0));
    let (right, wrong) = (solve(&guyed(true, 1.0)), solve(&guyed(true, 1.05)));
    for (i, tolerance) in [1e-8, 1e-9, 1e-9].into_iter().enumerate() {
        let off = [&right, &wrong].map(|of| apart(&of[i], &expected[i]));
        held("guys under preload", tolerance, off[0], off[1]);
    }
}

/// The mirror image of a bridge with all its dead load, driven over from the other end: peaks of the mirror image to 1e-9 of the
/// largest. Twin: the mirrored ballast 5 % heavier.
#[test]
fn a_mirrored_dead_load_gives_mirrored_answers() {
    let (length_m, modules) = (design("smoke").module.length_m, design("smoke").modules);
    let mirrored = |factor: f64| {
        with(&on_banks(1.0), |d| {
            for bank in &mut d.banks {
                bank.at = match bank.at {
                    BankPlace::End(BridgeEnd::Left) => BankPlace::End(BridgeEnd::Right),
                    _ => BankPlace::End(BridgeEnd::Left),
                };
            }
            for of in &mut d.dead.ballast {
                *of = ballast(modules + 1 - of.module, length_m - of.x_m, of.y_m, factor * of.weight_n);
            }
            d.supports = Supports {
                left: vec![Direction::Y],
                right: vec![Direction::X, Direction::Y],
            };
        })
    };
    let vehicle = footprint(&[-0.4, 2.4], Inertia::Local);
    let settings = settings(Ready::new(&design("smoke"), Model::SuperElement).rayleigh(), 0.01, 0.9);
    let solve = |design: &BridgeDesign, speed_m_s: f64| {
        let ready = Ready::new(design, Model::SuperElement);
        let crossing = SingleCrossing {
            speed_m_s,
            ..moving(&ready, GAPS, PAPER_LOAD_N)
        };
        ready.crossings(&vehicle, &settings).solve(&crossing).expect("solved")
    };
    let numbers = |r: &CrossingResponse, back: bool| -> Vec<f64> {
        let mut of_positions: Vec<[f64; 2]> = r
            .positions
            .iter()
            .map(|p| [p.deflection.value, p.uplift.value])
            .collect();
        let mut of_joints: Vec<[f64; 2]> = r
            .joints
            .iter()
            .map(|j| [1e-7 * j.sum.compression.value, 1e-7 * j.sum.tension.value])
            .collect();
        if back {
            of_positions.reverse();
            of_joints.reverse();
        }
        of_positions.into_iter().chain(of_joints).flatten().collect()
    };
    let expected = numbers(&solve(&on_banks(1.0), 9.0), false);
    let [right, wrong] = [1.0, 1.05].map(|factor| apart(&numbers(&solve(&mirrored(factor), -9.0), true), &expected));
    held("mirrored dead load", 1e-9, right, wrong);
}

/// The creeping load of a bridge with a dead state: its peaks are the largest deflections of static cases at its places, a quarter of
/// an element apart. 1e-9 of the largest. Twin: a load 5 % heavier.
#[test]
fn a_load_creeps_from_the_dead_state() {
    let design = on_banks(1.0);
    let ready = Ready::new(&design, Model::SuperElement);
    let vehicle = footprint(&[-1.4, 1.4], Inertia::None);
    let statics = ready.statics(&vehicle);
    let case = standing(&ready, GAPS, PAPER_LOAD_N, 0.0);
    let places = 4 * design.module.mesh.elements_along * design.modules;
    let at = |place: usize, factor: f64| {
        let case = StaticCase {
            load_x_m: design.length_m() * place as f64 / places as f64,
            load_n: factor * case.load_n,
            ..case.clone()
        };
        most(
            &statics
                .solve(&case)
                .expect("solved")
                .deflection_m
                .iter()
                .map(|w| w.max(0.0))
                .collect::<Vec<_>>(),
        )
    };
    let largest_m = |factor: f64| (0..=places).map(|place| at(place, factor)).fold(0.0, f64::max);
    let crept_m = statics.creeping_peak_m(&case).expect("solved");
    let [right, wrong] = [1.0, 1.05].map(|factor| miss(crept_m, largest_m(factor)));
    held("creeping from rest", 1e-9, right, wrong);
}
