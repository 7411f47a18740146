//! Tells the crate what its own sources come to, so that an operator of other mechanics is not taken for its own.

use pontoon_sources::{MECHANICS, key_of, watch};
use std::path::Path;

fn main() {
    let crates = Path::new("..");
    watch(crates, MECHANICS);
    println!("cargo:rustc-env=PONTOON_CORE_SOURCES={}", key_of(crates, MECHANICS));
}
