//! Quantities of a reference: what they are, what of them can be refused, and their values on results.
//!
//! | module | charter |
//! |---|---|
//! | `spec` | their keys and types |
//! | `place` | what is refused by the file alone |
//! | `check_input` | what is refused by what results have |
//! | `evaluator` | their values on results |
//! | `history` | a history and what can be made of it |
//! | `no_value` | why there is no value |
//!
//! Knows tables, rows and filters. Does not know what a quantity should be.

mod check_input;
mod evaluator;
mod history;
mod no_value;
mod place;
mod spec;

pub(crate) use check_input::CheckInput;
pub(crate) use evaluator::Evaluator;
pub use history::{Along, Moments, moments_of};
pub use no_value::NoValue;
pub(crate) use place::Place;
pub use spec::{Edge, HistoryQuantity, HistoryReduction, Quantity, Reduction, SelectQuantity, Tolerance};
