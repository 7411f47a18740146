//! Why results could not be read.
//!
//! Knows that there are none, or that they are not what a run left. Does not know what was read of them.

use pontoon_plan::input::Refusal;
use std::path::PathBuf;
use thiserror::Error;

/// Why results could not be read.
#[derive(Debug, Error)]
pub enum ResultsError {
    /// There are none in that folder.
    #[error(transparent)]
    Refused(#[from] Refusal),
    /// They are not what their manifest says, or cannot be read.
    #[error("{}: damaged results: {found}; run the study again", file.display())]
    Damaged {
        /// The file.
        file: PathBuf,
        /// What is wrong with it.
        found: String,
    },
    /// A table does not fit into memory.
    #[error("{}: a table that needs {found}; read it in parts, with polars or DuckDB", file.display())]
    TooLarge {
        /// The file.
        file: PathBuf,
        /// What it needs and what is free.
        found: String,
    },
}
