//! The connector: a tension truss and a compression truss, each with its gap.
//!
//! Knows force against elongation. Does not know where the elongation comes from.

/// How the trusses of every connector work in a job.
/// Equation (J3).
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Connection {
    /// Both trusses at work at once, without gaps: `N = 2 k e`.
    Linear,
    /// `N = k (e - gap_tension)` above the tension gap, `N = k (e + gap_compression)` below minus the compression gap,
    /// 0 between.
    Nonlinear {
        /// Tension gap `[m]`, at least 0.
        gap_tension_m: f64,
        /// Compression gap `[m]`, at least 0.
        gap_compression_m: f64,
    },
}

/// Which truss of a connector is at work.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub enum State {
    /// Neither: the elongation lies between the gaps.
    #[default]
    Open,
    /// The tension truss.
    Tension,
    /// The compression truss.
    Compression,
    /// Both at once: the linear connection.
    Both,
}

/// A branch `N = k e - n0` of the connector law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Branch {
    /// Stiffness k `[N/m]`.
    pub stiffness: f64,
    /// Offset n0 `[N]`.
    pub offset: f64,
}

/// The law of one connector in one job.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Law {
    /// Stiffness of one truss `[N/m]`.
    pub k: f64,
    /// The connection.
    pub connection: Connection,
}

impl Law {
    /// The state that elongation `e` `[m]` asks for.
    #[inline]
    pub(crate) fn state(&self, e: f64) -> State {
        match self.connection {
            Connection::Linear => State::Both,
            Connection::Nonlinear { gap_tension_m, .. } if e > gap_tension_m => State::Tension,
            Connection::Nonlinear { gap_compression_m, .. } if e < -gap_compression_m => State::Compression,
            Connection::Nonlinear { .. } => State::Open,
        }
    }

    /// The branch of the law in a state.
    /// Equation (J2).
    #[inline]
    pub(crate) fn branch(&self, state: State) -> Branch {
        match (state, self.connection) {
            (State::Open, _) => Branch {
                stiffness: 0.0,
                offset: 0.0,
            },
            (_, Connection::Linear) | (State::Both, _) => Branch {
                stiffness: 2.0 * self.k,
                offset: 0.0,
            },
            (State::Tension, Connection::Nonlinear { gap_tension_m, .. }) => Branch {
                stiffness: self.k,
                offset: self.k * gap_tension_m,
            },
            (State::Compression, Connection::Nonlinear { gap_compression_m, .. }) => Branch {
                stiffness: self.k,
                offset: -self.k * gap_compression_m,
            },
        }
    }

    /// Strain energy at elongation `e` `[J]`.
    #[inline]
    pub(crate) fn energy(&self, e: f64) -> f64 {
        let branch = self.branch(self.state(e));
        if branch.stiffness == 0.0 {
            0.0
        } else {
            0.5 * (branch.stiffness * e - branch.offset).powi(2) / branch.stiffness
        }
    }
}
