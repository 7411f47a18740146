//! The plane chain of `tests/data/chain.json`, for comparing codes: its bridge of beams and its crossings.
//!
//! Knows how the file becomes a bridge and what is reported of its crossings. Does not know what other codes answer.

use crate::beams::BeamModule;
use crate::{Ready, gaps, settings, with};
use pontoon_core::analysis::modes::Rayleigh;
use pontoon_core::bridge::{BridgeDesign, Direction, Model, ModuleKind, ModuleRow, ModuleRun, PreparedModule};
use pontoon_core::connector::Connection;
use pontoon_core::response::CrossingResponse;
use pontoon_core::vehicle::{Inertia, Vehicle, VehicleDesign};
use pontoon_core::water::WaterDistribution;
use serde_json::{Value, json};
use std::path::Path;

/// The chain as its file gives it.
#[derive(Debug, Clone, PartialEq)]
pub struct Chain {
    /// Number of modules.
    pub modules: usize,
    /// A module.
    pub module: BeamModule,
    /// A module of another kind, its water with it.
    pub other: OtherModule,
    /// Numbers of the modules that are of it, from 1; none in the file.
    pub others: Vec<usize>,
    /// Hydrostatic stiffness a metre of bridge `[N/m^2]`.
    pub hydrostatic_stiffness_n_m2: f64,
    /// Added mass a metre of bridge `[kg/m]`.
    pub added_mass_kg_m: f64,
    /// Stiffness of a joint in one sense `[N/m]`.
    pub joint_stiffness_n_m: f64,
    /// Tension gap `[m]`.
    pub gap_tension_m: f64,
    /// Compression gap `[m]`.
    pub gap_compression_m: f64,
    /// On everything but the connectors.
    pub rayleigh: Rayleigh,
    /// Weight that moves `[N]`.
    pub weight_n: f64,
    /// Length over which it is spread `[m]`.
    pub footprint_length_m: f64,
    /// Points that carry it.
    pub points: usize,
    /// Connection, linear or with the gaps, and speed `[m/s]`.
    pub crossings: Vec<(bool, f64)>,
    /// Time after the last point has left `[s]`.
    pub tail_s: f64,
}

/// A module of the chain of another kind.
#[derive(Debug, Clone, PartialEq)]
pub struct OtherModule {
    /// The module.
    pub module: BeamModule,
    /// Hydrostatic stiffness a metre of it `[N/m^2]`.
    pub hydrostatic_stiffness_n_m2: f64,
    /// Added mass a metre of it `[kg/m]`.
    pub added_mass_kg_m: f64,
}

/// Young's modulus in the file is that of the sections it stands with.
fn product(of: &Value, key: &str) -> f64 {
    number(of, "youngs_modulus_pa") * number(of, key)
}

/// The kind that a design's only module is.
fn kind(of: &BridgeDesign) -> ModuleKind {
    ModuleKind {
        module: of.module.clone(),
        hydrostatic_stiffness_pa_m: of.hydrostatic_stiffness_pa_m,
        draft_buoyancy: None,
        added_mass_kg_m: of.added_mass_kg_m,
        todd: None,
        wet_from_m: None,
        wet_to_m: None,
        draft_m: None,
        freeboard_m: None,
    }
}

fn number(of: &Value, key: &str) -> f64 {
    of[key].as_f64().unwrap_or_else(|| panic!("no number {key}"))
}

fn count(of: &Value, key: &str) -> usize {
    let found = of[key].as_u64().unwrap_or_else(|| panic!("no count {key}"));
    usize::try_from(found).expect("a count")
}

impl Chain {
    /// The file.
    ///
    /// # Panics
    /// Where it cannot be read as a chain.
    pub fn read() -> Self {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/chain.json");
        let text = std::fs::read_to_string(&file).unwrap_or_else(|e| panic!("{}: {e}", file.display()));
        let all: Value = serde_json::from_str(&text).unwrap_or_else(|e| panic!("{}: {e}", file.display()));
        let (beam, post, load) = (&all["beam"], &all["post"], &all["load"]);
        let crossing = |c: &Value| match c["connection"].as_str() {
            Some("linear") => (true, number(c, "speed_m_s")),
            Some("nonlinear") => (false, number(c, "speed_m_s")),
            other => panic!("no connection {other:?}"),
        };
        let module = BeamModule {
            length_m: number(&all, "module_length_m"),
            breadth_m: 2.0,
            depth_m: number(&all, "depth_m"),
            elements: count(&all, "elements_along_module"),
            bending_stiffness_n_m2: product(beam, "second_moment_m4"),
            axial_stiffness_n: product(beam, "area_m2"),
            mass_kg_m: number(beam, "density_kg_m3") * number(beam, "area_m2"),
            posts: (product(post, "second_moment_m4"), product(post, "area_m2")),
        };
        let other = &all["other"];
        Self {
            modules: count(&all, "modules"),
            other: OtherModule {
                module: BeamModule {
                    length_m: number(other, "module_length_m"),
                    elements: count(other, "elements_along_module"),
                    bending_stiffness_n_m2: number(beam, "youngs_modulus_pa") * number(other, "second_moment_m4"),
                    mass_kg_m: number(other, "density_kg_m3") * number(beam, "area_m2"),
                    ..module.clone()
                },
                hydrostatic_stiffness_n_m2: number(other, "hydrostatic_stiffness_n_m2"),
                added_mass_kg_m: number(other, "added_mass_kg_m"),
            },
            others: Vec::new(),
            module,
            hydrostatic_stiffness_n_m2: number(&all["water"], "hydrostatic_stiffness_n_m2"),
            added_mass_kg_m: number(&all["water"], "added_mass_kg_m"),
            joint_stiffness_n_m: number(&all["connectors"], "stiffness_of_a_joint_n_m"),
            gap_tension_m: number(&all["connectors"], "gap_tension_m"),
            gap_compression_m: number(&all["connectors"], "gap_compression_m"),
            rayleigh: Rayleigh::new(
                number(&all["rayleigh"], "stiffness_s"),
                number(&all["rayleigh"], "mass_1_s"),
            ),
            weight_n: number(load, "weight_n"),
            footprint_length_m: number(load, "footprint_length_m"),
            points: count(load, "points"),
            crossings: all["crossings"]
                .as_array()
                .expect("crossings")
                .iter()
                .map(crossing)
                .collect(),
            tail_s: number(&all, "tail_s"),
        }
    }

    /// Its bridge: water lumped on the line nodes, z held at both ends, x at the left (and y, in which nothing happens).
    pub fn design(&self) -> BridgeDesign {
        let (k, m_a, truss) = (
            self.hydrostatic_stiffness_n_m2,
            self.added_mass_kg_m,
            0.5 * self.joint_stiffness_n_m,
        );
        let alike = |module: &BeamModule, k: f64, m_a: f64| {
            with(&module.design(self.modules, k, m_a, truss), |d| {
                d.water_distribution = WaterDistribution::Lumped;
                d.supports.left = vec![Direction::X, Direction::Y, Direction::Z];
                d.supports.right = vec![Direction::Y, Direction::Z];
                (d.draft_m, d.freeboard_m) = (None, None);
            })
        };
        let plain = alike(&self.module, k, m_a);
        if self.others.is_empty() {
            return plain;
        }
        let OtherModule {
            module,
            hydrostatic_stiffness_n_m2,
            added_mass_kg_m,
        } = &self.other;
        let other = alike(module, *hydrostatic_stiffness_n_m2, *added_mass_kg_m);
        let is_other = |number: usize| self.others.contains(&number);
        let kinds = [("plain", kind(&plain)), ("other", kind(&other))].map(|(name, of)| (name.to_owned(), of));
        let run = |number: usize| ModuleRun {
            kind: (if is_other(number) { "other" } else { "plain" }).to_owned(),
            count: 1,
            mirrored: false,
        };
        let row = ModuleRow {
            kinds: kinds.into(),
            runs: (1..=self.modules).map(run).collect(),
        };
        let first = if is_other(1) { other } else { plain };
        with(&first, |d| d.row = Some(row))
    }

    /// The bridge, every degree of freedom kept.
    pub fn ready(&self) -> Ready {
        self.ready_of(&self.design())
    }

    /// A bridge of the chain's modules, every degree of freedom kept.
    ///
    /// # Panics
    /// Where a module or the bridge is refused.
    pub fn ready_of(&self, design: &BridgeDesign) -> Ready {
        let other = &self.other.module;
        let prepare = |of: &BridgeDesign| {
            let module = if of.module.length_m == other.length_m {
                other
            } else {
                &self.module
            };
            PreparedModule::from_mesh(of, module.mesh(), Model::Full).expect("a module")
        };
        Ready::of_kinds(design, design.variants().designs.iter().map(prepare).collect())
    }

    /// The moving force, half on each line.
    ///
    /// # Panics
    /// Where the load is refused.
    pub fn vehicle(&self) -> Vehicle {
        self.vehicle_design().check(self.module.breadth_m).expect("a load")
    }

    /// That force as a vehicle is written.
    pub fn vehicle_design(&self) -> VehicleDesign {
        VehicleDesign {
            footprint_length_m: Some(self.footprint_length_m),
            track_y_m: Some(self.module.lines().to_vec()),
            inertia: Inertia::None,
            patch_points: self.points,
            ..VehicleDesign::default()
        }
    }

    /// The connection of a crossing.
    pub fn connection(&self, linear: bool) -> Connection {
        match linear {
            true => Connection::Linear,
            false => gaps(self.gap_tension_m, self.gap_compression_m),
        }
    }

    /// All crossings of the list, by the reference solver, spectral radius 0.9.
    ///
    /// # Panics
    /// Where one fails.
    pub fn cross(&self, time_step_s: f64) -> Vec<CrossingResponse> {
        let (ready, vehicle) = (self.ready(), self.vehicle());
        let solver = ready.crossings(&vehicle, &settings(self.rayleigh, time_step_s, 0.9));
        let solve = |&(linear, speed_m_s): &(bool, f64)| {
            let mut crossing = ready.crossing(self.connection(linear), self.weight_n, speed_m_s);
            crossing.tail_s = self.tail_s;
            solver.solve(&crossing).expect("a crossing")
        };
        crate::on_two_threads(&self.crossings, solve)
    }

    /// What is compared: peaks of the positions (module ends, left to right) and of the joints' sums of force.
    pub fn report(&self, time_step_s: f64, responses: &[CrossingResponse]) -> Value {
        let one = |(&(linear, speed_m_s), r): (&(bool, f64), &CrossingResponse)| {
            let positions = |of: &dyn Fn(&pontoon_core::response::PositionPeaks) -> f64| -> Vec<f64> {
                r.positions.iter().map(of).collect()
            };
            let joints = |of: &dyn Fn(&pontoon_core::response::JointPeaks) -> f64| -> Vec<f64> {
                r.joints.iter().map(of).collect()
            };
            json!({
                "connection": if linear { "linear" } else { "nonlinear" },
                "speed_m_s": speed_m_s,
                "peak_deflection_m": positions(&|p| p.deflection.value),
                "peak_uplift_m": positions(&|p| p.uplift.value),
                "peak_compression_n": joints(&|j| j.sum.compression.value),
                "peak_tension_n": joints(&|j| j.sum.tension.value),
            })
        };
        let crossings: Vec<Value> = self.crossings.iter().zip(responses).map(one).collect();
        json!({ "time_step_s": time_step_s, "crossings": crossings })
    }
}
