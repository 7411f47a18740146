//! A table of rows named by columns of their own and values under heads, in as many pieces as a width asks for.
//!
//! Knows widths, alignment and what stands in for names that are too long. Does not know what the values are.

use crate::terminal::{HEAD, TextStyle};
use crate::text::{listed, padded};
use anstyle::Style;
use std::ops::Range;
use unicode_width::UnicodeWidthStr;

/// Blanks between columns.
const GAP: usize = 2;

/// A value as it is written, with its style.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(super) struct TableEntry {
    /// The text; numbers end in a blank where others end in a mark.
    pub text: String,
    /// How it is painted.
    pub style: Style,
}

/// What names a row: a column of the table.
#[derive(Debug, Clone)]
pub(super) struct RowNames {
    /// Lines of the head; the last stands beside the last of the heads of values.
    pub head: Vec<String>,
    /// A name a row.
    pub rows: Vec<String>,
    /// A name a row where it stands alone; nothing where it says nothing.
    pub told: Vec<String>,
}

/// A table.
#[derive(Debug, Clone, Default)]
pub(super) struct TextTable {
    /// Columns that name rows.
    pub names: Vec<RowNames>,
    /// Heads of the columns of values, each of as many lines.
    pub heads: Vec<Vec<String>>,
    /// Values, a row of the table each.
    pub rows: Vec<Vec<TableEntry>>,
    /// Blanks before a value: less than elsewhere where values end in one.
    pub gap: usize,
}

/// Texts with their points under each other, where all are numbers; else to the left.
fn aligned(texts: &[String]) -> Vec<String> {
    let number = |text: &String| text == "-" || text.parse::<f64>().is_ok();
    if !texts.iter().all(number) {
        return texts.to_vec();
    }
    let behind = |text: &str| text.find('.').map_or(0, |point| text.len() - point);
    let most = texts.iter().map(|text| behind(text)).max().unwrap_or(0);
    let beside: Vec<String> = texts
        .iter()
        .map(|text| text.clone() + &" ".repeat(most - behind(text)))
        .collect();
    let width = longest(beside.iter());
    beside.iter().map(|text| padded(text, width, true)).collect()
}

fn longest<'a>(texts: impl Iterator<Item = &'a String>) -> usize {
    texts.map(|text| text.width()).max().unwrap_or(0)
}

impl TextTable {
    /// Number of pieces that a width asks for.
    pub(super) fn pieces(&self, width: usize) -> usize {
        self.split(width_of(&self.columns_of_names(width)), width).len()
    }

    /// The table in pieces that fit a width, if there is any way to.
    pub(super) fn written(&self, width: usize, text_style: TextStyle) -> String {
        let names = self.columns_of_names(width);
        let mut text = String::new();
        if self.is_numbered(width) {
            text += &self.key(width);
        }
        let named = width_of(&names);
        // names stand as far from values as from each other, if that costs no piece more
        let apart = GAP.saturating_sub(self.gap);
        let pieces = self.split(named, width);
        let apart = if self.split(named + apart, width).len() == pieces.len() {
            apart
        } else {
            0
        };
        for (i, columns) in self.split(named + apart, width).into_iter().enumerate() {
            if i > 0 {
                text.push('\n');
            }
            self.piece(&names, apart, columns, text_style, &mut text);
        }
        text
    }

    /// Whether names of rows leave no room for values: then numbers stand for them.
    fn is_numbered(&self, width: usize) -> bool {
        let names = width_of(&self.aligned_names());
        let value = (0..self.heads.len())
            .map(|column| self.value(column))
            .max()
            .unwrap_or(0);
        names > 0 && (3 * names > 2 * width || names + self.gap + value > width)
    }

    fn aligned_names(&self) -> Vec<RowNames> {
        let aligned = |names: &RowNames| RowNames {
            head: names.head.clone(),
            rows: aligned(&names.rows),
            told: Vec::new(),
        };
        self.names.iter().map(aligned).collect()
    }

    /// The columns of values in pieces that fit beside names of so many characters; at least one a piece.
    fn split(&self, names: usize, width: usize) -> Vec<Range<usize>> {
        let mut pieces: Vec<Range<usize>> = Vec::new();
        let mut used = 0;
        for column in 0..self.heads.len() {
            let more = self.value(column) + self.gap;
            match pieces.last_mut().filter(|_| used + more <= width) {
                Some(piece) => piece.end = column + 1,
                None => {
                    pieces.push(column..column + 1);
                    used = names;
                }
            }
            used += more;
        }
        pieces
    }

    /// The columns that name rows, or numbers where they leave no room for values.
    fn columns_of_names(&self, width: usize) -> Vec<RowNames> {
        if !self.is_numbered(width) {
            return self.aligned_names();
        }
        vec![RowNames {
            head: Vec::new(),
            rows: (1..=self.rows.len()).map(|number| format!("#{number}")).collect(),
            told: Vec::new(),
        }]
    }

    /// What the numbers stand for.
    fn key(&self, width: usize) -> String {
        let indent = format!("#{}", self.rows.len()).len() + 1;
        let keys = (0..self.rows.len()).map(|row| {
            let number = format!("#{}", row + 1);
            let told = self.names.iter().map(|names| &names.told[row]);
            listed(&format!("{number:<indent$}"), told, width, indent)
        });
        keys.collect::<String>() + "\n"
    }

    /// Lines of the head.
    fn lines(&self, names: &[RowNames]) -> usize {
        let names = names.iter().map(|names| names.head.len());
        names.chain(self.heads.iter().map(Vec::len)).max().unwrap_or(0)
    }

    /// Width of a column of values.
    fn value(&self, column: usize) -> usize {
        let cells = self
            .rows
            .iter()
            .filter_map(|row| row.get(column))
            .map(|cell| &cell.text);
        longest(cells.chain(&self.heads[column]))
    }

    fn piece(&self, names: &[RowNames], apart: usize, columns: Range<usize>, text_style: TextStyle, text: &mut String) {
        let named = |line: &dyn Fn(&RowNames) -> String| {
            let column = |names: &RowNames| {
                let width = longest(names.rows.iter().chain(&names.head));
                let numbers = names
                    .rows
                    .iter()
                    .all(|row| row.trim() == "-" || row.trim().parse::<f64>().is_ok());
                let written = line(names);
                padded(&written, width, numbers)
            };
            names.iter().map(column).collect::<Vec<_>>().join(&" ".repeat(GAP)) + &" ".repeat(apart)
        };
        let lines = self.lines(names);
        // heads stand on the table
        let at = |head: &[String], line: usize| {
            let line = (line + head.len()).checked_sub(lines);
            line.map_or(String::new(), |line| head[line].clone())
        };
        for line in 0..lines {
            let mut head = named(&|names| at(&names.head, line));
            for column in columns.clone() {
                let value = self.value(column) + self.gap;
                head += &padded(&at(&self.heads[column], line), value, true);
            }
            if !head.trim().is_empty() {
                *text += &text_style.painted(HEAD, head.trim_end());
                text.push('\n');
            }
        }
        for (i, row) in self.rows.iter().enumerate() {
            let mut written = named(&|names| names.rows[i].clone());
            for column in columns.clone() {
                let cell = &row[column];
                let blanks = self.gap + self.value(column) - cell.text.width();
                let bare = cell.text.trim_end();
                written += &format!("{}{}", " ".repeat(blanks), text_style.painted(cell.style, bare));
                written += &" ".repeat(cell.text.len() - bare.len());
            }
            *text += written.trim_end();
            text.push('\n');
        }
    }
}

fn width_of(names: &[RowNames]) -> usize {
    let columns = names.iter().map(|names| longest(names.rows.iter().chain(&names.head)));
    columns.sum::<usize>() + GAP * names.len().saturating_sub(1)
}
