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

/// Hinges at the corners tie neighbours there: what the one's corner does the other's does, to rounding (1e-9 of the largest
/// motion). At the deck they come apart along the bridge, where a bridge bends. Twin: hinges 5 % of the breadth further in,
/// from which the corners are left behind by what plates of 2 mm give.
#[test]
fn corners_move_with_the_hinges_that_are_there() {
    let apart = |share: f64| {
        let half = 0.5 * share * design("smoke").module.breadth_m;
        let hinged = with(&design("smoke"), |d| d.hinges.y_m = vec![-half, half]);
        let all = found(&hinged, Model::SuperElement);
        let corners = motion(&all, "vertical bending 1").to_vec();
        assert_eq!(corners.len(), 3 * CORNERS);
        let largest = corners.iter().flatten().fold(0.0_f64, |most, x| most.max(x.abs()));
        assert!((largest - 1.0).abs() < 1e-12, "{largest}");
        // the ends of a free beam go up while its middle goes down
        assert!(corners[0][2] * corners[CORNERS][2] < 0.0);
        let between =
            |right: usize, left: usize, way: usize| (corners[right][way] - corners[CORNERS + left][way]).abs();
        let deck = between(RIGHT_END[2], LEFT_END[2], 0);
        assert!(deck > 1e-4, "{deck}");
        let bottom = RIGHT_END.into_iter().zip(LEFT_END).take(2);
        bottom.fold(0.0_f64, |most, (right, left)| {
            (0..3).map(|way| between(right, left, way)).fold(most, f64::max)
        })
    };
    held("corners at hinges", 1e-9, apart(1.0), apart(0.95));
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
