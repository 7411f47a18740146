//! Numbers that are allowed and yet look as if they were in another unit, or go beyond what the model is valid for.
//!
//! Knows what bridges and vehicles are like. Refuses nothing: a person may mean what nobody else would.

use super::{Job, Task, has_springs};
use pontoon_core::bridge::BridgeDesign;
use pontoon_core::module::ModuleDesign;
use pontoon_core::traffic::Driven;
use std::borrow::Cow;
use std::collections::HashSet;

/// Speed from which a vehicle on a floating bridge is a doubt `[m/s]`: 108 km/h.
const FAST_M_S: f64 = 30.0;
/// Weight below which a vehicle is a doubt `[N]`: that of a person.
const LIGHT_N: f64 = 1000.0;
/// Young's modulus below which the material of a module is a doubt `[Pa]`: wood has ten times as much.
const SOFT_PA: f64 = 1e9;
/// Thickness above which a plate is a doubt `[m]`.
const THICK_M: f64 = 0.1;

/// Modules from which the states of water with memory are slow to make.
const MANY_IN_WAVES: usize = 30;

/// Stiffness above which a wheel's spring on a point is a doubt `[N/m]`.
const STIFF_N_M: f64 = 1e7;

/// The stiffness of a wheel's spring that stands on a point and is too stiff for that `[N/m]`.
fn stiff_point(job: &Job) -> Option<f64> {
    let crossing = job.as_crossing().filter(|_| has_springs(job))?;
    let stiff = |driven: &Driven| {
        let springs = driven.vehicle.springs.as_ref()?;
        let wheels = springs.wheels.iter().zip(&driven.vehicle.patches);
        let mut points = wheels.filter(|(_, patch)| patch.length_m == 0.0);
        let found = points.find(|(wheel, _)| driven.scale() * wheel.stiffness_n_m > STIFF_N_M);
        found.map(|(wheel, _)| driven.scale() * wheel.stiffness_n_m)
    };
    crossing.traffic().vehicles.iter().find_map(stiff)
}

/// A number that is in doubt.
#[derive(Debug)]
struct Doubt {
    key: Cow<'static, str>,
    /// The first such value.
    value: f64,
    /// Jobs that have one.
    jobs: usize,
    why: &'static str,
}

/// What looks wrong, as jobs are looked at one after the other.
#[derive(Debug, Default)]
pub struct Doubts {
    found: Vec<Doubt>,
    /// Bridges that were looked at.
    bridges: HashSet<usize>,
}

impl Doubts {
    /// Those of some jobs.
    pub fn of<'a>(jobs: impl IntoIterator<Item = &'a Job>) -> Self {
        let mut doubts = Self::default();
        jobs.into_iter().for_each(|job| doubts.take(job));
        doubts
    }

    /// Looks at a job.
    pub fn take(&mut self, job: &Job) {
        if self.bridges.insert(job.shared.bridge.id) {
            self.bridge(&job.shared.bridge.design);
        }
        if let Task::Crossing { speed_m_s } = job.task {
            let fast = speed_m_s > FAST_M_S;
            self.note(
                fast,
                "speed_m_s",
                speed_m_s,
                "above 30 m/s, which is 108 km/h: is it in km/h?",
            );
        }
        if let Some(crossing) = job.as_crossing() {
            let damping = &crossing.analysis.damping;
            let twice = job.shared.bridge.design.water.is_some()
                && damping.structure.is_none()
                && damping.rayleigh_ratio() > 0.0;
            self.note(
                twice,
                "analysis.damping.ratio",
                damping.rayleigh_ratio(),
                "damps structure and water alike, of which waves take theirs already: state analysis.damping.structure",
            );
            self.note(
                crossing.is_step_long() == Some(true),
                "analysis.time_step_s",
                crossing.first_time_step_s(),
                "the vehicle goes more than half of its shortest patch in a time step, so that peaks may be far too large: take a \
                 smaller step or \"auto\" (column step_warning)",
            );
        }
        if let Some(stiffness_n_m) = stiff_point(job) {
            self.note(
                true,
                "vehicle.axles",
                stiffness_n_m,
                "a spring above 1e7 N/m on a patch of no length: the deck is straight between stations and kicks it at each; state a \
                 patch_length_m",
            );
        }
        if job.task != Task::Modes {
            let light = job.load_n < LIGHT_N;
            self.note(
                light,
                "load_n",
                job.load_n,
                "below 1000 N, the weight of a person: is it in kN?",
            );
        }
        let depth_m = job.shared.bridge.design.deepest_m().0;
        if let Some((tension, compression)) = job.gaps_m() {
            for (key, gap) in [("gap_tension_m", tension), ("gap_compression_m", compression)] {
                self.note(gap > depth_m, key, gap, "above the depth of a module: is it in mm?");
            }
        }
    }

    fn bridge(&mut self, design: &BridgeDesign) {
        let many = design.water.is_some() && design.modules > MANY_IN_WAVES;
        self.note(
            many,
            "bridge.modules",
            design.modules as f64,
            "in water with memory: the states of its memory take a minute or more and gigabytes, once for each bridge",
        );
        for (key, kind) in design.named_kinds() {
            let key = if key.is_empty() {
                String::new()
            } else {
                format!("{key}.")
            };
            self.module(&format!("bridge.{key}module"), &kind.module);
        }
    }

    fn module(&mut self, key: &str, module: &ModuleDesign) {
        let of = |rest: &str| format!("{key}.{rest}");
        let modulus = module.material.youngs_modulus_pa;
        let why = "below 1e9 Pa: is it in GPa or MPa?";
        self.note(modulus < SOFT_PA, of("material.youngs_modulus_pa"), modulus, why);
        for (rest, thickness) in [
            ("deck_thickness_m", module.deck_thickness_m),
            ("bottom_thickness_m", module.bottom_thickness_m),
            ("side_thickness_m", module.side_thickness_m),
            ("end_thickness_m", module.end_thickness_m),
            ("longitudinal_walls.thickness_m", module.longitudinal_walls.thickness_m),
            ("transverse_walls.thickness_m", module.transverse_walls.thickness_m),
        ] {
            let thick = thickness > THICK_M;
            self.note(thick, of(rest), thickness, "above 0.1 m: is it in mm?");
        }
    }

    fn note(&mut self, doubted: bool, key: impl Into<Cow<'static, str>>, value: f64, why: &'static str) {
        if !doubted {
            return;
        }
        let key = key.into();
        match self.found.iter_mut().find(|doubt| doubt.key == key) {
            Some(doubt) => doubt.jobs += 1,
            None => self.found.push(Doubt {
                key,
                value,
                jobs: 1,
                why,
            }),
        }
    }

    /// In words, a line each.
    pub fn notes(&self) -> Vec<String> {
        let told = |doubt: &Doubt| {
            let of_bridge = doubt.key.starts_with("bridge.");
            let many = match doubt.jobs {
                1 => String::new(),
                more if of_bridge => format!(" ({} more bridges)", more - 1),
                more => format!(" ({} more jobs)", more - 1),
            };
            format!("{} {}: {}{many}", doubt.key, doubt.value, doubt.why)
        };
        self.found.iter().map(told).collect()
    }
}
