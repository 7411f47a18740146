//! Points of a reference that are drawn beside results.
//!
//! Knows what was measured and which checks say what a position, a joint or a job should have. Does not know which figure a
//! mark ends in, and judges nothing.

use pontoon_judge::checks::{Check, CheckCurve, Expectation};
use pontoon_judge::quantity::SelectQuantity;
use pontoon_judge::reference::{Against, MeasuredSpec, Reference};
use pontoon_plan::input::filter::{Allowed, Filter};
use pontoon_plan::input::{Cell, Refusal};
use pontoon_results::{Column, ColumnRole, Results, Table, TableName};
use serde::Serialize;
use std::collections::BTreeMap;

/// What a mark is drawn in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Chart {
    /// Something along the bridge, against `x_m`.
    Profile,
    /// Something against `speed_m_s`.
    Speed,
    /// Something against `time_s`.
    History,
}

/// Whether a mark was measured, or is what a check expects.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Origin {
    /// A measured point of the reference, or the value of a check of kind `measured`.
    Measured,
    /// What a check expects; whose number that is its id, statement and note say.
    Expected,
}

/// A point of a reference.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ReferenceMark {
    /// Id of the measurement or of the check.
    pub id: String,
    /// Whether it was measured.
    pub origin: Origin,
    /// What it is drawn in.
    pub chart: Chart,
    /// The table whose column it is; of histories the column is their quantity.
    pub table: TableName,
    /// Name of what it is, with its unit and sense: `deflection_m`, `peak_compression_n`, ...
    pub column: String,
    /// Where across the chart: `x_m`, `speed_m_s` or `time_s`; none where the results do not have the position.
    pub x: Option<f64>,
    /// The value, in the unit of its column.
    pub y: f64,
    /// Position or joint number, where it is one's.
    pub position: Option<u32>,
    /// The axes that are fixed for it. A job to which the mark belongs has these values.
    pub axes: BTreeMap<String, Cell<'static>>,
    /// Words for a legend.
    pub label: String,
    /// What else is said of it.
    pub note: Option<String>,
}

impl ReferenceMark {
    /// Whether the job in a row of the table of jobs has the axes that are fixed for the mark.
    pub fn belongs_to(&self, jobs: &Table, row: usize) -> bool {
        let fits = |(axis, value): (&String, &Cell<'_>)| jobs.has(axis) && same_value(value, &jobs.cell(axis, row));
        self.axes.iter().all(fits)
    }
}

/// The marks of a reference: all its measured points in the order of the file, then what its checks expect of single
/// positions, joints and jobs. A check whose point was measured as well leaves no second mark.
///
/// # Errors
/// [`Refusal`] where a measurement names an axis that the study does not have.
pub fn marks(results: &Results, reference: &Reference) -> Result<Vec<ReferenceMark>, Refusal> {
    let mut found = Vec::new();
    for (i, group) in reference.measured.iter().enumerate() {
        let known = results.axes();
        let place = group.place();
        for (name, _) in &group.filter.0 {
            if Some(name.as_str()) != place && !known.contains(name) {
                let key = format!("measured[{i}].where.{name}");
                return Err(Refusal::unknown_key(&reference.file, key, name, &known));
            }
        }
        found.extend(of_measured(group));
    }
    let places = PositionPlaces::new(results);
    for check in &reference.checks {
        let expected = of_check(&places, check);
        let new: Vec<ReferenceMark> = expected
            .into_iter()
            .filter(|mark| !found.iter().any(|other| same_point(other, mark)))
            .collect();
        found.extend(new);
    }
    Ok(found)
}

/// Numbers closer than this share of each other are one point: both are decimals of one file.
const SAME_POINT: f64 = 1e-6;

/// Whether two marks are one point: the same number at the same place, and no axis that both fix differs.
fn same_point(a: &ReferenceMark, b: &ReferenceMark) -> bool {
    let near = |a: f64, b: f64| (a - b).abs() <= SAME_POINT * a.abs().max(b.abs());
    let same_x = match (a.x, b.x) {
        (Some(a), Some(b)) => near(a, b),
        (a, b) => a == b,
    };
    let agree = |(axis, value): (&String, &Cell<'_>)| b.axes.get(axis).is_none_or(|other| same_value(value, other));
    (a.chart, &a.column) == (b.chart, &b.column) && same_x && near(a.y, b.y) && a.axes.iter().all(agree)
}

fn same_value(a: &Cell<'_>, b: &Cell<'_>) -> bool {
    Allowed::one(a).allows(b)
}

fn of_measured(group: &MeasuredSpec) -> impl Iterator<Item = ReferenceMark> {
    let (position, axes) = place_and_axes(&group.filter).unwrap_or_default();
    let chart = match group.against {
        Against::X => Chart::Profile,
        Against::Speed => Chart::Speed,
        Against::Time => Chart::History,
    };
    group.points.iter().map(move |&[x, y]| ReferenceMark {
        id: group.id.clone(),
        origin: Origin::Measured,
        chart,
        table: group.of.table,
        column: group.of.column.clone(),
        x: Some(x),
        y,
        position,
        axes: axes.clone(),
        label: group.id.clone(),
        note: group.note.clone(),
    })
}

/// What a check expects, where that is a point of a chart.
fn of_check(places: &PositionPlaces<'_>, check: &Check) -> Vec<ReferenceMark> {
    if !check.each.is_empty() {
        return Vec::new();
    }
    match check.expectation() {
        Expectation::Value {
            select,
            value,
            measured,
        } => {
            let origin = if measured { Origin::Measured } else { Origin::Expected };
            of_select(places, check, select, value, origin)
        }
        Expectation::Curve(curve) => of_curve(check, &curve),
        Expectation::Mode { .. } | Expectation::None => Vec::new(),
    }
}

fn of_select(
    places: &PositionPlaces<'_>,
    check: &Check,
    select: &SelectQuantity,
    y: f64,
    origin: Origin,
) -> Vec<ReferenceMark> {
    let Some((position, mut axes)) = place_and_axes(&select.filter.within(&check.filter)) else {
        return Vec::new();
    };
    if !Column::of(select.table, &select.column).is_some_and(|column| column.drawn) {
        return Vec::new();
    }
    let mark = |chart: Chart, x: Option<f64>, axes: BTreeMap<String, Cell<'static>>| ReferenceMark {
        id: check.id.clone(),
        origin,
        chart,
        table: select.table,
        column: select.column.clone(),
        x,
        y,
        position,
        axes,
        label: check.id.clone(),
        note: check.note.clone().or_else(|| check.statement.clone()),
    };
    let mut marks = Vec::new();
    if let (TableName::Positions, Some(position)) = (select.table, position) {
        marks.push(mark(Chart::Profile, places.x_m(position, &axes), axes.clone()));
    }
    let placed = position.is_some() || select.table == TableName::Jobs;
    if placed && let Some(speed_m_s) = axes.remove("speed_m_s").as_ref().and_then(Cell::number) {
        marks.push(mark(Chart::Speed, Some(speed_m_s), axes));
    }
    marks
}

fn of_curve(check: &Check, curve: &CheckCurve<'_>) -> Vec<ReferenceMark> {
    let Some((position, axes)) = place_and_axes(&check.filter) else {
        return Vec::new();
    };
    let chart = match (curve.table, curve.against) {
        (TableName::Positions, "x_m") => Chart::Profile,
        (TableName::Positions | TableName::Connectors, "speed_m_s") if position.is_some() => Chart::Speed,
        (TableName::Jobs, "speed_m_s") => Chart::Speed,
        _ => return Vec::new(),
    };
    let mark = |&[x, y]: &[f64; 2]| ReferenceMark {
        id: check.id.clone(),
        origin: Origin::Expected,
        chart,
        table: curve.table,
        column: curve.column.to_owned(),
        x: Some(x),
        y,
        position,
        axes: axes.clone(),
        label: check.id.clone(),
        note: check.note.clone().or_else(|| check.statement.clone()),
    };
    curve.points.iter().map(mark).collect()
}

/// The position or joint and the axes of a filter; none where it names several values of one, or what is no axis.
fn place_and_axes(filter: &Filter) -> Option<(Option<u32>, BTreeMap<String, Cell<'static>>)> {
    let (mut position, mut axes) = (None, BTreeMap::new());
    for (name, allowed) in &filter.0 {
        let value = allowed.single()?;
        let role = Column::named(name).map(|column| column.role);
        match name.as_str() {
            "position" | "joint" => {
                let number = value.number().filter(|n| *n >= 1.0 && n.fract() == 0.0)?;
                position = Some(number as u32);
            }
            "y_m" if value.is_nothing() => {}
            _ if matches!(role, Some(ColumnRole::Key | ColumnRole::State)) => return None,
            _ => {
                axes.insert(name.clone(), value.clone());
            }
        }
    }
    Some((position, axes))
}

/// Where along the bridge positions are: of each its rows' jobs, by their row in the table of jobs, and `x_m`.
struct PositionPlaces<'a> {
    results: &'a Results,
    of_position: BTreeMap<u32, Vec<(usize, f64)>>,
}

impl<'a> PositionPlaces<'a> {
    fn new(results: &'a Results) -> Self {
        let mut of_position: BTreeMap<u32, Vec<(usize, f64)>> = BTreeMap::new();
        let table = results.table(TableName::Positions);
        let column = |name| table.and_then(|table| table.numbers(name)).unwrap_or_default();
        for ((job, position), x_m) in column("job").iter().zip(column("position")).zip(column("x_m")) {
            if let (Some(job), Some(position), Some(x_m)) = (job, position, x_m)
                && let Some(row) = results.row_of_job(*job as u64)
            {
                of_position.entry(*position as u32).or_default().push((row, *x_m));
            }
        }
        Self { results, of_position }
    }

    /// Where a position is in the first job that has the axes.
    fn x_m(&self, position: u32, axes: &BTreeMap<String, Cell<'static>>) -> Option<f64> {
        let jobs = self.results.jobs();
        let has = |row: usize| {
            axes.iter()
                .all(|(axis, value)| same_value(value, &jobs.cell(axis, row)))
        };
        let (_, x_m) = self.of_position.get(&position)?.iter().find(|(row, _)| has(*row))?;
        Some(*x_m)
    }
}
