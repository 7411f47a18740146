//! What a run leaves behind beside its records.
//!
//! Knows counts, times and the first reasons of failure. Keeps no record.

use super::bench::{BridgeReport, OperatorCounts};
use super::record::JobRecord;
use super::verify::Verification;
use std::error::Error as StdError;
use thiserror::Error;

/// Reasons that are kept of jobs that failed; all are in the table of jobs.
const FAILURES_KEPT: usize = 10;

/// What a run leaves behind beside its records.
#[derive(Debug)]
pub struct Outcome {
    /// Jobs that ran.
    pub jobs: usize,
    /// Those that failed.
    pub failures: Failures,
    /// Those solved again by the reference solver.
    pub verification: Verification,
    /// Modules condensed.
    pub condensations: usize,
    /// Where operators came from.
    pub operators: OperatorCounts,
    /// What was prepared of each bridge.
    pub bridges: Vec<BridgeReport>,
    /// Threads used.
    pub threads: usize,
    /// Wall time of what jobs share: finite elements, condensation, assembly, factors, static peaks [s].
    pub offline_s: f64,
    /// Wall time of the jobs, what becomes of their records included [s].
    pub jobs_s: f64,
}

/// Jobs that failed.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Failures {
    /// Number of failed jobs.
    pub count: usize,
    /// The first of them in the order of jobs with why they failed, ten at most.
    pub first: Vec<(usize, String)>,
}

impl Failures {
    /// Counts those among the next records.
    pub(super) fn take(&mut self, records: &[JobRecord]) {
        for record in records {
            let Some(reason) = &record.reason else { continue };
            self.count += 1;
            if self.first.len() < FAILURES_KEPT {
                self.first.push((record.job, reason.clone()));
            }
        }
    }
}

/// Why a run could not begin.
#[derive(Debug, Error)]
#[error("no pool of {threads} threads: {cause}")]
pub struct PoolError {
    /// Threads asked for.
    pub(super) threads: usize,
    /// What the system said.
    pub(super) cause: rayon::ThreadPoolBuildError,
}

/// Why a run did not come to its end.
#[derive(Debug, Error)]
pub enum RunError<E: StdError + 'static> {
    /// It could not begin.
    #[error(transparent)]
    Pool(#[from] PoolError),
    /// Its records were not taken.
    #[error(transparent)]
    Sink(E),
}
