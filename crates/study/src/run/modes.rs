//! A job that asks for modes to its record.
//!
//! Knows which mode fills which row. Does not know columns, or how modes are found.

use super::failure::JobFailure;
use super::shared_models::SharedModels;
use crate::modes::rows;
use pontoon_core::bridge::Ends;
use pontoon_plan::job::Job;
use pontoon_plan::study_file::ModesAnalysis;
use pontoon_results::{JobRecord, Summary};

/// Finds the modes of a job.
pub(super) fn solve(job: &Job, asked: &ModesAnalysis, models: &SharedModels) -> Result<JobRecord, JobFailure> {
    let ends = if asked.supports { Ends::Supported } else { Ends::Free };
    let bridge = models.bridge(job, ends)?;
    let modes = rows(&bridge, asked.count)?;
    let summary = Summary {
        structural_mass_kg: Some(models.mean_mass_kg(job)?),
        ..Summary::default()
    };
    Ok(JobRecord {
        job: job.number,
        summary,
        modes,
        ..JobRecord::default()
    })
}
