//! Rating jobs to their records: a ladder of crossings, then sections between the last that passes and the first that fails.
//!
//! Knows which values are tried in which order and what a rating tells of them: it depends on the job alone. Does not know how a
//! crossing is solved.

use super::crossing::JobResult;
use super::failure::{JobFailure, too_long};
use super::finer::{FINER_TOLERANCE, finer_operator};
use super::shared_models::SharedModels;
use super::tried::{Tried, solved};
use pontoon_core::connector::{Connection, ConnectorLaw};
use pontoon_core::vehicle::Inertia;
use pontoon_plan::design::{JobAxis, Varies};
use pontoon_plan::job::{Candidates, Job};
use pontoon_plan::study_file::{Find, Solver, Study};
use pontoon_results::{Failure, FailureKind, JobRecord, governing};

/// By how much the load of a reported crossing is varied, as a share of it.
const NUDGE: f64 = 1e-4;
/// Spread of the utilisation beyond which a reported crossing is chaotic.
const CHAOTIC: f64 = 0.02;
/// How close to its limit a crossing is of which the study's operator is not sure, as a share of the limit. `scripts/ratings` draws
/// ratings at random: of 871 crossings the worst was 1.01 % off the reference solver.
const CLOSE: f64 = 0.01;
/// What a crossing by the finer operator may be off, as a share of what it changed: of 80 ends of such ratings the worst error fell
/// from 0.99 to 0.035 %, nine of ten from 0.31 to 0.003 %.
const CHANGE_LEFT: f64 = 0.1;
/// And at least: half of those ends were off by less than a tenth of it.
const LEAST_DOUBT: f64 = 2e-5;
/// What a crossing may be off where the study's own operator is as fine: more than the worst of those ends.
const DOUBT_OF_FINE: f64 = 5e-4;
/// How often a pair is moved by its width.
const MOST_MOVES: usize = 30;

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

impl Rating<'_> {
    fn record(&mut self) -> JobResult {
        if let Some(record) = self.in_proportion()? {
            return Ok(record);
        }
        let ladder = self.find.ladder();
        let mut rungs = self.tried(&at_own_load(&ladder));
        let fails = |tried: &Result<Tried, JobFailure>| !tried.as_ref().is_ok_and(Tried::passes);
        let first = rungs.iter().position(fails);
        let Some(first) = self.first_failing(&mut rungs, first)? else {
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
            for (value, tried) in values.iter().zip(self.tried(&at_own_load(&values))) {
                let tried = tried.map_err(|failure| self.at(*value, failure))?;
                if !tried.passes() {
                    failed = tried;
                    break;
                }
                passed = tried;
            }
        }
        let (passed, failed) = self.settled(passed, failed)?;
        let spread = self.spread([&passed, &failed])?;
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
        record.limits = failed.limits().to_vec();
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

    /// The crossings at some values, each with all weights multiplied, side by side.
    fn tried(&mut self, asked: &[(f64, f64)]) -> Vec<Result<Tried, JobFailure>> {
        let made: Vec<Result<Job, JobFailure>> = asked
            .iter()
            .map(|&(value, load_factor)| match self.candidates.at(self.job, value) {
                Ok(Some(job)) if load_factor != 1.0 => Ok(job.with_load(load_factor)),
                Ok(Some(job)) => Ok(job),
                Ok(None) => Err(JobFailure::of_program("a rating without a point")),
                Err(refusal) => Err(Failure::new(FailureKind::NotPrepared, refusal.to_string()).into()),
            })
            .map(|job: Result<Job, JobFailure>| {
                let job = job?;
                too_long(&job).map_or(Ok(job), |failure| Err(failure.into()))
            })
            .collect();
        let jobs: Vec<&Job> = made.iter().flatten().collect();
        self.crossings += jobs.len();
        let own = self.prepared_for(&jobs);
        let models = own.as_ref().unwrap_or(self.models);
        let mut solved = solved(&jobs, models).into_iter();
        let value_and_made = asked.iter().zip(made);
        value_and_made
            .map(|(&(value, _), job)| {
                let job = job?;
                let response = solved
                    .next()
                    .unwrap_or_else(|| Err(JobFailure::of_program("no answer")))?;
                Tried::new(value, job, response, models)
            })
            .collect()
    }

    /// The first rung that fails: `first` by the study's own solver, or one before it that is close to its limit and fails by the solvers
    /// that judge, whose crossing then stands for it. The last rung before `first` is judged with the pair.
    fn first_failing(
        &mut self,
        rungs: &mut [Result<Tried, JobFailure>],
        first: Option<usize>,
    ) -> Result<Option<usize>, JobFailure> {
        let before = first.map_or(rungs.len(), |first| first.saturating_sub(1));
        for (at, rung) in rungs[..before].iter_mut().enumerate() {
            let Ok(tried) = rung else { continue };
            if tried.utilisation() > 1.0 - CLOSE {
                let judged = self.judged(tried.clone())?;
                if !judged.passes() {
                    *tried = judged;
                    return Ok(Some(at));
                }
            }
        }
        Ok(first)
    }

    /// The pair of which the solvers that judge say that one end passes and the other fails. Where they say otherwise of an end, the pair
    /// moves by its own width.
    fn settled(&mut self, passed: Tried, failed: Tried) -> Result<(Tried, Tried), JobFailure> {
        let (mut passed, mut failed) = (self.judged(passed)?, self.judged(failed)?);
        for _ in 0..MOST_MOVES {
            let down = !passed.passes();
            if !down && !failed.passes() {
                return Ok((passed, failed));
            }
            let value = match down {
                true => self.find.next(failed.value, passed.value),
                false => self.find.next(passed.value, failed.value),
            };
            let Some(value) = value else {
                return Err(match down {
                    true => self.unbracketed(FailureKind::BracketFails, &passed),
                    false => self.unbracketed(FailureKind::BracketPasses, &failed),
                }
                .into());
            };
            let tried = self.one_tried(value)?;
            let tried = self.judged(tried)?;
            (passed, failed) = if down { (tried, passed) } else { (failed, tried) };
        }
        let text = format!(
            "finer solvers find no pair within {MOST_MOVES} widths of {} = {}",
            self.find.axis.name, passed.value
        );
        Err(Failure::new(FailureKind::RatingNotSettled, text).into())
    }

    /// A crossing by a solver that tells surely whether it passes: an operator of more modes, or the reference solver where that
    /// operator's answer is too close to the limit.
    fn judged(&mut self, tried: Tried) -> Result<Tried, JobFailure> {
        let Some(tolerance) = tried.tolerance() else {
            return Ok(tried);
        };
        let finer = finer_operator(&tried.job).filter(|by| tried.is_held_by(self.models, *by));
        let (tried, doubt) = match finer {
            Some(by) => {
                let finer = self.again(&tried, by)?;
                let changed = (finer.utilisation() - tried.utilisation()).abs();
                (finer, (CHANGE_LEFT * changed).max(LEAST_DOUBT))
            }
            None if tolerance > FINER_TOLERANCE => (tried, CLOSE),
            None => (tried, DOUBT_OF_FINE),
        };
        if (tried.utilisation() - 1.0).abs() > doubt || tried.has_own_step() {
            return Ok(tried);
        }
        self.again(&tried, Solver::Reference)
    }

    /// A crossing once more, by another solver.
    fn again(&mut self, tried: &Tried, by: Solver) -> Result<Tried, JobFailure> {
        self.crossings += 1;
        let own = match by {
            Solver::Reference => self.prepared_for(&[&tried.job]),
            Solver::Operator { .. } => None,
        };
        let again = tried.again(by, own.as_ref().unwrap_or(self.models));
        again.map_err(|failure| self.at(tried.value, failure))
    }

    /// What crossings share where the value searched changes that; none where what was prepared holds for them.
    fn prepared_for(&self, jobs: &[&Job]) -> Option<SharedModels> {
        let holds = |job: &&Job| job.as_crossing().is_some_and(|crossing| self.models.holds(&crossing));
        if jobs.iter().all(holds) {
            return None;
        }
        let known = self.models.modules();
        Some(SharedModels::prepare_candidates(jobs, &known))
    }

    /// The record of a crossing with all that the study keeps.
    fn whole(&mut self, tried: &Tried) -> JobResult {
        let own = self.prepared_for(&[&tried.job]);
        tried.whole(own.as_ref().unwrap_or(self.models))
    }

    /// How far a ten-thousandth of the load moves the utilisation of crossings, as a share of it, of the one that it moves most.
    fn spread(&mut self, pair: [&Tried; 2]) -> Result<f64, JobFailure> {
        let nudged = |tried: &Tried| [1.0 - NUDGE, 1.0 + NUDGE].map(|factor| (tried.value, factor));
        let mut moved = self.tried(&pair.map(nudged).concat()).into_iter();
        let mut most = 0.0_f64;
        for tried in pair {
            let mut range = [tried.by_study; 2];
            for moved in moved.by_ref().take(2) {
                let utilisation = moved.map_err(|failure| self.at(tried.value, failure))?.utilisation();
                range = [range[0].min(utilisation), range[1].max(utilisation)];
            }
            most = most.max((range[1] - range[0]) / tried.by_study);
        }
        Ok(most)
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
        for (row, of) in tried.limits().iter().zip(&*self.job.shared.limits) {
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
        let tried = self.tried(&[(value, 1.0)]).pop();
        let tried = tried.unwrap_or_else(|| Err(JobFailure::of_program("no answer")));
        tried.map_err(|failure| self.at(value, failure))
    }
}

/// Values, each at the load that it says.
fn at_own_load(values: &[f64]) -> Vec<(f64, f64)> {
    values.iter().map(|&value| (value, 1.0)).collect()
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
    let design = &least.shared.bridge.design;
    pressed
        && least.connection == Connection::Linear
        && least
            .own_laws()
            .iter()
            .all(|(_, law)| matches!(law, ConnectorLaw::Linear { .. }))
        && design.banks.is_empty()
        && !design.has_dead_load()
        && least.shared.limits.iter().all(|of| !of.limit.is_floor())
}
