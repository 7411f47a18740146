//! When a crossing that failed is solved once more.
//!
//! Knows that contacts may settle at half the step. Does not know how a crossing is solved.

use pontoon_core::analysis::AnalysisError;

/// The time step at which a crossing is solved once more, as a share of its own.
pub const RETRY_STEP_SHARE: f64 = 0.5;

/// Whether a crossing that failed so is solved once more at half its time step: its contacts did not settle.
pub fn half_step_may_help(error: &AnalysisError) -> bool {
    matches!(
        error,
        AnalysisError::NotConverged { .. } | AnalysisError::NotFinite { .. }
    )
}
