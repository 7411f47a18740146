//! Axes: what they are called and what they vary.
//!
//! Knows the names that an axis may have and when two axes contradict each other. Does not know values or points.

use crate::input::{DocumentPath, Refusal};
use std::path::Path;

/// Axes that have a name of their own; every other is named by its path.
pub const SHORT_NAMES: [&str; 7] = [
    "connection",
    "gap_tension_m",
    "gap_compression_m",
    "speed_m_s",
    "load_n",
    "load_position",
    "load_x_m",
];

/// What an axis varies.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum AxisName {
    /// One of [`SHORT_NAMES`].
    Short(&'static str),
    /// A value of one of the study's documents.
    Path {
        /// `bridge`, `vehicle` or `analysis`.
        root: &'static str,
        /// The path inside that document.
        path: DocumentPath,
    },
}

/// One axis.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Axis {
    /// The name as written, which is also its column.
    pub name: String,
    /// What it varies.
    pub varies: AxisName,
}

impl Axis {
    /// The axis of a name that stands at `key`; `known` are the names to suggest for a name that is not known.
    pub(super) fn read(file: &Path, key: &str, name: &str, known: &[String]) -> Result<Self, Refusal> {
        Ok(Self {
            name: name.to_owned(),
            varies: axis_name(file, key, name, known)?,
        })
    }

    /// Whether it sets what an axis of another name would set.
    pub(super) fn sets_what(&self, name: &str) -> bool {
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
            return Err(Refusal::new(
                file,
                format!("{key}.{}", axis.name),
                found,
                "one of the two",
            ));
        }
    }
    Ok(())
}

/// The path of what an axis sets: a short name of a number of the bridge stands for its path.
fn place(name: &str) -> &str {
    match name {
        "gap_tension_m" => "bridge.connectors.gap_tension_m",
        "gap_compression_m" => "bridge.connectors.gap_compression_m",
        other => other,
    }
}

/// Whether one path is the other or leads to it.
fn same_place(a: &str, b: &str) -> bool {
    let leads = |a: &str, b: &str| {
        b.strip_prefix(a)
            .is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
    };
    leads(a, b) || leads(b, a)
}

fn axis_name(file: &Path, key: &str, name: &str, known: &[String]) -> Result<AxisName, Refusal> {
    if let Some(short) = SHORT_NAMES.iter().find(|short| **short == name) {
        return Ok(AxisName::Short(short));
    }
    let unknown = || Refusal {
        allowed: "a short name or the path of a value in bridge, vehicle or analysis".to_owned(),
        ..Refusal::unknown(file, key, name, known)
    };
    let (root, path) = name.split_once('.').ok_or_else(unknown)?;
    let root = ["bridge", "vehicle", "analysis"]
        .into_iter()
        .find(|r| *r == root)
        .ok_or_else(unknown)?;
    if name == "analysis.kind" {
        return Err(Refusal::new(
            file,
            key,
            "the kind of the study as an axis",
            "one kind a study",
        ));
    }
    Ok(AxisName::Path {
        root,
        path: DocumentPath::parse(path).ok_or_else(unknown)?,
    })
}
