//! Tells the crate what the sources that make records come to, so that records of other rules are not taken for its own.

use pontoon_sources::{RECORDS, key_of, watch};
use std::path::Path;

fn main() {
    let crates = Path::new("..");
    watch(crates, RECORDS);
    println!("cargo:rustc-env=PONTOON_NUMERICS={}", key_of(crates, RECORDS));
}
