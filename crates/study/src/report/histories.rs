//! Recorded histories, thinned for a page.
//!
//! Knows how a curve keeps its peaks with fewer points. Does not know which jobs matter.

use super::packed::Packed;
use crate::tables::{Results, TableName};
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

/// The first histories of the table, and how many there are. `jobs` are the ones wanted.
pub(super) fn histories(
    results: &Results,
    jobs: &HashSet<u32>,
    said: &dyn Fn(usize) -> String,
) -> (Vec<HistoryLine>, usize) {
    let Some(table) = results.table(TableName::Histories) else {
        return (Vec::new(), 0);
    };
    let columns = (
        table.numbers("job"),
        table.numbers("time_s"),
        table.word_cells("quantity"),
        table.numbers("position"),
        table.numbers("value"),
    );
    let (Some(job), Some(time), Some(quantity), Some(position), Some(value)) = columns else {
        return (Vec::new(), 0);
    };
    let (mut lines, mut count, mut start) = (Vec::new(), 0, 0);
    while start < table.rows() {
        let same = |row: &usize| {
            job[*row] == job[start] && quantity[*row] == quantity[start] && position[*row] == position[start]
        };
        let end = (start..table.rows()).take_while(same).last().unwrap_or(start) + 1;
        let number = job[start].map_or(u32::MAX, |job| job as u32);
        count += 1;
        if lines.len() < MOST && jobs.contains(&number) {
            let word = quantity[start].clone().unwrap_or_default();
            let kept = thinned(&value[start..end]);
            let of = |list: &[Option<f64>]| Packed::numbers(kept.iter().map(|i| list[start + i]));
            lines.push(HistoryLine {
                job: number,
                axes: results.row_of_job(u64::from(number)).map(said).unwrap_or_default(),
                position: position[start].map_or(0, |position| position as u32),
                unit: super::words::unit(&word),
                quantity: word,
                time_s: of(time),
                value: of(value),
            });
        }
        start = end;
    }
    (lines, count)
}

/// Places of a list that keep its first, its last, and the smallest and the largest of each stretch.
fn thinned(values: &[Option<f64>]) -> Vec<usize> {
    if values.len() <= 2 * STRETCHES {
        return (0..values.len()).collect();
    }
    let mut kept = vec![0, values.len() - 1];
    for stretch in 0..STRETCHES {
        let (from, to) = (
            stretch * values.len() / STRETCHES,
            (stretch + 1) * values.len() / STRETCHES,
        );
        let of = |i: &usize| values[*i].unwrap_or_default();
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
        let mut values: Vec<Option<f64>> = (0..5000).map(|i| Some(f64::sin(0.01 * f64::from(i)))).collect();
        values[1234] = Some(9.0);
        values[3333] = Some(-9.0);
        let kept = thinned(&values);
        assert!(kept.len() <= 2 * STRETCHES + 2 && kept.windows(2).all(|w| w[0] < w[1]));
        assert!([0, 1234, 3333, 4999].iter().all(|place| kept.contains(place)));
        assert_eq!(thinned(&values[..10]).len(), 10);
    }
}
