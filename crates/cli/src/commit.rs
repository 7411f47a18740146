//! The sources that this program was built from.
//!
//! Knows what the build script has found. Does not know what is done with it.

/// Commit of the sources that this program was built from, where they were a repository's.
pub const COMMIT: Option<&str> = option_env!("PONTOON_COMMIT");
