//! What is timed: the default bridge, its operator at the default tolerance, the paper's load and gaps.
//!
//! Knows what benchmarks run. Does not know a clock.

use crate::{PAPER_GAPS, PAPER_LOAD_N, Ready, SingleCrossing, design, footprint, gaps, read_vehicle, settings};
use pontoon_core::analysis::crossing::{CrossingSettings, CrossingSolver, OperatorSolver};
use pontoon_core::bridge::Model;
use pontoon_core::operator::BridgeOperator;
use pontoon_core::response::{CrossingResponse, Record};
use pontoon_core::vehicle::{Inertia, Vehicle};
use std::sync::Arc;

/// The bridge, of `studies/bridges`.
pub const BRIDGE: &str = "fu2005";

/// The operator's tolerance.
pub const OPERATOR_TOLERANCE: f64 = 6e-4;

/// The time step `[s]`.
pub const TIME_STEP_S: f64 = 0.01;

/// How long a crossing goes on after the vehicle has left `[s]`.
pub const TAIL_S: f64 = 2.0;

/// The bridge made ready, with its operator.
pub struct Scenario {
    /// The bridge.
    pub ready: Ready,
    /// Settings of its crossings.
    pub settings: CrossingSettings,
    /// Its fast solver.
    pub solver: OperatorSolver,
}

impl Scenario {
    /// Builds it.
    ///
    /// # Panics
    /// Where the bridge has no operator.
    pub fn new() -> Self {
        let ready = Ready::new(&design(BRIDGE), Model::SuperElement);
        let settings = settings(ready.rayleigh(), TIME_STEP_S, 0.9);
        let operator = BridgeOperator::new(&ready.bridge, OPERATOR_TOLERANCE).expect("an operator");
        let solver = OperatorSolver::new(&ready.bridge, &Arc::new(operator), &settings);
        Self {
            ready,
            settings,
            solver,
        }
    }

    /// The paper's crossing at a speed.
    pub fn crossing(&self, speed_m_s: f64, record: Record) -> SingleCrossing {
        SingleCrossing {
            record,
            tail_s: TAIL_S,
            ..self.ready.crossing(PAPER_GAPS, PAPER_LOAD_N, speed_m_s)
        }
    }

    /// Histories of every position and joint.
    pub fn everything(&self) -> Record {
        let modules = self.ready.design.modules;
        Record {
            positions: (1..=modules + 1).collect(),
            joints: (2..=modules).collect(),
            ..Record::default()
        }
    }

    /// A grid of gap, gap, speed and load.
    pub fn sweep(&self, [tensions, compressions, speeds, loads]: [usize; 4]) -> Vec<SingleCrossing> {
        let along = |from: f64, to: f64, count: usize| {
            (0..count).map(move |i| from + (to - from) * i as f64 / (count.max(2) - 1) as f64)
        };
        let mut crossings = Vec::new();
        for tension_m in along(0.0, 0.036, tensions) {
            for compression_m in along(0.0, 0.018, compressions) {
                for speed_m_s in along(3.0, 15.0, speeds) {
                    for load_n in along(100e3, 400e3, loads) {
                        crossings.push(SingleCrossing {
                            connection: gaps(tension_m, compression_m),
                            load_n,
                            ..self.crossing(speed_m_s, Record::default())
                        });
                    }
                }
            }
        }
        crossings
    }

    /// Time steps of a crossing, bisections apart.
    pub fn steps(&self, vehicle: &Vehicle, crossing: &SingleCrossing) -> usize {
        let length_m = self.ready.design.length_m();
        CrossingSolver::steps(length_m, &crossing.traffic(vehicle), TIME_STEP_S, crossing.tail_s)
    }

    /// Solves crossings of one vehicle on some threads, each taking part of what is left at a time.
    ///
    /// # Panics
    /// Where a crossing fails.
    pub fn solve(&self, vehicle: &Vehicle, crossings: &[SingleCrossing], threads: usize) -> Vec<CrossingResponse> {
        let chunks: Vec<&[SingleCrossing]> = crossings.chunks(CHUNK).collect();
        let answers = |chunk: &&[SingleCrossing]| -> Vec<CrossingResponse> {
            let jobs: Vec<_> = chunk.iter().map(|crossing| (vehicle, crossing)).collect();
            let answers = crate::solve_side_by_side(&self.solver, &jobs, 0).into_iter();
            answers.map(|answer| answer.expect("a crossing")).collect()
        };
        crate::on_threads(threads, &chunks, answers).concat()
    }
}

/// Crossings that a thread takes at a time.
const CHUNK: usize = 64;

impl Default for Scenario {
    fn default() -> Self {
        Self::new()
    }
}

/// The paper's vehicle.
pub fn vehicle(inertia: Inertia) -> Vehicle {
    footprint(&[-1.4, 1.4], inertia)
}

/// The paper's vehicle, a metre and a half off the centre line.
pub fn vehicle_off_centre(inertia: Inertia) -> Vehicle {
    footprint(&[0.1, 2.9], inertia)
}

/// The shipped truck with two axles: on its springs, or its axle loads as masses on the deck.
///
/// # Panics
/// Where the file holds no vehicle.
pub fn truck(inertia: Option<Inertia>) -> Vehicle {
    let mut design = read_vehicle(if inertia.is_some() { "truck_rigid" } else { "truck" });
    design.inertia = inertia.unwrap_or(design.inertia);
    design.check(f64::INFINITY).expect("a vehicle")
}
