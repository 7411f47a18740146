//! Jobs that processes died with.
//!
//! Knows how to find out whether a job kills its process: what was under way when processes died is solved again as if
//! nothing had happened; a job that was under way twice is solved in a process of its own, whose death is the job's. A job
//! whose process died three times is passed over. A kill from outside ends the process that asks, not the one that solves,
//! and is counted against no job.

use super::ending::ending;
use super::fingerprint::{binding, session};
use super::results_folder::ResultsFolder;
use super::{SweepError, SweepSetting, Watcher};
use crate::run::{CancelToken, ResumeIndex, RunError, Setting, Silent, record_key, run};
use pontoon_journal::place::FolderError;
use pontoon_journal::{JournalIndex, JournalWriter, RecordKey};
use pontoon_plan::input::Refusal;
use pontoon_plan::job::Job;
use pontoon_plan::study_file::Study;
use pontoon_results::{Failure, FailureKind};
use std::collections::{BTreeMap, BTreeSet};

/// Deaths after which a job is solved in a process of its own.
const SUSPECT: usize = 2;

/// Numbers of jobs that are not to be solved, with why they failed.
pub(super) type PassedOver = BTreeMap<usize, Failure>;

/// How a process ended that solved jobs apart.
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

/// Finds out about jobs that processes died with, and tells which ones are passed over.
pub(super) fn settle(
    opened: &mut ResultsFolder,
    study: &Study,
    jobs: &[Job],
    cancel: &CancelToken,
    watcher: &dyn Watcher,
) -> Result<PassedOver, SweepError> {
    let (mut over, mut killed, mut before) = (PassedOver::new(), BTreeSet::new(), Vec::new());
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
        let Some(apart) = watcher.solve_apart(&hash_of(study), &numbers) else {
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

/// What tells a study and its bridge from any other.
pub(super) fn hash_of(study: &Study) -> String {
    let both = study.document.hash() + &study.bridge.document.hash();
    blake3::hash(both.as_bytes()).to_hex().to_string()
}

/// Jobs that processes died with too often.
fn suspects<'j>(index: &JournalIndex, jobs: &'j [Job]) -> impl Iterator<Item = &'j Job> {
    let mut deaths: BTreeMap<RecordKey, usize> = index.deaths();
    deaths.retain(|_, times| *times >= SUSPECT);
    let jobs = if deaths.is_empty() { &[] } else { jobs };
    jobs.iter().filter(move |job| deaths.contains_key(&record_key(job)))
}

/// Solves jobs one by one, for a process that holds the folder and wants to know whether they end this one.
///
/// # Errors
/// [`SweepError::Refused`] where the study is not the one of that hash any more; any other [`SweepError`].
pub fn run_apart(
    study: &Study,
    jobs: &[Job],
    (of, numbers): (&str, &[usize]),
    setting: &SweepSetting,
    cancel: &CancelToken,
) -> Result<(), SweepError> {
    if hash_of(study) != of {
        let allowed = "the study of the process that asks";
        return Err(Refusal::new(&study.file, "", "a study that was changed meanwhile", allowed).into());
    }
    let own: Vec<Job> = jobs
        .iter()
        .filter(|job| numbers.contains(&job.number))
        .cloned()
        .collect();
    let index = JournalIndex::read(&setting.out)?;
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
    let ran = run(study, &own, setting, cancel, &Silent, None).map_err(|e: RunError<FolderError>| SweepError::from(e));
    let how = ran.as_ref().map_or_else(ToString::to_string, |_| "complete".to_owned());
    writer.end(&ending(how, 0.0, 0.0))?;
    ran.map(|_| ())
}
