//! The bridge and its mesh made ready, a job's solver.
//!
//! Knows what is built of a design. Does not know what is exported of it.

use super::ExportError;
use super::subject::{CrossingWanted, Stresses};
use pontoon_core::analysis::crossing::{CrossingSettings, CrossingSolver};
use pontoon_core::analysis::modes::bending_frequencies_hz;
use pontoon_core::analysis::snapshot::Snapshot;
use pontoon_core::bridge::{
    Bridge, BridgeDesign, BridgeStresses, Ends, MeshedBridge, Model, PreparedModule, StressRecovery,
};
use pontoon_core::stop::Stop;
use std::sync::Arc;

/// A bridge with its mesh.
#[derive(Debug)]
pub(super) struct Ready {
    pub bridge: Arc<Bridge>,
    pub meshed: MeshedBridge,
    recovery: Option<StressRecovery>,
}

impl Ready {
    /// Builds a design.
    ///
    /// # Errors
    /// [`ExportError::Bridge`].
    pub(super) fn new(
        design: &BridgeDesign,
        model: Model,
        ends: Ends,
        stresses: Stresses,
    ) -> Result<Self, ExportError> {
        Self::of(design, &PreparedModule::of_kinds(design, model)?, ends, stresses)
    }

    fn of(
        design: &BridgeDesign,
        modules: &[PreparedModule],
        ends: Ends,
        stresses: Stresses,
    ) -> Result<Self, ExportError> {
        Ok(Self {
            bridge: Arc::new(Bridge::of_kinds(design, modules, ends)?),
            meshed: MeshedBridge::of_kinds(design, modules, ends)?,
            recovery: match stresses {
                Stresses::Wanted => Some(StressRecovery::of_kinds(design, modules)?),
                Stresses::Unwanted => None,
            },
        })
    }

    /// The stresses of a state, where they are wanted.
    pub(super) fn stresses(&self, state: &Snapshot) -> Option<BridgeStresses> {
        let recovery = self.recovery.as_ref()?;
        Some(recovery.stresses(&self.meshed, &state.u, state.inertial.as_deref()))
    }

    /// The bridge of a crossing with its settings: those of its study, at the time step of its answer.
    ///
    /// # Errors
    /// [`ExportError`].
    pub(super) fn of_crossing(
        wanted: &CrossingWanted,
        stresses: Stresses,
    ) -> Result<(Self, CrossingSettings), ExportError> {
        let (design, crossing) = (&wanted.job.shared.bridge.design, wanted.crossing()?);
        let modules = PreparedModule::of_kinds(design, wanted.job.model().into())?;
        let bending_hz = || -> Result<[f64; 2], ExportError> {
            let free = Bridge::of_kinds(design, &modules, Ends::Free)?;
            Ok(bending_frequencies_hz(&free, Stop::never())?)
        };
        let (_, coefficients) = crossing.analysis.damping.coefficients(bending_hz)?;
        let settings = CrossingSettings {
            time_step_s: wanted.time_step_s,
            ..crossing.settings(coefficients)
        };
        Ok((Self::of(design, &modules, Ends::Supported, stresses)?, settings))
    }

    /// The solver of a crossing on this bridge.
    ///
    /// # Errors
    /// [`ExportError::Analysis`].
    pub(super) fn solver(&self, settings: &CrossingSettings) -> Result<CrossingSolver, ExportError> {
        Ok(CrossingSolver::new(&self.bridge, settings)?)
    }
}
