//! Rating jobs to their records: a ladder of crossings, then sections between the last that passes and the first that fails.
//!
//! Knows which values are tried in which order and what a rating tells of them: it depends on the job alone. Does not know how a
//! crossing is solved.

use super::cancel::CancelToken;
use super::crossing::{self, JobResult, SteppedResponse};
use super::demands::record_for;
use super::failure::JobFailure;
use super::progress::Silent;
use super::shared_models::SharedModels;
use pontoon_core::connector::{Connection, ConnectorLaw};
use pontoon_core::response::Record;
use pontoon_core::vehicle::Inertia;
use pontoon_plan::design::{JobAxis, Varies};
use pontoon_plan::job::{Candidates, CrossingJob, Job};
use pontoon_plan::study_file::{Find, Study};
use pontoon_results::{Failure, FailureKind, JobRecord, LimitRow, governing};
use rayon::prelude::*;

/// Crossings that are solved side by side.
const TOGETHER: usize = 32;
/// By how much the load of a reported crossing is varied, as a share of it.
const NUDGE: f64 = 1e-4;
/// Spread of the utilisation beyond which a reported crossing is chaotic.
const CHAOTIC: f64 = 0.02;

/// Solves a rating.
pub(super) fn solve(study: &Study, job: &Job, models: &SharedModels) -> JobResult {
    let Some(find) = &study.find else {
        return Err(JobFailure::of_program("a rating without a search"));
    };
    let mut rating = Rating {
        job,
        find,
        models,
        candidates: Candidates::new(study),
        crossings: 0,
    };
    rating.record()
}

/// A rating under way.
struct Rating<'a> {
    job: &'a Job,
    find: &'a Find,
    models: &'a SharedModels,
    candidates: Candidates<'a>,
    crossings: usize,
}

/// A crossing that was tried.
struct Tried {
    value: f64,
    job: Job,
    response: SteppedResponse,
    record: JobRecord,
}

impl Tried {
    fn limits(&self) -> &[LimitRow] {
        &self.record.limits
    }

    fn utilisation(&self) -> f64 {
        self.record.summary.utilisation.unwrap_or(f64::INFINITY)
    }

    fn passes(&self) -> bool {
        self.utilisation() <= 1.0
    }
}

impl Rating<'_> {
    fn record(&mut self) -> JobResult {
        if let Some(record) = self.in_proportion()? {
            return Ok(record);
        }
        let ladder = self.find.ladder();
        let mut rungs = self.tried(&ladder, 1.0);
        let fails = |tried: &Result<Tried, JobFailure>| !tried.as_ref().is_ok_and(Tried::passes);
        let Some(first) = rungs.iter().position(fails) else {
            let last = rungs
                .pop()
                .unwrap_or_else(|| Err(JobFailure::of_program("no ladder")))?;
            return Err(self.unbracketed(FailureKind::BracketPasses, &last).into());
        };
        let mut beyond = rungs.split_off(first).into_iter();
        let failed = beyond.next().unwrap_or_else(|| Err(JobFailure::of_program("no rung")));
        // a crossing that was not solved is neither: it tells nothing of the bridge
        let mut failed = failed.map_err(|failure| self.at(ladder[first], failure))?;
        let Some(passed) = rungs.pop() else {
            return Err(self.unbracketed(FailureKind::BracketFails, &failed).into());
        };
        let mut passed = passed?;
        // of a crossing that was not solved nobody knows whether it passes
        let (mut passes_beyond, mut unknown) = (None, false);
        for rung in beyond {
            match rung {
                Ok(tried) if tried.passes() => passes_beyond = Some(tried.value),
                Ok(_) => {}
                Err(_) => unknown = true,
            }
        }
        loop {
            let values = self.find.sections(passed.value, failed.value);
            if values.is_empty() {
                break;
            }
            for (value, tried) in values.iter().zip(self.tried(&values, 1.0)) {
                let tried = tried.map_err(|failure| self.at(*value, failure))?;
                if !tried.passes() {
                    failed = tried;
                    break;
                }
                passed = tried;
            }
        }
        let spread = self.spread(&passed)?.max(self.spread(&failed)?);
        let mut record = self.whole(&passed)?;
        let summary = &mut record.summary;
        summary.rated_value = Some(passed.value);
        summary.first_failure = Some(failed.value);
        summary.largest_pass = Some(passes_beyond.unwrap_or(passed.value));
        summary.monotone = Some(passes_beyond.is_none()).filter(|is| !(*is && unknown));
        summary.spread = Some(spread);
        summary.chaotic = Some(spread > CHAOTIC);
        summary.crossings = Some(self.crossings);
        if let Some(row) = governing(failed.limits()) {
            summary.take_governing(row);
        }
        record.limits = failed.record.limits;
        Ok(record)
    }

    /// The failure of a rating at an end of its bracket.
    fn unbracketed(&self, kind: FailureKind, tried: &Tried) -> Failure {
        let row = governing(tried.limits());
        let limit = row.map_or("no limit", |row| row.limit.as_str());
        let is_lower = (kind == FailureKind::BracketFails) == self.find.is_largest;
        let text = format!(
            "the {} end of the bracket {}: {} = {} uses up {:.4} of {limit}",
            if is_lower { "lower" } else { "upper" },
            if kind == FailureKind::BracketFails {
                "fails"
            } else {
                "passes"
            },
            self.find.axis.name,
            tried.value,
            tried.utilisation()
        );
        Failure::new(kind, text).with("utilisation", tried.utilisation())
    }

    /// The failure of a crossing at a value.
    fn at(&self, value: f64, failure: JobFailure) -> JobFailure {
        failure.said(&format!("crossing at {} = {value}: ", self.find.axis.name), "")
    }

    /// The crossings at some values with all weights multiplied, side by side.
    fn tried(&mut self, values: &[f64], load_factor: f64) -> Vec<Result<Tried, JobFailure>> {
        let made: Vec<Result<Job, JobFailure>> = values
            .iter()
            .map(|&value| match self.candidates.at(self.job, value) {
                Ok(Some(job)) if load_factor != 1.0 => Ok(job.with_load(load_factor)),
                Ok(Some(job)) => Ok(job),
                Ok(None) => Err(JobFailure::of_program("a rating without a point")),
                Err(refusal) => Err(Failure::new(FailureKind::NotPrepared, refusal.to_string()).into()),
            })
            .collect();
        let jobs: Vec<&Job> = made.iter().flatten().collect();
        self.crossings += jobs.len();
        let own = self.prepared_for(&jobs);
        let models = own.as_ref().unwrap_or(self.models);
        let mut solved = solved(&jobs, models).into_iter();
        let value_and_made = values.iter().zip(made);
        value_and_made
            .map(|(&value, job)| {
                let job = job?;
                let response = solved
                    .next()
                    .unwrap_or_else(|| Err(JobFailure::of_program("no answer")))?;
                let crossing = job.as_crossing().ok_or_else(|| JobFailure::of_program("no crossing"))?;
                let record = crossing::recorded_beside(&crossing, response.0.clone(), None, models)?;
                Ok(Tried {
                    value,
                    job,
                    response,
                    record,
                })
            })
            .collect()
    }

    /// What crossings share where the value searched changes that; none where what was prepared holds for them.
    fn prepared_for(&self, jobs: &[&Job]) -> Option<SharedModels> {
        let holds = |job: &&Job| job.as_crossing().is_some_and(|crossing| self.models.holds(&crossing));
        if jobs.iter().all(holds) {
            return None;
        }
        let known = self.models.modules();
        Some(SharedModels::prepare(
            jobs,
            &known,
            None,
            &CancelToken::default(),
            &Silent,
        ))
    }

    /// The record of a crossing with all that the study keeps.
    fn whole(&mut self, tried: &Tried) -> JobResult {
        let Some(crossing) = tried.job.as_crossing() else {
            return Err(JobFailure::of_program("no crossing"));
        };
        let own = self.prepared_for(&[&tried.job]);
        let models = own.as_ref().unwrap_or(self.models);
        let kept = tried
            .job
            .record
            .of_crossing(&tried.job.bridge.design, &crossing.traffic());
        let (response, time_step_s) = if kept == asked(&crossing) {
            tried.response.clone()
        } else {
            // histories of the rated crossing alone
            let mut wanted = kept;
            record_for(&tried.job.limits, &mut wanted);
            one(&crossing, wanted, models)?
        };
        let mut record = crossing::recorded_beside(&crossing, response, None, models)?;
        record.summary.time_step_s = time_step_s;
        Ok(record)
    }

    /// How far a ten-thousandth of the load moves the utilisation of a crossing, as a share of it.
    fn spread(&mut self, tried: &Tried) -> Result<f64, JobFailure> {
        let mut range = [tried.utilisation(); 2];
        for factor in [1.0 - NUDGE, 1.0 + NUDGE] {
            for moved in self.tried(&[tried.value], factor) {
                let utilisation = moved.map_err(|failure| self.at(tried.value, failure))?.utilisation();
                range = [range[0].min(utilisation), range[1].max(utilisation)];
            }
        }
        Ok((range[1] - range[0]) / tried.utilisation())
    }

    /// The rating of a load that nothing but weight presses on a linear bridge: demands are in proportion to it.
    fn in_proportion(&mut self) -> Result<Option<JobRecord>, JobFailure> {
        if !self.find.is_largest || self.find.axis.varies != Varies::Job(JobAxis::Load) {
            return Ok(None);
        }
        let [from, to] = self.find.ends();
        let made = |failure: Option<Job>| failure.ok_or_else(|| JobFailure::of_program("a rating without a point"));
        let refused = |refusal: pontoon_plan::input::Refusal| {
            JobFailure::from(Failure::new(FailureKind::NotPrepared, refusal.to_string()))
        };
        let ends = [from, to].map(|value| self.candidates.at(self.job, value));
        let [least, most] = ends;
        let (least, most) = (made(least.map_err(refused)?)?, made(most.map_err(refused)?)?);
        if !is_in_proportion(&least, &most, to / from) {
            return Ok(None);
        }
        let tried = self.one_tried(to)?;
        let mut rated = f64::INFINITY;
        for (row, of) in tried.limits().iter().zip(&*self.job.limits) {
            let by_load = row.demand.value.unwrap_or(0.0) - of.beside;
            if by_load > 0.0 {
                rated = rated.min(to * (of.allowed - of.beside) / by_load);
            }
        }
        if rated > to {
            return Err(self.unbracketed(FailureKind::BracketPasses, &tried).into());
        }
        if rated < from {
            let least = self.one_tried(from)?;
            return Err(self.unbracketed(FailureKind::BracketFails, &least).into());
        }
        let at = self.one_tried(rated)?;
        let mut record = self.whole(&at)?;
        let summary = &mut record.summary;
        summary.rated_value = Some(rated);
        summary.first_failure = Some(rated);
        summary.largest_pass = Some(rated);
        summary.monotone = Some(true);
        summary.chaotic = Some(false);
        summary.crossings = Some(self.crossings);
        Ok(Some(record))
    }

    fn one_tried(&mut self, value: f64) -> Result<Tried, JobFailure> {
        let tried = self.tried(&[value], 1.0).pop();
        let tried = tried.unwrap_or_else(|| Err(JobFailure::of_program("no answer")));
        tried.map_err(|failure| self.at(value, failure))
    }
}

/// Whether demands are in proportion to the load: nothing on the bridge but weights that are so, all connectors and banks linear,
/// no state at rest and no limit from below.
fn is_in_proportion(least: &Job, most: &Job, ratio: f64) -> bool {
    let (Some(one), Some(other)) = (least.as_crossing(), most.as_crossing()) else {
        return false;
    };
    let (few, many) = (one.traffic(), other.traffic());
    let pressed = few.vehicles.iter().zip(&many.vehicles).all(|(a, b)| {
        let is_weight = a.vehicle.inertia == Inertia::None && a.vehicle.springs.is_none();
        is_weight && (b.load_n - ratio * a.load_n).abs() <= 1e-12 * b.load_n
    });
    let design = &least.bridge.design;
    pressed
        && least.connection == Connection::Linear
        && least
            .own_laws()
            .iter()
            .all(|(_, law)| matches!(law, ConnectorLaw::Linear { .. }))
        && design.banks.is_empty()
        && !design.has_dead_load()
        && least.limits.iter().all(|of| !of.limit.is_floor())
}

/// What is recorded of a crossing that is tried.
fn asked(crossing: &CrossingJob<'_>) -> Record {
    let mut record = Record {
        places_x_m: crossing.job.record.places_x_m.clone(),
        corners: crossing.job.record.freeboards,
        ..Default::default()
    };
    record_for(&crossing.job.limits, &mut record);
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
fn solved(jobs: &[&Job], models: &SharedModels) -> Vec<Result<SteppedResponse, JobFailure>> {
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
