//! Records to files and back to tables: Parquet, summary, manifest.
//!
//! Knows columns, provenance, how a file is replaced whole and how a folder proves to be whole. Does not know how a record
//! came about. The only room that knows the table library. Tables hold nothing that changes from run to run; the manifest
//! does.

mod columns;
mod folder;
mod frames;
mod manifest;
mod parquet;
mod results;
mod summary;
mod table;
mod writer;

pub use folder::{Folder, FolderError, OwnFiles, PAGE};
pub use manifest::{Manifest, Moment, check_own};
pub use parquet::Provenance;
pub use results::{Results, ResultsError};
pub use summary::{Cell, SummaryTable};
pub use table::{Kind, Table, TableName};
pub use writer::Writer;

pub(crate) use folder::hash_of;
pub(crate) use frames::axis_names;

#[cfg(test)]
mod tests;
