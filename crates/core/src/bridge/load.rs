//! What vehicles at their places do to the track: weights on rows, masses that ride along, wheels on springs.
//!
//! Knows the weight and mass of points and patches, and rows. Does not know solvers or time.

use super::{Heading, Track, VehiclePlacement};
use crate::fem::SparseRow;
use crate::vehicle::{GRAVITY_M_S2, Inertia, Patch, Vehicle};

/// What rides along: the row on which its force acts, and what it is measured by.
#[derive(Debug, Clone)]
pub(crate) struct Rider {
    /// Vehicle and axle that it belongs to.
    pub vehicle: usize,
    pub axle: usize,
    /// r, where the force acts.
    pub row: SparseRow,
    /// What it is.
    pub rides: Rides,
}

/// What rides.
#[derive(Debug, Clone)]
pub(crate) enum Rides {
    /// A mass, measured by `r u'' + 2 V r_x u' + (V^2 r_xx + V' r_x) u`, the derivatives where convective.
    Mass {
        /// Mass `[kg]`.
        mass_kg: f64,
        /// r_x and r_xx.
        derivatives: Option<(SparseRow, SparseRow)>,
    },
    /// The spring of a wheel, measured by the height of deck and road under it.
    Spring {
        /// Number of the wheel in its vehicle.
        wheel: usize,
        /// r_x.
        slope: SparseRow,
    },
}

impl Rider {
    /// Whether its force enters the balance as a spring's, weighted as the displacement is, or as that of a mass, weighted as the
    /// acceleration.
    pub(crate) fn is_spring(&self) -> bool {
        matches!(self.rides, Rides::Spring { .. })
    }
}

/// Vehicles on the track at one instant.
#[derive(Debug, Clone, Default)]
pub(crate) struct Load {
    /// Where each vehicle is.
    pub placements: Vec<VehiclePlacement>,
    /// Downward force of the weights on each track column, as one row `[N]`.
    pub weight: SparseRow,
    /// What rides along, vehicle after vehicle.
    pub riders: Vec<Rider>,
    /// Weight of each axle of each vehicle that lies on the bridge `[N]`, and whether the contact force of all its points has settled.
    pub axles: Vec<Vec<(f64, bool)>>,
}

impl Load {
    /// A vehicle of weight `load_n` alone. A point off the bridge neither loads nor weighs.
    /// Equation (V1).
    pub(crate) fn new(track: &Track, vehicle: &Vehicle, load_n: f64, heading: Heading) -> Self {
        let mut load = Self::default();
        load.add(track, vehicle, load_n, heading, false);
        load
    }

    /// Adds a vehicle; its springs where it is `awake`.
    pub(crate) fn add(&mut self, track: &Track, vehicle: &Vehicle, load_n: f64, heading: Heading, awake: bool) {
        let (number, placement) = (self.placements.len(), VehiclePlacement::new(track, vehicle, heading));
        let mut axles = vec![(0.0, true); vehicle.axles];
        let mut weight = std::mem::take(&mut self.weight).0;
        for (wheel, patch) in vehicle.patches.iter().enumerate() {
            let rider = |row: SparseRow, rides: Rides| Rider {
                vehicle: number,
                axle: patch.axle,
                row,
                rides,
            };
            axles[patch.axle].1 &= placement.tells(patch);
            let mut mean: Vec<(usize, f64)> = Vec::new();
            for point in &patch.points {
                let Some(row) = placement.row(track, point) else {
                    continue;
                };
                mean.extend(row.0.iter().map(|&(c, v)| (c, v * point.share)));
                if patch.rigid == 0.0 {
                    continue;
                }
                let w = load_n * (point.share * patch.rigid);
                axles[patch.axle].0 += w;
                weight.extend(row.0.iter().map(|&(c, v)| (c, v * w)));
                if vehicle.inertia == Inertia::Local {
                    let mass_kg = w / GRAVITY_M_S2;
                    let derivatives = None;
                    self.riders.push(rider(row, Rides::Mass { mass_kg, derivatives }));
                }
            }
            let share_on = placement.share_on(patch);
            if vehicle.inertia == Inertia::Convective && patch.rigid > 0.0 && share_on > 0.0 {
                let scaled = mean.iter().map(|&(c, v)| (c, v / share_on)).collect();
                let rides = Rides::Mass {
                    mass_kg: load_n * (share_on * patch.rigid) / GRAVITY_M_S2,
                    derivatives: Some(derivatives(track, patch, &placement)),
                };
                self.riders.push(rider(SparseRow::from_entries(scaled), rides));
            }
            if vehicle.springs.is_some() && awake {
                // points off the bridge stand on a road that does not move
                let scaled = mean.into_iter().map(|(c, v)| (c, v / patch.share)).collect();
                let rides = Rides::Spring {
                    wheel,
                    slope: mean_slope(track, patch, &placement),
                };
                self.riders.push(rider(SparseRow::from_entries(scaled), rides));
            }
        }
        self.weight = SparseRow::from_entries(weight);
        self.axles.push(axles);
        self.placements.push(placement);
    }

    /// Where the only vehicle is.
    pub(crate) fn placement(&self) -> &VehiclePlacement {
        &self.placements[0]
    }
}

/// r_x of a wheel on springs: the mean slope under its points, none of those off the bridge.
fn mean_slope(track: &Track, patch: &Patch, placement: &VehiclePlacement) -> SparseRow {
    let slopes = patch.points.iter().filter_map(|point| {
        let cell = placement.cell(point.along)?;
        Some((point.share / patch.share, track.slope_row_in(cell, point.y_m)))
    });
    let slopes: Vec<(f64, SparseRow)> = slopes.collect();
    SparseRow::combine(&slopes.iter().map(|(share, row)| (*share, row)).collect::<Vec<_>>())
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
