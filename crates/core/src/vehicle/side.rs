//! One side of a vehicle that is its own mirror image across the centre line of the bridge.
//!
//! Knows patches, points and which of them are images. Does not know the bridge.

use super::{Patch, Vehicle, WheelPoint};
use std::sync::Arc;

/// One side of a vehicle.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SideVehicle {
    /// What of it lies on the side of higher y or on the centre line, each patch of that side with the weight of its image as well.
    pub(crate) vehicle: Vehicle,
    /// Of each patch of the whole vehicle the one that stands for it, and its share of the force.
    pub(crate) of_patches: Vec<(usize, f64)>,
}

/// How far the shares of two wheels on springs may be apart to be images: they come from the state at rest, and its rounding.
const ROUNDING: f64 = 1e-12;

/// One side of a vehicle; none of one that is not its own mirror image to the last bit, but for the rounding of what is at rest.
pub(crate) fn one_side(vehicle: &Vehicle) -> Option<SideVehicle> {
    let rounding = if vehicle.springs.is_some() { ROUNDING } else { 0.0 };
    let mut images = Vec::new();
    for patch in &vehicle.patches {
        let mut of = (0..vehicle.patches.len()).filter(|&other| is_image(patch, &vehicle.patches[other], rounding));
        images.push(of.next()?);
        if of.next().is_some() {
            return None;
        }
    }
    let is_kept = |patch: usize| vehicle.patches[patch].y_m >= 0.0;
    let kept: Vec<usize> = (0..images.len()).filter(|&patch| is_kept(patch)).collect();
    let mut of_patches = Vec::new();
    for (patch, &image) in images.iter().enumerate() {
        let own = if is_kept(patch) { patch } else { image };
        let share = if image == patch { 1.0 } else { 0.5 };
        of_patches.push((kept.iter().position(|patch| *patch == own)?, share));
    }
    let with_image = |patch: &Patch| {
        // of a patch on the centre line its own other side is the image
        let points = patch.points.iter().filter(|point| patch.y_m > 0.0 || point.y_m >= 0.0);
        let of_point = |point: &WheelPoint| WheelPoint {
            share: if patch.y_m > 0.0 || point.y_m > 0.0 {
                2.0 * point.share
            } else {
                point.share
            },
            ..*point
        };
        Patch {
            share: if patch.y_m > 0.0 {
                2.0 * patch.share
            } else {
                patch.share
            },
            points: points.map(of_point).collect(),
            ..patch.clone()
        }
    };
    let springs = match &vehicle.springs {
        Some(springs) => Some(Arc::new(springs.one_side(&images, &kept)?)),
        None => None,
    };
    Some(SideVehicle {
        vehicle: Vehicle {
            patches: kept.iter().map(|&patch| with_image(&vehicle.patches[patch])).collect(),
            springs,
            ..vehicle.clone()
        },
        of_patches,
    })
}

/// Whether a patch is the mirror image of another, point by point, its shares within a rounding.
fn is_image(a: &Patch, b: &Patch, rounding: f64) -> bool {
    let of_patch = |of: &Patch| (of.axle, of.ahead_m, of.length_m, of.width_m);
    let is_alike = |a: f64, b: f64| (a - b).abs() <= rounding * a.abs();
    let image = |p: &WheelPoint| {
        b.points
            .iter()
            .any(|q| (p.along, -p.y_m) == (q.along, q.y_m) && is_alike(p.share, q.share))
    };
    of_patch(a) == of_patch(b)
        && a.y_m == -b.y_m
        && is_alike(a.share, b.share)
        && is_alike(a.rigid, b.rigid)
        && a.points.len() == b.points.len()
        && a.points.iter().all(image)
}

#[cfg(test)]
mod tests {
    use crate::vehicle::VehicleDesign;
    use serde_json::{Value, json};

    fn side_of(design: Value) -> Option<crate::vehicle::Vehicle> {
        let design: VehicleDesign = serde_json::from_value(design).unwrap();
        super::one_side(&design.check(8.0).unwrap()).map(|side| side.vehicle)
    }

    /// Two tracks become one with the weight of both, patches of a width keep the points of one side, and shares sum to 1.
    #[test]
    fn a_side_carries_the_whole_weight() {
        for (tracks, widths, points) in [
            (json!([-1.4, 1.4]), 0.0, 4),
            (json!([-1.4, 1.4]), 0.5, 8),
            (json!([0.0]), 0.0, 4),
            (json!([0.0]), 0.5, 4),
            (json!([-1.4, 0.0, 1.4]), 0.0, 8),
        ] {
            let vehicle = json!({ "axles": [{ "share": 1.0, "track_y_m": tracks, "behind_front_m": 1.0, "patch_length_m": 1.0, "patch_width_m": widths }], "patch_points": 4 });
            let side = side_of(vehicle.clone()).unwrap();
            assert_eq!(side.points().count(), points, "{vehicle}");
            let sum: f64 = side.points().map(|point| point.share).sum();
            let of_patches: f64 = side.patches.iter().map(|patch| patch.share).sum();
            assert!(
                (sum - 1.0).abs() < 1e-14 && (of_patches - 1.0).abs() < 1e-14,
                "{vehicle}: {sum}"
            );
            assert!(side.points().all(|point| point.y_m >= 0.0));
        }
    }

    /// An asymmetry of one bit is one.
    #[test]
    fn a_vehicle_off_the_centre_has_no_side() {
        assert!(side_of(json!({ "track_y_m": [-1.4, 1.4_f64.next_up()] })).is_none());
        assert!(side_of(json!({ "track_y_m": [-1.0, 1.8] })).is_none());
        assert!(side_of(json!({ "track_y_m": [1.4] })).is_none());
    }
}
