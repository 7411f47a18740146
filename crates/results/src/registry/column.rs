//! What is told of a column, and how an entry of the list is written.
//!
//! Knows records and tables. Does not know which columns there are.

use super::COLUMNS;
use crate::arrays::CellKind;
use crate::limit_rows::LimitRow;
use crate::record::{
    AtPeakRow, BankRow, ConnectorRow, JobRecord, ModeRow, NumberPlace, PinRow, PlaceRow, PositionRow, SectionRow,
};
use crate::rest_rows::{DeadRow, FreeboardRow};
use crate::table::TableName;
use crate::vehicle_rows::{BodyRow, WheelRow};
use pontoon_plan::input::Cell;
use pontoon_plan::study_file::Kind;
use serde::Serialize;

/// A column of a table.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Column {
    /// The table.
    pub table: TableName,
    /// Its name.
    pub name: &'static str,
    /// What its cells are.
    #[serde(flatten)]
    pub cells: CellKind,
    /// Its unit; empty of counts, shares and words.
    pub unit: &'static str,
    /// What it is called in words.
    pub label: &'static str,
    /// What it is.
    pub text: &'static str,
    /// When a table has it.
    pub when: When,
    /// Where its cells come from.
    #[serde(skip)]
    pub(crate) source: ColumnSource,
    /// How many digits people read.
    #[serde(skip)]
    pub digits: Digits,
    /// Which part it has in what people look at.
    #[serde(skip)]
    pub role: ColumnRole,
    /// Whether points of an experiment may be drawn in its chart.
    #[serde(skip)]
    pub drawn: bool,
    /// Whether the summary has it.
    #[serde(skip)]
    pub in_summary: bool,
    /// Its card on a page.
    #[serde(skip)]
    pub card: Option<Card>,
    /// Its panel in a figure against speed.
    #[serde(skip)]
    pub curve: Option<Curve>,
}

/// Where the cells of a column come from.
#[derive(Debug, Clone, Copy)]
pub(crate) enum ColumnSource {
    /// A job's record.
    Job(fn(&JobRecord) -> Cell<'_>),
    /// A row of positions.
    Position(fn(&RowOf<'_, PositionRow>) -> Cell<'static>),
    /// A row of connectors.
    Connector(fn(&RowOf<'_, ConnectorRow>) -> Cell<'static>),
    /// A sample of a history.
    Sample(for<'a> fn(&HistorySample<'a>) -> Cell<'a>),
    /// A mode.
    Mode(for<'a> fn(&RowOf<'a, ModeRow>) -> Cell<'a>),
    /// A pin.
    Pin(fn(&RowOf<'_, PinRow>) -> Cell<'static>),
    /// A section force.
    Section(for<'a> fn(&RowOf<'a, SectionRow>) -> Cell<'a>),
    /// A place.
    Place(fn(&RowOf<'_, PlaceRow>) -> Cell<'static>),
    /// A number at a peak.
    AtPeak(for<'a> fn(&RowOf<'a, AtPeakRow>) -> Cell<'a>),
    /// A bank.
    Bank(fn(&RowOf<'_, BankRow>) -> Cell<'static>),
    /// A number at rest.
    Dead(for<'a> fn(&RowOf<'a, DeadRow>) -> Cell<'a>),
    /// A corner of a deck.
    Freeboard(fn(&RowOf<'_, FreeboardRow>) -> Cell<'static>),
    /// A wheel on its spring.
    Wheel(fn(&RowOf<'_, WheelRow>) -> Cell<'static>),
    /// A motion of a body.
    Body(for<'a> fn(&RowOf<'a, BodyRow>) -> Cell<'a>),
    /// A limit.
    Limit(for<'a> fn(&RowOf<'a, LimitRow>) -> Cell<'a>),
    /// A worn joint.
    Joint(fn(&JointRow) -> Cell<'static>),
}

/// A worn joint of a job.
#[derive(Debug, Clone, Copy)]
pub(crate) struct JointRow {
    /// The job's number.
    pub(crate) job: usize,
    /// The joint's number.
    pub(crate) joint: usize,
    /// Its gaps, tension and compression `[m]`.
    pub(crate) gaps_m: [f64; 2],
}

/// A row of a table with its job.
#[derive(Debug)]
pub(crate) struct RowOf<'a, R> {
    /// The job's number.
    pub(crate) job: usize,
    /// The row.
    pub(crate) row: &'a R,
}

/// A sample of a history.
#[derive(Debug, Clone, Copy)]
pub(crate) struct HistorySample<'a> {
    /// The job's number.
    pub(crate) job: usize,
    /// Its time `[s]`.
    pub(crate) time_s: f64,
    /// What the history is of.
    pub(crate) of: &'a NumberPlace,
    /// The value, in the unit of the quantity.
    pub(crate) value: f64,
}

/// When a table has a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum When {
    /// In every study that leaves the table.
    Always,
    /// In studies of crossings and static cases.
    Loaded,
    /// In studies of static cases.
    Static,
    /// In studies of crossings.
    Crossing,
    /// In studies of modes.
    Modes,
    /// Where a job's time step was to be found.
    AutoTimeStep,
    /// Where jobs are solved again.
    Verify,
    /// Where pins are recorded.
    Pins,
    /// Where section forces are recorded.
    Sections,
    /// Where freeboards are recorded.
    Freeboards,
    /// Where histories of places are recorded.
    PlaceHistories,
    /// Where histories of pins or vehicles are recorded.
    PinHistories,
    /// Where any job has a vehicle on springs.
    Springs,
    /// Where crossings are in water with memory.
    Waves,
    /// Where modes are in water with memory.
    ModesInWaves,
    /// Where limits are stated.
    Limits,
    /// In studies of ratings.
    Rating,
    /// Where histories of vehicles are recorded.
    VehicleHistories,
}

/// How many digits of a number people read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Digits {
    /// So many behind the point.
    Decimals(usize),
    /// So many from the first that is not zero, none that says nothing.
    Significant(usize),
}

/// Which part a column has in what people look at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ColumnRole {
    /// It says which row it is.
    Key,
    /// It says what became of the job.
    State,
    /// A number of a job whose largest value matters.
    Measure,
    /// A number that a page lists with the job.
    Listed,
    /// A number that the table keeps.
    Kept,
}

/// A card of the largest value of a measure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Card {
    /// In words.
    pub label: &'static str,
    /// What the place is one of: `position`, `joint`.
    pub place: Option<(&'static str, &'static str)>,
    /// The column of its time.
    pub time: Option<&'static str>,
}

/// A panel of a figure against speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Curve {
    /// The figure.
    pub figure: SpeedFigure,
    /// What the axis up is called.
    pub label: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// What a number of the table is multiplied by to be in that unit.
    pub factor: f64,
}

/// A figure against speed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SpeedFigure {
    /// Deflection and uplift.
    Deflection,
    /// Forces of joints.
    Force,
}

impl SpeedFigure {
    /// All figures.
    pub const ALL: [Self; 2] = [Self::Deflection, Self::Force];
}

pub(super) const fn column(
    table: TableName,
    (name, cells): (&'static str, CellKind),
    (label, text): (&'static str, &'static str),
    source: ColumnSource,
) -> Column {
    Column {
        table,
        name,
        cells,
        unit: "",
        label,
        text,
        when: When::Always,
        source,
        digits: Digits::Significant(6),
        role: ColumnRole::Kept,
        drawn: false,
        in_summary: false,
        card: None,
        curve: None,
    }
}

impl Column {
    pub(super) const fn unit(self, unit: &'static str) -> Self {
        Self { unit, ..self }
    }

    pub(super) const fn when(self, when: When) -> Self {
        Self { when, ..self }
    }

    pub(super) const fn role(self, role: ColumnRole) -> Self {
        Self { role, ..self }
    }

    pub(super) const fn decimals(self, decimals: usize) -> Self {
        Self {
            digits: Digits::Decimals(decimals),
            ..self
        }
    }

    pub(super) const fn drawn(self) -> Self {
        Self { drawn: true, ..self }
    }

    pub(super) const fn in_summary(self) -> Self {
        Self {
            in_summary: true,
            ..self
        }
    }

    pub(super) const fn card(self, card: Card) -> Self {
        Self {
            card: Some(card),
            ..self
        }
    }

    pub(super) const fn curve(self, curve: Curve) -> Self {
        Self {
            curve: Some(curve),
            ..self
        }
    }

    /// A length `[m]`, read to a tenth of a millimetre.
    pub(super) const fn metres(self) -> Self {
        self.unit("m").decimals(4)
    }

    /// A force `[N]`, read to a newton.
    pub(super) const fn newtons(self) -> Self {
        self.unit("N").decimals(0)
    }
}

type NameAndLabel = (&'static str, &'static str);

/// A column of every table of jobs.
pub(super) const fn of_record(
    name: &'static str,
    cells: CellKind,
    names: NameAndLabel,
    of: fn(&JobRecord) -> Cell<'_>,
) -> Column {
    column(TableName::Jobs, (name, cells), names, ColumnSource::Job(of))
}

/// A column of the table of jobs of crossings and static cases.
pub(super) const fn of_job(
    name: &'static str,
    cells: CellKind,
    names: NameAndLabel,
    of: fn(&JobRecord) -> Cell<'_>,
) -> Column {
    of_record(name, cells, names, of).when(When::Loaded)
}

/// A number of a job whose largest value matters.
pub(super) const fn measure(
    name: &'static str,
    label: &'static str,
    text: &'static str,
    of: fn(&JobRecord) -> Cell<'_>,
) -> Column {
    of_job(name, CellKind::Numbers, (label, text), of).role(ColumnRole::Measure)
}

/// How an entry of each other table is written: name, cells, label and text, where its cells come from.
macro_rules! entries {
    ($($name:ident: $table:ident, $source:ident($of:ty);)*) => { $(
        pub(super) const fn $name(name: &'static str, cells: CellKind, names: NameAndLabel, of: $of) -> Column {
            column(TableName::$table, (name, cells), names, ColumnSource::$source(of))
        }
    )* };
}

entries! {
    of_position: Positions, Position(fn(&RowOf<'_, PositionRow>) -> Cell<'static>);
    of_connector: Connectors, Connector(fn(&RowOf<'_, ConnectorRow>) -> Cell<'static>);
    of_sample: Histories, Sample(for<'a> fn(&HistorySample<'a>) -> Cell<'a>);
    of_mode: Modes, Mode(for<'a> fn(&RowOf<'a, ModeRow>) -> Cell<'a>);
    of_joint: Joints, Joint(fn(&JointRow) -> Cell<'static>);
    of_pin: Pins, Pin(fn(&RowOf<'_, PinRow>) -> Cell<'static>);
    of_section: Sections, Section(for<'a> fn(&RowOf<'a, SectionRow>) -> Cell<'a>);
    of_place: Places, Place(fn(&RowOf<'_, PlaceRow>) -> Cell<'static>);
    at_peak: AtPeaks, AtPeak(for<'a> fn(&RowOf<'a, AtPeakRow>) -> Cell<'a>);
    of_bank: Banks, Bank(fn(&RowOf<'_, BankRow>) -> Cell<'static>);
    at_rest: Dead, Dead(for<'a> fn(&RowOf<'a, DeadRow>) -> Cell<'a>);
    of_freeboard: Freeboards, Freeboard(fn(&RowOf<'_, FreeboardRow>) -> Cell<'static>);
    of_wheel: Wheels, Wheel(fn(&RowOf<'_, WheelRow>) -> Cell<'static>);
    of_limit: Limits, Limit(for<'a> fn(&RowOf<'a, LimitRow>) -> Cell<'a>);
    of_body: Bodies, Body(for<'a> fn(&RowOf<'a, BodyRow>) -> Cell<'a>);
}

pub(super) const fn peak_card(
    label: &'static str,
    place: (&'static str, &'static str),
    time: Option<&'static str>,
) -> Card {
    Card {
        label,
        place: Some(place),
        time,
    }
}

pub(super) const fn plain_card(label: &'static str) -> Card {
    Card {
        label,
        place: None,
        time: None,
    }
}

pub(super) const fn centimetres(label: &'static str) -> Curve {
    Curve {
        figure: SpeedFigure::Deflection,
        label,
        unit: "cm",
        factor: 100.0,
    }
}

pub(super) const fn kilonewtons(label: &'static str) -> Curve {
    Curve {
        figure: SpeedFigure::Force,
        label,
        unit: "kN",
        factor: 1e-3,
    }
}

impl Column {
    /// The columns of a table, in their order.
    pub fn of_table(table: TableName) -> impl Iterator<Item = &'static Self> {
        COLUMNS.iter().filter(move |column| column.table == table)
    }

    /// The column of a table by its name.
    pub fn of(table: TableName, name: &str) -> Option<&'static Self> {
        Self::of_table(table).find(|column| column.name == name)
    }

    /// The first column of a name, whatever its table.
    pub fn named(name: &str) -> Option<&'static Self> {
        COLUMNS.iter().find(|column| column.name == name)
    }

    /// The cell of a mode that stands alone; nothing in a column of another table.
    pub fn of_mode<'a>(&self, mode: &'a ModeRow) -> Cell<'a> {
        match self.source {
            ColumnSource::Mode(of) => of(&RowOf { job: 0, row: mode }),
            _ => Cell::Nothing,
        }
    }

    /// The numbers of a job whose largest values matter.
    pub fn measures() -> impl Iterator<Item = &'static Self> {
        Self::of_table(TableName::Jobs).filter(|column| column.role == ColumnRole::Measure)
    }

    /// The numbers that a summary of crossings, ratings or static cases has: what limits ask of first.
    pub fn of_summary(kind: Kind, has_limits: bool) -> impl Iterator<Item = &'static Self> {
        let shown = move |column: &&Self| match column.when {
            When::Limits => has_limits,
            When::Rating => kind == Kind::Rating,
            _ => true,
        };
        Self::of_table(TableName::Jobs)
            .filter(|column| column.in_summary)
            .filter(shown)
    }
}
