//! The bridge operator beside the reference solver: the same crossings through both, and how far apart their answers are.
//!
//! Knows both solvers and the scales of what they answer. Does not know which differences are expected.

use crate::{Ready, SingleCrossing, SolvesSingle, apart, largest};
use pontoon_core::analysis::AnalysisError;
use pontoon_core::analysis::crossing::{CrossingSettings, CrossingSolver, OperatorSolver};
use pontoon_core::operator::BridgeOperator;
use pontoon_core::response::{CrossingResponse, ForcePeaks, Peak, Quantity};
use pontoon_core::vehicle::{Axle, Body, Inertia, Vehicle, VehicleDesign};
use std::sync::Arc;

/// Both solvers of one bridge at one time step.
pub struct Both {
    /// By direct integration.
    pub reference: CrossingSolver,
    /// Through the operator.
    pub operated: OperatorSolver,
}

impl Both {
    /// Makes both ready.
    ///
    /// # Panics
    /// Where the reference solver cannot be made.
    pub fn new(ready: &Ready, operator: &Arc<BridgeOperator>, settings: &CrossingSettings) -> Self {
        Self {
            reference: CrossingSolver::new(&ready.bridge, settings).expect("crossings"),
            operated: OperatorSolver::new(&ready.bridge, operator, settings),
        }
    }

    /// The operator's answer and the reference solver's.
    ///
    /// # Errors
    /// Either's.
    pub fn solve(&self, vehicle: &Vehicle, crossing: &SingleCrossing) -> Result<[CrossingResponse; 2], AnalysisError> {
        let operated = self.operated.solve_single(vehicle, crossing)?;
        Ok([operated, self.reference.solve_single(vehicle, crossing)?])
    }
}

/// The operator of a bridge.
///
/// # Panics
/// Where there is none.
pub fn operator(ready: &Ready, tolerance: f64) -> Arc<BridgeOperator> {
    Arc::new(BridgeOperator::new(&ready.bridge, tolerance).expect("an operator"))
}

/// Axles on tracks of their own, each with its patch's length and width: distance behind the front, share, length, width,
/// places across.
///
/// # Panics
/// Where they are no vehicle on the usual deck.
pub fn wide_axles(list: &[(f64, f64, f64, f64, [f64; 2])], inertia: Inertia, patch_points: usize) -> Vehicle {
    let axle =
        |&(behind_front_m, share, patch_length_m, patch_width_m, track_y_m): &(f64, f64, f64, f64, [f64; 2])| Axle {
            behind_front_m,
            share: Some(share),
            patch_length_m,
            patch_width_m,
            track_y_m: track_y_m.to_vec(),
            ..Axle::default()
        };
    let design = VehicleDesign {
        axles: Some(list.iter().map(axle).collect()),
        inertia,
        patch_points,
        ..VehicleDesign::default()
    };
    design.check(8.082).expect("a vehicle")
}

/// A truck of 132.3 kN: two axles 4.5 m apart on springs and tyres, its suspensions multiplied by `factor`; what else it is to have is
/// changed in it and in each axle.
///
/// # Panics
/// Where it is no vehicle on the usual deck.
pub fn sprung_truck(factor: f64, change: impl FnOnce(&mut VehicleDesign), change_axle: impl Fn(&mut Axle)) -> Vehicle {
    let axle = |behind_front_m: f64, mass: f64, suspension: [f64; 2], tyre: [f64; 2]| {
        let mut axle = Axle {
            behind_front_m,
            patch_length_m: 0.3,
            unsprung_mass_kg: Some(mass),
            suspension_stiffness_n_m: Some(factor * suspension[0]),
            suspension_damping_n_s_m: Some(suspension[1]),
            tyre_stiffness_n_m: Some(tyre[0]),
            tyre_damping_n_s_m: Some(tyre[1]),
            ..Axle::default()
        };
        change_axle(&mut axle);
        axle
    };
    let mut design = VehicleDesign {
        axles: Some(vec![
            axle(0.0, 600.0, [4e5, 1e4], [1.5e6, 3e3]),
            axle(4.5, 1000.0, [1e6, 2e4], [3e6, 6e3]),
        ]),
        body: Some(Body {
            mass_kg: 11_890.8,
            behind_front_m: 2.940,
            pitch_inertia_kg_m2: Some(5e4),
            roll_inertia_kg_m2: Some(1.2e4),
            height_m: Some(1.4),
        }),
        patch_points: 4,
        ..VehicleDesign::default()
    };
    change(&mut design);
    design.check(8.082).expect("a truck")
}

/// How far two answers are apart, each kind over its largest value in the second.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Apart {
    /// Deflections and uplifts of all positions.
    pub deflection: f64,
    /// Compression and tension of all joints and all connectors.
    pub force: f64,
    /// The deck's edges.
    pub edge: f64,
    /// Roll, over the largest deflection per breadth of 8.082 m where that is more.
    pub roll: f64,
    /// Trim of a module.
    pub trim: f64,
    /// Smallest contact force, over the load.
    pub contact: f64,
    /// Histories of deflections and of forces.
    pub history: f64,
}

impl Apart {
    /// Of two answers to crossings under `load_n`.
    pub fn of(found: &CrossingResponse, expected: &CrossingResponse, load_n: f64) -> Self {
        let scale_m = largest(deflections(expected));
        let [roll, trim] = [
            [found.peak_roll.value, expected.peak_roll.value],
            [found.peak_trim.value, expected.peak_trim.value],
        ]
        .map(|[found, expected]| (found - expected).abs());
        Self {
            deflection: over_largest(&deflections(found), &deflections(expected)),
            force: over_largest(&forces(found), &forces(expected)),
            edge: (found.peak_edge.value - expected.peak_edge.value).abs() / expected.peak_edge.value,
            roll: roll / expected.peak_roll.value.max(scale_m / 8.082),
            trim: trim / expected.peak_trim.value,
            contact: (found.least_contact.force_n - expected.least_contact.force_n).abs() / load_n,
            history: largest([Quantity::Deflection, Quantity::Force].map(|quantity| {
                let [found, expected] = [found, expected].map(|r| curve(r, quantity));
                over_largest(&found, &expected)
            })),
        }
    }

    /// The largest of them.
    pub fn most(&self) -> f64 {
        largest([
            self.deflection,
            self.force,
            self.edge,
            self.roll,
            self.trim,
            self.contact,
            self.history,
        ])
    }
}

/// As `apart`, and 0 where both are nothing but zeros.
fn over_largest(found: &[f64], expected: &[f64]) -> f64 {
    if found == expected { 0.0 } else { apart(found, expected) }
}

/// Peaks of all positions, deflection and uplift in turn `[m]`.
pub fn deflections(r: &CrossingResponse) -> Vec<f64> {
    let of = |p: &[Peak; 2]| [p[0].value, p[1].value];
    r.positions.iter().flat_map(|p| of(&[p.deflection, p.uplift])).collect()
}

/// Peaks of all joints and their connectors, compression and tension in turn `[N]`.
pub fn forces(r: &CrossingResponse) -> Vec<f64> {
    let of = |p: &ForcePeaks| [p.compression.value, p.tension.value];
    let joints = r.joints.iter();
    joints
        .flat_map(|j| {
            std::iter::once(&j.sum)
                .chain(j.connectors.iter().map(|(_, p)| p))
                .flat_map(of)
        })
        .collect()
}

/// All recorded histories of a quantity, one after the other.
pub fn curve(r: &CrossingResponse, quantity: Quantity) -> Vec<f64> {
    let of = r.recorded.histories.iter().filter(|h| h.subject.quantity() == quantity);
    of.flat_map(|h| h.values.iter().copied()).collect()
}

/// A row of numbers between 0 and 1 that is always the same.
pub struct Numbers(u64);

impl Numbers {
    /// Begins at a seed that is not 0.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// The next between `from` and `to`.
    pub fn between(&mut self, from: f64, to: f64) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        from + (to - from) * (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}
