//! The connector: a tension truss and a compression truss, each with its gap.
//!
//! Knows force against elongation. Does not know where the elongation comes from.

/// How the trusses of every connector work in a job.
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

/// A line `N = k e - n0` of the connector law: its slope k `[N/m]` and offset n0 `[N]`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Line {
    /// Slope `[N/m]`.
    pub k: f64,
    /// Offset `[N]`.
    pub n0: f64,
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

    /// The line of the law in a state.
    #[inline]
    pub(crate) fn line(&self, state: State) -> Line {
        match (state, self.connection) {
            (State::Open, _) => Line { k: 0.0, n0: 0.0 },
            (_, Connection::Linear) | (State::Both, _) => Line {
                k: 2.0 * self.k,
                n0: 0.0,
            },
            (State::Tension, Connection::Nonlinear { gap_tension_m, .. }) => Line {
                k: self.k,
                n0: self.k * gap_tension_m,
            },
            (State::Compression, Connection::Nonlinear { gap_compression_m, .. }) => Line {
                k: self.k,
                n0: -self.k * gap_compression_m,
            },
        }
    }

    /// Strain energy at elongation `e` `[J]`.
    #[inline]
    pub(crate) fn energy(&self, e: f64) -> f64 {
        let line = self.line(self.state(e));
        if line.k == 0.0 {
            0.0
        } else {
            0.5 * (line.k * e - line.n0).powi(2) / line.k
        }
    }
}
