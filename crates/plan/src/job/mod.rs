//! Jobs: a point of a design made into a checked job, equal jobs merged; what a study would run.
//!
//! | module | charter |
//! |---|---|
//! | `documents` | a point's bridge, vehicle and analysis, equal ones shared |
//! | `jobs` | the jobs of a study, one after the other |
//! | `seen` | which jobs were there before |
//! | `key` | what a job is known by from run to run |
//! | `shard` | a share of the jobs |
//! | `plan` | what a study would run |
//!
//! Knows every check that a single job needs. Does not run anything and writes nothing.

mod documents;
mod jobs;
mod key;
mod plan;
mod seen;
mod shard;

pub use documents::{AnalysisEntry, BridgeEntry, VehicleEntry};
pub use jobs::Jobs;
pub use key::JobKey;
pub use plan::{Plan, Share, Work, module_steps};
pub use shard::Shard;

use crate::input::{DocumentPath, canonical};
use crate::study_file::{SolverSpec, TimeStepSpec, VerifySpec};
use pontoon_core::analysis::crossing::{Crossing, CrossingSettings, CrossingSolver};
use pontoon_core::analysis::modes::Rayleigh;
use pontoon_core::connector::Connection;
use pontoon_core::response::Record;
use serde_json::Value;
use std::sync::Arc;

/// A job of a study.
#[derive(Debug, Clone)]
pub struct Job {
    /// Its number, from 0, in the order of the file.
    pub number: usize,
    /// Its bridge.
    pub bridge: Arc<BridgeEntry>,
    /// Its vehicle.
    pub vehicle: Arc<VehicleEntry>,
    /// Its analysis.
    pub analysis: Arc<AnalysisEntry>,
    /// How the connectors work.
    pub connection: Connection,
    /// Weight of the vehicle `[N]`; 0 where none is asked for.
    pub load_n: f64,
    /// What is asked.
    pub task: Task,
}

/// What a job asks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Task {
    /// A crossing.
    Crossing {
        /// Speed `[m/s]`.
        speed_m_s: f64,
    },
    /// A static case.
    Static(Load),
    /// Natural frequencies.
    Modes,
}

/// Where the vehicle stands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Load {
    /// The position it was put on, where it was put on one.
    pub position: Option<usize>,
    /// Place of its centre `[m]`.
    pub x_m: f64,
}

impl Job {
    /// Time steps of a crossing, bisected ones apart; 0 of a static case.
    pub fn steps(&self) -> usize {
        let analysis = &self.analysis.spec;
        match (self.task, analysis.time_step_s, analysis.tail_s) {
            (Task::Crossing { speed_m_s }, Some(step), Some(tail)) => CrossingSolver::steps(
                self.bridge.design.length_m(),
                &self.vehicle.vehicle,
                step.seconds(),
                speed_m_s,
                tail,
            ),
            _ => 0,
        }
    }

    /// The crossing, of which a record is kept.
    pub fn crossing(&self, record: Record) -> Crossing {
        let speed_m_s = match self.task {
            Task::Crossing { speed_m_s } => speed_m_s,
            _ => 0.0,
        };
        Crossing {
            connection: self.connection,
            connector_stiffness_n_m: self.bridge.design.connectors.stiffness_n_m,
            load_n: self.load_n,
            speed_m_s,
            tail_s: self.analysis.spec.tail_s.unwrap_or_default(),
            record,
        }
    }

    /// The settings of its crossing's solver, with the damping of its bridge.
    pub fn settings(&self, rayleigh: Rayleigh) -> CrossingSettings {
        let spec = &self.analysis.spec;
        CrossingSettings {
            time_step_s: self.time_step_s(),
            spectral_radius: spec.spectral_radius.unwrap_or_default(),
            rayleigh,
            newton_limit: spec.newton_limit.unwrap_or_default(),
            bisection_limit: spec.bisection_limit.unwrap_or_default(),
        }
    }

    /// The time step that its study states, the first one where the program is to find it; 0 of what is no crossing `[s]`.
    pub fn time_step_s(&self) -> f64 {
        self.analysis.spec.time_step_s.map_or(0.0, TimeStepSpec::seconds)
    }

    /// Whether it is a crossing by the operator.
    pub fn by_operator(&self) -> bool {
        matches!(self.task, Task::Crossing { .. }) && self.analysis.spec.solver == Some(SolverSpec::Operator)
    }

    /// How it is to be verified; none where it is not.
    pub fn verify(&self) -> Option<VerifySpec> {
        let verify = self.analysis.spec.verify.filter(|verify| verify.takes(self.number));
        verify.filter(|_| self.by_operator())
    }

    /// The gaps (tension, compression) `[m]`; none in the linear connection.
    pub fn gaps_m(&self) -> Option<(f64, f64)> {
        match self.connection {
            Connection::Linear => None,
            Connection::Nonlinear {
                gap_tension_m,
                gap_compression_m,
            } => Some((gap_tension_m, gap_compression_m)),
        }
    }

    /// The value of a column of the study, a short name or a path; null where it has no meaning.
    pub fn column(&self, name: &str) -> Value {
        canonical(&self.typed_column(name))
    }

    /// The same with each number written as its type has it: `3.0` where fractions are allowed, `3` where they are not.
    pub fn typed_column(&self, name: &str) -> Value {
        let (load, speed) = match self.task {
            Task::Crossing { speed_m_s } => (None, Some(speed_m_s)),
            Task::Static(load) => (Some(load), None),
            Task::Modes => (None, None),
        };
        match name {
            "connection" => self.gaps_m().map_or("linear", |_| "nonlinear").into(),
            "gap_tension_m" | "bridge.connectors.gap_tension_m" => self.gaps_m().map(|g| g.0).into(),
            "gap_compression_m" | "bridge.connectors.gap_compression_m" => self.gaps_m().map(|g| g.1).into(),
            "load_n" if self.task == Task::Modes => Value::Null,
            "load_n" => self.load_n.into(),
            "speed_m_s" => speed.into(),
            "load_position" => load.and_then(|l| l.position).into(),
            "load_x_m" => load.map(|l| l.x_m).into(),
            path => self.at(path).cloned().unwrap_or_default(),
        }
    }

    fn at(&self, name: &str) -> Option<&Value> {
        let (root, path) = name.split_once('.')?;
        let document = match root {
            "bridge" => &self.bridge.document,
            "vehicle" => &self.vehicle.document,
            _ => &self.analysis.document,
        };
        DocumentPath::parse(path)?.get(document)
    }

    /// What the job is known by from run to run: equal for jobs that leave the same record, in whatever study and at whatever
    /// number they stand.
    pub fn key(&self) -> JobKey {
        key::key_of(self)
    }

    /// Equal for jobs that are equal.
    pub(super) fn identity(&self) -> Identity {
        let bits = |x: f64| (x + 0.0).to_bits();
        Identity {
            structure: Arc::clone(&self.bridge.structure_key),
            vehicle: self.vehicle.id,
            analysis: self.analysis.id,
            gaps: self
                .gaps_m()
                .map(|(tension, compression)| [tension, compression].map(bits)),
            load: bits(self.load_n),
            task: bits(match self.task {
                Task::Crossing { speed_m_s } => speed_m_s,
                Task::Static(load) => load.x_m,
                Task::Modes => 0.0,
            }),
        }
    }
}

/// What tells jobs of one study apart.
#[derive(Debug, PartialEq, Eq, Hash)]
pub(super) struct Identity {
    structure: Arc<str>,
    vehicle: usize,
    analysis: usize,
    gaps: Option<[u64; 2]>,
    load: u64,
    task: u64,
}
