//! Any bytes as a bridge: `pontoon_fuzz::bridge`.
#![no_main]

use std::sync::LazyLock;
use tempfile::TempDir;

/// The folder of this process.
static FOLDER: LazyLock<TempDir> = LazyLock::new(pontoon_fuzz::folder);

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| pontoon_fuzz::bridge(FOLDER.path(), bytes));
