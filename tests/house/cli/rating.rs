//! Limits, ratings, tables of classes and exceedances, from a study to the tables.

use crate::stage::{Stage, is_refused, stderr, stdout};
use serde_json::{Value, json};
use std::f64::consts::PI;

/// The smoke bridge rated by load at 5 m/s.
fn stage() -> Stage {
    let mut stage = Stage::new();
    stage.study["analysis"] = json!({ "kind": "rating", "time_step_s": 0.02, "tail_s": 1.0 });
    stage.study["limits"] = json!({ "edge_sinkage_m": 0.3, "joint_compression_n": 8e5 });
    stage.study["find"] = json!({ "largest": "load_n", "between": [5e4, 4e5], "ladder_ratio": 1.1 });
    stage.study["design"] = json!([{ "grid": { "speed_m_s": 5 } }]);
    stage.study["record"] = json!({});
    stage
}

fn job(stage: &Stage, out: &str, column: &str) -> f64 {
    stage.numbers(&format!("{out}/jobs.parquet"), column)[0].unwrap_or_else(|| panic!("no {column}"))
}

fn word(stage: &Stage, out: &str, column: &str) -> String {
    let table = stage.table(&format!("{out}/jobs.parquet"));
    let cells = table.column(column).unwrap().str().unwrap();
    cells.get(0).unwrap_or_default().to_owned()
}

/// The study as one of crossings at some values of the axis that it searched.
fn crossings(stage: &mut Stage, axis: &str, values: &[f64]) {
    stage.study["analysis"]["kind"] = json!("crossing");
    stage.study.as_object_mut().unwrap().remove("find");
    stage.study["design"][0]["grid"][axis] = json!(values);
}

/// A single rigid module under two vehicles that meet: sinkage is their weight over `rho g A`, wherever they are, as they enter at
/// both ends at once. With a search and, where the connection is linear, without. 1 %: wheels enter one patch point after the
/// other, which moves the module. Twin: the allowable.
#[test]
fn a_rigid_module_carries_its_water_plane_times_the_sinkage() {
    let mut stage = stage();
    stage.bridge["modules"] = json!(1);
    stage.bridge["supports"] = json!({ "left": ["x", "y"], "right": ["y"] });
    stage.bridge["module"]["material"]["youngs_modulus_pa"] = json!(2e14);
    stage.study["traffic"] = json!([{ "y_m": -2.0 }, { "y_m": 2.0, "direction": -1, "start_time_s": 0 }]);
    stage.study["vehicle"] =
        json!({ "footprint_length_m": 3.35, "track_y_m": [-1.4, 1.4], "inertia": "none", "patch_points": 32 });
    stage.study["analysis"]["damping"] = json!({ "ratio": 0.8, "frequencies_hz": [0.3, 0.45] });
    stage.study["analysis"]["time_step_s"] = json!(0.05);
    let rated = |stage: &mut Stage, connection: &str, sinkage_m: f64| {
        stage.study["limits"] = json!({ "edge_sinkage_m": sinkage_m });
        stage.study["design"] = json!([{ "grid": { "connection": connection, "speed_m_s": 0.2 } }]);
        let out = format!("{connection} {sinkage_m}");
        stage.ran(&out);
        job(stage, &out, "rated_value")
    };
    let water_n_m = 7486.0 * 6.7 * 8.082;
    for connection in ["linear", "nonlinear"] {
        let off = |load_n: f64| (2.0 * load_n / (water_n_m * 0.3) - 1.0).abs();
        let right = off(rated(&mut stage, connection, 0.3));
        let wrong = off(rated(&mut stage, connection, 0.285));
        assert!(right < 0.01 && wrong > 0.04, "{connection}: {right} {wrong}");
    }
}

/// A long beam on water whose ends are held: the deepest point under a slow load is that of an endless beam, `P lambda / 2k`, and what the
/// end near by adds at `2 lambda a = pi`, a share of `e^-pi` (the load's mirror image beyond the end presses upward). 1 % is
/// asked, 0.2 % held: shear of the webs takes 2e-5. Twin: the allowable.
#[test]
fn a_long_beam_carries_what_winkler_says() {
    let mut stage = stage();
    let (length_m, breadth_m, depth_m, plate_m, e_pa, lambda_1_m) = (240.0, 2.0, 0.6, 0.01, 2e11, 0.05);
    let area_moment_m4 =
        2.0 * breadth_m * plate_m * (0.5_f64 * depth_m).powi(2) + 3.0 * plate_m * f64::powi(depth_m, 3) / 12.0;
    let k_n_m2 = 4.0 * e_pa * area_moment_m4 * f64::powi(lambda_1_m, 4);
    let frames: Vec<f64> = (1..60).map(|i| 4.0 * f64::from(i)).collect();
    stage.bridge["modules"] = json!(1);
    stage.bridge["module"] = json!({
        "length_m": length_m, "breadth_m": breadth_m, "depth_m": depth_m,
        "deck_thickness_m": plate_m, "bottom_thickness_m": plate_m, "side_thickness_m": plate_m, "end_thickness_m": plate_m,
        "longitudinal_walls": { "thickness_m": plate_m, "y_m": [0.0] },
        "transverse_walls": { "thickness_m": plate_m, "x_m": frames },
        "stiffeners": { "area_m2": 1e-6, "second_moment_m4": 1e-12, "torsion_constant_m4": 1e-12,
                        "transverse_x_m": [0.0, length_m], "longitudinal_y_m": [-1.0, 1.0] },
        "material": { "youngs_modulus_pa": e_pa, "poissons_ratio": 0.3, "density_kg_m3": 100.0 },
        "mesh": { "elements_along": 120, "elements_between_lines": 1, "elements_over_depth": 1 } });
    stage.bridge["hydrostatic_stiffness_pa_m"] = json!(k_n_m2 / breadth_m);
    stage.bridge["added_mass_kg_m"] = json!(100.0);
    stage.bridge["hinges"]["y_m"] = json!([0.0]);
    stage.bridge["connectors"]["y_m"] = json!([-1.0, 1.0]);
    let bridge = stage.bridge.as_object_mut().unwrap();
    bridge.remove("draft_m");
    bridge.remove("freeboard_m");
    stage.study["vehicle"] =
        json!({ "footprint_length_m": 0.5, "track_y_m": [-1.0, 1.0], "inertia": "none", "patch_points": 4 });
    stage.study["analysis"]["damping"] = json!({ "ratio": 0.05, "frequencies_hz": [1.3, 5.0] });
    stage.study["analysis"]["time_step_s"] = json!(0.1);
    stage.study["design"] = json!([{ "grid": { "connection": "linear", "speed_m_s": 1 } }]);
    let mut off = |sinkage_m: f64| {
        stage.study["limits"] = json!({ "edge_sinkage_m": sinkage_m });
        let out = format!("{sinkage_m}");
        stage.ran(&out);
        let exact_n = 0.1 * 2.0 * k_n_m2 / lambda_1_m / (1.0 + (-PI).exp());
        (job(&stage, &out, "rated_value") / exact_n - 1.0).abs()
    };
    let (right, wrong) = (off(0.1), off(0.095));
    assert!(right < 0.002 && wrong > 0.04, "{right} {wrong}");
}

/// Of a linear bridge under weight alone the rated load is a reference load times the allowable over the response, to rounding, without
/// a search: one crossing at the bracket's end and one at the rating.
#[test]
fn a_linear_bridge_is_rated_in_proportion() {
    let mut stage = stage();
    stage.study["vehicle"]["inertia"] = json!("none");
    stage.study["design"][0]["grid"]["connection"] = json!("linear");
    stage.study["limits"] =
        json!({ "edge_sinkage_m": 0.3, "static_trim_m": 0.02, "joint_compression_n": 8e5, "roll_rad": 0.01 });
    stage.ran("r");
    assert!(job(&stage, "r", "crossings") <= 2.0 && job(&stage, "r", "monotone") == 1.0);
    crossings(&mut stage, "load_n", &[123_456.0]);
    stage.ran("c");
    let edge = 123_456.0 * (0.3 - 0.02) / job(&stage, "c", "peak_edge_deflection_m");
    let joint = 123_456.0 * 8e5 / job(&stage, "c", "peak_compression_n");
    let exact_n = edge.min(joint);
    let rated_n = job(&stage, "r", "rated_value");
    assert!((rated_n / exact_n - 1.0).abs() < 1e-9, "{rated_n} {exact_n}");
    assert!((job(&stage, "r", "utilisation") - 1.0).abs() < 1e-9);
    // another inertia or gaps need a search
    stage.study["analysis"]["kind"] = json!("rating");
    stage.study["find"] = json!({ "largest": "load_n", "between": [5e4, 4e5], "ladder_ratio": 1.1 });
    stage.study["design"] = json!([{ "grid": { "speed_m_s": 5, "connection": "linear" } }]);
    stage.study["vehicle"]["inertia"] = json!("local");
    stage.ran("s");
    assert!(job(&stage, "s", "crossings") > 20.0);
}

/// A rating is the ladder and sections by hand: crossings at its reported values pass and fail, the rungs below pass, and the
/// width is the one asked. Twin: an allowable 5 % lower.
#[test]
fn a_search_is_the_ladder_by_hand() {
    let mut stage = stage();
    stage.ran("r");
    let [rated, failure, largest] =
        ["rated_value", "first_failure", "largest_pass"].map(|column| job(&stage, "r", column));
    assert!(
        failure > rated && failure / rated - 1.0 <= 0.002 + 1e-9,
        "{rated} {failure}"
    );
    assert!((largest - rated).abs() < 1e-9 && job(&stage, "r", "monotone") == 1.0);
    let governing = word(&stage, "r", "governing_limit");
    // 22 rungs, sections of a tenth to 0.2 %, four of the load's spread
    let crossed = job(&stage, "r", "crossings");
    assert!((30.0..70.0).contains(&crossed), "{crossed}");
    stage.study["limits"]["joint_compression_n"] = json!(7.6e5);
    stage.study["limits"]["edge_sinkage_m"] = json!(0.285);
    stage.ran("twin");
    assert!(job(&stage, "twin", "rated_value") < 0.98 * rated);
    stage.study["limits"] = json!({ "edge_sinkage_m": 0.3, "joint_compression_n": 8e5 });
    let mut rungs: Vec<f64> = (0..)
        .map(|i| 5e4 * 1.1_f64.powi(i))
        .take_while(|load| *load < rated)
        .collect();
    let below = rungs.len();
    rungs.extend([rated, failure]);
    crossings(&mut stage, "load_n", &rungs);
    stage.ran("c");
    let used = stage.numbers("c/jobs.parquet", "utilisation");
    assert!(used[..=below].iter().all(|used| used.unwrap() <= 1.0), "{used:?}");
    assert!(used[below + 1].unwrap() > 1.0, "{used:?}");
    let told = stage.table("c/jobs.parquet");
    let names = told.column("governing_limit").unwrap();
    assert_eq!(names.str().unwrap().get(below + 1), Some(governing.as_str()));
    // what is told of the rating is its crossing at the value rated, by the operator that judges
    let told_m = job(&stage, "r", "peak_deflection_m");
    let by_study_m = stage.numbers("c/jobs.parquet", "peak_deflection_m")[below].unwrap();
    assert!((by_study_m / told_m - 1.0).abs() < 1e-3, "{by_study_m} {told_m}");
    // the rows of limits of crossings give the columns: largest of demand over allowable
    let rows = stage.numbers("c/limits.parquet", "utilisation");
    let (demand, allowed) = (
        stage.numbers("c/limits.parquet", "demand"),
        stage.numbers("c/limits.parquet", "allowed"),
    );
    for (job, used) in used.iter().enumerate() {
        let own = 2 * job..2 * job + 2;
        let most = rows[own.clone()].iter().map(|cell| cell.unwrap()).fold(0.0, f64::max);
        assert_eq!(*used, Some(most));
        for row in own {
            assert!((demand[row].unwrap() / allowed[row].unwrap() - rows[row].unwrap()).abs() < 1e-12);
        }
    }
    stage.study["analysis"]["operator_tolerance"] = json!(1e-4);
    stage.study["design"][0]["grid"]["load_n"] = json!([rated, failure]);
    stage.ran("judge");
    assert_eq!(
        stage.numbers("judge/jobs.parquet", "peak_deflection_m")[0],
        Some(told_m)
    );
    // and the reference solver agrees on both ends
    stage.study["analysis"]["solver"] = json!("reference");
    stage.study["analysis"]
        .as_object_mut()
        .unwrap()
        .remove("operator_tolerance");
    stage.ran("reference");
    let used = stage.numbers("reference/jobs.parquet", "utilisation");
    assert!(used[0].unwrap() <= 1.0 && used[1].unwrap() > 1.0, "{used:?}");
}

/// A search along other axes, in either sense: the fastest, and the shortest spacing of a column. Three vehicles 17 m apart press a bridge of
/// 20 m deeper than those 14 m apart: where that is too deep the rating is not monotone, and tells the far pass too.
#[test]
fn any_axis_of_numbers_is_searched() {
    let mut stage = stage();
    stage.study["limits"] = json!({ "edge_sinkage_m": 0.12 });
    stage.study["column"] = json!({ "count": 3, "spacing_m": 30, "load_n": 1.5e5 });
    stage.study["find"] =
        json!({ "smallest": "column.spacing_m", "between": [5, 40], "relative_width": 0.01, "ladder_ratio": 1.2 });
    stage.ran("r");
    let [rated, failure] = ["rated_value", "first_failure"].map(|column| job(&stage, "r", column));
    assert!(
        failure < rated && rated / failure - 1.0 <= 0.01 + 1e-9,
        "{rated} {failure}"
    );
    crossings(&mut stage, "column.spacing_m", &[rated, failure]);
    stage.ran("c");
    let used = stage.numbers("c/jobs.parquet", "utilisation");
    assert!(used[0].unwrap() <= 1.0 && used[1].unwrap() > 1.0, "{used:?}");

    let mut stage = self::stage();
    stage.study["limits"] = json!({ "edge_sinkage_m": 0.114 });
    stage.study["column"] = json!({ "count": 3, "spacing_m": 30, "load_n": 1.5e5 });
    stage.study["find"] =
        json!({ "smallest": "column.spacing_m", "between": [5, 40], "relative_width": 0.01, "ladder_ratio": 1.1 });
    stage.ran("r");
    assert_eq!(job(&stage, "r", "monotone"), 0.0);
    let [rated, failure, largest] =
        ["rated_value", "first_failure", "largest_pass"].map(|column| job(&stage, "r", column));
    assert!(
        rated > failure && failure > 16.0 && largest < 14.0,
        "{rated} {failure} {largest}"
    );
    crossings(&mut stage, "column.spacing_m", &[rated, failure, largest]);
    stage.ran("c");
    let used = stage.numbers("c/jobs.parquet", "utilisation");
    let passes: Vec<bool> = used.iter().map(|used| used.unwrap() <= 1.0).collect();
    assert_eq!(passes, [true, false, true]);

    let mut stage = self::stage();
    stage.study["limits"] = json!({ "uplift_m": 0.06 });
    stage.study["find"] =
        json!({ "largest": "speed_m_s", "between": [2, 20], "relative_width": 0.01, "ladder_ratio": 1.1 });
    stage.study["design"] = json!([{ "grid": { "load_n": 1.5e5 } }]);
    stage.ran("r");
    let [rated, failure] = ["rated_value", "first_failure"].map(|column| job(&stage, "r", column));
    crossings(&mut stage, "speed_m_s", &[rated, failure]);
    stage.ran("c");
    let used = stage.numbers("c/jobs.parquet", "utilisation");
    assert!(used[0].unwrap() <= 1.0 && used[1].unwrap() > 1.0, "{used:?}");
}

/// A bracket that does not hold the rating is a row that says so, and no number.
#[test]
fn a_bracket_without_the_rating_is_a_failed_row() {
    let mut stage = stage();
    for (limits, failure, words) in [
        (
            json!({ "edge_sinkage_m": 0.001 }),
            "bracket_fails",
            "the lower end of the bracket fails: load_n = 50000",
        ),
        (
            json!({ "edge_sinkage_m": 50.0 }),
            "bracket_passes",
            "the upper end of the bracket passes: load_n = 400000",
        ),
    ] {
        for (connection, inertia) in [("nonlinear", "local"), ("linear", "none")] {
            stage.study["limits"] = limits.clone();
            stage.study["vehicle"]["inertia"] = json!(inertia);
            stage.study["design"][0]["grid"]["connection"] = json!(connection);
            let out = format!("{failure} {connection}");
            let output = stage.write().pontoon(&["run", "study.json", "--out", &out, "--quiet"]);
            assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
            assert_eq!(word(&stage, &out, "failure"), failure);
            let reason = word(&stage, &out, "reason");
            assert!(
                reason.starts_with(words) && reason.contains("of edge_sinkage_m"),
                "{reason}"
            );
            assert_eq!(stage.numbers(&format!("{out}/jobs.parquet"), "rated_value"), [None]);
        }
    }
}

/// A crossing that a rating tries is held to the limit of time steps, as a job is: the job of the rating is that of the end where
/// the limits are to hold, and a slower crossing takes longer.
#[test]
fn a_crossing_of_a_rating_is_held_to_its_steps() {
    let mut stage = stage();
    stage.study["analysis"]["step_limit"] = json!(1000);
    stage.study["limits"] = json!({ "edge_sinkage_m": 5.0 });
    stage.study["find"] = json!({ "smallest": "speed_m_s", "between": [0.2, 20], "ladder_ratio": 1.5 });
    stage.study["design"] = json!([{ "grid": { "load_n": 1e5 } }]);
    let output = stage.write().pontoon(&["run", "study.json", "--out", "r", "--quiet"]);
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    assert_eq!(word(&stage, "r", "failure"), "too_many_steps");
    let reason = word(&stage, "r", "reason");
    assert!(
        reason.contains("crossing at speed_m_s = ") && reason.contains("the limit is 1000"),
        "{reason}"
    );
}

/// A class table: a row a vehicle, the columns by type and speed, a crossing a cell; what a type says is what a column says.
#[test]
fn a_table_of_classes_has_a_crossing_a_cell() {
    let mut stage = stage();
    let truck = |load_n: f64| {
        json!({ "name": "truck", "axles": [{ "behind_front_m": 0.0, "load_n": load_n, "patch_length_m": 0.3, "track_y_m": [-1.0, 1.4] },
                                           { "behind_front_m": 4.0, "load_n": load_n, "patch_length_m": 0.3, "track_y_m": [-1.0, 1.4] }] })
    };
    stage.json("light.json", &truck(4e4));
    stage.json("heavy.json", &truck(2e5));
    stage.study.as_object_mut().unwrap().remove("vehicle");
    stage.study["design"] = json!([{ "grid": { "vehicle": ["light.json", "heavy.json"] } }]);
    let output = stage.write().pontoon(&["rate", "study.json", "--out", "r", "--quiet"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let told = stdout(&output);
    let lines: Vec<&str> = told.lines().collect();
    let heads = [
        "normal 2 m/s",
        "normal 4 m/s",
        "normal 6 m/s",
        "caution 3.6 m/s",
        "risk 1.3 m/s",
    ];
    assert!(heads.iter().all(|head| lines[2].contains(head)), "{told}");
    let row = |name: &str| *lines.iter().find(|line| line.starts_with(name)).unwrap();
    assert!(
        !row("light").contains('!') && row("heavy").matches('!').count() == 5,
        "{told}"
    );
    // one crossing a cell, each with its numbers; caution and risk have one speed
    let table: Value = {
        let output = stage.pontoon(&["rate", "study.json", "--out", "r", "--quiet", "--format", "json"]);
        serde_json::from_str(&stdout(&output)).unwrap()
    };
    let cells = table["table"]["rows"][1]["cells"].as_array().unwrap().clone();
    assert_eq!((cells.len(), stage.table("r/jobs.parquet").height()), (5, 10));
    // caution is a column of two 45.7 m apart on the centre line at 3.6 m/s: the wheels' middle is at y = 0.2 m
    let caution = &cells[3];
    stage.study["analysis"]["kind"] = json!("crossing");
    stage.study.as_object_mut().unwrap().remove("find");
    stage.study["column"] = json!({ "count": 2, "spacing_m": 45.7, "spacing_from": "tail_to_head", "y_m": -0.2 });
    stage.study["vehicle"] = json!("heavy.json");
    stage.study["design"] = json!([{ "grid": { "speed_m_s": 3.6 } }]);
    stage.ran("c");
    assert_eq!(caution["utilisation"].as_f64(), Some(job(&stage, "c", "utilisation")));
    // the page has the table
    let output = stage.pontoon(&["report", "r", "--out", "page.html"]);
    assert!(output.status.success(), "{}", stderr(&output));
    let page = std::fs::read_to_string(stage.path("page.html")).unwrap();
    assert!(page.contains("\"classes\":{\"names\":") && page.contains("caution 3.6 m/s"));
}

/// In a study with points drawn at random each limit has the share of jobs that exceed it: counted in the table, with its interval.
#[test]
fn limits_of_random_points_have_their_share() {
    let mut stage = stage();
    stage.study["analysis"]["kind"] = json!("crossing");
    stage.study.as_object_mut().unwrap().remove("find");
    stage.study["limits"] = json!({ "edge_sinkage_m": 0.2, "joint_compression_n": 6e5 });
    stage.study["design"] = json!([{ "latin_hypercube": { "count": 30, "seed": 2, "ranges": { "load_n": [5e4, 3e5], "speed_m_s": [3, 12] } } }]);
    let output = stage.write().pontoon(&["run", "study.json", "--out", "r", "--quiet"]);
    let used = stage.numbers("r/limits.parquet", "utilisation");
    let csv = std::fs::read_to_string(stage.path("r/summary_limits.csv")).unwrap();
    for (number, limit) in ["edge_sinkage_m", "joint_compression_n"].into_iter().enumerate() {
        let exceeded = used
            .iter()
            .skip(number)
            .step_by(2)
            .filter(|used| used.unwrap() > 1.0)
            .count();
        assert!((1..30).contains(&exceeded), "{exceeded}");
        assert!(csv.contains(&format!("\n{limit},{exceeded},30,0,")), "{csv}");
        assert!(stdout(&output).contains(&format!("{limit} exceeded by {exceeded} of 30 jobs")));
    }
    let output = stage.pontoon(&["report", "r", "--out", "page.html"]);
    assert!(output.status.success(), "{}", stderr(&output));
    let page = std::fs::read_to_string(stage.path("page.html")).unwrap();
    assert!(page.contains("\"exceedance\":[{\"limit\":\"edge_sinkage_m\""));
    // a grid has no share
    stage.study["design"] = json!([{ "grid": { "load_n": [1e5, 2e5] , "speed_m_s": 5 } }]);
    stage
        .write()
        .pontoon(&["run", "study.json", "--out", "r", "--quiet", "--fresh"]);
    assert!(!stage.path("r/summary_limits.csv").exists());
}

#[test]
fn what_no_limit_or_search_may_be_is_refused_at_its_key() {
    let refused = |change: &dyn Fn(&mut Stage), parts: &[&str]| {
        let mut stage = stage();
        change(&mut stage);
        is_refused(&stage.write().pontoon(&["plan", "study.json"]), parts);
    };
    let limits = |value: Value, parts: &[&str]| refused(&|stage| stage.study["limits"] = value.clone(), parts);
    limits(json!({}), &["limits", "no limit", "edge_sinkage_m", "axle_contact_n"]);
    limits(json!({ "edge_sinkage_m": 0 }), &["limits.edge_sinkage_m", "found 0"]);
    limits(json!({ "roll_rad": -0.1 }), &["limits.roll_rad", "found -0.1"]);
    limits(
        json!({ "edge_sinkag_m": 0.1 }),
        &["limits.edge_sinkag_m", "nearest known: edge_sinkage_m"],
    );
    limits(
        json!({ "peak_deflection_m": 0.1 }),
        &["limits.peak_deflection_m", "edge_sinkage_m", "uplift_m", "pin_force_n"],
    );
    limits(
        json!({ "edge_sinkage_m": 0.3, "freeboard_margin_m": 0.3 }),
        &["limits.freeboard_margin_m", "none beside edge_sinkage_m"],
    );
    limits(
        json!({ "freeboard_margin_m": 0.98 }),
        &["limits.freeboard_margin_m", "below 0.973"],
    );
    limits(json!({ "freeboard_margin_m": -1 }), &["limits.freeboard_margin_m"]);
    limits(
        json!({ "uplift_m": 0.1, "static_trim_m": 0.1 }),
        &["limits.static_trim_m", "none without edge_sinkage_m"],
    );
    refused(
        &|stage| {
            stage.bridge.as_object_mut().unwrap().remove("draft_m");
            stage.study["limits"] = json!({ "draft_margin_m": 0.01 });
        },
        &["limits.draft_margin_m", "without draft_m", "uplift_m"],
    );
    for joint in [
        "joint_compression_n",
        "connector_tension_n",
        "pin_force_n",
        "joint_angle_rad",
    ] {
        refused(
            &|stage| {
                stage.bridge["modules"] = json!(1);
                stage.study["analysis"]["damping"] = json!({ "ratio": 0.05, "frequencies_hz": [0.3, 3.0] });
                stage.study["limits"] = json!({ joint: 1.0 });
            },
            &[&format!("limits.{joint}"), "one module has no joint"],
        );
    }
    refused(
        &|stage| {
            stage.study.as_object_mut().unwrap().remove("limits");
        },
        &["missing key `limits`"],
    );
    refused(
        &|stage| {
            stage.study.as_object_mut().unwrap().remove("find");
        },
        &["missing key `find`"],
    );
    refused(
        &|stage| stage.study["analysis"]["kind"] = json!("crossing"),
        &["find", "none but in a study of kind rating"],
    );
    let find = |key: &str, value: Value, parts: &[&str]| {
        refused(
            &|stage| {
                stage.study["find"][key] = value.clone();
            },
            parts,
        );
    };
    find(
        "smallest",
        json!("speed_m_s"),
        &["find", "both", "either largest or smallest"],
    );
    find("largest", json!(null), &["find", "neither"]);
    find("largest", json!("connection"), &["find.largest", "which is no number"]);
    find(
        "largest",
        json!("vehicle.inertia"),
        &["find.largest", "which is no number"],
    );
    find(
        "largest",
        json!("vehicle.track_y_m"),
        &["find.largest", "which is no number"],
    );
    find(
        "largest",
        json!("speed_m_s"),
        &["find.largest", "which the design's axis speed_m_s sets too"],
    );
    find("largest", json!("lod_kn"), &["find.largest", "load_n"]);
    find("between", json!([4e5, 5e4]), &["find.between[1]", "above 400000"]);
    find("between", json!([4e5, 4e5]), &["find.between[1]", "above 400000"]);
    find("between", json!([0, 4e5]), &["find.between", "found 0", "above 0"]);
    find("ladder_ratio", json!(1.0), &["find.ladder_ratio", "above 1"]);
    find(
        "ladder_ratio",
        json!(1.000_01),
        &["find.ladder_ratio", "at most 2000 values"],
    );
    find("relative_width", json!(0), &["find.relative_width"]);
    find("relative_width", json!(0.6), &["find.relative_width", "at most 0.5"]);
    // types of crossings
    let types = |change: &dyn Fn(&mut Stage), parts: &[&str]| {
        let mut stage = stage();
        stage.study["design"][0]["grid"]["crossing_type"] = json!(["normal", "risk"]);
        change(&mut stage);
        is_refused(&stage.write().pontoon(&["plan", "study.json"]), parts);
    };
    types(
        &|stage| stage.study["design"][0]["grid"]["crossing_type"] = json!(["normal", "brisk"]),
        &["crossing_type", "risk"],
    );
    types(
        &|stage| stage.study["column"] = json!({ "count": 3, "spacing_m": 30 }),
        &["crossing_type"],
    );
    types(&|stage| stage.study["traffic"] = json!([{}]), &["crossing_type"]);
    // a table of classes needs limits and a grid
    let mut stage = stage();
    stage.study.as_object_mut().unwrap().remove("limits");
    is_refused(
        &stage.write().pontoon(&["rate", "study.json", "--out", "r"]),
        &["missing key `limits`"],
    );
}
