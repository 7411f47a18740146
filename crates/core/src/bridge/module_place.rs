//! A module at its place of the bridge.
//!
//! Knows its measures and masses per metre. Does not know dofs.

use super::BridgeDesign;
use super::modules::Modules;
use crate::radiation::{FREEDOMS_PER_MODULE, FreedomMatrix};

/// A module at its place of the bridge.
#[derive(Debug, Clone)]
pub(crate) struct ModulePlace {
    /// Place of its left end `[m]`.
    pub left_m: f64,
    /// Length, and depth at the left and the right end `[m]`.
    pub length_m: f64,
    pub depths_m: [f64; 2],
    /// Lines along, from its left end `[m]`.
    pub lines_x: Vec<f64>,
    /// Mass of the structure, the water's added mass in the wet part and inertia of roll with it, per metre.
    pub structural_mass_kg_m: f64,
    pub added_mass_kg_m: f64,
    /// Where its wet part begins and ends `[m]`, where some of it is dry.
    pub wet_m: Option<[f64; 2]>,
    pub roll_inertia_kg_m: f64,
    /// Still-water draft and freeboard, where its kind has them `[m]`.
    pub draft_m: Option<f64>,
    pub freeboard_m: Option<f64>,
}

impl ModulePlace {
    /// Lists what stands at each place of a row.
    pub(super) fn all(design: &BridgeDesign, modules: &Modules<'_>) -> Vec<Self> {
        let radiation = design.water.as_ref().and_then(|water| water.radiation.as_ref());
        // added mass of water with memory, where all modules heave or roll alike
        let of_water = |j: usize| {
            let alike = |freedom: usize| {
                let sum = |x: &FreedomMatrix| -> f64 {
                    let row = x.row(FREEDOMS_PER_MODULE * j + freedom);
                    row.iter().skip(freedom).step_by(FREEDOMS_PER_MODULE).sum()
                };
                radiation.map_or(0.0, |radiation| sum(radiation.infinite()))
            };
            [alike(0), alike(2)]
        };
        let of_module = |j: usize| {
            let (module, of_kind) = (modules.module(j), modules.design(j));
            let length_m = of_kind.module.length_m;
            let [heaving_kg, rolling_kg_m2] = of_water(j);
            Self {
                left_m: modules.left_m(j),
                length_m,
                depths_m: of_kind.module.outline().depths_m(),
                lines_x: module.grid.x.clone(),
                structural_mass_kg_m: module.structural_mass_kg() / length_m,
                added_mass_kg_m: of_kind.m_a() + heaving_kg / length_m,
                wet_m: of_kind.is_dry_in_part().then(|| of_kind.wet_m()),
                roll_inertia_kg_m: (module.roll_inertia_kg_m2() + rolling_kg_m2) / length_m,
                draft_m: of_kind.draft_m,
                freeboard_m: of_kind.freeboard_m,
            }
        };
        (0..modules.len()).map(of_module).collect()
    }

    /// Mass per metre before lines along, water included `[kg/m]`, and of how many lines side by side.
    pub(crate) fn afloat_kg_m(&self) -> Vec<(f64, usize)> {
        let wet_kg_m = self.structural_mass_kg_m + self.added_mass_kg_m;
        let Some([from_m, to_m]) = self.wet_m else {
            return vec![(wet_kg_m, self.lines_x.len())];
        };
        let mut spans = Vec::new();
        // what is before the first line has no length
        let mut before_m = self.lines_x[0];
        for &x_m in &self.lines_x {
            let middle_m = 0.5 * (before_m + x_m);
            let is_wet = middle_m > from_m && middle_m < to_m;
            spans.push((if is_wet { wet_kg_m } else { self.structural_mass_kg_m }, 1));
            before_m = x_m;
        }
        spans
    }
}
