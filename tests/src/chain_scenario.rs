//! A question to the plane chain, read from a scenario file.
//!
//! Knows the words of a scenario, which are those of studies and bridge files, and refuses what the chain cannot do. Does not
//! know how the chain is built, nor how it is asked.

use crate::chain::Chain;
use pontoon_core::analysis::crossing::{Crossing, CrossingSolver};
use pontoon_core::analysis::statics::StaticCase;
use pontoon_core::bridge::{BankPlace, BankSpec, BridgeDesign, BridgeEnd, DeadSpec, Joints, Model};
use pontoon_core::connector::Connection;
use pontoon_core::input::{Found, InvalidInput, Problem, bound, not_negative, positive, within};
use pontoon_core::response::Record;
use pontoon_core::road::RoadDesign;
use pontoon_core::traffic::{ColumnDesign, Deck, StudyVehicle, Traffic, TrafficDesign, TrafficEntry};
use pontoon_core::vehicle::{Inertia, Vehicle, VehicleDesign};
use pontoon_plan::Refusal;
use pontoon_plan::input::{Document, typed_value};
use serde::Deserialize;
use serde_json::{Map, Value, json};
use std::path::Path;

/// A scenario as it is written.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct ScenarioSpec {
    modules: Option<usize>,
    #[serde(default)]
    others: Vec<usize>,
    #[serde(default)]
    joints: Joints,
    #[serde(default)]
    banks: Vec<BankSpec>,
    #[serde(default)]
    dead: DeadSpec,
    water_level_m: Option<f64>,
    #[serde(default)]
    connection: ConnectionSpec,
    gap_tension_m: Option<f64>,
    gap_compression_m: Option<f64>,
    #[serde(default)]
    analysis: AnalysisSpec,
    vehicle: Option<VehicleDesign>,
    load_n: Option<f64>,
    speed_m_s: Option<f64>,
    load_x_m: Option<f64>,
    load_position: Option<usize>,
    traffic: Option<Vec<TrafficEntry>>,
    column: Option<ColumnDesign>,
    roughness: Option<RoadDesign>,
}

#[derive(Debug, Clone, Copy, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
enum ConnectionSpec {
    Linear,
    #[default]
    Nonlinear,
}

#[derive(Debug, Clone, Copy, Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct AnalysisSpec {
    #[serde(default)]
    kind: Kind,
    time_step_s: Option<f64>,
    tail_s: Option<f64>,
    spectral_radius: Option<f64>,
}

#[derive(Debug, Clone, Copy, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Kind {
    #[default]
    Crossing,
    Static,
    Modes,
}

/// A checked question to the chain.
#[derive(Debug, Clone)]
pub struct ChainScenario {
    /// The chain, of as many modules as are asked for.
    pub chain: Chain,
    /// Its bridge with the scenario's joints: two trusses a joint, each of half the joint's stiffness.
    pub design: BridgeDesign,
    /// The vehicle.
    pub vehicle: Vehicle,
    /// What it does, the dead state left out.
    pub task: ChainTask,
}

/// What the vehicle of a scenario does.
#[derive(Debug, Clone, PartialEq)]
pub enum ChainTask {
    /// It crosses.
    Crossing {
        /// What drives.
        traffic: Traffic,
        /// How.
        crossing: Crossing,
        /// Time step `[s]`.
        time_step_s: f64,
        /// Spectral radius of the time integration.
        spectral_radius: f64,
    },
    /// It stands.
    Static(StaticCase),
    /// There is none: the bridge floats free and vibrates.
    Modes,
}

/// The time step where none is given `[s]`: half of it moves no largest peak by more than 0.1 %.
pub const TIME_STEP_S: f64 = 0.0025;

/// Time steps beyond which no crossing runs, as in studies.
const MOST_STEPS: f64 = 1e7;

impl ChainScenario {
    /// Reads a scenario file; a time step given beside it counts in place of the file's.
    ///
    /// # Errors
    /// [`Refusal`] with the key, what was found and what is allowed.
    pub fn read(file: &Path, time_step_s: Option<f64>) -> Result<Self, Refusal> {
        Self::of(file, &Document::read(file)?, time_step_s)
    }

    /// The scenario of a document; `file` stands for it in messages.
    ///
    /// # Errors
    /// As above.
    pub fn of(file: &Path, document: &Document, time_step_s: Option<f64>) -> Result<Self, Refusal> {
        let chain = Chain::read();
        let spec: ScenarioSpec = typed_value(file, "", &filled(document.value(), &chain))?;
        Self::checked(chain, &spec, time_step_s).map_err(|e| Refusal::of(file, "", e))
    }

    fn checked(mut chain: Chain, spec: &ScenarioSpec, time_step_s: Option<f64>) -> Result<Self, InvalidInput> {
        chain.modules = spec.modules.unwrap_or(chain.modules);
        for (i, &number) in spec.others.iter().enumerate() {
            if !(1..=chain.modules).contains(&number) {
                let allowed = format!("a module, from 1 to {}", chain.modules);
                return Err(InvalidInput::new(format!("others[{i}]"), number, allowed));
            }
        }
        chain.others.clone_from(&spec.others);
        let mut design = with_banks(with_joints(chain.design(), &spec.joints)?, &spec.banks)?;
        (design.dead, design.water_level_m) = (spec.dead.clone(), spec.water_level_m);
        design.check()?;
        let connection = spec.connection(&chain)?;
        let own_laws = design.own_laws(connection, None)?;
        let of_vehicle = |e: InvalidInput| e.under("vehicle");
        let standing = spec.standing();
        let own = standing
            .and_then(|entry| entry.vehicle.clone())
            .or_else(|| spec.vehicle.clone());
        let own = own.unwrap_or_else(|| chain.vehicle_design());
        let vehicle = own.check(chain.module.breadth_m).map_err(of_vehicle)?;
        plane(&vehicle).map_err(of_vehicle)?;
        let stiffness = design.connectors.stiffness_n_m;
        let task = match spec.analysis.kind {
            Kind::Crossing => {
                let traffic = spec.driving(&chain, &own, &design)?;
                let analysis = spec.analysis;
                let crossing = Crossing {
                    connection,
                    connector_stiffness_n_m: stiffness,
                    own_laws,
                    tail_s: not_negative("analysis.tail_s", analysis.tail_s.unwrap_or(chain.tail_s))?,
                    record: Record {
                        pins: true,
                        sections: true,
                        ..Record::default()
                    },
                    dead: None,
                };
                let radius = analysis.spectral_radius.unwrap_or(0.9);
                ChainTask::Crossing {
                    time_step_s: time_step(
                        time_step_s.or(analysis.time_step_s),
                        &design,
                        (&traffic, crossing.tail_s),
                    )?,
                    traffic,
                    spectral_radius: within("analysis.spectral_radius", radius, 0.0, 1.0)?,
                    crossing,
                }
            }
            Kind::Modes => ChainTask::Modes,
            Kind::Static => {
                let moving = [
                    ("speed_m_s", spec.speed_m_s.is_some()),
                    ("traffic", spec.traffic.is_some() && standing.is_none()),
                    ("column", spec.column.is_some()),
                    ("roughness", spec.roughness.is_some()),
                ];
                none_of(&moving, "a key of crossings", "none of them in a static case")?;
                let load_n = standing
                    .and_then(|entry| entry.load_n)
                    .or(spec.load_n)
                    .or(vehicle.weight_n)
                    .unwrap_or(chain.weight_n);
                positive("load_n", load_n)?;
                ChainTask::Static(StaticCase {
                    connection,
                    connector_stiffness_n_m: stiffness,
                    own_laws,
                    load_n,
                    load_x_m: spec.place(&design)?,
                    places_x_m: Vec::new(),
                    dead: None,
                })
            }
        };
        Ok(Self {
            chain,
            design,
            vehicle,
            task,
        })
    }
}

/// The document with what the chain's own load has where its vehicles say nothing: footprint, lines, points, no inertia.
fn filled(mut document: Value, chain: &Chain) -> Value {
    let fill = |vehicle: Option<&mut Value>| {
        let Some(vehicle) = vehicle.and_then(Value::as_object_mut) else {
            return;
        };
        let lines = json!(chain.module.lines());
        let add = |vehicle: &mut Map<String, Value>, key: &str, value: Value| {
            vehicle.entry(key).or_insert(value);
        };
        add(vehicle, "inertia", json!(Inertia::None));
        add(vehicle, "patch_points", json!(chain.points));
        match vehicle.get_mut("axles") {
            None => {
                add(vehicle, "footprint_length_m", json!(chain.footprint_length_m));
                add(vehicle, "track_y_m", lines);
            }
            Some(axles) => {
                let axles = axles.as_array_mut().into_iter().flatten();
                for axle in axles.filter_map(Value::as_object_mut) {
                    add(axle, "track_y_m", lines.clone());
                }
            }
        }
    };
    fill(document.get_mut("vehicle"));
    fill(document.get_mut("column").and_then(|column| column.get_mut("vehicle")));
    let traffic = document.get_mut("traffic").and_then(Value::as_array_mut);
    for entry in traffic.into_iter().flatten() {
        fill(entry.get_mut("vehicle"));
    }
    document
}

/// The bridge with banks in place of the supports there; a bank stands on the chain's two lines.
fn with_banks(mut design: BridgeDesign, banks: &[BankSpec]) -> Result<BridgeDesign, InvalidInput> {
    design.banks = banks.to_vec();
    for bank in &mut design.banks {
        bank.y_m.get_or_insert_with(|| design.hinges.y_m.clone());
        match bank.at {
            BankPlace::End(BridgeEnd::Left) => design.supports.left.retain(|held| *held != bank.direction),
            BankPlace::End(BridgeEnd::Right) => design.supports.right.retain(|held| *held != bank.direction),
            BankPlace::Position(_) => {}
        }
    }
    design.check()?;
    Ok(design)
}

/// The chain's bridge with what its joints have of their own, checked as it is written, a joint's stiffness and damping then
/// given to two trusses.
fn with_joints(mut design: BridgeDesign, joints: &Joints) -> Result<BridgeDesign, InvalidInput> {
    let misplaced = |key: String, found: &str, allowed: &str| {
        Err(InvalidInput::new(key, found, allowed).because(Problem::Misplaced))
    };
    for (range, spec) in &joints.0 {
        let of = format!("joints[{range}]");
        if spec.hinges.is_some() {
            let allowed = "connectors alone: a joint of the chain has one hinge, in line";
            return misplaced(format!("{of}.hinges"), "hinges", allowed);
        }
        if spec.connectors.as_ref().is_some_and(|own| own.at_y_m.is_some()) {
            let allowed = "no places: a joint of the chain has one connector";
            return misplaced(format!("{of}.connectors.at_y_m"), "places across", allowed);
        }
    }
    design.joints = joints.clone();
    design.check()?;
    design.check_size(Model::Full)?;
    for own in design
        .joints
        .0
        .iter_mut()
        .filter_map(|(_, spec)| spec.connectors.as_mut())
    {
        let stops = [&mut own.stop_tension, &mut own.stop_compression].into_iter().flatten();
        let of_stops = stops.map(|stop| &mut stop.stiffness_n_m);
        let of_joint = of_stops.chain(&mut own.stiffness_n_m).chain(&mut own.damping_n_s_m);
        of_joint.for_each(|number| *number *= 0.5);
    }
    Ok(design)
}

/// A vehicle that loads both lines of the chain alike.
fn plane(vehicle: &Vehicle) -> Result<(), InvalidInput> {
    for axle in 0..vehicle.axles {
        let points = vehicle.patches.iter().filter(|patch| patch.axle == axle);
        let aside: f64 = points.flat_map(|patch| &patch.points).map(|p| p.share * p.y_m).sum();
        if aside.abs() > 1e-9 {
            let allowed = "tracks on both sides of 0 alike: the chain is plane";
            let key = format!("axles[{axle}].track_y_m");
            return Err(InvalidInput::new(key, "a vehicle to one side", allowed).because(Problem::Conflict));
        }
    }
    Ok(())
}

/// A time step of at most the passage of a module, which does not make too many steps.
fn time_step(
    asked_s: Option<f64>,
    design: &BridgeDesign,
    (traffic, tail_s): (&Traffic, f64),
) -> Result<f64, InvalidInput> {
    let key = "analysis.time_step_s";
    let step = positive(key, asked_s.unwrap_or(TIME_STEP_S))?;
    let fastest_m_s = traffic
        .vehicles
        .iter()
        .map(|driven| driven.drive.speed_m_s)
        .fold(0.0, f64::max);
    let passage = design.shortest_module_m() / fastest_m_s;
    if step > passage {
        let allowed = format!("at most {}, the passage of one module", bound(passage));
        return Err(InvalidInput::new(key, step, allowed).because(Problem::Conflict));
    }
    let steps = CrossingSolver::steps(design.length_m(), traffic, step, tail_s) as f64;
    if steps > MOST_STEPS {
        let allowed = format!("a crossing of at most {MOST_STEPS} steps");
        return Err(InvalidInput::new(
            key,
            format!("{step}, which makes {steps:.1e} steps"),
            allowed,
        ));
    }
    Ok(step)
}

impl ScenarioSpec {
    fn connection(&self, chain: &Chain) -> Result<Connection, InvalidInput> {
        let gap = |key: &str, own: Option<f64>, of_chain: f64| not_negative(key, own.unwrap_or(of_chain));
        let gap_tension_m = gap("gap_tension_m", self.gap_tension_m, chain.gap_tension_m)?;
        let gap_compression_m = gap("gap_compression_m", self.gap_compression_m, chain.gap_compression_m)?;
        Ok(match self.connection {
            ConnectionSpec::Linear => Connection::Linear,
            ConnectionSpec::Nonlinear => Connection::Nonlinear {
                gap_tension_m,
                gap_compression_m,
            },
        })
    }

    /// The one vehicle of a static case, where it is written as a traffic.
    fn standing(&self) -> Option<&TrafficEntry> {
        let is_static = matches!(self.analysis.kind, Kind::Static);
        match self.traffic.as_deref() {
            Some([entry]) if is_static && entry.speed_m_s.is_none() => Some(entry),
            _ => None,
        }
    }

    /// What drives in a crossing, in which no load stands; the chain's own load where nobody says a weight.
    fn driving(&self, chain: &Chain, own: &VehicleDesign, design: &BridgeDesign) -> Result<Traffic, InvalidInput> {
        let places = [
            ("load_x_m", self.load_x_m.is_some()),
            ("load_position", self.load_position.is_some()),
        ];
        none_of(&places, "a place of the load", "none in a crossing")?;
        let weight_n = |vehicle: Option<&VehicleDesign>, own_n: Option<f64>| {
            let states = vehicle.unwrap_or(own).states_weight();
            own_n.or(self.load_n).or((!states).then_some(chain.weight_n))
        };
        let mut asked = TrafficDesign {
            traffic: self.traffic.clone(),
            column: self.column.clone(),
            roughness: self.roughness.clone(),
        };
        for entry in asked.traffic.iter_mut().flatten() {
            entry.load_n = weight_n(entry.vehicle.as_ref(), entry.load_n);
        }
        if let Some(column) = &mut asked.column {
            column.load_n = weight_n(column.vehicle.as_ref(), column.load_n);
        }
        let study = StudyVehicle {
            design: own,
            load_n: weight_n(None, None),
            speed_m_s: self.speed_m_s,
        };
        let deck = Deck {
            length_m: design.length_m(),
            breadth_m: chain.module.breadth_m,
        };
        let traffic = asked.traffic(study, deck)?;
        for (number, driven) in traffic.vehicles.iter().enumerate() {
            plane(&driven.vehicle).map_err(|e| e.under(&format!("traffic[{number}].vehicle")))?;
        }
        Ok(traffic)
    }

    /// The place of a load that stands.
    fn place(&self, design: &BridgeDesign) -> Result<f64, InvalidInput> {
        let analysis = self.analysis;
        let of_crossings = [
            ("analysis.time_step_s", analysis.time_step_s.is_some()),
            ("analysis.tail_s", analysis.tail_s.is_some()),
            ("analysis.spectral_radius", analysis.spectral_radius.is_some()),
        ];
        none_of(&of_crossings, "a key of crossings", "none of them in a static case")?;
        let positions = design.positions();
        match (self.load_position, self.load_x_m) {
            (Some(position), None) if (1..=positions).contains(&position) => Ok(design.position_x_m(position)),
            (Some(position), None) => {
                let allowed = format!("a whole number from 1 to {positions}");
                Err(InvalidInput::new("load_position", position, allowed))
            }
            (None, Some(x_m)) => within("load_x_m", x_m, 0.0, design.length_m()),
            (Some(_), Some(_)) => Err(
                InvalidInput::new("load_x_m", "load_position beside it", "one of the two").because(Problem::Misplaced),
            ),
            (None, None) => {
                let found = Found::Nothing;
                Err(InvalidInput::new("load_x_m", found, "load_x_m or load_position").because(Problem::Missing))
            }
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
