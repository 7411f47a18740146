//! `pontoon calibrate` on a bridge of three modules whose numbers are known.

use crate::stage::{Stage, stderr, stdout};
use serde_json::{Value, json};
use std::fs;
use std::process::Output;

const PLATES_M: f64 = 0.0034;
const STIFFNESS_N_M: f64 = 2.9e7;
const HYDROSTATIC_PA_M: f64 = 7700.0;
const TOTAL_KG_M: f64 = 12600.0;

/// A stage of calibration: `truth.json` with the known numbers, `start.json` with others, references of modes and statics
/// that expect what the true bridge has.
pub(super) fn stage() -> Stage {
    let mut stage = Stage::new();
    let start = stage.bridge.clone();
    let module = &mut stage.bridge["module"];
    for key in ["deck_thickness_m", "bottom_thickness_m"] {
        module[key] = json!(PLATES_M);
    }
    stage.bridge["connectors"]["stiffness_n_m"] = json!(STIFFNESS_N_M);
    stage.bridge["hydrostatic_stiffness_pa_m"] = json!(HYDROSTATIC_PA_M);
    stage.json("truth.json", &stage.bridge);
    let mass = structural_mass_kg(&stage, "truth.json") / 6.7;
    stage.bridge["added_mass_kg_m"] = json!(TOTAL_KG_M - mass);
    stage.json("start.json", &start);
    let modes = json!({ "name": "modes", "bridge": "bridge.json", "analysis": { "kind": "modes", "count": 10 },
                        "design": [{ "grid": { "analysis.model": ["super-element"] } }] });
    let statics = json!({ "name": "statics", "bridge": "bridge.json", "analysis": { "kind": "static" },
                          "design": [{ "grid": { "connection": ["linear"], "load_position": [2, 3], "load_n": 1e5 } }] });
    for (name, study) in [("modes", &modes), ("statics", &statics)] {
        stage.study = study.clone();
        stage.ran(name);
        stage.json(&format!("{name}.json"), study);
    }
    let table = stage.table("modes/modes.parquet");
    let shapes = table.column("shape").unwrap().str().unwrap();
    let frequencies = stage.numbers("modes/modes.parquet", "frequency_hz");
    let checks: Vec<Value> = (0..frequencies.len())
        .map(|row| (shapes.get(row).unwrap(), frequencies[row].unwrap()))
        .filter(|(_, hz)| *hz > 0.01)
        .map(|(shape, hz)| json!({ "id": shape, "mode": { "shape": shape, "expected_hz": hz, "relative_tolerance": 0.001 } }))
        .collect();
    assert!(checks.len() >= 5, "{checks:?}");
    stage.json("modes.reference.json", &document("modes.json", &checks));
    let deflection = stage.numbers("statics/positions.parquet", "deflection_m")[1].unwrap();
    stage.json(
        "statics.reference.json",
        &document("statics.json", &[static_check(deflection, 0.001)]),
    );
    stage
}

/// What a static job has at position 2 under the load there.
pub(super) fn static_check(expected: f64, relative_tolerance: f64) -> Value {
    let of = json!({ "select": { "table": "positions", "column": "deflection_m", "where": { "position": 2, "load_position": 2 } } });
    json!({ "id": "deflection", "value": { "of": of, "expected": expected, "relative_tolerance": relative_tolerance } })
}

pub(super) fn document(study: &str, checks: &[Value]) -> Value {
    json!({ "name": study, "source": "a bridge of known numbers", "study": study, "checks": checks })
}

/// The mass of a module of a bridge, as the table of jobs of modes gives it.
fn structural_mass_kg(stage: &Stage, bridge: &str) -> f64 {
    let study = json!({ "name": "mass", "bridge": bridge, "analysis": { "kind": "modes", "count": 1 },
                        "design": [{ "grid": { "analysis.model": "super-element" } }] });
    stage.json("mass.json", &study);
    let output = stage.pontoon(&["run", "mass.json", "--out", "mass", "--quiet", "--fresh"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    stage.numbers("mass/jobs.parquet", "structural_mass_kg")[0].unwrap()
}

pub(super) fn parameter(name: &str, lower: f64, upper: f64) -> Value {
    json!({ "name": name, "lower": lower, "upper": upper })
}

/// All four numbers that the true bridge has otherwise.
pub(super) fn parameters() -> Value {
    let mut plates = parameter("plates_m", 0.002, 0.005);
    plates["sets"] = json!({ "module.deck_thickness_m": 1, "module.bottom_thickness_m": 1 });
    json!({ "parameters": [
        plates,
        parameter("connectors.stiffness_n_m", 1.5e7, 4e7),
        parameter("hydrostatic_stiffness_pa_m", 7000.0, 8200.0),
        parameter("total_mass_kg_m", 11000.0, 13500.0),
    ] })
}

/// Calibrates `start.json` to both references with further words.
pub(super) fn calibrate(stage: &Stage, parameters: &Value, more: &[&str]) -> Output {
    stage.json("parameters.json", parameters);
    let words = [
        "calibrate",
        "start.json",
        "--with",
        "modes.reference.json",
        "--with",
        "statics.reference.json",
        "--parameters",
        "parameters.json",
    ];
    let out: &[&str] = if more.contains(&"--out") {
        &[]
    } else {
        &["--out", "found.json"]
    };
    stage.pontoon(&[&words[..], out, more].concat())
}

/// The outcome of a calibration that came to an end with a status.
fn outcome(output: &Output, status: i32) -> Value {
    assert_eq!(
        output.status.code(),
        Some(status),
        "{}{}",
        stderr(output),
        stdout(output)
    );
    serde_json::from_str(&stdout(output)).unwrap()
}

fn found<'a>(outcome: &'a Value, name: &str) -> &'a Value {
    let mut all = outcome["parameters"].as_array().unwrap().iter();
    all.find(|p| p["name"] == name).unwrap()
}

#[test]
fn known_numbers_are_found_again() {
    let stage = stage();
    let output = calibrate(&stage, &parameters(), &["--format", "json", "--quiet"]);
    let told = outcome(&output, 0);
    assert_eq!(stderr(&output), "");
    for (name, truth) in [
        ("plates_m", PLATES_M),
        ("connectors.stiffness_n_m", STIFFNESS_N_M),
        ("hydrostatic_stiffness_pa_m", HYDROSTATIC_PA_M),
        ("total_mass_kg_m", TOTAL_KG_M),
    ] {
        let p = found(&told, name);
        let best = p["found"].as_f64().unwrap();
        assert!((best / truth - 1.0).abs() < 2e-3, "{name}: {best} for {truth}: {p}");
        assert!((p["start"].as_f64().unwrap() / truth - 1.0).abs() > 0.01, "{p}");
        assert!(
            p["standard_error"].as_f64().is_some_and(|error| error > 0.0) && p["remark"].is_null(),
            "{p}"
        );
    }
    let [before, after] = ["sum_of_squares_start", "sum_of_squares_best"].map(|key| told[key].as_f64().unwrap());
    assert!(before > 100.0 && after < 1e-2, "{before} {after}");
    assert_eq!(told["undetermined"], json!([]));
    assert_eq!(told["correlation"][0][0], json!(1.0));
    let bridge: Value = serde_json::from_str(&fs::read_to_string(stage.path("found.json")).unwrap()).unwrap();
    assert_eq!(bridge, told["bridge"]);
    let plates = &found(&told, "plates_m")["found"];
    assert_eq!(
        (
            &bridge["module"]["deck_thickness_m"],
            &bridge["module"]["bottom_thickness_m"]
        ),
        (plates, plates)
    );
    let total = structural_mass_kg(&stage, "found.json") / 6.7 + bridge["added_mass_kg_m"].as_f64().unwrap();
    assert!(
        (total / found(&told, "total_mass_kg_m")["found"].as_f64().unwrap() - 1.0).abs() < 1e-9,
        "{total}"
    );
}

#[test]
fn the_bridge_is_one_that_the_program_reads_with_its_provenance() {
    let stage = stage();
    assert_eq!(calibrate(&stage, &parameters(), &[]).status.code(), Some(0));
    let output = stage.pontoon(&["modes", "found.json", "--count", "6"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let bridge: Value = serde_json::from_str(&fs::read_to_string(stage.path("found.json")).unwrap()).unwrap();
    let provenance = &bridge["provenance"];
    assert!(
        provenance["program"]
            .as_str()
            .unwrap()
            .starts_with("pontoon calibrate "),
        "{provenance}"
    );
    let roles: Vec<&str> = provenance["documents"]
        .as_array()
        .unwrap()
        .iter()
        .map(|d| d["role"].as_str().unwrap())
        .collect();
    assert_eq!(
        roles,
        ["start", "parameters", "reference", "study", "reference", "study"]
    );
    assert_eq!(provenance["parameters"].as_array().unwrap().len(), 4);
    // what was found is a start like any other
    let again = stage.pontoon(&[
        "calibrate",
        "found.json",
        "--with",
        "modes.reference.json",
        "--parameters",
        "parameters.json",
        "--out",
        "again.json",
        "--quiet",
    ]);
    assert_eq!(again.status.code(), Some(0), "{}", stderr(&again));
}

#[test]
fn the_bytes_do_not_depend_on_threads_or_on_the_run() {
    let stage = stage();
    let bytes = |threads: &str, out: &str| {
        let output = calibrate(
            &stage,
            &parameters(),
            &["--threads", threads, "--out", out, "--format", "json", "--quiet"],
        );
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        (stdout(&output), fs::read(stage.path(out)).unwrap())
    };
    let first = bytes("1", "one.json");
    assert!(first == bytes("2", "two.json") && first == bytes("2", "two.json"));
}

#[test]
fn people_see_residuals_errors_and_correlations() {
    let stage = stage();
    let output = calibrate(&stage, &parameters(), &[]);
    let text = stdout(&output);
    for words in [
        "off before",
        "off after",
        "standard error",
        "correlation",
        "(4) total_mass_kg_m",
        "deflection ",
        "the data determine every parameter",
        "sum of squares",
        "converged: ",
        "bridge in found.json",
    ] {
        assert!(text.contains(words), "no '{words}' in {text}");
    }
    assert!(
        stderr(&output).contains("candidates, least sum of squares"),
        "{}",
        stderr(&output)
    );
}

#[test]
fn what_the_data_do_not_determine_is_said() {
    let stage = stage();
    let gap = json!({ "parameters": [
        parameter("hydrostatic_stiffness_pa_m", 7000.0, 8200.0),
        // no mode and no linear case knows of gaps
        parameter("connectors.gap_tension_m", 0.01, 0.05),
    ] });
    let output = calibrate(&stage, &gap, &["--format", "json"]);
    let told = outcome(&output, 0);
    assert_eq!(
        found(&told, "connectors.gap_tension_m")["remark"],
        "not determined by the data"
    );
    assert!(found(&told, "connectors.gap_tension_m")["standard_error"].is_null());
    assert!(
        told["undetermined"][0]
            .as_str()
            .unwrap()
            .contains("connectors.gap_tension_m"),
        "{told}"
    );
    let text = stdout(&calibrate(&stage, &gap, &[]));
    assert!(
        text.contains("the data do not determine +1.00 connectors.gap_tension_m"),
        "{text}"
    );
    // heave, roll and pitch do not tell stiffness from mass
    let mut both = json!({ "parameters": [
        parameter("hydrostatic_stiffness_pa_m", 5000.0, 10000.0),
        parameter("total_mass_kg_m", 8000.0, 17000.0),
    ] });
    both["fit"] = json!(["heave"]);
    let told = outcome(&calibrate(&stage, &both, &["--format", "json"]), 0);
    let direction = told["undetermined"][0].as_str().unwrap();
    assert!(
        direction.contains("hydrostatic_stiffness_pa_m") && direction.contains("total_mass_kg_m"),
        "{direction}"
    );
}

#[test]
fn a_minimum_outside_its_bounds_ends_on_the_bound() {
    let stage = stage();
    let outside = json!({ "parameters": [parameter("hydrostatic_stiffness_pa_m", 7400.0, 8000.0)],
                          "fit": ["heave", "pitch"] });
    let told = outcome(&calibrate(&stage, &outside, &["--format", "json"]), 0);
    let p = found(&told, "hydrostatic_stiffness_pa_m");
    assert_eq!(
        (&p["remark"], &p["found"]),
        (&json!("at its lower bound"), &json!(7400.0)),
        "{p}"
    );
}

#[test]
fn held_quantities_keep_their_value() {
    let stage = stage();
    let held = json!({ "parameters": [parameter("module.deck_thickness_m", 0.002, 0.005)],
                       "hold": { "structural_mass_kg": 7000, "total_mass_kg_m": 12500 } });
    let told = outcome(&calibrate(&stage, &held, &["--format", "json"]), 0);
    assert!((structural_mass_kg(&stage, "found.json") / 7000.0 - 1.0).abs() < 1e-9);
    let added = told["bridge"]["added_mass_kg_m"].as_f64().unwrap();
    assert!((added + 7000.0 / 6.7 - 12500.0).abs() < 1e-6, "{added}");
    assert_eq!(told["bridge"]["provenance"]["held"].as_array().unwrap().len(), 2);
}

/// The points that are told as failed, each on a line of standard error and in the outcome.
fn told_failures(output: &Output) -> Vec<String> {
    let message = stderr(output);
    let lines = message
        .lines()
        .filter_map(|line| line.strip_prefix("failed inside the bounds: "));
    let told: Vec<String> = lines.map(str::to_owned).collect();
    let printed: Value = serde_json::from_str(&stdout(output)).unwrap();
    assert_eq!(printed["failed"], json!(told));
    told
}

#[test]
fn a_model_that_fails_inside_the_bounds_is_told_and_the_fit_goes_on() {
    let stage = stage();
    let mut all = parameters();
    // a quarter of the width above 0.3 is no ratio of any material
    let ratio = parameter("module.material.poissons_ratio", 0.0, 0.9);
    all["parameters"].as_array_mut().unwrap().push(ratio);
    all["difference_share"] = json!(0.25);
    let output = calibrate(&stage, &all, &["--format", "json"]);
    let told = outcome(&output, 0);
    let failed = told_failures(&output);
    assert!(!failed.is_empty());
    for part in [
        "poissons_ratio 5.2",
        "allowed: ",
        "a difference over module.material.poissons_ratio not taken",
    ] {
        assert!(failed[0].contains(part), "no '{part}' in {}", failed[0]);
    }
    let best = found(&told, "module.material.poissons_ratio")["found"]
        .as_f64()
        .unwrap();
    assert!((best - 0.3).abs() < 0.05, "{best}");
}

#[test]
fn a_model_that_fails_on_both_sides_ends_a_search_that_has_not_converged() {
    let stage = stage();
    // a quarter of the width below the start the whole is lighter than its structure
    let blind = json!({ "parameters": [parameter("total_mass_kg_m", -40000.0, 12200.0)], "fit": ["heave"],
                        "difference_share": 0.25 });
    let output = calibrate(&stage, &blind, &["--format", "json"]);
    let told = outcome(&output, 1);
    let failures = told_failures(&output);
    assert!(failures[0].contains("which they make of added_mass_kg_m"), "{told}");
    let ending = told["ending"].as_str().unwrap();
    assert!(
        ending.contains("the model fails on both sides of the best point"),
        "{ending}"
    );
}

#[test]
fn a_limit_of_candidates_ends_a_search_that_has_not_converged() {
    let stage = stage();
    let mut limited = parameters();
    limited["evaluations_limit"] = json!(1);
    let output = calibrate(&stage, &limited, &[]);
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    assert!(
        stdout(&output).contains("not converged: the limit of model evaluations was reached"),
        "{}",
        stdout(&output)
    );
    assert_eq!(stage.pontoon(&["modes", "found.json"]).status.code(), Some(0));
}
