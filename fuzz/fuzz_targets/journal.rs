//! Any bytes as a journal's file: `pontoon_fuzz::journal`.
#![no_main]

use std::sync::LazyLock;
use tempfile::TempDir;

/// The folder of this process.
static FOLDER: LazyLock<TempDir> = LazyLock::new(pontoon_fuzz::folder);

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| pontoon_fuzz::journal(FOLDER.path(), bytes));
