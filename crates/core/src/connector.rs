//! The connector: a tension truss and a compression truss, each with its gap and, where it has one, its stop.
//!
//! Knows force against elongation. Does not know where the elongation comes from.

use std::sync::Arc;

/// How the trusses of every connector work in a job that has no law of its own.
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

/// The law of one connector, piecewise linear in its elongation and nowhere falling, with dashpots beside the trusses at work.
/// Equations (J4), (J5).
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ConnectorLaw {
    /// Both trusses at work at once, without gaps: `N = 2 k e`.
    Linear {
        /// Stiffness k of one truss `[N/m]`; 0 of a lost connector.
        stiffness_n_m: f64,
        /// Coefficient c of the dashpot of one truss `[N s/m]`; 0 of a lost connector.
        damping_n_s_m: f64,
    },
    /// A truss in tension and one in compression, which work beyond their gaps.
    Gaps {
        /// The tension truss.
        tension: Truss,
        /// The compression truss, its gaps counted in shortening.
        compression: Truss,
    },
}

/// One truss of a connector: `N = k (s - gap)` for an elongation, or a shortening, s beyond its gap.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Truss {
    /// Stiffness k `[N/m]`; 0 of a truss that is not there, which never works.
    pub stiffness_n_m: f64,
    /// Gap `[m]`; below 0 under a preload.
    pub gap_m: f64,
    /// Coefficient c of its dashpot `[N s/m]`; 0 without one, and of a truss that is not there.
    pub damping_n_s_m: f64,
    /// Its stop, where it has one: the truss is then the buffer before it.
    pub stop: Option<EndStop>,
}

/// The second branch of a truss: `N = k (gap_stop - gap) + k_stop (s - gap_stop)` beyond its own gap.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EndStop {
    /// Stiffness of the branch, buffer and stop together `[N/m]`; above 0.
    pub stiffness_n_m: f64,
    /// Gap `[m]`, beyond that of the truss.
    pub gap_m: f64,
}

/// The connectors of a bridge that have laws of their own, by place from 0 in the order of joints and places across.
pub type OwnLaws = Arc<[(usize, ConnectorLaw)]>;

impl ConnectorLaw {
    /// The law of a connector whose two trusses have one stiffness k `[N/m]`.
    pub fn new(stiffness_n_m: f64, connection: Connection) -> Self {
        let truss = |gap_m| Truss {
            stiffness_n_m,
            gap_m,
            damping_n_s_m: 0.0,
            stop: None,
        };
        match connection {
            Connection::Linear => Self::Linear {
                stiffness_n_m,
                damping_n_s_m: 0.0,
            },
            Connection::Nonlinear {
                gap_tension_m,
                gap_compression_m,
            } => Self::Gaps {
                tension: truss(gap_tension_m),
                compression: truss(gap_compression_m),
            },
        }
    }

    /// Coefficients of the dashpots that act in tension and in compression `[N s/m]`; of the linear connection both trusses'
    /// in either sense.
    pub fn dampings_n_s_m(&self) -> [f64; 2] {
        match self {
            Self::Linear { damping_n_s_m, .. } => [2.0 * damping_n_s_m; 2],
            Self::Gaps { tension, compression } => [tension, compression].map(|truss| truss.damping_n_s_m),
        }
    }

    /// The law of the connector at rest, which dashpots do not change.
    #[must_use]
    pub fn at_rest(mut self) -> Self {
        match &mut self {
            Self::Linear { damping_n_s_m, .. } => *damping_n_s_m = 0.0,
            Self::Gaps { tension, compression } => {
                (tension.damping_n_s_m, compression.damping_n_s_m) = (0.0, 0.0);
            }
        }
        self
    }
}

/// Which branch of its law a connector is on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub enum State {
    /// No truss at work: the elongation lies between the gaps.
    #[default]
    Open,
    /// The tension truss.
    Tension,
    /// The tension truss at its stop.
    TensionStop,
    /// The compression truss.
    Compression,
    /// The compression truss at its stop.
    CompressionStop,
    /// Both trusses at once: the linear connection.
    Both,
}

impl State {
    /// Number of states.
    pub(crate) const COUNT: usize = 6;
}
