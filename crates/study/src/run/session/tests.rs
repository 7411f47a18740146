//! Tests of sessions: what is kept, and that it changes no record.

use super::super::{CancelToken, Setting, Silent, Why, run};
use super::*;
use pontoon_plan::input::Document;
use pontoon_plan::job::Jobs;
use pontoon_plan::study_file::{BridgeFile, bridge_of, read_bridge};
use pontoon_results::FailureKind;
use serde_json::{Value, json};
use std::path::Path;

fn smoke() -> BridgeFile {
    read_bridge(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies/bridges/smoke.json")).unwrap()
}

/// The smoke bridge with connectors of another stiffness.
fn with_stiffness(stiffness_n_m: f64) -> BridgeFile {
    let mut document = smoke().document.value();
    document["connectors"]["stiffness_n_m"] = stiffness_n_m.into();
    bridge_of(Path::new("b"), Document::from(&document)).unwrap()
}

fn study(bridge: &BridgeFile, grid: &Value) -> (Study, Vec<Job>) {
    let analysis = json!({ "kind": "crossing", "time_step_s": 0.05, "step_limit": 200 });
    let spec = json!({ "name": "s", "bridge": "", "analysis": analysis, "design": [{ "grid": grid }] });
    let study = Study::of_values(Path::new("s"), Document::from(&spec), bridge).unwrap();
    let jobs = Jobs::new(&study).collect::<Result<_, _>>().unwrap();
    (study, jobs)
}

fn by(static_peaks: bool) -> SessionSetting {
    SessionSetting {
        threads: 2,
        static_peaks,
    }
}

fn solved(session: &SolveSession, (study, jobs): &(Study, Vec<Job>), setting: SessionSetting) -> Vec<JobRecord> {
    let mut all = Vec::new();
    let seconds = session.solve(
        study,
        jobs,
        setting,
        (&CancelToken::default(), &Silent),
        |_, records| {
            all.extend(records);
        },
    );
    assert!(seconds.unwrap() > 0.0);
    all
}

#[test]
fn a_session_leaves_the_records_of_a_run_whatever_was_asked_before() {
    // 1 m/s takes too many steps and fails
    let grid = json!({ "speed_m_s": [1, 8, 12], "load_n": [1e5, 2e5], "gap_tension_m": [0, 0.02] });
    let of = study(&smoke(), &grid);
    let mut expected = Vec::new();
    let mut sink = |records: Vec<JobRecord>| {
        expected.extend(records);
        Ok::<(), std::io::Error>(())
    };
    run(
        &of.0,
        &of.1,
        Setting::default(),
        &CancelToken::default(),
        &Silent,
        Some(&mut sink),
    )
    .unwrap();
    assert_eq!(expected.iter().filter(|record| record.failure.is_some()).count(), 4);
    let session = SolveSession::new(None);
    assert_eq!(solved(&session, &of, by(true)), expected);
    let other = study(&with_stiffness(2e8), &grid);
    assert_ne!(solved(&session, &other, by(true)), expected);
    assert_eq!(solved(&session, &of, by(true)), expected);
}

#[test]
fn a_session_prepares_once_what_studies_share() {
    let session = SolveSession::new(None);
    let of = study(&smoke(), &json!({ "speed_m_s": 8, "load_n": 1e5 }));
    let condensed = |of: &(Study, Vec<Job>)| {
        let jobs: Vec<&Job> = of.1.iter().collect();
        session
            .prepare(&jobs, &session.kept(), true, (&CancelToken::default(), &Silent))
            .condensations()
    };
    assert_eq!((condensed(&of), condensed(&of)), (1, 0));
    // the connectors' stiffness is no part of a module
    assert_eq!(
        condensed(&study(&with_stiffness(2e8), &json!({ "speed_m_s": 9, "load_n": 1e5 }))),
        0
    );
}

#[test]
fn a_session_keeps_a_bounded_number_of_bridges() {
    let session = SolveSession::new(None);
    let kept = || session.kept.lock().unwrap().large_parts();
    let mut most = 0;
    for number in 0..30 {
        let of = study(
            &with_stiffness(1e8 + f64::from(number)),
            &json!({ "speed_m_s": 20, "load_n": 1e5 }),
        );
        solved(&session, &of, by(false));
        most = most.max(kept());
    }
    assert!((MOST_KEPT / 2..=MOST_KEPT).contains(&most), "{most}");
}

#[test]
fn static_peaks_that_nobody_asks_for_are_left_out_and_change_nothing_else() {
    let session = SolveSession::new(None);
    let of = study(&smoke(), &json!({ "speed_m_s": [8, 12], "load_n": 1e5 }));
    let (with, without) = (solved(&session, &of, by(true)), solved(&session, &of, by(false)));
    for (mut with, without) in with.into_iter().zip(without) {
        assert!(with.summary.static_peak_deflection_m.is_some_and(|peak| peak > 0.0));
        assert!(with.summary.dynamic_amplification.is_some());
        with.summary.static_peak_deflection_m = None;
        with.summary.dynamic_amplification = None;
        for row in &mut with.positions {
            row.static_peak_deflection_m = None;
        }
        assert_eq!(with, without);
    }
}

#[test]
fn a_crossing_for_which_all_is_there_takes_no_preparation_and_has_the_same_record() {
    let session = SolveSession::new(None);
    let grid = |speed: Value, gap_m: f64| json!({ "speed_m_s": speed, "gap_tension_m": gap_m, "load_n": 1e5 });
    let of = |speed: f64, gap_m: f64| study(&smoke(), &grid(speed.into(), gap_m));
    assert!(!session.kept().suffice(&of(8.0, 0.0).1[0]));
    let both = study(&smoke(), &grid(json!([8, 12]), 0.0));
    let expected = solved(&session, &both, by(false));
    let kept = session.kept();
    for (speed, place) in [(12.0, 1), (8.0, 0), (12.0, 1)] {
        let one = of(speed, 0.0);
        assert!(kept.suffice(&one.1[0]));
        let mut records = solved(&session, &one, by(false));
        records[0].job = place;
        assert_eq!(records, expected[place..=place]);
    }
    // nothing new is kept
    assert!(Arc::ptr_eq(&kept, &session.kept()));
    // gaps are no part of what is kept; another bridge is, and so is the step
    assert!(kept.suffice(&of(9.0, 0.02).1[0]));
    assert!(!kept.suffice(&study(&with_stiffness(2e8), &grid(8.into(), 0.0)).1[0]));
    for (path, value) in [
        ("analysis.time_step_s", json!("auto")),
        ("analysis.verify.share", json!(1.0)),
        ("analysis.solver", json!("reference")),
    ] {
        let mut axes = grid(8.into(), 0.0);
        axes[path] = value;
        assert!(!kept.suffice(&study(&smoke(), &axes).1[0]), "{path}");
    }
    // too many steps are a failure here too
    let failed = solved(&session, &of(1.0, 0.0), by(false)).remove(0).failure.unwrap();
    assert_eq!(failed.kind, FailureKind::TooManySteps);
    let stop = CancelToken::default();
    stop.ask(Why::Interrupted);
    let (study, jobs) = of(8.0, 0.0);
    let stopped = session.solve(&study, &jobs, by(false), (&stop, &Silent), |_, _| panic!("records"));
    assert!(matches!(stopped, Err(SessionError::Stopped { tally }) if tally.done == 0 && tally.total == 1));
}

#[test]
fn a_session_that_is_stopped_hands_on_no_half_of_a_batch_and_goes_on() {
    let session = SolveSession::new(None);
    let of = study(&smoke(), &json!({ "speed_m_s": [8, 12], "load_n": 1e5 }));
    let stop = CancelToken::default();
    stop.ask(Why::Interrupted);
    let stopped = session.solve(&of.0, &of.1, by(true), (&stop, &Silent), |_, _| panic!("records"));
    assert!(matches!(stopped, Err(SessionError::Stopped { tally }) if tally.done == 0 && tally.total == 2));
    assert_eq!(solved(&session, &of, by(true)).len(), 2);
}
