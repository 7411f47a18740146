//! Aligned tables, times, and what goes where when a reader has left.
//!
//! Knows text. Does not know what it says.

use crate::caller::{caller, keep_note, keep_result};
use pontoon_plan::input::Cell;
use pontoon_results::labels;
pub(crate) use pontoon_results::labels::printable;
use std::io::{self, BufWriter, ErrorKind, Write};
use unicode_width::UnicodeWidthStr;

/// Writes results on standard output, or hands them to the caller. A reader that has left (a closed pipe) wants no more, which is no error.
///
/// # Errors
/// What the system says of any other failure.
pub(crate) fn result(text: &str) -> io::Result<()> {
    results(|out| out.write_all(text.as_bytes()))
}

/// Writes results on standard output piece by piece; a reader that has left is no error.
///
/// # Errors
/// As above.
pub(crate) fn results(write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    if caller().is_some() {
        let mut kept = Vec::new();
        write(&mut kept)?;
        keep_result(&kept);
        return Ok(());
    }
    let mut out = BufWriter::new(io::stdout().lock());
    match write(&mut out).and_then(|()| out.flush()) {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        other => other,
    }
}

/// Writes a line on standard error, where it is nobody's loss if nobody reads it.
pub(crate) fn note(line: &str) {
    if keep_note(line) {
        return;
    }
    crate::bar::aside(|| {
        let _ = writeln!(io::stderr().lock(), "{line}");
    });
}

/// A table with its columns aligned, numbers to the right; a last line end.
pub(crate) fn table(columns: &[String], rows: &[Vec<Cell<'_>>]) -> String {
    let cells: Vec<Vec<String>> = rows
        .iter()
        .map(|row| {
            columns
                .iter()
                .zip(row)
                .map(|(name, cell)| labels::listed(name, cell))
                .collect()
        })
        .collect();
    let width = |i: usize| {
        let longest = cells.iter().map(|row| row[i].width()).max().unwrap_or(0);
        longest.max(columns[i].width())
    };
    let widths: Vec<usize> = (0..columns.len()).map(width).collect();
    let numbers: Vec<bool> = (0..columns.len())
        .map(|i| rows.iter().all(|row| row[i].word().is_none()))
        .collect();
    let line = |row: &[String]| {
        let mut text = String::new();
        for (i, cell) in row.iter().enumerate() {
            let gap = if i == 0 { "" } else { "  " };
            text += &format!("{gap}{}", padded(cell, widths[i], numbers[i]));
        }
        text.trim_end().to_owned() + "\n"
    };
    cells.iter().fold(line(columns), |text, row| text + &line(row))
}

/// A text made as wide as `width` columns of a terminal by blanks, before it or behind it.
pub(crate) fn padded(text: &str, width: usize, to_the_right: bool) -> String {
    let blanks = " ".repeat(width.saturating_sub(text.width()));
    if to_the_right {
        format!("{blanks}{text}")
    } else {
        format!("{text}{blanks}")
    }
}

/// A text in lines of a width, broken at blanks; all but the first begin with blanks. A word that is longer stays whole.
pub(crate) fn wrapped(text: &str, width: usize, indent: usize) -> String {
    let indent = " ".repeat(indent);
    let options = textwrap::Options::new(width)
        .subsequent_indent(&indent)
        .break_words(false)
        .word_separator(textwrap::WordSeparator::AsciiSpace)
        .word_splitter(textwrap::WordSplitter::NoHyphenation)
        .wrap_algorithm(textwrap::WrapAlgorithm::FirstFit);
    textwrap::fill(text, options) + "\n"
}

/// A list behind its beginning, in lines of a width, broken between its entries where they fit a line; empty ones left out.
pub(crate) fn listed(
    begin: &str,
    entries: impl Iterator<Item = impl AsRef<str>>,
    width: usize,
    indent: usize,
) -> String {
    const KEPT: &str = "\u{a0}";
    let fits = |entry: &str| indent + entry.width() < width;
    let kept = |entry: &str| {
        if fits(entry) {
            entry.replace(' ', KEPT)
        } else {
            entry.to_owned()
        }
    };
    let entries: Vec<String> = entries
        .map(|entry| kept(entry.as_ref()))
        .filter(|entry| !entry.is_empty())
        .collect();
    // a line may end behind the beginning
    let end = if begin.ends_with(' ') { " " } else { "" };
    let begin = begin.strip_suffix(' ').unwrap_or(begin).replace(' ', KEPT) + end;
    wrapped(&format!("{begin}{}", entries.join(", ")), width, indent).replace(KEPT, " ")
}

/// A count with its thousands apart.
pub(crate) fn grouped(count: u64) -> String {
    let digits = count.to_string();
    let first = digits.len() % 3;
    let (first, rest) = digits.split_at(if first == 0 { 3.min(digits.len()) } else { first });
    let groups = rest.as_bytes().chunks(3).map(String::from_utf8_lossy);
    groups.fold(first.to_owned(), |text, group| text + "," + &group)
}

/// Jobs a second for people: three digits.
pub(crate) fn rate(per_second: f64) -> String {
    match per_second {
        r if r < 10.0 => format!("{r:.2} jobs/s"),
        r if r < 100.0 => format!("{r:.1} jobs/s"),
        r => format!("{r:.0} jobs/s"),
    }
}

/// A duration for people.
pub(crate) fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 10.0 => format!("{s:.1} s"),
        s if s < 120.0 => format!("{s:.0} s"),
        s if s < 7200.0 => format!("{:.0} min", s / 60.0),
        s => format!("{:.1} h", s / 3600.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_stand_to_the_right_and_nothing_is_a_dash() {
        let columns = ["connection", "speed_m_s", "peak_deflection_m"].map(str::to_owned);
        let rows = [
            vec![Cell::from("linear"), Cell::Whole(3), Cell::Number(0.14)],
            vec![Cell::from("nonlinear"), Cell::Number(6.09), Cell::Nothing],
        ];
        let expected = "connection  speed_m_s  peak_deflection_m\n\
                        linear              3             0.1400\n\
                        nonlinear        6.09                  -\n";
        assert_eq!(table(&columns, &rows), expected);
    }

    #[test]
    fn wide_letters_take_two_columns() {
        assert_eq!(
            [padded("\u{6a4b}", 4, true), padded("\u{6a4b}", 4, false)],
            ["  \u{6a4b}", "\u{6a4b}  "]
        );
        assert_eq!(padded("long", 2, true), "long");
    }

    #[test]
    fn long_texts_are_broken_at_blanks_and_indented() {
        assert_eq!(wrapped("one two  three four", 9, 2), "one two\n  three\n  four\n");
        assert_eq!(
            wrapped("#1  longer-than-that x", 9, 4),
            "#1\n    longer-than-that\n    x\n"
        );
        assert_eq!(wrapped("  a b", 80, 2), "  a b\n");
        assert_eq!(wrapped("", 80, 2), "\n");
    }

    #[test]
    fn lists_are_broken_between_their_entries() {
        let list = |width| listed("#1  ", ["gap 0.028 m", "", "load 5 N", "a b"].iter(), width, 4);
        assert_eq!(list(80), "#1  gap 0.028 m, load 5 N, a b\n");
        assert_eq!(list(24), "#1  gap 0.028 m,\n    load 5 N, a b\n");
        assert_eq!(list(10), "#1  gap\n    0.028\n    m,\n    load 5\n    N, a b\n");
    }

    #[test]
    fn thousands_stand_apart() {
        let texts = [0, 7, 999, 1000, 47_555, 123_456, 1_200_000_000].map(grouped);
        assert_eq!(texts, ["0", "7", "999", "1,000", "47,555", "123,456", "1,200,000,000"]);
    }

    #[test]
    fn durations_are_in_the_unit_that_fits() {
        assert_eq!(
            [1.25, 75.0, 600.0, 9000.0].map(duration),
            ["1.2 s", "75 s", "10 min", "2.5 h"]
        );
    }
}
