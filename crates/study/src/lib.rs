//! The engine: from jobs to records, and a study run into its folder.
//!
//! | module | charter |
//! |---|---|
//! | [`run`] | jobs to records: what jobs share is prepared once, jobs run in parallel, a failed job is a record |
//! | [`sweep`] | a study run into its folder: journal, resume, shards, tables |
//! | [`modes`] | natural frequencies of a bridge file |
//!
//! Knows threads, the clock and folders. Does not know what is made of results, and prints nothing.

pub mod modes;
pub mod run;
pub mod sweep;

/// The numerics key: changes with the sources of the mechanics, of how a file becomes a job and a job a record, and with the
/// libraries that numbers hang on. Records of another key are refused.
pub const NUMERICS: &str = env!("PONTOON_NUMERICS");
