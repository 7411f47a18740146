//! Jobs that a process dies with, that fail, and that fail too often.

use super::sweep::{begin, command, finish, run, run_with, sweep, tables};
use crate::stage::{stderr, stdout};
use serde_json::json;
use std::time::Duration;

#[test]
fn a_job_whose_process_died_three_times_is_marked_and_passed_over() {
    let stage = sweep(2, 0.05);
    finish(&stage, "whole");
    // the process dies whenever job 7 begins: first with its crew, then with its crew again, then alone
    let mut deaths = 0;
    let output = loop {
        let output = run_with(&stage, "r", "job.7:1:die");
        if output.status.code().is_some() {
            break output;
        }
        deaths += 1;
        assert!(deaths < 5, "it never ends");
    };
    let told = stderr(&output);
    assert_eq!((output.status.code(), deaths), (Some(1), 2), "{told}");
    assert!(
        told.contains(
            "job 7 failed: the process died 3 times while this job ran, the last time with no other beside it"
        ),
        "{told}"
    );
    let status = stage
        .table("r/jobs.parquet")
        .column("status")
        .unwrap()
        .str()
        .unwrap()
        .iter()
        .map(|s| s.unwrap() == "ok")
        .collect::<Vec<_>>();
    assert_eq!(status.iter().filter(|ok| !**ok).count(), 1);
    assert!(!status[7]);
    // the verdict stands, and the other jobs are what they were
    let again = run(&stage, "r", &[]);
    assert_eq!(again.status.code(), Some(1), "{}", stderr(&again));
    let numbers = |out: &str| stage.numbers(&format!("{out}/jobs.parquet"), "peak_deflection_m");
    let (found, whole) = (numbers("r"), numbers("whole"));
    for (job, (found, whole)) in found.iter().zip(&whole).enumerate() {
        assert_eq!(*found, whole.filter(|_| job != 7), "job {job}");
    }
}

#[test]
fn failed_jobs_are_tried_again_where_that_is_asked_and_the_others_are_not() {
    let stage = sweep(2, 0.05);
    finish(&stage, "whole");
    let expected = tables(&stage, "whole");
    for (out, more) in [("r", &[][..]), ("s", &["--shard", "0/1"])] {
        let again = |fault: &str, words: &[&str]| {
            let words = [&["run", "study.json", "--out", out, "--quiet"], more, words].concat();
            command(&stage, &words).env("PONTOON_FAULT", fault).output().unwrap()
        };
        while again("job.7:1:die", &[]).status.code().is_none() {}
        let failed = |expected: usize| assert_eq!(super::sweep::status(&stage, &[out])["failed"], expected);
        failed(1);
        let output = command(&stage, &["explain", out, "7"]).output().unwrap();
        assert!(stdout(&output).contains("--retry-failed"), "{}", stdout(&output));
        // killed before the tables: what was tried again stands, and they are made of it
        let output = again("tables.rename:1:die", &["--retry-failed"]);
        assert_eq!(output.status.code(), if more.is_empty() { None } else { Some(0) });
        let output = again("", &[]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        failed(0);
        let output = again("", &["--retry-failed"]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    }
    // 48 jobs once, and the one that failed once more
    assert!(super::sweep::records(&stage, "r") <= 49, "others ran again");
    let output = command(&stage, &["merge", "s", "--out", "m", "--quiet"])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(tables(&stage, "r") == expected && tables(&stage, "m") == expected);
}

#[test]
fn a_job_that_was_under_way_when_others_killed_the_process_is_not_marked() {
    let stage = sweep(2, 0.05);
    finish(&stage, "whole");
    // the same jobs are under way each time, and none of them is to blame
    for _ in 0..2 {
        let words = ["run", "study.json", "--out", "r", "--quiet", "--threads", "1"];
        let output = command(&stage, &words)
            .env("PONTOON_FAULT", "journal.write:3:short")
            .output()
            .unwrap();
        assert_eq!(output.status.code(), None, "{}", stderr(&output));
    }
    let output = finish(&stage, "r");
    assert!(
        stderr(&output).contains("were under way when processes died twice"),
        "{}",
        stderr(&output)
    );
    assert!(tables(&stage, "r") == tables(&stage, "whole"));
}

#[test]
fn a_kill_of_the_process_that_waits_counts_against_no_job() {
    let stage = sweep(2, 0.05);
    finish(&stage, "whole");
    let words = ["run", "study.json", "--out", "r", "--quiet", "--threads", "1"];
    for _ in 0..2 {
        let output = command(&stage, &words)
            .env("PONTOON_FAULT", "journal.write:3:short")
            .output()
            .unwrap();
        assert_eq!(output.status.code(), None, "{}", stderr(&output));
    }
    // killed while another process solves the suspects, again and again
    for micros in [20_000, 40_000, 60_000, 80_000, 100_000, 120_000] {
        let mut child = begin(&stage, "r", &[]);
        std::thread::sleep(Duration::from_micros(micros));
        child.kill().unwrap();
        child.wait().unwrap();
    }
    finish(&stage, "r");
    assert!(tables(&stage, "r") == tables(&stage, "whole"));
}

/// A sweep of jobs that take long, of which two processes died, and a third that solves the suspects apart.
fn apart_at_work() -> (crate::stage::Stage, std::process::Child) {
    let mut stage = sweep(2, 0.0005);
    stage.study["analysis"]["solver"] = json!("reference");
    stage.write();
    let words = ["run", "study.json", "--out", "r", "--quiet"];
    for _ in 0..2 {
        let output = command(&stage, &words)
            .env("PONTOON_FAULT", "job.1:1:die")
            .output()
            .unwrap();
        assert_eq!(output.status.code(), None, "{}", stderr(&output));
    }
    let child = begin(&stage, "r", &[]);
    let began = std::time::Instant::now();
    while std::fs::read_dir(stage.path("r/journal")).unwrap().count() < 3 {
        assert!(began.elapsed() < Duration::from_secs(60));
        std::thread::sleep(Duration::from_millis(2));
    }
    (stage, child)
}

#[test]
fn status_knows_nothing_of_jobs_solved_apart_but_that_they_are_done() {
    let (stage, mut child) = apart_at_work();
    let told = super::sweep::status(&stage, &["r"]);
    assert_eq!(
        (&told["jobs"], &told["folders"][0]["state"]),
        (&json!(48), &json!("running"))
    );
    child.kill().unwrap();
    child.wait().unwrap();
    let told = super::sweep::status(&stage, &["r"]);
    assert_eq!(told["jobs"], 48);
    finish(&stage, "r");
    assert_eq!(super::sweep::status(&stage, &["r"])["folders"][0]["state"], "complete");
}

#[test]
fn an_interrupt_ends_a_run_that_waits_for_jobs_solved_apart() {
    let (stage, child) = apart_at_work();
    let asked = std::time::Instant::now();
    let sent = std::process::Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status()
        .unwrap();
    assert!(sent.success());
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130), "{}", stderr(&output));
    assert!(asked.elapsed() < Duration::from_secs(3), "{:?}", asked.elapsed());
    let lines = stderr(&output)
        .lines()
        .filter(|line| line.contains("process of their own"))
        .count();
    assert_eq!(lines, 1, "{}", stderr(&output));
    finish(&stage, "r");
}

#[test]
fn a_study_changed_while_jobs_are_solved_apart_is_not_taken_for_the_old_one() {
    let mut stage = sweep(2, 0.05);
    finish(&stage, "whole");
    let words = ["run", "study.json", "--out", "r", "--quiet", "--threads", "1"];
    for _ in 0..2 {
        let output = command(&stage, &words)
            .env("PONTOON_FAULT", "journal.write:3:short")
            .output()
            .unwrap();
        assert_eq!(output.status.code(), None, "{}", stderr(&output));
    }
    let old = stage.study.clone();
    stage.study["analysis"]["time_step_s"] = json!(0.04);
    stage.write();
    let apart = format!("{}:1,2", "0".repeat(64));
    let output = command(&stage, &["run", "study.json", "--out", "r", "--apart", &apart])
        .stdin(std::process::Stdio::piped())
        .output();
    // its standard input may end before it has said so
    assert!(matches!(output.unwrap().status.code(), Some(2 | 3)));
    stage.study = old;
    stage.write();
    finish(&stage, "r");
    assert!(tables(&stage, "r") == tables(&stage, "whole"));
}

#[test]
fn failures_are_grouped_by_cause_and_stop_the_run_where_they_are_too_many() {
    let mut stage = sweep(2, 0.05);
    // a single Newton solution and no bisection: contacts do not settle, neither at half the step
    stage.study["analysis"]["newton_limit"] = json!(1);
    stage.study["analysis"]["bisection_limit"] = json!(0);
    stage.write();
    let output = run(&stage, "r", &[]);
    let told = stderr(&output);
    assert_eq!(output.status.code(), Some(1), "{told}");
    assert!(
        told.contains("jobs failed; by cause:") && told.contains("at half the time step"),
        "{told}"
    );
    let output = run(&stage, "few", &["--max-failures", "3"]);
    let told = stderr(&output);
    assert_eq!(output.status.code(), Some(3), "{told}");
    assert!(
        told.contains("stopped: ") && told.contains("of 48 are recorded"),
        "{told}"
    );
    assert!(!stage.path("few/manifest.json").exists());
    // a share says so each time it is asked for
    for _ in 0..2 {
        let output = run(&stage, "share", &["--shard", "0/1"]);
        assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    }
    // more are allowed: it goes on
    let output = run(&stage, "few", &["--max-failures", "48"]);
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    assert!(tables(&stage, "few") == tables(&stage, "r"));
}

#[test]
fn a_job_beyond_the_step_limit_fails_without_running() {
    let mut stage = sweep(2, 0.05);
    finish(&stage, "whole");
    let steps = stage.numbers("whole/jobs.parquet", "steps");
    let most = steps.iter().flatten().copied().fold(0.0, f64::max);
    stage.study["analysis"]["step_limit"] = json!(most as u64 - 1);
    stage.write();
    let output = run(&stage, "r", &[]);
    let told = stderr(&output);
    assert_eq!(output.status.code(), Some(1), "{told}");
    assert!(
        told.contains(&format!("failed: {most} time steps, the limit is {}", most - 1.0)),
        "{told}"
    );
    let found = stage.numbers("r/jobs.parquet", "steps");
    for (found, steps) in found.iter().zip(&steps) {
        assert_eq!(*found, steps.filter(|steps| *steps < most));
    }
}

/// A time step that the program finds is halved no further than the limit allows.
#[test]
fn the_step_limit_holds_for_each_time_step_that_is_tried() {
    let mut stage = sweep(2, 0.05);
    stage.study["analysis"]["time_step_s"] = json!("auto");
    stage.write();
    finish(&stage, "whole");
    let steps: Vec<f64> = stage
        .numbers("whole/jobs.parquet", "steps")
        .into_iter()
        .flatten()
        .collect();
    let (least, most) = steps
        .iter()
        .fold((f64::MAX, 0.0_f64), |(a, b), x| (a.min(*x), b.max(*x)));
    assert!(least < most);
    stage.study["analysis"]["step_limit"] = json!(most as u64 - 1);
    stage.write();
    let output = run(&stage, "r", &[]);
    let told = stderr(&output);
    assert_eq!(output.status.code(), Some(1), "{told}");
    let failed = format!(" s: {most} time steps, the limit is {}", most - 1.0);
    assert!(
        told.contains("failed: at a time step of 0.0") && told.contains(&failed),
        "{told}"
    );
    for (found, steps) in stage.numbers("r/jobs.parquet", "steps").iter().zip(&steps) {
        assert_eq!(*found, Some(*steps).filter(|steps| *steps < most));
    }
}

#[test]
fn a_job_that_half_the_step_helps_says_so() {
    let mut stage = sweep(4, 0.05);
    stage.study["analysis"]["newton_limit"] = json!(2);
    stage.study["analysis"]["bisection_limit"] = json!(0);
    stage.write();
    let output = command(&stage, &["run", "study.json", "--out", "r", "--quiet"])
        .output()
        .unwrap();
    assert!(matches!(output.status.code(), Some(0 | 1)), "{}", stderr(&output));
    let jobs = stage.table("r/jobs.parquet");
    let (status, reason) = (
        jobs.column("status").unwrap().str().unwrap(),
        jobs.column("reason").unwrap().str().unwrap(),
    );
    let helped: Vec<&str> = status
        .iter()
        .zip(reason.iter())
        .filter(|(s, _)| *s == Some("ok"))
        .filter_map(|(_, r)| r)
        .collect();
    assert!(!helped.is_empty(), "no job was helped: the test has lost its case");
    assert!(
        helped
            .iter()
            .all(|r| r.starts_with("at half the time step; at its own: contact not settled")),
        "{helped:?}"
    );
}
