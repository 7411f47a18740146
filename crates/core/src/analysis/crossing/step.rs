//! One step of the generalized-alpha scheme with contact and riding masses.
//!
//! Knows the balance at alpha and its energies. Does not know when to stop or what is reported.

use super::StepMatrix;
use crate::analysis::modes::Rayleigh;
use crate::bridge::{Bridge, Load, PinPlace, Rider, Track, front_x_m};
use crate::connector::State;
use crate::contact::{ContactProblem, ContactSolution, Dashpot, DashpotTrail, LinkLaw, NotSettled, rest_force_n};
use crate::fem::SparseRow;
use crate::response::{DeadState, StepEnergies};
use crate::scheme::{Newmark, Scalar};
use crate::vehicle::Vehicle;
use nalgebra::{DMatrix, DVector};
use std::sync::Arc;

/// The motion at one time, with what the next step and the energy balance need of it.
#[derive(Debug, Clone, Default)]
pub(super) struct Motion {
    pub time_s: f64,
    pub u: Vec<f64>,
    pub v: Vec<f64>,
    pub a: Vec<f64>,
    /// K u, M v, M a.
    pub ku: Vec<f64>,
    pub mv: Vec<f64>,
    pub ma: Vec<f64>,
    /// State, force in the balance and elongation of each connector, and what dashpots carry on.
    pub states: Vec<State>,
    pub forces: Vec<f64>,
    pub elongations: Vec<f64>,
    pub dashpots: DashpotTrail,
    pub load: Load,
    /// Inertia force of each rider, `m (r u'' + ...)` `[N]`.
    pub inertia: Vec<f64>,
    pub newton_iterations: usize,
    /// Energies of the step that led here.
    pub spent: StepEnergies,
    /// Forces where the balance of that step holds; none where nobody asks for pins.
    pub balance: Option<BalanceForces>,
}

/// Forces at the instant of the balance of a step.
#[derive(Debug, Clone, Default)]
pub(super) struct BalanceForces {
    pub time_s: f64,
    /// Of each connector.
    pub connectors_n: Vec<f64>,
    /// Of each pin on the module left of it.
    pub pins_n: Vec<[f64; 3]>,
}

impl Motion {
    /// Displacements and velocities of zero, without connectors and load.
    fn zero(dofs: usize) -> Self {
        let zero = || vec![0.0; dofs];
        Self {
            u: zero(),
            v: zero(),
            a: zero(),
            ku: zero(),
            mv: zero(),
            ma: zero(),
            ..Self::default()
        }
    }

    /// Force of each connector by its law, tension positive `[N]`.
    pub(super) fn connector_forces(&self) -> &[f64] {
        self.dashpots.by_law(&self.forces)
    }

    pub(super) fn is_finite(&self) -> bool {
        self.spent.kinetic.is_finite() && self.spent.strain.is_finite()
    }
}

/// What stays the same through a crossing.
#[derive(Debug)]
pub(super) struct Stepper<'a> {
    pub bridge: &'a Bridge,
    pub track: &'a Track,
    pub vehicle: &'a Vehicle,
    pub load_n: f64,
    pub speed_m_s: f64,
    pub rayleigh: Rayleigh,
    /// Law of each connector.
    pub laws: Vec<LinkLaw>,
    /// Connectors that have dashpots.
    pub dashpots: Vec<Dashpot>,
    /// Whether forces of pins are wanted.
    pub pins: bool,
    /// The state at rest from which the motion counts; forces of links are whole, the structure feels what they are beyond it.
    pub dead: Option<Arc<DeadState>>,
}

impl Stepper<'_> {
    /// Rest under the vehicle's first place.
    pub(super) fn at_rest(&self, time_s: f64) -> Motion {
        let load = self.load(time_s);
        let connectors = self.laws.len();
        Motion {
            time_s,
            states: self.laws.iter().map(|law| law.state(0.0)).collect(),
            forces: (0..connectors).map(|i| self.rest_n(i)).collect(),
            elongations: vec![0.0; connectors],
            inertia: vec![0.0; load.riders.len()],
            load,
            ..Motion::zero(self.bridge.dofs())
        }
    }

    /// One step: predict, meet the contact, correct, account.
    pub(super) fn step(
        &self,
        matrix: &StepMatrix,
        old: &Motion,
        time_s: f64,
        newton_limit: usize,
    ) -> Result<Motion, NotSettled> {
        let load = self.load(time_s); // (V1)
        let mut d = self.predict(matrix, old, &load); // (T3), (T4)
        let problem = self.contact_problem(matrix, old, &load, &d); // (C1), (T5)
        let h = matrix.scheme.h;
        let laws = old.dashpots.laws(&self.dashpots, &self.laws, &old.elongations, h); // (C4)
        let contact = problem.solve(&laws, &old.states, newton_limit)?; // (C2)
        self.correct(matrix, &load, &contact, &mut d);
        let mut new = self.advance(matrix, old, &d); // (T2)
        new.time_s = time_s;
        new.load = load;
        new.inertia = contact
            .riders
            .iter()
            .map(|q| q / (1.0 - matrix.scheme.alpha_m))
            .collect();
        new.states = contact.states;
        new.forces = contact.forces;
        new.elongations = contact.elongations;
        let way = [&*old.elongations, &*new.elongations];
        new.dashpots = old.dashpots.follow(&self.dashpots, way, &new.forces, h);
        new.newton_iterations = contact.iterations;
        new.spent = self.account(matrix, old, &new, &d); // (R1)
        new.balance = self.pins.then(|| self.balance(matrix, old, &new)); // (J6)
        Ok(new)
    }

    /// The step without new connector and inertia forces, `A d = f - M (y_m + b y_v) - K (u_0 + a y_v)`.
    fn predict(&self, matrix: &StepMatrix, old: &Motion, load: &Load) -> Vec<f64> {
        let mut d = self.known_forces(matrix, old);
        let weight = -(1.0 - matrix.scheme.alpha_f);
        matrix.flexibility.add_track_force(&load.weight, weight, &mut d);
        matrix.flexibility.solve(&mut d);
        d
    }

    /// Adds to a step what the new connector and inertia forces do.
    fn correct(&self, matrix: &StepMatrix, load: &Load, contact: &ContactSolution, d: &mut [f64]) {
        let (s, flexibility) = (&matrix.scheme, &matrix.flexibility);
        for (i, force) in contact.forces.iter().enumerate() {
            flexibility.add_connector_response(i, -(1.0 - s.alpha_f) * (force - self.rest_n(i)), d);
        }
        let mut inertia = SparseRow::default();
        for (rider, q) in load.riders.iter().zip(&contact.riders) {
            inertia.0.extend(rider.row.0.iter().map(|&(c, r)| (c, -q * r)));
        }
        flexibility.add_track_response(&SparseRow::from_entries(inertia.0), d);
    }

    /// The motion after a step in which the displacement changes by d.
    fn advance(&self, matrix: &StepMatrix, old: &Motion, d: &[f64]) -> Motion {
        let mut new = Motion::zero(d.len());
        let newmark = Newmark::of(Scalar, &matrix.scheme);
        for (i, &d) in d.iter().enumerate() {
            [new.u[i], new.v[i], new.a[i]] = newmark.advance(Scalar, d, [old.u[i], old.v[i], old.a[i]]);
        }
        self.bridge.times_k.multiply(&new.u, &mut new.ku);
        self.bridge.times_m.multiply(&new.v, &mut new.mv);
        self.bridge.times_m.multiply(&new.a, &mut new.ma);
        new
    }

    /// Force of a link at rest `[N]`.
    fn rest_n(&self, link: usize) -> f64 {
        rest_force_n(self.dead.as_deref(), link)
    }

    /// What a link takes up beyond its force at rest, from there to the elongation `e` `[J]`.
    fn energy_from_rest(&self, link: usize, law: &LinkLaw, e: f64) -> f64 {
        match &self.dead {
            None => law.energy(e),
            Some(_) => law.energy(e) - law.energy(0.0) - self.rest_n(link) * e,
        }
    }

    /// The vehicle where it is at a time.
    fn load(&self, time_s: f64) -> Load {
        let front_x_m = front_x_m(self.track, self.speed_m_s, time_s);
        Load::new(self.track, self.vehicle, self.load_n, front_x_m, self.speed_m_s)
    }

    /// All forces of the balance at alpha that do not wait for the new instant.
    /// Equation (T3).
    fn known_forces(&self, matrix: &StepMatrix, old: &Motion) -> Vec<f64> {
        let (s, Rayleigh { a, b }) = (&matrix.scheme, self.rayleigh);
        let (on_v, on_a) = ((1.0 - s.alpha_f) * s.v_v + s.alpha_f, (1.0 - s.alpha_f) * s.v_a);
        let y_v: Vec<f64> = old.v.iter().zip(&old.a).map(|(v, a)| on_v * v + on_a * a).collect();
        let mut f = vec![0.0; y_v.len()];
        self.bridge.times_k.multiply(&y_v, &mut f);
        let m_v = (1.0 - s.alpha_m) * s.a_v + b * on_v;
        let m_a = (1.0 - s.alpha_m) * s.a_a + s.alpha_m + b * on_a;
        for (i, f) in f.iter_mut().enumerate() {
            *f = -a * *f - old.ku[i] - m_v * old.mv[i] - m_a * old.ma[i];
        }
        for (i, (connector, force)) in self.bridge.links.iter().zip(&old.forces).enumerate() {
            connector.row.add_to(-s.alpha_f * (force - self.rest_n(i)), &mut f);
        }
        matrix.flexibility.add_track_force(&old.load.weight, -s.alpha_f, &mut f);
        for (rider, q) in old.load.riders.iter().zip(&old.inertia) {
            matrix.flexibility.add_track_force(&rider.row, -s.alpha_m * q, &mut f);
        }
        f
    }

    /// The small system of the step. Riders are measured in displacement: `q' / ((1 - alpha_m) m c_a) = g . d + known`
    /// with `g = r + (2 V c_v/c_a) r_x + (V^2/c_a) r_xx` and `q' = (1 - alpha_m) q`.
    fn contact_problem<'l>(&self, matrix: &'l StepMatrix, old: &Motion, load: &Load, d: &[f64]) -> ContactProblem<'l> {
        let (s, flexibility) = (&matrix.scheme, &matrix.flexibility);
        let connectors = &self.bridge.links;
        let (nc, nr) = (connectors.len(), load.riders.len());
        let measures: Vec<SparseRow> = load.riders.iter().map(|rider| self.measure(matrix, rider)).collect();
        let mut riders = DMatrix::from_fn(nr, nr, |i, j| {
            flexibility.track_to_track(&measures[i], &load.riders[j].row)
        });
        for (i, rider) in load.riders.iter().enumerate() {
            riders[(i, i)] += 1.0 / ((1.0 - s.alpha_m) * rider.mass_kg * s.c_a);
        }
        let known = |rider: &Rider| {
            let on = |row: &SparseRow, x: &dyn Fn(usize) -> f64| -> f64 {
                row.0.iter().map(|&(c, v)| v * x(flexibility.track().dof(c))).sum()
            };
            let mut total = on(&rider.row, &|i| s.a_v * old.v[i] + s.a_a * old.a[i]);
            if let Some((r_x, r_xx)) = &rider.derivatives {
                let speed = self.speed_m_s;
                total += 2.0 * speed * on(r_x, &|i| s.v_v * old.v[i] + s.v_a * old.a[i]);
                total += speed * speed * on(r_xx, &|i| old.u[i]);
            }
            total / s.c_a
        };
        let problem = ContactProblem {
            e_free: connectors
                .iter()
                .zip(&old.elongations)
                .map(|(c, e)| e + c.row.dot(d))
                .collect(),
            connectors: flexibility.among_connectors(),
            weight: 1.0 - s.alpha_f,
            connectors_riders: DMatrix::from_fn(nc, nr, |i, r| flexibility.connector_to_track(i, &load.riders[r].row)),
            riders_connectors: DMatrix::from_fn(nr, nc, |r, i| flexibility.connector_to_track(i, &measures[r])),
            riders,
            riders_free: DVector::from_iterator(
                nr,
                load.riders
                    .iter()
                    .zip(&measures)
                    .map(|(rider, g)| flexibility.track_dot(g, d) + known(rider)),
            ),
        };
        match &self.dead {
            None => problem,
            Some(dead) => problem.with_rest(&dead.forces_n),
        }
    }

    /// The row by which a rider is measured. Equation (T5).
    fn measure(&self, matrix: &StepMatrix, rider: &Rider) -> SparseRow {
        let s = &matrix.scheme;
        match &rider.derivatives {
            None => rider.row.clone(),
            Some((r_x, r_xx)) => {
                let speed = self.speed_m_s;
                SparseRow::combine(&[
                    (1.0, &rider.row),
                    (2.0 * speed * s.c_v / s.c_a, r_x),
                    (speed * speed / s.c_a, r_xx),
                ])
            }
        }
    }

    /// The forces of connectors and pins where the balance holds, and when that is.
    fn balance(&self, matrix: &StepMatrix, old: &Motion, new: &Motion) -> BalanceForces {
        let (s, Rayleigh { a, b }) = (&matrix.scheme, self.rayleigh);
        let dofs = 0..new.u.len();
        let v = |i: usize| s.at_f(new.v[i], old.v[i]);
        let elastic: Vec<f64> = dofs.clone().map(|i| s.at_f(new.u[i], old.u[i]) + a * v(i)).collect();
        let inertial: Vec<f64> = dofs.map(|i| s.at_m(new.a[i], old.a[i]) + b * v(i)).collect();
        let shares = [(1.0 - s.alpha_f, 1.0 - s.alpha_m, new), (s.alpha_f, s.alpha_m, old)];
        let down: Vec<SparseRow> = shares
            .iter()
            .flat_map(|(f, m, instant)| {
                let riders = instant.load.riders.iter().zip(&instant.inertia);
                let inertia = riders.map(move |(rider, q)| SparseRow::combine(&[(m * q, &rider.row)]));
                inertia.chain([SparseRow::combine(&[(*f, &instant.load.weight)])])
            })
            .collect();
        let force = |(i, pin): (usize, &PinPlace)| {
            let at_rest = self.dead.as_ref().map_or([0.0; 3], |dead| dead.pins_n[i]);
            let moved = pin
                .rows
                .each_ref()
                .map(|row| row.force_n(&elastic, Some(&inertial), &down));
            [0, 1, 2].map(|d| moved[d] + at_rest[d])
        };
        let connectors = new.forces.iter().zip(&old.forces);
        BalanceForces {
            time_s: s.at_f(new.time_s, old.time_s),
            connectors_n: connectors.map(|(new, old)| s.at_f(*new, *old)).collect(),
            pins_n: self.bridge.pins.iter().enumerate().map(force).collect(),
        }
    }

    /// Energies of the step by the scheme's own increments: each term of the balance at alpha times `d`. What a term gives
    /// beyond the change of its energy is numerical dissipation.
    fn account(&self, matrix: &StepMatrix, old: &Motion, new: &Motion, d: &[f64]) -> StepEnergies {
        let (s, flexibility) = (&matrix.scheme, &matrix.flexibility);
        let kinetic = 0.5 * dot(&new.v, &new.mv);
        let strain = 0.5 * dot(&new.u, &new.ku);
        let connectors: f64 = self
            .laws
            .iter()
            .zip(&new.elongations)
            .enumerate()
            .map(|(i, (law, &e))| self.energy_from_rest(i, law, e))
            .sum();
        let (mut inertia, mut stiffness, mut damping_m, mut damping_k) = (0.0, 0.0, 0.0, 0.0);
        for (i, d) in d.iter().enumerate() {
            inertia += d * s.at_m(new.ma[i], old.ma[i]);
            stiffness += d * s.at_f(new.ku[i], old.ku[i]);
            damping_m += d * s.at_f(new.mv[i], old.mv[i]);
            damping_k += s.at_f(new.v[i], old.v[i]) * (new.ku[i] - old.ku[i]);
        }
        let (mut springs, mut dashpots) = (0.0, 0.0);
        for i in 0..new.forces.len() {
            let lengthening = new.elongations[i] - old.elongations[i];
            let [damped, damped_old] = [new, old].map(|m| m.dashpots.in_balance.get(i).copied().unwrap_or(0.0));
            springs += lengthening * (s.at_f(new.forces[i] - damped, old.forces[i] - damped_old) - self.rest_n(i));
            dashpots += lengthening * s.at_f(damped, damped_old);
        }
        let riders = |instant: &Motion| -> f64 {
            instant
                .load
                .riders
                .iter()
                .zip(&instant.inertia)
                .map(|(r, q)| q * flexibility.track_dot(&r.row, d))
                .sum()
        };
        let weights = s.at_f(
            flexibility.track_dot(&new.load.weight, d),
            flexibility.track_dot(&old.load.weight, d),
        );
        StepEnergies {
            kinetic,
            strain,
            connectors,
            rayleigh: self.rayleigh.a * damping_k + self.rayleigh.b * damping_m,
            dashpots,
            numerical: (inertia + old.spent.kinetic - kinetic)
                + (stiffness + old.spent.strain - strain)
                + (springs + old.spent.connectors - connectors),
            work: -weights - s.at_m(riders(new), riders(old)),
        }
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
