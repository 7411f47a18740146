//! Studies solved one after the other in one process, without a file: what one has prepared serves the next.
//!
//! Knows what is kept between studies, and that several may be solved at once. Does not know where records go.

use super::batch::{self, JobObserver};
use super::cache::Cache;
use super::cancel::CancelToken;
use super::cut::{self, Batch};
use super::failure::too_long;
use super::pool::{PoolError, on_threads};
use super::progress::{Progress, Tally};
use super::self_test::{self, SelfTestError};
use super::shared_models::SharedModels;
use pontoon_plan::job::Job;
use pontoon_plan::study_file::Study;
use pontoon_results::JobRecord;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::time::Instant;
use thiserror::Error;

/// Bridges, modules and solvers that are kept between studies, at some megabytes each.
const MOST_KEPT: usize = 32;

/// What a session keeps between studies. Threads may share it.
#[derive(Debug)]
pub struct SolveSession {
    cache: Option<Cache>,
    kept: Mutex<Arc<SharedModels>>,
    /// Set once this machine has proven itself.
    proven: OnceLock<()>,
}

/// How a study of a session is solved.
#[derive(Debug, Clone, Copy)]
pub struct SessionSetting {
    /// Threads; 0: as many as the machine has.
    pub threads: usize,
    /// Whether the static peaks of crossings are asked for, which take about as long as a crossing.
    pub static_peaks: bool,
}

/// Why a study of a session was not solved.
#[derive(Debug, Error)]
pub enum SessionError {
    /// It could not begin.
    #[error(transparent)]
    Pool(#[from] PoolError),
    /// This machine or build computes wrongly.
    #[error(transparent)]
    SelfTest(#[from] SelfTestError),
    /// It was asked to stop.
    #[error("stopped after {} of {} jobs", tally.done, tally.total)]
    Stopped {
        /// How far it came.
        tally: Tally,
    },
}

impl SolveSession {
    /// A session that takes operators from a cache and keeps them there.
    pub fn new(cache: Option<Cache>) -> Self {
        Self {
            cache,
            kept: Mutex::new(Arc::new(SharedModels::without_static_peaks())),
            proven: OnceLock::new(),
        }
    }

    /// Solves the jobs of a study and hands their records on, batch by batch in the order of jobs. The records are those of
    /// [`super::run`], to the last bit. Returns the seconds in which jobs were solved.
    ///
    /// # Errors
    /// [`SessionError`]. A job that fails is a record.
    pub fn solve(
        &self,
        study: &Study,
        jobs: &[Job],
        setting: SessionSetting,
        (cancel, progress): (&CancelToken, &dyn Progress),
        mut take: impl FnMut(&[Job], Vec<JobRecord>) + Send,
    ) -> Result<f64, SessionError> {
        if self.proven.get().is_none() {
            self_test::run()?;
            self.proven.get_or_init(|| ());
        }
        let observer = SessionObserver {
            cancel,
            progress,
            total: jobs.len(),
            done: AtomicUsize::new(0),
            failed: AtomicUsize::new(0),
        };
        let mut solved_s = 0.0;
        let mut solve_next = |batch: &[Job], solve: &dyn Fn() -> Vec<JobRecord>| {
            let began = Instant::now();
            let records = solve();
            solved_s += began.elapsed().as_secs_f64();
            if !cancel.is_asked() {
                take(batch, records);
            }
        };
        let kept = self.kept();
        match jobs {
            // threads take longer to start than such a job needs beside its solution
            [job] if !setting.static_peaks && too_long(job).is_none() && kept.suffice(job) => {
                observer.start();
                solve_next(jobs, &|| batch::solve_one(study, job, &kept, &observer));
            }
            _ => on_threads(setting.threads, || {
                let solvable: Vec<&Job> = jobs.iter().filter(|job| too_long(job).is_none()).collect();
                let models = self.prepare(&solvable, &kept, setting.static_peaks, (cancel, progress));
                observer.start();
                for batch in cut::cut(study, jobs, Batch::default()) {
                    solve_next(batch, &|| solve_batch(study, batch, &models, &observer));
                    if cancel.is_asked() {
                        break;
                    }
                }
            })?,
        }
        match cancel.is_asked() {
            true => Err(SessionError::Stopped {
                tally: observer.tally(),
            }),
            false => Ok(solved_s),
        }
    }

    /// What is kept at the moment.
    fn kept(&self) -> Arc<SharedModels> {
        Arc::clone(&self.kept.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Prepares what jobs share beyond what is kept, and keeps it. No lock is held meanwhile.
    fn prepare(
        &self,
        jobs: &[&Job],
        before: &SharedModels,
        static_peaks: bool,
        (cancel, progress): (&CancelToken, &dyn Progress),
    ) -> SharedModels {
        let cache = self.cache.as_ref();
        let models = SharedModels::prepare_after(jobs, before, static_peaks, (cache, cancel), progress);
        if !cancel.is_asked() {
            let mut kept = SharedModels::without_static_peaks();
            kept.keep(&models);
            let mut latest = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
            if kept.large_parts() + latest.large_parts() <= MOST_KEPT {
                kept.keep(&latest);
            }
            *latest = Arc::new(kept);
        }
        models
    }
}

/// Solves the jobs of a batch; those with too many time steps fail unsolved.
fn solve_batch(study: &Study, batch: &[Job], models: &SharedModels, observer: &SessionObserver<'_>) -> Vec<JobRecord> {
    let pairs = batch.iter().map(|job| (study, job));
    let (long, solvable): (Vec<_>, Vec<_>) = pairs.partition(|(_, job)| too_long(job).is_some());
    let mut records = batch::solve(&solvable, false, models, observer);
    if !long.is_empty() && !observer.cancel.is_asked() {
        let failed = long
            .iter()
            .filter_map(|(_, job)| Some(JobRecord::failed(job, too_long(job)?)));
        let failed: Vec<JobRecord> = failed.collect();
        observer.end(&[], &failed);
        records.extend(failed);
        records.sort_by_key(|record| record.job);
    }
    records
}

/// Counts jobs.
struct SessionObserver<'a> {
    cancel: &'a CancelToken,
    progress: &'a dyn Progress,
    total: usize,
    done: AtomicUsize,
    failed: AtomicUsize,
}

impl SessionObserver<'_> {
    /// Tells that jobs begin.
    fn start(&self) {
        self.progress.stage("running jobs");
        self.progress.jobs(self.tally());
    }

    fn tally(&self) -> Tally {
        let done = self.done.load(Ordering::Relaxed);
        Tally {
            done,
            failed: self.failed.load(Ordering::Relaxed),
            total: self.total,
            ran: done,
        }
    }
}

impl JobObserver for SessionObserver<'_> {
    fn begin(&self, _: &[&Job]) -> bool {
        !self.cancel.is_asked()
    }

    fn end(&self, _: &[&Job], records: &[JobRecord]) {
        let failed = records.iter().filter(|record| record.failure.is_some()).count();
        self.failed.fetch_add(failed, Ordering::Relaxed);
        self.done.fetch_add(records.len(), Ordering::Relaxed);
        self.progress.jobs(self.tally());
    }
}

#[cfg(test)]
mod tests;
