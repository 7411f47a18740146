//! Quantities of a bridge that are no number of its file: masses.
//!
//! Knows what they are and which numbers follow them. Does not know parameters.

use pontoon_core::bridge::BridgeDesign;

/// Quantities of a bridge that are no number of its file.
pub(super) const QUANTITIES: [&str; 2] = ["structural_mass_kg", "total_mass_kg_m"];

/// Quantities with the numbers of the file that follow them, Todd's formula giving way to the added mass.
pub(super) const FOLLOWS: [(&str, &str); 5] = [
    ("structural_mass_kg", "module.material.density_kg_m3"),
    ("total_mass_kg_m", "added_mass_kg_m"),
    ("total_mass_kg_m", "todd.water_density_kg_m3"),
    ("total_mass_kg_m", "todd.section_coefficient"),
    ("total_mass_kg_m", "todd.three_dimensional_correction"),
];

/// A quantity of a bridge by its name; none of one whose modules are not alike.
pub(super) fn quantity(design: &BridgeDesign, name: &str) -> Option<f64> {
    match name {
        _ if design.row.is_some() => None,
        "structural_mass_kg" => Some(design.structural_mass_kg()),
        "total_mass_kg_m" => {
            Some(design.structural_mass_kg() / design.module.length_m + design.m_a() * design.wet_share())
        }
        _ => None,
    }
}
