//! What a run ends with: its summary as a person looks at it. All rows are in summary.csv.
//!
//! | module | charter |
//! |---|---|
//! | `label` | names of columns and values as heads and cells |
//! | `text_table` | a table in as many pieces as a width asks for |
//! | `survey` | one look at all rows: which axes vary, where peaks are largest |
//! | `peaks` | peak deflection against speed, a row a combination of the other axes |
//! | `modes` | natural frequencies, a row a shape |
//!
//! Knows which table fits which study. Does not know how rows came about.

mod label;
mod modes;
mod peaks;
mod survey;
#[cfg(test)]
mod tests;
mod text_table;

use crate::terminal::TextStyle;
use survey::SummaryRow;

/// Characters of a line where the place does not say how many it has.
const WIDTH: usize = 118;

/// The summary for people. `rows` are made as often as they are looked at.
pub(crate) fn text<'a, I: Iterator<Item = SummaryRow<'a>>>(
    columns: &[String],
    rows: impl Fn() -> I,
    text_style: TextStyle,
) -> String {
    let width = text_style.width.unwrap_or(WIDTH);
    if columns.last().is_some_and(|column| column == "shape") {
        modes::modes(columns, rows(), text_style, width)
    } else {
        peaks::peaks(columns, rows, text_style, width)
    }
}
