//! What the place is like where something is written: its width, whether it shows colours.
//!
//! Knows terminals, `NO_COLOR` and `TERM`. Does not know what is written.

use crate::caller::caller;
use anstyle::{AnsiColor, Style};
use std::io::{IsTerminal, stderr, stdout};
use terminal_size::{Width, terminal_size_of};

/// The looks of a place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct TextStyle {
    /// Whether it shows colours.
    pub colour: bool,
    /// Characters of a line; none where lines may be of any length, as in a file.
    pub width: Option<usize>,
}

/// What is good.
pub(crate) const GOOD: Style = AnsiColor::Green.on_default();
/// What falls short.
pub(crate) const BAD: Style = AnsiColor::Red.on_default().bold();
/// What has changed or is the largest.
pub(crate) const NOTABLE: Style = AnsiColor::Yellow.on_default().bold();
/// Heads of tables.
pub(crate) const HEAD: Style = Style::new().bold();
/// What is of lesser weight.
pub(crate) const FAINT: Style = Style::new().dimmed();

impl TextStyle {
    /// Of standard output, where results go.
    pub(crate) fn of_results() -> Self {
        if caller().is_some() {
            return Self::new(false, None);
        }
        Self::new(
            stdout().is_terminal(),
            terminal_size_of(stdout()).map(|(width, _)| width),
        )
    }

    /// Of standard error, where progress and errors go.
    pub(crate) fn of_notes() -> Self {
        Self::new(
            stderr().is_terminal(),
            terminal_size_of(stderr()).map(|(width, _)| width),
        )
    }

    fn new(terminal: bool, width: Option<Width>) -> Self {
        let set = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty());
        let dumb = set("TERM").is_none_or(|term| term == "dumb");
        Self {
            colour: terminal && !dumb && set("NO_COLOR").is_none(),
            // a terminal that does not tell its width is not written to as if it were narrow
            width: width
                .filter(|_| terminal)
                .map(|Width(width)| usize::from(width))
                .filter(|&width| width > 0),
        }
    }

    /// A text in a style, where colours are shown.
    pub(crate) fn painted(self, style: Style, text: &str) -> String {
        if self.colour && !text.is_empty() {
            format!("{style}{text}{style:#}")
        } else {
            text.to_owned()
        }
    }
}
