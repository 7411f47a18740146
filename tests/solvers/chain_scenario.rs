//! Scenarios of the plane chain: what a file asks is what a direct call answers, and what the chain cannot do is refused.
//!
//! Knows scenarios and the calls that they stand for. Does not know other codes, but for one line of their numbers.

#![allow(clippy::expect_used)]

use pontoon_core::analysis::statics::StaticCase;
use pontoon_core::bridge::Model;
use pontoon_core::connector::Connection;
use pontoon_core::vehicle::{Inertia, VehicleDesign};
use pontoon_plan::Refusal;
use pontoon_plan::input::Document;
use pontoon_tests::chain::Chain;
use pontoon_tests::chain_scenario::ChainScenario;
use pontoon_tests::*;
use serde_json::{Value, json};
use std::path::Path;

fn read(scenario: &Value, time_step_s: Option<f64>) -> Result<ChainScenario, Refusal> {
    ChainScenario::of(Path::new("s.json"), &Document::from(scenario), time_step_s)
}

fn answer(scenario: &Value) -> Value {
    chain_answer::answer(&read(scenario, None).expect("a scenario")).expect("solved")
}

fn column(answer: &Value, rows: &str, key: &str) -> Vec<f64> {
    let rows = answer[rows].as_array().expect("rows");
    rows.iter().map(|row| row[key].as_f64().expect(key)).collect()
}

/// The chain under another load at one speed, no scenario between, and its scenario: the same numbers. Exact.
#[test]
fn a_crossing_is_that_of_the_chain() {
    let chain = Chain {
        modules: 5,
        gap_compression_m: 0.003,
        weight_n: 1e5,
        tail_s: 1.0,
        crossings: vec![(true, 15.0), (false, 12.0)],
        ..Chain::read()
    };
    for ((linear, speed), direct) in chain.crossings.iter().zip(chain.cross(0.004)) {
        let found = answer(&json!({
            "modules": 5, "connection": if *linear { "linear" } else { "nonlinear" }, "gap_compression_m": 0.003,
            "analysis": { "tail_s": 1, "time_step_s": 0.004 }, "load_n": 1e5, "speed_m_s": speed
        }));
        let peaks = |of: fn(&pontoon_core::response::PositionPeaks) -> f64| direct.positions.iter().map(of).collect();
        let forces = |of: fn(&pontoon_core::response::JointPeaks) -> f64| direct.joints.iter().map(of).collect();
        for (rows, key, expected) in [
            ("positions", "x_m", peaks(|p| p.x_m)),
            ("positions", "peak_deflection_m", peaks(|p| p.deflection.value)),
            ("positions", "peak_uplift_m", peaks(|p| p.uplift.value)),
            ("joints", "peak_compression_n", forces(|j| j.sum.compression.value)),
            ("joints", "peak_tension_n", forces(|j| j.sum.tension.value)),
        ] {
            let expected: Vec<f64> = expected;
            assert_eq!(column(&found, rows, key), expected, "{key}");
        }
        let top = direct.peak_deflection();
        let largest = &found["largest"];
        assert_eq!(largest["peak_deflection_m"], json!(top.deflection.value));
        assert_eq!(largest["peak_deflection_position"], json!(top.position));
        assert_eq!(largest["peak_deflection_time_s"], json!(top.deflection.time_s));
        assert_eq!(largest.get("min_contact_force_n"), None);
    }
}

/// A case with everything that a joint and a vehicle can have, against the core's own call with two trusses of half the
/// joint's stiffness. Exact.
#[test]
fn joints_and_axles_are_those_of_the_core() {
    let axles = json!([
        { "behind_front_m": 0.0, "load_n": 6e4, "patch_length_m": 0.3 },
        { "behind_front_m": 4.2, "load_n": 9e4, "patch_length_m": 0.0, "track_y_m": [-0.5, 0.5] }
    ]);
    let joints = |half: f64| {
        json!({ "2..5": { "connectors": { "stiffness_n_m": 3e7 * half, "gap_tension_m": 0.0 } },
                "3": { "connectors": { "compression": false } },
                "4": { "connectors": { "stop_compression": { "gap_m": 0.008, "stiffness_n_m": 9e7 * half },
                                       "stop_tension": { "gap_m": 0.001, "stiffness_n_m": 8e7 * half } } } })
    };
    let found = answer(&json!({
        "modules": 5, "joints": joints(1.0), "analysis": { "kind": "static" }, "load_x_m": 20.1,
        "traffic": [{ "vehicle": { "axles": axles, "patch_points": 3 } }]
    }));
    let chain = Chain {
        modules: 5,
        ..Chain::read()
    };
    let design = with(&chain.design(), |d| {
        d.joints = serde_json::from_value(joints(0.5)).expect("joints");
    });
    let mut written = axles.clone();
    written[0]["track_y_m"] = json!([-1.0, 1.0]);
    let vehicle = VehicleDesign {
        axles: serde_json::from_value(written).expect("axles"),
        inertia: Inertia::None,
        patch_points: 3,
        ..VehicleDesign::default()
    };
    let vehicle = vehicle.check(2.0).expect("a vehicle");
    let ready = chain.module.ready(&design, Model::Full);
    let connection = chain.connection(false);
    let case = StaticCase {
        own_laws: design.own_laws(connection, None).expect("laws"),
        ..ready.case(connection, 1.5e5, 20.1)
    };
    let direct = ready.statics(&vehicle).solve(&case).expect("solved");
    assert_eq!(column(&found, "positions", "deflection_m"), direct.deflection_m);
    let forces: Vec<f64> = direct.joints.iter().map(|j| j.sum_n).collect();
    assert_eq!(column(&found, "joints", "force_n"), forces);
    let at_stop = 3e7 * (0.008 - 0.0055);
    assert!(-forces[2] > at_stop, "joint 4 is not at its stop: {forces:?}");
    let most = forces.iter().copied().fold(0.0, f64::min);
    assert_eq!(found["largest"]["compression_n"], json!(-most));
}

/// Dashpots of a scenario's joints, against the core's own call with two trusses of half the joint's damping. Exact. Twin: without
/// them.
#[test]
fn damping_of_joints_is_that_of_the_core() {
    let joints = |damping: f64| json!({ "2..5": { "connectors": { "damping_n_s_m": damping } } });
    let found = |joints: Value| {
        let found = answer(&json!({
            "modules": 5, "joints": joints, "gap_compression_m": 0.003, "speed_m_s": 12,
            "analysis": { "tail_s": 1, "time_step_s": 0.004 }
        }));
        column(&found, "joints", "peak_compression_n")
    };
    let chain = Chain {
        modules: 5,
        gap_compression_m: 0.003,
        ..Chain::read()
    };
    let design = with(&chain.design(), |d| {
        d.joints = serde_json::from_value(joints(2e5)).expect("joints");
    });
    let ready = chain.module.ready(&design, Model::Full);
    let connection = chain.connection(false);
    let crossing = SingleCrossing {
        own_laws: design.own_laws(connection, None).expect("laws"),
        tail_s: 1.0,
        ..ready.crossing(connection, chain.weight_n, 12.0)
    };
    let solver = ready.crossings(&chain.vehicle(), &settings(chain.rayleigh, 0.004, 0.9));
    let direct = solver.solve(&crossing).expect("solved");
    let expected: Vec<f64> = direct.joints.iter().map(|j| j.sum.compression.value).collect();
    assert_eq!(found(joints(4e5)), expected);
    assert_ne!(found(json!({})), expected);
}

/// Numbers of two independent codes through the reader: joint 7 of half the stiffness, deflection of positions 7 and 8 `[m]` and
/// forces of joints 6 to 8 `[kN]`. Tolerance 1e-4 of the largest. Twin: the stiffness 5 % off.
#[test]
fn a_joint_of_half_the_stiffness_is_that_of_independent_codes() {
    let off = |stiffness: f64| {
        let found = answer(&json!({
            "joints": { "7": { "connectors": { "stiffness_n_m": stiffness } } },
            "analysis": { "kind": "static" }, "load_position": 7
        }));
        let (w, n) = (
            column(&found, "positions", "deflection_m"),
            column(&found, "joints", "force_n"),
        );
        let n: Vec<f64> = n[4..7].iter().map(|n| n / 1e3).collect();
        apart(&w[6..8], &[0.23312, 0.15125]).max(apart(&n, &[-94.79, -463.35, -94.79]))
    };
    held("joint 7 of half the stiffness", 1e-4, off(2.37e7), off(1.05 * 2.37e7));
}

/// A vehicle with inertia answers with its smallest contact force, which is below its weight, and other peaks.
#[test]
fn inertia_has_a_contact_force() {
    let of = |inertia: &str| {
        let vehicle = json!({ "footprint_length_m": 3.35, "inertia": inertia });
        let largest = answer(&json!({ "modules": 4, "vehicle": vehicle, "speed_m_s": 10 }))["largest"].clone();
        (
            largest["peak_deflection_m"].as_f64(),
            largest["min_contact_force_n"].as_f64(),
        )
    };
    let (without, none) = of("none");
    let (with, force) = of("convective");
    assert!(
        none.is_none() && force.is_some_and(|n| n > 0.0 && n < 230_300.0),
        "{force:?}"
    );
    assert_ne!(without, with);
}

/// The time step beside the file counts; where neither says one it is the examples' own.
#[test]
fn the_nearer_time_step_counts() {
    use pontoon_tests::chain_scenario::{ChainTask, TIME_STEP_S};
    let step = |scenario: &Value, beside: Option<f64>| match read(scenario, beside).expect("a scenario").task {
        ChainTask::Crossing {
            time_step_s, crossing, ..
        } => {
            assert!(matches!(crossing.connection, Connection::Nonlinear { .. }));
            time_step_s
        }
        ChainTask::Static(_) | ChainTask::Modes => 0.0,
    };
    let (plain, own) = (
        json!({ "speed_m_s": 3 }),
        json!({ "speed_m_s": 3, "analysis": { "time_step_s": 0.01 } }),
    );
    assert_eq!(
        [step(&plain, None), step(&own, None), step(&own, Some(0.02))],
        [TIME_STEP_S, 0.01, 0.02]
    );
    assert_eq!(read(&own, Some(-1.0)).unwrap_err().path, "analysis.time_step_s");
}

#[test]
fn what_the_chain_cannot_do_is_refused_by_its_key() {
    let wheel = |tracks: Value| json!({ "axles": [{ "behind_front_m": 0, "share": 1, "patch_length_m": 0, "track_y_m": tracks }] });
    let joint = |own: Value| json!({ "7": { "connectors": own } });
    for (path, more) in [
        (
            "dead.ballast[0].module",
            json!({ "dead": { "ballast": [{ "module": 16, "x_m": 1, "y_m": 0, "weight_n": 1e4 }] } }),
        ),
        ("water_level_m", json!({ "water_level_m": 200 })),
        ("wear", json!({ "wear": {} })),
        ("modules", json!({ "modules": [{ "kind": "ramp" }] })),
        ("modules", json!({ "modules": 0 })),
        ("connection", json!({ "connection": "lineal" })),
        ("gap_tension_m", json!({ "gap_tension_m": -0.1 })),
        ("analysis.kind", json!({ "analysis": { "kind": "rating" } })),
        ("analysis.solver", json!({ "analysis": { "solver": "operator" } })),
        ("analysis.time_step_s", json!({ "analysis": { "time_step_s": 5 } })),
        ("analysis.time_step_s", json!({ "analysis": { "time_step_s": 1e-9 } })),
        ("analysis.tail_s", json!({ "analysis": { "tail_s": -1 } })),
        (
            "analysis.spectral_radius",
            json!({ "analysis": { "spectral_radius": 2 } }),
        ),
        ("load_n", json!({ "load_n": 0 })),
        ("speed_m_s", json!({ "speed_m_s": -3 })),
        ("speed_m_s", json!({ "speed_m_s": null })),
        ("load_position", json!({ "load_position": 7 })),
        ("vehicle", json!({ "vehicle": "truck.json" })),
        ("vehicle.axles[0].track_y_m", json!({ "vehicle": wheel(json!([1])) })),
        (
            "vehicle.axles[0].track_y_m[0]",
            json!({ "vehicle": wheel(json!([-1.4, 1.4])) }),
        ),
        ("joints[16]", json!({ "joints": { "16": {} } })),
        (
            "joints[7].hinges",
            json!({ "joints": { "7": { "hinges": { "y_m": [1] } } } }),
        ),
        (
            "joints[7].connectors.at_y_m",
            json!({ "joints": joint(json!({ "at_y_m": [1] })) }),
        ),
        (
            "joints[7].connectors.stiffness_n_m",
            json!({ "joints": joint(json!({ "stiffness_n_m": 0 })) }),
        ),
        (
            "joints[7].connectors.stop_tension.gap_m",
            json!({ "joints": joint(json!({ "stop_tension": { "gap_m": 0.01, "stiffness_n_m": 1e8 } })) }),
        ),
        (
            "traffic",
            json!({ "speed_m_s": null, "traffic": [{ "speed_m_s": 3 }, { "speed_m_s": 3 }] }),
        ),
        ("traffic", json!({ "speed_m_s": null, "traffic": [] })),
        (
            "traffic[0].start_s",
            json!({ "speed_m_s": null, "traffic": [{ "speed_m_s": 3, "start_s": 1 }] }),
        ),
        (
            "traffic",
            json!({ "analysis": { "kind": "static" }, "load_x_m": 3, "speed_m_s": null, "traffic": [{ "speed_m_s": 3 }] }),
        ),
        (
            "traffic[0].speed_m_s",
            json!({ "speed_m_s": null, "traffic": [{ "load_n": 3 }] }),
        ),
        ("speed_m_s", json!({ "analysis": { "kind": "static" }, "load_x_m": 3 })),
        (
            "load_x_m",
            json!({ "speed_m_s": null, "analysis": { "kind": "static" } }),
        ),
        (
            "load_x_m",
            json!({ "speed_m_s": null, "analysis": { "kind": "static" }, "load_x_m": 101 }),
        ),
        (
            "load_x_m",
            json!({ "speed_m_s": null, "analysis": { "kind": "static" }, "load_x_m": 1, "load_position": 1 }),
        ),
        (
            "analysis.tail_s",
            json!({ "speed_m_s": null, "analysis": { "kind": "static", "tail_s": 1 }, "load_x_m": 3 }),
        ),
    ] {
        let mut scenario = json!({ "speed_m_s": 3 });
        let keys = more.as_object().expect("an object").clone();
        keys.into_iter().for_each(|(key, value)| scenario[key] = value);
        let refused = read(&scenario, None).map(|_| ()).expect_err(path);
        assert_eq!(refused.path, path, "{refused}");
    }
}
