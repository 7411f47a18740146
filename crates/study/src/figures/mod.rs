//! Figures of results: what a paper would draw, as numbers.
//!
//! | module | charter |
//! |---|---|
//! | `marks` | points of a reference that are drawn beside results |
//!
//! Knows which curves belong together, their units and their legends. Does not know how a figure is drawn or where it
//! is written.

mod marks;

pub use marks::{Chart, Mark, Origin, marks};
