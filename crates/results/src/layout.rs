//! Which tables a study leaves, and the rows of each from records.
//!
//! Knows which columns of the registry a study has, and the types of its axes. Does not know files.

use super::arrays::{CellKind, Columns, type_of};
use super::frame::ArrowFrame;
use super::registry::{Column, ColumnSource, HistorySample, JointRow, RowOf, When};
use super::table::{Table, TableName};
use crate::JobRecord;
use pontoon_plan::design::{AxisValues, NamedAxis, Varies};
use pontoon_plan::input::Cell;
use pontoon_plan::job::{Job, has_springs};
use pontoon_plan::study_file::{Kind, RecordSpec, Study};
use std::io;
use std::sync::Arc;

/// The column behind which those of the axes stand.
const BEFORE_AXES: &str = "failure";

/// The column of an axis.
#[derive(Debug)]
struct AxisColumn {
    name: String,
    /// What its cells are.
    cells: CellKind,
    /// Where they come from; nowhere where the name is no axis's.
    axis: Option<Varies>,
}

impl AxisColumn {
    fn new(name: String, jobs: &[Job]) -> Self {
        let axis = Varies::of_column(&name);
        let cells = match NamedAxis::of(&name).map(|named| named.values) {
            Some(AxisValues::Counts) => CellKind::Counts,
            _ => type_of(jobs.iter().map(|job| cell_of(job, axis.as_ref()))),
        };
        Self { name, cells, axis }
    }
}

fn cell_of<'a>(job: &'a Job, axis: Option<&Varies>) -> Cell<'a> {
    axis.map_or(Cell::Nothing, |axis| job.cell(axis))
}

/// Which tables a study leaves and which columns each has, whatever part of its rows is at hand.
#[derive(Debug)]
pub(super) struct Layout {
    kind: Kind,
    axes: Vec<AxisColumn>,
    tables: Vec<TableName>,
    /// Whether any job's time step was to be found.
    auto: bool,
    /// Whether any job may be solved again.
    verify: bool,
    /// Whether any job has a vehicle on springs.
    springs: bool,
    /// Whether any job's bridge is in water with memory.
    waves: bool,
    /// Whether limits are stated.
    limits: bool,
    /// What is kept of jobs.
    record: Arc<RecordSpec>,
}

impl Layout {
    /// The layout of a study with all its jobs, whose axes make the types of columns.
    pub(super) fn new(study: &Study, jobs: &[Job]) -> Self {
        let (record, kind) = (&study.record, study.analysis.kind());
        let loaded = kind != Kind::Modes;
        let springs = jobs.iter().any(has_springs);
        let left = |name: &TableName| match name {
            TableName::Jobs => true,
            TableName::Positions => record.positions && loaded,
            TableName::Connectors => record.connectors && loaded,
            TableName::Histories => record.histories.asked() && loaded,
            TableName::Modes => !loaded,
            TableName::Pins => record.pins && loaded,
            TableName::Sections => record.sections && loaded,
            TableName::Places => !record.places_x_m.is_empty() && loaded,
            TableName::Banks => loaded && jobs.iter().any(|job| !job.shared.bridge.design.banks.is_empty()),
            TableName::Dead => loaded && jobs.iter().any(|job| job.shared.bridge.design.has_dead_load()),
            TableName::Freeboards => record.freeboards && loaded,
            TableName::Wheels | TableName::Bodies => springs,
            TableName::Limits => study.limits.is_some(),
            TableName::AtPeaks => !record.at_peak_of.is_empty() && kind.has_crossings(),
            TableName::Joints => study.wear.is_some() && loaded,
        };
        let crossings = || jobs.iter().filter_map(Job::as_crossing);
        Self {
            kind,
            axes: study
                .axis_columns()
                .into_iter()
                .map(|name| AxisColumn::new(name, jobs))
                .collect(),
            tables: TableName::ALL.into_iter().filter(left).collect(),
            auto: crossings().any(|crossing| crossing.analysis.time_step.tolerance().is_some()),
            springs,
            waves: jobs.iter().any(|job| job.shared.bridge.design.water.is_some()),
            limits: study.limits.is_some(),
            verify: crossings().any(|crossing| crossing.analysis.verify().is_some()),
            record: Arc::clone(record),
        }
    }

    /// The tables that the study leaves, in the order of their names.
    pub(super) fn tables(&self) -> impl Iterator<Item = TableName> {
        self.tables.iter().copied()
    }

    /// The rows of some jobs in a table, in the order of jobs, as arrays; no job makes the table without rows.
    pub(super) fn frame(&self, name: TableName, of: &[Job], records: &[JobRecord]) -> io::Result<ArrowFrame> {
        self.columns(name, of, records).frame()
    }

    /// The rows of some jobs as a table in memory.
    pub(super) fn table(&self, name: TableName, of: &[Job], records: &[JobRecord]) -> Table {
        Table::from_columns(self.columns(name, of, records))
    }

    fn columns<'a>(&self, table: TableName, jobs: &'a [Job], records: &'a [JobRecord]) -> Columns<'a> {
        self.some_columns(table, jobs, records, &|_| true)
    }

    /// The rows of some jobs in those columns of a table that are `wanted` by their names.
    pub(super) fn some_columns<'a>(
        &self,
        table: TableName,
        jobs: &'a [Job],
        records: &'a [JobRecord],
        wanted: &dyn Fn(&str) -> bool,
    ) -> Columns<'a> {
        let mut columns = Columns::default();
        for column in Column::of_table(table).filter(|column| self.has(column)) {
            match column.source {
                _ if !wanted(column.name) => {}
                ColumnSource::Job(of) => columns.push(column.name, column.cells, records.iter().map(of)),
                ColumnSource::Position(of) => push(&mut columns, column, rows(records, |record| &record.positions), of),
                ColumnSource::Connector(of) => {
                    push(&mut columns, column, rows(records, |record| &record.connectors), of)
                }
                ColumnSource::Mode(of) => push(&mut columns, column, rows(records, |record| &record.modes), of),
                ColumnSource::Pin(of) => push(&mut columns, column, rows(records, |record| &record.pins), of),
                ColumnSource::Section(of) => push(&mut columns, column, rows(records, |record| &record.sections), of),
                ColumnSource::Place(of) => push(&mut columns, column, rows(records, |record| &record.places), of),
                ColumnSource::AtPeak(of) => push(&mut columns, column, rows(records, |record| &record.at_peaks), of),
                ColumnSource::Bank(of) => push(&mut columns, column, rows(records, |record| &record.banks), of),
                ColumnSource::Dead(of) => push(&mut columns, column, rows(records, |record| &record.dead), of),
                ColumnSource::Freeboard(of) => {
                    push(&mut columns, column, rows(records, |record| &record.freeboards), of)
                }
                ColumnSource::Wheel(of) => push(&mut columns, column, rows(records, |record| &record.wheels), of),
                ColumnSource::Limit(of) => push(&mut columns, column, rows(records, |record| &record.limits), of),
                ColumnSource::Body(of) => push(&mut columns, column, rows(records, |record| &record.bodies), of),
                ColumnSource::Joint(of) => {
                    let rows = jobs.iter().flat_map(worn_joints);
                    columns.push(column.name, column.cells, rows.map(|row| of(&row)));
                }
                ColumnSource::Sample(of) => {
                    let samples = records.iter().flat_map(samples);
                    columns.push(column.name, column.cells, samples.map(|sample| of(&sample)));
                }
            }
            if table == TableName::Jobs && column.name == BEFORE_AXES {
                for AxisColumn { name, cells, axis } in self.axes.iter().filter(|axis| wanted(&axis.name)) {
                    let of_jobs = jobs.iter().map(|job| cell_of(job, axis.as_ref()));
                    columns.push(name, *cells, of_jobs);
                }
            }
        }
        columns
    }

    /// Whether the study's tables have a column.
    fn has(&self, column: &Column) -> bool {
        match column.when {
            When::Always => true,
            When::Loaded => self.kind != Kind::Modes,
            When::Static => self.kind == Kind::Static,
            When::Crossing => self.kind.has_crossings(),
            When::Rating => self.kind == Kind::Rating,
            When::Limits => self.limits,
            When::Modes => self.kind == Kind::Modes,
            When::AutoTimeStep => self.auto,
            When::Verify => self.verify,
            When::Pins => self.record.pins && self.kind != Kind::Modes,
            When::Sections => self.record.sections && self.kind != Kind::Modes,
            When::Waves => self.waves && self.kind.has_crossings(),
            When::ModesInWaves => self.waves && self.kind == Kind::Modes,
            When::Freeboards => self.record.freeboards && self.kind != Kind::Modes,
            When::Springs => self.springs,
            When::VehicleHistories => !self.record.histories.vehicles.is_empty(),
            When::PlaceHistories => !self.record.histories.places_x_m.is_empty(),
            When::PinHistories => {
                let histories = &self.record.histories;
                !(histories.pins.is_empty() && histories.vehicles.is_empty())
            }
        }
    }
}

/// Fills a column from rows.
fn push<'a, R>(
    columns: &mut Columns<'a>,
    column: &'static Column,
    rows: impl Iterator<Item = RowOf<'a, R>>,
    of: fn(&RowOf<'a, R>) -> Cell<'a>,
) {
    columns.push(column.name, column.cells, rows.map(|row| of(&row)));
}

/// The rows of a table with their jobs.
fn rows<'a, R: 'a>(
    records: &'a [JobRecord],
    of: fn(&'a JobRecord) -> &'a Vec<R>,
) -> impl Iterator<Item = RowOf<'a, R>> {
    records.iter().flat_map(move |record| {
        let job = record.job;
        of(record).iter().map(move |row| RowOf { job, row })
    })
}

/// The joints of a job with the gaps that they have in it.
fn worn_joints(job: &Job) -> impl Iterator<Item = JointRow> {
    let number = job.number;
    job.joint_gaps_m().map(move |(joint, gaps_m)| JointRow {
        job: number,
        joint,
        gaps_m,
    })
}

/// The samples of a record's histories, one history after the other.
fn samples(record: &JobRecord) -> impl Iterator<Item = HistorySample<'_>> {
    let histories = &record.histories;
    histories.series.iter().flat_map(|series| {
        let times = if series.of_balance {
            &histories.balance_time_s
        } else {
            &histories.time_s
        };
        times.iter().zip(&series.values).map(|(&time_s, &value)| HistorySample {
            job: record.job,
            time_s,
            of: &series.of,
            value,
        })
    })
}
