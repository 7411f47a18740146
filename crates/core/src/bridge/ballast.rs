//! What lies on a bridge at rest, as a bridge file writes it.
//!
//! Knows weights and their places, and refuses those beside a deck. Does not know modules or nodes.

use crate::input::{InvalidInput, positive, within};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What lies on a bridge at rest.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DeadSpec {
    /// Ballast on decks.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub ballast: Vec<BallastSpec>,
}

/// A weight on the deck of a module, which moves with it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BallastSpec {
    /// The module, from 1.
    pub module: usize,
    /// Place along, from the module's left end `[m]`.
    pub x_m: f64,
    /// Place across `[m]`.
    pub y_m: f64,
    /// Weight `[N]`.
    pub weight_n: f64,
}

impl DeadSpec {
    /// Whether nothing lies there.
    pub fn is_empty(&self) -> bool {
        self.ballast.is_empty()
    }

    /// Refuses ballast beside its module; `lengths_m` are those of the modules.
    ///
    /// # Errors
    /// [`InvalidInput`] with the key's path.
    pub(super) fn check(&self, lengths_m: &[f64], half_breadth_m: f64) -> Result<(), InvalidInput> {
        for (i, ballast) in self.ballast.iter().enumerate() {
            let checked = || {
                let Some(&length_m) = ballast.module.checked_sub(1).and_then(|j| lengths_m.get(j)) else {
                    let allowed = format!("a module from 1 to {}", lengths_m.len());
                    return Err(InvalidInput::new("module", ballast.module, allowed));
                };
                within("x_m", ballast.x_m, 0.0, length_m)?;
                within("y_m", ballast.y_m, -half_breadth_m, half_breadth_m)?;
                positive("weight_n", ballast.weight_n)
            };
            checked().map_err(|e| e.under(&format!("dead.ballast[{i}]")))?;
        }
        Ok(())
    }
}
