//! The bridge: modules in a row, tied at their hinges, held at their supports, with connectors and a track.
//!
//! The one place where module, water, connector and vehicle meet. Does not know time, contact or response.

mod assembly;
mod ballast;
mod banks;
mod buoyancy;
mod dead;
mod design;
mod dry;
mod fit;
mod joints;
mod kinds;
mod link_row;
mod load;
mod meshed;
mod module_place;
mod modules;
mod pins;
mod placement;
mod prepared;
mod product;
mod provenance;
#[cfg(test)]
mod ramps;
mod row;
mod stresses;
mod supports;
mod track;
mod water_spec;
mod waves;

pub use assembly::Bridge;
pub use ballast::{BallastSpec, DeadSpec};
pub use banks::{BankPlace, BankSpec, BridgeEnd, Toward};
pub use buoyancy::{DraftBuoyancy, Todd};
pub(crate) use design::is_own_image;
pub use design::{BridgeDesign, Condensation, Variants};
pub use joints::{Connectors, Hinges, JointConnectors, JointGaps, JointRange, JointSpec, Joints, StopSpec};
pub use kinds::{ModuleKind, ModuleRow, ModuleRun};
pub use link_row::LinkPlace;
pub(crate) use link_row::SpringPlace;
pub(crate) use load::{Load, Rider, Rides};
pub use meshed::{BeamCell, Link, MeshedBridge, ShellCell};
pub(crate) use module_place::ModulePlace;
#[cfg(test)]
pub(crate) use pins::ModuleForces;
pub(crate) use pins::{Acting, PinPlace, PinRow, joint_parts};
pub(crate) use placement::{Heading, VehiclePlacement};
pub use prepared::PreparedModule;
#[cfg(test)]
pub(crate) use prepared::Side;
pub use provenance::{Provenance, ProvenanceDocument, ProvenanceHeld, ProvenanceParameter};
pub(crate) use row::HeldDof;
pub use stresses::{BridgeStresses, StressRecovery};
pub use supports::{Direction, Supports};
use thiserror::Error;
pub use track::Track;
pub use water_spec::WaterSpec;
pub(crate) use waves::BridgeWaves;

/// Which matrices a module contributes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Model {
    /// Every degree of freedom of the shells and beams.
    Full,
    /// The condensed module.
    SuperElement,
}

/// Whether the ends are held.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Ends {
    /// Floating free, as in the paper's table of modes.
    Free,
    /// Held as the design's supports say, as in statics and crossings.
    Supported,
}

/// Why a bridge could not be built.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum BridgeError {
    /// A number of the design is refused.
    #[error(transparent)]
    Design(#[from] crate::input::InvalidInput),
    /// The finite elements failed.
    #[error(transparent)]
    Fem(#[from] crate::fem::FemError),
}
