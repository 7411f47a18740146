//! Studies to export, and what an export left: collections and grids read back.

use crate::stage::{Stage, is_refused, stderr, stdout};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// A stage whose crossings are solved by the reference solver, so that what is exported is what is in the tables.
pub(super) fn crossings() -> Stage {
    let mut stage = Stage::new();
    stage.study["analysis"] = json!({ "kind": "crossing", "time_step_s": 0.02, "tail_s": 0.5, "solver": "reference" });
    stage.study["design"] = json!([{ "grid": { "connection": ["linear", "nonlinear"], "gap_tension_m": 0.0,
                                                "gap_compression_m": 0.0055, "speed_m_s": 10, "load_n": 1e5 } }]);
    stage
}

pub(super) fn static_cases() -> Stage {
    let mut stage = Stage::new();
    stage.study["analysis"] = json!({ "kind": "static" });
    stage.study["record"] = json!({});
    stage.study["design"] = json!([{ "grid": { "load_n": [1e5, 2e5], "load_position": 2 } }]);
    stage
}

pub(super) fn exported(stage: &Stage, words: &[&str]) -> Value {
    let output = stage.pontoon(&[&["export"], words, &["--format", "json"]].concat());
    assert_eq!(output.status.code(), Some(0), "{words:?}: {}", stderr(&output));
    serde_json::from_str(&stdout(&output)).unwrap()
}

pub(super) fn refused(stage: &Stage, words: &[&str], parts: &[&str]) {
    let output = stage.pontoon(&[&["export"], words, &["--to", "vtk"]].concat());
    is_refused(&output, parts);
    assert!(!stage.path("vtk").exists(), "{words:?} left a folder");
    assert!(
        !stage.names().iter().any(|name| name.starts_with(".vtk")),
        "{:?}",
        stage.names()
    );
}

pub(super) fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<String> = entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

pub(super) fn contents(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let read = |name: String| (name.clone(), fs::read(folder.join(name)).unwrap());
    names(folder).into_iter().map(read).collect()
}

/// The value of the first attribute of a name in a text.
fn attribute<'a>(text: &'a str, name: &str) -> &'a str {
    let begin = format!("{name}=\"");
    let from = text.find(&begin).unwrap() + begin.len();
    text[from..].split('"').next().unwrap()
}

/// The times and files of a collection.
pub(super) fn collection(path: &Path) -> Vec<(f64, String)> {
    let text = fs::read_to_string(path).unwrap();
    let value = |line: &str, key: &str| attribute(line, &format!(" {key}")).to_owned();
    let lines = text.lines().filter(|line| line.contains("<DataSet "));
    lines
        .map(|line| (value(line, "timestep").parse().unwrap(), value(line, "file")))
        .collect()
}

/// A grid's head and its appended bytes.
pub(super) struct Grid {
    head: String,
    bytes: Vec<u8>,
}

impl Grid {
    pub(super) fn read(path: &Path) -> Self {
        let bytes = fs::read(path).unwrap();
        let mark = b"<AppendedData encoding=\"raw\">";
        let at = bytes.windows(mark.len()).position(|w| w == mark).unwrap() + mark.len();
        let start = at + bytes[at..].iter().position(|b| *b == b'_').unwrap() + 1;
        Self {
            head: String::from_utf8(bytes[..at].to_vec()).unwrap(),
            bytes: bytes[start..].to_vec(),
        }
    }

    pub(super) fn count(&self, of: &str) -> usize {
        attribute(&self.head, of).parse().unwrap()
    }

    pub(super) fn raw(&self, name: &str) -> (&str, &[u8]) {
        let line = self
            .head
            .lines()
            .find(|line| line.contains(&format!(" Name=\"{name}\"")))
            .unwrap();
        let value = |key: &str| attribute(line, &format!(" {key}"));
        let from: usize = value("offset").parse().unwrap();
        let (count, rest) = self.bytes[from..].split_at(8);
        let count = u64::from_le_bytes(count.try_into().unwrap()) as usize;
        (value("type"), &rest[..count])
    }

    pub(super) fn numbers(&self, name: &str) -> Vec<f64> {
        let (kind, bytes) = self.raw(name);
        match kind {
            "Float64" => bytes
                .chunks(8)
                .map(|b| f64::from_le_bytes(b.try_into().unwrap()))
                .collect(),
            "Float32" => bytes
                .chunks(4)
                .map(|b| f64::from(f32::from_le_bytes(b.try_into().unwrap())))
                .collect(),
            "Int32" => bytes
                .chunks(4)
                .map(|b| f64::from(i32::from_le_bytes(b.try_into().unwrap())))
                .collect(),
            other => panic!("{name} of type {other}"),
        }
    }

    pub(super) fn text(&self, name: &str) -> String {
        String::from_utf8(self.raw(name).1.to_vec()).unwrap()
    }

    /// Deflection of the bottom's centre line at a place along the bridge `[m]`.
    pub(super) fn deflection_m(&self, x_m: f64) -> f64 {
        let points = self.numbers("points");
        let there = |p: &[f64]| (p[0] - x_m).abs() < 1e-4 && p[1] == 0.0 && p[2] == 0.0;
        let node = points.chunks(3).position(there).unwrap();
        -self.numbers("displacement")[3 * node + 2]
    }
}
