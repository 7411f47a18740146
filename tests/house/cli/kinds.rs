//! Kinds of modules, from the bridge file to the tables.

use super::refusals::refused;
use crate::stage::{Stage, stderr};
use serde_json::{Value, json};

const KEYS_OF_A_KIND: [&str; 5] = [
    "module",
    "hydrostatic_stiffness_pa_m",
    "added_mass_kg_m",
    "draft_m",
    "freeboard_m",
];

/// The stage's bridge with its module as the only kind, `interior`.
fn as_kind(bridge: &Value, modules: Value) -> Value {
    let (mut of_kinds, mut kind) = (bridge.clone(), json!({}));
    let keys = of_kinds.as_object_mut().unwrap();
    for key in KEYS_OF_A_KIND {
        kind[key] = keys.remove(key).unwrap();
    }
    of_kinds["module_kinds"] = json!({ "interior": kind });
    of_kinds["modules"] = modules;
    of_kinds
}

fn stage() -> Stage {
    let mut stage = Stage::new();
    stage.study["design"] = json!([{ "grid": {
        "connection": ["linear", "nonlinear"], "gap_tension_m": 0.002, "gap_compression_m": 0.001, "speed_m_s": [6, 9], "load_n": 3e5
    } }]);
    stage.study["record"] = json!({
        "positions": true, "connectors": true, "pins": true, "sections": true, "places_x_m": [4.0, 13.4],
        "histories": { "positions": [2], "joints": [3] }
    });
    stage
}

/// A stage whose bridge has a ramp at its right end, shorter than the others.
fn with_ramp() -> Stage {
    let mut stage = stage();
    stage.bridge = as_kind(
        &stage.bridge,
        json!([{ "kind": "interior", "count": 2 }, { "kind": "ramp" }]),
    );
    let mut ramp = stage.bridge["module_kinds"]["interior"].clone();
    ramp["module"]["length_m"] = json!(5.0);
    ramp["module"]["transverse_walls"]["x_m"] = json!([2.0]);
    ramp["module"]["stiffeners"]["transverse_x_m"] = json!([0.0, 2.0, 5.0]);
    stage.bridge["module_kinds"]["ramp"] = ramp;
    stage
}

/// That stage, its ramp sloping from bottom and deck of the others down to its right end, where it is dry.
fn with_slope() -> Stage {
    let mut stage = with_ramp();
    let ramp = &mut stage.bridge["module_kinds"]["ramp"];
    ramp["module"]["deck_right_m"] = json!(0.9);
    ramp["module"]["bottom_right_m"] = json!(0.4);
    ramp["wet_to_m"] = json!(3.0);
    for key in ["draft_m", "freeboard_m"] {
        ramp.as_object_mut().unwrap().remove(key);
    }
    stage
}

const TABLES: [&str; 7] = [
    "jobs",
    "positions",
    "connectors",
    "histories",
    "pins",
    "sections",
    "places",
];

#[test]
fn a_row_of_equal_kinds_is_the_number_of_modules_bit_for_bit() {
    for kind in ["crossing", "static", "modes"] {
        let mut stage = stage();
        let names: &[&str] = match kind {
            "crossing" => &TABLES,
            "static" => &["jobs", "positions", "connectors"],
            _ => &["jobs", "modes"],
        };
        match kind {
            "static" => {
                stage.study["analysis"] = json!({ "kind": "static" });
                stage.study["record"] = json!({ "positions": true, "connectors": true });
                stage.study["design"] = json!([{ "cases": [
                    { "connection": "nonlinear", "gap_tension_m": 0.002, "gap_compression_m": 0.001, "load_n": 3e5, "load_x_m": 7.0 } ] }]);
            }
            "modes" => {
                stage.study["analysis"] = json!({ "kind": "modes", "count": 9 });
                stage.study["record"] = json!({});
                stage.study.as_object_mut().unwrap().remove("vehicle");
                stage.study["design"] = json!([{ "cases": [{}] }]);
            }
            _ => {}
        }
        stage.ran("plain");
        let plain = stage.bridge.clone();
        let rows = [
            json!([{ "kind": "interior", "count": 3 }]),
            json!([{ "kind": "interior", "mirrored": true }, { "kind": "interior" }, { "kind": "interior", "mirrored": true }]),
        ];
        for (i, row) in rows.into_iter().enumerate() {
            stage.bridge = as_kind(&plain, row);
            let folder = format!("row {i}");
            stage.ran(&folder);
            for name in names {
                let table = |of: &str| stage.table(&format!("{of}/{name}.parquet"));
                assert!(table("plain").same_cells(&table(&folder)), "{kind}, {folder}, {name}");
            }
        }
        // and a kind that is not equal is told
        stage.bridge["module_kinds"]["interior"]["module"]["deck_thickness_m"] = json!(0.003);
        stage.ran("other");
        let table = |of: &str| stage.table(&format!("{of}/{}.parquet", names[names.len() - 1]));
        assert!(!table("plain").same_cells(&table("other")), "{kind}");
    }
}

#[test]
fn numbers_of_kinds_are_axes_under_their_paths() {
    let mut by_axis = with_ramp();
    by_axis.study["design"][0]["grid"]["bridge.module_kinds.ramp.module.deck_thickness_m"] = json!([0.004]);
    by_axis.study["design"][0]["grid"]["bridge.modules[0].count"] = json!([3]);
    by_axis.ran("r");
    let mut by_file = with_ramp();
    by_file.bridge["module_kinds"]["ramp"]["module"]["deck_thickness_m"] = json!(0.004);
    by_file.bridge["modules"][0]["count"] = json!(3);
    by_file.ran("r");
    for name in &TABLES[1..] {
        let table = |stage: &Stage| stage.table(&format!("r/{name}.parquet"));
        assert!(table(&by_axis).same_cells(&table(&by_file)), "{name}");
    }
    // each kind is condensed once, whatever the other one is
    let manifest = by_file.manifest("r");
    assert_eq!(manifest["condensations"], json!(2), "{manifest}");
    let mut both = with_ramp();
    both.study["design"][0]["grid"]["bridge.module_kinds.ramp.module.deck_thickness_m"] = json!([0.004, 0.005]);
    both.ran("r");
    assert_eq!(both.manifest("r")["condensations"], json!(3));
    // a ramp's end stands where the ramp says
    let places = both.numbers("r/positions.parquet", "x_m");
    assert_eq!(places[..4], [Some(0.0), Some(6.7), Some(13.4), Some(18.4)]);
}

#[test]
fn a_row_of_kinds_is_shown_and_exported() {
    for (stage, heights) in [(with_ramp(), None), (with_slope(), Some("[0.0,0.4,1.07,0.9]"))] {
        is_shown(&stage, heights);
    }
}

fn is_shown(stage: &Stage, heights: Option<&str>) {
    stage.ran("r");
    for arguments in [
        &["report", "r", "--out", "page.html"][..],
        &["modes", "bridge.json", "--module"],
        &["modes", "bridge.json"],
    ] {
        let output = stage.pontoon(arguments);
        assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", stderr(&output));
    }
    let page = std::fs::read_to_string(stage.path("page.html")).unwrap();
    assert!(page.contains("ramp 5 m"));
    assert_eq!(page.contains("\"module_heights_m\":"), heights.is_some());
    assert!(heights.is_none_or(|heights| page.contains(heights)), "{heights:?}");
}

#[test]
fn a_wet_part_that_is_the_whole_changes_nothing() {
    let mut stage = stage();
    stage.ran("plain");
    (stage.bridge["wet_from_m"], stage.bridge["wet_to_m"]) = (json!(0.0), json!(6.7));
    (
        stage.bridge["module"]["deck_right_m"],
        stage.bridge["module"]["bottom_right_m"],
    ) = (json!(1.07), json!(0.0));
    stage.ran("whole");
    for name in &TABLES[1..] {
        let table = |of: &str| stage.table(&format!("{of}/{name}.parquet"));
        assert!(table("plain").same_cells(&table("whole")), "{name}");
    }
    stage.bridge["wet_to_m"] = json!(6.3);
    stage.ran("dry in part");
    let table = |of: &str| stage.table(&format!("{of}/positions.parquet"));
    assert!(!table("plain").same_cells(&table("dry in part")));
}

#[test]
fn slopes_and_wet_parts_that_no_module_can_have_are_refused_at_the_key() {
    let ramp = |change: &dyn Fn(&mut Value), parts: &[&str]| {
        let mut stage = with_slope();
        change(&mut stage.bridge["module_kinds"]["ramp"]);
        refused(stage.write(), &[&["bridge.json: module_kinds.ramp."], parts].concat());
    };
    ramp(
        &|r| r["wet_from_m"] = json!(-1),
        &["wet_from_m: found -1, allowed: a number from 0 to 5"],
    );
    ramp(
        &|r| r["wet_from_m"] = json!(3.5),
        &["wet_to_m: found 3, allowed: a number from 3.5 to 5"],
    );
    ramp(
        &|r| r["wet_to_m"] = json!(5.1),
        &["wet_to_m: found 5.1, allowed: a number from 0 to 5"],
    );
    ramp(
        &|r| r["wet_to_m"] = json!(0),
        &[
            "hydrostatic_stiffness_pa_m: found a value",
            "nothing: the module is dry",
        ],
    );
    ramp(
        &|r| {
            r["wet_to_m"] = json!(0);
            r["module"]["bottom_right_m"] = json!(0);
            r["draft_m"] = json!(0.1);
            let keys = r.as_object_mut().unwrap();
            keys.remove("hydrostatic_stiffness_pa_m");
            keys.remove("added_mass_kg_m");
        },
        &["draft_m: found 0.1", "nothing: the module is dry"],
    );
    ramp(&|r| r["draft_m"] = json!(0.1), &["draft_m: found 0.1", "slopes"]);
    ramp(
        &|r| r["freeboard_m"] = json!(0.9),
        &["freeboard_m: found 0.9", "slopes"],
    );
    ramp(
        &|r| r["module"]["deck_right_m"] = json!(0.4),
        &["module.deck_right_m: found 0.4, allowed: a number above 0.4, the bottom there"],
    );
    ramp(
        &|r| {
            r["module"]["bottom_right_m"] = json!(1.2);
            r["module"].as_object_mut().unwrap().remove("deck_right_m");
        },
        &["module.bottom_right_m: found 1.2, allowed: a number below 1.07, the deck there"],
    );
    ramp(
        &|r| r["module"]["bottom_right_m"] = json!(-6),
        &["module.bottom_right_m: found -6, allowed: a number from -5 to 5"],
    );
    ramp(
        &|r| r["module"]["deck_right_m"] = json!(7),
        &["module.deck_right_m: found 7, allowed: a number from -3.93 to 6.07"],
    );
    // dry, and no support at its end
    let mut stage = with_slope();
    stage.bridge["supports"] = json!({ "left": ["x", "y", "z"], "right": ["y"] });
    stage.bridge["module_kinds"]["ramp"]["wet_to_m"] = json!(0);
    let keys = stage.bridge["module_kinds"]["ramp"].as_object_mut().unwrap();
    keys.remove("hydrostatic_stiffness_pa_m");
    keys.remove("added_mass_kg_m");
    // crossings start from the state under its weight, and static cases do
    for statics in [false, true] {
        if statics {
            stage.study["analysis"] = json!({ "kind": "static" });
            stage.study["record"] = json!({});
            stage.study["design"] = json!([{ "cases": [{ "connection": "linear", "load_n": 3e5, "load_x_m": 7.0 }] }]);
        }
        refused(
            stage.write(),
            &[
                "modules: found module 3, which is dry, free at position 4",
                "held in z at both ends",
            ],
        );
    }
    stage.bridge["banks"] = json!([{ "at": "right", "direction": "z", "stiffness_n_m": 1e8 }]);
    stage.ran("rests");
    stage.bridge["banks"] = json!([{ "at": "right", "direction": "z", "stiffness_n_m": 1e8, "one_sided": false }]);
    stage.ran("held");
    // a deck as high as the others', but on a bottom that is not: connectors would act on the hinge
    let mut stage = with_slope();
    stage.bridge["hinges"]["y_m"][0] = json!(-2.02);
    stage.bridge["module_kinds"]["ramp"]["module"]["depth_m"] = json!(1.0);
    refused(
        stage.write(),
        &["connectors.y_m[0]: found -2.02", "the depths at joint 3"],
    );
    // beside a list
    let mut stage = with_slope();
    stage.bridge["wet_from_m"] = json!(1.0);
    refused(
        stage.write(),
        &[
            "bridge.json: wet_from_m: found a value",
            "nothing beside a list of modules",
        ],
    );
}

/// The refusal of a bridge after a change.
fn refuses(change: impl FnOnce(&mut Value), parts: &[&str]) {
    let mut stage = with_ramp();
    change(&mut stage.bridge);
    refused(stage.write(), &[&["bridge.json: "], parts].concat());
}

#[test]
fn rows_that_no_bridge_can_have_are_refused_at_the_key() {
    refuses(
        |b| b["modules"] = json!([{ "kind": "interior" }]),
        &[
            "module_kinds.ramp: found a kind of no module",
            "a kind that modules names",
        ],
    );
    refuses(
        |b| b["modules"][1]["kind"] = json!("rampe"),
        &["modules[1].kind: found rampe, allowed: a kind of module_kinds: interior, ramp"],
    );
    refuses(
        |b| b["modules"][0]["count"] = json!(0),
        &["modules[0].count: found 0, allowed: a whole number from 1 to 500"],
    );
    refuses(
        |b| b["modules"] = json!([{ "kind": "interior", "count": 499 }, { "kind": "ramp", "count": 2 }]),
        &["modules: found 501, allowed: at most 500 modules"],
    );
    refuses(|b| b["modules"] = json!([]), &["modules: found an empty list"]);
    refuses(
        |b| b["module_kinds"]["ramp"]["module"]["breadth_m"] = json!(9.0),
        &[
            "module_kinds.ramp.module.breadth_m: found 9",
            "8.082, the breadth of interior",
        ],
    );
    refuses(
        |b| b["module_kinds"]["ramp"]["module"]["mesh"]["elements_between_lines"] = json!(2),
        &["module_kinds.ramp.module.mesh.elements_between_lines: found 2"],
    );
    refuses(
        |b| {
            b["hinges"]["y_m"][0] = json!(-2.02);
            b["module_kinds"]["ramp"]["module"]["depth_m"] = json!(1.0);
            b["module_kinds"]["ramp"]["freeboard_m"] = json!(0.903);
        },
        &["connectors.y_m[0]: found -2.02, allowed: a place without a hinge: the depths at joint 3"],
    );
    refuses(
        |b| b["hinges"]["y_m"] = json!([-5.0, 0.0]),
        &["hinges.y_m[0]: found -5"],
    );
    refuses(
        |b| b["module_kinds"]["ramp"]["module"]["length_m"] = json!(-1),
        &["module_kinds.ramp.module.length_m: found -1"],
    );
    refuses(
        |b| b["module_kinds"]["ramp"]["freeboard_m"] = json!(0.5),
        &["module_kinds.ramp.freeboard_m: found 0.5"],
    );
    refuses(
        |b| {
            drop(
                b["module_kinds"]["ramp"]
                    .as_object_mut()
                    .unwrap()
                    .remove("added_mass_kg_m"),
            )
        },
        &["module_kinds.ramp.added_mass_kg_m: found neither"],
    );
    refuses(
        |b| {
            let kind = b["module_kinds"]["ramp"].clone();
            b["module_kinds"]["2nd"] = kind;
            b["modules"][0]["kind"] = json!("2nd");
        },
        &["found 2nd, allowed: a name of letters, digits, - and _ that begins with a letter"],
    );
}

#[test]
fn two_forms_at_once_are_refused_at_the_key() {
    for key in KEYS_OF_A_KIND {
        refuses(
            |b| b[key] = b["module_kinds"]["ramp"][key].clone(),
            &[key, "allowed: nothing beside a list of modules, whose kinds have it"],
        );
    }
    let mut stage = Stage::new();
    let kinds = as_kind(&stage.bridge, json!([]))["module_kinds"].clone();
    stage.bridge["module_kinds"] = kinds;
    refused(
        stage.write(),
        &[
            "bridge.json: module_kinds: found kinds",
            "nothing beside a number of modules",
        ],
    );
    refuses(
        |b| drop(b.as_object_mut().unwrap().remove("module_kinds")),
        &["module_kinds: missing key"],
    );
    // an axis into the form that the bridge does not have
    let mut stage = with_ramp();
    stage.study["design"][0]["grid"]["bridge.draft_m"] = json!([0.1]);
    refused(stage.write(), &["study.json: design[0].grid.bridge.draft_m"]);
}
