//! Candidates to residuals: each candidate's bridge in place of its studies' own, the jobs that the fitted checks need.
//!
//! Knows which checks are fitted and which jobs they look at. Does not know what moves the parameters.

use super::candidate::Candidate;
use super::parameters::Parameters;
use crate::compare::Judge;
use crate::reference::{CheckKind, CheckSpec, Filter, Quantity, Reference, Role};
use pontoon_plan::input::Refusal;
use pontoon_plan::job::{Job, Jobs};
use pontoon_plan::study_file::{BridgeFile, Study};
use pontoon_results::{JobRecord, Results};
use pontoon_study::run::{PreparedModules, solve_together};
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::{Mutex, PoisonError};

/// What a calibration computes.
pub(super) struct Model<'a> {
    pub(super) bridge: &'a BridgeFile,
    pub(super) parameters: &'a Parameters,
    pub(super) sources: Vec<Source<'a>>,
    told: &'a (dyn Fn(usize, f64) + Sync),
    state: Mutex<State>,
}

/// What a candidate is computed for: each study with its jobs.
type Work = Vec<(Study, Vec<Job>)>;

/// A reference with its study.
pub(super) struct Source<'a> {
    pub(super) reference: &'a Reference,
    pub(super) study: Study,
    /// Numbers of the checks that are fitted.
    pub(super) checks: Vec<usize>,
    /// Filters of all that the checks look at.
    filters: Vec<Filter>,
}

/// What batches leave to those behind them.
struct State {
    modules: PreparedModules,
    candidates: usize,
    condensations: usize,
    least: f64,
    /// What was refused before anything else was asked for: the input is to blame, no candidate.
    refused: Option<Refusal>,
}

impl<'a> Model<'a> {
    pub(super) fn new(
        bridge: &'a BridgeFile,
        references: &'a [Reference],
        parameters: &'a Parameters,
        told: &'a (dyn Fn(usize, f64) + Sync),
    ) -> Result<Self, Refusal> {
        for (i, reference) in references.iter().enumerate() {
            let same = |other: &Reference| other.file.canonicalize().ok() == reference.file.canonicalize().ok();
            if references[..i].iter().any(same) {
                return Err(Refusal::new(&reference.file, "", "given twice", "each reference once"));
            }
        }
        let known: Vec<String> = references
            .iter()
            .flat_map(|r| &r.spec.checks)
            .map(|c| c.id.clone())
            .collect();
        if let Some(ids) = &parameters.spec.fit {
            for (i, id) in ids.iter().enumerate() {
                let key = format!("fit[{i}]");
                if !known.contains(id) {
                    return Err(Refusal::unknown(&parameters.file, key, id, &known));
                }
                let mut meant = references.iter().flat_map(|r| &r.spec.checks).filter(|c| c.id == *id);
                if meant.clone().count() > 1 {
                    let found = format!("'{id}', which several references have");
                    return Err(Refusal::new(
                        &parameters.file,
                        key,
                        found,
                        "an id that one reference has",
                    ));
                }
                if meant.any(|check| !has_value(check)) {
                    let found = format!("'{id}', which is no check of one value with a tolerance");
                    return Err(Refusal::new(
                        &parameters.file,
                        key,
                        found,
                        "a value, a mode or a measured value",
                    ));
                }
            }
        }
        for id in parameters.spec.weights.keys() {
            if !known.contains(id) {
                return Err(Refusal::unknown(&parameters.file, format!("weights.{id}"), id, &known));
            }
        }
        let sources = references
            .iter()
            .map(|r| Source::new(r, parameters))
            .collect::<Result<Vec<_>, Refusal>>()?;
        if sources.iter().all(|source| source.checks.is_empty()) {
            let found = "no check to fit";
            return Err(Refusal::new(
                &parameters.file,
                "fit",
                found,
                "ids of checks of one value with a tolerance",
            ));
        }
        Ok(Self {
            bridge,
            parameters,
            sources,
            told,
            state: Mutex::new(State {
                modules: PreparedModules::default(),
                candidates: 0,
                condensations: 0,
                least: f64::INFINITY,
                refused: None,
            }),
        })
    }

    /// `weight (found - expected) / tolerance` of each fitted check, for each of several candidates, all solved together.
    pub(super) fn residuals(&self, points: &[Vec<f64>]) -> Vec<Result<Vec<f64>, String>> {
        let prepared: Vec<Result<Work, String>> = points
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
        let answers: Vec<Result<Vec<f64>, String>> = prepared
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
    fn told_of(&self, refusal: Refusal) -> String {
        let text = refusal.to_string();
        let mut state = self.lock();
        if state.candidates == 0 {
            state.refused.get_or_insert(refusal);
        }
        text
    }

    /// Modules condensed so far.
    pub(super) fn condensations(&self) -> usize {
        self.lock().condensations
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// For each reference its study with the candidate's bridge, and the jobs that the checks need.
    fn jobs(&self, point: &[f64]) -> Result<Work, Refusal> {
        let candidate = Candidate::new(self.parameters, self.bridge, point)?;
        let of_source = |source: &Source<'_>| {
            let mut study = source.study.clone();
            study.bridge = BridgeFile {
                file: self.bridge.file.clone(),
                document: candidate.document(),
                design: candidate.design.clone(),
            };
            let jobs = Jobs::new(&study).filter(|job| job.as_ref().map_or(true, |job| source.needs(job)));
            let jobs = jobs.collect::<Result<Vec<Job>, Refusal>>()?;
            Ok((study, jobs))
        };
        self.sources.iter().map(of_source).collect()
    }
}

impl<'a> Source<'a> {
    fn new(reference: &'a Reference, parameters: &Parameters) -> Result<Self, Refusal> {
        let Some(path) = reference.study() else {
            let allowed = "the path of the study that gives what its checks look at";
            return Err(Refusal::new(&reference.file, "study", "nothing", allowed));
        };
        let all = reference.spec.checks.iter().enumerate();
        let checks: Vec<usize> = all
            .filter(|(_, check)| match &parameters.spec.fit {
                Some(ids) => ids.contains(&check.id),
                None => check.role == Role::Hold && has_value(check),
            })
            .map(|(i, _)| i)
            .collect();
        let mut filters = Vec::new();
        for &i in &checks {
            let check = &reference.spec.checks[i];
            match check.kind() {
                Some(CheckKind::Value(value)) => collect(&value.of, &check.filter, &mut filters),
                Some(CheckKind::Measured(measured)) => collect(&measured.of, &check.filter, &mut filters),
                _ => filters.push(check.filter.clone()),
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
        let mut axes = self.study.path_axes();
        axes.extend(pontoon_plan::design::SHORT_NAMES.map(str::to_owned));
        let means = |filter: &Filter| {
            let mut of_axes = filter.0.iter().filter(|(name, _)| axes.contains(name));
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
    ) -> Result<Result<Vec<f64>, String>, Refusal> {
        if let Some(record) = records.iter().find(|record| record.reason.is_some()) {
            let reason = record.reason.as_deref().unwrap_or_default();
            return Ok(Err(format!("{}: job {}: {reason}", study.spec.name, record.job)));
        }
        let results = match Results::of_run(study, jobs, records, Path::new("candidate")) {
            Ok(results) => results,
            Err(reason) => return Ok(Err(reason)),
        };
        let judge = Judge::new(&results, self.reference);
        let mut residuals = Vec::new();
        for &i in &self.checks {
            let check = &self.reference.spec.checks[i];
            let (expected, tolerance) = check.expected_and_tolerance().unwrap_or_default();
            match judge.value(i)? {
                Ok(found) => {
                    let weight = weights.get(&check.id).unwrap_or(&1.0);
                    residuals.push(weight * (found - expected) / tolerance);
                }
                Err(reason) => return Ok(Err(format!("{}: {reason}", check.id))),
            }
        }
        Ok(Ok(residuals))
    }
}

/// Whether a check is of one value, with a tolerance above zero to scale it by.
fn has_value(check: &CheckSpec) -> bool {
    check.each.is_empty()
        && check
            .expected_and_tolerance()
            .is_some_and(|(_, tolerance)| tolerance > 0.0)
}

/// The filters of all parts of a quantity.
fn collect(quantity: &Quantity, outer: &Filter, filters: &mut Vec<Filter>) {
    match quantity {
        Quantity::Number(_) => {}
        Quantity::Select(select) => filters.push(select.filter.within(outer)),
        Quantity::History(history) => filters.push(history.filter.within(outer)),
        _ => quantity
            .parts()
            .iter()
            .for_each(|(_, part)| collect(part, outer, filters)),
    }
}
