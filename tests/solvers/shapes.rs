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

/// Pitch, roll and heave of a single module on the water, beside which it is stiff: its plates give way by 2e-6 of the motion,
/// 1e-4 is allowed. In pitch the deck runs ahead of the bottom by the slope times the depth, in roll
/// beside it. Twins: a depth 5 % off; a twentieth of the roll in the heave and of the heave in the roll.
#[test]
fn a_single_module_moves_as_a_body() {
    let single = with(&design("smoke"), |d| d.modules = 1);
    let all = found(&single, Model::SuperElement);
    let module = &single.module;
    let pitch = motion(&all, "pitch");
    assert_eq!(pitch.len(), CORNERS);
    let slope = (pitch[1][2] - pitch[0][2]) / module.length_m;
    // a body that turns by -slope about y moves along x by -slope z
    let ahead = pitch[4][0] - pitch[0][0];
    held(
        "deck over bottom in pitch",
        1e-4,
        miss(ahead, -slope * module.depth_m),
        miss(ahead, -slope * 1.05 * module.depth_m),
    );
    let (heave, roll) = (motion(&all, "heave"), motion(&all, "roll"));
    let turn = (roll[3][2] - roll[0][2]) / module.breadth_m;
    assert!(turn.abs() > 0.2, "{turn}");
    // a body that turns by `turn` about x moves across by -turn z
    let beside = roll[4][1] - roll[0][1];
    held(
        "deck beside bottom in roll",
        1e-4,
        miss(beside, -turn * module.depth_m),
        miss(beside, -turn * 1.05 * module.depth_m),
    );
    // how far a share of a roll in it takes the corners from going up by 1
    let off_heave = |share: f64| {
        let corners = heave.iter().zip(roll);
        corners.fold(0.0_f64, |most, (up, turned)| {
            let moved = [0, 1, 2].map(|way| up[way] + share * turned[way]);
            let off = [moved[0], moved[1], moved[2] - 1.0];
            off.iter().fold(most, |most, x| most.max(x.abs()))
        })
    };
    held("heave", 1e-4, off_heave(0.0), off_heave(0.05));
    // how far a share of a heave in it takes opposite corners from going up and down alike
    let off_roll = |share: f64| {
        let pairs = [[0, 3], [1, 2], [4, 7], [5, 6]];
        let up = |corner: usize| roll[corner][2] + share * heave[corner][2];
        pairs
            .iter()
            .fold(0.0_f64, |most, [a, b]| most.max((up(*a) + up(*b)).abs()))
    };
    held("heave in roll", 1e-4, off_roll(0.0), off_roll(0.05));
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

/// The condensed module's corners are those of the full one: 2e-4 of the largest motion. The fixed-master modes beyond the 16th
/// that are left out are worth 2e-5 of it in bending and 1.2e-4 in torsion; the 16 that are kept 7e-5 and 4e-4. Twin: a deck
/// 5 % thicker.
#[test]
fn condensed_corners_are_those_of_the_full_module() {
    let thicker = with(&design("smoke"), |d| d.module.deck_thickness_m *= 1.05);
    let full = found(&design("smoke"), Model::Full);
    let [condensed, wrong] = [design("smoke"), thicker].map(|design| found(&design, Model::SuperElement));
    for name in ["vertical bending 1", "torsion 1"] {
        let expected = motion(&full, name);
        let off = |found: &[Shape]| {
            let found = motion(found, name);
            let sign = if found[0][2] * expected[0][2] < 0.0 { -1.0 } else { 1.0 };
            let each = found.iter().flatten().zip(expected.iter().flatten());
            each.fold(0.0_f64, |most, (a, b)| most.max((a - sign * b).abs()))
        };
        held(name, 2e-4, off(&condensed), off(&wrong));
    }
}

/// Fewer modes are the first of more, whatever number is asked for: names are equal and frequencies too, to a millionth of a
/// hertz. One or two of the three motions that nothing restores would else be mixtures of them. Twin: a frequency 5 % off.
#[test]
fn fewer_modes_are_the_first_of_more() {
    for modules in [1, 3] {
        let ready = Ready::new(&with(&design("smoke"), |d| d.modules = modules), Model::SuperElement);
        let more = ready.modes(14);
        for count in 1..=13 {
            let fewer = ready.modes(count);
            assert_eq!(fewer.len(), count);
            let apart = |factor: f64| {
                let pairs = fewer.iter().zip(&more);
                let apart = pairs.map(|(a, b)| (factor * a.frequency_hz - b.frequency_hz).abs());
                apart.fold(0.0, f64::max)
            };
            for (a, b) in fewer.iter().zip(&more) {
                assert_eq!(a.name, b.name, "{count} modes of {modules} modules");
            }
            assert!(apart(1.0) < 1e-6, "{count} modes of {modules} modules");
            assert!(count < 4 || apart(1.05) > 1e-6, "a wrong frequency passes");
        }
    }
}
