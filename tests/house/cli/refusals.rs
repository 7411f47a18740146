//! Bad input: exit status 2, one message with file, key path, found and allowed, and nothing written.

use crate::stage::{Stage, one_message, says_what_is_wrong, stderr, stdout};
use serde_json::{Value, json};
use std::fs;

/// Runs a study as it stands and expects it to be refused with all of `parts` in the one line of the message.
pub(super) fn refused(stage: &Stage, parts: &[&str]) {
    let before = stage.names();
    for command in ["run", "plan"] {
        let output = stage.pontoon(&[command, "study.json"]);
        let told = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{command}: {parts:?}: {told}");
        let message = one_message(&told);
        // a key of a file that a person wrote has a place in it
        assert_eq!(told.lines().count() > 1, !is_of_the_whole(message), "{command}: {told}");
        assert!(says_what_is_wrong(message), "{command}: {message}");
        for part in parts {
            assert!(message.contains(part), "{command}: no '{part}' in: {message}");
        }
        assert_eq!(stdout(&output), "", "{command}");
        assert_eq!(stage.names(), before, "{command} wrote something");
    }
}

/// Whether a message is of a file as a whole: one that cannot be read or is empty.
fn is_of_the_whole(message: &str) -> bool {
    ["found no readable file", "found an empty file"]
        .iter()
        .any(|found| message.contains(found))
}

/// Sets a value of the study at a JSON pointer's parent and key and expects the refusal.
pub(super) fn study(pointer: &str, key: &str, value: Value, parts: &[&str]) {
    let mut stage = Stage::new();
    stage.study.pointer_mut(pointer).unwrap()[key] = value;
    refused(stage.write(), &[&["study.json: "], parts].concat());
}

pub(super) fn bridge(pointer: &str, key: &str, value: Value, parts: &[&str]) {
    let mut stage = Stage::new();
    stage.bridge.pointer_mut(pointer).unwrap()[key] = value;
    refused(stage.write(), &[&["bridge.json: "], parts].concat());
}

pub(super) fn grid(key: &str, value: Value, parts: &[&str]) {
    study(
        "/design/0/grid",
        key,
        value,
        &[&[format!("design[0].grid.{key}").as_str()], parts].concat(),
    );
}

/// A study of static cases on the smoke bridge.
pub(super) fn static_stage(case: Value) -> Stage {
    let mut stage = Stage::new();
    stage.study["analysis"] = json!({ "kind": "static" });
    stage.study["design"] = json!([{ "cases": [case] }]);
    stage.study["record"] = json!({});
    stage
}

#[test]
fn the_stage_itself_is_accepted() {
    let output = Stage::new().write().pontoon(&["plan", "study.json"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let stage = static_stage(json!({ "load_position": 2, "load_n": 1e5 }));
    assert_eq!(stage.write().pontoon(&["plan", "study.json"]).status.code(), Some(0));
}

#[test]
fn unknown_keys_name_their_path_and_the_nearest() {
    study(
        "",
        "vehicl",
        json!({}),
        &["vehicl: found unknown key `vehicl`", "nearest known: vehicle"],
    );
    study(
        "/analysis",
        "time_step",
        json!(0.1),
        &["analysis.time_step: ", "nearest known: time_step_s"],
    );
    study(
        "/vehicle",
        "foot_length_m",
        json!(1),
        &["vehicle.foot_length_m: ", "nearest known: footprint_length_m"],
    );
    study(
        "/record/histories",
        "position",
        json!([1]),
        &["record.histories.position: ", "nearest known: positions"],
    );
    study("/design/0", "gird", json!({}), &["design[0]"]);
    bridge("", "modles", json!(3), &["modles: ", "nearest known: modules"]);
    bridge(
        "/module/material",
        "youngs_modulus",
        json!(1),
        &["module.material.youngs_modulus: ", "youngs_modulus_pa"],
    );
    bridge(
        "/connectors",
        "gap_tensoin_m",
        json!(0),
        &["connectors.gap_tensoin_m: ", "nearest known: gap_tension_m"],
    );
}

#[test]
fn unknown_axes_name_the_nearest() {
    grid("sped_m_s", json!([3]), &["nearest known: speed_m_s"]);
    grid(
        "hydrostatic_stiffness_pa_m",
        json!([3]),
        &["nearest known: bridge.hydrostatic_stiffness_pa_m"],
    );
    grid(
        "bridge.hydrostatic_stifness_pa_m",
        json!([3]),
        &["nearest known: hydrostatic_stiffness_pa_m"],
    );
    grid(
        "bridge.module.deck_thicknes_m",
        json!([3]),
        &["nearest known: deck_thickness_m"],
    );
    grid("vehicle.axles[0].share", json!([1]), &["found no list to hold [0]"]);
    grid(
        "bridge.hinges.y_m[7]",
        json!([1]),
        &["found no place [7] in a list of 3"],
    );
}

#[test]
fn missing_files_and_keys() {
    let stage = Stage::new();
    let output = stage.pontoon(&["run", "nowhere.json"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(
        stderr(&output).contains("nowhere.json: found no readable file"),
        "{}",
        stderr(&output)
    );
    assert_eq!(stage.names(), Vec::<String>::new());
    study(
        "",
        "bridge",
        json!("other.json"),
        &["bridge: found \"other.json\", which is no file"],
    );
    let mut stage = Stage::new();
    stage.bridge["module"].as_object_mut().unwrap().remove("depth_m");
    refused(stage.write(), &["bridge.json: module.depth_m: missing key `depth_m`"]);
    for command in [["modes", "nowhere.json"], ["modes", "bridge.json"]] {
        let output = stage.pontoon(&command);
        assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
    }
}

#[test]
fn lengths_stiffnesses_masses_and_speeds_of_nothing_or_less() {
    for value in [0.0, -1.0] {
        let found = format!("found {value}, allowed: a finite number above 0");
        bridge("/module", "length_m", json!(value), &["module.length_m: ", &found]);
        bridge(
            "/connectors",
            "stiffness_n_m",
            json!(value),
            &["connectors.stiffness_n_m: ", &found],
        );
        bridge(
            "/module/material",
            "density_kg_m3",
            json!(value),
            &["module.material.density_kg_m3: ", &found],
        );
        bridge(
            "",
            "hydrostatic_stiffness_pa_m",
            json!(value),
            &["hydrostatic_stiffness_pa_m: ", &found],
        );
        study(
            "/vehicle",
            "footprint_length_m",
            json!(value),
            &["vehicle.footprint_length_m: ", &found],
        );
        grid("speed_m_s", json!([5, value]), &[&found]);
        grid("load_n", json!(value), &[&found]);
        grid("bridge.module.length_m", json!([6.7, value]), &[&found]);
    }
    bridge("", "added_mass_kg_m", json!(-1), &["added_mass_kg_m: found -1"]);
    bridge("", "modules", json!(0), &["modules: found 0"]);
}

#[test]
fn gaps_below_zero() {
    grid(
        "gap_tension_m",
        json!([0.01, -0.01]),
        &["found -0.01, allowed: a finite number of at least 0"],
    );
    grid("gap_compression_m", json!(-0.01), &["found -0.01"]);
    bridge(
        "/connectors",
        "gap_tension_m",
        json!(-0.01),
        &["connectors.gap_tension_m: found -0.01"],
    );
}

#[test]
fn numbers_that_are_not_finite() {
    for token in ["NaN", "1e999", "-Infinity"] {
        for (file, key) in [("study.json", "analysis.tail_s"), ("bridge.json", "module.length_m")] {
            let stage = Stage::new();
            stage.write();
            let (name, old) = if file == "study.json" {
                ("tail_s", "2.0")
            } else {
                ("length_m", "6.7")
            };
            let text = fs::read_to_string(stage.path(file)).unwrap();
            let changed = text.replace(&format!("\"{name}\": {old}"), &format!("\"{name}\": {token}"));
            assert_ne!(text, changed);
            fs::write(stage.path(file), changed).unwrap();
            refused(
                &stage,
                &[file, key, &format!("found {token}"), "allowed: a finite number"],
            );
        }
    }
}

#[test]
fn tracks_off_the_deck() {
    study(
        "/vehicle",
        "track_y_m",
        json!([-1.4, 4.2]),
        &["vehicle.track_y_m[1]: found 4.2"],
    );
    study(
        "/vehicle",
        "track_y_m",
        json!([]),
        &["vehicle.track_y_m: found an empty list"],
    );
    grid(
        "vehicle.track_y_m",
        json!([[-1.4, 1.4], [-5, 1]]),
        &["vehicle.track_y_m[0]: found -5"],
    );
    study(
        "",
        "vehicle",
        json!({ "axles": [{ "behind_front_m": 0, "share": 1, "patch_length_m": 0.3, "track_y_m": [9] }] }),
        &["vehicle.axles[0].track_y_m[0]: found 9"],
    );
}

#[test]
fn axes_and_designs_without_a_value() {
    grid(
        "load_n",
        json!([]),
        &["found an empty list, allowed: at least one value"],
    );
    study("", "design", json!([]), &["design: found an empty list"]);
    study(
        "",
        "design",
        json!([{ "cases": [] }]),
        &["design[0].cases: found an empty list"],
    );
    study(
        "",
        "design",
        json!([{ "grid": { "load_n": 1e5 } }]),
        &["design[0].grid.speed_m_s: missing key `speed_m_s` (required)"],
    );
    study(
        "",
        "design",
        json!([{ "cases": [{ "speed_m_s": 5 }] }]),
        &["design[0].cases[0].load_n: missing key `load_n` (required)"],
    );
    grid("connection", json!(["linaer"]), &["nearest known: linear"]);
    grid("speed_m_s", json!(["fast"]), &["found \"fast\", allowed: a number"]);
}

#[test]
fn places_outside_the_bridge() {
    let case = |case: Value, parts: &[&str]| refused(static_stage(case).write(), parts);
    case(
        json!({ "load_position": 5, "load_n": 1e5 }),
        &["cases[0].load_position: found 5", "from 1 to 4"],
    );
    case(
        json!({ "load_position": 0, "load_n": 1e5 }),
        &["cases[0].load_position: found 0"],
    );
    case(
        json!({ "load_position": 1.5, "load_n": 1e5 }),
        &["cases[0].load_position: found 1.5"],
    );
    case(
        json!({ "load_x_m": 20.2, "load_n": 1e5 }),
        &["cases[0].load_x_m: found 20.2"],
    );
    case(
        json!({ "load_x_m": -0.1, "load_n": 1e5 }),
        &["cases[0].load_x_m: found -0.1"],
    );
    study(
        "/record/histories",
        "positions",
        json!([2, 5]),
        &["record.histories.positions[1]: found 5, allowed: 1 to 4"],
    );
    study(
        "/record/histories",
        "positions",
        json!([0]),
        &["record.histories.positions[0]: found 0"],
    );
    study(
        "/record/histories",
        "joints",
        json!([1]),
        &["record.histories.joints[0]: found 1, allowed: 2 to 3"],
    );
    study(
        "/record/histories",
        "joints",
        json!([4]),
        &["record.histories.joints[0]: found 4"],
    );
    study(
        "/record/histories",
        "joints",
        json!([2, 2]),
        &["record.histories.joints[1]: found 2 twice"],
    );
}

#[test]
fn time_steps_of_nothing_or_beyond_the_passage_of_a_module() {
    study(
        "/analysis",
        "time_step_s",
        json!(0),
        &["analysis.time_step_s: found 0, allowed: a finite number above 0"],
    );
    study(
        "/analysis",
        "time_step_s",
        json!(-0.01),
        &["analysis.time_step_s: found -0.01"],
    );
    study(
        "/analysis",
        "time_step_s",
        json!(0.68),
        &["analysis.time_step_s: found 0.68", "at most 0.67", "10 m/s"],
    );
    grid(
        "analysis.time_step_s",
        json!([0.01, 0.7]),
        &["found 0.7", "at most 0.67"],
    );
}

#[test]
fn axes_of_the_other_kind() {
    let case = |case: Value, parts: &[&str]| refused(static_stage(case).write(), parts);
    case(
        json!({ "load_position": 2, "load_n": 1e5, "speed_m_s": 3 }),
        &["cases[0].speed_m_s: found 3"],
    );
    case(
        json!({ "load_n": 1e5 }),
        &["cases[0]: found neither", "exactly one of the two"],
    );
    case(
        json!({ "load_position": 2, "load_x_m": 6.7, "load_n": 1e5 }),
        &["cases[0]: found both"],
    );
    grid(
        "load_position",
        json!(2),
        &["no place of the load in a study of crossings"],
    );
    let mut stage = static_stage(json!({ "load_position": 2, "load_n": 1e5 }));
    stage.study["analysis"]["time_step_s"] = json!(0.01);
    refused(stage.write(), &["analysis.time_step_s: found a key of crossings"]);
}

#[test]
fn solvers_models_and_names_that_are_not_known() {
    study(
        "/analysis",
        "solver",
        json!("newmark"),
        &[
            "analysis.solver: found unknown \"newmark\"",
            "allowed: operator, reference",
        ],
    );
    study(
        "/analysis",
        "model",
        json!("super_element"),
        &["analysis.model: ", "nearest known: super-element"],
    );
    study(
        "/analysis",
        "kind",
        json!("crosing"),
        &["analysis.kind: ", "nearest known: crossing"],
    );
    study("", "name", json!("../elsewhere"), &["name: found \"../elsewhere\""]);
}

#[test]
fn words_that_are_not_understood_are_refused_too() {
    let stage = Stage::new();
    stage.write();
    for words in [
        &["run"][..],
        &["run", "study.json", "--shard", "2/2"],
        &["rnu"],
        &["run", "study.json", "--threads", "0"],
    ] {
        assert_eq!(stage.pontoon(words).status.code(), Some(2), "{words:?}");
    }
    assert_eq!(stage.names(), ["bridge.json", "study.json"]);
}
