//! Rows of what a bridge does at rest, and of the freeboards of its decks' corners.
//!
//! Knows which corner of which module a row is of. Does not know how a number was found.

use super::extreme::Extreme;
use pontoon_plan::job::Job;
use serde::{Deserialize, Serialize};

/// A row of the table of what is at rest.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DeadRow {
    /// What it is, by its word.
    pub quantity: String,
    /// Position of a deflection or freeboard, joint of a force.
    pub position: Option<usize>,
    /// The module, of its sinkage, trim, heel and freeboard.
    pub module: Option<usize>,
    /// The bank, of a reaction.
    pub bank: Option<usize>,
    /// Place across `[m]`; null of a sum.
    pub y_m: Option<f64>,
    /// The value, in the unit of the quantity.
    pub value: f64,
}

/// A row of the table of freeboards.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FreeboardRow {
    /// The module.
    pub module: usize,
    /// Position of its end.
    pub position: usize,
    /// Place across of the deck's edge `[m]`.
    pub y_m: f64,
    /// Smallest freeboard `[m]`, and when it is.
    pub least: Extreme,
}

/// The rows of the freeboards of a job that failed; none where they are not recorded.
pub(crate) fn freeboard_rows_of_none(job: &Job) -> Vec<FreeboardRow> {
    let modules = if job.shared.record.freeboards {
        job.shared.bridge.design.modules
    } else {
        0
    };
    let rows = (0..4 * modules).map(|corner| FreeboardRow::of_corner(corner, job, Extreme::default()));
    rows.collect()
}

impl FreeboardRow {
    /// Of a corner of the modules' decks: module after module, left and right end, lower and higher y.
    pub fn of_corner(corner: usize, job: &Job, least: Extreme) -> Self {
        let (module, end, edge) = (corner / 4, corner % 4 / 2, corner % 2);
        let half_m = 0.5 * job.shared.bridge.design.module.breadth_m;
        Self {
            module: module + 1,
            position: module + 1 + end,
            y_m: if edge == 0 { -half_m } else { half_m },
            least,
        }
    }
}
