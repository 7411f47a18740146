//! What sources come to, for build scripts: a key that changes with every byte of the sources that it is made of, and with the
//! version of every library that numbers hang on.
//!
//! Knows files and the lock file. Does not know what is computed. It tells versions apart and guards against nobody.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// What the mechanics are made of, below `crates/`.
pub const MECHANICS: &[&str] = &["core/Cargo.toml", "core/src"];

/// What a record is made of, below `crates/`: the mechanics, how a file becomes a job, how a job becomes a record, and the
/// form of the record.
pub const RECORDS: &[&str] = &[
    "core/Cargo.toml",
    "core/src",
    "plan/Cargo.toml",
    "plan/src",
    "results/src/extreme.rs",
    "results/src/failure.rs",
    "results/src/limit_rows.rs",
    "results/src/record.rs",
    "results/src/rest_rows.rs",
    "results/src/vehicle_rows.rs",
    "study/Cargo.toml",
    "study/src",
];

/// Crates whose libraries numbers hang on.
const OWN: &[&str] = &["pontoon-core", "pontoon-plan"];

/// Their libraries that numbers hang on; those that they are built on count too.
const LIBRARIES: &[&str] = &["faer", "nalgebra", "pulp", "rand_pcg", "sobol", "sobol_burley"];

/// The key of all sources and manifests below some paths of the folder `crates`, and of the libraries' versions in the lock
/// file beside that folder: 16 hexadecimal digits.
///
/// # Panics
/// Where a path has no sources: a key of nothing would never change. Verified by `tests/house/numerics.rs`.
pub fn key_of(crates: &Path, paths: &[&str]) -> String {
    let mut hash = Fnv::new();
    for path in paths {
        let mut files = Vec::new();
        collect(&crates.join(path), &mut files);
        assert!(!files.is_empty(), "no sources at {path}");
        for file in files {
            let name = file
                .strip_prefix(crates)
                .unwrap_or(&file)
                .to_string_lossy()
                .replace('\\', "/");
            hash.take(name.as_bytes());
            hash.take(&fs::read(&file).unwrap_or_default());
        }
    }
    let lock = fs::read_to_string(crates.join("../Cargo.lock")).unwrap_or_default();
    for (name, version) in locked(&lock) {
        hash.take(format!("{name} {version}").as_bytes());
    }
    format!("{:016x}", hash.0)
}

/// Tells cargo what a key hangs on.
pub fn watch(crates: &Path, paths: &[&str]) {
    for path in ["sources/src", "../Cargo.lock"].iter().chain(paths) {
        println!("cargo:rerun-if-changed={}", crates.join(path).display());
    }
}

fn collect(path: &Path, files: &mut Vec<PathBuf>) {
    if path.is_dir() {
        let entries = fs::read_dir(path).into_iter().flatten().filter_map(Result::ok);
        let mut paths: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
        paths.sort();
        paths.iter().for_each(|path| collect(path, files));
    } else if path.extension().is_some_and(|e| e == "rs" || e == "toml") {
        files.push(path.to_owned());
    }
}

/// Name and version of the libraries and of all that they are built on, as a lock file has them.
fn locked(lock: &str) -> BTreeSet<(String, String)> {
    let quoted = |line: &str| line.split('"').nth(1).unwrap_or_default().to_owned();
    let mut versions: BTreeMap<String, Vec<(String, Vec<String>)>> = BTreeMap::new();
    for package in lock.split("[[package]]").skip(1) {
        let field = |name: &str| {
            package
                .lines()
                .find(|line| line.starts_with(name))
                .map(quoted)
                .unwrap_or_default()
        };
        let below = package
            .split("dependencies = [")
            .nth(1)
            .and_then(|rest| rest.split(']').next());
        let below = below
            .unwrap_or_default()
            .lines()
            .map(quoted)
            .filter(|name| !name.is_empty())
            .collect();
        versions
            .entry(field("name = "))
            .or_default()
            .push((field("version = "), below));
    }
    let mut seen = BTreeSet::new();
    let own = OWN.iter().filter_map(|name| versions.get(*name)).flatten();
    let mut open: Vec<String> = own.flat_map(|(_, below)| below).cloned().collect();
    // `name`, or `name version` where there are several
    open.retain(|asked| LIBRARIES.contains(&asked.split(' ').next().unwrap_or_default()));
    while let Some(asked) = open.pop() {
        let (name, version) = asked.split_once(' ').unwrap_or((&asked, ""));
        for (found, below) in versions.get(name).into_iter().flatten() {
            let meant = version.is_empty() || version.split(' ').next() == Some(found);
            if meant && seen.insert((name.to_owned(), found.clone())) {
                open.extend(below.iter().cloned());
            }
        }
    }
    seen
}

/// FNV-1a, 64 bit: this tells versions apart, it does not guard against anybody.
struct Fnv(u64);

impl Fnv {
    fn new() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }

    /// Takes bytes and their number, so that bytes cannot pass from one file to the next.
    fn take(&mut self, bytes: &[u8]) {
        let length = (bytes.len() as u64).to_le_bytes();
        for byte in bytes.iter().chain(&length) {
            self.0 = (self.0 ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }
}
