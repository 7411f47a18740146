//! The largest of each measure, with its place and job; why jobs failed.
//!
//! Knows which columns tell the place of a peak. Does not know cells.

use super::cells::Measure;
use crate::labels;
use pontoon_results::{Results, Table, words_of_reason};
use serde::Serialize;
use serde_json::Value;
use std::collections::BTreeMap;

/// Measures that have a card, each with the columns of its place and time.
const CARDS: [(&str, &str, &str, &str); 6] = [
    (
        "peak_deflection_m",
        "largest deflection",
        "peak_deflection_position",
        "peak_deflection_time_s",
    ),
    (
        "peak_uplift_m",
        "largest uplift",
        "peak_uplift_position",
        "peak_uplift_time_s",
    ),
    (
        "peak_compression_n",
        "largest compression",
        "peak_compression_joint",
        "",
    ),
    ("peak_tension_n", "largest tension", "peak_tension_joint", ""),
    ("dynamic_amplification", "largest dynamic amplification", "", ""),
    ("influential_length_m", "longest influential length", "", ""),
];

/// Most causes of failures that are listed.
const MOST_CAUSES: usize = 50;

/// The largest value of a measure.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Card {
    /// The measure's column.
    pub measure: &'static str,
    /// In words.
    pub label: &'static str,
    /// The value.
    pub value: f64,
    /// Its unit.
    pub unit: &'static str,
    /// Where and when.
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
    /// How many.
    pub count: usize,
    /// The first of them.
    pub job: u32,
    /// Why that one did.
    pub reason: String,
}

/// The cards of a table of jobs.
pub(super) fn cards(results: &Results, measures: &[Measure], said: &dyn Fn(usize) -> String) -> Vec<Card> {
    let jobs = results.jobs();
    let card = |(name, label, place, time): (&str, &'static str, &str, &str)| {
        let measure = measures.iter().find(|measure| measure.name == name)?;
        let numbers = jobs.numbers(name)?;
        let of = |row: usize| numbers[row].filter(|_| !results.is_failed(row));
        // the first of equals
        let row = (0..jobs.rows()).filter(|&row| of(row).is_some()).max_by(|&a, &b| {
            let by_value = of(a).unwrap_or_default().total_cmp(&of(b).unwrap_or_default());
            by_value.then(b.cmp(&a))
        })?;
        let kind = if place.ends_with("_joint") { "joint" } else { "position" };
        let at = jobs.number(place, row).map(|place| format!("{kind} {place}"));
        let when = jobs.number(time, row).map(|time| format!("at {time:.2} s"));
        Some(Card {
            measure: measure.name,
            label,
            value: of(row)?,
            unit: measure.unit,
            place: [at, when].into_iter().flatten().collect::<Vec<_>>().join(" "),
            job: (of(row) != Some(0.0)).then(|| super::job(results, row)),
            axes: if of(row) == Some(0.0) { String::new() } else { said(row) },
        })
    };
    CARDS.into_iter().filter_map(card).collect()
}

/// Why jobs failed, the commonest cause first, and how many causes there are. Reasons that differ in numbers alone are one
/// cause.
pub(super) fn failures(results: &Results) -> (Vec<FailureNote>, usize) {
    let jobs = results.jobs();
    let mut causes: BTreeMap<String, FailureNote> = BTreeMap::new();
    for row in (0..jobs.rows()).filter(|&row| results.is_failed(row)) {
        let reason = match jobs.cell("reason", row) {
            Value::String(reason) => reason,
            _ => "no reason".to_owned(),
        };
        let first = || FailureNote {
            count: 0,
            job: super::job(results, row),
            reason: reason.clone(),
        };
        causes.entry(words_of_reason(&reason)).or_insert_with(first).count += 1;
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
        let said = labels::value(name, &cell);
        match name.as_str() {
            _ if cell.is_null() => None,
            "connection" | "speed_m_s" | "load_n" => Some(said),
            _ => Some(format!("{} {said}", labels::label(name))),
        }
    };
    names.iter().filter_map(of).collect::<Vec<_>>().join(", ")
}
