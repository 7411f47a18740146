//! Natural frequencies for people: a row a shape, a column a job.
//!
//! Knows how modes of one name are told apart. Does not know where rows come from.

use super::grid::{Cell, Grid, Names};
use super::label::{axis, heads, told};
use super::survey::Row;
use crate::terminal::{FAINT, Look};
use crate::words::{listed, wrapped};
use anstyle::Style;
use pontoon_view::labels::printable;
use serde_json::Value;

/// Jobs and shapes that are written at most.
const MOST_JOBS: usize = 12;
const MOST_SHAPES: usize = 60;

/// A job: its axes, and the shapes and frequencies of its modes.
struct OfJob {
    axes: Vec<Value>,
    modes: Vec<((String, usize), f64)>,
}

/// The frequencies of a summary of modes.
pub(super) fn modes(columns: &[String], rows: impl Iterator<Item = Row>, look: Look, width: usize) -> String {
    let axes = columns.len() - 3;
    let mut jobs: Vec<OfJob> = Vec::new();
    let mut left = 0;
    for row in rows {
        let begins = row[axes].as_u64() == Some(1) || jobs.is_empty();
        if begins && jobs.len() == MOST_JOBS {
            left += 1;
        }
        if left > 0 {
            continue;
        }
        if begins {
            jobs.push(OfJob {
                axes: row[..axes].to_vec(),
                modes: Vec::new(),
            });
        }
        let shape = printable(row[axes + 2].as_str().unwrap_or_default());
        if let Some(job) = jobs.last_mut() {
            // several modes may have one name
            let same = job.modes.iter().filter(|((name, _), _)| *name == shape).count();
            job.modes
                .push(((shape, same), row[axes + 1].as_f64().unwrap_or_default()));
        }
    }
    let heads = heads(&columns[..axes]);
    let varies = |i: usize| jobs.iter().any(|job| job.axes[i] != jobs[0].axes[i]);
    let (varying, constant): (Vec<usize>, Vec<usize>) = (0..axes).partition(|&i| varies(i));
    let mut text = wrapped("natural frequencies [Hz]", width, 2);
    if !constant.is_empty() && !jobs.is_empty() {
        let constant: Vec<String> = constant.iter().map(|&i| told(&heads[i], &jobs[0].axes[i])).collect();
        text += &listed("throughout: ", constant.iter(), width, 2);
    }
    let mut shapes: Vec<&(String, usize)> = Vec::new();
    for (shape, _) in jobs.iter().flat_map(|job| &job.modes) {
        if !shapes.contains(&shape) {
            shapes.push(shape);
        }
    }
    let all = shapes.len();
    shapes.truncate(MOST_SHAPES);
    let frequency = |job: &OfJob, shape: &(String, usize)| {
        let found = job.modes.iter().find(|(name, _)| name == shape);
        Cell {
            text: found.map_or(String::new(), |(_, hz)| format!("{hz:.5}")),
            style: Style::new(),
        }
    };
    let head = varying.iter().map(|&i| {
        let (name, unit) = &heads[i];
        unit.map_or(name.clone(), |unit| format!("{name} [{unit}]"))
    });
    let grid = Grid {
        gap: 2,
        names: vec![Names {
            head: if varying.is_empty() {
                vec![String::new()]
            } else {
                head.collect()
            },
            rows: shapes.iter().map(|(name, _)| name.clone()).collect(),
            told: shapes.iter().map(|(name, _)| name.clone()).collect(),
        }],
        heads: jobs
            .iter()
            .map(|job| match varying.as_slice() {
                [] => vec![String::new()],
                varying => varying.iter().map(|&i| axis(&job.axes[i])).collect(),
            })
            .collect(),
        rows: shapes
            .iter()
            .map(|shape| jobs.iter().map(|job| frequency(job, shape)).collect())
            .collect(),
    };
    text.push('\n');
    if jobs.is_empty() {
        text += "none: all jobs failed\n";
    }
    text += &grid.written(width, look);
    for (more, of) in [(left, "jobs"), (all - shapes.len(), "shapes")] {
        if more > 0 {
            text += &(look.painted(FAINT, &format!("and {more} more {of}: see summary.csv")) + "\n");
        }
    }
    text
}
