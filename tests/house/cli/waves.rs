//! A bridge in water with memory, from its files to the tables and the manifest.

use super::water::water;
use crate::stage::{Stage, is_refused, stderr};
use serde_json::{Value, json};
use std::fs;

/// The stage's bridge in the water of `water.json`, which is that of the smoke bridge.
fn stage() -> Stage {
    let mut stage = super::water::stage();
    let made = water(&stage);
    fs::write(stage.path("water.json"), made.to_string()).unwrap();
    stage.bridge = serde_json::from_slice(&fs::read(stage.path("bridge.json")).unwrap()).unwrap();
    stage.bridge.as_object_mut().unwrap().remove("added_mass_kg_m");
    stage.bridge["water"] = json!({ "file": "water.json" });
    stage.study["design"] = json!([{ "grid": {
        "gap_tension_m": 0.004, "gap_compression_m": 0.001, "speed_m_s": [4, 8], "load_n": 2e5 } }]);
    stage.study["analysis"]["damping"] = json!({ "structure": { "ratio": 0.02, "at_hz": 1.0 } });
    stage
}

fn json_file(stage: &Stage, file: &str) -> Value {
    serde_json::from_slice(&fs::read(stage.path(file)).unwrap()).unwrap()
}

#[test]
fn waves_take_energy_and_the_manifest_tells_the_water() {
    let mut stage = stage();
    stage.ran("r");
    let radiated = stage.numbers("r/jobs.parquet", "radiated_energy_j");
    let least = stage.numbers("r/jobs.parquet", "least_radiated_energy_j");
    let residual = stage.numbers("r/jobs.parquet", "energy_residual");
    for job in 0..radiated.len() {
        assert!(radiated[job].unwrap() > 10.0, "{radiated:?}");
        assert!(least[job].unwrap() > -1e-6, "{least:?}");
        assert!(residual[job].unwrap() < 1e-11, "{residual:?}");
    }
    let manifest = json_file(&stage, "r/manifest.json");
    let told = manifest.to_string();
    for word in [
        "\"water\"",
        "\"states\"",
        "\"kernel_error\"",
        "\"passivity\"",
        "\"accepted\":[]",
    ] {
        assert!(told.contains(word), "{word}: {told}");
    }
    // the operator comes whole from the cache, and the same bytes with it
    let first = fs::read(stage.path("r/jobs.parquet")).unwrap();
    for (out, told) in [("kept", "\"from_cache\":0"), ("again", "\"from_cache\":1")] {
        let output = stage.pontoon_with(&["run", "study.json", "--out", out, "--quiet"], &stage.path("cache"));
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        assert_eq!(fs::read(stage.path(&format!("{out}/jobs.parquet"))).unwrap(), first);
        let manifest = json_file(&stage, &format!("{out}/manifest.json")).to_string();
        assert!(manifest.contains(told), "{manifest}");
    }
    // the reference solver is near, at the tolerance of operators
    stage.study["analysis"]["solver"] = json!("reference");
    stage.ran("direct");
    let peaks = ["r", "direct"].map(|of| stage.numbers(&format!("{of}/jobs.parquet"), "peak_deflection_m"));
    for (found, expected) in peaks[0].iter().zip(&peaks[1]) {
        let (found, expected) = (found.unwrap(), expected.unwrap());
        assert!((found / expected - 1.0).abs() < 5e-3, "{peaks:?}");
    }
    // other water has no such columns
    stage.bridge["added_mass_kg_m"] = json!(11135);
    stage.bridge.as_object_mut().unwrap().remove("water");
    stage.ran("paper");
    let table = stage.table("paper/jobs.parquet");
    assert!(table.column("radiated_energy_j").is_none());
    assert!(
        !json_file(&stage, "paper/manifest.json")
            .to_string()
            .contains("kernel_error")
    );
}

#[test]
fn waters_can_be_an_axis_and_leave_other_numbers() {
    let mut stage = stage();
    let mut calmer = json_file(&stage, "water.json");
    for matrix in calmer["radiation_damping"].as_array_mut().unwrap() {
        for entry in matrix.as_array_mut().unwrap() {
            *entry = json!(0.99 * entry.as_f64().unwrap());
        }
    }
    fs::write(stage.path("calmer.json"), calmer.to_string()).unwrap();
    stage.study["design"][0]["grid"]["bridge.water.file"] = json!(["water.json", "calmer.json"]);
    stage.ran("r");
    let peaks = stage.numbers("r/jobs.parquet", "peak_deflection_m");
    assert_eq!(peaks.len(), 4);
    let set: std::collections::BTreeSet<u64> = peaks.iter().map(|peak| peak.unwrap().to_bits()).collect();
    assert_eq!(set.len(), 4, "{peaks:?}");
    // what a file of its own cannot be is told there, whichever axis names it
    let mut torn = calmer.clone();
    torn["density_kg_m3"] = json!(-1);
    fs::write(stage.path("calmer.json"), torn.to_string()).unwrap();
    is_refused(&stage.pontoon(&["plan", "study.json"]), &["calmer.json: density_kg_m3"]);
    fs::write(stage.path("calmer.json"), calmer.to_string()).unwrap();
    // results and merged shards hold the waters, so that crossings are solved again without their files
    for shard in ["0", "1"] {
        let (share, out) = (format!("{shard}/2"), format!("shard{shard}"));
        let output = stage.pontoon(&["run", "study.json", "--shard", &share, "--out", &out, "--quiet"]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    }
    for file in ["water.json", "calmer.json"] {
        fs::remove_file(stage.path(file)).unwrap();
    }
    let output = stage.pontoon(&["merge", "shard0", "shard1", "--out", "merged", "--quiet"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let exported = |results: &str, job: &str| {
        let to = format!("{results}-{job}");
        let asked = ["export", results, "--job", job, "--to", &to, "--every", "100"];
        let output = stage.pontoon(&[&asked[..], &["--count", "2"]].concat());
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        fs::read(stage.path(&format!("{to}/crossing-002.vtu"))).unwrap()
    };
    let (own, calm) = (exported("r", "0"), exported("r", "1"));
    assert!(own != calm && own == exported("merged", "0") && calm == exported("merged", "1"));
    let page = stage.pontoon(&["report", "r", "--out", "page.html"]);
    assert!(!stderr(&page).contains("No mode shapes"), "{}", stderr(&page));
}

#[test]
fn a_water_that_cannot_be_the_bridges_is_refused_before_anything_runs() {
    let refused = |change: &dyn Fn(&mut Stage), told: &[&str]| {
        let mut stage = stage();
        change(&mut stage);
        is_refused(&stage.write().pontoon(&["plan", "study.json"]), told);
    };
    refused(
        &|stage| stage.bridge["water"]["file"] = json!("none.json"),
        &["water.file", "none.json", "which is no file"],
    );
    refused(
        &|stage| stage.bridge["water"]["accept"] = json!(["kramers_konig"]),
        &["water.accept[0]", "kramers_kronig"],
    );
    refused(
        &|stage| stage.bridge["water"]["blake3"] = json!("00ff"),
        &["water.blake3", "the hash of water.json"],
    );
    refused(
        &|stage| stage.bridge["added_mass_kg_m"] = json!(11135),
        &["added_mass_kg_m", "nothing beside water"],
    );
    refused(
        &|stage| stage.study["analysis"]["damping"]["ratio"] = json!(0.05),
        &["damping.ratio", "nothing beside damping.structure"],
    );
    refused(
        &|stage| stage.study["analysis"]["time_step_s"] = json!(0.2),
        &["analysis.time_step_s", "at most 0.1 in water with memory"],
    );
    let in_file = |stage: &Stage, key: &str, value: Value| {
        let mut water = json_file(stage, "water.json");
        water[key] = value;
        fs::write(stage.path("water.json"), water.to_string()).unwrap();
    };
    refused(
        &|stage| in_file(stage, "usable_to_rad_s", json!(7)),
        &["water.json: usable_to_rad_s", "a number below 6.5"],
    );
    // an added mass below 0, which no acceptance makes a mass
    refused(
        &|stage| {
            let mass = json_file(stage, "water.json")["added_mass"].clone();
            let turned = |x: &Value| json!(-x.as_f64().unwrap());
            let matrix = |m: &Value| Value::Array(m.as_array().unwrap().iter().map(turned).collect());
            in_file(
                stage,
                "added_mass",
                Value::Array(mass.as_array().unwrap().iter().map(matrix).collect()),
            );
            stage.bridge["water"]["accept"] = json!(["kramers_kronig", "total_heave_infinite_kg", "infinite_of_table"]);
        },
        &["water.json: added_mass", "added mass of at least 0 in every motion"],
    );
    refused(
        &|stage| stage.study["analysis"]["damping"]["structure"]["at_hz"] = json!(1e-3),
        &["damping.structure.at_hz", "0.01"],
    );
    refused(&|stage| stage.bridge["modules"] = json!(4), &["water.json", "modules"]);
    refused(
        &|stage| stage.bridge["modules"] = json!(41),
        &["modules", "at most 40 in water with memory"],
    );
    // a water that a check refuses, unless the bridge accepts it
    let torn = |stage: &Stage, place: usize, factor: f64| {
        let mut water = json_file(stage, "water.json");
        for entry in water["radiation_damping"][place].as_array_mut().unwrap() {
            *entry = json!(factor * entry.as_f64().unwrap());
        }
        fs::write(stage.path("water.json"), water.to_string()).unwrap();
    };
    refused(
        &|stage| torn(stage, 12, -0.05),
        &["water.file", "least_damping refuses", "water.accept"],
    );
    let mut stage = stage();
    torn(&stage, 2, -0.2);
    stage.bridge["water"]["accept"] = json!(["least_damping", "kramers_kronig"]);
    stage.ran("r");
    assert!(
        json_file(&stage, "r/manifest.json")
            .to_string()
            .contains("\"accepted\":[[\"least_damping\"")
    );
    // states that could give energy are not used, whatever is accepted: such jobs fail
    torn(&stage, 12, -0.5);
    let output = stage
        .write()
        .pontoon(&["run", "study.json", "--out", "failed", "--quiet"]);
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    assert!(stderr(&output).contains("job 0 failed: water: "), "{}", stderr(&output));
    // a bridge found would not find its water from another folder
    let output = stage.pontoon(&[
        "calibrate",
        "bridge.json",
        "--with",
        "r.json",
        "--parameters",
        "p.json",
        "--out",
        "other/found.json",
    ]);
    is_refused(
        &output,
        &["other/found.json", "to which its water water.json is relative"],
    );
    // a module alone has no water of the whole
    stage.write();
    let output = stage.pontoon(&["modes", "bridge.json", "--module"]);
    assert!(
        output.status.code() == Some(2) || output.status.code() == Some(1),
        "{output:?}"
    );
    assert!(stderr(&output).contains("under a module alone"), "{}", stderr(&output));
}
