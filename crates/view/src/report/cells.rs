//! All jobs in aggregate: a cell is a combination of the axes' bins that has jobs.
//!
//! Knows largest and smallest. Does not know what is drawn of them.

use super::axes::PageAxis;
use super::packed::Packed;
use crate::asked;
use pontoon_plan::study_file::Study;
use pontoon_results::{Column, Results, Table};
use serde::Serialize;
use std::collections::{BTreeMap, HashSet};

/// Cells up to which axes are left as they are.
const MOST_CELLS: usize = 40_000;

/// The number of no job.
const NO_JOB: u32 = u32::MAX;

/// A measure of a job.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PageMeasure {
    /// Its column.
    pub name: &'static str,
    /// In words.
    pub label: &'static str,
    /// Its unit.
    pub unit: &'static str,
}

/// The measures that a table of jobs has.
pub(super) fn measures(jobs: &Table, study: Option<&Study>) -> Vec<PageMeasure> {
    let there = |column: &&Column| {
        let numbers = jobs.numbers(column.name);
        numbers.is_some_and(|list| list.iter().any(Option::is_some))
    };
    let measure = |column: &Column| PageMeasure {
        name: column.name,
        label: column.label,
        unit: asked::searched_unit(study, column.name).unwrap_or(column.unit),
    };
    Column::measures().filter(there).map(measure).collect()
}

/// All jobs, cell by cell in the order of their bins.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PageCells {
    /// Number of cells.
    pub count: usize,
    /// For each axis the bin of each cell.
    pub axis: Vec<Packed>,
    /// Jobs of each cell, the failed ones among them.
    pub jobs: Packed,
    /// Jobs of each that failed.
    pub failed: Packed,
    /// For each measure the largest value in each cell.
    pub max: Vec<Packed>,
    /// The smallest.
    pub min: Vec<Packed>,
    /// The number of the job that has the largest.
    pub at: Vec<Packed>,
}

#[derive(Debug, Clone)]
struct CellBin {
    jobs: u32,
    failed: u32,
    /// Largest, smallest and the job of the largest.
    measures: Vec<Option<(f64, f64, u32)>>,
}

/// Makes axes coarser until the jobs fall into few enough cells; whether any was.
pub(super) fn coarsen(axes: &mut [PageAxis], rows: usize) -> bool {
    let mut coarser = false;
    while count(axes, rows) > MOST_CELLS {
        let mut order: Vec<usize> = (0..axes.len()).collect();
        // of equals the one that charts have along their edge last
        order.sort_by_key(|&i| (std::cmp::Reverse(axes[i].values.len()), axes[i].name == "speed_m_s"));
        if !order.into_iter().any(|i| axes[i].coarsen()) {
            break;
        }
        coarser = true;
    }
    coarser
}

fn count(axes: &[PageAxis], rows: usize) -> usize {
    if rows <= MOST_CELLS {
        return rows;
    }
    let of = |row: usize| axes.iter().map(|axis| axis.of_row[row]).collect::<Vec<u16>>();
    (0..rows).map(of).collect::<HashSet<_>>().len()
}

impl PageCells {
    /// The cells of all jobs.
    pub(super) fn new(results: &Results, axes: &[PageAxis], measures: &[PageMeasure]) -> Self {
        let jobs = results.jobs();
        let columns: Vec<_> = measures
            .iter()
            .map(|m| jobs.numbers(m.name).unwrap_or_default())
            .collect();
        let mut cells: BTreeMap<Vec<u16>, CellBin> = BTreeMap::new();
        for row in 0..jobs.rows() {
            let key = axes.iter().map(|axis| axis.of_row[row]).collect();
            let cell = cells.entry(key).or_insert_with(|| CellBin {
                jobs: 0,
                failed: 0,
                measures: vec![None; measures.len()],
            });
            cell.jobs += 1;
            if results.is_failed(row) {
                cell.failed += 1;
                continue;
            }
            let job = super::job(results, row);
            for (kept, column) in cell.measures.iter_mut().zip(&columns) {
                let Some(x) = column.get(row).copied().flatten() else {
                    continue;
                };
                *kept = Some(match *kept {
                    Some((most, least, at)) if x <= most => (most, least.min(x), at),
                    Some((_, least, _)) => (x, least.min(x), job),
                    None => (x, x, job),
                });
            }
        }
        let each = |of: &dyn Fn(&CellBin) -> u32| Packed::U32(cells.values().map(of).collect());
        let of_measure = |m: usize, of: &dyn Fn((f64, f64, u32)) -> f64| {
            Packed::numbers(cells.values().map(|cell| cell.measures[m].map(of)))
        };
        let places = 0..measures.len();
        Self {
            count: cells.len(),
            axis: (0..axes.len())
                .map(|a| Packed::U16(cells.keys().map(|key| key[a]).collect()))
                .collect(),
            jobs: each(&|cell| cell.jobs),
            failed: each(&|cell| cell.failed),
            max: places.clone().map(|m| of_measure(m, &|kept| kept.0)).collect(),
            min: places.clone().map(|m| of_measure(m, &|kept| kept.1)).collect(),
            at: places
                .map(|m| each(&|cell| cell.measures[m].map_or(NO_JOB, |kept| kept.2)))
                .collect(),
        }
    }
}
