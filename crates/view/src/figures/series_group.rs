//! Groups of jobs: those that differ in one axis, to be lines of one figure.
//!
//! Knows that with the linear connection the gaps have no meaning, so that one linear line is compared with every gap. Does
//! not know what is drawn.

use super::figure_context::{FigureContext, axis_label};
use crate::thinning::spread;
use pontoon_plan::input::Cell;
use pontoon_results::labels::{self, SHOWN};
use std::collections::HashMap;

/// Axes that the linear connection does not have.
const GAPS: [&str; 2] = ["gap_tension_m", "gap_compression_m"];

/// Lines of a figure, beside the linear one; and lines of a figure of all jobs.
const MOST_LINES: usize = 6;

/// Bytes of a name of files: a system takes 255 at most, of which a number, an ending and the marks of a file that is being
/// written take some.
const LONGEST_NAME: usize = 200;

/// Groups by one axis that become figures.
const MOST_GROUPS: usize = 6;

/// Jobs that are lines of one figure.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct SeriesGroup {
    /// The axis in which they differ; none where the group is all jobs.
    pub by: Option<String>,
    /// What sets it apart from other groups by that axis, as a name of files has it; empty of the only one.
    pub suffix: String,
    /// The lines.
    pub lines: Vec<GroupedLine>,
    /// What no line holds, in words; to be said where the group is drawn.
    pub left_out: Option<String>,
}

/// A line: one job, or where the figure runs along an axis, one job a value of it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct GroupedLine {
    pub label: String,
    pub style: usize,
    pub rows: Vec<usize>,
}

impl SeriesGroup {
    /// What the labels are values of.
    pub(super) fn legend(&self) -> String {
        self.by.as_deref().map(labels::label).unwrap_or_default()
    }

    /// All rows.
    pub(super) fn rows(&self) -> Vec<usize> {
        self.lines.iter().flat_map(|line| line.rows.iter().copied()).collect()
    }

    /// A name of files, which [`super::distinct`] tells from others that were cut to the same.
    pub(super) fn name(&self, of: &str) -> String {
        let by = self
            .by
            .as_ref()
            .map(|by| format!("-by-{}", plain(by)))
            .unwrap_or_default();
        let mut name = format!("{of}{by}{}", self.suffix);
        name.truncate(name.floor_char_boundary(LONGEST_NAME));
        name
    }
}

/// A word as a name of files has it.
pub(super) fn plain(word: &str) -> String {
    const LONGEST: usize = 60;
    let allowed = |c: char| c.is_ascii_alphanumeric() || ['.', '_', '-'].contains(&c);
    let kept = word.chars().map(|c| if allowed(c) { c } else { '_' });
    let text: String = kept.take(LONGEST).collect();
    // a name that begins with a dot is hidden
    text.trim_start_matches('.').to_owned()
}

/// The groups of a context whose figures run along an axis; none of single lines. Last, where they are few and no group
/// is all of them, all jobs.
pub(super) fn series_groups(context: &mut FigureContext<'_>, along: Option<&str>) -> Vec<SeriesGroup> {
    let varying: Vec<String> = context
        .varying
        .iter()
        .filter(|axis| Some(axis.as_str()) != along)
        .cloned()
        .collect();
    let gaps_vary = varying.iter().any(|axis| GAPS.contains(&axis.as_str()));
    let mut found = Vec::new();
    for by in varying.iter().filter(|axis| *axis != "connection" || !gaps_vary) {
        let (of_axis, count) = by_axis(context, &varying, by, along);
        if count > of_axis.len() {
            let others = varying.iter().filter(|axis| *axis != by);
            context.left_out.push(format!(
                "by {}: {} of {count} families, one for each {}",
                labels::label(by),
                count - of_axis.len(),
                labels(others)
            ));
        }
        found.extend(of_axis);
    }
    let all = context.grouped(&context.rows, &varying.iter().collect::<Vec<_>>());
    if all.len() > MOST_LINES {
        if found.is_empty() {
            context.left_out.push(format!(
                "{} combinations of {}, no two of which differ in one axis alone",
                all.len(),
                labels(varying.iter())
            ));
        }
    } else if !found.iter().any(|series_group| series_group.lines.len() == all.len()) {
        found.push(all_jobs(context, &varying, all));
    }
    found
}

/// Axes in words, one after the other.
fn labels<'s>(axes: impl Iterator<Item = &'s String>) -> String {
    axes.map(|axis| labels::label(axis)).collect::<Vec<_>>().join(", ")
}

/// The first groups that differ in one axis alone, and how many there are.
fn by_axis(
    context: &FigureContext<'_>,
    varying: &[String],
    by: &str,
    along: Option<&str>,
) -> (Vec<SeriesGroup>, usize) {
    let by = by.to_owned();
    let others: Vec<&String> = varying.iter().filter(|axis| **axis != by).collect();
    let has = |row: &usize| context.code(&by, *row).is_some();
    let rows: Vec<usize> = context.rows.iter().copied().filter(has).collect();
    // the rows of each group by their value
    let mut groups: Vec<Vec<Vec<usize>>> = Vec::new();
    // only what differs between groups is part of their names
    let mut differs = vec![false; others.len()];
    let (mut count, mut like) = (0, None);
    for rows in context.grouped(&rows, &others) {
        let values = context.grouped(&rows, &[&by]);
        if values.len() < 2 || !meet(context, &values, along) {
            continue;
        }
        let first = *like.get_or_insert(rows[0]);
        for (axis, differs) in others.iter().zip(&mut differs) {
            *differs |= context.code(axis, rows[0]) != context.code(axis, first);
        }
        count += 1;
        if groups.len() < MOST_GROUPS {
            groups.push(values);
        }
    }
    let named: Vec<&String> = others
        .iter()
        .copied()
        .zip(differs)
        .filter_map(|(axis, differs)| differs.then_some(axis))
        .collect();
    let series_group = |values| series_group(context, &by, &others, &named, values);
    (groups.into_iter().map(series_group).collect(), count)
}

/// A group by an axis: rows by their value, and the axes that are part of its name.
fn series_group(
    context: &FigureContext<'_>,
    by: &str,
    others: &[&String],
    named: &[&String],
    mut values: Vec<Vec<usize>>,
) -> SeriesGroup {
    let first = values[0][0];
    let value = |rows: &Vec<usize>| context.number(by, rows[0]);
    if values.iter().all(|rows| value(rows).is_some()) {
        values.sort_by(|a, b| value(a).unwrap_or_default().total_cmp(&value(b).unwrap_or_default()));
    }
    let suffix = named
        .iter()
        .map(|axis| format!("-{}-{}", plain(axis), plain(&text(&context.cell(axis, first)))));
    let mut lines = Vec::new();
    if GAPS.contains(&by) {
        lines.extend(linear_line(context, others, first));
    }
    let chosen = spread(values.len(), MOST_LINES);
    let left_out = (chosen.len() < values.len()).then(|| {
        let left = values.len() - chosen.len();
        format!("by {}: {left} of {} values", labels::label(by), values.len())
    });
    let cells: Vec<Cell<'_>> = chosen.iter().map(|&place| context.cell(by, values[place][0])).collect();
    let mut texts = labels::values_apart(by, &cells.iter().collect::<Vec<_>>());
    lines.extend(chosen.into_iter().enumerate().map(|(i, place)| GroupedLine {
        label: std::mem::take(&mut texts[i]),
        style: i + 1,
        rows: std::mem::take(&mut values[place]),
    }));
    SeriesGroup {
        by: Some(by.to_owned()),
        suffix: suffix.collect(),
        lines,
        left_out,
    }
}

/// Whether at some place along an axis there are jobs of more than one value, so that there is something to compare.
fn meet(context: &FigureContext<'_>, values: &[Vec<usize>], along: Option<&str>) -> bool {
    let Some(along) = along else { return true };
    let mut of_value = HashMap::new();
    values.iter().enumerate().any(|(i, rows)| {
        rows.iter()
            .filter_map(|row| context.code(along, *row))
            .any(|place| *of_value.entry(place).or_insert(i) != i)
    })
}

/// The linear jobs that have what a row has in all axes but the gaps.
fn linear_line(context: &FigureContext<'_>, others: &[&String], like: usize) -> Option<GroupedLine> {
    let compared: Vec<&String> = others
        .iter()
        .copied()
        .filter(|axis| *axis != "connection" && !GAPS.contains(&axis.as_str()))
        .collect();
    let same = |row: &usize| {
        let mut compared = compared.iter();
        context.is_linear(*row) && compared.all(|axis| context.code(axis, *row) == context.code(axis, like))
    };
    let rows: Vec<usize> = context.rows.iter().copied().filter(same).collect();
    (!rows.is_empty()).then(|| GroupedLine {
        label: "linear connection".to_owned(),
        style: 0,
        rows,
    })
}

/// All jobs, a line each combination of the axes: `groups` are their rows.
fn all_jobs(context: &FigureContext<'_>, varying: &[String], groups: Vec<Vec<usize>>) -> SeriesGroup {
    let (linear, others): (Vec<_>, Vec<_>) = groups.into_iter().partition(|rows| context.is_linear(rows[0]));
    let several = !others.is_empty() && linear.len() == 1;
    let line = |(i, rows): (usize, Vec<usize>)| GroupedLine {
        label: label(context, varying, rows[0]),
        style: if several { i } else { i + 1 },
        rows,
    };
    SeriesGroup {
        by: None,
        suffix: String::new(),
        lines: linear.into_iter().chain(others).enumerate().map(line).collect(),
        left_out: None,
    }
}

/// A job in the words of the axes that vary.
fn label(context: &FigureContext<'_>, varying: &[String], row: usize) -> String {
    let has = |axis: &str| varying.iter().any(|name| name == axis) && !context.cell(axis, row).is_nothing();
    let both = GAPS.iter().all(|gap| has(gap));
    let mut parts: Vec<String> = Vec::new();
    if both {
        let [tension, compression] = GAPS.map(|gap| labels::value(gap, &context.cell(gap, row)));
        let (tension, unit) = tension.rsplit_once(' ').unwrap_or((&tension, ""));
        parts.push(match compression.strip_suffix(unit) {
            Some(number) => format!("gaps {tension} / {} {unit}", number.trim_end()),
            None => format!("gaps {tension} {unit} / {compression}"),
        });
    }
    for axis in varying
        .iter()
        .filter(|axis| has(axis) && !(both && GAPS.contains(&axis.as_str())))
    {
        match axis.as_str() {
            "connection" if context.is_linear(row) || !GAPS.iter().any(|gap| has(gap)) => {
                parts.insert(0, axis_label(axis, &context.cell(axis, row)));
            }
            "connection" => {}
            "load_n" => parts.push(labels::value(axis, &context.cell(axis, row))),
            _ => parts.push(axis_label(axis, &context.cell(axis, row))),
        }
    }
    if parts.is_empty() {
        "calculated".to_owned()
    } else {
        parts.join(", ")
    }
}

fn text(cell: &Cell<'_>) -> String {
    match cell.number() {
        Some(number) => labels::number(number, SHOWN),
        None => cell.text(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_files_have_no_letters_that_a_shell_or_a_page_reads() {
        assert_eq!(plain("bridge.x <b>&\"/1"), "bridge.x__b____1");
        assert_eq!(plain("..hidden"), "hidden");
        assert!(plain(&"x".repeat(500)).len() <= 60);
    }
}
