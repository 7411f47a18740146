//! Studies that a Python program asks without a file.
//!
//! Knows how a study in JSON becomes tables in memory, and how points become numbers. Does not know its keys, nor how it is
//! solved.

use crate::bridge::BridgeDocument;
use crate::errors::{failed, refused};
use crate::table::EngineTable;
use crate::waiting::{Watched, wait};
use pontoon_plan::input::{Document, Refusal};
use pontoon_plan::job::{AskedPoints, Job, Jobs, PointStudy};
use pontoon_plan::study_file::{BridgeFile, Study};
use pontoon_results::{ArrowTable, JobNumbers, JobRecord, MemoryTables, STATIC_PEAK_COLUMNS, TableName};
use pontoon_study::run::{Cache, SessionError, SessionSetting, SolveSession};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// What is kept from call to call.
#[pyclass(frozen, module = "pontoon._engine")]
pub(crate) struct Session {
    session: SolveSession,
}

/// The study of a function: its points come with each call.
#[pyclass(frozen, module = "pontoon._engine")]
pub(crate) struct FunctionStudy {
    study: PointStudy,
}

/// Why a study left nothing.
enum Unsolved {
    Refused(Refusal),
    Session(SessionError),
    Tables(io::Error),
}

/// What points came to.
struct PointNumbers {
    /// Point by point the number of each output, as bytes.
    bytes: Vec<u8>,
    /// Why points failed, by their number.
    failures: BTreeMap<usize, String>,
    /// Seconds in which jobs were solved.
    solved_s: f64,
}

#[pymethods]
impl FunctionStudy {
    /// The study of a JSON text, whose design is one zip with the inputs first; `name` stands for its file in messages.
    #[new]
    fn new(py: Python<'_>, study: &str, name: PathBuf, bridge: &BridgeDocument) -> PyResult<Self> {
        let study = opened(study, &name, &bridge.bridge).map_err(|refusal| refused(py, &refusal))?;
        Ok(Self {
            study: PointStudy::new(study),
        })
    }
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
        let solved = wait(py, told, |watched| {
            let study = opened(study, &name, &bridge.bridge).map_err(Unsolved::Refused)?;
            self.tables(&study, threads, watched)
        })?;
        let tables = solved.map_err(|unsolved| exception(py, unsolved))?;
        let named = |(name, table): (TableName, _)| (name.word(), EngineTable::from(table));
        Ok(tables.into_iter().map(named).collect())
    }

    /// Solves the study of a function at points, each list being the values of an input: point by point the numbers of columns
    /// of the table of jobs as bytes, why points failed by their number, and the seconds in which jobs were solved.
    #[pyo3(signature = (study, lists, outputs, threads, told))]
    fn solve_points<'py>(
        &self,
        py: Python<'py>,
        study: &FunctionStudy,
        lists: Vec<Vec<f64>>,
        outputs: Vec<String>,
        threads: usize,
        told: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<(Bound<'py, PyBytes>, BTreeMap<usize, String>, f64)> {
        let solved = wait(py, told, |watched| {
            let asked = study.study.at(&lists).map_err(Unsolved::Refused)?;
            self.numbers(&asked, &outputs, threads, watched)
        })?;
        let numbers = solved.map_err(|unsolved| exception(py, unsolved))?;
        Ok((PyBytes::new(py, &numbers.bytes), numbers.failures, numbers.solved_s))
    }
}

impl Session {
    fn tables(
        &self,
        study: &Study,
        threads: usize,
        watched: &Arc<Watched>,
    ) -> Result<BTreeMap<TableName, ArrowTable>, Unsolved> {
        let jobs = Jobs::new(study).collect::<Result<Vec<Job>, Refusal>>();
        let jobs = jobs.map_err(Unsolved::Refused)?;
        let setting = SessionSetting {
            threads,
            static_peaks: true,
        };
        let mut tables = MemoryTables::begin(study, &jobs).map_err(Unsolved::Tables)?;
        let mut taken = Ok(());
        self.records(study, &jobs, setting, watched, |batch, records| {
            if taken.is_ok() {
                taken = tables.append(batch, &records);
            }
        })?;
        taken.map_err(Unsolved::Tables)?;
        Ok(tables.finish())
    }

    fn numbers(
        &self,
        asked: &AskedPoints,
        outputs: &[String],
        threads: usize,
        watched: &Arc<Watched>,
    ) -> Result<PointNumbers, Unsolved> {
        let AskedPoints { study, jobs, rows } = asked;
        let setting = SessionSetting {
            threads,
            static_peaks: outputs.iter().any(|name| STATIC_PEAK_COLUMNS.contains(&name.as_str())),
        };
        let mut of_jobs = JobNumbers::begin(study, jobs, outputs).map_err(|none| {
            let path = format!("outputs[{}]", none.place);
            Unsolved::Refused(Refusal::unknown(&study.file, path, &outputs[none.place], &none.known))
        })?;
        let solved_s = self.records(study, jobs, setting, watched, |batch, records| {
            of_jobs.append(batch, &records)
        })?;
        let numbers = rows
            .iter()
            .flat_map(|&row| of_jobs.numbers.iter().map(move |of| of[row]));
        let failed = rows
            .iter()
            .enumerate()
            .filter_map(|(point, row)| Some((point, of_jobs.failures.get(row)?.clone())));
        Ok(PointNumbers {
            bytes: numbers.flat_map(f64::to_ne_bytes).collect(),
            failures: failed.collect(),
            solved_s,
        })
    }

    /// Solves jobs and hands their records on: the seconds in which they were solved.
    fn records(
        &self,
        study: &Study,
        jobs: &[Job],
        setting: SessionSetting,
        watched: &Arc<Watched>,
        take: impl FnMut(&[Job], Vec<JobRecord>) + Send,
    ) -> Result<f64, Unsolved> {
        let watch = (&*watched.stop, &**watched as &dyn pontoon_study::run::Progress);
        let solved_s = self.session.solve(study, jobs, setting, watch, take);
        solved_s.map_err(Unsolved::Session)
    }
}

/// The study of a JSON text.
fn opened(text: &str, name: &Path, bridge: &BridgeFile) -> Result<Study, Refusal> {
    Study::of_values(name, Document::parse(name, text)?, bridge)
}

fn exception(py: Python<'_>, unsolved: Unsolved) -> PyErr {
    match unsolved {
        Unsolved::Refused(refusal) => refused(py, &refusal),
        Unsolved::Session(error) => failed(py, &error),
        Unsolved::Tables(error) => failed(py, &error),
    }
}
