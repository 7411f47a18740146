//! One step of the generalized-alpha scheme with contact, riding masses and vehicles on springs.
//!
//! Knows the balance at alpha and its energies. Does not know when to stop or what is reported.

use super::StepMatrix;
use super::riders::{DeckMotion, MeasuredRider, Pressing, Riders};
use crate::analysis::modes::Rayleigh;
use crate::analysis::snapshot::RideNow;
use crate::bridge::{Acting, Bridge, Heading, Load, PinPlace, Rider, Rides, Track};
use crate::connector::State;
use crate::contact::{ContactProblem, ContactSolution, Dashpot, DashpotTrail, LinkLaw, NotSettled, rest_force_n};
use crate::fem::SparseRow;
use crate::radiation::{Convolution, Remembered};
use crate::response::{DeadState, StepEnergies};
use crate::riding::{FreeRide, Ride, RideEnergies, RidingStep};
use crate::scheme::{Newmark, Scalar};
use crate::traffic::{Driven, Presence, Traffic};
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
    /// Force of each rider on the deck: inertia force `m (r u'' + ...)` of a mass, force of a spring `[N]`.
    pub rider_forces: Vec<f64>,
    /// Motion of each vehicle on springs; of no meaning for others.
    pub rides: Vec<Ride>,
    pub newton_iterations: usize,
    /// Energies of the step that led here.
    pub spent: StepEnergies,
    /// What water with memory remembers; nothing of other waters.
    pub remembered: Remembered,
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

    /// The bridge's motion.
    fn deck(&self) -> DeckMotion<'_> {
        DeckMotion {
            u: &self.u,
            v: &self.v,
            a: &self.a,
        }
    }

    /// What rides along with its forces.
    fn pressing(&self) -> Pressing<'_> {
        Pressing {
            load: &self.load,
            forces: &self.rider_forces,
        }
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
    pub traffic: &'a Traffic,
    /// When each vehicle's springs are awake.
    pub presences: Vec<Presence>,
    /// Vehicles on springs at the step length after some halvings, vehicle after vehicle.
    pub riding: Vec<Vec<Option<RidingStep>>>,
    pub rayleigh: Rayleigh,
    /// Law of each connector.
    pub laws: Vec<LinkLaw>,
    /// Connectors that have dashpots.
    pub dashpots: Vec<Dashpot>,
    /// Whether forces of pins are wanted.
    pub pins: bool,
    /// The memory of the water, where it has one.
    pub convolution: Option<&'a Convolution>,
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
            rides: self
                .traffic
                .vehicles
                .iter()
                .map(|driven| self.ride_at_rest(driven))
                .collect(),
            states: self.laws.iter().map(|law| law.state(0.0)).collect(),
            forces: (0..connectors).map(|i| self.rest_n(i)).collect(),
            elongations: vec![0.0; connectors],
            rider_forces: vec![0.0; load.riders.len()],
            remembered: self.convolution.map(Convolution::at_rest).unwrap_or_default(),
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
        let known_waves = self
            .convolution
            .map(|memory| memory.known(&old.remembered, matrix.scheme.h)); // (W6)
        let mut d = self.predict(matrix, old, (&load, known_waves.as_deref())); // (T3), (T4)
        let riders = self.riders(matrix);
        let mut free = riders.predict(&old.rides, &load); // (V4)
        let problem = self.contact_problem(matrix, old, &load, &d, &free); // (C1), (T5), (V5)
        let h = matrix.scheme.h;
        let laws = old.dashpots.laws(&self.dashpots, &self.laws, &old.elongations, h); // (C4)
        let mut contact = problem.solve(&laws, &self.first_states(old, &load), newton_limit)?; // (C2)
        self.correct(matrix, &load, &contact, &mut d);
        let mut new = self.advance(matrix, old, &d); // (T2)
        new.time_s = time_s;
        new.load = load;
        new.rider_forces = self.unscaled(matrix, &new.load, &contact.riders);
        contact.states.truncate(self.laws.len());
        new.states = contact.states;
        let mut rides = old.rides.clone();
        let along = |row: &SparseRow| matrix.flexibility.track_dot(row, &d);
        let pressing = [old.pressing(), new.pressing()];
        let ridden = riders.finish(&mut rides, &mut free, new.deck(), pressing, along);
        new.rides = rides;
        self.remember(matrix, old, known_waves, &mut new);
        new.forces = contact.forces;
        new.elongations = contact.elongations;
        let way = [&*old.elongations, &*new.elongations];
        new.dashpots = old.dashpots.follow(&self.dashpots, way, &new.forces, h);
        new.newton_iterations = contact.iterations;
        new.spent = self.account(matrix, old, &new, &d, ridden); // (R1)
        new.balance = self.pins.then(|| self.balance(matrix, old, &new)); // (J6)
        Ok(new)
    }

    /// The step without new connector and inertia forces, `A d = f - M (y_m + b y_v) - K (u_0 + a y_v)`.
    fn predict(&self, matrix: &StepMatrix, old: &Motion, (load, waves): (&Load, Option<&[f64]>)) -> Vec<f64> {
        let mut d = self.known_forces(matrix, old);
        if let Some(waves) = waves {
            self.add_known_waves(matrix, old, waves, &mut d);
        }
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
        let mut pressed = SparseRow::default();
        for (rider, q) in load.riders.iter().zip(&contact.riders) {
            pressed.0.extend(rider.row.0.iter().map(|&(c, r)| (c, -q * r)));
        }
        flexibility.add_track_response(&SparseRow::from_entries(pressed.0), d);
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

    /// Adds the forces of water with memory at alpha, `(1 - alpha_f) F_1 + alpha_f F_0`, without what the step's d adds to F_1; that
    /// is in the matrix of the step.
    /// Equation (W6).
    fn add_known_waves(&self, matrix: &StepMatrix, old: &Motion, known: &[f64], f: &mut [f64]) {
        let (Some(waves), Some(memory)) = (&self.bridge.waves, self.convolution) else {
            return;
        };
        let s = &matrix.scheme;
        let free: Vec<f64> = old.v.iter().zip(&old.a).map(|(v, a)| s.v_v * v + s.v_a * a).collect();
        let pressed = memory.at_end(s.h) * DVector::from_vec(waves.motion(&free));
        let forces = known.iter().zip(pressed.iter()).zip(&old.remembered.force);
        let forces: Vec<f64> = forces
            .map(|((known, pressed), old)| s.at_f(known - pressed, *old))
            .collect();
        waves.add_forces(&forces, f);
    }

    /// Takes the velocity at the step's end into the memory of the water.
    fn remember(&self, matrix: &StepMatrix, old: &Motion, known: Option<Vec<f64>>, new: &mut Motion) {
        if let (Some(waves), Some(memory), Some(mut force)) = (&self.bridge.waves, self.convolution, known) {
            let h = matrix.scheme.h;
            let velocity = waves.motion(&new.v);
            let pressed = memory.at_end(h) * DVector::from_column_slice(&velocity);
            force.iter_mut().zip(pressed.iter()).for_each(|(f, p)| *f -= p);
            new.remembered = memory.follow(&old.remembered, h, velocity, force);
        }
    }

    /// Forces of water with memory where the balance of a step holds.
    fn waves_at_balance(&self, matrix: &StepMatrix, old: &Motion, new: &Motion) -> Option<Vec<f64>> {
        self.convolution?;
        let forces = new.remembered.force.iter().zip(&old.remembered.force);
        Some(forces.map(|(new, old)| matrix.scheme.at_f(*new, *old)).collect())
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

    /// The vehicles where they are at a time.
    fn load(&self, time_s: f64) -> Load {
        let mut load = Load::default();
        for (driven, presence) in self.traffic.vehicles.iter().zip(&self.presences) {
            let heading = Heading::of(self.track, &driven.drive, time_s);
            load.add(
                self.track,
                &driven.vehicle,
                driven.load_n,
                heading,
                presence.holds(time_s),
            );
        }
        load
    }

    /// All forces of the balance at alpha that do not wait for the new instant.
    /// Equation (T3).
    fn known_forces(&self, matrix: &StepMatrix, old: &Motion) -> Vec<f64> {
        let (s, Rayleigh { a, b, .. }) = (&matrix.scheme, self.rayleigh);
        let (on_v, on_a) = ((1.0 - s.alpha_f) * s.v_v + s.alpha_f, (1.0 - s.alpha_f) * s.v_a);
        let y_v: Vec<f64> = old.v.iter().zip(&old.a).map(|(v, a)| on_v * v + on_a * a).collect();
        let mut f = vec![0.0; y_v.len()];
        self.bridge.times_k.multiply(&y_v, &mut f);
        let m_v = (1.0 - s.alpha_m) * s.a_v + b * on_v;
        let m_a = (1.0 - s.alpha_m) * s.a_a + s.alpha_m + b * on_a;
        for (i, f) in f.iter_mut().enumerate() {
            *f = -a * *f - old.ku[i] - m_v * old.mv[i] - m_a * old.ma[i];
        }
        let beyond_water = self.rayleigh.beyond_water();
        if beyond_water != 0.0 {
            let mut of_water = vec![0.0; y_v.len()];
            self.bridge.times_k_water.multiply(&y_v, &mut of_water);
            f.iter_mut().zip(&of_water).for_each(|(f, w)| *f += beyond_water * w);
        }
        for (i, (connector, force)) in self.bridge.links.iter().zip(&old.forces).enumerate() {
            connector.row.add_to(-s.alpha_f * (force - self.rest_n(i)), &mut f);
        }
        matrix.flexibility.add_track_force(&old.load.weight, -s.alpha_f, &mut f);
        for (rider, q) in old.load.riders.iter().zip(&old.rider_forces) {
            let old_weight = if rider.is_spring() { s.alpha_f } else { s.alpha_m };
            matrix.flexibility.add_track_force(&rider.row, -old_weight * q, &mut f);
        }
        f
    }

    /// The small system of the step.
    fn contact_problem<'l>(
        &self,
        matrix: &'l StepMatrix,
        old: &Motion,
        load: &Load,
        d: &[f64],
        free: &[FreeRide],
    ) -> ContactProblem<'l> {
        let (flexibility, along) = (&matrix.flexibility, self.riders(matrix));
        let connectors = &self.bridge.links;
        let (nc, nr) = (connectors.len(), load.riders.len());
        let measured = |rider: &Rider| along.measured(old.deck(), load, rider, free);
        let rows: Vec<MeasuredRider> = load.riders.iter().map(measured).collect();
        let mut riders = DMatrix::from_fn(nr, nr, |i, j| {
            flexibility.track_to_track(&rows[i].measure, &load.riders[j].row)
        });
        for (i, row) in rows.iter().enumerate() {
            riders[(i, i)] += row.own;
            for (j, other) in load.riders.iter().enumerate() {
                riders[(i, j)] += along.among_wheels(&load.riders[i], other);
            }
        }
        let problem = ContactProblem {
            e_free: connectors
                .iter()
                .zip(&old.elongations)
                .map(|(c, e)| e + c.row.dot(d))
                .collect(),
            connectors: flexibility.among_connectors(),
            weight: 1.0 - matrix.scheme.alpha_f,
            connectors_riders: DMatrix::from_fn(nc, nr, |i, r| flexibility.connector_to_track(i, &load.riders[r].row)),
            riders_connectors: DMatrix::from_fn(nr, nc, |r, i| flexibility.connector_to_track(i, &rows[r].measure)),
            riders,
            riders_free: DVector::from_iterator(
                nr,
                rows.iter()
                    .map(|row| flexibility.track_dot(&row.measure, d) + row.known),
            ),
            one_sided: (0..nr).filter(|&r| load.riders[r].is_spring()).collect(),
        };
        match &self.dead {
            None => problem,
            Some(dead) => problem.with_rest(&dead.forces_n),
        }
    }

    /// What rides along at the length of a step.
    fn riders<'r>(&'r self, matrix: &'r StepMatrix) -> Riders<'r> {
        Riders {
            track: self.track,
            traffic: self.traffic,
            riding: &self.riding[matrix.halvings],
            scheme: &matrix.scheme,
        }
    }

    /// Vehicles on springs as they are.
    pub(super) fn rides_now(&self, now: &Motion) -> Vec<RideNow> {
        let each = self.traffic.vehicles.iter().zip(&now.rides).enumerate();
        let ride = |(vehicle, (driven, ride)): (usize, (&Driven, &Ride))| {
            let springs = driven.vehicle.springs.as_ref()?;
            Some(RideNow {
                vehicle,
                moved: ride.moved(springs).collect(),
                accelerations: ride.a.clone(),
                wheels_n: ride.wheels_n.iter().map(|force| driven.scale() * force).collect(),
            })
        };
        each.filter_map(ride).collect()
    }

    /// A vehicle at rest where it wakes, on the road's height there.
    fn ride_at_rest(&self, driven: &Driven) -> Ride {
        driven.vehicle.springs.as_ref().map_or_else(Ride::default, |springs| {
            Ride::at_rest(springs, self.traffic.level_m(driven.drive.backward))
        })
    }

    /// First guess of the states: those before, a wheel pressing where it did.
    fn first_states(&self, old: &Motion, load: &Load) -> Vec<State> {
        let pressing = |rider: &Rider| match rider.rides {
            Rides::Spring { wheel, .. } if old.rides[rider.vehicle].wheels_n[wheel] > 0.0 => Some(State::Compression),
            Rides::Spring { .. } => Some(State::Open),
            Rides::Mass { .. } => None,
        };
        old.states
            .iter()
            .copied()
            .chain(load.riders.iter().filter_map(pressing))
            .collect()
    }

    /// Forces of riders from their scaled ones.
    fn unscaled(&self, matrix: &StepMatrix, load: &Load, scaled: &[f64]) -> Vec<f64> {
        let s = &matrix.scheme;
        let force = |(rider, q): (&Rider, &f64)| q / (1.0 - if rider.is_spring() { s.alpha_f } else { s.alpha_m });
        load.riders.iter().zip(scaled).map(force).collect()
    }

    /// The forces of connectors and pins where the balance holds, and when that is.
    fn balance(&self, matrix: &StepMatrix, old: &Motion, new: &Motion) -> BalanceForces {
        let (s, Rayleigh { a, b, .. }) = (&matrix.scheme, self.rayleigh);
        let dofs = 0..new.u.len();
        let v = |i: usize| s.at_f(new.v[i], old.v[i]);
        let elastic: Vec<f64> = dofs.clone().map(|i| s.at_f(new.u[i], old.u[i]) + a * v(i)).collect();
        let inertial: Vec<f64> = dofs.clone().map(|i| s.at_m(new.a[i], old.a[i]) + b * v(i)).collect();
        let beyond_water = self.rayleigh.beyond_water();
        let beyond_water: Option<Vec<f64>> = (beyond_water != 0.0).then(|| dofs.map(|i| beyond_water * v(i)).collect());
        let waves = self.waves_at_balance(matrix, old, new);
        let shares = [(1.0 - s.alpha_f, 1.0 - s.alpha_m, new), (s.alpha_f, s.alpha_m, old)];
        let down: Vec<SparseRow> = shares
            .iter()
            .flat_map(|(f, m, instant)| {
                let riders = instant.load.riders.iter().zip(&instant.rider_forces);
                let weight = move |rider: &Rider| if rider.is_spring() { f } else { m };
                let pressed = riders.map(move |(rider, q)| SparseRow::combine(&[(weight(rider) * q, &rider.row)]));
                pressed.chain([SparseRow::combine(&[(*f, &instant.load.weight)])])
            })
            .collect();
        let acting = Acting {
            elastic: &elastic,
            beyond_water: beyond_water.as_deref(),
            inertial: Some(&inertial),
            waves: waves.as_deref(),
            down: &down,
        };
        let force = |(i, pin): (usize, &PinPlace)| {
            let at_rest = self.dead.as_ref().map_or([0.0; 3], |dead| dead.pins_n[i]);
            let moved = pin.rows.each_ref().map(|row| row.force_n(&acting));
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
    fn account(
        &self,
        matrix: &StepMatrix,
        old: &Motion,
        new: &Motion,
        d: &[f64],
        ridden: RideEnergies,
    ) -> StepEnergies {
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
        let beyond_water = self.rayleigh.beyond_water();
        let of_water = if beyond_water == 0.0 {
            0.0
        } else {
            let mut pressed = vec![0.0; d.len()];
            self.bridge.times_k_water.multiply(d, &mut pressed);
            let v = (0..d.len()).map(|i| s.at_f(new.v[i], old.v[i]));
            v.zip(&pressed).map(|(v, pressed)| v * pressed).sum()
        };
        let radiated = match (&self.bridge.waves, self.waves_at_balance(matrix, old, new)) {
            (Some(waves), Some(forces)) => -dot(&waves.motion(d), &forces),
            _ => 0.0,
        };
        let (mut springs, mut dashpots) = (0.0, 0.0);
        for i in 0..new.forces.len() {
            let lengthening = new.elongations[i] - old.elongations[i];
            let [damped, damped_old] = [new, old].map(|m| m.dashpots.in_balance.get(i).copied().unwrap_or(0.0));
            springs += lengthening * (s.at_f(new.forces[i] - damped, old.forces[i] - damped_old) - self.rest_n(i));
            dashpots += lengthening * s.at_f(damped, damped_old);
        }
        // what springs do to the deck stays within
        let riders = |instant: &Motion| -> f64 {
            let riders = instant.load.riders.iter().zip(&instant.rider_forces);
            let masses = riders.filter(|(rider, _)| !rider.is_spring());
            masses.map(|(r, q)| q * flexibility.track_dot(&r.row, d)).sum()
        };
        let weights = s.at_f(
            flexibility.track_dot(&new.load.weight, d),
            flexibility.track_dot(&old.load.weight, d),
        );
        StepEnergies {
            kinetic,
            strain,
            connectors,
            rayleigh: self.rayleigh.a * damping_k + self.rayleigh.b * damping_m - beyond_water * of_water,
            radiated,
            dashpots: dashpots + ridden.dampers,
            vehicles: old.spent.vehicles + ridden.stored,
            numerical: ridden.numerical
                + (inertia + old.spent.kinetic - kinetic)
                + (stiffness + old.spent.strain - strain)
                + (springs + old.spent.connectors - connectors),
            work: ridden.work - weights - s.at_m(riders(new), riders(old)),
        }
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
