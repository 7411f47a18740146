//! Shares of a study on several machines, or one after the other on one.

use super::sweep::{begin, command, finish, run, run_with, same_tables, status, sweep, tables};
use crate::stage::{Stage, is_refused, stderr};
use serde_json::json;
use std::process::Output;
use std::time::Duration;

fn folders(of: usize) -> Vec<String> {
    (0..of).map(|k| format!("{k}-of-{of}")).collect()
}

fn merge(stage: &Stage, folders: &[String], out: &str) -> Output {
    let folders: Vec<&str> = folders.iter().map(String::as_str).collect();
    command(stage, &[&["merge", "--out", out, "--quiet"], &folders[..]].concat())
        .output()
        .unwrap()
}

#[test]
fn any_number_of_shards_and_threads_makes_the_same_tables_interrupted_or_not() {
    let stage = sweep(10, 0.05);
    finish(&stage, "whole");
    let expected = tables(&stage, "whole");
    for threads in ["1", "2", "3"] {
        let output = run(&stage, threads, &["--threads", threads]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        same_tables(&stage, threads, &expected);
    }
    for of in [1, 2, 5] {
        let folders = folders(of);
        for (k, folder) in folders.iter().enumerate() {
            let shard = format!("{k}/{of}");
            if k % 2 == 0 {
                let mut child = begin(&stage, folder, &["--shard", &shard]);
                std::thread::sleep(Duration::from_millis(60));
                child.kill().unwrap();
                child.wait().unwrap();
            }
            let threads = (1 + k % 3).to_string();
            let output = run(&stage, folder, &["--shard", &shard, "--threads", &threads]);
            assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        }
        let names: Vec<&str> = folders.iter().map(String::as_str).collect();
        let told = status(&stage, &names);
        assert_eq!((told["jobs"].as_u64(), told["done"].as_u64()), (Some(240), Some(240)));
        assert_eq!(told["shards_missing"], json!([]));
        let share = told["folders"][0]["jobs"].as_u64().unwrap();
        assert!(share.abs_diff(240 / of as u64) <= 12, "{share} jobs of {of} shards");
        let out = format!("merged-{of}");
        let output = merge(&stage, &folders, &out);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        same_tables(&stage, &out, &expected);
        // a merged folder is one that the study was run into
        finish(&stage, &out);
        same_tables(&stage, &out, &expected);
    }
}

/// Both halves of a study, into `s0` and `s1`.
fn run_both(stage: &Stage) {
    for shard in ["0/2", "1/2"] {
        let output = run(stage, &format!("s{}", &shard[..1]), &["--shard", shard]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    }
}

#[test]
fn shards_of_a_study_that_has_grown_are_merged() {
    let mut stage = sweep(3, 0.05);
    run_both(&stage);
    // numbers move, and jobs from one share to the other
    stage.study["design"][0]["grid"]["gap_tension_m"] = json!({ "linspace": [0.0, 0.03, 5] });
    stage.write();
    run_both(&stage);
    finish(&stage, "whole");
    let output = merge(&stage, &["s0".to_owned(), "s1".to_owned()], "m");
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    same_tables(&stage, "m", &tables(&stage, "whole"));
}

/// Nothing is computed from a bridge's name and source, nor from what a study asks.
#[test]
fn shards_whose_words_differ_are_merged() {
    let mut stage = sweep(2, 0.05);
    finish(&stage, "whole");
    for (shard, words) in [("0/2", "first"), ("1/2", "then")] {
        (stage.bridge["source"], stage.study["question"]) = (json!(words), json!(words));
        stage.write();
        let output = run(&stage, &format!("s{}", &shard[..1]), &["--shard", shard]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    }
    let output = merge(&stage, &["s0".to_owned(), "s1".to_owned()], "m");
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert_eq!(
        stage.numbers("m/jobs.parquet", "peak_deflection_m"),
        stage.numbers("whole/jobs.parquet", "peak_deflection_m")
    );
}

#[test]
fn shards_of_a_study_that_has_shrunk_or_grown_in_one_share_alone_are_merged() {
    let mut stage = sweep(3, 0.05);
    run_both(&stage);
    let both = ["s0".to_owned(), "s1".to_owned()];
    // nothing is missing of the smaller study, and it is the one that is merged
    stage.study["design"][0]["grid"]["gap_tension_m"] = json!([0.0, 0.03]);
    stage.write();
    run_both(&stage);
    finish(&stage, "small");
    let output = merge(&stage, &both, "m");
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    same_tables(&stage, "m", &tables(&stage, "small"));
    // one job more is of one share
    let more = json!({ "cases": [{ "speed_m_s": 9, "load_n": 1e5 }] });
    stage.study["design"].as_array_mut().unwrap().push(more);
    stage.write();
    run_both(&stage);
    finish(&stage, "more");
    let output = merge(&stage, &both, "more-merged");
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    same_tables(&stage, "more-merged", &tables(&stage, "more"));
    // into the folder of the smaller study too
    let output = merge(&stage, &both, "m");
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    same_tables(&stage, "m", &tables(&stage, "more"));
    // a folder that is named twice is one
    let told = status(&stage, &["m", "./m", "s0/../m"]);
    assert_eq!(told["folders"].as_array().unwrap().len(), 1);
    assert_eq!(
        (&told["jobs"], &told["folders"][0]["shard"]),
        (&json!(49), &serde_json::Value::Null)
    );
    assert_eq!(told["folders"][0]["state"], "complete");
    std::fs::remove_file(stage.path("m/progress.json")).unwrap();
    assert_eq!(status(&stage, &["m"]), told);
    // an older record in the folder of the results counts like a shard's
    stage.study["design"][1] =
        json!({ "cases": [{ "speed_m_s": 9, "load_n": 1e5 }, { "speed_m_s": 8, "load_n": 1e5 }] });
    stage.write();
    run_both(&stage);
    let output = command(&stage, &["explain", "m", "49"]).output().unwrap();
    is_refused(&output, &["job: found 49", "0 to 48"]);
    let output = run(&stage, "s0", &["--shard", "1/2"]);
    is_refused(&output, &["shard: found 1/2", "0/2"]);
}

#[test]
fn many_shards_need_few_open_files() {
    let stage = sweep(2, 0.05);
    let folders = folders(24);
    for (k, folder) in folders.iter().enumerate() {
        let output = run(&stage, folder, &["--shard", &format!("{k}/24")]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    }
    finish(&stage, "whole");
    let program = env!("CARGO_BIN_EXE_pontoon");
    let line = format!(
        "ulimit -n 64 && exec {program} merge --quiet --out m {}",
        folders.join(" ")
    );
    let output = std::process::Command::new("sh")
        .args(["-c", &line])
        .current_dir(stage.path(""))
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    same_tables(&stage, "m", &tables(&stage, "whole"));
}

#[test]
fn shards_that_do_not_belong_together_are_refused() {
    let mut stage = sweep(2, 0.05);
    run_both(&stage);
    let names = |list: &[&str]| list.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>();
    is_refused(&merge(&stage, &names(&["s0"]), "m"), &["in no shard", "all of them"]);
    is_refused(
        &merge(&stage, &names(&["s0", "nowhere"]), "m"),
        &["nowhere: found no journal"],
    );
    is_refused(
        &merge(&stage, &names(&["s0", "s0"]), "m"),
        &["s0: found a shard that is given twice"],
    );
    is_refused(
        &merge(&stage, &names(&["s0", "s1"]), "s1"),
        &["s1: found a shard as the folder of results"],
    );
    // a share of another study
    stage.study["analysis"]["time_step_s"] = json!(0.04);
    stage.write();
    let output = run(&stage, "other", &["--shard", "1/2"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    is_refused(
        &merge(&stage, &names(&["s0", "other"]), "m"),
        &["other: found a shard of another study"],
    );
    assert!(!stage.path("m").exists());
    // a folder is a share's own
    let output = run(&stage, "other", &["--shard", "0/2"]);
    is_refused(&output, &["shard: found 0/2", "allowed: 1/2"]);
    // a shard that is not done
    let _ = run_with(&stage, "half", "journal.write:5:die");
    is_refused(&merge(&stage, &names(&["half", "other"]), "m"), &["in no shard"]);
}
