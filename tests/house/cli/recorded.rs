//! What is recorded beyond peaks: pins, section forces, places, the response at a peak, from the study to the tables.

use crate::stage::{Stage, is_refused};
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// A stage of two crossings that record everything.
fn stage() -> Stage {
    let mut stage = Stage::new();
    stage.study["design"] = json!([{ "grid": {
        "gap_tension_m": 0.002, "gap_compression_m": 0.001, "speed_m_s": [6, 9], "load_n": 3e5 } }]);
    stage.study["record"] = json!({
        "pins": true, "sections": true, "places_x_m": [6.7, 9.4],
        "at_peak_of": ["peak_deflection_m", { "column": "peak_compression_n", "joint": 3 }, "peak_pin_n"],
        "histories": { "positions": [2], "pins": [2], "sections": [2], "places_x_m": [9.4] }
    });
    stage
}

/// A table to be looked at row by row.
struct Rows {
    height: usize,
    words: BTreeMap<String, Vec<String>>,
    numbers: BTreeMap<String, Vec<Option<f64>>>,
}

impl Rows {
    fn read(stage: &Stage, path: &str) -> Self {
        let table = stage.table(path);
        let mut rows = Self {
            height: table.height(),
            words: BTreeMap::new(),
            numbers: BTreeMap::new(),
        };
        for name in table.names() {
            let column = table.column(&name).unwrap();
            match column.str() {
                Some(cells) => {
                    let words = cells.iter().map(|cell| cell.unwrap_or_default().to_owned());
                    rows.words.insert(name, words.collect());
                }
                None => {
                    rows.numbers.insert(name, column.numbers());
                }
            }
        }
        rows
    }

    fn number(&self, column: &str, row: usize) -> Option<f64> {
        self.numbers[column][row]
    }

    /// A cell as text, nothing of an empty one.
    fn cell(&self, column: &str, row: usize) -> String {
        match self.words.get(column) {
            Some(words) => words[row].clone(),
            None => self.number(column, row).map(|x| x.to_string()).unwrap_or_default(),
        }
    }

    /// Rows in which columns have values.
    fn rows(&self, of: &[(&str, &str)]) -> Vec<usize> {
        let fits = |row: &usize| of.iter().all(|(column, value)| self.cell(column, *row) == *value);
        (0..self.height).filter(fits).collect()
    }
}

#[test]
fn what_holds_at_a_peak_is_one_state_of_the_bridge() {
    let stage = stage();
    stage.ran("r");
    let peaks = stage.numbers("r/jobs.parquet", "peak_deflection_m");
    let table = Rows::read(&stage, "r/at_peaks.parquet");
    for (job, peak) in peaks.iter().enumerate() {
        let own = |of: &str| -> BTreeMap<String, f64> {
            let rows = table.rows(&[("job", &job.to_string()), ("at_peak_of", of)]);
            let key = |row: usize| {
                ["quantity", "position", "x_m", "y_m"]
                    .map(|column| table.cell(column, row))
                    .join(" ")
            };
            rows.into_iter()
                .map(|row| (key(row), table.number("value", row).unwrap()))
                .collect()
        };
        let at = own("peak_deflection_m");
        let deflections = at.iter().filter(|(key, _)| key.starts_with("deflection_m"));
        let largest = deflections.map(|(_, value)| *value).fold(0.0, f64::max);
        assert_eq!(Some(largest), *peak);
        // the place on position 2 is that position; a joint's force is the sum of its connectors
        assert_eq!(at["deflection_m  6.7 "], at["deflection_m 2  "]);
        let sum = |of: &str| -> f64 {
            let each = at.iter().filter(|(key, _)| key.starts_with(of) && !key.ends_with(' '));
            each.map(|(_, value)| value).sum()
        };
        assert_eq!(at["force_n 2  "], sum("force_n 2 "));
        // section forces are the sums of pins, and bending is what connectors do
        let off = |found: f64, expected: f64| (found - expected).abs() / 3e5;
        assert!(off(at["shear_z_n 2  "], sum("pin_z_n 2 ")) < 1e-12);
        assert!(off(at["axial_n 2  "], sum("pin_x_n 2 ") + sum("force_n 2 ")) < 0.02);
        assert!(
            at["bending_nm 2  "] > 1e5 && at["angle_rad 2  "] < 0.0,
            "the deck is compressed"
        );
        // another peak has another state
        assert_ne!(own("peak_pin_n")["deflection_m 2  "], at["deflection_m 2  "]);
    }
    // joint 3 was asked for by its number
    let named = table.rows(&[("at_peak_of", "peak_compression_n")]);
    assert!(!named.is_empty() && named.iter().all(|row| table.number("peak_at", *row) == Some(3.0)));
}

#[test]
fn peaks_of_pins_and_sections_are_the_largest_of_their_histories() {
    let stage = stage();
    stage.ran("r");
    let histories = Rows::read(&stage, "r/histories.parquet");
    let largest = |quantity: &str, y_m: &str, sign: f64| {
        let rows = histories.rows(&[("job", "1"), ("quantity", quantity), ("y_m", y_m)]);
        let values = rows.iter().map(|row| sign * histories.number("value", *row).unwrap());
        values.fold(0.0, f64::max)
    };
    let pins = Rows::read(&stage, "r/pins.parquet");
    let row = pins.rows(&[("job", "1"), ("joint", "2")])[0];
    for (column, quantity, sign) in [
        ("peak_plus_x_n", "pin_x_n", 1.0),
        ("peak_minus_z_n", "pin_z_n", -1.0),
        ("peak_plus_z_n", "pin_z_n", 1.0),
    ] {
        let expected = largest(quantity, &pins.cell("y_m", row), sign);
        assert_eq!(pins.number(column, row), Some(expected), "{column}");
    }
    let sections = Rows::read(&stage, "r/sections.parquet");
    for quantity in ["angle_rad", "bending_nm", "shear_z_n"] {
        let row = sections.rows(&[("job", "1"), ("joint", "2"), ("quantity", quantity)])[0];
        for (column, sign) in [("peak_minus", -1.0), ("peak_plus", 1.0)] {
            let expected = largest(quantity, "", sign);
            assert_eq!(sections.number(column, row), Some(expected), "{quantity} {column}");
        }
    }
    let jobs = stage.numbers("r/jobs.parquet", "peak_bending_nm")[1].unwrap();
    assert!(jobs >= largest("bending_nm", "", 1.0));
}

#[test]
fn what_is_recorded_changes_no_other_number_and_survives_a_second_run() {
    let mut stage = stage();
    stage.ran("all");
    let plain = |stage: &mut Stage| stage.study["record"] = json!({ "histories": { "positions": [2] } });
    let tables = ["jobs", "pins", "sections", "places", "at_peaks", "histories"];
    let read = |stage: &Stage, folder: &str, name: &str| stage.table(&format!("{folder}/{name}.parquet"));
    let first: Vec<_> = tables.iter().map(|name| read(&stage, "all", name)).collect();
    // from the journal alone
    for name in tables {
        std::fs::remove_file(stage.path(&format!("all/{name}.parquet"))).unwrap();
    }
    stage.ran("all");
    for (name, first) in tables.iter().zip(&first) {
        assert!(read(&stage, "all", name).same_cells(first), "{name}");
    }
    plain(&mut stage);
    stage.ran("plain");
    for name in ["positions", "connectors"] {
        assert!(
            read(&stage, "all", name).same_cells(&read(&stage, "plain", name)),
            "{name}"
        );
    }
    assert!(!stage.path("plain/pins.parquet").exists());
}

#[test]
fn a_bridge_of_one_module_answers_at_its_places() {
    let mut stage = Stage::new();
    stage.bridge["modules"] = json!(1);
    stage.study["analysis"]["damping"] = json!({ "ratio": 0.02, "frequencies_hz": [0.4, 2.0] });
    stage.study["design"] = json!([{ "grid": { "connection": "linear", "speed_m_s": [6], "load_n": 3e5 } }]);
    stage.study["record"] = json!({ "places_x_m": [0, 3.35], "pins": true, "sections": true });
    stage.ran("r");
    let peaks = stage.numbers("r/places.parquet", "peak_deflection_m");
    // the module bends between its supports
    assert!(peaks[1] > Some(5e-4), "{peaks:?}");
    assert_eq!(peaks[0], stage.numbers("r/positions.parquet", "peak_deflection_m")[0]);
    assert_eq!(stage.table("r/pins.parquet").height(), 0);
    // and a load that stands, deepest under itself
    stage.study["analysis"] = json!({ "kind": "static" });
    stage.study["design"] = json!([{ "grid": { "connection": "linear", "load_x_m": [3.35], "load_n": 3e5 } }]);
    stage.ran("s");
    assert!(stage.numbers("s/places.parquet", "deflection_m")[1] > Some(5e-4));
}

#[test]
fn records_of_what_is_not_there_are_refused_at_their_key() {
    let refused = |record: Value, parts: &[&str]| {
        let mut stage = stage();
        stage.study["record"] = record;
        let output = stage.write().pontoon(&["plan", "study.json"]);
        is_refused(&output, parts);
    };
    refused(
        json!({ "places_x_m": [3.0, 99.0] }),
        &["study.json: record.places_x_m[1]: found 99, allowed: 0 to 20.1"],
    );
    refused(json!({ "places_x_m": [-1] }), &["record.places_x_m[0]: found -1"]);
    refused(
        json!({ "places_x_m": [3.0, 3.0] }),
        &["record.places_x_m[1]: found 3 twice, allowed: each place once"],
    );
    refused(
        json!({ "places_x_m": [3.0], "histories": { "places_x_m": [4.0] } }),
        &["record.histories.places_x_m[0]: found 4, allowed: a place of record.places_x_m"],
    );
    refused(
        json!({ "histories": { "pins": [4] } }),
        &["record.histories.pins[0]: found 4, allowed: 2 to 3"],
    );
    refused(
        json!({ "histories": { "sections": [2, 2] } }),
        &["record.histories.sections[1]: found 2 twice, allowed: each number once"],
    );
    refused(
        json!({ "at_peak_of": ["peak_pin_n"] }),
        &["record.at_peak_of[0]: found \"peak_pin_n\", without record.pins"],
    );
    refused(
        json!({ "at_peak_of": ["peak_roll_rad"] }),
        &["record.at_peak_of[0]", "peak_deflection_m"],
    );
    refused(
        json!({ "at_peak_of": [{ "column": "peak_deflection_m", "joint": 2 }] }),
        &["record.at_peak_of[0].joint: found 2, allowed: position"],
    );
    refused(
        json!({ "at_peak_of": [{ "column": "peak_tension_n", "joint": 9 }] }),
        &["record.at_peak_of[0].joint: found 9, allowed: 2 to 3"],
    );
    refused(
        json!({ "at_peak_of": ["peak_tension_n", "peak_tension_n"] }),
        &["record.at_peak_of[1]: found \"peak_tension_n\" twice, allowed: each peak once"],
    );
    // a bridge that an axis makes shorter
    let mut stage = stage();
    stage.study["design"][0]["grid"]["bridge.modules"] = json!([3, 1]);
    let output = stage.write().pontoon(&["plan", "study.json"]);
    is_refused(&output, &["record.", "allowed: "]);
}
