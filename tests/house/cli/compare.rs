//! Results held against a reference: roles, cases, failed jobs, ends.

use crate::stage::{Stage, is_refused, reference, stderr, stdout};
use serde_json::{Value, json};

fn peak(job: usize, expected: f64) -> Value {
    json!({ "id": "peak", "where": { "job": job }, "value": { "of": column(), "expected": expected, "relative_tolerance": 0.01 } })
}

fn column() -> Value {
    json!({ "select": { "table": "jobs", "column": "peak_deflection_m" } })
}

fn with(check: &Value, key: &str, value: Value) -> Value {
    let mut check = check.clone();
    check[key] = value;
    check
}

/// A run of the smoke study and its peak deflections.
fn ran() -> (Stage, Vec<f64>) {
    let stage = Stage::new();
    stage.ran("r");
    let peaks = stage.numbers("r/jobs.parquet", "peak_deflection_m");
    (stage, peaks.into_iter().flatten().collect())
}

/// A study one of whose two jobs fails: a weight whose forces leave the range of numbers.
fn half_failed() -> Stage {
    let mut stage = Stage::new();
    stage.study["design"] = json!([{ "grid": { "load_n": [1e5, 1e305], "speed_m_s": 10 } }]);
    let output = stage.write().pontoon(&["run", "study.json", "--out", "r", "--quiet"]);
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    stage
}

#[test]
fn roles_decide_what_becomes_of_a_check() {
    let (stage, peaks) = ran();
    for (role, factor, status, verdict) in [
        ("hold", 1.0, 0, "holds"),
        ("hold", 1.05, 1, "falls-short"),
        ("expected-fail", 1.05, 0, "expected-fail"),
        ("expected-fail", 1.0, 0, "now-holds"),
        ("record", 1.0, 0, "record"),
        ("record", 1.05, 0, "record"),
    ] {
        let check = with(&peak(0, factor * peaks[0]), "role", role.into());
        stage.json("reference.json", &reference(&json!([check])));
        let output = stage.pontoon(&["compare", "r", "--with", "reference.json", "--format", "json"]);
        let printed: Value = serde_json::from_str(&stdout(&output)).unwrap();
        assert_eq!(output.status.code(), Some(status), "{role} {factor}");
        assert_eq!(printed["lines"][0]["verdict"], verdict, "{role} {factor}");
        let told = stderr(&output);
        assert_eq!(
            told.contains("changed: 'peak'"),
            verdict == "now-holds",
            "{role} {factor}: {told}"
        );
        assert_eq!(told.is_empty(), verdict != "now-holds", "{told}");
    }
}

#[test]
fn one_check_that_falls_short_among_others_decides_the_status() {
    let (stage, peaks) = ran();
    let checks = json!([peak(0, peaks[0]), with(&peak(1, 1.05 * peaks[1]), "id", "other".into())]);
    let (code, lines) = stage.held("r", &checks);
    assert_eq!(code, Some(1));
    assert_eq!(
        (&lines[0]["verdict"], &lines[1]["verdict"]),
        (&json!("holds"), &json!("falls-short"))
    );
}

#[test]
fn the_worst_case_decides_for_each() {
    let (stage, peaks) = ran();
    let worst_peak = |f: f64| f * peaks[3];
    let check = |at_most: f64| {
        json!([{ "id": "a", "each": ["connection", "speed_m_s"], "where": { "gap_tension_m": [null, 0.028] },
                 "bound": { "of": column(), "at_most": at_most } }])
    };
    let (code, lines) = stage.held("r", &check(worst_peak(1.01)));
    assert_eq!((code, lines[0]["cases"].as_array().unwrap().len()), (Some(0), 4));
    let (code, lines) = stage.held("r", &check(worst_peak(0.95)));
    assert_eq!(code, Some(1));
    let worst = &lines[0]["worst"];
    assert_eq!(worst["case"], json!({ "connection": "nonlinear", "speed_m_s": 10.0 }));
    assert_eq!(worst["values"], json!([peaks[3]]));
    let holding = lines[0]["cases"]
        .as_array()
        .unwrap()
        .iter()
        .filter(|case| case["holds"] == true);
    assert_eq!(holding.count(), 3);
    let text = stdout(&stage.pontoon(&["compare", "r", "--with", "reference.json"]));
    assert!(
        text.contains("worst of 4: connection nonlinear, speed_m_s 10"),
        "{text}"
    );
}

#[test]
fn the_worst_of_a_record_is_the_farthest_off() {
    let (stage, peaks) = ran();
    let record =
        json!([{ "id": "a", "role": "record", "each": ["job"], "value": { "of": column(), "expected": peaks[0] } }]);
    let (code, lines) = stage.held("r", &record);
    assert_eq!((code, &lines[0]["worst"]["case"]), (Some(0), &json!({ "job": 3.0 })));
}

#[test]
fn an_expected_failure_holds_now_only_where_every_case_does() {
    let (stage, peaks) = ran();
    let check = |at_most: f64| json!([{ "id": "a", "role": "expected-fail", "each": ["job"], "bound": { "of": column(), "at_most": at_most } }]);
    for (at_most, verdict) in [(0.95 * peaks[3], "expected-fail"), (1.05 * peaks[3], "now-holds")] {
        let (code, lines) = stage.held("r", &check(at_most));
        assert_eq!((code, &lines[0]["verdict"]), (Some(0), &json!(verdict)));
    }
}

#[test]
fn a_check_without_a_row_falls_short_whatever_its_role() {
    let (stage, _) = ran();
    for role in ["hold", "expected-fail", "record"] {
        for (filter, each, reason) in [
            (json!({ "speed_m_s": 99 }), json!([]), "no job matches"),
            (json!({ "speed_m_s": 99 }), json!(["load_n"]), "no job matches"),
            (
                json!({ "position": { "from": 9 } }),
                json!([]),
                "no row of positions matches",
            ),
        ] {
            let of = json!({ "select": { "table": "positions", "column": "peak_deflection_m", "reduce": "count" } });
            let check = json!([{ "id": "a", "role": role, "where": filter, "each": each,
                                 "value": { "of": of, "expected": 0, "absolute_tolerance": 100 } }]);
            let (code, lines) = stage.held("r", &check);
            assert_eq!((code, &lines[0]["verdict"]), (Some(1), &json!("falls-short")), "{role}");
            assert_eq!(lines[0]["worst"]["reason"], reason);
        }
    }
}

#[test]
fn failed_jobs_are_never_passed_over_in_silence() {
    let stage = half_failed();
    for role in ["hold", "expected-fail", "record"] {
        for check in [
            json!({ "where": { "load_n": 1e305 }, "bound": { "of": column(), "at_least": 0 } }),
            json!({ "each": ["load_n"], "bound": { "of": column(), "at_least": 0 } }),
            json!({ "trend": { "of": column(), "along": "load_n", "trend": "positive" } }),
            json!({ "where": { "job": 1 }, "curve": { "table": "positions", "column": "peak_deflection_m",
                    "against": "x_m", "points": [[0, 0]], "absolute_tolerance": 9 } }),
        ] {
            let check = with(&with(&check, "id", "a".into()), "role", role.into());
            let (code, lines) = stage.held("r", &json!([check]));
            assert_eq!(
                (code, &lines[0]["verdict"]),
                (Some(1), &json!("falls-short")),
                "{check}"
            );
            let text = stdout(&stage.pontoon(&["compare", "r", "--with", "reference.json"]));
            assert!(text.contains("only failed jobs match, 1 of them"), "{role}: {text}");
        }
    }
    let of = json!({ "select": { "table": "jobs", "column": "peak_deflection_m", "reduce": "max" } });
    // the largest of some jobs is not known where one of them failed
    let (code, lines) = stage.held("r", &json!([{ "id": "a", "bound": { "of": of, "at_least": 0 } }]));
    assert_eq!(
        (code, &lines[0]["worst"]["reason"]),
        (Some(1), &json!("1 failed job among those that match"))
    );
    let of = json!({ "select": { "table": "jobs", "column": "peak_deflection_m" } });
    let (code, lines) = stage.held("r", &json!([{ "id": "a", "bound": { "of": of, "at_least": 0 } }]));
    assert_eq!(
        (code, &lines[0]["worst"]["reason"]),
        (Some(0), &json!("1 failed job left out"))
    );
}

#[test]
fn a_run_holds_its_results_in_one_go() {
    let (stage, peaks) = ran();
    for (name, factor, status) in [("good.json", 1.0, 0), ("bad.json", 1.05, 1)] {
        stage.json(name, &reference(&json!([peak(0, factor * peaks[0])])));
        let words = ["run", "study.json", "--out", name, "--with", name, "--quiet"];
        let words = words.map(|word| {
            if word == name {
                word.trim_end_matches(".json")
            } else {
                word
            }
        });
        let with = [&words[..5], &[name, "--quiet"]].concat();
        let output = stage.pontoon(&with);
        assert_eq!(output.status.code(), Some(status), "{}", stderr(&output));
        let text = stdout(&output);
        assert!(
            text.contains("jobs 6, failed 0") && text.contains("smoke against expected: "),
            "{text}"
        );
        let output = stage.pontoon(&[&with[..], &["--format", "json"]].concat());
        let printed: Value = serde_json::from_str(&stdout(&output)).unwrap();
        assert_eq!(printed["comparison"]["good"], json!(status == 0));
        assert_eq!(printed["jobs"], 6);
        let output = stage.pontoon(&[&with[..], &["--format", "markdown"]].concat());
        assert!(
            stdout(&output).starts_with("### smoke against expected\n"),
            "{}",
            stdout(&output)
        );
    }
}

#[test]
fn a_run_refuses_the_reference_of_another_study_before_it_runs() {
    let stage = Stage::new();
    stage.write();
    let mut other = stage.study.clone();
    other["name"] = "other".into();
    stage.json("other.json", &other);
    let mut document = reference(&json!([peak(0, 1.0)]));
    document["study"] = "other.json".into();
    stage.json("reference.json", &document);
    let before = stage.names();
    let words = ["run", "study.json", "--out", "r", "--with", "reference.json"];
    is_refused(
        &stage.pontoon(&words),
        &["study.json: ", "to which reference.json belongs", "'other'", "'smoke'"],
    );
    document["checks"][0]["value"]["expected"] = "x".into();
    stage.json("reference.json", &document);
    is_refused(&stage.pontoon(&words), &["reference.json: checks[0].value.expected: "]);
    assert_eq!(stage.names(), before);
}

#[test]
fn a_reference_is_a_file_or_the_folder_that_holds_it() {
    let (stage, peaks) = ran();
    std::fs::create_dir(stage.path("held")).unwrap();
    let mut document = reference(&json!([peak(0, peaks[0])]));
    document["study"] = "../study.json".into();
    stage.json("held/reference.json", &document);
    for with in ["held", "held/reference.json"] {
        assert_eq!(stage.compared("r", with).0, Some(0), "{with}");
    }
}
