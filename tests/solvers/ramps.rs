//! Ramps that are dry in part, or dry, on one-sided banks: the full model, what carries them, crossings by both solvers.
//!
//! Knows a row of boxes between two ramps. Does not know studies.

#![allow(clippy::expect_used)]

use crate::dead::{GAPS, most, moving, standing};
use pontoon_core::analysis::modes::Rayleigh;
use pontoon_core::bridge::{BridgeDesign, Model};
use pontoon_core::response::CrossingResponse;
use pontoon_core::vehicle::{GRAVITY_M_S2, Inertia};
use pontoon_tests::operated::{Both, deflections, forces, operator};
use pontoon_tests::*;
use serde_json::{Map, Value, json};

/// Three of smoke's modules between ramps on one-sided banks; `ramp` is what the ramps' kind has in place of the interior's.
fn with_ramps(ramp: &Value, bank_n_m: f64) -> BridgeDesign {
    let mut document = serde_json::to_value(design("smoke")).expect("a document");
    let interior = json!({ "module": document["module"].take(), "hydrostatic_stiffness_pa_m": 7486.0, "added_mass_kg_m": 11135.0 });
    let mut of_ramp = interior.clone();
    for (key, value) in ramp.as_object().expect("an object") {
        of_ramp[key] = value.clone();
    }
    let of_ramp: Map<String, Value> = of_ramp
        .as_object()
        .expect("an object")
        .clone()
        .into_iter()
        .filter(|(_, value)| !value.is_null())
        .collect();
    let object = document.as_object_mut().expect("an object");
    for key in [
        "module",
        "hydrostatic_stiffness_pa_m",
        "added_mass_kg_m",
        "draft_m",
        "freeboard_m",
    ] {
        object.remove(key);
    }
    document["module_kinds"] = json!({ "interior": interior, "ramp": of_ramp });
    document["modules"] =
        json!([{ "kind": "ramp", "mirrored": true }, { "kind": "interior", "count": 3 }, { "kind": "ramp" }]);
    document["supports"] = json!({ "left": ["x", "y"], "right": ["y"] });
    let bank = |at: &str| json!({ "at": at, "direction": "z", "stiffness_n_m": bank_n_m });
    document["banks"] = json!([bank("left"), bank("right")]);
    let design: BridgeDesign = serde_json::from_value(document).expect("a design");
    design.check().expect("a bridge");
    design
}

/// Ramps that are dry in part, and ramps that are dry, which nothing but their hinges and one-sided banks holds: at rest and under a
/// load the super-element is the full model, in which every node has its weight, to 1e-9 of the largest; reactions and water carry
/// the dry weight, that of the plates by hand where all of a ramp is dry, to 1e-10. Twins: banks 5 % softer; the answer of banks
/// 5 % off.
#[test]
fn ramps_lie_on_their_banks() {
    let dry =
        json!({ "wet_from_m": 0.0, "wet_to_m": 0.0, "hydrostatic_stiffness_pa_m": null, "added_mass_kg_m": null });
    let in_part = json!({ "wet_to_m": 3.35 });
    for (ramp, is_dry) in [(&in_part, false), (&dry, true)] {
        let solve = |bank_n_m: f64, model: Model| {
            let ready = Ready::new(&with_ramps(ramp, bank_n_m), model);
            let case = standing(&ready, GAPS, PAPER_LOAD_N, 10.0);
            let at_rest = case.dead.clone().expect("a dead load");
            let solved = ready
                .statics(&footprint(&[-1.4, 1.4], Inertia::None))
                .solve(&case)
                .expect("solved");
            let forces = at_rest.forces_n.iter().map(|n| 1e-6 * n);
            let moved = solved.deflection_m.iter().chain(&at_rest.deflection_m).copied();
            let banks = solved.banks.iter().map(|of| 1e-6 * of.2);
            let numbers: Vec<f64> = moved.chain(forces).chain(banks).collect();
            (
                numbers,
                at_rest.equilibrium,
                solved.equilibrium,
                ready.module.structural_mass_kg(),
            )
        };
        let (expected, ..) = solve(1e7, Model::Full);
        let (found, at_rest, loaded, mass_kg) = solve(1e7, Model::SuperElement);
        let (wrong, ..) = solve(9.5e6, Model::SuperElement);
        held(
            "ramps on banks",
            1e-9,
            apart(&found, &expected),
            apart(&wrong, &expected),
        );
        for of in [at_rest, loaded] {
            let length_m = design("smoke").module.length_m * 5.0;
            let sum = |factor: f64| {
                let scale = [1.0, length_m, length_m];
                let sums = [0, 1, 2].map(|i| (of.load[i] + of.water[i] + factor * of.banks[i]) / scale[i]);
                most(&sums) / of.load[0].abs()
            };
            held("what carries ramps", 1e-10, sum(1.0), sum(1.05));
        }
        if is_dry {
            let by_hand = -2.0 * mass_kg * GRAVITY_M_S2;
            held(
                "weight of two ramps",
                1e-10,
                miss(at_rest.load[0], by_hand),
                miss(1.05 * at_rest.load[0], by_hand),
            );
        }
    }
}

/// A crossing over dry ramps, which nothing linear holds up, by both solvers: all modes kept to 1e-8 of the largest. Twin: banks 5 %
/// softer.
#[test]
fn both_solvers_cross_dry_ramps() {
    let dry =
        json!({ "wet_from_m": 0.0, "wet_to_m": 0.0, "hydrostatic_stiffness_pa_m": null, "added_mass_kg_m": null });
    let settings = settings(Rayleigh::new(0.02, 0.1), 0.01, 0.9);
    let vehicle = footprint(&[-1.4, 1.4], Inertia::Local);
    let solve = |bank_n_m: f64| {
        let ready = Ready::new(&with_ramps(&dry, bank_n_m), Model::SuperElement);
        let both = Both::new(&ready, &operator(&ready, 0.0), &settings);
        both.solve(&vehicle, &moving(&ready, GAPS, PAPER_LOAD_N))
            .expect("solved")
    };
    let [operated, direct] = solve(1e7);
    let numbers = |r: &CrossingResponse| -> Vec<f64> {
        let banks = r.recorded.banks.iter().map(|b| 1e-6 * b.force.tension.value);
        deflections(r)
            .into_iter()
            .chain(forces(r).into_iter().map(|n| 1e-6 * n))
            .chain(banks)
            .collect()
    };
    let [right, wrong] = [&operated, &solve(9.5e6)[0]].map(|r| apart(&numbers(r), &numbers(&direct)));
    held("crossing over dry ramps", 1e-8, right, wrong);
    assert!(direct.energy.energy_residual < 1e-9, "{:?}", direct.energy);
}
