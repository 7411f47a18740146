//! Finite elements: shells and beams in space, their assembly, factorisation and eigenvalues.
//!
//! Knows nodes, elements and sparse matrices. Has never heard of a bridge, of water or of a vehicle. Six degrees of
//! freedom a node, in the order u_x, u_y, u_z, theta_x, theta_y, theta_z.

mod assembly;
mod beam;
mod eigen;
mod factor;
mod frame;
mod inertia;
mod lanczos;
mod membrane;
mod mesh;
mod plate;
mod probe;
mod section;
mod shell;
mod sparse;
mod stress;
mod windows;

pub use assembly::{MassKind, assemble};
pub use beam::{Beam, BeamSection};
pub(crate) use eigen::lowest_modes_unless;
pub use eigen::{EigenPairs, lowest_modes};
pub use factor::Factor;
pub(crate) use factor::SolveMemory;
pub use frame::QuadFrame;
pub use inertia::count_below;
pub use mesh::{DOFS_PER_NODE, Mesh, NodeId};
pub(crate) use mesh::{MeshBeam, MeshShell};
pub(crate) use probe::{allowed, diagonal, hold, pattern, residual, sizes};
pub use section::ShellSection;
pub use shell::Shell;
pub use sparse::{SparseRow, SymmetricMatrix};
pub use stress::{BeamForceMatrix, BeamForces, ShellStress, ShellStressMatrix, von_mises_pa};
pub use windows::{ModeSearch, ONE_SEARCH};

use crate::stop::Stop;
use thiserror::Error;

/// Goes on unless a stop is asked for.
pub(crate) fn go_on(stop: Stop<'_>) -> Result<(), FemError> {
    if stop.is_asked() {
        Err(FemError::Stopped)
    } else {
        Ok(())
    }
}

/// Why finite elements gave no answer.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum FemError {
    /// Somebody wished it to stop.
    #[error("stopped")]
    Stopped,
    /// A matrix that must be positive definite is not.
    #[error("matrix of {dofs} degrees of freedom is not positive definite (pivot {pivot})")]
    NotPositiveDefinite {
        /// Degrees of freedom.
        dofs: usize,
        /// Pivot at which the factorisation stopped.
        pivot: usize,
    },
    /// A factorisation solved its probe badly.
    #[error(
        "{name}, {dofs} degrees of freedom: its factorisation leaves {residual:.1e} of the probe, allowed {allowed:.1e}"
    )]
    BadFactor {
        /// What was factorised.
        name: &'static str,
        /// Degrees of freedom.
        dofs: usize,
        /// Relative residual of the probe.
        residual: f64,
        /// Residual allowed.
        allowed: f64,
    },
    /// An element that cannot carry a field: no area, no length, a corner of more than 180 degrees, or a section that
    /// no material has.
    #[error("element {element} is degenerate: {measure} = {value:.3e}")]
    Degenerate {
        /// Number of the element in its list.
        element: usize,
        /// What is wrong.
        measure: &'static str,
        /// Its value.
        value: f64,
    },
    /// A shift that cannot make a singular stiffness definite.
    #[error("the shift of an eigenvalue problem must be positive and finite, not {value}")]
    Shift {
        /// The shift.
        value: f64,
    },
    /// Fewer eigenvalues converged than were asked for.
    #[error("{converged} of {asked} eigenvalues converged")]
    Eigen {
        /// Eigenvalues asked for.
        asked: usize,
        /// Eigenvalues that converged.
        converged: usize,
    },
    /// A mode is none, or not of unit modal mass, or not orthogonal to one before it.
    #[error("mode {mode} of {dofs} degrees of freedom: {measure} is off by {found:.1e}, allowed {allowed:.1e}")]
    BadPair {
        /// Number of the mode, from 1 in rising order.
        mode: usize,
        /// Degrees of freedom.
        dofs: usize,
        /// What is wrong.
        measure: &'static str,
        /// By how much, relative.
        found: f64,
        /// How much is allowed.
        allowed: f64,
    },
    /// Storage for a matrix or factor could not be had.
    #[error("no memory for a matrix of {dofs} degrees of freedom")]
    OutOfMemory {
        /// Degrees of freedom.
        dofs: usize,
    },
}

/// Refuses an element whose `measure` is not as it must be.
fn require(element: usize, measure: &'static str, value: f64, holds: bool) -> Result<(), FemError> {
    if value.is_finite() && holds {
        Ok(())
    } else {
        Err(FemError::Degenerate {
            element,
            measure,
            value,
        })
    }
}
