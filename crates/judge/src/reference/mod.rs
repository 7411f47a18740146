//! The reference file: checks with their source, to hold results against.
//!
//! Knows what a person may write and refuses what cannot be a check, whatever the results. Does not know results.

mod file;
mod measured;
mod spec;

pub use file::Reference;
pub use measured::{Against, MeasuredOf, MeasuredSpec};
pub use pontoon_plan::input::filter::{Allowed, Filter};
pub use spec::{
    BoundCheck, CheckKind, CheckSpec, CurveCheck, Edge, HistoryQuantity, HistoryReduction, MeasuredCheck, ModeCheck,
    Quantity, Reduction, ReferenceSpec, Role, SelectQuantity, Tolerance, Trend, TrendCheck, ValueCheck,
};
