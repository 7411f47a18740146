//! A run monitored: what is recorded, what is told of jobs as they begin and end, and what makes it stop.
//!
//! Knows the journal by way of the resume index and counts jobs. Does not know how jobs are solved.

use super::Setting;
use super::batch::JobObserver;
use super::cancel::{CancelToken, Why};
use super::error::RunError;
use super::failure::too_long;
use super::model_keys::by_bridge;
use super::progress::{Progress, Tally};
use super::resume_index::ResumeIndex;
use pontoon_journal::{JournalError, PreparationKey, fault};
use pontoon_plan::job::Job;
use pontoon_results::{Failure, JobRecord, Preparation};
use std::collections::BTreeMap;
use std::error::Error as StdError;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

/// What watches a run.
pub(super) struct Monitor<'a> {
    resume_index: Option<&'a ResumeIndex<'a>>,
    pub(super) apart: bool,
    passed_over: &'a BTreeMap<usize, Failure>,
    most_failures: Option<usize>,
    cancel: &'a CancelToken,
    progress: &'a dyn Progress,
    /// Jobs in all; done, recorded ones included; failed; run here.
    total: usize,
    done: AtomicUsize,
    failed: AtomicUsize,
    ran: AtomicUsize,
    /// Why the journal cannot be written.
    broken: Mutex<Option<JournalError>>,
}

impl<'a> Monitor<'a> {
    pub(super) fn new(
        total: usize,
        setting: &'a Setting<'a>,
        cancel: &'a CancelToken,
        progress: &'a dyn Progress,
    ) -> Self {
        let resume_index = setting.resume_index.as_ref();
        Self {
            resume_index,
            apart: setting.apart,
            passed_over: &setting.passed_over,
            most_failures: setting.most_failures,
            cancel,
            progress,
            total,
            done: AtomicUsize::new(resume_index.map_or(0, ResumeIndex::known)),
            failed: AtomicUsize::new(resume_index.map_or(0, ResumeIndex::failed)),
            ran: AtomicUsize::new(0),
            broken: Mutex::new(None),
        }
    }

    /// Whether the job at a place is recorded.
    pub(super) fn knows(&self, at: usize) -> bool {
        self.resume_index.is_some_and(|resume_index| resume_index.knows(at))
    }

    /// Recorded jobs that had failed.
    pub(super) fn failed_before(&self) -> usize {
        self.resume_index.map_or(0, ResumeIndex::failed)
    }

    /// Says which bridges are about to be prepared, so that it is known what a process died with.
    pub(super) fn preparing(&self, jobs: &[&Job]) {
        if let Some(resume_index) = self.resume_index {
            let bridges = by_bridge(jobs.iter().copied());
            let keys: Vec<PreparationKey> = bridges.into_iter().map(|(key, _)| key).collect();
            self.note(resume_index.preparing(&keys));
        }
        fault::at_preparation(jobs.iter().map(|job| job.number));
    }

    /// Keeps what was prepared.
    pub(super) fn prepared(&self, preparation: &Preparation) {
        self.note(
            self.resume_index
                .map_or(Ok(()), |resume_index| resume_index.prepared(preparation)),
        );
    }

    /// Tells how many jobs are done before any runs.
    pub(super) fn begin_counting(&self) {
        self.check_failures(self.failed.load(Ordering::Relaxed));
        self.progress.jobs(self.tally());
    }

    fn tally(&self) -> Tally {
        let ran = self.ran.load(Ordering::Relaxed);
        Tally {
            done: self.done.load(Ordering::Relaxed),
            failed: self.failed.load(Ordering::Relaxed),
            total: self.total,
            ran,
        }
    }

    fn check_failures(&self, failed: usize) {
        if self.most_failures.is_some_and(|most| failed > most) {
            self.cancel.ask(Why::Failures);
        }
    }

    /// Records of jobs of a batch that begins `from`, those that are recorded put between those `solved` now.
    pub(super) fn with_known(
        &self,
        batch: &[Job],
        from: usize,
        solved: Vec<JobRecord>,
    ) -> Result<Vec<JobRecord>, JournalError> {
        let Some(resume_index) = self.resume_index else {
            return Ok(solved);
        };
        let (mut all, mut solved) = (Vec::with_capacity(batch.len()), solved.into_iter());
        for (at, job) in (from..).zip(batch) {
            match resume_index.record(at, job)? {
                Some(known) => all.push(known),
                // none where the run was stopped
                None => all.extend(solved.next()),
            }
        }
        Ok(all)
    }

    /// Why a job is not to be solved; none where it is.
    pub(super) fn passes_over(&self, job: &Job) -> Option<Failure> {
        let known = self.passed_over.get(&job.number).cloned();
        known.or_else(|| too_long(job))
    }

    /// The failures of jobs that are not to be solved.
    pub(super) fn pass_over(&self, jobs: &[&Job]) -> Vec<JobRecord> {
        let failed = |job: &&Job| Some(JobRecord::failed(job, self.passes_over(job)?));
        let records: Vec<JobRecord> = jobs.iter().filter_map(failed).collect();
        self.end(jobs, &records);
        records
    }

    /// Whether a stop is asked for.
    pub(super) fn is_stopped(&self) -> bool {
        self.cancel.is_asked()
    }

    /// Jobs run here.
    pub(super) fn ran(&self) -> usize {
        self.ran.load(Ordering::Relaxed)
    }

    fn note(&self, kept: Result<(), JournalError>) {
        if let Err(error) = kept {
            self.cancel.ask(Why::Journal);
            self.broken
                .lock()
                .unwrap_or_else(PoisonError::into_inner)
                .get_or_insert(error);
        }
    }

    /// Whether the run goes on.
    pub(super) fn outcome<E: StdError + Send + 'static>(&self) -> Result<(), RunError<E>> {
        if let Some(error) = self.broken.lock().unwrap_or_else(PoisonError::into_inner).take() {
            return Err(RunError::Journal(error));
        }
        match self.cancel.why() {
            None => Ok(()),
            Some(why) => Err(RunError::Stopped {
                why,
                tally: self.tally(),
            }),
        }
    }
}

impl JobObserver for Monitor<'_> {
    fn begin(&self, jobs: &[&Job]) -> bool {
        if self.cancel.is_asked() {
            return false;
        }
        if let Some(resume_index) = self.resume_index {
            self.note(resume_index.started(jobs.iter().copied()));
        }
        for job in jobs {
            fault::at_job(job.number);
        }
        true
    }

    fn end(&self, jobs: &[&Job], records: &[JobRecord]) {
        if let Some(resume_index) = self.resume_index {
            self.note(resume_index.keep(jobs.iter().copied().zip(records)));
        }
        let fails = records.iter().filter(|record| record.failure.is_some()).count();
        let failed = self.failed.fetch_add(fails, Ordering::Relaxed) + fails;
        self.done.fetch_add(records.len(), Ordering::Relaxed);
        self.ran.fetch_add(records.len(), Ordering::Relaxed);
        self.check_failures(failed);
        self.progress.jobs(self.tally());
    }
}
