//! The operator that judges crossings of which a rating's own operator is not sure.
//!
//! Knows which jobs have one. Does not know what is prepared or tried.

use pontoon_core::connector::Connection;
use pontoon_core::vehicle::Inertia;
use pontoon_plan::job::Job;
use pontoon_plan::study_file::{CrossingAnalysis, Solver};

/// Its tolerance.
pub(super) const FINER_TOLERANCE: f64 = 1e-4;

/// The operator that judges a rating's crossings; none where the study's own is as fine, and where a rating needs no search.
pub(super) fn finer_operator(job: &Job) -> Option<Solver> {
    let crossing = job.as_crossing().filter(|_| job.rating.is_some())?;
    let vehicle = &job.shared.vehicle.vehicle;
    let in_proportion =
        job.connection == Connection::Linear && vehicle.inertia == Inertia::None && vehicle.springs.is_none();
    let is_finer = crossing.operator_tolerance()? > FINER_TOLERANCE;
    (is_finer && !in_proportion).then_some(Solver::Operator {
        tolerance: FINER_TOLERANCE,
        verify: None,
    })
}

/// The analysis of a rating's crossings by that operator.
pub(super) fn finer_analysis(job: &Job) -> Option<CrossingAnalysis> {
    let solver = finer_operator(job)?;
    let crossing = job.as_crossing()?;
    Some(CrossingAnalysis {
        solver,
        ..*crossing.analysis
    })
}
