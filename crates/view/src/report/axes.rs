//! The axes of a study as a page offers them: a value of an axis or a range of values is a bin.
//!
//! Knows how many values are too many. Does not know what was computed at them.

use pontoon_plan::input::Cell;
use pontoon_results::{Seen, labels};
use serde::Serialize;

/// Distinct values up to which each is a bin of its own.
const MOST_VALUES: usize = 60;

/// Bins that more distinct values are put into, of even width.
const BINS: usize = 24;

/// What the values of an axis are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum AxisKind {
    /// Numbers.
    Number,
    /// Words, lists, or both kinds of values.
    Word,
}

/// An axis.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PageAxis {
    /// Its column.
    pub name: String,
    /// In words.
    pub label: String,
    /// Its unit.
    pub unit: &'static str,
    /// What its values are.
    pub kind: AxisKind,
    /// A value a bin, rising; the middle where a bin is a range; null, the last, where the axis has no meaning.
    pub values: Vec<Cell<'static>>,
    /// From and to of each bin, where a bin holds more than one value; a null bin has none.
    pub bins: Option<Vec<Option<[f64; 2]>>>,
    /// Whether all jobs have one value.
    pub constant: bool,
    /// The bin of each row.
    #[serde(skip)]
    pub(super) of_row: Vec<u16>,
}

impl PageAxis {
    /// The axis of a column's cells.
    pub(super) fn new(name: &str, cells: &[Cell<'_>]) -> Self {
        let numeric = cells.iter().all(|cell| cell.is_nothing() || cell.number().is_some());
        let mut axis = Self {
            name: name.to_owned(),
            label: labels::label(name),
            unit: labels::unit(name),
            kind: if numeric { AxisKind::Number } else { AxisKind::Word },
            values: Vec::new(),
            bins: None,
            constant: false,
            of_row: Vec::new(),
        };
        if numeric {
            axis.take_numbers(cells);
        } else {
            axis.take_words(cells);
        }
        axis.constant = !Seen::of(cells.iter().map(Cell::borrowed)).varies();
        axis
    }

    fn take_words(&mut self, cells: &[Cell<'_>]) {
        let mut index = std::collections::HashMap::new();
        for cell in cells {
            let place = *index.entry(cell.to_string()).or_insert_with(|| {
                self.values.push(cell.owned());
                self.values.len() - 1
            });
            self.of_row
                .push(u16::try_from(place.min(usize::from(u16::MAX) - 1)).unwrap_or(u16::MAX));
        }
        self.values.truncate(usize::from(u16::MAX));
    }

    fn take_numbers(&mut self, cells: &[Cell<'_>]) {
        let mut distinct: Vec<f64> = cells.iter().filter_map(Cell::number).map(|x| x + 0.0).collect();
        distinct.sort_by(f64::total_cmp);
        distinct.dedup();
        let (few, first, last) = (distinct.len() <= MOST_VALUES, distinct.first(), distinct.last());
        let bin_of: Box<dyn Fn(f64) -> usize> = match (first, last) {
            (Some(&first), Some(&last)) if !few => {
                let width = (last - first) / BINS as f64;
                let bin = move |x: f64| (((x - first) / width) as usize).min(BINS - 1);
                let edges = |b: usize| [first + b as f64 * width, first + (b + 1) as f64 * width];
                self.values = (0..BINS)
                    .map(|b| Cell::Number(f64::midpoint(edges(b)[0], edges(b)[1])))
                    .collect();
                self.bins = Some((0..BINS).map(|b| Some(edges(b))).collect());
                Box::new(bin)
            }
            _ => {
                self.values = distinct.iter().map(|&x| Cell::Number(x)).collect();
                let distinct = distinct.clone();
                Box::new(move |x| distinct.partition_point(|&d| d < x))
            }
        };
        let nothing = self.values.len();
        if cells.iter().any(Cell::is_nothing) {
            self.values.push(Cell::Nothing);
            if let Some(bins) = &mut self.bins {
                bins.push(None);
            }
        }
        let place = |cell: &Cell<'_>| cell.number().map_or(nothing, |x| bin_of(x + 0.0));
        self.of_row = cells.iter().map(|cell| place(cell) as u16).collect();
    }

    /// Puts neighbouring bins together, two by two; whether there were any to put together.
    pub(super) fn coarsen(&mut self) -> bool {
        let whole = self.values.iter().filter(|value| !value.is_nothing()).count();
        if self.kind == AxisKind::Word || whole < 3 {
            return false;
        }
        let number = |value: &Cell<'_>| value.number().unwrap_or_default();
        let edges = |bin: usize| match &self.bins {
            Some(bins) => bins[bin].unwrap_or_default(),
            None => [number(&self.values[bin]); 2],
        };
        let pairs: Vec<[f64; 2]> = (0..whole)
            .step_by(2)
            .map(|bin| [edges(bin)[0], edges((bin + 1).min(whole - 1))[1]])
            .collect();
        let mut values: Vec<Cell<'static>> = pairs
            .iter()
            .map(|[from, to]| Cell::Number(f64::midpoint(*from, *to)))
            .collect();
        let mut bins: Vec<Option<[f64; 2]>> = pairs.into_iter().map(Some).collect();
        if self.values.len() > whole {
            values.push(Cell::Nothing);
            bins.push(None);
        }
        let last = (values.len() - 1) as u16;
        for bin in &mut self.of_row {
            *bin = if usize::from(*bin) >= whole { last } else { *bin / 2 };
        }
        (self.values, self.bins) = (values, Some(bins));
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::{Value, json};

    fn cells(values: &[Value]) -> Vec<Cell<'_>> {
        values.iter().map(Cell::of).collect()
    }

    #[test]
    fn few_values_are_bins_of_their_own_and_null_is_the_last() {
        let values = [json!(7.0), json!(null), json!(3.0), json!(7.0), json!(-0.0)];
        let axis = PageAxis::new("speed_m_s", &cells(&values));
        let expected = [json!(-0.0), json!(3.0), json!(7.0), json!(null)];
        assert_eq!(axis.values, cells(&expected));
        assert_eq!(axis.of_row, [2, 3, 1, 2, 0]);
        assert!(axis.bins.is_none() && !axis.constant);
    }

    #[test]
    fn many_values_are_put_into_bins_that_hold_them() {
        let cells: Vec<Cell<'_>> = (0..1000).map(|i| Cell::Number(2.0 + 0.018 * f64::from(i))).collect();
        let mut axis = PageAxis::new("speed_m_s", &cells);
        let holds = |axis: &PageAxis| {
            let bins = axis.bins.as_ref().unwrap();
            cells.iter().zip(&axis.of_row).all(|(cell, &bin)| {
                let ([from, to], x) = (bins[usize::from(bin)].unwrap(), cell.number().unwrap());
                from <= x + 1e-9 && x <= to + 1e-9
            })
        };
        assert_eq!(axis.values.len(), BINS);
        assert!(holds(&axis));
        assert!(axis.coarsen());
        assert_eq!(axis.values.len(), BINS / 2);
        assert!(holds(&axis));
    }

    #[test]
    fn words_and_lists_are_bins_in_the_order_of_their_rows() {
        let values = [json!("linear"), json!([-3.0, -1.0]), json!("linear")];
        let mut axis = PageAxis::new("vehicle.track_y_m", &cells(&values));
        assert_eq!((axis.values.len(), axis.of_row.clone()), (2, vec![0, 1, 0]));
        assert!(!axis.coarsen());
    }
}
