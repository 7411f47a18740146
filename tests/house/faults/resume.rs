//! A command given again: more jobs, another bridge, another form.

use super::sweep::{command, finish, run, same_tables, sweep, tables};
use crate::stage::{Stage, is_refused, stderr};
use serde_json::{Value, json};
use std::fs;

fn ran(output: &std::process::Output) -> u64 {
    let told: Value = serde_json::from_slice(&output.stdout).unwrap();
    told["ran"].as_u64().unwrap()
}

#[test]
fn a_study_that_has_grown_runs_the_new_jobs_alone() {
    let mut stage = sweep(3, 0.05);
    finish(&stage, "r");
    // new values before, between and behind the old ones: numbers move, records do not
    stage.study["design"][0]["grid"]["gap_tension_m"] = json!([0.01, 0.0, 0.015, 0.02, 0.03]);
    stage.write();
    let words = ["run", "study.json", "--out", "r", "--quiet", "--format", "json"];
    let output = command(&stage, &words).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert_eq!(ran(&output), 48);
    finish(&stage, "whole");
    same_tables(&stage, "r", &tables(&stage, "whole"));
    // and one that has shrunk runs none
    stage.study["design"][0]["grid"]["gap_tension_m"] = json!([0.02]);
    stage.write();
    let output = command(&stage, &words).output().unwrap();
    assert_eq!(ran(&output), 0);
    finish(&stage, "small");
    same_tables(&stage, "r", &tables(&stage, "small"));
    let told = super::sweep::status(&stage, &["r"]);
    assert_eq!((&told["jobs"], &told["missing"]), (&json!(24), &json!(0)));
    is_refused(
        &command(&stage, &["explain", "r", "24"]).output().unwrap(),
        &["job: found 24", "0 to 23"],
    );
}

#[test]
fn a_bit_flipped_in_the_beginning_of_a_journal_costs_nothing() {
    let stage = sweep(2, 0.05);
    finish(&stage, "r");
    let path = fs::read_dir(stage.path("r/journal"))
        .unwrap()
        .next()
        .unwrap()
        .unwrap()
        .path();
    let bytes = fs::read(&path).unwrap();
    let length = |at: usize| 16 + u32::from_le_bytes(bytes[at + 4..at + 8].try_into().unwrap()) as usize;
    // binding, session, and the same once more
    for at in [3, 100, length(0) - 1, length(0) + 6, length(0) + length(length(0)) - 1] {
        let mut flipped = bytes.clone();
        flipped[at] ^= 4;
        fs::write(&path, &flipped).unwrap();
        fs::remove_file(stage.path("r/progress.json")).unwrap();
        assert_eq!(super::sweep::status(&stage, &["r"])["done"], 48, "byte {at}");
        let output = command(
            &stage,
            &["run", "study.json", "--out", "r", "--quiet", "--format", "json"],
        )
        .output()
        .unwrap();
        assert_eq!(
            (output.status.code(), ran(&output)),
            (Some(0), 0),
            "byte {at}: {}",
            stderr(&output)
        );
        fs::write(stage.path("r/progress.json"), "").unwrap();
    }
}

#[test]
fn a_study_of_another_name_is_refused_and_moved_aside_on_demand() {
    let mut stage = sweep(2, 0.05);
    finish(&stage, "r");
    stage.study["name"] = json!("other");
    stage.write();
    is_refused(&run(&stage, "r", &[]), &["r/manifest.json: name: ", "--fresh"]);
    let output = run(&stage, "r", &["--fresh"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    is_refused(
        &command(&stage, &["status", "study.json"]).output().unwrap(),
        &["study.json: found a file"],
    );
}

#[test]
fn what_is_done_does_nothing_again() {
    let stage = sweep(2, 0.05);
    finish(&stage, "r");
    let expected = tables(&stage, "r");
    let files = || fs::read_dir(stage.path("r/journal")).unwrap().count();
    assert_eq!(files(), 1);
    let output = command(&stage, &["run", "study.json", "--out", "r", "--format", "json"])
        .output()
        .unwrap();
    assert_eq!((output.status.code(), ran(&output), files()), (Some(0), 0, 1));
    same_tables(&stage, "r", &expected);
}

#[test]
fn another_bridge_or_analysis_is_refused_with_what_differs_unless_fresh() {
    let mut stage = sweep(2, 0.05);
    finish(&stage, "r");
    let before = tables(&stage, "r");
    let first = (stage.study.clone(), stage.bridge.clone());
    let changes: [(&str, Value, &str); 4] = [
        ("bridge", json!(7000.0), "bridge.hydrostatic_stiffness_pa_m: "),
        ("analysis", json!(0.04), "analysis.time_step_s: 0.05 then, 0.04 now"),
        ("vehicle", json!("none"), "vehicle.inertia: "),
        ("record", json!(false), "record.connectors: true then, false now"),
    ];
    for (what, value, told) in changes {
        (stage.study, stage.bridge) = first.clone();
        match what {
            "bridge" => stage.bridge["hydrostatic_stiffness_pa_m"] = value,
            "analysis" => stage.study["analysis"]["time_step_s"] = value,
            "vehicle" => stage.study["vehicle"]["inertia"] = value,
            _ => stage.study["record"]["connectors"] = value,
        }
        stage.write();
        let output = run(&stage, "r", &[]);
        is_refused(&output, &["r/journal/", told, "--fresh"]);
        same_tables(&stage, "r", &before);
    }
    let output = run(&stage, "r", &["--fresh"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(!stage.path("r/connectors.parquet").exists());
    let aside: Vec<_> = fs::read_dir(stage.path("r/aside"))
        .unwrap()
        .map(|e| e.unwrap().path())
        .collect();
    assert_eq!(aside.len(), 1);
    for (name, bytes) in before {
        assert!(fs::read(aside[0].join(&name)).unwrap() == bytes, "{name}");
    }
}

/// Changes words of what a folder's first journal file is bound to, its checksum made right again.
fn rebound(stage: &Stage, out: &str, old: &str, new: &str) {
    let journal = fs::read_dir(stage.path(out).join("journal")).unwrap();
    let mut paths: Vec<_> = journal.map(|e| e.unwrap().path()).collect();
    paths.sort();
    let bytes = fs::read(&paths[0]).unwrap();
    let length = u32::from_le_bytes(bytes[4..8].try_into().unwrap()) as usize;
    let text = String::from_utf8(bytes[16..16 + length].to_vec()).unwrap();
    assert!(text.contains(old), "{text}");
    let payload = text.replace(old, new).into_bytes();
    let (kind, length) = (&bytes[12..16], u32::try_from(payload.len()).unwrap().to_le_bytes());
    let mut crc = crc32fast::Hasher::new();
    for part in [&length[..], kind, &payload] {
        crc.update(part);
    }
    let crc = crc.finalize().to_le_bytes();
    let rest = &bytes[16 + text.len()..];
    let changed = [&bytes[..4], &length, &crc, kind, &payload, rest].concat();
    fs::write(&paths[0], changed).unwrap();
}

#[test]
fn a_journal_of_another_form_or_program_is_refused_by_name() {
    let stage = sweep(2, 0.05);
    finish(&stage, "r");
    rebound(&stage, "r", "\"form\":7", "\"form\":1");
    let output = run(&stage, "r", &[]);
    assert_eq!(output.status.code(), Some(3), "{}", stderr(&output));
    for words in ["a journal of form 1", "this one reads form 7", "--fresh"] {
        assert!(stderr(&output).contains(words), "{words}: {}", stderr(&output));
    }
    rebound(&stage, "r", "\"form\":1", "\"form\":7");
    finish(&stage, "r");
    rebound(&stage, "r", "\"numerics\":\"", "\"numerics\":\"0.0.9 ");
    is_refused(&run(&stage, "r", &[]), &["the program's numerics: 0.0.9 ", "--fresh"]);
    // of a form that this program cannot read, too
    rebound(&stage, "r", "\"form\":7", "\"form\":1");
    let output = run(&stage, "r", &["--fresh"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
}

#[test]
fn records_of_another_instruction_path_are_refused_unless_accepted_and_then_told() {
    let stage = sweep(4, 0.05);
    for shard in ["0/2", "1/2"] {
        let output = run(&stage, &shard[..1], &["--shard", shard]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    }
    let here = {
        let output = run(&stage, "whole", &[]);
        assert_eq!(output.status.code(), Some(0));
        stage.manifest("whole")["instruction_path"].as_str().unwrap().to_owned()
    };
    rebound(
        &stage,
        "1",
        &format!("\"instruction_path\":\"{here}\""),
        "\"instruction_path\":\"elsewhere\"",
    );
    is_refused(
        &run(&stage, "1", &["--shard", "1/2"]),
        &["records computed on elsewhere", "--any-instructions"],
    );
    let merge = |more: &[&str]| {
        command(&stage, &[&["merge", "0", "1", "--out", "m", "--quiet"], more].concat())
            .output()
            .unwrap()
    };
    is_refused(
        &merge(&[]),
        &[
            "instruction_path: found shards computed on elsewhere and ",
            "--any-instructions",
        ],
    );
    let output = merge(&["--any-instructions"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let told = format!("elsewhere; {here}");
    assert_eq!(stage.manifest("m")["instruction_path"], told.as_str());
    let bytes = fs::read(stage.path("m/jobs.parquet")).unwrap();
    assert!(
        bytes.windows(told.len()).any(|window| window == told.as_bytes()),
        "not in the table's metadata"
    );
}

#[test]
fn a_plan_tells_what_of_it_is_done_and_how_long_the_rest_takes() {
    let mut stage = sweep(2, 0.05);
    let plan = || -> Value {
        let output = command(&stage, &["plan", "study.json", "--out", "r", "--format", "json"])
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        serde_json::from_slice(&output.stdout).unwrap()
    };
    let told = plan();
    assert_eq!((&told["jobs"], &told["found"]), (&json!(48), &Value::Null));
    let seconds = told["expected_seconds"].as_f64().unwrap();
    assert!(0.0 < seconds && seconds < 60.0, "{seconds}");
    assert_eq!(
        stage.names(),
        ["bridge.json", "cache", "study.json"],
        "a plan writes nothing"
    );
    finish(&stage, "r");
    let told = plan();
    assert_eq!(
        told["found"],
        json!({ "done": 48, "failed": 0, "missing": 0, "refused": [] })
    );
    assert_eq!(told["expected_seconds"], json!(0.0));
    stage.study["design"][0]["grid"]["gap_tension_m"] = json!([0.0, 0.03, 0.01]);
    stage.write();
    let told: Value = serde_json::from_slice(
        &command(&stage, &["plan", "study.json", "--out", "r", "--format", "json"])
            .output()
            .unwrap()
            .stdout,
    )
    .unwrap();
    assert_eq!(
        (&told["found"]["done"], &told["found"]["missing"]),
        (&json!(48), &json!(24))
    );
    stage.bridge["hydrostatic_stiffness_pa_m"] = json!(7000.0);
    stage.write();
    let text = command(&stage, &["plan", "study.json", "--out", "r"])
        .output()
        .unwrap()
        .stdout;
    let text = String::from_utf8(text).unwrap();
    assert!(
        text.contains("done              0 (0 failed), missing 72, in r"),
        "{text}"
    );
    assert!(
        text.contains("no use            bridge.hydrostatic_stiffness_pa_m: "),
        "{text}"
    );
}

#[test]
fn a_job_is_explained_and_counted() {
    let stage = sweep(2, 0.05);
    finish(&stage, "r");
    let explain = |job: &str| {
        command(&stage, &["explain", "r", job, "--format", "json"])
            .output()
            .unwrap()
    };
    let told: Value = serde_json::from_slice(&explain("5").stdout).unwrap();
    assert_eq!((&told["state"], &told["axes"]["speed_m_s"]), (&json!("ok"), &json!(12)));
    let refused = explain("48");
    is_refused(&refused, &["job: found 48", "0 to 47"]);
    let output = command(&stage, &["explain", "nowhere", "0"]).output().unwrap();
    is_refused(&output, &["nowhere: found no journal of a run"]);
}
