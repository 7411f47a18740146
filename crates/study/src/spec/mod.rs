//! The study file: its keys, its designs, the points they expand to.
//!
//! Knows what a person may write and where it is relative to. Does not know what a job is or how it runs.

mod analysis;
mod axes;
mod block;
mod condition;
mod design;
mod points;
mod sampling;
mod study;
#[cfg(test)]
mod tests;
mod values;

pub use analysis::{AnalysisSpec, DampingSpec, Kind, ModelSpec, SolverSpec, TimeStepSpec, VerifySpec};
pub use axes::{Axis, AxisName, SHORT_NAMES};
pub use block::Block;
pub use condition::{Condition, Conditions, Relation};
pub use design::{AxisMap, Design, Form, RangeMap, SampleSpec};
pub use points::Point;
pub use study::{BridgeFile, HistoriesSpec, RecordSpec, Study, StudySpec, read_bridge};
pub(crate) use study::{check_histories, filled_vehicle, text_and_hash, to_value};
