//! A mass crosses a simple span: an independent Galerkin solution with the mass's full acceleration.
//!
//! Sketch: a beam EI, mu a metre, span L, simple supports, at rest; a mass M of weight M g comes on at t = 0 with speed V.
//! `w = sum of q_j sin(j pi x/L)`, `mu L/2 (q_j'' + omega_j^2 q_j) = phi_j M (g - a)`, where `a` is 0 (`none`), `w''` under each
//! point (`local`), or `w'' + 2 V w'_x + V^2 w_xx` of the footprint's mean (`convective`, the whole acceleration of a mass that
//! follows the beam). Integrated here by Runge-Kutta steps far below the engine's. No published table of numbers was at hand
//! to be cited; the equations are written out here.
//!
//! EI = 1e9 N m^2, mu = 1500 kg/m, L = 20 m, M = mu L/2, `alpha = V L/pi sqrt(mu/EI)` = 0.3, footprint 0.5 m of eight points.

#![allow(clippy::expect_used)]

use nalgebra::{DMatrix, DVector};
use pontoon_core::analysis::modes::Rayleigh;
use pontoon_core::bridge::Model;
use pontoon_core::connector::Connection;
use pontoon_core::response::{Quantity, Record};
use pontoon_core::vehicle::{GRAVITY_M_S2, Inertia};
use pontoon_tests::beams::BeamModule;
use pontoon_tests::*;
use std::f64::consts::PI;

const EI: f64 = 1e9;
const MASS_KG_M: f64 = 1500.0;
const SPAN_M: f64 = 20.0;
const VEHICLE_KG: f64 = 0.5 * MASS_KG_M * SPAN_M;
const PATCH_M: f64 = 0.5;
const POINTS: usize = 8;
const ALPHA: f64 = 0.3;
const STEPS: usize = 1000;

fn speed_m_s() -> f64 {
    ALPHA * PI / SPAN_M * (EI / MASS_KG_M).sqrt()
}

/// The span and mass of the Galerkin solution.
#[derive(Debug, Clone, Copy)]
struct Galerkin {
    inertia: Inertia,
    modes: usize,
    /// The mass that is carried along; the weight stays.
    mass_kg: f64,
    /// Factors of `2 V w'_x` and `V^2 w_xx`.
    terms: [f64; 2],
}

impl Galerkin {
    fn new(inertia: Inertia) -> Self {
        Self {
            inertia,
            modes: if inertia == Inertia::Local { 32 } else { 24 },
            mass_kg: VEHICLE_KG,
            terms: [1.0, 1.0],
        }
    }

    fn shapes(&self, x: f64, derivative: usize) -> DVector<f64> {
        DVector::from_fn(self.modes, |j, _| {
            let kappa = (j + 1) as f64 * PI / SPAN_M;
            match derivative {
                0 => (kappa * x).sin(),
                _ => kappa * (kappa * x).cos(),
            }
        })
    }

    /// Accelerations of the modes at time t.
    fn acceleration(&self, t: f64, q: &DVector<f64>, v: &DVector<f64>) -> DVector<f64> {
        let (speed, own) = (speed_m_s(), 0.5 * MASS_KG_M * SPAN_M);
        let mut m = DMatrix::identity(self.modes, self.modes) * own;
        let mut f = DVector::from_fn(self.modes, |j, _| {
            -own * ((j + 1) as f64 * PI / SPAN_M).powi(4) * EI / MASS_KG_M * q[j]
        });
        let centre = speed * t;
        let places = (0..POINTS).map(|p| centre + PATCH_M * ((p as f64 + 0.5) / POINTS as f64 - 0.5));
        let on: Vec<f64> = places.filter(|x| (0.0..=SPAN_M).contains(x)).collect();
        let mut mean = DVector::zeros(self.modes);
        for &x in &on {
            let phi = self.shapes(x, 0);
            f += &phi * (VEHICLE_KG * GRAVITY_M_S2 / POINTS as f64);
            if self.inertia == Inertia::Local {
                m += &phi * phi.transpose() * (self.mass_kg / POINTS as f64);
            }
            mean += phi / on.len() as f64;
        }
        if self.inertia == Inertia::Convective && !on.is_empty() {
            let mass = self.mass_kg * on.len() as f64 / POINTS as f64;
            let [left, right] = [-0.5, 0.5].map(|end| (centre + end * PATCH_M).clamp(0.0, SPAN_M));
            let slope =
                |derivative: usize| (self.shapes(right, derivative) - self.shapes(left, derivative)) / (right - left);
            let known = self.terms[0] * 2.0 * speed * slope(0).dot(v) + self.terms[1] * speed * speed * slope(1).dot(q);
            f -= &mean * (mass * known);
            m += &mean * mean.transpose() * mass;
        }
        m.lu().solve(&f).expect("a definite mass")
    }

    /// Midspan at times `n h`.
    fn midspan_m(&self, h: f64, steps: usize) -> Vec<f64> {
        let parts = if self.modes > 24 { 8 } else { 4 };
        let dt = h / parts as f64;
        let (mut q, mut v) = (DVector::zeros(self.modes), DVector::zeros(self.modes));
        let middle = self.shapes(0.5 * SPAN_M, 0);
        let mut found = vec![0.0];
        for n in 0..steps * parts {
            let t = n as f64 * dt;
            let a1 = self.acceleration(t, &q, &v);
            let (q2, v2) = (&q + &v * (0.5 * dt), &v + &a1 * (0.5 * dt));
            let a2 = self.acceleration(t + 0.5 * dt, &q2, &v2);
            let (q3, v3) = (&q + &v2 * (0.5 * dt), &v + &a2 * (0.5 * dt));
            let a3 = self.acceleration(t + 0.5 * dt, &q3, &v3);
            let (q4, v4) = (&q + &v3 * dt, &v + &a3 * dt);
            let a4 = self.acceleration(t + dt, &q4, &v4);
            q += (&v + (&v2 + &v3) * 2.0 + &v4) * (dt / 6.0);
            v += (a1 + (a2 + a3) * 2.0 + a4) * (dt / 6.0);
            if (n + 1) % parts == 0 {
                found.push(middle.dot(&q));
            }
        }
        found
    }
}

/// Midspan by the engine from t = 0 until the footprint's centre leaves.
fn crossed(inertia: Inertia, elements: usize, h: f64) -> Vec<f64> {
    let module = BeamModule::slender(0.5 * SPAN_M, elements, EI, MASS_KG_M, 1e4);
    let ready = module.ready(&module.design(2, 1e-3, 0.0, module.continuous_n_m(1e9)), Model::Full);
    let mut crossing = ready.crossing(Connection::Linear, VEHICLE_KG * GRAVITY_M_S2, speed_m_s());
    (crossing.tail_s, crossing.record) = (
        0.0,
        Record {
            positions: vec![2],
            joints: vec![],
            ..Record::default()
        },
    );
    let solver = ready.crossings(
        &module.axle(PATCH_M, POINTS, inertia),
        &settings(Rayleigh::new(0.0, 0.0), h, 1.0),
    );
    let r = solver.solve(&crossing).expect("solved");
    let start = r
        .recorded
        .history_time_s
        .iter()
        .position(|t| t.abs() < 0.5 * h)
        .expect("t = 0");
    history(&r, Quantity::Deflection, 2)[start..=start + STEPS].to_vec()
}

/// What a wrong Galerkin solution is wrong in.
type Change = (&'static str, fn(&mut Galerkin));

/// Midspan over the whole crossing, over its largest, for the three kinds of inertia; 80 elements, 1000 steps. 2e-3: the
/// deck is straight between nodes and points come on within a step (measured 5e-4, and 8e-4 for `local`). Only `local`
/// converges slowly, in modes as in elements, with order 1: a mass that leaves its motion behind on the beam stirs the high
/// modes; from 24 to 48 modes and from 40 to 160 elements the two solutions draw near each other, 2e-3, 7e-4, 5e-4. Modes of
/// the Galerkin solution: 1e-3 against three quarters of them. Twins: the vehicle's mass at the same weight; the Coriolis term
/// and the centripetal one 5 % off, and each left out; the other kinds of inertia.
#[test]
fn midspan_follows_the_galerkin_solution() {
    let h = SPAN_M / speed_m_s() / STEPS as f64;
    let of = |inertia: Inertia, change: fn(&mut Galerkin)| {
        let mut galerkin = Galerkin::new(inertia);
        change(&mut galerkin);
        galerkin.midspan_m(h, STEPS)
    };
    for inertia in [Inertia::None, Inertia::Local, Inertia::Convective] {
        let (found, exact) = (crossed(inertia, 40, h), of(inertia, |_| {}));
        let right = apart(&found, &exact);
        let fewer = apart(&of(inertia, |g| g.modes = g.modes * 3 / 4), &exact);
        held(
            &format!("{inertia:?}, modes of the other"),
            1e-3,
            fewer,
            apart(&of(inertia, |g| g.modes = 2), &exact),
        );
        let other: Change = match inertia {
            Inertia::Convective => ("other inertia", |g| g.inertia = Inertia::Local),
            _ => ("other inertia", |g| g.inertia = Inertia::Convective),
        };
        let twins: [Change; 5] = [
            ("vehicle mass", |g| g.mass_kg *= 1.05),
            ("2 V term", |g| g.terms[0] = 1.05),
            ("V^2 term", |g| g.terms[1] = 1.05),
            ("no 2 V term", |g| g.terms[0] = 0.0),
            ("no V^2 term", |g| g.terms[1] = 0.0),
        ];
        let count = match inertia {
            Inertia::None => 0,
            Inertia::Local => 1,
            Inertia::Convective => 5,
        };
        for (what, change) in twins.into_iter().take(count).chain([other]) {
            held(
                &format!("{inertia:?}, {what}"),
                2e-3,
                right,
                apart(&found, &of(inertia, change)),
            );
        }
    }
}
