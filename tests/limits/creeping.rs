//! Loads that creep: each position's largest static deflection against the single static cases at the same places.

#![allow(clippy::expect_used)]

use pontoon_core::analysis::statics::{CreepingLoad, StaticCase, StaticSolver};
use pontoon_core::bridge::Model;
use pontoon_core::connector::Connection;
use pontoon_core::vehicle::{Inertia, Vehicle};
use pontoon_tests::*;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use std::sync::OnceLock;

/// A bridge of three modules and one of the paper's fifteen.
fn bridges() -> &'static [(Ready, StaticSolver); 2] {
    static BRIDGES: OnceLock<[(Ready, StaticSolver); 2]> = OnceLock::new();
    BRIDGES.get_or_init(|| {
        ["smoke", "fu2005"].map(|name| {
            let ready = Ready::new(&design(name), Model::SuperElement);
            let solver = StaticSolver::new(&ready.bridge).expect("statics");
            (ready, solver)
        })
    })
}

/// The single static cases, each from open connectors, at places a quarter of an element apart.
fn one_by_one((ready, solver): &(Ready, StaticSolver), vehicle: &Vehicle, case: &StaticCase) -> Vec<f64> {
    let places = ready.design.modules * ready.design.module.mesh.elements_along * 4;
    let mut peaks = vec![0.0_f64; ready.design.modules + 1];
    for place in 0..=places {
        let load_x_m = ready.design.length_m() * place as f64 / places as f64;
        let case = StaticCase {
            load_x_m,
            ..case.clone()
        };
        let response = solver.solve(vehicle, &case).expect("solved");
        for (peak, w) in peaks.iter_mut().zip(response.deflection_m) {
            *peak = peak.max(w);
        }
    }
    peaks
}

fn vehicles() -> [(&'static str, Vehicle); 3] {
    let list = [(0.0, 0.25, 0.3), (3.2, 0.45, 0.3), (4.6, 0.3, 0.0)];
    [
        ("both lanes", footprint(&[-1.4, 1.4], Inertia::Local)),
        ("one lane", footprint(&[0.7, 3.1], Inertia::Convective)),
        ("axles", axles(&list, Inertia::None, 4)),
    ]
}

/// A creeping load is nothing but static cases: the same numbers whether each place starts from open connectors or from
/// the place before, and whether places or forces are solved for. 1e-12 of the largest: rounding through one more solution;
/// measured at 1e-14. Twins: the load, the trusses.
#[test]
fn creeping_load_is_the_static_cases_at_its_places() {
    for bridge in bridges() {
        for (name, vehicle) in vehicles() {
            let load: CreepingLoad = bridge.1.creeping(&vehicle);
            for connection in [Connection::Linear, PAPER_GAPS, gaps(0.001, 0.0005), gaps(0.0, 0.0)] {
                let case = bridge.0.case(connection, PAPER_LOAD_N, 0.0);
                let expected = one_by_one(bridge, &vehicle, &case);
                let heavy = bridge.0.case(connection, 1.05 * PAPER_LOAD_N, 0.0);
                let stiff = StaticCase {
                    connector_stiffness_n_m: 1.05 * case.connector_stiffness_n_m,
                    ..case.clone()
                };
                let found = |case: &StaticCase| apart(&load.peaks_m(case).expect("solved"), &expected);
                let what = format!("{name}, {} modules, {connection:?}", bridge.0.design.modules);
                held(&format!("{what}: load"), 1e-12, found(&case), found(&heavy));
                held(&format!("{what}: trusses"), 1e-12, found(&case), found(&stiff));
                let short_form = bridge.1.creeping_peaks_m(&vehicle, &case).expect("solved");
                assert_eq!(short_form, load.peaks_m(&case).expect("solved"), "{what}");
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 24,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(5),
        ..ProptestConfig::default()
    })]

    /// The contact has one solution, so that a start from the place before finds what a start from open connectors finds:
    /// any gaps, weight and lane. 1e-12 and measured as above. Twin: a twentieth more weight.
    #[test]
    fn warm_starts_find_what_cold_ones_find(
        which in 0_usize..2,
        gap_tension_m in prop_oneof![Just(0.0), 0.0..0.03],
        gap_compression_m in prop_oneof![Just(0.0), 0.0..0.01],
        load_n in 2.0e4..1.0e6,
        lane_m in -2.5..2.5_f64,
    ) {
        let bridge = &bridges()[which];
        let vehicle = footprint(&[lane_m - 1.4, lane_m + 1.4], Inertia::None);
        let load = bridge.1.creeping(&vehicle);
        let case = |factor: f64| bridge.0.case(gaps(gap_tension_m, gap_compression_m), factor * load_n, 0.0);
        let expected = one_by_one(bridge, &vehicle, &case(1.0));
        let found = |factor: f64| apart(&load.peaks_m(&case(factor)).expect("solved"), &expected);
        held("warm start", 1e-12, found(1.0), found(1.05));
    }
}

/// A case is answered alike whatever was asked before it.
#[test]
fn cases_of_one_creeping_load_do_not_know_of_each_other() {
    let (ready, solver) = &bridges()[1];
    let load = solver.creeping(&footprint(&[-1.4, 1.4], Inertia::Local));
    let peaks = |connection| {
        load.peaks_m(&ready.case(connection, PAPER_LOAD_N, 0.0))
            .expect("solved")
    };
    let first = peaks(PAPER_GAPS);
    peaks(Connection::Linear);
    assert_eq!(peaks(PAPER_GAPS), first);
}
