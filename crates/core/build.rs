//! Tells the crate what its own sources come to, so that an operator of other mechanics is not taken for its own.

include!("../sources.rs");

fn main() {
    let crates = Path::new("..");
    watch(crates, MECHANICS);
    println!("cargo:rustc-env=PONTOON_CORE_SOURCES={}", key_of(crates, MECHANICS));
}
