//! What is wrong, as Python's exceptions: their texts are the engine's.
//!
//! Knows the classes of exceptions. Does not know what any of them is about.

use pontoon_plan::input::{Refusal, RefusalKind};
use pontoon_program::{place_in_file, refusal_of};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::fmt::Display;
use std::path::PathBuf;

/// The module of the package that holds the exceptions.
const CLASSES: &str = "pontoon._errors";

/// The exception of a refused input.
pub(crate) fn refused(py: Python<'_>, refusal: &Refusal) -> PyErr {
    input_error(py, refusal).unwrap_or_else(|broken| broken)
}

fn input_error(py: Python<'_>, refusal: &Refusal) -> PyResult<PyErr> {
    let keys = PyDict::new(py);
    keys.set_item("file", refusal.file.display().to_string())?;
    keys.set_item("path", &refusal.path)?;
    keys.set_item("kind", kind(refusal.kind))?;
    keys.set_item("found", refusal.found.text())?;
    keys.set_item("allowed", &refusal.allowed)?;
    keys.set_item("nearest", refusal.nearest.as_deref())?;
    keys.set_item("span", place_in_file(refusal).map(|place| (place.start, place.end)))?;
    let class = py.import(CLASSES)?.getattr("InputError")?;
    Ok(PyErr::from_value(class.call((refusal.to_string(),), Some(&keys))?))
}

/// What is wrong, as a word.
fn kind(kind: RefusalKind) -> &'static str {
    match kind {
        RefusalKind::Whole => "file",
        RefusalKind::Syntax => "syntax",
        RefusalKind::RepeatedKey => "repeated_key",
        RefusalKind::Missing => "missing",
        RefusalKind::UnknownKey => "unknown_key",
        RefusalKind::Misplaced => "misplaced",
        RefusalKind::UnknownWord => "unknown_word",
        RefusalKind::WrongType => "wrong_type",
        RefusalKind::NotAllowed => "not_allowed",
        RefusalKind::Repeated => "repeated",
        RefusalKind::Conflict => "conflict",
    }
}

/// The exception of an input that has no file: arguments of a call.
pub(crate) fn argument(py: Python<'_>, text: &str) -> PyErr {
    let made = || py.import(CLASSES)?.getattr("InputError")?.call1((text,));
    made().map_or_else(|broken| broken, PyErr::from_value)
}

/// The exception of what went wrong otherwise.
pub(crate) fn failed(py: Python<'_>, error: &dyn Display) -> PyErr {
    let text = format!("{error:#}");
    let made = || py.import(CLASSES)?.getattr("EngineError")?.call1((&text,));
    made().map_or_else(|_| PyRuntimeError::new_err(text.clone()), PyErr::from_value)
}

/// The exception of a command that did not come to its end.
pub(crate) fn ended(py: Python<'_>, error: &anyhow::Error) -> PyErr {
    match refusal_of(error) {
        Some(refusal) => refused(py, refusal),
        None => failed(py, error),
    }
}

/// Raises the refusal of a word of a call that is not among those it knows.
#[pyfunction]
pub(crate) fn refuse_word(py: Python<'_>, call: PathBuf, path: &str, word: &str, known: Vec<String>) -> PyResult<()> {
    Err(refused(py, &Refusal::unknown_key(&call, path, word, &known)))
}
