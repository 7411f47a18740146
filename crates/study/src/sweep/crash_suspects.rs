//! Jobs that processes died with.
//!
//! Knows how to find out whether a job kills its process: what was under way when processes died is solved again as if
//! nothing had happened; a job that was under way twice is solved in a process of its own, whose death is the job's. A job
//! whose process died three times is passed over. A kill from outside ends the process that asks, not the one that solves,
//! and is counted against no job.

use super::apart::{ApartEnd, ApartTask, hash_of};
use super::results_folder::ResultsFolder;
use super::{SweepError, Watcher};
use crate::run::{CancelToken, record_key};
use pontoon_journal::{JournalIndex, RecordKey};
use pontoon_plan::job::Job;
use pontoon_plan::study_file::Study;
use pontoon_results::{Failure, FailureKind};
use std::collections::{BTreeMap, BTreeSet};

/// Deaths after which a job is solved in a process of its own.
const SUSPECT: usize = 2;

/// Numbers of jobs that are not to be solved, with why they failed.
pub(super) type PassedOver = BTreeMap<usize, Failure>;

/// Finds out about jobs that processes died with, and tells which ones are passed over, with those that are so already.
pub(super) fn settle(
    opened: &mut ResultsFolder,
    (study, jobs): (&Study, &[Job]),
    mut over: PassedOver,
    cancel: &CancelToken,
    watcher: &dyn Watcher,
) -> Result<PassedOver, SweepError> {
    let (mut killed, mut before) = (BTreeSet::new(), Vec::new());
    loop {
        let suspects: Vec<&Job> = suspects(&opened.index, jobs)
            .filter(|job| !over.contains_key(&job.number))
            .collect();
        let numbers: Vec<usize> = suspects.iter().map(|job| job.number).collect();
        if numbers.is_empty() || numbers == before || cancel.is_asked() {
            return Ok(over);
        }
        let many = numbers.len();
        watcher.warn(&format!(
            "{many} jobs were under way when processes died twice: solved one by one in a process of their own"
        ));
        let Some(apart) = watcher.work_apart(ApartTask::Solve, &hash_of(study), &numbers) else {
            return Ok(over);
        };
        opened.read_again()?;
        before = numbers;
        if apart.end == ApartEnd::Own {
            continue;
        }
        let begun: Vec<RecordKey> = opened.index.begun_apart(apart.process).copied().collect();
        for job in suspects.iter().filter(|job| begun.contains(&record_key(job))) {
            // one kill may be anybody's
            if apart.end == ApartEnd::Killed && killed.insert(job.number) {
                before.clear();
                continue;
            }
            let text = "the process died 3 times while this job ran, the last time with no other beside it";
            over.insert(
                job.number,
                Failure::new(FailureKind::ProcessDied, text).with("deaths", 3.0),
            );
        }
    }
}

/// Jobs that processes died with too often.
fn suspects<'j>(index: &JournalIndex, jobs: &'j [Job]) -> impl Iterator<Item = &'j Job> {
    let mut deaths: BTreeMap<RecordKey, usize> = index.deaths();
    deaths.retain(|_, times| *times >= SUSPECT);
    let jobs = if deaths.is_empty() { &[] } else { jobs };
    jobs.iter().filter(move |job| deaths.contains_key(&record_key(job)))
}
