//! What a vehicle at a place does to the track: weights on rows, and the masses that ride along.
//!
//! Knows the weight and mass of points and patches, and rows. Does not know solvers or time.

use super::{Track, VehiclePlacement};
use crate::fem::SparseRow;
use crate::vehicle::{GRAVITY_M_S2, Inertia, Patch, Vehicle};

/// A mass that rides along: the row on which its force acts and the rows that make its acceleration
/// `r u'' + 2 V r_x u' + V^2 r_xx u`.
#[derive(Debug, Clone)]
pub(crate) struct Rider {
    /// Mass `[kg]`.
    pub mass_kg: f64,
    /// Axle it belongs to.
    pub axle: usize,
    /// r, where the force acts and the acceleration is taken.
    pub row: SparseRow,
    /// r_x and r_xx, where convective.
    pub derivatives: Option<(SparseRow, SparseRow)>,
}

/// A vehicle on the track at one instant.
#[derive(Debug, Clone, Default)]
pub(crate) struct Load {
    /// Where the vehicle is.
    pub placement: VehiclePlacement,
    /// Downward force of the weights on each track column, as one row `[N]`.
    pub weight: SparseRow,
    /// The masses.
    pub riders: Vec<Rider>,
    /// Weight of each axle that is on the bridge `[N]`, and whether the contact force of all its points has settled.
    pub axles: Vec<(f64, bool)>,
}

impl Load {
    /// A vehicle of weight `load_n` with its front at `front_x_m`, moving at `speed_m_s`. A point off the bridge neither loads nor weighs.
    /// Equation (V1).
    pub(crate) fn new(track: &Track, vehicle: &Vehicle, load_n: f64, front_x_m: f64, speed_m_s: f64) -> Self {
        let mut load = Self {
            placement: VehiclePlacement::new(track, vehicle, front_x_m, speed_m_s),
            axles: vec![(0.0, true); vehicle.axles],
            ..Self::default()
        };
        let mut weight = Vec::new();
        for patch in &vehicle.patches {
            let mut mean: Vec<(usize, f64)> = Vec::new();
            for point in &patch.points {
                load.axles[patch.axle].1 &= load.placement.is_settled(point.along);
                let Some(row) = load.placement.row(track, point) else {
                    continue;
                };
                let w = load_n * point.share;
                load.axles[patch.axle].0 += w;
                weight.extend(row.0.iter().map(|&(c, v)| (c, v * w)));
                match vehicle.inertia {
                    Inertia::None => {}
                    Inertia::Local => {
                        let mass_kg = w / GRAVITY_M_S2;
                        load.riders.push(Rider {
                            mass_kg,
                            axle: patch.axle,
                            row,
                            derivatives: None,
                        });
                    }
                    Inertia::Convective => mean.extend(row.0.iter().map(|&(c, v)| (c, v * point.share))),
                }
            }
            let share_on = load.placement.share_on(patch);
            if vehicle.inertia == Inertia::Convective && share_on > 0.0 {
                let scaled = mean.into_iter().map(|(c, v)| (c, v / share_on)).collect();
                load.riders.push(Rider {
                    mass_kg: load_n * share_on / GRAVITY_M_S2,
                    axle: patch.axle,
                    row: SparseRow::from_entries(scaled),
                    derivatives: Some(derivatives(track, patch, &load.placement)),
                });
            }
        }
        load.weight = SparseRow::from_entries(weight);
        load
    }
}

/// r_x and r_xx of the row averaged over the part of a patch that is on the bridge: differences of the row and of its slope
/// between the part's ends, over its length.
/// Equation (V2).
fn derivatives(track: &Track, patch: &Patch, placement: &VehiclePlacement) -> (SparseRow, SparseRow) {
    let mut ys: Vec<f64> = patch.points.iter().map(|p| p.y_m).collect();
    ys.sort_by(f64::total_cmp);
    ys.dedup();
    let [left, right] = placement.ends_m(track, patch);
    let per = 1.0 / ((right - left) * ys.len() as f64);
    let difference = |of: &dyn Fn(f64, f64) -> Option<SparseRow>| {
        let mut terms = Vec::new();
        for &y in &ys {
            for (end, sign) in [(right, per), (left, -per)] {
                terms.extend(of(end, y).map(|row| (sign, row)));
            }
        }
        SparseRow::combine(&terms.iter().map(|(s, r)| (*s, r)).collect::<Vec<_>>())
    };
    (
        difference(&|x, y| track.row(x, y)),
        difference(&|x, y| track.slope_row(x, y)),
    )
}
