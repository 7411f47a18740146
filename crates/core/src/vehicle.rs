//! The vehicle: a set of wheel patches, each with its share of the weight.
//!
//! Knows axles, patches and where their points stand for a given place of the vehicle. Does not know the bridge: what
//! a point does to the deck is the track's business.

use crate::input::{Found, InvalidInput, Problem, bound, not_negative, positive, within};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

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

/// One axle: a patch on each of its tracks.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Axle {
    /// Distance of the patch centre behind the vehicle's front `[m]`.
    pub behind_front_m: f64,
    /// Share of the vehicle's weight; the shares of all axles sum to 1, within a thousandth. Either this or `load_n`, the same
    /// for all axles.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub share: Option<f64>,
    /// Weight on the axle `[N]`; the sum of all axles is the vehicle's weight, and a study states no other.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub load_n: Option<f64>,
    /// Length of the patch along the bridge `[m]`; 0 is a point.
    pub patch_length_m: f64,
    /// Width of the patch across the bridge `[m]`; 0 is a line.
    #[serde(default)]
    pub patch_width_m: f64,
    /// Places of the tracks across the bridge `[m]`; the axle's share is split evenly between them.
    pub track_y_m: Vec<f64>,
}

/// A vehicle as a study writes it: the single footprint of the paper, or a list of axles.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct VehicleDesign {
    /// Length of the single footprint `[m]`; its centre is the vehicle's front. Not together with `axles`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub footprint_length_m: Option<f64>,
    /// Tracks of the single footprint `[m]`. Not together with `axles`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub track_y_m: Option<Vec<f64>>,
    /// Axles in place of the single footprint.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axles: Option<Vec<Axle>>,
    /// How the vehicle's mass takes part.
    #[serde(default)]
    pub inertia: Inertia,
    /// Points along each patch, evenly spaced, that carry its weight and mass.
    #[serde(default = "default_patch_points")]
    pub patch_points: usize,
}

fn default_patch_points() -> usize {
    8
}

impl Default for VehicleDesign {
    /// The paper's single footprint on two tracks.
    fn default() -> Self {
        Self {
            footprint_length_m: None,
            track_y_m: None,
            axles: None,
            inertia: Inertia::default(),
            patch_points: default_patch_points(),
        }
    }
}

/// Footprint length of the paper's vehicle as identified `[m]`.
const DEFAULT_FOOTPRINT_LENGTH_M: f64 = 3.35;
/// Tracks of the paper's vehicle as identified `[m]`.
const DEFAULT_TRACK_Y_M: [f64; 2] = [-1.4, 1.4];

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
    /// Share of the vehicle's weight.
    pub share: f64,
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
    /// Weight `[N]`, where the axles state theirs.
    pub weight_n: Option<f64>,
    /// Number of axles.
    pub axles: usize,
    /// How the mass takes part.
    pub inertia: Inertia,
}

impl VehicleDesign {
    /// The axles: those given, or the single footprint as one axle.
    ///
    /// # Errors
    /// [`InvalidInput`] where both forms are given.
    pub fn axles(&self) -> Result<Vec<Axle>, InvalidInput> {
        match &self.axles {
            Some(axles) => {
                if self.footprint_length_m.is_some() {
                    return Err(InvalidInput::new(
                        "footprint_length_m",
                        "both a footprint and axles",
                        "one of the two",
                    )
                    .because(Problem::Misplaced));
                }
                if self.track_y_m.is_some() {
                    return Err(InvalidInput::new(
                        "track_y_m",
                        "both a footprint's tracks and axles",
                        "one of the two",
                    )
                    .because(Problem::Misplaced));
                }
                Ok(axles.clone())
            }
            None => Ok(vec![Axle {
                behind_front_m: 0.0,
                share: Some(1.0),
                load_n: None,
                patch_length_m: self.footprint_length_m.unwrap_or(DEFAULT_FOOTPRINT_LENGTH_M),
                patch_width_m: 0.0,
                track_y_m: self.track_y_m.clone().unwrap_or_else(|| DEFAULT_TRACK_Y_M.to_vec()),
            }]),
        }
    }

    /// The vehicle with its patches and points, checked against a deck of breadth `deck_breadth_m`.
    ///
    /// # Errors
    /// [`InvalidInput`] with the key's path: no axle or track, a share that is not positive, shares that do not sum
    /// to 1, a negative length, a patch that reaches beyond the deck, convective inertia on a patch of no length.
    pub fn check(&self, deck_breadth_m: f64) -> Result<Vehicle, InvalidInput> {
        let axles = self.axles()?;
        let single = self.axles.is_none();
        let key = |k: usize, name: &str| match (single, name) {
            (true, "patch_length_m") => "footprint_length_m".to_owned(),
            (true, name) => name.to_owned(),
            (false, name) => format!("axles[{k}].{name}"),
        };
        if axles.is_empty() {
            return Err(InvalidInput::new("axles", "an empty list", "at least one axle"));
        }
        if !(1..=64).contains(&self.patch_points) {
            return Err(InvalidInput::new(
                "patch_points",
                self.patch_points,
                "a whole number from 1 to 64",
            ));
        }
        let half = 0.5 * deck_breadth_m;
        let (shares, weight_n) = shares(&axles)?;
        let mut patches = Vec::new();
        for (k, axle) in axles.iter().enumerate() {
            not_negative(&key(k, "behind_front_m"), axle.behind_front_m)?;
            if single {
                positive(&key(k, "patch_length_m"), axle.patch_length_m)?;
            }
            not_negative(&key(k, "patch_length_m"), axle.patch_length_m)?;
            not_negative(&key(k, "patch_width_m"), axle.patch_width_m)?;
            if self.inertia == Inertia::Convective && axle.patch_length_m == 0.0 {
                return Err(
                    InvalidInput::new(key(k, "patch_length_m"), 0.0, "above 0 with convective inertia")
                        .because(Problem::Conflict),
                );
            }
            if axle.track_y_m.is_empty() {
                return Err(InvalidInput::new(
                    key(k, "track_y_m"),
                    "an empty list",
                    "at least one track",
                ));
            }
            let share = shares[k] / axle.track_y_m.len() as f64;
            for (t, &y) in axle.track_y_m.iter().enumerate() {
                let reach = half - 0.5 * axle.patch_width_m;
                within(&format!("{}[{t}]", key(k, "track_y_m")), y, -reach, reach)?;
                patches.push(patch(k, axle, y, share, self.patch_points));
            }
        }
        Ok(Vehicle {
            weight_n,
            along_m: number_places(&mut patches),
            patches,
            axles: axles.len(),
            inertia: self.inertia,
        })
    }
}

/// How far the sum of the shares may be off 1: three shares of 0.333 are 0.999.
const ROUNDED_SHARES: f64 = 1.001e-3;

/// The share of each axle, their sum 1, and the vehicle's weight `[N]` where its axles state theirs.
fn shares(axles: &[Axle]) -> Result<(Vec<f64>, Option<f64>), InvalidInput> {
    let by_loads = axles.first().is_some_and(|first| first.load_n.is_some());
    let (own, other) = if by_loads {
        ("load_n", "share")
    } else {
        ("share", "load_n")
    };
    let mut list = Vec::new();
    for (k, axle) in axles.iter().enumerate() {
        let key = |name: &str| format!("axles[{k}].{name}");
        let (value, excluded) = match by_loads {
            true => (axle.load_n, axle.share),
            false => (axle.share, axle.load_n),
        };
        if let Some(excluded) = excluded {
            let refused = InvalidInput::new(key(other), excluded, format!("{own} alone, the same for all axles"));
            return Err(refused.because(Problem::Misplaced));
        }
        let Some(value) = value else {
            let allowed = "a share of each axle, or a load_n of each";
            let refused = InvalidInput::new(key(own), Found::Nothing, allowed);
            return Err(refused.because(Problem::Missing));
        };
        list.push(positive(&key(own), value)?);
    }
    let sum: f64 = list.iter().sum();
    if !by_loads && (sum - 1.0).abs() > ROUNDED_SHARES {
        return Err(InvalidInput::new(
            "axles[*].share",
            format!("a sum of {}", bound(sum)),
            "shares that sum to 1 within 0.001, or load_n in place of each share",
        ));
    }
    list.iter_mut().for_each(|value| *value /= sum);
    Ok((list, by_loads.then_some(sum)))
}

fn patch(k: usize, axle: &Axle, y: f64, share: f64, along: usize) -> Patch {
    let along = if axle.patch_length_m > 0.0 { along } else { 1 };
    let gauss = 0.5 * axle.patch_width_m / 3.0_f64.sqrt();
    let across: &[f64] = if axle.patch_width_m > 0.0 { &[-1.0, 1.0] } else { &[0.0] };
    let centre = -axle.behind_front_m;
    let each = share / (along * across.len()) as f64;
    let points = (0..along)
        .flat_map(|i| {
            let ahead_m = centre + axle.patch_length_m * ((i as f64 + 0.5) / along as f64 - 0.5);
            across.iter().map(move |s| WheelPoint {
                ahead_m,
                along: 0,
                y_m: y + s * gauss,
                share: each,
            })
        })
        .collect();
    Patch {
        axle: k,
        ahead_m: centre,
        length_m: axle.patch_length_m,
        share,
        points,
    }
}

/// Numbers the places of the points along the vehicle and gives their distances ahead of the front.
fn number_places(patches: &mut [Patch]) -> Vec<f64> {
    let mut along_m: Vec<f64> = Vec::new();
    for point in patches.iter_mut().flat_map(|p| &mut p.points) {
        point.along = along_m.iter().position(|x| *x == point.ahead_m).unwrap_or_else(|| {
            along_m.push(point.ahead_m);
            along_m.len() - 1
        });
    }
    along_m
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
}
