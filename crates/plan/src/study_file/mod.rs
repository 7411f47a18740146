//! The study file and the bridge and vehicle files that it names: their keys, defaults and ranges.
//!
//! | module | charter |
//! |---|---|
//! | `raw` | a study as its file writes it |
//! | `rated` | a study as a table of classes asks it |
//! | `limits` | how far a bridge may go in a crossing |
//! | `find` | which values a rating tries |
//! | `analysis` | what is asked, checked, with its defaults |
//! | `study` | a study opened: its files read, its own numbers checked |
//! | `record` | what is kept of each job beyond its peaks |
//! | `vehicle_files` | vehicle files that a study names, put in their place |
//! | `wear` | how the gaps of joints scatter |
//!
//! Knows what a person may write and where it is relative to. Does not know what a job is or how it runs.

mod analysis;
mod find;
mod limits;
mod rated;
mod raw;
mod record;
mod study;
mod vehicle_files;
mod wear;

pub use analysis::{Analysis, CrossingAnalysis, ModesAnalysis, Solver, StaticAnalysis, TimeStep};
pub use find::{Find, FindSpec};
pub use limits::{Allowed, Limit, LimitsSpec};
pub use raw::{AnalysisSpec, DampingSpec, Kind, ModelSpec, SolverSpec, StructureDamping, StudySpec, VerifySpec};
pub use record::{HistoriesSpec, PeakAt, PeakColumn, PeakSpec, RecordSpec};
pub use study::{BridgeFile, Study, bridge_of, filled_vehicle, read_bridge};
pub(crate) use vehicle_files::at_home;
pub use vehicle_files::{VehicleFile, read_vehicle};
pub use wear::{ScatterSpec, WearSpec};
