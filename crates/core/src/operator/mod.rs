//! The bridge operator: what never changes between the crossings of one bridge, taken out of the loop.
//!
//! Knows the modes of the connector-free bridge, the flexibility that they leave out, and how many crossings step through
//! them side by side, one a SIMD lane. Does not know when a crossing begins or ends; what is kept of
//! one is for `watch`.
//!
//! `u = Phi q + K^-1 (what the modes leave out)`: the modes obey `q'' + (a omega^2 + b) q' + omega^2 q = Phi^T f`, the
//! rest answers without mass, `K (u + a u') = f`, which leaves residual flexibilities R between connectors B, deck L and
//! observed rows V. [`BridgeOperator`] holds them, `Level` what one step length makes of them, `Wheels` what a
//! vehicle sees of the deck, `Lanes` the motion.

mod basis;
mod beside;
mod cutoff;
mod lane;
mod lanes;
mod level;
mod motion;
mod panel;
mod parts;
mod riders;
mod settle;
mod step;
mod sums;
mod vector;
mod watch;
mod wheels;

pub use basis::{BridgeOperator, OperatorError};
pub use cutoff::Cutoff;
pub(crate) use lane::Passage;
pub(crate) use lanes::Lanes;
pub(crate) use level::Level;
pub use panel::InstructionPath;
pub use parts::{OperatorParts, SOURCES};
pub(crate) use settle::Unsettled;
pub(crate) use step::step;
pub(crate) use wheels::{Ride, Wheels};
