//! Killed at each place that matters, once.

use super::sweep::{command, finish, records, run, run_with, same_tables, sweep, tables};
use crate::stage::stderr;

/// Places that a run passes, with the passages at which it dies.
const PLACES: [(&str, &[usize]); 14] = [
    ("documents.write", &[1, 2]),
    ("documents.rename", &[1, 2]),
    ("journal.begin", &[1]),
    ("journal.begin.sync", &[1]),
    ("journal.write", &[1, 2, 3, 4, 6, 9]),
    ("journal.written", &[1, 2, 4]),
    ("journal.begun", &[1]),
    ("journal.sync", &[1]),
    ("journal.synced", &[1]),
    ("tables.write", &[1, 2, 6]),
    ("tables.sync", &[1, 3]),
    ("tables.synced", &[2]),
    ("tables.rename", &[1, 2, 5, 6]),
    ("tables.renamed", &[1, 2, 5, 6]),
];

#[test]
fn a_process_that_dies_at_any_place_loses_nothing() {
    let stage = sweep(4, 0.05);
    finish(&stage, "whole");
    let expected = tables(&stage, "whole");
    for (place, passages) in PLACES {
        for passage in passages {
            let ways: &[&str] = if matches!(
                place,
                "documents.write" | "journal.begin" | "journal.write" | "tables.write"
            ) {
                &["die", "short"]
            } else {
                &["die"]
            };
            for how in ways {
                let out = format!("{place}-{passage}-{how}");
                let fault = format!("{place}:{passage}:{how}");
                let output = run_with(&stage, &out, &fault);
                assert_eq!(
                    output.status.code(),
                    None,
                    "{fault} did not strike: {}",
                    stderr(&output)
                );
                // and once more while it recovers; twice between the first word of a preparation and the last one is a
                // bridge's fault, as far as anybody knows
                if !matches!((place, passage), ("journal.write", 2) | ("journal.written", 1)) {
                    let again = run_with(&stage, &out, &fault);
                    assert!(
                        matches!(again.status.code(), None | Some(0)),
                        "{fault}: {}",
                        stderr(&again)
                    );
                }
                finish(&stage, &out);
                same_tables(&stage, &out, &expected);
                assert!(records(&stage, &out) <= 96, "{fault}: a job ran twice");
            }
        }
    }
}

#[test]
fn a_merge_that_dies_at_any_place_loses_nothing() {
    let stage = sweep(4, 0.05);
    finish(&stage, "whole");
    let expected = tables(&stage, "whole");
    for shard in ["0/2", "1/2"] {
        let output = run(&stage, &format!("shard-{}", &shard[..1]), &["--shard", shard]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    }
    let merge = |out: &str| command(&stage, &["merge", "shard-0", "shard-1", "--out", out, "--quiet"]);
    for (place, passages) in [
        ("merge.copy", &[1, 2][..]),
        ("merge.rename", &[1, 2]),
        ("tables.write", &[1, 4]),
        ("tables.rename", &[1, 3, 6]),
        ("tables.renamed", &[1, 3, 6]),
    ] {
        for passage in passages {
            let (out, fault) = (format!("{place}-{passage}"), format!("{place}:{passage}:die"));
            let output = merge(&out).env("PONTOON_FAULT", &fault).output().unwrap();
            assert_eq!(
                output.status.code(),
                None,
                "{fault} did not strike: {}",
                stderr(&output)
            );
            let output = merge(&out).output().unwrap();
            assert_eq!(output.status.code(), Some(0), "{fault}: {}", stderr(&output));
            same_tables(&stage, &out, &expected);
        }
    }
}

#[test]
fn results_set_aside_by_a_process_that_dies_are_set_aside_by_the_next() {
    let mut stage = sweep(2, 0.05);
    finish(&stage, "r");
    let old = tables(&stage, "r");
    stage.study["analysis"]["time_step_s"] = 0.04.into();
    stage.write();
    finish(&stage, "whole");
    let expected = tables(&stage, "whole");
    // four tables, summary, manifest, documents, journal: each process moves one more
    for _ in 0..7 {
        let fault = "aside.rename:2:die";
        let words = ["run", "study.json", "--out", "r", "--quiet", "--fresh"];
        let output = command(&stage, &words).env("PONTOON_FAULT", fault).output().unwrap();
        assert_eq!(
            output.status.code(),
            None,
            "{fault} did not strike: {}",
            stderr(&output)
        );
    }
    let output = run(&stage, "r", &["--fresh"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    same_tables(&stage, "r", &expected);
    let aside: Vec<_> = std::fs::read_dir(stage.path("r/aside")).unwrap().collect();
    assert_eq!(aside.len(), 1, "{aside:?}");
    let kept = aside[0].as_ref().unwrap().path();
    for (name, bytes) in old {
        assert!(std::fs::read(kept.join(&name)).unwrap() == bytes, "{name}");
    }
    assert!(kept.join("journal").is_dir() && kept.join("manifest.json").is_file());
}

/// A fault that no place knows would make a run look as if it had outlived one.
#[test]
fn a_misspelt_fault_is_refused() {
    let stage = sweep(2, 0.05);
    for fault in [
        "journal.writes:3:short",
        "journal.write:3:shrt",
        "journal.write",
        "journal.write:0:die",
    ] {
        let output = run_with(&stage, "r", fault);
        let told = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{fault}: {told}");
        assert!(
            told.starts_with(&format!(
                "pontoon: PONTOON_FAULT: found \"{fault}\", allowed: PLACE:NUMBER:HOW"
            )),
            "{told}"
        );
        assert!(!stage.path("r").exists());
    }
}
