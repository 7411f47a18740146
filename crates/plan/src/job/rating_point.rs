//! The point of a design that a rating is of.
//!
//! Knows what values tried depend on. Does not know how a job is made of it.

use crate::input::Cell;
use std::sync::Arc;

/// The point of a design that a rating is of.
#[derive(Debug, Clone, PartialEq)]
pub struct RatingPoint {
    /// The number of its block.
    pub(super) block: usize,
    /// Its number in the block, and its values.
    pub(super) number: usize,
    pub(super) values: Vec<Cell<'static>>,
    /// Everything that the values tried depend on beside the point.
    pub(super) search: Arc<str>,
    /// Crossings that it takes at least.
    pub(super) crossings: usize,
}
