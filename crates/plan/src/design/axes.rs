//! Axes: what they are called, in which unit they are, and where they go.
//!
//! Knows the axes that have a name of their own, one entry each, and when two axes contradict each other. Does not know values
//! or points.

use crate::input::{DocumentPath, FoundValue, Refusal, RefusalKind};
use serde::Serialize;
use std::path::Path;

/// An axis that has a name of its own; every other is named by the path of what it sets.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct NamedAxis {
    /// Its name, which is also its column.
    pub name: &'static str,
    /// Its unit; empty of words and counts.
    pub unit: &'static str,
    /// What it is called in words.
    pub label: &'static str,
    /// What its values are.
    #[serde(flatten)]
    pub values: AxisValues,
    /// Where they go.
    #[serde(flatten)]
    pub goes: Goes,
}

/// What the values of an axis with a name of its own are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(tag = "values", content = "words", rename_all = "snake_case")]
pub enum AxisValues {
    /// Numbers.
    Numbers,
    /// Whole numbers from 1.
    Counts,
    /// These words.
    Words(&'static [&'static str]),
    /// Names and paths.
    Names,
}

/// Where the values of an axis with a name of its own go.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Goes {
    /// To the job itself.
    Job {
        /// Which of its numbers they are.
        axis: JobAxis,
        /// The path of the value that they take the place of, where they do: the axis of that path is the same one.
        stands_for: Option<&'static str>,
        /// Whether crossings have it, and so its column.
        crossings: bool,
        /// Whether static cases have it.
        statics: bool,
    },
    /// To the value at a path of a document: the axis is another name of that path.
    Document(&'static str),
}

/// A number or word of a job that an axis sets.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum JobAxis {
    /// How the connectors work.
    Connection,
    /// Tension gap.
    TensionGap,
    /// Compression gap.
    CompressionGap,
    /// Speed of a crossing.
    Speed,
    /// Position that the load stands on.
    LoadPosition,
    /// Place of the load.
    LoadPlace,
    /// Weight of the vehicle.
    Load,
    /// Seed of the wear of its joints.
    WearSeed,
    /// Its vehicle, by name or file.
    Vehicle,
    /// Type of the crossing.
    CrossingType,
}

const fn job(axis: JobAxis, crossings: bool, statics: bool) -> Goes {
    Goes::Job {
        axis,
        stands_for: None,
        crossings,
        statics,
    }
}

const fn gap(axis: JobAxis, path: &'static str) -> Goes {
    Goes::Job {
        axis,
        stands_for: Some(path),
        crossings: true,
        statics: true,
    }
}

const fn numbers(name: &'static str, unit: &'static str, label: &'static str, goes: Goes) -> NamedAxis {
    NamedAxis {
        name,
        unit,
        label,
        values: AxisValues::Numbers,
        goes,
    }
}

/// Types of crossings, by name.
pub const CROSSING_TYPES: [&str; 3] = ["normal", "caution", "risk"];

/// Speeds of a normal crossing in a table of classes that states none `[m/s]`.
pub const NORMAL_SPEEDS_M_S: [f64; 3] = [2.0, 4.0, 6.0];

/// The axes that have a name of their own, in the order of their columns.
pub const NAMED_AXES: &[NamedAxis] = &[
    NamedAxis {
        name: "connection",
        unit: "",
        label: "connection",
        values: AxisValues::Words(&["linear", "nonlinear"]),
        goes: job(JobAxis::Connection, true, true),
    },
    numbers(
        "gap_tension_m",
        "m",
        "tension gap",
        gap(JobAxis::TensionGap, "bridge.connectors.gap_tension_m"),
    ),
    numbers(
        "gap_compression_m",
        "m",
        "compression gap",
        gap(JobAxis::CompressionGap, "bridge.connectors.gap_compression_m"),
    ),
    numbers("speed_m_s", "m/s", "speed", job(JobAxis::Speed, true, false)),
    NamedAxis {
        name: "load_position",
        unit: "",
        label: "load position",
        values: AxisValues::Counts,
        goes: job(JobAxis::LoadPosition, false, true),
    },
    numbers("load_x_m", "m", "load place", job(JobAxis::LoadPlace, false, true)),
    numbers("load_n", "N", "load", job(JobAxis::Load, true, true)),
    NamedAxis {
        name: "wear_seed",
        unit: "",
        label: "wear seed",
        values: AxisValues::Counts,
        goes: job(JobAxis::WearSeed, true, true),
    },
    NamedAxis {
        name: "vehicle",
        unit: "",
        label: "vehicle",
        values: AxisValues::Names,
        goes: job(JobAxis::Vehicle, true, true),
    },
    NamedAxis {
        name: "crossing_type",
        unit: "",
        label: "crossing type",
        values: AxisValues::Words(&CROSSING_TYPES),
        goes: job(JobAxis::CrossingType, true, false),
    },
];

impl NamedAxis {
    /// The axis of a name, or of the path that its values take the place of.
    pub fn of(name: &str) -> Option<&'static Self> {
        let mut axes = NAMED_AXES.iter();
        axes.find(|axis| axis.name == name || axis.path() == Some(name))
    }

    /// The axis that sets a number of the job.
    pub fn of_job(of: JobAxis) -> Option<&'static Self> {
        let sets = |axis: &&Self| matches!(axis.goes, Goes::Job { axis, .. } if axis == of);
        NAMED_AXES.iter().find(sets)
    }

    /// The path of the value that it sets or takes the place of, where there is one.
    fn path(&self) -> Option<&'static str> {
        match self.goes {
            Goes::Job { stands_for, .. } => stands_for,
            Goes::Document(path) => Some(path),
        }
    }
}

/// A document of a study.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Root {
    /// The bridge.
    Bridge,
    /// The vehicle.
    Vehicle,
    /// The analysis.
    Analysis,
    /// The wear of joints.
    Wear,
    /// Traffic, column and road: keys of the study itself.
    Traffic,
}

impl Root {
    /// All documents.
    pub const ALL: [Self; 5] = [Self::Bridge, Self::Vehicle, Self::Analysis, Self::Wear, Self::Traffic];

    /// The keys of the study that are of [`Self::Traffic`].
    const TRAFFIC: [&'static str; 3] = ["traffic", "column", "roughness"];

    /// What it is called.
    pub fn described(self) -> &'static str {
        match self {
            Self::Traffic => "traffic, column or roughness",
            other => other.word(),
        }
    }

    /// How a path begins that leads into it; nothing where the document is the study itself.
    pub fn word(self) -> &'static str {
        match self {
            Self::Bridge => "bridge",
            Self::Vehicle => "vehicle",
            Self::Analysis => "analysis",
            Self::Wear => "wear",
            Self::Traffic => "",
        }
    }
}

/// What an axis varies.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Varies {
    /// A number or word of the job itself.
    Job(JobAxis),
    /// A value of one of the study's documents.
    Path(Root, DocumentPath),
}

impl Varies {
    /// What the axis or column of a name varies; none where the name is no axis's.
    pub fn of(name: &str) -> Option<Self> {
        let path = match NamedAxis::of(name).map(|axis| axis.goes) {
            Some(Goes::Job { axis, .. }) if NAMED_AXES.iter().any(|named| named.name == name) => {
                return Some(Self::Job(axis));
            }
            Some(Goes::Document(path)) => path,
            _ => name,
        };
        let key = path.split(['.', '[']).next().unwrap_or_default();
        if Root::TRAFFIC.contains(&key) && path != key {
            return Some(Self::Path(Root::Traffic, DocumentPath::parse(path)?));
        }
        let (root, path) = path.split_once('.')?;
        let root = Root::ALL
            .into_iter()
            .find(|known| known.word() == root && !root.is_empty())?;
        Some(Self::Path(root, DocumentPath::parse(path)?))
    }
}

impl Varies {
    /// What a column of a name shows: of a path whose value the job has a number of its own for, that number.
    pub fn of_column(name: &str) -> Option<Self> {
        match NamedAxis::of(name).map(|axis| axis.goes) {
            Some(Goes::Job { axis, .. }) => Some(Self::Job(axis)),
            _ => Self::of(name),
        }
    }
}

/// One axis.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Axis {
    /// The name as written, which is also its column.
    pub name: String,
    /// What it varies.
    pub varies: Varies,
}

impl Axis {
    /// The axis of a name that stands at `key`; `known` are the names to suggest for a name that is not known.
    pub(crate) fn read(file: &Path, key: &str, name: &str, known: &[String]) -> Result<Self, Refusal> {
        if name == "analysis.kind" {
            let found = FoundValue::from("the kind of the study as an axis");
            return Err(Refusal::new(file, key, found, "one kind a study").because(RefusalKind::Misplaced));
        }
        match Varies::of(name) {
            Some(varies) => Ok(Self {
                name: name.to_owned(),
                varies,
            }),
            None => Err(Refusal {
                allowed: "a short name or the path of a value in bridge, vehicle, analysis, wear, traffic, column or roughness".to_owned(),
                ..Refusal::unknown_key(file, key, name, known)
            }),
        }
    }

    /// The name that its random numbers follow from: the same for all names of what it sets.
    pub(super) fn drawn_by(&self) -> &str {
        NamedAxis::of(&self.name).map_or(&self.name, |named| named.name)
    }

    /// Whether it sets what an axis of another name would set.
    pub(crate) fn sets_what(&self, name: &str) -> bool {
        place(&self.name) == place(name)
    }
}

/// Refuses axes of a block at `key` that contradict each other: none is part of what another one sets.
pub(super) fn check_apart(file: &Path, key: &str, axes: &[Axis]) -> Result<(), Refusal> {
    for (i, axis) in axes.iter().enumerate() {
        if let Some(other) = axes[..i]
            .iter()
            .find(|other| same_place(place(&other.name), place(&axis.name)))
        {
            let found = format!("an axis that sets what {} sets too", other.name);
            let refused = Refusal::new(file, format!("{key}.{}", axis.name), found, "one of the two");
            return Err(refused.because(RefusalKind::Misplaced));
        }
    }
    Ok(())
}

/// The path of what an axis sets: a name of its own stands for its path, where it has one.
fn place(name: &str) -> &str {
    NamedAxis::of(name).and_then(NamedAxis::path).unwrap_or(name)
}

/// Whether one path is the other or leads to it.
fn same_place(a: &str, b: &str) -> bool {
    let leads = |a: &str, b: &str| {
        b.strip_prefix(a)
            .is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
    };
    leads(a, b) || leads(b, a)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_entry_is_found_by_its_name_and_by_the_path_that_it_stands_for() {
        for axis in NAMED_AXES {
            assert_eq!(NamedAxis::of(axis.name), Some(axis));
            if let Some(path) = axis.path() {
                assert_eq!(NamedAxis::of(path), Some(axis));
            }
            if let Goes::Job { axis: of, .. } = axis.goes {
                assert_eq!(NamedAxis::of_job(of), Some(axis));
                assert_eq!(Varies::of(axis.name), Some(Varies::Job(of)));
            }
            let unit = axis
                .name
                .ends_with(&format!("_{}", axis.unit.to_lowercase().replace('/', "_")));
            assert!(axis.unit.is_empty() || unit, "{axis:?}");
        }
    }

    #[test]
    fn a_path_varies_a_value_of_its_document() {
        let path = |text| DocumentPath::parse(text).unwrap();
        assert_eq!(
            Varies::of("vehicle.axles[0].share"),
            Some(Varies::Path(Root::Vehicle, path("axles[0].share")))
        );
        for name in ["speed", "bridge", "bridge.", "water.depth_m", "bridge.a[x]"] {
            assert_eq!(Varies::of(name), None, "{name}");
        }
    }
}
