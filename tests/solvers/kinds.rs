//! Modules that are not alike: mirror images, the full model, the operator and a bridge of equal modules beside them.
//!
//! Knows kinds that differ in everything they may differ in. Does not know studies.

#![allow(clippy::expect_used)]

use pontoon_core::analysis::crossing::OperatorSolver;
use pontoon_core::bridge::{BridgeDesign, Ends, MeshedBridge, Model, PreparedModule};
use pontoon_core::operator::{BridgeOperator, Followed, OperatorParts};
use pontoon_core::response::{CrossingResponse, Record, Section};
use pontoon_core::stop::Stop;
use pontoon_core::vehicle::Inertia;
use pontoon_tests::operated::{Apart, Both, deflections, forces, operator};
use pontoon_tests::*;
use serde_json::{Value, json};
use std::sync::Arc;

const KEYS_OF_A_KIND: [&str; 5] = [
    "module",
    "hydrostatic_stiffness_pa_m",
    "added_mass_kg_m",
    "draft_m",
    "freeboard_m",
];

/// Smoke's module as a kind, its deck `thicker` times as thick.
fn interior(thicker: f64) -> Value {
    let smoke = serde_json::to_value(design("smoke")).expect("a document");
    let mut kind: Value = KEYS_OF_A_KIND
        .map(|key| (key.to_owned(), smoke[key].clone()))
        .into_iter()
        .collect();
    let thickness = kind["module"]["deck_thickness_m"].as_f64().expect("a thickness");
    kind["module"]["deck_thickness_m"] = json!(thicker * thickness);
    kind
}

/// A shorter, lower kind with other plates, walls, stiffeners, elements and water; its wall is not in the middle.
fn ramp(water: f64) -> Value {
    let mut kind = interior(1.4);
    let module = &mut kind["module"];
    module["length_m"] = json!(5.0);
    module["depth_m"] = json!(0.8);
    module["transverse_walls"]["x_m"] = json!([1.2, 3.0]);
    module["stiffeners"]["transverse_x_m"] = json!([0.0, 1.2, 5.0]);
    module["longitudinal_walls"]["y_m"] = json!([-1.5, 1.5]);
    module["mesh"]["elements_along"] = json!(3);
    kind["hydrostatic_stiffness_pa_m"] = json!(water * 6500.0);
    kind["added_mass_kg_m"] = json!(9000.0);
    kind["draft_m"] = json!(0.13);
    kind["freeboard_m"] = json!(0.67);
    kind
}

/// A ramp that slopes, dry at its left end; at its right end it is as deep as an interior module, its bottom higher than at the
/// left.
fn sloping(water: f64) -> Value {
    let mut kind = ramp(water);
    kind["module"]["deck_right_m"] = json!(1.2);
    kind["module"]["bottom_right_m"] = json!(0.13);
    kind["wet_from_m"] = json!(1.7);
    for key in ["draft_m", "freeboard_m"] {
        kind.as_object_mut().expect("an object").remove(key);
    }
    kind
}

/// A kind of ramp by the share of its water.
type RampOf = fn(f64) -> Value;

/// A bridge of kinds, else smoke's.
fn bridge(kinds: Value, modules: Value) -> BridgeDesign {
    let mut document = serde_json::to_value(design("smoke")).expect("a document");
    let keys = document.as_object_mut().expect("an object");
    KEYS_OF_A_KIND.iter().for_each(|key| drop(keys.remove(*key)));
    document["module_kinds"] = kinds;
    document["modules"] = modules;
    let design: BridgeDesign = serde_json::from_value(document).expect("a design");
    design.check().expect("a bridge");
    design
}

/// Ramps at both ends, the one on the right mirrored, and one more ramp between modules.
fn unlike(water: f64) -> BridgeDesign {
    with_ramps(ramp(water))
}

/// Such a row with another kind of ramp.
fn with_ramps(ramp: Value) -> BridgeDesign {
    let row = json!([{ "kind": "ramp" }, { "kind": "interior", "count": 2 }, { "kind": "ramp", "mirrored": true }]);
    bridge(json!({ "interior": interior(1.0), "ramp": ramp }), row)
}

/// Ramps at places that are no mirror image of themselves.
fn lopsided() -> [Value; 2] {
    let row =
        json!([{ "kind": "ramp" }, { "kind": "interior" }, { "kind": "ramp" }, { "kind": "interior", "count": 2 }]);
    let image = json!([{ "kind": "interior", "count": 2, "mirrored": true }, { "kind": "ramp", "mirrored": true },
                       { "kind": "interior", "mirrored": true }, { "kind": "ramp", "mirrored": true }]);
    [row, image]
}

fn solved(ready: &Ready, speed_m_s: f64, tolerance: f64) -> [CrossingResponse; 2] {
    let rayleigh = ready.rayleigh();
    let both = Both::new(ready, &operator(ready, tolerance), &settings(rayleigh, 0.01, 0.9));
    let vehicle = footprint(&[-0.4, 2.4], Inertia::Local);
    let crossing = ready.crossing(gaps(0.002, 0.001), PAPER_LOAD_N, speed_m_s);
    both.solve(&vehicle, &crossing).expect("solved")
}

#[test]
fn a_row_is_built_of_what_differs_in_it() {
    let d = unlike(1.0);
    let variants = d.variants();
    assert_eq!(variants.of_module, [0, 1, 1, 2]);
    assert_eq!(
        d.positions_m(),
        [0.0, 5.0, 11.7, 5.0 + 2.0 * 6.7, 5.0 + 2.0 * 6.7 + 5.0]
    );
    assert_eq!((d.modules, d.positions(), d.length_m()), (4, 5, d.position_x_m(5)));
    // its own mirror image
    let [row, image] = lopsided();
    let kinds = || json!({ "interior": interior(1.0), "ramp": ramp(1.0) });
    assert_eq!(bridge(kinds(), row).variants().designs.len(), 2);
    assert_eq!(bridge(kinds(), image).variants().of_module, [0, 0, 1, 0, 1]);
    // as it is written, it is read
    let again: BridgeDesign = serde_json::from_value(serde_json::to_value(&d).expect("a document")).expect("a design");
    assert_eq!(again, d);
}

/// Two kinds that differ by a billionth of a plate are smoke's modules: 1e-6 of peaks, a thousand times what the plate does.
/// Twin: the plate 5 % thicker.
#[test]
fn kinds_that_hardly_differ_are_equal_modules() {
    let row = || json!([{ "kind": "a" }, { "kind": "b" }, { "kind": "a" }]);
    let of = |thicker: f64| bridge(json!({ "a": interior(1.0), "b": interior(thicker) }), row());
    let plain = solved(&Ready::new(&design("smoke"), Model::SuperElement), 8.0, 0.0);
    let [right, wrong] = [1.0 + 1e-9, 1.05].map(|thicker| {
        let ready = Ready::new(&of(thicker), Model::SuperElement);
        assert_eq!(of(thicker).variants().designs.len(), 2);
        let found = solved(&ready, 8.0, 0.0);
        largest((0..2).map(|i| Apart::of(&found[i], &plain[i], PAPER_LOAD_N).most()))
    });
    held("kinds that hardly differ", 1e-6, right, wrong);
}

/// The mirror image of a row under a mirrored drive, in both solvers: 1e-7 of the largest, rounding of two condensations.
/// Twin: 5 % less water under one of the ramps' kind.
#[test]
fn a_mirrored_row_gives_mirrored_answers() {
    for (what, ramp) in [("mirrored row", ramp as RampOf), ("mirrored slope", sloping)] {
        mirrors(what, ramp);
    }
}

fn mirrors(what: &str, ramp: RampOf) {
    let [row, image] = lopsided();
    let of = |row: &Value, water: f64| bridge(json!({ "interior": interior(1.0), "ramp": ramp(water) }), row.clone());
    let mirrored = |water: f64| {
        with(&of(&image, water), |d| {
            std::mem::swap(&mut d.supports.left, &mut d.supports.right)
        })
    };
    let first = solved(&Ready::new(&of(&row, 1.0), Model::SuperElement), 8.0, 0.0);
    let backward = |r: &CrossingResponse| {
        let mut image = r.clone();
        image.positions.reverse();
        image.joints.reverse();
        [deflections(&image), forces(&image)]
    };
    let [right, wrong] = [1.0, 0.95].map(|water| {
        let found = solved(&Ready::new(&mirrored(water), Model::SuperElement), -8.0, 0.0);
        let miss = |i: usize| {
            let [moved, pressed] = backward(&found[i]);
            apart(&moved, &deflections(&first[i])).max(apart(&pressed, &forces(&first[i])))
        };
        miss(0).max(miss(1))
    });
    held(what, 1e-7, right, wrong);
}

/// Condensed frequencies are upper bounds, by at most 0.1 %. Twin: the full model on 5 % more water under the ramps.
#[test]
fn condensed_kinds_keep_the_frequencies_of_the_full_model() {
    for (what, ramp) in [
        ("frequencies of kinds", ramp as RampOf),
        ("frequencies of slopes", sloping),
    ] {
        keeps_frequencies(what, ramp);
    }
}

fn keeps_frequencies(what: &str, ramp: RampOf) {
    let condensed = Ready::new(&with_ramps(ramp(1.0)), Model::SuperElement).modes(16);
    let miss = |water: f64| {
        let full = Ready::new(&with_ramps(ramp(water)), Model::Full).modes(16);
        let above = |(c, f): (&_, &_)| -> f64 {
            let [c, f]: [&pontoon_core::analysis::modes::Mode; 2] = [c, f];
            let share = c.frequency_hz / f.frequency_hz - 1.0;
            // rounding of the search apart, none lies below
            if share < -1e-7 { f64::INFINITY } else { share }
        };
        // surge, sway and yaw have none
        largest(condensed.iter().zip(&full).skip(3).map(above))
    };
    held(what, 1e-3, miss(1.0), miss(1.05));
}

/// Load, water and supports of a static case add up to zero, force and both moments: 1e-8 of the load's. Twin: 5 % more load.
/// Pins and connectors of a joint pull along the bridge as much as they push: 1e-8 of the largest. Twin: connectors 5 % off.
#[test]
fn a_row_of_kinds_is_in_equilibrium() {
    for ramp in [ramp as RampOf, sloping] {
        is_in_equilibrium(&with_ramps(ramp(1.0)));
    }
}

fn is_in_equilibrium(design: &BridgeDesign) {
    let ready = Ready::new(design, Model::SuperElement);
    let vehicle = footprint(&[-0.4, 2.4], Inertia::None);
    for x_m in [2.0, 5.0, 9.0, 20.0] {
        let case = ready.case(gaps(0.002, 0.001), PAPER_LOAD_N, x_m);
        let answer = ready.statics(&vehicle).solve(&case).expect("solved");
        let e = answer.equilibrium;
        let sum = |factor: f64, i: usize| (factor * e.load[i] + e.water[i] + e.supports[i]).abs() / e.load[i].abs();
        let [right, wrong] = [1.0, 1.05].map(|factor| largest((0..3).map(|i| sum(factor, i))));
        held("equilibrium of kinds", 1e-8, right, wrong);
        let forces = || answer.joints.iter().map(|joint| joint.sum_n);
        let scale = largest(forces().map(f64::abs));
        let [right, wrong] = [0.0, 0.05].map(|off| {
            let joints = answer.sections.iter().zip(forces());
            largest(joints.map(|(section, sum)| (section[Section::Axial as usize] + off * sum).abs())) / scale
        });
        held("axial force of joints", 1e-8, right, wrong);
    }
}

/// What a crossing of unlike modules records, pins included.
fn recorded(ready: &Ready) -> SingleCrossing {
    let mut crossing = ready.crossing(gaps(0.002, 0.001), PAPER_LOAD_N, 8.0);
    crossing.record = Record {
        positions: vec![1, 2, 4],
        joints: vec![2, 4],
        places_x_m: vec![3.3, 13.1],
        pins: true,
        sections: true,
        ..Record::default()
    };
    crossing
}

/// All peaks of pins `[N]`.
fn pins(r: &CrossingResponse) -> Vec<f64> {
    let each = r.pins.iter().flat_map(|pin| &pin.extremes.components);
    each.flat_map(|peaks| [peaks.compression.value, peaks.tension.value])
        .collect()
}

/// The operator beside the reference solver on unlike modules: with every mode 1e-8, with the modes that studies keep 1 %; on slopes
/// with every mode.
/// Twin: an operator on 5 % more water under the ramps.
#[test]
fn the_operator_of_unlike_modules_is_the_reference_solver() {
    is_the_reference_solver("unlike modules", ramp, &[(0.0, 1e-8), (6e-4, 1e-2)]);
    is_the_reference_solver("sloping modules", sloping, &[(0.0, 1e-8)]);
}

/// Holds the operator of each tolerance to a limit.
fn is_the_reference_solver(what: &str, ramp: RampOf, limits: &[(f64, f64)]) {
    let (ready, other) = (
        Ready::new(&with_ramps(ramp(1.0)), Model::SuperElement),
        Ready::new(&with_ramps(ramp(1.3)), Model::SuperElement),
    );
    let settings = settings(ready.rayleigh(), 0.01, 0.9);
    let crossing = recorded(&ready);
    let followed = Followed {
        pins: true,
        places_x_m: crossing.record.places_x_m.clone(),
    };
    for &(tolerance, limit) in limits {
        let operator = |ready: &Ready| {
            Arc::new(
                BridgeOperator::new_unless(&ready.bridge, tolerance, &followed, Stop::never()).expect("an operator"),
            )
        };
        let own = operator(&ready);
        // kept and read again it is the one that was built
        let kept = OperatorParts::of(&own).operator(&ready.bridge).expect("an operator");
        assert_eq!(OperatorParts::of(&kept), OperatorParts::of(&own));
        let both = Both::new(&ready, &Arc::new(kept), &settings);
        let twin = OperatorSolver::new(&other.bridge, &operator(&other), &settings);
        for inertia in [Inertia::None, Inertia::Local, Inertia::Convective] {
            let vehicle = footprint(&[-0.4, 3.9], inertia);
            let [found, expected] = both.solve(&vehicle, &crossing).expect("solved");
            let wrong = twin.solve_single(&vehicle, &crossing).expect("solved");
            let miss = |r: &CrossingResponse| {
                let peaks = Apart::of(r, &expected, PAPER_LOAD_N).most();
                peaks.max(apart(&pins(r), &pins(&expected)))
            };
            held(
                &format!("{what}, {inertia:?}, {tolerance:e}"),
                limit,
                miss(&found),
                miss(&wrong),
            );
            assert_eq!(
                (found.bottom_emerged, found.deck_submerged),
                (expected.bottom_emerged, expected.deck_submerged)
            );
        }
    }
}

/// Bottoms of a row that slopes meet in the hinges in pictures, and the deck of a crossing's wheels lies on the mesh's.
#[test]
fn bottoms_of_slopes_meet_in_the_hinges() {
    let design = with_ramps(sloping(1.0));
    let modules = PreparedModule::of_kinds(&design, Model::SuperElement).expect("modules");
    let meshed = MeshedBridge::of_kinds(&design, &modules, Ends::Supported).expect("a mesh");
    assert_eq!(design.bases_m(), [0.0, 0.13, 0.13, 0.13]);
    for link in &meshed.hinges {
        let [a, b] = link.nodes.map(|node| meshed.nodes_m[node]);
        assert!(largest((0..3).map(|i| (a[i] - b[i]).abs())) < 1e-12, "{link:?}");
        assert_eq!(b[2], 0.13);
    }
    let near = |x_m: f64, z_m: f64| {
        let miss = |p: &[f64; 3]| (p[0] - x_m).abs().max((p[2] - z_m).abs());
        meshed.nodes_m.iter().map(miss).fold(f64::INFINITY, f64::min)
    };
    let ends = [
        (0.0, 0.8),
        (3.0, 1.04),
        (5.0, 1.2),
        (11.7, 1.2),
        (18.4, 1.2),
        (20.4, 1.04),
        (23.4, 0.8),
    ];
    for (x_m, deck_m) in ends {
        assert!(
            (design.deck_m(x_m) - deck_m).abs() < 1e-12,
            "{x_m}: {}",
            design.deck_m(x_m)
        );
        assert!(near(x_m, deck_m) < 1e-9, "no deck at {x_m}");
    }
    let bottom = |x_m: f64, z_m: f64| assert!(near(x_m, z_m) < 1e-9, "no bottom at {x_m}");
    bottom(0.0, 0.0);
    bottom(1.7, 0.13 * 1.7 / 5.0);
    bottom(23.4, 0.0);
    bottom(23.4 - 1.7, 0.13 * 1.7 / 5.0);
}

/// In the mesh of a row of kinds hinges of neighbours are at one place and move as one, decks of unlike depth do not meet, and
/// the centre of the bottom moves as the positions do: 1e-9 of the largest. Twin: 5 % more of the motion.
#[test]
fn the_mesh_of_a_row_moves_as_its_bridge() {
    for model in [Model::Full, Model::SuperElement] {
        let design = unlike(1.0);
        let modules = PreparedModule::of_kinds(&design, model).expect("modules");
        let meshed = MeshedBridge::of_kinds(&design, &modules, Ends::Supported).expect("a mesh");
        let ready = Ready::new(&design, model);
        let vehicle = footprint(&[-0.4, 2.4], Inertia::None);
        let case = ready.case(gaps(0.002, 0.001), PAPER_LOAD_N, 9.0);
        let statics = pontoon_core::analysis::statics::StaticSolver::new(&ready.bridge).expect("statics");
        let (state, answer) = (
            statics.state(&vehicle, &case).expect("solved"),
            statics.solve(&vehicle, &case).expect("solved"),
        );
        let moved = meshed.displacement_m(&state.u);
        let scale = largest(answer.deflection_m.iter().map(|z| z.abs()));
        for link in &meshed.hinges {
            let [a, b] = link.nodes;
            assert_eq!(meshed.nodes_m[a], meshed.nodes_m[b], "{link:?}");
            assert!(
                largest((0..3).map(|i| (moved[a][i] - moved[b][i]).abs())) < 1e-9 * scale,
                "{link:?}"
            );
        }
        let depths: Vec<[f64; 2]> = meshed
            .connectors
            .iter()
            .map(|link| link.nodes.map(|node| meshed.nodes_m[node][2]))
            .collect();
        assert_eq!(
            depths,
            [
                [0.8, 1.07],
                [0.8, 1.07],
                [1.07, 1.07],
                [1.07, 1.07],
                [1.07, 0.8],
                [1.07, 0.8]
            ]
        );
        let at = |x_m: f64| {
            let is_there = |p: &[f64; 3]| largest([p[0] - x_m, p[1], p[2]].map(f64::abs)) < 1e-9;
            meshed.nodes_m.iter().position(is_there).expect("a node")
        };
        let bottom: Vec<f64> = design.positions_m().iter().map(|&x_m| -moved[at(x_m)][2]).collect();
        let [right, wrong] =
            [1.0, 1.05].map(|f| apart(&bottom.iter().map(|z| f * z).collect::<Vec<_>>(), &answer.deflection_m));
        held("bottom of the mesh", 1e-9, right, wrong);
    }
}

/// What is known of the aluminium bay: its mass, thus its draught, by the sum over its elements to 0.1 %; and its heave afloat, by hand
/// `sqrt(rho g A / (m + m_a l)) / 2 pi` with the added mass that is assumed, to 0.5 %, for its plates give. Twin: 5 % more mass;
/// 5 % more water.
#[test]
fn the_interior_bay_floats_as_it_is_known_to() {
    let row = design("interior_bay_692");
    let of_kind = row.named_kinds().into_iter().find(|(key, _)| key.ends_with("interior"));
    let bay = with(&of_kind.expect("interior bays").1, |d| {
        (d.modules, d.row) = (1, None);
        (d.joints, d.banks) = (pontoon_core::bridge::Joints::default(), Vec::new());
    });
    let (length_m, breadth_m) = (bay.module.length_m, bay.module.breadth_m);
    let ready = Ready::new(&bay, Model::Full);
    let mass_kg = ready.module.structural_mass_kg();
    held(
        "mass of the bay",
        1e-3,
        miss(mass_kg, 6350.0),
        miss(1.05 * mass_kg, 6350.0),
    );
    let draught_m = mass_kg / (1000.0 * length_m * breadth_m);
    let draft_m = bay.draft_m.expect("a draft");
    assert!(
        (draught_m - draft_m).abs() < 1e-3,
        "{draught_m} m, the file has {draft_m} m"
    );
    let heave_hz = frequency_hz(&ready.modes(8), "heave");
    let by_hand = |water: f64| {
        let stiffness_n_m = water * 9806.65 * length_m * breadth_m;
        (stiffness_n_m / (mass_kg + bay.m_a() * length_m)).sqrt() / (2.0 * std::f64::consts::PI)
    };
    held(
        "heave of the bay",
        5e-3,
        miss(heave_hz, by_hand(1.0)),
        miss(heave_hz, by_hand(1.05)),
    );
}
