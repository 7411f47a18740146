//! A figure laid out: panels in a grid, the legend below them.
//!
//! Knows sizes: a column of a journal is 84 mm wide, a page 174 mm. Does not know what is drawn.

use super::legend;
use super::letters::Letters;
use super::panel::{self, PanelFrame};
use super::pen::{Anchor, PT_MM, Pen};
use super::style::LARGE;
use crate::figures::{Figure, FigurePanel};
use std::io;

/// Width of a figure of one panel `[pt]`.
const COLUMN: f64 = 84.0 * PT_MM;
/// Width of a figure of several panels `[pt]`.
const PAGE: f64 = 174.0 * PT_MM;
/// Height of a panel between its axes `[pt]`.
const HEIGHT: f64 = 46.0 * PT_MM;
/// Height of a word of a list of words `[pt]`.
const WORD: f64 = 9.0;
/// From panel to panel across, and from the figure's edge `[pt]`.
const GAP: f64 = 9.0;
/// Above a panel for its title, or for nothing `[pt]`.
const TITLE: f64 = 13.0;
const NO_TITLE: f64 = 5.0;
/// Below a panel: ticks with their numbers, and the axis's words `[pt]`.
const TICKS: f64 = 13.0;
const WORDS: f64 = 11.0;

/// The SVG of a figure.
pub(super) fn svg(figure: &Figure, letters: &Letters) -> io::Result<String> {
    let count = figure.panels.len();
    let columns = count.clamp(1, 2);
    let rows = count.div_ceil(columns);
    let width = if columns == 1 { COLUMN } else { PAGE };
    let scales = panel::scales(figure);
    let left: Vec<f64> = figure
        .panels
        .iter()
        .zip(&scales)
        .map(|(panel, scale)| panel::left(panel, scale, letters))
        .collect();
    let of_column = |column: usize| {
        left.iter()
            .skip(column)
            .step_by(columns)
            .fold(0.0, |a: f64, b| a.max(*b))
    };
    let lefts: Vec<f64> = (0..columns).map(of_column).collect();
    let across = (width - lefts.iter().sum::<f64>() - GAP * columns as f64) / columns as f64;
    let top = if count > 1 { TITLE } else { NO_TITLE };
    let words = figure.panels.iter().map(|panel| panel.y.words.len()).max().unwrap_or(0);
    let down = if words > 0 { WORD * words as f64 + 4.0 } else { HEIGHT };
    let row = top + down + TICKS + WORDS;
    let legend = legend::Legend::new(figure, letters, lefts[0], width - GAP);
    let height = row * rows as f64 + legend.height() + 2.0;
    let mut pen = Pen::new(width, height, &figure.caption, letters)?;
    for (i, (panel, scale)) in figure.panels.iter().zip(&scales).enumerate() {
        let (column, line) = (i % columns, i / columns);
        let x = lefts[..=column].iter().sum::<f64>() + (across + GAP) * column as f64;
        let frame = PanelFrame {
            x,
            y: row * line as f64 + top,
            width: across,
            height: down,
            id: format!("panel-{i}"),
        };
        panel::draw(&mut pen, panel, scale, &frame)?;
        title(&mut pen, panel, &frame, (count > 1).then_some(i), letters)?;
    }
    legend.draw(&mut pen, row * rows as f64)?;
    pen.end()
}

/// The letter of a panel and what sets it apart.
fn title(
    pen: &mut Pen,
    panel: &FigurePanel,
    frame: &PanelFrame,
    number: Option<usize>,
    letters: &Letters,
) -> io::Result<()> {
    let letter = number
        .and_then(|i| u8::try_from(i).ok())
        .map(|i| char::from(b'a' + i % 26));
    let text = match (letter, panel.title.as_str()) {
        (None, "") => return Ok(()),
        (None, title) => title.to_owned(),
        (Some(letter), "") => format!("({letter})"),
        (Some(letter), title) => format!("({letter}) {title}"),
    };
    let text = letters.fitting(&text, LARGE, frame.width);
    pen.text([frame.x, frame.y - 3.5], LARGE, Anchor::Start, "#000000", &text)
}
