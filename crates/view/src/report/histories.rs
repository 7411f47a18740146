//! Recorded histories, thinned for a page.
//!
//! Knows how many histories fit a page with fewer points. Does not know which jobs matter.

use super::packed::Packed;
use crate::thinning::thinned;
use pontoon_results::{Results, ResultsError, TableName, labels};
use serde::Serialize;
use std::collections::HashSet;

/// Most histories that a page carries.
const MOST: usize = 160;

/// A history.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct HistoryLine {
    /// The job.
    pub job: u32,
    /// Its axes in words.
    pub axes: String,
    /// Position or joint.
    pub position: u32,
    /// `deflection_m` or `force_n`.
    pub quantity: String,
    /// Its unit.
    pub unit: &'static str,
    /// Times `[s]`.
    pub time_s: Packed,
    /// Values.
    pub value: Packed,
}

/// A history as its rows come.
#[derive(Debug, Default)]
struct Gathered {
    job: u32,
    quantity: String,
    position: u32,
    time_s: Vec<f64>,
    value: Vec<f64>,
}

impl Gathered {
    fn is(&self, job: u32, quantity: &str, position: u32) -> bool {
        self.job == job && self.position == position && self.quantity == quantity
    }

    fn line(&self, axes: String) -> HistoryLine {
        let kept = thinned(&self.value);
        let of = |list: &[f64]| Packed::numbers(kept.iter().map(|&i| Some(list[i])));
        HistoryLine {
            job: self.job,
            axes,
            position: self.position,
            quantity: self.quantity.clone(),
            unit: labels::unit(&self.quantity),
            time_s: of(&self.time_s),
            value: of(&self.value),
        }
    }
}

/// The first histories of the jobs that are wanted, and how many there are of all jobs.
///
/// # Errors
/// [`ResultsError::Damaged`].
pub(super) fn histories(
    results: &Results,
    wanted: &HashSet<u32>,
    row_label: &dyn Fn(usize) -> String,
) -> Result<(Vec<HistoryLine>, usize), ResultsError> {
    let (mut lines, mut count, mut now) = (Vec::new(), 0, Gathered::default());
    let mut flush = |now: &Gathered| {
        if !now.value.is_empty() && lines.len() < MOST {
            let row = results.row_of_job(u64::from(now.job));
            lines.push(now.line(row.map(row_label).unwrap_or_default()));
        }
    };
    let columns = ["job", "time_s", "quantity", "position", "value"];
    results.scan(TableName::Histories, &columns, |part| {
        let Some(quantities) = part.word_cells("quantity") else {
            return;
        };
        for (row, quantity) in quantities.iter().enumerate() {
            let quantity = quantity.as_deref().unwrap_or_default();
            let place = |column| part.number(column, row).map_or(u32::MAX, |x| x as u32);
            let (job, position) = (place("job"), place("position"));
            if count == 0 || !now.is(job, quantity, position) {
                flush(&now);
                count += 1;
                now = Gathered {
                    job,
                    quantity: quantity.to_owned(),
                    position,
                    ..Gathered::default()
                };
            }
            let sample = part.number("time_s", row).zip(part.number("value", row));
            if let Some((time_s, value)) = sample.filter(|_| wanted.contains(&job)) {
                now.time_s.push(time_s);
                now.value.push(value);
            }
        }
    })?;
    flush(&now);
    Ok((lines, count))
}
