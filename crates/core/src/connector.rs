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
