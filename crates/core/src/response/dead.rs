//! What a bridge does at rest under its dead load: the state from which static cases and crossings count.
//!
//! Knows numbers. Does not know how they were computed.

use super::Equilibrium;

/// A bridge at rest under its dead load: ballast, dry parts, preloads, a risen river.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct DeadState {
    /// Displacement of each dof of the bridge.
    pub displacements: Vec<f64>,
    /// Elongation of each link, connectors first, then one-sided springs of banks `[m]`.
    pub elongations_m: Vec<f64>,
    /// Force of each link, tension positive `[N]`.
    pub forces_n: Vec<f64>,
    /// Force of each pin on the module left of it, along, across and up `[N]`.
    pub pins_n: Vec<[f64; 3]>,
    /// Motion of each spring that holds both ways, along its sense `[m]`.
    pub springs_m: Vec<f64>,
    /// Deflection of each position, positive downward `[m]`.
    pub deflection_m: Vec<f64>,
    /// How far each corner of the modules' decks, then of their bottoms, has risen against the water `[m]`: module after
    /// module, left and right end, lower and higher y.
    pub deck_corners_m: Vec<f64>,
    /// As the deck's.
    pub bottom_corners_m: Vec<f64>,
    /// Each module.
    pub modules: Vec<ModuleAtRest>,
    /// Force of each bank's spring on the bridge along its sense: bank, place across `[m]`, force `[N]`.
    pub banks: Vec<(usize, f64, f64)>,
    /// What carries the dead load.
    pub equilibrium: Equilibrium,
}

/// How a module floats at rest.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ModuleAtRest {
    /// How far the middle of its deck has gone down `[m]`.
    pub sinkage_m: f64,
    /// Trim, positive where its right end is higher `[rad]`.
    pub trim_rad: f64,
    /// Heel, positive where the side of higher y is higher `[rad]`.
    pub heel_rad: f64,
}
