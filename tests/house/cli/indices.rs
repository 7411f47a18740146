//! Designs of Saltelli and Morris from outside: what is refused.

use super::refusals::study;
use serde_json::{Value, json};

fn ranges() -> Value {
    json!({ "speed_m_s": [4, 16], "load_n": [1e5, 3e5], "gap_tension_m": 0.02 })
}

fn saltelli(second_order: bool) -> Value {
    json!({ "saltelli": { "count": 16, "seed": 1, "ranges": ranges(), "second_order": second_order } })
}

/// So many levels that no two points are equal.
fn morris() -> Value {
    json!({ "morris": { "trajectories": 6, "levels": 100, "seed": 1, "ranges": ranges() } })
}

#[test]
fn designs_that_no_index_comes_from_are_refused_at_their_key() {
    let bad = |design: Value, key: &str, found: &str, allowed: &str| {
        let message = format!("design[0]{key}: found {found}, allowed: {allowed}");
        study("", "design", json!([design]), &[&message]);
    };
    let with = |mut design: Value, form: &str, key: &str, value: Value| {
        design[form][key] = value;
        design
    };
    let counts = "a whole number from 2 to 10000000";
    bad(
        with(saltelli(false), "saltelli", "count", json!(1)),
        ".saltelli.count",
        "1",
        counts,
    );
    bad(
        with(morris(), "morris", "trajectories", json!(0)),
        ".morris.trajectories",
        "0",
        counts,
    );
    let even = "an even number from 2 to 1000";
    bad(
        with(morris(), "morris", "levels", json!(5)),
        ".morris.levels",
        "5",
        even,
    );
    bad(
        with(morris(), "morris", "levels", json!(1002)),
        ".morris.levels",
        "1002",
        even,
    );
    let constant = json!({ "speed_m_s": 5, "load_n": 1e5 });
    let range = "at least one axis with a range [from, to], whole or values";
    for (design, form) in [(saltelli(false), "saltelli"), (morris(), "morris")] {
        bad(
            with(design.clone(), form, "ranges", constant.clone()),
            &format!(".{form}.ranges"),
            "no range",
            range,
        );
        let mut under_conditions = design;
        under_conditions["where"] = json!({ "speed_m_s": { "from": 5 } });
        let whole = if form == "morris" {
            "a trajectory"
        } else {
            "a row of the base sample"
        };
        bad(
            under_conditions,
            ".where",
            &format!("conditions beside {form}"),
            &format!("none: {whole} is of use only with all of its points"),
        );
    }
    let many: serde_json::Map<_, _> = (0..51).map(|i| (format!("bridge.x{i}"), json!([0, 1]))).collect();
    bad(
        with(saltelli(false), "saltelli", "ranges", many.into()),
        ".saltelli.ranges",
        "51 ranges",
        "at most 50 ranges",
    );
    study(
        "",
        "design",
        json!([with(saltelli(false), "saltelli", "second_orders", json!(true))]),
        &[
            "design[0].saltelli.second_orders: found unknown key",
            "nearest known: second_order",
        ],
    );
    study(
        "",
        "design",
        json!([with(saltelli(false), "saltelli", "count", json!(4_000_000))]),
        &["design: found 16000000 points, allowed: at most 10000000 points"],
    );
}
