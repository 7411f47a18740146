//! A crossing whose answer is known, solved at the start of a sweep: a self-test of the machine.
//!
//! Knows one small bridge, one crossing of it and what both solvers answer where arithmetic is sound. Does not know studies:
//! what it tells is about processor, compiler and libraries, and nothing about anybody's bridge.
//!
//! All that a sweep rests on takes part: shells and beams, condensation with fixed-master modes by Lanczos, the operator with
//! what its modes leave out, lanes on this machine's instructions, contacts that open and close, masses that ride along, and
//! the reference solver's factors beside them.

use pontoon_core::analysis::AnalysisError;
use pontoon_core::analysis::crossing::{Crossing, CrossingSettings, CrossingSolver, OperatorSolver};
use pontoon_core::analysis::modes::rayleigh;
use pontoon_core::bridge::{Bridge, BridgeDesign, BridgeError, Ends, Model, PreparedModule};
use pontoon_core::connector::{Connection, OwnLaws};
use pontoon_core::input::InvalidInput;
use pontoon_core::operator::{BridgeOperator, OperatorError};
use pontoon_core::response::{CrossingResponse, Record};
use pontoon_core::traffic::Traffic;
use pontoon_core::vehicle::{Inertia, VehicleDesign};
use pontoon_journal::fault;
use std::fmt;
use std::sync::Arc;
use thiserror::Error;

/// Relative difference from the known answer that is allowed.
///
/// Not zero: lanes step with the same bits on every machine, but the modes, flexibilities and factors that they step with are
/// made by a library that orders and fuses its sums as the processor likes best, and the reference solver rests on them at
/// every step. What rounding of their last digits moves in the answers was measured by stiffnesses of the plates that differ
/// by 1e-13 to 1e-11: at most 1.4e-11. One wrong operation moves far more than this.
pub const TOLERANCE: f64 = 1e-9;

/// Crossings side by side, so that every lane of the widest vectors has one.
const LANES: usize = 8;

/// Why a sweep should not be begun on this machine.
#[derive(Debug, Error)]
pub enum SelfTestError {
    /// A number is not what it is known to be.
    #[error(
        "arithmetic is not sound here: of a crossing whose answer is known, {quantity} by the {solver}: expected \
         {expected:?}, found {found:?}, tolerance {tolerance:e} of it"
    )]
    Off {
        /// Which solver.
        solver: TestedSolver,
        /// Which number.
        quantity: &'static str,
        /// What is known `[m, N, 1]`.
        expected: f64,
        /// What was found.
        found: f64,
        /// Relative difference allowed.
        tolerance: f64,
    },
    /// The bridge's document was not read.
    #[error("the known crossing's bridge was not read: {0}")]
    Document(#[from] serde_json::Error),
    /// The vehicle was refused.
    #[error("the known crossing's vehicle was refused: {0}")]
    Vehicle(#[from] InvalidInput),
    /// The bridge was not built.
    #[error("the known crossing's bridge was not built: {0}")]
    Bridge(#[from] BridgeError),
    /// It has no operator.
    #[error("the known crossing's bridge has no operator: {0}")]
    Operator(#[from] OperatorError),
    /// A solver gave no answer.
    #[error("the known crossing was not solved: {0}")]
    Crossing(#[from] AnalysisError),
}

/// A solver.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TestedSolver {
    /// The bridge operator.
    Operator,
    /// The reference solver.
    Reference,
}

impl fmt::Display for TestedSolver {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Operator => "operator",
            Self::Reference => "reference solver",
        })
    }
}

/// What is compared of an answer.
#[derive(Debug, Clone, Copy, PartialEq)]
struct SelfTestAnswer {
    deflection_m: f64,
    uplift_m: f64,
    compression_n: f64,
    tension_n: f64,
    contact_switches: usize,
}

/// The known answer of a solver, as it was found where the two agree within what the operator leaves out, 2e-3. Whoever
/// changes mechanics on purpose writes down what the error then names.
fn known(solver: TestedSolver) -> SelfTestAnswer {
    match solver {
        TestedSolver::Operator => SelfTestAnswer {
            deflection_m: 0.097_162_533_555_537_67,
            uplift_m: 0.030_493_021_414_378_51,
            compression_n: 373_692.382_752_154_14,
            tension_n: 112_348.502_104_914_22,
            contact_switches: 20,
        },
        TestedSolver::Reference => SelfTestAnswer {
            deflection_m: 0.097_156_327_905_228_75,
            uplift_m: 0.030_488_031_788_756_677,
            compression_n: 373_703.882_951_675_16,
            tension_n: 112_278.182_500_843_82,
            contact_switches: 20,
        },
    }
}

/// Solves the crossing by both solvers, by the operator in every lane, and holds the answers against what is known of them:
/// some 23 ms.
///
/// # Errors
/// [`SelfTestError::Off`] with the first number that is not as known; any other where there is no number at all.
pub fn run() -> Result<(), SelfTestError> {
    let mut answers = SelfTestCrossing::known()?.solved()?;
    if fault::at("canary").is_err() {
        answers.iter_mut().for_each(|(_, answer)| answer.deflection_m *= 1.05);
    }
    answers.iter().try_for_each(|(solver, answer)| judge(*solver, answer))
}

fn judge(solver: TestedSolver, answer: &SelfTestAnswer) -> Result<(), SelfTestError> {
    let known = known(solver);
    let switches = |answer: &SelfTestAnswer| answer.contact_switches as f64;
    for (quantity, expected, found, tolerance) in [
        (
            "peak deflection [m]",
            known.deflection_m,
            answer.deflection_m,
            TOLERANCE,
        ),
        ("peak uplift [m]", known.uplift_m, answer.uplift_m, TOLERANCE),
        (
            "peak compression [N]",
            known.compression_n,
            answer.compression_n,
            TOLERANCE,
        ),
        ("peak tension [N]", known.tension_n, answer.tension_n, TOLERANCE),
        ("contact switches", switches(&known), switches(answer), 0.0),
    ] {
        let holds = (found - expected).abs() <= tolerance * expected;
        if !holds {
            return Err(SelfTestError::Off {
                solver,
                quantity,
                expected,
                found,
                tolerance,
            });
        }
    }
    Ok(())
}

/// The bridge and the numbers of the crossing that may be asked for otherwise.
#[derive(Debug, Clone)]
struct SelfTestCrossing {
    design: BridgeDesign,
    load_n: f64,
    time_step_s: f64,
}

impl SelfTestCrossing {
    fn known() -> Result<Self, serde_json::Error> {
        Ok(Self {
            design: serde_json::from_str(include_str!("self_test.json"))?,
            load_n: 90e3,
            time_step_s: 0.02,
        })
    }

    /// The answers of the operator's lanes and of the reference solver.
    fn solved(&self) -> Result<Vec<(TestedSolver, SelfTestAnswer)>, SelfTestError> {
        let design = &self.design;
        let module = PreparedModule::new(design, Model::SuperElement)?;
        let bridge = Arc::new(Bridge::new(design, &module, Ends::Supported)?);
        // beside the centre line, so that the bridge rolls
        let vehicle = VehicleDesign {
            footprint_length_m: Some(2.5),
            track_y_m: Some(vec![-0.6, 1.4]),
            inertia: Inertia::Local,
            patch_points: 4,
            ..VehicleDesign::default()
        };
        let vehicle = vehicle.check(design.module.breadth_m)?;
        let connectors = &design.connectors;
        let crossing = Crossing {
            connection: Connection::Nonlinear {
                gap_tension_m: connectors.gap_tension_m,
                gap_compression_m: connectors.gap_compression_m,
            },
            connector_stiffness_n_m: connectors.stiffness_n_m,
            own_laws: OwnLaws::default(),
            tail_s: 0.5,
            record: Record::default(),
            dead: None,
        };
        let settings = CrossingSettings {
            time_step_s: self.time_step_s,
            spectral_radius: 0.9,
            rayleigh: rayleigh(0.05, [0.5, 0.8]),
            newton_limit: 40,
            bisection_limit: 4,
        };
        let operator = Arc::new(BridgeOperator::new(&bridge, 6e-4)?);
        let operated = OperatorSolver::new(&bridge, &operator, &settings);
        let traffic = Traffic::single(&vehicle, self.load_n, 9.0);
        let mut answers = Vec::new();
        for response in operated.solve_all(&[(&traffic, &crossing); LANES], 0) {
            answers.push((TestedSolver::Operator, SelfTestAnswer::of(&response?)));
        }
        let reference = CrossingSolver::new(&bridge, &settings)?;
        answers.push((
            TestedSolver::Reference,
            SelfTestAnswer::of(&reference.solve(&traffic, &crossing)?),
        ));
        Ok(answers)
    }
}

impl SelfTestAnswer {
    fn of(response: &CrossingResponse) -> Self {
        let joints = || response.joints.iter().map(|joint| joint.sum);
        Self {
            deflection_m: response.peak_deflection().deflection.value,
            uplift_m: response.peak_uplift().uplift.value,
            compression_n: joints().map(|force| force.compression.value).fold(0.0, f64::max),
            tension_n: joints().map(|force| force.tension.value).fold(0.0, f64::max),
            contact_switches: response.statistics.contact_switches,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn changed(change: impl FnOnce(&mut SelfTestCrossing)) -> Vec<(TestedSolver, SelfTestAnswer)> {
        let mut piece = SelfTestCrossing::known().unwrap();
        change(&mut piece);
        piece.solved().unwrap()
    }

    /// The relative differences of two answers.
    fn apart(a: &SelfTestAnswer, b: &SelfTestAnswer) -> [f64; 4] {
        let numbers = |s: &SelfTestAnswer| [s.deflection_m, s.uplift_m, s.compression_n, s.tension_n];
        let (a, b) = (numbers(a), numbers(b));
        std::array::from_fn(|i| (a[i] / b[i] - 1.0).abs())
    }

    #[test]
    fn answers_are_as_known() {
        run().unwrap();
    }

    /// Each number of bridge and crossing that is 5 % wrong is heard by both solvers, in every lane.
    #[test]
    fn a_coefficient_5_percent_wrong_is_heard() {
        for (name, answers) in [
            ("trusses", changed(|p| p.design.connectors.stiffness_n_m *= 1.05)),
            (
                "water",
                changed(|p| *p.design.hydrostatic_stiffness_pa_m.as_mut().unwrap() *= 1.05),
            ),
            ("load", changed(|p| p.load_n *= 1.05)),
            ("time step", changed(|p| p.time_step_s *= 1.05)),
        ] {
            assert_eq!(answers.len(), LANES + 1, "{name}");
            for (solver, answer) in &answers {
                let told = judge(*solver, answer).unwrap_err();
                assert!(
                    matches!(told, SelfTestError::Off { solver: of, .. } if of == *solver),
                    "{name}: {told}"
                );
            }
        }
    }

    /// What the tolerance is for: rounding moves the answers by a twentieth of it at most, measured 1.4e-11. Twin: a stiffness
    /// that is wrong by 1e-7. The number of switches is the same for both, far from its next value.
    #[test]
    fn rounding_is_not_heard() {
        let with_e = |by: f64| changed(|p| p.design.module.material.youngs_modulus_pa *= 1.0 + by);
        for by in [-1e-13, 1e-13, 1e-12, 1e-11] {
            for (solver, answer) in &with_e(by) {
                let moved = apart(answer, &known(*solver));
                assert!(moved.iter().all(|m| *m < 0.05 * TOLERANCE), "{solver}: {moved:?}");
                judge(*solver, answer).unwrap();
            }
        }
        for (solver, answer) in &with_e(1e-7) {
            assert!(judge(*solver, answer).is_err(), "{answer:?}");
            assert_eq!(answer.contact_switches, known(*solver).contact_switches);
        }
    }

    #[test]
    fn solvers_differ_by_what_the_operator_leaves_out() {
        let apart = apart(&known(TestedSolver::Operator), &known(TestedSolver::Reference));
        assert!(
            apart.iter().all(|by| *by < 2e-3) && apart.iter().any(|by| *by > TOLERANCE),
            "{apart:?}"
        );
    }

    #[test]
    fn the_error_names_what_was_off() {
        let mut answer = known(TestedSolver::Operator);
        answer.tension_n *= 1.0 + 2e-9;
        let told = judge(TestedSolver::Operator, &answer).unwrap_err().to_string();
        for part in ["operator", "peak tension [N]", "tolerance 1e-9"] {
            assert!(told.contains(part), "{told}");
        }
        answer.tension_n = f64::NAN;
        assert!(judge(TestedSolver::Operator, &answer).is_err());
    }
}
