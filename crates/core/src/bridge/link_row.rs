//! Links and springs of a bridge: where each is and the row that gives its elongation.
//!
//! Knows places. Does not know laws or forces.

use crate::fem::SparseRow;

/// One link, a connector or a one-sided spring of a bank: where it is and the row of B that gives its elongation.
/// Equation (J1).
#[derive(Debug, Clone)]
pub(crate) struct LinkRow {
    /// Where it is.
    pub place: LinkPlace,
    /// `e = row . u`: the right deck node's motion along x minus the left one's, between decks of unlike depth at the height of
    /// the lower one; of a bank's spring the motion along its sense.
    pub row: SparseRow,
}

/// Where a link is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LinkPlace {
    /// A connector.
    Connector {
        /// Its number, from 1, joints from left to right.
        number: usize,
        /// Position number of its joint.
        joint: usize,
        /// Place across `[m]`.
        y_m: f64,
    },
    /// A spring of a bank.
    Bank {
        /// The bank, from 0 in the order of the bridge file.
        bank: usize,
        /// Place across `[m]`.
        y_m: f64,
    },
}

impl std::fmt::Display for LinkPlace {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Connector { number, joint, y_m } => write!(f, "connector {number} (joint {joint}, y = {y_m} m)"),
            Self::Bank { bank, y_m } => write!(f, "bank {bank} (y = {y_m} m)"),
        }
    }
}

/// Where a vertical spring acts, and its sense.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct UpwardForce {
    /// Place along and across `[m]`.
    pub x_m: f64,
    pub y_m: f64,
    /// 1 where its force on the bridge points upward, -1 where downward.
    pub sense: f64,
}

/// A spring that holds both ways: its stiffness stands in K.
#[derive(Debug, Clone)]
pub(crate) struct SpringPlace {
    /// The bank that it is of.
    pub bank: usize,
    /// Place across `[m]`.
    pub y_m: f64,
    /// Its stiffness `[N/m]`.
    pub stiffness_n_m: f64,
    /// Its motion, `e = row . u`.
    pub row: SparseRow,
}
