//! A panel: its axes, and lines, markers and marks between them.
//!
//! Knows where a value lies on paper. Does not know what values are.

use super::letters::Letters;
use super::pen::{Anchor, Pen, Stroke};
use super::scale::Scale;
use super::style::{self, LARGE, MARK, MARKER, SMALL};
use crate::figures::{Figure, FigureAxis, FigureLine, FigurePanel, Origin};
use std::io;

/// Steps between ticks, about.
const STEPS: f64 = 6.0;
const STEPS_UP: f64 = 8.0;
/// Length of a tick `[pt]`.
const TICK: f64 = 2.5;
/// Points up to which each has a marker; longer lines have this many markers.
const MARKED: usize = 10;
const MARKERS: usize = 7;

/// Where a panel is `[pt]`.
pub(super) struct PanelFrame {
    /// Its left edge.
    pub x: f64,
    /// Its upper edge.
    pub y: f64,
    /// Its width.
    pub width: f64,
    /// Its height.
    pub height: f64,
    /// Its name in the file.
    pub id: String,
}

/// The scales of a panel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Scales {
    /// Across.
    pub x: Scale,
    /// Up, or down.
    pub y: Scale,
}

/// Whether panels of a figure count the same upward, so that they are drawn to one scale.
fn alike(a: &FigurePanel, b: &FigurePanel) -> bool {
    a.y == b.y
}

/// The scales of all panels with one that they share.
fn shared(figure: &Figure, own: impl Fn(&[&FigurePanel], &FigurePanel) -> Scales) -> Vec<Scales> {
    let of = |panel: &FigurePanel| {
        let like: Vec<&FigurePanel> = figure.panels.iter().filter(|other| alike(other, panel)).collect();
        own(&like, panel)
    };
    figure.panels.iter().map(of).collect()
}

/// The scales of all panels: those that count the same upward have one.
pub(super) fn scales(figure: &Figure) -> Vec<Scales> {
    shared(figure, |like, panel| {
        let points = |panel: &FigurePanel| -> Vec<[f64; 2]> {
            let of_lines = panel.lines.iter().flat_map(|line| line.points.iter().copied());
            of_lines.chain(panel.marks.iter().map(|mark| mark.point)).collect()
        };
        let own = points(panel);
        let across = own.iter().map(|[x, _]| *x);
        let apart = panel
            .lines
            .iter()
            .any(|line| line.points.len() <= MARKED || !line.joined);
        let x = if apart {
            Scale::exact(across, STEPS).padded(0.05)
        } else {
            Scale::exact(across, STEPS)
        };
        let y = if panel.y.words.is_empty() {
            let up = like.iter().flat_map(|panel| points(panel)).map(|[_, y]| y);
            Scale::round(
                roomy(up.chain([0.0]), like.iter().any(|panel| !panel.moments.is_empty())),
                STEPS_UP,
            )
        } else {
            Scale {
                from: -0.7,
                to: panel.y.words.len() as f64 - 0.3,
                step: 1.0,
            }
        };
        Scales { x, y }
    })
}

/// The ends of some values with room before them, more at the end where moments are named; none at zero.
fn roomy(values: impl Iterator<Item = f64>, named: bool) -> impl Iterator<Item = f64> {
    let (from, to) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
    let span = to - from;
    let before = if from < 0.0 { from - 0.03 * span } else { from };
    let behind = if to > 0.0 || named {
        to + if named { 0.12 } else { 0.03 } * span
    } else {
        to
    };
    [before, behind].into_iter()
}

/// Room left of a panel `[pt]`.
pub(super) fn left(panel: &FigurePanel, scales: &Scales, letters: &Letters) -> f64 {
    let ticks = if panel.y.words.is_empty() {
        scales.y.ticks().iter().map(|tick| scales.y.text(*tick)).collect()
    } else {
        panel.y.words.clone()
    };
    let widest = ticks.iter().map(|text| letters.width(text, SMALL)).fold(0.0, f64::max);
    let words = if panel.y.label.is_empty() { 3.0 } else { LARGE + 5.0 };
    words + widest.min(110.0) + TICK + 2.5
}

/// The words of an axis with its unit.
pub(super) fn words(axis: &FigureAxis) -> String {
    if axis.unit.is_empty() {
        axis.label.clone()
    } else {
        format!("{} ({})", axis.label, axis.unit)
    }
}

/// Draws a panel.
pub(super) fn draw(pen: &mut Pen, panel: &FigurePanel, scales: &Scales, frame: &PanelFrame) -> io::Result<()> {
    let placed = Placed { panel, scales, frame };
    let at = |point| placed.at(point);
    placed.axes(pen)?;
    pen.clipped(&frame.id, [frame.x, frame.y, frame.width, frame.height])?;
    for line in panel.lines.iter().filter(|line| line.joined && line.points.len() > 1) {
        let style = style::of(line.style);
        let points: Vec<[f64; 2]> = line.points.iter().map(|point| at(*point)).collect();
        let stroke = Stroke {
            colour: style.colour,
            width: style.width,
            dashes: style.dashes,
        };
        pen.line(&points, stroke)?;
    }
    pen.end_group()?;
    pen.group("markers")?;
    for line in &panel.lines {
        let style = style::of(line.style);
        let marker = style
            .marker
            .or((!line.joined || line.points.len() == 1).then_some(style::Marker::Disc));
        if let Some(marker) = marker {
            for point in marked(line, scales) {
                pen.marker(marker, at(point), MARKER, style.colour, !line.joined)?;
            }
        }
    }
    pen.end_group()?;
    pen.group("marks")?;
    for mark in &panel.marks {
        if panel.y.words.is_empty() {
            pen.star(at(mark.point), MARK, mark.origin == Origin::Measured)?;
        } else {
            pen.bar(at(mark.point), MARK)?;
        }
    }
    pen.end_group()
}

/// Where a line has markers: at each of few points, else at some evenly across, each line's between the others'.
fn marked(line: &FigureLine, scales: &Scales) -> Vec<[f64; 2]> {
    if line.points.len() <= MARKED || !line.joined {
        return line.points.clone();
    }
    let shift = (line.style as f64 * 0.37).fract();
    let target = |i: usize| scales.x.from + (scales.x.to - scales.x.from) * (i as f64 + shift) / MARKERS as f64;
    let near = |x: f64| {
        let first = line.points.partition_point(|point| point[0] < x);
        let around = first.saturating_sub(1)..(first + 1).min(line.points.len());
        line.points[around]
            .iter()
            .copied()
            .min_by(|a, b| (a[0] - x).abs().total_cmp(&(b[0] - x).abs()))
    };
    let mut places: Vec<[f64; 2]> = (0..MARKERS).map(target).filter_map(near).collect();
    places.dedup();
    places
}

const AXIS: Stroke<'static> = Stroke {
    colour: "#000000",
    width: 0.6,
    dashes: "",
};
const FAINT: Stroke<'static> = Stroke {
    colour: "#b0b0b0",
    width: 0.5,
    dashes: "",
};
const MOMENT: Stroke<'static> = Stroke {
    colour: "#555555",
    width: 0.6,
    dashes: "2 1.5",
};

/// A panel in its place on paper.
struct Placed<'a> {
    panel: &'a FigurePanel,
    scales: &'a Scales,
    frame: &'a PanelFrame,
}

impl Placed<'_> {
    /// Gives the place on paper of a point of the panel `[pt]`.
    fn at(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let Self { panel, scales, frame } = self;
        let up = scales.y.share(y);
        let down = if panel.y.down { up } else { 1.0 - up };
        [frame.x + frame.width * scales.x.share(x), frame.y + frame.height * down]
    }

    /// Gives the right edge of the frame `[pt]`.
    fn right(&self) -> f64 {
        self.frame.x + self.frame.width
    }

    /// Gives the lower edge of the frame `[pt]`.
    fn bottom(&self) -> f64 {
        self.frame.y + self.frame.height
    }

    /// Draws all that stands around the lines: zero, moments, the frame, both axes.
    fn axes(&self, pen: &mut Pen) -> io::Result<()> {
        let frame = self.frame;
        pen.group("axes")?;
        if self.panel.y.words.is_empty() {
            self.zero(pen)?;
        }
        self.moments(pen)?;
        pen.frame([frame.x, frame.y, frame.width, frame.height], AXIS)?;
        self.axis_across(pen)?;
        self.axis_up(pen)?;
        pen.end_group()
    }

    /// Draws the line at zero where it is not the frame.
    fn zero(&self, pen: &mut Pen) -> io::Result<()> {
        let zero = self.at([self.scales.x.from, 0.0])[1];
        if zero > self.frame.y + 0.5 && zero < self.bottom() - 0.5 {
            pen.line(&[[self.frame.x, zero], [self.right(), zero]], FAINT)?;
        }
        Ok(())
    }

    /// Draws the moments that lie on the axis across, each with its words on the side that has room.
    fn moments(&self, pen: &mut Pen) -> io::Result<()> {
        let Self { panel, scales, frame } = self;
        let bottom = self.bottom();
        for moment in panel
            .moments
            .iter()
            .filter(|moment| (0.0..=1.0).contains(&scales.x.share(moment.x)))
        {
            let x = self.at([moment.x, scales.y.from])[0];
            pen.line(&[[x, frame.y], [x, bottom]], MOMENT)?;
            let (place, anchor) = if x < frame.x + 0.6 * frame.width {
                (x + 2.5, Anchor::Start)
            } else {
                (x - 2.5, Anchor::End)
            };
            let down = if panel.y.down { bottom - 3.5 } else { frame.y + 8.0 };
            pen.text([place, down], SMALL, anchor, "#555555", &moment.label)?;
        }
        Ok(())
    }

    /// Draws ticks and words of the axis across.
    fn axis_across(&self, pen: &mut Pen) -> io::Result<()> {
        let Self { panel, scales, frame } = self;
        let bottom = self.bottom();
        for tick in scales.x.ticks() {
            let x = self.at([tick, scales.y.from])[0];
            pen.line(&[[x, bottom], [x, bottom + TICK]], AXIS)?;
            pen.text(
                [x, bottom + TICK + 7.5],
                SMALL,
                Anchor::Middle,
                "#000000",
                &scales.x.text(tick),
            )?;
        }
        pen.text(
            [frame.x + 0.5 * frame.width, bottom + 21.0],
            LARGE,
            Anchor::Middle,
            "#000000",
            &words(&panel.x),
        )
    }

    /// Draws ticks and words of the axis up.
    fn axis_up(&self, pen: &mut Pen) -> io::Result<()> {
        let Self { panel, scales, frame } = self;
        let mut widest = 0;
        for (tick, text) in self.ticks_up() {
            let y = self.at([scales.x.from, tick])[1];
            pen.line(&[[frame.x - TICK, y], [frame.x, y]], AXIS)?;
            if !panel.y.words.is_empty() {
                pen.line(&[[frame.x, y], [self.right(), y]], FAINT)?;
            }
            pen.text([frame.x - TICK - 2.0, y + 2.5], SMALL, Anchor::End, "#000000", &text)?;
            widest = widest.max(text.chars().count());
        }
        if !panel.y.label.is_empty() {
            // a digit is 0.556 em wide
            let x = frame.x - TICK - 5.5 - 0.556 * SMALL * widest as f64;
            pen.upward([x, frame.y + 0.5 * frame.height], LARGE, &words(&panel.y))?;
        }
        Ok(())
    }

    /// Lists the ticks of the axis up with their words: numbers, or the words of the axis.
    fn ticks_up(&self) -> Vec<(f64, String)> {
        let (words, scale) = (&self.panel.y.words, &self.scales.y);
        if words.is_empty() {
            scale.ticks().into_iter().map(|tick| (tick, scale.text(tick))).collect()
        } else {
            (0..).map(f64::from).zip(words.iter().cloned()).collect()
        }
    }
}
