//! The vehicle: a set of wheel patches, each with its share of the weight, and what rides on them.
//!
//! | module | charter |
//! |---|---|
//! | `design` | a vehicle as it is written, and its checks |
//! | `written` | axles and bodies as they are written |
//! | `springs` | masses on springs: matrices, wheels, the state at rest |
//! | `side` | one side of a vehicle that is its own mirror image |
//!
//! Knows axles, patches and where their points stand for a given place of the vehicle. Does not know the bridge: what
//! a point does to the deck is the track's business.

mod design;
mod side;
mod springs;
mod written;

use crate::input::{InvalidInput, within};
pub use design::VehicleDesign;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
pub(crate) use side::{SideVehicle, one_side};
pub use springs::{SpringWheel, Springs, VehicleMotion};
use std::sync::Arc;
pub use written::{Axle, Body};

/// Standard gravity `[m/s^2]`, by which a weight becomes a mass.
pub const GRAVITY_M_S2: f64 = 9.806_65;

/// How the vehicle's mass takes part in the motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Inertia {
    /// Moving weight only.
    None,
    /// The paper's: each point's mass has the acceleration `u''` of the deck under it.
    #[default]
    Local,
    /// What the mass really undergoes: `r u'' + 2 V r_x u' + V^2 r_xx u`, with `r` averaged over the patch.
    Convective,
}

/// One point that carries weight and mass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WheelPoint {
    /// Distance of the point ahead of the vehicle's front `[m]`; negative behind it.
    pub ahead_m: f64,
    /// Number of that distance in [`Vehicle::along_m`], from 0.
    pub along: usize,
    /// Place across the bridge `[m]`.
    pub y_m: f64,
    /// Share of the vehicle's weight.
    pub share: f64,
}

/// One patch: the points of one axle on one track.
#[derive(Debug, Clone, PartialEq)]
pub struct Patch {
    /// Number of the axle, from 0.
    pub axle: usize,
    /// Distance of the patch centre ahead of the vehicle's front `[m]`; negative behind it.
    pub ahead_m: f64,
    /// Length along the bridge `[m]`.
    pub length_m: f64,
    /// Place of its track across the bridge `[m]`.
    pub y_m: f64,
    /// Width across the bridge `[m]`.
    pub width_m: f64,
    /// Share of the vehicle's weight, which it carries at rest.
    pub share: f64,
    /// What of that lies on the deck without a spring between, and rides along: 1 of a rigid vehicle.
    pub rigid: f64,
    /// The points, evenly spaced along the patch (midpoint rule) and, where it has a width, at its two Gauss points
    /// across.
    pub points: Vec<WheelPoint>,
}

/// A checked vehicle: patches in order of axles, then tracks.
#[derive(Debug, Clone, PartialEq)]
pub struct Vehicle {
    /// The patches.
    pub patches: Vec<Patch>,
    /// Distances of the points ahead of the front `[m]`, each once; points side by side share one.
    pub along_m: Vec<f64>,
    /// Weight `[N]`, where the axles state theirs or masses on springs have it.
    pub weight_n: Option<f64>,
    /// Number of axles.
    pub axles: usize,
    /// How the mass that lies on the deck without a spring takes part.
    pub inertia: Inertia,
    /// What rides on springs; none of a rigid vehicle.
    pub springs: Option<Arc<Springs>>,
}

impl Vehicle {
    /// Farthest point ahead of the front `[m]`.
    pub fn ahead_m(&self) -> f64 {
        self.points().map(|p| p.ahead_m).fold(f64::NEG_INFINITY, f64::max)
    }

    /// Farthest point behind the front `[m]`.
    pub fn behind_m(&self) -> f64 {
        self.points().map(|p| -p.ahead_m).fold(f64::NEG_INFINITY, f64::max)
    }

    /// All points, patch after patch.
    pub fn points(&self) -> impl Iterator<Item = &WheelPoint> {
        self.patches.iter().flat_map(|p| p.points.iter())
    }

    /// Distance of the vehicle's centre (weighted by the shares) ahead of its front `[m]`.
    pub fn centre_ahead_m(&self) -> f64 {
        self.points().map(|p| p.share * p.ahead_m).sum()
    }

    /// The vehicle as it stands: its weight alone, without springs and masses that ride along.
    #[must_use]
    pub fn standing(&self) -> Self {
        let mut standing = self.clone();
        (standing.inertia, standing.springs) = (Inertia::None, None);
        standing.patches.iter_mut().for_each(|patch| patch.rigid = 1.0);
        standing
    }

    /// Whether any of its mass lies on the deck without a spring between and rides along.
    pub fn has_riding_mass(&self) -> bool {
        self.inertia != Inertia::None && self.patches.iter().any(|patch| patch.rigid > 0.0)
    }

    /// Where it is wide across the bridge: from the outer side of one outermost patch to that of the other `[m]`.
    pub fn breadth_m(&self) -> [f64; 2] {
        let sides = |patch: &Patch| [patch.y_m - 0.5 * patch.width_m, patch.y_m + 0.5 * patch.width_m];
        let join = |[lo, hi]: [f64; 2], [a, b]: [f64; 2]| [lo.min(a), hi.max(b)];
        let all = self.patches.iter().map(sides);
        all.fold([f64::INFINITY, f64::NEG_INFINITY], join)
    }

    /// Ends of what it covers along, ahead of its front: rear and front of its patches `[m]`.
    pub fn reach_m(&self) -> [f64; 2] {
        let ends = |patch: &Patch| {
            [
                patch.ahead_m - 0.5 * patch.length_m,
                patch.ahead_m + 0.5 * patch.length_m,
            ]
        };
        let join = |[lo, hi]: [f64; 2], [a, b]: [f64; 2]| [lo.min(a), hi.max(b)];
        let all = self.patches.iter().map(ends);
        all.fold([f64::INFINITY, f64::NEG_INFINITY], join)
    }

    /// The vehicle in a lane: its centre line at `y_m` across a deck of breadth `deck_breadth_m`; turned round where it drives
    /// toward the left end.
    ///
    /// # Errors
    /// [`InvalidInput`] at `y_m` where a patch reaches beyond the deck.
    pub fn in_lane(&self, y_m: f64, turned: bool, deck_breadth_m: f64) -> Result<Self, InvalidInput> {
        let mut placed = self.clone();
        let across = |y: f64| if turned { y_m - y } else { y_m + y };
        for patch in &mut placed.patches {
            patch.y_m = across(patch.y_m);
            patch.points.iter_mut().for_each(|point| point.y_m = across(point.y_m));
        }
        let (half, [left, right]) = (0.5 * deck_breadth_m, placed.breadth_m());
        let [from, to] = [-half - (left - y_m), half - (right - y_m)];
        // room for the rounding of its own check
        if left < -half - 1e-9 || right > half + 1e-9 {
            within("y_m", y_m, from, to)?;
        }
        Ok(placed)
    }
}
