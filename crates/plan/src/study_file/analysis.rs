//! The `analysis` of a study.
//!
//! Knows its keys, their defaults and ranges. Does not know bridges or vehicles.

use pontoon_core::bridge::Model;
use pontoon_core::input::{InvalidInput, not_negative, positive, within};
use schemars::JsonSchema;
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize};

/// What is asked of the bridge.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// A vehicle crosses at constant speed.
    Crossing,
    /// A vehicle stands still.
    Static,
    /// The bridge oscillates by itself, linearly connected: natural frequencies and the names of their shapes.
    Modes,
}

/// Which solver integrates a crossing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SolverSpec {
    /// The bridge operator: modes, residual flexibilities and a small piecewise-linear system, many crossings at once.
    #[default]
    Operator,
    /// Direct integration of the assembled bridge, the operator's judge.
    Reference,
}

/// Length of a crossing's steps.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum TimeStepSpec {
    /// As stated `[s]`.
    Seconds(f64),
    /// Each job's own: 0.02 s, halved as often as its peak force asks for.
    Auto(AutoSpec),
}

/// The word that leaves the time step to the program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum AutoSpec {
    /// Follow an error estimate.
    Auto,
}

impl TimeStepSpec {
    /// The coarsest step that "auto" begins with `[s]`.
    pub const COARSEST_S: f64 = 0.02;

    /// The step, the coarsest of "auto" `[s]`.
    pub fn seconds(self) -> f64 {
        match self {
            Self::Seconds(seconds) => seconds,
            Self::Auto(_) => Self::COARSEST_S,
        }
    }
}

/// The reference solver as judge of the operator: which share of the jobs it solves again, and how far the operator may be
/// off.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct VerifySpec {
    /// Share of the jobs, above 0 to 1: the first and then evenly one in `1 / share`.
    #[schemars(range(max = 1.0), extend("exclusiveMinimum" = 0.0))]
    pub share: f64,
    /// How far the largest deflection may be off, as a share of the reference solver's.
    #[serde(default = "default_deflection_tolerance")]
    #[schemars(range(min = 0.0))]
    pub deflection_tolerance: f64,
    /// How far the largest compression may be off, as a share of the job's largest joint force.
    #[serde(default = "default_compression_tolerance")]
    #[schemars(range(min = 0.0))]
    pub compression_tolerance: f64,
    /// How far the largest tension may be off, on the same scale.
    #[serde(default = "default_tension_tolerance")]
    #[schemars(range(min = 0.0))]
    pub tension_tolerance: f64,
}

fn default_deflection_tolerance() -> f64 {
    0.005
}

fn default_compression_tolerance() -> f64 {
    0.02
}

fn default_tension_tolerance() -> f64 {
    0.1
}

impl VerifySpec {
    /// Whether a job is one of those that are solved again.
    pub fn takes(&self, job: usize) -> bool {
        let before = |n: usize| (n as f64 * self.share).floor();
        job == 0 || before(job) > before(job - 1)
    }
}

/// Which matrices a module contributes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ModelSpec {
    /// Every degree of freedom of the shells and beams.
    Full,
    /// The condensed module.
    #[default]
    SuperElement,
}

impl From<ModelSpec> for Model {
    fn from(model: ModelSpec) -> Self {
        match model {
            ModelSpec::Full => Self::Full,
            ModelSpec::SuperElement => Self::SuperElement,
        }
    }
}

/// Rayleigh damping.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DampingSpec {
    /// Ratio of critical damping at both frequencies.
    #[serde(default = "default_ratio")]
    #[schemars(range(min = 0.0, max = 0.99))]
    pub ratio: f64,
    /// The two frequencies, increasing `[Hz]`; absent: the first two vertical bending modes of the job's own bridge,
    /// linearly connected and floating free.
    #[serde(default, deserialize_with = "pair", skip_serializing_if = "Option::is_none")]
    pub frequencies_hz: Option<[f64; 2]>,
}

/// Two numbers or nothing; a list of another length is told as such.
fn pair<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<[f64; 2]>, D::Error> {
    let list: Option<Vec<f64>> = Option::deserialize(deserializer)?;
    let to_pair = |list: Vec<f64>| {
        let wrong = D::Error::invalid_length(list.len(), &"a list of two numbers");
        <[f64; 2]>::try_from(list).map_err(|_| wrong)
    };
    list.map(to_pair).transpose()
}

fn default_ratio() -> f64 {
    0.05
}

impl Default for DampingSpec {
    fn default() -> Self {
        Self {
            ratio: default_ratio(),
            frequencies_hz: None,
        }
    }
}

/// What is asked and how it is computed. The keys of a crossing have no place in a study of another kind, nor have those of
/// modes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AnalysisSpec {
    /// What is asked of the bridge.
    pub kind: Kind,
    /// Time step of a crossing `[s]`; 0.01 where absent. At most the passage of one module. `"auto"`: each job's own, 0.02 s
    /// halved until its peak force changes no more than `time_step_tolerance`.
    #[serde(default, deserialize_with = "time_step", skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub time_step_s: Option<TimeStepSpec>,
    /// How far a job's peak force may be off for its time step, as a share of it; 0.02 where absent. A key of `"auto"`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(max = 0.5), extend("exclusiveMinimum" = 0.0))]
    pub time_step_tolerance: Option<f64>,
    /// How long a crossing goes on after the vehicle has left the bridge `[s]`; 6 where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0))]
    pub tail_s: Option<f64>,
    /// Solver of a crossing; `operator` where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub solver: Option<SolverSpec>,
    /// What the operator may leave out: modes are added until the flexibility of connectors and deck at 5 Hz is off by no
    /// more than this share; 0.0006 where absent. A key of the operator.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 0.1))]
    pub operator_tolerance: Option<f64>,
    /// A share of the jobs solved again by the reference solver; none where absent. A key of the operator.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub verify: Option<VerifySpec>,
    /// Model of the modules.
    #[serde(default)]
    pub model: ModelSpec,
    /// Spectral radius at infinite frequency of a crossing's time integration, 0 to 1; 0.9 where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub spectral_radius: Option<f64>,
    /// Newton solutions that a crossing's step may take before it is halved; 30 where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1, max = 1000))]
    pub newton_limit: Option<usize>,
    /// How often a crossing's step may be halved before the job fails; 8 where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0, max = 12))]
    pub bisection_limit: Option<usize>,
    /// Time steps beyond which a crossing is not run but fails; none where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1, max = 10_000_000))]
    pub step_limit: Option<usize>,
    /// Damping of a crossing; 5 % at the bridge's own first two vertical bending modes where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub damping: Option<DampingSpec>,
    /// How many modes, from the lowest; 20 where absent. A key of modes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1, max = 1000))]
    pub count: Option<usize>,
    /// Whether the modes are those of the bridge on its supports; floating free where absent. A key of modes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub supports: Option<bool>,
}

impl AnalysisSpec {
    /// Refuses numbers out of range and a crossing's keys in a static study, and fills a crossing's defaults.
    ///
    /// # Errors
    /// [`InvalidInput`] with the key relative to `analysis`.
    pub fn checked(mut self) -> Result<Self, InvalidInput> {
        let crossing = [
            ("time_step_s", self.time_step_s.is_some()),
            ("time_step_tolerance", self.time_step_tolerance.is_some()),
            ("tail_s", self.tail_s.is_some()),
            ("solver", self.solver.is_some()),
            ("operator_tolerance", self.operator_tolerance.is_some()),
            ("verify", self.verify.is_some()),
            ("spectral_radius", self.spectral_radius.is_some()),
            ("newton_limit", self.newton_limit.is_some()),
            ("bisection_limit", self.bisection_limit.is_some()),
            ("step_limit", self.step_limit.is_some()),
            ("damping", self.damping.is_some()),
        ];
        let modes = [("count", self.count.is_some()), ("supports", self.supports.is_some())];
        let none = |keys: &[(&str, bool)], of: &str, allowed: &str| match keys.iter().find(|(_, given)| *given) {
            Some((key, _)) => Err(InvalidInput::new(*key, format!("a key of {of}"), allowed)),
            None => Ok(()),
        };
        match self.kind {
            Kind::Static => {
                let allowed = "only kind and model in a static study";
                none(&crossing, "crossings", allowed)?;
                none(&modes, "modes", allowed)?;
                return Ok(self);
            }
            Kind::Modes => {
                none(
                    &crossing,
                    "crossings",
                    "only kind, model, count and supports in a study of modes",
                )?;
                whole("count", *self.count.get_or_insert(20), 1, 1000)?;
                self.supports.get_or_insert(false);
                return Ok(self);
            }
            Kind::Crossing => none(&modes, "modes", "no key of modes in a study of crossings")?,
        }
        self.check_solver()?;
        not_negative("tail_s", *self.tail_s.get_or_insert(6.0))?;
        within("spectral_radius", *self.spectral_radius.get_or_insert(0.9), 0.0, 1.0)?;
        whole("newton_limit", *self.newton_limit.get_or_insert(30), 1, 1000)?;
        whole("bisection_limit", *self.bisection_limit.get_or_insert(8), 0, 12)?;
        if let Some(limit) = self.step_limit {
            whole("step_limit", limit, 1, 10_000_000)?;
        }
        let damping = self.damping.get_or_insert_default();
        within("damping.ratio", damping.ratio, 0.0, 0.99)?;
        if let Some([first, second]) = damping.frequencies_hz {
            positive("damping.frequencies_hz[0]", first)?;
            if !(second.is_finite() && second > first) {
                return Err(InvalidInput::new(
                    "damping.frequencies_hz[1]",
                    second,
                    format!("above {first}"),
                ));
            }
        }
        Ok(self)
    }
}

impl AnalysisSpec {
    /// Refuses the operator's keys beside the reference solver, and fills the defaults of time step and solver.
    fn check_solver(&mut self) -> Result<(), InvalidInput> {
        let solver = *self.solver.get_or_insert_default();
        let step = *self.time_step_s.get_or_insert(TimeStepSpec::Seconds(0.01));
        positive("time_step_s", step.seconds())?;
        let auto = matches!(step, TimeStepSpec::Auto(_));
        if auto {
            let tolerance = *self.time_step_tolerance.get_or_insert(0.02);
            positive("time_step_tolerance", tolerance)?;
            within("time_step_tolerance", tolerance, 0.0, 0.5)?;
        } else if let Some(tolerance) = self.time_step_tolerance {
            let allowed = "no tolerance where time_step_s is a number";
            return Err(InvalidInput::new("time_step_tolerance", tolerance, allowed));
        }
        if solver == SolverSpec::Reference {
            let of_operator = [
                ("operator_tolerance", self.operator_tolerance.is_some()),
                ("verify", self.verify.is_some()),
                ("time_step_s", auto),
            ];
            return match of_operator.iter().find(|(_, given)| *given) {
                Some((key, _)) => Err(InvalidInput::new(*key, "a key of the operator", "solver: operator")),
                None => Ok(()),
            };
        }
        within(
            "operator_tolerance",
            *self.operator_tolerance.get_or_insert(6e-4),
            0.0,
            0.1,
        )?;
        if let Some(verify) = self.verify {
            positive("verify.share", verify.share)?;
            within("verify.share", verify.share, 0.0, 1.0)?;
            not_negative("verify.deflection_tolerance", verify.deflection_tolerance)?;
            not_negative("verify.compression_tolerance", verify.compression_tolerance)?;
            not_negative("verify.tension_tolerance", verify.tension_tolerance)?;
        }
        Ok(())
    }
}

/// A number or the word; anything else is told as such.
fn time_step<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<TimeStepSpec>, D::Error> {
    let value: Option<serde_json::Value> = Option::deserialize(deserializer)?;
    let read = |value: serde_json::Value| match (value.as_f64(), value.as_str()) {
        (Some(seconds), _) => Ok(TimeStepSpec::Seconds(seconds)),
        (None, Some("auto")) => Ok(TimeStepSpec::Auto(AutoSpec::Auto)),
        _ => Err(D::Error::custom(format!(
            "found {value}, allowed: a number of seconds or \"auto\""
        ))),
    };
    value.map(read).transpose()
}

fn whole(key: &str, value: usize, from: usize, to: usize) -> Result<(), InvalidInput> {
    if (from..=to).contains(&value) {
        return Ok(());
    }
    Err(InvalidInput::new(
        key,
        value,
        format!("a whole number from {from} to {to}"),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn checked(value: serde_json::Value) -> Result<AnalysisSpec, InvalidInput> {
        serde_json::from_value::<AnalysisSpec>(value).unwrap().checked()
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
                ratio: 0.05,
                frequencies_hz: None
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
}
