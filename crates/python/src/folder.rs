//! Tables of a folder of results, and of what a command says in JSON.
//!
//! Knows names of tables. Does not know columns.

use crate::errors::{failed, refused};
use crate::table::EngineTable;
use pontoon_plan::input::{FoundValue, Refusal};
use pontoon_results::{ArrowTable, Results, ResultsError, TableName};
use pyo3::prelude::*;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Names of the tables that a folder of results holds.
#[pyfunction]
pub(crate) fn table_names(py: Python<'_>, folder: PathBuf) -> PyResult<Vec<&'static str>> {
    let opened = py.detach(|| Results::read_some(&folder, &[]));
    let results = opened.map_err(|error| exception(py, &error))?;
    let held = TableName::ALL.into_iter().filter(|name| results.has_table(*name));
    Ok(held.map(TableName::word).collect())
}

/// A table of a folder of results.
#[pyfunction]
pub(crate) fn read_table(py: Python<'_>, folder: PathBuf, name: &str) -> PyResult<EngineTable> {
    let read = py.detach(|| read(&folder, name));
    read.map(EngineTable::from).map_err(|error| exception(py, &error))
}

fn read(folder: &Path, name: &str) -> Result<ArrowTable, ResultsError> {
    let results = Results::read_some(folder, &[])?;
    let known = TableName::ALL.into_iter().filter(|table| results.has_table(*table));
    let known: Vec<String> = known.map(|table| table.word().to_owned()).collect();
    let named = TableName::ALL.into_iter().find(|table| table.word() == name);
    if let Some(table) = named.map(|table| results.arrays(table)).transpose()?.flatten() {
        return Ok(table);
    }
    let refusal = Refusal::unknown(folder, "", name, &known);
    let found = FoundValue::value(name).which("which is no table of these results");
    Err(Refusal {
        found: Box::new(found),
        ..refusal
    }
    .into())
}

/// The table of a list of objects in JSON.
#[pyfunction]
pub(crate) fn table_of_rows(py: Python<'_>, json: &str) -> PyResult<EngineTable> {
    let rows: Vec<Value> = serde_json::from_str(json).map_err(|error| failed(py, &error))?;
    let table = ArrowTable::of_objects(&rows).map_err(|error| failed(py, &error))?;
    Ok(table.into())
}

fn exception(py: Python<'_>, error: &ResultsError) -> PyErr {
    match error {
        ResultsError::Refused(refusal) => refused(py, refusal),
        other => failed(py, other),
    }
}
