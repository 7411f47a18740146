//! A sweep on a stage: how it is begun, disturbed and looked at.

use crate::stage::{Stage, stderr};
use serde_json::{Value, json};
use std::fs;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};

/// A stage with a sweep of `gaps` x 6 x 4 crossings at a time step.
pub(crate) fn sweep(gaps: usize, time_step_s: f64) -> Stage {
    let mut stage = Stage::new();
    stage.study["analysis"] = json!({ "kind": "crossing", "time_step_s": time_step_s, "tail_s": 1.0 });
    stage.study["design"] = json!([{ "grid": {
        "gap_tension_m": { "linspace": [0.0, 0.03, gaps] }, "speed_m_s": [10, 12, 14, 16, 18, 20],
        "load_n": { "linspace": [5e4, 2e5, 4] }
    } }]);
    stage.study["record"] = json!({ "histories": { "positions": [2], "joints": [] } });
    stage.write();
    stage
}

/// A sweep of few jobs that leave little.
pub(crate) fn tiny() -> Stage {
    let mut stage = Stage::new();
    stage.study["analysis"] = json!({ "kind": "crossing", "time_step_s": 0.05, "tail_s": 0.5 });
    stage.study["design"] = json!([{ "grid": { "gap_tension_m": [0.0, 0.03], "speed_m_s": [15, 20], "load_n": 1e5 } }]);
    stage.study["record"] = json!({ "positions": false, "connectors": false });
    stage.write();
    stage
}

/// The program at work on a sweep, to be disturbed.
pub(crate) fn begin(stage: &Stage, out: &str, more: &[&str]) -> Child {
    command(stage, &[&["run", "study.json", "--out", out, "--quiet"], more].concat())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

/// The program in the folder of a stage.
pub(crate) fn command(stage: &Stage, words: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_pontoon"));
    command
        .args(words)
        .current_dir(stage.path(""))
        .env("PONTOON_CACHE_DIR", stage.path("cache"));
    command
}

/// Runs a sweep to its end, come what may.
pub(crate) fn run(stage: &Stage, out: &str, more: &[&str]) -> Output {
    command(stage, &[&["run", "study.json", "--out", out, "--quiet"], more].concat())
        .output()
        .unwrap()
}

/// Runs a sweep with a fault on the way.
pub(crate) fn run_with(stage: &Stage, out: &str, fault: &str) -> Output {
    command(stage, &["run", "study.json", "--out", out, "--quiet"])
        .env("PONTOON_FAULT", fault)
        .output()
        .unwrap()
}

/// Runs a sweep to its good end.
pub(crate) fn finish(stage: &Stage, out: &str) -> Output {
    let output = run(stage, out, &[]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    output
}

/// The bytes of all tables in a folder, by name.
pub(crate) fn tables(stage: &Stage, out: &str) -> Vec<(String, Vec<u8>)> {
    let mut all = Vec::new();
    for entry in fs::read_dir(stage.path(out)).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|e| e == "parquet" || e == "csv") {
            all.push((name(&path), fs::read(&path).unwrap()));
        }
    }
    all.sort();
    all
}

/// Refuses tables that are not those of another folder, byte for byte.
#[track_caller]
pub(crate) fn same_tables(stage: &Stage, out: &str, expected: &[(String, Vec<u8>)]) {
    let found = tables(stage, out);
    let names = |list: &[(String, Vec<u8>)]| list.iter().map(|(name, _)| name.clone()).collect::<Vec<_>>();
    assert_eq!(names(&found), names(expected));
    for ((name, found), (_, expected)) in found.iter().zip(expected) {
        assert!(found == expected, "{name} differs");
    }
    let left = fs::read_dir(stage.path(out)).unwrap().map(|e| name(&e.unwrap().path()));
    let partial: Vec<String> = left.filter(|name| name.contains("partial")).collect();
    assert!(partial.is_empty(), "left behind: {partial:?}");
}

fn name(path: &Path) -> String {
    path.file_name().unwrap().to_string_lossy().into_owned()
}

/// Records that all processes wrote to a folder's journal, by the manifest: those before the last one, and the last.
pub(crate) fn records(stage: &Stage, out: &str) -> usize {
    let manifest = stage.manifest(out);
    let before = manifest["sessions"]
        .as_array()
        .unwrap()
        .iter()
        .map(|s| s["records"].as_u64().unwrap());
    usize::try_from(before.sum::<u64>() + manifest["ran"].as_u64().unwrap()).unwrap()
}

/// How often something is tried: more often where the environment says so.
pub(crate) fn tries(few: usize) -> usize {
    std::env::var("PONTOON_FAULT_TRIES").map_or(few, |many| many.parse().unwrap())
}

/// Numbers that look random, the same in each run of a test.
pub(crate) struct Random(pub u64);

impl Random {
    /// The next one, below a bound.
    pub(crate) fn below(&mut self, bound: u64) -> u64 {
        // splitmix64
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (z ^ (z >> 31)) % bound
    }
}

/// What `status` says of a folder.
pub(crate) fn status(stage: &Stage, folders: &[&str]) -> Value {
    let output = command(stage, &[&["status", "--format", "json"], folders].concat())
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    serde_json::from_slice(&output.stdout).unwrap()
}
