//! Asked to stop, or how far it is.

use super::sweep::{begin, command, finish, records, same_tables, status, sweep, tables};
use crate::stage::{Stage, stderr};
use serde_json::Value;
use std::process::{Child, Command, Output};
use std::time::{Duration, Instant};

fn send(child: &Child, signal: &str) {
    let sent = Command::new("kill")
        .args([signal, &child.id().to_string()])
        .status()
        .unwrap();
    assert!(sent.success());
}

/// Waits until a run has recorded a job.
fn under_way(stage: &Stage, out: &str) {
    let began = Instant::now();
    // the folder of a journal is there before its file, and the file before what it begins with
    let is_under_way = || {
        let output = command(stage, &["status", "--format", "json", out]).output().unwrap();
        let told: Value = serde_json::from_slice(&output.stdout).unwrap_or_default();
        output.status.code() == Some(0) && told["done"].as_u64() > Some(0)
    };
    while !is_under_way() {
        assert!(began.elapsed() < Duration::from_secs(60));
        std::thread::sleep(Duration::from_millis(5));
    }
}

fn ended(child: Child) -> Output {
    child.wait_with_output().unwrap()
}

#[test]
fn an_interrupt_ends_the_run_resumable_and_a_question_does_not() {
    let stage = sweep(30, 0.002);
    finish(&stage, "whole");
    let expected = tables(&stage, "whole");
    for signal in ["-INT", "-TERM"] {
        let out = &signal[1..];
        let child = begin(&stage, out, &[]);
        under_way(&stage, out);
        assert_eq!(status(&stage, &[out])["folders"][0]["state"], "running");
        send(&child, "-USR1");
        std::thread::sleep(Duration::from_millis(30));
        send(&child, signal);
        let output = ended(child);
        let told = stderr(&output);
        assert_eq!(output.status.code(), Some(130), "{told}");
        assert!(told.contains("/720 jobs done, 0 failed, journal synced"), "{told}");
        assert!(
            told.contains("of 720 jobs are recorded, the same command goes on from there"),
            "{told}"
        );
        let told = status(&stage, &[out]);
        let done = told["done"].as_u64().unwrap();
        assert!(0 < done && done < 720, "{told}");
        assert_eq!(told["folders"][0]["state"], "interrupted");
        finish(&stage, out);
        same_tables(&stage, out, &expected);
        assert_eq!(records(&stage, out), 720);
    }
}

/// A bridge of 120 modules is prepared for some twenty seconds; an interrupt in the midst of it is answered at once.
#[test]
fn an_interrupt_during_preparation_does_not_wait_for_it() {
    let mut stage = sweep(2, 0.01);
    stage.bridge["modules"] = 120.into();
    stage.write();
    let child = begin(&stage, "r", &[]);
    let began = Instant::now();
    while !stage.path("r/journal").exists() {
        assert!(began.elapsed() < Duration::from_secs(60));
        std::thread::sleep(Duration::from_millis(5));
    }
    std::thread::sleep(Duration::from_millis(2500));
    let asked = Instant::now();
    send(&child, "-INT");
    let output = ended(child);
    let told = stderr(&output);
    assert_eq!(output.status.code(), Some(130), "{told}");
    assert!(told.contains("interrupted: 0 of 48 jobs are recorded"), "{told}");
    assert!(asked.elapsed() < Duration::from_secs(5), "{:?}", asked.elapsed());
}

#[test]
fn a_second_interrupt_ends_the_run_at_once() {
    // by the reference solver at a short step: a job takes seconds
    let mut stage = sweep(2, 0.0002);
    stage.study["analysis"]["solver"] = "reference".into();
    stage.write();
    let child = begin(&stage, "r", &[]);
    let began = Instant::now();
    while !stage.path("r/journal").exists() {
        assert!(began.elapsed() < Duration::from_secs(60));
        std::thread::sleep(Duration::from_millis(1));
    }
    std::thread::sleep(Duration::from_millis(300));
    send(&child, "-INT");
    std::thread::sleep(Duration::from_millis(50));
    let asked = Instant::now();
    send(&child, "-INT");
    let output = ended(child);
    assert_eq!(output.status.code(), Some(130), "{}", stderr(&output));
    assert!(asked.elapsed() < Duration::from_secs(2));
    // which is no death of the jobs that were under way
    assert_eq!(status(&stage, &["r"])["folders"][0]["state"], "interrupted");
}
