//! Tables as Python takes them.
//!
//! Knows rows and columns. Does not know what they mean.

use crate::capsule::stream;
use crate::errors::failed;
use pontoon_plan::input::Cell;
use pontoon_results::ArrowTable;
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyCapsule, PyList};
use std::collections::BTreeMap;
use std::sync::OnceLock;

/// A table in memory.
#[pyclass(frozen, module = "pontoon._engine")]
pub(crate) struct EngineTable {
    table: ArrowTable,
    /// The cells one by one, made when the first is asked for.
    cells: OnceLock<pontoon_results::Table>,
}

impl From<ArrowTable> for EngineTable {
    fn from(table: ArrowTable) -> Self {
        Self {
            table,
            cells: OnceLock::new(),
        }
    }
}

#[pymethods]
impl EngineTable {
    /// Names of the columns.
    #[getter]
    fn columns(&self) -> Vec<&str> {
        self.table.names().collect()
    }

    fn __len__(&self) -> usize {
        self.table.rows()
    }

    /// The cells of a column from one row to another, `None` where there is none.
    fn column<'py>(&self, py: Python<'py>, name: &str, from: usize, to: usize) -> PyResult<Bound<'py, PyList>> {
        let cells = match self.cells.get() {
            Some(cells) => cells,
            None => {
                let made = self.table.cells().map_err(|error| failed(py, &error))?;
                self.cells.get_or_init(|| made)
            }
        };
        let whole = self.table.is_whole(name);
        let list = PyList::empty(py);
        for row in from..to.min(self.table.rows()) {
            list.append(object(py, cells.cell(name, row), whole)?)?;
        }
        Ok(list)
    }

    /// Why rows failed, by their number, of a table of jobs.
    fn failures(&self) -> BTreeMap<usize, &str> {
        let [status, reason] = ["status", "reason"].map(|name| self.table.words(name).unwrap_or_default());
        let rows = status.into_iter().zip(reason).enumerate();
        let failed = rows.filter(|(_, (status, _))| *status != Some("ok"));
        failed
            .map(|(row, (_, reason))| (row, reason.unwrap_or_default()))
            .collect()
    }

    /// A column as the bytes of floating-point numbers; `None` where it holds words.
    fn numbers<'py>(&self, py: Python<'py>, name: &str) -> Option<Bound<'py, PyBytes>> {
        let numbers = self.table.numbers(name)?;
        let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_ne_bytes()).collect();
        Some(PyBytes::new(py, &bytes))
    }

    /// The table by Arrow's C interface.
    #[pyo3(signature = (requested_schema=None))]
    fn __arrow_c_stream__<'py>(
        &self,
        py: Python<'py>,
        requested_schema: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyCapsule>> {
        // a consumer that wants other types casts what it gets
        drop(requested_schema);
        stream(py, &self.table)
    }
}

fn object<'py>(py: Python<'py>, cell: Cell<'_>, whole: bool) -> PyResult<Bound<'py, PyAny>> {
    match cell {
        Cell::Nothing => Ok(py.None().into_bound(py)),
        Cell::Number(number) if whole => (number as i64).into_bound_py_any(py),
        Cell::Number(number) => number.into_bound_py_any(py),
        Cell::Whole(whole) => whole.into_bound_py_any(py),
        Cell::Flag(yes) => yes.into_bound_py_any(py),
        other => other.word().unwrap_or_default().into_bound_py_any(py),
    }
}
