//! Candidates to residuals: each candidate's bridge in place of its studies' own, the jobs that the fitted checks need.
//!
//! Knows which checks are fitted and which jobs they look at. Does not know what moves the parameters.

use super::candidate::Candidate;
use super::fit::ModelError;
use super::parameters::Parameters;
use crate::checks::{Check, Role};
use crate::compare::ReferenceJudge;
use crate::reference::Reference;
use pontoon_plan::design::Varies;
use pontoon_plan::input::filter::Filter;
use pontoon_plan::input::{FoundValue, Refusal, RefusalKind};
use pontoon_plan::job::{Job, Jobs};
use pontoon_plan::study_file::{BridgeFile, Study};
use pontoon_results::{JobRecord, Results};
use pontoon_study::run::{PreparedModules, solve_together};
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::{Mutex, PoisonError};

/// What a calibration computes.
pub(super) struct CalibrationModel<'a> {
    pub(super) bridge: &'a BridgeFile,
    pub(super) parameters: &'a Parameters,
    pub(super) sources: Vec<ReferencedStudy<'a>>,
    told: &'a (dyn Fn(usize, f64) + Sync),
    state: Mutex<ModelState>,
}

/// What a candidate is computed for: each study with its jobs.
type CandidateWork = Vec<(Study, Vec<Job>)>;

/// A reference with its study.
pub(super) struct ReferencedStudy<'a> {
    pub(super) reference: &'a Reference,
    pub(super) study: Study,
    /// Numbers of the checks that are fitted.
    pub(super) checks: Vec<usize>,
    /// Filters of all that the checks look at.
    filters: Vec<Filter>,
}

/// What batches leave to those behind them.
struct ModelState {
    modules: PreparedModules,
    candidates: usize,
    condensations: usize,
    least: f64,
    /// What was refused before anything else was asked for: the input is to blame, no candidate.
    refused: Option<Refusal>,
}

impl<'a> CalibrationModel<'a> {
    pub(super) fn new(
        bridge: &'a BridgeFile,
        references: &'a [Reference],
        parameters: &'a Parameters,
        told: &'a (dyn Fn(usize, f64) + Sync),
    ) -> Result<Self, Refusal> {
        check_once(references)?;
        check_ids(references, parameters)?;
        let sources = references
            .iter()
            .map(|r| ReferencedStudy::new(r, parameters))
            .collect::<Result<Vec<_>, Refusal>>()?;
        if sources.iter().all(|source| source.checks.is_empty()) {
            let allowed = "ids of checks of one value with a tolerance";
            let refused = Refusal::new(&parameters.file, "fit", "no check to fit", allowed);
            return Err(refused.because(RefusalKind::Missing));
        }
        Ok(Self {
            bridge,
            parameters,
            sources,
            told,
            state: Mutex::new(ModelState {
                modules: PreparedModules::default(),
                candidates: 0,
                condensations: 0,
                least: f64::INFINITY,
                refused: None,
            }),
        })
    }

    /// `weight (found - expected) / tolerance` of each fitted check, for each of several candidates, all solved together.
    pub(super) fn residuals(&self, points: &[Vec<f64>]) -> Vec<Result<Vec<f64>, ModelError>> {
        let prepared: Vec<Result<CandidateWork, ModelError>> = points
            .iter()
            .map(|point| self.jobs(point).map_err(|refusal| self.told_of(refusal)))
            .collect();
        let all: Vec<(&Study, &Job)> = prepared
            .iter()
            .flatten()
            .flatten()
            .flat_map(|(study, jobs)| jobs.iter().map(move |job| (study, job)))
            .collect();
        let known = self.lock().modules.clone();
        let (records, solved) = solve_together(&all, &known);
        let mut records = records.into_iter();
        let answers: Vec<Result<Vec<f64>, ModelError>> = prepared
            .iter()
            .map(|candidate| {
                let studies = candidate.as_ref().map_err(Clone::clone)?;
                // every candidate takes its own records, whether an earlier check failed or not
                let own: Vec<Vec<JobRecord>> = studies
                    .iter()
                    .map(|(_, jobs)| records.by_ref().take(jobs.len()).collect())
                    .collect();
                let mut found = Vec::new();
                for ((source, (study, jobs)), records) in self.sources.iter().zip(studies).zip(&own) {
                    let residuals = source.residuals(study, jobs, records, &self.parameters.spec.weights);
                    found.extend(residuals.map_err(|refusal| self.told_of(refusal))??);
                }
                Ok(found)
            })
            .collect();
        let mut state = self.lock();
        state.modules = solved.modules;
        state.condensations += solved.condensations;
        state.candidates += points.len();
        for residuals in answers.iter().flatten() {
            state.least = state.least.min(residuals.iter().map(|r| r * r).sum());
        }
        (self.told)(state.candidates, state.least);
        answers
    }

    /// What is wrong with the input itself, where the first candidates were refused.
    pub(super) fn refused_at_start(&self) -> Option<Refusal> {
        self.lock().refused.clone()
    }

    /// Keeps what the first candidates were refused for, and says it.
    fn told_of(&self, refusal: Refusal) -> ModelError {
        let error = ModelError(refusal.to_string());
        let mut state = self.lock();
        if state.candidates == 0 {
            state.refused.get_or_insert(refusal);
        }
        error
    }

    /// Modules condensed so far.
    pub(super) fn condensations(&self) -> usize {
        self.lock().condensations
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, ModelState> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// For each reference its study with the candidate's bridge, and the jobs that the checks need.
    fn jobs(&self, point: &[f64]) -> Result<CandidateWork, Refusal> {
        let candidate = Candidate::new(self.parameters, self.bridge, point)?;
        let of_source = |source: &ReferencedStudy<'_>| {
            let mut study = source.study.clone();
            study.bridge = self.bridge.with(candidate.document(), candidate.design.clone());
            let jobs = Jobs::new(&study).filter(|job| job.as_ref().map_or(true, |job| source.needs(job)));
            let jobs = jobs.collect::<Result<Vec<Job>, Refusal>>()?;
            Ok((study, jobs))
        };
        self.sources.iter().map(of_source).collect()
    }
}

impl<'a> ReferencedStudy<'a> {
    fn new(reference: &'a Reference, parameters: &Parameters) -> Result<Self, Refusal> {
        let Some(path) = reference.study() else {
            let allowed = "the path of the study that gives what its checks look at";
            return Err(Refusal::new(&reference.file, "study", FoundValue::NOTHING, allowed));
        };
        let is_fitted = |check: &Check| match &parameters.spec.fit {
            Some(ids) => ids.contains(&check.id),
            None => check.role == Role::Hold && fitted(check).is_some(),
        };
        let checks: Vec<usize> = (0..reference.checks.len())
            .filter(|&i| is_fitted(&reference.checks[i]))
            .collect();
        let mut filters = Vec::new();
        for check in checks.iter().map(|&i| &reference.checks[i]) {
            match check.one_value() {
                Some(one) => filters.extend(one.of.filters(&check.filter)),
                None => filters.push(check.filter.clone()),
            }
        }
        Ok(Self {
            reference,
            study: Study::open(&path)?,
            checks,
            filters,
        })
    }

    /// Whether a check looks at a job.
    fn needs(&self, job: &Job) -> bool {
        let means = |filter: &Filter| {
            // what is no axis is a column of rows, which the job's record will have
            let mut of_axes = filter.0.iter().filter(|(name, _)| Varies::of_column(name).is_some());
            of_axes.all(|(name, allowed)| allowed.allows(&job.column(name)))
        };
        self.filters.iter().any(means)
    }

    /// The residuals, or in the inner result why there are none.
    fn residuals(
        &self,
        study: &Study,
        jobs: &[Job],
        records: &[JobRecord],
        weights: &BTreeMap<String, f64>,
    ) -> Result<Result<Vec<f64>, ModelError>, Refusal> {
        let failed = records
            .iter()
            .find_map(|record| Some((record, record.failure.as_ref()?)));
        if let Some((record, failure)) = failed {
            let reason = format!("{}: job {}: {}", study.name, record.job, failure.text);
            return Ok(Err(ModelError(reason)));
        }
        let results = Results::of_records(study, jobs, records, Path::new("candidate"));
        let judge = ReferenceJudge::new(&results, self.reference);
        let mut residuals = Vec::new();
        for &i in &self.checks {
            let check = &self.reference.checks[i];
            let Some((expected, tolerance)) = fitted(check) else {
                return Ok(Err(ModelError(format!("{}: not a check of one value", check.id))));
            };
            match judge.value(i)? {
                Ok(found) => {
                    let weight = weights.get(&check.id).unwrap_or(&1.0);
                    residuals.push(weight * (found - expected) / tolerance);
                }
                Err(reason) => return Ok(Err(ModelError(format!("{}: {reason}", check.id)))),
            }
        }
        Ok(Ok(residuals))
    }
}

/// What a check of one value expects and the tolerance that scales its residual; none where it has none above zero.
fn fitted(check: &Check) -> Option<(f64, f64)> {
    let one = check.one_value()?;
    Some((one.expected?, one.tolerance)).filter(|(_, tolerance)| *tolerance > 0.0)
}

/// Refuses a reference that is given twice.
fn check_once(references: &[Reference]) -> Result<(), Refusal> {
    let place = |reference: &Reference| reference.file.canonicalize().ok();
    for (i, reference) in references.iter().enumerate() {
        if references[..i].iter().any(|other| place(other) == place(reference)) {
            return Err(Refusal::new(&reference.file, "", "given twice", "each reference once"));
        }
    }
    Ok(())
}

/// Refuses ids of checks to fit or to weigh that no check has, or several, or one that cannot be fitted.
fn check_ids(references: &[Reference], parameters: &Parameters) -> Result<(), Refusal> {
    let checks = || references.iter().flat_map(|reference| &reference.checks);
    let known: Vec<String> = checks().map(|check| check.id.clone()).collect();
    for (i, id) in parameters.spec.fit.iter().flatten().enumerate() {
        let path = format!("fit[{i}]");
        if !known.contains(id) {
            return Err(Refusal::unknown(&parameters.file, path, id, &known));
        }
        let mut meant = checks().filter(|check| check.id == *id);
        let found = FoundValue::value(id.as_str());
        if meant.clone().count() > 1 {
            let found = found.which("which several references have");
            let allowed = "an id that one reference has";
            return Err(Refusal::new(&parameters.file, path, found, allowed));
        }
        if meant.any(|check| fitted(check).is_none()) {
            let found = found.which("which is no check of one value with a tolerance");
            let allowed = "a value, a mode or a measured value";
            return Err(Refusal::new(&parameters.file, path, found, allowed));
        }
    }
    for id in parameters.spec.weights.keys() {
        if !known.contains(id) {
            let path = format!("weights.{id}");
            return Err(Refusal::unknown_key(&parameters.file, path, id, &known));
        }
    }
    Ok(())
}
