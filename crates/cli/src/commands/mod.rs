//! A file a command: what it asks of the study's rooms and how it answers.

pub mod calibrate;
pub mod compare;
pub mod completions;
pub mod explain;
pub mod export;
pub mod man;
pub mod merge;
pub mod modes;
pub mod plan;
pub mod report;
pub mod run;
pub mod schema;
pub mod status;
