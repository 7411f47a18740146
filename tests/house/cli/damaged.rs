//! Results that are not what a run left: status 3 with the file, or the same verdicts as ever; never a wrong table.

use crate::stage::{Stage, reference, stderr, stdout};
use serde_json::{Value, json};
use std::fs;

const FILES: [&str; 5] = [
    "jobs.parquet",
    "positions.parquet",
    "connectors.parquet",
    "histories.parquet",
    "manifest.json",
];

/// Results in `r` with a reference that looks at every table, at the bridge and at the vehicle.
fn stage() -> Stage {
    let mut stage = Stage::new();
    stage.study["design"] = json!([{ "grid": { "load_n": [1e5, 2e5], "speed_m_s": 10 } }]);
    stage.ran("r");
    let select = |table: &str, column: &str| json!({ "select": { "table": table, "column": column, "reduce": "max" } });
    let history = json!({ "history": { "quantity": "deflection_m", "position": 2, "where": { "job": 1 },
        "from": { "centre_past_m": -3 }, "to": { "after_leaving_s": 0.5 }, "reduce": "amplitude" } });
    let quantities = [
        select("jobs", "peak_deflection_m"),
        select("positions", "peak_uplift_m"),
        select("connectors", "peak_compression_n"),
        select("histories", "value"),
        history,
    ];
    let check = |(i, of): (usize, &Value)| json!({ "id": i.to_string(), "role": "record", "value": { "of": of, "expected": 1 } });
    let mut document = reference(&Value::Null);
    document["study"] = "study.json".into();
    document["checks"] = quantities.iter().enumerate().map(check).collect();
    stage.json("reference.json", &document);
    stage
}

/// Compares, and expects the very same output, or a refusal that names the file in one message.
fn same_or_refused(stage: &Stage, good: &str, file: &str, what: &str) -> bool {
    let output = stage.pontoon(&["compare", "r", "--with", "reference.json", "--format", "json"]);
    if output.status.code() == Some(0) {
        assert_eq!(stdout(&output), good, "{file}: {what}");
        return true;
    }
    let message = stderr(&output);
    assert_eq!(output.status.code(), Some(3), "{file}: {what}: {message}");
    assert!(
        message.contains("damaged results") && message.contains("r/"),
        "{file}: {what}: {message}"
    );
    assert!(
        message.contains(file) || file == "manifest.json",
        "{file}: {what}: {message}"
    );
    assert_eq!(
        (message.lines().count(), stdout(&output).as_str()),
        (1, ""),
        "{message}"
    );
    false
}

fn good(stage: &Stage) -> String {
    let output = stage.pontoon(&["compare", "r", "--with", "reference.json", "--format", "json"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    stdout(&output)
}

/// The file of a document of the results in `r`, within their folder.
fn document_file(stage: &Stage, document: &str) -> String {
    let manifest = stage.manifest("r");
    manifest["documents"][document]["file"].as_str().unwrap().to_owned()
}

/// As they were before documents had files of their own.
#[test]
fn results_with_their_documents_in_the_manifest_are_read() {
    let stage = stage();
    let good = good(&stage);
    let mut manifest = stage.manifest("r");
    for document in ["study", "bridge"] {
        let text = fs::read_to_string(stage.path("r").join(document_file(&stage, document))).unwrap();
        manifest[document] = serde_json::from_str(&text).unwrap();
    }
    manifest
        .as_object_mut()
        .unwrap()
        .retain(|key, _| key != "documents" && key != "kind");
    stage.json("r/manifest.json", &manifest);
    fs::remove_dir_all(stage.path("r/documents")).unwrap();
    assert!(same_or_refused(&stage, &good, "", "an older manifest"));
    manifest["bridge"]["modules"] = json!(4);
    stage.json("r/manifest.json", &manifest);
    assert!(!same_or_refused(&stage, &good, "manifest.json", "another bridge"));
}

#[test]
fn files_cut_short_are_refused() {
    let stage = stage();
    let good = good(&stage);
    for file in FILES {
        let path = stage.path("r").join(file);
        let bytes = fs::read(&path).unwrap();
        for length in [
            0,
            1,
            4,
            bytes.len() / 3,
            bytes.len() / 2,
            bytes.len() - 8,
            bytes.len() - 2,
        ] {
            fs::write(&path, &bytes[..length]).unwrap();
            assert!(
                !same_or_refused(&stage, &good, file, &format!("{length} bytes")),
                "{file}: {length}"
            );
        }
        fs::write(&path, [&bytes[..], b"x"].concat()).unwrap();
        assert!(!same_or_refused(&stage, &good, file, "a byte more"), "{file}");
        fs::write(&path, &bytes).unwrap();
    }
    assert!(same_or_refused(&stage, &good, "", "restored"));
}

#[test]
fn one_bit_flipped_anywhere_never_makes_another_table() {
    let stage = stage();
    let good = good(&stage);
    for (file, flips) in FILES.into_iter().zip([15, 15, 15, 15, 160]) {
        let path = stage.path("r").join(file);
        let bytes = fs::read(&path).unwrap();
        for k in 0..flips {
            let at = (bytes.len() - 1) * k / (flips - 1);
            let mut flipped = bytes.clone();
            flipped[at] ^= 1 << (k % 8);
            fs::write(&path, flipped).unwrap();
            let same = same_or_refused(&stage, &good, file, &format!("bit {} of byte {at}", k % 8));
            assert!(!same || file == "manifest.json", "{file}: byte {at} passed");
        }
        fs::write(&path, &bytes).unwrap();
    }
}

#[test]
fn every_digit_of_the_documents_that_verdicts_stand_on_is_kept() {
    let stage = stage();
    let good = good(&stage);
    for (document, from, to) in [
        ("bridge", "\"length_m\":6.7", "\"length_m\":6.8"),
        ("bridge", "\"modules\":3", "\"modules\":4"),
        ("study", "\"footprint_length_m\":3.35", "\"footprint_length_m\":3.36"),
        ("study", "\"name\":\"smoke\"", "\"name\":\"smoky\""),
    ] {
        let file = document_file(&stage, document);
        let path = stage.path("r").join(&file);
        let text = fs::read_to_string(&path).unwrap();
        assert!(text.contains(from), "{from}: {text}");
        fs::write(&path, text.replacen(from, to, 1)).unwrap();
        assert!(!same_or_refused(&stage, &good, &file, to), "{to}");
        fs::remove_file(&path).unwrap();
        assert!(!same_or_refused(&stage, &good, &file, "deleted"), "{to}");
        // the same run writes it again
        stage.ran("r");
        assert!(same_or_refused(&stage, &good, &file, "restored"), "{to}");
    }
    let path = stage.path("r/manifest.json");
    let text = fs::read_to_string(&path).unwrap();
    for (from, to) in [
        ("\"name\": \"smoke\"", "\"name\": \"smoky\""),
        ("\"jobs\": 2", "\"jobs\": 3"),
        ("\"jobs.parquet\"", "\"jobz.parquet\""),
        ("\"histories.parquet\"", "\"historics.parquet\""),
    ] {
        assert!(text.contains(from), "{from}: {text}");
        fs::write(&path, text.replacen(from, to, 1)).unwrap();
        assert!(!same_or_refused(&stage, &good, "manifest.json", to), "{to}");
    }
}

#[test]
fn tables_of_another_run_are_not_taken_for_this_one() {
    let mut stage = stage();
    let good = good(&stage);
    let own = stage.study.clone();
    stage.study["design"][0]["grid"]["speed_m_s"] = json!(9);
    stage.ran("other");
    stage.study = own;
    stage.write();
    for file in FILES {
        let path = stage.path("r").join(file);
        let own = fs::read(&path).unwrap();
        fs::copy(stage.path("other").join(file), &path).unwrap();
        assert!(!same_or_refused(&stage, &good, file, "of another run"), "{file}");
        fs::write(&path, own).unwrap();
    }
    fs::copy(stage.path("r/jobs.parquet"), stage.path("r/modes.parquet")).unwrap();
    assert!(!same_or_refused(&stage, &good, "modes.parquet", "a table too many"));
    fs::remove_file(stage.path("r/modes.parquet")).unwrap();
    for file in &FILES[..4] {
        let path = stage.path("r").join(file);
        let own = fs::read(&path).unwrap();
        fs::remove_file(&path).unwrap();
        assert!(!same_or_refused(&stage, &good, file, "deleted"), "{file}");
        fs::create_dir(&path).unwrap();
        assert!(!same_or_refused(&stage, &good, file, "a folder"), "{file}");
        fs::remove_dir(&path).unwrap();
        fs::write(&path, own).unwrap();
    }
    assert!(same_or_refused(&stage, &good, "", "restored"));
}

#[test]
fn a_manifest_without_hashes_is_that_of_another_version() {
    let stage = stage();
    let good = good(&stage);
    for key in [
        "tables",
        "name",
        "kind",
        "documents",
        "study_blake3",
        "bridge_blake3",
        "jobs",
    ] {
        let mut manifest = stage.manifest("r");
        let whole = manifest.clone();
        manifest.as_object_mut().unwrap().remove(key);
        stage.json("r/manifest.json", &manifest);
        assert!(!same_or_refused(&stage, &good, "manifest.json", key), "{key}");
        stage.json("r/manifest.json", &whole);
    }
    assert!(same_or_refused(&stage, &good, "", "restored"));
}

#[test]
fn damaged_old_results_are_refused_like_damaged_new_ones() {
    let stage = stage();
    stage.ran("old");
    fs::write(stage.path("old/positions.parquet"), b"PAR1").unwrap();
    let output = stage.pontoon(&["compare", "r", "--with", "old"]);
    assert_eq!(output.status.code(), Some(3), "{}", stderr(&output));
    assert!(
        stderr(&output).contains("old/positions.parquet: damaged results"),
        "{}",
        stderr(&output)
    );
}
