//! One look at all rows of a summary: which axes vary, over what, and where the peaks are largest.
//!
//! Knows rows as they come, a million of them at no more than a few bytes each. Does not know how any of it is written.

use pontoon_plan::input::Cell;
use pontoon_results::{Column, Seen, TableName};
use std::cmp::Ordering;
use std::collections::HashSet;
use std::hash::{DefaultHasher, Hash, Hasher};

/// A row of a summary.
pub(super) type SummaryRow<'a> = Vec<Cell<'a>>;

/// Axes that one may look along, the best first.
const ALONG: [&str; 3] = ["speed_m_s", "load_position", "load_x_m"];

/// Most values of an axis that are kept.
const MOST_VALUES: usize = 400;

/// What a look at all rows has found.
#[derive(Debug)]
pub(super) struct Survey<'a> {
    /// Places of the axes that vary, in their order, without the one to look along.
    pub varying: Vec<usize>,
    /// Places of the axes that have one value, and the value.
    pub constant: Vec<(usize, Cell<'static>)>,
    /// The axis to look along; none where rows have little in common.
    pub along: Option<SurveyAxis<'a>>,
    /// Combinations of the varying axes but the one to look along.
    pub combinations: usize,
    /// Rows.
    pub rows: usize,
    /// The peaks that there are.
    pub largest: Vec<Largest<'a>>,
}

/// An axis to look along.
#[derive(Debug)]
pub(super) struct SurveyAxis<'a> {
    /// Its place.
    pub axis: usize,
    /// Its values, increasing.
    pub values: Vec<Cell<'a>>,
}

/// The largest value of a peak.
#[derive(Debug)]
pub(super) struct Largest<'a> {
    /// Place of its column.
    pub column: usize,
    /// The value.
    pub most: f64,
    /// Its row.
    pub row: SummaryRow<'a>,
}

/// What all rows have in an axis.
struct AxisValueSet<'a> {
    place: usize,
    seen: Seen,
    values: Vec<Cell<'a>>,
    too_many: bool,
}

impl<'a> AxisValueSet<'a> {
    fn new(place: usize) -> Self {
        Self {
            place,
            seen: Seen::default(),
            values: Vec::new(),
            too_many: false,
        }
    }

    fn take(&mut self, cell: &Cell<'a>) {
        self.seen.take(cell);
        if !cell.is_nothing()
            && !self.too_many
            && let Err(at) = self.values.binary_search_by(|known| order(known, cell))
        {
            self.values.insert(at, cell.clone());
            self.too_many = self.values.len() > MOST_VALUES;
        }
    }
}

fn order(a: &Cell<'_>, b: &Cell<'_>) -> Ordering {
    match (a.number(), b.number()) {
        (Some(a), Some(b)) => a.total_cmp(&b),
        _ => a.to_string().cmp(&b.to_string()),
    }
}

/// What the first look finds.
struct FirstPass<'a> {
    axes: Vec<AxisValueSet<'a>>,
    largest: Vec<Largest<'a>>,
    rows: usize,
}

impl<'a> FirstPass<'a> {
    fn at(columns: &[String], rows: impl Iterator<Item = SummaryRow<'a>>) -> Self {
        let peaks = peaks_among(columns);
        let axes = (0..columns.len()).filter(|i| !peaks.contains(i)).map(AxisValueSet::new);
        let mut first_pass = Self {
            axes: axes.collect(),
            largest: Vec::new(),
            rows: 0,
        };
        let mut largest: Vec<Option<Largest<'a>>> = peaks.iter().map(|_| None).collect();
        for row in rows {
            first_pass.rows += 1;
            first_pass.axes.iter_mut().for_each(|axis| axis.take(&row[axis.place]));
            for (&column, largest) in peaks.iter().zip(&mut largest) {
                let peak = row[column].number();
                if let Some(most) = peak.filter(|peak| largest.as_ref().is_none_or(|known| *peak > known.most)) {
                    let row = row.clone();
                    *largest = Some(Largest { column, most, row });
                }
            }
        }
        first_pass.largest = largest.into_iter().flatten().collect();
        first_pass
    }

    fn axis(&self, columns: &[String], name: &str) -> Option<&AxisValueSet<'a>> {
        self.axes.iter().find(|axis| columns[axis.place] == name)
    }

    /// Places of the axes that vary, and those of one value with it.
    fn parted(&self, columns: &[String]) -> (Vec<usize>, Vec<(usize, Cell<'static>)>) {
        // a gap has no meaning where the connection is linear: that is no second value of it
        let linear = self
            .axis(columns, "connection")
            .is_some_and(|axis| axis.seen.has_several());
        let is_gap = |i: usize| ["gap_tension_m", "gap_compression_m"].contains(&columns[i].as_str());
        // where the load's position tells its place, the place is not told again
        let told = self
            .axis(columns, "load_position")
            .is_some_and(|axis| axis.seen.is_whole());
        let (mut varying, mut constant) = (Vec::new(), Vec::new());
        for AxisValueSet { place, seen, .. } in &self.axes {
            let varies = if linear && is_gap(*place) {
                seen.has_several()
            } else {
                seen.varies()
            };
            match seen.only() {
                _ if told && columns[*place] == "load_x_m" => {}
                _ if varies => varying.push(*place),
                Some(only) => constant.push((*place, only.clone())),
                None => {}
            }
        }
        (varying, constant)
    }

    /// The axis to look along: the first of those that have a value in every row, few of them.
    fn along(&self, columns: &[String], varying: &[usize]) -> Option<SurveyAxis<'a>> {
        let mut whole = ALONG
            .iter()
            .filter_map(|name| self.axis(columns, name))
            .filter(|axis| axis.seen.is_whole() && varying.contains(&axis.place));
        whole.next().filter(|axis| !axis.too_many).map(|axis| SurveyAxis {
            axis: axis.place,
            values: axis.values.clone(),
        })
    }
}

impl<'a> Survey<'a> {
    /// Looks at all rows twice.
    pub(super) fn new<I: Iterator<Item = SummaryRow<'a>>>(columns: &[String], rows: impl Fn() -> I) -> Self {
        let first_pass = FirstPass::at(columns, rows());
        let (varying, constant) = first_pass.parted(columns);
        let mut along = first_pass.along(columns, &varying);
        let others = |along: &Option<SurveyAxis<'_>>| {
            let along = along.as_ref().map(|along| along.axis);
            varying
                .iter()
                .copied()
                .filter(|i| Some(*i) != along)
                .collect::<Vec<_>>()
        };
        let mut combinations = combinations(rows(), &others(&along));
        // a table that would be empty for the most part says less than a list
        if along
            .as_ref()
            .is_some_and(|along| 2 * first_pass.rows < combinations * along.values.len())
        {
            along = None;
            combinations = first_pass.rows;
        }
        Self {
            varying: others(&along),
            constant,
            along,
            combinations,
            rows: first_pass.rows,
            largest: first_pass.largest,
        }
    }
}

/// Places of the columns of peaks.
pub(super) fn peaks_among(columns: &[String]) -> Vec<usize> {
    let place = |peak: &Column| columns.iter().position(|column| column == peak.name);
    Column::of_table(TableName::Jobs)
        .filter(|column| column.in_summary)
        .filter_map(place)
        .collect()
}

/// How many combinations of some axes there are.
fn combinations<'a>(rows: impl Iterator<Item = SummaryRow<'a>>, axes: &[usize]) -> usize {
    let hashes: HashSet<u64> = rows.map(|row| hash(&row, axes)).collect();
    hashes.len()
}

/// A number for the values of some axes.
pub(super) fn hash(row: &SummaryRow<'_>, axes: &[usize]) -> u64 {
    let mut hasher = DefaultHasher::new();
    axes.iter().for_each(|&i| row[i].hash(&mut hasher));
    hasher.finish()
}
