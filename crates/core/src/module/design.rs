//! A pontoon module as a bridge file writes it: box, walls, stiffeners, material, mesh.
//!
//! Knows which numbers describe the box and refuses those that cannot. Does not know water, hinges or connectors.

use super::Outline;
use crate::input::{InvalidInput, SAME_PLACE_M, apart, bound, not_negative, positive, within};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A closed box of plates with walls and stiffeners; x along the bridge from 0 to `length_m`, y across from the centre
/// line, z up from the bottom plate of the left end. Deck and bottom are plane between the ends.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ModuleDesign {
    /// Length along the bridge `[m]`.
    pub length_m: f64,
    /// Breadth across the bridge `[m]`.
    pub breadth_m: f64,
    /// Depth from bottom plate to deck plate `[m]`, at the left end.
    pub depth_m: f64,
    /// Height of the deck at the right end above the bottom of the left end `[m]`; absent: `depth_m`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub deck_right_m: Option<f64>,
    /// Height of the bottom at the right end above that of the left end `[m]`; absent: 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bottom_right_m: Option<f64>,
    /// Thickness of the deck plate `[m]`.
    pub deck_thickness_m: f64,
    /// Thickness of the bottom plate `[m]`.
    pub bottom_thickness_m: f64,
    /// Thickness of the two side plates `[m]`.
    pub side_thickness_m: f64,
    /// Thickness of the two end plates `[m]`.
    pub end_thickness_m: f64,
    /// Longitudinal walls inside the box.
    #[serde(default)]
    pub longitudinal_walls: LongitudinalWalls,
    /// Transverse walls inside the box.
    #[serde(default)]
    pub transverse_walls: TransverseWalls,
    /// Beams on the plates.
    #[serde(default)]
    pub stiffeners: Stiffeners,
    /// Lines across of the mesh beside those of walls, stiffeners, hinges and connectors `[m]`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub lines_y_m: Vec<f64>,
    /// Material of plates and beams.
    pub material: Material,
    /// How finely the box is meshed.
    pub mesh: MeshDesign,
}

/// Vertical walls along the bridge.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LongitudinalWalls {
    /// Thickness `[m]`.
    pub thickness_m: f64,
    /// Places across `[m]`.
    pub y_m: Vec<f64>,
}

/// Vertical walls across the bridge.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TransverseWalls {
    /// Thickness `[m]`.
    pub thickness_m: f64,
    /// Places along `[m]`.
    pub x_m: Vec<f64>,
}

/// Beams on deck and bottom along given lines, and as posts on sides and end walls at the same lines.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Stiffeners {
    /// Cross-section area `[m^2]`.
    pub area_m2: f64,
    /// Second moment of area about both axes `[m^4]`.
    pub second_moment_m4: f64,
    /// Torsion constant `[m^4]`.
    pub torsion_constant_m4: f64,
    /// Shear area, both directions `[m^2]`; absent: no shear deformation.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shear_area_m2: Option<f64>,
    /// Places of the transverse beams along the module `[m]`.
    pub transverse_x_m: Vec<f64>,
    /// Places of the longitudinal beams across the module `[m]`.
    pub longitudinal_y_m: Vec<f64>,
}

/// Linear elastic isotropic material.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// Young's modulus `[Pa]`.
    pub youngs_modulus_pa: f64,
    /// Poisson's ratio.
    pub poissons_ratio: f64,
    /// Density `[kg/m^3]`, fittings included.
    pub density_kg_m3: f64,
}

/// Mesh of the box. Every line that carries a wall, a stiffener, a hinge or a connector is a mesh line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MeshDesign {
    /// Least number of elements along the module; no element is longer than the length over this number.
    pub elements_along: usize,
    /// Elements between two neighbouring lines across.
    #[serde(default = "one")]
    pub elements_between_lines: usize,
    /// Elements over the depth.
    pub elements_over_depth: usize,
}

fn one() -> usize {
    1
}

impl ModuleDesign {
    /// Refuses numbers that describe no box.
    ///
    /// # Errors
    /// [`InvalidInput`] with the key's path.
    pub fn check(&self) -> Result<(), InvalidInput> {
        for (key, side_m) in [
            ("length_m", self.length_m),
            ("breadth_m", self.breadth_m),
            ("depth_m", self.depth_m),
        ] {
            // of a shorter side both ends, or the centre line and an end, would be one place
            if positive(key, side_m)? <= 4.0 * SAME_PLACE_M {
                return Err(InvalidInput::new(
                    key,
                    side_m,
                    format!("a number above {}", 4.0 * SAME_PLACE_M),
                ));
            }
        }
        self.check_right_end()?;
        positive("deck_thickness_m", self.deck_thickness_m)?;
        positive("bottom_thickness_m", self.bottom_thickness_m)?;
        positive("side_thickness_m", self.side_thickness_m)?;
        positive("end_thickness_m", self.end_thickness_m)?;
        let half = 0.5 * self.breadth_m;
        lines(
            "longitudinal_walls",
            "y_m",
            &self.longitudinal_walls.y_m,
            -half,
            half,
            Some(self.longitudinal_walls.thickness_m),
        )?;
        lines(
            "transverse_walls",
            "x_m",
            &self.transverse_walls.x_m,
            0.0,
            self.length_m,
            Some(self.transverse_walls.thickness_m),
        )?;
        self.stiffeners.check(self.length_m, half)?;
        lines("", "lines_y_m", &self.lines_y_m, -half, half, None)?;
        self.material.check().map_err(|e| e.under("material"))?;
        self.mesh.check().map_err(|e| e.under("mesh"))
    }

    /// Refuses a right end whose deck is not above its bottom, or a slope above one in one.
    fn check_right_end(&self) -> Result<(), InvalidInput> {
        let Outline { bottom_m, deck_m, .. } = self.outline();
        within("bottom_right_m", bottom_m[1], -self.length_m, self.length_m)?;
        let least = bottom_m[1] + 4.0 * SAME_PLACE_M;
        let (key, right_m) = ("deck_right_m", deck_m[1]);
        match self.deck_right_m {
            Some(_) if right_m > least => within(key, right_m, deck_m[0] - self.length_m, deck_m[0] + self.length_m)?,
            None if right_m > least => right_m,
            Some(_) => {
                let allowed = format!("a number above {}, the bottom there", bound(bottom_m[1]));
                return Err(InvalidInput::new(key, right_m, allowed));
            }
            None => {
                let allowed = format!("a number below {}, the deck there", bound(right_m));
                return Err(InvalidInput::new("bottom_right_m", bottom_m[1], allowed));
            }
        };
        Ok(())
    }

    /// The heights of its deck and its bottom.
    pub fn outline(&self) -> Outline {
        Outline {
            length_m: self.length_m,
            bottom_m: [0.0, self.bottom_right_m.unwrap_or(0.0)],
            deck_m: [self.depth_m, self.deck_right_m.unwrap_or(self.depth_m)],
        }
    }

    /// Lines across of its walls, its stiffeners and its mesh `[m]`; the mesh has more at the edges and the centre.
    pub(crate) fn lines_across_m(&self) -> impl Iterator<Item = f64> {
        let stiffened = self.stiffeners.longitudinal_y_m.iter();
        self.longitudinal_walls
            .y_m
            .iter()
            .chain(stiffened)
            .chain(&self.lines_y_m)
            .copied()
    }

    /// Its mirror image along x, ends exchanged; none where that is the box itself.
    pub(crate) fn mirrored(&self) -> Option<Self> {
        let image = |places: &[f64]| places.iter().rev().map(|x_m| self.length_m - x_m).collect::<Vec<_>>();
        let is_own_image = |places: &[f64]| {
            let own = |x_m: &f64| places.iter().any(|place| (place - x_m).abs() <= SAME_PLACE_M);
            image(places).iter().all(own)
        };
        let (walls, beams) = (&self.transverse_walls.x_m, &self.stiffeners.transverse_x_m);
        let outline = self.outline();
        if is_own_image(walls) && is_own_image(beams) && outline.is_level() {
            return None;
        }
        let mut mirrored = self.clone();
        if !outline.is_level() {
            let Outline { bottom_m, deck_m, .. } = outline.mirrored();
            mirrored.depth_m = deck_m[0];
            mirrored.deck_right_m = Some(deck_m[1]);
            mirrored.bottom_right_m = Some(bottom_m[1]);
        }
        mirrored.transverse_walls.x_m = image(walls);
        mirrored.stiffeners.transverse_x_m = image(beams);
        Some(mirrored)
    }
}

fn lines(of: &str, key: &str, places: &[f64], from: f64, to: f64, thickness: Option<f64>) -> Result<(), InvalidInput> {
    let path = if of.is_empty() {
        key.to_owned()
    } else {
        format!("{of}.{key}")
    };
    for (i, &place) in places.iter().enumerate() {
        within(&format!("{path}[{i}]"), place, from - 1e-9, to + 1e-9)?;
    }
    apart(&path, places)?;
    match thickness {
        Some(t) if !places.is_empty() => positive(&format!("{of}.thickness_m"), t).map(|_| ()),
        _ => Ok(()),
    }
}

impl Stiffeners {
    fn check(&self, length_m: f64, half_breadth_m: f64) -> Result<(), InvalidInput> {
        lines(
            "stiffeners",
            "transverse_x_m",
            &self.transverse_x_m,
            0.0,
            length_m,
            None,
        )?;
        lines(
            "stiffeners",
            "longitudinal_y_m",
            &self.longitudinal_y_m,
            -half_breadth_m,
            half_breadth_m,
            None,
        )?;
        if self.transverse_x_m.is_empty() && self.longitudinal_y_m.is_empty() {
            return Ok(());
        }
        positive("stiffeners.area_m2", self.area_m2)?;
        positive("stiffeners.second_moment_m4", self.second_moment_m4)?;
        positive("stiffeners.torsion_constant_m4", self.torsion_constant_m4)?;
        if let Some(area) = self.shear_area_m2 {
            positive("stiffeners.shear_area_m2", area)?;
        }
        Ok(())
    }
}

impl Material {
    fn check(&self) -> Result<(), InvalidInput> {
        positive("youngs_modulus_pa", self.youngs_modulus_pa)?;
        not_negative("poissons_ratio", self.poissons_ratio)?;
        within("poissons_ratio", self.poissons_ratio, 0.0, 0.499)?;
        positive("density_kg_m3", self.density_kg_m3)?;
        Ok(())
    }
}

impl MeshDesign {
    fn check(&self) -> Result<(), InvalidInput> {
        for (key, n) in [
            ("elements_along", self.elements_along),
            ("elements_between_lines", self.elements_between_lines),
            ("elements_over_depth", self.elements_over_depth),
        ] {
            if !(1..=200).contains(&n) {
                return Err(InvalidInput::new(key, n, "a whole number from 1 to 200"));
            }
        }
        Ok(())
    }
}
