//! Tests of runs: batches, sinks, failures.

use super::*;
use pontoon_plan::job::Jobs;
use pontoon_results::{FailureKind, Failures};
use serde_json::{Value, json};
use std::path::Path;
use std::sync::Mutex;

/// A study of crossings on the smoke study's bridge with its jobs.
fn study(design: Value, record: Value) -> (Study, Vec<Job>) {
    let dir = tempfile::tempdir().unwrap();
    let smoke = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies/bridges/smoke.json");
    std::fs::copy(smoke, dir.path().join("b.json")).unwrap();
    let analysis = json!({ "kind": "crossing", "time_step_s": 0.05, "tail_s": 1.0 });
    let study = json!({ "name": "s", "bridge": "b.json", "analysis": analysis, "design": design, "record": record });
    std::fs::write(dir.path().join("study.json"), study.to_string()).unwrap();
    let study = Study::open(dir.path()).unwrap();
    let jobs = Jobs::new(&study).collect::<Result<_, _>>().unwrap();
    (study, jobs)
}

fn seven() -> (Study, Vec<Job>) {
    let grid = json!({ "gap_tension_m": [0.028, 0.0], "speed_m_s": [10, 15, 20], "load_n": 1e5 });
    let linear = json!({ "connection": "linear", "speed_m_s": 10, "load_n": 1e5 });
    study(
        json!([{ "grid": grid }, { "cases": [linear] }]),
        json!({ "histories": { "positions": [2] } }),
    )
}

fn by(threads: usize, most_jobs: usize) -> Setting<'static> {
    let batch = Batch {
        most_jobs,
        ..Batch::default()
    };
    Setting {
        threads,
        batch,
        ..Setting::default()
    }
}

/// The batches that a run hands on.
fn batches(setting: Setting<'_>, (study, jobs): &(Study, Vec<Job>)) -> Vec<Vec<JobRecord>> {
    let mut taken = Vec::new();
    let mut sink = |records| {
        taken.push(records);
        Ok::<(), std::io::Error>(())
    };
    let outcome = run(study, jobs, setting, &CancelToken::default(), &Silent, Some(&mut sink)).unwrap();
    assert_eq!((outcome.jobs, outcome.failures.count), (jobs.len(), 0));
    taken
}

#[test]
fn records_depend_neither_on_batches_nor_on_threads() {
    let of = seven();
    let one = batches(Setting::default(), &of);
    assert_eq!((one.len(), one[0].len()), (1, 7));
    for threads in [1, 3] {
        let several = batches(by(threads, 3), &of);
        assert_eq!(several.iter().map(Vec::len).collect::<Vec<_>>(), [3, 3, 1]);
        assert_eq!(several.concat(), one[0]);
    }
}

/// Tallies told.
#[derive(Default)]
struct RecordedTallies(Mutex<Vec<usize>>);

impl Progress for RecordedTallies {
    fn stage(&self, _: &str) {}
    fn jobs(&self, tally: Tally) {
        self.0.lock().unwrap().push(tally.done);
    }
}

#[test]
fn a_sink_that_fails_ends_the_run() {
    let (study, jobs) = seven();
    for threads in [1, 3] {
        let (told, mut calls) = (RecordedTallies::default(), 0);
        let mut sink = |_| {
            calls += 1;
            if calls == 2 {
                Err(std::io::Error::other("no space"))
            } else {
                Ok(())
            }
        };
        let error = run(
            &study,
            &jobs,
            by(threads, 1),
            &CancelToken::default(),
            &told,
            Some(&mut sink),
        )
        .unwrap_err();
        assert!(
            matches!(&error, RunError::Sink(e) if e.to_string() == "no space"),
            "{error}"
        );
        // the batch that was being solved while the second one was taken is the last
        assert_eq!((calls, told.0.into_inner().unwrap().into_iter().max()), (2, Some(3)));
    }
}

#[test]
fn a_batch_ends_where_its_rows_or_jobs_are_enough() {
    let (study, jobs) = seven();
    let sizes = |most_jobs, most_rows| {
        let batch = Batch { most_jobs, most_rows };
        let cuts = cut::cut(&study, &jobs, batch).map(<[Job]>::len).collect::<Vec<_>>();
        assert_eq!(cuts.iter().sum::<usize>(), jobs.len());
        cuts
    };
    assert_eq!(sizes(5, usize::MAX), [5, 2]);
    assert_eq!(sizes(0, 0), [1; 7]);
    // a job, 4 positions, 2 joints of 3 rows, a history of a row a step
    let rows = |job: &Job| 1 + 4 + 2 * 3 + job.steps();
    let two = rows(&jobs[0]) + rows(&jobs[1]);
    assert_eq!(sizes(7, two)[0], 2);
    assert_eq!(sizes(7, two - 1)[0], 1);
    assert_eq!(cut::cut(&study, &[], Batch::default()).count(), 0);
}

#[test]
fn failures_are_counted_and_the_first_ten_told() {
    let (_, jobs) = seven();
    let mut failures = Failures::default();
    for batch in 0..3 {
        let reason = |job: &Job| Failure::new(FailureKind::NotFinite, format!("{batch} {}", job.number));
        let records: Vec<JobRecord> = jobs.iter().map(|job| JobRecord::failed(job, reason(job))).collect();
        failures.take(&records);
    }
    assert_eq!((failures.count, failures.first.len()), (21, 10));
    assert_eq!(failures.first[9], (2, "1 2".to_owned()));
}
