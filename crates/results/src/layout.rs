//! Which columns each table has.
//!
//! Knows the names of columns. Does not know files.

use super::columns::{AxisType, Columns};
use super::frame::Frame;
use super::table::TableName;
use crate::{ConnectorRow, JobRecord, PositionRow};
use pontoon_plan::job::Job;
use pontoon_plan::study_file::{AnalysisSpec, Kind, Study, TimeStepSpec};
use serde_json::Value;
use std::io;

/// The first column of the table of jobs behind the axes, for each kind of study.
pub(super) const FIRST_OUTCOMES: [&str; 2] = ["peak_deflection_m", "structural_mass_kg"];

/// The columns of a study's axes: the short names of its kind, then every path.
pub fn axis_names(study: &Study) -> Vec<String> {
    let short: &[&str] = match study.spec.analysis.kind {
        Kind::Modes => &[],
        Kind::Crossing => &[
            "connection",
            "gap_tension_m",
            "gap_compression_m",
            "speed_m_s",
            "load_n",
        ],
        Kind::Static => &[
            "connection",
            "gap_tension_m",
            "gap_compression_m",
            "load_position",
            "load_x_m",
            "load_n",
        ],
    };
    short
        .iter()
        .map(|name| (*name).to_owned())
        .chain(study.path_axes())
        .collect()
}

/// Which tables a study leaves and which columns each has, whatever part of its rows is at hand.
#[derive(Debug)]
pub(super) struct Layout {
    kind: Kind,
    axes: Vec<(String, AxisType)>,
    tables: Vec<TableName>,
    /// Whether any job's time step was to be found.
    auto: bool,
    /// Whether any job may be solved again.
    verify: bool,
}

impl Layout {
    /// The layout of a study with all its jobs, whose axes make the types of columns.
    pub(super) fn new(study: &Study, jobs: &[Job]) -> Self {
        let (record, kind) = (&study.spec.record, study.spec.analysis.kind);
        let axis = |name: String| {
            let of = match name.as_str() {
                "load_position" => AxisType::Counts,
                name => AxisType::of(jobs.iter().map(|job| job.typed_column(name))),
            };
            (name, of)
        };
        let loaded = kind != Kind::Modes;
        let left = |name: &TableName| match name {
            TableName::Jobs => true,
            TableName::Positions => record.positions && loaded,
            TableName::Connectors => record.connectors && loaded,
            TableName::Histories => record.histories.asked() && loaded,
            TableName::Modes => !loaded,
        };
        Self {
            kind,
            axes: axis_names(study).into_iter().map(axis).collect(),
            tables: TableName::ALL.into_iter().filter(left).collect(),
            auto: any(jobs, |analysis| {
                matches!(analysis.time_step_s, Some(TimeStepSpec::Auto(_)))
            }),
            verify: any(jobs, |analysis| analysis.verify.is_some()),
        }
    }

    /// The tables that the study leaves, in the order of their names.
    pub(super) fn tables(&self) -> impl Iterator<Item = TableName> {
        self.tables.iter().copied()
    }

    /// The rows of some jobs in a table, in the order of jobs; no job makes the table without rows.
    pub(super) fn frame(&self, name: TableName, of: &[Job], records: &[JobRecord]) -> io::Result<Frame> {
        match name {
            TableName::Jobs => jobs(self, of, records),
            TableName::Positions => positions(self.kind, records),
            TableName::Connectors => connectors(records),
            TableName::Histories => histories(records),
            TableName::Modes => modes(records),
        }
    }
}

/// Whether any job's analysis is such.
fn any(jobs: &[Job], is: impl Fn(&AnalysisSpec) -> bool) -> bool {
    jobs.iter().any(|job| is(&job.analysis.spec))
}

/// One row a job.
fn jobs(layout: &Layout, jobs: &[Job], records: &[JobRecord]) -> io::Result<Frame> {
    let s = || records.iter().map(|r| &r.summary);
    let mut c = Columns::default();
    c.count("job", records.iter().map(|r| Some(r.job)));
    c.word(
        "status",
        records
            .iter()
            .map(|r| Some(if r.reason.is_none() { "ok" } else { "failed" })),
    );
    let reason = |r: &'_ JobRecord| r.reason.clone().or_else(|| r.summary.retried.clone());
    let reasons: Vec<Option<String>> = records.iter().map(reason).collect();
    c.word("reason", reasons.iter().map(Option::as_deref));
    for (name, of) in &layout.axes {
        let values: Vec<Value> = jobs.iter().map(|job| job.typed_column(name)).collect();
        c.axis(name, *of, &values);
    }
    if layout.kind == Kind::Modes {
        return c
            .number("structural_mass_kg", s().map(|s| s.structural_mass_kg))
            .frame();
    }
    c.number("peak_deflection_m", s().map(|s| s.peak_deflection_m))
        .count("peak_deflection_position", s().map(|s| s.peak_deflection_position))
        .number("peak_deflection_time_s", s().map(|s| s.peak_deflection_time_s))
        .number("peak_uplift_m", s().map(|s| s.peak_uplift_m))
        .count("peak_uplift_position", s().map(|s| s.peak_uplift_position))
        .number("peak_uplift_time_s", s().map(|s| s.peak_uplift_time_s))
        .number("peak_compression_n", s().map(|s| s.peak_compression_n))
        .count("peak_compression_joint", s().map(|s| s.peak_compression_joint))
        .number("peak_tension_n", s().map(|s| s.peak_tension_n))
        .count("peak_tension_joint", s().map(|s| s.peak_tension_joint))
        .number("peak_edge_deflection_m", s().map(|s| s.peak_edge_deflection_m))
        .number("peak_roll_rad", s().map(|s| s.peak_roll_rad))
        .number("static_peak_deflection_m", s().map(|s| s.static_peak_deflection_m))
        .number("dynamic_amplification", s().map(|s| s.dynamic_amplification))
        .number("influential_length_m", s().map(|s| s.influential_length_m))
        .flag("bottom_emerged", s().map(|s| s.bottom_emerged))
        .flag("deck_submerged", s().map(|s| s.deck_submerged))
        .number("min_contact_force_n", s().map(|s| s.min_contact_force_n));
    if layout.auto {
        c.number("time_step_s", s().map(|s| s.time_step_s));
    }
    c.count("steps", s().map(|s| s.steps))
        .count("newton_iterations", s().map(|s| s.newton_iterations))
        .count("contact_switches", s().map(|s| s.contact_switches))
        .number("energy_residual", s().map(|s| s.energy_residual))
        .number("numerical_dissipation", s().map(|s| s.numerical_dissipation));
    if layout.verify {
        c.number("verify_deflection", s().map(|s| s.verify_deflection))
            .number("verify_compression", s().map(|s| s.verify_compression))
            .number("verify_tension", s().map(|s| s.verify_tension))
            .flag("verify_held", s().map(|s| s.verify_held));
    }
    c.frame()
}

/// One row a position of each job.
fn positions(kind: Kind, records: &[JobRecord]) -> io::Result<Frame> {
    let rows: Vec<(usize, &PositionRow)> = records
        .iter()
        .flat_map(|r| r.positions.iter().map(move |row| (r.job, row)))
        .collect();
    let rows = || rows.iter().copied();
    let mut c = Columns::default();
    c.count("job", rows().map(|(job, _)| Some(job)))
        .count("position", rows().map(|(_, r)| Some(r.position)))
        .number("x_m", rows().map(|(_, r)| Some(r.x_m)))
        .number("peak_deflection_m", rows().map(|(_, r)| r.deflection.value))
        .number("peak_deflection_time_s", rows().map(|(_, r)| r.deflection.time_s))
        .number("peak_uplift_m", rows().map(|(_, r)| r.uplift.value))
        .number("peak_uplift_time_s", rows().map(|(_, r)| r.uplift.time_s));
    if kind == Kind::Static {
        c.number("deflection_m", rows().map(|(_, r)| r.static_deflection_m));
    } else {
        c.number(
            "static_peak_deflection_m",
            rows().map(|(_, r)| r.static_peak_deflection_m),
        );
    }
    c.frame()
}

/// One row a joint's sum and one a connector of each job.
fn connectors(records: &[JobRecord]) -> io::Result<Frame> {
    let rows: Vec<(usize, &ConnectorRow)> = records
        .iter()
        .flat_map(|r| r.connectors.iter().map(move |row| (r.job, row)))
        .collect();
    let rows = || rows.iter().copied();
    Columns::default()
        .count("job", rows().map(|(job, _)| Some(job)))
        .count("joint", rows().map(|(_, r)| Some(r.joint)))
        .number("y_m", rows().map(|(_, r)| r.y_m))
        .number("peak_compression_n", rows().map(|(_, r)| r.compression.value))
        .number("peak_compression_time_s", rows().map(|(_, r)| r.compression.time_s))
        .number("peak_tension_n", rows().map(|(_, r)| r.tension.value))
        .number("peak_tension_time_s", rows().map(|(_, r)| r.tension.time_s))
        .frame()
}

/// One row a mode of each job.
fn modes(records: &[JobRecord]) -> io::Result<Frame> {
    let rows = || records.iter().flat_map(|r| r.modes.iter().map(move |row| (r.job, row)));
    Columns::default()
        .count("job", rows().map(|(job, _)| Some(job)))
        .count("number", rows().map(|(_, m)| Some(m.number)))
        .number("frequency_hz", rows().map(|(_, m)| Some(m.frequency_hz)))
        .word("shape", rows().map(|(_, m)| Some(m.shape.as_str())))
        .number("vertical_share", rows().map(|(_, m)| Some(m.vertical_share)))
        .number("torsion_share", rows().map(|(_, m)| Some(m.torsion_share)))
        .number("horizontal_share", rows().map(|(_, m)| Some(m.horizontal_share)))
        .number("axial_share", rows().map(|(_, m)| Some(m.axial_share)))
        .frame()
}

/// One row a time of each history of each job.
fn histories(records: &[JobRecord]) -> io::Result<Frame> {
    let series = || {
        records
            .iter()
            .flat_map(|r| r.histories.series.iter().map(move |s| (r, s)))
    };
    let of = |r: &JobRecord| r.histories.time_s.len();
    Columns::default()
        .count(
            "job",
            series().flat_map(|(r, _)| std::iter::repeat_n(Some(r.job), of(r))),
        )
        .number(
            "time_s",
            series().flat_map(|(r, _)| r.histories.time_s.iter().map(|t| Some(*t))),
        )
        .word(
            "quantity",
            series().flat_map(|(r, s)| std::iter::repeat_n(Some(s.0.as_str()), of(r))),
        )
        .count(
            "position",
            series().flat_map(|(r, s)| std::iter::repeat_n(Some(s.1), of(r))),
        )
        .number("value", series().flat_map(|(_, s)| s.2.iter().map(|v| Some(*v))))
        .frame()
}
