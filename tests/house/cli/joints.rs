//! Joints of their own and wear, from the study to the tables.

use crate::stage::{Stage, is_refused, stderr};
use serde_json::{Value, json};

/// A stage of a few crossings and what its bridge's joints have.
fn stage(joints: Value) -> Stage {
    let mut stage = Stage::new();
    stage.study["design"] = json!([{ "grid": {
        "connection": ["linear", "nonlinear"], "gap_tension_m": 0.002, "gap_compression_m": 0.001, "speed_m_s": [6, 9], "load_n": 3e5
    } }]);
    if !joints.is_null() {
        stage.bridge["joints"] = joints;
    }
    stage
}

const TABLES: [&str; 4] = ["jobs", "positions", "connectors", "histories"];

/// Whether two folders of results have the same cells in every table.
fn same_tables(stage: &Stage, a: &str, b: &str) -> bool {
    TABLES.into_iter().all(|name| {
        let table = |of: &str| stage.table(&format!("{of}/{name}.parquet"));
        table(a).same_cells(&table(b))
    })
}

#[test]
fn equal_joints_given_one_by_one_are_the_tables_without_them() {
    let mut stage = stage(Value::Null);
    stage.ran("plain");
    let connectors =
        json!({ "stiffness_n_m": stage.bridge["connectors"]["stiffness_n_m"], "tension": true, "lost": false });
    stage.bridge["joints"] =
        json!({ "2": { "connectors": connectors }, "2..3": { "connectors": { "compression": true } } });
    stage.ran("one by one");
    assert!(same_tables(&stage, "plain", "one by one"));
    // and joints that are not equal are told
    stage.bridge["joints"]["3"] = json!({ "connectors": { "gap_compression_m": 0.0011 } });
    stage.ran("other");
    assert!(!same_tables(&stage, "plain", "other"));
}

#[test]
fn every_number_of_a_joint_is_an_axis_under_its_path() {
    let mut by_axis = stage(Value::Null);
    for (path, value) in [
        ("bridge.joints[3].connectors.gap_compression_m", json!(0.004)),
        ("bridge.joints[2..3].connectors.tension", json!(false)),
        ("bridge.joints[2].connectors.stop_compression.gap_m", json!(0.003)),
        ("bridge.joints[2].connectors.stop_compression.stiffness_n_m", json!(9e7)),
    ] {
        by_axis.study["design"][0]["grid"][path] = value;
    }
    by_axis.ran("r");
    let mut by_file = stage(json!({
        "2..3": { "connectors": { "tension": false } },
        "3": { "connectors": { "gap_compression_m": 0.004 } },
        "2": { "connectors": { "stop_compression": { "gap_m": 0.003, "stiffness_n_m": 9e7 } } }
    }));
    by_file.ran("r");
    for name in &TABLES[1..] {
        let table = |stage: &Stage| stage.table(&format!("r/{name}.parquet"));
        assert!(table(&by_axis).same_cells(&table(&by_file)), "{name}");
    }
    let column = by_axis.numbers("r/jobs.parquet", "bridge.joints[3].connectors.gap_compression_m");
    assert_eq!(column, [Some(0.004); 4]);
    // later entries of a joint win
    by_file.bridge["joints"]["2..3"] = Value::Null;
    by_file.bridge["joints"] = json!({
        "2": { "connectors": { "tension": true, "stop_compression": { "gap_m": 0.003, "stiffness_n_m": 9e7 } } },
        "3": { "connectors": { "gap_compression_m": 0.004 } },
        "2..3": { "connectors": { "tension": false } }
    });
    by_file.ran("s");
    assert!(same_tables(&by_file, "r", "s"));
}

/// The numbers of a column of the jobs, none missing.
fn of_jobs(stage: &Stage, column: &str) -> Vec<f64> {
    let column = stage.numbers("r/jobs.parquet", column);
    column.into_iter().map(|x| x.expect("a number")).collect()
}

/// How many unlike numbers a list has.
fn unlike(mut list: Vec<f64>) -> usize {
    list.sort_by(f64::total_cmp);
    list.dedup();
    list.len()
}

#[test]
fn damping_is_an_axis_of_the_bridge_and_of_its_joints() {
    let path = "bridge.connectors.damping_n_s_m";
    let by_axis = |path: &str| {
        let mut stage = stage(Value::Null);
        stage.study["design"][0]["grid"][path] = json!([0, 2e5, 6e5]);
        stage.ran("r");
        stage
    };
    let (all, by_joint) = (by_axis(path), by_axis("bridge.joints[2..3].connectors.damping_n_s_m"));
    for name in &TABLES[1..] {
        let table = |stage: &Stage| stage.table(&format!("r/{name}.parquet"));
        assert!(table(&all).same_cells(&table(&by_joint)), "{name}");
    }
    let damping = of_jobs(&all, path);
    let where_it_is = |is: f64, column: &str| -> Vec<f64> {
        let cells = of_jobs(&all, column).into_iter().zip(&damping);
        cells.filter(|(_, c)| **c == is).map(|(x, _)| x).collect()
    };
    // a coefficient of 0 is a study without dashpots
    let plain = stage(Value::Null);
    plain.ran("r");
    for column in [
        "peak_deflection_m",
        "peak_compression_n",
        "static_peak_deflection_m",
        "energy_residual",
    ] {
        assert_eq!(where_it_is(0.0, column), of_jobs(&plain, column), "{column}");
    }
    // each other one is another crossing with the static peak of its connection
    assert_eq!(unlike(of_jobs(&all, "peak_compression_n")), 12);
    assert_eq!(unlike(of_jobs(&all, "static_peak_deflection_m")), 2);
    assert!(of_jobs(&all, "energy_residual").iter().all(|of| *of < 1e-12));
    // by the file, and by the reference solver: 0.1 %, as far as the operator may be off
    let mut by_file = stage(json!({ "2": { "connectors": { "damping_n_s_m": 6e5 } } }));
    by_file.bridge["connectors"]["damping_n_s_m"] = json!(6e5);
    by_file.ran("r");
    let operated = where_it_is(6e5, "peak_deflection_m");
    assert_eq!(of_jobs(&by_file, "peak_deflection_m"), operated);
    by_file.study["analysis"]["solver"] = json!("reference");
    by_file.ran("s");
    let reference = by_file.numbers("s/jobs.parquet", "peak_deflection_m");
    assert_eq!(reference.len(), operated.len());
    for (reference, operated) in reference.into_iter().flatten().zip(operated) {
        assert!((reference / operated - 1.0).abs() < 1e-3, "{reference} {operated}");
    }
}

#[test]
fn damping_is_nothing_to_static_cases() {
    let mut stage = stage(Value::Null);
    stage.study["analysis"] = json!({ "kind": "static" });
    stage.study["design"] = json!([{ "grid": {
        "load_x_m": [5, 9], "load_n": 3e5, "bridge.connectors.damping_n_s_m": [0, 2e5]
    } }]);
    stage.study.as_object_mut().unwrap().remove("record");
    stage.ran("r");
    assert_eq!(of_jobs(&stage, "load_x_m"), [5.0, 9.0], "equal jobs are one");
    // nor is a coefficient of 0 to crossings: eight jobs, four of them with dashpots
    let mut stage = self::stage(Value::Null);
    let plain = stage.study["design"][0].clone();
    let mut damped = plain.clone();
    damped["grid"]["bridge.connectors.damping_n_s_m"] = json!([0, 2e5]);
    stage.study["design"] = json!([plain, damped]);
    stage.ran("r");
    let damping = stage.numbers("r/jobs.parquet", "bridge.connectors.damping_n_s_m");
    assert_eq!(damping, [[None; 4], [Some(2e5); 4]].concat());
}

#[test]
fn a_lost_pin_is_another_bridge() {
    let mut stage = stage(json!({ "2": { "hinges": { "y_m": [-1.125, 1.125] } } }));
    stage.ran("lost");
    stage.bridge["joints"] = json!({ "2": { "hinges": stage.bridge["hinges"] } });
    stage.ran("all");
    stage.bridge.as_object_mut().unwrap().remove("joints");
    stage.ran("plain");
    assert!(same_tables(&stage, "plain", "all"));
    assert!(!same_tables(&stage, "plain", "lost"));
    // one place more than the bridge has
    stage.bridge["joints"] = json!({ "3": { "hinges": { "y_m": [-2.02, 0, 2.02] } } });
    stage.ran("more");
    assert!(!same_tables(&stage, "plain", "more"));
}

#[test]
fn wear_is_drawn_from_its_seed_and_kept_joint_by_joint() {
    let mut stage = stage(json!({ "3": { "connectors": { "gap_tension_m": 0.005 } } }));
    stage.study["wear"] = json!({ "gap_tension_m": { "uniform": 0.008 }, "gap_compression_m": { "normal": 0.0005 } });
    stage.study["design"][0]["grid"]["wear_seed"] = json!([0, 1, 2]);
    stage.ran("r");
    // two linear crossings, which gaps do not change, and two of each seed
    let seeds = stage.numbers("r/jobs.parquet", "wear_seed");
    assert_eq!(seeds.len(), 8);
    assert_eq!(seeds.iter().flatten().filter(|seed| **seed == 2.0).count(), 2);
    let table = "r/joints.parquet";
    assert_eq!(
        stage.table(table).names(),
        ["job", "joint", "gap_tension_m", "gap_compression_m"]
    );
    let [jobs, joints, tension, compression] = ["job", "joint", "gap_tension_m", "gap_compression_m"]
        .map(|name| stage.numbers(table, name).into_iter().flatten().collect::<Vec<f64>>());
    assert_eq!(joints, [2.0, 3.0].repeat(6));
    let nominal = [0.002, 0.005].repeat(6);
    for (gap, nominal) in tension.iter().zip(&nominal) {
        assert!((0.0..=0.008).contains(&(gap - nominal)), "{gap}");
    }
    assert!(compression.iter().all(|gap| *gap >= 0.0));
    // both speeds of a seed are on one bridge, two seeds are not
    assert_eq!(jobs.len(), 12);
    assert_eq!(tension.iter().filter(|gap| **gap == tension[0]).count(), 2);
    // the gaps that were drawn, as axes of a study without wear, are the same crossings
    let [t, c] = [&tension, &compression];
    let mut stated = self::stage(json!({
        "2": { "connectors": { "gap_tension_m": t[0], "gap_compression_m": c[0] } },
        "3": { "connectors": { "gap_tension_m": t[1], "gap_compression_m": c[1] } }
    }));
    stated.study["design"][0]["grid"]["connection"] = json!("nonlinear");
    stated.study["design"][0]["grid"]["speed_m_s"] = json!(if jobs[0] == 2.0 { 6 } else { 9 });
    stated.ran("r");
    let of = |stage: &Stage, row: usize| {
        ["peak_deflection_m", "peak_compression_n", "static_peak_deflection_m"]
            .map(|name| stage.numbers("r/jobs.parquet", name)[row])
    };
    assert_eq!(of(&stated, 0), of(&stage, jobs[0] as usize));
}

#[test]
fn the_scatter_of_wear_is_an_axis_too() {
    let mut stage = stage(Value::Null);
    stage.study["wear"] = json!({ "gap_compression_m": { "normal": 0.001 } });
    let grid = &mut stage.study["design"][0]["grid"];
    (grid["connection"], grid["wear_seed"]) = (json!("nonlinear"), json!(3));
    grid["wear.gap_compression_m.normal"] = json!([0.0, 0.0005, 0.001]);
    stage.ran("r");
    let gaps = stage.numbers("r/joints.parquet", "gap_compression_m");
    // the second joint of the jobs at the first speed
    let gap = |scale: usize| gaps[2 * scale + 1].unwrap();
    assert_eq!(gap(0), 0.001);
    assert!((gap(2) - 0.001 - 2.0 * (gap(1) - 0.001)).abs() < 1e-15, "{gaps:?}");
}

/// What is refused of joints: entry, parts of the message.
fn refused(joints: Value, parts: &[&str]) {
    let mut stage = stage(Value::Null);
    stage.bridge["joints"] = joints;
    let output = stage.write().pontoon(&["plan", "study.json"]);
    is_refused(&output, parts);
}

#[test]
fn joints_that_are_none_are_refused_at_their_key() {
    let lost = || json!({ "connectors": { "lost": true } });
    refused(
        json!({ "4": lost() }),
        &["bridge.json: joints[4]: found joint 4, allowed: joints from 2 to 3"],
    );
    refused(
        json!({ "1..2": lost() }),
        &["joints[1..2]: found joint 1, allowed: joints from 2 to 3"],
    );
    refused(
        json!({ "3..2": lost() }),
        &["joints[3..2]: found a range backwards, allowed: the lower number first: \"2..3\""],
    );
    refused(
        json!({ "two": lost() }),
        &["joints", "two", "a joint as \"7\" or joints as \"3..14\""],
    );
    refused(
        json!({ "2": { "connector": {} } }),
        &["joints[2].connector", "connectors"],
    );
    let of = |key: &str, value: Value| json!({ "2..3": { "connectors": { key: value } } });
    refused(
        of("stiffness_n_m", json!(-1)),
        &["joints[2..3].connectors.stiffness_n_m: found -1"],
    );
    refused(
        of("gap_tension_m", json!(-1e-3)),
        &["joints[2..3].connectors.gap_tension_m: found -0.001"],
    );
    refused(
        of("damping_n_s_m", json!(-1e5)),
        &["bridge.json: joints[2..3].connectors.damping_n_s_m: found -100000, allowed: a finite number of at least 0"],
    );
    refused(
        of("damping_n_s_m", json!("NaN")),
        &["joints[2..3].connectors.damping_n_s_m: found \"NaN\""],
    );
    refused(
        of("at_y_m", json!([1.0])),
        &["joints[2..3].connectors.at_y_m[0]: found 1, allowed: a place of connectors.y_m: -2.02, 2.02"],
    );
    let stop = |gap_m: f64, stiffness: f64| json!({ "gap_m": gap_m, "stiffness_n_m": stiffness });
    refused(
        of("stop_tension", stop(0.1, -5.0)),
        &["joints[2..3].connectors.stop_tension.stiffness_n_m: found -5"],
    );
    refused(
        of("stop_compression", stop(0.001, 5e7)),
        &[
            "joints[2..3].connectors.stop_compression.gap_m: found 0.001, allowed: above 0.001, the gap of the truss before it",
        ],
    );
    refused(
        json!({ "2": { "hinges": { "y_m": [] } } }),
        &["joints[2].hinges.y_m: found an empty list"],
    );
    refused(
        json!({ "2": { "hinges": { "y_m": [9] } } }),
        &["joints[2].hinges.y_m[0]: found 9"],
    );
    let mut damped = stage(Value::Null);
    damped.bridge["connectors"]["damping_n_s_m"] = json!(-1);
    let output = damped.write().pontoon(&["plan", "study.json"]);
    is_refused(
        &output,
        &["bridge.json: connectors.damping_n_s_m: found -1, allowed: a finite number of at least 0"],
    );
    damped.bridge["connectors"]["damping_n_s_m"] = json!(1);
    damped.study["design"][0]["grid"]["bridge.connectors.damping_n_s_m"] = json!([0, -2]);
    let output = damped.write().pontoon(&["plan", "study.json"]);
    is_refused(
        &output,
        &["study.json: design[0].grid.bridge.connectors.damping_n_s_m: found -2"],
    );
    // as an axis, at the axis
    let mut stage = stage(Value::Null);
    stage.study["design"][0]["grid"]["bridge.joints[9].connectors.lost"] = json!([true]);
    let output = stage.write().pontoon(&["plan", "study.json"]);
    is_refused(
        &output,
        &["study.json: design[0].grid.bridge.joints[9]", "joints from 2 to 3"],
    );
}

#[test]
fn wear_that_is_none_is_refused_at_its_key() {
    let refused = |wear: Value, seed: Value, parts: &[&str]| {
        let mut stage = stage(Value::Null);
        if !wear.is_null() {
            stage.study["wear"] = wear;
        }
        if !seed.is_null() {
            stage.study["design"][0]["grid"]["wear_seed"] = seed;
        }
        let output = stage.write().pontoon(&["plan", "study.json"]);
        is_refused(&output, parts);
    };
    let normal = |s: f64| json!({ "gap_compression_m": { "normal": s } });
    refused(
        normal(-0.001),
        json!(1),
        &["wear.gap_compression_m.normal: found -0.001"],
    );
    refused(
        json!({ "gap_tension_m": {} }),
        json!(1),
        &["wear.gap_tension_m: found neither, allowed: either normal or uniform"],
    );
    refused(
        json!({ "gap_m": { "normal": 1 } }),
        json!(1),
        &["wear.gap_m", "gap_tension_m"],
    );
    let beyond = json!({ "gap_compression_m": { "uniform": -0.0011 } });
    refused(
        beyond,
        json!(1),
        &["wear.gap_compression_m.uniform: found -0.0011, allowed: at least -0.001"],
    );
    refused(normal(0.001), Value::Null, &["wear_seed"]);
    refused(
        normal(0.001),
        json!(1.5),
        &["wear_seed: found 1.5, allowed: a whole number"],
    );
    refused(
        normal(0.001),
        json!(-1),
        &["wear_seed: found -1, allowed: a whole number"],
    );
    refused(
        Value::Null,
        json!(1),
        &["wear_seed: found 1, allowed: no seed of a wear"],
    );
    let mut stage = stage(Value::Null);
    stage.study["wear"] = normal(0.001);
    stage.study["analysis"] = json!({ "kind": "modes" });
    stage.study["design"] = json!([{ "grid": { "bridge.modules": [1] } }]);
    let output = stage.write().pontoon(&["plan", "study.json"]);
    assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
    is_refused(&output, &["wear: "]);
}
