//! What is asked of the bridge and how it is computed: every number checked, every default filled in.
//!
//! Knows the ranges and defaults of a study's `analysis`, and which keys each kind of it has. Does not know bridges or vehicles.

use super::raw::{AnalysisSpec, AutoSpec, DampingSpec, Kind, ModelSpec, SolverSpec, TimeStepSpec, VerifySpec};
use pontoon_core::input::{InvalidInput, Problem, not_negative, positive, within};

/// What is asked of the bridge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Analysis {
    /// Vehicles cross, once or for a rating.
    Crossing(CrossingAnalysis),
    /// A vehicle stands still.
    Static(StaticAnalysis),
    /// The bridge oscillates by itself, linearly connected.
    Modes(ModesAnalysis),
}

/// How a crossing is computed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CrossingAnalysis {
    /// Whether it is searched for a rating.
    pub is_rating: bool,
    /// Model of the modules.
    pub model: ModelSpec,
    /// Length of the time steps.
    pub time_step: TimeStep,
    /// How long the crossing goes on after the vehicle has left the bridge `[s]`.
    pub tail_s: f64,
    /// Which solver integrates it.
    pub solver: Solver,
    /// Spectral radius of the time integration at infinite frequency.
    pub spectral_radius: f64,
    /// Newton solutions that a step may take before it is halved.
    pub newton_limit: usize,
    /// How often a step may be halved before the job fails.
    pub bisection_limit: usize,
    /// Time steps beyond which the crossing is not run but fails.
    pub step_limit: Option<usize>,
    /// Damping.
    pub damping: DampingSpec,
}

/// Length of a crossing's time steps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TimeStep {
    /// As stated `[s]`.
    Stated(f64),
    /// Each job's own: the coarsest, halved until its peak force changes by no more than a share of itself.
    Auto {
        /// The share.
        tolerance: f64,
    },
}

impl TimeStep {
    /// The coarsest step that a job's own begins with `[s]`.
    pub const COARSEST_S: f64 = 0.02;

    /// The step that a crossing begins with `[s]`: the stated one, or of its own the coarsest that is no longer than the
    /// passage of one module, halved from [`Self::COARSEST_S`].
    pub fn first_s(self, passage_s: f64) -> f64 {
        match self {
            Self::Stated(seconds) => seconds,
            Self::Auto { .. } => {
                let mut step_s = Self::COARSEST_S;
                while step_s > passage_s {
                    step_s *= 0.5;
                }
                step_s
            }
        }
    }

    /// How far a job's peak force may be off for its own time step, as a share of it; none where the step is stated.
    pub fn tolerance(self) -> Option<f64> {
        match self {
            Self::Stated(_) => None,
            Self::Auto { tolerance } => Some(tolerance),
        }
    }
}

/// Which solver integrates a crossing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Solver {
    /// The bridge operator.
    Operator {
        /// The share by which the flexibility of connectors and deck may be off.
        tolerance: f64,
        /// Which jobs the reference solver solves again.
        verify: Option<VerifySpec>,
    },
    /// Direct integration of the assembled bridge.
    Reference,
}

/// How a static case is computed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StaticAnalysis {
    /// Model of the modules.
    pub model: ModelSpec,
}

/// Which modes are asked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModesAnalysis {
    /// Model of the modules.
    pub model: ModelSpec,
    /// How many, from the lowest.
    pub count: usize,
    /// Whether the bridge stands on its supports; else it floats free.
    pub supports: bool,
}

/// The time step of a crossing that states none `[s]`.
const TIME_STEP_S: f64 = 0.01;

impl Analysis {
    /// What a study file asks, checked, with the defaults of its kind.
    ///
    /// # Errors
    /// [`InvalidInput`] with the key relative to `analysis`: a number out of range, a key of another kind.
    pub fn of(written: &AnalysisSpec) -> Result<Self, InvalidInput> {
        let model = written.model;
        match written.kind {
            Kind::Static => {
                let allowed = "only kind and model in a static study";
                has_none_of_crossings(written, allowed)?;
                has_none_of_modes(written, allowed)?;
                Ok(Self::Static(StaticAnalysis { model }))
            }
            Kind::Modes => {
                has_none_of_crossings(written, "only kind, model, count and supports in a study of modes")?;
                let count = written.count.unwrap_or(20);
                whole("count", count, 1, 1000)?;
                let supports = written.supports.unwrap_or(false);
                Ok(Self::Modes(ModesAnalysis { model, count, supports }))
            }
            Kind::Crossing | Kind::Rating => {
                has_none_of_modes(written, "no key of modes in a study of crossings or ratings")?;
                crossing(written).map(Self::Crossing)
            }
        }
    }

    /// The analysis as a study file would write it, every default written out.
    pub fn written(&self) -> AnalysisSpec {
        let nothing = AnalysisSpec {
            kind: self.kind(),
            time_step_s: None,
            time_step_tolerance: None,
            tail_s: None,
            solver: None,
            operator_tolerance: None,
            verify: None,
            model: self.model(),
            spectral_radius: None,
            newton_limit: None,
            bisection_limit: None,
            step_limit: None,
            damping: None,
            count: None,
            supports: None,
        };
        match self {
            Self::Static(_) => nothing,
            Self::Modes(modes) => AnalysisSpec {
                count: Some(modes.count),
                supports: Some(modes.supports),
                ..nothing
            },
            Self::Crossing(crossing) => AnalysisSpec {
                time_step_s: Some(match crossing.time_step {
                    TimeStep::Stated(seconds) => TimeStepSpec::Seconds(seconds),
                    TimeStep::Auto { .. } => TimeStepSpec::Auto(AutoSpec::Auto),
                }),
                time_step_tolerance: crossing.time_step.tolerance(),
                tail_s: Some(crossing.tail_s),
                solver: Some(match crossing.solver {
                    Solver::Operator { .. } => SolverSpec::Operator,
                    Solver::Reference => SolverSpec::Reference,
                }),
                operator_tolerance: match crossing.solver {
                    Solver::Operator { tolerance, .. } => Some(tolerance),
                    Solver::Reference => None,
                },
                verify: crossing.verify(),
                spectral_radius: Some(crossing.spectral_radius),
                newton_limit: Some(crossing.newton_limit),
                bisection_limit: Some(crossing.bisection_limit),
                step_limit: crossing.step_limit,
                damping: Some(crossing.damping),
                ..nothing
            },
        }
    }

    /// What kind it is of.
    pub fn kind(&self) -> Kind {
        match self {
            Self::Crossing(crossing) if crossing.is_rating => Kind::Rating,
            Self::Crossing(_) => Kind::Crossing,
            Self::Static(_) => Kind::Static,
            Self::Modes(_) => Kind::Modes,
        }
    }

    /// Model of the modules.
    pub fn model(&self) -> ModelSpec {
        match self {
            Self::Crossing(crossing) => crossing.model,
            Self::Static(case) => case.model,
            Self::Modes(modes) => modes.model,
        }
    }
}

impl CrossingAnalysis {
    /// Which jobs the reference solver solves again.
    pub fn verify(&self) -> Option<VerifySpec> {
        match self.solver {
            Solver::Operator { verify, .. } => verify,
            Solver::Reference => None,
        }
    }
}

/// Refuses the keys of crossings.
fn has_none_of_crossings(written: &AnalysisSpec, allowed: &str) -> Result<(), InvalidInput> {
    none_of(
        &[
            ("time_step_s", written.time_step_s.is_some()),
            ("time_step_tolerance", written.time_step_tolerance.is_some()),
            ("tail_s", written.tail_s.is_some()),
            ("solver", written.solver.is_some()),
            ("operator_tolerance", written.operator_tolerance.is_some()),
            ("verify", written.verify.is_some()),
            ("spectral_radius", written.spectral_radius.is_some()),
            ("newton_limit", written.newton_limit.is_some()),
            ("bisection_limit", written.bisection_limit.is_some()),
            ("step_limit", written.step_limit.is_some()),
            ("damping", written.damping.is_some()),
        ],
        "a key of crossings",
        allowed,
    )
}

/// Refuses the keys of modes.
fn has_none_of_modes(written: &AnalysisSpec, allowed: &str) -> Result<(), InvalidInput> {
    let keys = [
        ("count", written.count.is_some()),
        ("supports", written.supports.is_some()),
    ];
    none_of(&keys, "a key of modes", allowed)
}

fn crossing(written: &AnalysisSpec) -> Result<CrossingAnalysis, InvalidInput> {
    let time_step = time_step(written)?;
    let solver = solver(written, time_step)?;
    let is_rating = written.kind == Kind::Rating;
    let verified = [("verify", is_rating && written.verify.is_some())];
    none_of(
        &verified,
        "a verification",
        "none in a study of ratings: the reference solver rates too",
    )?;
    let tail_s = not_negative("tail_s", written.tail_s.unwrap_or(6.0))?;
    let spectral_radius = within("spectral_radius", written.spectral_radius.unwrap_or(0.9), 0.0, 1.0)?;
    let newton_limit = whole("newton_limit", written.newton_limit.unwrap_or(30), 1, 1000)?;
    let bisection_limit = whole("bisection_limit", written.bisection_limit.unwrap_or(8), 0, 12)?;
    let step_limit = written
        .step_limit
        .map(|limit| whole("step_limit", limit, 1, 10_000_000));
    let damping = written.damping.unwrap_or_default().filled();
    if let Some(of) = damping.structure {
        let beside = [
            ("ratio", damping.ratio.is_some()),
            ("frequencies_hz", damping.frequencies_hz.is_some()),
        ];
        if let Some((key, _)) = beside.into_iter().find(|(_, given)| *given) {
            let allowed = "nothing beside damping.structure";
            return Err(InvalidInput::new(format!("damping.{key}"), "a value", allowed).because(Problem::Misplaced));
        }
        within("damping.structure.ratio", of.ratio, 0.0, 0.99)?;
        // further off the ratio at the bridge's own frequencies, 0.3 to 30 Hz, is none
        within("damping.structure.at_hz", of.at_hz, 0.01, 1000.0)?;
    }
    within("damping.ratio", damping.rayleigh_ratio(), 0.0, 0.99)?;
    if let Some([first, second]) = damping.frequencies_hz {
        positive("damping.frequencies_hz[0]", first)?;
        if !(second.is_finite() && second > first) {
            let allowed = format!("above {first}");
            return Err(InvalidInput::new("damping.frequencies_hz[1]", second, allowed));
        }
    }
    Ok(CrossingAnalysis {
        is_rating,
        model: written.model,
        time_step,
        tail_s,
        solver,
        spectral_radius,
        newton_limit,
        bisection_limit,
        step_limit: step_limit.transpose()?,
        damping,
    })
}

fn time_step(written: &AnalysisSpec) -> Result<TimeStep, InvalidInput> {
    match (written.time_step_s, written.time_step_tolerance) {
        (Some(TimeStepSpec::Auto(_)), tolerance) => {
            let tolerance = positive("time_step_tolerance", tolerance.unwrap_or(0.02))?;
            within("time_step_tolerance", tolerance, 0.0, 0.5)?;
            Ok(TimeStep::Auto { tolerance })
        }
        (stated, tolerance) => {
            let seconds = match stated {
                Some(TimeStepSpec::Seconds(seconds)) => seconds,
                _ => TIME_STEP_S,
            };
            positive("time_step_s", seconds)?;
            match tolerance {
                None => Ok(TimeStep::Stated(seconds)),
                Some(tolerance) => {
                    let allowed = "no tolerance where time_step_s is a number";
                    let refused = InvalidInput::new("time_step_tolerance", tolerance, allowed);
                    Err(refused.because(Problem::Misplaced))
                }
            }
        }
    }
}

fn solver(written: &AnalysisSpec, time_step: TimeStep) -> Result<Solver, InvalidInput> {
    match written.solver.unwrap_or_default() {
        SolverSpec::Reference => {
            let of_operator = [
                ("operator_tolerance", written.operator_tolerance.is_some()),
                ("verify", written.verify.is_some()),
                ("time_step_s", time_step.tolerance().is_some()),
            ];
            none_of(&of_operator, "a key of the operator", "solver: operator")?;
            Ok(Solver::Reference)
        }
        SolverSpec::Operator => {
            let tolerance = written.operator_tolerance.unwrap_or(6e-4);
            within("operator_tolerance", tolerance, 0.0, 0.1)?;
            if let Some(verify) = written.verify {
                positive("verify.share", verify.share)?;
                within("verify.share", verify.share, 0.0, 1.0)?;
                not_negative("verify.deflection_tolerance", verify.deflection_tolerance)?;
                not_negative("verify.compression_tolerance", verify.compression_tolerance)?;
                not_negative("verify.tension_tolerance", verify.tension_tolerance)?;
            }
            let verify = written.verify;
            Ok(Solver::Operator { tolerance, verify })
        }
    }
}

/// Refuses the first of some keys that is given.
fn none_of(keys: &[(&str, bool)], found: &str, allowed: &str) -> Result<(), InvalidInput> {
    match keys.iter().find(|(_, given)| *given) {
        Some((key, _)) => Err(InvalidInput::new(*key, found, allowed).because(Problem::Misplaced)),
        None => Ok(()),
    }
}

fn whole(key: &str, value: usize, from: usize, to: usize) -> Result<usize, InvalidInput> {
    if (from..=to).contains(&value) {
        return Ok(value);
    }
    let allowed = format!("a whole number from {from} to {to}");
    Err(InvalidInput::new(key, value, allowed))
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn checked(value: serde_json::Value) -> Result<AnalysisSpec, InvalidInput> {
        let analysis = Analysis::of(&serde_json::from_value(value).unwrap())?;
        // what is written out is read as the same
        assert_eq!(Analysis::of(&analysis.written()).unwrap(), analysis);
        Ok(analysis.written())
    }

    #[test]
    fn a_crossing_gets_its_defaults() {
        let spec = checked(json!({"kind": "crossing"})).unwrap();
        assert_eq!(
            (spec.time_step_s, spec.tail_s, spec.spectral_radius),
            (Some(TimeStepSpec::Seconds(0.01)), Some(6.0), Some(0.9))
        );
        assert_eq!(
            (spec.solver, spec.operator_tolerance),
            (Some(SolverSpec::Operator), Some(6e-4))
        );
        assert_eq!(spec.model, ModelSpec::SuperElement);
        assert_eq!(
            spec.damping,
            Some(DampingSpec {
                ratio: Some(0.05),
                ..DampingSpec::default()
            })
        );
    }

    #[test]
    fn a_static_study_refuses_the_keys_of_crossings() {
        for key in ["time_step_s", "tail_s", "spectral_radius"] {
            assert_eq!(checked(json!({"kind": "static", key: 0.5})).unwrap_err().key, key);
        }
        assert!(checked(json!({"kind": "static", "model": "full"})).is_ok());
    }

    #[test]
    fn a_study_of_modes_gets_its_defaults_and_refuses_the_keys_of_crossings() {
        let spec = checked(json!({"kind": "modes"})).unwrap();
        assert_eq!(
            (spec.count, spec.supports, spec.time_step_s),
            (Some(20), Some(false), None)
        );
        assert_eq!(
            checked(json!({"kind": "modes", "tail_s": 1})).unwrap_err().key,
            "tail_s"
        );
        assert_eq!(checked(json!({"kind": "modes", "count": 0})).unwrap_err().key, "count");
        for kind in ["static", "crossing"] {
            assert_eq!(checked(json!({"kind": kind, "count": 5})).unwrap_err().key, "count");
        }
    }

    #[test]
    fn numbers_out_of_range_are_refused_by_key() {
        for (key, value) in [("time_step_s", 0.0), ("tail_s", -1.0), ("spectral_radius", 1.1)] {
            assert_eq!(checked(json!({"kind": "crossing", key: value})).unwrap_err().key, key);
        }
        let damping = |d| checked(json!({"kind": "crossing", "damping": d})).unwrap_err().key;
        assert_eq!(damping(json!({"ratio": -0.1})), "damping.ratio");
        assert_eq!(
            damping(json!({"frequencies_hz": [0.4, 0.3]})),
            "damping.frequencies_hz[1]"
        );
    }

    #[test]
    fn keys_of_the_operator_have_no_place_with_the_reference_solver() {
        for (key, value) in [
            ("operator_tolerance", json!(1e-3)),
            ("verify", json!({"share": 0.1})),
            ("time_step_s", json!("auto")),
        ] {
            let e = checked(json!({"kind": "crossing", "solver": "reference", key: value})).unwrap_err();
            assert_eq!((e.key.as_str(), e.problem), (key, Problem::Misplaced), "{e}");
        }
        let of = |value| Analysis::of(&serde_json::from_value(value).unwrap()).unwrap();
        let Analysis::Crossing(crossing) = of(json!({"kind": "crossing", "time_step_s": "auto"})) else {
            panic!()
        };
        assert_eq!(
            (crossing.time_step.first_s(1.0), crossing.time_step.tolerance()),
            (TimeStep::COARSEST_S, Some(0.02))
        );
    }
}
