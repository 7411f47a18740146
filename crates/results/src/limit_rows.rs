//! Rows of the table of limits.
//!
//! Knows what a crossing asks of a limit. Does not know how that came about.

use super::extreme::Extreme;
use pontoon_plan::job::Job;
use serde::{Deserialize, Serialize};

/// A row of the table of limits.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LimitRow {
    /// Which limit, by its word.
    pub limit: String,
    /// What the crossing asks, and when.
    pub demand: Extreme,
    /// What is allowed.
    pub allowed: f64,
    /// How much of it is used up: 1 at the limit.
    pub utilisation: Option<f64>,
    /// Position, joint, module or axle of the demand.
    pub place: Option<usize>,
}

/// The rows of a job that failed.
pub(super) fn limit_rows_of_none(job: &Job) -> Vec<LimitRow> {
    let row = |of: &pontoon_plan::study_file::Allowed| LimitRow {
        limit: of.limit.word().to_owned(),
        demand: Extreme::default(),
        allowed: of.allowed,
        utilisation: None,
        place: None,
    };
    job.shared.limits.iter().map(row).collect()
}

/// The row of the limit of which most is used up, the first of equals.
pub fn governing(rows: &[LimitRow]) -> Option<&LimitRow> {
    let mut most: Option<&LimitRow> = None;
    for row in rows {
        if row.utilisation.is_some() && most.is_none_or(|most| row.utilisation > most.utilisation) {
            most = Some(row);
        }
    }
    most
}
