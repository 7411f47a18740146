//! The tables of a run as its records come.
//!
//! Knows in which order files come into place. Keeps no record: what is kept of a job is its line of the summary.

use super::folder::{Folder, FolderError};
use super::frames::Layout;
use super::manifest::{self, Manifest};
use super::parquet::{TableFile, provenance};
use super::summary::{Lines, SummaryTable};
use super::table::TableName;
use crate::plan::Job;
use crate::run::JobRecord;
use crate::spec::Study;
use std::io::Write;

/// Name of the summary's file.
const SUMMARY: &str = "summary.csv";

/// The tables of a run under way. Until they are finished the folder keeps what it held before.
pub struct Writer<'a> {
    folder: &'a Folder,
    jobs: &'a [Job],
    layout: Layout,
    files: Vec<(TableName, TableFile)>,
    lines: Lines<'a>,
    taken: usize,
}

impl<'a> Writer<'a> {
    /// Begins the tables of a study with all its jobs.
    ///
    /// # Errors
    /// [`FolderError`] with the file that could not be begun.
    pub fn begin(study: &Study, jobs: &'a [Job], folder: &'a Folder) -> Result<Self, FolderError> {
        let layout = Layout::new(study, jobs);
        let provenance = provenance(study, jobs);
        let file = |name: TableName| {
            let empty = layout.frame(name, &[], &[]);
            Ok((name, TableFile::begin(folder, &name.file(), empty, &provenance)?))
        };
        Ok(Self {
            folder,
            jobs,
            files: layout.tables().map(file).collect::<Result<_, FolderError>>()?,
            layout,
            lines: Lines::new(study, jobs),
            taken: 0,
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
        let mut ended = Vec::new();
        for (name, file) in self.files {
            let (partial, hash) = file.end()?;
            manifest.tables.insert(name.file(), hash);
            ended.push(partial);
        }
        // from here on the folder holds no results until the new ones are whole
        self.folder.remove(manifest::FILE)?;
        for name in TableName::ALL.map(TableName::file) {
            if !manifest.tables.contains_key(&name) {
                self.folder.remove(&name)?;
            }
        }
        ended.into_iter().try_for_each(|partial| partial.place())?;
        self.folder.write(SUMMARY, |file| summary.write_csv(file))?;
        self.folder
            .write(manifest::FILE, |file| file.write_all(manifest.text().as_bytes()))?;
        Ok(summary)
    }
}
