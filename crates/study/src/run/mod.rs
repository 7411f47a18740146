//! Jobs to records: what jobs share is prepared once, jobs run in parallel, a failed job is a record.
//!
//! | module | charter |
//! |---|---|
//! | `shared_models`, `made_once`, `cache` | what jobs share, prepared once; operators on disk |
//! | `cut`, `batch`, `pool` | which jobs are solved together, and on which threads |
//! | `crossing`, `statics`, `modes`, `rating`, `retry` | a job to its record, by its kind; when a crossing is solved once more |
//! | `demands` | what a crossing asks of limits |
//! | `tried`, `finer` | crossings that a rating tries, and the operator that judges them |
//! | `verify`, `self_test` | the reference solver as judge; a crossing whose answer is known |
//! | `session` | studies solved one after the other in one process, without a file |
//! | `failure`, `guard` | an error of the mechanics as the failure that a record keeps; panics made failures |
//! | `resume_index` | records in the journal, and back |
//! | `monitor`, `progress`, `cancel`, `probe` | who is told, who may stop it, how long it will take |
//! | `error` | why a run did not come to its end |
//!
//! Knows threads and the clock. Does not know files of results: a record holds all rows of its job, whatever becomes of it,
//! and is handed on as soon as its batch is solved.

mod batch;
mod cache;
mod cancel;
mod crossing;
mod cut;
mod dead_rows;
mod demands;
mod error;
mod failure;
mod finer;
mod guard;
mod joint_rows;
mod made_once;
mod model_keys;
mod modes;
mod monitor;
mod pool;
mod probe;
mod progress;
mod quantity_words;
mod rating;
mod resume_index;
mod retry;
pub mod self_test;
mod session;
mod shared_models;
mod statics;
mod tried;
mod verify;

pub use cache::Cache;
pub use cancel::{CancelToken, Why};
pub use cut::Batch;
pub use error::RunError;
pub use pool::{PoolError, on_threads};
pub use probe::{Measured, measure};
pub use progress::{Progress, Silent, Tally};
pub use resume_index::ResumeIndex;
pub(crate) use resume_index::record_key;
pub use retry::{RETRY_STEP_SHARE, half_step_may_help};
pub use self_test::SelfTestError;
pub use session::{SessionError, SessionSetting, SolveSession};
pub use shared_models::PreparedModules;

use batch::NoObserver;
use model_keys::by_bridge;
pub(crate) use model_keys::preparation_key_of;
use monitor::Monitor;
use pontoon_journal::{JournalIndex, PreparationKey};
use pontoon_plan::job::Job;
use pontoon_plan::study_file::{HistoriesSpec, Study};
use pontoon_results::{Failure, Failures, JobRecord, Outcome, Preparation, Verification};
use shared_models::SharedModels;
use std::collections::BTreeMap;
use std::error::Error as StdError;
use std::sync::Arc;
use std::time::Instant;

/// The instructions that crossings by the operator run on here.
pub fn instruction_path() -> &'static str {
    pontoon_core::operator::InstructionPath::of_this_machine().name
}

/// How a run goes about its jobs; no record depends on it.
#[derive(Debug, Default)]
pub struct Setting<'a> {
    /// Threads; 0: as many as the machine has.
    pub threads: usize,
    /// What is solved at a time.
    pub batch: Batch,
    /// Where operators are kept from run to run; none: nowhere.
    pub cache: Option<Cache>,
    /// What is recorded of the jobs, and where new records go; none: nothing and nowhere.
    pub resume_index: Option<ResumeIndex<'a>>,
    /// Jobs are solved one by one, so that it is known which of them a process dies with.
    pub apart: bool,
    /// Failed jobs beyond which the run stops; none: it goes on.
    pub most_failures: Option<usize>,
    /// Numbers of jobs that are not to be solved, with why they failed.
    pub passed_over: BTreeMap<usize, Failure>,
}

/// Where the records of a batch go, in the order of jobs.
pub type Sink<'a, E> = dyn FnMut(Vec<JobRecord>) -> Result<(), E> + Send + 'a;

/// Runs the jobs of a study that are not recorded yet, batch by batch in their order. While a batch is solved, `sink` takes
/// the records of all jobs of the one before it, on the same pool: no more than the records of two batches are in memory.
/// Without a sink nothing but the journal takes records. Neither the records nor the batches depend on the number of
/// threads, nor on which jobs were recorded before.
///
/// # Errors
/// [`RunError::Pool`]; [`RunError::Sink`] with what the sink said, which ends the run; [`RunError::Journal`];
/// [`RunError::Stopped`]. A job that fails is a record.
pub fn run<E: StdError + Send + 'static>(
    study: &Study,
    jobs: &[Job],
    setting: Setting<'_>,
    cancel: &CancelToken,
    progress: &dyn Progress,
    mut sink: Option<&mut Sink<'_, E>>,
) -> Result<Outcome, RunError<E>> {
    let threads = setting.threads;
    on_threads(threads, || {
        let start = Instant::now();
        let monitor = Monitor::new(jobs.len(), &setting, cancel, progress);
        let missing: Vec<&Job> = (0..)
            .zip(jobs)
            .filter(|(at, _)| !monitor.knows(*at))
            .map(|(_, job)| job)
            .collect();
        let (models, preparation) = prepare(missing, &setting, &monitor, cancel, progress);
        let offline_s = start.elapsed().as_secs_f64();
        progress.stage("running jobs");
        monitor.begin_counting();
        let (mut failures, mut verification) = (Failures::default(), Verification::default());
        let has_sink = sink.is_some();
        let (mut batches, mut solved, mut from) = (cut::cut(study, jobs, setting.batch), None, 0);
        loop {
            let (batch, before) = (batches.next(), solved.take());
            let (records, taken) = rayon::join(
                || {
                    let batch = batch.filter(|_| !cancel.is_asked())?;
                    let records = solve_missing(study, batch, from, &models, &monitor);
                    Some(if has_sink {
                        monitor.with_known(batch, from, records)
                    } else {
                        Ok(records)
                    })
                },
                || match (before, sink.as_mut()) {
                    (Some(before), Some(sink)) => sink(before),
                    _ => Ok(()),
                },
            );
            taken.map_err(RunError::Sink)?;
            monitor.outcome()?;
            let Some(records) = records else { break };
            let records = records?;
            from += batch.map_or(0, <[Job]>::len);
            failures.take(&records);
            verification.take(&records);
            solved = Some(records);
        }
        monitor.outcome()?;
        if !has_sink {
            // nobody has read the records that were there before
            failures.count += monitor.failed_before();
        }
        Ok(Outcome {
            jobs: jobs.len(),
            ran: monitor.ran(),
            failures,
            verification,
            preparation,
            threads: rayon::current_num_threads(),
            offline_s,
            jobs_s: start.elapsed().as_secs_f64() - offline_s,
        })
    })?
}

/// Prepares what the missing jobs share. Jobs that are passed over need nothing, and their bridge may be what a process died
/// with.
fn prepare(
    mut missing: Vec<&Job>,
    setting: &Setting<'_>,
    monitor: &Monitor<'_>,
    cancel: &CancelToken,
    progress: &dyn Progress,
) -> (SharedModels, Preparation) {
    missing.retain(|job| !setting.passed_over.contains_key(&job.number));
    // what is stopped before it begins clears no bridge of a suspicion
    if !missing.is_empty() && !cancel.is_asked() {
        monitor.preparing(&missing);
    }
    let (known, cache) = (PreparedModules::default(), setting.cache.as_ref());
    let models = SharedModels::prepare(&missing, &known, cache, cancel, progress);
    let preparation = models.preparation(&missing);
    if !missing.is_empty() {
        monitor.prepared(&preparation);
    }
    (models, preparation)
}

/// Prepares the bridges of jobs one by one, so that it is known which of them a process dies with. Nothing is left of it but
/// what the journal and the cache keep.
///
/// # Errors
/// [`RunError::Pool`], [`RunError::Journal`], [`RunError::Stopped`].
pub fn prepare_apart<E: StdError + Send + 'static>(
    jobs: &[Job],
    setting: Setting<'_>,
    cancel: &CancelToken,
) -> Result<(), RunError<E>> {
    on_threads(setting.threads, || {
        let monitor = Monitor::new(jobs.len(), &setting, cancel, &Silent);
        let mut known = PreparedModules::default();
        for (_, jobs) in by_bridge(jobs.iter()) {
            // a module of another bridge would stand beside this one in memory
            known.keep_for(&jobs);
            monitor.preparing(&jobs);
            let models = SharedModels::prepare(&jobs, &known, setting.cache.as_ref(), cancel, &Silent);
            if cancel.is_asked() {
                break;
            }
            monitor.prepared(&models.preparation(&jobs));
            known = models.modules();
        }
        monitor.outcome()
    })?
}

/// Jobs that are taken for missing, by the bridge whose preparation they share.
pub(crate) fn missing_by_bridge<'j>(
    index: &JournalIndex,
    jobs: &'j [Job],
    retry_failed: bool,
) -> Vec<(PreparationKey, Vec<&'j Job>)> {
    let missing = |job: &&Job| {
        let entry = index.find(&record_key(job));
        entry.is_none_or(|entry| retry_failed && entry.failed)
    };
    by_bridge(jobs.iter().filter(missing))
}

/// Solves the jobs of a batch that are not recorded; the batch begins `from`.
fn solve_missing(
    study: &Study,
    batch: &[Job],
    from: usize,
    models: &SharedModels,
    monitor: &Monitor<'_>,
) -> Vec<JobRecord> {
    let missing = (from..).zip(batch).filter(|(at, _)| !monitor.knows(*at));
    let (over, missing): (Vec<&Job>, Vec<&Job>) = missing
        .map(|(_, job)| job)
        .partition(|job| monitor.passes_over(job).is_some());
    let missing: Vec<(&Study, &Job)> = missing.into_iter().map(|job| (study, job)).collect();
    let mut records = batch::solve(&missing, monitor.apart, models, monitor);
    if !over.is_empty() && !monitor.is_stopped() {
        records.extend(monitor.pass_over(&over));
        records.sort_by_key(|record| record.job);
    }
    records
}

/// Solves jobs of several studies on the current pool: what any of them share is prepared once, and modules that are
/// `known` are not prepared again. Leaves a record for each job in their order, and the modules.
pub fn solve_together(jobs: &[(&Study, &Job)], known: &PreparedModules) -> (Vec<JobRecord>, Prepared) {
    let alone: Vec<&Job> = jobs.iter().map(|(_, job)| *job).collect();
    let models = SharedModels::prepare(&alone, known, None, &CancelToken::default(), &Silent);
    let records = batch::solve(jobs, false, &models, &NoObserver);
    let prepared = Prepared {
        modules: models.modules(),
        condensations: models.condensations(),
    };
    (records, prepared)
}

/// Solves crossings of a study once more with all their histories, some at a time, and hands their records on: no record is
/// kept. What they share is taken from `cache` where it is there.
pub fn replay(study: &Study, jobs: &[&Job], cache: Option<&Cache>, mut take: impl FnMut(&Job, JobRecord)) {
    let mut whole: BTreeMap<usize, Study> = BTreeMap::new();
    for job in jobs {
        let modules = job.shared.bridge.design.modules;
        whole.entry(modules).or_insert_with(|| {
            let mut study = study.clone();
            let record = Arc::make_mut(&mut study.record);
            record.histories = HistoriesSpec {
                positions: (1..=modules + 1).collect(),
                joints: (2..=modules).collect(),
                ..HistoriesSpec::default()
            };
            record.at_peak_of.clear();
            study
        });
    }
    let models = SharedModels::prepare(
        jobs,
        &PreparedModules::default(),
        cache,
        &CancelToken::default(),
        &Silent,
    );
    for some in jobs.chunks(REPLAYED_TOGETHER) {
        let pairs: Vec<(&Study, &Job)> = some
            .iter()
            .filter_map(|job| Some((whole.get(&job.shared.bridge.design.modules)?, *job)))
            .collect();
        for (job, record) in some.iter().zip(batch::solve(&pairs, false, &models, &NoObserver)) {
            take(job, record);
        }
    }
}

/// Crossings whose whole histories are in memory together.
const REPLAYED_TOGETHER: usize = 64;

/// What a run prepared.
pub struct Prepared {
    /// The modules.
    pub modules: PreparedModules,
    /// How many were condensed for it.
    pub condensations: usize,
}

#[cfg(test)]
mod tests;
