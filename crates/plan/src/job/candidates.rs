//! The crossings that a rating tries: its point at values of the axis that is searched.
//!
//! Knows how to make a job again from its point. Does not know which values are tried or what passes.

use super::Job;
use super::jobs::{JobParts, Jobs};
use crate::input::Refusal;
use crate::study_file::Study;

/// Makes the crossings of a study's ratings.
pub struct Candidates<'a> {
    study: &'a Study,
    jobs: Jobs<'a>,
}

impl<'a> Candidates<'a> {
    /// Of a study.
    pub fn new(study: &'a Study) -> Self {
        Self {
            study,
            jobs: Jobs::of_no_point(study, JobParts::default()),
        }
    }

    /// The crossing of a rating at a value; none where the job is no rating.
    ///
    /// # Errors
    /// [`Refusal`] of a value that no crossing may have.
    pub fn at(&mut self, rating: &Job, value: f64) -> Result<Option<Job>, Refusal> {
        let Some(of) = &rating.rating else { return Ok(None) };
        let Some(block) = self.study.blocks.get(of.block) else {
            return Ok(None);
        };
        let point = block.point(of.number, &of.values).at(value);
        let job = self.jobs.job(&point)?;
        Ok(Some(Job {
            number: rating.number,
            rating: rating.rating.clone(),
            ..job
        }))
    }

    /// The crossing that a job's row tells of: the job itself, of a rating the crossing at the value rated; none where there is
    /// no such value.
    pub fn told_crossing(study: &'a Study, job: &Job, rated_value: Option<f64>) -> Option<Job> {
        if job.rating.is_none() {
            return Some(job.clone());
        }
        let crossing = Self::new(study).at(job, rated_value?).ok()??;
        Some(Job {
            rating: None,
            ..crossing
        })
    }
}
