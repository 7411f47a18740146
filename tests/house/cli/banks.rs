//! Banks, from the bridge file to the tables.

use crate::stage::{Stage, is_refused};
use serde_json::{Value, json};

/// A stage of two crossings on two banks in place of the supports' z.
fn stage() -> Stage {
    let mut stage = Stage::new();
    stage.study["design"] = json!([{ "grid": {
        "gap_tension_m": 0.002, "gap_compression_m": 0.001, "speed_m_s": [6, 9], "load_n": 3e5 } }]);
    stage.bridge["supports"] = json!({ "left": ["x", "y"], "right": ["y"] });
    stage.bridge["banks"] = json!([
        { "at": "left", "direction": "z", "stiffness_n_m": 1e7, "y_m": [-1.125, 1.125] },
        { "at": "right", "direction": "z", "stiffness_n_m": 1e7, "clearance_m": 0.005, "y_m": [0] }
    ]);
    stage
}

#[test]
fn banks_leave_a_table_and_are_axes_of_one_operator() {
    let mut stage = stage();
    stage.study["design"][0]["grid"]["bridge.banks[1].clearance_m"] = json!([0.0, 0.005, 5.0]);
    stage.ran("r");
    let [jobs, banks, y_m, toward] =
        ["job", "bank", "y_m", "peak_toward_n"].map(|name| stage.numbers("r/banks.parquet", name));
    // a sum and two places, a sum and one
    assert_eq!(jobs.len(), 6 * 5);
    let of = |job: usize, bank: usize, place: Option<f64>| {
        let is = |row: &usize| jobs[*row] == Some(job as f64) && banks[*row] == Some(bank as f64) && y_m[*row] == place;
        toward[(0..jobs.len()).find(is).unwrap()].unwrap()
    };
    let clearance = stage.numbers("r/jobs.parquet", "bridge.banks[1].clearance_m");
    for (job, clearance) in clearance.iter().enumerate() {
        let places = of(job, 0, Some(-1.125)) + of(job, 0, Some(1.125));
        assert!(
            (of(job, 0, None) - places).abs() < 1e-9 * places,
            "the load is in the middle"
        );
        assert!(of(job, 0, None) > 1e5);
        match clearance {
            Some(5.0) => assert_eq!(of(job, 1, None), 0.0, "nothing comes down five metres"),
            _ => assert!(of(job, 1, None) > 5e4),
        }
    }
    // the reference solver finds them too
    stage.study["analysis"]["solver"] = json!("reference");
    stage.ran("s");
    let other = stage.numbers("s/banks.parquet", "peak_toward_n");
    let largest = toward.iter().flatten().fold(0.0, |most: f64, x| most.max(*x));
    for (a, b) in toward.iter().zip(&other) {
        assert!((a.unwrap() - b.unwrap()).abs() < 0.01 * largest, "{a:?} {b:?}");
    }
}

#[test]
fn a_standing_load_is_carried_by_water_and_banks() {
    let mut stage = stage();
    stage.study["analysis"] = json!({ "kind": "static" });
    stage.study["design"] = json!([{ "grid": { "connection": "linear", "load_x_m": [0.5, 10.05], "load_n": 3e5 } }]);
    stage.ran("r");
    let rows = stage.numbers("r/banks.parquet", "peak_toward_n");
    // near the left end its bank carries more than half of it, in the middle both carry some
    assert!(rows[0] > Some(1.5e5) && rows[3] < Some(1e4), "{rows:?}");
    assert!(rows[5] > Some(1e5) && rows[8] > Some(1e5), "{rows:?}");
}

#[test]
fn banks_that_a_bridge_cannot_have_are_refused_at_their_key() {
    let refused = |bank: Value, parts: &[&str]| {
        let mut stage = stage();
        stage.bridge["banks"] = json!([bank]);
        let output = stage.write().pontoon(&["plan", "study.json"]);
        is_refused(&output, parts);
    };
    let bank = |key: &str, value: Value| {
        let mut bank = json!({ "at": "left", "direction": "z", "stiffness_n_m": 1e7 });
        bank[key] = value;
        bank
    };
    refused(
        bank("stiffness_n_m", json!(0)),
        &["bridge.json: banks[0].stiffness_n_m: found 0"],
    );
    refused(bank("clearance_m", json!(-0.1)), &["banks[0].clearance_m: found -0.1"]);
    refused(bank("damping_n_s_m", json!(-1)), &["banks[0].damping_n_s_m: found -1"]);
    refused(
        bank("at", json!(9)),
        &["banks[0].at: found 9, allowed: \"left\", \"right\" or a position from 1 to 4"],
    );
    refused(bank("at", json!("middle")), &["banks[0].at", "left"]);
    refused(
        bank("direction", json!("y")),
        &["banks[0].toward: found neither, allowed: \"+\" or \"-\""],
    );
    refused(
        bank("direction", json!("x")),
        &["banks[0].direction: found x, allowed: a direction that supports.left does not hold"],
    );
    refused(
        bank("y_m", json!([0.3])),
        &["banks[0].y_m[0]: found 0.3, allowed: a place of hinges"],
    );
    let mut both = bank("one_sided", json!(false));
    both["clearance_m"] = json!(0.01);
    refused(
        both,
        &["banks[0].clearance_m: found 0.01, allowed: 0 of a spring that holds both ways"],
    );
}
