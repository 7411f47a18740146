//! Vehicles on springs in a time step: what their wheels' springs see of each other, and their motion.
//!
//! Knows one vehicle's equations and the scheme. Does not know the deck, but for the heights under its wheels.
//!
//! All numbers are of the vehicle at its own weight: one of other weight has forces, masses and springs scaled, motions not.

use crate::response::RideReading;
use crate::scheme::Scheme;
use crate::vehicle::{Springs, VehicleMotion};
use nalgebra::DMatrix;
use std::sync::Arc;

/// A vehicle's springs at one step length.
#[derive(Debug)]
pub(crate) struct RidingStep {
    springs: Arc<Springs>,
    scheme: Scheme,
    /// `A_v^-1`, `A_v = (1 - alpha_m) c_a M + (1 - alpha_f) (c_v C + K)`.
    inverse: DMatrix<f64>,
    /// `A_v^-1 G^T`, motions x wheels.
    lift: DMatrix<f64>,
    /// `S = G A_v^-1 G^T` (V4).
    pub(crate) among: DMatrix<f64>,
    /// `kappa = k + c_v c` of each wheel.
    pub(crate) kappa: Vec<f64>,
}

/// A vehicle's motion at one instant.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Ride {
    /// State, its rate and acceleration.
    pub z: Vec<f64>,
    pub v: Vec<f64>,
    pub a: Vec<f64>,
    /// `K z`, what the vehicle's own springs hold.
    held: Vec<f64>,
    /// Force of each wheel's spring and damper `[N]`, and of the spring alone.
    pub wheels_n: Vec<f64>,
    springs_n: Vec<f64>,
    /// Height of deck and road under each wheel `[m]`.
    pub under_m: Vec<f64>,
    /// Acceleration along the deck, which pitches it `[m/s^2]`.
    pub driven_m_s2: f64,
    /// Energy of masses and springs `[J]`.
    pub stored_j: f64,
}

impl Ride {
    /// At rest on a level road of a height.
    pub(crate) fn at_rest(springs: &Springs, height_m: f64) -> Self {
        let lifted = |(z, motion): (&f64, &VehicleMotion)| match motion {
            VehicleMotion::Bounce | VehicleMotion::Hop { .. } => z + height_m,
            _ => *z,
        };
        let zeros = vec![0.0; springs.rest.len()];
        let mut ride = Self {
            z: springs.rest.iter().zip(&springs.motions).map(lifted).collect(),
            v: zeros.clone(),
            a: zeros.clone(),
            held: zeros,
            wheels_n: springs.wheels.iter().map(|wheel| wheel.rest_n).collect(),
            springs_n: springs.wheels.iter().map(|wheel| wheel.rest_n).collect(),
            under_m: vec![height_m; springs.wheels.len()],
            driven_m_s2: 0.0,
            stored_j: 0.0,
        };
        ride.hold(springs);
        ride.stored_j = ride.energy_j(springs);
        ride
    }

    /// Takes note of what the springs hold in the state as it is.
    fn hold(&mut self, springs: &Springs) {
        for (held, row) in self.held.iter_mut().zip(columns(&springs.stiffness)) {
            *held = dot(row, &self.z);
        }
    }

    /// Energy of masses and springs, those of the wheels as far as these press `[J]`.
    fn energy_j(&self, springs: &Springs) -> f64 {
        let mut twice = dot(&self.z, &self.held);
        for (inertia, v) in springs.inertia.iter().zip(&self.v) {
            twice += inertia * v * v;
        }
        for (wheel, under_m) in springs.wheels.iter().zip(&self.under_m) {
            let compressed_m = (under_m - dot(&wheel.row, &self.z)).max(0.0);
            twice += wheel.stiffness_n_m * compressed_m * compressed_m;
        }
        0.5 * twice
    }

    /// Force of a wheel by its law at a rate of the height under it, and of its spring alone `[N]`.
    fn by_law_n(&self, springs: &Springs, wheel: usize, rate_m_s: f64) -> [f64; 2] {
        let of = &springs.wheels[wheel];
        let spring_n = of.stiffness_n_m * (self.under_m[wheel] - dot(&of.row, &self.z));
        let damper_n = of.damping_n_s_m * (rate_m_s - dot(&of.row, &self.v));
        [spring_n + damper_n, spring_n].map(|force| force.max(0.0))
    }

    /// The vehicle to be read, its masses and springs so many times as large.
    pub(crate) fn reading<'a>(&'a self, springs: &'a Springs, scale: f64) -> RideReading<'a> {
        RideReading {
            wheels_n: &self.wheels_n,
            scale,
            body: &springs.body,
            state: &self.z,
            rest: &springs.rest,
            accelerations: &self.a,
            of_side: None,
        }
    }

    /// How far each motion is from rest on a level road `[m, rad]`.
    pub(crate) fn moved<'a>(&'a self, springs: &'a Springs) -> impl Iterator<Item = f64> + 'a {
        self.z.iter().zip(&springs.rest).map(|(z, rest)| z - rest)
    }
}

/// A vehicle's step without new forces of its wheels.
#[derive(Debug, Clone, Default)]
pub(crate) struct FreeRide {
    /// Change of the state.
    d: Vec<f64>,
    /// Height of each wheel's upper end and its rate `[m, m/s]`.
    pub y: Vec<f64>,
    pub rate: Vec<f64>,
    known: Vec<f64>,
    /// Rates of the state, at the places where they are needed.
    rates: Vec<f64>,
}

impl FreeRide {
    /// Room for a vehicle.
    pub(crate) fn new(springs: &Springs) -> Self {
        let (n, wheels) = (springs.rest.len(), springs.wheels.len());
        Self {
            d: vec![0.0; n],
            y: vec![0.0; wheels],
            rate: vec![0.0; wheels],
            known: vec![0.0; n],
            rates: vec![0.0; n],
        }
    }
}

/// Energies of a vehicle over a step `[J]`.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct RideEnergies {
    /// Change of what masses and springs store.
    pub stored: f64,
    /// Dissipated by its dampers.
    pub dampers: f64,
    /// Dissipated by the scheme.
    pub numerical: f64,
    /// Work of gravity and of what drives the vehicle over deck and road.
    pub work: f64,
}

impl RideEnergies {
    /// Those of a vehicle whose masses and springs are so many times as large.
    pub(crate) fn scaled(self, scale: f64) -> Self {
        Self {
            stored: scale * self.stored,
            dampers: scale * self.dampers,
            numerical: scale * self.numerical,
            work: scale * self.work,
        }
    }

    /// The sum of two.
    pub(crate) fn and(self, other: Self) -> Self {
        Self {
            stored: self.stored + other.stored,
            dampers: self.dampers + other.dampers,
            numerical: self.numerical + other.numerical,
            work: self.work + other.work,
        }
    }
}

/// What a step tells of the deck under a vehicle.
#[derive(Debug, Clone, Copy)]
pub(crate) struct UnderWheels<'a> {
    /// Height of deck and road under each wheel at the step's end, and its rate `[m, m/s]`.
    pub height_m: &'a [f64],
    pub rate_m_s: &'a [f64],
    /// Work of the wheels' forces on the deck, downward, over the step, all of one vehicle at its own weight `[J]`.
    pub on_deck_j: f64,
}

impl RidingStep {
    /// Inverts the vehicle's step.
    pub(crate) fn new(springs: &Arc<Springs>, scheme: Scheme) -> Self {
        let (c_m, c_c, c_k) = scheme.effective();
        let n = springs.rest.len();
        let matrix = DMatrix::from_fn(n, n, |i, j| {
            let inertia = if i == j { c_m * springs.inertia[i] } else { 0.0 };
            inertia + c_c * springs.damping[(i, j)] + c_k * springs.stiffness[(i, j)]
        });
        // positive definite, as every motion has a mass
        let inverse = matrix
            .cholesky()
            .map_or_else(|| DMatrix::identity(n, n), |factor| factor.inverse());
        let g = DMatrix::from_fn(springs.wheels.len(), n, |i, j| springs.wheels[i].row[j]);
        let lift = &inverse * g.transpose();
        Self {
            among: &g * &lift,
            kappa: springs
                .wheels
                .iter()
                .map(|of| of.stiffness_n_m + scheme.c_v * of.damping_n_s_m)
                .collect(),
            springs: Arc::clone(springs),
            scheme,
            inverse,
            lift,
        }
    }

    /// `1 - alpha_f`, by which scaled forces are larger than forces.
    #[inline(always)]
    pub(crate) fn unscaling(&self) -> f64 {
        1.0 - self.scheme.alpha_f
    }

    /// The vehicle.
    pub(crate) fn springs(&self) -> &Springs {
        &self.springs
    }

    /// The step without new forces of the wheels, accelerated along the deck by `driven_m_s2` at its end.
    /// Equation (V4).
    pub(crate) fn predict(&self, old: &Ride, driven_m_s2: f64, free: &mut FreeRide) {
        let (s, springs) = (&self.scheme, &*self.springs);
        let (at_v, at_a) = ((1.0 - s.alpha_f) * s.v_v + s.alpha_f, (1.0 - s.alpha_f) * s.v_a);
        let (m_v, m_a) = ((1.0 - s.alpha_m) * s.a_v, (1.0 - s.alpha_m) * s.a_a + s.alpha_m);
        for (rate, (v, a)) in free.rates.iter_mut().zip(old.v.iter().zip(&old.a)) {
            *rate = at_v * v + at_a * a;
        }
        for (i, (known, damping)) in free.known.iter_mut().zip(columns(&springs.damping)).enumerate() {
            *known = -springs.weight_n[i]
                - springs.inertia[i] * (m_v * old.v[i] + m_a * old.a[i])
                - dot(damping, &free.rates)
                - old.held[i];
            if springs.motions[i] == VehicleMotion::Pitch {
                *known += springs.braking_kg_m * s.at_f(driven_m_s2, old.driven_m_s2);
            }
        }
        for (wheel, force) in springs.wheels.iter().zip(&old.wheels_n) {
            add(s.alpha_f * force, &wheel.row, &mut free.known);
        }
        for (d, row) in free.d.iter_mut().zip(columns(&self.inverse)) {
            *d = dot(row, &free.known);
        }
        for (rate, (d, (v, a))) in free.rates.iter_mut().zip(free.d.iter().zip(old.v.iter().zip(&old.a))) {
            *rate = s.c_v * d + s.v_v * v + s.v_a * a;
        }
        for (w, wheel) in springs.wheels.iter().enumerate() {
            free.y[w] = dot(&wheel.row, &old.z) + dot(&wheel.row, &free.d);
            free.rate[w] = dot(&wheel.row, &free.rates);
        }
    }

    /// Takes the vehicle to the step's end under the scaled forces `lambda' = (1 - alpha_f) lambda` of its wheels, and accounts for
    /// the step.
    pub(crate) fn finish(
        &self,
        ride: &mut Ride,
        free: &mut FreeRide,
        scaled: impl Fn(usize) -> f64,
        under: UnderWheels<'_>,
        driven_m_s2: f64,
    ) -> RideEnergies {
        let (s, springs) = (&self.scheme, &*self.springs);
        let FreeRide { d, known, rates, .. } = free;
        for (w, lift) in columns(&self.lift).enumerate() {
            add(scaled(w), lift, d);
        }
        let mut energies = RideEnergies {
            work: -under.on_deck_j,
            ..RideEnergies::default()
        };
        // each term of the balance at alpha times the change of the state
        let mut spent = 0.0;
        for (i, &d) in d.iter().enumerate() {
            let [z, v, a] = [ride.z[i], ride.v[i], ride.a[i]];
            let v_1 = s.c_v * d + s.v_v * v + s.v_a * a;
            let a_1 = s.c_a * d + s.a_v * v + s.a_a * a;
            spent += d * springs.inertia[i] * s.at_m(a_1, a);
            energies.work -= springs.weight_n[i] * d;
            if springs.motions[i] == VehicleMotion::Pitch {
                energies.work += d * springs.braking_kg_m * s.at_f(driven_m_s2, ride.driven_m_s2);
            }
            rates[i] = s.at_f(v_1, v);
            (ride.z[i], ride.v[i], ride.a[i]) = (z + d, v_1, a_1);
        }
        // what is known is not needed any more
        known.copy_from_slice(&ride.held);
        ride.hold(springs);
        for (i, (d, damping)) in d.iter().zip(columns(&springs.damping)).enumerate() {
            spent += d * s.at_f(ride.held[i], known[i]);
            energies.dampers += d * dot(damping, rates);
        }
        for (w, wheel) in springs.wheels.iter().enumerate() {
            let old_under_m = std::mem::replace(&mut ride.under_m[w], under.height_m[w]);
            let raised = dot(&wheel.row, d);
            let (before, now) = (ride.wheels_n[w], scaled(w) / (1.0 - s.alpha_f));
            let [law, spring] = ride.by_law_n(springs, w, under.rate_m_s[w]);
            let spring_before = std::mem::replace(&mut ride.springs_n[w], spring);
            let (whole, of_spring) = (s.at_f(law, before), s.at_f(spring, spring_before));
            let rise = under.height_m[w] - old_under_m;
            spent += of_spring * (rise - raised);
            energies.dampers += (whole - of_spring) * (rise - raised);
            energies.work += s.at_f(now, before) * rise;
            ride.wheels_n[w] = now;
        }
        ride.driven_m_s2 = driven_m_s2;
        let stored = ride.energy_j(springs);
        energies.stored = stored - std::mem::replace(&mut ride.stored_j, stored);
        energies.numerical = spent - energies.stored;
        energies
    }
}

/// Columns of a matrix, which are rows of one that is symmetric.
#[inline(always)]
fn columns(matrix: &DMatrix<f64>) -> impl Iterator<Item = &[f64]> {
    matrix.as_slice().chunks_exact(matrix.nrows().max(1))
}

/// Adds a multiple of a row.
#[inline(always)]
fn add(factor: f64, row: &[f64], to: &mut [f64]) {
    for (to, value) in to.iter_mut().zip(row) {
        *to += factor * value;
    }
}

#[inline(always)]
fn dot(row: &[f64], x: &[f64]) -> f64 {
    row.iter().zip(x).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::{FreeRide, Ride, RidingStep, UnderWheels};
    use crate::scheme::Scheme;
    use crate::vehicle::{Axle, Springs, VehicleDesign};
    use std::sync::Arc;

    /// A mass of 1 kg on 100 N/m, its weight 10 N.
    fn ball(stiffness_n_m: f64) -> Arc<Springs> {
        let axle = Axle {
            track_y_m: vec![0.0],
            unsprung_mass_kg: Some(1.0),
            tyre_stiffness_n_m: Some(stiffness_n_m),
            ..Axle::default()
        };
        let design = VehicleDesign {
            axles: Some(vec![axle]),
            ..VehicleDesign::default()
        };
        let vehicle = design.check(2.0).expect("a mass");
        let mut springs = vehicle.springs.as_deref().expect("springs").clone();
        springs.weight_n = vec![10.0];
        Arc::new(springs)
    }

    /// Falls from z = 0 with -1 m/s onto a ground at -2 m: times of contact and release, z at 1.0 and 1.1 s, largest force.
    fn bounced(stiffness_n_m: f64, h: f64) -> [f64; 5] {
        let springs = ball(stiffness_n_m);
        let step = RidingStep::new(&springs, Scheme::new(h, 0.9));
        let mut ride = Ride::at_rest(&springs, 0.0);
        (ride.z, ride.v, ride.a) = (vec![0.0], vec![-1.0], vec![-10.0]);
        (ride.wheels_n, ride.under_m) = (vec![0.0], vec![-2.0]);
        let mut free = FreeRide::new(&springs);
        let (mut times, mut heights, mut most) = ([0.0; 2], [0.0; 2], 0.0_f64);
        for i in 1..=(1.1 / h).round() as usize {
            step.predict(&ride, 0.0, &mut free);
            // the row of a wheel on a ground that stands still, which only presses
            let known = -2.0 - free.y[0];
            let scaled = known / (step.among[(0, 0)] + 1.0 / (step.unscaling() * step.kappa[0]));
            let before = ride.wheels_n[0];
            let under = UnderWheels {
                height_m: &[-2.0],
                rate_m_s: &[0.0],
                on_deck_j: 0.0,
            };
            step.finish(&mut ride, &mut free, |_| scaled.max(0.0), under, 0.0);
            let (now, t) = (ride.wheels_n[0], i as f64 * h);
            most = most.max(now);
            if before == 0.0 && now > 0.0 {
                times[0] = t;
            }
            if before > 0.0 && now == 0.0 {
                times[1] = t;
            }
            if (t - 1.0).abs() < 0.5 * h {
                heights[0] = ride.z[0];
            }
            if (t - 1.1).abs() < 0.5 * h {
                heights[1] = ride.z[0];
            }
        }
        [times[0], times[1], heights[0], heights[1], most]
    }

    /// The closed solution: free fall, a half wave about -2.1 m at 10 rad/s, free flight. Contact at 0.540312 s and release at
    /// 0.885456 s within a step of 0.1 ms, heights to 1e-5 m, the largest force to 1e-5 of itself. A spring that is 5 % off is found.
    #[test]
    fn a_mass_bounces_as_in_closed_form() {
        let h = 1e-4;
        let expected = [0.540_312, 0.885_456, -1.332_163, -0.856_394, 74.8074];
        let off = |found: [f64; 5]| -> [f64; 5] { std::array::from_fn(|i| (found[i] - expected[i]).abs()) };
        let right = off(bounced(100.0, h));
        let bounds = [h, h, 1e-5, 1e-5, 1e-5 * expected[4]];
        assert!(right.iter().zip(&bounds).all(|(off, bound)| off <= bound), "{right:?}");
        let wrong = off(bounced(105.0, h));
        assert!(
            wrong.iter().zip(&bounds).skip(1).all(|(off, bound)| off > bound),
            "{wrong:?}"
        );
    }
}
