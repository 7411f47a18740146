//! Joints that are not alike: connectors with laws of their own, in statics and in crossings, by both solvers.
//!
//! Knows bridges whose joints differ and what each must equal. Does not know studies.

#![allow(clippy::expect_used)]

use pontoon_core::analysis::statics::{StaticCase, StaticSolver};
use pontoon_core::bridge::{BridgeDesign, Model};
use pontoon_core::connector::Connection;
use pontoon_core::response::{CrossingResponse, StaticResponse};
use pontoon_core::vehicle::Inertia;
use pontoon_tests::chain::Chain;
use pontoon_tests::operated::*;
use pontoon_tests::*;
use serde_json::{Value, json};

/// Rounding, as of equal joints.
const ROUNDING: f64 = 1e-9;

/// A design whose joints have something of their own.
fn with_joints(design: &BridgeDesign, joints: &Value) -> BridgeDesign {
    let changed = with(design, |d| {
        d.joints = serde_json::from_value(joints.clone()).expect("joints")
    });
    changed.check().expect("a design");
    changed
}

/// The case with the laws of its design's joints.
fn case(design: &BridgeDesign, plain: StaticCase) -> StaticCase {
    let own_laws = design.own_laws(plain.connection, None).expect("laws");
    StaticCase { own_laws, ..plain }
}

/// The crossing with the laws of its design's joints.
fn crossing(design: &BridgeDesign, plain: SingleCrossing) -> SingleCrossing {
    let own_laws = design.own_laws(plain.connection, None).expect("laws");
    SingleCrossing { own_laws, ..plain }
}

/// Six modules of smoke's.
fn six() -> BridgeDesign {
    with(&design("smoke"), |d| d.modules = 6)
}

/// Everything that a joint can have: an open coupling, a buffer before a stop, a lost connector, gaps and a stiffness of its own.
fn unlike(stiffness: f64) -> Value {
    json!({
        "2..6": { "connectors": { "gap_tension_m": 0.002, "gap_compression_m": 0.001 } },
        "2": { "connectors": { "tension": false, "stiffness_n_m": stiffness } },
        "3": { "connectors": { "stiffness_n_m": 4e6, "stop_compression": { "gap_m": 0.003, "stiffness_n_m": 6e7 },
                               "stop_tension": { "gap_m": 0.004, "stiffness_n_m": 5e7 } } },
        "4": { "connectors": { "at_y_m": [2.02], "lost": true } },
        "5..6": { "connectors": { "gap_compression_m": 0.0 } }
    })
}

/// Every mode in the operator: the same motion through both solvers, the same solutions and switches, energies that close.
/// Tolerance: rounding. Twin: one joint's stiffness 5 % off in the operator's crossing.
#[test]
fn operator_takes_unlike_joints_as_the_reference_does() {
    let [right, wrong] = [1e7, 1.05e7].map(|stiffness| with_joints(&six(), &unlike(stiffness)));
    let ready = Ready::new(&right, Model::SuperElement);
    let both = Both::new(&ready, &operator(&ready, 0.0), &settings(ready.rayleigh(), 0.01, 0.9));
    let vehicle = footprint(&[-0.4, 2.4], Inertia::Local);
    for connection in [PAPER_GAPS, Connection::Linear] {
        let plain = ready.crossing(connection, PAPER_LOAD_N, 8.0);
        let [found, expected] = both.solve(&vehicle, &crossing(&right, plain.clone())).expect("solved");
        let twin = both
            .operated
            .solve_single(&vehicle, &crossing(&wrong, plain))
            .expect("solved");
        let [of, wrong] = [&found, &twin].map(|r| Apart::of(r, &expected, PAPER_LOAD_N).most());
        held(&format!("{connection:?}"), ROUNDING, of, wrong);
        assert_eq!(found.statistics, expected.statistics);
        for r in [&found, &expected] {
            assert!(r.energy.energy_residual < 1e-12, "{:?}", r.energy);
        }
        let dissipation = (found.energy.numerical_dissipation - expected.energy.numerical_dissipation).abs();
        assert!(dissipation < ROUNDING, "{dissipation:e}");
    }
}

/// What a crossing does not depend on: lanes that stand beside it, equal joints or others. Exact.
#[test]
fn unlike_joints_change_nothing_beside_them() {
    let design = with_joints(&six(), &unlike(1e7));
    let ready = Ready::new(&design, Model::SuperElement);
    let both = Both::new(&ready, &operator(&ready, 1e-3), &settings(ready.rayleigh(), 0.01, 0.9));
    let vehicle = footprint(&[-0.4, 2.4], Inertia::Local);
    let plain = |speed: f64| ready.crossing(PAPER_GAPS, PAPER_LOAD_N, speed);
    let mixed: Vec<SingleCrossing> = (0..6)
        .map(|i| 6.0 + f64::from(i))
        .map(|speed| {
            if speed > 8.5 {
                crossing(&design, plain(speed))
            } else {
                plain(speed)
            }
        })
        .collect();
    let asked: Vec<_> = mixed.iter().map(|crossing| (&vehicle, crossing)).collect();
    for (together, crossing) in solve_side_by_side(&both.operated, &asked, 0).into_iter().zip(&mixed) {
        assert_eq!(together, both.operated.solve_single(&vehicle, crossing));
    }
}

/// The law by hand, in tension positive: buffers, stops, what is lost.
fn law(joint: usize, y_m: f64, e: f64) -> f64 {
    let k = 2.37e7;
    match joint {
        2 => 1e7 * (e + 0.001).min(0.0),
        3 => {
            let pull = 4e6 * (e - 0.002).max(0.0) + (5e7 - 4e6) * (e - 0.004).max(0.0);
            pull - 4e6 * (-e - 0.001).max(0.0) - (6e7 - 4e6) * (-e - 0.003).max(0.0)
        }
        4 if y_m > 0.0 => 0.0,
        4 => k * (e - 0.002).max(0.0) - k * (-e - 0.001).max(0.0),
        _ => k * (e - 0.002).max(0.0) - k * (-e).max(0.0),
    }
}

/// Statics under each place of a heavy load: each connector is on its own law, and the creeping peaks are the largest of them.
/// Tolerance: 1e-9 of the largest force; a law with 5 % more stiffness is off by more.
#[test]
fn statics_follow_each_connectors_law() {
    let design = with_joints(&six(), &unlike(1e7));
    let ready = Ready::new(&design, Model::SuperElement);
    let solver = StaticSolver::new(&ready.bridge).expect("statics");
    let vehicle = footprint(&[-0.4, 2.4], Inertia::None);
    let (mut off, mut twin, mut stops, mut peaks) = (0.0_f64, 0.0_f64, 0, vec![0.0_f64; 7]);
    for place in 0..=96 {
        let x_m = 0.4187 * f64::from(place);
        let case = case(&design, ready.case(PAPER_GAPS, 3.0 * PAPER_LOAD_N, x_m));
        let connectors = solver.state(&vehicle, &case).expect("solved").connectors;
        let largest = largest(connectors.iter().map(|c| c.force_n.abs()));
        for (i, c) in connectors.iter().enumerate() {
            let (joint, y_m) = (2 + i / 2, [-2.02, 2.02][i % 2]);
            let expected = law(joint, y_m, c.elongation_m);
            off = off.max((c.force_n - expected).abs() / largest);
            twin = twin.max((c.force_n - 1.05 * expected).abs() / largest);
            stops += usize::from(joint == 3 && (c.elongation_m < -0.003 || c.elongation_m > 0.004));
        }
        let answer = solver.solve(&vehicle, &case).expect("solved");
        for (peak, w) in peaks.iter_mut().zip(&answer.deflection_m) {
            *peak = peak.max(*w);
        }
    }
    held("forces on their laws", 1e-9, off, twin);
    assert!(stops > 10, "{stops} connectors at their stops");
    // places of the creeping load lie 0.41875 m apart
    let case = case(&design, ready.case(PAPER_GAPS, 3.0 * PAPER_LOAD_N, 0.0));
    let creeping = solver.creeping_peaks_m(&vehicle, &case).expect("solved");
    assert!(apart(&peaks, &creeping) < 2e-3, "{peaks:?} {creeping:?}");
}

/// A bridge with one connector a joint at y = -2.02, and one with two of which those at 2.02 are lost, on the full model: the
/// same to rounding. An open coupling is a tension gap that nothing reaches. Twins: the connector's stiffness 5 % off.
#[test]
fn what_is_lost_or_open_is_not_there() {
    let both_lines = six();
    let one_line = with(&six(), |d| d.connectors.y_m = vec![-2.02]);
    let lost = json!({ "2..6": { "connectors": { "at_y_m": [2.02], "lost": true } } });
    let lost = with_joints(&both_lines, &lost);
    let vehicle = footprint(&[-0.4, 2.4], Inertia::Local);
    // damping is told by the linear connection's modes, which lose the connectors too
    let rayleigh = Ready::new(&both_lines, Model::SuperElement).rayleigh();
    let solve = |design: &BridgeDesign, model: Model, connection: Connection, factor: f64| {
        let ready = Ready::new(design, model);
        let mut asked = crossing(design, ready.crossing(connection, PAPER_LOAD_N, 9.0));
        asked.connector_stiffness_n_m *= factor;
        let crossings = ready.crossings(&vehicle, &settings(rayleigh, 0.01, 0.9));
        crossings.solve(&asked).expect("solved")
    };
    let moves = |r: &CrossingResponse| -> Vec<f64> {
        r.positions
            .iter()
            .flat_map(|p| [p.deflection.value, p.uplift.value])
            .collect()
    };
    let sums = |r: &CrossingResponse| -> Vec<f64> {
        let of_joint = |j: &pontoon_core::response::JointPeaks| [j.sum.compression.value, j.sum.tension.value];
        r.joints.iter().flat_map(of_joint).collect()
    };
    for connection in [Connection::Linear, gaps(0.002, 0.001)] {
        let [without, wrong] = [1.0, 1.05].map(|factor| solve(&one_line, Model::Full, connection, factor));
        let with_lost = solve(&lost, Model::Full, connection, 1.0);
        for of in [moves, sums] {
            let [right, wrong] = [&without, &wrong].map(|r| apart(&of(&with_lost), &of(r)));
            held(&format!("lost, {connection:?}"), 1e-8, right, wrong);
        }
    }
    let open = with_joints(&six(), &json!({ "3..5": { "connectors": { "tension": false } } }));
    let wide = with_joints(&six(), &json!({ "3..5": { "connectors": { "gap_tension_m": 1e6 } } }));
    let [open, wide] = [open, wide].map(|d| solve(&d, Model::SuperElement, gaps(0.002, 0.001), 1.0));
    assert_eq!(open.positions, wide.positions);
    assert_eq!(open.joints, wide.joints);
}

/// A bridge mirrored about its middle, the load mirrored with it or driven from the other end, and one mirrored across, the lane
/// mirrored with it: mirrored answers. Tolerance: 1e-9 of the largest. Twin: a joint that is not mirrored.
#[test]
fn mirrored_joints_give_mirrored_answers() {
    let here = json!({ "2": { "connectors": { "gap_compression_m": 0.009 } }, "3": { "connectors": { "tension": false } },
                       "4": { "connectors": { "at_y_m": [2.02], "stiffness_n_m": 1e7 } } });
    let along = json!({ "6": { "connectors": { "gap_compression_m": 0.009 } }, "5": { "connectors": { "tension": false } },
                        "4": { "connectors": { "at_y_m": [2.02], "stiffness_n_m": 1e7 } } });
    let across = json!({ "2": { "connectors": { "gap_compression_m": 0.009 } }, "3": { "connectors": { "tension": false } },
                         "4": { "connectors": { "at_y_m": [-2.02], "stiffness_n_m": 1e7 } } });
    let [here, along, across] = [here, along, across].map(|joints| with_joints(&six(), &joints));
    let along = with(&along, |d| std::mem::swap(&mut d.supports.left, &mut d.supports.right));
    let tracks = |side: f64| footprint(&[-0.4 * side, 2.4 * side], Inertia::Local);
    let statics = |design: &BridgeDesign, side: f64, x_m: f64| -> StaticResponse {
        let ready = Ready::new(design, Model::SuperElement);
        let case = case(design, ready.case(gaps(0.01, 0.002), PAPER_LOAD_N, x_m));
        ready.statics(&tracks(side)).solve(&case).expect("solved")
    };
    let (length_m, x_m) = (here.length_m(), 15.3);
    let deflections = |r: &StaticResponse, turned: bool| {
        let mut of = r.deflection_m.clone();
        if turned {
            of.reverse();
        }
        of
    };
    let first = deflections(&statics(&here, 1.0, x_m), false);
    let [turned, not] = [&along, &here].map(|d| apart(&deflections(&statics(d, 1.0, length_m - x_m), true), &first));
    held("mirrored along, statics", ROUNDING, turned, not);
    let crossings = |design: &BridgeDesign, side: f64| {
        let ready = Ready::new(design, Model::SuperElement);
        let both = Both::new(&ready, &operator(&ready, 1e-3), &settings(ready.rayleigh(), 0.01, 0.9));
        let asked = crossing(design, ready.crossing(gaps(0.01, 0.002), PAPER_LOAD_N, 7.0));
        let solved = both.solve(&tracks(side), &asked).expect("solved");
        solved.map(|r| r.positions.iter().map(|p| p.deflection.value).collect::<Vec<_>>())
    };
    let (first, mirrored, not) = (crossings(&here, 1.0), crossings(&across, -1.0), crossings(&here, -1.0));
    for solver in 0..2 {
        let [right, wrong] = [&mirrored, &not].map(|r| apart(&r[solver], &first[solver]));
        held("mirrored across, crossings", ROUNDING, right, wrong);
    }
    // along: driven from the other end, at a speed at which no point stands on a joint at the end of a step
    let driven = |design: &BridgeDesign, speed_m_s: f64, inertia: Inertia| {
        let ready = Ready::new(design, Model::SuperElement);
        let both = Both::new(&ready, &operator(&ready, 1e-3), &settings(ready.rayleigh(), 0.01, 0.9));
        let asked = crossing(design, ready.crossing(gaps(0.01, 0.002), PAPER_LOAD_N, speed_m_s));
        let solved = both.solve(&footprint(&[-0.4, 2.4], inertia), &asked).expect("solved");
        solved.map(|mut r| {
            if speed_m_s < 0.0 {
                r.positions.reverse();
                r.joints.reverse();
            }
            let deflections = r.positions.iter().flat_map(|p| [p.deflection.value, p.uplift.value]);
            let deflections: Vec<f64> = deflections.collect();
            let forces = r
                .joints
                .iter()
                .flat_map(|j| [j.sum.compression.value, j.sum.tension.value]);
            (deflections, forces.collect::<Vec<f64>>())
        })
    };
    for inertia in [Inertia::None, Inertia::Local, Inertia::Convective] {
        let speed_m_s = 7.0 + 1.0 / 17.0;
        let first = driven(&here, speed_m_s, inertia);
        let [turned, not] = [&along, &here].map(|design| driven(design, -speed_m_s, inertia));
        for solver in 0..2 {
            let [right, wrong] = [&turned, &not].map(|r| apart(&r[solver].0, &first[solver].0));
            held(
                &format!("mirrored along, deflections, {inertia:?}"),
                ROUNDING,
                right,
                wrong,
            );
            let [right, wrong] = [&turned, &not].map(|r| apart(&r[solver].1, &first[solver].1));
            held(&format!("mirrored along, joints, {inertia:?}"), ROUNDING, right, wrong);
        }
    }
}

/// What a joint of the chain has, and numbers of two independent codes for it: a static load at position 7 (deflection of
/// positions 7 and 8 `[m]`, forces of joints 6, 7, 8 `[kN]`), and a crossing at 3 m/s (deflection of position 7, largest of
/// all, compression and tension of joint 7, largest compression).
type ChainCase = (&'static str, Value, [f64; 5], [f64; 5]);

fn chain_cases() -> [ChainCase; 4] {
    let half = 0.25 * Chain::read().joint_stiffness_n_m;
    [
        (
            "all equal",
            json!({}),
            [0.20492, 0.14946, -125.86, -519.11, -125.86],
            [0.2100, 0.2103, 557.0, 0.0, 713.0],
        ),
        (
            "joint 8 with a gap of 20 mm",
            json!({ "8": { "connectors": { "gap_compression_m": 0.020 } } }),
            [0.21507, 0.17927, -105.44, -473.02, -82.61],
            [0.2293, 0.2592, 531.4, 65.4, 713.0],
        ),
        (
            "joint 7 of half the stiffness",
            json!({ "7": { "connectors": { "stiffness_n_m": half } } }),
            [0.23312, 0.15125, -94.79, -463.35, -94.79],
            [0.2421, 0.2421, 492.0, 0.0, 713.0],
        ),
        (
            "all tension connectors open",
            json!({ "2..15": { "connectors": { "tension": false } } }),
            [0.20492, 0.14946, -125.86, -519.11, -125.86],
            [0.2100, 0.2102, 557.0, 0.0, 713.0],
        ),
    ]
}

/// The plane chain with joints of their own against numbers of a plain prototype and of a second one of OpenSees elements.
/// Tolerances: statics 1e-4 of the largest, deflections 0.3 %, compressions 2 % of the largest. Twin: a connector 5 % stiffer in statics,
/// 20 % in crossings, which hardly depend on it.
#[test]
fn chain_with_unlike_joints_is_that_of_independent_codes() {
    let chain = Chain::read();
    let vehicle = chain.vehicle();
    let of = |(what, joints, statics, moving): &ChainCase| {
        let design = with_joints(&chain.design(), joints);
        let ready = Ready {
            design: design.clone(),
            ..chain.ready()
        };
        let mut off = Vec::new();
        for factor in [1.0, 1.05] {
            let mut case = case(&design, ready.case(chain.connection(false), chain.weight_n, 6.0 * 6.7));
            case.load_n *= factor;
            let r = ready.statics(&vehicle).solve(&case).expect("solved");
            let forces: Vec<f64> = r.joints.iter().map(|j| j.sum_n / 1e3).collect();
            let w = apart(&r.deflection_m[6..8], &statics[..2]);
            off.push(w.max(apart(&forces[4..7], &statics[2..])));
        }
        held(&format!("{what}, statics"), 1e-4, off[0], off[1]);
        let solver = ready.crossings(&vehicle, &settings(chain.rayleigh, 0.0025, 0.9));
        for factor in [1.0, 1.05] {
            let mut asked = crossing(&design, ready.crossing(chain.connection(false), chain.weight_n, 3.0));
            (asked.tail_s, asked.load_n) = (chain.tail_s, factor * asked.load_n);
            let r = solver.solve(&asked).expect("solved");
            let moves: Vec<f64> = r.positions.iter().map(|p| p.deflection.value).collect();
            let kn = |of: fn(&pontoon_core::response::ForcePeaks) -> f64| -> Vec<f64> {
                r.joints.iter().map(|j| of(&j.sum) / 1e3).collect()
            };
            let (c, t) = (kn(|p| p.compression.value), kn(|p| p.tension.value));
            let found = [moves[6], largest(moves.iter().copied())];
            let forces = [c[5], t[5], largest(c.iter().copied())];
            off.push(apart(&found, &moving[..2]));
            off.push(apart(&forces, &moving[2..]));
        }
        held(&format!("{what}, deflections at 3 m/s"), 3e-3, off[2], off[4]);
        held(&format!("{what}, forces at 3 m/s"), 2e-2, off[3], off[5]);
    };
    let cases = chain_cases();
    on_two_threads(&cases, of);
}
