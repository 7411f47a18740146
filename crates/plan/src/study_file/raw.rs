//! The study file as it is written: its keys and their types.
//!
//! Knows what a person may write. Does not know ranges or which keys go together: `analysis` and `study` make of this what a
//! run is asked.

use super::find::FindSpec;
use super::limits::LimitsSpec;
use super::record::RecordSpec;
use super::wear::WearSpec;
use crate::design::Design;
use pontoon_core::analysis::modes::{Rayleigh, rayleigh};
use pontoon_core::bridge::Model;
use pontoon_core::road::RoadDesign;
use pontoon_core::traffic::{ColumnDesign, TrafficDesign, TrafficEntry, VehicleOrFile};
use pontoon_core::vehicle::VehicleDesign;
use schemars::JsonSchema;
use serde::de::{Error, Unexpected};
use serde::{Deserialize, Deserializer, Serialize};
use serde_json::Value;
use std::collections::BTreeMap;

/// A study as its file writes it.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StudySpec {
    /// Name of the study and of its folder of results: letters, digits, `_`, `-` and `.`, not beginning with `.` or `-`, not
    /// ending with `.`, and no name of a device on Windows as `con` is.
    #[schemars(regex(pattern = r"^[A-Za-z0-9_]([A-Za-z0-9_.-]*[A-Za-z0-9_-])?$"), length(max = 200))]
    pub name: String,
    /// What the study asks, in a sentence, for whoever reads its report.
    #[serde(default)]
    pub question: Option<String>,
    /// Path of the bridge file, relative to the study file.
    pub bridge: String,
    /// The vehicle, or the path of its file; a single footprint of 3.35 m on two tracks where absent.
    #[serde(default)]
    #[schemars(with = "VehicleOrFile")]
    pub vehicle: VehicleDesign,
    /// Vehicles that the axis `vehicle` names; it may name files too, which are read into here.
    #[serde(default)]
    pub vehicles: BTreeMap<String, VehicleDesign>,
    /// Vehicles that cross together, in the order of their numbers, in place of the one.
    #[serde(default)]
    #[schemars(length(min = 1, max = 200))]
    pub traffic: Option<Vec<TrafficEntry>>,
    /// A column of equal vehicles in place of the one.
    #[serde(default)]
    pub column: Option<ColumnDesign>,
    /// How uneven the road is; level where absent.
    #[serde(default)]
    pub roughness: Option<RoadDesign>,
    /// What is asked and how it is computed.
    pub analysis: AnalysisSpec,
    /// How the gaps of joints scatter, drawn from the axis `wear_seed`.
    #[serde(default)]
    pub wear: Option<WearSpec>,
    /// How far the bridge may go in a crossing: each crossing then tells how much of that it uses up.
    #[serde(default)]
    pub limits: Option<LimitsSpec>,
    /// What a rating searches; in studies of kind `rating` alone.
    #[serde(default)]
    pub find: Option<FindSpec>,
    /// The designs, united in order; equal jobs run once.
    #[schemars(length(min = 1))]
    pub design: Vec<Design>,
    /// What to keep of each job beyond its peaks.
    #[serde(default)]
    pub record: RecordSpec,
}

impl StudySpec {
    /// Its traffic and road.
    pub fn traffic(&self) -> TrafficDesign {
        TrafficDesign {
            traffic: self.traffic.clone(),
            column: self.column.clone(),
            roughness: self.roughness.clone(),
        }
    }
}

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
    /// The largest or smallest value of an axis at which a crossing keeps all limits.
    Rating,
}

impl Kind {
    /// Whether vehicles cross.
    pub fn has_crossings(self) -> bool {
        matches!(self, Self::Crossing | Self::Rating)
    }
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

/// Damping: Rayleigh's, of structure and water alike, or that of the structure alone, which belongs to water with memory.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DampingSpec {
    /// Ratio of critical damping at both frequencies; 0.05 where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 0.99))]
    pub ratio: Option<f64>,
    /// The two frequencies, increasing `[Hz]`; absent: the first two vertical bending modes of the job's own bridge,
    /// linearly connected and floating free.
    #[serde(default, deserialize_with = "pair", skip_serializing_if = "Option::is_none")]
    pub frequencies_hz: Option<[f64; 2]>,
    /// Damping of the structure alone, in place of both: none of the water's springs and added mass.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub structure: Option<StructureDamping>,
}

/// Damping of the structure in proportion to its stiffness.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StructureDamping {
    /// Ratio of critical damping of a motion at `at_hz` that the structure alone restores.
    #[schemars(range(min = 0.0, max = 0.99))]
    pub ratio: f64,
    /// Frequency at which the ratio holds; it is in proportion to the frequency `[Hz]`.
    #[schemars(range(min = 0.01, max = 1000.0))]
    pub at_hz: f64,
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

impl DampingSpec {
    /// The ratio of Rayleigh's damping where none is written.
    pub const RATIO: f64 = 0.05;

    /// The ratio of Rayleigh's damping.
    pub fn rayleigh_ratio(&self) -> f64 {
        self.ratio.unwrap_or(Self::RATIO)
    }

    /// The frequencies of Rayleigh's damping `[Hz]`, none of the structure's own, and the coefficients; `bending_hz` finds the first two
    /// vertical bending modes where no frequencies are stated.
    ///
    /// # Errors
    /// Those of `bending_hz`.
    pub fn coefficients<E>(
        &self,
        bending_hz: impl FnOnce() -> Result<[f64; 2], E>,
    ) -> Result<(Option<[f64; 2]>, Rayleigh), E> {
        if let Some(of) = self.structure {
            return Ok((None, Rayleigh::of_structure(of.ratio, of.at_hz)));
        }
        let frequencies_hz = self.frequencies_hz.map_or_else(bending_hz, Ok)?;
        Ok((Some(frequencies_hz), rayleigh(self.rayleigh_ratio(), frequencies_hz)))
    }

    /// With the ratio written out where it counts.
    #[must_use]
    pub(super) fn filled(self) -> Self {
        match self.structure {
            None => Self {
                ratio: Some(self.rayleigh_ratio()),
                ..self
            },
            Some(_) => self,
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

/// A number or the word; anything else is refused.
fn time_step<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<TimeStepSpec>, D::Error> {
    let read = |value: Value| match &value {
        Value::Number(number) => Ok(TimeStepSpec::Seconds(number.as_f64().unwrap_or(f64::NAN))),
        Value::String(word) if word == "auto" => Ok(TimeStepSpec::Auto(AutoSpec::Auto)),
        other => {
            let text = other.to_string();
            let found = match other {
                Value::String(word) => Unexpected::Str(word),
                Value::Bool(flag) => Unexpected::Bool(*flag),
                Value::Array(_) => Unexpected::Seq,
                Value::Object(_) => Unexpected::Map,
                _ => Unexpected::Other(&text),
            };
            Err(D::Error::invalid_value(found, &"a number of seconds or \"auto\""))
        }
    };
    let value: Option<Value> = Option::deserialize(deserializer)?;
    value.map(read).transpose()
}
