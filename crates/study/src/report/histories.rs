//! Recorded histories, thinned for a page.
//!
//! Knows how a curve keeps its peaks with fewer points. Does not know which jobs matter.

use super::packed::Packed;
use crate::tables::{Results, ResultsError, TableName};
use serde::Serialize;
use std::collections::HashSet;

/// Most histories that a page carries.
const MOST: usize = 160;

/// Stretches of a history, of each of which its smallest and its largest value are kept.
const STRETCHES: usize = 400;

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
    /// Times [s].
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
            unit: super::words::unit(&self.quantity),
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
    said: &dyn Fn(usize) -> String,
) -> Result<(Vec<HistoryLine>, usize), ResultsError> {
    let (mut lines, mut count, mut now) = (Vec::new(), 0, Gathered::default());
    let mut flush = |now: &Gathered| {
        if !now.value.is_empty() && lines.len() < MOST {
            let row = results.row_of_job(u64::from(now.job));
            lines.push(now.line(row.map(said).unwrap_or_default()));
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

/// Places of a list that keep its first, its last, and the smallest and the largest of each stretch.
pub(crate) fn thinned(values: &[f64]) -> Vec<usize> {
    if values.len() <= 2 * STRETCHES {
        return (0..values.len()).collect();
    }
    let mut kept = vec![0, values.len() - 1];
    for stretch in 0..STRETCHES {
        let (from, to) = (
            stretch * values.len() / STRETCHES,
            (stretch + 1) * values.len() / STRETCHES,
        );
        let of = |i: &usize| values[*i];
        let by = |a: &usize, b: &usize| of(a).total_cmp(&of(b)).then(b.cmp(a));
        kept.extend((from..to).min_by(by));
        kept.extend((from..to).max_by(by));
    }
    kept.sort_unstable();
    kept.dedup();
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thinned_lists_keep_their_ends_and_peaks() {
        let mut values: Vec<f64> = (0..5000).map(|i| f64::sin(0.01 * f64::from(i))).collect();
        values[1234] = 9.0;
        values[3333] = -9.0;
        let kept = thinned(&values);
        assert!(kept.len() <= 2 * STRETCHES + 2 && kept.windows(2).all(|w| w[0] < w[1]));
        assert!([0, 1234, 3333, 4999].iter().all(|place| kept.contains(place)));
        assert_eq!(thinned(&values[..10]).len(), 10);
    }
}
