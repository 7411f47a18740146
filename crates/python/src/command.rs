//! Commands of the program as functions, and the program itself.
//!
//! Knows that a command is its words. Does not know what any command does.

use crate::errors::{argument, ended};
use crate::waiting::wait;
use pontoon_program::{CallError, Caller};
use pontoon_study::run::Progress;
use pyo3::prelude::*;
use std::ffi::OsString;
use std::sync::Arc;

/// Runs a command in this process: what it writes as its result, its notes, and whether nothing fell short. `again` is how a
/// process of its own is started.
#[pyfunction]
#[pyo3(signature = (words, again, told=None))]
pub(crate) fn call(
    py: Python<'_>,
    words: Vec<OsString>,
    again: Vec<OsString>,
    told: Option<&Bound<'_, PyAny>>,
) -> PyResult<(String, Vec<String>, bool)> {
    let called = wait(py, told, |watched| {
        let progress: Arc<dyn Progress + Send + Sync> = Arc::<crate::waiting::Watched>::clone(watched);
        let stop = Arc::clone(&watched.stop);
        pontoon_program::call(&words, Caller { stop, progress, again })
    })?;
    match called {
        Ok(called) => Ok((called.result, called.notes, called.good)),
        Err(CallError::Words(text)) => Err(argument(py, &text)),
        Err(CallError::Ended(error)) => Err(ended(py, &error)),
    }
}

/// Runs the program with a command line, whose first word is its own name, and gives its exit status. It answers signals
/// itself and writes on standard output and error.
#[pyfunction]
pub(crate) fn program(py: Python<'_>, words: Vec<OsString>, again: Vec<OsString>) -> u8 {
    py.detach(|| pontoon_program::program(words, &again))
}
