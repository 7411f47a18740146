//! The words of recorded numbers: what each is, with its unit.
//!
//! Knows words. Does not know tables.

/// The words of `quantity`: what a history is of, with its unit and its sense.
pub const QUANTITIES: [&str; 16] = [
    "deflection_m",
    "force_n",
    "pin_x_n",
    "pin_y_n",
    "pin_z_n",
    "angle_rad",
    "axial_n",
    "shear_y_n",
    "shear_z_n",
    "torsion_nm",
    "bending_nm",
    "lateral_bending_nm",
    "wheel_n",
    "bounce_m",
    "pitch_rad",
    "roll_rad",
];

/// The words of what a bridge does at rest, with their units and senses.
pub const DEAD_QUANTITIES: [&str; 7] = [
    "deflection_m",
    "force_n",
    "reaction_n",
    "sinkage_m",
    "trim_rad",
    "heel_rad",
    "freeboard_m",
];

/// Those of them that are a joint's angle and section forces.
pub const SECTION_QUANTITIES: [&str; 7] = {
    let [_, _, _, _, _, sections @ .., _, _, _, _] = QUANTITIES;
    sections
};
