//! The crossings that a rating tries: its point at values of the axis that is searched.
//!
//! Knows how to make a job again from its point. Does not know which values are tried or what passes.

use super::Job;
use super::documents::TrafficEntry;
use super::jobs::Jobs;
use crate::input::{Cell, Refusal};
use crate::study_file::Study;
use std::sync::Arc;

/// The point of a design that a rating is of.
#[derive(Debug, Clone, PartialEq)]
pub struct RatingPoint {
    /// The number of its block.
    pub(super) block: usize,
    /// Its number in the block, and its values.
    pub(super) number: usize,
    pub(super) values: Vec<Cell<'static>>,
    /// Everything that the values tried depend on beside the point.
    pub(super) search: Arc<str>,
    /// Crossings that it takes at least.
    pub(super) crossings: usize,
}

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
            jobs: Jobs::of_no_point(study),
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
}

impl Job {
    /// The crossing that the job's row tells of: the job itself, of a rating the crossing at the value rated; none where there is
    /// no such value.
    pub fn told_crossing(&self, study: &Study, rated_value: Option<f64>) -> Option<Self> {
        if self.rating.is_none() {
            return Some(self.clone());
        }
        let job = Candidates::new(study).at(self, rated_value?).ok()??;
        Some(Self { rating: None, ..job })
    }

    /// Crossings that it takes at least.
    pub fn crossings(&self) -> usize {
        self.rating.as_ref().map_or(1, |rating| rating.crossings)
    }

    /// The crossing with all weights so many times as large.
    #[must_use]
    pub fn with_load(&self, factor: f64) -> Self {
        let mut job = self.clone();
        job.load_n *= factor;
        job.traffic = self.traffic.as_ref().map(|entry| {
            let mut traffic = entry.traffic.clone();
            traffic.vehicles.iter_mut().for_each(|driven| driven.load_n *= factor);
            Arc::new(TrafficEntry {
                traffic,
                is_single: entry.is_single,
                document: entry.document.clone(),
                key: entry.key,
            })
        });
        job
    }
}
