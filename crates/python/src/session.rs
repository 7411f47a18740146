//! Studies that a Python program asks without a file.
//!
//! Knows how a study in JSON becomes tables in memory. Does not know its keys, nor how it is solved.

use crate::bridge::BridgeDocument;
use crate::errors::{failed, refused};
use crate::table::EngineTable;
use crate::waiting::{Watched, wait};
use pontoon_plan::input::{Document, Refusal};
use pontoon_plan::job::{Job, Jobs, PointJobs};
use pontoon_plan::study_file::{BridgeFile, Study};
use pontoon_results::{ArrowTable, MemoryTables, STATIC_PEAK_COLUMNS, TableName};
use pontoon_study::run::{Cache, SessionError, SessionSetting, SolveSession};
use pyo3::prelude::*;
use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// What is kept from call to call.
#[pyclass(frozen, module = "pontoon._engine")]
pub(crate) struct Session {
    session: SolveSession,
}

/// Why a study left no tables.
enum Unsolved {
    Refused(Refusal),
    Session(SessionError),
    Tables(io::Error),
}

/// What a study left.
struct Solved {
    tables: BTreeMap<TableName, ArrowTable>,
    /// The row of each point, where those were asked for.
    rows: Option<Vec<usize>>,
    /// Seconds in which jobs were solved.
    solved_s: f64,
}

#[pymethods]
impl Session {
    #[new]
    fn new() -> Self {
        Self {
            session: SolveSession::new(Cache::of_user()),
        }
    }

    /// Solves a study: its tables by their names. `name` stands for the study's file in messages. The program's own threads
    /// are as many as the machine has where `threads` is 0.
    #[pyo3(signature = (study, name, bridge, threads, told))]
    fn solve(
        &self,
        py: Python<'_>,
        study: &str,
        name: PathBuf,
        bridge: &BridgeDocument,
        threads: usize,
        told: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<BTreeMap<&'static str, EngineTable>> {
        let asked = Asked {
            study,
            name,
            bridge: &bridge.bridge,
            threads,
            outputs: None,
        };
        let solved = wait(py, told, |watched| self.tables(&asked, watched))?;
        let Solved { tables, .. } = solved.map_err(|unsolved| exception(py, unsolved))?;
        let named = |(name, table): (TableName, _)| (name.word(), EngineTable::from(table));
        Ok(tables.into_iter().map(named).collect())
    }

    /// Solves a study for some columns of its table of jobs alone: that table, the row of each point, and the seconds in which
    /// jobs were solved.
    #[pyo3(signature = (study, name, bridge, outputs, threads, told))]
    #[allow(clippy::too_many_arguments, reason = "a call from Python")]
    fn solve_points(
        &self,
        py: Python<'_>,
        study: &str,
        name: PathBuf,
        bridge: &BridgeDocument,
        outputs: Vec<String>,
        threads: usize,
        told: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<(EngineTable, Vec<usize>, f64)> {
        let asked = Asked {
            study,
            name,
            bridge: &bridge.bridge,
            threads,
            outputs: Some(&outputs),
        };
        let solved = wait(py, told, |watched| self.tables(&asked, watched))?;
        let mut solved = solved.map_err(|unsolved| exception(py, unsolved))?;
        match (solved.tables.remove(&TableName::Jobs), solved.rows) {
            (Some(jobs), Some(rows)) => Ok((jobs.into(), rows, solved.solved_s)),
            _ => Err(failed(py, &"program error: no table of jobs")),
        }
    }
}

/// A study that is asked.
struct Asked<'a> {
    study: &'a str,
    name: PathBuf,
    bridge: &'a BridgeFile,
    threads: usize,
    /// The columns of the table of jobs that are asked for; all tables where none are named.
    outputs: Option<&'a [String]>,
}

impl Session {
    fn tables(&self, asked: &Asked<'_>, watched: &Arc<Watched>) -> Result<Solved, Unsolved> {
        let document = Document::parse(&asked.name, asked.study).map_err(Unsolved::Refused)?;
        let study = Study::of_values(&asked.name, document, asked.bridge).map_err(Unsolved::Refused)?;
        let jobs = Jobs::new(&study).collect::<Result<Vec<Job>, Refusal>>();
        let jobs = jobs.map_err(Unsolved::Refused)?;
        let rows = asked.outputs.map(|_| rows(&study, &jobs)).transpose()?;
        let setting = SessionSetting {
            threads: asked.threads,
            static_peaks: asked
                .outputs
                .is_none_or(|outputs| outputs.iter().any(|name| STATIC_PEAK_COLUMNS.contains(&name.as_str()))),
        };
        let only = asked.outputs.map(|_| &[TableName::Jobs][..]);
        let mut tables = MemoryTables::begin(&study, &jobs, only).map_err(Unsolved::Tables)?;
        for (number, output) in asked.outputs.iter().flat_map(|outputs| outputs.iter().enumerate()) {
            check_output(&asked.name, number, output, tables.table(TableName::Jobs)).map_err(Unsolved::Refused)?;
        }
        let mut taken = Ok(());
        let watch = (&*watched.stop, &**watched as &dyn pontoon_study::run::Progress);
        let solved = self.session.solve(&study, &jobs, setting, watch, |batch, records| {
            if taken.is_ok() {
                taken = tables.append(batch, &records);
            }
        });
        let solved_s = solved.map_err(Unsolved::Session)?;
        taken.map_err(Unsolved::Tables)?;
        Ok(Solved {
            tables: tables.finish(),
            rows,
            solved_s,
        })
    }
}

/// Refuses an output that is no number of the table of jobs.
fn check_output(name: &Path, number: usize, output: &str, jobs: Option<&ArrowTable>) -> Result<(), Refusal> {
    let Some(jobs) = jobs.filter(|jobs| jobs.numbers(output).is_none()) else {
        return Ok(());
    };
    let numeric = jobs.names().filter(|name| jobs.numbers(name).is_some());
    let known: Vec<String> = numeric.map(str::to_owned).collect();
    Err(Refusal::unknown(name, format!("outputs[{number}]"), output, &known))
}

/// The row of each point in the table of jobs.
fn rows(study: &Study, jobs: &[Job]) -> Result<Vec<usize>, Unsolved> {
    if study.points() == jobs.len() {
        return Ok((0..jobs.len()).collect());
    }
    let number = |job: Result<Job, Refusal>| Ok(job.map_err(Unsolved::Refused)?.number);
    PointJobs::new(study).map(number).collect()
}

fn exception(py: Python<'_>, unsolved: Unsolved) -> PyErr {
    match unsolved {
        Unsolved::Refused(refusal) => refused(py, &refusal),
        Unsolved::Session(error) => failed(py, &error),
        Unsolved::Tables(error) => failed(py, &error),
    }
}
