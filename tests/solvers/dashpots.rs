//! Dashpots of connectors through both solvers: what they must equal, and what they must not change.
//!
//! Knows bridges whose connectors have dashpots. Does not know studies.

#![allow(clippy::expect_used)]

use pontoon_core::bridge::{BridgeDesign, Model};
use pontoon_core::connector::Connection;
use pontoon_core::response::{CrossingResponse, Record};
use pontoon_core::vehicle::Inertia;
use pontoon_tests::operated::*;
use pontoon_tests::*;
use serde_json::json;

/// Rounding, as without dashpots.
const ROUNDING: f64 = 1e-9;

/// Gaps that every joint meets.
const NARROW: Connection = gaps(0.002, 0.001);

/// Six modules of smoke's whose connectors have dashpots and all that a joint can have beside: an open coupling, a buffer before
/// a stop, a lost connector, no gap, none of the dashpots.
fn damped(factor: f64) -> BridgeDesign {
    let joints = json!({
        "2": { "connectors": { "tension": false, "damping_n_s_m": 6e5 } },
        "3": { "connectors": { "stiffness_n_m": 4e6, "stop_compression": { "gap_m": 0.003, "stiffness_n_m": 6e7 },
                               "stop_tension": { "gap_m": 0.004, "stiffness_n_m": 5e7 } } },
        "4": { "connectors": { "at_y_m": [2.02], "lost": true, "damping_n_s_m": factor * 3e5 } },
        "5": { "connectors": { "gap_compression_m": 0.0, "gap_tension_m": 0.0, "damping_n_s_m": 1e6 } },
        "6": { "connectors": { "damping_n_s_m": 0.0 } }
    });
    let design = with(&design("smoke"), |d| {
        d.modules = 6;
        d.connectors.damping_n_s_m = Some(factor * 2e5);
        d.joints = serde_json::from_value(joints).expect("joints");
    });
    design.check().expect("a design");
    design
}

/// The crossing with its design's dashpots.
fn crossing(design: &BridgeDesign, plain: SingleCrossing) -> SingleCrossing {
    let own_laws = design.own_laws(plain.connection, None).expect("laws");
    SingleCrossing { own_laws, ..plain }
}

/// Every mode in the operator: one motion through both solvers, as many solutions and switches, energies that close. Steps of
/// 10 ms, and of 50 ms, some of which are halved. Tolerance: rounding. Twin: most dashpots 5 % off in the operator's crossing.
#[test]
fn operator_takes_dashpots_as_the_reference_does() {
    let [right, wrong] = [1.0, 1.05].map(damped);
    let ready = Ready::new(&right, Model::SuperElement);
    let operator = operator(&ready, 0.0);
    let mut halved = 0;
    for (inertia, h, newton_limit) in [
        (Inertia::Local, 0.01, 40),
        (Inertia::None, 0.01, 40),
        (Inertia::Local, 0.05, 2),
    ] {
        let mut settings = settings(ready.rayleigh(), h, 0.9);
        settings.newton_limit = newton_limit;
        let both = Both::new(&ready, &operator, &settings);
        let vehicle = footprint(&[-0.4, 2.4], inertia);
        for connection in [NARROW, Connection::Linear] {
            let mut plain = ready.crossing(connection, 2.0 * PAPER_LOAD_N, 9.0);
            plain.record = Record {
                positions: vec![3],
                joints: vec![2, 3],
                ..Record::default()
            };
            let [found, expected] = both.solve(&vehicle, &crossing(&right, plain.clone())).expect("solved");
            let twin = both
                .operated
                .solve_single(&vehicle, &crossing(&wrong, plain))
                .expect("solved");
            let [of, wrong] = [&found, &twin].map(|r| Apart::of(r, &expected, PAPER_LOAD_N).most());
            held(&format!("{connection:?}, {inertia:?}, {h} s"), ROUNDING, of, wrong);
            assert_eq!(found.statistics, expected.statistics);
            halved += found.statistics.bisections;
            for r in [&found, &expected] {
                assert!(r.energy.energy_residual < 1e-12, "{:?}", r.energy);
            }
            let dissipation = (found.energy.numerical_dissipation - expected.energy.numerical_dissipation).abs();
            assert!(dissipation < ROUNDING, "{dissipation:e}");
        }
    }
    assert!(halved > 0, "some steps are halved");
}

/// Crossings without dashpots, with them and with others, side by side in every order: each to the last bit as alone. Steps of
/// 50 ms, some of which are halved.
#[test]
fn lanes_with_dashpots_change_nothing_beside_them() {
    let designs = [Some(1.0), None, Some(0.3), None, Some(2.0)].map(|factor| factor.map(damped));
    let ready = Ready::new(&damped(1.0), Model::SuperElement);
    let operator = operator(&ready, 1e-3);
    for (h, newton_limit) in [(0.01, 40), (0.05, 2)] {
        let mut settings = settings(ready.rayleigh(), h, 0.9);
        settings.newton_limit = newton_limit;
        let both = Both::new(&ready, &operator, &settings);
        let vehicle = footprint(&[-0.4, 2.4], Inertia::Local);
        let of = |i: usize| {
            let mut plain = ready.crossing(NARROW, PAPER_LOAD_N, 6.0 + 0.7 * i as f64);
            plain.record.joints = vec![2, 5];
            match &designs[i % designs.len()] {
                Some(design) => crossing(design, plain),
                None => plain,
            }
        };
        let mixed: Vec<SingleCrossing> = (0..15).map(of).collect();
        let alone: Vec<_> = mixed
            .iter()
            .map(|crossing| both.operated.solve_single(&vehicle, crossing))
            .collect();
        for turned in 0..3 {
            let order: Vec<usize> = (0..mixed.len())
                .map(|i| (i * (2 * turned + 2) + turned) % mixed.len())
                .collect();
            let asked: Vec<_> = order.iter().map(|&i| (&vehicle, &mixed[i])).collect();
            for (together, &i) in solve_side_by_side(&both.operated, &asked, 0).into_iter().zip(&order) {
                assert_eq!(together, alone[i], "{h} s, crossing {i}");
            }
        }
        let halved = alone.iter().flatten().map(|r| r.statistics.bisections).sum::<usize>();
        assert_eq!(halved > 0, newton_limit == 2, "{halved} steps are halved");
    }
}

/// Dashpots of coefficient 0, and those of trusses that are not there, are none: exact. Static cases have none of any.
#[test]
fn dashpots_that_are_none_change_nothing() {
    let plain = with(&design("smoke"), |d| d.modules = 4);
    let none = with(&plain, |d| d.connectors.damping_n_s_m = Some(0.0));
    let lost = json!({ "2..4": { "connectors": { "lost": true } } });
    let lost = with(&plain, |d| d.joints = serde_json::from_value(lost).expect("joints"));
    let lost_damped = with(&lost, |d| d.connectors.damping_n_s_m = Some(1e6));
    let some = with(&plain, |d| d.connectors.damping_n_s_m = Some(1e5));
    for connection in [NARROW, Connection::Linear] {
        let laws = |design: &BridgeDesign| design.own_laws(connection, None).expect("laws");
        assert!(laws(&none).is_empty());
        assert_eq!(laws(&lost), laws(&lost_damped));
        let ready = Ready::new(&plain, Model::SuperElement);
        let vehicle = footprint(&[-0.4, 2.4], Inertia::None);
        let at_rest = ready.case(connection, PAPER_LOAD_N, 9.0);
        let mut with_dashpots = at_rest.clone();
        with_dashpots.own_laws = laws(&some);
        assert_eq!(with_dashpots.own_laws.len(), 6);
        let statics = ready.statics(&vehicle);
        assert_eq!(statics.solve(&with_dashpots), statics.solve(&at_rest));
        // which is no test of nothing: a crossing does have them
        let crossings = ready.crossings(&vehicle, &settings(ready.rayleigh(), 0.01, 0.9));
        let asked = ready.crossing(connection, PAPER_LOAD_N, 9.0);
        let solved = |asked: &SingleCrossing| -> CrossingResponse { crossings.solve(asked).expect("solved") };
        assert_ne!(solved(&crossing(&some, asked.clone())), solved(&asked));
    }
}

/// Dashpots that are far stiffer in a step than trusses, met at speed: forces and deflections converge to those of a step of
/// 0.5 ms, and no step has to be halved. Tolerance: from 8 to 2 ms they get a tenth as wrong, by order 2 a sixteenth (measured
/// 0.024 and 0.038). Twin: dashpots 5 % off, towards which nothing converges.
#[test]
fn forces_of_strong_dashpots_converge() {
    let strong = |damping_n_s_m: f64| {
        let design = with(&design("smoke"), |d| {
            d.modules = 4;
            d.connectors.damping_n_s_m = Some(damping_n_s_m);
        });
        let ready = Ready::new(&design, Model::SuperElement);
        let vehicle = footprint(&[-0.4, 2.4], Inertia::None);
        let asked = crossing(&design, ready.crossing(NARROW, PAPER_LOAD_N, 12.0));
        let operator = operator(&ready, 1e-3);
        move |h: f64| {
            let both = Both::new(&ready, &operator, &settings(ready.rayleigh(), h, 0.9));
            let r = both.operated.solve_single(&vehicle, &asked).expect("solved");
            assert_eq!(r.statistics.bisections, 0);
            [forces(&r), deflections(&r)]
        }
    };
    let right = strong(4e6);
    let [coarse, middle, fine] = [0.008, 0.002, 0.0005].map(&right);
    let other = strong(1.05 * 4e6)(0.0005);
    for (i, what) in ["forces", "deflections"].into_iter().enumerate() {
        let shrinks = |to: &[Vec<f64>; 2]| apart(&middle[i], &to[i]) / apart(&coarse[i], &to[i]);
        held(what, 0.1, shrinks(&fine), shrinks(&other));
    }
}
