//! Numbers of a text that a BEM code wrote, with the lines they stand on.
//!
//! Knows how Fortran writes numbers and what a refused one looks like. Does not know what the numbers mean.

use pontoon_plan::input::{FoundValue, Refusal};
use std::path::Path;

/// The place of a line, from 1.
pub(crate) fn line_place(line: usize) -> String {
    format!("line {line}")
}

/// Refuses a text whose last line has no end: the codes write whole lines.
///
/// # Errors
/// [`Refusal`] of the last line.
pub(crate) fn check_last_line(file: &Path, text: &str) -> Result<(), Refusal> {
    match text.lines().last() {
        Some(last) if !text.ends_with('\n') => {
            let place = line_place(text.lines().count());
            let found = FoundValue::value(last).which("without a line end: the file was cut off");
            Err(Refusal::new(file, place, found, "whole lines"))
        }
        _ => Ok(()),
    }
}

/// A finite number; Fortran's exponents may be written with a D.
///
/// # Errors
/// [`Refusal`] of the line.
pub(crate) fn number(file: &Path, line: usize, word: &str) -> Result<f64, Refusal> {
    let number = parsed(word).filter(|number| number.is_finite());
    number.ok_or_else(|| Refusal::new(file, line_place(line), FoundValue::value(word), "a finite number"))
}

/// A number, finite or not; none of any other word.
pub(crate) fn parsed(word: &str) -> Option<f64> {
    word.parse().ok().or_else(|| word.replace(['D', 'd'], "E").parse().ok())
}

/// A whole number from 1 to `most`.
///
/// # Errors
/// [`Refusal`] of the line.
pub(crate) fn whole(file: &Path, line: usize, word: &str, most: usize) -> Result<usize, Refusal> {
    let number = word.parse().ok().filter(|number| (1..=most).contains(number));
    let allowed = || format!("a whole number from 1 to {most}");
    number.ok_or_else(|| Refusal::new(file, line_place(line), FoundValue::value(word), allowed()))
}

/// The words of a text, read one after the other however its lines are wrapped.
pub(crate) struct Words<'a> {
    file: &'a Path,
    words: std::vec::IntoIter<(usize, &'a str)>,
    last_line: usize,
}

impl<'a> Words<'a> {
    /// The words of lines with their numbers from 1.
    pub(crate) fn new(file: &'a Path, lines: impl Iterator<Item = (usize, &'a str)>) -> Self {
        let words: Vec<(usize, &str)> = lines
            .flat_map(|(line, text)| text.split_whitespace().map(move |word| (line, word)))
            .collect();
        Self {
            file,
            last_line: words.last().map_or(1, |(line, _)| *line),
            words: words.into_iter(),
        }
    }

    /// How many are left.
    pub(crate) fn left(&self) -> usize {
        self.words.len()
    }

    /// The next number with its line.
    ///
    /// # Errors
    /// [`Refusal`] of the line, also where there is none left.
    pub(crate) fn next(&mut self, what: &str) -> Result<(usize, f64), Refusal> {
        let Some((line, word)) = self.words.next() else {
            let place = line_place(self.last_line);
            let found = "the end of the table: the file was cut off";
            return Err(Refusal::new(self.file, place, found, what));
        };
        Ok((line, number(self.file, line, word)?))
    }

    /// Refuses words that are left.
    ///
    /// # Errors
    /// [`Refusal`] of the first line that has one.
    pub(crate) fn end(mut self, what: &str) -> Result<(), Refusal> {
        self.words.next().map_or(Ok(()), |(line, word)| {
            Err(Refusal::new(self.file, line_place(line), FoundValue::value(word), what))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_read_as_fortran_writes_them_and_refused_with_their_line() {
        let file = Path::new("f.dat");
        assert_eq!(number(file, 1, "1.5D+02").unwrap(), 150.0);
        for word in ["NaN", "Infinity", "1.0E999", "*****", "1.0-100"] {
            let e = number(file, 7, word).unwrap_err();
            assert_eq!(
                (e.path.as_str(), e.allowed.as_str()),
                ("line 7", "a finite number"),
                "{e}"
            );
        }
        assert!(whole(file, 1, "0", 5).is_err() && whole(file, 1, "6", 5).is_err());
    }

    #[test]
    fn a_cut_text_is_refused_at_its_last_line() {
        let file = Path::new("f.dat");
        assert!(check_last_line(file, "1 2\n").is_ok());
        assert_eq!(check_last_line(file, "1 2\n3").unwrap_err().path, "line 2");
        let mut words = Words::new(file, "1\n2 3\n".lines().zip(1..).map(|(text, line)| (line, text)));
        assert_eq!((words.next("").unwrap(), words.left()), ((1, 1.0), 2));
        assert_eq!((words.next("").unwrap(), words.next("").unwrap()), ((2, 2.0), (2, 3.0)));
        assert_eq!(words.next("a number").unwrap_err().path, "line 2");
    }
}
