//! The study file and the bridge file that it names: their keys, defaults and ranges.
//!
//! Knows what a person may write and where it is relative to. Does not know what a job is or how it runs.

mod analysis;
mod study;

pub use analysis::{AnalysisSpec, DampingSpec, Kind, ModelSpec, SolverSpec, TimeStepSpec, VerifySpec};
pub(crate) use study::check_histories;
pub use study::{BridgeFile, HistoriesSpec, RecordSpec, Study, StudySpec, filled_vehicle, read_bridge};
