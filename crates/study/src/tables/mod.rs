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

pub use folder::{Folder, FolderError};
pub use manifest::{Manifest, Moment, check_own};
pub use results::{Results, ResultsError};
pub use summary::{Cell, SummaryTable};
pub use table::{Kind, Table, TableName};

use crate::plan::Job;
use crate::run::Outcome;
use crate::spec::Study;

/// Writes all tables of a run into its folder, the manifest with their hashes last.
///
/// # Errors
/// [`FolderError`] with the file that could not be written.
pub fn write(
    study: &Study,
    jobs: &[Job],
    outcome: &Outcome,
    mut manifest: Manifest,
    folder: &Folder,
) -> Result<SummaryTable, FolderError> {
    let provenance = parquet::provenance(study, jobs);
    let records = &outcome.records;
    folder.remove(manifest::FILE)?;
    for (name, frame) in frames::all(study, jobs, records) {
        let file = name.file();
        match frame {
            Some(frame) => {
                parquet::write(folder, &file, frame, &provenance)?;
                let path = folder.path().join(&file);
                let hash = results::hash_of(&path).map_err(|cause| FolderError { path, cause })?;
                manifest.tables.insert(file, hash);
            }
            None => folder.remove(&file)?,
        }
    }
    let summary = SummaryTable::new(study, jobs, records);
    folder.write("summary.csv", |file| {
        std::io::Write::write_all(file, summary.csv().as_bytes())
    })?;
    folder.write(manifest::FILE, |file| {
        std::io::Write::write_all(file, manifest.text().as_bytes())
    })?;
    Ok(summary)
}
