//! The table that says which vehicle may cross how: vehicles against types of crossing, a crossing a cell.
//!
//! Knows rows of results. Does not know how a table is shown.

use pontoon_plan::input::Cell;
use pontoon_results::{Results, labels};
use serde::Serialize;

/// Vehicles against types of crossing.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ClassTable {
    /// What the columns that name rows are called.
    pub names: Vec<String>,
    /// Heads of the columns of cells: type and speed.
    pub heads: Vec<String>,
    /// The rows.
    pub rows: Vec<ClassRow>,
}

/// A row of it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ClassRow {
    /// What names it.
    pub names: Vec<String>,
    /// Its cells; none where no such crossing was asked for.
    pub cells: Vec<Option<ClassCell>>,
}

/// A crossing.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ClassCell {
    /// The job.
    pub job: u64,
    /// Largest utilisation of a limit; none where the crossing failed.
    pub utilisation: Option<f64>,
    /// The limit.
    pub limit: Option<String>,
    /// Position, joint, module or axle of its demand.
    pub place: Option<u64>,
}

impl ClassCell {
    /// Its utilisation, a mark where a limit is exceeded, the limit and its place.
    fn words(&self) -> String {
        let Some(utilisation) = self.utilisation else {
            return "failed".to_owned();
        };
        // two decimals, and as many more as tell what exceeds its limit from what is at it
        let with = |decimals: usize| format!("{utilisation:.decimals$}");
        let fewest = (2..8).find(|decimals| self.passes() || with(*decimals).parse() != Ok(1.0));
        let mark = if self.passes() { ' ' } else { '!' };
        let label = self.limit.as_deref().map(labels::label).unwrap_or_default();
        let place = self.place.map_or(String::new(), |place| format!(" {place}"));
        format!("{}{mark} {label}{place}", with(fewest.unwrap_or(8)))
    }

    /// Whether all limits hold.
    pub fn passes(&self) -> bool {
        self.utilisation.is_some_and(|utilisation| utilisation <= 1.0)
    }
}

/// The column of the types.
const TYPE: &str = "crossing_type";
const SPEED: &str = "speed_m_s";
const VEHICLE: &str = "vehicle";

impl ClassTable {
    /// What its cells say where they are words.
    pub const LEGEND: &'static str = "utilisation of the limit that governs, and where; ! where it is exceeded";

    /// Its rows in words.
    pub fn lines(&self) -> impl Iterator<Item = Vec<String>> {
        let line = |row: &ClassRow| {
            let cells = row
                .cells
                .iter()
                .map(|cell| cell.as_ref().map_or(String::new(), ClassCell::words));
            row.names.iter().cloned().chain(cells).collect()
        };
        self.rows.iter().map(line)
    }

    /// The table of results; none where they have no types of crossings or no limits, or are ratings.
    pub fn of(results: &Results) -> Option<Self> {
        let jobs = results.jobs();
        // all values that ratings tell pass
        if !(jobs.has(TYPE) && jobs.has("utilisation")) || jobs.has("rated_value") {
            return None;
        }
        let varies = |axis: &String| {
            let first = jobs.cell(axis, 0);
            (1..jobs.rows()).any(|row| jobs.cell(axis, row) != first)
        };
        let axes: Vec<String> = results.axes();
        let mut naming: Vec<&String> = axes
            .iter()
            .filter(|axis| {
                !matches!(axis.as_str(), TYPE | SPEED | "load_n") && (axis.as_str() == VEHICLE || varies(axis))
            })
            .collect();
        naming.sort_by_key(|axis| axis.as_str() != VEHICLE);
        let mut table = Self {
            names: naming.iter().map(|axis| labels::label(axis)).collect(),
            heads: Vec::new(),
            rows: Vec::new(),
        };
        for row in 0..jobs.rows() {
            let of = jobs.cell(TYPE, row).text();
            let speed = jobs.number(SPEED, row).map(labels::as_written).unwrap_or_default();
            let head = format!("{of} {speed} m/s");
            let names: Vec<String> = naming.iter().map(|axis| named(axis, &jobs.cell(axis, row))).collect();
            let column = table.column(head);
            let place = table.row(names);
            let cell = ClassCell {
                job: results.job_of_row(row),
                utilisation: jobs.number("utilisation", row),
                limit: Some(jobs.cell("governing_limit", row).text()).filter(|word| !word.is_empty()),
                place: jobs.number("governing_place", row).map(|place| place as u64),
            };
            let cells = &mut table.rows[place].cells;
            if cells.len() <= column {
                cells.resize(column + 1, None);
            }
            cells[column] = Some(cell);
        }
        let columns = table.heads.len();
        table.rows.iter_mut().for_each(|row| row.cells.resize(columns, None));
        Some(table)
    }

    fn column(&mut self, head: String) -> usize {
        self.heads.iter().position(|known| *known == head).unwrap_or_else(|| {
            self.heads.push(head);
            self.heads.len() - 1
        })
    }

    fn row(&mut self, names: Vec<String>) -> usize {
        self.rows
            .iter()
            .position(|known| known.names == names)
            .unwrap_or_else(|| {
                self.rows.push(ClassRow {
                    names,
                    cells: Vec::new(),
                });
                self.rows.len() - 1
            })
    }
}

/// A value of an axis as a row is named by it: of a path of a file its stem.
fn named(axis: &str, cell: &Cell<'_>) -> String {
    if axis != VEHICLE {
        return labels::value(axis, cell);
    }
    let text = cell.text();
    let stem = text.rsplit('/').next().unwrap_or_default();
    stem.strip_suffix(".json").unwrap_or(stem).to_owned()
}
