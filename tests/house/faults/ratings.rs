//! Ratings on threads, in shares and killed: which values are tried depends on the rating alone.

use super::sweep::{begin, command, finish, records, run, same_tables, sweep, tables};
use crate::stage::{Stage, stderr};
use serde_json::json;
use std::time::{Duration, Instant};

/// A stage of 12 ratings.
fn ratings() -> Stage {
    let mut stage = sweep(1, 0.02);
    stage.study["analysis"]["kind"] = json!("rating");
    stage.study["limits"] = json!({ "edge_sinkage_m": 0.25, "joint_compression_n": 8e5 });
    stage.study["find"] = json!({ "largest": "load_n", "between": [5e4, 6e5], "ladder_ratio": 1.05 });
    stage.study["design"] = json!([{ "grid": { "gap_tension_m": [0.0, 0.02, 0.03], "speed_m_s": [5, 8, 12, 16] } }]);
    stage.write();
    stage
}

#[test]
fn ratings_leave_the_same_tables_whatever_runs_them() {
    let stage = ratings();
    finish(&stage, "whole");
    let expected = tables(&stage, "whole");
    let mut longest = Duration::ZERO;
    for threads in ["3", "1"] {
        let began = Instant::now();
        let output = run(&stage, threads, &["--threads", threads]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        same_tables(&stage, threads, &expected);
        longest = began.elapsed();
    }
    // at a sixth, two sixths and so on of what one thread takes with the operators at hand
    for kill in 0..4 {
        let mut child = begin(&stage, "killed", &["--threads", "1"]);
        std::thread::sleep(longest * (kill + 1) / 6);
        if child.try_wait().unwrap().is_some() {
            assert!(kill > 0, "no rating was killed");
            break;
        }
        child.kill().unwrap();
        child.wait().unwrap();
    }
    finish(&stage, "killed");
    same_tables(&stage, "killed", &expected);
    assert_eq!(records(&stage, "killed"), 12);
    for shard in ["0/2", "1/2"] {
        let output = run(
            &stage,
            &format!("s{}", &shard[..1]),
            &["--shard", shard, "--threads", "1"],
        );
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    }
    let output = command(&stage, &["merge", "--out", "merged", "--quiet", "s0", "s1"])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    same_tables(&stage, "merged", &expected);
}

/// Another search or another limit is another rating: what was recorded does not answer it.
#[test]
fn a_rating_with_another_limit_or_search_is_run_again() {
    let mut stage = ratings();
    finish(&stage, "r");
    stage.study["limits"]["edge_sinkage_m"] = json!(0.2);
    stage.write();
    finish(&stage, "r");
    stage.study["find"]["ladder_ratio"] = json!(1.04);
    stage.write();
    finish(&stage, "r");
    finish(&stage, "fresh");
    same_tables(&stage, "r", &tables(&stage, "fresh"));
}
