//! Killed at random instants.

use super::sweep::{Random, begin, finish, records, same_tables, status, sweep, tables, tries};
use crate::stage::Stage;
use std::time::{Duration, Instant};

/// Kills a sweep again and again until it was killed often enough or is done; how often it was killed.
fn killed(stage: &Stage, out: &str, kills: usize, longest: Duration, seed: u64) -> usize {
    let mut random = Random(seed);
    for kill in 0..kills {
        let micros = u64::try_from(longest.as_micros()).unwrap();
        let mut child = begin(stage, out, &[]);
        std::thread::sleep(Duration::from_micros(random.below(micros)));
        if child.try_wait().unwrap().is_some_and(|status| status.success()) {
            return kill;
        }
        child.kill().unwrap();
        child.wait().unwrap();
    }
    kills
}

#[test]
fn a_sweep_that_is_killed_again_and_again_leaves_the_same_tables() {
    let stage = sweep(10, 0.01);
    let began = Instant::now();
    finish(&stage, "whole");
    let whole = began.elapsed();
    let expected = tables(&stage, "whole");
    let mut kills = 0;
    for round in 0.. {
        if kills >= tries(10) {
            break;
        }
        let out = format!("killed-{round}");
        kills += killed(&stage, &out, (tries(10) - kills).min(20), whole, 1 + round);
        finish(&stage, &out);
        same_tables(&stage, &out, &expected);
        // none twice: what was recorded is not run again
        assert_eq!(records(&stage, &out), 240, "round {round}");
        let told = status(&stage, &[&out]);
        assert_eq!((told["done"].as_u64(), told["missing"].as_u64()), (Some(240), Some(0)));
        assert_eq!(told["folders"][0]["state"], "complete");
    }
}
