//! A long beam on water is a beam on an elastic foundation: Hetenyi's closed form under a point load.
//!
//! Sketch: an endless beam EI on k = p_b B a metre, P at x = 0. `w = w0 e^(-s) (cos s + sin s)`, `s = lambda |x|`,
//! `lambda = (k / 4EI)^(1/4)`, `w0 = P lambda / 2k`; zeros at `s = 3 pi/4`, so that `3 pi / 2 lambda` of the beam goes down
//! (M. Hetenyi: Beams on Elastic Foundation, University of Michigan Press, 1946, ch. II).
//!
//! EI = 1e7 N m^2, k = 64 kN/m^2, lambda = 0.2 1/m. 80 m of beam, 8/lambda to either side: what its simply supported ends
//! send back to the load is e^-16, 1e-7.

#![allow(clippy::expect_used)]

use pontoon_core::bridge::Model;
use pontoon_core::connector::Connection;
use pontoon_core::response::StaticResponse;
use pontoon_core::vehicle::Inertia;
use pontoon_tests::beams::BeamModule;
use pontoon_tests::*;
use std::f64::consts::PI;

const EI: f64 = 1e7;
const K_N_M2: f64 = 6.4e4;
const LAMBDA: f64 = 0.2;
const LOAD_N: f64 = 1e5;
const LENGTH_M: f64 = 80.0;

/// 80 m of beam in `modules` joined as one, `elements` in all, P at their middle.
fn respond(modules: usize, elements: usize, ei: f64, k_n_m2: f64) -> StaticResponse {
    let module = BeamModule::slender(LENGTH_M / modules as f64, elements / modules, ei, 1000.0, 1e4);
    let d = module.design(modules, k_n_m2, 0.0, module.continuous_n_m(1e9));
    let ready = module.ready(&d, Model::Full);
    let case = ready.case(Connection::Linear, LOAD_N, 0.5 * LENGTH_M);
    ready
        .statics(&module.axle(0.0, 1, Inertia::None))
        .solve(&case)
        .expect("solved")
}

/// Deflection at a distance from the load `[m]`.
fn hetenyi_m(distance_m: f64) -> f64 {
    let s = LAMBDA * distance_m;
    0.5 * LOAD_N * LAMBDA / K_N_M2 * (-s).exp() * (s.cos() + s.sin())
}

/// Sixteen modules of 5 m, elements of 0.5 m: all positions, over w0. 2e-3: water shared by bilinear shapes over elements of
/// `lambda h = 0.1` is of order 2 in it (below), posts and joints take 1e-4. Twins: p_b, E.
#[test]
fn beam_on_water_deflects_as_hetenyi_says() {
    assert!(
        (LAMBDA - (K_N_M2 / (4.0 * EI)).powf(0.25)).abs() < 1e-12,
        "lambda of these numbers"
    );
    let exact: Vec<f64> = (0..=16)
        .map(|p| hetenyi_m((5.0 * p as f64 - 0.5 * LENGTH_M).abs()))
        .collect();
    let off = |ei: f64, k: f64| apart(&respond(16, 160, ei, k).deflection_m, &exact);
    let right = off(EI, K_N_M2);
    held("Hetenyi, p_b", 2e-3, right, off(EI, 1.05 * K_N_M2));
    held("Hetenyi, E", 2e-3, right, off(1.05 * EI, K_N_M2));
}

/// One module of 80 m, 160 elements: the length that goes down, `3 pi / 2 lambda` = 23.562 m, and w0 as the deck's largest
/// deflection, which has the squash of the posts with it. 1e-3: zeros are interpolated between nodes 0.5 m apart. Twins:
/// p_b, E.
#[test]
fn influential_length_is_hetenyis() {
    let of = |ei: f64, k: f64| {
        let r = respond(1, 160, ei, k);
        [
            miss(r.influential_length_m, 1.5 * PI / LAMBDA),
            miss(r.peak_edge_deflection_m, hetenyi_m(0.0)),
        ]
    };
    let [right, deep, stiff] = [(1.0, 1.0), (1.0, 1.05), (1.05, 1.0)].map(|(e, k)| of(e * EI, k * K_N_M2));
    for (n, what) in ["influential length", "w0 of one module"].iter().enumerate() {
        held(&format!("{what}, p_b"), 1e-3, right[n], deep[n]);
        held(&format!("{what}, E"), 1e-3, right[n], stiff[n]);
    }
}

/// The order in space of beams on shared water: 2 in w0, elements of 2.5, 1.25 and 0.625 m. Slope within 0.1. Twin: p_b,
/// towards which no error falls.
#[test]
fn water_on_beams_is_of_second_order() {
    let errors = |k: f64| [32, 64, 128].map(|n| miss(respond(16, n, EI, k).deflection_m[8], hetenyi_m(0.0)));
    let off = |k: f64| largest(errors(k).windows(2).map(|w| ((w[0] / w[1]).log2() - 2.0).abs()));
    println!("errors {:?}", errors(K_N_M2));
    held("order in space on water", 0.1, off(K_N_M2), off(1.05 * K_N_M2));
}
