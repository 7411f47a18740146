//! What `pontoon calibrate` refuses, and what it does where it cannot go on; nothing is written by halves.

use super::calibrate::{calibrate, document, parameter, parameters, stage, static_check};
use crate::stage::{Stage, is_refused, stderr, stdout};
use serde_json::{Value, json};
use std::fs;

/// Calibrates into a folder that is not there yet and expects a refusal that leaves everything as it was.
fn refused(stage: &Stage, parameters: &Value, parts: &[&str]) {
    stage.json("parameters.json", parameters);
    let before = stage.names();
    is_refused(&calibrate(stage, parameters, &["--out", "new/found.json"]), parts);
    assert_eq!(stage.names(), before, "{parts:?}");
}

fn of(parameter: Value) -> Value {
    json!({ "parameters": [parameter] })
}

#[test]
fn parameters_that_the_bridge_does_not_have_or_that_cannot_move() {
    let stage = stage();
    let sets = |sets: Value| of(json!({ "name": "own_m", "lower": 0.001, "upper": 0.01, "sets": sets }));
    for (made, parts) in [
        (
            of(parameter("hydrostatic_stifness_pa_m", 1.0, 9e3)),
            &[
                "parameters.json: parameters[0].name: ",
                "nearest known: hydrostatic_stiffness_pa_m",
            ][..],
        ),
        (
            of(parameter("module.deck_m", 1.0, 2.0)),
            &["parameters[0].name: ", "nearest known: module."],
        ),
        (
            of(parameter("total_mass_kg", 1.0, 2.0)),
            &["nearest known: total_mass_kg_m"],
        ),
        (
            of(parameter("module.material", 1.0, 2.0)),
            &["parameters[0].name: found \"module.material\", which is no number"],
        ),
        (
            of(parameter("name", 1.0, 2.0)),
            &["parameters[0].name: found \"name\", which is no number"],
        ),
        (
            of(parameter("hinges.y_m", 1.0, 2.0)),
            &["found \"hinges.y_m\", which is no number"],
        ),
        (
            of(parameter("hinges.y_m[9]", 1.0, 2.0)),
            &["parameters[0].name: ", "nearest known: hinges.y_m["],
        ),
        (
            of(parameter("modules", 2.0, 5.0)),
            &["parameters[0].name: found \"modules\", a whole number"],
        ),
        (
            sets(json!({ "module.deck_thicknes_m": 1 })),
            &[
                "parameters[0].sets.module.deck_thicknes_m: ",
                "nearest known: module.deck_thickness_m",
            ],
        ),
        (
            sets(json!({ "module.deck_thickness_m": 0 })),
            &["parameters[0].sets.module.deck_thickness_m: found 0"],
        ),
        (
            sets(json!({ "module.deck_thickness_m": "x" })),
            &["found \"x\", allowed: a number"],
        ),
        (
            sets(json!({ "module.deck_thickness_m": 1, "module.bottom_thickness_m": 2 })),
            &[
                "parameters[0].sets.module.deck_thickness_m: found 0.00295 in the bridge",
                "as its other numbers make it",
            ],
        ),
    ] {
        refused(&stage, &made, parts);
    }
}

#[test]
fn bounds_that_are_none() {
    let stage = stage();
    let name = "hydrostatic_stiffness_pa_m";
    for (made, parts) in [
        (
            of(parameter(name, 7600.0, 8000.0)),
            &[
                "parameters[0]: found 7486, where hydrostatic_stiffness_pa_m starts",
                "7600 to 8000 do not",
            ][..],
        ),
        (
            of(parameter(name, 8000.0, 7000.0)),
            &["parameters[0].upper: found 7000, allowed: above lower, 8000"],
        ),
        (of(parameter(name, 7486.0, 7486.0)), &["parameters[0].upper: "]),
        (of(parameter(name, -1e308, 1e308)), &["parameters[0].upper: "]),
        (
            of(json!({ "name": name, "lower": 7000 })),
            &["parameters[0].upper: missing key `upper`"],
        ),
        (
            of(json!({ "name": name, "lower": "a", "upper": 1 })),
            &["parameters[0].lower: found \"a\", allowed: a number"],
        ),
        (
            of(json!({ "name": name, "lower": 1, "uper": 1 })),
            &["parameters[0].uper: ", "nearest known: upper"],
        ),
    ] {
        refused(&stage, &made, parts);
    }
}

#[test]
fn numbers_that_two_things_move() {
    let stage = stage();
    let plates =
        |name: &str| json!({ "name": name, "lower": 0.001, "upper": 0.006, "sets": { "module.deck_thickness_m": 1 } });
    let (mass, added) = (
        parameter("total_mass_kg_m", 1e4, 2e4),
        parameter("added_mass_kg_m", 1e4, 2e4),
    );
    for (list, hold, parts) in [
        (
            json!([plates("a"), plates("a")]),
            json!({}),
            &["parameters[1].name: found \"a\" twice"][..],
        ),
        (
            json!([plates("a"), plates("b")]),
            json!({}),
            &["parameters[1].sets.module.deck_thickness_m: ", "which follows 'a'"],
        ),
        (
            json!([plates("a"), parameter("module.deck_thickness_m", 0.001, 0.006)]),
            json!({}),
            &["parameters[1].name: "],
        ),
        (
            json!([added, mass]),
            json!({}),
            &["parameters[0].name: found \"added_mass_kg_m\", which follows 'total_mass_kg_m'"],
        ),
        (
            json!([added]),
            json!({ "total_mass_kg_m": 12000 }),
            &["parameters[0].name: "],
        ),
        (
            json!([mass]),
            json!({ "total_mass_kg_m": 12000 }),
            &["hold.total_mass_kg_m: found a parameter of the same name"],
        ),
        (
            json!([mass]),
            json!({ "structural_mass": 7000 }),
            &["hold.structural_mass: ", "nearest known: structural_mass_kg"],
        ),
        (
            json!([mass]),
            json!({ "structural_mass_kg": -1 }),
            &["hold.structural_mass_kg: found -1"],
        ),
        (
            json!([mass]),
            json!({ "structural_mass_kg": "x" }),
            &["hold.structural_mass_kg: found \"x\""],
        ),
        (json!([]), json!({}), &["parameters: found an empty list"]),
    ] {
        refused(&stage, &json!({ "parameters": list, "hold": hold }), parts);
    }
}

#[test]
fn checks_that_cannot_be_fitted() {
    let stage = stage();
    let with = |key: &str, value: Value| {
        let mut all = parameters();
        all[key] = value;
        all
    };
    for (made, parts) in [
        (
            with("fit", json!(["heave", "torison 1"])),
            &["parameters.json: fit[1]: ", "nearest known: torsion 1"][..],
        ),
        (with("fit", json!([])), &["fit: found no check to fit"]),
        (with("fitt", json!([])), &["fitt: ", "nearest known: fit"]),
        (with("difference_share", json!(0.5)), &["difference_share: found 0.5"]),
        (with("tolerance", json!(0)), &["tolerance: found 0"]),
        (with("evaluations_limit", json!(0)), &["evaluations_limit: found 0"]),
        (with("evaluations_limit", json!(1.5)), &["evaluations_limit: found 1.5"]),
    ] {
        refused(&stage, &made, parts);
    }
    let bare = json!({ "id": "bare", "role": "record", "mode": { "shape": "heave", "expected_hz": 1 } });
    let of = json!({ "select": { "table": "modes", "column": "frequency_hz", "reduce": "max" } });
    let bound = json!({ "id": "bound", "bound": { "of": of, "at_least": 0 } });
    let mode = json!({ "shape": "heave", "expected_hz": 0.36, "relative_tolerance": 0.1 });
    let each = json!({ "id": "each", "each": ["analysis.model"], "mode": mode });
    stage.json("modes.reference.json", &document("modes.json", &[bare, bound, each]));
    for id in ["bare", "bound", "each"] {
        let found = format!("fit[0]: found \"{id}\", which is no check of one value with a tolerance");
        refused(&stage, &with("fit", json!([id])), &[&found]);
    }
}

#[test]
fn references_and_files_that_are_not_there() {
    let stage = stage();
    let good = fs::read_to_string(stage.path("statics.reference.json")).unwrap();
    let mut reference: Value = serde_json::from_str(&good).unwrap();
    reference["study"] = "gone.json".into();
    stage.json("statics.reference.json", &reference);
    refused(&stage, &parameters(), &["gone.json: found no readable file"]);
    reference.as_object_mut().unwrap().remove("study");
    stage.json("statics.reference.json", &reference);
    refused(
        &stage,
        &parameters(),
        &["statics.reference.json: study: missing key `study`"],
    );
    // what a fitted check names is looked for where the first bridge is computed
    for (key, value, parts) in [
        (
            "column",
            json!("deflecton_m"),
            &["checks[0].value.of.select.column: ", "nearest known: deflection_m"][..],
        ),
        (
            "where",
            json!({ "positon": 2 }),
            &["checks[0].value.of.select.where.positon: ", "nearest known: position"],
        ),
    ] {
        let mut check = static_check(0.02, 0.001);
        check["value"]["of"]["select"][key] = value;
        stage.json("statics.reference.json", &document("statics.json", &[check]));
        is_refused(
            &calibrate(&stage, &parameters(), &["--quiet"]),
            &[&["statics.reference.json: "], parts].concat(),
        );
    }
    stage.json("statics.reference.json", &serde_json::from_str(&good).unwrap());
    for missing in ["parameters.json", "modes.reference.json", "start.json"] {
        let path = stage.path(missing);
        stage.json("parameters.json", &parameters());
        let bytes = fs::read(&path).unwrap();
        fs::remove_file(&path).unwrap();
        let output = stage.pontoon(&[
            "calibrate",
            "start.json",
            "--with",
            "modes.reference.json",
            "--parameters",
            "parameters.json",
            "--out",
            "new/found.json",
        ]);
        is_refused(&output, &[missing, "found no readable file"]);
        fs::write(&path, bytes).unwrap();
    }
    assert!(!stage.path("new").exists() && !stage.path("found.json").exists());
}

#[test]
fn a_start_that_fails_is_said_with_its_numbers() {
    let stage = stage();
    // with a single iteration the joints do not settle
    let study = json!({ "name": "statics", "bridge": "bridge.json",
        "analysis": { "kind": "crossing", "time_step_s": 0.02, "newton_limit": 1, "bisection_limit": 0 },
        "design": [{ "grid": { "connection": "nonlinear", "speed_m_s": 15, "load_n": 2e5 } }] });
    stage.json("statics.json", &study);
    let of = json!({ "select": { "table": "jobs", "column": "peak_deflection_m" } });
    let check = json!({ "id": "peak", "value": { "of": of, "expected": 0.1, "relative_tolerance": 0.1 } });
    stage.json("statics.reference.json", &document("statics.json", &[check]));
    let output = calibrate(&stage, &parameters(), &["--quiet"]);
    let message = stderr(&output);
    assert_eq!(
        (output.status.code(), stdout(&output).as_str()),
        (Some(3), ""),
        "{message}"
    );
    for part in [
        "the bridge to start from fails, at plates_m 2.95",
        "total_mass_kg_m ",
        "statics: job 0: contact not settled at t = ",
    ] {
        assert!(message.contains(part), "no '{part}' in {message}");
    }
    assert_eq!(message.lines().count(), 1, "{message}");
    assert!(!stage.path("found.json").exists());
}

#[test]
fn a_start_that_is_no_bridge_is_refused() {
    let stage = stage();
    let mut light = of(parameter("connectors.stiffness_n_m", 1.5e7, 4e7));
    light["hold"] = json!({ "total_mass_kg_m": 10 });
    let output = calibrate(&stage, &light, &["--quiet"]);
    is_refused(
        &output,
        &[
            "parameters.json: parameters: found -",
            "which they make of added_mass_kg_m",
        ],
    );
    assert!(!stage.path("found.json").exists());
}

#[test]
fn bridges_that_cannot_be_written_are_not_written_by_halves() {
    let stage = stage();
    let before = stage.names();
    let quiet = |out: &str| calibrate(&stage, &parameters(), &["--out", out, "--quiet"]);
    stage.json("parameters.json", &parameters());
    let output = quiet("start.json/found.json");
    assert_eq!(output.status.code(), Some(3), "{}", stderr(&output));
    assert!(
        stderr(&output).contains("no place for the bridge: start.json"),
        "{}",
        stderr(&output)
    );
    for out in ["modes", ".."] {
        is_refused(
            &quiet(out),
            &["found a folder, allowed: a new file, or a bridge of `pontoon calibrate`"],
        );
    }
    // what somebody wrote is nothing to write over
    fs::write(stage.path("notes.txt"), "mine").unwrap();
    for out in ["notes.txt", "modes.json", "parameters.json"] {
        let bytes = fs::read(stage.path(out)).unwrap();
        is_refused(
            &quiet(out),
            &[
                out,
                "found another file, allowed: a new file, or a bridge of `pontoon calibrate`",
            ],
        );
        assert_eq!(fs::read(stage.path(out)).unwrap(), bytes, "{out}");
    }
    fs::remove_file(stage.path("notes.txt")).unwrap();
    let names = stage.names();
    let more: Vec<&String> = names.iter().filter(|name| !before.contains(name)).collect();
    assert_eq!(more, ["parameters.json"]);
}
