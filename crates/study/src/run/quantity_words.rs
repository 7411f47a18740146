//! The words by which tables have the numbers of a response.
//!
//! Knows both. Does not know what a number is made of.

use pontoon_core::response::{Axis, Quantity, Section};
use pontoon_plan::job::body_word;

/// The word of a recorded number.
pub(super) fn quantity_word(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::Deflection => "deflection_m",
        Quantity::Force => "force_n",
        Quantity::Pin(Axis::X) => "pin_x_n",
        Quantity::Pin(Axis::Y) => "pin_y_n",
        Quantity::Pin(Axis::Z) => "pin_z_n",
        Quantity::Section(Section::Angle) => "angle_rad",
        Quantity::Section(Section::Axial) => "axial_n",
        Quantity::Section(Section::ShearY) => "shear_y_n",
        Quantity::Section(Section::ShearZ) => "shear_z_n",
        Quantity::Section(Section::Torsion) => "torsion_nm",
        Quantity::Section(Section::Bending) => "bending_nm",
        Quantity::Section(Section::LateralBending) => "lateral_bending_nm",
        Quantity::Wheel => "wheel_n",
        Quantity::Body(motion) => body_word(motion),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pontoon_core::response::BodyMotion;
    use pontoon_results::{QUANTITIES, SECTION_QUANTITIES};

    #[test]
    fn tables_know_every_word() {
        let pins = Axis::ALL.map(Quantity::Pin);
        let sections = Section::ALL.map(Quantity::Section);
        let all = [Quantity::Deflection, Quantity::Force]
            .into_iter()
            .chain(pins)
            .chain(sections)
            .chain([Quantity::Wheel])
            .chain([BodyMotion::Bounce, BodyMotion::Pitch, BodyMotion::Roll].map(Quantity::Body));
        assert_eq!(all.map(quantity_word).collect::<Vec<_>>(), QUANTITIES);
        assert_eq!(sections.map(quantity_word), SECTION_QUANTITIES);
    }
}
