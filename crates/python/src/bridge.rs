//! A bridge that a Python program holds.
//!
//! Knows that a bridge is its document. Does not know its keys.

use crate::errors::refused;
use pontoon_plan::input::{Document, Refusal};
use pontoon_plan::study_file::{BridgeFile, bridge_of, read_bridge, read_vehicle};
use pyo3::prelude::*;
use std::path::PathBuf;

/// A bridge, checked.
#[pyclass(frozen, module = "pontoon._engine")]
pub(crate) struct BridgeDocument {
    pub(crate) bridge: BridgeFile,
}

#[pymethods]
impl BridgeDocument {
    /// Reads a bridge file.
    #[staticmethod]
    fn read(py: Python<'_>, file: PathBuf) -> PyResult<Self> {
        let read = py.detach(|| read_bridge(&file));
        Self::checked(py, read)
    }

    /// The bridge of a JSON text; `name` stands for its file in messages.
    #[staticmethod]
    fn parse(py: Python<'_>, name: PathBuf, text: &str) -> PyResult<Self> {
        let parsed = Document::parse(&name, text).and_then(|document| bridge_of(&name, document));
        Self::checked(py, parsed)
    }

    /// The document as JSON.
    #[getter]
    fn json(&self) -> &str {
        self.bridge.document.text()
    }

    /// What stands for its file in messages.
    #[getter]
    fn name(&self) -> String {
        self.bridge.file.display().to_string()
    }

    /// Number of modules.
    #[getter]
    fn modules(&self) -> usize {
        self.bridge.design.modules
    }

    /// Length of the bridge `[m]`.
    #[getter]
    fn length_m(&self) -> f64 {
        self.bridge.design.length_m()
    }
}

impl BridgeDocument {
    fn checked(py: Python<'_>, bridge: Result<BridgeFile, Refusal>) -> PyResult<Self> {
        let bridge = bridge.map_err(|refusal| refused(py, &refusal))?;
        Ok(Self { bridge })
    }
}

/// Reads a vehicle file: its document as JSON.
#[pyfunction]
pub(crate) fn vehicle_json(py: Python<'_>, file: PathBuf) -> PyResult<String> {
    let (document, _) = read_vehicle(&file).map_err(|refusal| refused(py, &refusal))?;
    Ok(document.text().to_owned())
}
