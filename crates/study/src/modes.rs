//! Natural frequencies of a bridge file.
//!
//! Knows which bridge is meant (the whole, its single module, free or on its supports). Does not know how modes are
//! found or named.

use pontoon_core::analysis::{AnalysisError, modes};
use pontoon_core::bridge::{Bridge, Ends, PreparedModule};
use pontoon_core::input::{InvalidInput, Problem};
use pontoon_plan::study_file::{BridgeFile, ModelSpec};

pub use pontoon_core::bridge::BridgeError;
use pontoon_results::ModeRow;
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
    /// Whether a single module is meant, floating alone: the first.
    pub module: bool,
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
        if design.water.is_some() {
            let allowed = "no water with memory, which is that of the whole bridge, under a module alone";
            let refused = InvalidInput::new("water", "a water file", allowed);
            return Err(BridgeError::from(refused.because(Problem::Conflict)).into());
        }
        // of a row of kinds the first module
        design = design.variants().designs.swap_remove(0);
        design.modules = 1;
    }
    design.check_size(request.model.into()).map_err(BridgeError::from)?;
    let ends = if request.supports && !request.module {
        Ends::Supported
    } else {
        Ends::Free
    };
    let modules = PreparedModule::of_kinds(&design, request.model.into())?;
    Ok(rows(&Bridge::of_kinds(&design, &modules, ends)?, request.count)?)
}

/// The lowest modes of a bridge, numbered from 1.
pub(crate) fn rows(bridge: &Bridge, count: usize) -> Result<Vec<ModeRow>, AnalysisError> {
    let (found, _) = modes::modes(bridge, count)?;
    let row = |(number, mode): (usize, modes::Mode)| ModeRow {
        number,
        frequency_hz: mode.frequency_hz,
        shape: mode.name,
        radiation_ratio: mode.radiation_ratio,
        vertical_share: mode.vertical_share,
        torsion_share: mode.torsion_share,
        horizontal_share: mode.horizontal_share,
        axial_share: mode.axial_share,
    };
    Ok((1..).zip(found).map(row).collect())
}
