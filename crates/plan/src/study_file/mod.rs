//! The study file and the bridge file that it names: their keys, defaults and ranges.
//!
//! | module | charter |
//! |---|---|
//! | `raw` | a study as its file writes it |
//! | `analysis` | what is asked, checked, with its defaults |
//! | `study` | a study opened: its files read, its own numbers checked |
//! | `wear` | how the gaps of joints scatter |
//!
//! Knows what a person may write and where it is relative to. Does not know what a job is or how it runs.

mod analysis;
mod raw;
mod study;
mod wear;

pub use analysis::{Analysis, CrossingAnalysis, ModesAnalysis, Solver, StaticAnalysis, TimeStep};
pub use raw::{
    AnalysisSpec, DampingSpec, HistoriesSpec, Kind, ModelSpec, RecordSpec, SolverSpec, StudySpec, VerifySpec,
};
pub(crate) use study::check_histories;
pub use study::{BridgeFile, Study, filled_vehicle, read_bridge};
pub use wear::{ScatterSpec, WearSpec};
