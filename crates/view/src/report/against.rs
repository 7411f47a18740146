//! The largest of each measure against one axis, all other axes taken together: what a page says where its script may not run.
//!
//! Knows which axis a reader looks along first. Does not know markup.

use super::axes::{AxisKind, PageAxis};
use super::cells::PageMeasure;
use pontoon_plan::input::Cell;
use pontoon_results::{Results, labels};

/// Axes that a reader looks along first.
const FIRST: [&str; 3] = ["speed_m_s", "load_position", "load_x_m"];

/// A table of few rows.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct AgainstTable {
    /// The axis in words; none where no axis has numbers.
    pub axis: Option<String>,
    /// Of each bin of the axis the largest of each measure in words, its unit with it.
    pub rows: Vec<(String, Vec<String>)>,
}

impl AgainstTable {
    pub(super) fn new(results: &Results, axes: &[PageAxis], measures: &[PageMeasure]) -> Self {
        let numeric = |axis: &&PageAxis| axis.kind == AxisKind::Number && axis.values.iter().any(|v| !v.is_nothing());
        let mut first = FIRST
            .iter()
            .filter_map(|name| axes.iter().find(|axis| axis.name == *name));
        let Some(axis) = first.find(numeric).or_else(|| axes.iter().find(numeric)) else {
            return Self::default();
        };
        let mut largest = vec![vec![None::<f64>; measures.len()]; axis.values.len()];
        for (m, measure) in measures.iter().enumerate() {
            let numbers = results.jobs().numbers(measure.name).unwrap_or_default();
            for (row, x) in numbers.iter().enumerate() {
                let Some(x) = x.filter(|_| !results.is_failed(row)) else {
                    continue;
                };
                let kept = &mut largest[usize::from(axis.of_row[row])][m];
                *kept = Some(kept.map_or(x, |most| most.max(x)));
            }
        }
        let said = |name: &str, x: Option<f64>| labels::value(name, &x.into());
        let row = |(bin, largest): (usize, Vec<Option<f64>>)| {
            let values = measures.iter().zip(largest).map(|(m, x)| said(m.name, x));
            (bin_in_words(axis, bin), values.collect())
        };
        Self {
            axis: Some(axis.label.clone()),
            rows: largest.into_iter().enumerate().map(row).collect(),
        }
    }
}

/// A bin of an axis: its value, or from where to where it goes.
fn bin_in_words(axis: &PageAxis, bin: usize) -> String {
    let edges = axis.bins.as_ref().and_then(|bins| *bins.get(bin)?);
    match edges {
        Some([from, to]) if from < to => {
            let said = [from, to].map(|x| labels::value(&axis.name, &Cell::Number(x)));
            format!("{} to {}", said[0], said[1])
        }
        _ => labels::value(&axis.name, &axis.values[bin]),
    }
}
