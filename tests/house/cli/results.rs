//! Runs that end with tables.

use crate::stage::{Frame, Stage, stderr, stdout};
use serde_json::{Value, json};
use std::fs;

fn columns(frame: &Frame) -> Vec<String> {
    frame.names()
}

/// A stage with fewer jobs.
fn small() -> Stage {
    let mut stage = Stage::new();
    stage.study["design"] = json!([{ "grid": {
        "connection": ["linear", "nonlinear"], "gap_tension_m": [0.028, 0.0], "speed_m_s": [10, 15], "load_n": 1e5
    } }]);
    stage
}

const JOBS: &str = "job status reason failure connection gap_tension_m gap_compression_m speed_m_s load_n peak_deflection_m \
    peak_deflection_position peak_deflection_time_s peak_uplift_m peak_uplift_position peak_uplift_time_s \
    peak_compression_n peak_compression_joint peak_tension_n peak_tension_joint peak_edge_deflection_m peak_roll_rad peak_trim_rad \
    static_peak_deflection_m dynamic_amplification influential_length_m bottom_emerged deck_submerged \
    min_contact_force_n step_warning steps newton_iterations contact_switches energy_residual numerical_dissipation";

#[test]
fn any_number_of_threads_writes_the_same_bytes() {
    let stage = small();
    stage.write();
    for threads in ["1", "2", "3"] {
        let output = stage.pontoon(&["run", "study.json", "--out", threads, "--threads", threads]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        assert_eq!(stage.manifest(threads)["threads"].to_string(), threads);
    }
    for name in [
        "jobs.parquet",
        "positions.parquet",
        "connectors.parquet",
        "histories.parquet",
        "summary.csv",
    ] {
        let bytes = |threads: &str| fs::read(stage.path(threads).join(name)).unwrap();
        assert!(bytes("1") == bytes("2") && bytes("1") == bytes("3"), "{name} differs");
    }
}

#[test]
fn tables_have_their_columns_and_a_row_for_everything() {
    let stage = small();
    let output = stage
        .write()
        .pontoon(&["run", "study.json", "--out", "r", "--format", "json", "--quiet"]);
    assert_eq!((output.status.code(), stderr(&output).as_str()), (Some(0), ""));
    let jobs = stage.table("r/jobs.parquet");
    assert_eq!(columns(&jobs), JOBS.split_whitespace().collect::<Vec<_>>());
    // Linear and two gaps at two speeds: the linear points of the second gap are equal to those of the first.
    assert_eq!(jobs.height(), 6);
    assert_eq!(jobs.column("gap_tension_m").unwrap().null_count(), 2);
    assert_eq!(stage.table("r/positions.parquet").height(), 6 * 4);
    assert_eq!(stage.table("r/connectors.parquet").height(), 6 * 2 * 3);
    let steps: i64 = jobs.column("steps").unwrap().i64().unwrap().iter().flatten().sum();
    let histories = stage.table("r/histories.parquet");
    assert_eq!(columns(&histories), ["job", "time_s", "quantity", "position", "value"]);
    assert!(
        histories.height() as i64 >= 2 * steps,
        "{} rows for {steps} steps",
        histories.height()
    );

    let printed: Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!((&printed["jobs"], &printed["failed"]), (&json!(6), &json!(0)));
    let first = jobs.column("peak_deflection_m").unwrap().f64().unwrap().get(0);
    assert_eq!(printed["summary"][0]["peak_deflection_m"].as_f64(), first);
    let manifest = stage.manifest("r");
    assert_eq!((&manifest["jobs"], &manifest["merged"]), (&json!(6), &json!(2)));
    let csv = fs::read_to_string(stage.path("r/summary.csv")).unwrap();
    assert_eq!(csv.lines().count(), 7);
}

#[test]
fn files_carry_where_they_come_from() {
    let stage = small();
    assert_eq!(
        stage
            .write()
            .pontoon(&["run", "study.json", "--out", "r"])
            .status
            .code(),
        Some(0)
    );
    let table = stage.table("r/jobs.parquet");
    let metadata = table.metadata.key_value_metadata().clone().unwrap();
    let value = |key: &str| {
        metadata
            .iter()
            .find(|pair| pair.key == key)
            .unwrap()
            .value
            .clone()
            .unwrap()
    };
    let manifest = stage.manifest("r");
    for (document, written) in [("bridge", &stage.bridge), ("study", &stage.study)] {
        let place = &manifest["documents"][document];
        let text = fs::read(stage.path("r").join(place["file"].as_str().unwrap())).unwrap();
        assert_eq!(place["bytes"], text.len());
        let hash = blake3::hash(&text).to_hex().to_string();
        assert_eq!(value(&format!("pontoon.{document}_blake3")), hash);
        let kept: Value = serde_json::from_slice(&text).unwrap();
        assert_eq!(kept["name"], written["name"]);
    }
    for key in ["study_blake3", "bridge_blake3", "version"] {
        assert_eq!(manifest[key], json!(value(&format!("pontoon.{key}"))), "{key}");
    }
}

/// Readers of the tables refuse a footer of more than 100 MB.
#[test]
fn nothing_that_a_table_or_manifest_says_of_itself_grows_with_the_study() {
    let said = |question: usize, bridges: usize, designs: usize| {
        let mut stage = Stage::new();
        stage.study["question"] = "q".repeat(question).into();
        stage.bridge["source"] = "s".repeat(question).into();
        stage.study["analysis"] = json!({ "kind": "static" });
        stage.study["record"] = json!({ "positions": false, "connectors": false });
        let loads = |seed: usize| json!({ "sobol": { "count": 1, "seed": seed, "ranges": { "load_n": [1e5, 2e5], "load_position": [1, 2] } } });
        stage.study["design"] = (0..designs).map(loads).collect();
        let stiffness: Vec<f64> = (0..bridges).map(|i| 2e7 + i as f64).collect();
        let grid =
            json!({ "grid": { "load_n": 1e5, "load_position": 1, "bridge.connectors.stiffness_n_m": stiffness } });
        stage.study["design"].as_array_mut().unwrap().push(grid);
        stage.ran("r");
        let table = stage.table("r/jobs.parquet");
        let pairs = table.metadata.key_value_metadata().clone().unwrap();
        let own = pairs.iter().filter(|pair| pair.key.starts_with("pontoon."));
        let footer: usize = own
            .map(|pair| pair.key.len() + pair.value.as_ref().map_or(0, String::len))
            .sum();
        (footer, stage.manifest("r").to_string().len())
    };
    let (small, large) = (said(1, 1, 1), said(1_000_000, 40, 40));
    assert!(large.0 < small.0 + 50, "footers of {} and {} bytes", small.0, large.0);
    assert!(
        large.1 < small.1 + 60_000,
        "manifests of {} and {} bytes",
        small.1,
        large.1
    );
}

#[test]
fn a_module_is_condensed_once_for_each_bridge_and_not_for_its_connectors() {
    for (axis, values, bridges, condensations) in [
        ("bridge.hydrostatic_stiffness_pa_m", json!([7000, 8000]), 2, 2),
        ("bridge.connectors.stiffness_n_m", json!([2e7, 3e7]), 2, 1),
    ] {
        let mut stage = small();
        stage.study["design"][0]["grid"][axis] = values;
        stage.write();
        let output = stage.pontoon(&["run", "study.json", "--out", "r"]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let manifest = stage.manifest("r");
        let counts = (&manifest["distinct_bridges"], &manifest["condensations"]);
        assert_eq!(counts, (&json!(bridges), &json!(condensations)), "{axis}");
        let jobs = stage.table("r/jobs.parquet");
        assert_eq!(jobs.height(), 12, "{axis}");
        let column = jobs.column(axis).unwrap().f64().unwrap().clone();
        assert!(column.get(0) != column.get(1), "the last axis changes fastest");
    }
}

#[test]
fn a_failed_job_is_a_row_and_the_others_go_on() {
    let mut stage = small();
    // A weight whose forces leave the range of numbers.
    stage.study["design"] = json!([{ "grid": { "load_n": [1e5, 1e305], "speed_m_s": 15 } }]);
    let output = stage.write().pontoon(&["run", "study.json", "--out", "r"]);
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    assert!(stderr(&output).contains("job 1 failed: "), "{}", stderr(&output));
    let jobs = stage.table("r/jobs.parquet");
    let text = |name: &str, row: usize| jobs.column(name).unwrap().str().unwrap().get(row).map(str::to_owned);
    assert_eq!(
        (text("status", 0).as_deref(), text("status", 1).as_deref()),
        (Some("ok"), Some("failed"))
    );
    assert!(text("reason", 0).is_none() && text("reason", 1).is_some_and(|r| !r.contains("program error")));
    let peaks = jobs.column("peak_deflection_m").unwrap().f64().unwrap().clone();
    assert!(peaks.get(0).is_some_and(|p| p > 0.0) && peaks.get(1).is_none());
    assert_eq!(stage.manifest("r")["failed"], json!(1));
    assert_eq!(stage.table("r/positions.parquet").height(), 2 * 4);
}

#[test]
fn a_contact_that_does_not_settle_fails_with_time_and_connector() {
    let mut stage = small();
    stage.study["design"] = json!([{ "grid": {
        "analysis.newton_limit": [1, 30], "analysis.bisection_limit": 0, "load_n": 2e5, "speed_m_s": 15
    } }]);
    let output = stage.write().pontoon(&["run", "study.json", "--out", "r", "--quiet"]);
    let message = stderr(&output);
    assert_eq!(output.status.code(), Some(1), "{message}");
    assert!(
        message.contains("job 0 failed: contact not settled at t = "),
        "{message}"
    );
    assert!(message.contains("in connector "), "{message}");
    assert_eq!(message.lines().count(), 1, "{message}");
}

#[test]
fn static_cases_have_places_and_deflections() {
    let mut stage = Stage::new();
    stage.study["analysis"] = json!({ "kind": "static" });
    stage.study["record"] = json!({ "connectors": false });
    stage.study["design"] =
        json!([{ "grid": { "connection": ["linear", "nonlinear"], "load_position": [2, 3], "load_n": 1e5 } }]);
    let output = stage.write().pontoon(&["run", "study.json", "--out", "r"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let jobs = stage.table("r/jobs.parquet");
    assert!(!columns(&jobs).contains(&"speed_m_s".to_owned()));
    assert_eq!(jobs.column("load_x_m").unwrap().f64().unwrap().get(1), Some(2.0 * 6.7));
    assert_eq!(jobs.column("influential_length_m").unwrap().null_count(), 0);
    assert_eq!(jobs.column("peak_deflection_time_s").unwrap().null_count(), 4);
    let positions = stage.table("r/positions.parquet");
    let at = |name: &str, row: usize| positions.column(name).unwrap().f64().unwrap().get(row).unwrap();
    for row in 0..positions.height() {
        assert_eq!(
            at("deflection_m", row),
            at("peak_deflection_m", row) - at("peak_uplift_m", row),
            "row {row}"
        );
    }
    assert!(!stage.path("r/connectors.parquet").exists() && !stage.path("r/histories.parquet").exists());
}

#[test]
fn modes_are_named_in_text_and_json() {
    let stage = Stage::new();
    stage.write();
    let words = [
        "modes",
        "bridge.json",
        "--model",
        "super-element",
        "--count",
        "6",
        "--format",
        "json",
    ];
    let output = stage.pontoon(&words);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let modes: Vec<Value> = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!(modes.len(), 6);
    assert!(
        modes
            .iter()
            .all(|mode| mode["frequency_hz"].is_f64() && mode["shape"].is_string()),
        "{modes:?}"
    );
    let output = stage.pontoon(&words[..6]);
    assert_eq!(stdout(&output).lines().count(), 7, "{}", stdout(&output));
    assert!(stdout(&output).starts_with("number  frequency_hz  shape"));
}

#[test]
fn schemas_are_json_and_name_every_key_of_the_studies() {
    let stage = Stage::new();
    for (of, document) in [("study", &stage.study), ("bridge", &stage.bridge)] {
        let output = stage.pontoon(&["schema", of]);
        assert_eq!(output.status.code(), Some(0));
        let schema: Value = serde_json::from_str(&stdout(&output)).unwrap();
        for key in document.as_object().unwrap().keys() {
            assert!(schema["properties"].get(key).is_some(), "{of}: {key}");
        }
        assert_eq!(schema["additionalProperties"], json!(false));
    }
}

#[test]
fn results_that_cannot_be_written_end_with_status_3() {
    let stage = small();
    stage.write();
    let output = stage.pontoon(&["run", "study.json", "--out", "bridge.json/r"]);
    assert_eq!(output.status.code(), Some(3), "{}", stderr(&output));
    assert!(stderr(&output).contains("bridge.json/r"), "{}", stderr(&output));
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_ends_the_run_and_leaves_the_results_before_it() {
    let mut stage = small();
    stage.ran("r");
    let before = fs::read(stage.path("r/manifest.json")).unwrap();
    stage.study["design"][0]["grid"]["speed_m_s"] = json!([10, 15, 20]);
    stage.write();
    let output = crate::faults::sweep::run_with(&stage, "r", "tables.write:1:full");
    assert_eq!((output.status.code(), stdout(&output).as_str()), (Some(3), ""));
    let told = stderr(&output);
    assert!(
        told.starts_with("pontoon: results not written: r/histories.parquet: ") && told.contains("no space left"),
        "{told}"
    );
    assert_eq!(fs::read(stage.path("r/manifest.json")).unwrap(), before);
    let left = fs::read_dir(stage.path("r")).unwrap().map(|e| e.unwrap().file_name());
    assert!(left.into_iter().all(|name| !name.to_string_lossy().contains("partial")));
    let jobs = stage.table("r/jobs.parquet");
    assert_eq!(jobs.height(), 6);
}

#[test]
fn words_that_nothing_is_computed_from_leave_results_as_they_are() {
    let mut stage = Stage::new();
    stage.ran("r");
    let tables = |stage: &Stage| Frame::read(&stage.path("r/jobs.parquet"));
    let before = tables(&stage);
    stage.bridge["name"] = json!("another name");
    stage.bridge["source"] = json!("told again");
    stage.study["question"] = json!("the same, asked otherwise");
    let run = |stage: &Stage| {
        let words = ["run", "study.json", "--out", "r", "--quiet", "--format", "json"];
        let output = stage.write().pontoon(&words);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        serde_json::from_str::<Value>(&stdout(&output)).unwrap()["ran"].clone()
    };
    assert_eq!(run(&stage), 0);
    assert!(tables(&stage).same_cells(&before));
}

#[test]
fn numbers_in_another_unit_are_noted_on_the_terminal_and_in_the_manifest() {
    let mut stage = Stage::new();
    stage.study["design"] = json!([{ "grid": { "load_n": 230, "speed_m_s": 54 } }]);
    stage.study["analysis"]["tail_s"] = json!(0.1);
    stage.write();
    let expected = ["speed_m_s 54: above 30 m/s", "load_n 230: below 1000 N"];
    let mut told = vec![stderr(&stage.pontoon(&["plan", "study.json"]))];
    let output = stage.pontoon(&["run", "study.json", "--out", "r"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    told.extend([stderr(&output), stage.manifest("r")["notes"].to_string()]);
    for told in told {
        assert!(expected.iter().all(|note| told.contains(note)), "{told}");
    }
    assert_eq!(stderr(&stage.pontoon(&["plan", "study.json", "--quiet"])), "");
}

#[test]
fn every_file_may_name_its_schema() {
    let mut stage = Stage::new();
    (stage.study["$schema"], stage.bridge["$schema"]) = ("study.schema.json".into(), "bridge.schema.json".into());
    stage.ran("r");
    let of = json!({ "select": { "table": "jobs", "column": "job", "where": { "job": 0 } } });
    let check = json!({ "id": "a", "value": { "of": of, "expected": 0, "absolute_tolerance": 0 } });
    stage.json(
        "reference.json",
        &json!({ "$schema": "x", "name": "r", "source": "a book", "checks": [check] }),
    );
    let output = stage.pontoon(&["compare", "r", "--with", "reference.json"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    for of in ["study", "bridge", "reference", "parameters"] {
        let schema: Value = serde_json::from_str(&stdout(&stage.pontoon(&["schema", of]))).unwrap();
        assert_eq!(schema["properties"]["$schema"]["type"], "string", "{of}");
    }
}
