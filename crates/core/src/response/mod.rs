//! What a crossing or a static case leaves behind: peaks, envelopes, histories, the energy balance.
//!
//! Knows numbers and where and when they occurred. Does not know how they were computed.

mod dead;
mod energy;
mod histories;
mod peaks;
mod recorder;
mod ride;
mod rides;
mod subject;

pub use dead::{DeadState, ModuleAtRest};
pub use energy::{EnergyBalance, EnergySummary, StepEnergies};
pub use histories::History;
pub use peaks::{
    AxlePlace, BankPeaks, ForcePeaks, JointForces, JointPeaks, LeastContact, Peak, PinExtremes, PinPeaks, PlacePeaks,
    PlacedPeak, PositionPeaks, SectionPeaks, resultant_n,
};
pub(crate) use recorder::Recorder;
pub use recorder::{AtPeak, PeakOf, Record, Recorded, WatchedPeak};
pub use ride::BodyMotion;
pub(crate) use ride::RideReading;
pub(crate) use rides::RidePart;
pub use rides::{MotionPeaks, WheelPeaks};
use std::sync::Arc;
pub use subject::{Axis, Quantity, SECTIONS, Section, Subject};
pub(crate) use subject::{BankPart, BankSource, JointParts, JointReading, Reading};

/// Counts of what the solver did.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Statistics {
    /// Time steps taken, bisected ones counted as taken.
    pub steps: usize,
    /// Newton solutions over all steps.
    pub newton_iterations: usize,
    /// Trusses that changed between open and working from one step to the next.
    pub contact_switches: usize,
    /// Steps that had to be halved.
    pub bisections: usize,
}

/// The response to one crossing.
#[derive(Debug, Clone, PartialEq)]
pub struct CrossingResponse {
    /// Peaks of each position 1 to modules + 1, in order.
    pub positions: Vec<PositionPeaks>,
    /// Peaks of each joint 2 to modules, in order.
    pub joints: Vec<JointPeaks>,
    /// Peaks of the pins of each joint, then of their sum, at the instants of the balance; empty where they were not asked for.
    pub pins: Vec<PinPeaks>,
    /// Largest downward deflection of the deck's two edges `[m]`, at a position: inside a module that of the nearer end, in its
    /// middle that of the left one.
    pub peak_edge: PlacedPeak,
    /// Largest roll of a module end, either sense `[rad]`, at the end's position.
    pub peak_roll: PlacedPeak,
    /// Largest trim of a module, either sense `[rad]`, and which module: `(z_right - z_left) / length`, z being the mean height of
    /// the deck's two corners at an end, in the motion from rest.
    pub peak_trim: PlacedPeak,
    /// Smallest contact force of an axle while all its points are on the bridge.
    pub least_contact: LeastContact,
    /// Whether a corner of a module's bottom rose above the water; unknown without a draft.
    pub bottom_emerged: Option<bool>,
    /// Whether a corner of a module's deck went below the water; unknown without a freeboard.
    pub deck_submerged: Option<bool>,
    /// What the solver did.
    pub statistics: Statistics,
    /// The energy balance.
    pub energy: EnergySummary,
    /// What else was recorded.
    pub recorded: Recorded,
}

impl CrossingResponse {
    /// The position with the largest deflection (the first of equals).
    pub fn peak_deflection(&self) -> PositionPeaks {
        largest(&self.positions, |p| p.deflection.value)
    }

    /// The position with the largest uplift (the first of equals).
    pub fn peak_uplift(&self) -> PositionPeaks {
        largest(&self.positions, |p| p.uplift.value)
    }
}

/// The first entry with the largest key. The list is never empty.
fn largest<T: Copy>(list: &[T], key: impl Fn(&T) -> f64) -> T {
    let mut best = list[0];
    for &entry in &list[1..] {
        if key(&entry) > key(&best) {
            best = entry;
        }
    }
    best
}

/// The response to one static case.
#[derive(Debug, Clone, PartialEq)]
pub struct StaticResponse {
    /// Deflection of each position 1 to modules + 1, positive downward `[m]`.
    pub deflection_m: Vec<f64>,
    /// Forces of each joint 2 to modules, in order.
    pub joints: Vec<JointForces>,
    /// Force of each pin on the module left of it, along, across and up, joint after joint `[N]`.
    pub pins_n: Vec<[f64; 3]>,
    /// Angle and section forces of each joint in the order of [`Section::ALL`].
    pub sections: Vec<[f64; SECTIONS]>,
    /// Deflection of each place asked for, positive downward `[m]`.
    pub places_m: Vec<f64>,
    /// Deflection of each corner of the modules' decks, see [`DeadState::deck_corners_m`] `[m]`.
    pub corners_m: Vec<f64>,
    /// Force of each bank's spring on the bridge along its sense: bank, place across `[m]`, force `[N]`.
    pub banks: Vec<(usize, f64, f64)>,
    /// Largest downward deflection of the deck's two edges `[m]`.
    pub peak_edge_deflection_m: f64,
    /// Largest roll of a module end, either sense `[rad]`.
    pub peak_roll_rad: f64,
    /// Distance between the first zero crossings of the deflection left and right of the load, along the centre line
    /// at the bottom `[m]`; the support where there is none.
    pub influential_length_m: f64,
    /// As for a crossing.
    pub bottom_emerged: Option<bool>,
    /// As for a crossing.
    pub deck_submerged: Option<bool>,
    /// Newton solutions.
    pub newton_iterations: usize,
    /// What carries the load and the dead load.
    pub equilibrium: Equilibrium,
    /// The state at rest from which deflections are counted, where the bridge has a dead load.
    pub dead: Option<Arc<DeadState>>,
}

/// Resultants about the origin (left end, centre line) in a static case: force up `[N]`, moment about x `[N m]` and about
/// y `[N m]`. Load, water, supports and banks sum to zero.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Equilibrium {
    /// The vehicle's weight, and what lies on the bridge.
    pub load: [f64; 3],
    /// The water's answer, that of a risen river included.
    pub water: [f64; 3],
    /// The supports' answer.
    pub supports: [f64; 3],
    /// The banks' answer.
    pub banks: [f64; 3],
}
