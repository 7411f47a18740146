//! Tells the crate what the sources that make records come to, so that records of other sources are not taken for its own.

use std::fs;
use std::path::{Path, PathBuf};

fn main() {
    println!("cargo:rerun-if-changed=src/run");
    println!("cargo:rerun-if-changed=src/modes.rs");
    let entries = fs::read_dir(Path::new("src/run"))
        .into_iter()
        .flatten()
        .filter_map(Result::ok);
    let mut sources: Vec<PathBuf> = entries
        .map(|entry| entry.path())
        .chain([PathBuf::from("src/modes.rs")])
        .collect();
    sources.retain(|path| path.extension().is_some_and(|e| e == "rs"));
    sources.sort();
    // FNV-1a, 64 bit: this tells versions apart, it does not guard against anybody
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    for source in sources {
        for byte in fs::read(&source).unwrap_or_default() {
            hash = (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }
    println!("cargo:rustc-env=PONTOON_RUN_SOURCES={hash:016x}");
}
