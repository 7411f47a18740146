//! A crossing whose answer is known, solved at the start of a sweep: a canary for the machine.
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
use pontoon_core::connector::Connection;
use pontoon_core::input::InvalidInput;
use pontoon_core::operator::{BridgeOperator, OperatorError};
use pontoon_core::response::{CrossingResponse, Record};
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
pub enum CanaryError {
    /// A number is not what it is known to be.
    #[error(
        "arithmetic is not sound here: of a crossing whose answer is known, {quantity} by the {solver}: expected \
         {expected:?}, found {found:?}, tolerance {tolerance:e} of it"
    )]
    Off {
        /// Which solver.
        solver: Singer,
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
pub enum Singer {
    /// The bridge operator.
    Operator,
    /// The reference solver.
    Reference,
}

impl fmt::Display for Singer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Operator => "operator",
            Self::Reference => "reference solver",
        })
    }
}

/// What is compared of an answer.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Song {
    deflection_m: f64,
    uplift_m: f64,
    compression_n: f64,
    tension_n: f64,
    contact_switches: usize,
}

/// The known answer of a solver, as it was found where the two agree within what the operator leaves out, 2e-3. Whoever
/// changes mechanics on purpose writes down what the error then names.
fn known(solver: Singer) -> Song {
    match solver {
        Singer::Operator => Song {
            deflection_m: 0.097_162_533_555_537_67,
            uplift_m: 0.030_493_021_414_378_51,
            compression_n: 373_692.382_752_154_14,
            tension_n: 112_348.502_104_914_22,
            contact_switches: 20,
        },
        Singer::Reference => Song {
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
/// [`CanaryError::Off`] with the first number that is not as known; any other where there is no number at all.
pub fn sing() -> Result<(), CanaryError> {
    let mut sung = Piece::known()?.sung()?;
    if fault::at("canary").is_err() {
        sung.iter_mut().for_each(|(_, song)| song.deflection_m *= 1.05);
    }
    sung.iter().try_for_each(|(solver, song)| judge(*solver, song))
}

fn judge(solver: Singer, song: &Song) -> Result<(), CanaryError> {
    let known = known(solver);
    let switches = |song: &Song| song.contact_switches as f64;
    for (quantity, expected, found, tolerance) in [
        ("peak deflection [m]", known.deflection_m, song.deflection_m, TOLERANCE),
        ("peak uplift [m]", known.uplift_m, song.uplift_m, TOLERANCE),
        (
            "peak compression [N]",
            known.compression_n,
            song.compression_n,
            TOLERANCE,
        ),
        ("peak tension [N]", known.tension_n, song.tension_n, TOLERANCE),
        ("contact switches", switches(&known), switches(song), 0.0),
    ] {
        let holds = (found - expected).abs() <= tolerance * expected;
        if !holds {
            return Err(CanaryError::Off {
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
struct Piece {
    design: BridgeDesign,
    load_n: f64,
    time_step_s: f64,
}

impl Piece {
    fn known() -> Result<Self, serde_json::Error> {
        Ok(Self {
            design: serde_json::from_str(include_str!("canary.json"))?,
            load_n: 90e3,
            time_step_s: 0.02,
        })
    }

    /// The answers of the operator's lanes and of the reference solver.
    fn sung(&self) -> Result<Vec<(Singer, Song)>, CanaryError> {
        let design = &self.design;
        let module = PreparedModule::new(design, Model::SuperElement)?;
        let bridge = Arc::new(Bridge::new(design, &module, Ends::Supported)?);
        // beside the centre line, so that the bridge rolls
        let vehicle = VehicleDesign {
            footprint_length_m: Some(2.5),
            track_y_m: Some(vec![-0.6, 1.4]),
            inertia: Inertia::Local,
            patch_points: 4,
            axles: None,
        };
        let vehicle = vehicle.check(design.module.breadth_m)?;
        let connectors = &design.connectors;
        let crossing = Crossing {
            connection: Connection::Nonlinear {
                gap_tension_m: connectors.gap_tension_m,
                gap_compression_m: connectors.gap_compression_m,
            },
            connector_stiffness_n_m: connectors.stiffness_n_m,
            load_n: self.load_n,
            speed_m_s: 9.0,
            tail_s: 0.5,
            record: Record::default(),
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
        let mut sung = Vec::new();
        for response in operated.solve_all(&[(&vehicle, &crossing); LANES], 0) {
            sung.push((Singer::Operator, Song::of(&response?)));
        }
        let reference = CrossingSolver::new(&bridge, &settings)?;
        sung.push((Singer::Reference, Song::of(&reference.solve(&vehicle, &crossing)?)));
        Ok(sung)
    }
}

impl Song {
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

    fn changed(change: impl FnOnce(&mut Piece)) -> Vec<(Singer, Song)> {
        let mut piece = Piece::known().unwrap();
        change(&mut piece);
        piece.sung().unwrap()
    }

    /// The relative differences of two answers.
    fn apart(a: &Song, b: &Song) -> [f64; 4] {
        let numbers = |s: &Song| [s.deflection_m, s.uplift_m, s.compression_n, s.tension_n];
        let (a, b) = (numbers(a), numbers(b));
        std::array::from_fn(|i| (a[i] / b[i] - 1.0).abs())
    }

    #[test]
    fn it_sings() {
        sing().unwrap();
    }

    /// Each number of bridge and crossing that is 5 % wrong is heard by both solvers, in every lane.
    #[test]
    fn a_coefficient_5_percent_wrong_is_heard() {
        for (name, sung) in [
            ("trusses", changed(|p| p.design.connectors.stiffness_n_m *= 1.05)),
            (
                "water",
                changed(|p| *p.design.hydrostatic_stiffness_pa_m.as_mut().unwrap() *= 1.05),
            ),
            ("load", changed(|p| p.load_n *= 1.05)),
            ("time step", changed(|p| p.time_step_s *= 1.05)),
        ] {
            assert_eq!(sung.len(), LANES + 1, "{name}");
            for (solver, song) in &sung {
                let told = judge(*solver, song).unwrap_err();
                assert!(
                    matches!(told, CanaryError::Off { solver: of, .. } if of == *solver),
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
            for (solver, song) in &with_e(by) {
                let moved = apart(song, &known(*solver));
                assert!(moved.iter().all(|m| *m < 0.05 * TOLERANCE), "{solver}: {moved:?}");
                judge(*solver, song).unwrap();
            }
        }
        for (solver, song) in &with_e(1e-7) {
            assert!(judge(*solver, song).is_err(), "{song:?}");
            assert_eq!(song.contact_switches, known(*solver).contact_switches);
        }
    }

    #[test]
    fn solvers_differ_by_what_the_operator_leaves_out() {
        let apart = apart(&known(Singer::Operator), &known(Singer::Reference));
        assert!(
            apart.iter().all(|by| *by < 2e-3) && apart.iter().any(|by| *by > TOLERANCE),
            "{apart:?}"
        );
    }

    #[test]
    fn the_error_names_what_was_off() {
        let mut song = known(Singer::Operator);
        song.tension_n *= 1.0 + 2e-9;
        let told = judge(Singer::Operator, &song).unwrap_err().to_string();
        for part in ["operator", "peak tension [N]", "tolerance 1e-9"] {
            assert!(told.contains(part), "{told}");
        }
        song.tension_n = f64::NAN;
        assert!(judge(Singer::Operator, &song).is_err());
    }
}
