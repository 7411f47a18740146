//! What is known of the jobs before any figure: which axes vary, which marks a reference has, what was left out.
//!
//! Knows jobs and axes. Does not know what is drawn of them.

use super::figure::{FigureMeasure, PlottedMark};
use super::marks::{Chart, Origin, ReferenceMark};
use pontoon_plan::input::Cell;
use pontoon_results::{Results, Seen, Table, TableName, labels};
use std::collections::{BTreeMap, HashMap};

/// Jobs to be drawn.
pub(super) struct FigureContext<'a> {
    pub results: &'a Results,
    /// Rows of the jobs that did not fail.
    pub rows: Vec<usize>,
    /// Every axis.
    pub axes: Vec<String>,
    /// Axes of which those jobs have several values; nothing, where an axis has no meaning, is none.
    pub varying: Vec<String>,
    /// Of each axis which of its distinct values each row of the table of jobs has; none where it has no meaning.
    codes: BTreeMap<String, Vec<Option<u32>>>,
    /// Whether the job of each row of the table of jobs is linearly connected.
    linear: Vec<bool>,
    /// Points of a reference.
    pub marks: Vec<ReferenceMark>,
    /// What no figure holds.
    pub left_out: Vec<String>,
}

/// What expected marks are called in a legend; which checks they are of stands in the caption's file.
const EXPECTED: &str = "reference value";

impl<'a> FigureContext<'a> {
    pub(super) fn new(results: &'a Results, marks: Vec<ReferenceMark>) -> Self {
        let jobs = results.jobs();
        let rows: Vec<usize> = (0..jobs.rows()).filter(|row| !results.is_failed(*row)).collect();
        let axes = results.axes();
        let codes: BTreeMap<String, Vec<Option<u32>>> =
            axes.iter().map(|axis| (axis.clone(), jobs.codes(axis))).collect();
        let several = |axis: &&String| Seen::of(rows.iter().map(|row| jobs.cell(axis, *row))).has_several();
        let varying = axes.iter().filter(several).cloned().collect();
        let connection = jobs.word_cells("connection").unwrap_or_default().iter();
        let mut linear: Vec<bool> = connection.map(|word| word.as_deref() == Some("linear")).collect();
        linear.resize(jobs.rows(), false);
        Self {
            results,
            rows,
            axes,
            varying,
            codes,
            linear,
            marks,
            left_out: Vec::new(),
        }
    }

    pub(super) fn cell(&self, axis: &str, row: usize) -> Cell<'_> {
        self.results.jobs().cell(axis, row)
    }

    pub(super) fn number(&self, axis: &str, row: usize) -> Option<f64> {
        self.results.jobs().number(axis, row)
    }

    pub(super) fn job(&self, row: usize) -> u64 {
        self.results.job_of_row(row)
    }

    pub(super) fn is_linear(&self, row: usize) -> bool {
        self.linear[row]
    }

    /// Which of an axis's distinct values the job of a row has; none where the axis has no meaning for it.
    pub(super) fn code(&self, axis: &str, row: usize) -> Option<u32> {
        self.codes.get(axis).and_then(|codes| codes[row])
    }

    /// Rows by what they have in some axes, in the order of their first row.
    pub(super) fn grouped(&self, rows: &[usize], axes: &[&String]) -> Vec<Vec<usize>> {
        let mut group = vec![0; rows.len()];
        let mut count = usize::from(!rows.is_empty());
        for codes in axes.iter().filter_map(|axis| self.codes.get(*axis)) {
            let mut known: HashMap<(usize, Option<u32>), usize> = HashMap::new();
            for (own, row) in group.iter_mut().zip(rows) {
                let next = known.len();
                *own = *known.entry((*own, codes[*row])).or_insert(next);
            }
            count = known.len();
        }
        let mut groups = vec![Vec::new(); count];
        for (own, row) in group.into_iter().zip(rows) {
            groups[own].push(*row);
        }
        groups
    }

    /// What all of some rows have alike, in words: `compression gap 5.5 mm, load 230.3 kN`. Axes of `told` are not said.
    pub(super) fn alike(&self, rows: &[usize], told: &[&str]) -> Vec<String> {
        let of = |axis: &String| {
            let seen = Seen::of(rows.iter().map(|row| self.cell(axis, *row)));
            seen.only().map(|cell| axis_label(axis, cell))
        };
        // of a load at a position its place is said
        let placed = rows.iter().any(|row| self.number("load_position", *row).is_some());
        let skipped = |axis: &str| told.contains(&axis) || (placed && axis == "load_x_m");
        let axes = self.axes.iter().filter(|axis| !skipped(axis));
        axes.filter_map(of).collect()
    }

    /// The marks of a chart that belong to any of some rows.
    pub(super) fn marks_of(&self, rows: &[usize], asked: &MarkRequest<'_>) -> Vec<PlottedMark> {
        let jobs = self.results.jobs();
        let meant = |mark: &&ReferenceMark| {
            mark.chart == asked.chart
                && mark.table == asked.table
                && asked.columns.contains(&mark.column.as_str())
                && (asked.position.is_none() || mark.position == asked.position)
                && rows.iter().any(|row| mark.belongs_to(jobs, *row))
        };
        let plotted = |mark: &ReferenceMark| {
            Some(PlottedMark {
                label: match mark.origin {
                    Origin::Measured => mark.label.clone(),
                    Origin::Expected => EXPECTED.to_owned(),
                },
                origin: mark.origin,
                id: mark.id.clone(),
                point: [mark.x? * asked.x.factor, mark.y * asked.y.factor * asked.sign],
            })
        };
        self.marks.iter().filter(meant).filter_map(plotted).collect()
    }
}

/// The rows of a table by job.
pub(super) fn rows_by_job(table: &Table) -> HashMap<u64, Vec<usize>> {
    let mut found: HashMap<u64, Vec<usize>> = HashMap::new();
    for (row, job) in table.numbers("job").unwrap_or_default().iter().enumerate() {
        if let Some(job) = job {
            found.entry(*job as u64).or_default().push(row);
        }
    }
    found
}

/// Which marks are asked for, and in which units.
pub(super) struct MarkRequest<'a> {
    pub chart: Chart,
    pub table: TableName,
    pub columns: &'a [&'a str],
    /// Of which position or joint, where it is one's.
    pub position: Option<u32>,
    pub x: FigureMeasure,
    pub y: FigureMeasure,
    /// -1 where it is drawn the other way: uplift on an axis of deflection.
    pub sign: f64,
}

/// An axis with its value in words.
pub(super) fn axis_label(axis: &str, value: &Cell<'_>) -> String {
    match axis {
        "connection" => format!("{} connection", labels::value(axis, value)),
        _ => format!("{} {}", labels::label(axis), labels::value(axis, value)),
    }
}

/// Words joined as a sentence has them: `a, b and c`.
pub(super) fn listed(words: &[String]) -> String {
    match words {
        [] => String::new(),
        [one] => one.clone(),
        [several @ .., last] => format!("{} and {last}", several.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn lists_and_axes_read_as_sentences() {
        let words = ["a", "b", "c"].map(str::to_owned);
        assert_eq!(
            [listed(&words), listed(&words[..1]), listed(&[])],
            ["a, b and c", "a", ""]
        );
        assert_eq!(
            axis_label("gap_tension_m", &Cell::of(&json!(0.028))),
            "tension gap 28 mm"
        );
        assert_eq!(
            axis_label("connection", &Cell::of(&json!("linear"))),
            "linear connection"
        );
    }
}
