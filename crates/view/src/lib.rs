//! What people look at: reports, figures, exports.
//!
//! | module | charter |
//! |---|---|
//! | [`asked`] | what a study asks of limits, in words |
//! | [`class_table`] | which vehicle may cross how |
//! | `thinning` | a few places that stand for many |
//! | [`figures`] | what a paper would draw of results, as numbers, with the points of a reference beside them |
//! | [`drawing`] | figures as SVG and PNG, with their captions |
//! | [`report`] | what a page tells of results |
//! | [`page`] | the page of a report, whole |
//! | [`export`] | mode shapes, static cases and crossings as grids for ParaView |
//!
//! Knows results, verdicts and how they are shown. Does not know terminals or the words of the command line.

pub mod asked;
pub mod class_table;
pub mod drawing;
pub mod export;
pub mod figures;
pub mod page;
pub mod report;
pub(crate) mod thinning;
