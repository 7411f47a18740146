//! A comparison as text, JSON, Markdown and JUnit XML.

use crate::stage::{Stage, reference, stderr, stdout};
use quick_junit::{NonSuccessKind, Report, TestCaseStatus};
use serde_json::{Value, json};

/// Three checks, one of each end, with ids that every format has to keep from doing harm.
const IDS: [&str; 4] = [
    "holds | \"a\" <b> & 'c'",
    "short\\|\n]]> \u{7}",
    "fails as expected",
    "kept",
];

fn compared() -> Stage {
    let stage = Stage::new();
    stage.ran("r");
    let peak = stage.numbers("r/jobs.parquet", "peak_deflection_m")[0].unwrap();
    let check = |i: usize, role: &str, factor: f64| {
        json!({ "id": IDS[i], "role": role, "where": { "job": 0 }, "value": {
            "of": { "select": { "table": "jobs", "column": "peak_deflection_m" } },
            "expected": factor * peak, "relative_tolerance": 0.01 } })
    };
    let checks = json!([
        check(0, "hold", 1.0),
        check(1, "hold", 1.05),
        check(2, "expected-fail", 1.05),
        check(3, "record", 2.0),
    ]);
    stage.json("reference.json", &reference(&checks));
    stage
}

fn written(stage: &Stage, format: &str) -> String {
    let output = stage.pontoon(&["compare", "r", "--with", "reference.json", "--format", format]);
    assert_eq!(
        (output.status.code(), stderr(&output).as_str()),
        (Some(1), ""),
        "{format}"
    );
    stdout(&output)
}

#[test]
fn text_is_a_line_a_check_and_the_counts() {
    let text = written(&compared(), "text");
    for word in ["check ", "holds", "FALLS SHORT", "fails as expected", "record"] {
        assert!(text.contains(word), "{word}: {text}");
    }
    assert!(
        text.ends_with("smoke against expected: 1 hold, 1 fall short, 1 fail as expected, 0 changed, 1 recorded\n"),
        "{text}"
    );
}

#[test]
fn text_keeps_a_check_on_its_line() {
    let text = written(&compared(), "text");
    assert_eq!(text.lines().count(), 1 + 4 + 2, "{text}");
    assert!(!text.contains('\u{7}'), "{text:?}");
}

#[test]
fn json_holds_every_line_whole() {
    let object: Value = serde_json::from_str(&written(&compared(), "json")).unwrap();
    assert_eq!(
        (&object["results"], &object["with"], &object["good"]),
        (&json!("smoke"), &json!("expected"), &json!(false))
    );
    let ids: Vec<&str> = object["lines"]
        .as_array()
        .unwrap()
        .iter()
        .map(|l| l["id"].as_str().unwrap())
        .collect();
    assert_eq!(ids, IDS);
    let keys = [
        "statement",
        "role",
        "expected",
        "expected_value",
        "verdict",
        "worst",
        "cases",
    ];
    assert!(
        keys.iter().all(|key| object["lines"][0].get(*key).is_some()),
        "{object}"
    );
}

#[test]
fn markdown_cells_hold_what_would_end_them() {
    let text = written(&compared(), "markdown");
    let rows: Vec<&str> = text.lines().filter(|line| line.starts_with('|')).collect();
    assert_eq!(rows.len(), 2 + 4, "{text}");
    for row in rows {
        let escaped_gone = row.replace("\\\\", "").replace("\\|", "");
        assert_eq!(escaped_gone.matches('|').count(), 8, "{row}");
        assert!(!row.contains("<b>"), "{row}");
    }
    assert!(text.contains("holds \\| \"a\" &lt;b> & 'c'"), "{text}");
}

#[test]
fn junit_is_well_formed_and_has_a_case_a_check() {
    let text = written(&compared(), "junit");
    let report = Report::deserialize_from_str(&text).unwrap_or_else(|e| panic!("{e}: {text}"));
    assert_eq!((report.tests, report.failures, report.errors), (4, 1, 0));
    let suite = &report.test_suites[0];
    assert_eq!(suite.name.as_str(), "smoke");
    let cases: Vec<_> = suite.test_cases.iter().map(|case| &case.status).collect();
    assert!(matches!(cases[0], TestCaseStatus::Success { .. }));
    assert!(matches!(
        cases[1],
        TestCaseStatus::NonSuccess {
            kind: NonSuccessKind::Failure,
            message: Some(_),
            ..
        }
    ));
    assert!(
        cases[2..]
            .iter()
            .all(|status| matches!(status, TestCaseStatus::Skipped { .. })),
        "{text}"
    );
    assert_eq!(suite.test_cases[0].name.as_str(), IDS[0]);
    assert!(!text.contains('\u{7}'));
}

#[test]
fn formats_of_a_comparison_are_refused_where_there_is_none() {
    let stage = Stage::new();
    stage.write();
    let before = stage.names();
    for words in [
        &["run", "study.json", "--out", "r"][..],
        &["plan", "study.json"],
        &["modes", "bridge.json"],
        &["schema", "study"],
        &[
            "calibrate",
            "bridge.json",
            "--with",
            "r.json",
            "--parameters",
            "p.json",
            "--out",
            "o.json",
        ],
    ] {
        for format in ["markdown", "junit"] {
            let output = stage.pontoon(&[words, &["--format", format]].concat());
            assert_eq!(output.status.code(), Some(2), "{words:?} {format}");
            assert!(stderr(&output).contains("text or json"), "{}", stderr(&output));
            assert_eq!(stdout(&output), "");
        }
    }
    assert_eq!(stage.names(), before);
}
