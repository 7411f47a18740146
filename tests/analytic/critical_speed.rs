//! A force on a beam on water, up towards the critical speed.
//!
//! Sketch: an endless beam EI, mu a metre, on k a metre with damping `c = b mu`; P moves with V, for ever. With `s = x - V t` the
//! deflection that moves along obeys `EI W'''' + mu V^2 W'' - c V W' + k W = P delta(s)`, so that with D the polynomial of the
//! left side and r its roots `W = P sum of e^(r s)/D'(r)` over those that decay ahead, and less the same over the others behind.
//! Without damping that is under P `W = w0 / sqrt(1 - (V/V_cr)^2)`, `w0 = P lambda/2k`, `lambda = (k/4EI)^(1/4)`, `V_cr = (4 k EI
//! / mu^2)^(1/4)` (S. Timoshenko: Method of analysis of statical and dynamical stresses in rail, Proc. 2nd Int. Congress of
//! Applied Mechanics, Zurich, 1926; L. Fryba: Vibration of Solids and Structures under Moving Loads).
//!
//! EI = 1e7 N m^2, k = 64 kN/m^2, mu = 6000 + 6000 kg/m: lambda = 0.2 1/m, V_cr = 11.55 m/s. b = 0.6 1/s, an eighth of critical
//! in heave, so that what the entry stirs up has died away where the deflection is compared, 200 m on in 240 m of beam.

#![allow(clippy::expect_used)]

use nalgebra::Complex;
use pontoon_core::analysis::modes::Rayleigh;
use pontoon_core::bridge::Model;
use pontoon_core::connector::Connection;
use pontoon_core::response::{Quantity, Record};
use pontoon_core::vehicle::Inertia;
use pontoon_tests::beams::BeamModule;
use pontoon_tests::*;

const LOAD_N: f64 = 1e5;

/// What moves along.
#[derive(Debug, Clone, Copy)]
struct Wave {
    ei: f64,
    k_n_m2: f64,
    mass_kg_m: f64,
    added_mass_kg_m: f64,
    damping_1_s: f64,
    speed_m_s: f64,
}

impl Wave {
    /// At a share of the critical speed.
    fn at(ratio: f64) -> Self {
        let still = Self {
            ei: 1e7,
            k_n_m2: 6.4e4,
            mass_kg_m: 6000.0,
            added_mass_kg_m: 6000.0,
            damping_1_s: 0.6,
            speed_m_s: 0.0,
        };
        Self {
            speed_m_s: ratio * still.critical_m_s(),
            ..still
        }
    }

    fn mu(&self) -> f64 {
        self.mass_kg_m + self.added_mass_kg_m
    }

    fn critical_m_s(&self) -> f64 {
        (4.0 * self.k_n_m2 * self.ei / self.mu().powi(2)).powf(0.25)
    }

    /// w0 `[m]`.
    fn still_m(&self) -> f64 {
        0.5 * LOAD_N / self.k_n_m2 * (self.k_n_m2 / (4.0 * self.ei)).powf(0.25)
    }

    /// Deflection at a distance ahead of the load `[m]`.
    fn deflection_m(&self, ahead_m: f64) -> f64 {
        let (mu, v) = (self.mu(), self.speed_m_s);
        let (c2, c1, c0) = (
            mu * v * v / self.ei,
            -self.damping_1_s * mu * v / self.ei,
            self.k_n_m2 / self.ei,
        );
        let term = |r: &Complex<f64>| {
            let slope = r * r * r * 4.0 + r * (2.0 * c2) + c1;
            match (r.re < 0.0, ahead_m >= 0.0) {
                (true, true) => ((r * ahead_m).exp() / slope).re,
                (false, false) => -((r * ahead_m).exp() / slope).re,
                _ => 0.0,
            }
        };
        LOAD_N / self.ei * roots(c2, c1, c0).iter().map(term).sum::<f64>()
    }

    /// Distance ahead of the load of the place 200 m on, and its deflection there by the engine, from 40 m before the load
    /// comes to 20 m after, when the beam's end is as far from it.
    fn engine(&self) -> Vec<(f64, f64)> {
        let module = BeamModule::slender(10.0, 20, self.ei, self.mass_kg_m, 1e4);
        let d = module.design(24, self.k_n_m2, self.added_mass_kg_m, module.continuous_n_m(1e9));
        let ready = module.ready(&d, Model::Full);
        let damping = Rayleigh::new(0.0, self.damping_1_s);
        let solver = ready.crossings(
            &module.axle(0.0, 1, Inertia::None),
            &settings(damping, 0.25 / self.speed_m_s, 1.0),
        );
        let mut crossing = ready.crossing(Connection::Linear, LOAD_N, self.speed_m_s);
        (crossing.tail_s, crossing.record) = (
            0.0,
            Record {
                positions: vec![21],
                joints: vec![],
                ..Record::default()
            },
        );
        let r = solver.solve(&crossing).expect("solved");
        let ahead_m = r.recorded.history_time_s.iter().map(|t| 200.0 - self.speed_m_s * t);
        let all = ahead_m.zip(history(&r, Quantity::Deflection, 21).iter().copied());
        all.filter(|(ahead, _)| (-20.0..40.0).contains(ahead)).collect()
    }
}

/// Roots of `r^4 + c2 r^2 + c1 r + c0`, all at once (Durand, Kerner).
fn roots(c2: f64, c1: f64, c0: f64) -> [Complex<f64>; 4] {
    let size = c0.powf(0.25);
    let mut r = [0.4, 2.0, 3.5, 5.1].map(|angle: f64| Complex::from_polar(size, angle));
    for _ in 0..200 {
        for i in 0..4 {
            let apart: Complex<f64> = (0..4).filter(|&j| j != i).map(|j| r[i] - r[j]).product();
            let step = (r[i] * r[i] * r[i] * r[i] + r[i] * r[i] * c2 + r[i] * c1 + c0) / apart;
            r[i] -= step;
        }
    }
    r
}

/// The solution without damping and at rest: the peak of the formula to 1e-9 (roots of a quartic). Twins: p_b, m_a.
#[test]
fn closed_form_has_the_known_peak() {
    for ratio in [0.0, 0.5, 0.7, 0.9] {
        let wave = Wave {
            damping_1_s: 0.0,
            ..Wave::at(ratio)
        };
        let peak = |w: Wave| miss(w.deflection_m(0.0), wave.still_m() / (1.0 - ratio * ratio).sqrt());
        let deep = Wave {
            k_n_m2: 1.05 * wave.k_n_m2,
            ..wave
        };
        let heavy = Wave {
            added_mass_kg_m: 1.05 * wave.added_mass_kg_m,
            ..wave
        };
        held(&format!("peak at {ratio}, p_b"), 1e-9, peak(wave), peak(deep));
        if ratio > 0.0 {
            held(&format!("peak at {ratio}, m_a"), 1e-9, peak(wave), peak(heavy));
        }
    }
}

/// A coefficient of the wave, changed.
type Change = (&'static str, fn(&mut Wave));

const CHANGES: [Change; 6] = [
    ("p_b", |w| w.k_n_m2 *= 1.05),
    ("m_a", |w| w.added_mass_kg_m *= 1.05),
    ("mass", |w| w.mass_kg_m *= 1.05),
    ("E", |w| w.ei *= 1.05),
    ("Rayleigh b", |w| w.damping_1_s *= 1.05),
    ("speed", |w| w.speed_m_s *= 1.05),
];

/// The wave at half and at 0.7 of the critical speed, from 40 m before the load to 20 m behind, over its largest. 2e-3: the water's
/// bilinear shapes leave `(lambda h)^2/12` = 8e-4 (measured 6e-4 and 8e-4), what the entry stirred up dies with b. Twins: p_b, m_a, mass, E,
/// Rayleigh b, speed.
#[test]
fn wave_moves_along_as_the_closed_form() {
    let found = on_two_threads(&[0.5, 0.7], |&ratio| (Wave::at(ratio), Wave::at(ratio).engine()));
    for (wave, found) in found {
        let off = |w: &Wave| {
            let exact: Vec<f64> = found.iter().map(|f| w.deflection_m(f.0)).collect();
            apart(&found.iter().map(|f| f.1).collect::<Vec<_>>(), &exact)
        };
        let right = off(&wave);
        let peak = largest(found.iter().map(|f| f.1.max(0.0))) / wave.still_m();
        println!(
            "V = {:.2} m/s: {} places, amplified {peak:.4}",
            wave.speed_m_s,
            found.len()
        );
        for (name, change) in CHANGES {
            let mut changed = wave;
            change(&mut changed);
            held(
                &format!("V = {:.2} m/s, {name}", wave.speed_m_s),
                2e-3,
                right,
                off(&changed),
            );
        }
    }
}
