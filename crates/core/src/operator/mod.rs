//! The bridge operator: what never changes between the crossings of one bridge, taken out of the loop.
//!
//! Knows the modes of the connector-free bridge, the flexibility that they leave out, and how many crossings step through
//! them side by side, one a SIMD lane. Does not know when a crossing begins or ends; what is kept of
//! one is for `envelope`.
//!
//! `u = Phi q + K^-1 (what the modes leave out)`: the modes obey `q'' + (a omega^2 + b) q' + omega^2 q = Phi^T f`, the
//! rest answers without mass, `K (u + a u') = f`, which leaves residual flexibilities R between connectors B, deck L and
//! observed rows V. [`BridgeOperator`] holds them, `StepConstants` what one step length makes of them,
//! `WheelLines` what vehicles see of the deck, `Crossings` the motion.

mod active_sets;
mod basis;
mod clock;
mod columns;
mod connectors;
mod contact_step;
mod contact_system;
mod corner_panel;
mod corners;
mod crossings;
mod cutoff;
mod dashpots;
mod dead;
mod deck_forces;
mod energy;
mod envelope;
mod lane;
mod lane_array;
mod lane_group;
mod lane_waves;
mod line_mass;
mod listed_links;
mod loads;
mod local_residual;
mod modes;
mod moving_masses;
mod panel;
mod parts;
mod persist;
mod pin_rows;
mod pins;
mod placed;
mod residual;
mod residual_rows;
mod rider_block;
mod rides;
mod riding_places;
mod side;
mod small_matrix;
mod state_bounds;
mod step;
mod step_constants;
mod sums;
mod vector;
mod waves;
mod wheel_lines;

pub use basis::{BridgeOperator, Followed, OperatorError};
pub use clock::{StepClock, StepPart};
pub(crate) use crossings::Crossings;
pub use cutoff::Cutoff;
pub(crate) use lane::CrossingInput;
pub use panel::InstructionPath;
pub use parts::OperatorParts;
pub use persist::SOURCES;
pub(crate) use side::{SideBridge, SideLinks, one_side};
pub(crate) use step::step;
pub(crate) use step_constants::StepConstants;
pub use waves::WaveStates;
pub(crate) use wheel_lines::{WheelCompliance, WheelLines};
