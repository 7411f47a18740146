//! A folder with a study and its bridge, and the program run in it.

use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// The folder; gone with the value.
pub struct Stage {
    dir: tempfile::TempDir,
    /// The study's document, to be changed before a run.
    pub study: Value,
    /// The bridge's document, to be changed before a run.
    pub bridge: Value,
}

fn studies() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies")
}

fn document(path: &Path) -> Value {
    serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap()
}

impl Stage {
    /// The smoke study with its bridge beside it.
    pub fn new() -> Self {
        let mut study = document(&studies().join("smoke/study.json"));
        study["bridge"] = "bridge.json".into();
        let bridge = document(&studies().join("bridges/smoke.json"));
        Self {
            dir: tempfile::tempdir().unwrap(),
            study,
            bridge,
        }
    }

    /// A file in the folder.
    pub fn path(&self, name: &str) -> PathBuf {
        self.dir.path().join(name)
    }

    /// Writes both documents.
    pub fn write(&self) -> &Self {
        fs::write(self.path("study.json"), format!("{:#}", self.study)).unwrap();
        fs::write(self.path("bridge.json"), format!("{:#}", self.bridge)).unwrap();
        self
    }

    /// Runs the program in the folder.
    pub fn pontoon(&self, words: &[&str]) -> Output {
        Command::new(env!("CARGO_BIN_EXE_pontoon"))
            .args(words)
            .current_dir(self.dir.path())
            .output()
            .unwrap()
    }

    /// The names of everything in the folder, sorted.
    pub fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(self.dir.path()).unwrap();
        let mut names: Vec<String> = entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    /// The manifest of the results in a folder.
    pub fn manifest(&self, out: &str) -> Value {
        document(&self.path(out).join("manifest.json"))
    }
}

/// What a program wrote on standard output.
pub fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

/// What a program wrote on standard error.
pub fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}
