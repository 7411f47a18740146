//! Why a job gave no record: an error of the mechanics as the failure that a record keeps.
//!
//! Knows which error is of which kind, which numbers it has, and which failures a smaller time step may help. Does not know
//! tables.

use super::retry::half_step_may_help;
use pontoon_core::analysis::{AnalysisError, DeadFault};
use pontoon_core::bridge::BridgeError;
use pontoon_core::bridge::LinkPlace;
use pontoon_core::fem::FemError;
use pontoon_core::operator::OperatorError;
use pontoon_plan::job::{Job, TooManySteps};
use pontoon_results::{Failure, FailureKind};

/// Why a job gave no record.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct JobFailure {
    /// What the record keeps.
    pub(super) failure: Failure,
    /// Whether half the time step may help.
    pub(super) half_step_may_help: bool,
}

impl JobFailure {
    /// A fault of the program itself.
    pub(super) fn of_program(what: &str) -> Self {
        Failure::new(FailureKind::ProgramError, format!("program error: {what}")).into()
    }

    /// Puts words before and behind its own.
    pub(super) fn said(self, before: &str, behind: &str) -> Self {
        Self {
            failure: self.failure.said(before, behind),
            ..self
        }
    }

    fn not_prepared(error: &dyn std::error::Error) -> Self {
        Failure::new(FailureKind::NotPrepared, error.to_string()).into()
    }
}

impl From<Failure> for JobFailure {
    fn from(failure: Failure) -> Self {
        Self {
            failure,
            half_step_may_help: false,
        }
    }
}

impl From<AnalysisError> for JobFailure {
    fn from(error: AnalysisError) -> Self {
        Self {
            half_step_may_help: half_step_may_help(&error),
            failure: failure_of(&error),
        }
    }
}

impl From<BridgeError> for JobFailure {
    fn from(error: BridgeError) -> Self {
        match error {
            BridgeError::Fem(error) => error.into(),
            error @ BridgeError::Design(_) => Self::not_prepared(&error),
        }
    }
}

impl From<OperatorError> for JobFailure {
    fn from(error: OperatorError) -> Self {
        match error {
            OperatorError::Factor(error) => error.into(),
            error @ OperatorError::Waves(_) => Self::not_prepared(&error),
        }
    }
}

impl From<FemError> for JobFailure {
    fn from(error: FemError) -> Self {
        let failure = Self::not_prepared(&error);
        match keys_of(&error) {
            Some(keys) => failure.said("", &format!(": look at {keys}")),
            None => failure,
        }
    }
}

/// The keys of a study whose values may have brought an error of the finite elements about.
fn keys_of(error: &FemError) -> Option<&'static str> {
    match error {
        FemError::Eigen { .. } | FemError::BadPair { .. } => Some(
            "bridge.module.material (units: Pa, kg/m^3), the thicknesses of bridge.module (m) and \
             bridge.condensation.fixed_master_modes",
        ),
        FemError::NotPositiveDefinite { .. } | FemError::BadFactor { .. } => Some(
            "bridge.module.material, the thicknesses of bridge.module, bridge.hydrostatic_stiffness_pa_m and bridge.supports",
        ),
        FemError::Degenerate { .. } => Some("the sizes of bridge.module and bridge.module.mesh"),
        FemError::Shift { .. } | FemError::OutOfMemory { .. } | FemError::Stopped => None,
    }
}

/// The failure of a job whose crossing has more time steps than it may; none of another job.
pub(super) fn too_long(job: &Job) -> Option<Failure> {
    let crossing = job.as_crossing()?;
    let checked = crossing.check_steps(crossing.first_time_step_s());
    checked.err().map(too_many_steps)
}

/// The failure of a crossing that may not take so many steps.
pub(super) fn too_many_steps(TooManySteps { steps, limit }: TooManySteps) -> Failure {
    let text = format!("{steps} time steps, the limit is {limit}");
    Failure::new(FailureKind::TooManySteps, text)
        .with("steps", steps as f64)
        .with("limit", limit as f64)
}

/// An error of the mechanics with its numbers.
fn failure_of(error: &AnalysisError) -> Failure {
    let of = |kind| Failure::new(kind, error.to_string());
    match error {
        AnalysisError::NotConverged {
            time_s,
            link,
            bisections,
        } => {
            let failure = of(FailureKind::ContactNotSettled).with("time_s", *time_s);
            let failure = match link {
                Some(LinkPlace::Connector { number, joint, y_m }) => {
                    let failure = failure.with("connector", *number as f64).with("joint", *joint as f64);
                    failure.with("y_m", *y_m)
                }
                Some(LinkPlace::Bank { bank, y_m }) => failure.with("bank", *bank as f64).with("y_m", *y_m),
                None => failure,
            };
            failure.with("bisections", *bisections as f64)
        }
        AnalysisError::StaticNotConverged { iterations, load_x_m } => of(FailureKind::StaticContactNotSettled)
            .with("iterations", *iterations as f64)
            .with("load_x_m", *load_x_m),
        AnalysisError::NoDeadState(fault) => {
            let failure = of(FailureKind::NoDeadState);
            match fault {
                DeadFault::NotSettled { iterations } => failure.with("iterations", *iterations as f64),
                DeadFault::NotHeld => failure,
                DeadFault::Sinks { module, under_m } => {
                    failure.with("module", *module as f64).with("under_m", *under_m)
                }
            }
        }
        AnalysisError::NotFinite { time_s } => of(FailureKind::NotFinite).with("time_s", *time_s),
        AnalysisError::Factor(_) => of(FailureKind::NotPrepared),
        AnalysisError::ModeMissing { searched, .. } => of(FailureKind::ModeMissing).with("searched", *searched as f64),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_of_the_finite_elements_names_the_keys_that_may_have_brought_it_about() {
        let failure = JobFailure::from(BridgeError::Fem(FemError::Eigen {
            asked: 16,
            converged: 0,
        }))
        .failure;
        assert_eq!(failure.kind, FailureKind::NotPrepared);
        assert!(
            failure
                .text
                .starts_with("0 of 16 eigenvalues converged: look at bridge.module.material (units: Pa"),
            "{}",
            failure.text
        );
    }

    #[test]
    fn an_error_keeps_its_kind_its_numbers_and_its_words() {
        let error = AnalysisError::NotFinite { time_s: 1.25 };
        let failure = JobFailure::from(error.clone());
        assert!(failure.half_step_may_help);
        assert_eq!(failure.failure.kind, FailureKind::NotFinite);
        assert_eq!(failure.failure.numbers, [("time_s".to_owned(), 1.25)]);
        assert_eq!(failure.failure.text, error.to_string());
        let said = failure.said("static peak: ", "");
        assert_eq!(said.failure.text, format!("static peak: {error}"));
        let missing = AnalysisError::ModeMissing {
            name: "heave".to_owned(),
            searched: 20,
        };
        assert!(!JobFailure::from(missing).half_step_may_help);
    }
}
