//! Static cases with the gap law.
//!
//! Knows one vehicle standing still on one bridge, on any model. Does not know motion.

mod creeping;

use super::AnalysisError;
use super::snapshot::{Snapshot, connectors, wheels};
use crate::bridge::{Bridge, Load, PinPlace, VehiclePlacement, joint_parts};
use crate::connector::{Connection, OwnLaws, State};
use crate::contact::{ContactProblem, ContactSolution, LinkLaw, NotSettled};
use crate::fem::SparseRow;
use crate::flexibility::Flexibility;
use crate::response::{Equilibrium, JointForces, JointReading, StaticResponse};
use crate::vehicle::Vehicle;
pub use creeping::CreepingLoad;
use nalgebra::{DMatrix, DVector};
use std::sync::{Arc, OnceLock};

/// One static case.
#[derive(Debug, Clone, PartialEq)]
pub struct StaticCase {
    /// How the connectors work.
    pub connection: Connection,
    /// Stiffness of one truss `[N/m]`.
    pub connector_stiffness_n_m: f64,
    /// Connectors that have laws of their own in place of these.
    pub own_laws: OwnLaws,
    /// Weight of the vehicle `[N]`.
    pub load_n: f64,
    /// Place of the vehicle's centre `[m]`.
    pub load_x_m: f64,
    /// Places along the bridge whose deflection is wanted `[m]`.
    pub places_x_m: Vec<f64>,
}

impl StaticCase {
    /// The law of each of so many connectors.
    fn laws(&self, connectors: usize) -> Vec<LinkLaw> {
        LinkLaw::connectors(
            connectors,
            self.connector_stiffness_n_m,
            self.connection,
            &self.own_laws,
        )
    }
}

/// A bridge made ready for static cases. Shared read-only between jobs and threads.
#[derive(Debug)]
pub struct StaticSolver {
    bridge: Arc<Bridge>,
    flexibility: Flexibility,
    /// What each connector and below them each position sees of a unit force on each column of the track, made when a
    /// creeping load first needs it.
    influence: OnceLock<DMatrix<f64>>,
}

/// Newton solutions allowed before the load is halved.
const NEWTON_LIMIT: usize = 60;

/// How often the load may be halved.
const HALVINGS: usize = 12;

impl StaticSolver {
    /// Factorises K once.
    ///
    /// # Errors
    /// [`AnalysisError::Factor`] where K is singular: the supports leave a motion that nothing restores.
    pub fn new(bridge: &Arc<Bridge>) -> Result<Self, AnalysisError> {
        Ok(Self {
            bridge: Arc::clone(bridge),
            flexibility: Flexibility::new("stiffness of the bridge", &bridge.k, bridge)?,
            influence: OnceLock::new(),
        })
    }

    /// Solves `K u + B^T N(B u) = f`.
    ///
    /// # Errors
    /// [`AnalysisError::StaticNotConverged`].
    /// Equation (S1).
    pub fn solve(&self, vehicle: &Vehicle, case: &StaticCase) -> Result<StaticResponse, AnalysisError> {
        let (load, contact, u) = self.rest(vehicle, case)?;
        let bridge = &self.bridge;
        let design = bridge.design();
        let joints = (2..=design.modules)
            .zip(contact.forces.chunks(design.connectors.y_m.len()))
            .map(|(joint, forces)| JointForces {
                joint,
                sum_n: forces.iter().sum(),
                connectors: design
                    .connectors
                    .y_m
                    .iter()
                    .copied()
                    .zip(forces.iter().copied())
                    .collect(),
            })
            .collect();
        let largest = |rows: &[SparseRow], value: &dyn Fn(f64) -> f64| {
            rows.iter().map(|row| value(row.dot(&u))).fold(0.0_f64, f64::max)
        };
        let pins_n = self.pins_n(&load, &u);
        let at_rest = Rest {
            bridge,
            u: &u,
            contact: &contact,
            pins_n: &pins_n,
        };
        let banks = bridge.bank_parts().into_iter();
        let banks = banks
            .map(|part| (part.bank, part.y_m, part.force_n(&at_rest)))
            .collect();
        let sections = joint_parts(design)
            .iter()
            .map(|parts| parts.sections(&at_rest))
            .collect();
        let place_m = |&x_m: &f64| 0.0 - bridge.place(x_m).dot(&u);
        Ok(StaticResponse {
            sections,
            banks,
            places_m: case.places_x_m.iter().map(place_m).collect(),
            // nothing is 0, not -0
            deflection_m: bridge.positions.iter().map(|row| 0.0 - row.dot(&u)).collect(),
            joints,
            pins_n,
            peak_edge_deflection_m: largest(&bridge.edges, &|z| -z),
            peak_roll_rad: largest(&bridge.rolls, &f64::abs),
            influential_length_m: self.influential_length_m(&u, case.load_x_m),
            bottom_emerged: bridge.bottom_emerges(&u),
            deck_submerged: bridge.deck_submerges(&u),
            newton_iterations: contact.iterations,
            equilibrium: self.equilibrium(vehicle, case, &load.placement, &u),
        })
    }

    /// The static case as the whole state of the bridge.
    ///
    /// # Errors
    /// As [`Self::solve`].
    pub fn state(&self, vehicle: &Vehicle, case: &StaticCase) -> Result<Snapshot, AnalysisError> {
        let (load, contact, u) = self.rest(vehicle, case)?;
        let at_rest = vec![0.0; load.riders.len()];
        Ok(Snapshot {
            time_s: 0.0,
            elastic: u.clone(),
            u,
            inertial: None,
            connectors: connectors(&contact.states, &contact.forces, &contact.elongations),
            wheels: wheels(self.flexibility.track(), vehicle, case.load_n, &load, &at_rest),
        })
    }

    /// The load, the connectors' forces and the displacement of a case.
    fn rest(&self, vehicle: &Vehicle, case: &StaticCase) -> Result<(Load, ContactSolution, Vec<f64>), AnalysisError> {
        let load = self.load(vehicle, case, case.load_x_m);
        let e_free: Vec<f64> = (0..self.bridge.links.len())
            .map(|i| -self.flexibility.connector_to_track(i, &load.weight))
            .collect();
        let laws = case.laws(e_free.len());
        let contact = brought_on(self.flexibility.among_connectors(), &laws, &e_free, case.load_x_m)?;
        let mut u = vec![0.0; self.bridge.dofs()];
        self.flexibility
            .add_track_response(&SparseRow::combine(&[(-1.0, &load.weight)]), &mut u);
        for (i, force) in contact.forces.iter().enumerate() {
            self.flexibility.add_connector_response(i, -force, &mut u);
        }
        Ok((load, contact, u))
    }

    /// Force of each pin on the module left of it.
    fn pins_n(&self, load: &Load, u: &[f64]) -> Vec<[f64; 3]> {
        let down = std::slice::from_ref(&load.weight);
        let force = |pin: &PinPlace| pin.rows.each_ref().map(|row| row.force_n(u, None, down));
        self.bridge.pins.iter().map(force).collect()
    }

    /// Largest static deflection of any position over all places of the load along the bridge `[m]`.
    ///
    /// # Errors
    /// [`AnalysisError::StaticNotConverged`].
    pub fn creeping_peak_m(&self, vehicle: &Vehicle, case: &StaticCase) -> Result<f64, AnalysisError> {
        let peaks = self.creeping_peaks_m(vehicle, case)?;
        Ok(peaks.into_iter().fold(0.0, f64::max))
    }

    /// Largest static deflection of each position over all places of the load along the bridge `[m]`: places a quarter of
    /// an element apart (`load_x_m` of the case is not used). For many cases of one vehicle see [`Self::creeping`].
    ///
    /// # Errors
    /// [`AnalysisError::StaticNotConverged`].
    pub fn creeping_peaks_m(&self, vehicle: &Vehicle, case: &StaticCase) -> Result<Vec<f64>, AnalysisError> {
        self.creeping(vehicle).peaks_m(case)
    }

    /// A vehicle made ready to creep over the bridge under any connection and weight.
    pub fn creeping(&self, vehicle: &Vehicle) -> CreepingLoad {
        let positions = &self.bridge.positions;
        let influence = self.influence.get_or_init(|| self.flexibility.influence(positions));
        CreepingLoad::new(&self.bridge, &self.flexibility, influence, vehicle)
    }

    fn load(&self, vehicle: &Vehicle, case: &StaticCase, centre_x_m: f64) -> Load {
        let front_x_m = centre_x_m - vehicle.centre_ahead_m();
        Load::new(self.flexibility.track(), vehicle, case.load_n, front_x_m, 0.0)
    }

    /// Between the first zero crossings left and right of the load, interpolated between nodes.
    fn influential_length_m(&self, u: &[f64], load_x_m: f64) -> f64 {
        let line: Vec<(f64, f64)> = self
            .bridge
            .centre_line
            .iter()
            .map(|(x, row)| (*x, -row.dot(u)))
            .collect();
        let zero = |from: &mut dyn Iterator<Item = &(f64, f64)>| -> Option<f64> {
            let mut last: Option<(f64, f64)> = None;
            for &(x, w) in from {
                if let Some((x0, w0)) = last
                    && w0 > 0.0
                    && w <= 0.0
                {
                    return Some(x0 + (x - x0) * w0 / (w0 - w));
                }
                last = Some((x, w));
            }
            None
        };
        let (left, right): (Vec<_>, Vec<_>) = line.into_iter().partition(|&(x, _)| x < load_x_m);
        let length = self.bridge.design().length_m();
        let left_end = zero(&mut right.first().into_iter().chain(left.iter().rev())).unwrap_or(0.0);
        let right_end = zero(&mut left.last().into_iter().chain(right.iter())).unwrap_or(length);
        right_end - left_end
    }

    fn equilibrium(
        &self,
        vehicle: &Vehicle,
        case: &StaticCase,
        placement: &VehiclePlacement,
        u: &[f64],
    ) -> Equilibrium {
        let mut result = Equilibrium::default();
        for point in vehicle.points().filter(|p| placement.cell(p.along).is_some()) {
            let force = -case.load_n * point.share;
            add_force(&mut result.load, force, placement.x_m(point), point.y_m);
        }
        result.water = std::array::from_fn(|i| self.bridge.water[i].dot(u));
        for held in self.bridge.held.iter().filter(|h| h.vertical) {
            add_force(&mut result.supports, held.row.dot(u), held.x_m, held.y_m);
        }
        result
    }
}

/// Adds an upward force at (x, y) to resultants (force, moment about x, moment about y).
fn add_force(to: &mut [f64; 3], force: f64, x: f64, y: f64) {
    to[0] += force;
    to[1] += y * force;
    to[2] -= x * force;
}

/// The contact of connectors whose elongations without forces are `e_full`; where Newton does not settle from open
/// connectors, the load is brought on in parts.
fn brought_on(
    among: &DMatrix<f64>,
    laws: &[LinkLaw],
    e_full: &[f64],
    load_x_m: f64,
) -> Result<ContactSolution, AnalysisError> {
    let nc = e_full.len();
    let mut problem = ContactProblem {
        e_free: e_full.to_vec(),
        connectors: among,
        weight: 1.0,
        connectors_riders: DMatrix::zeros(nc, 0),
        riders_connectors: DMatrix::zeros(0, nc),
        riders: DMatrix::zeros(0, 0),
        riders_free: DVector::zeros(0),
    };
    let mut states = vec![State::Open; nc];
    let (mut reached, mut part, mut halvings, mut iterations) = (0.0_f64, 1.0_f64, 0, 0);
    loop {
        let target = (reached + part).min(1.0);
        problem.e_free = e_full.iter().map(|e| target * e).collect();
        match problem.solve(laws, &states, NEWTON_LIMIT) {
            Ok(solution) => {
                iterations += solution.iterations;
                if target >= 1.0 {
                    return Ok(ContactSolution { iterations, ..solution });
                }
                states = solution.states;
                reached = target;
            }
            Err(NotSettled { iterations: spent, .. }) => {
                iterations += spent;
                halvings += 1;
                part *= 0.5;
                if halvings > HALVINGS {
                    return Err(AnalysisError::StaticNotConverged { iterations, load_x_m });
                }
            }
        }
    }
}

/// What joints do at rest, to be read.
struct Rest<'a> {
    bridge: &'a Bridge,
    u: &'a [f64],
    contact: &'a ContactSolution,
    pins_n: &'a [[f64; 3]],
}

impl JointReading for Rest<'_> {
    fn connector_n(&self, connector: usize) -> [f64; 2] {
        [self.contact.forces[connector]; 2]
    }

    fn elongation_m(&self, connector: usize) -> f64 {
        self.contact.elongations[connector]
    }

    fn pin_n(&self, pin: usize) -> [f64; 3] {
        self.pins_n[pin]
    }

    fn spring_m(&self, spring: usize) -> f64 {
        self.bridge.springs[spring].row.dot(self.u)
    }
}
