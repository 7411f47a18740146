//! Reductions of histories, held against a computation of their own from the table of histories.

use crate::stage::Stage;
use serde_json::{Value, json};

const JOB: usize = 3;
const SPEED_M_S: f64 = 10.0;
const POSITION_X_M: f64 = 6.7;
const LENGTH_M: f64 = 3.0 * 6.7;
/// The last of the eight points that a footprint of 3.35 m has on each track, behind its centre.
const LAST_POINT_M: f64 = 0.5 * 3.35 * 7.0 / 8.0;

/// The history of one quantity of the job at position 2: times and values.
fn history(stage: &Stage, quantity: &str) -> Vec<(f64, f64)> {
    let path = "r/histories.parquet";
    let table = stage.table(path);
    let quantities = table.column("quantity").unwrap().str().unwrap();
    let [jobs, times, values] = ["job", "time_s", "value"].map(|column| stage.numbers(path, column));
    (0..jobs.len())
        .filter(|&i| jobs[i] == Some(JOB as f64) && quantities.get(i) == Some(quantity))
        .map(|i| (times[i].unwrap(), values[i].unwrap()))
        .collect()
}

/// The centre of a single footprint is at x = 0 at t = 0.
fn arrival_s() -> f64 {
    POSITION_X_M / SPEED_M_S
}

fn leaving_s() -> f64 {
    (LENGTH_M + LAST_POINT_M) / SPEED_M_S
}

fn part(history: &[(f64, f64)], from_s: f64, to_s: f64) -> Vec<(f64, f64)> {
    let inside = |(t, _): &&(f64, f64)| *t > from_s - 1e-9 && *t < to_s + 1e-9;
    history.iter().filter(inside).copied().collect()
}

fn max(part: &[(f64, f64)]) -> f64 {
    part.iter().map(|p| p.1).fold(f64::MIN, f64::max)
}

fn min(part: &[(f64, f64)]) -> f64 {
    part.iter().map(|p| p.1).fold(f64::MAX, f64::min)
}

fn zeros(part: &[(f64, f64)]) -> Vec<f64> {
    let mut zeros = Vec::new();
    for pair in part.windows(2) {
        let ((t0, w0), (t1, w1)) = (pair[0], pair[1]);
        if (w0 > 0.0) != (w1 > 0.0) {
            zeros.push(t0 + (t1 - t0) * w0 / (w0 - w1));
        }
    }
    zeros
}

/// The value at a time between two others.
fn at(history: &[(f64, f64)], time_s: f64) -> Option<f64> {
    history.windows(2).find_map(|pair| {
        let ((t0, w0), (t1, w1)) = (pair[0], pair[1]);
        let inside = t0 - 1e-12 <= time_s && time_s <= t1 + 1e-12;
        inside.then(|| w0 + (w1 - w0) * (time_s - t0) / (t1 - t0))
    })
}

fn holds(stage: &Stage, quantity: &Value, expected: f64) -> (bool, Value) {
    let check = json!([{ "id": "a", "where": { "job": JOB }, "value": {
        "of": { "history": quantity }, "expected": expected, "relative_tolerance": 1e-9 } }]);
    let (code, lines) = stage.held("r", &check);
    (code == Some(0), lines[0].clone())
}

#[test]
fn every_reduction_is_what_the_table_gives_between_its_edges() {
    let mut stage = Stage::new();
    stage.study["analysis"]["tail_s"] = json!(6.0);
    stage.ran("r");
    let deflection = history(&stage, "deflection_m");
    let force = history(&stage, "force_n");
    let end = deflection.last().unwrap().0;
    assert!(end >= leaving_s() + 6.0 && end < leaving_s() + 6.0 + 0.02, "{end}");
    let whole = (json!(null), json!(null), f64::MIN, f64::MAX);
    let past = (
        json!({ "centre_past_m": -5 }),
        json!({ "centre_past_m": 8.5 }),
        arrival_s() - 0.5,
        arrival_s() + 0.85,
    );
    let after = (
        json!({ "after_leaving_s": 0.5 }),
        json!(null),
        leaving_s() + 0.5,
        f64::MAX,
    );
    let times = (
        json!({ "time_s": 0.4 }),
        json!({ "after_leaving_s": 0 }),
        0.4,
        leaving_s(),
    );
    for (from, to, from_s, to_s) in [whole, past, after, times] {
        for (name, history) in [("deflection_m", &deflection), ("force_n", &force)] {
            let part = part(history, from_s, to_s);
            let (most, least) = (max(&part), min(&part));
            for (reduce, expected) in [
                ("max", most),
                ("min", least),
                ("max_abs", most.abs().max(least.abs())),
                ("max_negative", (-least).max(0.0)),
                ("amplitude", 0.5 * (most - least)),
            ] {
                let mut quantity = json!({ "quantity": name, "position": 2, "reduce": reduce });
                for (key, edge) in [("from", &from), ("to", &to)] {
                    if !edge.is_null() {
                        quantity[key] = edge.clone();
                    }
                }
                let (held, line) = holds(&stage, &quantity, expected);
                assert!(held, "{quantity}: {expected}: {line}");
                if expected.abs() > 0.0 {
                    assert!(!holds(&stage, &quantity, 1.05 * expected).0, "{quantity}");
                }
            }
        }
    }
}

#[test]
fn periods_humps_and_asymmetry_are_those_of_the_table() {
    let mut stage = Stage::new();
    stage.study["analysis"]["tail_s"] = json!(6.0);
    stage.ran("r");
    let deflection = history(&stage, "deflection_m");
    let free = zeros(&part(&deflection, leaving_s() + 0.2, f64::MAX));
    let period = 2.0 * (free[free.len() - 1] - free[0]) / (free.len() - 1) as f64;
    let most = max(&deflection);
    let top = deflection.iter().find(|p| p.1 == most).unwrap().0;
    let all = zeros(&deflection);
    let before = all.iter().copied().filter(|t| *t < top).fold(f64::MIN, f64::max);
    let after = all.iter().copied().filter(|t| *t > top).fold(f64::MAX, f64::min);
    let reach = 5.0 / SPEED_M_S;
    let ways = deflection.iter().map(|p| p.0 - arrival_s());
    let asymmetry = ways
        .filter(|s| (0.0..=reach).contains(s))
        .filter_map(|s| Some((at(&deflection, arrival_s() - s)? - at(&deflection, arrival_s() + s)?).abs()))
        .fold(0.0, f64::max);
    for (quantity, expected) in [
        (
            json!({ "reduce": "period_s", "from": { "after_leaving_s": 0.2 } }),
            period,
        ),
        (json!({ "reduce": "hump_duration_s" }), after - before),
        (json!({ "reduce": { "asymmetry_within_m": 5 } }), asymmetry / most),
    ] {
        let mut quantity = quantity;
        quantity["quantity"] = "deflection_m".into();
        quantity["position"] = 2.into();
        assert!(expected.is_finite() && expected > 0.0, "{quantity}: {expected}");
        let (held, line) = holds(&stage, &quantity, expected);
        assert!(held, "{quantity}: {expected}: {line}");
        assert!(!holds(&stage, &quantity, 1.05 * expected).0, "{quantity}");
    }
}

#[test]
fn histories_that_are_not_there_fall_short() {
    let stage = Stage::new();
    stage.ran("r");
    for (quantity, reason) in [
        (json!({ "position": 3 }), "no history of deflection_m at 3 was recorded"),
        (
            json!({ "position": 2, "from": { "time_s": 90 } }),
            "the history has 0 values between",
        ),
        (
            json!({ "position": 2, "reduce": "period_s", "to": { "time_s": 0.1 } }),
            "zero crossings, no period",
        ),
        (
            json!({ "position": 2, "where": { "job": [1, 2] } }),
            "several jobs match where one history is meant",
        ),
    ] {
        let mut quantity = quantity;
        quantity["quantity"] = "deflection_m".into();
        if quantity.get("reduce").is_none() {
            quantity["reduce"] = "max".into();
        }
        let (held, line) = holds(&stage, &quantity, 1.0);
        let found = line["worst"]["reason"].as_str().unwrap();
        assert!(!held && found.contains(reason), "{found}");
    }
}
