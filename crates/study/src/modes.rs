//! Natural frequencies of a bridge file.
//!
//! Knows which bridge is meant (the whole, its single module, free or on its supports). Does not know how modes are
//! found or named.

use crate::spec::{BridgeFile, ModelSpec};
use pontoon_core::analysis::{AnalysisError, modes};
use pontoon_core::bridge::{Bridge, Ends, PreparedModule};

pub use pontoon_core::bridge::BridgeError;
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// What is asked.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ModesRequest {
    /// Model of the modules.
    pub model: ModelSpec,
    /// How many modes.
    pub count: usize,
    /// Whether the ends are held.
    pub supports: bool,
    /// Whether the single module is meant, floating alone.
    pub module: bool,
}

/// One mode; the shares are those of its kinetic energy.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ModeRow {
    /// Its number, from 1.
    pub number: usize,
    /// Natural frequency [Hz].
    pub frequency_hz: f64,
    /// Name of its shape.
    pub shape: String,
    /// Vertical share.
    pub vertical_share: f64,
    /// Share of torsion.
    pub torsion_share: f64,
    /// Horizontal share.
    pub horizontal_share: f64,
    /// Share along the bridge.
    pub axial_share: f64,
}

/// Why there are no modes.
#[derive(Debug, Error)]
pub enum ModesError {
    /// The bridge could not be built.
    #[error(transparent)]
    Bridge(#[from] BridgeError),
    /// The modes were not found.
    #[error(transparent)]
    Analysis(#[from] AnalysisError),
}

/// The lowest modes of a bridge with the linear connection.
///
/// # Errors
/// [`ModesError`].
pub fn modes(file: &BridgeFile, request: ModesRequest) -> Result<Vec<ModeRow>, ModesError> {
    let mut design = file.design.clone();
    if request.module {
        design.modules = 1;
    }
    design.check_size(request.model.into()).map_err(BridgeError::from)?;
    let ends = if request.supports && !request.module {
        Ends::Supported
    } else {
        Ends::Free
    };
    let module = PreparedModule::new(&design, request.model.into())?;
    Ok(rows(&Bridge::new(&design, &module, ends)?, request.count)?)
}

/// The lowest modes of a bridge, numbered from 1.
pub(crate) fn rows(bridge: &Bridge, count: usize) -> Result<Vec<ModeRow>, AnalysisError> {
    let (found, _) = modes::modes(bridge, count)?;
    let row = |(number, mode): (usize, modes::Mode)| ModeRow {
        number,
        frequency_hz: mode.frequency_hz,
        shape: mode.name,
        vertical_share: mode.vertical_share,
        torsion_share: mode.torsion_share,
        horizontal_share: mode.horizontal_share,
        axial_share: mode.axial_share,
    };
    Ok((1..).zip(found).map(row).collect())
}
