//! What a person may write, made into checked jobs.
//!
//! | module | charter |
//! |---|---|
//! | [`input`] | JSON documents: strict and typed reading, paths, filters, and what a refusal looks like |
//! | [`design`] | designs of a study: axes, blocks, points, sampling |
//! | [`study_file`] | the study file and the bridge file: their keys, defaults and ranges |
//! | [`job`] | jobs: a point of a design made into a checked job, its key, equal jobs merged, shards |
//! | [`water_file`] | water files: their keys, checks, and the waters that bridges name |
//! | [`schema`] | the JSON Schema of study, bridge and vehicle files |
//!
//! Knows the files that people write. Does not know solvers, tables or journals, runs nothing and prints nothing.

pub mod design;
pub mod input;
pub mod job;
pub mod schema;
pub mod study_file;
pub mod water_file;

pub use input::Refusal;
pub use study_file::Study;
