//! Numbers of a bridge that contradict each other, and the bridges that come with the program.

use super::refusals::{bridge, study};
use crate::stage::{Stage, stderr};
use pontoon_plan::study_file::read_bridge;
use serde_json::json;
use std::path::Path;

#[test]
fn a_draft_and_a_freeboard_are_those_of_the_module() {
    bridge(
        "",
        "draft_m",
        json!(5),
        &["draft_m: found 5, allowed: at most 1.07, the depth of the module"],
    );
    bridge(
        "",
        "freeboard_m",
        json!(5),
        &["freeboard_m: found 5, allowed: at most 1.07, the depth of the module"],
    );
    bridge(
        "",
        "freeboard_m",
        json!(0.9),
        &["freeboard_m: found 0.9, allowed: about 0.973, what the depth of 1.07 leaves above the draft of 0.097"],
    );
    // an axis that makes the other one wrong
    study(
        "/design/0/grid",
        "bridge.draft_m",
        json!([0.097, 0.15]),
        &["design[0].grid (bridge.freeboard_m): found 0.973, allowed: about 0.92, what the depth"],
    );
    // rounded to centimetres they are the depth
    let mut stage = Stage::new();
    (stage.bridge["draft_m"], stage.bridge["freeboard_m"]) = (json!(0.1), json!(0.96));
    let output = stage.write().pontoon(&["plan", "study.json"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
}

#[test]
fn a_draft_is_that_of_the_mass_and_of_the_table() {
    for (draft, refused) in [(0.04, true), (0.06, false), (0.18, false), (0.3, true)] {
        let mut stage = Stage::new();
        (stage.bridge["draft_m"], stage.bridge["freeboard_m"]) = (json!(draft), json!(1.07 - draft));
        let output = stage.write().pontoon(&["plan", "study.json"]);
        let told = stderr(&output);
        assert_eq!(
            output.status.code(),
            Some(if refused { 2 } else { 0 }),
            "{draft}: {told}"
        );
        let message =
            format!("draft_m: found {draft}, allowed: about 0.097, which the mass of the module gives (5265 kg)");
        assert_eq!(told.contains(&message), refused, "{told}");
    }
    let mut stage = Stage::new();
    stage
        .bridge
        .as_object_mut()
        .unwrap()
        .remove("hydrostatic_stiffness_pa_m");
    stage.bridge["draft_buoyancy"] =
        json!({ "draft_m": [0, 0.3], "buoyancy_n": [0, 1.2e5], "still_water_draft_m": 0.15 });
    super::refusals::refused(
        stage.write(),
        &["draft_m: found 0.097, allowed: about 0.15, the draft of draft_buoyancy.still_water_draft_m"],
    );
}

/// Draft of a box with the model's mass in fresh water, `m / (rho l b)`, to the millimetre, and what the depth leaves above it.
#[test]
fn the_bridges_that_come_with_the_program_state_their_water_line() {
    let studies = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies");
    for file in ["bridges/fu2005.json", "bridges/smoke.json", "identification/start.json"] {
        let design = read_bridge(&studies.join(file)).unwrap().design;
        let module = &design.module;
        let draft = design.structural_mass_kg() / (1000.0 * module.length_m * module.breadth_m);
        let (stated, freeboard) = (design.draft_m.unwrap(), design.freeboard_m.unwrap());
        assert!(
            (draft - stated).abs() < 1e-3,
            "{file}: {draft} of its mass, {stated} stated"
        );
        assert!((stated + freeboard - module.depth_m).abs() < 1e-12, "{file}");
    }
}
