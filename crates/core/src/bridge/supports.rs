//! Supports of the two ends: directions that do not move.
//!
//! Knows directions. Does not know nodes.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A direction of translation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Direction {
    /// Along the bridge.
    X,
    /// Across the bridge.
    Y,
    /// Up.
    Z,
}

/// Directions held at the two ends: z at all nodes of the bottom edge, x and y at its hinge places.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Supports {
    /// At the left end.
    pub left: Vec<Direction>,
    /// At the right end.
    pub right: Vec<Direction>,
}

impl Default for Supports {
    /// The paper's: all three translations at the left end, y and z at the right.
    fn default() -> Self {
        Self {
            left: vec![Direction::X, Direction::Y, Direction::Z],
            right: vec![Direction::Y, Direction::Z],
        }
    }
}
