//! JSON documents: strict reading, typed reading, values at a path, filters; what a refusal looks like.
//!
//! Knows JSON and where in it something stands. Does not know what any key means.

pub mod filter;
mod path;
mod pretty;
mod refusal;
mod spot;
#[cfg(test)]
mod spot_tests;
mod strict;
mod typed;

pub use path::{DocumentPath, leaves};
pub use pretty::pretty;
pub use refusal::{Refusal, nearest};
pub use spot::{Spot, SpotKind, spot};
pub(crate) use strict::canonical;
pub use strict::{canonical_text, read, text_and_hash};
pub use typed::{to_value, typed};
