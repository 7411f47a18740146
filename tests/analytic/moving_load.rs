//! A force crosses a simple span: Fryba's series, undamped and damped, and the order of the elements under it.
//!
//! Sketch: a beam EI, mu a metre, of span L on simple supports, at rest; P enters at x = 0 at t = 0 with speed V. With
//! `w = sum of q_j sin(j pi x/L)` each `q_j'' + b q_j' + omega_j^2 q_j = 2P/(mu L) sin(j pi V t/L)`, `omega_j^2 = (j pi/L)^4
//! EI/mu`; b is Rayleigh's mass coefficient (L. Fryba: Vibration of Solids and Structures under Moving Loads, 3rd ed., Thomas
//! Telford, 1999, ch. 1). Without b the solution is his series
//! `w = 2 P L^3/(pi^4 EI) sum of sin(j pi x/L) (sin(j w t) - alpha/j sin(omega_j t)) / (j^2 (j^2 - alpha^2))`, `w = pi V/L`,
//! `alpha = w/omega_1`.
//!
//! EI = 1e9 N m^2, mu = 1500 kg/m, L = 20 m, P = 1e5 N, alpha = 1/2: V = 64 m/s.

#![allow(clippy::expect_used)]

use pontoon_core::analysis::modes::Rayleigh;
use pontoon_core::bridge::Model;
use pontoon_core::connector::Connection;
use pontoon_core::response::{Quantity, Record};
use pontoon_core::vehicle::Inertia;
use pontoon_tests::beams::BeamModule;
use pontoon_tests::*;
use std::f64::consts::PI;

const SPAN_M: f64 = 20.0;
const LOAD_N: f64 = 1e5;
const ALPHA: f64 = 0.5;
/// Steps of a crossing.
const STEPS: usize = 1000;

#[derive(Debug, Clone, Copy)]
struct Span {
    ei: f64,
    mass_kg_m: f64,
    damping_1_s: f64,
}

const BARE: Span = Span {
    ei: 1e9,
    mass_kg_m: 1500.0,
    damping_1_s: 0.0,
};

/// 5 % of critical in the first mode: `b = 2 zeta omega_1`.
const DAMPED: Span = Span {
    damping_1_s: 2.015,
    ..BARE
};

impl Span {
    fn omega(&self, j: usize) -> f64 {
        (j as f64 * PI / SPAN_M).powi(2) * (self.ei / self.mass_kg_m).sqrt()
    }
}

/// Speed of all crossings: alpha of the bare span.
fn speed_m_s() -> f64 {
    ALPHA * BARE.omega(1) * SPAN_M / PI
}

/// Midspan at time t from the modal equations, each solved in closed form, b or not.
fn series_m(span: Span, t: f64) -> f64 {
    let mode = |j: usize| {
        let (omega, drive) = (span.omega(j), j as f64 * PI * speed_m_s() / SPAN_M);
        let (half, p) = (0.5 * span.damping_1_s, 2.0 * LOAD_N / (span.mass_kg_m * SPAN_M));
        let (stiff, loss) = (omega * omega - drive * drive, span.damping_1_s * drive);
        let scale = p / (stiff * stiff + loss * loss);
        // forced part s sin + c cos, and the free one that starts from rest
        let (s, c) = (scale * stiff, -scale * loss);
        let free = (omega * omega - half * half).sqrt();
        let decay = (-half * t).exp();
        let sine = (-s * drive - half * c) / free;
        let q =
            s * (drive * t).sin() + c * (drive * t).cos() + decay * (sine * (free * t).sin() - c * (free * t).cos());
        q * (0.5 * j as f64 * PI).sin()
    };
    (1..60).rev().map(mode).sum()
}

/// Fryba's undamped series at midspan, term for term.
fn fryba_m(t: f64) -> f64 {
    let omega = PI * speed_m_s() / SPAN_M;
    let term = |j: usize| {
        let n = j as f64;
        let shape = (0.5 * n * PI).sin() / (n * n * (n * n - ALPHA * ALPHA));
        shape * ((n * omega * t).sin() - ALPHA / n * (BARE.omega(j) * t).sin())
    };
    2.0 * LOAD_N * SPAN_M.powi(3) / (PI.powi(4) * BARE.ei) * (1..60).rev().map(term).sum::<f64>()
}

/// Times of a crossing and midspan at them, by the engine.
fn crossed(span: Span, elements: usize, steps: usize) -> (Vec<f64>, Vec<f64>) {
    let module = BeamModule::slender(0.5 * SPAN_M, elements, span.ei, span.mass_kg_m, 1e4);
    let ready = module.ready(&module.design(2, 1e-3, 0.0, module.continuous_n_m(1e9)), Model::Full);
    let h = SPAN_M / speed_m_s() / steps as f64;
    let damping = Rayleigh::new(0.0, span.damping_1_s);
    let vehicle = module.axle(0.0, 1, Inertia::None);
    let mut crossing = ready.crossing(Connection::Linear, LOAD_N, speed_m_s());
    (crossing.tail_s, crossing.record) = (
        0.0,
        Record {
            positions: vec![2],
            joints: vec![],
            ..Record::default()
        },
    );
    let r = ready
        .crossings(&vehicle, &settings(damping, h, 1.0))
        .solve(&crossing)
        .expect("solved");
    let deflection_m = history(&r, Quantity::Deflection, 2).to_vec();
    // the step before t = 0 is rest
    (
        r.recorded.history_time_s[1..=steps + 1].to_vec(),
        deflection_m[1..=steps + 1].to_vec(),
    )
}

/// Midspan over the whole crossing, over its largest. 40 elements, 1000 steps. 1e-3: a force between nodes is shared between
/// the two, of order 2 in their distance (below, 4e-4). Twins: mass, E, and with damping Rayleigh's b.
#[test]
fn midspan_follows_frybas_series() {
    for (what, span) in [("bare", BARE), ("damped", DAMPED)] {
        let off = |changed: Span| {
            let (times, found) = crossed(changed, 20, STEPS);
            let exact: Vec<f64> = times.iter().map(|&t| series_m(span, t)).collect();
            if what == "bare" {
                let frybas: Vec<f64> = times.iter().map(|&t| fryba_m(t)).collect();
                assert!(apart(&exact, &frybas) < 1e-12, "the modal equations are his series");
            }
            apart(&found, &exact)
        };
        let right = off(span);
        let twins = [
            (
                "mass",
                Span {
                    mass_kg_m: 1.05 * span.mass_kg_m,
                    ..span
                },
            ),
            (
                "E",
                Span {
                    ei: 1.05 * span.ei,
                    ..span
                },
            ),
            (
                "Rayleigh b",
                Span {
                    damping_1_s: 1.05 * span.damping_1_s,
                    ..span
                },
            ),
        ];
        for (name, wrong) in twins.into_iter().take(if span.damping_1_s > 0.0 { 3 } else { 2 }) {
            held(&format!("{what}, {name}"), 1e-3, right, off(wrong));
        }
    }
}

/// The order in space of a force that moves over beams whose deck is straight between nodes: 2, from 8, 16 and 32 elements a
/// module with steps that do nothing. Slope within 0.2. Twin: E, towards which no error falls.
#[test]
fn moving_force_is_of_second_order_in_space() {
    let errors = |ei: f64| {
        [8, 16, 32].map(|elements| {
            let (times, found) = crossed(Span { ei, ..BARE }, elements, 2 * STEPS);
            apart(&found, &times.iter().map(|&t| series_m(BARE, t)).collect::<Vec<_>>())
        })
    };
    let off = |ei: f64| largest(errors(ei).windows(2).map(|w| ((w[0] / w[1]).log2() - 2.0).abs()));
    println!("errors {:?}", errors(BARE.ei));
    held("order in space, moving force", 0.2, off(BARE.ei), off(1.05 * BARE.ei));
}
