//! How a module is condensed to a super-element, as a bridge file writes it.
//!
//! Knows defaults. Does not know matrices.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Masters and modes of the super-element. Hinges, connectors, the deck's z and the ends' bottom edges are always
/// masters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Condensation {
    /// Fixed-master modes kept (Craig-Bampton); 0 is Guyan's condensation.
    #[serde(default = "default_fixed_master_modes")]
    pub fixed_master_modes: usize,
    /// Whether z of all bottom nodes, which carry the water, are masters too.
    #[serde(default)]
    pub bottom_masters: bool,
    /// Whether x of the bottom at the connectors' places of both ends are masters, as in every row of unlike depths, whose
    /// connectors reach below a deck.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub end_masters: bool,
}

fn default_fixed_master_modes() -> usize {
    16
}

impl Default for Condensation {
    fn default() -> Self {
        Self {
            fixed_master_modes: default_fixed_master_modes(),
            bottom_masters: false,
            end_masters: false,
        }
    }
}
