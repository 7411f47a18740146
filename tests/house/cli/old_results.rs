//! New results held against older ones, job by job.

use crate::stage::{Stage, is_refused, stderr, stdout};
use serde_json::{Value, json};

/// The smoke study run into `old`.
fn stage() -> Stage {
    let stage = Stage::new();
    stage.ran("old");
    stage
}

/// A line of a comparison by its id.
fn line<'a>(lines: &'a [Value], id: &str) -> &'a Value {
    lines
        .iter()
        .find(|line| line["id"] == id)
        .unwrap_or_else(|| panic!("no line {id}"))
}

fn fall_short(lines: &[Value]) -> Vec<&str> {
    let short = lines.iter().filter(|line| line["verdict"] == "falls-short");
    short.filter_map(|line| line["id"].as_str()).collect()
}

fn with_tolerance(stage: &Stage, tolerance: &Value) -> (Option<i32>, Vec<Value>) {
    stage.json("tolerance.json", tolerance);
    let words = [
        "compare",
        "new",
        "--with",
        "old",
        "--tolerance",
        "tolerance.json",
        "--format",
        "json",
    ];
    let output = stage.pontoon(&words);
    let printed: Value = serde_json::from_str(&stdout(&output)).unwrap_or_else(|_| panic!("{}", stderr(&output)));
    (output.status.code(), printed["lines"].as_array().unwrap().clone())
}

#[test]
fn the_same_results_hold() {
    let stage = stage();
    stage.ran("new");
    for new in ["new", "old"] {
        let (code, lines) = stage.compared(new, "old");
        assert_eq!((code, fall_short(&lines)), (Some(0), vec![]));
        for id in [
            "jobs",
            "jobs.peak_deflection_m",
            "positions.peak_uplift_m",
            "connectors.peak_tension_n",
            "histories.value",
        ] {
            assert_eq!(line(&lines, id)["verdict"], "holds", "{id}");
        }
        // axes and what tells rows apart are no numbers to compare
        assert!(
            lines
                .iter()
                .all(|line| line["id"] != "jobs.speed_m_s" && line["id"] != "positions.position")
        );
    }
}

#[test]
fn another_bridge_falls_short_with_the_axes_of_the_worst_job() {
    let mut stage = stage();
    stage.bridge["connectors"]["stiffness_n_m"] = json!(2.4e7);
    stage.ran("new");
    let (code, lines) = stage.compared("new", "old");
    assert_eq!(code, Some(1));
    let short = fall_short(&lines);
    assert!(
        short.contains(&"jobs.peak_deflection_m") && short.contains(&"histories.value"),
        "{short:?}"
    );
    assert!(!short.contains(&"jobs"), "{short:?}");
    let case = &line(&lines, "positions.peak_deflection_m")["worst"]["case"];
    for key in ["connection", "speed_m_s", "load_n", "position"] {
        assert!(case.get(key).is_some(), "{key}: {case}");
    }
    let text = stdout(&stage.pontoon(&["compare", "new", "--with", "old"]));
    let told = text
        .lines()
        .find(|line| line.contains(" jobs.peak_deflection_m "))
        .unwrap();
    assert!(
        told.starts_with("FALLS SHORT  jobs.") && told.contains("connection ") && told.contains("speed_m_s "),
        "{told}"
    );
}

#[test]
fn tolerances_of_all_and_of_single_columns_decide() {
    let mut stage = stage();
    stage.bridge["connectors"]["stiffness_n_m"] = json!(2.4e7);
    stage.ran("new");
    let off = |lines: &[Value], id: &str| line(lines, id)["worst"]["deviation"].as_f64().unwrap().abs();
    let (_, lines) = stage.compared("new", "old");
    let far = off(&lines, "jobs.peak_deflection_m");
    assert!(far > 1e-6, "{far}");
    let wide = json!({ "relative_tolerance": 1e9, "absolute_tolerance": 1e9 });
    // everything within a wide default, all but one column
    for (factor, status) in [(1.01, 0), (0.95, 1)] {
        for name in ["jobs.peak_deflection_m", "peak_deflection_m"] {
            let ignored = json!({ "ignore": true });
            let mut columns = json!({ name: { "relative_tolerance": factor * far } });
            if name == "peak_deflection_m" {
                columns["positions.peak_deflection_m"] = ignored;
            }
            let (code, lines) = with_tolerance(&stage, &json!({ "default": wide, "columns": columns }));
            let expected: Vec<&str> = if status == 0 {
                vec![]
            } else {
                vec!["jobs.peak_deflection_m"]
            };
            assert_eq!((code, fall_short(&lines)), (Some(status), expected), "{name} {factor}");
        }
    }
    let (code, lines) = with_tolerance(&stage, &json!({ "default": { "ignore": true } }));
    assert_eq!((code, lines.len()), (Some(0), 1), "only the jobs are left");
    let (code, lines) = with_tolerance(
        &stage,
        &json!({ "columns": { "positions.peak_deflection_m": { "ignore": true } } }),
    );
    assert_eq!(code, Some(1));
    assert!(lines.iter().all(|line| line["id"] != "positions.peak_deflection_m"));
}

#[test]
fn tolerances_that_are_none_are_refused() {
    let stage = stage();
    for (tolerance, parts) in [
        (
            json!({ "columns": { "peak_deflecton_m": { "ignore": true } } }),
            &["columns.peak_deflecton_m: ", "nearest known: "][..],
        ),
        (
            json!({ "columns": { "jobs.x_m": { "relative_tolerance": 1 } } }),
            &["columns.jobs.x_m: "],
        ),
        (
            json!({ "columns": { "steps": { "relative_tolerance": -1 } } }),
            &["columns.steps.relative_tolerance: found -1"],
        ),
        (
            json!({ "default": { "absolute_tolerance": -1e-9 } }),
            &["default.absolute_tolerance: "],
        ),
        (
            json!({ "columns": { "steps": {} } }),
            &["columns.steps: found no tolerance"],
        ),
        (json!({ "default": {} }), &["default: found no tolerance"]),
        (
            json!({ "defualt": { "ignore": true } }),
            &["defualt: ", "nearest known: default"],
        ),
        (
            json!({ "columns": { "steps": { "tolerance": 1 } } }),
            &["columns.steps.tolerance: "],
        ),
        (json!({ "columns": [] }), &["columns: "]),
        (
            json!({ "default": { "relative_tolerance": "x" } }),
            &["default.relative_tolerance: found \"x\""],
        ),
    ] {
        stage.json("tolerance.json", &tolerance);
        let output = stage.pontoon(&["compare", "old", "--with", "old", "--tolerance", "tolerance.json"]);
        is_refused(&output, &[&["tolerance.json: "], parts].concat());
    }
    let output = stage.pontoon(&["compare", "old", "--with", "old", "--tolerance", "gone.json"]);
    is_refused(&output, &["gone.json: found no readable file"]);
}

#[test]
fn jobs_that_are_gone_fall_short_and_new_ones_do_not() {
    let mut stage = stage();
    let speeds = |stage: &mut Stage, speeds: Value| stage.study["design"][0]["grid"]["speed_m_s"] = speeds;
    speeds(&mut stage, json!([5, 10, 12]));
    stage.ran("more");
    let (code, lines) = stage.compared("more", "old");
    assert_eq!((code, fall_short(&lines)), (Some(0), vec![]));
    assert_eq!(
        line(&lines, "jobs")["worst"]["reason"],
        "3 of the new jobs without an old one"
    );
    speeds(&mut stage, json!([5, 12]));
    stage.ran("other");
    let (code, lines) = stage.compared("other", "old");
    assert_eq!((code, fall_short(&lines)), (Some(1), vec!["jobs"]));
    let worst = &line(&lines, "jobs")["worst"];
    assert_eq!(
        worst["reason"],
        "3 of the old jobs without a new one, 3 of the new jobs without an old one"
    );
    assert_eq!(
        (&worst["case"]["speed_m_s"], &worst["case"]["connection"]),
        (&json!(10.0), &json!("linear"))
    );
}

#[test]
fn a_job_that_fails_now_falls_short_and_one_that_failed_then_does_not() {
    let mut stage = Stage::new();
    let mut ran = |name: &str, limit: usize, status: i32| {
        // with a single iteration the joints of the nonlinear bridge do not settle
        stage.study["analysis"]["newton_limit"] = json!(limit);
        stage.study["analysis"]["bisection_limit"] = json!(0);
        let output = stage.write().pontoon(&["run", "study.json", "--out", name, "--quiet"]);
        assert_eq!(output.status.code(), Some(status), "{}", stderr(&output));
    };
    ran("whole", 30, 0);
    ran("broken", 1, 1);
    let failed = stage.table("broken/jobs.parquet").column("reason").unwrap().len()
        - stage
            .table("broken/jobs.parquet")
            .column("reason")
            .unwrap()
            .null_count();
    assert!(failed > 0 && failed < 6, "{failed}");
    let (code, lines) = stage.compared("broken", "whole");
    assert_eq!((code, fall_short(&lines)[0]), (Some(1), "jobs"));
    let worst = &line(&lines, "jobs")["worst"];
    assert_eq!(
        worst["reason"],
        format!("{failed} of the jobs fail now and did not then")
    );
    assert_eq!(worst["case"]["connection"], "nonlinear");
    let (code, lines) = stage.compared("whole", "broken");
    assert_eq!((code, fall_short(&lines)), (Some(0), vec![]));
    let (code, lines) = stage.compared("broken", "broken");
    assert_eq!((code, fall_short(&lines)), (Some(0), vec![]));
}

#[test]
fn jobs_are_matched_by_their_axes_and_not_by_their_order() {
    let mut stage = stage();
    stage.study["design"][0]["grid"]["speed_m_s"] = json!([10, 5]);
    stage.study["design"][0]["grid"]["connection"] = json!(["nonlinear", "linear"]);
    stage.ran("new");
    let peaks = |out: &str| stage.numbers(&format!("{out}/jobs.parquet"), "peak_deflection_m");
    assert_ne!(peaks("new"), peaks("old"));
    let (code, lines) = stage.compared("new", "old");
    assert_eq!((code, fall_short(&lines)), (Some(0), vec![]));
}

#[test]
fn results_of_other_axes_are_refused() {
    let mut stage = stage();
    stage.study["design"][0]["grid"]["bridge.connectors.stiffness_n_m"] = json!([2.37e7]);
    stage.ran("new");
    for (new, old) in [("new", "old"), ("old", "new")] {
        let output = stage.pontoon(&["compare", new, "--with", old]);
        is_refused(
            &output,
            &[
                "the axis 'bridge.connectors.stiffness_n_m'",
                "which only one of both results has",
            ],
        );
    }
}

#[test]
fn rows_and_tables_that_are_gone_fall_short_and_say_so() {
    let mut stage = stage();
    stage.study["record"] = json!({ "connectors": false, "histories": { "positions": [2] } });
    stage.ran("new");
    let (code, lines) = stage.compared("new", "old");
    assert_eq!(
        (code, fall_short(&lines)),
        (Some(1), vec!["connectors", "histories.value"])
    );
    assert_eq!(
        line(&lines, "connectors")["worst"]["reason"],
        "the new results do not hold this table"
    );
    let worst = &line(&lines, "histories.value")["worst"];
    assert!(
        worst["reason"]
            .as_str()
            .unwrap()
            .ends_with("of the rows are no longer there"),
        "{worst}"
    );
    assert_eq!(
        (&worst["case"]["quantity"], &worst["case"]["position"]),
        (&json!("force_n"), &json!(2.0))
    );
    let (code, _) = stage.compared("old", "new");
    assert_eq!(code, Some(0), "more tables and rows than before are no harm");
}

#[test]
fn a_flag_that_turns_is_a_difference() {
    let mut stage = Stage::new();
    stage.study["design"][0]["grid"]["load_n"] = json!(300_000);
    let mut ran = |name: &str, draft: f64| {
        stage.bridge["draft_m"] = json!(draft);
        stage.bridge["freeboard_m"] = json!(1.07 - draft);
        stage.ran(name);
    };
    ran("wet", 0.18);
    ran("dry", 0.06);
    let (code, lines) = stage.compared("dry", "wet");
    assert_eq!((code, fall_short(&lines)), (Some(1), vec!["jobs.bottom_emerged"]));
}
