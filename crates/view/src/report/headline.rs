//! The largest of each measure, with its place and job; why jobs failed.
//!
//! Knows which columns tell the place of a peak. Does not know cells.

use super::cells::PageMeasure;
use pontoon_plan::study_file::{Limit, Study};
use pontoon_results::{Column, Results, Table, labels};
use serde::Serialize;
use std::collections::BTreeMap;

/// Most causes of failures that are listed.
const MOST_CAUSES: usize = 50;

/// The largest value of a measure.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PageCard {
    /// The measure's column.
    pub measure: &'static str,
    /// In words.
    pub label: &'static str,
    /// The value.
    pub value: f64,
    /// Its unit.
    pub unit: &'static str,
    /// Where and when; empty where the value is 0.
    #[serde(rename = "where")]
    pub place: String,
    /// Its job; null where the value is 0, for it is nobody's.
    pub job: Option<u32>,
    /// The job's axes in words.
    pub axes: String,
}

/// Jobs that failed for one cause.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FailureNote {
    /// The kind of the failure; none where the results are of before there were kinds.
    pub kind: Option<String>,
    /// How many.
    pub count: usize,
    /// The first of them.
    pub job: u32,
    /// Why that one did.
    pub reason: String,
}

/// The cards of a table of jobs.
pub(super) fn cards(
    results: &Results,
    measures: &[PageMeasure],
    study: Option<&Study>,
    row_label: &dyn Fn(usize) -> String,
) -> Vec<PageCard> {
    let find = study.and_then(|study| study.find.as_ref());
    let card = |column: &'static Column| {
        let of = column.card?;
        let measure = measures.iter().find(|measure| measure.name == column.name)?;
        // of ratings the one that is safe for all: of largest values the smallest
        let is_least = column.name == "rated_value" && find.is_some_and(|find| find.is_largest);
        let (row, value) = most(results, column.name, if is_least { -1.0 } else { 1.0 })?;
        let number = |column: Option<&str>| column.and_then(|column| results.jobs().number(column, row));
        let at = of.place.and_then(|(kind, column)| {
            let place = number(Some(column))?;
            let limit =
                Some(results.jobs().cell("governing_limit", row).text()).filter(|_| measure.name == "utilisation");
            let limit = limit.and_then(|word| Limit::ALL.into_iter().find(|of| of.word() == word));
            Some(match limit {
                Some(limit) => format!("{}, {} {place}", labels::label(limit.word()), limit.place()),
                None => format!("{kind} {place}"),
            })
        });
        let words = |of_job: String| if value == 0.0 { String::new() } else { of_job };
        let when = number(of.time).map(|time| format!("at {time:.2} s"));
        Some(PageCard {
            measure: measure.name,
            label: if is_least { "smallest rated value" } else { of.label },
            value,
            unit: measure.unit,
            place: words([at, when].into_iter().flatten().collect::<Vec<_>>().join(" ")),
            job: (value != 0.0).then(|| super::job(results, row)),
            axes: words(row_label(row)),
        })
    };
    Column::measures().filter_map(card).collect()
}

/// The row with the largest number of a column times a sign, the first of equals, and that number; failed jobs have none.
fn most(results: &Results, column: &str, sign: f64) -> Option<(usize, f64)> {
    let numbers = results.jobs().numbers(column)?;
    let mut best: Option<(usize, f64)> = None;
    for (row, number) in numbers.iter().enumerate() {
        let Some(number) = number.filter(|_| !results.is_failed(row)) else {
            continue;
        };
        if best.is_none_or(|(_, most)| sign * number > sign * most) {
            best = Some((row, number));
        }
    }
    best
}

/// Why jobs failed, the commonest cause first, and how many causes there are: failures of one kind are one cause.
pub(super) fn failures(results: &Results) -> (Vec<FailureNote>, usize) {
    let jobs = results.jobs();
    let mut causes: BTreeMap<String, FailureNote> = BTreeMap::new();
    for row in (0..jobs.rows()).filter(|&row| results.is_failed(row)) {
        let reason = jobs.cell("reason", row);
        let reason = reason.word().unwrap_or("no reason");
        let kind = jobs.cell("failure", row).word().map(str::to_owned);
        let cause = kind.clone().unwrap_or_else(|| reason.to_owned());
        let first = || FailureNote {
            kind: kind.clone(),
            count: 0,
            job: super::job(results, row),
            reason: reason.to_owned(),
        };
        causes.entry(cause).or_insert_with(first).count += 1;
    }
    let found = causes.len();
    let mut notes: Vec<FailureNote> = causes.into_values().collect();
    notes.sort_by_key(|note| (std::cmp::Reverse(note.count), note.job));
    notes.truncate(MOST_CAUSES);
    (notes, found)
}

/// A job's axes in words: those that differ between jobs, or all where none does.
pub(super) fn axes_in_words(jobs: &Table, names: &[String], row: usize) -> String {
    let of = |name: &String| {
        let cell = jobs.cell(name, row);
        let value_label = labels::value(name, &cell);
        match name.as_str() {
            _ if cell.is_nothing() => None,
            "connection" | "speed_m_s" | "load_n" => Some(value_label),
            _ => Some(format!("{} {value_label}", labels::label(name))),
        }
    };
    names.iter().filter_map(of).collect::<Vec<_>>().join(", ")
}
