//! A study run into its folder of results: nothing that is finished is run again, whatever became of the process before.
//!
//! Knows the order of things: lock, journal, what is bound to what, jobs, tables, manifest. Does not know how a job is solved
//! nor how a record is written.
//!
//! | module | charter |
//! |---|---|
//! | `apart` | work in a process of its own |
//! | `archive` | old results moved out of the way, under their hash |
//! | `fingerprint` | what a study's records are bound to; a study from a journal alone |
//! | `crash_suspects`, `preparation_suspects` | jobs and bridges that processes died with |
//! | `ending` | how a process says that it came to its own end |
//! | `forecast` | what a study will take, and what of it is done |
//! | `merge` | shards put together |
//! | `results_folder` | a folder of results taken: lock, journal, whether it is this study's |
//! | `partial_results` | what a journal holds of a study that is not done |
//! | `solving` | what is missing, solved into the journal |
//! | `status` | what is done, missing, failed; why a job ran or will run |

mod apart;
mod archive;
mod crash_suspects;
mod ending;
mod fingerprint;
mod forecast;
mod merge;
mod partial_results;
mod preparation_suspects;
mod results_folder;
mod solving;
mod status;

pub use apart::{Apart, ApartEnd, ApartTask, run_apart};
pub use ending::ended_now;
pub use forecast::{Forecast, RecordedJobs, forecast};
pub use merge::{Merged, merge};
pub use partial_results::{PartialResults, partial_results};
pub use status::{Explanation, Standings, explain, standings};

use crate::run::self_test::SelfTestError;
use crate::run::{Batch, Cache, CancelToken, PoolError, Progress, ResumeIndex, RunError, Why};
use pontoon_journal::place::FolderError;
use pontoon_journal::{JournalError, JournalWriter};
use pontoon_plan::input::Refusal;
use pontoon_plan::job::{Doubts, Job, Shard};
use pontoon_plan::study_file::Study;
use pontoon_results::{JobRecord, Manifest, Moment, Outcome, SummaryTable, TableProvenance, TableWriter};
use results_folder::ResultsFolder;
use solving::{SolveOutcome, Solving};
use std::path::PathBuf;
use std::sync::Arc;
use thiserror::Error;

/// How a sweep goes about its jobs.
#[derive(Debug, Clone, Default)]
pub struct SweepSetting {
    /// Folder of the results.
    pub out: PathBuf,
    /// Threads; 0: as many as the machine has.
    pub threads: usize,
    /// What is solved at a time.
    pub batch: Batch,
    /// Where operators are kept from run to run; none: nowhere.
    pub cache: Option<Cache>,
    /// The share of the jobs that is asked for; none: all. A share leaves a journal and no tables.
    pub shard: Option<Shard>,
    /// Jobs that are recorded as failed are tried again.
    pub retry_failed: bool,
    /// Results that the folder holds are moved aside, whatever they are.
    pub fresh: bool,
    /// Records of other instruction paths are of use.
    pub any_instructions: bool,
    /// Failed jobs beyond which the run stops.
    pub most_failures: Option<usize>,
    /// Commit of the program's sources, where it was built from one.
    pub commit: Option<String>,
}

/// Why a sweep did not come to its end.
#[derive(Debug, Error)]
pub enum SweepError {
    /// The folder holds what this study cannot go on from.
    #[error(transparent)]
    Refused(#[from] Refusal),
    /// The journal.
    #[error(transparent)]
    Journal(#[from] JournalError),
    /// A table or the folder could not be written.
    #[error("results not written")]
    Folder(#[from] FolderError),
    /// No threads.
    #[error(transparent)]
    Pool(#[from] PoolError),
    /// This machine or build computes wrongly.
    #[error(transparent)]
    SelfTest(#[from] SelfTestError),
    /// Somebody asked it to stop; the same command goes on from there.
    #[error("interrupted: {done} of {jobs} jobs are recorded, the same command goes on from there")]
    Interrupted {
        /// Recorded jobs.
        done: usize,
        /// Jobs asked for.
        jobs: usize,
    },
    /// More jobs failed than may.
    #[error("stopped: {failed} jobs failed, {done} of {jobs} are recorded")]
    Failures {
        /// Failed jobs.
        failed: usize,
        /// Recorded jobs.
        done: usize,
        /// Jobs asked for.
        jobs: usize,
    },
}

impl From<RunError<FolderError>> for SweepError {
    fn from(error: RunError<FolderError>) -> Self {
        match error {
            RunError::Pool(error) => error.into(),
            RunError::Sink(error) => error.into(),
            RunError::Journal(error) => error.into(),
            RunError::Stopped { why, tally } => match why {
                Why::Failures => Self::Failures {
                    failed: tally.failed,
                    done: tally.done,
                    jobs: tally.total,
                },
                Why::Interrupted | Why::Journal => Self::Interrupted {
                    done: tally.done,
                    jobs: tally.total,
                },
            },
        }
    }
}

/// What a sweep left beside its files.
#[derive(Debug)]
pub struct Swept<'a> {
    /// Counts and times.
    pub outcome: Outcome,
    /// The summary; none of a share.
    pub summary: Option<SummaryTable<'a>>,
    /// Jobs of the study.
    pub jobs: usize,
}

/// Who is told of a sweep.
pub trait Watcher: Progress {
    /// Something that is worth a line: what was set aside.
    fn note(&self, what: &str);

    /// Something that nobody should miss: what was passed over in the journal.
    fn warn(&self, what: &str);

    /// The journal's file of this process has begun.
    fn writing(&self, journal: &Arc<JournalWriter>);

    /// Does a task with jobs of a study of that hash, by their numbers, in a process of its own, see [`run_apart`]; none where
    /// that cannot be done. A stop that is asked for ends the process.
    fn work_apart(&self, task: ApartTask, study: &str, jobs: &[usize]) -> Option<Apart>;
}

/// Runs what is missing of a study, and writes its tables.
///
/// # Errors
/// [`SweepError`].
pub fn sweep<'a>(
    study: &Study,
    jobs: &'a [Job],
    setting: &SweepSetting,
    cancel: &CancelToken,
    watcher: &dyn Watcher,
) -> Result<Swept<'a>, SweepError> {
    let started = Moment::now();
    let mut opened = ResultsFolder::take(study, setting, watcher)?;
    Doubts::of(jobs).notes().iter().for_each(|note| watcher.note(note));
    let share = |shard: Shard| shard.deal(jobs).into_iter().map(|at| jobs[at].clone()).collect();
    let own: Option<Vec<Job>> = setting.shard.map(share);
    let asked: &[Job] = own.as_deref().unwrap_or(jobs);
    pontoon_results::keep_documents(opened.folder.path(), study)?;
    let (of, retry) = ((study, asked), setting.retry_failed);
    let passed_over = preparation_suspects::settle(&mut opened, of, retry, cancel, watcher)?;
    let passed_over = crash_suspects::settle(&mut opened, of, passed_over, cancel, watcher)?;
    let mut resume_index = ResumeIndex::new(&opened.index, asked);
    if setting.retry_failed {
        resume_index = resume_index.without_failed(asked);
    }
    results_folder::tell_damage(&opened.index, |what| match resume_index.known() < asked.len() {
        true => watcher.warn(what),
        false => watcher.note(what),
    });
    let paths = opened.instruction_paths(resume_index.known() < asked.len());
    let solving = Solving {
        study,
        jobs: asked,
        setting,
        cancel,
        watcher,
        opened: &opened,
        passed_over,
    };
    if own.is_some() {
        let solved = solving.solve(resume_index, None)?;
        solved.end()?;
        return Ok(Swept {
            outcome: solved.outcome,
            summary: None,
            jobs: jobs.len(),
        });
    }
    let provenance = TableProvenance {
        commit: setting.commit.clone(),
        instruction_paths: paths,
    };
    let done = resume_index.known() == asked.len();
    let whole = done
        .then(|| TableWriter::of_whole(study, jobs, resume_index.failed(), &opened.folder, &provenance))
        .flatten();
    let mut tables = match whole {
        Some(whole) => whole,
        None => TableWriter::begin(study, jobs, &opened.folder, &provenance)?,
    };
    let mut sink = |records: Vec<JobRecord>| tables.append(&records);
    let mut solved = solving.solve(resume_index, Some(&mut sink))?;
    // records before tables: whatever becomes of the tables, no job runs again
    if let Some(writer) = &solved.writer {
        writer.sync()?;
    }
    for before in opened.preparations() {
        solved.outcome.preparation.add(before);
    }
    let mut manifest = Manifest::new(study, jobs, &solved.outcome, started, Moment::now(), &provenance);
    manifest.sessions = opened.sessions();
    let finished = tables.finish(manifest);
    let summary = finished.map_err(|error| solved.end_without_tables(error.into()))?;
    solved.end()?;
    let SolveOutcome { outcome, .. } = solved;
    Ok(Swept {
        outcome,
        summary: Some(summary),
        jobs: jobs.len(),
    })
}
