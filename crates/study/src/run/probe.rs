//! What a step and a bridge cost on this machine, measured on a few jobs.
//!
//! Knows the clock. Leaves no record: whatever becomes of the jobs, they run again when the study does.

use super::PreparedModules;
use super::batch::{NoObserver, solve};
use super::cache::Cache;
use super::cancel::{CancelToken, Why};
use super::progress::Silent;
use super::shared_models::SharedModels;
use pontoon_plan::job::{Job, Share, module_steps};
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

/// Jobs that are tried together, and how many of all steps they stand for.
#[derive(Debug)]
struct Group<'a> {
    jobs: Vec<&'a Job>,
    parts: f64,
}

/// Measures what jobs like the first of a share cost, on one thread, those that can be solved beside it: of crossings by the operator
/// groups of all lengths, of other jobs the shortest. None where they are too long or all fail, and where their preparation is not
/// done at the `deadline`.
pub fn measure(study: &Study, share: &Share, cache: Option<&Cache>, deadline: Instant) -> Option<Measured> {
    let first = share.first.first()?;
    let mut groups = groups(&known(share, first), first.by_operator());
    let work = |job: &Job| (job.steps() * job.crossings()) as f64 * (job.shared.bridge.design.modules as f64).powi(2);
    let all = |groups: &[Group<'_>]| {
        let each = groups.iter().flat_map(|group| &group.jobs);
        each.map(|job| work(job)).sum::<f64>()
    };
    // fewer and shorter ones where they are long
    if all(&groups) > MOST_WORK {
        groups.truncate(1);
    }
    if all(&groups) > MOST_WORK {
        groups[0].jobs.truncate(1);
    }
    if all(&groups) > MOST_WORK {
        return None;
    }
    let tried: Vec<&Job> = groups.iter().flat_map(|group| &group.jobs).copied().collect();
    let start = Instant::now();
    let models = until(deadline, |cancel| {
        SharedModels::prepare(&tried, &PreparedModules::default(), cache, cancel, &Silent)
    })?;
    let bridge_s = start.elapsed().as_secs_f64();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().ok()?;
    let solved_s = |jobs: &[&Job]| {
        let list: Vec<(&Study, &Job)> = jobs.iter().map(|job| (study, *job)).collect();
        let start = Instant::now();
        let records = pool.install(|| solve(&list, false, &models, &NoObserver));
        let passed = records.iter().all(|record| record.failure.is_none());
        passed.then(|| start.elapsed().as_secs_f64())
    };
    if groups.len() > 1 {
        // what the first jobs make for all
        let _ = solved_s(&groups[0].jobs[..1]);
    }
    let (mut per_step_s, mut parts, mut seconds, mut steps, mut jobs) = (0.0, 0.0, 0.0, 0.0, 0);
    // jobs that fail tell nothing
    for (group, of_group_s) in groups.iter().filter_map(|group| Some((group, solved_s(&group.jobs)?))) {
        let of_group: f64 = group.jobs.iter().map(|job| module_steps(job)).sum();
        per_step_s += group.parts * of_group_s / of_group;
        parts += group.parts;
        seconds += of_group_s;
        steps += of_group;
        jobs += group.jobs.len();
    }
    let many = (jobs > 0).then_some(jobs as f64)?;
    Some(Measured {
        bridge_s,
        job_s: if steps > 0.0 {
            per_step_s / parts * steps / many
        } else {
            seconds / many
        },
        module_steps: steps / many,
        jobs,
    })
}

/// Jobs that can be solved beside the first, the shortest first: any of the share where there are enough of them, else its first ones.
fn known<'a>(share: &'a Share, first: &Job) -> Vec<&'a Job> {
    let lane_batch = |job: &Job| job.as_crossing().as_ref().and_then(SharedModels::lane_batch_key);
    let alike = |jobs: &'a [Job]| -> Vec<&'a Job> {
        let of_jobs = jobs.iter().filter(|job| lane_batch(job) == lane_batch(first));
        of_jobs.collect()
    };
    let of_all = alike(&share.sample);
    let enough = first.by_operator() && of_all.len() >= share.jobs.min(GROUPS * TRIED);
    let mut known = if enough { of_all } else { alike(&share.first) };
    known.sort_by_key(|job| job.steps());
    known
}

/// Groups of jobs, which come by their steps, the shortest first. Of crossings by the operator all where they are few; of many as many groups
/// as there are parts of equally many steps, each from the middle of its part, of one length where so many have it as fill lanes.
fn groups<'a>(jobs: &[&'a Job], by_operator: bool) -> Vec<Group<'a>> {
    let whole: f64 = jobs.iter().map(|job| module_steps(job)).sum();
    let of = |jobs: &[&'a Job]| Group {
        jobs: jobs.to_vec(),
        parts: jobs.iter().map(|job| module_steps(job)).sum::<f64>() / whole,
    };
    if !by_operator {
        return vec![of(&jobs[..1])];
    }
    if jobs.len() <= GROUPS * TRIED {
        return jobs.chunks(TRIED).map(of).collect();
    }
    let mut groups: Vec<Group<'_>> = Vec::new();
    for part in 0..GROUPS {
        let middle = (part as f64 + 0.5) / GROUPS as f64 * whole;
        let mut sum = 0.0;
        let reaches = |job: &&Job| {
            sum += module_steps(job);
            sum >= middle
        };
        let at = jobs.iter().position(reaches).unwrap_or(0);
        let steps = jobs[at].steps();
        if let Some(same) = groups.last_mut().filter(|group| group.jobs[0].steps() == steps) {
            same.parts += 1.0;
            continue;
        }
        let alike: Vec<&Job> = jobs.iter().copied().filter(|job| job.steps() == steps).collect();
        let jobs = if alike.len() >= TRIED {
            // those of other gaps and loads as well
            let apart = alike.len() / TRIED;
            alike.into_iter().step_by(apart).take(TRIED).collect()
        } else {
            let from = at.saturating_sub(TRIED / 2).min(jobs.len() - TRIED);
            jobs[from..from + TRIED].to_vec()
        };
        groups.push(Group { jobs, parts: 1.0 });
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
