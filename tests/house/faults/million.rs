//! A million jobs that are nothing by themselves: what is left is the engine.

use super::sweep::{begin, command, status};
use crate::stage::{Stage, stderr};
use serde_json::json;
use std::fs;
use std::time::{Duration, Instant};

/// Resident memory of a process, its own line of what the system tells `[kB]`.
fn memory_kb(process: u32, line: &str) -> Option<u64> {
    let told = fs::read_to_string(format!("/proc/{process}/status")).ok()?;
    let line = told.lines().find(|l| l.starts_with(line))?.to_owned();
    line.split_whitespace().nth(1)?.parse().ok()
}

#[test]
#[ignore = "a minute; run by scripts/faults"]
fn a_million_jobs_keep_memory_flat_and_status_below_a_second() {
    let mut stage = Stage::new();
    stage.study["analysis"] = json!({ "kind": "static" });
    stage.study["design"] = json!([{ "grid": { "load_position": [1, 2, 3, 4], "gap_tension_m": { "linspace": [0, 0.03, 250] },
                                               "load_n": { "linspace": [1000, 100_000, 1000] } } }]);
    stage.study["record"] = json!({ "positions": false, "connectors": false });
    stage.write();
    let mut child = begin(&stage, "r", &[]);
    let mut seen = Vec::new();
    let mut slowest = Duration::ZERO;
    while child.try_wait().unwrap().is_none() {
        if stage.path("r/journal").exists() {
            let asked = Instant::now();
            let told = status(&stage, &["r"]);
            slowest = slowest.max(asked.elapsed());
            let done = told["done"].as_u64().unwrap();
            seen.extend(memory_kb(child.id(), "VmRSS").map(|kb| (done, kb)));
        }
        std::thread::sleep(Duration::from_millis(200));
    }
    assert_eq!(child.wait().unwrap().code(), Some(0));
    // from a tenth to nine tenths of the jobs: what grows is a line of the summary a job
    let at = |share: u64| seen.iter().find(|(done, _)| *done >= share * 100_000).unwrap().1;
    let (early, late) = (at(1), at(9));
    println!("memory {early} kB at a tenth, {late} kB at nine tenths; slowest status {slowest:?}");
    assert!(late < early + 60_000, "{early} kB at a tenth, {late} kB at nine tenths");
    assert!(slowest < Duration::from_secs(1), "{slowest:?}");
    // and without the small file that makes it fast, the journal itself tells the same
    fs::remove_file(stage.path("r/progress.json")).unwrap();
    assert_eq!(status(&stage, &["r"])["done"], 1_000_000);
    let output = command(&stage, &["explain", "r", "999999"]).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
}
