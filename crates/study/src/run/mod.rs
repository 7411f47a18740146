//! Jobs to records: what jobs share is prepared once, jobs run in parallel, a failed job is a record.
//!
//! Knows threads and the clock. Does not know files: a record holds all rows of its job, whatever becomes of it.

mod bench;
mod crossing;
mod guard;
mod modes;
mod progress;
mod record;
mod statics;

pub use bench::{BridgeReport, PreparedModules};
pub use progress::{Progress, Silent, Tally};
pub use record::{ConnectorRow, HistoryRows, JobRecord, PositionRow, Summary};

use crate::plan::{Job, Task};
use crate::spec::Study;
use bench::Bench;
use rayon::prelude::*;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;
use thiserror::Error;

/// Why a run could not begin.
#[derive(Debug, Error)]
#[error("no pool of {threads} threads: {cause}")]
pub struct PoolError {
    /// Threads asked for.
    threads: usize,
    /// What the system said.
    cause: rayon::ThreadPoolBuildError,
}

/// What a run leaves behind.
#[derive(Debug)]
pub struct Outcome {
    /// A record for each job, in the order of jobs.
    pub records: Vec<JobRecord>,
    /// Modules condensed.
    pub condensations: usize,
    /// What was prepared of each bridge.
    pub bridges: Vec<BridgeReport>,
    /// Threads used.
    pub threads: usize,
    /// Wall time of what jobs share: finite elements, condensation, assembly, factors, static peaks [s].
    pub offline_s: f64,
    /// Wall time of the jobs [s].
    pub jobs_s: f64,
}

impl Outcome {
    /// Number of failed jobs.
    pub fn failed(&self) -> usize {
        self.records.iter().filter(|r| r.reason.is_some()).count()
    }
}

/// Runs jobs of a study on `threads` threads (0: as many as the machine has). The records do not depend on the number
/// of threads.
///
/// # Errors
/// [`PoolError`]; a job that fails is a record.
pub fn run(study: &Study, jobs: &[Job], threads: usize, progress: &dyn Progress) -> Result<Outcome, PoolError> {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .map_err(|cause| PoolError { threads, cause })?;
    let threads = pool.current_num_threads();
    pool.install(|| {
        let start = Instant::now();
        let bench = Bench::prepare(jobs, &PreparedModules::default(), progress);
        let offline_s = start.elapsed().as_secs_f64();
        progress.stage("running jobs");
        let (done, failed) = (AtomicUsize::new(0), AtomicUsize::new(0));
        progress.jobs(Tally {
            done: 0,
            failed: 0,
            total: jobs.len(),
        });
        let records = jobs.par_iter().with_max_len(1).map(|job| {
            let record = record(study, job, &bench);
            let failed = failed.fetch_add(usize::from(record.reason.is_some()), Ordering::Relaxed)
                + usize::from(record.reason.is_some());
            let done = done.fetch_add(1, Ordering::Relaxed) + 1;
            progress.jobs(Tally {
                done,
                failed,
                total: jobs.len(),
            });
            record
        });
        let records = records.collect();
        let jobs_s = start.elapsed().as_secs_f64() - offline_s;
        Ok(Outcome {
            records,
            condensations: bench.condensations(),
            bridges: bench.reports(jobs),
            threads,
            offline_s,
            jobs_s,
        })
    })
}

/// Solves jobs of several studies on the current pool: what any of them share is prepared once, and modules that are
/// `known` are not prepared again. Leaves a record for each job in their order, and the modules.
pub(crate) fn solve_together(jobs: &[(&Study, &Job)], known: &PreparedModules) -> (Vec<JobRecord>, Prepared) {
    let alone: Vec<Job> = jobs.iter().map(|(_, job)| (*job).clone()).collect();
    let bench = Bench::prepare(&alone, known, &Silent);
    let records = jobs
        .par_iter()
        .with_max_len(1)
        .map(|(study, job)| record(study, job, &bench));
    let records = records.collect();
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

fn record(study: &Study, job: &Job, bench: &Bench) -> JobRecord {
    let solved = guard::guarded(|| match job.task {
        Task::Crossing { speed_m_s } => crossing::solve(job, speed_m_s, study.spec.record.histories.record(), bench),
        Task::Static(load) => statics::solve(job, load, bench),
        Task::Modes => modes::solve(job, bench),
    });
    let mut record = solved.unwrap_or_else(|reason| JobRecord::failed(job, reason));
    // rows that no table will hold are not kept until the end of a large study
    if !study.spec.record.positions {
        record.positions = Vec::new();
    }
    if !study.spec.record.connectors {
        record.connectors = Vec::new();
    }
    record
}
