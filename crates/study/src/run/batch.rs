//! A batch of jobs to its records, on the current pool.
//!
//! Knows how jobs become records: crossings by the operator in crews that share its lanes, everything else one by one. Does
//! not know how a study is cut into batches nor what becomes of the records.

use super::bench::Bench;
use super::record::JobRecord;
use super::{crossing, guard, modes, statics, verify};
use crate::plan::{Job, Task};
use crate::spec::{SolverSpec, Study};
use pontoon_core::response::Record;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Most crossings of a crew: eight for each of four lanes, so that few lanes stand empty when the last ones end.
const CREW: usize = 32;

/// Crews that a thread should find, where there are jobs enough.
const CREWS_A_THREAD: usize = 4;

/// Solves a batch of jobs of a study: a record for each job in the order of the batch, a failed job being a record too.
/// `done` is told of each record as soon as it is there, from any thread and in any order. The records depend on the jobs
/// alone, not on the batch they came in nor on the pool.
pub(super) fn solve_batch(
    study: &Study,
    batch: &[Job],
    bench: &Bench,
    done: &(dyn Fn(&JobRecord) + Sync),
) -> Vec<JobRecord> {
    let jobs: Vec<(&Study, &Job)> = batch.iter().map(|job| (study, job)).collect();
    solve(&jobs, bench, done)
}

/// The same of jobs of several studies.
pub(super) fn solve(jobs: &[(&Study, &Job)], bench: &Bench, done: &(dyn Fn(&JobRecord) + Sync)) -> Vec<JobRecord> {
    let solved = crews(jobs).into_par_iter().with_max_len(1).flat_map_iter(|crew| {
        let records = records(jobs, &crew, bench);
        records.iter().for_each(done);
        crew.into_iter().zip(records).collect::<Vec<_>>()
    });
    let mut solved: Vec<(usize, JobRecord)> = solved.collect();
    solved.sort_by_key(|(place, _)| *place);
    solved.into_iter().map(|(_, record)| record).collect()
}

/// Places of jobs that are solved together: crossings that share a solver, the long ones first so that the lanes of a crew
/// end together; any other job by itself.
fn crews(jobs: &[(&Study, &Job)]) -> Vec<Vec<usize>> {
    let mut crews = Vec::new();
    let mut operated: BTreeMap<_, Vec<usize>> = BTreeMap::new();
    for (place, (_, job)) in jobs.iter().enumerate() {
        if by_operator(job) {
            operated.entry(Bench::crew_key(job)).or_default().push(place);
        } else {
            crews.push(vec![place]);
        }
    }
    for mut places in operated.into_values() {
        places.sort_by_key(|&place| std::cmp::Reverse(jobs[place].1.steps()));
        let most = places.len().div_ceil(CREWS_A_THREAD * rayon::current_num_threads());
        crews.extend(places.chunks(most.clamp(1, CREW)).map(<[usize]>::to_vec));
    }
    crews
}

/// Whether a job is a crossing by the operator.
pub(super) fn by_operator(job: &Job) -> bool {
    matches!(job.task, Task::Crossing { .. }) && job.analysis.spec.solver == Some(SolverSpec::Operator)
}

/// The records of the jobs at some places.
fn records(jobs: &[(&Study, &Job)], places: &[usize], bench: &Bench) -> Vec<JobRecord> {
    let of = |place: usize| jobs[place];
    let operated = of(places[0]).1;
    let solved: Vec<Result<JobRecord, String>> = if by_operator(operated) {
        let crew: Vec<(&Job, Record)> = places
            .iter()
            .map(|&place| (of(place).1, histories(of(place).0)))
            .collect();
        let together = guard::guarded(|| crossing::solve_crew(&crew, bench));
        // a panic is the failure of the job that it came from alone
        together.unwrap_or_else(|_| {
            let alone = |job: &(&Job, Record)| {
                let one = guard::guarded(|| crossing::solve_crew(std::slice::from_ref(job), bench))?;
                one.into_iter()
                    .next()
                    .unwrap_or_else(|| Err("program error: no record".to_owned()))
            };
            crew.iter().map(alone).collect()
        })
    } else {
        let single = |&place: &usize| {
            let (study, job) = of(place);
            guard::guarded(|| match job.task {
                Task::Crossing { .. } => crossing::solve(job, histories(study), bench),
                Task::Static(load) => statics::solve(job, load, bench),
                Task::Modes => modes::solve(job, bench),
            })
        };
        places.iter().map(single).collect()
    };
    let finish = |(&place, solved): (&usize, Result<JobRecord, String>)| {
        let (study, job) = of(place);
        let mut record = solved.unwrap_or_else(|reason| JobRecord::failed(job, reason));
        verify::judge(job, &mut record, bench);
        // rows that no table will hold are not kept until their batch is written
        if !study.spec.record.positions {
            record.positions = Vec::new();
        }
        if !study.spec.record.connectors {
            record.connectors = Vec::new();
        }
        record
    };
    places.iter().zip(solved).map(finish).collect()
}

fn histories(study: &Study) -> Record {
    study.spec.record.histories.record()
}
