//! Whether a bridge is its own mirror image across the centre line.
//!
//! Knows the places across that a bridge file has. Does not know meshes.

use super::BridgeDesign;

impl BridgeDesign {
    /// Whether every place across that the file has stands there with its mirror image, to the last bit; never of a bridge with
    /// springs on banks, which have places of their own.
    pub(crate) fn is_own_image(&self) -> bool {
        let joints = (2..=self.modules).map(|joint| &self.joints.hinges_of(joint, &self.hinges).y_m);
        let hinges = std::iter::once(&self.hinges.y_m).chain(joints);
        let boxes = self.boxes();
        let walls = boxes
            .iter()
            .flat_map(|module| [&module.longitudinal_walls.y_m, &module.lines_y_m]);
        let mut places = hinges.chain(walls).chain([&self.connectors.y_m]);
        self.banks.is_empty() && places.all(|y_m| y_m.iter().all(|y| y_m.contains(&-y)))
    }
}
