//! What a folder's journal holds of a study that is not done, or whose tables are not there.
//!
//! Knows journals from outside, while others write them. Writes nothing.

use super::SweepError;
use super::fingerprint::check_program;
use super::results_folder::check_folder;
use super::status::study_of_index;
use crate::run::ResumeIndex;
use pontoon_journal::{JournalIndex, Session};
use pontoon_plan::input::Refusal;
use pontoon_plan::job::{Job, Jobs};
use pontoon_plan::study_file::Study;
use pontoon_results::JobRecord;
use std::path::Path;

/// The recorded jobs of a study.
#[derive(Debug, Clone)]
pub struct PartialResults {
    /// The study as the last process had it.
    pub study: Study,
    /// The jobs that are recorded, in their order.
    pub jobs: Vec<Job>,
    /// Their records.
    pub records: Vec<JobRecord>,
    /// Jobs of the study.
    pub of: usize,
    /// The share of the jobs that was asked for; none where all were.
    pub shard: Option<String>,
    /// The last process.
    pub session: Session,
}

/// Reads what is recorded in a folder.
///
/// # Errors
/// [`SweepError::Refused`] of a folder without a journal, or with one of a study that this program cannot read;
/// [`SweepError::Journal`].
pub fn partial_results(folder: &Path) -> Result<PartialResults, SweepError> {
    check_folder(folder)?;
    let index = JournalIndex::read(folder)?;
    check_program(&index)?;
    let (study, binding, session) = study_of_index(&index, folder)?;
    let jobs = Jobs::new(&study).collect::<Result<Vec<Job>, Refusal>>()?;
    let resume_index = ResumeIndex::new(&index, &jobs);
    let mut records = Vec::with_capacity(resume_index.known());
    for (at, job) in jobs.iter().enumerate() {
        records.extend(resume_index.record(at, job)?);
    }
    let of = jobs.len();
    let known = jobs.into_iter().enumerate().filter(|(at, _)| resume_index.knows(*at));
    let known = known.map(|(_, job)| job).collect();
    let (shard, session) = (binding.shard.clone(), session.clone());
    Ok(PartialResults {
        study,
        jobs: known,
        records,
        of,
        shard,
        session,
    })
}
