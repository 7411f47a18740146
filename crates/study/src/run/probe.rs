//! What a step and a bridge cost on this machine, measured on a few jobs.
//!
//! Knows the clock. Leaves no record: whatever becomes of the jobs, they run again when the study does.

use super::PreparedModules;
use super::batch::{NoObserver, solve};
use super::cache::Cache;
use super::cancel::{CancelToken, Why};
use super::progress::Silent;
use super::shared_models::SharedModels;
use pontoon_plan::job::{Job, module_steps};
use pontoon_plan::study_file::Study;
use std::sync::mpsc;
use std::thread;
use std::time::Instant;

/// Steps times the square of the modules, beyond which jobs take too long to be tried: some five seconds.
const MOST_WORK: f64 = 2e8;

/// Jobs that are tried together: as many as lanes may be.
const TRIED: usize = 8;

/// What was measured on a few jobs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measured {
    /// What a bridge costs before any job of it runs, on all threads `[s]`.
    pub bridge_s: f64,
    /// What a job costs of one thread `[s]`.
    pub job_s: f64,
    /// Steps times modules of such a job; 0 where it has no steps.
    pub module_steps: f64,
    /// Jobs that were tried.
    pub jobs: usize,
}

/// Measures what jobs like the first of `jobs` cost: the shortest of those that can be solved beside it are solved on one
/// thread. None where they are too long or fail, and where their preparation is not done at the `deadline`.
pub fn measure(study: &Study, jobs: &[Job], cache: Option<&Cache>, deadline: Instant) -> Option<Measured> {
    let first = jobs.first()?;
    let lane_batch = |job: &Job| job.as_crossing().as_ref().and_then(SharedModels::lane_batch_key);
    let alike = |job: &&Job| lane_batch(job) == lane_batch(first);
    let mut tried: Vec<&Job> = jobs.iter().filter(alike).collect();
    tried.sort_by_key(|job| job.steps());
    tried.truncate(if first.by_operator() { TRIED } else { 1 });
    let work = |job: &Job| (job.steps() * job.crossings()) as f64 * (job.bridge.design.modules as f64).powi(2);
    if tried.iter().map(|job| work(job)).sum::<f64>() > MOST_WORK {
        tried.truncate(1);
    }
    if tried.iter().any(|job| work(job) > MOST_WORK) {
        return None;
    }
    let start = Instant::now();
    let models = until(deadline, |cancel| {
        SharedModels::prepare(&tried, &PreparedModules::default(), cache, cancel, &Silent)
    })?;
    let bridge_s = start.elapsed().as_secs_f64();
    let list: Vec<(&Study, &Job)> = tried.iter().map(|job| (study, *job)).collect();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().ok()?;
    let start = Instant::now();
    let records = pool.install(|| solve(&list, false, &models, &NoObserver));
    let job_s = start.elapsed().as_secs_f64() / tried.len() as f64;
    let failed = records.iter().any(|record| record.failure.is_some());
    (!failed).then(|| Measured {
        bridge_s,
        job_s,
        module_steps: tried.iter().map(|job| module_steps(job)).sum::<f64>() / tried.len() as f64,
        jobs: tried.len(),
    })
}

/// Does something that looks at a token, which is asked to stop at the deadline; none where it was.
fn until<T: Send>(deadline: Instant, work: impl FnOnce(&CancelToken) -> T + Send) -> Option<T> {
    let (cancel, (done, waits)) = (CancelToken::default(), mpsc::channel::<()>());
    thread::scope(|scope| {
        let cancel = &cancel;
        scope.spawn(move || {
            let left = deadline.saturating_duration_since(Instant::now());
            if waits.recv_timeout(left) == Err(mpsc::RecvTimeoutError::Timeout) {
                cancel.ask(Why::Interrupted);
            }
        });
        let made = work(cancel);
        drop(done);
        (!cancel.is_asked()).then_some(made)
    })
}
