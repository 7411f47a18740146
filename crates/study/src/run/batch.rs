//! A batch of jobs to its records, on the current pool.
//!
//! Knows how jobs become records: crossings by the operator in crews that share its lanes, everything else one by one. Does
//! not know how a study is cut into batches nor what becomes of the records.

use super::bench::Bench;
use super::crossing::{Failure, Solved};
use super::{crossing, guard, modes, statics, verify};
use pontoon_core::response::Record;
use pontoon_journal::LONGEST;
use pontoon_plan::job::{Job, Task};
use pontoon_plan::study_file::Study;
use pontoon_results::JobRecord;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Most crossings of a crew: eight for each of four lanes, so that few lanes stand empty when the last ones end.
const CREW: usize = 32;

/// Crews that a thread should find, where there are jobs enough.
const CREWS_A_THREAD: usize = 4;

/// What is told of jobs as they begin and end, from any thread and in any order.
pub(super) trait Told: Sync {
    /// Jobs are about to be solved together; whether they may.
    fn begin(&self, jobs: &[&Job]) -> bool;
    /// Their records are there.
    fn end(&self, jobs: &[&Job], records: &[JobRecord]);
}

/// Nobody is told.
pub(super) struct Untold;

impl Told for Untold {
    fn begin(&self, _: &[&Job]) -> bool {
        true
    }
    fn end(&self, _: &[&Job], _: &[JobRecord]) {}
}

/// Solves jobs of several studies: a record for each job in their order, a failed job being a record too; none of jobs that
/// might not begin. The records depend on the jobs alone, not on those beside them nor on the pool. Jobs go `apart` where
/// none may share its process's fate with another.
pub(super) fn solve(jobs: &[(&Study, &Job)], apart: bool, bench: &Bench, told: &dyn Told) -> Vec<JobRecord> {
    let crews = crews(jobs, if apart { 1 } else { CREW });
    let solved = crews.into_par_iter().with_max_len(1).flat_map_iter(|crew| {
        let of_crew: Vec<&Job> = crew.iter().map(|&place| jobs[place].1).collect();
        let records = if told.begin(&of_crew) {
            let records = records(jobs, &crew, bench);
            told.end(&of_crew, &records);
            records
        } else {
            Vec::new()
        };
        crew.into_iter().zip(records).collect::<Vec<_>>()
    });
    let mut solved: Vec<(usize, JobRecord)> = solved.collect();
    solved.sort_by_key(|(place, _)| *place);
    solved.into_iter().map(|(_, record)| record).collect()
}

/// Places of jobs that are solved together: crossings that share a solver, the long ones first so that the lanes of a crew
/// end together; any other job by itself.
fn crews(jobs: &[(&Study, &Job)], largest: usize) -> Vec<Vec<usize>> {
    let mut crews = Vec::new();
    let mut operated: BTreeMap<_, Vec<usize>> = BTreeMap::new();
    for (place, (_, job)) in jobs.iter().enumerate() {
        if job.by_operator() {
            operated.entry(Bench::crew_key(job)).or_default().push(place);
        } else {
            crews.push(vec![place]);
        }
    }
    for mut places in operated.into_values() {
        places.sort_by_key(|&place| std::cmp::Reverse(jobs[place].1.steps()));
        let most = places.len().div_ceil(CREWS_A_THREAD * rayon::current_num_threads());
        crews.extend(places.chunks(most.clamp(1, largest)).map(<[usize]>::to_vec));
    }
    crews
}

/// The records of the jobs at some places.
fn records(jobs: &[(&Study, &Job)], places: &[usize], bench: &Bench) -> Vec<JobRecord> {
    let of = |place: usize| jobs[place];
    let solved: Vec<Solved> = if of(places[0]).1.by_operator() {
        let crew: Vec<(&Job, Record)> = places
            .iter()
            .map(|&place| (of(place).1, histories(of(place).0)))
            .collect();
        let together = guard::guarded(|| Ok::<_, String>(crossing::solve_crew(&crew, bench)));
        // a panic is the failure of the job that it came from alone
        together.unwrap_or_else(|_| {
            let alone = |job: &(&Job, Record)| {
                guard::guarded(|| {
                    let one = crossing::solve_crew(std::slice::from_ref(job), bench)
                        .into_iter()
                        .next();
                    one.unwrap_or_else(|| Err("program error: no record".to_owned().into()))
                })
            };
            crew.iter().map(alone).collect()
        })
    } else {
        let single = |&place: &usize| {
            let (study, job) = of(place);
            guard::guarded(|| match job.task {
                Task::Crossing { .. } => crossing::solve(job, histories(study), bench),
                Task::Static(load) => statics::solve(job, load, bench).map_err(Failure::from),
                Task::Modes => modes::solve(job, bench).map_err(Failure::from),
            })
        };
        places.iter().map(single).collect()
    };
    let finish = |(&place, solved): (&usize, Solved)| {
        let (study, job) = of(place);
        let solved = match solved {
            Err(failure) if failure.half_step_may_help => {
                guard::guarded(|| crossing::again_at_half_step(job, histories(study), bench, &failure))
            }
            solved => solved,
        };
        let mut record = solved.unwrap_or_else(|failure| JobRecord::failed(job, failure.reason));
        let bytes = record.histories.bytes();
        if bytes > LONGEST / 2 {
            record = JobRecord::failed(job, format!("histories of {bytes} bytes, more than a record may have"));
        }
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
