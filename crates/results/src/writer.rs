//! The tables of a run as its records come.
//!
//! Knows in which order files come into place. Keeps no record: what is kept of a job is its line of the summary.

use super::documents::keep_documents;
use super::exceedance::Exceedance;
use super::files::{MANIFEST, SUMMARY, SUMMARY_OF_LIMITS};
use super::layout::Layout;
use super::manifest::{self, Manifest};
use super::parquet::{TableFile, TableProvenance, metadata};
use super::summary::{SummaryLines, SummaryTable};
use super::table::TableName;
use crate::JobRecord;
use pontoon_journal::place::{Folder, FolderError};
use pontoon_plan::job::Job;
use pontoon_plan::study_file::Study;

/// The tables of a run under way. Until they are finished the folder keeps what it held before.
pub struct TableWriter<'a> {
    folder: Folder,
    jobs: &'a [Job],
    layout: Layout,
    files: Vec<(TableName, TableFile)>,
    lines: SummaryLines<'a>,
    taken: usize,
    /// Whether the tables are there already.
    whole: bool,
}

impl<'a> TableWriter<'a> {
    /// Begins the tables of a study with all its jobs.
    ///
    /// # Errors
    /// [`FolderError`] with the file that could not be begun.
    pub fn begin(
        study: &Study,
        jobs: &'a [Job],
        folder: &Folder,
        provenance: &TableProvenance,
    ) -> Result<Self, FolderError> {
        keep_documents(folder.path(), study)?;
        let layout = Layout::new(study, jobs);
        let metadata = metadata(study, jobs, provenance);
        let file = |name: TableName| {
            let empty = layout.frame(name, &[], &[]);
            Ok((name, TableFile::begin(folder, &name.file(), empty, &metadata)?))
        };
        Ok(Self {
            folder: folder.clone(),
            jobs,
            files: layout.tables().map(file).collect::<Result<_, FolderError>>()?,
            layout,
            lines: SummaryLines::new(study, jobs),
            taken: 0,
            whole: false,
        })
    }

    /// A writer of a study whose tables the folder holds already, so many jobs failed: nothing but the summary is written. None where they are
    /// not what this program would write.
    pub fn of_whole(
        study: &Study,
        jobs: &'a [Job],
        failed: usize,
        folder: &Folder,
        provenance: &TableProvenance,
    ) -> Option<Self> {
        let layout = Layout::new(study, jobs);
        let names: Vec<String> = layout.tables().map(TableName::file).collect();
        TableName::ALL
            .into_iter()
            .for_each(|name| folder.remove_begun(&name.file()));
        manifest::is_whole(folder.path(), study, (jobs.len(), failed), &names, provenance).then(|| Self {
            folder: folder.clone(),
            jobs,
            layout,
            files: Vec::new(),
            lines: SummaryLines::new(study, jobs),
            taken: 0,
            whole: true,
        })
    }

    /// Appends the rows of the next jobs.
    ///
    /// # Errors
    /// [`FolderError`] with the file that could not be written.
    pub fn append(&mut self, records: &[JobRecord]) -> Result<(), FolderError> {
        let jobs = &self.jobs[self.taken..self.taken + records.len()];
        self.taken += records.len();
        for (name, file) in &mut self.files {
            file.append(self.layout.frame(*name, jobs, records))?;
        }
        self.lines.append(records);
        Ok(())
    }

    /// Ends all tables, then puts them into place, the manifest with their hashes last.
    ///
    /// # Errors
    /// [`FolderError`] with the file that could not be written.
    pub fn finish(self, mut manifest: Manifest) -> Result<SummaryTable<'a>, FolderError> {
        let summary = self.lines.summary();
        if self.whole {
            summaries(&self.folder, &summary)?;
            return Ok(summary);
        }
        let mut ended = Vec::new();
        for (name, file) in self.files {
            let (partial, hash) = file.end()?;
            manifest.tables.insert(name.file(), hash);
            ended.push(partial);
        }
        // from here on the folder holds no results until the new ones are whole
        self.folder.remove(MANIFEST)?;
        for name in TableName::ALL.map(TableName::file) {
            if !manifest.tables.contains_key(&name) {
                self.folder.remove(&name)?;
            }
        }
        self.folder.sync()?;
        ended.into_iter().try_for_each(|partial| partial.place())?;
        summaries(&self.folder, &summary)?;
        self.folder
            .write(MANIFEST, |file| file.write_all(manifest.text().as_bytes()))?;
        Ok(summary)
    }
}

/// Writes the files that people read, and removes one of limits that no longer holds.
fn summaries(folder: &Folder, summary: &SummaryTable<'_>) -> Result<(), FolderError> {
    folder.write(SUMMARY, |file| summary.write_csv(file))?;
    match summary.exceedances() {
        [] => folder.remove(SUMMARY_OF_LIMITS),
        some => folder.write(SUMMARY_OF_LIMITS, |file| Exceedance::write_csv(some, file)),
    }
}
