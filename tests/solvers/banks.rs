//! Banks: springs between the bridge and the ground, one-sided and both ways, beside closed forms and other codes.
//!
//! Knows beams on water and the plane chain. Does not know studies.

#![allow(clippy::expect_used)]

use pontoon_core::bridge::{BankPlace, BankSpec, BridgeDesign, BridgeEnd, Direction, Model, Supports};
use pontoon_core::response::{CrossingResponse, StaticResponse};
use pontoon_core::vehicle::Inertia;
use pontoon_plan::input::Document;
use pontoon_tests::chain_answer::answer;
use pontoon_tests::chain_scenario::ChainScenario;
use pontoon_tests::operated::{Both, operator};
use pontoon_tests::*;
use serde_json::{Value, json};
use std::path::Path;

fn bank(at: BridgeEnd, direction: Direction, stiffness_n_m: f64) -> BankSpec {
    BankSpec {
        at: BankPlace::End(at),
        direction,
        stiffness_n_m,
        one_sided: true,
        toward: None,
        clearance_m: 0.0,
        preload_n: None,
        damping_n_s_m: 0.0,
        y_m: None,
    }
}

/// Smoke's bridge.
fn three() -> BridgeDesign {
    design("smoke")
}

/// The answer of a bank's sum over its places `[N]`.
fn reaction(r: &StaticResponse, bank: usize) -> f64 {
    r.banks.iter().filter(|of| of.0 == bank).map(|of| of.2).sum()
}

/// Springs that hold both ways of 1e15 N/m, in place of every support: peaks and reactions of the supports to 1e-6, the
/// ratio of the stiffnesses. Twin: 5 % more load.
#[test]
fn stiff_springs_are_supports() {
    let supported = three();
    let held_by_springs = with(&supported, |d| {
        d.supports = Supports {
            left: Vec::new(),
            right: Vec::new(),
        };
        let (left, right) = (BridgeEnd::Left, BridgeEnd::Right);
        let places = [
            (left, Direction::X),
            (left, Direction::Y),
            (left, Direction::Z),
            (right, Direction::Y),
            (right, Direction::Z),
        ];
        d.banks = places
            .map(|(end, direction)| BankSpec {
                one_sided: false,
                ..bank(end, direction, 1e15)
            })
            .to_vec();
    });
    let vehicle = footprint(&[-0.4, 2.4], Inertia::Local);
    // damping of one bridge, as both float alike
    let rayleigh = Ready::new(&supported, Model::SuperElement).rayleigh();
    let solve = |design: &BridgeDesign, factor: f64| -> [Vec<f64>; 2] {
        let ready = Ready::new(design, Model::SuperElement);
        let crossing = ready.crossing(gaps(0.002, 0.001), factor * PAPER_LOAD_N, 9.0);
        let solved = ready
            .crossings(&vehicle, &settings(rayleigh, 0.01, 0.9))
            .solve(&crossing)
            .expect("solved");
        let deflections = solved
            .positions
            .iter()
            .flat_map(|p| [p.deflection.value, p.uplift.value]);
        let joints = solved
            .joints
            .iter()
            .flat_map(|j| [j.sum.compression.value, j.sum.tension.value]);
        [deflections.collect(), joints.collect()]
    };
    let first = solve(&supported, 1.0);
    let [right, wrong] = [1.0, 1.05].map(|factor| solve(&held_by_springs, factor));
    for i in 0..2 {
        held(
            "peaks on springs",
            1e-6,
            apart(&right[i], &first[i]),
            apart(&wrong[i], &first[i]),
        );
    }
    let case = |design: &BridgeDesign, factor: f64| -> StaticResponse {
        let ready = Ready::new(design, Model::SuperElement);
        let case = ready.case(gaps(0.002, 0.001), factor * PAPER_LOAD_N, 4.0);
        ready.statics(&vehicle).solve(&case).expect("solved")
    };
    let [up, ..] = case(&supported, 1.0).equilibrium.supports;
    let vertical = |r: &StaticResponse| reaction(r, 2) + reaction(r, 4);
    let [right, wrong] = [1.0, 1.05].map(|factor| miss(vertical(&case(&held_by_springs, factor)), up));
    held("reactions on springs", 1e-6, right, wrong);
}

/// Banks that never let go are springs that hold both ways: one of a stiffness in K, the other a link, in both solvers.
/// Tolerance: 1e-9 of the largest for the reference solver, 5e-3 for the operator with the modes that studies keep. Twin: 5 %
/// more stiffness of the banks.
#[test]
fn a_bank_under_load_is_a_spring() {
    let on_banks = |one_sided: bool, factor: f64| {
        with(&three(), |d| {
            d.supports = Supports {
                left: vec![Direction::X, Direction::Y],
                right: vec![Direction::Y],
            };
            let spec = |end: BridgeEnd| BankSpec {
                one_sided,
                y_m: Some(vec![-1.125, 1.125]),
                ..bank(end, Direction::Z, factor * 4e6)
            };
            // never apart: far against its sense
            d.banks = vec![spec(BridgeEnd::Left), spec(BridgeEnd::Right)];
        })
    };
    let vehicle = footprint(&[-1.4, 1.4], Inertia::None);
    let solve = |design: &BridgeDesign| -> Vec<f64> {
        let ready = Ready::new(design, Model::SuperElement);
        // standing in the middle both ends are pressed down
        let mut case = ready.case(gaps(0.002, 0.001), PAPER_LOAD_N, 10.05);
        case.own_laws = design.own_laws(gaps(0.002, 0.001), None).expect("laws");
        let solved = ready.statics(&vehicle).solve(&case).expect("solved");
        let banks = (0..2).map(|bank| 1e-6 * reaction(&solved, bank));
        solved.deflection_m.iter().copied().chain(banks).collect()
    };
    let springs = solve(&on_banks(false, 1.0));
    let [right, wrong] = [1.0, 1.05].map(|factor| apart(&solve(&on_banks(true, factor)), &springs));
    held("banks pressed down", 1e-9, right, wrong);
}

/// Both solvers on banks with clearance, a slack cable and a dashpot: all modes kept to rounding, with those that studies keep
/// 1 % of the largest reaction. Twin: 5 % more stiffness of the banks.
#[test]
fn operator_finds_the_banks_of_the_reference_solver() {
    let on_banks = |factor: f64| {
        with(&three(), |d| {
            d.supports = Supports {
                left: vec![Direction::Y],
                right: vec![Direction::Y],
            };
            let mut left = bank(BridgeEnd::Left, Direction::Z, factor * 1e7);
            left.y_m = Some(vec![-1.125, 1.125]);
            left.damping_n_s_m = 2e4;
            let mut right = bank(BridgeEnd::Right, Direction::Z, factor * 2e7);
            right.clearance_m = 0.004;
            let along = BankSpec {
                one_sided: false,
                ..bank(BridgeEnd::Left, Direction::X, factor * 1e8)
            };
            let cable = BankSpec {
                clearance_m: 1e-5,
                ..bank(BridgeEnd::Right, Direction::X, factor * 1e7)
            };
            d.banks = vec![left, right, along, cable];
        })
    };
    let vehicle = footprint(&[-0.4, 2.4], Inertia::Local);
    let rayleigh = Ready::new(&three(), Model::SuperElement).rayleigh();
    let forces = |r: &CrossingResponse| -> Vec<f64> {
        let each = r
            .recorded
            .banks
            .iter()
            .flat_map(|of| [of.force.tension.value, of.force.compression.value]);
        each.collect()
    };
    for (tolerance, allowed) in [(0.0, 1e-8), (6e-4, 1e-2)] {
        let solve = |factor: f64| {
            let ready = Ready::new(&on_banks(factor), Model::SuperElement);
            let both = Both::new(&ready, &operator(&ready, tolerance), &settings(rayleigh, 0.01, 0.9));
            let mut asked = ready.crossing(gaps(0.002, 0.001), PAPER_LOAD_N, 8.0);
            asked.own_laws = ready.design.own_laws(gaps(0.002, 0.001), None).expect("laws");
            both.solve(&vehicle, &asked).expect("solved")
        };
        let [found, expected] = solve(1.0);
        let [twin, _] = solve(1.05);
        let [right, wrong] = [&found, &twin].map(|r| apart(&forces(r), &forces(&expected)));
        held(&format!("reactions, tolerance {tolerance}"), allowed, right, wrong);
        let positions = |r: &CrossingResponse| -> Vec<f64> {
            let each = r.positions.iter().flat_map(|p| [p.deflection.value, p.uplift.value]);
            each.collect()
        };
        let [right, wrong] = [&found, &twin].map(|r| apart(&positions(r), &positions(&expected)));
        held(&format!("deflections, tolerance {tolerance}"), allowed, right, wrong);
        assert!(
            forces(&expected).iter().filter(|force| **force > 1e3).count() >= 4,
            "{:?}",
            forces(&expected)
        );
        assert!(found.energy.energy_residual < 1e-9, "{:?}", found.energy);
    }
}

/// The plane chain on one-sided banks of 1e7 N/m in place of its supports: numbers of a plain prototype. Statics 1e-4 (its last
/// printed digit is coarser in places), crossings: deflections 0.3 %, banks 1 %, compression 2 %. Twin: banks 5 % stiffer for
/// the statics, 5 % more load for the crossing.
#[test]
fn the_chain_on_banks_is_that_of_an_independent_code() {
    let asked = |scenario: Value| {
        let document = Document::of_canonical(scenario.to_string());
        let scenario = ChainScenario::of(Path::new("scenario.json"), &document, None).expect("a scenario");
        answer(&scenario).expect("an answer")
    };
    let banks = |stiffness: f64| json!([{ "at": "left", "direction": "z", "stiffness_n_m": stiffness }, { "at": "right", "direction": "z", "stiffness_n_m": stiffness }]);
    let number = |of: &Value, path: &str| of.pointer(path).and_then(Value::as_f64).unwrap_or(f64::NAN);
    let still = |factor: f64| {
        let r = asked(json!({ "banks": banks(factor * 1e7), "analysis": { "kind": "static" }, "load_x_m": 1.675 }));
        [
            number(&r, "/positions/0/deflection_m") / 0.01858,
            number(&r, "/positions/1/deflection_m") / 0.05845,
            number(&r, "/joints/0/force_n") / -122_670.0,
            number(&r, "/banks/0/force_n") / 185_830.0,
        ]
    };
    // the first two are printed to four digits
    let [right, wrong] = [1.0, 1.05].map(|factor| apart(&still(factor), &[1.0; 4]));
    held("statics", 2e-4, right, wrong);
    let driven = |factor: f64| {
        let r = asked(json!({ "banks": banks(1e7), "speed_m_s": 3, "load_n": factor * 230_300.0 }));
        let deflections = [
            number(&r, "/positions/6/peak_deflection_m"),
            number(&r, "/largest/peak_deflection_m"),
        ];
        let compression = [
            number(&r, "/joints/5/peak_compression_n"),
            number(&r, "/largest/peak_compression_n"),
        ];
        let reactions = [
            number(&r, "/banks/0/peak_toward_n"),
            number(&r, "/banks/1/peak_toward_n"),
        ];
        [deflections, compression, reactions]
    };
    let [right, wrong] = [1.0, 1.05].map(driven);
    for (i, (allowed, expected)) in [
        (3e-3, [0.2115; 2]),
        (2e-2, [572.5e3, 724.4e3]),
        (1e-2, [213.3e3, 200.1e3]),
    ]
    .into_iter()
    .enumerate()
    {
        held(
            "3 m/s",
            allowed,
            apart(&right[i], &expected),
            apart(&wrong[i], &expected),
        );
    }
}
