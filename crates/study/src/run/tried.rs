//! Crossings that a rating tries, by the solver of the study or a finer one.
//!
//! Knows which solver a crossing was solved by, and what is recorded of it. Does not know what is searched.

use super::crossing::{self, JobResult, SteppedResponse};
use super::demands::record_for;
use super::failure::JobFailure;
use super::shared_models::SharedModels;
use pontoon_core::response::Record;
use pontoon_plan::job::{CrossingJob, Job};
use pontoon_plan::study_file::{CrossingAnalysis, Solver};
use pontoon_results::{JobRecord, LimitRow};
use rayon::prelude::*;

/// Crossings that are solved side by side.
const TOGETHER: usize = 32;

/// A crossing that was tried.
#[derive(Clone)]
pub(super) struct Tried {
    /// At which value.
    pub(super) value: f64,
    /// The crossing.
    pub(super) job: Job,
    /// How it was computed.
    analysis: CrossingAnalysis,
    response: SteppedResponse,
    record: JobRecord,
    /// Its utilisation by the study's own solver.
    pub(super) by_study: f64,
}

impl Tried {
    /// Of a response by the study's own solver.
    pub(super) fn new(
        value: f64,
        job: Job,
        response: SteppedResponse,
        models: &SharedModels,
    ) -> Result<Self, JobFailure> {
        let crossing = job.as_crossing().ok_or_else(no_crossing)?;
        let analysis = *crossing.analysis;
        let record = crossing::recorded_beside(&crossing, response.0.clone(), None, models)?;
        Ok(Self {
            value,
            by_study: utilisation(&record),
            job,
            analysis,
            response,
            record,
        })
    }

    /// This crossing by another solver.
    pub(super) fn again(&self, by: Solver, models: &SharedModels) -> Result<Self, JobFailure> {
        let analysis = CrossingAnalysis {
            solver: by,
            ..self.analysis
        };
        let crossing = crossing_by(&self.job, &analysis)?;
        let response = one(&crossing, asked(&crossing), models)?;
        let record = crossing::recorded_beside(&crossing, response.0.clone(), None, models)?;
        Ok(Self {
            value: self.value,
            job: self.job.clone(),
            analysis,
            response,
            record,
            by_study: self.by_study,
        })
    }

    /// Whether all is there that it is solved with by an operator.
    pub(super) fn is_held_by(&self, models: &SharedModels, by: Solver) -> bool {
        let analysis = CrossingAnalysis {
            solver: by,
            ..self.analysis
        };
        crossing_by(&self.job, &analysis).is_ok_and(|crossing| models.holds(&crossing))
    }

    /// Its record with all that the study keeps.
    pub(super) fn whole(&self, models: &SharedModels) -> JobResult {
        let crossing = crossing_by(&self.job, &self.analysis)?;
        let kept = self
            .job
            .shared
            .record
            .of_crossing(&self.job.shared.bridge.design, &crossing.traffic());
        let (response, time_step_s) = if kept == asked(&crossing) {
            self.response.clone()
        } else {
            // histories of the rated crossing alone
            let mut wanted = kept;
            record_for(&self.job.shared.limits, &mut wanted);
            one(&crossing, wanted, models)?
        };
        let mut record = crossing::recorded_beside(&crossing, response, None, models)?;
        record.summary.time_step_s = time_step_s;
        Ok(record)
    }

    pub(super) fn limits(&self) -> &[LimitRow] {
        &self.record.limits
    }

    pub(super) fn utilisation(&self) -> f64 {
        utilisation(&self.record)
    }

    pub(super) fn passes(&self) -> bool {
        self.utilisation() <= 1.0
    }

    /// The operator's tolerance; none where the reference solver has solved it.
    pub(super) fn tolerance(&self) -> Option<f64> {
        match self.analysis.solver {
            Solver::Operator { tolerance, .. } => Some(tolerance),
            Solver::Reference => None,
        }
    }

    /// Whether it has a time step of its own, which only the operator finds.
    pub(super) fn has_own_step(&self) -> bool {
        self.analysis.time_step.tolerance().is_some()
    }
}

fn utilisation(record: &JobRecord) -> f64 {
    record.summary.utilisation.unwrap_or(f64::INFINITY)
}

fn no_crossing() -> JobFailure {
    JobFailure::of_program("no crossing")
}

fn crossing_by<'a>(job: &'a Job, analysis: &'a CrossingAnalysis) -> Result<CrossingJob<'a>, JobFailure> {
    let crossing = job.as_crossing().ok_or_else(no_crossing)?;
    Ok(CrossingJob { analysis, ..crossing })
}

/// What is recorded of a crossing that is tried.
fn asked(crossing: &CrossingJob<'_>) -> Record {
    let mut record = Record {
        places_x_m: crossing.job.shared.record.places_x_m.clone(),
        corners: crossing.job.shared.record.freeboards,
        ..Default::default()
    };
    record_for(&crossing.job.shared.limits, &mut record);
    record
}

fn one(crossing: &CrossingJob<'_>, record: Record, models: &SharedModels) -> Result<SteppedResponse, JobFailure> {
    if crossing.operator_tolerance().is_none() {
        return crossing::integrated(crossing, record, models);
    }
    let mut answers = crossing::operated(&[(*crossing, record)], models);
    answers
        .pop()
        .unwrap_or_else(|| Err(JobFailure::of_program("no answer")))
}

/// The responses of crossings, those that share a solver side by side; what stands beside which does not matter.
pub(super) fn solved(jobs: &[&Job], models: &SharedModels) -> Vec<Result<SteppedResponse, JobFailure>> {
    let crossings: Vec<CrossingJob<'_>> = jobs.iter().filter_map(|job| job.as_crossing()).collect();
    let some = |chunk: &[CrossingJob<'_>]| -> Vec<_> {
        let batch: Vec<_> = chunk.iter().map(|crossing| (*crossing, asked(crossing))).collect();
        let keys: Vec<_> = chunk.iter().map(SharedModels::lane_batch_key).collect();
        if keys.iter().all(|key| key.is_some() && *key == keys[0]) {
            crossing::operated(&batch, models)
        } else {
            batch
                .into_iter()
                .map(|(crossing, record)| one(&crossing, record, models))
                .collect()
        }
    };
    crossings
        .par_chunks(TOGETHER)
        .with_max_len(1)
        .flat_map_iter(some)
        .collect()
}
