//! `pontoon export`: which files, and what is in them.

use super::export_stage::{Grid, collection, crossings, exported, static_cases};
use crate::stage::{Stage, stdout};
use serde_json::{Value, json};
use std::fs;

#[test]
fn a_bridge_file_becomes_its_modes_as_they_are_named_and_its_static_case() {
    let stage = Stage::new();
    stage.write();
    let told = exported(
        &stage,
        &[
            "bridge.json",
            "--to",
            "vtk",
            "--count",
            "7",
            "--load-n",
            "1e5",
            "--load-position",
            "2",
        ],
    );
    assert_eq!(told["files"], json!(15));
    let files: Vec<&str> = told["parts"]
        .as_array()
        .unwrap()
        .iter()
        .map(|p| p["file"].as_str().unwrap())
        .collect();
    assert_eq!(
        files,
        ["modes.pvd", "static-joints.pvd", "static-vehicle.pvd", "static.pvd"]
    );
    let vtk = stage.path("vtk");
    let steps = collection(&vtk.join("modes.pvd"));
    let modes = stage.pontoon(&["modes", "bridge.json", "--count", "7", "--format", "json"]);
    let modes: Value = serde_json::from_str(&stdout(&modes)).unwrap();
    assert_eq!(steps.len(), 7);
    for (mode, (number, file)) in modes.as_array().unwrap().iter().zip(&steps) {
        let grid = Grid::read(&vtk.join(file));
        assert_eq!((grid.count("NumberOfPoints"), grid.count("NumberOfCells")), (210, 606));
        assert_eq!(json!(grid.text("shape")), mode["shape"]);
        assert_eq!(json!(grid.numbers("frequency_hz")[0]), mode["frequency_hz"]);
        assert_eq!(grid.numbers("number"), [*number]);
        assert_eq!(grid.text("program_version"), env!("CARGO_PKG_VERSION"));
        let displacement = grid.numbers("displacement");
        assert_eq!(displacement.iter().fold(0.0_f64, |most, x| most.max(x.abs())), 1.0);
        assert!(displacement.contains(&1.0));
    }
    let vehicle = Grid::read(&vtk.join("static-vehicle-001.vtu"));
    let weight: f64 = vehicle.numbers("contact_force_n").iter().sum();
    assert!((weight - 1e5).abs() < 1e-6, "{weight}");
}

#[test]
fn supports_gaps_and_connection_change_what_is_shown() {
    let stage = Stage::new();
    stage.write();
    let load = ["bridge.json", "--count", "0", "--load-n", "1e5", "--load-x-m", "6.7"];
    let peak = |to: &str, more: &[&str]| {
        let told = exported(&stage, &[&load[..], more, &["--to", to]].concat());
        told["parts"][2]["peak_deflection_m"].as_f64().unwrap()
    };
    let own = peak("own", &[]);
    let stated = peak("stated", &["--gap-tension-m", "0.028", "--gap-compression-m", "0.0055"]);
    let closed = peak("closed", &["--gap-tension-m", "0", "--gap-compression-m", "0"]);
    let linear = peak("linear", &["--connection", "linear"]);
    assert_eq!(own, stated);
    assert!(own > closed && closed > linear, "{own} {closed} {linear}");
    exported(&stage, &["bridge.json", "--count", "1", "--to", "free"]);
    exported(&stage, &["bridge.json", "--count", "1", "--supports", "--to", "held"]);
    let lowest = |to: &str| Grid::read(&stage.path(to).join("modes-001.vtu")).numbers("frequency_hz")[0];
    assert!(lowest("free") < 1e-3 && lowest("held") > 0.1);
}

#[test]
fn a_crossing_has_the_tables_peaks_at_their_times_and_states_of_its_forces() {
    let stage = crossings();
    stage.ran("out");
    for job in [0, 1] {
        let to = format!("vtk-{job}");
        exported(
            &stage,
            &[
                "out",
                "--to",
                &to,
                "--job",
                &job.to_string(),
                "--every",
                "1",
                "--count",
                "0",
            ],
        );
        let folder = stage.path(&to);
        let steps = collection(&folder.join("crossing.pvd"));
        assert_eq!(
            steps.len() as f64,
            stage.numbers("out/jobs.parquet", "steps")[job].unwrap() + 1.0
        );
        let column = |name: &str| -> Vec<f64> {
            let of_job = stage.numbers("out/positions.parquet", "job").into_iter();
            let rows = of_job.zip(stage.numbers("out/positions.parquet", name));
            rows.filter(|(j, _)| *j == Some(job as f64))
                .map(|(_, v)| v.unwrap_or(f64::NAN))
                .collect()
        };
        let (x_m, peaks, times) = (
            column("x_m"),
            column("peak_deflection_m"),
            column("peak_deflection_time_s"),
        );
        for i in [1, 2] {
            let (_, file) = steps.iter().find(|(time, _)| (time - times[i]).abs() < 1e-9).unwrap();
            let found = Grid::read(&folder.join(file)).deflection_m(x_m[i]);
            // rounding to single precision
            assert!((found - peaks[i]).abs() <= 2e-7 * peaks[i], "{found} {}", peaks[i]);
            assert!((1.05 * found - peaks[i]).abs() > 2e-7 * peaks[i]);
        }
        let mut most = [0.0_f64; 2];
        for (_, file) in collection(&folder.join("crossing-joints.pvd")) {
            let grid = Grid::read(&folder.join(file));
            let (force, state, link) = (grid.numbers("force_n"), grid.numbers("state"), grid.numbers("link"));
            for ((force, state), link) in force.iter().zip(&state).zip(&link) {
                let expected = if *force == 0.0 {
                    0.0
                } else if *force < 0.0 {
                    1.0
                } else {
                    2.0
                };
                assert_eq!(*state, expected, "{force}");
                if *link == 0.0 {
                    most = [most[0].max(-force), most[1].max(*force)];
                }
            }
        }
        let of_one = |column: &str| -> f64 {
            let rows = stage.numbers("out/connectors.parquet", column).into_iter();
            let keys = stage.numbers("out/connectors.parquet", "job").into_iter();
            let y = stage.numbers("out/connectors.parquet", "y_m").into_iter();
            let own = rows
                .zip(keys)
                .zip(y)
                .filter(|((_, j), y)| *j == Some(job as f64) && y.is_some());
            own.filter_map(|((value, _), _)| value).fold(0.0, f64::max)
        };
        assert_eq!(most, [of_one("peak_compression_n"), of_one("peak_tension_n")]);
    }
}

#[test]
fn the_job_of_the_largest_deflection_is_shown_twenty_times_a_second() {
    let stage = crossings();
    stage.ran("out");
    let told = exported(&stage, &["out", "--to", "vtk", "--count", "2"]);
    let peaks = stage.numbers("out/jobs.parquet", "peak_deflection_m");
    assert!(peaks[1] > peaks[0]);
    let contents: Value = serde_json::from_slice(&fs::read(stage.path("vtk/export.json")).unwrap()).unwrap();
    assert_eq!(
        (&contents["source"]["job"], &contents["source"]["axes"]["gap_tension_m"]),
        (&json!(1), &json!(0))
    );
    let steps = collection(&stage.path("vtk/crossing.pvd"));
    // every third step of 0.02 s, and the last
    let apart: Vec<f64> = steps.windows(2).map(|w| w[1].0 - w[0].0).collect();
    assert!(
        apart[..apart.len() - 1].iter().all(|d| (d - 0.06).abs() < 1e-9),
        "{apart:?}"
    );
    assert_eq!(told["files"], json!(3 * (steps.len() + 1) + 3 + 1));
}

#[test]
fn a_crossing_of_an_automatic_time_step_is_shown_at_the_step_that_was_found() {
    let mut stage = crossings();
    stage.study["analysis"] =
        json!({ "kind": "crossing", "time_step_s": "auto", "time_step_tolerance": 0.05, "tail_s": 0.5 });
    stage.ran("out");
    exported(
        &stage,
        &["out", "--to", "vtk", "--job", "1", "--every", "1", "--count", "0"],
    );
    let steps = collection(&stage.path("vtk/crossing.pvd"));
    let found = stage.numbers("out/jobs.parquet", "time_step_s")[1].unwrap();
    assert!(
        found < 0.02 && (steps[1].0 - steps[0].0 - found).abs() < 1e-9,
        "{found}"
    );
}

#[test]
fn a_static_study_shows_its_case_and_a_study_of_modes_its_modes() {
    let stage = static_cases();
    stage.ran("out");
    exported(&stage, &["out", "--to", "vtk", "--job", "0", "--count", "0"]);
    let grid = Grid::read(&stage.path("vtk/static-001.vtu"));
    let deflections = stage.numbers("out/positions.parquet", "deflection_m");
    for (i, expected) in deflections[..4].iter().enumerate() {
        let (found, expected) = (grid.deflection_m(6.7 * i as f64), expected.unwrap());
        assert!((found - expected).abs() <= 1e-8, "{found} {expected}");
    }
    let mut stage = Stage::new();
    stage.study["analysis"] = json!({ "kind": "modes", "model": "super-element", "count": 5, "supports": true });
    stage.study["design"] = json!([{ "cases": [{ "bridge.modules": 2 }] }]);
    stage.study["record"] = json!({});
    stage.ran("out");
    let told = exported(&stage, &["out", "--to", "vtk"]);
    assert_eq!(
        (told["files"].clone(), told["parts"][0]["points"].clone()),
        (json!(7), json!(140))
    );
    let expected = stage.numbers("out/modes.parquet", "frequency_hz");
    let found: Vec<_> = collection(&stage.path("vtk/modes.pvd"))
        .iter()
        .map(|(_, file)| Some(Grid::read(&stage.path("vtk").join(file)).numbers("frequency_hz")[0]))
        .collect();
    assert_eq!(found, expected);
}

#[test]
fn a_crossing_that_settled_at_half_its_time_step_is_shown_at_that() {
    let mut stage = crossings();
    let unsettled = json!({ "time_step_s": 0.08, "newton_limit": 2, "bisection_limit": 0 });
    let analysis = stage.study["analysis"].as_object_mut().unwrap();
    analysis.extend(unsettled.as_object().unwrap().clone());
    stage.study["design"] = json!([{ "cases": [{ "gap_tension_m": 0, "gap_compression_m": 0.0055, "speed_m_s": 12,
                                                 "load_n": 2e5 }] }]);
    stage.ran("out");
    let reason = stage
        .table("out/jobs.parquet")
        .column("reason")
        .unwrap()
        .str()
        .unwrap()
        .get(0)
        .map(str::to_owned);
    assert!(reason.unwrap().starts_with("at half the time step"));
    exported(&stage, &["out", "--to", "vtk", "--every", "1", "--count", "0"]);
    let steps = collection(&stage.path("vtk/crossing.pvd"));
    assert_eq!(
        steps.len() as f64,
        stage.numbers("out/jobs.parquet", "steps")[0].unwrap() + 1.0
    );
    assert!((steps[1].0 - steps[0].0 - 0.04).abs() < 1e-9);
}
