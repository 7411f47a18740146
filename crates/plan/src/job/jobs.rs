//! The jobs of a study, one after the other.
//!
//! Knows the checks of a single point and merges equal jobs. A stream: it stores what jobs share and a fingerprint a job.

use super::documents::{BridgeEntry, Documents, VehicleEntry};
use super::seen::Seen;
use super::{Job, Load, Task};
use crate::design::{AxisName, Point, SHORT_NAMES};
use crate::input::{Refusal, canonical};
use crate::study_file::{AnalysisSpec, Kind, ModelSpec, Study, check_histories};
use pontoon_core::connector::Connection;
use pontoon_core::input::InvalidInput;
use serde_json::Value;
use std::collections::HashSet;

/// Most time steps of one crossing.
const MOST_STEPS: f64 = 1e7;

/// The jobs of a study in order, numbered from 0; equal jobs come once, where the first of them stands.
pub struct Jobs<'a> {
    study: &'a Study,
    points: Box<dyn Iterator<Item = Point<'a>> + 'a>,
    documents: Documents,
    seen: Seen,
    /// Bridges whose size was checked, with their model.
    sized: HashSet<(usize, ModelSpec)>,
}

impl<'a> Jobs<'a> {
    /// The jobs of a study.
    pub fn new(study: &'a Study) -> Self {
        let points = Box::new(study.blocks.iter().flat_map(|block| block.points()));
        Self {
            study,
            points,
            documents: Documents::default(),
            seen: Seen::with_room_for(study.points()),
            sized: HashSet::new(),
        }
    }
}

impl Iterator for Jobs<'_> {
    type Item = Result<Job, Refusal>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            let point = self.points.next()?;
            match self.job(&point) {
                Ok(job) if self.seen.insert(&job.identity()) => return Some(Ok(job)),
                Ok(_) => {}
                Err(refusal) => return Some(Err(refusal)),
            }
        }
    }
}

impl Jobs<'_> {
    fn job(&mut self, point: &Point<'_>) -> Result<Job, Refusal> {
        let bridge = self.documents.bridge(self.study, point)?;
        let vehicle = self.documents.vehicle(self.study, point, &bridge)?;
        let analysis = self.documents.analysis(self.study, point)?;
        check_histories(
            &self.study.file,
            &self.study.spec.record.histories,
            bridge.design.modules,
        )?;
        let short = Short {
            study: self.study,
            point,
        };
        if self.sized.insert((bridge.id, analysis.spec.model)) {
            let size = bridge.design.check_size(analysis.spec.model.into());
            size.map_err(|refused| short.of_bridge(refused))?;
        }
        let (task, connection, load_n) = match analysis.spec.kind {
            Kind::Crossing => {
                let (connection, load_n) = short.loaded(&bridge)?;
                let speed_m_s = short.speed()?;
                short.time_step(&analysis.spec, &bridge, &vehicle, speed_m_s)?;
                short.damping(&analysis.spec, &bridge)?;
                (Task::Crossing { speed_m_s }, connection, load_n)
            }
            Kind::Static => {
                let (connection, load_n) = short.loaded(&bridge)?;
                short.held(&bridge)?;
                (Task::Static(short.place(&bridge)?), connection, load_n)
            }
            Kind::Modes => {
                short.nothing_loaded()?;
                (Task::Modes, Connection::Linear, 0.0)
            }
        };
        Ok(Job {
            number: self.seen.len(),
            bridge,
            vehicle,
            analysis,
            connection,
            load_n,
            task,
        })
    }
}

/// The axes with short names of one point.
struct Short<'a> {
    study: &'a Study,
    point: &'a Point<'a>,
}

impl Short<'_> {
    fn value(&self, name: &str) -> Option<&Value> {
        let same = |varies: &AxisName| matches!(varies, AxisName::Short(short) if *short == name);
        self.point
            .values()
            .find(|(axis, _)| same(&axis.varies))
            .map(|(_, value)| value)
    }

    fn key(&self, name: &str) -> String {
        format!("{}.{name}", self.point.block.key)
    }

    /// Where a path was set: at its axis, or in the study itself.
    fn key_or(&self, path: &str) -> String {
        let axis = self.point.block.axes.iter().any(|axis| axis.name == path);
        if axis { self.key(path) } else { path.to_owned() }
    }

    fn refuse(&self, name: &str, found: impl ToString, allowed: impl Into<String>) -> Refusal {
        Refusal::new(&self.study.file, self.key(name), found, allowed)
    }

    fn number(&self, name: &str) -> Result<Option<f64>, Refusal> {
        match self.value(name) {
            None => Ok(None),
            Some(value) => value
                .as_f64()
                .map(Some)
                .ok_or_else(|| self.refuse(name, value, "a number")),
        }
    }

    fn required(&self, name: &str) -> Result<f64, Refusal> {
        let missing = || {
            Refusal::new(
                &self.study.file,
                &self.point.block.key,
                format!("no {name}"),
                format!("{name} as one of the axes"),
            )
        };
        self.number(name)?.ok_or_else(missing)
    }

    fn positive(&self, name: &str, value: f64) -> Result<f64, Refusal> {
        if value > 0.0 {
            Ok(value)
        } else {
            Err(self.refuse(name, value, "a finite number above 0"))
        }
    }

    fn absent(&self, name: &str, allowed: &str) -> Result<(), Refusal> {
        self.value(name)
            .map_or(Ok(()), |value| Err(self.refuse(name, value, allowed)))
    }

    /// Refuses what moves or loads a bridge, and gaps: modes are those of the linear connection.
    fn nothing_loaded(&self) -> Result<(), Refusal> {
        SHORT_NAMES
            .iter()
            .try_for_each(|name| self.absent(name, "only axes named by their path in a study of modes"))
    }

    /// How the connectors work and what the vehicle weighs.
    fn loaded(&self, bridge: &BridgeEntry) -> Result<(Connection, f64), Refusal> {
        let connection = self.connection(bridge)?;
        let load_n = self.positive("load_n", self.required("load_n")?)?;
        Ok((connection, load_n))
    }

    fn connection(&self, bridge: &BridgeEntry) -> Result<Connection, Refusal> {
        let gap = |name: &str, default: f64| match self.number(name)? {
            Some(gap) if gap < 0.0 => Err(self.refuse(name, gap, "a finite number of at least 0")),
            gap => Ok(gap.unwrap_or(default)),
        };
        let connectors = &bridge.design.connectors;
        let gap_tension_m = gap("gap_tension_m", connectors.gap_tension_m)?;
        let gap_compression_m = gap("gap_compression_m", connectors.gap_compression_m)?;
        match self.value("connection").map(|v| (v, v.as_str())) {
            None | Some((_, Some("nonlinear"))) => Ok(Connection::Nonlinear {
                gap_tension_m,
                gap_compression_m,
            }),
            Some((_, Some("linear"))) => Ok(Connection::Linear),
            Some((_, Some(word))) => {
                let known = ["linear".to_owned(), "nonlinear".to_owned()];
                Err(Refusal::unknown(&self.study.file, self.key("connection"), word, &known))
            }
            Some((value, None)) => Err(self.refuse("connection", value, "linear or nonlinear")),
        }
    }

    fn speed(&self) -> Result<f64, Refusal> {
        for name in ["load_position", "load_x_m"] {
            self.absent(name, "no place of the load in a study of crossings")?;
        }
        self.positive("speed_m_s", self.required("speed_m_s")?)
    }

    /// Refuses a time step beyond the passage of one module and one that would take too many steps.
    fn time_step(
        &self,
        analysis: &AnalysisSpec,
        bridge: &BridgeEntry,
        vehicle: &VehicleEntry,
        speed_m_s: f64,
    ) -> Result<(), Refusal> {
        let (Some(step), Some(tail)) = (analysis.time_step_s, analysis.tail_s) else {
            return Ok(());
        };
        let step = step.seconds();
        let key = |path| self.key_or(path);
        let passage = bridge.design.module.length_m / speed_m_s;
        if step > passage {
            let [most, speed] = [passage, speed_m_s].map(|x| canonical(&x.into()));
            let allowed = format!("above 0 and at most {most}, the passage of one module at {speed} m/s");
            return Err(Refusal::new(
                &self.study.file,
                key("analysis.time_step_s"),
                step,
                allowed,
            ));
        }
        let vehicle = &vehicle.vehicle;
        let way = bridge.design.length_m() + vehicle.behind_m() + vehicle.ahead_m();
        let steps = (way / speed_m_s + tail) / step;
        if steps > MOST_STEPS {
            let found = format!("{}, which makes {steps:.1e} steps", Value::from(step));
            let allowed = format!("a crossing of at most {MOST_STEPS} steps");
            return Err(Refusal::new(
                &self.study.file,
                key("analysis.time_step_s"),
                found,
                allowed,
            ));
        }
        Ok(())
    }

    /// Refuses damping at the bending modes of a bridge that has none.
    fn damping(&self, analysis: &AnalysisSpec, bridge: &BridgeEntry) -> Result<(), Refusal> {
        let stated = analysis.damping.is_some_and(|damping| damping.frequencies_hz.is_some());
        if stated || bridge.design.modules > 1 {
            return Ok(());
        }
        let key = self.key_or("analysis.damping.frequencies_hz");
        let allowed = "two frequencies: a bridge of one module has no vertical bending modes to take them from";
        Err(Refusal::new(&self.study.file, key, "nothing", allowed))
    }

    /// Refuses a static case of a bridge that its supports and hinges leave free to move horizontally.
    fn held(&self, bridge: &BridgeEntry) -> Result<(), Refusal> {
        bridge.design.check_held().map_err(|free| self.of_bridge(free))
    }

    /// A refusal of the bridge as a whole: in its own file, or beside the block whose axes changed it.
    fn of_bridge(&self, refused: InvalidInput) -> Refusal {
        let InvalidInput { key, found, allowed } = refused;
        let axes = &self.point.block.axes;
        if axes.iter().any(|axis| axis.name.starts_with("bridge.")) {
            let key = format!("{} (bridge.{key})", self.point.block.key);
            return Refusal::new(&self.study.file, key, found, allowed);
        }
        Refusal::new(&self.study.bridge.file, key, found, allowed)
    }

    fn place(&self, bridge: &BridgeEntry) -> Result<Load, Refusal> {
        self.absent("speed_m_s", "no speed in a static study")?;
        let design = &bridge.design;
        match (self.number("load_position")?, self.number("load_x_m")?) {
            (Some(at), None) => {
                let positions = design.positions();
                let position = (1..=positions).find(|p| *p as f64 == at);
                let position = position
                    .ok_or_else(|| self.refuse("load_position", at, format!("a whole number from 1 to {positions}")))?;
                Ok(Load {
                    position: Some(position),
                    x_m: design.position_x_m(position),
                })
            }
            (None, Some(x_m)) if (0.0..=design.length_m()).contains(&x_m) => Ok(Load { position: None, x_m }),
            (None, Some(x_m)) => Err(self.refuse("load_x_m", x_m, format!("a number from 0 to {}", design.length_m()))),
            (at, _) => {
                let found = if at.is_some() {
                    "both load_position and load_x_m"
                } else {
                    "neither load_position nor load_x_m"
                };
                Err(Refusal::new(
                    &self.study.file,
                    &self.point.block.key,
                    found,
                    "exactly one of the two",
                ))
            }
        }
    }
}
