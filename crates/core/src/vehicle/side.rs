//! One side of a vehicle that is its own mirror image across the centre line of the bridge.
//!
//! Knows patches and points. Does not know the bridge.

use super::{Patch, Vehicle, WheelPoint};

/// What of the vehicle lies on the side of higher y or on the centre line, each point of that side with the weight of its image
/// as well; none of a vehicle that is not its own mirror image to the last bit, or that rides on springs.
pub(crate) fn one_side(vehicle: &Vehicle) -> Option<Vehicle> {
    if vehicle.springs.is_some() {
        return None;
    }
    let mut patches = Vec::new();
    for patch in &vehicle.patches {
        let mut images = vehicle.patches.iter().filter(|other| is_image(patch, other));
        images.next()?;
        if images.next().is_some() {
            return None;
        }
        if patch.y_m < 0.0 {
            continue;
        }
        // of a patch on the centre line its own other side is the image
        let points = patch.points.iter().filter(|point| patch.y_m > 0.0 || point.y_m >= 0.0);
        let with_image = |point: &WheelPoint| WheelPoint {
            share: if patch.y_m > 0.0 || point.y_m > 0.0 {
                2.0 * point.share
            } else {
                point.share
            },
            ..*point
        };
        patches.push(Patch {
            share: if patch.y_m > 0.0 {
                2.0 * patch.share
            } else {
                patch.share
            },
            points: points.map(with_image).collect(),
            ..patch.clone()
        });
    }
    Some(Vehicle {
        patches,
        ..vehicle.clone()
    })
}

/// Whether a patch is the mirror image of another, point by point.
fn is_image(a: &Patch, b: &Patch) -> bool {
    let of_patch = |of: &Patch| (of.axle, of.ahead_m, of.length_m, of.width_m, of.share, of.rigid);
    let image = |p: &WheelPoint| {
        b.points
            .iter()
            .any(|q| (p.along, -p.y_m, p.share) == (q.along, q.y_m, q.share))
    };
    of_patch(a) == of_patch(b) && a.y_m == -b.y_m && a.points.len() == b.points.len() && a.points.iter().all(image)
}

#[cfg(test)]
mod tests {
    use crate::vehicle::VehicleDesign;
    use serde_json::{Value, json};

    fn side_of(design: Value) -> Option<crate::vehicle::Vehicle> {
        let design: VehicleDesign = serde_json::from_value(design).unwrap();
        super::one_side(&design.check(8.0).unwrap())
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
