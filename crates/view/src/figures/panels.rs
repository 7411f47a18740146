//! A group of series split into panels, one a speed, and what is written under a figure.
//!
//! Knows groups and speeds. Does not know tables.

use super::figure::{FigurePanel, MomentKind};
use super::figure_context::{FigureContext, listed};
use super::series_group::SeriesGroup;
use crate::thinning::spread;
use pontoon_plan::input::Cell;
use pontoon_results::labels;
use std::collections::BTreeMap;

/// Panels of a figure.
const MOST_PANELS: usize = 6;

/// The part of a group that one panel shows: one job a line.
pub(super) struct Split {
    pub title: String,
    pub lines: Vec<SplitLine>,
}

/// A line of a panel.
pub(super) struct SplitLine {
    pub label: String,
    pub style: usize,
    pub row: usize,
}

/// A panel a speed, at most [`MOST_PANELS`], evenly spread over the speeds; and what none holds, in words, to be said where
/// the figure of that `name` is drawn.
pub(super) fn by_speed(
    context: &FigureContext<'_>,
    series_group: &SeriesGroup,
    name: &str,
) -> (Vec<Split>, Option<String>) {
    let mut speeds: Vec<(f64, Vec<SplitLine>)> = Vec::new();
    let mut place: BTreeMap<u64, usize> = BTreeMap::new();
    for line in &series_group.lines {
        for row in &line.rows {
            let Some(speed_m_s) = context.number("speed_m_s", *row) else {
                continue;
            };
            let i = *place.entry(speed_m_s.to_bits()).or_insert_with(|| {
                speeds.push((speed_m_s, Vec::new()));
                speeds.len() - 1
            });
            speeds[i].1.push(SplitLine {
                label: line.label.clone(),
                style: line.style,
                row: *row,
            });
        }
    }
    speeds.sort_by(|a, b| a.0.total_cmp(&b.0));
    let chosen = spread(speeds.len(), MOST_PANELS);
    let left_out = (chosen.len() < speeds.len())
        .then(|| format!("{name}: {} of {} speeds", speeds.len() - chosen.len(), speeds.len()));
    let cells: Vec<Cell<'_>> = speeds.iter().map(|(speed_m_s, _)| (*speed_m_s).into()).collect();
    let titles = labels::values_apart("speed_m_s", &cells.iter().collect::<Vec<_>>());
    let mut splits: Vec<Option<Split>> = speeds
        .into_iter()
        .zip(titles)
        .map(|((_, lines), title)| Some(Split { title, lines }))
        .collect();
    let single = chosen.len() == 1;
    let mut split = |i: usize| {
        let mut split = splits[i].take()?;
        if single {
            split.title.clear();
        }
        Some(split)
    };
    (chosen.into_iter().filter_map(&mut split).collect(), left_out)
}

/// What a paper would write under a figure: what is drawn, for what, under which conditions, what panels and marks are.
pub(super) fn caption(
    context: &FigureContext<'_>,
    series_group: &SeriesGroup,
    what: &str,
    panels: &[FigurePanel],
) -> String {
    let mut text = what.to_owned();
    let linear = series_group.lines.iter().any(|line| line.style == 0);
    if let Some(by) = &series_group.by {
        let others = series_group.lines.iter().filter(|line| line.style > 0);
        let values: Vec<String> = others.map(|line| line.label.clone()).collect();
        text += &format!(", for {} {}", labels::label(by), listed(&values));
        if linear {
            text += " and for the linear connection";
        }
    }
    let mut told: Vec<&str> = series_group.by.as_deref().into_iter().collect();
    if panels.len() > 1 {
        told.push("speed_m_s");
    }
    if linear {
        told.push("connection");
    }
    let alike = context.alike(&series_group.rows(), &told);
    if !alike.is_empty() {
        text += &format!("; {}", alike.join(", "));
    }
    text + "." + &of_panels(panels) + of_moments(panels) + &of_marks(panels)
}

/// What the panels are, where there are several.
fn of_panels(panels: &[FigurePanel]) -> String {
    if panels.len() < 2 {
        return String::new();
    }
    let panels = panels.iter().zip('a'..);
    let named = panels.map(|(panel, letter)| format!("({letter}) {}", panel.title));
    format!(" {}.", named.collect::<Vec<_>>().join("; "))
}

/// What vertical lines are.
fn of_moments(panels: &[FigurePanel]) -> &'static str {
    let mut moments = panels.iter().flat_map(|panel| &panel.moments);
    match moments.next().map(|moment| moment.kind) {
        Some(MomentKind::Standing) => " Vertical line: the vehicle's centre.",
        Some(MomentKind::Arrival) => " Vertical line: the vehicle's centre is at the position.",
        None => "",
    }
}

/// What marks are.
fn of_marks(panels: &[FigurePanel]) -> String {
    let mut marks: Vec<String> = Vec::new();
    for mark in panels.iter().flat_map(|panel| &panel.marks) {
        let mark_label = if mark.label == mark.id {
            mark.id.clone()
        } else {
            format!("{} ({})", mark.label, mark.id)
        };
        if !marks.contains(&mark_label) {
            marks.push(mark_label);
        }
    }
    match marks.as_slice() {
        [] => String::new(),
        marks => format!(" Marks: {}.", marks.join("; ")),
    }
}
