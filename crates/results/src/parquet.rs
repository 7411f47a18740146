//! Parquet files with their provenance, written row group by row group.
//!
//! Knows what a file says of where it comes from and how it grows. Does not know its columns.

use super::frame::{ArrowFrame, FrameWriter};
use pontoon_journal::fault::Watched;
use pontoon_journal::place::{Folder, FolderError, Partial};
use pontoon_plan::job::Job;
use pontoon_plan::study_file::Study;
use std::collections::HashSet;
use std::io::{self, BufWriter};

/// Most rows of a row group, the table library's own number: what a reader takes at a time.
const ROW_GROUP: usize = 1 << 18;

/// What a program's tables carry of it and of where their numbers were computed.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct TableProvenance {
    /// Commit of the program's sources, where it was built from one.
    pub commit: Option<String>,
    /// Instructions that crossings by the operator ran on; more than one where shards of such were merged.
    pub instruction_paths: Vec<String>,
}

/// What every table of a study carries: nothing of it changes from run to run, and nothing of it grows with the study, as
/// readers refuse a file that says too much of itself. The documents themselves stand beside the tables under their hashes.
pub(super) fn metadata(study: &Study, jobs: &[Job], of: &TableProvenance) -> Vec<(String, String)> {
    let (mut seen, mut bridges) = (HashSet::new(), blake3::Hasher::new());
    for job in jobs {
        if seen.insert(job.shared.bridge.id) {
            bridges.update(job.shared.bridge.hash.as_bytes());
            bridges.update(b" ");
        }
    }
    let pairs = [
        ("pontoon.version", crate::VERSION.to_owned()),
        ("pontoon.commit", of.commit.clone().unwrap_or_default()),
        ("pontoon.instruction_path", of.instruction_paths.join("; ")),
        ("pontoon.jobs", jobs.len().to_string()),
        ("pontoon.study_blake3", study.document.hash()),
        ("pontoon.bridge_blake3", study.bridge.document.hash()),
        ("pontoon.distinct_bridges", seen.len().to_string()),
        (
            "pontoon.bridges_after_axes_blake3",
            bridges.finalize().to_hex().to_string(),
        ),
    ];
    pairs.map(|(key, value)| (key.to_owned(), value)).to_vec()
}

/// A table under way: rows are appended, a part after the other, and nothing of them stays in memory.
pub(super) struct TableFile {
    partial: Partial,
    writer: FrameWriter<BufWriter<Watched>>,
    metadata: Vec<(String, String)>,
}

impl TableFile {
    /// Begins a table of the columns of `empty`.
    pub(super) fn begin(
        folder: &Folder,
        name: &str,
        empty: io::Result<ArrowFrame>,
        metadata: &[(String, String)],
    ) -> Result<Self, FolderError> {
        let partial = folder.begin(name)?;
        let to = BufWriter::new(partial.watched()?);
        match empty.and_then(|empty| FrameWriter::begin(to, &empty)) {
            Ok(writer) => Ok(Self {
                partial,
                writer,
                metadata: metadata.to_vec(),
            }),
            Err(cause) => Err(partial.error(cause)),
        }
    }

    /// Appends rows as row groups of their own; no rows make none.
    pub(super) fn append(&mut self, rows: io::Result<ArrowFrame>) -> Result<(), FolderError> {
        let appended = rows.and_then(|rows| {
            let mut starts = (0..rows.rows()).step_by(ROW_GROUP);
            starts.try_for_each(|start| {
                let group = start..rows.rows().min(start + ROW_GROUP);
                self.writer.append(&rows, &group)
            })
        });
        appended.map_err(|cause| self.partial.error(cause))
    }

    /// Ends the table, still under its temporary name, and leaves it with its hash.
    pub(super) fn end(self) -> Result<(Partial, String), FolderError> {
        let ended = self.writer.end(&self.metadata);
        ended.map_err(|cause| self.partial.error(cause))?;
        let hash = self.partial.sync()?;
        Ok((self.partial, hash))
    }
}
