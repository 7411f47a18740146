//! Peaks for people: deflection against speed (against the place of the load of static cases), a row a combination of the
//! other axes; a list of all peaks where rows have too little in common for that.
//!
//! Knows how many rows a person looks at. Does not know where rows come from.

use super::label::{ColumnHead, heads};
use super::survey::{SummaryRow, Survey, SurveyAxis, hash, peaks_among};
use super::text_table::{RowNames, TableEntry, TextTable};
use crate::terminal::{BAD, FAINT, NOTABLE, TextStyle};
use crate::text::{listed, wrapped};
use anstyle::Style;
use pontoon_plan::input::Cell;
use pontoon_results::{Column, When, labels};
use std::collections::HashMap;

/// Lines of rows that are written at most, over all pieces of a table.
const MOST_LINES: usize = 60;
/// Rows that are written at most, and at least where there are pieces.
const MOST_ROWS: usize = 40;
const FEWEST_ROWS: usize = 5;

/// What stands in a cell of a job that failed.
const FAILED: &str = "failed";

/// The peaks of a summary as a table and what is largest.
pub(super) fn peaks<'a, I: Iterator<Item = SummaryRow<'a>>>(
    columns: &[String],
    rows: impl Fn() -> I,
    text_style: TextStyle,
    width: usize,
) -> String {
    let survey = Survey::new(columns, &rows);
    let heads = heads(columns);
    let mut text = String::new();
    if let Some(&first) = peaks_among(columns).first() {
        let peak = ColumnHead::of(&columns[first]);
        text += &match &survey.along {
            Some(along) => wrapped(
                &format!("{} against {}", peak.united(), heads[along.axis].united()),
                width,
                2,
            ),
            None => wrapped("peaks", width, 2),
        };
    }
    let constant: Vec<String> = survey.constant.iter().map(|(i, value)| heads[*i].told(value)).collect();
    if !constant.is_empty() {
        text += &listed("throughout: ", constant.iter(), width, 2);
    }
    if !text.is_empty() {
        text.push('\n');
    }
    text += &match &survey.along {
        Some(along) => against(&survey, along, columns, &heads, &rows, text_style, width),
        None => list(&survey, columns, &heads, &rows, text_style, width),
    };
    text + &largest(&survey, columns, &heads, text_style, width)
}

/// Values of the axes that vary, as the names of rows; heads a word a line.
fn names(axes: &[usize], heads: &[ColumnHead], rows: &[SummaryRow<'_>]) -> Vec<RowNames> {
    let column = |&i: &usize| {
        let head = &heads[i];
        let words = head.name.split(' ').map(str::to_owned);
        let values: Vec<&Cell<'_>> = rows.iter().map(|row| &row[i]).collect();
        let texts = labels::listed_apart(&values);
        let told = |(value, text): (&&Cell<'_>, &String)| match value.is_nothing() {
            true => String::new(),
            false => head.told_as(text),
        };
        RowNames {
            head: words.chain(head.unit.map(|unit| format!("[{unit}]"))).collect(),
            told: values.iter().zip(&texts).map(told).collect(),
            rows: texts,
        }
    };
    axes.iter().map(column).collect()
}

/// The largest of its kind ends in a star; all others in a blank, so that their points stay under each other.
fn entry(text: String, is_largest: bool) -> TableEntry {
    let (mark, style) = if is_largest {
        ("*", NOTABLE)
    } else {
        (" ", Style::new())
    };
    TableEntry {
        text: text + mark,
        style,
    }
}

fn of_peak(name: &str, value: &Cell<'_>, is_largest: bool) -> TableEntry {
    match value.number() {
        Some(x) => entry(labels::digits(name, x), is_largest),
        None => TableEntry {
            style: BAD,
            ..entry(FAILED.to_owned(), false)
        },
    }
}

/// The first peak against an axis.
fn against<'a, I: Iterator<Item = SummaryRow<'a>>>(
    survey: &Survey<'a>,
    along: &SurveyAxis<'a>,
    columns: &[String],
    heads: &[ColumnHead],
    rows: &impl Fn() -> I,
    text_style: TextStyle,
    width: usize,
) -> String {
    let Some(peak) = survey.largest.first().map(|largest| largest.column) else {
        return "no job has a peak: all failed\n".to_owned();
    };
    let values = &along.values;
    let mut grid = TextTable {
        heads: labels::listed_apart(&values.iter().collect::<Vec<_>>())
            .into_iter()
            .map(|text| vec![text + " "])
            .collect(),
        gap: 1,
        ..TextTable::default()
    };
    let collect = |most: usize| {
        let mut places: HashMap<u64, usize> = HashMap::new();
        let (mut first, mut entries): (Vec<SummaryRow<'a>>, Vec<Vec<TableEntry>>) = Default::default();
        for row in rows() {
            let next = places.len();
            let known = hash(&row, &survey.varying);
            let place = match places.get(&known) {
                Some(&place) => place,
                None if next < most => {
                    places.insert(known, next);
                    entries.push(vec![TableEntry::default(); values.len()]);
                    first.push(row.clone());
                    next
                }
                None => continue,
            };
            let at = values.iter().position(|value| *value == row[along.axis]);
            if let Some(entry) = at.and_then(|at| entries[place].get_mut(at)) {
                *entry = of_peak(&columns[peak], &row[peak], is_largest(survey, peak, &row));
            }
        }
        (first, entries)
    };
    let (first, entries) = collect(MOST_ROWS);
    grid.names = names(&survey.varying, heads, &first);
    grid.rows = entries;
    let shown = fitting(&mut grid, width);
    grid.written(width, text_style) + &more(survey.combinations - shown, "combinations", text_style)
}

/// Cuts a table to as many rows as a person looks at in all its pieces; how many are left.
fn fitting(grid: &mut TextTable, width: usize) -> usize {
    let most = (MOST_LINES / grid.pieces(width).max(1)).clamp(FEWEST_ROWS, MOST_ROWS);
    grid.rows.truncate(most);
    grid.names.iter_mut().for_each(|names| names.rows.truncate(most));
    grid.rows.len()
}

fn more(left: usize, of: &str, text_style: TextStyle) -> String {
    match left {
        0 => String::new(),
        left => text_style.painted(FAINT, &format!("and {left} more {of}: see summary.csv")) + "\n",
    }
}

/// All peaks of jobs: in their order, of more than a person looks at those with the largest deflections.
fn list<'a, I: Iterator<Item = SummaryRow<'a>>>(
    survey: &Survey<'a>,
    columns: &[String],
    heads: &[ColumnHead],
    rows: &impl Fn() -> I,
    text_style: TextStyle,
    width: usize,
) -> String {
    let peaks: Vec<usize> = peaks_among(columns);
    let Some(&first) = peaks.first() else {
        return "no rows\n".to_owned();
    };
    let mut shown: Vec<SummaryRow<'a>> = Vec::new();
    if survey.rows <= MOST_ROWS {
        shown = rows().collect();
    } else {
        let mut order: Vec<(f64, usize)> = rows()
            .map(|row| row[first].number().unwrap_or(f64::NEG_INFINITY))
            .zip(0..)
            .collect();
        order.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        let places: HashMap<usize, usize> = order.iter().take(MOST_ROWS).map(|o| o.1).zip(0..).collect();
        let mut kept: Vec<(usize, SummaryRow<'a>)> = rows()
            .enumerate()
            .filter_map(|(i, row)| places.get(&i).map(|&place| (place, row)))
            .collect();
        kept.sort_by_key(|(place, _)| *place);
        shown.extend(kept.into_iter().map(|(_, row)| row));
    }
    let mut grid = TextTable {
        gap: 1,
        names: names(&survey.varying, heads, &shown),
        heads: peaks
            .iter()
            .map(|&i| {
                let ColumnHead { name, unit } = short(&columns[i]);
                vec![name + " ", unit.map_or(String::new(), |unit| format!("[{unit}] "))]
            })
            .collect(),
        rows: shown
            .iter()
            .map(|row| {
                peaks
                    .iter()
                    .map(|&i| of_peak(&columns[i], &row[i], is_largest(survey, i, row)))
                    .collect()
            })
            .collect(),
    };
    let shown = fitting(&mut grid, width);
    let of = if survey.rows > MOST_ROWS {
        "jobs with less deflection"
    } else {
        "jobs"
    };
    grid.written(width, text_style) + &more(survey.rows - shown, of, text_style)
}

/// The head of a peak where all are peaks.
fn short(column: &str) -> ColumnHead {
    ColumnHead::of(column.trim_start_matches("peak_"))
}

/// The largest of each peak and where it is.
fn largest(
    survey: &Survey<'_>,
    columns: &[String],
    heads: &[ColumnHead],
    text_style: TextStyle,
    width: usize,
) -> String {
    let along = survey.along.iter().map(|along| along.axis);
    let axes: Vec<usize> = along.chain(survey.varying.iter().copied()).collect();
    let parts: Vec<(String, String, Vec<String>)> = survey
        .largest
        .iter()
        // the largest of several ratings is safe for one of them alone
        .filter(|largest| Column::named(&columns[largest.column]).is_none_or(|column| column.when != When::Rating))
        .map(|largest| {
            let name = &columns[largest.column];
            let head = short(name);
            // a peak of zero is no job's
            let at = axes
                .iter()
                .filter(|&&i| largest.most > 0.0 && !largest.row[i].is_nothing())
                .map(|&i| heads[i].told_as(&text_of(survey, i, &largest.row[i])));
            let unit = head.unit.map_or(String::new(), |unit| format!(" {unit}"));
            let value = format!("{}{unit}", labels::digits(name, largest.most));
            (head.name, value, at.collect())
        })
        .collect();
    if parts.is_empty() || survey.rows < 2 {
        return String::new();
    }
    let name = parts.iter().map(|part| part.0.len()).max().unwrap_or(0);
    let value = parts.iter().map(|part| part.1.len()).max().unwrap_or(0);
    let line = |(of, most, at): &(String, String, Vec<String>)| {
        let begin = format!("largest {of:<name$}  {most:>value$}");
        let indent = begin.len() + 2;
        let indent = if 2 * indent > width { 4 } else { indent };
        let begin = if at.is_empty() { begin } else { begin + "  " };
        listed(&begin, at.iter(), width, indent).replacen(most.as_str(), &text_style.painted(NOTABLE, most), 1)
    };
    format!("\n{}", parts.iter().map(line).collect::<String>())
}

/// The value of an axis at a largest peak, beside the values that it is read with: those looked along, or at the other peaks.
fn text_of(survey: &Survey<'_>, axis: usize, value: &Cell<'_>) -> String {
    let along = survey.along.as_ref().filter(|along| along.axis == axis);
    let others = survey.largest.iter().map(|largest| &largest.row[axis]);
    let beside = along.into_iter().flat_map(|along| &along.values).chain(others);
    let cells: Vec<&Cell<'_>> = std::iter::once(value).chain(beside).collect();
    labels::listed_apart(&cells).swap_remove(0)
}

/// Whether the peak of a row is the largest, above nothing and not the only one.
fn is_largest(survey: &Survey<'_>, column: usize, row: &SummaryRow<'_>) -> bool {
    let is_row = |of: &SummaryRow<'_>| of == row;
    survey.rows > 1
        && survey
            .largest
            .iter()
            .any(|largest| largest.column == column && largest.most > 0.0 && is_row(&largest.row))
}
