//! A module at its place of the bridge.
//!
//! Knows its measures and masses per metre. Does not know dofs.

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
