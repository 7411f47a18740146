//! The numerics key: which sources and libraries it hangs on.
//!
//! That a journal of another key is refused is tried in `tests/house/faults/resume.rs`.

use pontoon_sources::{RECORDS, key_of};
use std::fs;
use std::path::{Path, PathBuf};

fn crates() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// A copy of the crates and of the lock file.
fn copied() -> tempfile::TempDir {
    fn copy(from: &Path, to: &Path) {
        fs::create_dir_all(to).unwrap();
        for entry in fs::read_dir(from).unwrap().map(Result::unwrap) {
            let (path, target) = (entry.path(), to.join(entry.file_name()));
            if path.is_dir() {
                copy(&path, &target);
            } else {
                fs::copy(&path, &target).unwrap();
            }
        }
    }
    let dir = tempfile::tempdir().unwrap();
    for of in ["core", "plan", "results", "study", "view"] {
        copy(
            &crates().join(of).join("src"),
            &dir.path().join("crates").join(of).join("src"),
        );
        let manifest = Path::new(of).join("Cargo.toml");
        fs::copy(crates().join(&manifest), dir.path().join("crates").join(&manifest)).unwrap();
    }
    fs::copy(crates().join("../Cargo.lock"), dir.path().join("Cargo.lock")).unwrap();
    dir
}

#[test]
fn the_key_hangs_on_all_that_decides_a_number_and_on_nothing_else() {
    let dir = copied();
    let numerics = || key_of(&dir.path().join("crates"), RECORDS);
    let built = numerics();
    assert_eq!(built, pontoon_study::NUMERICS, "the program's key is of other sources");
    let changed = |file: &str, from: &str, to: &str| {
        let path = dir.path().join(file);
        let text = fs::read_to_string(&path).unwrap();
        assert!(text.contains(from), "{file} has no {from}");
        fs::write(&path, text.replacen(from, to, 1)).unwrap();
        let changed = numerics();
        fs::write(&path, text).unwrap();
        changed != built
    };
    for (file, from, to) in [
        // the mechanics; what a job's step rules are; what is solved again; the form of a record
        ("crates/core/src/scheme.rs", "spectral radius", "radius"),
        ("crates/plan/src/job/mod.rs", "time_step_s", "step_s"),
        ("crates/study/src/run/retry.rs", "0.5", "0.25"),
        ("crates/results/src/record.rs", "peak_deflection_m", "deflection_m"),
        ("crates/results/src/failure.rs", "not_finite", "infinite"),
        ("crates/core/Cargo.toml", "faer", "nalgebra"),
        (
            "Cargo.lock",
            "name = \"faer\"\nversion = \"0",
            "name = \"faer\"\nversion = \"1",
        ),
        // what faer is built on
        (
            "Cargo.lock",
            "name = \"gemm\"\nversion = \"0",
            "name = \"gemm\"\nversion = \"1",
        ),
    ] {
        assert!(changed(file, from, to), "{file}: {from} changes, and the key does not");
    }
    for (file, from, to) in [
        ("crates/results/src/summary.rs", "speed_m_s", "speed"),
        ("crates/results/src/labels.rs", "tension gap", "gap"),
        (
            "Cargo.lock",
            "name = \"clap\"\nversion = \"4",
            "name = \"clap\"\nversion = \"5",
        ),
    ] {
        assert!(
            !changed(file, from, to),
            "{file}: {from} changes the key, and no number"
        );
    }
    assert_eq!(numerics(), built);
}

#[test]
fn bytes_that_pass_from_one_file_to_the_next_change_the_key() {
    let dir = copied();
    let numerics = || key_of(&dir.path().join("crates"), RECORDS);
    let built = numerics();
    let [first, second] = ["connector.rs", "conventions.rs"].map(|name| dir.path().join("crates/core/src").join(name));
    let moved = fs::read_to_string(&first).unwrap() + &fs::read_to_string(&second).unwrap();
    fs::write(&first, moved).unwrap();
    fs::write(&second, "").unwrap();
    assert_ne!(numerics(), built);
}
