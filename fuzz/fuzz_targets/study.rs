//! Any bytes as a study: `pontoon_fuzz::study`.
#![no_main]

use std::sync::LazyLock;
use tempfile::TempDir;

/// The folder of this process.
static FOLDER: LazyLock<TempDir> = LazyLock::new(pontoon_fuzz::folder);

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| pontoon_fuzz::study(FOLDER.path(), bytes));
