//! `pontoon water`: a water that is what radiation has to be, and waters that are not.

use crate::stage::{Stage, is_refused, stderr, stdout};
use serde_json::{Value, json};
use std::f64::consts::{FRAC_2_PI, TAU};
use std::fs;
use std::process::Output;

/// Modules of the smoke bridge, and the freedoms of each.
const MODULES: usize = 3;
const FREEDOMS: usize = 3;
/// Damping at its largest `[N s/m]`, added mass at infinite frequency `[kg]`.
const DAMPING: f64 = 2e4;
const INFINITE: f64 = 3e4;

/// Damping of a module over frequency: none at 0, and none to speak of from 5 rad/s on.
fn damping(omega: f64) -> f64 {
    DAMPING * omega * omega * (1.0 - 0.5 * omega * omega).exp() / 2.0
}

/// Added mass of the same water: `A_inf - (1/w) int k sin wt dt` with `k = (2/pi) int B cos wt dw` (Kramers and Kronig).
fn added_mass(omega: f64) -> f64 {
    let (step, to) = (0.02, 8.0);
    let memory = |t: f64| -> f64 {
        let grid = (0..400).map(|i| to * (f64::from(i) + 0.5) / 400.0);
        FRAC_2_PI * grid.map(|w| damping(w) * (w * t).cos()).sum::<f64>() * to / 400.0
    };
    let times = (0..1000).map(|i| step * (f64::from(i) + 0.5));
    // (sin wt)/w is t at w = 0
    let over = |t: f64| if omega == 0.0 { t } else { (omega * t).sin() / omega };
    INFINITE - times.map(|t| memory(t) * over(t) * step).sum::<f64>()
}

/// The upper triangle of a matrix that has a number on its diagonal, row by row.
fn diagonal(number: f64) -> Vec<f64> {
    let order = FREEDOMS * MODULES;
    let row = |i: usize| (i..order).map(move |j| if i == j { number } else { 0.0 });
    (0..order).flat_map(row).collect()
}

pub(super) fn stage() -> Stage {
    let stage = Stage::new();
    fs::copy(
        concat!(env!("CARGO_MANIFEST_DIR"), "/../../studies/bridges/smoke.json"),
        stage.path("bridge.json"),
    )
    .unwrap();
    stage
}

/// A water for the smoke bridge with the water plane that its stiffness asks for.
pub(super) fn water(stage: &Stage) -> Value {
    let bridge: Value = serde_json::from_slice(&fs::read(stage.path("bridge.json")).unwrap()).unwrap();
    let stiffness = bridge["hydrostatic_stiffness_pa_m"].as_f64().unwrap();
    let breadth_m = stiffness * bridge["module"]["breadth_m"].as_f64().unwrap() / 9810.0;
    let omega: Vec<f64> = (0..=25).map(|i| 0.2 * f64::from(i)).collect();
    json!({
        "name": "made", "source": { "program": "a test" }, "modules": MODULES,
        "module_length_m": bridge["module"]["length_m"], "depth_m": null, "density_kg_m3": 1000, "gravity_m_s2": 9.81,
        "hull": "box", "waterline_breadth_m": breadth_m, "freedoms": ["heave", "pitch", "roll"], "omega_rad_s": omega,
        "added_mass": omega.iter().map(|&w| diagonal(added_mass(w))).collect::<Vec<_>>(),
        "radiation_damping": omega.iter().map(|&w| diagonal(damping(w))).collect::<Vec<_>>(),
        "infinite_added_mass": diagonal(INFINITE),
    })
}

/// The object that `pontoon water` prints of a water, with its exit status.
fn judged(stage: &Stage, water: &Value) -> (Option<i32>, Value) {
    fs::write(stage.path("water.json"), water.to_string()).unwrap();
    let output = stage.pontoon(&["water", "water.json", "--bridge", "bridge.json", "--format", "json"]);
    let text = stdout(&output);
    let found = serde_json::from_str(&text).unwrap_or_else(|e| panic!("{e}: {text}{}", stderr(&output)));
    (output.status.code(), found)
}

fn check<'a>(found: &'a Value, name: &str) -> &'a Value {
    let checks = found["judged"]["checks"].as_array().unwrap();
    checks
        .iter()
        .find(|check| check["check"] == name)
        .unwrap_or_else(|| panic!("{name}: {found}"))
}

fn scaled(matrices: &Value, by: impl Fn(usize) -> f64) -> Value {
    let number = |x: &Value, i: usize| json!(x.as_f64().unwrap() * by(i));
    let of =
        |(i, matrix): (usize, &Value)| -> Value { matrix.as_array().unwrap().iter().map(|x| number(x, i)).collect() };
    matrices.as_array().unwrap().iter().enumerate().map(of).collect()
}

#[test]
fn a_water_of_one_causal_fluid_holds_and_is_written() {
    let stage = stage();
    let good = water(&stage);
    let (status, found) = judged(&stage, &good);
    assert_eq!(status, Some(0), "{found}");
    let checks = found["judged"]["checks"].as_array().unwrap();
    assert!(
        checks.len() >= 9 && checks.iter().all(|check| check["outcome"] == "holds"),
        "{found}"
    );
    // the closed forms: A_inf, and k(0) = (2/pi) int B dw = (2/pi) e B/2 sqrt(tau)/2
    let per_m = MODULES as f64 / (good["module_length_m"].as_f64().unwrap() * MODULES as f64);
    let near = |key: &str, expected: f64| {
        let found = found["judged"][key].as_f64().unwrap();
        assert!((found / expected - 1.0).abs() < 2e-3, "{key}: {found}, not {expected}");
    };
    near("infinite_heave_kg_m", INFINITE * per_m);
    near(
        "memory_heave_n_m2",
        FRAC_2_PI * DAMPING / 2.0 * 1.0_f64.exp() * TAU.sqrt() / 2.0 * per_m,
    );
    let output = stage.pontoon(&[
        "water",
        "water.json",
        "--bridge",
        "bridge.json",
        "--out",
        "out/water.json",
    ]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(
        stdout(&output).contains("3 modules, 26 frequencies, 0 to 5 rad/s, deep"),
        "{}",
        stdout(&output)
    );
    let written: Value = serde_json::from_slice(&fs::read(stage.path("out/water.json")).unwrap()).unwrap();
    let (status, again) = judged(&stage, &written);
    // written at seven digits
    let outcomes = |found: &Value| -> Vec<Value> {
        let checks = found["judged"]["checks"].as_array().unwrap();
        checks.iter().map(|check| check["outcome"].clone()).collect()
    };
    assert_eq!((status, outcomes(&again)), (Some(0), outcomes(&found)));
    // the reader's word stands for names and for the band; what holds for BEM codes alone is refused
    let told = |more: &[&str]| stage.pontoon(&[&["water", "water.json"], more].concat());
    let output = told(&["--usable-to-rad-s", "4.5", "--name", "other", "--out", "told.json"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let written: Value = serde_json::from_slice(&fs::read(stage.path("told.json")).unwrap()).unwrap();
    assert_eq!(
        (&written["usable_to_rad_s"], &written["name"]),
        (&json!(4.5), &json!("other"))
    );
    is_refused(&told(&["--usable-to-rad-s", "7"]), &["usable_to_rad_s", "below 6.5"]);
    is_refused(&told(&["--modes", "3,5,4"]), &["modes", "WAMIT and NEMOH"]);
    is_refused(&told(&["--length-scale-m", "2"]), &["length_scale_m", "for WAMIT"]);
}

#[test]
fn what_is_wrong_is_told_by_its_check_and_not_written() {
    let stage = stage();
    let good = water(&stage);
    let wrong = |key: &str, value: Value| {
        let mut water = good.clone();
        water[key] = value;
        judged(&stage, &water)
    };
    let damping = &good["radiation_damping"];
    for (key, value, name, outcome) in [
        // more damping than belongs to the added mass
        (
            "radiation_damping",
            scaled(damping, |_| 1.05),
            "kramers_kronig",
            "warns",
        ),
        (
            "radiation_damping",
            scaled(damping, |_| 1.15),
            "kramers_kronig",
            "refused",
        ),
        (
            "radiation_damping",
            scaled(damping, |i| if i == 10 { -0.05 } else { 1.0 }),
            "least_damping",
            "refused",
        ),
        (
            "infinite_added_mass",
            json!(diagonal(1.1 * INFINITE)),
            "infinite_of_table",
            "warns",
        ),
        (
            "waterline_breadth_m",
            json!(1.1 * good["waterline_breadth_m"].as_f64().unwrap()),
            "water_plane",
            "warns",
        ),
        (
            "waterline_breadth_m",
            json!(2.0 * good["waterline_breadth_m"].as_f64().unwrap()),
            "water_plane",
            "refused",
        ),
        ("waterline_breadth_m", Value::Null, "water_plane", "warns"),
        ("usable_to_rad_s", json!(4.5), "last_used_rad_s", "warns"),
        ("usable_to_rad_s", json!(3.5), "last_used_rad_s", "refused"),
    ] {
        let (status, found) = wrong(key, value);
        assert_eq!(check(&found, name)["outcome"], outcome, "{key}: {found}");
        assert_eq!(status, Some(i32::from(outcome == "refused")), "{key}: {found}");
    }
    let mut refused = good.clone();
    refused["usable_to_rad_s"] = json!(3.5);
    fs::write(stage.path("water.json"), refused.to_string()).unwrap();
    let output = stage.pontoon(&["water", "water.json", "--out", "out.json"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(
        !stage.path("out.json").exists() && stderr(&output).contains("not written"),
        "{}",
        stderr(&output)
    );
}

fn refused_at(output: &Output, place: &str) {
    let told = stderr(output);
    assert!(
        output.status.code() == Some(2) && told.contains(place),
        "{place}: {told}"
    );
}

#[test]
fn a_file_that_cannot_be_this_water_is_refused_at_its_place() {
    let stage = stage();
    let good = water(&stage);
    let refused = |key: &str, value: Value, place: &str| {
        let mut water = good.clone();
        water[key] = value;
        fs::write(stage.path("water.json"), water.to_string()).unwrap();
        let output = stage.pontoon(&["water", "water.json", "--bridge", "bridge.json"]);
        refused_at(&output, place);
    };
    refused("module_length_m", json!(6.0), "module_length_m");
    refused("modules", json!(4), "water.json: ");
    refused("depth_m", json!(-1), "depth_m");
    refused("density_kg_m3", json!(0), "density_kg_m3");
    refused("omega_rad_s", json!(vec![1.0; 26]), "omega_rad_s");
    refused("freedoms", json!(["heave", "roll", "pitch"]), "freedoms");
    refused("added_mass", json!([[1.0]]), "added_mass");
    fs::write(stage.path("notes.txt"), "mine").unwrap();
    fs::write(stage.path("water.json"), good.to_string()).unwrap();
    let output = stage.pontoon(&["water", "water.json", "--out", "notes.txt"]);
    refused_at(&output, "a water file");
    assert_eq!(fs::read_to_string(stage.path("notes.txt")).unwrap(), "mine");
    fs::write(stage.path("cut.nc"), b"CDF\x02\x00\x00").unwrap();
    let output = stage.pontoon(&["water", "cut.nc", "--bridge", "bridge.json"]);
    refused_at(&output, "cut.nc: ");
}
