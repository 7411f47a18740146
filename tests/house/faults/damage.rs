//! Files that are cut, zeroed, or changed by a bit: the same tables come out, or the file is named. Never a wrong table.

use super::sweep::{Random, command, finish, run, same_tables, tables, tiny, tries};
use crate::stage::{Stage, stderr};
use std::fs;
use std::path::{Path, PathBuf};

/// Every file of a folder of results, by its path in there.
fn files(folder: &Path) -> Vec<PathBuf> {
    let mut all = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            all.extend(files(&path));
        } else {
            all.push(path);
        }
    }
    all.sort();
    all
}

/// A stage, the files of its results and their bytes.
struct Whole {
    stage: Stage,
    files: Vec<(PathBuf, Vec<u8>)>,
    expected: Vec<(String, Vec<u8>)>,
}

impl Whole {
    fn new() -> Self {
        let stage = tiny();
        finish(&stage, "r");
        let files = files(&stage.path("r"))
            .into_iter()
            .map(|path| (path.clone(), fs::read(&path).unwrap()))
            .collect();
        let expected = tables(&stage, "r");
        Self { stage, files, expected }
    }

    /// The folder as it was after the run.
    fn restore(&self) {
        fs::remove_dir_all(self.stage.path("r")).unwrap();
        for (path, bytes) in &self.files {
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, bytes).unwrap();
        }
    }

    /// One file changed: the study runs to the same tables, or names the file.
    fn survives(&self, path: &Path, bytes: &[u8], what: &str) {
        self.restore();
        fs::write(path, bytes).unwrap();
        let name = path.strip_prefix(self.stage.path("")).unwrap().display().to_string();
        let output = run(&self.stage, "r", &[]);
        match output.status.code() {
            Some(0) => same_tables(&self.stage, "r", &self.expected),
            code => {
                let told = stderr(&output);
                assert!(
                    matches!(code, Some(2 | 3)) && told.contains(&name),
                    "{name} {what}: {code:?} {told}"
                );
            }
        }
    }
}

/// Numbers below a bound: all, or as many as are to be tried.
fn places(bound: usize, few: usize, random: &mut Random) -> Vec<usize> {
    let many = tries(few);
    if many >= bound {
        return (0..bound).collect();
    }
    (0..many)
        .map(|_| usize::try_from(random.below(bound as u64)).unwrap())
        .collect()
}

#[test]
fn files_cut_at_any_length_are_recovered_or_named() {
    let (whole, mut random) = (Whole::new(), Random(1));
    for (path, bytes) in &whole.files {
        for length in places(bytes.len(), 4, &mut random) {
            whole.survives(path, &bytes[..length], &format!("cut at {length}"));
        }
    }
}

#[test]
fn files_whose_end_is_zeros_are_recovered_or_named() {
    let (whole, mut random) = (Whole::new(), Random(2));
    for (path, bytes) in &whole.files {
        for length in places(bytes.len(), 3, &mut random) {
            let mut zeroed = bytes.clone();
            zeroed[length..].fill(0);
            whole.survives(path, &zeroed, &format!("zeros from {length}"));
            let mut longer = bytes.clone();
            longer.extend(vec![0; 1 + length]);
            whole.survives(path, &longer, &format!("{} zeros more", 1 + length));
        }
    }
}

#[test]
fn files_with_a_flipped_bit_are_recovered_or_named() {
    let (whole, mut random) = (Whole::new(), Random(3));
    let total: usize = whole.files.iter().map(|(_, bytes)| bytes.len()).sum();
    for _ in 0..tries(40) {
        let mut at = usize::try_from(random.below(total as u64)).unwrap();
        let bit = random.below(8);
        let hit = whole.files.iter().find(|(_, bytes)| {
            let here = at < bytes.len();
            if !here {
                at -= bytes.len();
            }
            here
        });
        let (path, bytes) = hit.unwrap();
        let mut flipped = bytes.clone();
        flipped[at] ^= 1 << bit;
        whole.survives(path, &flipped, &format!("bit {bit} of byte {at} flipped"));
    }
}

/// A byte of the second frame that is a record.
fn second_record(bytes: &[u8]) -> usize {
    let number = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap());
    let (mut at, mut records) = (0, 0);
    loop {
        let length = number(at + 4) as usize;
        records += usize::from(number(at + 12) == 3);
        if records == 2 {
            return at + 16 + length / 2;
        }
        at += 16 + length;
    }
}

#[test]
fn a_damaged_record_runs_again_and_is_told() {
    let whole = Whole::new();
    let (path, bytes) = whole
        .files
        .iter()
        .find(|(path, _)| path.to_string_lossy().contains("journal/"))
        .unwrap();
    let mut flipped = bytes.clone();
    flipped[second_record(bytes)] ^= 1;
    fs::write(path, flipped).unwrap();
    let output = command(
        &whole.stage,
        &["run", "study.json", "--out", "r", "--format", "json", "--quiet"],
    )
    .output()
    .unwrap();
    let told = stderr(&output);
    assert_eq!(output.status.code(), Some(0), "{told}");
    assert!(
        told.contains(".pontoon: damaged, ") && told.contains("run again"),
        "{told}"
    );
    let ran: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(ran["ran"], 1, "the record that was hit, and no other");
    same_tables(&whole.stage, "r", &whole.expected);
    // what was set aside stays where it was
    assert!(path.exists());
}
