//! Parquet files with their provenance.
//!
//! Knows what a file says of where it comes from. Does not know its columns.

use super::folder::{Folder, FolderError};
use crate::plan::Job;
use crate::spec::Study;
use polars::prelude::{DataFrame, KeyValueMetadata, ParquetWriter, PolarsResult};
use std::io;

/// What every table of a study carries: nothing of it changes from run to run.
pub(super) fn provenance(study: &Study, jobs: &[Job]) -> KeyValueMetadata {
    let (study_text, study_hash) = study.text_and_hash();
    let (bridge_text, bridge_hash) = study.bridge_text_and_hash();
    let mut hashes: Vec<&str> = Vec::new();
    let mut seen = std::collections::HashSet::new();
    for job in jobs {
        if seen.insert(job.bridge.id) {
            hashes.push(&job.bridge.hash);
        }
    }
    let pairs = [
        ("pontoon.version", crate::VERSION.to_owned()),
        ("pontoon.study", study_text),
        ("pontoon.study_blake3", study_hash),
        ("pontoon.bridge", bridge_text),
        ("pontoon.bridge_blake3", bridge_hash),
        ("pontoon.bridges_after_axes_blake3", hashes.join(" ")),
    ];
    KeyValueMetadata::from_static(pairs.map(|(key, value)| (key.to_owned(), value)).to_vec())
}

/// Writes a table.
pub(super) fn write(
    folder: &Folder,
    name: &str,
    frame: PolarsResult<DataFrame>,
    provenance: &KeyValueMetadata,
) -> Result<(), FolderError> {
    folder.write(name, |file| {
        let mut frame = frame.map_err(io::Error::other)?;
        ParquetWriter::new(file)
            .set_parallel(false)
            .with_key_value_metadata(Some(provenance.clone()))
            .finish(&mut frame)
            .map(|_| ())
            .map_err(io::Error::other)
    })
}
