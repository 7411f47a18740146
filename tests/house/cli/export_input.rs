//! `pontoon export`: what is refused, and that nothing is there by halves.

use super::export_stage::{contents, crossings, exported, refused, static_cases};
use crate::stage::{Stage, is_refused, stderr};
use serde_json::json;
use std::fs;
use std::process::{Command, Output};

#[test]
fn the_same_export_has_the_same_bytes_and_replaces_an_earlier_one_alone() {
    let stage = Stage::new();
    stage.write();
    exported(&stage, &["bridge.json", "--to", "vtk", "--count", "9"]);
    exported(&stage, &["bridge.json", "--to", "again", "--count", "3"]);
    exported(&stage, &["bridge.json", "--to", "vtk", "--count", "3"]);
    assert_eq!(contents(&stage.path("vtk")), contents(&stage.path("again")));
    fs::write(stage.path("vtk/notes.txt"), "mine").unwrap();
    let before = contents(&stage.path("vtk"));
    let output = stage.pontoon(&["export", "bridge.json", "--to", "vtk"]);
    is_refused(&output, &["vtk: ", "'notes.txt'", "earlier export"]);
    assert_eq!(contents(&stage.path("vtk")), before);
    fs::create_dir(stage.path("empty")).unwrap();
    exported(&stage, &["bridge.json", "--to", "empty", "--count", "3"]);
    assert_eq!(contents(&stage.path("empty")), contents(&stage.path("again")));
    let output = stage.pontoon(&["export", "bridge.json", "--to", "bridge.json"]);
    is_refused(&output, &["a file"]);
    assert_eq!(stage.names(), ["again", "bridge.json", "empty", "study.json", "vtk"]);
}

#[test]
fn what_cannot_be_shown_is_refused_with_its_reason() {
    let stage = crossings();
    stage.ran("out");
    let bridge = "bridge.json";
    refused(&stage, &["nowhere.json"], &["nowhere.json", "no readable file"]);
    refused(&stage, &["study.json"], &["study.json: ", "unknown"]);
    fs::create_dir(stage.path("none")).unwrap();
    refused(&stage, &["none"], &["none: ", "manifest.json is missing"]);
    refused(&stage, &["out", "--job", "2"], &["--job", "found 2", "2 of which"]);
    refused(&stage, &["out", "--every", "0"], &["--every", "at least 1"]);
    for (flag, found) in [
        ("--load-x-m", "--load-x-m: found -1, allowed: a number from 0 to 20.1"),
        (
            "--gap-tension-m",
            "--gap-tension-m: found -1, allowed: a finite number of at least 0",
        ),
    ] {
        let load = ["--load-n", "1e5", "--load-position", "1"];
        let load = if flag == "--load-x-m" { &load[..2] } else { &load[..] };
        refused(&stage, &[&[bridge], load, &[flag, "-1"]].concat(), &[found]);
    }
    refused(
        &stage,
        &[bridge, "--load-n", "-1e5", "--load-x-m", "1"],
        &["--load-n: found -100000, allowed: a finite number above 0"],
    );
    refused(&stage, &[bridge, "--job", "1"], &["--job", "a bridge file has no jobs"]);
    refused(
        &stage,
        &[bridge, "--every", "1"],
        &["--every", "a bridge file has no jobs"],
    );
    refused(&stage, &[bridge, "--count", "0"], &["--count", "0 modes and no load"]);
    let load = |more: &[&str], parts: &[&str]| refused(&stage, &[&[bridge], more].concat(), parts);
    load(
        &["--load-n", "1e5"],
        &["--load-n", "no place", "--load-x-m or --load-position"],
    );
    for bad in ["0", "-1", "NaN", "inf"] {
        let load_n = format!("--load-n={bad}");
        load(&[&load_n, "--load-x-m", "1"], &["--load-n", "a finite number above 0"]);
    }
    for (flag, bad, allowed) in [
        ("--load-x-m", "20.2", "from 0 to 20.1"),
        ("--load-x-m", "NaN", "from 0 to 20.1"),
        ("--load-position", "0", "from 1 to 4"),
        ("--load-position", "5", "from 1 to 4"),
    ] {
        load(&["--load-n", "1e5", flag, bad], &[flag, bad, allowed]);
    }
    let gap = ["--load-n", "1e5", "--load-x-m", "1", "--gap-tension-m=-0.1"];
    load(&gap, &["--gap-tension-m", "-0.1", "at least 0"]);
    let static_study = static_cases();
    static_study.ran("out");
    refused(&static_study, &["out", "--every", "2"], &["--every", "crossings"]);
    refused(
        &static_study,
        &["out", "--load-n", "1", "--load-x-m", "1"],
        &["--load-n", "static study"],
    );
}

#[test]
fn failed_jobs_are_refused_with_why_they_failed() {
    let mut stage = crossings();
    stage.study["analysis"]["step_limit"] = json!(200);
    stage.study["design"] = json!([{ "grid": { "speed_m_s": [2, 10], "load_n": 1e5 } }]);
    let run = stage.write().pontoon(&["run", "study.json", "--out", "out", "--quiet"]);
    assert_eq!(run.status.code(), Some(1), "{}", stderr(&run));
    refused(
        &stage,
        &["out", "--job", "0"],
        &["--job", "job 0, which failed", "steps"],
    );
    exported(&stage, &["out", "--to", "other", "--count", "0"]);
    stage.study["design"] = json!([{ "grid": { "speed_m_s": 2, "load_n": 1e5 } }]);
    stage
        .write()
        .pontoon(&["run", "study.json", "--out", "failed", "--quiet"]);
    refused(&stage, &["failed"], &["failed jobs alone", "steps"]);
}

#[test]
fn a_bridge_that_has_no_static_case_and_results_that_are_damaged_are_told() {
    let mut stage = crossings();
    stage.bridge["supports"] = json!({ "left": ["z"], "right": ["z"] });
    stage.write();
    refused(
        &stage,
        &["bridge.json", "--load-n", "1", "--load-x-m", "1"],
        &["supports"],
    );
    exported(&stage, &["bridge.json", "--to", "free", "--count", "4"]);
    stage.ran("out");
    exported(&stage, &["out", "--to", "moving", "--count", "0", "--every", "20"]);
    fs::write(stage.path("out/manifest.json"), "{}").unwrap();
    let output = stage.pontoon(&["export", "out", "--to", "vtk"]);
    assert_eq!(output.status.code(), Some(3), "{}", stderr(&output));
    assert!(stderr(&output).contains("damaged results"), "{}", stderr(&output));
    assert!(!stage.path("vtk").exists());
}

#[test]
fn a_series_beyond_all_measure_is_refused_before_anything_is_written() {
    let mut stage = crossings();
    stage.study["analysis"] = json!({ "kind": "crossing", "time_step_s": 0.005, "tail_s": 60 });
    stage.ran("out");
    let output = stage.pontoon(&["export", "out", "--to", "vtk", "--every", "1"]);
    is_refused(&output, &["--every", "files of", "at most 30000 files and 20 GB"]);
    assert!(!stage.path("vtk").exists());
    let output = stage.pontoon(&["export", "out", "--to", "vtk", "--count", "1", "--every", "1000"]);
    assert_eq!(output.status.code(), Some(0));
    let told = stderr(&output);
    assert!(
        told.contains("instants of a crossing, one every 1000 steps of 0.005 s: "),
        "{told}"
    );
    let quiet = stage.pontoon(&["export", "out", "--to", "vtk", "--every", "1000", "--quiet"]);
    assert_eq!((quiet.status.code(), stderr(&quiet)), (Some(0), String::new()));
}

fn export_with(stage: &Stage, fault: &str) -> Output {
    Command::new(env!("CARGO_BIN_EXE_pontoon"))
        .args([
            "export",
            "bridge.json",
            "--to",
            "vtk",
            "--count",
            "2",
            "--load-n",
            "2e5",
            "--load-position",
            "3",
        ])
        .env("PONTOON_FAULT", fault)
        .current_dir(stage.path(""))
        .output()
        .unwrap()
}

#[test]
fn whatever_fails_the_folder_is_the_old_one_or_the_new_one() {
    let stage = Stage::new();
    stage.write();
    assert_eq!(export_with(&stage, "").status.code(), Some(0));
    let new = contents(&stage.path("vtk"));
    fs::remove_dir_all(stage.path("vtk")).unwrap();
    for earlier in [false, true] {
        for (place, how) in [
            ("write", "full"),
            ("write", "short"),
            ("sync", "error"),
            ("rename", "error"),
            ("rename", "die"),
        ] {
            let mut struck = 0;
            for number in 1.. {
                let old = earlier.then(|| {
                    exported(&stage, &["bridge.json", "--to", "vtk", "--count", "1"]);
                    contents(&stage.path("vtk"))
                });
                let fault = format!("export.{place}:{number}:{how}");
                let output = export_with(&stage, &fault);
                if output.status.code() == Some(0) {
                    assert_eq!(contents(&stage.path("vtk")), new, "{fault}");
                    fs::remove_dir_all(stage.path("vtk")).unwrap();
                    break;
                }
                struck += 1;
                let told = stderr(&output);
                if matches!(how, "full" | "error") {
                    assert_eq!(output.status.code(), Some(3), "{fault}: {told}");
                    assert!(told.contains("vtk"), "{fault}: {told}");
                    assert_eq!(
                        stage.names().iter().filter(|n| n.starts_with(".vtk")).count(),
                        0,
                        "{fault}"
                    );
                }
                let found = stage.path("vtk").exists().then(|| contents(&stage.path("vtk")));
                assert_eq!(found, old, "{fault}");
                // no need to try every file of the many
                if struck == 5 {
                    break;
                }
            }
            assert!(struck > 0, "{place} is never passed");
        }
        // once it is in its place it is the new one, whatever comes then
        let earlier_one = ["bridge.json", "--to", "vtk", "--count", "1"];
        for how in ["die", "error"] {
            if earlier {
                exported(&stage, &earlier_one);
            }
            let output = export_with(&stage, &format!("export.renamed:1:{how}"));
            assert_ne!(output.status.code(), Some(0));
            assert_eq!(contents(&stage.path("vtk")), new, "{how}");
            if how == "error" {
                let told = stderr(&output);
                assert!(told.contains("the new folder is in its place"), "{told}");
                assert_eq!(stage.names(), ["bridge.json", "study.json", "vtk"]);
            }
            fs::remove_dir_all(stage.path("vtk")).unwrap();
        }
        // what died processes gathered goes with the next export
        assert_eq!(export_with(&stage, "").status.code(), Some(0));
        assert_eq!(stage.names(), ["bridge.json", "study.json", "vtk"]);
        fs::remove_dir_all(stage.path("vtk")).unwrap();
    }
}

#[test]
fn modes_of_a_mesh_that_is_too_large_are_refused_with_the_key_that_is_too_large() {
    let mut stage = Stage::new();
    stage.bridge["modules"] = json!(220);
    stage.study["analysis"] = json!({ "kind": "static" });
    stage.study["design"] = json!([{ "cases": [{ "load_n": 1e5, "load_position": 2 }] }]);
    stage.study.as_object_mut().unwrap().remove("record");
    stage.ran("r");
    let told = stage.pontoon(&["export", "r", "--to", "vtk"]);
    assert_eq!(told.status.code(), Some(2));
    let told = stderr(&told);
    assert!(told.contains("r: bridge.module.mesh: found a mesh of"), "{told}");
    assert!(
        told.contains("allowed: ") && told.ends_with(", or --count 0: no modes\n"),
        "{told}"
    );
    exported(&stage, &["r", "--to", "vtk", "--count", "0"]);
}

#[test]
fn a_folder_that_cannot_be_made_is_told_with_its_name() {
    let stage = Stage::new();
    let output = stage
        .write()
        .pontoon(&["export", "bridge.json", "--to", "/proc/vtk", "--count", "1"]);
    assert_eq!(output.status.code(), Some(3), "{}", stderr(&output));
    assert!(stderr(&output).contains("/proc/vtk"), "{}", stderr(&output));
}
