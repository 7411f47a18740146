//! Axles and bodies as they are written.
//!
//! Knows keys. Does not know which go together.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// One axle: a patch on each of its tracks.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Axle {
    /// Distance of the patch centre behind the vehicle's front `[m]`.
    pub behind_front_m: f64,
    /// Share of the vehicle's weight; the shares of all axles sum to 1, within a thousandth. Either this or `load_n`, the same
    /// for all axles. A vehicle on springs needs neither: its masses have the weight, and what is stated must agree with them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub share: Option<f64>,
    /// Weight on the axle `[N]`; the sum of all axles is the vehicle's weight, which a study may scale by its `load_n`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub load_n: Option<f64>,
    /// Length of the patch along the bridge `[m]`; 0 is a point.
    pub patch_length_m: f64,
    /// Width of the patch across the bridge `[m]`; 0 is a line.
    #[serde(default)]
    pub patch_width_m: f64,
    /// Places of the tracks across the bridge `[m]`; the axle's share, masses and springs are split evenly between them.
    pub track_y_m: Vec<f64>,
    /// Mass between tyres and suspension `[kg]`; without tyres it rides on the deck itself.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unsprung_mass_kg: Option<f64>,
    /// Stiffness of the axle's tyres together `[N/m]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tyre_stiffness_n_m: Option<f64>,
    /// Damping of the tyres together `[N s/m]`; none where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tyre_damping_n_s_m: Option<f64>,
    /// Stiffness of the suspension that carries the body, of the axle's springs together `[N/m]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub suspension_stiffness_n_m: Option<f64>,
    /// Damping of the suspension, of the axle's dampers together `[N s/m]`; none where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub suspension_damping_n_s_m: Option<f64>,
}

/// The body that the axles' suspensions carry.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Body {
    /// Its mass `[kg]`.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub mass_kg: f64,
    /// Distance of its centre of mass behind the vehicle's front `[m]`.
    pub behind_front_m: f64,
    /// Moment of inertia about the axis across, through its centre `[kg m^2]`; it does not pitch where absent, as a body on
    /// one axle.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pitch_inertia_kg_m2: Option<f64>,
    /// Moment of inertia about the axis along, through its centre `[kg m^2]`; it does not roll where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub roll_inertia_kg_m2: Option<f64>,
    /// Height of its centre above the deck `[m]`, by which braking pitches it; 0 where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub height_m: Option<f64>,
}
