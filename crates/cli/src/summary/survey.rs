//! One look at all rows of a summary: which axes vary, over what, and where the peaks are largest.
//!
//! Knows rows as they come, a million of them at no more than a few bytes each. Does not know how any of it is written.

use pontoon_results::PEAKS;
use serde_json::Value;
use std::collections::HashSet;
use std::hash::{DefaultHasher, Hash, Hasher};

/// A row of a summary.
pub(super) type Row = Vec<Value>;

/// Axes that one may look along, the best first.
const ALONG: [&str; 3] = ["speed_m_s", "load_position", "load_x_m"];

/// Most values of an axis that are kept.
const MOST_VALUES: usize = 400;

/// What a look at all rows has found.
#[derive(Debug)]
pub(super) struct Survey {
    /// Places of the axes that vary, in their order.
    pub varying: Vec<usize>,
    /// Places of the axes that have one value, and the value.
    pub constant: Vec<(usize, Value)>,
    /// The axis to look along and its values, increasing; none where rows have little in common.
    pub along: Option<(usize, Vec<Value>)>,
    /// Combinations of the varying axes but the one to look along.
    pub combinations: usize,
    /// Rows.
    pub rows: usize,
    /// The peaks that there are: place of the column, largest value, its row.
    pub largest: Vec<(usize, f64, Row)>,
}

/// What is seen of an axis.
#[derive(Default)]
struct Seen {
    first: Option<Value>,
    varies: bool,
    nulls: usize,
    values: Vec<Value>,
    too_many: bool,
}

impl Seen {
    fn see(&mut self, value: &Value) {
        if value.is_null() {
            self.nulls += 1;
            return;
        }
        self.varies |= self.first.get_or_insert_with(|| value.clone()) != value;
        if !self.too_many
            && let Err(at) = self.values.binary_search_by(|known| order(known, value))
        {
            self.values.insert(at, value.clone());
            self.too_many = self.values.len() > MOST_VALUES;
        }
    }
}

fn order(a: &Value, b: &Value) -> std::cmp::Ordering {
    match (a.as_f64(), b.as_f64()) {
        (Some(a), Some(b)) => a.total_cmp(&b),
        _ => a.to_string().cmp(&b.to_string()),
    }
}

impl Survey {
    /// Looks at all rows twice.
    pub(super) fn new<I: Iterator<Item = Row>>(columns: &[String], rows: impl Fn() -> I) -> Self {
        let place = |name: &str| columns.iter().position(|column| column == name);
        let peaks: Vec<usize> = PEAKS.iter().filter_map(|name| place(name)).collect();
        let axes: Vec<usize> = (0..columns.len()).filter(|i| !peaks.contains(i)).collect();
        let mut seen: Vec<Seen> = axes.iter().map(|_| Seen::default()).collect();
        let mut largest: Vec<Option<(f64, Row)>> = vec![None; peaks.len()];
        let mut count = 0;
        for row in rows() {
            count += 1;
            axes.iter().zip(&mut seen).for_each(|(&i, seen)| seen.see(&row[i]));
            for (&i, largest) in peaks.iter().zip(&mut largest) {
                let peak = row[i].as_f64();
                if let Some(peak) = peak.filter(|peak| largest.as_ref().is_none_or(|(most, _)| peak > most)) {
                    *largest = Some((peak, row.clone()));
                }
            }
        }
        // a gap has no meaning where the connection is linear: that is no second value of it
        let connection = place("connection").and_then(|i| axes.iter().position(|&axis| axis == i));
        let linear = connection.is_some_and(|i| seen[i].varies);
        let is_gap = |i: usize| ["gap_tension_m", "gap_compression_m"].contains(&columns[i].as_str());
        let (mut varying, mut constant) = (Vec::new(), Vec::new());
        for (&i, seen) in axes.iter().zip(&seen) {
            let nulls = seen.nulls > 0 && seen.nulls < count && !(linear && is_gap(i));
            match &seen.first {
                Some(first) if !seen.varies && !nulls => constant.push((i, first.clone())),
                Some(_) => varying.push(i),
                None => {}
            }
        }
        // where the load's position tells its place, the place is not told again
        let whole = |name: &str| {
            let i = place(name)?;
            let seen = &seen[axes.iter().position(|&axis| axis == i)?];
            (seen.nulls == 0 && count > 0).then_some(i)
        };
        if let (Some(_), Some(x)) = (whole("load_position"), place("load_x_m")) {
            varying.retain(|&i| i != x);
            constant.retain(|&(i, _)| i != x);
        }
        let along = ALONG
            .iter()
            .filter_map(|name| whole(name))
            .find(|i| varying.contains(i));
        let mut along = along.and_then(|i| {
            let seen = &seen[axes.iter().position(|&axis| axis == i)?];
            (!seen.too_many).then(|| (i, seen.values.clone()))
        });
        let others = |along: Option<usize>| {
            varying
                .iter()
                .copied()
                .filter(|i| Some(*i) != along)
                .collect::<Vec<_>>()
        };
        let mut combinations = combinations(rows(), &others(along.as_ref().map(|(i, _)| *i)));
        // a table that would be empty for the most part says less than a list
        if along
            .as_ref()
            .is_some_and(|(_, values)| 2 * count < combinations * values.len())
        {
            along = None;
            combinations = count;
        }
        let largest = peaks.into_iter().zip(largest);
        Self {
            varying: others(along.as_ref().map(|(i, _)| *i)),
            constant,
            along,
            combinations,
            rows: count,
            largest: largest
                .filter_map(|(i, most)| most.map(|(peak, row)| (i, peak, row)))
                .collect(),
        }
    }
}

/// How many combinations of some axes there are.
fn combinations(rows: impl Iterator<Item = Row>, axes: &[usize]) -> usize {
    let hashes: HashSet<u64> = rows.map(|row| hash(&row, axes)).collect();
    hashes.len()
}

/// A number for the values of some axes.
pub(super) fn hash(row: &Row, axes: &[usize]) -> u64 {
    let mut hasher = DefaultHasher::new();
    axes.iter().for_each(|&i| row[i].to_string().hash(&mut hasher));
    hasher.finish()
}
