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
            .env("PONTOON_FAULT", "journal.write:8:short")
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
            .env("PONTOON_FAULT", "journal.write:4:short")
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
            .env("PONTOON_FAULT", "journal.write:4:short")
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

/// Three bridges, of four jobs each: 0 to 3, 4 to 7, 8 to 11.
fn bridges() -> crate::stage::Stage {
    let mut stage = sweep(1, 0.05);
    stage.study["design"] = json!([{ "grid": {
        "bridge.connectors.stiffness_n_m": [1e7, 2e7, 3e7], "speed_m_s": [10, 15], "load_n": [5e4, 1e5]
    } }]);
    stage.write();
    stage
}

/// The program that dies whenever it prepares the bridge of job 5.
fn dying(stage: &crate::stage::Stage, out: &str, more: &[&str]) -> std::process::Output {
    let words = [&["run", "study.json", "--out", out, "--quiet"], more].concat();
    let mut command = command(stage, &words);
    command.env("PONTOON_FAULT", "prepare.5:1:die").output().unwrap()
}

/// Why the jobs of that bridge fail.
const DIED: &str =
    "the process died 2 times while it prepared the bridge of this job, the last time with no other beside it";

#[test]
fn jobs_of_a_bridge_that_kills_its_process_are_marked_and_the_others_are_solved() {
    let stage = bridges();
    finish(&stage, "whole");
    let output = dying(&stage, "r", &[]);
    assert_eq!(output.status.code(), None, "{}", stderr(&output));
    let explained = |job: &str| stdout(&command(&stage, &["explain", "r", job]).output().unwrap());
    assert!(
        explained("5").contains("a process died while it prepared its bridge"),
        "{}",
        explained("5")
    );
    let output = dying(&stage, "r", &[]);
    let told = stderr(&output);
    assert_eq!(output.status.code(), Some(1), "{told}");
    assert!(
        told.contains(
            "3 bridges were being prepared when a process died: prepared one by one in a process of their own"
        ),
        "{told}"
    );
    assert!(
        told.contains(&format!("job 4 failed: {DIED}")) && explained("5").contains(DIED),
        "{told}{}",
        explained("5")
    );
    let told = super::sweep::status(&stage, &["r"]);
    assert_eq!(
        (&told["failed"], &told["folders"][0]["state"]),
        (&json!(4), &json!("complete"))
    );
    // the verdict stands, and nothing is prepared for it
    let before = tables(&stage, "r");
    let again = dying(&stage, "r", &[]);
    assert_eq!(again.status.code(), Some(1), "{}", stderr(&again));
    assert!(tables(&stage, "r") == before);
    others_are_whole(&stage);
}

/// Expects the rows of the jobs of the other two bridges to be those of a run without faults.
fn others_are_whole(stage: &crate::stage::Stage) {
    for name in ["jobs", "positions", "connectors", "histories"] {
        let [found, whole] = ["r", "whole"].map(|out| stage.table(&format!("{out}/{name}.parquet")));
        let rows = |table: &crate::stage::Frame| {
            let jobs = table.column("job").unwrap().numbers();
            let other = jobs
                .iter()
                .enumerate()
                .filter(|(_, job)| !(4.0..8.0).contains(&job.unwrap()));
            other.map(|(row, _)| row).collect::<Vec<_>>()
        };
        let (found_rows, whole_rows) = (rows(&found), rows(&whole));
        assert!(found_rows.len() == whole_rows.len() && found_rows.len() >= 8, "{name}");
        for column in whole.names() {
            let cells = |table: &crate::stage::Frame, rows: &[usize]| {
                let column = table.column(&column).unwrap();
                let texts = column.str();
                let numbers = texts.is_none().then(|| column.numbers());
                let cell = |&row: &usize| match (&texts, &numbers) {
                    (Some(texts), _) => texts.get(row).map(str::to_owned),
                    (None, numbers) => numbers.as_ref().and_then(|n| n[row]).map(|x| x.to_bits().to_string()),
                };
                rows.iter().map(cell).collect::<Vec<_>>()
            };
            assert_eq!(
                cells(&found, &found_rows),
                cells(&whole, &whole_rows),
                "{name}: {column}"
            );
        }
    }
}

#[test]
fn a_bridge_that_killed_its_process_is_tried_again_where_that_is_asked() {
    let stage = bridges();
    finish(&stage, "whole");
    let expected = tables(&stage, "whole");
    for (out, more) in [("r", &[][..]), ("s", &["--shard", "0/1"])] {
        let retried = [more, &["--retry-failed"]].concat();
        assert_eq!(dying(&stage, out, more).status.code(), None);
        // it dies apart, also where it is tried again
        for words in [more, &retried, more] {
            let output = dying(&stage, out, words);
            assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
            assert_eq!(super::sweep::status(&stage, &[out])["failed"], 4);
        }
        let output = run(&stage, out, &retried);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        assert_eq!(super::sweep::status(&stage, &[out])["failed"], 0);
    }
    let output = command(&stage, &["merge", "s", "--out", "m", "--quiet"]).output();
    assert_eq!(output.unwrap().status.code(), Some(0));
    assert!(tables(&stage, "r") == expected && tables(&stage, "m") == expected);
}

#[test]
fn a_process_that_died_once_while_it_prepared_bridges_costs_no_job() {
    let stage = bridges();
    finish(&stage, "whole");
    let expected = tables(&stage, "whole");
    for (out, more) in [("r", &[][..]), ("fresh", &["--fresh"])] {
        let output = dying(&stage, out, &[]);
        assert_eq!(output.status.code(), None, "{}", stderr(&output));
        let output = run(&stage, out, more);
        let told = stderr(&output);
        assert_eq!(output.status.code(), Some(0), "{told}");
        assert_eq!(told.contains("prepared one by one"), more.is_empty(), "{told}");
        super::sweep::same_tables(&stage, out, &expected);
    }
    // what was prepared since is no suspect of a later run
    let output = run(&stage, "r", &[]);
    assert_eq!((output.status.code(), stderr(&output).as_str()), (Some(0), ""));
}

/// A bridge that is prepared for some twenty seconds, with which a process died.
fn long_suspect() -> crate::stage::Stage {
    let mut stage = sweep(2, 0.01);
    stage.bridge["modules"] = 120.into();
    stage.write();
    let output = run_with(&stage, "r", "prepare.0:1:die");
    assert_eq!(output.status.code(), None, "{}", stderr(&output));
    stage
}

/// Waits for a journal to have as many files, and gives the number of the process that began the last one.
fn process_of_file(stage: &crate::stage::Stage, number: usize) -> String {
    let began = std::time::Instant::now();
    loop {
        let files = std::fs::read_dir(stage.path("r/journal")).unwrap();
        let names: std::collections::BTreeSet<_> = files.map(|file| file.unwrap().file_name()).collect();
        if names.len() >= number {
            let name = names.last().unwrap().to_string_lossy().into_owned();
            return u32::from_str_radix(&name[17..25], 16).unwrap().to_string();
        }
        assert!(began.elapsed() < Duration::from_secs(60));
        std::thread::sleep(Duration::from_millis(2));
    }
}

#[test]
fn a_bridge_whose_process_is_killed_twice_apart_is_marked() {
    let stage = long_suspect();
    let child = begin(&stage, "r", &[]);
    for number in 2..=3 {
        let apart = process_of_file(&stage, number);
        assert_ne!(apart, child.id().to_string());
        // it is at work by then
        std::thread::sleep(Duration::from_millis(400));
        let sent = std::process::Command::new("kill").args(["-KILL", &apart]).status();
        assert!(sent.unwrap().success());
    }
    let output = child.wait_with_output().unwrap();
    let told = stderr(&output);
    assert_eq!(output.status.code(), Some(1), "{told}");
    assert!(
        told.contains("the process died 3 times while it prepared the bridge"),
        "{told}"
    );
    assert_eq!(super::sweep::status(&stage, &["r"])["failed"], 48);
}

#[test]
fn an_interrupt_ends_a_run_that_waits_for_bridges_prepared_apart() {
    let stage = long_suspect();
    let child = begin(&stage, "r", &[]);
    process_of_file(&stage, 2);
    assert_eq!(super::sweep::status(&stage, &["r"])["folders"][0]["state"], "running");
    let asked = std::time::Instant::now();
    let sent = std::process::Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status();
    assert!(sent.unwrap().success());
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130), "{}", stderr(&output));
    assert!(asked.elapsed() < Duration::from_secs(3), "{:?}", asked.elapsed());
    assert!(
        stderr(&output).contains("interrupted: 0 of 48 jobs are recorded"),
        "{}",
        stderr(&output)
    );
    // nothing is known of it yet
    let mut child = begin(&stage, "r", &[]);
    assert_ne!(process_of_file(&stage, 4), child.id().to_string());
    child.kill().unwrap();
    child.wait().unwrap();
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
