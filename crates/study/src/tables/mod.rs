//! Records to files: Parquet tables, summary, manifest.
//!
//! Knows columns, provenance and how a file is replaced whole. Does not know how a record came about. The only room
//! that knows the table library. Tables hold nothing that changes from run to run; the manifest does.

mod columns;
mod folder;
mod frames;
mod manifest;
mod parquet;
mod summary;

pub use folder::{Folder, FolderError};
pub use manifest::{Manifest, Moment, check_own};
pub use summary::{Cell, SummaryTable};

use crate::plan::Job;
use crate::run::Outcome;
use crate::spec::Study;

/// Writes all tables of a run into its folder, the manifest last.
///
/// # Errors
/// [`FolderError`] with the file that could not be written.
pub fn write(
    study: &Study,
    jobs: &[Job],
    outcome: &Outcome,
    manifest: &Manifest,
    folder: &Folder,
) -> Result<SummaryTable, FolderError> {
    let provenance = parquet::provenance(study, jobs);
    let records = &outcome.records;
    let record = &study.spec.record;
    folder.remove(manifest::FILE)?;
    let kind = study.spec.analysis.kind;
    let tables = [
        ("jobs.parquet", Some(frames::jobs(study, jobs, records))),
        (
            "positions.parquet",
            record.positions.then(|| frames::positions(kind, records)),
        ),
        (
            "connectors.parquet",
            record.connectors.then(|| frames::connectors(records)),
        ),
        (
            "histories.parquet",
            record.histories.asked().then(|| frames::histories(records)),
        ),
    ];
    for (name, frame) in tables {
        match frame {
            Some(frame) => parquet::write(folder, name, frame, &provenance)?,
            None => folder.remove(name)?,
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
