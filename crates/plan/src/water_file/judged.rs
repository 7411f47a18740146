//! A water held against what radiation has to be, and against the bridge that is to float in it.
//!
//! Knows the checks of the mechanics and the bridge's own water plane. Does not know what becomes of a water that is refused.

use super::{WaterFile, full};
use crate::input::{FoundValue, Refusal};
use pontoon_core::bridge::BridgeDesign;
use pontoon_core::input::InvalidInput;
use pontoon_core::radiation::{
    Band, Check, CheckName, Kernel, Limit, Outcome, Radiation, RadiationTable, Scales, Window, added_mass_infinite,
    total_heave,
};
use serde::Serialize;
use std::path::Path;

/// Times at which the memory is told, as a share of that at 0 `[s]`.
const TOLD_AT_S: [f64; 3] = [5.0, 10.0, 20.0];

/// Lengths of modules in two files that are equal `[m]`: what files round to.
const EQUAL_LENGTHS_M: f64 = 1e-3;

/// Water plane of the hull against the bridge's hydrostatic stiffness: beyond what is unusual, and what is another hull.
const WATER_PLANE: [f64; 2] = [0.05, 0.5];

/// Name of that check.
const WATER_PLANE_CHECK: &str = "water_plane";

/// A water held against checks, its kernel or why it has none, its table and its lengths.
type JudgedParts = (JudgedWater, Result<Kernel, InvalidInput>, RadiationTable, Scales);

/// What was found of a water.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct JudgedWater {
    /// The checks in their order.
    pub checks: Vec<JudgedCheck>,
    /// Added mass at infinite frequency that follows from damping and added mass, heave of the whole, per length `[kg/m]`.
    pub infinite_heave_kg_m: Option<f64>,
    /// Memory at 0 s, heave of the whole, per length `[N/m per m]`.
    pub memory_heave_n_m2: Option<f64>,
    /// Norm of the memory over that at 0 s, after 5, 10 and 20 s.
    pub memory_left: Vec<f64>,
}

/// A check of a water.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct JudgedCheck {
    /// Its name.
    pub check: &'static str,
    /// What was found; none where the water allows no figure.
    pub figure: Option<f64>,
    /// Beyond what it is unusual, in words.
    pub usual: Option<String>,
    /// Beyond what it is refused, in words.
    pub allowed: Option<String>,
    /// What comes of it: `holds`, `warns` or `refused`.
    pub outcome: &'static str,
}

impl JudgedWater {
    /// Holds a water against the checks of radiation, and against a bridge where one is given. `file` stands for the water in
    /// messages.
    ///
    /// # Errors
    /// [`Refusal`] of a water of other modules than the bridge's, and of one whose breadth is not known.
    pub fn of(file: &Path, water: &WaterFile, bridge: Option<&BridgeDesign>) -> Result<Self, Refusal> {
        Self::with_kernel(file, water, bridge).map(|(judged, ..)| judged)
    }

    /// Holds a water against a bridge, and makes of it what the bridge moves in; `key` tells it from other waters.
    ///
    /// # Errors
    /// As [`Self::of`], and of a water that allows no memory or no added mass at infinite frequency.
    pub fn with_radiation(
        file: &Path,
        water: &WaterFile,
        bridge: &BridgeDesign,
        key: &str,
    ) -> Result<(Self, Radiation), Refusal> {
        let (judged, kernel, table, scales) = Self::with_kernel(file, water, Some(bridge))?;
        let refused = |error| Refusal::of(file, "", error);
        let radiation = kernel.and_then(|kernel| Radiation::new(kernel, &table, scales, key.to_owned()));
        Ok((judged, radiation.map_err(refused)?))
    }

    fn with_kernel(file: &Path, water: &WaterFile, bridge: Option<&BridgeDesign>) -> Result<JudgedParts, Refusal> {
        if let Some(bridge) = bridge {
            fits(file, water, bridge)?;
        }
        let lengths_m: Vec<f64> = (0..water.modules).filter_map(|m| water.module_length_m.of(m)).collect();
        let breadth_m = water
            .waterline_breadth_m
            .or(bridge.map(|bridge| bridge.module.breadth_m));
        let breadth_m = breadth_m.ok_or_else(|| Refusal::missing(file, "waterline_breadth_m"))?;
        let refused = |error| Refusal::of(file, "", error);
        let scales = Scales::new(&lengths_m, breadth_m).map_err(refused)?;
        let table = table_of(water).map_err(refused)?;
        let band = Band {
            usable_to_rad_s: water.usable_to_rad_s,
            ..Band::default()
        };
        let made = Kernel::new(&table, &scales, band);
        let kernel = made.as_ref().ok();
        let mut checks = Check::all(&table, &scales, band, kernel).map_err(refused)?;
        // the file keeps the symmetric part alone, and says how far the code's own was from it
        if let Some(own) = &water.source.asymmetry {
            for check in &mut checks {
                match check.name {
                    CheckName::AddedMassAsymmetry => check.figure = own.added_mass,
                    CheckName::DampingAsymmetry => check.figure = own.radiation_damping,
                    _ => {}
                }
            }
        }
        let mut judged: Vec<JudgedCheck> = checks.iter().map(JudgedCheck::of).collect();
        judged.extend(bridge.and_then(|bridge| water_plane(water, bridge)));
        let length_m: f64 = lengths_m.iter().sum();
        let infinite = kernel.and_then(|kernel| {
            let infinite = added_mass_infinite(kernel, &table, &scales, Window::TRANSFER).ok()?;
            Some(total_heave(&infinite) / length_m)
        });
        let norm = |kernel: &Kernel, t_s: f64| scales.scaled(&kernel.at(t_s)).norm();
        let judged = Self {
            checks: judged,
            infinite_heave_kg_m: infinite,
            memory_heave_n_m2: kernel.map(|kernel| total_heave(&kernel.at(0.0)) / length_m),
            memory_left: kernel.map_or_else(Vec::new, |kernel| {
                TOLD_AT_S
                    .iter()
                    .map(|&t_s| norm(kernel, t_s) / norm(kernel, 0.0))
                    .collect()
            }),
        };
        Ok((judged, made, table, scales))
    }

    /// This water held against another bridge of the same lengths, by the water plane.
    #[must_use]
    pub(super) fn beside(&self, water: &WaterFile, bridge: &BridgeDesign) -> Self {
        let mut judged = self.clone();
        judged.checks.retain(|check| check.check != WATER_PLANE_CHECK);
        judged.checks.extend(water_plane(water, bridge));
        judged
    }

    /// Whether a check refuses the water.
    pub fn is_refused(&self) -> bool {
        self.refused().next().is_some()
    }

    /// The checks that refuse the water.
    pub fn refused(&self) -> impl Iterator<Item = &JudgedCheck> {
        self.checks.iter().filter(|check| check.outcome == REFUSED)
    }

    /// The names of all checks.
    pub fn names() -> Vec<&'static str> {
        let of_water = CheckName::ALL.into_iter().map(CheckName::as_str);
        of_water.chain([WATER_PLANE_CHECK]).collect()
    }
}

const REFUSED: &str = "refused";

impl JudgedCheck {
    fn of(check: &Check) -> Self {
        Self {
            check: check.name.as_str(),
            figure: check.figure.is_finite().then_some(check.figure),
            usual: check.name.warns().map(words),
            allowed: check.name.refuses().map(words),
            outcome: match check.outcome() {
                Outcome::Holds => "holds",
                Outcome::Warns => "warns",
                Outcome::Refused => REFUSED,
            },
        }
    }
}

fn words(limit: Limit) -> String {
    match limit {
        Limit::AtMost(limit) => format!("at most {limit}"),
        Limit::AtLeast(limit) => format!("at least {limit}"),
    }
}

/// Refuses a water of other modules than the bridge has.
fn fits(file: &Path, water: &WaterFile, design: &BridgeDesign) -> Result<(), Refusal> {
    if water.modules != design.modules {
        let allowed = format!("{}, as many as the bridge has", design.modules);
        return Err(Refusal::new(file, "modules", water.modules, allowed));
    }
    let ends_m: Vec<f64> = (1..=design.modules + 1).map(|end| design.position_x_m(end)).collect();
    for (module, ends) in ends_m.windows(2).enumerate() {
        let (own_m, length_m) = (ends[1] - ends[0], water.module_length_m.of(module).unwrap_or(f64::NAN));
        if length_m.is_nan() || (length_m - own_m).abs() > EQUAL_LENGTHS_M {
            let found = FoundValue::from(length_m).which(format!("the length of module {}", module + 1));
            return Err(Refusal::new(
                file,
                "module_length_m",
                found,
                format!("{own_m}, as the bridge has it"),
            ));
        }
    }
    Ok(())
}

/// The table of a water.
fn table_of(water: &WaterFile) -> Result<RadiationTable, InvalidInput> {
    let order = water.order();
    let matrix = |triangle: &Vec<f64>| RadiationTable::matrix(order, &full(order, triangle));
    RadiationTable::new(
        water.modules,
        water.omega_rad_s.clone(),
        water.added_mass.iter().map(matrix).collect(),
        water.radiation_damping.iter().map(matrix).collect(),
        water.infinite_added_mass.as_ref().map(matrix),
    )
}

/// The hull's water plane against the hydrostatic stiffness that the bridge has, per length; none where
/// that is not one number.
fn water_plane(water: &WaterFile, design: &BridgeDesign) -> Option<JudgedCheck> {
    let own_n_m2 = design.hydrostatic_stiffness_pa_m? * design.module.breadth_m;
    let hull_n_m2 = water
        .waterline_breadth_m
        .map(|b_m| water.density_kg_m3 * water.gravity_m_s2 * b_m);
    let off = hull_n_m2.map(|hull_n_m2| (hull_n_m2 / own_n_m2 - 1.0).abs());
    let [usual, allowed] = WATER_PLANE;
    Some(JudgedCheck {
        check: WATER_PLANE_CHECK,
        figure: off,
        usual: Some(format!("at most {usual}")),
        allowed: Some(format!("at most {allowed}")),
        outcome: match off {
            Some(off) if off <= usual => "holds",
            Some(off) if off > allowed => REFUSED,
            // what nobody tells cannot be held against anything
            _ => "warns",
        },
    })
}
