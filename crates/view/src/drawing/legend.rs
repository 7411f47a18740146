//! The legend: which line is which, and what marks are.
//!
//! Knows words and samples. Does not know panels.

use super::letters::Letters;
use super::pen::{Anchor, Pen, Stroke};
use super::style::{self, MARK, MARKER, SMALL};
use crate::figures::{Figure, Origin};
use std::io;

/// Length of a sample of a line, of a mark; from a sample to its words, and from entry to entry `[pt]`.
const SAMPLE: f64 = 24.0;
const STAR: f64 = 10.0;
const NEAR: f64 = 3.5;
const APART: f64 = 11.0;
/// From line to line of the legend `[pt]`.
const ROW: f64 = 10.5;

#[derive(Debug, Clone, Copy, PartialEq)]
enum LegendSample {
    None,
    Line { style: usize, joined: bool },
    Mark(Origin),
    Bar,
}

/// What, its words, and where it begins: across and in which row.
type LegendEntry = (LegendSample, String, f64, usize);

/// A legend laid out.
pub(super) struct Legend {
    entries: Vec<LegendEntry>,
}

impl Legend {
    /// The legend of a figure between two places across.
    pub(super) fn new(figure: &Figure, letters: &Letters, left: f64, right: f64) -> Self {
        let room = right - left;
        let fitted = wanted(figure)
            .into_iter()
            .map(|(sample, words)| Fitted::new(sample, &words, letters, room));
        let fitted: Vec<Fitted> = fitted.collect();
        let whole: f64 = fitted.iter().map(|entry| entry.width).sum();
        let entries = if whole - APART <= room {
            in_one_row(fitted, left)
        } else {
            in_columns(fitted, left, room)
        };
        Self { entries }
    }

    /// Its height `[pt]`.
    pub(super) fn height(&self) -> f64 {
        let rows = self.entries.last().map_or(0, |(.., row)| row + 1);
        ROW * rows as f64 + 4.0
    }

    /// Draws it below a place.
    pub(super) fn draw(&self, pen: &mut Pen, top: f64) -> io::Result<()> {
        pen.group("legend")?;
        for (sample, words, x, row) in &self.entries {
            let middle = top + ROW * (*row as f64 + 0.5) + 2.0;
            sample.draw(pen, *x, middle)?;
            pen.text(
                [x + sample.width(), middle + 2.5],
                SMALL,
                Anchor::Start,
                "#000000",
                words,
            )?;
        }
        pen.end_group()
    }
}

/// An entry that is to have its place.
struct Fitted {
    sample: LegendSample,
    words: String,
    /// From its beginning to that of the next `[pt]`.
    width: f64,
}

impl Fitted {
    /// Cuts the words of an entry to the room that there is across `[pt]`.
    fn new(sample: LegendSample, words: &str, letters: &Letters, room: f64) -> Self {
        let words = letters.fitting(words, SMALL, room - sample.width());
        let width = sample.width() + letters.width(&words, SMALL) + APART;
        Self { sample, words, width }
    }
}

/// Lists what the legend of a figure says, each once: what the lines' words are values of, the lines by their style, the
/// marks.
fn wanted(figure: &Figure) -> Vec<(LegendSample, String)> {
    let mut wanted: Vec<(LegendSample, String)> = Vec::new();
    let mut want = |entry: (LegendSample, String)| {
        if !wanted.contains(&entry) {
            wanted.push(entry);
        }
    };
    for line in figure.panels.iter().flat_map(|panel| &panel.lines) {
        let sample = LegendSample::Line {
            style: line.style,
            joined: line.joined,
        };
        want((sample, line.label.clone()));
    }
    for panel in &figure.panels {
        for mark in &panel.marks {
            let bar = !panel.y.words.is_empty();
            let sample = if bar {
                LegendSample::Bar
            } else {
                LegendSample::Mark(mark.origin)
            };
            want((sample, mark.label.clone()));
        }
    }
    wanted.sort_by_key(|(sample, _)| sample.rank());
    if !figure.legend.is_empty() {
        wanted.insert(0, (LegendSample::None, format!("{}:", capital(&figure.legend))));
    }
    wanted
}

/// Places entries one behind the other from `left` `[pt]` on.
fn in_one_row(fitted: Vec<Fitted>, left: f64) -> Vec<LegendEntry> {
    let (mut entries, mut x) = (Vec::new(), left);
    for Fitted { sample, words, width } in fitted {
        entries.push((sample, words, x, 0));
        x += if sample == LegendSample::None {
            width - 0.5 * APART
        } else {
            width
        };
    }
    entries
}

/// Places entries that need several rows below each other, in as many columns as the room across takes `[pt]`.
fn in_columns(fitted: Vec<Fitted>, left: f64, room: f64) -> Vec<LegendEntry> {
    let widest = fitted.iter().map(|entry| entry.width).fold(1.0, f64::max);
    let columns = (((room + APART) / widest).floor() as usize).max(1);
    // what the words are values of stands above them
    let above = usize::from(fitted.first().is_some_and(|entry| entry.sample == LegendSample::None));
    let mut entries = Vec::new();
    for (i, Fitted { sample, words, .. }) in fitted.into_iter().enumerate() {
        if i < above {
            entries.push((sample, words, left, 0));
        } else {
            let place = i - above;
            entries.push((
                sample,
                words,
                left + widest * (place % columns) as f64,
                above + place / columns,
            ));
        }
    }
    entries
}

impl LegendSample {
    /// Gives its place in the order of the legend: what lines are compared with comes last of the lines.
    fn rank(self) -> usize {
        match self {
            Self::None => 0,
            Self::Line { style: 0, .. } => usize::MAX - 1,
            Self::Line { style, .. } => style,
            Self::Mark(_) | Self::Bar => usize::MAX,
        }
    }

    fn width(self) -> f64 {
        match self {
            Self::None => 0.0,
            Self::Line { joined: true, .. } => SAMPLE + NEAR,
            Self::Line { joined: false, .. } | Self::Mark(_) | Self::Bar => STAR + NEAR,
        }
    }

    fn draw(self, pen: &mut Pen, x: f64, y: f64) -> io::Result<()> {
        match self {
            Self::None => Ok(()),
            Self::Line { style, joined } => {
                let style = style::of(style);
                if joined {
                    let stroke = Stroke {
                        colour: style.colour,
                        width: style.width,
                        dashes: style.dashes,
                    };
                    pen.line(&[[x, y], [x + SAMPLE, y]], stroke)?;
                }
                let middle = x + 0.5 * if joined { SAMPLE } else { STAR };
                match style.marker.or((!joined).then_some(style::Marker::Disc)) {
                    Some(marker) => pen.marker(marker, [middle, y], MARKER, style.colour, !joined),
                    None => Ok(()),
                }
            }
            Self::Bar => pen.bar([x + 0.5 * STAR, y], MARK),
            Self::Mark(origin) => pen.star([x + 0.5 * STAR, y], MARK, origin == Origin::Measured),
        }
    }
}

/// A word at the beginning of a line.
fn capital(word: &str) -> String {
    let mut letters = word.chars();
    letters
        .next()
        .map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}
