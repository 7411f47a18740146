//! JSON documents: strict reading, typed reading, values at a path.
//!
//! Knows JSON and where in it something stands. Does not know what any key means.

mod path;
mod pretty;
mod spot;
#[cfg(test)]
mod spot_tests;
mod strict;
mod typed;

pub use path::{DocumentPath, leaves};
pub use pretty::pretty;
pub use spot::{Spot, SpotKind, spot};
pub use strict::{canonical, canonical_text, read};
pub use typed::typed;
