//! What is done, missing, failed; why a job ran or will run.
//!
//! Knows journals from outside, while others write them. Writes nothing.

use super::SweepError;
use super::fingerprint::{check_program, study_of};
use super::results_folder::check_folder;
use crate::run::{ResumeIndex, preparation_key_of, record_key};
use pontoon_journal::{Binding, JournalIndex, Lock, Session, Standing};
use pontoon_plan::input::{Cell, Refusal};
use pontoon_plan::job::{Job, Jobs, Shard};
use pontoon_plan::study_file::Study;
use pontoon_results::Failure;
use serde::{Serialize, Serializer};
use serde_json::{Map, Value, json};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Folders of results with how far their runs have come.
#[derive(Debug, Clone, Serialize)]
pub struct Standings {
    /// Each folder, once.
    pub folders: Vec<(PathBuf, Standing)>,
    /// Jobs asked for, in all folders.
    pub jobs: usize,
    /// Jobs recorded.
    pub done: usize,
    /// Jobs that failed.
    pub failed: usize,
    /// Jobs that are missing.
    pub missing: usize,
    /// Shares of which no folder was given; empty where none is a share.
    pub shards_missing: Vec<String>,
}

/// How far the runs of folders have come.
///
/// # Errors
/// [`SweepError::Refused`] of a folder without a journal; [`SweepError::Journal`].
pub fn standings(folders: &[PathBuf]) -> Result<Standings, SweepError> {
    let mut all = Standings {
        folders: Vec::new(),
        jobs: 0,
        done: 0,
        failed: 0,
        missing: 0,
        shards_missing: Vec::new(),
    };
    let mut known = BTreeSet::new();
    for folder in folders {
        // the same folder by another name is the same folder
        if !known.insert(folder.canonicalize().unwrap_or_else(|_| folder.clone())) {
            continue;
        }
        let standing = match Standing::told(folder) {
            Some(told) => told,
            None => counted(folder)?,
        };
        all.jobs += standing.jobs;
        all.done += standing.done;
        all.failed += standing.failed;
        all.missing += standing.missing;
        all.folders.push((folder.clone(), standing));
    }
    let shards: Vec<Shard> = all
        .folders
        .iter()
        .filter_map(|(_, standing)| standing.shard.as_ref()?.parse().ok())
        .collect();
    let only_shares = shards.len() == all.folders.len();
    if let Some(of) = shards.first().map(|shard| shard.of).filter(|_| only_shares) {
        let given = |number| shards.contains(&Shard { number, of });
        all.shards_missing = (0..of).filter(|k| !given(*k)).map(|k| format!("{k}/{of}")).collect();
    }
    Ok(all)
}

/// How far a run has come by its journal and study alone.
fn counted(folder: &Path) -> Result<Standing, SweepError> {
    check_folder(folder)?;
    let index = JournalIndex::read(folder)?;
    let (study, binding, session) = study_of_index(&index, folder)?;
    let shard: Option<Shard> = binding.shard.as_ref().and_then(|shard| shard.parse().ok());
    let jobs = Jobs::new(&study).collect::<Result<Vec<Job>, Refusal>>()?;
    let share = |shard: Shard| shard.deal(&jobs).into_iter().map(|at| jobs[at].clone()).collect();
    let own: Option<Vec<Job>> = shard.map(share);
    let asked = own.as_deref().unwrap_or(&jobs);
    let resume_index = ResumeIndex::new(&index, asked);
    let ended = index
        .files
        .iter()
        .rev()
        .find(|w| w.session.as_ref().is_some_and(|s| !s.apart));
    let ended = ended
        .and_then(|written| written.ending.as_ref())
        .map(|ending| ending.how.as_str());
    let standing = Standing {
        study: study.name.clone(),
        shard: binding.shard.clone(),
        jobs: asked.len(),
        done: resume_index.known(),
        failed: resume_index.failed(),
        missing: asked.len() - resume_index.known(),
        running: false,
        state: String::new(),
    };
    Ok(standing.with_state(folder, &session.study_blake3, ended))
}

fn no_journal(folder: &Path) -> Refusal {
    Refusal::new(
        folder,
        "",
        "no journal of a run",
        "a folder that `pontoon run` has written to",
    )
}

/// Why a job ran or will run.
#[derive(Debug, Clone, Serialize)]
pub struct Explanation {
    /// The job's number.
    pub job: usize,
    /// Its key: jobs of one key leave the same record, in whatever study.
    pub key: String,
    /// Its axes.
    pub axes: Map<String, Value>,
    /// `ok`, `failed` or `missing`.
    pub state: &'static str,
    /// Why it failed, in words.
    pub reason: Option<String>,
    /// Why it failed: kind, numbers by name, words.
    #[serde(serialize_with = "with_numbers_by_name")]
    pub failure: Option<Failure>,
    /// In a sentence.
    pub why: String,
    /// The share of the jobs that it is of, where the folder is of a share.
    pub shard: Option<String>,
    /// When its record was written (UTC).
    pub recorded: Option<String>,
    /// By which process on which machine.
    pub by: Option<String>,
    /// The journal's file that holds its record.
    pub file: Option<PathBuf>,
    /// Processes that died while it was under way.
    pub deaths: usize,
    /// Length of its crossing in time steps.
    pub steps: usize,
}

/// A failure with its numbers as an object.
fn with_numbers_by_name<S: Serializer>(failure: &Option<Failure>, serializer: S) -> Result<S::Ok, S::Error> {
    let told = failure.as_ref().map(|failure| {
        let numbers: Map<String, Value> = failure
            .numbers
            .iter()
            .map(|(name, x)| (name.clone(), Cell::written(*x).value()))
            .collect();
        json!({ "kind": failure.kind, "numbers": numbers, "text": failure.text })
    });
    told.serialize(serializer)
}

/// Explains a job of the study that a folder's journal is of.
///
/// # Errors
/// [`SweepError`].
pub fn explain(folder: &Path, number: usize) -> Result<Explanation, SweepError> {
    check_folder(folder)?;
    let index = JournalIndex::read(folder)?;
    let (study, binding, _) = study_of_index(&index, folder)?;
    let job = &job_of(&study, folder, number)?;
    let key = record_key(job);
    let axes = study.axis_columns().into_iter();
    let axes = axes.map(|name| (name.clone(), job.column(&name).value())).collect();
    let shard: Option<Shard> = binding.shard.as_ref().and_then(|shard| shard.parse().ok());
    let running = Lock::is_held(folder);
    let deaths = if running {
        index.deaths_before(&key)
    } else {
        index.deaths().get(&key).copied().unwrap_or_default()
    };
    let mut told = Explanation {
        job: number,
        key: job.key().to_string(),
        axes,
        state: "missing",
        reason: None,
        failure: None,
        why: String::new(),
        shard: shard.map(|shard| shard.to_string()),
        recorded: None,
        by: None,
        file: None,
        deaths,
        steps: job.steps(),
    };
    match index.find(&key) {
        Some(entry) => {
            check_program(&index)?;
            let resume_index = ResumeIndex::new(&index, std::slice::from_ref(job));
            let record = resume_index.record(0, job)?;
            let written = index.file_of(entry.place);
            told.state = if entry.failed { "failed" } else { "ok" };
            told.failure = record.and_then(|record| record.failure);
            told.reason = told.failure.as_ref().map(|failure| failure.text.clone());
            told.recorded = Some(pontoon_results::Moment::of_unix_ms(index.record(entry.place)?.unix_ms).text());
            told.by = written
                .session
                .as_ref()
                .map(|s| format!("process {} on {}", s.process, s.host));
            told.file = Some(written.path.clone());
            told.why = match entry.failed {
                true => "recorded: it runs again with --retry-failed alone",
                false => "recorded: it does not run again",
            }
            .to_owned();
        }
        None => {
            let jobs = shard.map(|_| Jobs::new(&study).collect::<Result<Vec<Job>, Refusal>>());
            let jobs = jobs.transpose()?.unwrap_or_default();
            let elsewhere = shard.filter(|shard| !shard.deal(&jobs).contains(&number));
            told.why = match (elsewhere, deaths) {
                (Some(shard), _) => format!("not of the share {shard}: another one runs it"),
                (None, _) if running => "not recorded: a process is at work here and will come to it".to_owned(),
                (None, deaths) => why_next(&index, job, deaths),
            };
        }
    }
    Ok(told)
}

/// Why the next run of a study runs a job that is not recorded, and how.
fn why_next(index: &JournalIndex, job: &Job, deaths: usize) -> String {
    let in_preparation = index.deaths_in_preparation();
    match (deaths, in_preparation.get(&preparation_key_of(job))) {
        (0, None) => "not recorded: the next run of the study runs it".to_owned(),
        (0, Some(n)) => {
            let died = match n {
                1 => "a process died while it prepared".to_owned(),
                n => format!("{n} processes died while they prepared"),
            };
            format!(
                "not recorded: {died} its bridge; the next run of the study prepares that in a process of its own first"
            )
        }
        (n, _) => format!("under way in {n} processes that died: the next run of the study runs it again"),
    }
}

/// A job by its number; the others are made and forgotten, as there may be a million of them.
fn job_of(study: &Study, folder: &Path, number: usize) -> Result<Job, Refusal> {
    let (mut count, mut jobs) = (0, Jobs::new(study));
    for job in &mut jobs {
        let job = job?;
        if job.number == number {
            return Ok(job);
        }
        count += 1;
    }
    let allowed = format!("0 to {}", count.max(1) - 1);
    Err(Refusal::new(folder, "job", number, allowed))
}

/// The study of a folder's journal as its last process had it, and that process.
pub(super) fn study_of_index<'a>(
    index: &'a JournalIndex,
    folder: &Path,
) -> Result<(Study, &'a Binding, &'a Session), SweepError> {
    let (binding, session) = index.newest().ok_or_else(|| no_journal(folder))?;
    Ok((study_of(session, folder)?, binding, session))
}
