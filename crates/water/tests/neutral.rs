//! The neutral form is written, read back and refused at its keys.
//!
//! Knows the keys of a water file. Does not know physics: the numbers are none.

#![allow(clippy::unwrap_used)]

use pontoon_plan::input::{Document, Refusal, RefusalKind};
use pontoon_plan::schema::water as schema;
use pontoon_plan::water_file::{WaterFile, triangle_length};
use pontoon_water::{Options, WaterFormat, read};
use serde_json::{Value, json};
use std::path::Path;
use tempfile::TempDir;

fn written() -> Value {
    let triangle: Vec<f64> = (0..21).map(|i| 1000.0 + f64::from(i)).collect();
    json!({
        "name": "two", "source": { "program": "by hand" }, "modules": 2, "module_length_m": 6.0, "depth_m": null,
        "density_kg_m3": 1000, "gravity_m_s2": 9.81, "hull": "a box", "waterline_breadth_m": 5.5, "draught_m": 0.2,
        "freedoms": ["heave", "pitch", "roll"], "omega_rad_s": [0, 0.5],
        "added_mass": [triangle, triangle], "radiation_damping": [triangle, triangle], "infinite_added_mass": triangle
    })
}

fn water(value: &Value) -> Result<WaterFile, Refusal> {
    WaterFile::of(Path::new("w.json"), &Document::from(value))
}

#[test]
fn what_is_written_is_read_back() {
    let mut one = water(&written()).unwrap();
    assert_eq!(one.usable_to_rad_s, 5.0);
    one.added_mass[0][3] = 123_456.789;
    one.added_mass[1][4] = -1.234_567_89e-3;
    one.added_mass[1][5] = 1e-13;
    one.depth_m = Some(4.0);
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("water.json");
    std::fs::write(&file, one.text()).unwrap();
    let other = WaterFile::open(&file).unwrap();
    assert_eq!(other.added_mass[0][3], 123_456.8);
    assert_eq!((other.added_mass[1][4], other.added_mass[1][5]), (-1.234_568e-3, 0.0));
    (one.added_mass[0][3], one.added_mass[1][4], one.added_mass[1][5]) = (123_456.8, -1.234_568e-3, 0.0);
    assert_eq!(other, one);
    // the text of what was read is the text that was read
    assert_eq!(other.text(), std::fs::read_to_string(&file).unwrap());
    let reading = read(&file, &Options::default()).unwrap();
    assert_eq!((reading.format, reading.water), (WaterFormat::Neutral, one));
    let options = Options {
        modules: Some(3),
        ..Options::default()
    };
    assert_eq!(read(&file, &options).unwrap_err().path, "modules");
}

#[test]
fn a_file_without_limits_is_written_too() {
    let mut value = written();
    for key in ["infinite_added_mass", "waterline_breadth_m", "draught_m"] {
        value.as_object_mut().unwrap().remove(key);
    }
    value["module_length_m"] = json!([6, 7.5]);
    let one = water(&value).unwrap();
    let other: Value = serde_json::from_str(&one.text()).unwrap();
    assert_eq!(water(&other).unwrap(), one);
    assert_eq!(
        (one.module_length_m.of(1), one.module_length_m.of(2)),
        (Some(7.5), None)
    );
}

#[test]
fn a_bridge_of_15_modules_at_27_frequencies_stays_small() {
    let mut one = water(&written()).unwrap();
    let length = triangle_length(45);
    let triangle: Vec<f64> = (0..length).map(|i| (i as f64 + 0.5).sin() * 1e5).collect();
    one.modules = 15;
    one.omega_rad_s = (0..27).map(|i| 0.2 * f64::from(i)).collect();
    one.added_mass = vec![triangle.clone(); 27];
    one.radiation_damping = vec![triangle.clone(); 27];
    one.infinite_added_mass = Some(triangle);
    one.check(Path::new("w.json")).unwrap();
    assert!(one.text().len() < 700_000, "{}", one.text().len());
}

#[test]
fn what_is_no_water_is_refused_at_its_key() {
    for (place, value, path, kind) in [
        ("/name", json!(" "), "name", RefusalKind::NotAllowed),
        ("/source/blake3", json!("12"), "source.blake3", RefusalKind::NotAllowed),
        ("/modules", json!(0), "modules", RefusalKind::NotAllowed),
        ("/modules", json!(3), "added_mass[0]", RefusalKind::Conflict),
        (
            "/module_length_m",
            json!("6"),
            "module_length_m",
            RefusalKind::WrongType,
        ),
        ("/module_length_m", json!(0), "module_length_m", RefusalKind::NotAllowed),
        ("/module_length_m", json!([6]), "module_length_m", RefusalKind::Conflict),
        (
            "/module_length_m",
            json!([6, -1]),
            "module_length_m[1]",
            RefusalKind::NotAllowed,
        ),
        ("/depth_m", json!(0), "depth_m", RefusalKind::NotAllowed),
        ("/depth_m", json!(0.2), "depth_m", RefusalKind::Conflict),
        ("/density_kg_m3", json!(-1), "density_kg_m3", RefusalKind::NotAllowed),
        ("/gravity_m_s2", json!(0), "gravity_m_s2", RefusalKind::NotAllowed),
        ("/usable_to_rad_s", json!(0), "usable_to_rad_s", RefusalKind::NotAllowed),
        (
            "/freedoms",
            json!(["heave", "pitch"]),
            "freedoms",
            RefusalKind::NotAllowed,
        ),
        (
            "/freedoms",
            json!(["heave", "roll", "pitch"]),
            "freedoms[1]",
            RefusalKind::NotAllowed,
        ),
        (
            "/freedoms",
            json!(["heave", "pitch", "rol"]),
            "freedoms[2]",
            RefusalKind::UnknownWord,
        ),
        ("/omega_rad_s", json!([]), "omega_rad_s", RefusalKind::NotAllowed),
        (
            "/omega_rad_s",
            json!([-1, 2]),
            "omega_rad_s[0]",
            RefusalKind::NotAllowed,
        ),
        ("/omega_rad_s", json!([1, 1]), "omega_rad_s[1]", RefusalKind::NotAllowed),
        ("/omega_rad_s", json!([2, 1]), "omega_rad_s[1]", RefusalKind::NotAllowed),
        ("/omega_rad_s", json!([1, 2, 3]), "added_mass", RefusalKind::Conflict),
        (
            "/radiation_damping/1",
            json!([1, 2]),
            "radiation_damping[1]",
            RefusalKind::Conflict,
        ),
        (
            "/added_mass/1/3",
            json!(null),
            "added_mass[1][3]",
            RefusalKind::WrongType,
        ),
        (
            "/infinite_added_mass",
            json!([1]),
            "infinite_added_mass",
            RefusalKind::Conflict,
        ),
        ("/added_masses", json!([1]), "added_masses", RefusalKind::UnknownKey),
    ] {
        let mut document = written();
        let (parent, key) = place.rsplit_once('/').unwrap();
        match document.pointer_mut(parent).unwrap() {
            Value::Array(list) => list[key.parse::<usize>().unwrap()] = value,
            object => object[key] = value,
        }
        let e = water(&document).unwrap_err();
        assert_eq!((e.path.as_str(), e.kind), (path, kind), "{place}: {e}");
    }
    for key in ["depth_m", "name", "source", "omega_rad_s", "added_mass", "freedoms"] {
        let mut document = written();
        document.as_object_mut().unwrap().remove(key);
        let e = water(&document).unwrap_err();
        assert_eq!((e.path.as_str(), e.kind), (key, RefusalKind::Missing), "{e}");
    }
}

#[test]
fn numbers_that_are_made_and_not_read_are_checked_too() {
    let mut one = water(&written()).unwrap();
    one.added_mass[1][2] = f64::NAN;
    let e = one.check(Path::new("w.json")).unwrap_err();
    assert_eq!((e.path.as_str(), e.found.text().as_str()), ("added_mass[1][2]", "NaN"));
}

#[test]
fn the_schema_asks_for_the_depth() {
    let schema = schema();
    let required = schema["required"].as_array().unwrap();
    assert!(
        required.contains(&json!("depth_m")) && !required.contains(&json!("draught_m")),
        "{required:?}"
    );
    assert_eq!(schema["additionalProperties"], json!(false));
}
