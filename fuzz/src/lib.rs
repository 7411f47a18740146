//! Bytes given to the readers as a run gives them a file: a study, a bridge, a reference, a file of a journal.
//!
//! Knows where each file lies and what a run asks of it before it solves anything. Does not know who makes the bytes: a
//! fuzzer, or the test that replays what is kept (`tests/house/corpus.rs`). Whatever the bytes are, each function returns;
//! what a reader says of them is not judged here.

use pontoon_journal::{FOLDER, JournalIndex, keep_document, read_document};
use pontoon_judge::reference::Reference;
use pontoon_plan::input::Document;
use pontoon_plan::job::Jobs;
use pontoon_plan::study_file::Study;
use pontoon_study::sweep::{explain, standings};
use serde_json::Value;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// A reader: takes a folder of its own, which it may find as it left it, and the bytes of a file.
pub type Reader = fn(&Path, &[u8]);

/// The readers by name.
pub const READERS: [(&str, Reader); 4] = [
    ("study", study),
    ("bridge", bridge),
    ("reference", reference),
    ("journal", journal),
];

/// The bridge beside a study.
const BRIDGE: &str = include_str!("../../studies/bridges/smoke.json");

/// The study beside a bridge: one that asks for a crossing of each kind.
const STUDY: &str = r#"{
  "name": "fuzz", "bridge": "bridge.json", "analysis": { "kind": "crossing" },
  "design": [ { "grid": { "connection": ["linear", "nonlinear"], "speed_m_s": [5, 10], "load_n": 1e5 } } ]
}"#;

/// The documents that the kept journals are of.
const DOCUMENTS: [&str; 5] = [
    include_str!("../documents/211f2d99ffd7f1cff109afa89c9a8a6c4e9e7e629b83f459e78ef6f7aacc65ee.json"),
    include_str!("../documents/2f466b6fefa491c572134cbcf5a645609f7cad803621af2d5a2825f889643347.json"),
    include_str!("../documents/8a9cbf071197bca0ef8be5e75f13d8358aff5e7a774efc1699f1355e13b64198.json"),
    include_str!("../documents/9e9d064134f66af144527f13f9d86a0f96e9ef7c1544e2ee562818553f79ec45.json"),
    include_str!("../documents/c5df729ef4e8c564c73bc8ef3c248e85db16316a0a7779abc61ab73ee48f5061.json"),
];

/// Jobs that are made of a study.
const MOST_JOBS: usize = 1000;

/// Points beyond which a study's jobs are not made, nor its conditions tried: ten million are a study, which takes the time
/// that it takes.
const MOST_POINTS: usize = 10_000;

/// Bytes as a study beside a good bridge.
pub fn study(folder: &Path, bytes: &[u8]) {
    opened(folder, bytes, BRIDGE.as_bytes());
}

/// Bytes as the bridge of a good study.
pub fn bridge(folder: &Path, bytes: &[u8]) {
    opened(folder, STUDY.as_bytes(), bytes);
}

/// Bytes as a reference.
pub fn reference(folder: &Path, bytes: &[u8]) {
    let file = folder.join("reference.json");
    written(&file, bytes);
    match Reference::open(&file) {
        Ok(reference) => {
            let _ = reference.study();
        }
        Err(refusal) => drop(refusal.to_string()),
    }
}

/// Bytes as the one file of a journal: as they are, and with the checksums that a writer would have given its frames, since
/// no chance hits upon those.
pub fn journal(folder: &Path, bytes: &[u8]) {
    let file = folder.join(FOLDER).join("0000000000000001-00000001.pontoon");
    let _ = fs::create_dir(folder.join(FOLDER));
    for text in DOCUMENTS {
        let _ = keep_document(folder, &Document::of_canonical(text.to_owned()).hash(), text);
    }
    let mended = mended(bytes);
    if mended != bytes {
        written(&file, bytes);
        drop(told(folder));
    }
    written(&file, &mended);
    if let Some(index) = told(folder) {
        explained(folder, &index, bytes.len());
    }
}

fn opened(folder: &Path, study: &[u8], bridge: &[u8]) {
    let (study_file, bridge_file) = (folder.join("study.json"), folder.join("bridge.json"));
    written(&study_file, study);
    written(&bridge_file, bridge);
    if let (Ok(study), Ok(bridge)) = (Document::read(&study_file), Document::read(&bridge_file))
        && has_many_points(folder, &study, bridge)
    {
        return;
    }
    match Study::open(folder) {
        Ok(study) => planned(&study),
        Err(refusal) => drop(refusal.to_string()),
    }
}

/// Whether conditions would be tried on more points than there is time for.
fn has_many_points(file: &Path, study: &Document, bridge: Document) -> bool {
    let mut study = study.value();
    let designs = study.get_mut("design").and_then(Value::as_array_mut);
    let conditions = designs.into_iter().flatten().filter_map(|design| {
        let design = design.as_object_mut()?;
        design.remove("where")
    });
    let conditions = conditions.count();
    conditions > 0
        && Study::of_documents(file, Document::from(&study), bridge).is_ok_and(|study| study.points() > MOST_POINTS)
}

/// The first jobs of a study and what they are known by.
fn planned(study: &Study) {
    let _ = (
        study.axis_columns(),
        study.document.hash(),
        study.bridge.document.hash(),
    );
    if study.points() > MOST_POINTS {
        return;
    }
    for job in Jobs::new(study).take(MOST_JOBS) {
        match job {
            Ok(job) => drop((job.key().to_string(), job.steps())),
            Err(refusal) => return drop(refusal.to_string()),
        }
    }
}

/// What a run, and whoever asks how far it has come, reads of a journal.
fn told(folder: &Path) -> Option<JournalIndex> {
    let index = JournalIndex::read(folder).ok()?;
    for entry in index.entries() {
        let _ = index.record(entry.place);
    }
    let _ = (index.deaths(), index.damages().count());
    let _ = standings(&[folder.to_owned()]);
    Some(index)
}

/// One job of a journal's study, which decodes its record; `any` says which.
fn explained(folder: &Path, index: &JournalIndex, any: usize) {
    let Some(session) = index.files.iter().find_map(|written| written.session.as_ref()) else {
        return;
    };
    let document = |hash: &str| read_document(folder, hash).map(Document::of_canonical);
    let (Ok(study), Ok(bridge)) = (document(&session.study_blake3), document(&session.bridge_blake3)) else {
        return;
    };
    if has_many_points(folder, &study, bridge.clone()) {
        return;
    }
    if let Ok(study) = Study::of_documents(folder, study, bridge)
        && (1..=MOST_POINTS).contains(&study.points())
    {
        let _ = explain(folder, any % study.points());
    }
}

/// A folder for the files of this process, among the system's temporary ones.
///
/// # Panics
/// Where there can be none.
pub fn folder() -> TempDir {
    tempfile::tempdir().unwrap_or_else(|cause| panic!("no temporary folder: {cause}"))
}

/// Writes a file.
///
/// # Panics
/// Where it cannot be written.
fn written(file: &Path, bytes: &[u8]) {
    if let Err(cause) = fs::write(file, bytes) {
        panic!("{}: {cause}", file.display());
    }
}

/// Bytes of a frame before its payload: mark, length, checksum, kind.
const HEAD: usize = 16;

/// Bytes in which each frame that lies whole has the checksum of what it holds.
fn mended(bytes: &[u8]) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    let mut at = 0;
    while let Some(head) = bytes.get(at..at + HEAD) {
        let length = u32::from_le_bytes([head[4], head[5], head[6], head[7]]) as usize;
        let end = at + HEAD + length;
        if !head.starts_with(b"\xf1pj\n") || end > bytes.len() {
            at += 1;
            continue;
        }
        let summed = bytes[at + 4..at + 8].iter().chain(&bytes[at + 12..end]);
        let sum = !summed.fold(!0, |sum, byte| crc_32(sum, *byte));
        bytes[at + 8..at + 12].copy_from_slice(&sum.to_le_bytes());
        at = end;
    }
    bytes
}

/// A CRC-32 with one more byte.
fn crc_32(sum: u32, byte: u8) -> u32 {
    (0..8).fold(sum ^ u32::from(byte), |sum, _| {
        if sum & 1 == 1 {
            (sum >> 1) ^ 0xedb8_8320
        } else {
            sum >> 1
        }
    })
}
