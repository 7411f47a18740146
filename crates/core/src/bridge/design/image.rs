//! Whether a bridge is its own mirror image across the centre line.
//!
//! Knows the places across that a bridge file has. Does not know meshes.

use super::BridgeDesign;

/// Whether every place across that a bridge file has stands there with its mirror image, to the last bit; never of a bridge with
/// springs on banks, which have places of their own.
pub(crate) fn is_own_image(design: &BridgeDesign) -> bool {
    let joints = (2..=design.modules).map(|joint| &design.joints.hinges_of(joint, &design.hinges).y_m);
    let hinges = std::iter::once(&design.hinges.y_m).chain(joints);
    let boxes = design.boxes();
    let walls = boxes
        .iter()
        .flat_map(|module| [&module.longitudinal_walls.y_m, &module.lines_y_m]);
    let mut places = hinges.chain(walls).chain([&design.connectors.y_m]);
    design.banks.is_empty() && places.all(|y_m| y_m.iter().all(|y| y_m.contains(&-y)))
}
