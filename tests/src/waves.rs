//! Bridges in water with memory.
//!
//! Knows where the water files are. Does not know what is expected of a bridge in them.

use crate::with;
use pontoon_core::bridge::{BridgeDesign, WaterSpec};
use pontoon_core::radiation::Radiation;
use pontoon_plan::water_file::{JudgedWater, WaterFile};
use std::path::Path;
use std::sync::Arc;

/// A bridge in the water of a file, without its added mass.
///
/// # Panics
/// Where the file is no water of the bridge.
pub fn in_water_of(design: &BridgeDesign, file: &Path) -> BridgeDesign {
    let water = WaterFile::open(file).unwrap_or_else(|e| panic!("{e}"));
    in_water(design, &water)
}

/// A bridge in a water, without its added mass.
///
/// # Panics
/// Where it is no water of the bridge.
pub fn in_water(design: &BridgeDesign, water: &WaterFile) -> BridgeDesign {
    let made = JudgedWater::with_radiation(Path::new("water"), water, design, "water");
    let (_, radiation) = made.unwrap_or_else(|e| panic!("{e}"));
    in_radiation(design, radiation)
}

/// A bridge in what a water comes to, without its added mass.
pub fn in_radiation(design: &BridgeDesign, radiation: Radiation) -> BridgeDesign {
    with(design, |design| {
        (design.added_mass_kg_m, design.todd) = (None, None);
        design.water = Some(WaterSpec {
            radiation: Some(Arc::new(radiation)),
            ..WaterSpec::default()
        });
    })
}
