//! Static cases with the gap law.
//!
//! Knows one vehicle standing still on one bridge, on any model. Does not know motion.

mod creeping;
mod dead;

use super::AnalysisError;
use super::snapshot::{Snapshot, connectors, wheels};
use crate::bridge::{Acting, Bridge, Heading, Load, PinPlace, VehiclePlacement, joint_parts};
use crate::connector::{Connection, OwnLaws, State};
use crate::contact::{ContactProblem, ContactSolution, LinkLaw, NotSettled, rest_force_n};
use crate::fem::{Factor, SparseRow, SymmetricMatrix};
use crate::flexibility::Flexibility;
use crate::response::{DeadState, Equilibrium, JointForces, JointReading, StaticResponse};
use crate::vehicle::Vehicle;
pub use creeping::CreepingLoad;
pub use dead::DeadCase;
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
    /// The state at rest from which deflections are counted, where the bridge has a dead load.
    pub dead: Option<Arc<DeadState>>,
}

impl StaticCase {
    /// The law of each of so many connectors.
    fn laws(&self, connectors: usize) -> Vec<LinkLaw> {
        let laws = LinkLaw::connectors(
            connectors,
            self.connector_stiffness_n_m,
            self.connection,
            &self.own_laws,
        );
        LinkLaw::from_rest(laws, self.dead.as_deref())
    }
}

/// A bridge made ready for static cases. Shared read-only between jobs and threads.
#[derive(Debug)]
pub struct StaticSolver {
    bridge: Arc<Bridge>,
    flexibility: Flexibility,
    /// Whether links alone hold a motion, so that the flexibility is that of `K + SHIFT M`.
    shifted: bool,
    /// What each connector and below them each position sees of a unit force on each column of the track, made when a
    /// creeping load first needs it.
    influence: OnceLock<DMatrix<f64>>,
}

/// Newton solutions allowed before the load is halved.
const NEWTON_LIMIT: usize = 60;

/// How often the load may be halved.
const HALVINGS: usize = 12;

/// Shift of the stiffness where links alone hold a motion `[1/s^2]`, the operator's: the square of 0.1 Hz.
const SHIFT: f64 = 0.4;

/// How often what the shift holds may be brought back, and the change of the motion that ends that `[m, rad]`. A link of 1e5 N/m
/// under 10 t leaves 4 % of the change each time: ten times for rounding.
const SHIFT_ITERATIONS: usize = 200;
const SHIFT_SETTLED: f64 = 1e-12;

/// Lowest eigenvalue, as a share of the shift, below which a motion is held by nothing; iterations by which it is found.
const LOOSE: f64 = 1e-6;
const LOOSE_ITERATIONS: usize = 40;

impl StaticSolver {
    /// Factorises K once; where one-sided springs of banks alone hold a motion, `K + SHIFT M`, whose share is then taken off by
    /// iteration.
    ///
    /// # Errors
    /// [`AnalysisError::Factor`] where K is singular: the supports leave a motion that nothing restores.
    pub fn new(bridge: &Arc<Bridge>) -> Result<Self, AnalysisError> {
        let shifted = bridge.links.len() > bridge.joint_connectors && is_loose(bridge);
        let flexibility = if shifted {
            let shifted = SymmetricMatrix::combine(&[(1.0, &bridge.k), (SHIFT, &bridge.m)])?;
            Flexibility::new("K + s M of the bridge", &shifted, bridge)?
        } else {
            Flexibility::new("stiffness of the bridge", &bridge.k, bridge)?
        };
        Ok(Self {
            bridge: Arc::clone(bridge),
            flexibility,
            shifted,
            influence: OnceLock::new(),
        })
    }

    /// Solves `K u + B^T N(B u) = f` from the dead state on, `u` the motion from there.
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
        let largest = |rows: &[(usize, SparseRow)], value: &dyn Fn(f64) -> f64| {
            let values = rows.iter().map(|(_, row)| value(row.dot(&u)));
            values.fold(0.0_f64, f64::max)
        };
        let pins_n = self.pins_n(&load, &u, case.dead.as_deref());
        let at_rest = Rest {
            bridge,
            u: &u,
            contact: &contact,
            pins_n: &pins_n,
            dead: case.dead.as_deref(),
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
            corners_m: bridge.deck_corners.iter().map(|row| 0.0 - row.dot(&u)).collect(),
            // nothing is 0, not -0
            deflection_m: bridge.positions.iter().map(|row| 0.0 - row.dot(&u)).collect(),
            joints,
            pins_n,
            peak_edge_deflection_m: largest(&bridge.edges, &|z| -z),
            peak_roll_rad: largest(&bridge.rolls, &f64::abs),
            influential_length_m: self.influential_length_m(&u, case.load_x_m),
            bottom_emerged: bridge.bottom_emerges(&u, case.dead.as_deref()),
            deck_submerged: bridge.deck_submerges(&u, case.dead.as_deref()),
            newton_iterations: contact.iterations,
            equilibrium: self.equilibrium(vehicle, case, load.placement(), (&contact.forces, &u)),
            dead: case.dead.clone(),
        })
    }

    /// Solves `K u_0 + B^T N(B u_0) = f_dead`; none where no dead load acts and no link presses by itself.
    ///
    /// # Errors
    /// [`AnalysisError::NoDeadState`] where the contact does not settle, nothing holds the bridge or a deck lies under water.
    /// Equation (D1).
    pub fn dead_state(&self, case: &DeadCase) -> Result<Option<Arc<DeadState>>, AnalysisError> {
        dead::dead_state(self, case)
    }

    /// The static case as the whole state of the bridge, the dead state in it.
    ///
    /// # Errors
    /// As [`Self::solve`].
    pub fn state(&self, vehicle: &Vehicle, case: &StaticCase) -> Result<Snapshot, AnalysisError> {
        let (load, contact, mut u) = self.rest(vehicle, case)?;
        let mut elongations = contact.elongations;
        if let Some(dead) = &case.dead {
            add(&mut u, &dead.displacements);
            add(&mut elongations, &dead.elongations_m);
        }
        Ok(Snapshot {
            time_s: 0.0,
            elastic: u.clone(),
            u,
            beyond_water: None,
            inertial: None,
            waves: None,
            connectors: connectors(&contact.states, &contact.forces, &elongations),
            wheels: wheels(
                self.flexibility.track(),
                [(&vehicle.standing(), case.load_n)],
                &load,
                &[],
            ),
            rides: Vec::new(),
            dead: case.dead.clone(),
        })
    }

    /// The load, the connectors' forces and the displacement of a case.
    fn rest(&self, vehicle: &Vehicle, case: &StaticCase) -> Result<(Load, ContactSolution, Vec<f64>), AnalysisError> {
        let load = self.load(vehicle, case, case.load_x_m);
        let laws = case.laws(self.bridge.links.len());
        let dead = case.dead.as_deref();
        let unsettled = |iterations| AnalysisError::StaticNotConverged {
            iterations,
            load_x_m: case.load_x_m,
        };
        let among = self.flexibility.among_connectors();
        if !self.shifted {
            let e_free: Vec<f64> = (0..self.bridge.links.len())
                .map(|i| -self.flexibility.connector_to_track(i, &load.weight))
                .collect();
            let contact = brought_on(among, &laws, dead, &e_free).map_err(unsettled)?;
            let mut u = vec![0.0; self.bridge.dofs()];
            self.flexibility
                .add_track_response(&SparseRow::combine(&[(-1.0, &load.weight)]), &mut u);
            self.add_links(&contact.forces, dead, &mut u);
            return Ok((load, contact, u));
        }
        let mut u_free = vec![0.0; self.bridge.dofs()];
        self.flexibility.add_track_force(&load.weight, -1.0, &mut u_free);
        self.flexibility.solve(&mut u_free);
        let held = self.held_from(&u_free, dead, |e_free| {
            brought_on(among, &laws, dead, e_free).map_err(unsettled)
        })?;
        let (contact, u) = held.ok_or_else(|| unsettled(0))?;
        Ok((load, contact, u))
    }

    /// Adds what links do to a motion, beyond what they do at rest.
    fn add_links(&self, forces_n: &[f64], dead: Option<&DeadState>, u: &mut [f64]) {
        for (i, force) in forces_n.iter().enumerate() {
            self.flexibility
                .add_connector_response(i, rest_force_n(dead, i) - force, u);
        }
    }

    /// Links and motion under forces whose response without links is `u_free`, at rest before; none where nothing holds it.
    fn held(
        &self,
        u_free: &[f64],
        contact: impl FnMut(&[f64]) -> Result<ContactSolution, AnalysisError>,
    ) -> Result<Option<(ContactSolution, Vec<f64>)>, AnalysisError> {
        self.held_from(u_free, None, contact)
    }

    /// As [`Self::held`], from a dead state on. What the shift of the matrix holds is brought back as a force,
    /// `(K + s M) u = f + s M u`, until the motion no longer changes.
    /// Equation (D2).
    fn held_from(
        &self,
        u_free: &[f64],
        dead: Option<&DeadState>,
        mut contact: impl FnMut(&[f64]) -> Result<ContactSolution, AnalysisError>,
    ) -> Result<Option<(ContactSolution, Vec<f64>)>, AnalysisError> {
        let (mut back, mut last) = (vec![0.0; u_free.len()], vec![0.0; u_free.len()]);
        for _ in 0..SHIFT_ITERATIONS {
            let mut u = u_free.to_vec();
            add(&mut u, &back);
            let e_free: Vec<f64> = self.bridge.links.iter().map(|link| link.row.dot(&u)).collect();
            let solution = contact(&e_free)?;
            self.add_links(&solution.forces, dead, &mut u);
            if !self.shifted {
                return Ok(Some((solution, u)));
            }
            let moved = u
                .iter()
                .zip(&last)
                .fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
            if moved <= SHIFT_SETTLED {
                return Ok(Some((solution, u)));
            }
            self.bridge.times_m.multiply(&u, &mut back);
            back.iter_mut().for_each(|x| *x *= SHIFT);
            self.flexibility.solve(&mut back);
            last = u;
        }
        Ok(None)
    }

    /// Force of each pin on the module left of it.
    fn pins_n(&self, load: &Load, u: &[f64], dead: Option<&DeadState>) -> Vec<[f64; 3]> {
        let down = std::slice::from_ref(&load.weight);
        let force = |(i, pin): (usize, &PinPlace)| {
            let at_rest = dead.map_or([0.0; 3], |dead| dead.pins_n[i]);
            let own = pin.rows.each_ref().map(|row| {
                row.force_n(&Acting {
                    elastic: u,
                    down,
                    ..Acting::default()
                })
            });
            [0, 1, 2].map(|d| own[d] + at_rest[d])
        };
        self.bridge.pins.iter().enumerate().map(force).collect()
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

    /// Whether links alone hold a motion of the bridge; a load cannot creep over it then.
    pub fn is_loose(&self) -> bool {
        self.shifted
    }

    /// A vehicle made ready to creep over the bridge under any connection and weight.
    pub fn creeping(&self, vehicle: &Vehicle) -> CreepingLoad {
        let positions = &self.bridge.positions;
        let influence = self.influence.get_or_init(|| self.flexibility.influence(positions));
        CreepingLoad::new(&self.bridge, &self.flexibility, influence, vehicle)
    }

    fn load(&self, vehicle: &Vehicle, case: &StaticCase, centre_x_m: f64) -> Load {
        let heading = Heading::standing(centre_x_m - vehicle.centre_ahead_m());
        Load::new(self.flexibility.track(), &vehicle.standing(), case.load_n, heading)
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
        (forces_n, u): (&[f64], &[f64]),
    ) -> Equilibrium {
        let mut result = case
            .dead
            .as_ref()
            .map_or_else(Equilibrium::default, |dead| dead.equilibrium);
        for point in vehicle.points().filter(|p| placement.cell(p.along).is_some()) {
            let force = -case.load_n * point.share;
            add_force(&mut result.load, force, placement.x_m(point), point.y_m);
        }
        for (i, water) in result.water.iter_mut().enumerate() {
            *water += self.bridge.water[i].dot(u);
        }
        let dead = case.dead.as_deref();
        let moved: Vec<f64> = (0..)
            .zip(forces_n)
            .map(|(i, force)| force - rest_force_n(dead, i))
            .collect();
        dead::add_holding(&self.bridge, &mut result, u, &moved, |_| 0.0);
        result
    }
}

/// `to += x`.
fn add(to: &mut [f64], x: &[f64]) {
    for (to, x) in to.iter_mut().zip(x) {
        *to += x;
    }
}

/// Whether a motion of the bridge is held by nothing but links: the lowest eigenvalue of K, by inverse iteration with a shift,
/// is nothing beside that shift.
fn is_loose(bridge: &Bridge) -> bool {
    let Ok(shifted) = SymmetricMatrix::combine(&[(1.0, &bridge.k), (SHIFT, &bridge.m)]) else {
        return false;
    };
    let Ok(factor) = Factor::new("K + s M of the bridge", &shifted) else {
        return false;
    };
    let (mut x, mut mx) = (vec![0.0; bridge.dofs()], vec![0.0; bridge.dofs()]);
    // a motion that is no one's mode
    x.iter_mut()
        .enumerate()
        .for_each(|(i, x)| *x = 1.0 + (0.7 * i as f64).sin());
    let mut lambda = f64::INFINITY;
    for _ in 0..LOOSE_ITERATIONS {
        bridge.times_m.multiply(&x, &mut mx);
        let mut next = mx.clone();
        factor.solve(&mut next);
        let over: f64 = x.iter().zip(&mx).map(|(x, mx)| x * mx).sum();
        let under: f64 = next.iter().zip(&mx).map(|(x, mx)| x * mx).sum();
        lambda = over / under - SHIFT;
        let size = next.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        next.iter_mut().for_each(|x| *x /= size);
        x = next;
    }
    lambda < LOOSE * SHIFT
}

/// Adds an upward force at (x, y) to resultants (force, moment about x, moment about y).
fn add_force(to: &mut [f64; 3], force: f64, x: f64, y: f64) {
    to[0] += force;
    to[1] += y * force;
    to[2] -= x * force;
}

/// The contact of links whose elongations without more forces than at rest are `e_full`; where Newton does not settle from the
/// states at rest, the load is brought on in parts.
///
/// # Errors
/// The number of Newton solutions made.
fn brought_on(
    among: &DMatrix<f64>,
    laws: &[LinkLaw],
    dead: Option<&DeadState>,
    e_full: &[f64],
) -> Result<ContactSolution, usize> {
    let nc = e_full.len();
    let mut problem = ContactProblem {
        e_free: vec![0.0; nc],
        connectors: among,
        weight: 1.0,
        connectors_riders: DMatrix::zeros(nc, 0),
        riders_connectors: DMatrix::zeros(0, nc),
        riders: DMatrix::zeros(0, 0),
        riders_free: DVector::zeros(0),
        one_sided: Vec::new(),
    };
    if let Some(dead) = dead {
        problem = problem.with_rest(&dead.forces_n);
    }
    let held = problem.e_free.clone();
    let mut states: Vec<State> = laws.iter().map(|law| law.state(0.0)).collect();
    let (mut reached, mut part, mut halvings, mut iterations) = (0.0_f64, 1.0_f64, 0, 0);
    loop {
        let target = (reached + part).min(1.0);
        problem.e_free = held.iter().zip(e_full).map(|(held, e)| held + target * e).collect();
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
                    return Err(iterations);
                }
            }
        }
    }
}

/// What joints do at rest, to be read.
struct Rest<'a> {
    bridge: &'a Bridge,
    /// The motion from the dead state.
    u: &'a [f64],
    contact: &'a ContactSolution,
    pins_n: &'a [[f64; 3]],
    dead: Option<&'a DeadState>,
}

impl JointReading for Rest<'_> {
    fn connector_n(&self, connector: usize) -> [f64; 2] {
        [self.contact.forces[connector]; 2]
    }

    fn elongation_m(&self, connector: usize) -> f64 {
        self.contact.elongations[connector] + self.dead.map_or(0.0, |dead| dead.elongations_m[connector])
    }

    fn pin_n(&self, pin: usize) -> [f64; 3] {
        self.pins_n[pin]
    }

    fn spring_m(&self, spring: usize) -> f64 {
        self.bridge.springs[spring].row.dot(self.u) + self.dead.map_or(0.0, |dead| dead.springs_m[spring])
    }
}
