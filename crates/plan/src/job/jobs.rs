//! The jobs of a study, one after the other.
//!
//! Knows the checks of a single point and merges equal jobs. A stream: it stores what jobs share and a fingerprint a job.

use super::crossing_type::CrossingType;
use super::documents::{BridgeEntry, Documents, TrafficEntry, VehicleEntry, WearEntry};
use super::rating_point::RatingPoint;
use super::seen::SeenJobs;
use super::{Job, MOST_STEPS, SharedParts, StandingLoad, Task, Worn};
use crate::design::{DesignPoint, Goes, JobAxis, NAMED_AXES, NamedAxis, Root, Varies};
use crate::input::{Cell, FoundValue, Refusal, RefusalKind};
use crate::study_file::{Allowed, Analysis, CrossingAnalysis, Find, ModelSpec, Study, TimeStep};
use pontoon_core::analysis::crossing::CrossingSolver;
use pontoon_core::connector::Connection;
use pontoon_core::input::{InvalidInput, bound};
use pontoon_core::traffic::Driven;
use std::collections::{HashMap, HashSet};
use std::sync::Arc;

/// Longest time step in water with memory `[s]`: at 0.2 s the radiated energy is 10 % off.
const LONGEST_IN_WAVES_S: f64 = 0.1;

/// The jobs of a study in order, numbered from 0; equal jobs come once, where the first of them stands.
pub struct Jobs<'a> {
    study: &'a Study,
    points: Box<dyn Iterator<Item = DesignPoint<'a>> + 'a>,
    parts: JobParts,
    seen: SeenJobs,
}

/// What the jobs of a study share, made so far.
#[derive(Debug, Clone, Default)]
pub(super) struct JobParts {
    documents: Documents,
    /// Bridges whose size was checked, with their model.
    sized: HashSet<(usize, ModelSpec)>,
    /// Limits by the bridge that has them.
    limits: HashMap<usize, Arc<[Allowed]>>,
    /// What jobs have in common, by what tells it apart within a study.
    shared: HashMap<SharedKey, Arc<SharedParts>>,
}

/// Bridge, vehicle and its name, type of crossing, analysis: equal for shared parts that are equal within a study.
type SharedKey = (usize, usize, Option<Arc<str>>, Option<CrossingType>, usize);

impl JobParts {
    /// The parts, or equal ones that another job has.
    fn shared(&mut self, parts: SharedParts) -> Arc<SharedParts> {
        let key = (
            parts.bridge.id,
            parts.vehicle.id,
            parts.vehicle_name.clone(),
            parts.crossing_type,
            parts.analysis.id,
        );
        Arc::clone(self.shared.entry(key).or_insert_with(|| Arc::new(parts)))
    }
}

impl<'a> Jobs<'a> {
    /// The jobs of a study.
    pub fn new(study: &'a Study) -> Self {
        let points = Box::new(study.blocks.iter().flat_map(|block| block.points()));
        Self {
            study,
            points,
            parts: JobParts::default(),
            seen: SeenJobs::with_room_for(study.points()),
        }
    }

    /// Of a study, to make jobs of points that are given; `parts` were made for the study before.
    pub(super) fn of_no_point(study: &'a Study, parts: JobParts) -> Self {
        Self {
            study,
            points: Box::new(std::iter::empty()),
            parts,
            seen: SeenJobs::with_room_for(0),
        }
    }

    /// What was made for the jobs so far.
    pub(super) fn into_parts(self) -> JobParts {
        self.parts
    }
}

impl Iterator for Jobs<'_> {
    type Item = Result<Job, Refusal>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            let point = self.points.next()?;
            match self.of_point(&point) {
                Ok(job) if self.seen.insert(&job.identity()) => return Some(Ok(job)),
                Ok(_) => {}
                Err(refusal) => return Some(Err(refusal)),
            }
        }
    }
}

impl Jobs<'_> {
    /// What a point asks for: a job, or a rating.
    pub(super) fn of_point(&mut self, point: &DesignPoint<'_>) -> Result<Job, Refusal> {
        match &self.study.find {
            None => self.job(point),
            Some(find) => self.rating(point, find),
        }
    }

    /// The rating of a point: its crossing at the end where the limits are to hold, and that at the other end has to be one.
    fn rating(&mut self, point: &DesignPoint<'_>, find: &Find) -> Result<Job, Refusal> {
        let [holds, beyond] = find.ends();
        self.job(&point.at(beyond))?;
        let job = self.job(&point.at(holds))?;
        let mut blocks = self.study.blocks.iter();
        let (number, values) = point.owned();
        let of = RatingPoint {
            block: blocks.position(|block| std::ptr::eq(block, point.block)).unwrap_or(0),
            number,
            values,
            search: find.key().into(),
            crossings: find.ladder().len(),
        };
        Ok(Job {
            rating: Some(Arc::new(of)),
            ..job
        })
    }

    /// The limits of a bridge.
    fn limits(&mut self, bridge: &BridgeEntry) -> Result<Arc<[Allowed]>, Refusal> {
        let Some(spec) = &self.study.limits else {
            return Ok(Arc::from([]));
        };
        if let Some(known) = self.parts.limits.get(&bridge.id) {
            return Ok(Arc::clone(known));
        }
        let limits = spec.of(&bridge.design);
        let limits: Arc<[Allowed]> = limits.map_err(|e| Refusal::of(&self.study.file, "limits", e))?.into();
        self.parts.limits.insert(bridge.id, Arc::clone(&limits));
        Ok(limits)
    }

    /// The job of a point.
    pub(super) fn job(&mut self, point: &DesignPoint<'_>) -> Result<Job, Refusal> {
        let bridge = self.parts.documents.bridge(self.study, point)?;
        let vehicle = self.parts.documents.vehicle(self.study, point, &bridge)?;
        let analysis = self.parts.documents.analysis(self.study, point)?;
        self.study.record.check(&self.study.file, &bridge.design)?;
        let short = Short {
            study: self.study,
            point,
        };
        let model = analysis.analysis.model();
        if self.parts.sized.insert((bridge.id, model)) {
            let size = bridge.design.check_size(model.into());
            size.map_err(|refused| short.of_bridge(refused))?;
        }
        let (mut traffic, mut crossing_type) = (None, None);
        let (task, connection, load_n) = match &analysis.analysis {
            Analysis::Crossing(crossing) => {
                let connection = short.connection(&bridge)?;
                crossing_type = short.crossing_type()?;
                let mut said = short.said()?;
                said[1] = crossing_type.and_then(CrossingType::speed_m_s).or(said[1]);
                let asked = (said, crossing_type);
                traffic = self
                    .parts
                    .documents
                    .traffic(self.study, point, (&bridge, &vehicle), asked)?;
                let (load_n, speed_m_s) = match &traffic {
                    Some(entry) => {
                        let most = |of: fn(&Driven) -> f64| entry.traffic.vehicles.iter().map(of).fold(0.0, f64::max);
                        (most(|driven| driven.load_n), most(|driven| driven.drive.speed_m_s))
                    }
                    None => (short.load(&vehicle)?, short.speed()?),
                };
                short.time_step(crossing, &bridge, (&vehicle, traffic.as_deref()), speed_m_s)?;
                short.damping(crossing, &bridge)?;
                short.step_in_waves(crossing, &bridge)?;
                if bridge.design.has_dead_load() {
                    short.held(&bridge)?;
                }
                (Task::Crossing { speed_m_s }, connection, load_n)
            }
            Analysis::Static(_) => {
                let (connection, load_n) = (short.connection(&bridge)?, short.load(&vehicle)?);
                short.held(&bridge)?;
                (Task::Static(short.place(&bridge)?), connection, load_n)
            }
            Analysis::Modes(_) => {
                short.nothing_loaded()?;
                (Task::Modes, Connection::Linear, 0.0)
            }
        };
        let limits = self.limits(&bridge)?;
        let worn = self.parts.documents.wear(self.study, point)?;
        let worn = short.worn(worn, connection, &bridge)?;
        let vehicle_name = short.value(JobAxis::Vehicle).and_then(|cell| cell.word());
        let job = Job {
            number: self.seen.len(),
            shared: self.parts.shared(SharedParts {
                bridge,
                vehicle,
                vehicle_name: vehicle_name.map(Arc::from),
                crossing_type,
                analysis,
                record: Arc::clone(&self.study.record),
                limits,
            }),
            traffic,
            connection,
            load_n,
            worn,
            rating: None,
            task,
        };
        if let Some(crossing) = job
            .as_crossing()
            .filter(|_| !job.shared.record.histories.vehicles.is_empty())
        {
            job.shared
                .record
                .check_vehicles(&self.study.file, &crossing.traffic())?;
        }
        match job.checked_laws() {
            Ok(_) => Ok(job),
            Err(refused) => Err(Short {
                study: self.study,
                point,
            }
            .of_bridge(refused)),
        }
    }
}

/// The largest seed of wear: the whole numbers up to it are floating-point numbers.
const MOST_SEED: f64 = 9_007_199_254_740_992.0;

/// The axes with short names of one point.
struct Short<'a> {
    study: &'a Study,
    point: &'a DesignPoint<'a>,
}

impl Short<'_> {
    fn value(&self, axis: JobAxis) -> Option<&Cell<'_>> {
        self.point.of_job(axis)
    }

    fn path(&self, axis: JobAxis) -> String {
        self.point.path_of(name(axis))
    }

    /// Where a path was set: at its axis, or in the study itself.
    fn path_or(&self, path: &str) -> String {
        let varies = Varies::of(path);
        let mut axes = self.point.block.axes.iter().chain(&self.point.block.searched);
        match axes.find(|axis| Some(&axis.varies) == varies.as_ref()) {
            Some(axis) => self.point.path_of(&axis.name),
            None => path.to_owned(),
        }
    }

    fn refuse(&self, axis: JobAxis, found: impl Into<FoundValue>, allowed: impl Into<String>) -> Refusal {
        Refusal::new(&self.study.file, self.path(axis), found, allowed)
    }

    fn number(&self, axis: JobAxis) -> Result<Option<f64>, Refusal> {
        match self.value(axis) {
            None => Ok(None),
            Some(cell) => cell.number().map(Some).ok_or_else(|| {
                let refused = self.refuse(axis, &cell.value(), "a number");
                refused.because(RefusalKind::WrongType)
            }),
        }
    }

    fn required(&self, axis: JobAxis) -> Result<f64, Refusal> {
        let missing = || Refusal::missing(&self.study.file, self.path(axis));
        self.number(axis)?.ok_or_else(missing)
    }

    fn positive(&self, axis: JobAxis, value: f64) -> Result<f64, Refusal> {
        if value > 0.0 {
            Ok(value)
        } else {
            Err(self.refuse(axis, value, "a finite number above 0"))
        }
    }

    fn absent(&self, axis: JobAxis, allowed: &str) -> Result<(), Refusal> {
        self.value(axis).map_or(Ok(()), |cell| {
            let refused = self.refuse(axis, &cell.value(), allowed);
            Err(refused.because(RefusalKind::Misplaced))
        })
    }

    /// Refuses what moves or loads a bridge, and gaps: modes are those of the linear connection.
    fn nothing_loaded(&self) -> Result<(), Refusal> {
        let allowed = "only axes named by their path in a study of modes";
        NAMED_AXES.iter().try_for_each(|named| match named.goes {
            Goes::Job { axis, .. } => self.absent(axis, allowed),
            Goes::Document(_) => Ok(()),
        })
    }

    /// What the vehicle weighs: what is said, to which it is scaled, or its own.
    fn load(&self, vehicle: &VehicleEntry) -> Result<f64, Refusal> {
        match (self.number(JobAxis::Load)?, vehicle.vehicle.weight_n) {
            (None, Some(own)) => Ok(own),
            _ => self.positive(JobAxis::Load, self.required(JobAxis::Load)?),
        }
    }

    /// The type of the crossing, where an axis has it.
    fn crossing_type(&self) -> Result<Option<CrossingType>, Refusal> {
        let Some(cell) = self.value(JobAxis::CrossingType) else {
            return Ok(None);
        };
        let path = || self.path(JobAxis::CrossingType);
        let Some(word) = cell.word() else {
            let refused = Refusal::new(&self.study.file, path(), &cell.value(), CrossingType::WORDS.join(", "));
            return Err(refused.because(RefusalKind::WrongType));
        };
        let known = CrossingType::WORDS.map(str::to_owned);
        let unknown = || Refusal::unknown(&self.study.file, path(), word, &known);
        let found = CrossingType::of(word).ok_or_else(unknown)?;
        let traffic = &self.study.traffic;
        for (key, is_given) in [
            ("traffic", traffic.traffic.is_some()),
            ("column", traffic.column.is_some()),
        ] {
            if is_given {
                let found = FoundValue::value(word).which(format!("which makes a column of its own, beside a {key}"));
                let refused = Refusal::new(&self.study.file, path(), found, format!("no {key} beside it"));
                return Err(refused.because(RefusalKind::Conflict));
            }
        }
        Ok(Some(found))
    }

    /// Weight and speed as far as axes say them.
    fn said(&self) -> Result<[Option<f64>; 2], Refusal> {
        for axis in [JobAxis::LoadPosition, JobAxis::LoadPlace] {
            self.absent(axis, "no place of the load in a study of crossings")?;
        }
        let said = |axis: JobAxis| self.number(axis)?.map(|value| self.positive(axis, value)).transpose();
        Ok([said(JobAxis::Load)?, said(JobAxis::Speed)?])
    }

    fn connection(&self, bridge: &BridgeEntry) -> Result<Connection, Refusal> {
        let gap = |axis: JobAxis, default: f64| match self.number(axis)? {
            Some(gap) if gap < 0.0 => Err(self.refuse(axis, gap, "a finite number of at least 0")),
            gap => Ok(gap.unwrap_or(default)),
        };
        let connectors = &bridge.design.connectors;
        let gap_tension_m = gap(JobAxis::TensionGap, connectors.gap_tension_m)?;
        let gap_compression_m = gap(JobAxis::CompressionGap, connectors.gap_compression_m)?;
        match self.value(JobAxis::Connection).map(|cell| (cell, cell.word())) {
            None | Some((_, Some("nonlinear"))) => Ok(Connection::Nonlinear {
                gap_tension_m,
                gap_compression_m,
            }),
            Some((_, Some("linear"))) => Ok(Connection::Linear),
            Some((_, Some(word))) => {
                let known = ["linear".to_owned(), "nonlinear".to_owned()];
                let path = self.path(JobAxis::Connection);
                Err(Refusal::unknown(&self.study.file, path, word, &known))
            }
            Some((cell, None)) => {
                let refused = self.refuse(JobAxis::Connection, &cell.value(), "linear or nonlinear");
                Err(refused.because(RefusalKind::WrongType))
            }
        }
    }

    /// The wear of the joints, checked against the gaps that it scatters about.
    fn worn(
        &self,
        entry: Option<Arc<WearEntry>>,
        connection: Connection,
        bridge: &BridgeEntry,
    ) -> Result<Option<Worn>, Refusal> {
        let Some(entry) = entry else {
            self.absent(JobAxis::WearSeed, "no seed of a wear that the study does not have")?;
            return Ok(None);
        };
        let seed = self.required(JobAxis::WearSeed)?;
        if !(0.0..=MOST_SEED).contains(&seed) || seed.fract() != 0.0 {
            return Err(self.refuse(JobAxis::WearSeed, seed, format!("a whole number from 0 to {MOST_SEED}")));
        }
        let Connection::Nonlinear {
            gap_tension_m,
            gap_compression_m,
        } = connection
        else {
            return Ok(None);
        };
        let design = &bridge.design;
        for joint in 2..=design.modules {
            for &y_m in &design.connectors.y_m {
                let nominal = design.nominal_gaps_m(joint, y_m, [gap_tension_m, gap_compression_m]);
                let checked = entry.wear.check_against(nominal);
                checked.map_err(|e| Refusal::of(&self.study.file, "wear", e))?;
            }
        }
        let seed = seed as u64;
        Ok(Some(Worn { entry, seed }))
    }

    fn speed(&self) -> Result<f64, Refusal> {
        self.positive(JobAxis::Speed, self.required(JobAxis::Speed)?)
    }

    /// Refuses a time step beyond the passage of one module and one that would take too many steps.
    fn time_step(
        &self,
        analysis: &CrossingAnalysis,
        bridge: &BridgeEntry,
        (vehicle, traffic): (&VehicleEntry, Option<&TrafficEntry>),
        speed_m_s: f64,
    ) -> Result<(), Refusal> {
        let passage = bridge.design.shortest_module_m() / speed_m_s;
        let step = analysis.time_step.first_s(passage);
        let refuse = |found: FoundValue, allowed: String| {
            let path = self.path_or("analysis.time_step_s");
            Err(Refusal::new(&self.study.file, path, found, allowed).because(RefusalKind::Conflict))
        };
        if step > passage {
            let [most, speed] = [passage, speed_m_s].map(|x| Cell::written(bound(x)));
            let allowed = format!("above 0 and at most {most}, the passage of one module at {speed} m/s");
            return refuse(self.time_step_found(analysis, step, None), allowed);
        }
        let length_m = bridge.design.length_m();
        let steps = match traffic {
            Some(entry) => CrossingSolver::steps(length_m, &entry.traffic, step, analysis.tail_s) as f64,
            None => {
                let way = length_m + vehicle.vehicle.behind_m() + vehicle.vehicle.ahead_m();
                (way / speed_m_s + analysis.tail_s) / step
            }
        };
        if steps > MOST_STEPS as f64 {
            let found = self.time_step_found(analysis, step, Some(format!("makes {steps:.1e} steps")));
            return refuse(found, format!("a crossing of at most {MOST_STEPS} steps"));
        }
        Ok(())
    }

    /// The time step as the study writes it, and what it makes.
    fn time_step_found(&self, analysis: &CrossingAnalysis, step: f64, makes: Option<String>) -> FoundValue {
        let path = "analysis.time_step_s";
        let and_makes = makes.iter().map(|makes| format!(" and {makes}")).collect::<String>();
        if analysis.time_step.tolerance().is_some() {
            return FoundValue::value("auto").which(format!("which begins with {step} s{and_makes}"));
        }
        if self.study.analysis_written.time_step_s.is_none() && self.path_or(path) == path {
            return format!("none, which stands for {step} s{and_makes}").into();
        }
        match makes {
            Some(makes) => FoundValue::from(step).which(format!("which {makes}")),
            None => step.into(),
        }
    }

    /// Refuses damping at the bending modes of a bridge that has none.
    fn damping(&self, analysis: &CrossingAnalysis, bridge: &BridgeEntry) -> Result<(), Refusal> {
        let damping = &analysis.damping;
        if damping.frequencies_hz.is_some() || damping.structure.is_some() || bridge.design.modules > 1 {
            return Ok(());
        }
        let path = self.path_or("analysis.damping.frequencies_hz");
        let allowed = "two frequencies: a bridge of one module has no vertical bending modes to take them from";
        Err(Refusal::new(&self.study.file, path, FoundValue::NOTHING, allowed))
    }

    /// Refuses a time step that is longer than the samples of the memory of a bridge's water.
    fn step_in_waves(&self, analysis: &CrossingAnalysis, bridge: &BridgeEntry) -> Result<(), Refusal> {
        match analysis.time_step {
            TimeStep::Stated(seconds) if bridge.design.water.is_some() && seconds > LONGEST_IN_WAVES_S => {
                let path = self.path_or("analysis.time_step_s");
                let allowed =
                    format!("at most {LONGEST_IN_WAVES_S} in water with memory, whose states are explicit in the step");
                Err(Refusal::new(&self.study.file, path, seconds, allowed).because(RefusalKind::Conflict))
            }
            _ => Ok(()),
        }
    }

    /// Refuses a static case or a dead load of a bridge that its supports, banks and hinges leave free to move horizontally.
    fn held(&self, bridge: &BridgeEntry) -> Result<(), Refusal> {
        bridge.design.check_held().map_err(|free| self.of_bridge(free))
    }

    /// A refusal of the bridge as a whole: in its own file, or beside the block whose axes changed it.
    fn of_bridge(&self, refused: InvalidInput) -> Refusal {
        let axes = &self.point.block.axes;
        if axes
            .iter()
            .any(|axis| matches!(axis.varies, Varies::Path(Root::Bridge, _)))
        {
            let refused = Refusal::of(&self.study.file, "bridge", refused);
            return Refusal {
                made_wrong: Some(refused.path.into()),
                path: self.point.key().into_owned(),
                ..refused
            };
        }
        Refusal::of(&self.study.bridge.file, "", refused)
    }

    fn place(&self, bridge: &BridgeEntry) -> Result<StandingLoad, Refusal> {
        self.absent(JobAxis::Speed, "no speed in a static study")?;
        let design = &bridge.design;
        match (self.number(JobAxis::LoadPosition)?, self.number(JobAxis::LoadPlace)?) {
            (Some(at), None) => {
                let positions = design.positions();
                let position = (1..=positions).find(|p| *p as f64 == at);
                let allowed = || format!("a whole number from 1 to {positions}");
                let position = position.ok_or_else(|| self.refuse(JobAxis::LoadPosition, at, allowed()))?;
                Ok(StandingLoad {
                    position: Some(position),
                    x_m: design.position_x_m(position),
                })
            }
            (None, Some(x_m)) if (0.0..=design.length_m()).contains(&x_m) => Ok(StandingLoad { position: None, x_m }),
            (None, Some(x_m)) => {
                let allowed = format!("a number from 0 to {}", bound(design.length_m()));
                Err(self.refuse(JobAxis::LoadPlace, x_m, allowed))
            }
            (at, _) => {
                let (found, kind) = match at {
                    Some(_) => ("both load_position and load_x_m", RefusalKind::Misplaced),
                    None => ("neither load_position nor load_x_m", RefusalKind::Missing),
                };
                let block = self.point.key();
                Err(Refusal::new(&self.study.file, block, found, "exactly one of the two").because(kind))
            }
        }
    }
}

/// The name of an axis that sets a number or word of the job.
fn name(axis: JobAxis) -> &'static str {
    NamedAxis::of_job(axis).map_or("", |named| named.name)
}
