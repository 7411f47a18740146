//! Where a study is cut into batches.
//!
//! Knows how many rows a job leaves. Does not know threads: the cuts depend on the study and its jobs alone, as the row
//! groups of the tables follow them.

use pontoon_core::bridge::BankSpec;
use pontoon_core::response::SECTIONS;
use pontoon_plan::job::{Job, on_springs};
use pontoon_plan::study_file::Study;

/// What a batch holds at most; a single job is a batch of its own however many rows it has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Batch {
    /// Jobs.
    pub most_jobs: usize,
    /// Rows of all tables.
    pub most_rows: usize,
}

impl Default for Batch {
    /// 4096 jobs: thousands of jobs for each thread, so that the end of a batch, where threads wait for the last job, is
    /// no part of the time to speak of, and row groups long enough for readers, at 6 kB a job some 25 MB of records.
    /// 2^18 rows, the table library's own row group, bound the memory where jobs leave histories.
    fn default() -> Self {
        Self {
            most_jobs: 4096,
            most_rows: 1 << 18,
        }
    }
}

/// Cuts jobs into batches in their order.
pub(super) fn cut<'a>(study: &'a Study, jobs: &'a [Job], batch: Batch) -> impl Iterator<Item = &'a [Job]> {
    let mut rest = jobs;
    std::iter::from_fn(move || {
        let mut sum = 0_usize;
        let fits = |job: &&Job| {
            sum = sum.saturating_add(rows(study, job));
            sum <= batch.most_rows
        };
        let fitting = rest.iter().take(batch.most_jobs).take_while(fits).count();
        let (taken, left) = rest.split_at(fitting.max(1).min(rest.len()));
        rest = left;
        (!taken.is_empty()).then_some(taken)
    })
}

/// Series of the histories of so many vehicles at most, and rows of all vehicles on springs.
fn rows_of_vehicles(recorded: usize, job: &Job) -> (usize, usize) {
    let (wheels, bodies) = on_springs(job);
    let rows = wheels.len() + bodies.len();
    (if recorded == 0 { 0 } else { rows }, rows)
}

/// Rows that a job leaves, those that bisected steps add to its histories apart.
fn rows(study: &Study, job: &Job) -> usize {
    let (record, design) = (&study.record, &job.shared.bridge.design);
    if let Some(modes) = job.as_modes() {
        return 1 + modes.count;
    }
    let positions = if record.positions { design.positions() } else { 0 };
    let vehicles = rows_of_vehicles(record.histories.vehicles.len(), job);
    let of_joint = if record.connectors {
        1 + design.connectors.y_m.len()
    } else {
        0
    };
    let joints = design.modules.saturating_sub(1);
    let pins = if record.pins { 1 + design.hinges.y_m.len() } else { 0 };
    let sections = if record.sections { SECTIONS } else { 0 };
    let places = record.places_x_m.len();
    // at a peak all of it and each direction of a pin
    let at_peaks = record.at_peak_of.len() * (design.positions() + places + (of_joint + 3 * pins + sections) * joints);
    let series = (record.histories.series(design) + vehicles.0) * job.steps();
    let of_bank = |bank: &BankSpec| 1 + design.bank_places_y_m(bank).len();
    let banks: usize = design.banks.iter().map(of_bank).sum();
    let freeboards = if record.freeboards { 4 * design.modules } else { 0 };
    let dead = if design.has_dead_load() {
        // deflections, forces and reactions once more, and of each module three numbers and four freeboards
        design.positions() + (1 + design.connectors.y_m.len()) * joints + banks + 7 * design.modules
    } else {
        0
    };
    1 + vehicles.1
        + positions
        + places
        + banks
        + freeboards
        + dead
        + (of_joint + pins + sections) * joints
        + at_peaks
        + series
}
