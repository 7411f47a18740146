//! Rows of jobs that a page lists, with their profiles along the bridge; the envelope of all jobs.
//!
//! Knows how many rows are too many and which ones tell most. Does not know cells.

use super::cells::PageMeasure;
use super::packed::Packed;
use crate::thinning::spread;
use pontoon_plan::input::Cell;
use pontoon_results::{Column, ColumnKind, ColumnRole, Results, ResultsError, Table, TableName, labels};
use serde::Serialize;
use std::collections::{BTreeSet, HashMap};

/// Most rows that a page lists.
pub(super) const MOST_ROWS: usize = 2_000;

/// Of more jobs: the ones with the largest values of each measure, and failed ones.
const SEVEREST: usize = 150;
const MOST_FAILED: usize = 200;

/// Words by their index, 65535 where there is none.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct WordList {
    /// The distinct words.
    pub words: Vec<String>,
    /// For each row the word.
    pub index: Packed,
}

impl WordList {
    fn new(cells: impl Iterator<Item = Option<String>>) -> Self {
        let (mut words, mut places) = (Vec::new(), HashMap::new());
        let index = cells
            .map(|cell| {
                let Some(word) = cell else { return u16::MAX };
                *places.entry(word.clone()).or_insert_with(|| {
                    words.push(word);
                    u16::try_from(words.len() - 1).unwrap_or(u16::MAX)
                })
            })
            .collect();
        Self {
            words,
            index: Packed::U16(index),
        }
    }
}

/// Cells of a column.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum ColumnData {
    /// Numbers.
    Numbers(Packed),
    /// Words.
    Words(WordList),
}

/// A column of the rows.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RowColumn {
    /// Its name in the table of jobs.
    pub name: String,
    /// In words.
    pub label: String,
    /// Its unit.
    pub unit: &'static str,
    /// `number` or `word`.
    pub kind: &'static str,
    /// Its cells.
    pub data: ColumnData,
}

/// What rows are along the bridge: a line of positions or joints for each row, NaN where a job failed.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PageProfile {
    /// Largest deflection of each position `[m]`.
    pub deflection_m: Packed,
    /// Largest uplift `[m]`.
    pub uplift_m: Packed,
    /// Largest compression of each joint `[N]`.
    pub compression_n: Packed,
    /// Largest tension `[N]`.
    pub tension_n: Packed,
    /// Deflected line of static jobs, positive downward `[m]`.
    pub signed_m: Option<Packed>,
}

/// Rows of the table of jobs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct JobRows {
    /// Number of rows.
    pub count: usize,
    /// Which jobs they are.
    pub note: String,
    /// Their columns: axes, then outcomes.
    pub columns: Vec<RowColumn>,
    /// The job of each row.
    pub job: Packed,
    /// 1 where it did not fail.
    pub ok: Packed,
    /// Why it failed, or what else is to be said.
    pub reason: WordList,
    /// Along the bridge, where the study leaves the tables of positions and connectors.
    pub profile: Option<PageProfile>,
}

/// Largest values along the bridge, of all jobs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PageEnvelope {
    /// Places of the positions `[m]`.
    pub x_m: Vec<f64>,
    /// Largest deflection there `[m]`.
    pub deflection_m: Packed,
    /// Largest uplift `[m]`.
    pub uplift_m: Packed,
    /// Places of the joints `[m]`.
    pub joint_x_m: Vec<f64>,
    /// Largest compression there `[N]`.
    pub compression_n: Packed,
    /// Largest tension `[N]`.
    pub tension_n: Packed,
}

/// The rows of the table of jobs that a page lists, in their order.
pub(super) fn chosen(results: &Results, measures: &[PageMeasure]) -> (Vec<usize>, String) {
    let jobs = results.jobs();
    let all = jobs.rows();
    if all <= MOST_ROWS {
        let note = if all == 1 {
            "the one job".to_owned()
        } else {
            format!("all {all} jobs")
        };
        return ((0..all).collect(), note);
    }
    let every: Vec<usize> = (0..all).collect();
    let mut rows: BTreeSet<usize> = BTreeSet::new();
    rows.extend((0..all).filter(|&row| results.is_failed(row)).take(MOST_FAILED));
    for measure in measures.iter().take(4) {
        rows.extend(severest(jobs, measure.name, &every).into_iter().take(SEVEREST));
    }
    let severe = rows.len();
    let left: Vec<usize> = (0..all).filter(|row| !rows.contains(row)).collect();
    rows.extend(
        spread(left.len(), MOST_ROWS - severe)
            .into_iter()
            .map(|place| left[place]),
    );
    let note = format!(
        "{} of {all} jobs: {severe} that failed or have the largest values, and an even sample",
        rows.len()
    );
    (rows.into_iter().collect(), note)
}

/// Places among `rows` in falling order of a column's values; rows without a value are left out.
pub(super) fn severest(jobs: &Table, column: &str, rows: &[usize]) -> Vec<usize> {
    let Some(numbers) = jobs.numbers(column) else {
        return Vec::new();
    };
    let mut places: Vec<usize> = (0..rows.len()).filter(|&at| numbers[rows[at]].is_some()).collect();
    let value = |at: usize| numbers[rows[at]].unwrap_or_default();
    places.sort_by(|&a, &b| value(b).total_cmp(&value(a)).then(a.cmp(&b)));
    places
}

impl JobRows {
    /// The rows with their profiles and the envelope of all jobs.
    ///
    /// # Errors
    /// [`ResultsError::Damaged`].
    pub(super) fn new(
        results: &Results,
        axes: &[String],
        measures: &[PageMeasure],
        (rows, note): &(Vec<usize>, String),
        notes: &mut Vec<String>,
    ) -> Result<(Self, Option<PageEnvelope>), ResultsError> {
        let jobs = results.jobs();
        let further = Column::of_table(TableName::Jobs).filter(|column| column.role == ColumnRole::Listed);
        let further = further.map(|column| column.name);
        let outcomes = measures.iter().map(|measure| measure.name).chain(further);
        let there = |name: &String| jobs.kind(name).is_some();
        let names = axes.iter().cloned().chain(outcomes.map(str::to_owned)).filter(there);
        let lines = match along(results, rows)? {
            AlongBridge::Lines(lines) => Some(*lines),
            AlongBridge::Nothing => None,
            AlongBridge::Bridges => {
                notes
                    .push("The jobs' bridges have positions at different places: no envelope, no profiles.".to_owned());
                None
            }
        };
        let (profile, envelope) = lines.unzip();
        let listed = Self {
            count: rows.len(),
            note: note.clone(),
            columns: names.map(|name| column(jobs, name, rows)).collect(),
            job: Packed::U32(rows.iter().map(|&row| super::job(results, row)).collect()),
            ok: Packed::U8(rows.iter().map(|&row| u8::from(!results.is_failed(row))).collect()),
            reason: WordList::new(
                rows.iter()
                    .map(|&row| jobs.cell("reason", row).word().map(str::to_owned)),
            ),
            profile,
        };
        Ok((listed, envelope))
    }
}

fn column(jobs: &Table, name: String, rows: &[usize]) -> RowColumn {
    let numeric = matches!(jobs.kind(&name), Some(ColumnKind::Numbers | ColumnKind::Flags));
    let text = |row: &usize| match jobs.cell(&name, *row) {
        Cell::Nothing => None,
        other => Some(other.text()),
    };
    let data = if numeric {
        ColumnData::Numbers(Packed::numbers(rows.iter().map(|&row| jobs.number(&name, row))))
    } else {
        ColumnData::Words(WordList::new(rows.iter().map(text)))
    };
    RowColumn {
        label: labels::label(&name),
        unit: labels::unit(&name),
        kind: if numeric { "number" } else { "word" },
        data,
        name,
    }
}

/// Values by place of the chosen rows and the largest of all jobs.
struct ProfileLines {
    places: usize,
    /// Columns that the table has.
    found: usize,
    rows: Vec<Vec<f32>>,
    largest: Vec<Vec<f32>>,
}

impl ProfileLines {
    fn new(rows: usize, places: usize, columns: usize) -> Self {
        Self {
            places,
            found: 0,
            rows: vec![vec![f32::NAN; rows * places]; columns],
            largest: vec![vec![f32::NAN; places]; columns],
        }
    }

    fn take(&mut self, row: Option<usize>, place: usize, values: impl Iterator<Item = Option<f64>>) {
        for (column, value) in values.enumerate() {
            let Some(value) = value.map(|value| value as f32).filter(|_| place < self.places) else {
                continue;
            };
            // the larger, or the one that is there
            let largest = &mut self.largest[column][place];
            *largest = largest.max(value);
            if let Some(row) = row {
                self.rows[column][row * self.places + place] = value;
            }
        }
    }

    fn row(&mut self, column: usize) -> Packed {
        Packed::F32(std::mem::take(&mut self.rows[column]))
    }

    fn envelope(&mut self, column: usize) -> Packed {
        Packed::F32(std::mem::take(&mut self.largest[column]))
    }
}

/// Distance below which places are one `[m]`.
const SAME_PLACE_M: f64 = 1e-6;

/// What there is along the bridge.
enum AlongBridge {
    /// The study leaves no table of positions.
    Nothing,
    /// Jobs have bridges whose positions are at other places.
    Bridges,
    /// Profiles of the chosen rows and the envelope of all.
    Lines(Box<(PageProfile, PageEnvelope)>),
}

/// Places of the positions `[m]`, and whether jobs have them at different ones; none where there is no table of positions.
fn places(results: &Results) -> Result<(Vec<f64>, bool), ResultsError> {
    let (mut x_m, mut differ): (Vec<f64>, bool) = (Vec::new(), false);
    results.scan(TableName::Positions, &["position", "x_m"], |part| {
        for row in 0..part.rows() {
            let place = whole(part, "position", row).saturating_sub(1);
            if place >= x_m.len() {
                x_m.resize(place + 1, f64::NAN);
            }
            let own = part.number("x_m", row).unwrap_or(f64::NAN);
            differ |= (own - x_m[place]).abs() > SAME_PLACE_M;
            if x_m[place].is_nan() {
                x_m[place] = own;
            }
        }
    })?;
    Ok((x_m, differ))
}

/// Where the numbers of a table along the bridge are.
struct AlongTable<'a> {
    table: TableName,
    /// The column of the place, and its first number.
    place: (&'a str, usize),
    /// How many places there are.
    places: usize,
    columns: &'a [&'a str],
}

/// The lines of listed jobs, by their place in the list, and the largest of all.
fn lines(results: &Results, listed: &HashMap<u64, usize>, of: &AlongTable<'_>) -> Result<ProfileLines, ResultsError> {
    let (place, first) = of.place;
    let mut lines = ProfileLines::new(listed.len(), of.places, of.columns.len());
    let asked: Vec<&str> = ["job", place, "y_m"].iter().chain(of.columns).copied().collect();
    results.scan(of.table, &asked, |part| {
        let numbers: Vec<&[Option<f64>]> = of.columns.iter().filter_map(|column| part.numbers(column)).collect();
        lines.found = lines.found.max(numbers.len());
        let y = part.numbers("y_m");
        // of a joint its sum alone
        for row in (0..part.rows()).filter(|&row| y.is_none_or(|y| y[row].is_none())) {
            let of_job = listed.get(&(whole(part, "job", row) as u64)).copied();
            let at = whole(part, place, row).saturating_sub(first);
            lines.take(of_job, at, numbers.iter().map(|column| column[row]));
        }
    })?;
    Ok(lines)
}

fn along(results: &Results, rows: &[usize]) -> Result<AlongBridge, ResultsError> {
    let listed = rows.iter().enumerate();
    let listed: HashMap<u64, usize> = listed
        .map(|(i, &row)| (u64::from(super::job(results, row)), i))
        .collect();
    let (x_m, differ) = places(results)?;
    if x_m.is_empty() {
        return Ok(AlongBridge::Nothing);
    }
    if differ {
        return Ok(AlongBridge::Bridges);
    }
    let columns = ["peak_deflection_m", "peak_uplift_m", "deflection_m"];
    let mut at_ends = lines(
        results,
        &listed,
        &AlongTable {
            table: TableName::Positions,
            place: ("position", 1),
            places: x_m.len(),
            columns: &columns,
        },
    )?;
    let mut at_joints = lines(
        results,
        &listed,
        &AlongTable {
            table: TableName::Connectors,
            place: ("joint", 2),
            places: x_m.len().saturating_sub(2),
            columns: &["peak_compression_n", "peak_tension_n"],
        },
    )?;
    let profile = PageProfile {
        deflection_m: at_ends.row(0),
        uplift_m: at_ends.row(1),
        compression_n: at_joints.row(0),
        tension_n: at_joints.row(1),
        signed_m: (at_ends.found == columns.len()).then(|| at_ends.row(2)),
    };
    let envelope = PageEnvelope {
        joint_x_m: x_m.get(1..x_m.len().saturating_sub(1)).unwrap_or_default().to_vec(),
        x_m,
        deflection_m: at_ends.envelope(0),
        uplift_m: at_ends.envelope(1),
        compression_n: at_joints.envelope(0),
        tension_n: at_joints.envelope(1),
    };
    Ok(AlongBridge::Lines(Box::new((profile, envelope))))
}

fn whole(table: &Table, column: &str, row: usize) -> usize {
    table.number(column, row).map_or(0, |x| x as usize)
}
