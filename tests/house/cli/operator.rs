//! Crossings by the operator: its judge, its time step, its cache.

use super::refusals::study as study_refused;
use crate::stage::{Stage, stderr};
use serde_json::{Value, json};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const JOBS: &str = "out/jobs.parquet";

/// A stage of a few crossings with keys of the analysis.
fn stage(analysis: &Value) -> Stage {
    let mut stage = Stage::new();
    stage.study["design"] = json!([{ "grid": {
        "connection": ["linear", "nonlinear"], "gap_tension_m": 0.01, "gap_compression_m": 0.002,
        "speed_m_s": [5, 10, 15], "load_n": 1e5
    } }]);
    let of = stage.study["analysis"].as_object_mut().unwrap();
    of.extend(analysis.as_object().unwrap().clone());
    stage.write();
    stage
}

/// Leaves the linear connection alone and writes the stage.
fn without_gaps(stage: &mut Stage) {
    let grid = stage.study["design"][0]["grid"].as_object_mut().unwrap();
    grid.insert("connection".to_owned(), json!("linear"));
    for gap in ["gap_tension_m", "gap_compression_m"] {
        grid.remove(gap);
    }
    stage.write();
}

fn run(stage: &Stage) -> Output {
    stage.pontoon(&["run", "study.json", "--out", "out", "--quiet"])
}

#[test]
fn the_operator_is_the_default_and_agrees_with_the_reference_solver() {
    let peaks = |analysis: Value| {
        let stage = stage(&analysis);
        assert_eq!(run(&stage).status.code(), Some(0));
        let manifest = stage.manifest("out");
        (
            stage.numbers(JOBS, "peak_deflection_m"),
            manifest["bridges"][0]["operator_modes"].clone(),
        )
    };
    let ((default, modes), (operator, _), (reference, none)) = (
        peaks(json!({})),
        peaks(json!({ "solver": "operator" })),
        peaks(json!({ "solver": "reference" })),
    );
    assert_eq!(default, operator);
    assert!(modes.as_u64().unwrap() > 10 && none.is_null(), "{modes} {none}");
    assert_ne!(operator, reference, "two solvers give the same last bits");
    for (found, expected) in operator.iter().zip(&reference) {
        // 0.5 % is what the operator promises of deflections; the bridge's are within 0.1 %
        let (found, expected) = (found.unwrap(), expected.unwrap());
        assert!((found - expected).abs() <= 5e-3 * expected, "{found} {expected}");
    }
}

#[test]
fn a_share_of_the_jobs_is_solved_again_and_its_deviations_are_told() {
    let stage = stage(&json!({ "verify": { "share": 0.5 } }));
    assert_eq!(run(&stage).status.code(), Some(0));
    let deviations = stage.numbers(JOBS, "verify_deflection");
    let taken: Vec<bool> = deviations.iter().map(Option::is_some).collect();
    assert_eq!(taken, [true, false, true, false, true, false]);
    assert_eq!(stage.numbers(JOBS, "verify_held")[0], Some(1.0));
    let verification = &stage.manifest("out")["verification"];
    assert_eq!((&verification["jobs"], &verification["beyond"]), (&json!(3), &json!(0)));
    let worst = verification["worst_deflection"].as_f64().unwrap();
    let largest = deviations.iter().flatten().fold(0.0_f64, |most, x| most.max(x.abs()));
    assert!(worst == largest && worst > 0.0 && worst < 5e-3, "{worst} {largest}");
}

#[test]
fn a_deviation_beyond_its_tolerance_is_status_1() {
    let stage = stage(&json!({ "verify": { "share": 1.0, "deflection_tolerance": 1e-12 } }));
    let output = run(&stage);
    assert_eq!(output.status.code(), Some(1));
    let told = stderr(&output);
    assert!(told.contains("of 6 jobs solved again are beyond"), "{told}");
    assert!(stage.numbers(JOBS, "verify_held").contains(&Some(0.0)));
    assert!(stage.numbers(JOBS, "peak_deflection_m").iter().all(Option::is_some));
}

#[test]
fn an_automatic_time_step_reaches_its_tolerance_and_is_in_the_table() {
    let force = |analysis: Value| {
        let stage = stage(&analysis);
        assert_eq!(run(&stage).status.code(), Some(0));
        let column = |name: &str| stage.numbers(JOBS, name);
        let forces: Vec<f64> = column("peak_compression_n")
            .iter()
            .zip(column("peak_tension_n"))
            .map(|(c, t)| c.unwrap().max(t.unwrap()))
            .collect();
        (forces, stage)
    };
    let (fine, _) = force(json!({ "time_step_s": 0.0003125 }));
    let mut before = usize::MAX;
    for tolerance in [0.001, 0.01, 0.1] {
        let (forces, stage) = force(json!({ "time_step_s": "auto", "time_step_tolerance": tolerance }));
        for (found, expected) in forces.iter().zip(&fine) {
            assert!(
                (found - expected).abs() <= tolerance * expected,
                "{tolerance}: {found} {expected}"
            );
        }
        let steps = stage.numbers(JOBS, "time_step_s");
        assert!(steps.iter().all(|h| h.is_some_and(|h| h <= 0.005)), "{steps:?}");
        // the looser the tolerance, the fewer the steps
        let count: f64 = stage.numbers(JOBS, "steps").iter().flatten().sum();
        assert!(count as usize <= before, "{tolerance}: {count}");
        before = count as usize;
    }
}

#[test]
fn an_automatic_time_step_of_a_fast_crossing_begins_below_the_passage_of_a_module() {
    let mut stage = stage(&json!({ "time_step_s": "auto", "time_step_tolerance": 0.05 }));
    let speeds = [5.0, 300.0, 336.0, 400.0, 900.0];
    stage.study["design"][0]["grid"]["speed_m_s"] = json!(speeds);
    without_gaps(&mut stage);
    let output = run(&stage);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let length_m = stage.bridge["module"]["length_m"].as_f64().unwrap();
    let found = stage.numbers(JOBS, "time_step_s");
    for (speed, step) in speeds.iter().zip(found) {
        // settled at the second halving at the earliest
        assert!(4.0 * step.unwrap() <= length_m / speed, "{speed} {step:?}");
    }
}

#[test]
fn a_vehicle_far_behind_its_front_begins_when_it_arrives() {
    let of = |behind_front_m: f64, solver: &str| {
        let mut stage = stage(&json!({ "solver": solver, "time_step_s": 0.01 }));
        stage.study["vehicle"] = json!({ "axles": [
            { "behind_front_m": behind_front_m, "share": 1, "patch_length_m": 1.93, "track_y_m": [0] }
        ], "inertia": "local" });
        // rounding of the place alone differs: contacts would make more of it, and so would a point that ends a step at a
        // joint, which 1.93 m avoid
        without_gaps(&mut stage);
        let output = run(&stage);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        [
            "steps",
            "peak_deflection_m",
            "peak_deflection_time_s",
            "peak_compression_n",
        ]
        .map(|name| stage.numbers(JOBS, name))
    };
    for solver in ["operator", "reference"] {
        // 120 m behind are whole steps at 5, 10 and 15 m/s
        let (at_front, behind) = (of(0.0, solver), of(120.0, solver));
        assert_eq!(at_front[0], behind[0], "{solver}: steps");
        let near = |x: f64, y: f64| (x - y).abs() <= 1e-9 * y.abs();
        for (k, later_s) in [(1, 0.0), (2, 1.0), (3, 0.0)] {
            for ((speed, x), y) in [5.0, 10.0, 15.0].iter().zip(&at_front[k]).zip(&behind[k]) {
                let expected = x.unwrap() + later_s * 120.0 / speed;
                assert!(near(y.unwrap(), expected), "{solver} {k}: {y:?} {expected}");
            }
        }
    }
}

#[test]
fn keys_that_have_no_meaning_beside_another_are_refused() {
    let analysis = "/analysis";
    study_refused(
        analysis,
        "time_step_s",
        json!("fast"),
        &["analysis.time_step_s", "\"auto\""],
    );
    study_refused(analysis, "time_step_s", json!(0), &["analysis.time_step_s"]);
    study_refused(
        analysis,
        "time_step_tolerance",
        json!(0.01),
        &["analysis.time_step_tolerance"],
    );
    study_refused(
        analysis,
        "operator_tolerance",
        json!(-1),
        &["analysis.operator_tolerance"],
    );
    for share in [json!(0), json!(1.5)] {
        study_refused(
            analysis,
            "verify",
            json!({ "share": share }),
            &["analysis.verify.share"],
        );
    }
    study_refused(
        analysis,
        "verify",
        json!({ "part": 0.1 }),
        &["analysis.verify", "part", "share"],
    );
    for (key, value) in [
        ("verify", json!({ "share": 0.1 })),
        ("operator_tolerance", json!(1e-3)),
        ("time_step_s", json!("auto")),
    ] {
        let mut stage = Stage::new();
        stage.study["analysis"]["solver"] = "reference".into();
        stage.study["analysis"][key] = value;
        stage.write();
        super::refusals::refused(&stage, &[&format!("analysis.{key}"), "solver: operator"]);
    }
}

/// The one file in a folder.
fn only_file(folder: &Path) -> PathBuf {
    let mut files = fs::read_dir(folder).unwrap().map(|e| e.unwrap().path());
    let file = files.next().unwrap();
    assert_eq!(files.next(), None);
    file
}

#[test]
fn an_operator_is_kept_and_read_back_and_a_damaged_one_replaced() {
    let stage = stage(&json!({}));
    let cache = stage.path("cache");
    let run = |out: &str| {
        let output = stage.pontoon_with(&["run", "study.json", "--out", out, "--quiet", "--fresh"], &cache);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let tables = ["jobs", "positions", "connectors", "histories"];
        let bytes = tables.map(|name| fs::read(stage.path(&format!("{out}/{name}.parquet"))).unwrap());
        let operators = stage.manifest(out)["operators"].clone();
        (bytes, operators, stderr(&output))
    };
    let counts = |built: usize, from_cache: usize, replaced: usize| json!({ "built": built, "from_cache": from_cache, "replaced": replaced });
    let (first, operators, _) = run("first");
    assert_eq!(operators, counts(1, 0, 0));
    let (second, operators, told) = run("second");
    assert_eq!((&second, operators, told.as_str()), (&first, counts(0, 1, 0), ""));
    let file = only_file(&cache);
    let whole = fs::read(&file).unwrap();
    let mut flipped = whole.clone();
    flipped[whole.len() / 2] ^= 16;
    for damaged in [flipped, whole[..whole.len() / 2].to_vec(), Vec::new()] {
        fs::write(&file, damaged).unwrap();
        let (again, operators, told) = run("again");
        assert_eq!((&again, operators), (&first, counts(1, 0, 1)));
        assert!(told.contains("an operator in the cache was damaged"), "{told}");
        assert_eq!(fs::read(only_file(&cache)).unwrap(), whole, "not replaced");
    }
}

#[test]
fn a_cache_that_cannot_be_written_costs_no_result() {
    let stage = stage(&json!({}));
    fs::write(stage.path("file"), "x").unwrap();
    let output = stage.pontoon_with(&["run", "study.json", "--out", "out", "--quiet"], &stage.path("file"));
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
}

/// What is set to nothing counts as not set: no cache comes into the folder where the program was called.
#[test]
fn a_cache_is_in_no_folder_that_is_named_by_nothing() {
    let stage = stage(&json!({}));
    let run = |out: &str, home: &str, caches: &str| {
        let output = Command::new(env!("CARGO_BIN_EXE_pontoon"))
            .args(["run", "study.json", "--out", out, "--quiet"])
            .current_dir(stage.path(""))
            .env_remove("PONTOON_CACHE_DIR")
            .envs([("HOME", home), ("XDG_CACHE_HOME", caches)])
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    };
    let before = stage.names();
    run("a", "", "");
    run("b", "here", "there");
    let new: Vec<String> = stage
        .names()
        .into_iter()
        .filter(|name| !before.contains(name))
        .collect();
    assert_eq!(new, ["a", "b"]);
    let at = |name: &str| stage.path(name).display().to_string();
    run("c", &at("home"), "");
    assert!(stage.path("home/.cache/pontoon").is_dir());
    run("d", &at("other"), &at("caches"));
    assert!(stage.path("caches/pontoon").is_dir() && !stage.path("other").exists());
}
