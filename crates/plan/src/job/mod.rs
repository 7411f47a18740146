//! Jobs: a point of a design made into a checked job, equal jobs merged; what a study would run.
//!
//! | module | charter |
//! |---|---|
//! | `documents` | a point's bridge, vehicle and analysis, equal ones shared |
//! | `doubts` | numbers that look as if they were in another unit |
//! | `jobs` | the jobs of a study, one after the other |
//! | `crossing_type` | which spacing, speed and lane vehicles keep |
//! | `rating_point` | the point of a design that a rating is of |
//! | `candidates` | the crossings that a rating tries |
//! | `point_jobs` | the job of each point |
//! | `point_study` | a study that is asked at points call after call |
//! | `seen` | which jobs were there before |
//! | `key` | what a job is known by from run to run |
//! | `springs` | what of a crossing rides on springs |
//! | `shard` | a share of the jobs |
//! | `plan` | what a study would run |
//!
//! Knows every check that a single job needs. Does not run anything and writes nothing.

mod candidates;
mod crossing_type;
mod documents;
mod doubts;
mod jobs;
mod key;
mod plan;
mod point_jobs;
mod point_study;
mod rating_point;
mod seen;
mod shard;
mod springs;

pub use candidates::Candidates;
pub use crossing_type::CrossingType;
pub use documents::{AnalysisEntry, BridgeEntry, TrafficEntry, VehicleEntry, WearEntry};
pub use doubts::Doubts;
pub use jobs::Jobs;
pub use key::JobKey;
pub use plan::{Plan, Share, Work, module_steps};
pub use point_jobs::PointJobs;
pub use point_study::{AskedPoints, PointStudy};
pub use rating_point::RatingPoint;
pub use shard::{NoShard, Shard};
pub use springs::{BODY_QUANTITIES, SpringWheelPlace, body_word, has_springs, on_springs};

use crate::design::{JobAxis, Root, Varies};
use crate::input::Cell;
use crate::study_file::{
    Allowed, Analysis, CrossingAnalysis, ModelSpec, ModesAnalysis, RecordSpec, Solver, VerifySpec,
};
use pontoon_core::analysis::crossing::{Crossing, CrossingSettings, CrossingSolver};
use pontoon_core::analysis::modes::Rayleigh;
use pontoon_core::bridge::JointGaps;
use pontoon_core::connector::{Connection, ConnectorLaw, OwnLaws};
use pontoon_core::input::InvalidInput;
use pontoon_core::response::{DeadState, Record};
use pontoon_core::traffic::{Drive, Driven, Traffic};
use pontoon_core::vehicle::Inertia;
use std::sync::Arc;

/// A job of a study.
#[derive(Debug, Clone)]
pub struct Job {
    /// Its number, from 0, in the order of the file.
    pub number: usize,
    /// What it has in common with others.
    pub shared: Arc<SharedParts>,
    /// Its traffic and road; none where that vehicle crosses a level road alone.
    pub traffic: Option<Arc<TrafficEntry>>,
    /// How the connectors work.
    pub connection: Connection,
    /// Weight of the vehicle, of several the heaviest `[N]`; 0 where none is asked for.
    pub load_n: f64,
    /// Wear of its joints; none where gaps have no meaning or do not scatter.
    pub worn: Option<Worn>,
    /// Of a rating where its crossings come from: the job itself is the crossing at the end where the limits are to hold.
    pub rating: Option<Arc<RatingPoint>>,
    /// What is asked.
    pub task: Task,
}

/// What jobs of one bridge, vehicle and analysis have in common. A study may have millions of jobs: they hold it once.
#[derive(Debug)]
pub struct SharedParts {
    /// The bridge.
    pub bridge: Arc<BridgeEntry>,
    /// The vehicle.
    pub vehicle: Arc<VehicleEntry>,
    /// The name or file of that vehicle, where an axis has it.
    pub vehicle_name: Option<Arc<str>>,
    /// The type of the crossing, where an axis has it.
    pub crossing_type: Option<CrossingType>,
    /// The analysis.
    pub analysis: Arc<AnalysisEntry>,
    /// What is kept of a job beyond its peaks.
    pub record: Arc<RecordSpec>,
    /// How far the bridge may go; nothing where no limits are stated.
    pub limits: Arc<[Allowed]>,
}

/// Worn joints.
#[derive(Debug, Clone)]
pub struct Worn {
    /// How gaps scatter.
    pub entry: Arc<WearEntry>,
    /// The seed that they are drawn from.
    pub seed: u64,
}

/// What a job asks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Task {
    /// A crossing.
    Crossing {
        /// Speed, of several vehicles that of the fastest `[m/s]`.
        speed_m_s: f64,
    },
    /// A static case.
    Static(StandingLoad),
    /// Natural frequencies.
    Modes,
}

/// Where the vehicle stands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StandingLoad {
    /// The position it was put on, where it was put on one.
    pub position: Option<usize>,
    /// Place of its centre `[m]`.
    pub x_m: f64,
}

/// A job that is a crossing, with how it is computed.
#[derive(Debug, Clone, Copy)]
pub struct CrossingJob<'a> {
    /// The job.
    pub job: &'a Job,
    /// How it is computed.
    pub analysis: &'a CrossingAnalysis,
    /// Speed `[m/s]`.
    pub speed_m_s: f64,
}

/// Time steps beyond which no crossing runs, whatever its study allows.
const MOST_STEPS: usize = 10_000_000;

/// A crossing of more time steps than it may take.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TooManySteps {
    /// How many it would take.
    pub steps: usize,
    /// How many it may take.
    pub limit: usize,
}

impl<'a> CrossingJob<'a> {
    /// The time step that it begins with `[s]`: the stated one, or the coarsest of its own.
    pub fn first_time_step_s(&self) -> f64 {
        let passage_s = self.job.shared.bridge.design.shortest_module_m() / self.speed_m_s;
        self.analysis.time_step.first_s(passage_s)
    }

    /// Time steps at the one that it begins with; bisected ones apart.
    pub fn steps(&self) -> usize {
        self.steps_of(self.first_time_step_s())
    }

    /// Time steps of so many seconds, bisected ones apart.
    fn steps_of(&self, time_step_s: f64) -> usize {
        CrossingSolver::steps(
            self.job.shared.bridge.design.length_m(),
            &self.traffic(),
            time_step_s,
            self.analysis.tail_s,
        )
    }

    /// Whether the vehicle goes more than half of its shortest patch in a time step, where its mass rides along and the step is
    /// stated: the deck then answers to jumps of the mass and no longer to its motion. None where the program finds the step.
    pub fn is_step_long(&self) -> Option<bool> {
        let (step_s, length_m) = (self.first_time_step_s(), self.job.shared.bridge.design.length_m());
        let is_long = |driven: &Driven| {
            let rigid = driven.vehicle.patches.iter().filter(|patch| patch.rigid > 0.0);
            let shortest_m = rigid.map(|p| p.length_m).fold(f64::INFINITY, f64::min);
            driven.vehicle.inertia != Inertia::None && driven.drive.top_speed_m_s(length_m) * step_s > 0.5 * shortest_m
        };
        let long = self.traffic().vehicles.iter().any(is_long);
        self.analysis.time_step.tolerance().is_none().then_some(long)
    }

    /// Whether it may be run at a time step `[s]`.
    ///
    /// # Errors
    /// [`TooManySteps`] beyond the limit of its study.
    pub fn check_steps(&self, time_step_s: f64) -> Result<(), TooManySteps> {
        let (steps, limit) = (
            self.steps_of(time_step_s),
            self.analysis.step_limit.unwrap_or(MOST_STEPS),
        );
        if steps > limit {
            return Err(TooManySteps { steps, limit });
        }
        Ok(())
    }

    /// What a solver is given, of which a record is kept; it starts from the `dead` state of its bridge.
    pub fn input(&self, record: Record, dead: Option<Arc<DeadState>>) -> Crossing {
        Crossing {
            connection: self.job.connection,
            connector_stiffness_n_m: self.job.shared.bridge.design.connectors.stiffness_n_m,
            own_laws: self.job.own_laws(),
            tail_s: self.analysis.tail_s,
            record,
            dead,
        }
    }

    /// The settings of its solver, with the damping of its bridge.
    pub fn settings(&self, rayleigh: Rayleigh) -> CrossingSettings {
        CrossingSettings {
            time_step_s: self.first_time_step_s(),
            spectral_radius: self.analysis.spectral_radius,
            rayleigh,
            newton_limit: self.analysis.newton_limit,
            bisection_limit: self.analysis.bisection_limit,
        }
    }

    /// Whether the operator solves it, and how far that may be off; none where the reference solver does.
    pub fn operator_tolerance(&self) -> Option<f64> {
        match self.analysis.solver {
            Solver::Operator { tolerance, .. } => Some(tolerance),
            Solver::Reference => None,
        }
    }

    /// How it is to be verified; none where it is not.
    pub fn verify(&self) -> Option<VerifySpec> {
        self.analysis.verify().filter(|verify| verify.takes(self.job.number))
    }

    /// What drives over the bridge.
    pub fn traffic(&self) -> Traffic {
        if let Some(entry) = &self.job.traffic {
            return entry.traffic.clone();
        }
        Traffic {
            vehicles: vec![Driven {
                vehicle: Arc::clone(&self.job.shared.vehicle.vehicle),
                load_n: self.job.load_n,
                drive: Drive::steady(self.speed_m_s),
            }],
            road: None,
        }
    }
}

impl Job {
    /// Crossings that it takes at least.
    pub fn crossings(&self) -> usize {
        self.rating.as_ref().map_or(1, |rating| rating.crossings)
    }

    /// The crossing with all weights so many times as large.
    #[must_use]
    pub fn with_load(&self, factor: f64) -> Self {
        let mut job = self.clone();
        job.load_n *= factor;
        job.traffic = self.traffic.as_ref().map(|entry| {
            let mut traffic = entry.traffic.clone();
            traffic.vehicles.iter_mut().for_each(|driven| driven.load_n *= factor);
            Arc::new(TrafficEntry {
                traffic,
                is_single: entry.is_single,
                document: entry.document.clone(),
                key: entry.key,
            })
        });
        job
    }

    /// The job as a crossing; none where it is another.
    pub fn as_crossing(&self) -> Option<CrossingJob<'_>> {
        match (&self.shared.analysis.analysis, self.task) {
            (Analysis::Crossing(analysis), Task::Crossing { speed_m_s }) => Some(CrossingJob {
                job: self,
                analysis,
                speed_m_s,
            }),
            _ => None,
        }
    }

    /// The modes that it asks for; none where it is another.
    pub fn as_modes(&self) -> Option<&ModesAnalysis> {
        match &self.shared.analysis.analysis {
            Analysis::Modes(modes) => Some(modes),
            _ => None,
        }
    }

    /// Whether the study's own vehicle alone loads the bridge.
    pub fn is_single(&self) -> bool {
        self.traffic.as_ref().is_none_or(|traffic| traffic.is_single)
    }

    /// Model of the modules.
    pub fn model(&self) -> ModelSpec {
        self.shared.analysis.analysis.model()
    }

    /// Time steps of a crossing, bisected ones apart; 0 of another job.
    pub fn steps(&self) -> usize {
        self.as_crossing().map_or(0, |crossing| crossing.steps())
    }

    /// Whether it is a crossing by the operator.
    pub fn by_operator(&self) -> bool {
        let crossing = self.as_crossing();
        crossing.is_some_and(|crossing| crossing.operator_tolerance().is_some())
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

    /// The gaps (tension, compression) of each joint from 2 on, its wear included `[m]`: of its connector at the first place of
    /// `connectors.y_m`; none in the linear connection.
    pub fn joint_gaps_m(&self) -> impl Iterator<Item = (usize, [f64; 2])> {
        let design = &self.shared.bridge.design;
        let of_job = self.gaps_m();
        (2..=design.modules).filter_map(move |joint| {
            let (tension, compression) = of_job?;
            let nominal = design.nominal_gaps_m(joint, design.connectors.y_m[0], [tension, compression]);
            Some((joint, self.worn_m(joint, nominal)))
        })
    }

    fn worn_m(&self, joint: usize, nominal_m: [f64; 2]) -> [f64; 2] {
        let worn = self.worn.as_ref();
        worn.map_or(nominal_m, |worn| worn.entry.wear.worn_m(worn.seed, joint, nominal_m))
    }

    /// The connectors that have laws of their own in this job; checked where the job was made.
    pub fn own_laws(&self) -> OwnLaws {
        self.checked_laws().unwrap_or_default()
    }

    /// Equal for jobs whose single connectors have equal laws; none where no connector has one of its own.
    pub fn laws_key(&self) -> Option<[u8; 32]> {
        key::laws_key(&self.own_laws())
    }

    /// The connectors that have laws of their own. Only in a crossing do dashpots count among these.
    fn checked_laws(&self) -> Result<OwnLaws, InvalidInput> {
        let worn = |joint: usize, nominal_m: [f64; 2]| self.worn_m(joint, nominal_m);
        let worn = self.worn.is_some().then_some(&worn as &JointGaps<'_>);
        let laws = self.shared.bridge.design.own_laws(self.connection, worn)?;
        Ok(match self.task {
            Task::Crossing { .. } => laws,
            Task::Static(_) | Task::Modes => self.at_rest(&laws),
        })
    }

    /// Laws of single connectors as a static case has them.
    fn at_rest(&self, laws: &OwnLaws) -> OwnLaws {
        let common = ConnectorLaw::new(self.shared.bridge.design.connectors.stiffness_n_m, self.connection);
        let at_rest = laws.iter().map(|(place, law)| (*place, law.at_rest()));
        at_rest.filter(|(_, law)| *law != common).collect()
    }

    /// The connectors that have laws of their own in a static case of this job.
    pub fn laws_at_rest(&self) -> OwnLaws {
        self.at_rest(&self.own_laws())
    }

    /// As [`Self::laws_key`], of static cases.
    pub fn laws_at_rest_key(&self) -> Option<[u8; 32]> {
        key::laws_key(&self.laws_at_rest())
    }

    /// The value of an axis as its type has it, whole where that is a count; nothing where the axis has no meaning for the
    /// job. A path's value is the one of the job's document, which is what the axis set.
    pub fn cell(&self, axis: &Varies) -> Cell<'_> {
        match axis {
            Varies::Job(axis) => self.own(*axis),
            Varies::Path(root, path) => {
                let document = match root {
                    Root::Bridge => &self.shared.bridge.document,
                    Root::Vehicle => &self.shared.vehicle.document,
                    Root::Analysis => &self.shared.analysis.document,
                    Root::Traffic => match &self.traffic {
                        Some(traffic) => &traffic.document,
                        None => return Cell::Nothing,
                    },
                    Root::Wear => match &self.worn {
                        Some(worn) => &worn.entry.document,
                        None => return Cell::Nothing,
                    },
                };
                path.get(document).map_or(Cell::Nothing, Cell::of)
            }
        }
    }

    /// The value of a column of the study, a number as a file would write it; nothing where it has no meaning.
    pub fn column(&self, name: &str) -> Cell<'_> {
        let axis = Varies::of_column(name);
        axis.map_or(Cell::Nothing, |axis| match axis {
            Varies::Job(axis) => self.own(axis),
            path @ Varies::Path(..) => self.cell(&path).owned(),
        })
        .canonical()
    }

    fn own(&self, axis: JobAxis) -> Cell<'_> {
        let gap = |of: fn((f64, f64)) -> f64| Cell::from(self.gaps_m().map(of));
        match (axis, self.task) {
            (JobAxis::Connection, _) => self.gaps_m().map_or("linear", |_| "nonlinear").into(),
            (JobAxis::TensionGap, _) => gap(|gaps| gaps.0),
            (JobAxis::CompressionGap, _) => gap(|gaps| gaps.1),
            (JobAxis::Speed, Task::Crossing { speed_m_s }) => match &self.traffic {
                Some(traffic) => traffic.common(|driven| driven.drive.speed_m_s).into(),
                None => speed_m_s.into(),
            },
            (JobAxis::Load, Task::Crossing { .. }) if self.traffic.is_some() => {
                let common = self
                    .traffic
                    .as_ref()
                    .and_then(|traffic| traffic.common(|driven| driven.load_n));
                common.into()
            }
            (JobAxis::Load, Task::Crossing { .. } | Task::Static(_)) => self.load_n.into(),
            (JobAxis::Vehicle, _) => self.shared.vehicle_name.as_deref().map_or(Cell::Nothing, Cell::from),
            (JobAxis::CrossingType, _) => self.shared.crossing_type.map(CrossingType::word).into(),
            (JobAxis::LoadPosition, Task::Static(load)) => load.position.into(),
            (JobAxis::LoadPlace, Task::Static(load)) => load.x_m.into(),
            (JobAxis::WearSeed, _) => self.worn.as_ref().map(|worn| worn.seed as usize).into(),
            _ => Cell::Nothing,
        }
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
            structure: Arc::clone(&self.shared.bridge.structure_key),
            vehicle: self.shared.vehicle.id,
            traffic: self.traffic.as_ref().map(|traffic| traffic.key),
            analysis: self.shared.analysis.id,
            gaps: self
                .gaps_m()
                .map(|(tension, compression)| [tension, compression].map(bits)),
            laws: self.laws_key(),
            level: bits(self.shared.bridge.design.risen_m()),
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
    traffic: Option<[u8; 32]>,
    analysis: usize,
    gaps: Option<[u64; 2]>,
    laws: Option<[u8; 32]>,
    level: u64,
    load: u64,
    task: u64,
}
