//! Families of jobs: those that differ in one axis, to be lines of one figure.
//!
//! Knows that with the linear connection the gaps have no meaning, so that one linear line is compared with every gap. Does
//! not know what is drawn.

use super::sheet::{Sheet, said};
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

/// Families by one axis that become figures.
const MOST_FAMILIES: usize = 6;

/// Jobs that are lines of one figure.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Family {
    /// The axis in which they differ; none where the family is all jobs.
    pub by: Option<String>,
    /// What sets it apart from other families by that axis, as a name of files has it; empty of the only one.
    pub suffix: String,
    /// The lines.
    pub lines: Vec<FamilyLine>,
    /// What no line holds, in words; to be said where the family is drawn.
    pub left_out: Option<String>,
}

/// A line: one job, or where the figure runs along an axis, one job a value of it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct FamilyLine {
    pub label: String,
    pub style: usize,
    pub rows: Vec<usize>,
}

impl Family {
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

/// The families of a sheet whose figures run along an axis; none of single lines. Last, where they are few and no family
/// is all of them, all jobs.
pub(super) fn families(sheet: &mut Sheet<'_>, along: Option<&str>) -> Vec<Family> {
    let varying: Vec<String> = sheet
        .varying
        .iter()
        .filter(|axis| Some(axis.as_str()) != along)
        .cloned()
        .collect();
    let gaps_vary = varying.iter().any(|axis| GAPS.contains(&axis.as_str()));
    let mut found = Vec::new();
    for by in varying.iter().filter(|axis| *axis != "connection" || !gaps_vary) {
        let (of_axis, count) = by_axis(sheet, &varying, by, along);
        if count > of_axis.len() {
            let others = varying.iter().filter(|axis| *axis != by);
            sheet.left_out.push(format!(
                "by {}: {} of {count} families, one for each {}",
                labels::label(by),
                count - of_axis.len(),
                labels(others)
            ));
        }
        found.extend(of_axis);
    }
    let all = sheet.grouped(&sheet.rows, &varying.iter().collect::<Vec<_>>());
    if all.len() > MOST_LINES {
        if found.is_empty() {
            sheet.left_out.push(format!(
                "{} combinations of {}, no two of which differ in one axis alone",
                all.len(),
                labels(varying.iter())
            ));
        }
    } else if !found.iter().any(|family| family.lines.len() == all.len()) {
        found.push(all_jobs(sheet, &varying, all));
    }
    found
}

/// Axes in words, one after the other.
fn labels<'s>(axes: impl Iterator<Item = &'s String>) -> String {
    axes.map(|axis| labels::label(axis)).collect::<Vec<_>>().join(", ")
}

/// The first families that differ in one axis alone, and how many there are.
fn by_axis(sheet: &Sheet<'_>, varying: &[String], by: &str, along: Option<&str>) -> (Vec<Family>, usize) {
    let by = by.to_owned();
    let others: Vec<&String> = varying.iter().filter(|axis| **axis != by).collect();
    let has = |row: &usize| sheet.code(&by, *row).is_some();
    let rows: Vec<usize> = sheet.rows.iter().copied().filter(has).collect();
    // the rows of each group by their value
    let mut groups: Vec<Vec<Vec<usize>>> = Vec::new();
    // only what differs between families is part of their names
    let mut differs = vec![false; others.len()];
    let (mut count, mut like) = (0, None);
    for rows in sheet.grouped(&rows, &others) {
        let values = sheet.grouped(&rows, &[&by]);
        if values.len() < 2 || !meet(sheet, &values, along) {
            continue;
        }
        let first = *like.get_or_insert(rows[0]);
        for (axis, differs) in others.iter().zip(&mut differs) {
            *differs |= sheet.code(axis, rows[0]) != sheet.code(axis, first);
        }
        count += 1;
        if groups.len() < MOST_FAMILIES {
            groups.push(values);
        }
    }
    let named: Vec<&String> = others
        .iter()
        .copied()
        .zip(differs)
        .filter_map(|(axis, differs)| differs.then_some(axis))
        .collect();
    let family = |values| family(sheet, &by, &others, &named, values);
    (groups.into_iter().map(family).collect(), count)
}

/// A family by an axis: rows by their value, and the axes that are part of its name.
fn family(sheet: &Sheet<'_>, by: &str, others: &[&String], named: &[&String], mut values: Vec<Vec<usize>>) -> Family {
    let first = values[0][0];
    let value = |rows: &Vec<usize>| sheet.number(by, rows[0]);
    if values.iter().all(|rows| value(rows).is_some()) {
        values.sort_by(|a, b| value(a).unwrap_or_default().total_cmp(&value(b).unwrap_or_default()));
    }
    let suffix = named
        .iter()
        .map(|axis| format!("-{}-{}", plain(axis), plain(&text(&sheet.cell(axis, first)))));
    let mut lines = Vec::new();
    if GAPS.contains(&by) {
        lines.extend(linear_line(sheet, others, first));
    }
    let chosen = spread(values.len(), MOST_LINES);
    let left_out = (chosen.len() < values.len()).then(|| {
        let left = values.len() - chosen.len();
        format!("by {}: {left} of {} values", labels::label(by), values.len())
    });
    lines.extend(chosen.into_iter().enumerate().map(|(i, place)| FamilyLine {
        label: labels::value(by, &sheet.cell(by, values[place][0])),
        style: i + 1,
        rows: std::mem::take(&mut values[place]),
    }));
    Family {
        by: Some(by.to_owned()),
        suffix: suffix.collect(),
        lines,
        left_out,
    }
}

/// Whether at some place along an axis there are jobs of more than one value, so that there is something to compare.
fn meet(sheet: &Sheet<'_>, values: &[Vec<usize>], along: Option<&str>) -> bool {
    let Some(along) = along else { return true };
    let mut of_value = HashMap::new();
    values.iter().enumerate().any(|(i, rows)| {
        rows.iter()
            .filter_map(|row| sheet.code(along, *row))
            .any(|place| *of_value.entry(place).or_insert(i) != i)
    })
}

/// The linear jobs that have what a row has in all axes but the gaps.
fn linear_line(sheet: &Sheet<'_>, others: &[&String], like: usize) -> Option<FamilyLine> {
    let compared: Vec<&String> = others
        .iter()
        .copied()
        .filter(|axis| *axis != "connection" && !GAPS.contains(&axis.as_str()))
        .collect();
    let same = |row: &usize| {
        let mut compared = compared.iter();
        sheet.is_linear(*row) && compared.all(|axis| sheet.code(axis, *row) == sheet.code(axis, like))
    };
    let rows: Vec<usize> = sheet.rows.iter().copied().filter(same).collect();
    (!rows.is_empty()).then(|| FamilyLine {
        label: "linear connection".to_owned(),
        style: 0,
        rows,
    })
}

/// All jobs, a line each combination of the axes: `groups` are their rows.
fn all_jobs(sheet: &Sheet<'_>, varying: &[String], groups: Vec<Vec<usize>>) -> Family {
    let (linear, others): (Vec<_>, Vec<_>) = groups.into_iter().partition(|rows| sheet.is_linear(rows[0]));
    let several = !others.is_empty() && linear.len() == 1;
    let line = |(i, rows): (usize, Vec<usize>)| FamilyLine {
        label: label(sheet, varying, rows[0]),
        style: if several { i } else { i + 1 },
        rows,
    };
    Family {
        by: None,
        suffix: String::new(),
        lines: linear.into_iter().chain(others).enumerate().map(line).collect(),
        left_out: None,
    }
}

/// A job in the words of the axes that vary.
fn label(sheet: &Sheet<'_>, varying: &[String], row: usize) -> String {
    let has = |axis: &str| varying.iter().any(|name| name == axis) && !sheet.cell(axis, row).is_nothing();
    let both = GAPS.iter().all(|gap| has(gap));
    let mut said_of: Vec<String> = Vec::new();
    if both {
        let [tension, compression] = GAPS.map(|gap| labels::value(gap, &sheet.cell(gap, row)));
        let (tension, unit) = tension.rsplit_once(' ').unwrap_or((&tension, ""));
        said_of.push(match compression.strip_suffix(unit) {
            Some(number) => format!("gaps {tension} / {} {unit}", number.trim_end()),
            None => format!("gaps {tension} {unit} / {compression}"),
        });
    }
    for axis in varying
        .iter()
        .filter(|axis| has(axis) && !(both && GAPS.contains(&axis.as_str())))
    {
        match axis.as_str() {
            "connection" if sheet.is_linear(row) || !GAPS.iter().any(|gap| has(gap)) => {
                said_of.insert(0, said(axis, &sheet.cell(axis, row)));
            }
            "connection" => {}
            "load_n" => said_of.push(labels::value(axis, &sheet.cell(axis, row))),
            _ => said_of.push(said(axis, &sheet.cell(axis, row))),
        }
    }
    if said_of.is_empty() {
        "calculated".to_owned()
    } else {
        said_of.join(", ")
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
