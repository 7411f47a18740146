//! Natural frequencies for people: a row a shape, a column a job.
//!
//! Knows how modes of one name are told apart. Does not know where rows come from.

use super::label::{ColumnHead, heads};
use super::survey::SummaryRow;
use super::text_table::{RowNames, TableEntry, TextTable};
use crate::terminal::{FAINT, TextStyle};
use crate::text::{listed, wrapped};
use anstyle::Style;
use pontoon_plan::input::Cell;
use pontoon_results::Seen;
use pontoon_results::labels::{self, printable};

/// Jobs and shapes that are written at most.
const MOST_JOBS: usize = 12;
const MOST_SHAPES: usize = 60;

/// A shape: its name, and how many modes of that name stand before it.
type ShapeName = (String, usize);

/// A job: its axes, and the shapes and frequencies of its modes.
struct OfJob<'a> {
    axes: SummaryRow<'a>,
    modes: Vec<(ShapeName, f64)>,
}

impl<'a> OfJob<'a> {
    /// The first jobs, and how many more there are. A row ends in the number of a mode, its frequency and its shape.
    fn all(axes: usize, rows: impl Iterator<Item = SummaryRow<'a>>) -> (Vec<Self>, usize) {
        let mut jobs: Vec<Self> = Vec::new();
        let mut left = 0;
        for row in rows {
            let begins = row[axes] == Cell::Whole(1) || jobs.is_empty();
            if begins && jobs.len() == MOST_JOBS {
                left += 1;
            }
            if left > 0 {
                continue;
            }
            if begins {
                jobs.push(Self {
                    axes: row[..axes].to_vec(),
                    modes: Vec::new(),
                });
            }
            if let Some(job) = jobs.last_mut() {
                job.push(&row[axes + 1], &row[axes + 2]);
            }
        }
        (jobs, left)
    }

    fn push(&mut self, frequency: &Cell<'_>, shape: &Cell<'_>) {
        let shape = printable(shape.word().unwrap_or_default());
        // several modes may have one name
        let same = self.modes.iter().filter(|((name, _), _)| *name == shape).count();
        self.modes.push(((shape, same), frequency.number().unwrap_or_default()));
    }

    fn frequency(&self, shape: &ShapeName) -> TableEntry {
        let found = self.modes.iter().find(|(name, _)| name == shape);
        TableEntry {
            text: found.map_or(String::new(), |(_, hz)| labels::digits("frequency_hz", *hz)),
            style: Style::new(),
        }
    }
}

/// The frequencies of a summary of modes.
pub(super) fn modes<'a>(
    columns: &[String],
    rows: impl Iterator<Item = SummaryRow<'a>>,
    text_style: TextStyle,
    width: usize,
) -> String {
    let axes = columns.len() - 3;
    let (jobs, left) = OfJob::all(axes, rows);
    let heads = heads(&columns[..axes]);
    let seen: Vec<Seen> = (0..axes)
        .map(|i| Seen::of(jobs.iter().map(|job| job.axes[i].borrowed())))
        .collect();
    let (varying, constant): (Vec<usize>, Vec<usize>) = (0..axes).partition(|&i| seen[i].varies());
    let mut text = wrapped("natural frequencies [Hz]", width, 2);
    if let Some(job) = jobs.first().filter(|_| !constant.is_empty()) {
        let constant = constant.iter().map(|&i| heads[i].told(&job.axes[i]));
        text += &listed("throughout: ", constant, width, 2);
    }
    let mut shapes: Vec<&ShapeName> = Vec::new();
    for (shape, _) in jobs.iter().flat_map(|job| &job.modes) {
        if !shapes.contains(&shape) {
            shapes.push(shape);
        }
    }
    let more_shapes = shapes.len().saturating_sub(MOST_SHAPES);
    shapes.truncate(MOST_SHAPES);
    text.push('\n');
    if jobs.is_empty() {
        text += "none: all jobs failed\n";
    }
    text += &grid(&jobs, &shapes, &varying, &heads).written(width, text_style);
    for (more, of) in [(left, "jobs"), (more_shapes, "shapes")] {
        if more > 0 {
            text += &(text_style.painted(FAINT, &format!("and {more} more {of}: see summary.csv")) + "\n");
        }
    }
    text
}

/// A row a shape, a column a job.
fn grid(jobs: &[OfJob<'_>], shapes: &[&ShapeName], varying: &[usize], heads: &[ColumnHead]) -> TextTable {
    let or_blank = |names: Vec<String>| if names.is_empty() { vec![String::new()] } else { names };
    let names: Vec<String> = shapes.iter().map(|(name, _)| name.clone()).collect();
    let texts = |&i: &usize| labels::listed_apart(&jobs.iter().map(|job| &job.axes[i]).collect::<Vec<_>>());
    let texts: Vec<Vec<String>> = varying.iter().map(texts).collect();
    TextTable {
        gap: 2,
        names: vec![RowNames {
            head: or_blank(varying.iter().map(|&i| heads[i].united()).collect()),
            rows: names.clone(),
            told: names,
        }],
        heads: (0..jobs.len())
            .map(|job| or_blank(texts.iter().map(|of_axis| of_axis[job].clone()).collect()))
            .collect(),
        rows: shapes
            .iter()
            .map(|shape| jobs.iter().map(|job| job.frequency(shape)).collect())
            .collect(),
    }
}
