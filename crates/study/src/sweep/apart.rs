//! Work in a process of its own, for one that holds the folder and wants to know whether the work ends it.
//!
//! Knows both ends: what is asked of such a process, and what that does. Does not know why it is asked.

use super::ending::ending;
use super::fingerprint::{binding, session};
use super::{SweepError, SweepSetting};
use crate::run::{CancelToken, ResumeIndex, RunError, Setting, Silent, missing_by_bridge, prepare_apart, run};
use pontoon_journal::place::FolderError;
use pontoon_journal::{JournalIndex, JournalWriter};
use pontoon_plan::input::Refusal;
use pontoon_plan::job::Job;
use pontoon_plan::study_file::Study;
use std::collections::BTreeSet;

/// What a process does apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ApartTask {
    /// It solves jobs one by one.
    Solve,
    /// It prepares the bridges of jobs one by one, each with all that jobs of this bridge share.
    Prepare,
}

/// How a process ended that worked apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Apart {
    /// Its number.
    pub process: u32,
    /// How.
    pub end: ApartEnd,
}

/// How a process ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ApartEnd {
    /// By itself.
    Own,
    /// It died of what it did.
    Died,
    /// It was killed, by a person or for want of memory.
    Killed,
}

/// What tells a study and its bridge from any other.
pub(super) fn hash_of(study: &Study) -> String {
    let both = study.document.hash() + &study.bridge.document.hash();
    blake3::hash(both.as_bytes()).to_hex().to_string()
}

/// Does what a process asks for that holds the folder: the jobs by their numbers.
///
/// # Errors
/// [`SweepError::Refused`] where the study is not the one of that hash any more; any other [`SweepError`].
pub fn run_apart(
    study: &Study,
    jobs: &[Job],
    (task, of, numbers): (ApartTask, &str, &[usize]),
    setting: &SweepSetting,
    cancel: &CancelToken,
) -> Result<(), SweepError> {
    if hash_of(study) != of {
        let allowed = "the study of the process that asks";
        return Err(Refusal::new(&study.file, "", "a study that was changed meanwhile", allowed).into());
    }
    let index = JournalIndex::read(&setting.out)?;
    let own = own(&index, jobs, task, numbers);
    let resume_index = ResumeIndex::new(&index, &own);
    let asked = session(study, setting, 1, own.len(), resume_index.known(), true);
    let writer = JournalWriter::begin(
        &setting.out,
        &binding(study, setting.shard),
        &asked,
        resume_index.failed(),
    )?;
    let setting = Setting {
        threads: 1,
        batch: setting.batch,
        cache: setting.cache.clone(),
        resume_index: Some(resume_index.written_by(&writer)),
        apart: true,
        ..Setting::default()
    };
    let done = match task {
        ApartTask::Solve => run(study, &own, setting, cancel, &Silent, None).map(|_| ()),
        ApartTask::Prepare => prepare_apart(&own, setting, cancel),
    };
    let done = done.map_err(|e: RunError<FolderError>| SweepError::from(e));
    let how = done
        .as_ref()
        .map_or_else(ToString::to_string, |()| "complete".to_owned());
    writer.end(&ending(how, 0.0, 0.0))?;
    done
}

/// The jobs that a task is about, of those by their numbers. A bridge is named by one of its jobs, as there may be more of
/// them than a command line holds; failed ones are among them, as they may be tried again.
fn own(index: &JournalIndex, jobs: &[Job], task: ApartTask, numbers: &[usize]) -> Vec<Job> {
    let numbers: BTreeSet<usize> = numbers.iter().copied().collect();
    let named = |job: &&Job| numbers.contains(&job.number);
    match task {
        ApartTask::Solve => jobs.iter().filter(named).cloned().collect(),
        ApartTask::Prepare => {
            let bridges = missing_by_bridge(index, jobs, true);
            let named = bridges.into_iter().filter(|(_, jobs)| jobs.iter().any(named));
            named.flat_map(|(_, jobs)| jobs).cloned().collect()
        }
    }
}
