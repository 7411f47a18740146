//! The module of beams is the plane beam that it stands for: statics, frequency, and nothing from what is called rigid.

#![allow(clippy::expect_used)]

use pontoon_core::analysis::modes::modes;
use pontoon_core::bridge::Model;
use pontoon_core::connector::Connection;
use pontoon_core::vehicle::Inertia;
use pontoon_tests::beams::BeamModule;
use pontoon_tests::*;
use std::f64::consts::PI;

const EI: f64 = 1e9;
const MASS_KG_M: f64 = 1500.0;
const SPAN_M: f64 = 20.0;
const LOAD_N: f64 = 1e5;

/// Next to no water: without any, K without connectors would be singular.
const WATER_N_M2: f64 = 10.0;

/// Two modules, joined so that they are one beam, on simple supports and next to no water.
fn span(elements: usize, ei: f64, mass_kg_m: f64, rigid: f64, model: Model) -> (BeamModule, Ready) {
    let module = BeamModule::slender(0.5 * SPAN_M, elements, ei, mass_kg_m, rigid);
    let d = module.design(2, WATER_N_M2, 0.0, module.continuous_n_m(1e9));
    let ready = module.ready(&d, model);
    (module, ready)
}

/// Deflection of midspan under P at midspan on water k, by the sine series: the nth term is `2 P / (L (EI (n pi/L)^4 + k))`
/// for odd n; without water its sum is `P L^3 / (48 EI)`.
fn midspan_m(water_n_m2: f64) -> f64 {
    let term = |n: usize| 1.0 / (EI * (n as f64 * PI / SPAN_M).powi(4) + water_n_m2);
    2.0 * LOAD_N / SPAN_M * (0..2000).rev().map(|n| term(2 * n + 1)).sum::<f64>()
}

/// Simple span L = 20 m in two modules, EI = 1e9 N m^2, P = 1e5 N at midspan. Expected: `P L^3 / (48 EI)`, less what the
/// water takes, 1.6e-5, plus what two posts r times as stiff as the beam turn at the joint, `2 d / (L r)`: 1e-6 at 1e5,
/// 1e-4 at 1e3. Cubic shape functions solve the beam's equation between nodes, so that 1e-6 is left to the water's bilinear
/// shapes over elements of 2.5 m (measured 4e-7). Twins: E; the posts.
#[test]
fn midspan_deflects_as_a_beam() {
    let deflection_m = |ei: f64, rigid: f64, model: Model| {
        let (module, ready) = span(4, ei, MASS_KG_M, rigid, model);
        let case = ready.case(Connection::Linear, LOAD_N, 0.5 * SPAN_M);
        ready
            .statics(&module.axle(0.0, 1, Inertia::None))
            .solve(&case)
            .expect("solved")
            .deflection_m[1]
    };
    let exact = midspan_m(WATER_N_M2);
    held(
        "series",
        1e-9,
        miss(midspan_m(0.0), LOAD_N * SPAN_M.powi(3) / (48.0 * EI)),
        miss(exact, midspan_m(0.0)),
    );
    for model in [Model::Full, Model::SuperElement] {
        for rigid in [1e3, 1e5] {
            let expected = |rigid: f64| exact * (1.0 + 2.0 / (SPAN_M * rigid));
            let [right, soft] = [1.0, 0.95].map(|f| miss(deflection_m(f * EI, rigid, model), expected(rigid)));
            held(&format!("midspan, posts {rigid:e}, {model:?}, E"), 1e-6, right, soft);
        }
        let posts = |f: f64| miss(deflection_m(EI, 1e3, model), exact * (1.0 + 2.0 / (SPAN_M * f * 1e3)));
        held(&format!("midspan, {model:?}, posts"), 1e-6, posts(1.0), posts(1.05));
    }
}

/// Frequencies of that span: `omega_n^2 = (EI (n pi/L)^4 + k) / m`, n = 1 and 2. Ten elements a module leave 4e-7 and 6e-6 by the
/// order 4 of the consistent mass, the posts (1e5) 5e-7 of the first. 1e-6 and 1e-5. Twins: E, mass.
#[test]
fn span_sounds_as_a_beam() {
    let hz = |ei: f64, mass_kg_m: f64| {
        let (_, ready) = span(10, ei, mass_kg_m, 1e5, Model::Full);
        let (modes, _) = modes(&ready.bridge, 6).expect("modes");
        [1, 2].map(|n| frequency_hz(&modes, &format!("vertical bending {n}")))
    };
    let exact = |n: usize| ((EI * (n as f64 * PI / SPAN_M).powi(4) + WATER_N_M2) / MASS_KG_M).sqrt() / (2.0 * PI);
    let [right, soft, heavy] = [(1.0, 1.0), (0.95, 1.0), (1.0, 1.05)].map(|(e, m)| hz(e * EI, m * MASS_KG_M));
    for (n, tolerance) in [(1, 1e-6), (2, 1e-5)] {
        let off = |hz: [f64; 2]| miss(hz[n - 1], exact(n));
        held(&format!("frequency {n}, E"), tolerance, off(right), off(soft));
        held(&format!("frequency {n}, mass"), tolerance, off(right), off(heavy));
    }
}
