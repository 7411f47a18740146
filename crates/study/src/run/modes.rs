//! A job that asks for modes to its record.
//!
//! Knows which mode fills which row. Does not know columns, or how modes are found.

use super::bench::Bench;
use crate::modes::rows;
use pontoon_core::bridge::Ends;
use pontoon_plan::job::Job;
use pontoon_results::{HistoryRows, JobRecord, Summary};

/// Finds the modes of a job.
pub(super) fn solve(job: &Job, bench: &Bench) -> Result<JobRecord, String> {
    let spec = &job.analysis.spec;
    let ends = if spec.supports.unwrap_or_default() {
        Ends::Supported
    } else {
        Ends::Free
    };
    let bridge = bench.bridge(job, ends)?;
    let modes = rows(&bridge, spec.count.unwrap_or_default()).map_err(|e| e.to_string())?;
    let summary = Summary {
        structural_mass_kg: Some(bench.module_of(job)?.structural_mass_kg()),
        ..Summary::default()
    };
    Ok(JobRecord {
        job: job.number,
        reason: None,
        summary,
        positions: Vec::new(),
        connectors: Vec::new(),
        histories: HistoryRows::default(),
        modes,
    })
}
