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
enum Sample {
    None,
    Line { style: usize, joined: bool },
    Mark(Origin),
    Bar,
}

/// A legend laid out.
pub(super) struct Legend {
    /// What, its words, and where it begins: across and in which row.
    entries: Vec<(Sample, String, f64, usize)>,
}

impl Legend {
    /// The legend of a figure between two places across.
    pub(super) fn new(figure: &Figure, letters: &Letters, left: f64, right: f64) -> Self {
        let mut wanted: Vec<(Sample, String)> = Vec::new();
        let mut want = |entry: (Sample, String)| {
            if !wanted.contains(&entry) {
                wanted.push(entry);
            }
        };
        for line in figure.panels.iter().flat_map(|panel| &panel.lines) {
            let sample = Sample::Line {
                style: line.style,
                joined: line.joined,
            };
            want((sample, line.label.clone()));
        }
        for panel in &figure.panels {
            for mark in &panel.marks {
                let bar = !panel.y.words.is_empty();
                let sample = if bar { Sample::Bar } else { Sample::Mark(mark.origin) };
                want((sample, mark.label.clone()));
            }
        }
        wanted.sort_by_key(|(sample, _)| match sample {
            Sample::None => 0,
            Sample::Line { style: 0, .. } => usize::MAX - 1,
            Sample::Line { style, .. } => *style,
            Sample::Mark(_) | Sample::Bar => usize::MAX,
        });
        if !figure.legend.is_empty() {
            wanted.insert(0, (Sample::None, format!("{}:", capital(&figure.legend))));
        }
        let fitted = wanted.into_iter().map(|(sample, words)| {
            let words = letters.fitting(&words, SMALL, right - left - sample.width());
            let width = sample.width() + letters.width(&words, SMALL) + APART;
            (sample, words, width)
        });
        let fitted: Vec<(Sample, String, f64)> = fitted.collect();
        let whole: f64 = fitted.iter().map(|(.., width)| width).sum();
        let in_row = whole - APART <= right - left;
        // entries that need several rows stand below each other
        let widest = fitted.iter().map(|(.., width)| *width).fold(1.0, f64::max);
        let columns = (((right - left + APART) / widest).floor() as usize).max(1);
        // what the words are values of stands above them then
        let above = usize::from(!in_row && fitted.first().is_some_and(|(sample, ..)| *sample == Sample::None));
        let (mut entries, mut x) = (Vec::new(), left);
        for (i, (sample, words, width)) in fitted.into_iter().enumerate() {
            if in_row {
                entries.push((sample, words, x, 0));
                x += if sample == Sample::None {
                    width - 0.5 * APART
                } else {
                    width
                };
            } else if i < above {
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

impl Sample {
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
