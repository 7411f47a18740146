//! Tables and formulas from which a bridge file may take the numbers of its water.
//!
//! Knows what a table of buoyancies and Todd's formula come to. Does not know the module that floats.

use crate::input::{InvalidInput, not_negative, positive, within};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Buoyancy of one module against draft.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DraftBuoyancy {
    /// Drafts, increasing `[m]`.
    pub draft_m: Vec<f64>,
    /// Buoyancy of a module at each draft `[N]`.
    pub buoyancy_n: Vec<f64>,
    /// The draft at which the unloaded module floats `[m]`.
    pub still_water_draft_m: f64,
}

/// Todd's formula, `m_a = 1/2 pi rho_w C J (B/2)^2` per metre.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Todd {
    /// Density of the water rho_w `[kg/m^3]`.
    pub water_density_kg_m3: f64,
    /// Section coefficient C.
    pub section_coefficient: f64,
    /// Three-dimensional correction J.
    pub three_dimensional_correction: f64,
}

impl DraftBuoyancy {
    pub(super) fn check(&self) -> Result<(), InvalidInput> {
        if self.draft_m.len() < 2 {
            return Err(InvalidInput::new(
                "draft_m",
                format!("{} entries", self.draft_m.len()),
                "at least two drafts",
            ));
        }
        if self.buoyancy_n.len() != self.draft_m.len() {
            return Err(InvalidInput::new(
                "buoyancy_n",
                format!("{} entries", self.buoyancy_n.len()),
                format!("{} entries, one a draft", self.draft_m.len()),
            ));
        }
        for (key, list) in [("draft_m", &self.draft_m), ("buoyancy_n", &self.buoyancy_n)] {
            for (i, w) in list.windows(2).enumerate() {
                not_negative(&format!("{key}[{i}]"), w[0])?;
                if !(w[1].is_finite() && w[1] > w[0]) {
                    return Err(InvalidInput::new(
                        format!("{key}[{}]", i + 1),
                        w[1],
                        format!("above {}", w[0]),
                    ));
                }
            }
        }
        let last = self.draft_m[self.draft_m.len() - 1];
        within("still_water_draft_m", self.still_water_draft_m, self.draft_m[0], last).map(|_| ())
    }

    /// Slope of the table at the still-water draft `[N/m]`: of the segment that holds it, of the two neighbours' mean
    /// on a table point.
    pub(crate) fn slope_n_m(&self) -> f64 {
        let slope = |i: usize| (self.buoyancy_n[i + 1] - self.buoyancy_n[i]) / (self.draft_m[i + 1] - self.draft_m[i]);
        let at = self.still_water_draft_m;
        let segments: Vec<f64> = (0..self.draft_m.len() - 1)
            .filter(|&i| self.draft_m[i] <= at && at <= self.draft_m[i + 1])
            .map(slope)
            .collect();
        segments.iter().sum::<f64>() / segments.len() as f64
    }
}

impl Todd {
    pub(super) fn check(&self) -> Result<(), InvalidInput> {
        positive("water_density_kg_m3", self.water_density_kg_m3)?;
        positive("section_coefficient", self.section_coefficient)?;
        positive("three_dimensional_correction", self.three_dimensional_correction)?;
        Ok(())
    }

    /// `m_a = 1/2 pi rho_w C J (B/2)^2` `[kg/m]`.
    /// Equation (W1).
    pub fn added_mass_kg_m(&self, breadth_m: f64) -> f64 {
        0.5 * std::f64::consts::PI
            * self.water_density_kg_m3
            * self.section_coefficient
            * self.three_dimensional_correction
            * (0.5 * breadth_m).powi(2)
    }
}
