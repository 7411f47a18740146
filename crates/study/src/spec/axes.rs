//! Axes and the points they expand to.
//!
//! Knows the forms of an axis, the names it may have and the order of points. Does not know what a point means.

use super::design::Design;
use super::values::axis_values;
use crate::document::{DocumentPath, canonical};
use crate::refusal::Refusal;
use serde_json::Value;
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

/// Most points of a study, equal ones counted as often as they occur: each costs a check and, in a run, some 0.3 kB of
/// memory (a job of 88 bytes, what tells it apart, its line of the summary), 3 GB for as many as this.
const MOST_POINTS: usize = 10_000_000;

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

/// One axis with its values, of which there is at least one.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// The name as written, which is also its column.
    pub name: String,
    /// What it varies.
    pub varies: AxisName,
    /// Its values in order.
    pub values: Vec<Value>,
}

/// A design with its axes read: a grid, or a single case as a grid of single values.
#[derive(Debug, Clone, PartialEq)]
pub struct Block {
    /// Where it stands in the study file.
    pub key: String,
    /// Its axes in the order of the file.
    pub axes: Vec<Axis>,
}

/// One point: a value for each axis of its block.
#[derive(Debug, Clone)]
pub struct Point<'a> {
    /// The block it is of.
    pub block: &'a Block,
    /// The place of each axis's value.
    places: Vec<usize>,
}

impl<'a> Point<'a> {
    /// The axes with the point's values.
    pub fn values(&self) -> impl Iterator<Item = (&'a Axis, &'a Value)> {
        self.block
            .axes
            .iter()
            .zip(&self.places)
            .map(|(axis, &place)| (axis, &axis.values[place]))
    }
}

impl Block {
    /// Reads the designs of a study; `known` are the names to suggest for a name that is not known.
    ///
    /// # Errors
    /// [`Refusal`] of an empty design, an empty axis, an unknown name, a form that is none.
    pub fn read(file: &Path, designs: &[Design], known: &[String]) -> Result<Vec<Self>, Refusal> {
        if designs.is_empty() {
            return Err(Refusal::new(
                file,
                "design",
                "an empty list",
                "at least one grid or list of cases",
            ));
        }
        let mut blocks = Vec::new();
        for (d, design) in designs.iter().enumerate() {
            let key = format!("design[{d}]");
            match design {
                Design::Grid(map) => {
                    let key = format!("{key}.grid");
                    let axes = map.0.iter().map(|(name, written)| {
                        let at = format!("{key}.{name}");
                        let varies = axis_name(file, &at, name, known)?;
                        Ok(Axis {
                            name: name.clone(),
                            varies,
                            values: axis_values(file, &at, written)?,
                        })
                    });
                    blocks.push(Self::checked(file, axes.collect::<Result<_, _>>()?, key)?);
                }
                Design::Cases(cases) if cases.is_empty() => {
                    return Err(Refusal::new(
                        file,
                        format!("{key}.cases"),
                        "an empty list",
                        "at least one case",
                    ));
                }
                Design::Cases(cases) => {
                    for (c, case) in cases.iter().enumerate() {
                        let key = format!("{key}.cases[{c}]");
                        let axes = case.iter().map(|(name, value)| {
                            let varies = axis_name(file, &format!("{key}.{name}"), name, known)?;
                            Ok(Axis {
                                name: name.clone(),
                                varies,
                                values: vec![canonical(value)],
                            })
                        });
                        blocks.push(Self::checked(file, axes.collect::<Result<_, _>>()?, key)?);
                    }
                }
            }
        }
        let points = blocks
            .iter()
            .try_fold(0_usize, |sum, block| sum.checked_add(block.count()?))
            .filter(|&points| points <= MOST_POINTS);
        match points {
            Some(_) => Ok(blocks),
            None => {
                let product: f64 = blocks
                    .iter()
                    .map(|b| b.axes.iter().map(|a| a.values.len() as f64).product::<f64>())
                    .sum();
                let found = format!("{product} points");
                Err(Refusal::new(
                    file,
                    "design",
                    found,
                    format!("at most {MOST_POINTS} points"),
                ))
            }
        }
    }

    /// A block whose axes do not contradict each other: none is part of what another one sets.
    fn checked(file: &Path, axes: Vec<Axis>, key: String) -> Result<Self, Refusal> {
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
        Ok(Self { key, axes })
    }

    fn count(&self) -> Option<usize> {
        self.axes
            .iter()
            .try_fold(1_usize, |n, axis| n.checked_mul(axis.values.len()))
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.axes.iter().map(|axis| axis.values.len()).product()
    }

    /// Whether there is no point; never so for a block that was read.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The points in order: the first axis changes slowest. Nothing is stored, so a long block costs nothing.
    pub fn points(&self) -> impl Iterator<Item = Point<'_>> {
        (0..self.len()).map(|number| {
            let mut rest = number;
            let mut places = vec![0; self.axes.len()];
            for (place, axis) in places.iter_mut().zip(&self.axes).rev() {
                *place = rest % axis.values.len();
                rest /= axis.values.len();
            }
            Point { block: self, places }
        })
    }
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

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn read(designs: Value) -> Result<Vec<Block>, Refusal> {
        let designs: Vec<Design> = serde_json::from_value(designs).unwrap();
        let mut known: Vec<String> = SHORT_NAMES.map(str::to_owned).to_vec();
        known.push("bridge.hydrostatic_stiffness_pa_m".to_owned());
        Block::read(Path::new("study.json"), &designs, &known)
    }

    fn points(designs: Value) -> Vec<Vec<Value>> {
        let blocks = read(designs).unwrap();
        blocks
            .iter()
            .flat_map(|b| b.points())
            .map(|p| p.values().map(|(_, v)| v.clone()).collect())
            .collect()
    }

    #[test]
    fn the_first_axis_changes_slowest_and_designs_follow_each_other() {
        let found = points(json!([
            {"grid": {"speed_m_s": [1, 2], "load_n": [30, 10, 20]}},
            {"cases": [{"load_n": 5}]}
        ]));
        let expected = [[1, 30], [1, 10], [1, 20], [2, 30], [2, 10], [2, 20]];
        assert_eq!(found.len(), 7);
        for (found, expected) in found.iter().zip(expected) {
            assert_eq!(found, &expected.map(Value::from));
        }
        assert_eq!(found[6], [json!(5)]);
    }

    #[test]
    fn a_single_value_and_a_list_as_value_are_axes() {
        let found = points(json!([{"grid": {"connection": "linear", "vehicle.track_y_m": [[-1.4, 1.4], [1, 3]]}}]));
        assert_eq!(
            found,
            [[json!("linear"), json!([-1.4, 1.4])], [json!("linear"), json!([1, 3])]]
        );
    }

    #[test]
    fn what_is_no_axis_is_refused_by_key() {
        for (grid, key) in [
            (json!({"speed_m_s": []}), "design[0].grid.speed_m_s"),
            (json!({"speed_m_s": null}), "design[0].grid.speed_m_s"),
            (
                json!({"speed_m_s": {"linspace": [1, 2]}}),
                "design[0].grid.speed_m_s.linspace",
            ),
            (
                json!({"speed_m_s": {"linspace": [1, 2, 1.5]}}),
                "design[0].grid.speed_m_s.linspace",
            ),
            (
                json!({"speed_m_s": {"geomspace": [0, 2, 3]}}),
                "design[0].grid.speed_m_s.geomspace",
            ),
            (
                json!({"speed_m_s": {"linspace": [1, 2, 1e9]}}),
                "design[0].grid.speed_m_s.linspace",
            ),
            (json!({"analysis.kind": ["static"]}), "design[0].grid.analysis.kind"),
            (
                json!({"bridge.connectors.gap_tension_m": [0], "gap_tension_m": [0]}),
                "design[0].grid.gap_tension_m",
            ),
            (
                json!({"vehicle.track_y_m[0]": [1], "vehicle.track_y_m": [[1]]}),
                "design[0].grid.vehicle.track_y_m",
            ),
            (json!({"bridge.a[": [1]}), "design[0].grid.bridge.a["),
        ] {
            assert_eq!(read(json!([{"grid": grid}])).unwrap_err().key, key);
        }
        assert_eq!(read(json!([])).unwrap_err().key, "design");
        let million = json!({"linspace": [1, 2, 1_000_000]});
        for grid in [
            json!({"speed_m_s": million, "load_n": [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11]}),
            json!({"speed_m_s": million, "load_n": million, "gap_tension_m": million, "load_x_m": million}),
        ] {
            let e = read(json!([{"grid": grid}])).unwrap_err();
            assert_eq!(
                (e.key.as_str(), e.allowed.as_str()),
                ("design", "at most 10000000 points"),
                "{e}"
            );
        }
        assert_eq!(read(json!([{"cases": []}])).unwrap_err().key, "design[0].cases");
    }

    #[test]
    fn an_unknown_name_is_refused_with_the_nearest() {
        for (name, nearest) in [
            ("sped_m_s", "speed_m_s"),
            ("hydrostatic_stiffness_pa_m", "bridge.hydrostatic_stiffness_pa_m"),
            ("brige.hydrostatic_stiffness_pa_m", "bridge.hydrostatic_stiffness_pa_m"),
        ] {
            let e = read(json!([{"grid": {name: [1]}}])).unwrap_err();
            assert_eq!(e.nearest.as_deref(), Some(nearest), "{e}");
        }
        let e = read(json!([{"grid": {"speed_m_s": {"linspce": [1, 2, 3]}}}])).unwrap_err();
        assert_eq!(e.nearest.as_deref(), Some("linspace"));
    }
}
