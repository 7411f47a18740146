//! Records in the journal, and back.
//!
//! Knows which jobs are recorded and how a record becomes bytes without loss. Does not know where the journal lies.

use pontoon_journal::{
    JournalError, JournalIndex, JournalWriter, NewRecord, PreparationKey, RecordKey, RecordLocation,
};
use pontoon_plan::job::Job;
use pontoon_results::{JobRecord, Preparation};

/// The journal as a run of some jobs sees it.
#[derive(Debug)]
pub struct ResumeIndex<'a> {
    index: &'a JournalIndex,
    /// Of each job, by its place among those of the run, the record that it has; nothing where none has one.
    known: Vec<Option<RecordLocation>>,
    writer: Option<&'a JournalWriter>,
    /// Recorded jobs that failed.
    failed: usize,
}

impl<'a> ResumeIndex<'a> {
    /// The records that `jobs` have in a journal.
    pub fn new(index: &'a JournalIndex, jobs: &[Job]) -> Self {
        let mut failed = 0;
        let known = jobs.iter().map(|job| {
            let entry = index.find(&record_key(job))?;
            failed += usize::from(entry.failed);
            Some(entry.place)
        });
        let known = if index.entries().is_empty() {
            Vec::new()
        } else {
            known.collect()
        };
        Self {
            index,
            known,
            writer: None,
            failed,
        }
    }

    /// Takes those of `jobs` whose records say that they failed for jobs that are not recorded, so that they are tried again.
    #[must_use]
    pub fn without_failed(mut self, jobs: &[Job]) -> Self {
        for (place, job) in self.known.iter_mut().zip(jobs) {
            let entry = self.index.find(&record_key(job));
            *place = place.filter(|_| entry.is_some_and(|entry| !entry.failed));
        }
        self.failed = 0;
        self
    }

    /// Lets new records go to a writer.
    #[must_use]
    pub fn written_by(mut self, writer: &'a JournalWriter) -> Self {
        self.writer = Some(writer);
        self
    }

    /// Number of jobs that are recorded.
    pub fn known(&self) -> usize {
        self.known.iter().flatten().count()
    }

    /// Of these, the ones that failed.
    pub fn failed(&self) -> usize {
        self.failed
    }

    fn place(&self, at: usize) -> Option<RecordLocation> {
        self.known.get(at).copied().flatten()
    }

    /// Whether the job at a place is recorded.
    pub fn knows(&self, at: usize) -> bool {
        self.place(at).is_some()
    }

    /// The record of the job at a place, where it has one.
    ///
    /// # Errors
    /// [`JournalError`].
    pub(crate) fn record(&self, at: usize, job: &Job) -> Result<Option<JobRecord>, JournalError> {
        let Some(place) = self.place(at) else { return Ok(None) };
        let left = self.index.record(place)?.left;
        let damaged = || self.index.damaged(place);
        let mut record: JobRecord = postcard::from_bytes(&left).map_err(|_| damaged())?;
        // the study may have grown
        record.job = job.number;
        Ok(Some(record))
    }

    /// Says that jobs are about to be solved together.
    pub(super) fn started<'j>(&self, jobs: impl Iterator<Item = &'j Job>) -> Result<(), JournalError> {
        let Some(writer) = self.writer else { return Ok(()) };
        let keys: Vec<RecordKey> = jobs.map(record_key).collect();
        writer.started(&keys)
    }

    /// Says that bridges are about to be prepared.
    pub(super) fn preparing(&self, keys: &[PreparationKey]) -> Result<(), JournalError> {
        self.writer.map_or(Ok(()), |writer| writer.preparing(keys))
    }

    /// Keeps what jobs share.
    pub(super) fn prepared(&self, preparation: &Preparation) -> Result<(), JournalError> {
        self.writer.map_or(Ok(()), |writer| writer.prepared(preparation))
    }

    /// Keeps records of jobs.
    pub(super) fn keep<'j>(&self, records: impl Iterator<Item = (&'j Job, &'j JobRecord)>) -> Result<(), JournalError> {
        let Some(writer) = self.writer else { return Ok(()) };
        let encode = |(job, record): (&Job, &JobRecord)| {
            let bytes = postcard::to_allocvec(record).map_err(|cause| JournalError::NotEncoded {
                what: format!("the record of job {}", job.number),
                cause: cause.to_string(),
            });
            Ok((record_key(job), record.failure.is_some(), bytes?))
        };
        let encoded: Vec<(RecordKey, bool, Vec<u8>)> = records.map(encode).collect::<Result<_, JournalError>>()?;
        writer.record(encoded.iter().map(|(key, failed, left)| NewRecord {
            key: *key,
            failed: *failed,
            left,
        }))
    }
}

/// What a job's record is found by.
pub(crate) fn record_key(job: &Job) -> RecordKey {
    RecordKey(job.key().0)
}
