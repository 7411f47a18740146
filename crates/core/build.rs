//! Tells the crate what its own sources come to, so that what was computed by other sources is not taken for its own.

use std::fs;
use std::path::{Path, PathBuf};

fn files(dir: &Path, found: &mut Vec<PathBuf>) {
    let mut paths: Vec<PathBuf> = match fs::read_dir(dir) {
        Ok(entries) => entries.filter_map(Result::ok).map(|e| e.path()).collect(),
        Err(_) => Vec::new(),
    };
    paths.sort();
    for path in paths {
        if path.is_dir() {
            files(&path, found);
        } else if path.extension().is_some_and(|e| e == "rs") {
            found.push(path);
        }
    }
}

fn main() {
    println!("cargo:rerun-if-changed=src");
    println!("cargo:rerun-if-changed=Cargo.toml");
    let mut sources = Vec::new();
    files(Path::new("src"), &mut sources);
    sources.push(PathBuf::from("Cargo.toml"));
    // FNV-1a, 64 bit: this tells versions apart, it does not guard against anybody
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    for source in sources {
        for byte in fs::read(&source).unwrap_or_default() {
            hash = (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }
    println!("cargo:rustc-env=PONTOON_CORE_SOURCES={hash:016x}");
}
