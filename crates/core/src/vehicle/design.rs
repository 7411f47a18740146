//! A vehicle as it is written: a single footprint, or axles, with or without bodies on springs.
//!
//! Knows keys, ranges and which keys go together. Does not know how a vehicle moves.

use super::springs::Springs;
use super::written::{Axle, Body};
use super::{Inertia, Patch, Vehicle, WheelPoint};
use crate::input::{Found, InvalidInput, Problem, bound, not_negative, positive, within};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// A vehicle as a study or a vehicle file writes it: the single footprint of the paper, or a list of axles, a body on their
/// suspensions or none.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct VehicleDesign {
    /// What it is called.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Where its numbers come from.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub source: Option<String>,
    /// Length of the single footprint `[m]`; its centre is the vehicle's front. Not together with `axles`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub footprint_length_m: Option<f64>,
    /// Tracks of the single footprint `[m]`. Not together with `axles`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub track_y_m: Option<Vec<f64>>,
    /// Axles in place of the single footprint.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axles: Option<Vec<Axle>>,
    /// A body on the axles' suspensions.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub body: Option<Body>,
    /// How the mass that lies on the deck without a spring takes part.
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
            name: None,
            source: None,
            footprint_length_m: None,
            track_y_m: None,
            axles: None,
            body: None,
            inertia: Inertia::default(),
            patch_points: default_patch_points(),
        }
    }
}

/// Footprint length of the paper's vehicle as identified `[m]`.
const DEFAULT_FOOTPRINT_LENGTH_M: f64 = 3.35;
/// Tracks of the paper's vehicle as identified `[m]`.
const DEFAULT_TRACK_Y_M: [f64; 2] = [-1.4, 1.4];

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
                patch_length_m: self.footprint_length_m.unwrap_or(DEFAULT_FOOTPRINT_LENGTH_M),
                track_y_m: self.track_y_m.clone().unwrap_or_else(|| DEFAULT_TRACK_Y_M.to_vec()),
                ..Axle::default()
            }]),
        }
    }

    /// Whether it says what it weighs: by loads of its axles, or by masses on springs.
    pub fn states_weight(&self) -> bool {
        let axles = self.axles.iter().flatten();
        let says = |axle: &Axle| axle.load_n.is_some() || axle.tyre_stiffness_n_m.is_some();
        self.body.is_some() || axles.into_iter().any(says)
    }

    /// The vehicle with its patches and points, checked against a deck of breadth `deck_breadth_m`.
    ///
    /// # Errors
    /// [`InvalidInput`] with the key's path: no axle or track, a share that is not positive, shares that do not sum
    /// to 1, a negative length, a patch that reaches beyond the deck, convective inertia on a patch of no length, masses and
    /// springs of which one does not hold the other.
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
        if let (Some(_), true) = (&self.body, single) {
            let refused = InvalidInput::new("body", "a body on a footprint", "a body on axles with suspensions");
            return Err(refused.because(Problem::Misplaced));
        }
        let half = 0.5 * deck_breadth_m;
        let springs = Springs::of(&axles, self.body.as_ref())?;
        let (mut shares, mut weight_n) = match &springs {
            None => shares(&axles)?,
            Some(_) => (vec![0.0; axles.len()], None),
        };
        if let Some(springs) = &springs {
            (shares, weight_n) = (springs.axle_shares(&axles), Some(springs.whole_weight_n()));
            agree_with_masses(&axles, &shares, springs.whole_weight_n())?;
        }
        let mut patches = Vec::new();
        for (k, axle) in axles.iter().enumerate() {
            not_negative(&key(k, "behind_front_m"), axle.behind_front_m)?;
            if single {
                positive(&key(k, "patch_length_m"), axle.patch_length_m)?;
            }
            not_negative(&key(k, "patch_length_m"), axle.patch_length_m)?;
            not_negative(&key(k, "patch_width_m"), axle.patch_width_m)?;
            let rides = springs.is_none() || axle.unsprung_mass_kg.is_some() && axle.tyre_stiffness_n_m.is_none();
            if self.inertia == Inertia::Convective && rides && axle.patch_length_m == 0.0 {
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
            for (t, &y) in axle.track_y_m.iter().enumerate() {
                let reach = half - 0.5 * axle.patch_width_m;
                within(&format!("{}[{t}]", key(k, "track_y_m")), y, -reach, reach)?;
                let (mut share, mut rigid) = (shares[k] / axle.track_y_m.len() as f64, 1.0);
                if let Some(springs) = &springs {
                    (share, rigid) = springs.patch_shares(patches.len());
                }
                patches.push(patch(k, axle, y, share, rigid, self.patch_points));
            }
        }
        Ok(Vehicle {
            springs: springs.map(Arc::new),
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

/// How far a stated load or share may be off what the masses give.
const STATED_LOAD: f64 = 0.01;

/// Refuses loads and shares of axles that are not those of the masses.
fn agree_with_masses(axles: &[Axle], shares: &[f64], weight_n: f64) -> Result<(), InvalidInput> {
    for (k, (axle, share)) in axles.iter().zip(shares).enumerate() {
        for (name, stated, found) in [("load_n", axle.load_n, share * weight_n), ("share", axle.share, *share)] {
            let Some(stated) = stated else { continue };
            if (stated - found).abs() > STATED_LOAD * found {
                let allowed = format!("{} within 1 %, which the masses give, or none", bound(found));
                let refused = InvalidInput::new(format!("axles[{k}].{name}"), stated, allowed);
                return Err(refused.because(Problem::Conflict));
            }
        }
    }
    Ok(())
}

fn patch(k: usize, axle: &Axle, y: f64, share: f64, rigid: f64, along: usize) -> Patch {
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
        y_m: y,
        width_m: axle.patch_width_m,
        share,
        rigid,
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
