//! What a fit comes to: residuals before and after, parameters with their errors, what the data leave open, the bridge.
//!
//! Knows what a reader wants of a fit. Does not know how it is written down.

use super::candidate::Candidate;
use super::fit::{Bound, Fit, Purpose};
use super::model::CalibrationModel;
use pontoon_core::bridge::{BridgeDesign, Provenance, ProvenanceDocument, ProvenanceHeld, ProvenanceParameter};
use pontoon_plan::input::{Document, to_value};
use serde::Serialize;
use serde_json::Value;

/// A check before and after.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FittedCheck {
    /// Its id.
    pub id: String,
    /// What it expects, in its own unit.
    pub expected: f64,
    /// How far it may be off, in its own unit.
    pub tolerance: f64,
    /// What the start gave.
    pub before: f64,
    /// What the best point gives.
    pub after: f64,
    /// `(before - expected) / tolerance`.
    pub residual_before: f64,
    /// `(after - expected) / tolerance`.
    pub residual_after: f64,
}

/// A parameter after the fit.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Identified {
    /// Its name.
    pub name: String,
    /// Where it started.
    pub start: f64,
    /// What was found.
    pub found: f64,
    /// Its standard error; none where it lies at a bound or the data do not determine it.
    pub standard_error: Option<f64>,
    /// Least value allowed.
    pub lower: f64,
    /// Largest value allowed.
    pub upper: f64,
    /// What is to be said: at a bound, not determined, no derivative.
    pub remark: Option<String>,
}

/// What a calibration comes to.
#[derive(Debug, Clone, Serialize)]
pub struct Calibration {
    /// The checks.
    pub checks: Vec<FittedCheck>,
    /// The parameters.
    pub parameters: Vec<Identified>,
    /// Correlation of the parameters, where both have an error.
    pub correlation: Vec<Vec<Option<f64>>>,
    /// Combinations of parameters that the data do not determine, for people.
    pub undetermined: Vec<String>,
    /// Sum of the squared residuals at the start, each by its weight.
    pub sum_of_squares_start: f64,
    /// Sum of the squared residuals at the best point.
    pub sum_of_squares_best: f64,
    /// Candidates computed.
    pub evaluations: usize,
    /// Modules condensed for them.
    pub condensations: usize,
    /// Whether the search came to its end.
    pub converged: bool,
    /// Why it ended.
    pub ending: String,
    /// Candidates whose model failed, for people.
    pub failed: Vec<String>,
    /// The bridge's document.
    pub bridge: Value,
    /// The bridge.
    #[serde(skip)]
    pub design: BridgeDesign,
}

/// Puts together what a fit found.
pub(super) fn calibration(model: &CalibrationModel<'_>, fit: Fit, best: Candidate) -> Calibration {
    let specs = &model.parameters.spec.parameters;
    let parameters: Vec<Identified> = fit
        .parameters
        .iter()
        .zip(specs)
        .map(|(found, spec)| {
            let remark = match (found.at_bound, found.has_derivative, found.standard_error) {
                (Some(Bound::Lower), ..) => Some("at its lower bound"),
                (Some(Bound::Upper), ..) => Some("at its upper bound"),
                (None, false, _) => Some("no derivative: the model failed on both sides"),
                (None, true, None) => Some("not determined by the data"),
                (None, true, Some(_)) => None,
            };
            Identified {
                name: found.name.clone(),
                start: found.start,
                found: found.best,
                standard_error: found.standard_error,
                lower: spec.lower,
                upper: spec.upper,
                remark: remark.map(str::to_owned),
            }
        })
        .collect();
    let checks = checks(model, &fit);
    let undetermined = fit.undetermined.iter().map(|direction| {
        let parts = direction
            .components
            .iter()
            .map(|c| format!("{:+.2} {}", c.component, specs[c.parameter].name));
        format!("{} (in widths between bounds)", parts.collect::<Vec<_>>().join(" "))
    });
    let failed = fit.failed.iter().map(|point| {
        let at = model.parameters.point(&point.parameters);
        let what = match point.purpose {
            Purpose::Trial => "a step refused".to_owned(),
            Purpose::Difference(k) => format!("a difference over {} not taken", specs[k].name),
        };
        format!("{at}: {}; {what}", point.reason)
    });
    let (undetermined, failed) = (undetermined.collect(), failed.collect());
    let mut design = best.design;
    design.provenance = Some(provenance(model, &fit, &parameters));
    Calibration {
        checks,
        undetermined,
        failed,
        sum_of_squares_start: fit.sum_of_squares_start,
        sum_of_squares_best: fit.sum_of_squares_best,
        evaluations: fit.evaluations,
        condensations: model.condensations(),
        converged: fit.ending.converged(),
        ending: fit.ending.text().to_owned(),
        correlation: fit.correlation,
        parameters,
        bridge: to_value(&design),
        design,
    }
}

fn checks(model: &CalibrationModel<'_>, fit: &Fit) -> Vec<FittedCheck> {
    let fitted = model
        .sources
        .iter()
        .flat_map(|s| s.checks.iter().map(|&i| &s.reference.checks[i]));
    let residuals = fit.residuals_start.iter().zip(&fit.residuals_best);
    fitted
        .zip(residuals)
        .filter_map(|(check, (&before, &after))| {
            let one = check.one_value()?;
            let (expected, tolerance) = (one.expected?, one.tolerance);
            let weight = model.parameters.spec.weights.get(&check.id).copied().unwrap_or(1.0);
            let (before, after) = (before / weight, after / weight);
            Some(FittedCheck {
                id: check.id.clone(),
                expected,
                tolerance,
                before: expected + before * tolerance,
                after: expected + after * tolerance,
                residual_before: before,
                residual_after: after,
            })
        })
        .collect()
}

fn provenance(model: &CalibrationModel<'_>, fit: &Fit, parameters: &[Identified]) -> Provenance {
    let document = |role: &str, name: &str, document: &Document| ProvenanceDocument {
        role: role.to_owned(),
        name: name.to_owned(),
        blake3: document.hash(),
    };
    let mut documents = vec![
        document("start", &model.bridge.design.name, &model.bridge.document),
        document("parameters", "parameters", &model.parameters.document),
    ];
    for source in &model.sources {
        documents.push(document(
            "reference",
            &source.reference.name,
            &Document::from(&source.reference.judged),
        ));
        let computed = Document::from(&source.study.computed());
        documents.push(document("study", &source.study.name, &computed));
    }
    Provenance {
        program: format!("pontoon calibrate {}", pontoon_results::VERSION),
        documents,
        parameters: parameters
            .iter()
            .map(|p| ProvenanceParameter {
                name: p.name.clone(),
                start: p.start,
                found: p.found,
                standard_error: p.standard_error,
                lower: p.lower,
                upper: p.upper,
            })
            .collect(),
        held: model
            .parameters
            .spec
            .hold
            .iter()
            .map(|(name, &held)| ProvenanceHeld {
                name: name.clone(),
                held,
            })
            .collect(),
        checks: fit.residuals_best.len(),
        sum_of_squares_start: fit.sum_of_squares_start,
        sum_of_squares_best: fit.sum_of_squares_best,
        ending: fit.ending.text().to_owned(),
    }
}
