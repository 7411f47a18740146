//! Disks that are full or fail, folders that are another's.

use super::sweep::{begin, command, finish, records, run, run_with, same_tables, sweep, tables, tiny};
use crate::stage::{stderr, stdout};
use std::fs;
use std::process::Stdio;
use std::time::{Duration, Instant};

#[test]
fn a_disk_that_is_full_at_any_write_costs_nothing_but_the_run() {
    let stage = tiny();
    finish(&stage, "whole");
    let expected = tables(&stage, "whole");
    for place in ["journal.begin", "journal.write", "tables.write"] {
        let mut struck = 0;
        for number in 1.. {
            let (out, fault) = (format!("{place}-{number}"), format!("{place}:{number}:full"));
            let output = run_with(&stage, &out, &fault);
            if output.status.code() == Some(0) {
                break;
            }
            struck += 1;
            let told = stderr(&output);
            assert_eq!(
                (output.status.code(), stdout(&output).as_str()),
                (Some(3), ""),
                "{fault}: {told}"
            );
            assert!(told.contains("no space left on device"), "{fault}: {told}");
            if place != "journal.begin"
                && stage.path(&out).join("journal").exists()
                && !stage.path(&out).join("manifest.json").exists()
            {
                let told = super::sweep::status(&stage, &[&out]);
                let state = told["folders"][0]["state"].as_str().unwrap_or_default().to_owned();
                assert!(state.contains("no space left on device"), "{fault}: {told}");
            }
            if stage.path(&out).join("manifest.json").exists() {
                // only the journal's last word was missing
                same_tables(&stage, &out, &expected);
            }
            finish(&stage, &out);
            same_tables(&stage, &out, &expected);
            assert_eq!(records(&stage, &out), 4, "{fault}");
        }
        assert!(struck > 0, "{place} is never passed");
    }
}

#[test]
fn a_sync_that_fails_ends_the_run_and_says_so() {
    let stage = sweep(10, 0.01);
    finish(&stage, "whole");
    let expected = tables(&stage, "whole");
    for fault in [
        "journal.sync:1:error",
        "journal.begin.sync:1:error",
        "tables.sync:1:error",
        "tables.rename:2:error",
    ] {
        let output = run_with(&stage, fault, fault);
        let told = stderr(&output);
        assert_eq!(output.status.code(), Some(3), "{fault}: {told}");
        assert!(told.contains("input/output error"), "{fault}: {told}");
        finish(&stage, fault);
        same_tables(&stage, fault, &expected);
    }
}

#[test]
fn a_folder_is_one_process_at_a_time_and_a_dead_one_holds_nothing() {
    let stage = sweep(10, 0.001);
    let mut first = begin(&stage, "r", &[]);
    let began = Instant::now();
    while !stage.path("r/journal").exists() {
        assert!(began.elapsed() < Duration::from_secs(60));
        std::thread::sleep(Duration::from_millis(1));
    }
    let second = run(&stage, "r", &[]);
    let told = stderr(&second);
    assert_eq!(second.status.code(), Some(3), "{told}");
    assert!(told.contains("r is in use by process "), "{told}");
    first.kill().unwrap();
    first.wait().unwrap();
    assert!(stage.path("r/lock").exists());
    finish(&stage, "r");
}

#[test]
fn a_folder_that_cannot_be_written_is_told_with_its_name() {
    let stage = tiny();
    let output = run(&stage, "/proc/results", &[]);
    assert_eq!(output.status.code(), Some(3), "{}", stderr(&output));
    assert!(stderr(&output).contains("/proc/results"), "{}", stderr(&output));
}

#[test]
fn tables_without_their_journal_are_not_replaced() {
    let stage = tiny();
    finish(&stage, "r");
    let before = tables(&stage, "r");
    fs::remove_dir_all(stage.path("r/journal")).unwrap();
    let output = run(&stage, "r", &[]);
    let told = stderr(&output);
    assert_eq!(output.status.code(), Some(2), "{told}");
    assert!(
        told.contains("r/manifest.json: found results without the journal"),
        "{told}"
    );
    same_tables(&stage, "r", &before);
    let output = run(&stage, "r", &["--fresh"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    same_tables(&stage, "r", &before);
}

#[test]
fn nobody_who_reads_is_no_error() {
    let stage = tiny();
    let mut child = command(&stage, &["run", "study.json", "--out", "r"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop((child.stdout.take(), child.stderr.take()));
    assert_eq!(child.wait().unwrap().code(), Some(0));
}

#[test]
fn a_machine_that_computes_wrongly_runs_nothing() {
    let stage = tiny();
    let output = run_with(&stage, "r", "canary:1:error");
    let told = stderr(&output);
    assert_eq!(output.status.code(), Some(3), "{told}");
    assert!(told.contains("arithmetic is not sound here"), "{told}");
    assert_eq!(fs::read_dir(stage.path("r/journal")).map_or(0, Iterator::count), 0);
    finish(&stage, "r");
}
