//! A batch of jobs to its records, on the current pool.
//!
//! Knows how jobs become records: crossings by the operator in batches that share its lanes, everything else one by one. Does
//! not know how a study is cut into batches nor what becomes of the records.

use super::crossing::JobResult;
use super::demands::record_for;
use super::failure::JobFailure;
use super::shared_models::SharedModels;
use super::{crossing, guard, modes, rating, statics, verify};
use pontoon_core::response::Record;
use pontoon_journal::LONGEST;
use pontoon_plan::job::{CrossingJob, Job, Task};
use pontoon_plan::study_file::Study;
use pontoon_results::{Failure, FailureKind, JobRecord};
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Most crossings of a lane batch: eight for each of four lanes, so that few lanes stand empty when the last ones end.
const LANE_BATCH: usize = 32;

/// Lanes of the vectors that most machines have.
const LANES: usize = 4;

/// Lane batches that a thread should find, where there are jobs enough.
const LANE_BATCHES_A_THREAD: usize = 4;

/// What is told of jobs as they begin and end, from any thread and in any order.
pub(super) trait JobObserver: Sync {
    /// Jobs are about to be solved together; whether they may.
    fn begin(&self, jobs: &[&Job]) -> bool;
    /// Their records are there.
    fn end(&self, jobs: &[&Job], records: &[JobRecord]);
}

/// Nobody is told.
pub(super) struct NoObserver;

impl JobObserver for NoObserver {
    fn begin(&self, _: &[&Job]) -> bool {
        true
    }
    fn end(&self, _: &[&Job], _: &[JobRecord]) {}
}

/// Solves jobs of several studies: a record for each job in their order, a failed job being a record too; none of jobs that
/// might not begin. The records depend on the jobs alone, not on those beside them nor on the pool. Jobs go `apart` where
/// none may share its process's fate with another.
pub(super) fn solve(
    jobs: &[(&Study, &Job)],
    apart: bool,
    models: &SharedModels,
    told: &dyn JobObserver,
) -> Vec<JobRecord> {
    let lane_batches = lane_batches(jobs, if apart { 1 } else { LANE_BATCH });
    let solved = lane_batches
        .into_par_iter()
        .with_max_len(1)
        .flat_map_iter(|lane_batch| {
            let records = solve_together(jobs, &lane_batch, models, told);
            lane_batch.into_iter().zip(records).collect::<Vec<_>>()
        });
    let mut solved: Vec<(usize, JobRecord)> = solved.collect();
    solved.sort_by_key(|(place, _)| *place);
    solved.into_iter().map(|(_, record)| record).collect()
}

/// Solves one job on the thread that calls, for which `models` suffice, as [`solve`] does.
pub(super) fn solve_one(study: &Study, job: &Job, models: &SharedModels, told: &dyn JobObserver) -> Vec<JobRecord> {
    solve_together(&[(study, job)], &[0], models, told)
}

/// The records of the jobs at some places, which are solved together; none where they might not begin.
fn solve_together(
    jobs: &[(&Study, &Job)],
    places: &[usize],
    models: &SharedModels,
    told: &dyn JobObserver,
) -> Vec<JobRecord> {
    let together: Vec<&Job> = places.iter().map(|&place| jobs[place].1).collect();
    if !told.begin(&together) {
        return Vec::new();
    }
    let records = records(jobs, places, models);
    told.end(&together, &records);
    records
}

/// Places of jobs that are solved together: crossings that share a solver, those of equally many steps side by side so that
/// the lanes of a batch stay in step and end together; any other job by itself.
fn lane_batches(jobs: &[(&Study, &Job)], largest: usize) -> Vec<Vec<usize>> {
    let mut lane_batches = Vec::new();
    let mut operated: BTreeMap<_, Vec<usize>> = BTreeMap::new();
    for (place, (_, job)) in jobs.iter().enumerate() {
        let crossing = job.as_crossing().filter(|_| job.rating.is_none());
        match crossing.as_ref().and_then(SharedModels::lane_batch_key) {
            Some(key) => operated.entry(key).or_default().push(place),
            None => lane_batches.push(vec![place]),
        }
    }
    for places in operated.into_values() {
        let most = places
            .len()
            .div_ceil(LANE_BATCHES_A_THREAD * rayon::current_num_threads());
        let most = most.clamp(1, largest);
        let of_steps = |place: &usize| jobs[*place].1.steps();
        let (in_step, others) = in_step(places, of_steps);
        // whole vectors of lanes where there are so many
        let whole = most.next_multiple_of(LANES).min(largest.max(1));
        lane_batches.extend(in_step.chunks(whole).map(<[usize]>::to_vec));
        lane_batches.extend(others.chunks(most).map(<[usize]>::to_vec));
    }
    lane_batches
}

/// Places with the most steps first: as many of each number of steps as fill whole vectors of lanes, so that vehicles of one speed stand
/// at one place in all of them, and those that are left.
fn in_step(mut places: Vec<usize>, steps: impl Fn(&usize) -> usize) -> (Vec<usize>, Vec<usize>) {
    places.sort_by_cached_key(|place| std::cmp::Reverse(steps(place)));
    let (mut in_step, mut others) = (Vec::new(), Vec::new());
    for alike in places.chunk_by(|a, b| steps(a) == steps(b)) {
        let (whole, rest) = alike.split_at(alike.len() / LANES * LANES);
        in_step.extend(whole);
        others.extend(rest);
    }
    (in_step, others)
}

/// The records of the jobs at some places: crossings by the operator that share a solver, or one job of another kind.
fn records(jobs: &[(&Study, &Job)], places: &[usize], models: &SharedModels) -> Vec<JobRecord> {
    let of: Vec<(&Study, &Job)> = places.iter().map(|&place| jobs[place]).collect();
    let lane_batch: Vec<(CrossingJob<'_>, Record)> = of
        .iter()
        .filter(|(_, job)| job.by_operator() && job.rating.is_none())
        .filter_map(|(study, job)| Some((job.as_crossing()?, histories(study, job))))
        .collect();
    let solved: Vec<JobResult> = if lane_batch.len() == of.len() {
        by_operator(&lane_batch, models)
    } else {
        of.iter()
            .map(|(study, job)| guard::guarded(|| alone(study, job, models)))
            .collect()
    };
    let finish = |((study, job), solved): (&(&Study, &Job), JobResult)| finished(study, job, solved, models);
    of.iter().zip(solved).map(finish).collect()
}

/// Crossings that share a solver.
fn by_operator(lane_batch: &[(CrossingJob<'_>, Record)], models: &SharedModels) -> Vec<JobResult> {
    let together = guard::guarded(|| Ok(crossing::solve_lane_batch(lane_batch, models)));
    // a panic is the failure of the job that it came from alone
    together.unwrap_or_else(|_| {
        let alone = |job: &(CrossingJob<'_>, Record)| {
            guard::guarded(|| {
                let mut solved = crossing::solve_lane_batch(std::slice::from_ref(job), models);
                solved.pop().unwrap_or_else(|| Err(JobFailure::of_program("no record")))
            })
        };
        lane_batch.iter().map(alone).collect()
    })
}

/// A job that shares nothing of its solution with others.
fn alone(study: &Study, job: &Job, models: &SharedModels) -> JobResult {
    if job.rating.is_some() {
        return rating::solve(study, job, models);
    }
    match (job.task, job.as_crossing(), job.as_modes()) {
        (Task::Crossing { .. }, Some(crossing), _) => crossing::solve(&crossing, histories(study, job), models),
        (Task::Static(load), ..) => statics::solve(job, load, models),
        (Task::Modes, _, Some(asked)) => modes::solve(job, asked, models),
        _ => Err(JobFailure::of_program("a task of another analysis")),
    }
}

/// The record of a job: solved once more where that may help, judged, without rows that no table will hold.
fn finished(study: &Study, job: &Job, solved: JobResult, models: &SharedModels) -> JobRecord {
    let solved = match (solved, job.as_crossing()) {
        (Err(failed), Some(crossing)) if failed.half_step_may_help && job.rating.is_none() => {
            guard::guarded(|| crossing::again_at_half_step(&crossing, histories(study, job), models, &failed))
        }
        (solved, _) => solved,
    };
    let mut record = solved.unwrap_or_else(|failed| JobRecord::failed(job, failed.failure));
    let bytes = record.histories.bytes();
    if bytes > LONGEST / 2 {
        let text = format!("histories of {bytes} bytes, more than a record may have");
        let failure = Failure::new(FailureKind::HistoriesTooLong, text).with("bytes", bytes as f64);
        record = JobRecord::failed(job, failure);
    }
    verify::judge(job, &mut record, models);
    // not kept until their batch is written
    if !study.record.positions {
        record.positions = Vec::new();
    }
    if !study.record.connectors {
        record.connectors = Vec::new();
    }
    record
}

fn histories(study: &Study, job: &Job) -> Record {
    match job.as_crossing() {
        Some(crossing) => {
            let mut record = study.record.of_crossing(&job.shared.bridge.design, &crossing.traffic());
            record_for(&job.shared.limits, &mut record);
            record
        }
        None => study.record.of_bridge(&job.shared.bridge.design),
    }
}

#[cfg(test)]
mod tests {
    use super::in_step;

    /// Fives of ten steps, one more of twelve: whole vectors of each number of steps come first, the longest in front.
    #[test]
    fn jobs_of_one_length_fill_whole_vectors() {
        let steps = [10, 12, 10, 8, 10, 12, 10, 12, 10, 12, 8];
        let (whole, rest) = in_step((0..steps.len()).collect(), |place| steps[*place]);
        let lengths = |of: &[usize]| of.iter().map(|place| steps[*place]).collect::<Vec<_>>();
        assert_eq!(lengths(&whole), [12, 12, 12, 12, 10, 10, 10, 10]);
        assert_eq!(lengths(&rest), [10, 8, 8]);
    }
}
