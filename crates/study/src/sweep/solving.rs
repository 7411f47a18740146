//! What is missing of a study, solved into its journal.
//!
//! Knows when a journal is begun and how it ends, and that a machine proves itself first. Does not know tables.

use super::crash_suspects::PassedOver;
use super::ending::ending;
use super::fingerprint::session;
use super::results_folder::ResultsFolder;
use super::{SweepError, SweepSetting, Watcher};
use crate::run::{CancelToken, ResumeIndex, Setting, Sink, run, self_test};
use pontoon_journal::JournalWriter;
use pontoon_journal::place::FolderError;
use pontoon_plan::job::Job;
use pontoon_plan::study_file::Study;
use pontoon_results::Outcome;
use std::sync::Arc;

/// Jobs of a study on the way into its journal.
pub(super) struct Solving<'a> {
    pub study: &'a Study,
    /// Jobs asked for.
    pub jobs: &'a [Job],
    pub setting: &'a SweepSetting,
    pub cancel: &'a CancelToken,
    pub watcher: &'a dyn Watcher,
    pub opened: &'a ResultsFolder,
    pub passed_over: PassedOver,
}

/// What solving left.
pub(super) struct SolveOutcome {
    pub outcome: Outcome,
    /// The journal's file of this process; none where nothing was missing.
    pub writer: Option<Arc<JournalWriter>>,
}

impl Solving<'_> {
    /// Solves what is missing; all records pass the sink.
    pub(super) fn solve(
        self,
        resume_index: ResumeIndex<'_>,
        sink: Option<&mut Sink<'_, FolderError>>,
    ) -> Result<SolveOutcome, SweepError> {
        let (known, failed) = (resume_index.known(), resume_index.failed());
        let missing = known < self.jobs.len();
        if missing {
            self_test::run()?;
        }
        // a study that has shrunk, and a share without jobs, have their word in the journal too
        let writer = if missing || !self.opened.is_of(self.study) {
            let threads = self.setting.threads;
            let session = session(self.study, self.setting, threads, self.jobs.len(), known, false);
            let folder = self.opened.folder.path();
            let writer = Arc::new(JournalWriter::begin(folder, &self.opened.binding, &session, failed)?);
            self.watcher.writing(&writer);
            Some(writer)
        } else {
            None
        };
        let resume_index = match &writer {
            Some(writer) => resume_index.written_by(writer),
            None => resume_index,
        };
        let setting = Setting {
            threads: self.setting.threads,
            batch: self.setting.batch,
            cache: self.setting.cache.clone(),
            resume_index: Some(resume_index),
            apart: false,
            most_failures: self.setting.most_failures,
            passed_over: self.passed_over,
        };
        let ran = run(self.study, self.jobs, setting, self.cancel, self.watcher, sink).map_err(SweepError::from);
        match ran {
            Ok(outcome) => Ok(SolveOutcome { outcome, writer }),
            Err(error) => {
                end_with(writer.as_deref(), &error);
                Err(error)
            }
        }
    }
}

/// Ends the journal's file of a run that could not go on. The error that ended the run is the one to tell.
fn end_with(writer: Option<&JournalWriter>, error: &SweepError) {
    let how = match error {
        SweepError::Interrupted { .. } => "interrupted".to_owned(),
        SweepError::Folder(cause) => format!("{error}: {cause}"),
        other => other.to_string(),
    };
    if let Some(writer) = writer {
        let _ = writer.end(&ending(how, 0.0, 0.0));
    }
}

impl SolveOutcome {
    /// Ends the journal's file where its records are whole and what comes after them could not be written.
    pub(super) fn end_without_tables(&self, error: SweepError) -> SweepError {
        end_with(self.writer.as_deref(), &error);
        error
    }

    /// Ends the journal's file.
    pub(super) fn end(&self) -> Result<(), SweepError> {
        if let Some(writer) = &self.writer {
            writer.end(&ending(
                "complete".to_owned(),
                self.outcome.offline_s,
                self.outcome.jobs_s,
            ))?;
        }
        Ok(())
    }
}
