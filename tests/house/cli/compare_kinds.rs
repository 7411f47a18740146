//! Each kind of check on the tables that a run wrote: it holds with what stands there and falls short 5 % off.

use crate::stage::{Stage, reference, stderr};
use serde_json::{Value, json};

const NONLINEAR: usize = 3;

/// The smoke study run: job 3 is nonlinear, gaps 28 / 5.5 mm, 10 m/s; job 2 the same at 5 m/s.
struct Run {
    stage: Stage,
    /// Its peak deflection.
    peak: f64,
    /// That of job 2.
    slow: f64,
}

impl Run {
    fn new() -> Self {
        let stage = Stage::new();
        stage.ran("r");
        let peaks = stage.numbers("r/jobs.parquet", "peak_deflection_m");
        let (peak, slow) = (peaks[NONLINEAR].unwrap(), peaks[NONLINEAR - 1].unwrap());
        Self { stage, peak, slow }
    }

    /// Makes a check with the factors of its twins on what it expects: 1 holds, 1.05 falls short.
    fn twins(&self, name: &str, check: impl Fn(f64) -> Value) {
        twins(&self.stage, "r", name, check);
    }
}

fn twins(stage: &Stage, results: &str, name: &str, check: impl Fn(f64) -> Value) {
    for (factor, status, verdict) in [(1.0, 0, "holds"), (1.05, 1, "falls-short")] {
        let mut made = check(factor);
        made["id"] = name.into();
        let (code, lines) = stage.held(results, &json!([made]));
        assert_eq!(code, Some(status), "{name}, {factor}: {lines:?}");
        assert_eq!(lines[0]["verdict"], verdict, "{name}, {factor}: {lines:?}");
    }
}

fn of(job: usize) -> Value {
    json!({ "select": { "table": "jobs", "column": "peak_deflection_m", "where": { "job": job } } })
}

fn value(of: &Value, expected: f64) -> Value {
    json!({ "value": { "of": of, "expected": expected, "relative_tolerance": 0.01 } })
}

#[test]
fn values_hold_within_relative_and_absolute_tolerances() {
    let run = Run::new();
    run.twins("relative", |f| value(&of(NONLINEAR), f * run.peak));
    run.twins("absolute", |f| {
        json!({ "value": { "of": of(NONLINEAR), "expected": f * run.peak, "absolute_tolerance": 0.01 * run.peak } })
    });
    run.twins("the wider of both", |f| {
        json!({ "value": { "of": of(NONLINEAR), "expected": f * run.peak, "relative_tolerance": 1e-30,
                           "absolute_tolerance": 0.01 * run.peak } })
    });
    run.twins(
        "measured",
        |f| json!({ "measured": { "of": of(NONLINEAR), "value": f * run.peak, "uncertainty": 0.01 * run.peak } }),
    );
    let (_, lines) = run.stage.held(
        "r",
        &json!([{ "id": "a", "value": value(&of(NONLINEAR), run.peak / 1.005)["value"] }]),
    );
    let worst = &lines[0]["worst"];
    assert!((worst["deviation"].as_f64().unwrap() - 0.005).abs() < 1e-9, "{worst}");
    assert!((worst["margin"].as_f64().unwrap() - 0.005).abs() < 1e-9, "{worst}");
    assert_eq!(worst["values"], json!([run.peak]));
}

#[test]
fn quantities_are_made_of_one_another() {
    let run = Run::new();
    let (fast, slow) = (of(NONLINEAR), of(NONLINEAR - 1));
    for (name, quantity, expected) in [
        ("ratio", json!({ "ratio": [fast, slow] }), run.peak / run.slow),
        ("difference", json!({ "difference": [fast, slow] }), run.peak - run.slow),
        (
            "largest",
            json!({ "largest": [slow, { "number": 0 }, fast] }),
            run.peak.max(run.slow),
        ),
        (
            "smallest",
            json!({ "smallest": [slow, { "number": 7 }, fast] }),
            run.peak.min(run.slow),
        ),
        (
            "number",
            json!({ "difference": [{ "number": -2 }, fast] }),
            -2.0 - run.peak,
        ),
        (
            "nested",
            json!({ "ratio": [{ "difference": [fast, { "number": 1 }] }, { "largest": [slow] }] }),
            (run.peak - 1.0) / run.slow,
        ),
    ] {
        run.twins(name, |f| value(&quantity, f * expected));
    }
}

#[test]
fn rows_are_reduced_to_their_largest_smallest_mean_and_count() {
    let run = Run::new();
    let jobs = run.stage.numbers("r/positions.parquet", "job");
    let all = run.stage.numbers("r/positions.parquet", "peak_deflection_m");
    let of_job = jobs.iter().zip(all).filter(|(job, _)| **job == Some(NONLINEAR as f64));
    let all: Vec<f64> = of_job.filter_map(|(_, peak)| peak).collect();
    // the ends stand on their supports
    let own = &all[1..3];
    assert!(all.len() == 4 && own[0] != own[1], "{all:?}");
    for (word, expected) in [
        ("max", own.iter().copied().fold(f64::MIN, f64::max)),
        ("min", own.iter().copied().fold(f64::MAX, f64::min)),
        ("mean", 0.5 * (own[0] + own[1])),
        ("count", 2.0),
    ] {
        let select = json!({ "select": { "table": "positions", "column": "peak_deflection_m", "reduce": word,
            "where": { "connection": "nonlinear", "gap_tension_m": 0.028, "speed_m_s": { "from": 6 }, "position": [2, 3] } } });
        run.twins(word, |f| value(&select, f * expected));
    }
    let only = json!({ "select": { "table": "positions", "column": "peak_deflection_m" } });
    let (code, lines) = run.stage.held(
        "r",
        &json!([{ "id": "only", "value": value(&only, run.peak)["value"] }]),
    );
    assert_eq!(code, Some(1));
    assert_eq!(lines[0]["worst"]["reason"], "24 rows match where one is meant");
}

#[test]
fn filters_take_values_lists_ranges_and_nothing() {
    let run = Run::new();
    let peaks = run.stage.numbers("r/connectors.parquet", "peak_compression_n");
    let joints = run.stage.numbers("r/connectors.parquet", "joint");
    let places = run.stage.numbers("r/connectors.parquet", "y_m");
    let jobs = run.stage.numbers("r/connectors.parquet", "job");
    let sum = (0..peaks.len())
        .find(|&i| jobs[i] == Some(NONLINEAR as f64) && joints[i] == Some(3.0) && places[i].is_none())
        .unwrap();
    let select = json!({ "select": { "table": "connectors", "column": "peak_compression_n",
                                     "where": { "joint": 3, "y_m": null } } });
    let filter =
        json!({ "connection": ["nonlinear"], "gap_tension_m": { "from": 0.028, "to": 0.028 }, "speed_m_s": 10 });
    run.twins(
        "a joint's sum",
        |f| json!({ "where": filter, "value": value(&select, f * peaks[sum].unwrap())["value"] }),
    );
    // what a quantity says of a column goes before what the check says of it
    run.twins(
        "inner before outer",
        |f| json!({ "where": { "job": 0 }, "value": value(&of(NONLINEAR), f * run.peak)["value"] }),
    );
}

#[test]
fn bounds_hold_from_below_and_above() {
    let run = Run::new();
    let quantity = of(NONLINEAR);
    run.twins(
        "at least",
        |f| json!({ "bound": { "of": quantity, "at_least": 0.99 * f * run.peak } }),
    );
    run.twins(
        "at most",
        |f| json!({ "bound": { "of": quantity, "at_most": 1.01 / f * run.peak } }),
    );
    run.twins(
        "between",
        |f| json!({ "bound": { "of": quantity, "at_least": 0.99 * f * run.peak, "at_most": 2.0 * run.peak } }),
    );
}

#[test]
fn trends_rise_fall_keep_flat_and_keep_their_sign() {
    let run = Run::new();
    let (peak, slow) = (run.peak, run.slow);
    assert!(peak > slow);
    let filter = json!({ "connection": "nonlinear", "gap_tension_m": 0.028 });
    let of = json!({ "select": { "table": "jobs", "column": "peak_deflection_m" } });
    let trend = |quantity: Value, word: &str| json!({ "where": filter, "trend": { "of": quantity, "along": "speed_m_s", "trend": word } });
    // two equal values neither rise nor fall: the twins lift the smaller one over the larger
    let floor = |f: f64| if f > 1.0 { f * peak } else { slow };
    run.twins("rises", |f| {
        trend(json!({ "largest": [of, { "number": floor(f) }] }), "rises")
    });
    run.twins("falls", |f| {
        trend(
            json!({ "difference": [{ "number": 1 }, { "largest": [of, { "number": floor(f) }] }] }),
            "falls",
        )
    });
    run.twins("positive", |f| {
        trend(json!({ "difference": [of, { "number": 0.99 * f * slow }] }), "positive")
    });
    run.twins("negative", |f| {
        trend(json!({ "difference": [of, { "number": 1.01 / f * peak }] }), "negative")
    });
    run.twins("flat", |f| {
        let mut check = trend(of.clone(), "flat");
        check["trend"]["within"] = json!(1.01 / f * (peak - slow) / slow);
        check
    });
    let (code, lines) = run.stage.held("r", &json!([
        { "id": "falls", "where": filter, "trend": { "of": of, "along": "speed_m_s", "trend": "falls" } },
        { "id": "one value", "where": { "speed_m_s": 5 }, "trend": { "of": of, "along": "speed_m_s", "trend": "rises" } },
    ]));
    assert_eq!((code, &lines[0]["verdict"]), (Some(1), &json!("falls-short")));
    assert_eq!(lines[0]["worst"]["values"], json!([slow, peak]));
    assert_eq!(
        lines[1]["worst"]["reason"],
        "1 values of speed_m_s match, a trend needs two"
    );
}

#[test]
fn modes_are_found_by_the_name_of_their_shape() {
    let mut stage = Stage::new();
    stage.study = json!({ "name": "modes", "bridge": "bridge.json", "analysis": { "kind": "modes", "count": 8 },
                          "design": [{ "grid": { "analysis.model": ["full", "super-element"] } }] });
    stage.ran("m");
    let shapes = stage.table("m/modes.parquet");
    let shapes = shapes.column("shape").unwrap().str().unwrap();
    let row = shapes.iter().position(|shape| shape == Some("torsion 1")).unwrap();
    let hz = stage.numbers("m/modes.parquet", "frequency_hz")[row].unwrap();
    twins(&stage, "m", "torsion", |f| {
        json!({ "where": { "analysis.model": "full" },
                "mode": { "shape": "torsion 1", "expected_hz": f * hz, "relative_tolerance": 0.01 } })
    });
    twins(
        &stage,
        "m",
        "of both models",
        |f| json!({ "each": ["analysis.model"], "mode": { "shape": "torsion 1", "expected_hz": f * hz, "relative_tolerance": 0.01 } }),
    );
}

#[test]
fn curves_run_along_positions_and_histories() {
    let run = Run::new();
    let of_job = |path: &str, column: &str| -> Vec<f64> {
        let jobs = run.stage.numbers(path, "job");
        let all = run.stage.numbers(path, column);
        let own = jobs.iter().zip(all).filter(|(job, _)| **job == Some(NONLINEAR as f64));
        own.filter_map(|(_, value)| value).collect()
    };
    let (x, w) = (
        of_job("r/positions.parquet", "x_m"),
        of_job("r/positions.parquet", "peak_deflection_m"),
    );
    let largest = w.iter().copied().fold(0.0, f64::max);
    let top = w.iter().position(|w| *w == largest).unwrap();
    run.twins("positions", |f| {
        let mut points: Vec<[f64; 2]> = x.iter().zip(&w).map(|(x, w)| [*x, *w]).collect();
        points[top][1] *= f;
        points.insert(1, [0.5 * (x[0] + x[1]), 0.5 * (w[0] + w[1])]);
        json!({ "where": { "job": NONLINEAR }, "curve": { "table": "positions", "column": "peak_deflection_m",
                "against": "x_m", "points": points, "relative_tolerance": 0.01 } })
    });
    // the deflection of the position and the force of the joint follow each other in the table
    let (t, value) = (
        of_job("r/histories.parquet", "time_s"),
        of_job("r/histories.parquet", "value"),
    );
    let (t, value) = (&t[..t.len() / 2], &value[..value.len() / 2]);
    let most = (0..t.len()).max_by(|&i, &j| value[i].total_cmp(&value[j])).unwrap();
    run.twins("a history", |f| {
        let points = [[t[0], value[0]], [t[most], f * value[most]]];
        json!({ "where": { "job": NONLINEAR, "quantity": "deflection_m", "position": 2 },
                "curve": { "table": "histories", "column": "value", "against": "time_s", "points": points,
                           "absolute_tolerance": 0.01 * value[most] } })
    });
    for (filter, points, reason) in [
        (
            json!({ "job": NONLINEAR }),
            json!([[99, 1]]),
            "x_m 99 lies outside the rows that match",
        ),
        (
            json!({}),
            json!([[0, 1]]),
            "several rows with one x_m: several jobs match",
        ),
    ] {
        let (code, lines) = run.stage.held(
            "r",
            &json!([{ "id": "a", "where": filter, "curve": { "table": "positions",
            "column": "peak_deflection_m", "against": "x_m", "points": points, "relative_tolerance": 0.01 } }]),
        );
        assert_eq!((code, &lines[0]["worst"]["reason"]), (Some(1), &json!(reason)));
    }
}

/// A bound may leave its end out, an inner filter may not fix what the check moves.
#[test]
fn a_bound_above_leaves_its_end_out_and_a_check_moves_its_own_columns() {
    let run = Run::new();
    let check = |bound: Value| json!([{ "id": "a", "bound": bound }]);
    for (sides, status) in [
        (json!({ "at_least": run.peak }), 0),
        (json!({ "above": run.peak }), 1),
        (json!({ "above": 0.999 * run.peak, "below": 1.001 * run.peak }), 0),
        (json!({ "at_most": run.peak }), 0),
        (json!({ "below": run.peak }), 1),
    ] {
        let mut bound = sides.clone();
        bound["of"] = of(NONLINEAR);
        assert_eq!(run.stage.held("r", &check(bound)).0, Some(status), "{sides}");
    }
    let of = json!({ "select": { "table": "jobs", "column": "peak_deflection_m", "where": { "speed_m_s": 10 } } });
    for check in [
        json!({ "id": "a", "each": ["speed_m_s"], "bound": { "of": of, "at_least": 0 } }),
        json!({ "id": "a", "trend": { "of": of, "along": "speed_m_s", "trend": "positive" } }),
    ] {
        run.stage.json("reference.json", &reference(&json!([check])));
        let output = run.stage.pontoon(&["compare", "r", "--with", "reference.json"]);
        assert_eq!(output.status.code(), Some(2));
        assert!(stderr(&output).contains("select.where.speed_m_s: found a column that the check itself moves"));
    }
}
