//! The columns of all tables, one entry each: name, unit, label, what it is, where its cells come from, who shows it.
//!
//! Tables, the report, figures, the terminal and the book's tables read this list. Knows columns and records. Does not know how a
//! number came about, nor which rows there are.

use crate::FailureKind;
use crate::arrays::CellKind;
use crate::record::{
    AtPeakRow, ConnectorRow, JobRecord, ModeRow, NumberPlace, PinRow, PlaceRow, PositionRow, SectionRow,
};
use crate::table::TableName;
use CellKind::{Counts, Flags, Numbers, Texts, Words};
use pontoon_plan::design::NAMED_AXES;
use pontoon_plan::input::Cell;
use serde::Serialize;
use serde_json::{Value, json};
use std::borrow::Cow;

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
    /// Where histories of places are recorded.
    PlaceHistories,
    /// Where histories of pins are recorded.
    PinHistories,
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

const fn column(
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
    const fn unit(self, unit: &'static str) -> Self {
        Self { unit, ..self }
    }

    const fn when(self, when: When) -> Self {
        Self { when, ..self }
    }

    const fn role(self, role: ColumnRole) -> Self {
        Self { role, ..self }
    }

    const fn decimals(self, decimals: usize) -> Self {
        Self {
            digits: Digits::Decimals(decimals),
            ..self
        }
    }

    const fn drawn(self) -> Self {
        Self { drawn: true, ..self }
    }

    const fn in_summary(self) -> Self {
        Self {
            in_summary: true,
            ..self
        }
    }

    const fn card(self, card: Card) -> Self {
        Self {
            card: Some(card),
            ..self
        }
    }

    const fn curve(self, curve: Curve) -> Self {
        Self {
            curve: Some(curve),
            ..self
        }
    }

    /// A length `[m]`, read to a tenth of a millimetre.
    const fn metres(self) -> Self {
        self.unit("m").decimals(4)
    }

    /// A force `[N]`, read to a newton.
    const fn newtons(self) -> Self {
        self.unit("N").decimals(0)
    }
}

type NameAndLabel = (&'static str, &'static str);

/// A column of every table of jobs.
const fn of_record(name: &'static str, cells: CellKind, names: NameAndLabel, of: fn(&JobRecord) -> Cell<'_>) -> Column {
    column(TableName::Jobs, (name, cells), names, ColumnSource::Job(of))
}

/// A column of the table of jobs of crossings and static cases.
const fn of_job(name: &'static str, cells: CellKind, names: NameAndLabel, of: fn(&JobRecord) -> Cell<'_>) -> Column {
    of_record(name, cells, names, of).when(When::Loaded)
}

/// A number of a job whose largest value matters.
const fn measure(
    name: &'static str,
    label: &'static str,
    text: &'static str,
    of: fn(&JobRecord) -> Cell<'_>,
) -> Column {
    of_job(name, CellKind::Numbers, (label, text), of).role(ColumnRole::Measure)
}

const fn of_position(
    name: &'static str,
    cells: CellKind,
    names: NameAndLabel,
    of: fn(&RowOf<'_, PositionRow>) -> Cell<'static>,
) -> Column {
    column(TableName::Positions, (name, cells), names, ColumnSource::Position(of))
}

const fn of_connector(
    name: &'static str,
    cells: CellKind,
    names: NameAndLabel,
    of: fn(&RowOf<'_, ConnectorRow>) -> Cell<'static>,
) -> Column {
    column(TableName::Connectors, (name, cells), names, ColumnSource::Connector(of))
}

const fn of_sample(
    name: &'static str,
    cells: CellKind,
    names: NameAndLabel,
    of: for<'a> fn(&HistorySample<'a>) -> Cell<'a>,
) -> Column {
    column(TableName::Histories, (name, cells), names, ColumnSource::Sample(of))
}

const fn of_pin(
    name: &'static str,
    cells: CellKind,
    names: NameAndLabel,
    of: fn(&RowOf<'_, PinRow>) -> Cell<'static>,
) -> Column {
    column(TableName::Pins, (name, cells), names, ColumnSource::Pin(of))
}

const fn of_section(
    name: &'static str,
    cells: CellKind,
    names: NameAndLabel,
    of: for<'a> fn(&RowOf<'a, SectionRow>) -> Cell<'a>,
) -> Column {
    column(TableName::Sections, (name, cells), names, ColumnSource::Section(of))
}

const fn of_place(
    name: &'static str,
    cells: CellKind,
    names: NameAndLabel,
    of: fn(&RowOf<'_, PlaceRow>) -> Cell<'static>,
) -> Column {
    column(TableName::Places, (name, cells), names, ColumnSource::Place(of))
}

const fn at_peak(
    name: &'static str,
    cells: CellKind,
    names: NameAndLabel,
    of: for<'a> fn(&RowOf<'a, AtPeakRow>) -> Cell<'a>,
) -> Column {
    column(TableName::AtPeaks, (name, cells), names, ColumnSource::AtPeak(of))
}

const fn of_joint(
    name: &'static str,
    cells: CellKind,
    names: NameAndLabel,
    of: fn(&JointRow) -> Cell<'static>,
) -> Column {
    column(TableName::Joints, (name, cells), names, ColumnSource::Joint(of))
}

const fn of_mode(
    name: &'static str,
    cells: CellKind,
    names: NameAndLabel,
    of: for<'a> fn(&RowOf<'a, ModeRow>) -> Cell<'a>,
) -> Column {
    column(TableName::Modes, (name, cells), names, ColumnSource::Mode(of))
}

const fn peak_card(label: &'static str, place: (&'static str, &'static str), time: Option<&'static str>) -> Card {
    Card {
        label,
        place: Some(place),
        time,
    }
}

const fn plain_card(label: &'static str) -> Card {
    Card {
        label,
        place: None,
        time: None,
    }
}

const fn centimetres(label: &'static str) -> Curve {
    Curve {
        figure: SpeedFigure::Deflection,
        label,
        unit: "cm",
        factor: 100.0,
    }
}

const fn kilonewtons(label: &'static str) -> Curve {
    Curve {
        figure: SpeedFigure::Force,
        label,
        unit: "kN",
        factor: 1e-3,
    }
}

fn status(record: &JobRecord) -> Cell<'_> {
    if record.failure.is_none() { "ok" } else { "failed" }.into()
}

fn reason(record: &JobRecord) -> Cell<'_> {
    match (&record.failure, &record.retried) {
        (Some(failure), _) => failure.text.as_str().into(),
        (None, Some(retried)) => {
            let text = format!("at half the time step; at its own: {}", retried.text);
            Cell::Word(Cow::Owned(text))
        }
        (None, None) if record.summary.steps.is_some() && record.summary.min_contact_force_n.is_none() => {
            "min_contact_force_n is null: no axle has been on its modules for 50 ms".into()
        }
        (None, None) => Cell::Nothing,
    }
}

/// The words of `quantity`: what a history is of, with its unit and its sense.
pub const QUANTITIES: [&str; 12] = [
    "deflection_m",
    "force_n",
    "pin_x_n",
    "pin_y_n",
    "pin_z_n",
    "angle_rad",
    "axial_n",
    "shear_y_n",
    "shear_z_n",
    "torsion_nm",
    "bending_nm",
    "lateral_bending_nm",
];

/// The words of [`QUANTITIES`] that are a joint's angle and section forces.
pub const SECTION_QUANTITIES: [&str; 7] = [
    "angle_rad",
    "axial_n",
    "shear_y_n",
    "shear_z_n",
    "torsion_nm",
    "bending_nm",
    "lateral_bending_nm",
];

/// The peaks that [`AtPeakRow`] may name.
const PEAKS: [&str; 5] = [
    "peak_deflection_m",
    "peak_uplift_m",
    "peak_compression_n",
    "peak_tension_n",
    "peak_pin_n",
];

/// The columns of all tables in their order; those of the axes stand behind the state of the jobs.
#[rustfmt::skip]
pub const COLUMNS: &[Column] = &[
    of_record("job", Counts, ("job", "number of the job, from 0"), |r| r.job.into()).role(ColumnRole::Key),
    of_record("status", Words(&["ok", "failed"]), ("status", "what became of the job"), status).role(ColumnRole::State),
    of_record("reason", Texts, ("reason", "why the job failed, or a remark"), reason).role(ColumnRole::State),
    of_record("failure", Words(&FailureKind::WORDS), ("failure", "the kind of the failure"), |r| r.failure.as_ref().map(|failure| failure.kind.word()).into()).role(ColumnRole::State),
    measure("peak_deflection_m", "peak deflection", "largest deflection of any position", |r| r.summary.peak_deflection_m.into()).metres().drawn().in_summary()
        .card(peak_card("largest deflection", ("position", "peak_deflection_position"), Some("peak_deflection_time_s")))
        .curve(centimetres("Peak deflection")),
    of_job("peak_deflection_position", Counts, ("peak deflection position", "its position"), |r| r.summary.peak_deflection_position.into()).role(ColumnRole::Listed),
    of_job("peak_deflection_time_s", Numbers, ("peak deflection time", "its time"), |r| r.summary.peak_deflection_time_s.into()).unit("s").role(ColumnRole::Listed),
    measure("peak_uplift_m", "peak uplift", "largest uplift of any position", |r| r.summary.peak_uplift_m.into()).metres().drawn().in_summary()
        .card(peak_card("largest uplift", ("position", "peak_uplift_position"), Some("peak_uplift_time_s")))
        .curve(centimetres("Peak uplift")),
    of_job("peak_uplift_position", Counts, ("peak uplift position", "its position"), |r| r.summary.peak_uplift_position.into()).role(ColumnRole::Listed),
    of_job("peak_uplift_time_s", Numbers, ("peak uplift time", "its time"), |r| r.summary.peak_uplift_time_s.into()).unit("s"),
    measure("peak_compression_n", "peak compression", "largest compression of any joint, its connectors added", |r| r.summary.peak_compression_n.into()).newtons().drawn().in_summary()
        .card(peak_card("largest compression", ("joint", "peak_compression_joint"), None))
        .curve(kilonewtons("Peak compression of a joint")),
    of_job("peak_compression_joint", Counts, ("peak compression joint", "its joint"), |r| r.summary.peak_compression_joint.into()).role(ColumnRole::Listed),
    measure("peak_tension_n", "peak tension", "largest tension of any joint, its connectors added", |r| r.summary.peak_tension_n.into()).newtons().drawn().in_summary()
        .card(peak_card("largest tension", ("joint", "peak_tension_joint"), None))
        .curve(kilonewtons("Peak tension of a joint")),
    of_job("peak_tension_joint", Counts, ("peak tension joint", "its joint"), |r| r.summary.peak_tension_joint.into()).role(ColumnRole::Listed),
    measure("peak_pin_n", "peak pin force", "largest resultant of any pin", |r| r.summary.peak_pin_n.into()).newtons().drawn().when(When::Pins)
        .card(peak_card("largest pin force", ("joint", "peak_pin_joint"), None))
        .curve(kilonewtons("Peak force of a pin")),
    of_job("peak_pin_joint", Counts, ("peak pin joint", "its joint"), |r| r.summary.peak_pin_joint.into()).role(ColumnRole::Listed).when(When::Pins),
    measure("peak_angle_rad", "peak joint angle", "largest angle of any joint, either sense", |r| r.summary.peak_angle_rad.into()).unit("rad").when(When::Sections),
    of_job("peak_angle_joint", Counts, ("peak angle joint", "its joint"), |r| r.summary.peak_angle_joint.into()).when(When::Sections),
    measure("peak_bending_nm", "peak bending moment", "largest bending moment of any joint, either sense", |r| r.summary.peak_bending_nm.into()).unit("N m").when(When::Sections),
    of_job("peak_bending_joint", Counts, ("peak bending joint", "its joint"), |r| r.summary.peak_bending_joint.into()).when(When::Sections),
    measure("peak_edge_deflection_m", "peak edge deflection", "largest deflection of the deck's edges", |r| r.summary.peak_edge_deflection_m.into()).metres().drawn(),
    measure("peak_roll_rad", "peak roll", "largest roll of a module end", |r| r.summary.peak_roll_rad.into()).unit("rad"),
    measure("static_peak_deflection_m", "static peak deflection", "largest static deflection of any position while the same weight moves slowly over the bridge, without inertia, over the job's connection and gaps", |r| r.summary.static_peak_deflection_m.into()).metres().drawn(),
    measure("dynamic_amplification", "dynamic amplification", "peak deflection over static peak deflection", |r| r.summary.dynamic_amplification.into()).drawn()
        .card(plain_card("largest dynamic amplification")),
    measure("influential_length_m", "influential length", "length over which a static load presses the bridge down; null in crossings", |r| r.summary.influential_length_m.into()).unit("m")
        .card(plain_card("longest influential length")),
    of_job("bottom_emerged", Flags, ("bottom emerged", "whether a corner of a module's bottom rose above the water; null unless the bridge has `draft_m`"), |r| r.summary.bottom_emerged.into()),
    of_job("deck_submerged", Flags, ("deck submerged", "whether a corner of a module's deck went below the water; null unless the bridge has `freeboard_m`"), |r| r.summary.deck_submerged.into()),
    of_job("min_contact_force_n", Numbers, ("smallest contact force", "smallest contact force of an axle, from 50 ms after its last point came onto a module; below zero it would have lifted off; with gaps impacts make it depend on the time step; null where no axle has been on its modules so long"), |r| r.summary.min_contact_force_n.into()).unit("N").role(ColumnRole::Listed),
    of_job("step_warning", Flags, ("step warning", "whether the vehicle goes more than half of its shortest patch in a time step, so that peaks may be far too large; vehicles with inertia and a stated time step"), |r| r.summary.step_warning.into()).role(ColumnRole::Listed),
    of_job("time_step_s", Numbers, ("time step", "time step found for the job"), |r| r.summary.time_step_s.into()).unit("s").when(When::AutoTimeStep).role(ColumnRole::Listed),
    of_job("steps", Counts, ("steps", "time steps"), |r| r.summary.steps.into()).role(ColumnRole::Listed),
    of_job("newton_iterations", Counts, ("newton iterations", "Newton solutions"), |r| r.summary.newton_iterations.into()),
    of_job("contact_switches", Counts, ("contact switches", "trusses that opened or closed"), |r| r.summary.contact_switches.into()).role(ColumnRole::Listed),
    of_job("energy_residual", Numbers, ("energy residual", "largest error of the energy balance, a share of the load's work"), |r| r.summary.energy_residual.into()).role(ColumnRole::Listed),
    of_job("numerical_dissipation", Numbers, ("numerical dissipation", "largest numerical dissipation, a share of the load's work"), |r| r.summary.numerical_dissipation.into()).role(ColumnRole::Listed),
    of_job("verify_deflection", Numbers, ("verify deflection", "how far the operator's largest deflection is off, a share of the reference solver's"), |r| r.summary.verify_deflection.into()).when(When::Verify).role(ColumnRole::Listed),
    of_job("verify_compression", Numbers, ("verify compression", "how far the operator's largest compression is off, a share of the job's largest joint force"), |r| r.summary.verify_compression.into()).when(When::Verify),
    of_job("verify_tension", Numbers, ("verify tension", "how far the operator's largest tension is off, a share of the job's largest joint force"), |r| r.summary.verify_tension.into()).when(When::Verify),
    of_job("verify_contact", Numbers, ("verify contact", "how far the smallest contact force of an axle is off, as a share of the vehicle's weight; judged with a linear connection only"), |r| r.summary.verify_contact.into()).when(When::Verify),
    of_job("verify_held", Flags, ("verify held", "whether all are within their tolerances"), |r| r.summary.verify_held.into()).when(When::Verify),
    measure("structural_mass_kg", "structural mass", "structural mass of a module", |r| r.summary.structural_mass_kg.into()).unit("kg").when(When::Modes),

    of_position("job", Counts, ("job", "number of the job"), |r| r.job.into()).role(ColumnRole::Key),
    of_position("position", Counts, ("position", "number of the module end, from 1 at x = 0"), |r| r.row.position.into()).role(ColumnRole::Key),
    of_position("x_m", Numbers, ("x", "its place along the bridge"), |r| r.row.x_m.into()).unit("m"),
    of_position("peak_deflection_m", Numbers, ("peak deflection", "largest deflection"), |r| r.row.deflection.value.into()).metres().drawn(),
    of_position("peak_deflection_time_s", Numbers, ("peak deflection time", "its time"), |r| r.row.deflection.time_s.into()).unit("s"),
    of_position("peak_uplift_m", Numbers, ("peak uplift", "largest uplift"), |r| r.row.uplift.value.into()).metres().drawn(),
    of_position("peak_uplift_time_s", Numbers, ("peak uplift time", "its time"), |r| r.row.uplift.time_s.into()).unit("s"),
    of_position("deflection_m", Numbers, ("deflection", "deflection of a static case, positive downward"), |r| r.row.static_deflection_m.into()).metres().when(When::Static).drawn(),
    of_position("static_peak_deflection_m", Numbers, ("static peak deflection", "largest static deflection while the same weight moves slowly over the bridge"), |r| r.row.static_peak_deflection_m.into()).metres().when(When::Crossing),

    of_connector("job", Counts, ("job", "number of the job"), |r| r.job.into()).role(ColumnRole::Key),
    of_connector("joint", Counts, ("joint", "number of the joint, from 2: joint k lies at position k"), |r| r.row.joint.into()).role(ColumnRole::Key),
    of_connector("y_m", Numbers, ("y", "place of the connector across; null in a joint's row, which adds its connectors"), |r| r.row.y_m.into()).unit("m").role(ColumnRole::Key),
    of_connector("peak_compression_n", Numbers, ("peak compression", "largest compression"), |r| r.row.compression.value.into()).newtons().drawn(),
    of_connector("peak_compression_time_s", Numbers, ("peak compression time", "its time"), |r| r.row.compression.time_s.into()).unit("s"),
    of_connector("peak_tension_n", Numbers, ("peak tension", "largest tension"), |r| r.row.tension.value.into()).newtons().drawn(),
    of_connector("peak_tension_time_s", Numbers, ("peak tension time", "its time"), |r| r.row.tension.time_s.into()).unit("s"),

    of_sample("job", Counts, ("job", "number of the job"), |r| r.job.into()).role(ColumnRole::Key),
    of_sample("time_s", Numbers, ("time", "time since the vehicle's front passed x = 0; below zero before; forces of pins and sections hold a part of a time step before the others"), |r| r.time_s.into()).unit("s").role(ColumnRole::Key),
    of_sample("quantity", Words(&QUANTITIES), ("quantity", "what the history is of: deflection positive downward, force tension positive"), |r| r.of.quantity.as_str().into()).role(ColumnRole::Key),
    of_sample("position", Counts, ("position", "position of a deflection, joint of a force; null of a place"), |r| r.of.position.into()).role(ColumnRole::Key),
    of_sample("x_m", Numbers, ("x", "place along the bridge, of the deflection of a place"), |r| r.of.x_m.into()).unit("m").role(ColumnRole::Key).when(When::PlaceHistories),
    of_sample("y_m", Numbers, ("y", "place across, of the force of a pin"), |r| r.of.y_m.into()).unit("m").role(ColumnRole::Key).when(When::PinHistories),
    of_sample("value", Numbers, ("value", "the quantity, in its unit"), |r| r.value.into()),

    of_mode("job", Counts, ("job", "number of the job"), |r| r.job.into()).role(ColumnRole::Key),
    of_mode("number", Counts, ("number", "number of the mode, from 1"), |r| r.row.number.into()).role(ColumnRole::Key),
    of_mode("frequency_hz", Numbers, ("frequency", "natural frequency"), |r| r.row.frequency_hz.into()).unit("Hz").decimals(5),
    of_mode("shape", Texts, ("shape", "name of the shape"), |r| r.row.shape.as_str().into()),
    of_mode("vertical_share", Numbers, ("vertical share", "vertical share of the kinetic energy"), |r| r.row.vertical_share.into()).decimals(4),
    of_mode("torsion_share", Numbers, ("torsion share", "share of torsion"), |r| r.row.torsion_share.into()).decimals(4),
    of_mode("horizontal_share", Numbers, ("horizontal share", "horizontal share"), |r| r.row.horizontal_share.into()).decimals(4),
    of_mode("axial_share", Numbers, ("axial share", "share along the bridge"), |r| r.row.axial_share.into()).decimals(4),

    of_joint("job", Counts, ("job", "number of the job"), |r| r.job.into()).role(ColumnRole::Key),
    of_joint("joint", Counts, ("joint", "number of the joint, from 2"), |r| r.joint.into()).role(ColumnRole::Key),
    of_joint("gap_tension_m", Numbers, ("tension gap", "tension gap of its first connector, wear included"), |r| r.gaps_m[0].into()).unit("m"),
    of_joint("gap_compression_m", Numbers, ("compression gap", "compression gap of its first connector, wear included"), |r| r.gaps_m[1].into()).unit("m"),

    of_pin("job", Counts, ("job", "number of the job"), |r| r.job.into()).role(ColumnRole::Key),
    of_pin("joint", Counts, ("joint", "number of the joint, from 2"), |r| r.row.joint.into()).role(ColumnRole::Key),
    of_pin("y_m", Numbers, ("y", "place of the pin across; null in a joint's row, which adds its pins"), |r| r.row.y_m.into()).unit("m").role(ColumnRole::Key),
    of_pin("peak_minus_x_n", Numbers, ("peak force, against x", "largest force of the pin on the module left of the joint, toward the left end of the bridge"), |r| r.row.components[0][0].value.into()).newtons(),
    of_pin("peak_minus_x_time_s", Numbers, ("peak force, against x, time", "its time"), |r| r.row.components[0][0].time_s.into()).unit("s"),
    of_pin("peak_plus_x_n", Numbers, ("peak force, along x", "largest force of the pin on the module left of the joint, toward its right end"), |r| r.row.components[0][1].value.into()).newtons(),
    of_pin("peak_plus_x_time_s", Numbers, ("peak force, along x, time", "its time"), |r| r.row.components[0][1].time_s.into()).unit("s"),
    of_pin("peak_minus_y_n", Numbers, ("peak force, against y", "largest force of the pin on the module left of the joint, across, against y"), |r| r.row.components[1][0].value.into()).newtons(),
    of_pin("peak_minus_y_time_s", Numbers, ("peak force, against y, time", "its time"), |r| r.row.components[1][0].time_s.into()).unit("s"),
    of_pin("peak_plus_y_n", Numbers, ("peak force, along y", "largest force of the pin on the module left of the joint, across, along y"), |r| r.row.components[1][1].value.into()).newtons(),
    of_pin("peak_plus_y_time_s", Numbers, ("peak force, along y, time", "its time"), |r| r.row.components[1][1].time_s.into()).unit("s"),
    of_pin("peak_minus_z_n", Numbers, ("peak force, against z", "largest force of the pin on the module left of the joint, downward"), |r| r.row.components[2][0].value.into()).newtons(),
    of_pin("peak_minus_z_time_s", Numbers, ("peak force, against z, time", "its time"), |r| r.row.components[2][0].time_s.into()).unit("s"),
    of_pin("peak_plus_z_n", Numbers, ("peak force, along z", "largest force of the pin on the module left of the joint, upward"), |r| r.row.components[2][1].value.into()).newtons(),
    of_pin("peak_plus_z_time_s", Numbers, ("peak force, along z, time", "its time"), |r| r.row.components[2][1].time_s.into()).unit("s"),
    of_pin("peak_resultant_n", Numbers, ("peak resultant", "largest resultant"), |r| r.row.resultant.value.into()).newtons(),
    of_pin("peak_resultant_time_s", Numbers, ("peak resultant time", "its time"), |r| r.row.resultant.time_s.into()).unit("s"),

    of_section("job", Counts, ("job", "number of the job"), |r| r.job.into()).role(ColumnRole::Key),
    of_section("joint", Counts, ("joint", "number of the joint, from 2"), |r| r.row.joint.into()).role(ColumnRole::Key),
    of_section("quantity", Words(&SECTION_QUANTITIES), ("quantity", "which number of the joint: its angle, positive where it opens at the deck; forces of the right part on the left one, moments about the centre of the hinge line"), |r| r.row.quantity.as_str().into()).role(ColumnRole::Key),
    of_section("peak_minus", Numbers, ("peak, against its sense", "largest value against its sense, in the unit of the quantity: joint closed at the deck, compression, hogging"), |r| r.row.sides[0].value.into()),
    of_section("peak_minus_time_s", Numbers, ("peak, against its sense, time", "its time"), |r| r.row.sides[0].time_s.into()).unit("s"),
    of_section("peak_plus", Numbers, ("peak, with its sense", "largest value with its sense, in the unit of the quantity: joint open at the deck, tension, sagging"), |r| r.row.sides[1].value.into()),
    of_section("peak_plus_time_s", Numbers, ("peak, with its sense, time", "its time"), |r| r.row.sides[1].time_s.into()).unit("s"),

    of_place("job", Counts, ("job", "number of the job"), |r| r.job.into()).role(ColumnRole::Key),
    of_place("x_m", Numbers, ("x", "the place along the bridge"), |r| r.row.x_m.into()).unit("m").role(ColumnRole::Key),
    of_place("peak_deflection_m", Numbers, ("peak deflection", "largest deflection"), |r| r.row.deflection.value.into()).metres(),
    of_place("peak_deflection_time_s", Numbers, ("peak deflection time", "its time"), |r| r.row.deflection.time_s.into()).unit("s"),
    of_place("peak_uplift_m", Numbers, ("peak uplift", "largest uplift"), |r| r.row.uplift.value.into()).metres(),
    of_place("peak_uplift_time_s", Numbers, ("peak uplift time", "its time"), |r| r.row.uplift.time_s.into()).unit("s"),
    of_place("deflection_m", Numbers, ("deflection", "deflection of a static case, positive downward"), |r| r.row.static_deflection_m.into()).metres().when(When::Static),

    at_peak("job", Counts, ("job", "number of the job"), |r| r.job.into()).role(ColumnRole::Key),
    at_peak("at_peak_of", Words(&PEAKS), ("at peak of", "the peak at whose instant the value holds"), |r| r.row.at_peak_of.as_str().into()).role(ColumnRole::Key),
    at_peak("peak_at", Counts, ("peak at", "position or joint of that peak where one was named; null where it is the largest of all"), |r| r.row.peak_at.into()).role(ColumnRole::Key),
    at_peak("time_s", Numbers, ("time", "when the value holds; of pins and sections a part of a time step before the others"), |r| r.row.time_s.into()).unit("s"),
    at_peak("quantity", Words(&QUANTITIES), ("quantity", "what the value is, with its unit"), |r| r.row.of.quantity.as_str().into()).role(ColumnRole::Key),
    at_peak("position", Counts, ("position", "position of a deflection, joint of all else; null of a place"), |r| r.row.of.position.into()).role(ColumnRole::Key),
    at_peak("x_m", Numbers, ("x", "place along the bridge, of the deflection of a place"), |r| r.row.of.x_m.into()).unit("m").role(ColumnRole::Key),
    at_peak("y_m", Numbers, ("y", "place across, of the force of a connector or pin"), |r| r.row.of.y_m.into()).unit("m").role(ColumnRole::Key),
    at_peak("value", Numbers, ("value", "the quantity, in its unit"), |r| r.row.value.into()),
];

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

    /// The peaks that a summary of crossings or static cases has.
    pub fn of_summary() -> impl Iterator<Item = &'static Self> {
        Self::of_table(TableName::Jobs).filter(|column| column.in_summary)
    }
}

/// The columns of all tables and the axes that have a name of their own, in their order.
pub fn registered() -> Value {
    json!({ "columns": COLUMNS, "axes": NAMED_AXES })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_column_stands_once_and_ends_in_its_unit() {
        for (i, column) in COLUMNS.iter().enumerate() {
            let twice = COLUMNS[..i]
                .iter()
                .any(|other| (other.table, other.name) == (column.table, column.name));
            assert!(!twice, "{column:?}");
            let suffix = column.unit.to_lowercase().replace('/', "_");
            assert!(
                suffix.is_empty() || column.name.ends_with(&format!("_{suffix}")),
                "{column:?}"
            );
        }
    }

    #[test]
    fn each_number_of_a_job_has_its_column() {
        let summary = serde_json::to_value(crate::Summary::default()).unwrap();
        for name in summary.as_object().unwrap().keys() {
            assert!(Column::of(TableName::Jobs, name).is_some(), "{name}");
        }
    }

    #[test]
    fn what_a_card_names_is_a_column_of_jobs() {
        let cards = COLUMNS.iter().filter_map(|column| column.card);
        for name in cards
            .flat_map(|card| [card.place.map(|(_, column)| column), card.time])
            .flatten()
        {
            assert!(Column::of(TableName::Jobs, name).is_some(), "{name}");
        }
    }
}
