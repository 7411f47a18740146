//! What can be asked of a bridge: its modes, a static load, a crossing.
//!
//! Knows the questions and puts solver and response together. Does not know studies, files or threads.

use crate::bridge::LinkPlace;
use thiserror::Error;

pub mod crossing;
pub mod modes;
pub mod snapshot;
pub mod statics;

/// Why an analysis gave no answer.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum AnalysisError {
    /// The contact did not settle at any step size allowed.
    #[error("contact not settled at t = {time_s:.6} s in {} after {bisections} bisections", place_of(*link))]
    NotConverged {
        /// Time of the step's end `[s]`.
        time_s: f64,
        /// A link that changes its state without end; none where that is a wheel on springs.
        link: Option<LinkPlace>,
        /// Bisections made.
        bisections: usize,
    },
    /// The contact of a static case did not settle.
    #[error("static contact not settled after {iterations} Newton solutions, load at x = {load_x_m} m")]
    StaticNotConverged {
        /// Newton solutions made.
        iterations: usize,
        /// Place of the load's centre `[m]`.
        load_x_m: f64,
    },
    /// The bridge has no state at rest under its dead load, or none was found.
    #[error("no dead state: {0}")]
    NoDeadState(DeadFault),
    /// A number left the finite range.
    #[error("response not finite at t = {time_s:.6} s")]
    NotFinite {
        /// Time `[s]`.
        time_s: f64,
    },
    /// The bridge's matrices could not be factorised.
    #[error(transparent)]
    Factor(#[from] crate::fem::FemError),
    /// A mode that the analysis needs was not found.
    #[error("mode '{name}' is not among the lowest {searched} modes")]
    ModeMissing {
        /// The mode's name.
        name: String,
        /// How many were searched.
        searched: usize,
    },
}

fn place_of(link: Option<LinkPlace>) -> String {
    link.map_or_else(|| "a wheel on its spring".to_owned(), |link| link.to_string())
}

/// Why a bridge has no dead state.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum DeadFault {
    /// The contact did not settle.
    #[error("contact not settled after {iterations} Newton solutions")]
    NotSettled {
        /// Newton solutions made.
        iterations: usize,
    },
    /// No water, support, bank or connector holds a part of the bridge.
    #[error("nothing holds the bridge where it has gone to")]
    NotHeld,
    /// A deck lies under water.
    #[error("module {module} sinks: a corner of its deck is {under_m:.3} m under water")]
    Sinks {
        /// The module, from 1.
        module: usize,
        /// Depth of the corner under the water `[m]`.
        under_m: f64,
    },
}
