//! Support of the workspace's own tests: bridges from their files, vehicles, and the check with its twin.
//!
//! Knows how a test gets what it measures. Does not know what is expected of it.

#![allow(clippy::expect_used)]

pub mod beams;
pub mod chain;
pub mod chain_answer;
pub mod chain_scenario;
pub mod fem_model;
pub mod operated;
pub mod oscillator;
pub mod scenario;
pub mod waves;

use pontoon_core::analysis::AnalysisError;
use pontoon_core::analysis::crossing::{Crossing, CrossingSettings, CrossingSolver, OperatorSolver};
use pontoon_core::analysis::modes::{Mode, Rayleigh, bending_frequencies_hz, modes, rayleigh};
use pontoon_core::analysis::statics::{StaticCase, StaticSolver};
use pontoon_core::bridge::{Bridge, BridgeDesign, Condensation, Ends, Model, PreparedModule};
use pontoon_core::connector::{Connection, OwnLaws};
use pontoon_core::response::{CrossingResponse, DeadState, Quantity, Record, StaticResponse};
use pontoon_core::stop::Stop;
use pontoon_core::traffic::Traffic;
use pontoon_core::vehicle::{Inertia, Vehicle, VehicleDesign};
use serde::de::DeserializeOwned;
use std::path::Path;
use std::sync::Arc;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The paper's gaps, 28 and 5.5 mm.
pub const PAPER_GAPS: Connection = gaps(0.028, 0.0055);

/// The paper's load `[N]`.
pub const PAPER_LOAD_N: f64 = 230_300.0;

/// A connection with gaps `[m]`.
pub const fn gaps(gap_tension_m: f64, gap_compression_m: f64) -> Connection {
    Connection::Nonlinear {
        gap_tension_m,
        gap_compression_m,
    }
}

/// A bridge of `studies/bridges`.
pub fn design(name: &str) -> BridgeDesign {
    read(&format!("bridges/{name}"))
}

/// The bridge that the identification starts from, with its hinges where the prototype has them: the prototype's water,
/// masses, truss and places.
pub fn prototype_design() -> BridgeDesign {
    let mut design: BridgeDesign = read("identification/start");
    design.hinges.y_m = vec![-1.125, 0.0, 1.125];
    let lines = &mut design.module.stiffeners.longitudinal_y_m;
    (lines[4], lines[6]) = (-1.125, 1.125);
    design
}

/// The vehicle of a file of `studies/vehicles`.
pub fn read_vehicle(name: &str) -> VehicleDesign {
    read(&format!("vehicles/{name}"))
}

fn read<T: DeserializeOwned>(place: &str) -> T {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../studies/{place}.json"));
    let text = std::fs::read_to_string(&file).unwrap_or_else(|e| panic!("{}: {e}", file.display()));
    serde_json::from_str(&text).unwrap_or_else(|e| panic!("{}: {e}", file.display()))
}

/// A bridge with something changed.
pub fn with(design: &BridgeDesign, change: impl FnOnce(&mut BridgeDesign)) -> BridgeDesign {
    let mut changed = design.clone();
    change(&mut changed);
    changed
}

/// A bridge with p_b multiplied.
pub fn with_p_b(design: &BridgeDesign, factor: f64) -> BridgeDesign {
    with(design, |d| d.hydrostatic_stiffness_pa_m = Some(factor * d.p_b()))
}

/// A bridge with m_a multiplied.
pub fn with_m_a(design: &BridgeDesign, factor: f64) -> BridgeDesign {
    with(design, |d| d.added_mass_kg_m = Some(factor * d.m_a()))
}

/// A bridge with E multiplied.
pub fn with_e(design: &BridgeDesign, factor: f64) -> BridgeDesign {
    with(design, |d| d.module.material.youngs_modulus_pa *= factor)
}

/// A bridge condensed otherwise.
pub fn condensed(design: &BridgeDesign, fixed_master_modes: usize, bottom_masters: bool) -> BridgeDesign {
    with(design, |d| {
        d.condensation = Condensation {
            fixed_master_modes,
            bottom_masters,
            ..d.condensation
        };
    })
}

/// A prepared module, floating free and supported bridge of one design.
pub struct Ready {
    /// What it was built from.
    pub design: BridgeDesign,
    /// The module; of a row of kinds the first.
    pub module: PreparedModule,
    /// Floating free.
    pub free: Arc<Bridge>,
    /// On its supports.
    pub bridge: Arc<Bridge>,
}

impl Ready {
    /// Prepares a design.
    pub fn new(design: &BridgeDesign, model: Model) -> Self {
        Self::of_kinds(design, PreparedModule::of_kinds(design, model).expect("modules"))
    }

    /// Prepares a design with a module that was made otherwise.
    pub fn of(design: &BridgeDesign, module: PreparedModule) -> Self {
        Self::of_kinds(design, vec![module])
    }

    /// Prepares a design with modules that were made otherwise, one of each of its variants.
    pub fn of_kinds(design: &BridgeDesign, mut modules: Vec<PreparedModule>) -> Self {
        let bridge = |ends| Arc::new(Bridge::of_kinds(design, &modules, ends).expect("a bridge"));
        let [free, bridge] = [Ends::Free, Ends::Supported].map(bridge);
        Self {
            design: design.clone(),
            module: modules.swap_remove(0),
            free,
            bridge,
        }
    }

    /// Rayleigh coefficients of 5 % at the first two bending modes.
    pub fn rayleigh(&self) -> Rayleigh {
        rayleigh(
            0.05,
            bending_frequencies_hz(&self.free, Stop::never()).expect("two bending modes"),
        )
    }

    /// The lowest modes, floating free.
    pub fn modes(&self, count: usize) -> Vec<Mode> {
        modes(&self.free, count).expect("modes").0
    }

    /// Statics of a vehicle.
    pub fn statics(&self, vehicle: &Vehicle) -> Statics {
        Statics {
            solver: StaticSolver::new(&self.bridge).expect("statics"),
            vehicle: vehicle.clone(),
        }
    }

    /// A static case with the design's trusses.
    pub fn case(&self, connection: Connection, load_n: f64, load_x_m: f64) -> StaticCase {
        StaticCase {
            connection,
            connector_stiffness_n_m: self.design.connectors.stiffness_n_m,
            own_laws: [].into(),
            load_n,
            load_x_m,
            places_x_m: Vec::new(),
            dead: None,
        }
    }

    /// Crossings of a vehicle.
    pub fn crossings(&self, vehicle: &Vehicle, settings: &CrossingSettings) -> Crossings {
        Crossings::new(&self.bridge, vehicle, settings)
    }

    /// A crossing with the design's trusses and no histories, one second of tail.
    pub fn crossing(&self, connection: Connection, load_n: f64, speed_m_s: f64) -> SingleCrossing {
        SingleCrossing {
            connection,
            connector_stiffness_n_m: self.design.connectors.stiffness_n_m,
            own_laws: [].into(),
            load_n,
            speed_m_s,
            tail_s: 1.0,
            record: Record::default(),
            dead: None,
        }
    }
}

/// A crossing of one vehicle at constant speed.
#[derive(Debug, Clone, PartialEq)]
pub struct SingleCrossing {
    /// How the connectors work.
    pub connection: Connection,
    /// Stiffness of one truss `[N/m]`.
    pub connector_stiffness_n_m: f64,
    /// Connectors that have laws of their own.
    pub own_laws: OwnLaws,
    /// Weight of the vehicle `[N]`.
    pub load_n: f64,
    /// Speed, below 0 from the right end `[m/s]`.
    pub speed_m_s: f64,
    /// How long to go on behind it `[s]`.
    pub tail_s: f64,
    /// What to keep.
    pub record: Record,
    /// The state at rest.
    pub dead: Option<Arc<DeadState>>,
}

impl SingleCrossing {
    /// The crossing without its vehicle.
    pub fn crossing(&self) -> Crossing {
        Crossing {
            connection: self.connection,
            connector_stiffness_n_m: self.connector_stiffness_n_m,
            own_laws: self.own_laws.clone(),
            tail_s: self.tail_s,
            record: self.record.clone(),
            dead: self.dead.clone(),
        }
    }

    /// The vehicle as it drives.
    pub fn traffic(&self, vehicle: &Vehicle) -> Traffic {
        Traffic::single(vehicle, self.load_n, self.speed_m_s)
    }
}

/// What solves crossings of one vehicle.
pub trait SolvesSingle {
    /// Solves one.
    ///
    /// # Errors
    /// The solver's.
    fn solve_single(&self, vehicle: &Vehicle, crossing: &SingleCrossing) -> Result<CrossingResponse, AnalysisError>;
}

impl SolvesSingle for CrossingSolver {
    fn solve_single(&self, vehicle: &Vehicle, crossing: &SingleCrossing) -> Result<CrossingResponse, AnalysisError> {
        self.solve(&crossing.traffic(vehicle), &crossing.crossing())
    }
}

impl SolvesSingle for OperatorSolver {
    fn solve_single(&self, vehicle: &Vehicle, crossing: &SingleCrossing) -> Result<CrossingResponse, AnalysisError> {
        self.solve(&crossing.traffic(vehicle), &crossing.crossing())
    }
}

/// Solves crossings side by side by the operator, at the time step halved `refinement` times.
pub fn solve_side_by_side(
    solver: &OperatorSolver,
    asked: &[(&Vehicle, &SingleCrossing)],
    refinement: usize,
) -> Vec<Result<CrossingResponse, AnalysisError>> {
    let each: Vec<(Traffic, Crossing)> = asked
        .iter()
        .map(|(vehicle, crossing)| (crossing.traffic(vehicle), crossing.crossing()))
        .collect();
    let list: Vec<_> = each.iter().map(|(traffic, crossing)| (traffic, crossing)).collect();
    solver.solve_all(&list, refinement)
}

/// Static cases of one vehicle.
pub struct Statics {
    solver: StaticSolver,
    vehicle: Vehicle,
}

impl Statics {
    /// Solves one case.
    ///
    /// # Errors
    /// The solver's.
    pub fn solve(&self, case: &StaticCase) -> Result<StaticResponse, AnalysisError> {
        self.solver.solve(&self.vehicle, case)
    }

    /// The largest static deflection over all places of the load.
    ///
    /// # Errors
    /// The solver's.
    pub fn creeping_peak_m(&self, case: &StaticCase) -> Result<f64, AnalysisError> {
        self.solver.creeping_peak_m(&self.vehicle, case)
    }
}

/// Crossings of one vehicle.
pub struct Crossings {
    solver: CrossingSolver,
    vehicle: Vehicle,
}

impl Crossings {
    /// Factorises.
    ///
    /// # Panics
    /// Where the solver cannot be made.
    pub fn new(bridge: &Arc<Bridge>, vehicle: &Vehicle, settings: &CrossingSettings) -> Self {
        Self {
            solver: CrossingSolver::new(bridge, settings).expect("crossings"),
            vehicle: vehicle.clone(),
        }
    }

    /// Solves one crossing.
    ///
    /// # Errors
    /// The solver's.
    pub fn solve(&self, crossing: &SingleCrossing) -> Result<CrossingResponse, AnalysisError> {
        self.solver.solve_single(&self.vehicle, crossing)
    }
}

/// Settings of a crossing as studies use them but for the arguments.
pub fn settings(rayleigh: Rayleigh, time_step_s: f64, spectral_radius: f64) -> CrossingSettings {
    CrossingSettings {
        time_step_s,
        spectral_radius,
        rayleigh,
        newton_limit: 40,
        bisection_limit: 8,
    }
}

/// The paper's footprint on given tracks.
pub fn footprint(track_y_m: &[f64], inertia: Inertia) -> Vehicle {
    let design = VehicleDesign {
        track_y_m: Some(track_y_m.to_vec()),
        inertia,
        ..VehicleDesign::default()
    };
    design.check(8.082).expect("a vehicle")
}

/// Axles of two tracks 2.8 m apart: for each its distance behind the front, share and patch length.
pub fn axles(list: &[(f64, f64, f64)], inertia: Inertia, patch_points: usize) -> Vehicle {
    let line =
        |&(behind_front_m, share, length_m): &(f64, f64, f64)| (behind_front_m, share, length_m, 0.0, [-1.4, 1.4]);
    let list: Vec<_> = list.iter().map(line).collect();
    operated::wide_axles(&list, inertia, patch_points)
}

/// Frequency of the mode of a name `[Hz]`.
pub fn frequency_hz(modes: &[Mode], name: &str) -> f64 {
    let mode = modes.iter().find(|m| m.name == name);
    let names = || modes.iter().map(|m| m.name.as_str()).collect::<Vec<_>>();
    mode.unwrap_or_else(|| panic!("no '{name}' among {:?}", names()))
        .frequency_hz
}

/// History of a position's deflection or a joint's force.
pub fn history(response: &CrossingResponse, quantity: Quantity, position: usize) -> &[f64] {
    let found = response
        .recorded
        .histories
        .iter()
        .find(|h| h.subject.quantity() == quantity && h.subject.position() == Some(position));
    &found.expect("a history that was asked for").values
}

/// Share by which `found` misses `expected`.
pub fn miss(found: f64, expected: f64) -> f64 {
    (found - expected).abs() / expected.abs()
}

/// Largest of some misses; NaN where one is.
pub fn largest(misses: impl IntoIterator<Item = f64>) -> f64 {
    let bigger = |a: f64, b: f64| if b.is_nan() || b > a { b } else { a };
    misses.into_iter().fold(0.0, bigger)
}

/// Largest difference of two lists over the second's largest value.
pub fn apart(found: &[f64], expected: &[f64]) -> f64 {
    assert_eq!(found.len(), expected.len(), "lists of different length");
    let scale = largest(expected.iter().map(|e| e.abs()));
    largest(found.iter().zip(expected).map(|(f, e)| (f - e).abs())) / scale
}

/// A check with its twin: the right bridge misses by no more than the tolerance, the wrong one by more.
pub fn held(what: &str, tolerance: f64, right: f64, wrong: f64) {
    println!("{what}: {right:.2e} <= {tolerance:.1e} < {wrong:.2e}");
    assert!(
        right <= tolerance,
        "{what}: misses by {right:.3e}, tolerance {tolerance:.1e}"
    );
    assert!(
        wrong > tolerance,
        "{what}: the wrong bridge passes, it misses by {wrong:.3e} only, tolerance {tolerance:.1e}"
    );
}

/// Answers of all jobs in their order, two threads at work.
pub fn on_two_threads<J: Sync, R: Send>(jobs: &[J], answer: impl Fn(&J) -> R + Sync) -> Vec<R> {
    on_threads(2, jobs, answer)
}

/// Answers of all jobs in their order, some threads at work.
pub fn on_threads<J: Sync, R: Send>(threads: usize, jobs: &[J], answer: impl Fn(&J) -> R + Sync) -> Vec<R> {
    let next = AtomicUsize::new(0);
    let answers = Mutex::new(Vec::new());
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                loop {
                    let place = next.fetch_add(1, Ordering::Relaxed);
                    let Some(job) = jobs.get(place) else { break };
                    let own = answer(job);
                    answers.lock().expect("no panic before").push((place, own));
                }
            });
        }
    });
    let mut answers = answers.into_inner().expect("no panic before");
    answers.sort_by_key(|a| a.0);
    answers.into_iter().map(|a| a.1).collect()
}
