//! A table handed to another library by Arrow's C stream interface, without a copy.
//!
//! Knows the interface, and is the only module of the workspace in which `unsafe` code may stand. Does not know columns.
// a C interface; today the libraries' own functions do without it
#![allow(unsafe_code)]

use crate::errors::failed;
use polars_arrow::ffi::export_iterator;
use pontoon_results::ArrowTable;
use pyo3::prelude::*;
use pyo3::types::PyCapsule;

/// A capsule that holds a stream of the parts of a table; whoever takes it releases it, else the capsule does.
pub(crate) fn stream<'py>(py: Python<'py>, table: &ArrowTable) -> PyResult<Bound<'py, PyCapsule>> {
    let parts = table.arrays().into_iter().map(Ok);
    let stream = export_iterator(Box::new(parts), table.field());
    PyCapsule::new_with_value(py, stream, c"arrow_array_stream").map_err(|error| failed(py, &error))
}
