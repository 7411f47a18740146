//! Bridges that processes died with while they prepared them.
//!
//! Knows how to find out whether a bridge kills its process: the bridges that a process prepared when it died are prepared one
//! by one in a process of its own, whose death is the bridge's. The jobs of such a bridge are passed over. One death is enough
//! to ask, as no job of any other bridge is solved until it is known.

use super::apart::{ApartEnd, ApartTask, hash_of};
use super::crash_suspects::PassedOver;
use super::results_folder::ResultsFolder;
use super::{SweepError, Watcher};
use crate::run::{CancelToken, missing_by_bridge};
use pontoon_journal::{JournalIndex, PreparationKey};
use pontoon_plan::job::Job;
use pontoon_plan::study_file::Study;
use pontoon_results::{Failure, FailureKind};
use std::collections::BTreeMap;

/// Most bridges that a process is asked for: a command line holds so many numbers.
const MOST_ASKED: usize = 5000;

/// A bridge that processes died with.
struct Suspect<'j> {
    key: PreparationKey,
    /// How many.
    deaths: usize,
    /// Its jobs that are not recorded.
    jobs: Vec<&'j Job>,
}

/// Finds out about bridges that processes died with, and tells which jobs are passed over. Jobs that are recorded as failed are
/// of interest where they are tried again.
pub(super) fn settle(
    opened: &mut ResultsFolder,
    (study, jobs): (&Study, &[Job]),
    retry_failed: bool,
    cancel: &CancelToken,
    watcher: &dyn Watcher,
) -> Result<PassedOver, SweepError> {
    let (mut over, mut before) = (PassedOver::new(), Vec::new());
    let mut apart_deaths: BTreeMap<PreparationKey, usize> = BTreeMap::new();
    loop {
        let suspects = suspects(&opened.index, jobs, retry_failed, &over);
        let numbers: Vec<usize> = suspects.iter().map(|suspect| suspect.jobs[0].number).collect();
        let numbers = &numbers[..numbers.len().min(MOST_ASKED)];
        if numbers.is_empty() || numbers == before || cancel.is_asked() {
            return Ok(over);
        }
        watcher.warn(&match suspects.len() {
            1 => "a bridge was being prepared when a process died: prepared in a process of its own".to_owned(),
            n => format!(
                "{n} bridges were being prepared when a process died: prepared one by one in a process of their own"
            ),
        });
        let Some(apart) = watcher.work_apart(ApartTask::Prepare, &hash_of(study), numbers) else {
            return Ok(over);
        };
        opened.read_again()?;
        before = numbers.to_vec();
        if apart.end == ApartEnd::Own {
            continue;
        }
        for key in opened.index.preparing_apart(apart.process) {
            let here = apart_deaths.entry(*key).or_insert(0);
            *here += 1;
            // one kill may be anybody's
            if apart.end == ApartEnd::Killed && *here == 1 {
                before.clear();
                continue;
            }
            for suspect in suspects.iter().filter(|suspect| suspect.key == *key) {
                let failure = died(suspect.deaths + *here);
                over.extend(suspect.jobs.iter().map(|job| (job.number, failure.clone())));
            }
        }
    }
}

/// The failure of the jobs of a bridge.
fn died(times: usize) -> Failure {
    let text = format!(
        "the process died {times} times while it prepared the bridge of this job, the last time with no other beside it"
    );
    Failure::new(FailureKind::ProcessDied, text).with("deaths", times as f64)
}

/// Bridges that processes died with since one prepared them, of jobs that are missing and not passed over.
fn suspects<'j>(index: &JournalIndex, jobs: &'j [Job], retry_failed: bool, over: &PassedOver) -> Vec<Suspect<'j>> {
    let deaths = index.deaths_in_preparation();
    if deaths.is_empty() {
        return Vec::new();
    }
    let bridges = missing_by_bridge(index, jobs, retry_failed).into_iter();
    let suspects = bridges.filter_map(|(key, jobs)| {
        let deaths = *deaths.get(&key)?;
        let passed = over.contains_key(&jobs[0].number);
        (!passed).then_some(Suspect { key, deaths, jobs })
    });
    suspects.collect()
}
