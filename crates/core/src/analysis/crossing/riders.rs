//! What rides along in one step: the rows of masses and wheels on springs in the small system, and the vehicles' own motion.
//!
//! Knows one vehicle's equations and the deck's rows under it. Does not know the bridge's balance.

use crate::bridge::{Load, Rider, Rides, Track};
use crate::fem::SparseRow;
use crate::riding::{FreeRide, Ride, RideEnergies, RidingStep, UnderWheels};
use crate::scheme::Scheme;
use crate::traffic::Traffic;

/// What rides along at one step length.
#[derive(Debug, Clone, Copy)]
pub(super) struct Riders<'a> {
    pub track: &'a Track,
    pub traffic: &'a Traffic,
    /// Each vehicle's springs at the step length; none of a rigid vehicle.
    pub riding: &'a [Option<RidingStep>],
    pub scheme: &'a Scheme,
}

/// Motion of the bridge at an instant, one entry a dof.
#[derive(Debug, Clone, Copy)]
pub(super) struct DeckMotion<'a> {
    pub u: &'a [f64],
    pub v: &'a [f64],
    pub a: &'a [f64],
}

/// What rides along at an instant, with the force of each rider on the deck `[N]`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pressing<'a> {
    pub load: &'a Load,
    pub forces: &'a [f64],
}

/// A rider's row of the small system: what measures it, its own compliance, what is known of its measure.
pub(super) struct MeasuredRider {
    pub measure: SparseRow,
    pub own: f64,
    pub known: f64,
}

impl Riders<'_> {
    /// A rider's row of the small system. Riders are measured in displacement.
    pub(super) fn measured(&self, old: DeckMotion<'_>, load: &Load, rider: &Rider, free: &[FreeRide]) -> MeasuredRider {
        match &rider.rides {
            Rides::Mass { mass_kg, derivatives } => self.mass(old, load, rider, (*mass_kg, derivatives.as_ref())),
            Rides::Spring { wheel, slope } => self.wheel(old, load, rider, (*wheel, slope), free),
        }
    }

    /// A mass's row, `q' / ((1 - alpha_m) m c_a) = g . d + known` with
    /// `g = r + (2 V c_v/c_a) r_x + (V^2 r_xx + V' r_x) / c_a` and `q' = (1 - alpha_m) q`.
    /// Equation (T5).
    fn mass(
        &self,
        old: DeckMotion<'_>,
        load: &Load,
        rider: &Rider,
        (mass_kg, derivatives): (f64, Option<&(SparseRow, SparseRow)>),
    ) -> MeasuredRider {
        let s = self.scheme;
        let on = |row: &SparseRow, x: &dyn Fn(usize) -> f64| self.on_track(row, x);
        let mut known = on(&rider.row, &|i| s.a_v * old.v[i] + s.a_a * old.a[i]);
        let mut measure = rider.row.clone();
        if let Some((r_x, r_xx)) = derivatives {
            let heading = load.placements[rider.vehicle].heading;
            let (speed, rate) = (heading.speed_m_s, heading.acceleration_m_s2);
            known += 2.0 * speed * on(r_x, &|i| s.v_v * old.v[i] + s.v_a * old.a[i]);
            known += speed * speed * on(r_xx, &|i| old.u[i]);
            let mut terms = vec![
                (1.0, &rider.row),
                (2.0 * speed * s.c_v / s.c_a, r_x),
                (speed * speed / s.c_a, r_xx),
            ];
            if rate != 0.0 {
                known += rate * on(r_x, &|i| old.u[i]);
                terms.push((rate / s.c_a, r_x));
            }
            measure = SparseRow::combine(&terms);
        }
        MeasuredRider {
            measure,
            own: 1.0 / ((1.0 - s.alpha_m) * mass_kg * s.c_a),
            known: known / s.c_a,
        }
    }

    /// The row of a wheel on springs, `lambda' / ((1 - alpha_f) kappa) + S lambda' = g . d + known` with
    /// `g = r + (c V / kappa) r_x` and `lambda' = (1 - alpha_f) lambda`. Equation (V5).
    fn wheel(
        &self,
        old: DeckMotion<'_>,
        load: &Load,
        rider: &Rider,
        (wheel, slope): (usize, &SparseRow),
        free: &[FreeRide],
    ) -> MeasuredRider {
        let s = self.scheme;
        let none = || MeasuredRider {
            measure: SparseRow::default(),
            own: 1.0,
            known: 0.0,
        };
        let Some(riding) = self.riding(rider.vehicle) else {
            return none();
        };
        let (of, kappa) = (&riding.springs().wheels[wheel], riding.kappa[wheel]);
        let speed = load.placements[rider.vehicle].heading.speed_m_s;
        let [height, road_slope] = self.road(load, rider.vehicle, wheel);
        let on = |row: &SparseRow, x: &dyn Fn(usize) -> f64| self.on_track(row, x);
        let free = &free[rider.vehicle];
        let spring = on(&rider.row, &|i| old.u[i]) + height - free.y[wheel];
        let rate = on(&rider.row, &|i| s.v_v * old.v[i] + s.v_a * old.a[i])
            + speed * (on(slope, &|i| old.u[i]) + road_slope)
            - free.rate[wheel];
        let driven = &self.traffic.vehicles[rider.vehicle];
        MeasuredRider {
            measure: SparseRow::combine(&[(1.0, &rider.row), (of.damping_n_s_m * speed / kappa, slope)]),
            own: 1.0 / ((1.0 - s.alpha_f) * kappa * driven.scale()),
            known: (of.stiffness_n_m * spring + of.damping_n_s_m * rate) / kappa,
        }
    }

    /// What a wheel on springs sees of another one of its vehicle (V4).
    pub(super) fn among_wheels(&self, one: &Rider, other: &Rider) -> f64 {
        let (Rides::Spring { wheel: i, .. }, Rides::Spring { wheel: j, .. }) = (&one.rides, &other.rides) else {
            return 0.0;
        };
        if one.vehicle != other.vehicle {
            return 0.0;
        }
        let scale = self.traffic.vehicles[one.vehicle].scale();
        self.riding(one.vehicle)
            .map_or(0.0, |riding| riding.among[(*i, *j)] / scale)
    }

    /// The sum of a row of the track over what its columns have.
    fn on_track(&self, row: &SparseRow, x: &dyn Fn(usize) -> f64) -> f64 {
        row.0.iter().map(|&(c, v)| v * x(self.track.dof(c))).sum()
    }

    /// A vehicle's springs; none of a rigid vehicle.
    fn riding(&self, vehicle: usize) -> Option<&RidingStep> {
        self.riding[vehicle].as_ref()
    }

    /// Height of the road under a wheel and its slope, means over its points.
    fn road(&self, load: &Load, vehicle: usize, wheel: usize) -> [f64; 2] {
        let placement = &load.placements[vehicle];
        self.traffic.under(vehicle, wheel, |ahead_m| placement.place_m(ahead_m))
    }

    /// Vehicles awake in a step without new forces of their wheels.
    pub(super) fn predict(&self, rides: &[Ride], load: &Load) -> Vec<FreeRide> {
        let free = |(vehicle, ride): (usize, &Ride)| match self.riding(vehicle) {
            Some(riding) if load.riders.iter().any(|r| r.vehicle == vehicle && r.is_spring()) => {
                let mut free = FreeRide::new(riding.springs());
                riding.predict(ride, self.driven_m_s2(load, vehicle), &mut free);
                free
            }
            _ => FreeRide::default(),
        };
        rides.iter().enumerate().map(free).collect()
    }

    /// Acceleration of a vehicle along its own direction `[m/s^2]`.
    fn driven_m_s2(&self, load: &Load, vehicle: usize) -> f64 {
        let heading = load.placements[vehicle].heading;
        let sign = if heading.backward { -1.0 } else { 1.0 };
        sign * heading.acceleration_m_s2
    }

    /// Takes the vehicles awake to the end of a step in which the deck comes to `deck`, and gives their energies; `on_deck_m` is the
    /// way that a row of the track moves in it.
    pub(super) fn finish(
        &self,
        rides: &mut [Ride],
        free: &mut [FreeRide],
        deck: DeckMotion<'_>,
        [old, new]: [Pressing<'_>; 2],
        on_deck_m: impl Fn(&SparseRow) -> f64,
    ) -> RideEnergies {
        let mut sum = RideEnergies::default();
        for (vehicle, ride) in rides.iter_mut().enumerate() {
            let Some(riding) = self.riding(vehicle) else { continue };
            let pressed_j = |of: &Pressing<'_>| -> f64 {
                let wheels = of.wheels(vehicle);
                wheels.map(|(rider, force)| force * on_deck_m(&rider.row)).sum()
            };
            // downward forces, upward ways
            let on_deck_j = self.scheme.at_f(pressed_j(&new), pressed_j(&old));
            let (mut forces, mut height_m, mut rate_m_s) = (Vec::new(), Vec::new(), Vec::new());
            for (rider, force) in new.wheels(vehicle) {
                let Rides::Spring { wheel, slope } = &rider.rides else {
                    continue;
                };
                let speed = new.load.placements[vehicle].heading.speed_m_s;
                let [height, road_slope] = self.road(new.load, vehicle, *wheel);
                let on = |row: &SparseRow, x: &[f64]| self.on_track(row, &|i| x[i]);
                height_m.push(on(&rider.row, deck.u) + height);
                rate_m_s.push(on(&rider.row, deck.v) + speed * (on(slope, deck.u) + road_slope));
                forces.push(force);
            }
            if forces.is_empty() {
                sum.work -= on_deck_j;
                continue;
            }
            let scale = self.traffic.vehicles[vehicle].scale();
            let under = UnderWheels {
                height_m: &height_m,
                rate_m_s: &rate_m_s,
                on_deck_j: on_deck_j / scale,
            };
            let scaled = |wheel: usize| riding.unscaling() * forces[wheel] / scale;
            let driven_m_s2 = self.driven_m_s2(new.load, vehicle);
            let spent = riding.finish(ride, &mut free[vehicle], scaled, under, driven_m_s2);
            sum = sum.and(spent.scaled(scale));
        }
        sum
    }
}

impl<'a> Pressing<'a> {
    /// The wheels on springs of a vehicle and their forces.
    fn wheels(self, vehicle: usize) -> impl Iterator<Item = (&'a Rider, f64)> {
        let each = self.load.riders.iter().zip(self.forces);
        each.filter(move |(rider, _)| rider.vehicle == vehicle && rider.is_spring())
            .map(|(rider, force)| (rider, *force))
    }
}
