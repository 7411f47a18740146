//! The dead load of a bridge, from its file to the tables.

use crate::stage::{Stage, is_refused};
use serde_json::{Value, json};

/// A stage of crossings on banks that press, with ballast, over levels of the river.
fn stage() -> Stage {
    let mut stage = Stage::new();
    stage.study["design"] = json!([{ "grid": {
        "gap_tension_m": 0.002, "gap_compression_m": 0.001, "speed_m_s": [6, 9], "load_n": 2e5,
        "bridge.water_level_m": [-0.05, 0.0, 0.05] } }]);
    stage.study["record"]["freeboards"] = json!(true);
    stage.bridge["supports"] = json!({ "left": ["x", "y"], "right": ["y"] });
    stage.bridge["banks"] = json!([
        { "at": "left", "direction": "z", "stiffness_n_m": 1e7, "preload_n": 2e4 },
        { "at": "right", "direction": "z", "stiffness_n_m": 1e7, "clearance_m": 0.02 }
    ]);
    stage.bridge["dead"] = json!({ "ballast": [ { "module": 2, "x_m": 3.35, "y_m": 2.0, "weight_n": 1.5e4 } ] });
    stage
}

/// A column of words.
fn words(stage: &Stage, table: &str, column: &str) -> Vec<Option<String>> {
    let table = stage.table(table);
    let cells = table.column(column).unwrap().str().unwrap();
    cells.iter().map(|cell| cell.map(str::to_owned)).collect()
}

/// Rows of a table as the values of some columns.
fn rows<const N: usize>(stage: &Stage, table: &str, columns: [&str; N]) -> Vec<[Option<f64>; N]> {
    let columns = columns.map(|column| stage.numbers(table, column));
    (0..columns[0].len())
        .map(|row| columns.each_ref().map(|column| column[row]))
        .collect()
}

#[test]
fn a_dead_load_leaves_tables_and_levels_share_one_operator() {
    let mut stage = stage();
    stage.ran("r");
    let words = words(&stage, "r/dead.parquet", "quantity");
    let dead = rows(
        &stage,
        "r/dead.parquet",
        ["job", "position", "module", "bank", "y_m", "value"],
    );
    let of = |job: f64, quantity: &str, is: &dyn Fn(&[Option<f64>; 6]) -> bool| -> f64 {
        let found =
            (0..dead.len()).find(|&i| words[i].as_deref() == Some(quantity) && dead[i][0] == Some(job) && is(&dead[i]));
        dead[found.unwrap_or_else(|| panic!("no {quantity} of job {job}"))][5].unwrap()
    };
    let levels = stage.numbers("r/jobs.parquet", "bridge.water_level_m");
    let half_m = 0.5 * 8.082;
    for (job, level) in levels.iter().enumerate() {
        let (job, level) = (job as f64, level.unwrap());
        // the ballast is on the side of higher y, which is lower then
        assert!(of(job, "heel_rad", &|row| row[2] == Some(2.0)) < -1e-4);
        // the middle goes with the river, but for the ballast's 15 kN on some 400 kN/m a module
        let sinks = of(job, "sinkage_m", &|row| row[2] == Some(2.0));
        assert!((sinks + level).abs() < 0.04, "{sinks} m at {level} m");
        // the bank is jacked up, and the river lifts the bridge off it
        let reaction = of(job, "reaction_n", &|row| row[3] == Some(0.0) && row[4].is_none());
        let allowed = match level {
            level if level < 0.0 => 1e4..1e5,
            level if level > 0.0 => 0.0..1e-9,
            // what of 20 kN the flexible end of the bridge does not give way to
            _ => 1e3..2e4,
        };
        assert!(allowed.contains(&reaction), "{reaction} N at {level} m");
        // freeboards at rest are heights of the deck above the river
        let lower = of(job, "freeboard_m", &|row| {
            row[2] == Some(2.0) && row[1] == Some(2.0) && row[4] == Some(half_m)
        });
        let higher = of(job, "freeboard_m", &|row| {
            row[2] == Some(2.0) && row[1] == Some(2.0) && row[4] == Some(-half_m)
        });
        assert!(lower < higher && higher < 1.0, "{lower} {higher}");
    }
    let least = rows(
        &stage,
        "r/freeboards.parquet",
        ["job", "module", "position", "y_m", "least_freeboard_m"],
    );
    assert_eq!(least.len(), 6 * 12, "{levels:?}");
    for row in &least {
        let at = |other: &[Option<f64>; 6]| other[2] == row[1] && other[1] == row[2] && other[4] == row[3];
        let at_rest = of(row[0].unwrap(), "freeboard_m", &at);
        assert!(row[4].unwrap() < at_rest - 0.01, "{row:?} from {at_rest}");
    }
    let of_jobs = rows(
        &stage,
        "r/jobs.parquet",
        ["job", "least_freeboard_m", "least_freeboard_module"],
    );
    for [job, value, module] in of_jobs {
        let own = least.iter().filter(|row| row[0] == job);
        let smallest = own.min_by(|a, b| a[4].unwrap().total_cmp(&b[4].unwrap())).unwrap();
        assert_eq!((value, module), (smallest[4], smallest[1]));
    }
    let manifest = stage.manifest("r");
    assert_eq!(manifest["operators"]["built"], json!(1), "{manifest}");
    // the reference solver starts from there too
    stage.study["analysis"]["solver"] = json!("reference");
    stage.ran("s");
    let other = rows(&stage, "s/freeboards.parquet", ["least_freeboard_m"]);
    for (row, other) in least.iter().zip(&other) {
        assert!((row[4].unwrap() - other[0].unwrap()).abs() < 2e-3, "{row:?} {other:?}");
    }
    assert_eq!(
        stage.numbers("r/dead.parquet", "value"),
        stage.numbers("s/dead.parquet", "value")
    );
}

#[test]
fn a_bridge_that_sinks_is_a_row_with_its_reason() {
    let mut stage = stage();
    stage.study["design"] = json!([{ "grid": {
        "gap_tension_m": 0.002, "gap_compression_m": 0.001, "speed_m_s": 6, "load_n": 2e5,
        "bridge.dead.ballast[0].weight_n": [1.5e4, 5e6] } }]);
    stage.write();
    stage.pontoon(&["run", "study.json", "--out", "r"]);
    let kinds = words(&stage, "r/jobs.parquet", "failure");
    assert_eq!(kinds, [None, Some("no_dead_state".to_owned())]);
    let reasons = words(&stage, "r/jobs.parquet", "reason");
    let reason = reasons[1].as_deref().unwrap();
    assert!(reason.contains("sinks: a corner of its deck is"), "{reason}");
}

#[test]
fn dead_loads_that_a_bridge_cannot_have_are_refused_at_their_key() {
    let refused = |change: &dyn Fn(&mut Stage), parts: &[&str]| {
        let mut stage = stage();
        change(&mut stage);
        is_refused(&stage.write().pontoon(&["plan", "study.json"]), parts);
    };
    let ballast = |key: &'static str, value: Value, parts: &[&str]| {
        refused(&|stage| stage.bridge["dead"]["ballast"][0][key] = value.clone(), parts);
    };
    ballast(
        "module",
        json!(4),
        &["bridge.json: dead.ballast[0].module: found 4, allowed: a module from 1 to 3"],
    );
    ballast("x_m", json!(6.8), &["dead.ballast[0].x_m: found 6.8"]);
    ballast("y_m", json!(-4.2), &["dead.ballast[0].y_m: found -4.2"]);
    ballast("weight_n", json!(0), &["dead.ballast[0].weight_n: found 0"]);
    refused(
        &|stage| stage.bridge["banks"][1]["preload_n"] = json!(1e3),
        &["banks[1].preload_n: found 1000, allowed: none beside a clearance"],
    );
    refused(
        &|stage| stage.bridge["banks"][0]["one_sided"] = json!(false),
        &["banks[0].preload_n: found 20000, allowed: 0 of a spring that holds both ways"],
    );
    refused(
        &|stage| stage.bridge["supports"]["left"] = json!(["y"]),
        &["found no end that holds x", "under a dead load"],
    );
    refused(
        &|stage| {
            stage.study["design"][0]["grid"]["bridge.water_level_m"] = json!([500]);
        },
        &["bridge.water_level_m", "found 500"],
    );
    refused(
        &|stage| stage.bridge["freeboard_m"] = Value::Null,
        &["study.json: record.freeboards: found true, with no module that has a freeboard_m"],
    );
}
