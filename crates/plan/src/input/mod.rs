//! JSON documents: strict reading, typed reading, values at a path, filters; what a refusal is, and where in a text its place
//! is.
//!
//! | module | charter |
//! |---|---|
//! | `document` | a file read as one document: its canonical text |
//! | `strict` | a text made canonical; what makes it no JSON, and where |
//! | `typed`, `reader`, `trouble` | a document read as a type; how its text is gone through; what a type does not take |
//! | `path` | paths into a document |
//! | `cell` | a value of an axis or of a table |
//! | [`filter`] | which rows or points are meant |
//! | `refusal`, `span` | what is wrong, and in words; its bytes in the text |
//! | `pretty` | a document as a person would write it |
//!
//! Knows JSON and where in it something stands. Does not know what any key means.

mod cell;
mod document;
pub mod filter;
mod path;
mod pretty;
mod reader;
mod refusal;
mod span;
#[cfg(test)]
mod span_tests;
mod strict;
mod trouble;
mod typed;

pub use cell::Cell;
pub use document::{Document, canonical_text, without_mark};
pub(crate) use path::join;
pub use path::{DocumentPath, Obstacle, leaves};
pub use pretty::pretty;
pub use refusal::{FoundValue, Refusal, RefusalKind, nearest};
pub use span::{Mark, MarkKind, mark};
pub(crate) use strict::canonical;
pub use typed::{to_value, typed, typed_value};
