//! The contract between who writes results and who reads them.
//!
//! | module | charter |
//! |---|---|
//! | `record`, `limit_rows` | all rows of one job |
//! | `failure` | why a job failed |
//! | `preparation`, `verification`, `outcome` | what a run leaves behind beside its records |
//! | `quantities` | the words of recorded numbers |
//! | `registry` | the columns of all tables, one entry each |
//! | [`labels`] | what columns are called, and the digits of a number |
//! | `varying` | which axes vary |
//! | `layout` | which tables a study leaves, and their rows from records |
//! | `arrays` | the few types of columns, filled one after the other |
//! | `arrow` | tables as arrays in memory |
//! | `job_numbers` | numbers of some columns of the table of jobs |
//! | `frame` | rows as arrays of the table library, to Parquet and back |
//! | `parquet`, `writer`, `summary` | tables under way; the summary |
//! | `exceedance` | which share of jobs exceeds each limit |
//! | `indices` | indices of sensitivity of a study's outputs |
//! | `sobol_indices`, `elementary_effects`, `resampling` | their estimators, and intervals by the bootstrap |
//! | `manifest`, `moment`, `files` | what ran, where, when; names of files |
//! | `table`, `results`, `documents`, `results_error` | tables to read; the documents that they are of; why they cannot be read |
//!
//! Knows columns, provenance, and how a folder proves to be whole. Does not know how a record came about. The only crate that
//! knows the table library. Tables hold nothing that changes from run to run; the manifest does.

mod arrays;
mod arrow;
mod documents;
#[cfg(test)]
mod drawn_block;
mod elementary_effects;
mod exceedance;
mod extreme;
mod failure;
mod files;
mod frame;
mod indices;
mod job_numbers;
pub mod labels;
mod layout;
mod limit_rows;
mod manifest;
mod memory;
mod moment;
mod outcome;
mod parquet;
mod preparation;
mod quantities;
mod record;
mod registry;
mod resampling;
mod rest_rows;
mod results;
mod results_error;
mod sobol_indices;
mod summary;
mod table;
mod varying;
mod vehicle_rows;
mod verification;
mod writer;

pub use arrays::CellKind;
pub use arrow::{ArrowTable, MemoryTables};
pub use documents::{RunDocuments, keep_documents};
pub use elementary_effects::{MorrisIndex, MorrisOutputs};
pub use exceedance::Exceedance;
pub use extreme::Extreme;
pub use failure::{Failure, FailureKind};
pub use files::{OwnFiles, PAGE, replaceable};
pub use indices::{DesignIndices, FactorIndex, FactorIndices, FactorPair, Indices, OutputIndices};
pub use job_numbers::{JobNumbers, NoNumbers};
pub use limit_rows::{LimitRow, governing};
pub use manifest::{DocumentPlace, Manifest, SessionNote, check_own};
pub use memory::too_large;
pub use moment::Moment;
pub use outcome::{Cause, Failures, Outcome};
pub use parquet::TableProvenance;
pub use preparation::{BridgeReport, OperatorCounts, Preparation, WaterReport};
pub use quantities::{DEAD_QUANTITIES, QUANTITIES, SECTION_QUANTITIES};
pub use record::{
    AtPeakRow, BankRow, ConnectorRow, HistoryRows, HistorySeries, JobRecord, ModeRow, NumberPlace, PinRow, PlaceRow,
    PositionRow, SectionRow, Summary,
};
pub use registry::{
    COLUMNS, Card, Column, ColumnRole, Curve, Digits, STATIC_PEAK_COLUMNS, SpeedFigure, When, registered,
};
pub use resampling::Resampling;
pub use rest_rows::{DeadRow, FreeboardRow};
pub use results::Results;
pub use results_error::ResultsError;
pub use sobol_indices::{PairIndex, SaltelliOutputs, SobolIndex};
pub use summary::{DoubtfulRatings, SummaryTable};
pub use table::{ColumnKind, Table, TableName};
pub use varying::Seen;
pub use verification::Verification;
pub use writer::TableWriter;

/// Version of this program, as tables and manifests carry it.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");
pub use vehicle_rows::{BodyRow, WheelRow};
