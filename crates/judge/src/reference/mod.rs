//! The reference file: checks with their source, to hold results against, and points that were measured.
//!
//! Knows what a person may write and refuses what cannot be a check, whatever the results. Does not know results.

mod file;
mod measured;

pub use file::{Reference, ReferenceSpec};
pub use measured::{Against, MeasuredOf, MeasuredSpec};
