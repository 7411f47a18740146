//! A file a command: what it asks of the other crates and how it answers.

pub(crate) mod calibrate;
pub(crate) mod compare;
pub(crate) mod completions;
pub(crate) mod explain;
pub(crate) mod export;
pub(crate) mod indices;
pub(crate) mod man;
pub(crate) mod merge;
pub(crate) mod modes;
pub(crate) mod plan;
pub(crate) mod rate;
pub(crate) mod report;
pub(crate) mod run;
pub(crate) mod schema;
pub(crate) mod status;
pub(crate) mod water;
