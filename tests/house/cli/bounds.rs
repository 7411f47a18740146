//! Input that is well formed and yet asks for what cannot be: too much, twice, against itself.

use super::refusals::{bridge, refused, static_stage, study};
use crate::stage::{Stage, stderr};
use serde_json::{Value, json};
use std::fs;

#[test]
fn crossings_of_more_steps_than_anybody_waits_for() {
    for (key, value) in [
        ("tail_s", json!(1e12)),
        ("tail_s", json!(1e300)),
        ("time_step_s", json!(1e-300)),
    ] {
        study(
            "/analysis",
            key,
            value,
            &[
                "analysis.time_step_s: ",
                " steps, allowed: a crossing of at most 10000000 steps",
            ],
        );
    }
    let mut stage = Stage::new();
    stage.study["design"][0]["grid"]["speed_m_s"] = json!(1e-300);
    refused(stage.write(), &["analysis.time_step_s: found 0.02, which makes "]);
}

#[test]
fn one_module_has_no_bending_modes_to_take_the_damping_from() {
    let mut stage = Stage::new();
    stage.bridge["modules"] = json!(1);
    stage.study["record"] = json!({});
    refused(
        stage.write(),
        &["study.json: analysis.damping.frequencies_hz: missing key `frequencies_hz`, allowed: two frequencies"],
    );
    stage.study["analysis"]["damping"] = json!({ "frequencies_hz": [0.3, 0.6] });
    let output = stage.write().pontoon(&["run", "study.json", "--out", "r"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    study(
        "/analysis",
        "damping",
        json!({ "frequencies_hz": [1, 2, 3] }),
        &["analysis.damping.frequencies_hz: found a list of length 3, allowed: a list of two numbers"],
    );
}

#[test]
fn static_cases_of_bridges_that_are_free_to_move_horizontally() {
    for (key, value, part) in [
        (
            "supports",
            json!({ "left": [], "right": [] }),
            "found no end that holds x",
        ),
        (
            "supports",
            json!({ "left": ["x", "z"], "right": ["z"] }),
            "found no end that holds y",
        ),
        (
            "hinges",
            json!({ "y_m": [0] }),
            "found one place, allowed: at least two places",
        ),
    ] {
        let mut stage = static_stage(json!({ "load_position": 2, "load_n": 1e5 }));
        stage.bridge[key] = value.clone();
        refused(stage.write(), &["bridge.json: ", part]);
        // a crossing is restored by its inertia
        let mut stage = Stage::new();
        stage.bridge[key] = value;
        let output = stage.write().pontoon(&["plan", "study.json"]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    }
}

#[test]
fn places_and_lines_twice() {
    for (pointer, key, list) in [
        ("/hinges", "y_m", json!([1, 1])),
        ("/connectors", "y_m", json!([1, 1.0000001])),
        ("/module/longitudinal_walls", "y_m", json!([1, 1])),
        ("/module/transverse_walls", "x_m", json!([1, 1])),
        ("/module/stiffeners", "transverse_x_m", json!([1, 1])),
    ] {
        bridge(
            pointer,
            key,
            list,
            &[&format!("{key}[1]: found 1"), "twice, allowed: each place once"],
        );
    }
}

#[test]
fn meshes_and_designs_that_do_not_fit() {
    let huge = json!({ "elements_along": 200, "elements_between_lines": 200, "elements_over_depth": 200 });
    bridge(
        "/module",
        "mesh",
        huge,
        &["module.mesh: ", "GiB, allowed: ", "at most 4 GiB"],
    );
    let mut stage = Stage::new();
    stage.study["design"][0]["grid"]["bridge.module.mesh.elements_between_lines"] = json!([1, 200]);
    refused(
        stage.write(),
        &["study.json: design[0].grid (bridge.module.mesh): found "],
    );
    study(
        "",
        "design",
        json!([{ "grid": { "speed_m_s": { "linspace": [1, 2, 1e6] }, "load_n": { "linspace": [1, 2, 1e6] } } }]),
        &["design: found 1000000000000 points, allowed: at most 10000000 points"],
    );
}

#[test]
fn axes_that_contradict_each_other() {
    let both = |a: &str, x: Value, b: &str, y: Value| {
        let grid = json!({ "speed_m_s": 5, "load_n": 1e5, a: x, b: y });
        let found = format!("design[0].grid.{b}: found an axis that sets what {a} sets too");
        study("", "design", json!([{ "grid": grid }]), &[&found]);
    };
    both(
        "gap_tension_m",
        json!([0, 0.01]),
        "bridge.connectors.gap_tension_m",
        json!([0, 0.01]),
    );
    both(
        "vehicle.track_y_m[0]",
        json!([-1]),
        "vehicle.track_y_m",
        json!([[-1, 1]]),
    );
}

#[test]
fn a_folder_that_is_refused_is_left_as_it_was() {
    let stage = Stage::new();
    stage.ran("r");
    fs::create_dir(stage.path("t")).unwrap();
    fs::copy(stage.path("r/jobs.parquet"), stage.path("t/jobs.parquet")).unwrap();
    let output = stage.pontoon(&["run", "study.json", "--out", "t", "--quiet"]);
    assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
    let left: Vec<_> = fs::read_dir(stage.path("t"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name())
        .collect();
    assert_eq!(left, ["jobs.parquet"]);
}

#[test]
fn results_of_another_study_are_not_replaced() {
    let mut stage = Stage::new();
    stage.study["design"] = json!([{ "grid": { "load_n": 1e5, "speed_m_s": 15 } }]);
    let run = |stage: &Stage| stage.pontoon(&["run", "study.json", "--out", "r", "--quiet"]);
    assert_eq!(run(stage.write()).status.code(), Some(0));
    fs::write(stage.path("r/notes.txt"), "mine").unwrap();
    assert_eq!(run(&stage).status.code(), Some(0));
    assert_eq!(fs::read_to_string(stage.path("r/notes.txt")).unwrap(), "mine");
    stage.study["name"] = json!("other");
    let before = fs::read(stage.path("r/manifest.json")).unwrap();
    let output = run(stage.write());
    assert_eq!(output.status.code(), Some(2));
    let message = "manifest.json: name: found results of the study 'smoke', allowed: a folder without results";
    assert!(stderr(&output).contains(message), "{}", stderr(&output));
    assert_eq!(fs::read(stage.path("r/manifest.json")).unwrap(), before);
}
