//! A figure as numbers: panels of lines, marks and moments, in the units that their axes name.
//!
//! Knows nothing of tables or of drawing.

use super::marks::Origin;
use pontoon_results::Curve;
use serde::Serialize;

/// A figure.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Figure {
    /// Its name, of which its files are made: letters, digits, `.`, `_` and `-`.
    pub name: String,
    /// What a paper would write under it.
    pub caption: String,
    /// What the words of its lines are values of; empty where they say it themselves.
    pub legend: String,
    /// Its panels in the order of reading.
    pub panels: Vec<FigurePanel>,
    /// What of its jobs it does not hold, in words; told with what no figure holds.
    #[serde(skip)]
    pub(super) left_out: Vec<String>,
}

impl Figure {
    /// Whether it has nothing to show.
    pub(super) fn is_empty(&self) -> bool {
        let mut lines = self.panels.iter().flat_map(|panel| &panel.lines);
        lines.all(|line| line.points.is_empty())
    }
}

/// A pair of axes with what is drawn between them.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FigurePanel {
    /// What sets it apart from the others; empty where it is the only one.
    pub title: String,
    /// The axis across.
    pub x: FigureAxis,
    /// The axis up or, where its numbers count downward, down.
    pub y: FigureAxis,
    /// Lines, in the order of the legend.
    pub lines: Vec<FigureLine>,
    /// Points of a reference.
    pub marks: Vec<PlottedMark>,
    /// Places across where something happens.
    pub moments: Vec<FigureMoment>,
}

/// An axis.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FigureAxis {
    /// What it counts.
    pub label: String,
    /// In which unit; empty of words.
    pub unit: String,
    /// Whether its numbers grow downward.
    pub down: bool,
    /// Where its places are words: the word at 0, 1, ...
    pub words: Vec<String>,
}

/// A line.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FigureLine {
    /// Its words in the legend; lines of one figure with equal words are one entry.
    pub label: String,
    /// How it is drawn: 0 for what others are compared with, then by number.
    pub style: usize,
    /// Whether its points are joined.
    pub joined: bool,
    /// The jobs that it is of.
    pub jobs: Vec<u64>,
    /// Its points, in the units of the axes.
    pub points: Vec<[f64; 2]>,
}

/// A point of a reference.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PlottedMark {
    /// Its words in the legend.
    pub label: String,
    /// Whether it was measured.
    pub origin: Origin,
    /// Id of the measurement or check.
    pub id: String,
    /// In the units of the axes.
    pub point: [f64; 2],
}

/// A place across a panel where something happens.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FigureMoment {
    /// What kind of place it is.
    #[serde(skip)]
    pub(super) kind: MomentKind,
    /// What happens.
    pub label: String,
    /// Where.
    pub x: f64,
}

/// What kind of place a moment is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum MomentKind {
    /// The vehicle stands there.
    Standing,
    /// The vehicle's centre is at the position then.
    Arrival,
}

/// A quantity as figures have it: its words, its unit, what a number of the tables is multiplied by.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct FigureMeasure {
    pub label: &'static str,
    pub unit: &'static str,
    pub factor: f64,
    pub down: bool,
}

impl FigureMeasure {
    /// What a curve of the registry counts.
    pub(super) fn of(curve: &Curve) -> Self {
        Self::up(curve.label, curve.unit, curve.factor)
    }

    const fn up(label: &'static str, unit: &'static str, factor: f64) -> Self {
        Self {
            label,
            unit,
            factor,
            down: false,
        }
    }

    /// Deflection, drawn downward.
    pub(super) const DEFLECTION: Self = Self {
        label: "Deflection",
        unit: "cm",
        factor: 100.0,
        down: true,
    };
    /// A joint's force, tension upward.
    pub(super) const FORCE: Self = Self::up("Joint force, tension positive", "kN", 1e-3);
    /// A pin's force on the module left of it.
    pub(super) const PIN_FORCE: Self = Self::up("Pin force", "kN", 1e-3);
    /// A joint's angle, open at the deck upward.
    pub(super) const ANGLE: Self = Self::up("Joint angle", "mrad", 1e3);
    /// A joint's bending moment, the deck compressed upward.
    pub(super) const BENDING: Self = Self::up("Bending moment", "kN m", 1e-3);
    pub(super) const WHEEL_FORCE: Self = Self::up("Wheel force", "kN", 1e-3);
    /// A body's rise from rest.
    pub(super) const BOUNCE: Self = Self::up("Bounce", "m", 1.0);
    /// A body's pitch, front up, or roll, left side up.
    pub(super) const BODY_ANGLE: Self = Self::up("Body angle", "mrad", 1e3);
    pub(super) const ALONG: Self = Self::up("Distance along the bridge", "m", 1.0);
    pub(super) const TIME: Self = Self::up("Time", "s", 1.0);
    pub(super) const SPEED: Self = Self::up("Speed", "m/s", 1.0);
    pub(super) const FREQUENCY: Self = Self::up("Frequency", "Hz", 1.0);

    /// The axis that counts it.
    pub(super) fn axis(self) -> FigureAxis {
        FigureAxis {
            label: self.label.to_owned(),
            unit: self.unit.to_owned(),
            down: self.down,
            words: Vec::new(),
        }
    }
}
