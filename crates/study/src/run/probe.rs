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

/// Groups of crossings by the operator that are tried, each for as large a part of the steps.
const GROUPS: usize = 5;

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

/// Measures what jobs like the first of `jobs` cost, on one thread, those that can be solved beside it: of crossings by the operator
/// groups of all lengths, of other jobs the shortest. None where they are too long or fail, and where their preparation is not
/// done at the `deadline`.
pub fn measure(study: &Study, jobs: &[Job], cache: Option<&Cache>, deadline: Instant) -> Option<Measured> {
    let first = jobs.first()?;
    let lane_batch = |job: &Job| job.as_crossing().as_ref().and_then(SharedModels::lane_batch_key);
    let alike = |job: &&Job| lane_batch(job) == lane_batch(first);
    let mut known: Vec<&Job> = jobs.iter().filter(alike).collect();
    known.sort_by_key(|job| job.steps());
    let work = |job: &Job| (job.steps() * job.crossings()) as f64 * (job.bridge.design.modules as f64).powi(2);
    let mut groups = if first.by_operator() {
        groups(&known)
    } else {
        vec![known[..1].to_vec()]
    };
    let all = |groups: &[Vec<&Job>]| groups.iter().flatten().map(|job| work(job)).sum::<f64>();
    if all(&groups) > MOST_WORK {
        groups = vec![known[..TRIED.min(known.len())].to_vec()];
    }
    if all(&groups) > MOST_WORK {
        groups = vec![known[..1].to_vec()];
    }
    if all(&groups) > MOST_WORK {
        return None;
    }
    let tried: Vec<&Job> = groups.iter().flatten().copied().collect();
    let start = Instant::now();
    let models = until(deadline, |cancel| {
        SharedModels::prepare(&tried, &PreparedModules::default(), cache, cancel, &Silent)
    })?;
    let bridge_s = start.elapsed().as_secs_f64();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().ok()?;
    let solved_s = |group: &[&Job]| {
        let list: Vec<(&Study, &Job)> = group.iter().map(|job| (study, *job)).collect();
        let start = Instant::now();
        let records = pool.install(|| solve(&list, false, &models, &NoObserver));
        let passed = records.iter().all(|record| record.failure.is_none());
        passed.then(|| start.elapsed().as_secs_f64())
    };
    let warms_up = groups.len() > 1;
    if warms_up {
        // what the first jobs make for all
        solved_s(&groups[0][..1])?;
    }
    let (mut job_s, mut steps, mut per_step_s) = (0.0, 0.0, 0.0);
    for group in &groups {
        let of_group: f64 = group.iter().map(|job| module_steps(job)).sum();
        let seconds = solved_s(group)?;
        job_s += seconds;
        steps += of_group;
        per_step_s += seconds / of_group / groups.len() as f64;
    }
    let many = tried.len() as f64;
    Some(Measured {
        bridge_s,
        // every group stands for as many steps
        job_s: if steps > 0.0 {
            per_step_s * steps / many
        } else {
            job_s / many
        },
        module_steps: steps / many,
        jobs: tried.len(),
    })
}

/// Groups of jobs, which come by their steps: each from the middle of as large a part of all steps, of one length where there are as
/// many as fill lanes. All of few jobs are one group.
fn groups<'a>(jobs: &[&'a Job]) -> Vec<Vec<&'a Job>> {
    if jobs.len() <= TRIED {
        return vec![jobs.to_vec()];
    }
    let whole: f64 = jobs.iter().map(|job| module_steps(job)).sum();
    let mut groups = Vec::new();
    for part in 0..GROUPS {
        let middle = (part as f64 + 0.5) / GROUPS as f64 * whole;
        let mut sum = 0.0;
        let reaches = |job: &&Job| {
            sum += module_steps(job);
            sum >= middle
        };
        let at = jobs.iter().position(reaches).unwrap_or(0);
        let steps = jobs[at].steps();
        let alike: Vec<&Job> = jobs.iter().copied().filter(|job| job.steps() == steps).collect();
        groups.push(if alike.len() >= TRIED {
            // those of other gaps and loads as well
            let apart = alike.len() / TRIED;
            alike.into_iter().step_by(apart).take(TRIED).collect()
        } else {
            let from = at.saturating_sub(TRIED / 2).min(jobs.len() - TRIED);
            jobs[from..from + TRIED].to_vec()
        });
    }
    groups
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
