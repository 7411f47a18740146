//! Studies of floating bridges: from a study file to tables.
//!
//! | module | charter |
//! |---|---|
//! | [`refusal`] | what a refused input looks like: file, key path, found, allowed, nearest known |
//! | [`document`] | JSON documents: strict reading, typed reading, values at a path |
//! | [`filter`] | which rows or points are meant: a value, a list or a range for each of some names |
//! | [`spec`] | the study file: its keys, its designs, the points they expand to |
//! | [`plan`] | jobs: a point of a design made into a checked job, equal jobs merged |
//! | [`journal`] | what jobs left, kept as soon as they left it, whatever becomes of the process |
//! | [`run`] | jobs to records: what jobs share is prepared once, jobs run in parallel, a failed job is a record |
//! | [`tables`] | records to files: Parquet tables, summary, manifest |
//! | [`sweep`] | a study run into its folder: journal, resume, shards, tables |
//! | [`reference`] | the reference file: checks with their source |
//! | [`compare`] | results held against a reference, or against older results |
//! | [`report`] | what a page tells of results |
//! | [`calibrate`] | a bridge's numbers identified from the checks of references |
//! | [`figures`] | what a paper would draw of results, as numbers, with the points of a reference beside them |
//! | [`export`] | mode shapes, static cases and crossings as grids for ParaView |
//! | [`modes`] | natural frequencies of a bridge file |
//! | [`schema`] | the JSON Schema of what a person writes |
//!
//! Knows files, threads and the clock. Does not know mechanics, and prints nothing.

pub mod calibrate;
pub mod compare;
pub mod document;
pub mod export;
pub mod figures;
pub mod filter;
pub mod journal;
pub mod modes;
pub mod plan;
pub mod reference;
pub mod refusal;
pub mod report;
pub mod run;
pub mod schema;
pub mod spec;
pub mod sweep;
pub mod tables;

pub use refusal::Refusal;
pub use spec::Study;

/// Version of this program, as tables and manifests carry it.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");
