//! Vehicles on springs, their files, traffic and roads, from a study to the tables.

use crate::stage::{Stage, is_refused, stdout};
use serde_json::{Value, json};

/// A truck of two axles on springs.
fn truck() -> Value {
    let axle = |behind_front_m: f64, mass: f64, stiffness: f64| {
        json!({ "behind_front_m": behind_front_m, "patch_length_m": 0.3, "track_y_m": [-1.0, 1.0],
                "unsprung_mass_kg": mass, "tyre_stiffness_n_m": 3.0 * stiffness, "tyre_damping_n_s_m": 3e3,
                "suspension_stiffness_n_m": stiffness, "suspension_damping_n_s_m": 1.5e4 })
    };
    json!({ "name": "truck", "axles": [axle(0.0, 600.0, 5e5), axle(4.5, 1000.0, 1e6)], "patch_points": 4,
            "body": { "mass_kg": 12000, "behind_front_m": 2.9, "pitch_inertia_kg_m2": 5e4 } })
}

/// A stage of a truck from a file at two speeds.
fn stage() -> Stage {
    let mut stage = Stage::new();
    stage.json("truck.json", &truck());
    stage.study["vehicle"] = json!("truck.json");
    stage.study["design"] = json!([{ "grid": { "speed_m_s": [6, 9] } }]);
    stage.study["record"]["histories"] = json!({ "positions": [2], "vehicles": [1] });
    stage
}

fn words(stage: &Stage, table: &str, column: &str) -> Vec<String> {
    let table = stage.table(table);
    let cells = table.column(column).unwrap().str().unwrap();
    cells.iter().map(|cell| cell.unwrap_or_default().to_owned()).collect()
}

/// A truck from a file leaves what one in the study leaves, with its wheels and bodies; the results hold the vehicle, so that the
/// file may go.
#[test]
fn a_vehicle_file_is_the_vehicle_in_the_study() {
    let mut stage = stage();
    stage.ran("r");
    let weight_n = 9.806_65 * (12_000.0 + 600.0 + 1000.0);
    for load in stage.numbers("r/jobs.parquet", "load_n") {
        assert!((load.unwrap() - weight_n).abs() < 1e-6, "{load:?}");
    }
    assert_eq!(
        stage.numbers("r/wheels.parquet", "axle"),
        [1, 1, 2, 2, 1, 1, 2, 2].map(|axle| Some(f64::from(axle)))
    );
    let [most, least] = ["peak_wheel_n", "least_wheel_n"].map(|column| stage.numbers("r/wheels.parquet", column));
    for (most, least) in most.iter().zip(&least) {
        assert!(least.unwrap() > 1e4 && most.unwrap() > 1.02 * least.unwrap() && most.unwrap() < 1e5);
    }
    assert_eq!(
        words(&stage, "r/bodies.parquet", "quantity"),
        ["bounce_m", "pitch_rad", "bounce_m", "pitch_rad"]
    );
    let quantities = words(&stage, "r/histories.parquet", "quantity");
    for quantity in ["wheel_n", "bounce_m", "pitch_rad", "deflection_m"] {
        assert!(quantities.iter().any(|other| other == quantity), "{quantity}");
    }
    // at the beginning each wheel carries what it does at rest
    let (time, value) = (
        stage.numbers("r/histories.parquet", "time_s"),
        stage.numbers("r/histories.parquet", "value"),
    );
    let places =
        (0..value.len()).filter(|&i| quantities[i] == "wheel_n" && time[i].is_some_and(|t| (0.0..0.02).contains(&t)));
    let sum: f64 = places.take(1).filter_map(|i| value[i]).sum();
    assert!(
        (sum - 0.5 * 9.806_65 * (600.0 + 12_000.0 * 1.6 / 4.5)).abs() < 500.0,
        "{sum}"
    );
    stage.study["vehicle"] = truck();
    stage.ran("s");
    std::fs::remove_file(stage.path("truck.json")).unwrap();
    for table in ["jobs", "positions", "wheels", "bodies", "histories"] {
        let [a, b] = ["r", "s"].map(|out| stage.table(&format!("{out}/{table}.parquet")));
        assert!(a.same_cells(&b), "{table}");
    }
    // a figure for each wheel and motion, on the page by the numbers of vehicle and axle
    let told = stage.pontoon(&["report", "r", "--out", "report.html", "--figures", "f"]);
    assert!(told.status.success(), "{}", String::from_utf8_lossy(&told.stderr));
    for name in [
        "wheel-1-1-1",
        "wheel-1-1-2",
        "wheel-1-2-1",
        "wheel-1-2-2",
        "bounce-1",
        "pitch-1",
    ] {
        let drawn = std::fs::read_dir(stage.path("f")).unwrap().any(|file| {
            let file = file.unwrap().file_name().into_string().unwrap();
            file.starts_with(name) && file.ends_with(".svg")
        });
        assert!(drawn, "{name}");
    }
    let page = std::fs::read_to_string(stage.path("report.html")).unwrap();
    assert!(page.contains("vehicle 1, axle 2, y -1 m") && page.contains("\"place\":\"vehicle 1\""));
}

/// An axis of files, with the vehicles that it names as columns; a job of each is what a study of that vehicle alone leaves.
#[test]
fn an_axis_lists_vehicle_files() {
    let mut stage = stage();
    let mut heavy = truck();
    heavy["body"]["mass_kg"] = json!(20_000);
    stage.json("heavy.json", &heavy);
    stage.study.as_object_mut().unwrap().remove("vehicle");
    stage.study["design"] = json!([{ "grid": { "vehicle": ["truck.json", "heavy.json"], "speed_m_s": 6 } }]);
    stage.ran("r");
    assert_eq!(words(&stage, "r/jobs.parquet", "vehicle"), ["truck.json", "heavy.json"]);
    let peaks = stage.numbers("r/jobs.parquet", "peak_deflection_m");
    for (file, peak) in ["truck.json", "heavy.json"].into_iter().zip(&peaks) {
        stage.study["vehicle"] = json!(file);
        stage.study["design"] = json!([{ "grid": { "speed_m_s": 6 } }]);
        let out = format!("one-{file}");
        stage.ran(&out);
        assert_eq!(
            stage.numbers(&format!("{out}/jobs.parquet"), "peak_deflection_m"),
            [*peak]
        );
    }
}

/// Every number of a traffic is an axis, whose values decide alone; numbers that all vehicles have alike are columns. A resumed run
/// finds every job.
#[test]
fn numbers_of_a_traffic_are_axes() {
    let mut stage = stage();
    stage.study["record"]["histories"] = json!({ "positions": [2] });
    stage.study["traffic"] = json!([{ "y_m": -2.0 }, { "y_m": 2.0, "direction": -1, "start_time_s": 0.5 }]);
    stage.study["design"] = json!([{ "grid": { "traffic[1].speed_m_s": [5, 8], "traffic[1].start_time_s": [0.0, 0.5],
                                               "speed_m_s": 8 } }]);
    stage.ran("r");
    assert_eq!(
        stage.numbers("r/jobs.parquet", "traffic[1].start_time_s"),
        [0.0, 0.5, 0.0, 0.5].map(Some)
    );
    // both drive at 8 m/s in the last two
    assert_eq!(
        stage.numbers("r/jobs.parquet", "speed_m_s"),
        [None, None, Some(8.0), Some(8.0)]
    );
    let peaks = stage.numbers("r/jobs.parquet", "peak_deflection_m");
    for i in 0..4 {
        assert!(peaks[..i].iter().all(|other| *other != peaks[i]), "{peaks:?}");
    }
    assert_eq!(stage.numbers("r/jobs.parquet", "static_peak_deflection_m"), [None; 4]);
    let again = stage.pontoon(&["run", "study.json", "--out", "r"]);
    assert!(again.status.success(), "{}", stdout(&again));
    assert_eq!(stage.numbers("r/jobs.parquet", "peak_deflection_m"), peaks);
    stage.study["analysis"]["solver"] = json!("reference");
    stage.ran("s");
    for (found, expected) in peaks.iter().zip(stage.numbers("s/jobs.parquet", "peak_deflection_m")) {
        assert!(
            (found.unwrap() / expected.unwrap() - 1.0).abs() < 5e-3,
            "{found:?} {expected:?}"
        );
    }
}

/// A column over its spacing and a road over its seed: equal seeds the same wheels, others others.
#[test]
fn columns_and_roads_are_swept() {
    let mut stage = stage();
    stage.study["record"]["histories"] = json!({ "positions": [2] });
    stage.study["column"] = json!({ "count": 2, "spacing_m": 30.5 });
    stage.study["roughness"] = json!({ "iso_8608": "D", "seed": 1, "run_in_m": 20 });
    stage.study["design"] = json!([
        { "grid": { "column.spacing_m": [20, 30.5], "roughness.seed": [1, 2], "speed_m_s": 10 } },
        { "grid": { "speed_m_s": 10 } }
    ]);
    stage.ran("r");
    // the last point is one of the grid
    let peaks = stage.numbers("r/wheels.parquet", "peak_wheel_n");
    assert_eq!(stage.numbers("r/jobs.parquet", "job").len(), 4);
    assert_eq!(peaks.len(), 4 * 8);
    assert!(peaks[..8] != peaks[8..16] && peaks[..8] != peaks[16..24]);
    assert!(
        stage
            .numbers("r/jobs.parquet", "contact_lost_s")
            .iter()
            .all(|lost| lost.is_some())
    );
}

/// What may not be, at its key: masses, springs, places, weights, overtaking, stops, roads, files, records.
#[test]
fn what_no_vehicle_or_traffic_may_be_is_refused_at_its_key() {
    let refused = |change: &dyn Fn(&mut Stage), parts: &[&str]| {
        let mut stage = stage();
        change(&mut stage);
        is_refused(&stage.write().pontoon(&["plan", "study.json"]), parts);
    };
    // of the file, in the file
    let in_file = |path: &[&str], value: Value, parts: &[&str]| {
        refused(
            &|stage| {
                let mut file = truck();
                let mut at = &mut file;
                for step in path {
                    at = match step.parse::<usize>() {
                        Ok(place) => &mut at[place],
                        Err(_) => &mut at[*step],
                    };
                }
                *at = value.clone();
                stage.json("truck.json", &file);
            },
            parts,
        );
    };
    in_file(
        &["body", "mass_kg"],
        json!(0),
        &["truck.json", "body.mass_kg", "above 0"],
    );
    in_file(
        &["axles", "0", "unsprung_mass_kg"],
        json!(null),
        &["axles[0].unsprung_mass_kg", "between tyres and suspension"],
    );
    in_file(
        &["axles", "0", "unsprung_mass_kg"],
        json!(-600),
        &["axles[0].unsprung_mass_kg", "-600"],
    );
    in_file(
        &["axles", "1", "tyre_stiffness_n_m"],
        json!(0),
        &["axles[1].tyre_stiffness_n_m", "above 0"],
    );
    in_file(
        &["axles", "1", "suspension_stiffness_n_m"],
        json!(0),
        &["axles[1].suspension_stiffness_n_m", "above 0"],
    );
    in_file(
        &["axles", "1", "tyre_damping_n_s_m"],
        json!(-1),
        &["axles[1].tyre_damping_n_s_m", "at least 0"],
    );
    in_file(
        &["axles", "1", "suspension_damping_n_s_m"],
        json!(-1),
        &["axles[1].suspension_damping_n_s_m"],
    );
    in_file(
        &["axles", "0", "track_y_m"],
        json!([-1.0, 5.0]),
        &["truck.json", "axles[0].track_y_m[1]", "4.041"],
    );
    in_file(
        &["axles", "0", "load_n"],
        json!(30_000),
        &["axles[0].load_n", "the masses give"],
    );
    in_file(&["body", "behind_front_m"], json!(5.0), &["body", "lifts axle 1"]);
    in_file(
        &["body", "pitch_inertia_kg_m2"],
        json!(null),
        &["body.pitch_inertia_kg_m2", "moment of inertia"],
    );
    in_file(&["body", "roll_inertia_kg_m2"], json!(0), &["body.roll_inertia_kg_m2"]);
    in_file(
        &["body"],
        json!(null),
        &[
            "axles[0].suspension_stiffness_n_m",
            "a body that the suspension carries",
        ],
    );
    in_file(&["axels"], json!([]), &["truck.json", "axels"]);
    in_file(
        &["axles"],
        json!([{ "behind_front_m": 2.9, "patch_length_m": 0.3, "track_y_m": [0], "suspension_stiffness_n_m": 1e6 }]),
        &["body", "no spring holds"],
    );
    // of the traffic, in the study
    let traffic = |entries: Value, parts: &[&str]| {
        refused(
            &|stage| {
                stage.study["record"]["histories"] = json!({});
                stage.study["traffic"] = entries.clone();
            },
            parts,
        );
    };
    traffic(json!([]), &["traffic", "an empty list"]);
    traffic(json!([{ "y_m": 3.5 }]), &["traffic[0].y_m", "3.041"]);
    traffic(json!([{ "direction": 2 }]), &["traffic[0].direction", "1 or -1"]);
    traffic(json!([{ "speed_m_s": 0 }]), &["traffic[0].speed_m_s"]);
    traffic(json!([{ "load_n": -1 }]), &["traffic[0].load_n"]);
    traffic(
        json!([{ "behind_m": 10 }]),
        &["traffic[0].behind_m", "before it in the list"],
    );
    traffic(
        json!([{}, { "behind_m": 10, "start_time_s": 3 }]),
        &["traffic[1].behind_m", "one of the two"],
    );
    traffic(
        json!([{ "speed_m_s": 4 }, { "speed_m_s": 9, "start_time_s": 3 }]),
        &["traffic", "vehicles 1 and 2", " m at ", " s"],
    );
    traffic(
        json!([{ "speed_m_s": 4 }, { "speed_m_s": 4, "direction": -1 }]),
        &["vehicles 1 and 2", "10.05 m at"],
    );
    traffic(
        json!([{ "acceleration_m_s2": -3 }]),
        &["traffic[0].acceleration_m_s2", "stop_x_m"],
    );
    traffic(
        json!([{ "acceleration_m_s2": -1, "stop_x_m": 4 }]),
        &["traffic[0].stop_x_m", "brakes in"],
    );
    traffic(
        json!([{ "acceleration_m_s2": 1, "stop_x_m": 19 }]),
        &["traffic[0].acceleration_m_s2", "below 0"],
    );
    traffic(
        json!([{ "acceleration_m_s2": -9, "stop_x_m": 21 }]),
        &["traffic[0].stop_x_m", "on the bridge"],
    );
    traffic(json!([{ "vehicle": "none.json" }]), &["traffic[0].vehicle", "no file"]);
    refused(
        &|stage| stage.study["vehicle"] = json!("none.json"),
        &["vehicle", "no file"],
    );
    refused(
        &|stage| {
            stage.study["design"] = json!([{ "grid": { "vehicle": ["truck.json", "none.json"], "speed_m_s": 6 } }])
        },
        &["design[0].grid.vehicle[1]", "no file"],
    );
    refused(
        &|stage| stage.study["column"] = json!({ "count": 2, "spacing_m": 0.5, "spacing_from": "centre" }),
        &["column.spacing_m", "vehicles 1 and 2"],
    );
    refused(
        &|stage| stage.study["column"] = json!({ "count": 0, "spacing_m": 30 }),
        &["column.count"],
    );
    refused(
        &|stage| {
            stage.study["column"] = json!({ "count": 2, "spacing_m": 30 });
            stage.study["traffic"] = json!([{}]);
        },
        &["column", "beside a traffic"],
    );
    refused(
        &|stage| stage.study["record"]["histories"] = json!({ "vehicles": [2] }),
        &["record.histories.vehicles[0]"],
    );
    refused(
        &|stage| {
            stage.study["vehicle"] = json!({ "footprint_length_m": 3.0 });
            stage.study["design"] = json!([{ "grid": { "speed_m_s": 6, "load_n": 1e5 } }]);
        },
        &["record.histories.vehicles[0]", "without springs"],
    );
    // of the road
    let road = |roughness: Value, parts: &[&str]| refused(&|stage| stage.study["roughness"] = roughness.clone(), parts);
    road(json!({}), &["roughness", "exactly one of"]);
    road(
        json!({ "table": [[0, 0], [20.2, 0]], "iso_8608": "C" }),
        &["roughness", "table and iso_8608"],
    );
    road(
        json!({ "table": [[0, 0], [15, 0.01]] }),
        &["roughness.table", "the whole bridge"],
    );
    road(json!({ "table": [[0, 0], [0, 0.01]] }), &["roughness.table[1][0]"]);
    road(
        json!({ "table": [[0, 0], [30, 0]], "seed": 3 }),
        &["roughness.seed", "iso_8608"],
    );
    road(
        json!({ "bump": { "x_m": 5, "length_m": 0, "height_m": 0.02 } }),
        &["roughness.bump.length_m"],
    );
    road(
        json!({ "step": { "x_m": 50, "length_m": 1, "height_m": 0.02 } }),
        &["roughness.step.x_m"],
    );
    road(
        json!({ "iso_8608": "C", "run_in_m": 200 }),
        &["roughness.waves", "at least"],
    );
    refused(
        &|stage| {
            stage.study["vehicle"] = json!({ "footprint_length_m": 3.0 });
            stage.study["record"]["histories"] = json!({});
            stage.study["roughness"] = json!({ "iso_8608": "C" });
            stage.study["design"] = json!([{ "grid": { "speed_m_s": 6, "load_n": 1e5 } }]);
        },
        &["roughness", "without a spring"],
    );
    refused(
        &|stage| {
            stage.study["analysis"] = json!({ "kind": "static" });
            stage.study["record"]["histories"] = json!({});
            stage.study["traffic"] = json!([{}]);
            stage.study["design"] = json!([{ "grid": { "load_position": 2, "load_n": 1e5 } }]);
        },
        &["traffic", "study of crossings"],
    );
}

/// A stiff spring on a point is a doubt, which refuses nothing.
#[test]
fn a_stiff_spring_on_a_point_is_a_doubt() {
    let stage = stage();
    let mut stiff = truck();
    stiff["axles"][0]["tyre_stiffness_n_m"] = json!(5e7);
    stiff["axles"][0]["patch_length_m"] = json!(0);
    stage.json("truck.json", &stiff);
    let told = stage.write().pontoon(&["plan", "study.json"]);
    let text = String::from_utf8_lossy(&told.stderr).into_owned() + &stdout(&told);
    assert!(told.status.success() && text.contains("a patch of no length"), "{text}");
}
