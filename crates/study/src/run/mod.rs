//! Jobs to records: what jobs share is prepared once, jobs run in parallel, a failed job is a record.
//!
//! Knows threads and the clock. Does not know files: a record holds all rows of its job, whatever becomes of it, and is
//! handed on as soon as its batch is solved.

mod batch;
mod bench;
mod cache;
pub mod canary;
mod crossing;
mod cut;
mod guard;
mod modes;
mod outcome;
mod progress;
mod record;
mod statics;
mod verify;

pub use bench::{BridgeReport, OperatorCounts, PreparedModules};
pub use cache::Cache;
pub use canary::CanaryError;
pub use cut::Batch;
pub use outcome::{Failures, Outcome, PoolError, RunError};
pub use progress::{Progress, Silent, Tally};
pub use record::{ConnectorRow, HistoryRows, JobRecord, PositionRow, Summary};
pub use verify::Verification;

use crate::plan::Job;
use crate::spec::Study;
use bench::Bench;
use progress::Count;
use std::error::Error as StdError;
use std::time::Instant;

/// The instructions that crossings by the operator run on here.
pub fn instruction_path() -> &'static str {
    pontoon_core::operator::InstructionPath::of_this_machine().name
}

/// How a run goes about its jobs; no record depends on it.
#[derive(Debug, Clone, Default)]
pub struct Setting {
    /// Threads; 0: as many as the machine has.
    pub threads: usize,
    /// What is solved at a time.
    pub batch: Batch,
    /// Where operators are kept from run to run; none: nowhere.
    pub cache: Option<Cache>,
}

/// Where the records of a batch go, in the order of jobs.
pub type Sink<'a, E> = dyn FnMut(Vec<JobRecord>) -> Result<(), E> + Send + 'a;

/// Runs jobs of a study, batch by batch in their order. While a batch is solved, `sink` takes the one before it, on the
/// same pool: no more than the records of two batches are in memory. Neither the records nor the batches depend on the
/// number of threads.
///
/// # Errors
/// [`RunError::Pool`]; [`RunError::Sink`] with what the sink said, which ends the run. A job that fails is a record.
pub fn run<E: StdError + Send + 'static>(
    study: &Study,
    jobs: &[Job],
    setting: Setting,
    progress: &dyn Progress,
    sink: &mut Sink<'_, E>,
) -> Result<Outcome, RunError<E>> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(setting.threads).build();
    let pool = pool.map_err(|cause| PoolError {
        threads: setting.threads,
        cause,
    })?;
    pool.install(|| {
        let start = Instant::now();
        let bench = Bench::prepare(jobs, &PreparedModules::default(), setting.cache.as_ref(), progress);
        let offline_s = start.elapsed().as_secs_f64();
        progress.stage("running jobs");
        let count = Count::new(jobs.len(), progress);
        let (mut failures, mut verification) = (Failures::default(), Verification::default());
        let (mut batches, mut solved) = (cut::cut(study, jobs, setting.batch), None);
        loop {
            let (batch, before) = (batches.next(), solved.take());
            let (records, taken) = rayon::join(
                || batch.map(|batch| batch::solve_batch(study, batch, &bench, &|record| count.done(record))),
                || before.map_or(Ok(()), &mut *sink),
            );
            taken.map_err(RunError::Sink)?;
            let Some(records) = records else { break };
            failures.take(&records);
            verification.take(&records);
            solved = Some(records);
        }
        Ok(Outcome {
            jobs: jobs.len(),
            failures,
            verification,
            condensations: bench.condensations(),
            operators: bench.operator_counts(),
            bridges: bench.reports(jobs),
            threads: rayon::current_num_threads(),
            offline_s,
            jobs_s: start.elapsed().as_secs_f64() - offline_s,
        })
    })
}

/// Solves jobs of several studies on the current pool: what any of them share is prepared once, and modules that are
/// `known` are not prepared again. Leaves a record for each job in their order, and the modules.
pub(crate) fn solve_together(jobs: &[(&Study, &Job)], known: &PreparedModules) -> (Vec<JobRecord>, Prepared) {
    let alone: Vec<Job> = jobs.iter().map(|(_, job)| (*job).clone()).collect();
    let bench = Bench::prepare(&alone, known, None, &Silent);
    let records = batch::solve(jobs, &bench, &|_| ());
    let prepared = Prepared {
        modules: bench.modules(),
        condensations: bench.condensations(),
    };
    (records, prepared)
}

/// What a run prepared.
pub(crate) struct Prepared {
    /// The modules.
    pub modules: PreparedModules,
    /// How many were condensed for it.
    pub condensations: usize,
}

#[cfg(test)]
mod tests;
