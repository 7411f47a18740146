//! A family split into panels, one a speed, and what is written under a figure.
//!
//! Knows families and speeds. Does not know tables.

use super::family::Family;
use super::figure::Panel;
use super::sheet::{Sheet, listed};
use crate::labels;
use crate::thinning::spread;
use std::collections::BTreeMap;

/// Panels of a figure.
const MOST_PANELS: usize = 6;

/// The part of a family that one panel shows: one job a line.
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
pub(super) fn by_speed(sheet: &Sheet<'_>, family: &Family, name: &str) -> (Vec<Split>, Option<String>) {
    let mut speeds: Vec<(f64, Vec<SplitLine>)> = Vec::new();
    let mut place: BTreeMap<u64, usize> = BTreeMap::new();
    for line in &family.lines {
        for row in &line.rows {
            let Some(speed_m_s) = sheet.number("speed_m_s", *row) else {
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
    let mut splits: Vec<Option<Split>> = speeds
        .into_iter()
        .map(|(speed_m_s, lines)| {
            let title = format!("{} m/s", labels::number(speed_m_s));
            Some(Split { title, lines })
        })
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
pub(super) fn caption(sheet: &Sheet<'_>, family: &Family, what: &str, panels: &[Panel]) -> String {
    let mut text = what.to_owned();
    let rows = family.rows();
    if let Some(by) = &family.by {
        let gaps: Vec<String> = family
            .lines
            .iter()
            .filter(|line| line.style > 0)
            .map(|line| line.label.clone())
            .collect();
        text += &format!(", for a {} of {}", labels::label(by), listed(&gaps));
        if family.lines.iter().any(|line| line.style == 0) {
            text += " and for the linear connection";
        }
    }
    let mut told: Vec<&str> = family.by.as_deref().into_iter().collect();
    if panels.len() > 1 {
        told.push("speed_m_s");
    }
    if family.lines.iter().any(|line| line.style == 0) {
        told.push("connection");
    }
    let alike = sheet.alike(&rows, &told);
    if !alike.is_empty() {
        text += &format!("; {}", alike.join(", "));
    }
    text += ".";
    if panels.len() > 1 {
        let named = panels
            .iter()
            .zip('a'..)
            .map(|(panel, letter)| format!("({letter}) {}", panel.title));
        text += &format!(" {}.", named.collect::<Vec<_>>().join("; "));
    }
    let mut moments: Vec<&str> = panels
        .iter()
        .flat_map(|panel| &panel.moments)
        .map(|moment| moment.label.as_str())
        .collect();
    moments.dedup();
    match moments.first() {
        Some(&"vehicle") => text += " Vertical line: the vehicle's centre.",
        Some(_) => text += " Vertical line: the vehicle's centre is at the position.",
        None => {}
    }
    let mut marks: Vec<String> = Vec::new();
    for mark in panels.iter().flat_map(|panel| &panel.marks) {
        let said = if mark.label == mark.id {
            mark.id.clone()
        } else {
            format!("{} ({})", mark.label, mark.id)
        };
        if !marks.contains(&said) {
            marks.push(said);
        }
    }
    if !marks.is_empty() {
        text += &format!(" Marks: {}.", marks.join("; "));
    }
    text
}
