//! Motion of the modules' corners in mode shapes, against rigid bodies and against the joints.

#![allow(clippy::expect_used)]

use pontoon_core::analysis::modes::{CORNERS, Shape, shapes};
use pontoon_core::bridge::{Bridge, BridgeDesign, Ends, Model, PreparedModule};
use pontoon_tests::*;

/// Corners of the right end of a module and those of the left end of the next, place by place.
const RIGHT_END: [usize; 4] = [1, 2, 5, 6];
const LEFT_END: [usize; 4] = [0, 3, 4, 7];

fn found(design: &BridgeDesign, model: Model) -> Vec<Shape> {
    let module = PreparedModule::new(design, model).expect("a module");
    let bridge = Bridge::new(design, &module, Ends::Free).expect("a bridge");
    shapes(&bridge, 9).expect("shapes")
}

fn motion<'a>(shapes: &'a [Shape], name: &str) -> &'a [[f64; 3]] {
    let found = shapes.iter().find(|(mode, _)| mode.name == name);
    &found.unwrap_or_else(|| panic!("no {name}")).1
}

/// A module that pitches turns as a body: its deck runs ahead of its bottom by the slope times the depth. 3 %: plates of 2 mm
/// give way by 2 % between the corners. Twin: a depth 5 % off.
#[test]
fn a_pitching_module_turns_as_a_body() {
    let single = with(&design("smoke"), |d| d.modules = 1);
    let all = found(&single, Model::SuperElement);
    let corners = motion(&all, "pitch");
    assert_eq!(corners.len(), CORNERS);
    let slope = (corners[1][2] - corners[0][2]) / single.module.length_m;
    // a body that turns by -slope about y moves along x by -slope z
    let ahead = corners[4][0] - corners[0][0];
    let expected = |depth_m: f64| -slope * depth_m;
    held(
        "deck over bottom in pitch",
        0.03,
        miss(ahead, expected(single.module.depth_m)),
        miss(ahead, expected(1.05 * single.module.depth_m)),
    );
    let heave = motion(&all, "heave");
    assert!(
        heave
            .iter()
            .all(|corner| corner[2] > 0.9 && corner[0].abs() < 0.05 && corner[1].abs() < 0.05),
        "{heave:?}"
    );
    let roll = motion(&all, "roll");
    assert!(
        roll[0][2] * roll[3][2] < 0.0 && (roll[0][2] + roll[3][2]).abs() < 1e-6,
        "{roll:?}"
    );
}

/// Hinges tie neighbours at the bottom, so that in vertical bending neighbouring corners at the bottom move up together,
/// and those at the deck come apart by what the connectors stretch; 2 %: the corners lie 3 m beside the hinges. The largest
/// component of a shape is 1.
#[test]
fn neighbours_move_together_at_the_bottom() {
    let all = found(&design("smoke"), Model::SuperElement);
    let corners = motion(&all, "vertical bending 1");
    assert_eq!(corners.len(), 3 * CORNERS);
    let largest = corners.iter().flatten().fold(0.0_f64, |most, x| most.max(x.abs()));
    assert!((largest - 1.0).abs() < 1e-12, "{largest}");
    for (right, left) in RIGHT_END.into_iter().zip(LEFT_END).take(2) {
        let (a, b) = (corners[right][2], corners[CORNERS + left][2]);
        assert!((a - b).abs() < 0.02, "{a} and {b}");
    }
    // the ends of a free beam go up while its middle goes down
    assert!(corners[0][2] * corners[CORNERS][2] < 0.0);
}

/// The condensed module's corners are those of the full one: 1 % of the largest motion, as the frequencies are within 0.03 %
/// and shapes are off by the root of that.
#[test]
fn condensed_corners_are_those_of_the_full_module() {
    let [condensed, full] = [Model::SuperElement, Model::Full].map(|model| found(&design("smoke"), model));
    for name in ["vertical bending 1", "torsion 1"] {
        let (a, b) = (motion(&condensed, name), motion(&full, name));
        let sign = if a[0][2] * b[0][2] < 0.0 { -1.0 } else { 1.0 };
        let off = a
            .iter()
            .flatten()
            .zip(b.iter().flatten())
            .map(|(a, b)| (a - sign * b).abs());
        let worst = off.fold(0.0, f64::max);
        assert!(worst < 0.01, "{name}: {worst}");
    }
}
