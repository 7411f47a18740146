//! The water: constant hydrostatic stiffness and added mass on the wetted bottom.
//!
//! Knows how a quantity per area is shared among the nodes of cells that are rectangles in plan; it acts in z alone. Does not know
//! the structure above.

use crate::fem::NodeId;
use crate::module::Grid;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How a quantity of the wetted surface is shared among the nodes of its elements.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum WaterDistribution {
    /// A quarter to each node of the element.
    #[default]
    Lumped,
    /// By the shape functions: `integral of N^T p N dS`.
    Consistent,
}

/// z of the bottom, as node pairs with their share of a quantity of `per_area` over the bottom between the places
/// `wet_m` along [11-12, 16-17]:
/// p_b `[Pa/m]` gives a stiffness `[N/m]`, an added mass per area `[kg/m^2]` a mass `[kg]`.
///
/// Consistent on a rectangle of area A: `A/36` times 4 on the diagonal, 2 between neighbours, 1 across; lumped: `A/4` on
/// the diagonal.
/// Equation (W2).
pub fn spread(
    grid: &Grid,
    wet_m: [f64; 2],
    per_area: f64,
    distribution: WaterDistribution,
) -> Vec<(NodeId, NodeId, f64)> {
    let mut entries = Vec::new();
    for (nodes, area) in grid.bottom_cells(wet_m) {
        let q = per_area * area;
        for a in 0..4 {
            match distribution {
                WaterDistribution::Lumped => entries.push((nodes[a], nodes[a], q / 4.0)),
                WaterDistribution::Consistent => {
                    for b in 0..4 {
                        let weight = [4.0, 2.0, 1.0, 2.0][(4 + b - a) % 4];
                        entries.push((nodes[a], nodes[b], q * weight / 36.0));
                    }
                }
            }
        }
    }
    entries
}
