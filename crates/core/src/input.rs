//! What a refused number looks like.
//!
//! Knows how to say which key was wrong, what was found and what is allowed. Does not know files: the caller adds
//! the file's name.

use std::fmt;
use thiserror::Error;

/// What is wrong with a value of an input.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Problem {
    /// There is no value where one is required.
    Missing,
    /// The value is out of its range: a number, a count, the length of a list.
    NotAllowed,
    /// The key has no place here: another key that excludes it is given.
    Misplaced,
    /// The value is given twice.
    Repeated,
    /// The value contradicts another value.
    Conflict,
}

impl Problem {
    /// What follows the value found in a message.
    pub fn words_after_found(self) -> &'static str {
        match self {
            Self::Repeated => " twice",
            Self::Missing | Self::NotAllowed | Self::Misplaced | Self::Conflict => "",
        }
    }
}

/// What stands in the place of an allowed value.
#[derive(Debug, Clone, PartialEq)]
pub enum Found {
    /// Nothing.
    Nothing,
    /// A number, as the input has it.
    Number(f64),
    /// What no single value of the input is, in words: `a sum of 0.9`.
    Words(String),
}

impl From<f64> for Found {
    fn from(number: f64) -> Self {
        Self::Number(number)
    }
}

impl From<usize> for Found {
    fn from(count: usize) -> Self {
        Self::Number(count as f64)
    }
}

impl From<&str> for Found {
    fn from(words: &str) -> Self {
        Self::Words(words.to_owned())
    }
}

impl From<String> for Found {
    fn from(words: String) -> Self {
        Self::Words(words)
    }
}

impl fmt::Display for Found {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Nothing => f.write_str("nothing"),
            Self::Number(number) => write!(f, "{number}"),
            Self::Words(words) => f.write_str(words),
        }
    }
}

/// An input that was refused: the key's path, what is wrong with it, what was found, what is allowed.
///
/// `key` is relative to the document that was checked (`module.length_m`, `axles[1].share`).
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{key}: found {found}{}, allowed: {allowed}", problem.words_after_found())]
pub struct InvalidInput {
    /// Path of the key inside its document, segments joined by dots, list places in brackets.
    pub key: String,
    /// What is wrong.
    pub problem: Problem,
    /// What was found.
    pub found: Found,
    /// The values allowed, as text.
    pub allowed: String,
}

impl InvalidInput {
    /// An error on `key` whose value is not allowed, with what was found and what is allowed.
    pub fn new(key: impl Into<String>, found: impl Into<Found>, allowed: impl Into<String>) -> Self {
        Self {
            key: key.into(),
            problem: Problem::NotAllowed,
            found: found.into(),
            allowed: allowed.into(),
        }
    }

    /// This error with another problem.
    #[must_use]
    pub fn because(self, problem: Problem) -> Self {
        Self { problem, ..self }
    }

    /// This error with `prefix` put before its key.
    #[must_use]
    pub fn under(mut self, prefix: &str) -> Self {
        self.key = if self.key.is_empty() {
            prefix.to_owned()
        } else {
            format!("{prefix}.{}", self.key)
        };
        self
    }

    /// This error of a kind whose keys begin with `prefix`; of the only kind, which has no name, as it is.
    #[must_use]
    pub fn within_kind(self, prefix: &str) -> Self {
        if prefix.is_empty() { self } else { self.under(prefix) }
    }
}

/// Refuses what is not a finite number above zero.
///
/// # Errors
/// [`InvalidInput`] on `key`.
pub fn positive(key: &str, value: f64) -> Result<f64, InvalidInput> {
    if value.is_finite() && value > 0.0 {
        Ok(value)
    } else {
        Err(InvalidInput::new(key, value, "a finite number above 0"))
    }
}

/// Refuses what is not a finite number of at least zero.
///
/// # Errors
/// [`InvalidInput`] on `key`.
pub fn not_negative(key: &str, value: f64) -> Result<f64, InvalidInput> {
    if value.is_finite() && value >= 0.0 {
        Ok(value)
    } else {
        Err(InvalidInput::new(key, value, "a finite number of at least 0"))
    }
}

/// Refuses what lies outside `[from, to]` or is not finite.
///
/// # Errors
/// [`InvalidInput`] on `key`.
pub fn within(key: &str, value: f64, from: f64, to: f64) -> Result<f64, InvalidInput> {
    if value.is_finite() && value >= from && value <= to {
        Ok(value)
    } else {
        let [from, to] = [from, to].map(bound);
        Err(InvalidInput::new(key, value, format!("a number from {from} to {to}")))
    }
}

/// A computed number as a message tells it, to 12 significant digits: half of 8.082 less half of 0.1 is 3.991.
pub fn bound(x: f64) -> f64 {
    format!("{x:.11e}").parse().unwrap_or(x)
}

/// Places closer than this are one place `[m]`: they share a line of the mesh.
pub(crate) const SAME_PLACE_M: f64 = 1e-6;

/// Refuses a place that is the same as an earlier one of its list.
///
/// # Errors
/// [`InvalidInput`] on the place in the list `key`.
pub(crate) fn apart(key: &str, places: &[f64]) -> Result<(), InvalidInput> {
    for (i, &place) in places.iter().enumerate() {
        if places[..i].iter().any(|&other| (other - place).abs() <= SAME_PLACE_M) {
            let refused = InvalidInput::new(format!("{key}[{i}]"), place, "each place once");
            return Err(refused.because(Problem::Repeated));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_are_told_without_what_rounding_leaves() {
        let (from, to) = (-0.1 - 0.2, 20.1 + 1e-14);
        let e = within("y_m", 25.0, from, to).unwrap_err();
        assert_eq!(e.allowed, "a number from -0.3 to 20.1");
        assert_eq!([1e-300, 1.0 / 3.0, -0.0].map(bound), [1e-300, 0.333_333_333_333, 0.0]);
        assert!(bound(f64::INFINITY).is_infinite());
    }

    #[test]
    fn the_same_place_twice_is_refused_at_the_second() {
        let e = apart("y_m", &[-1.0, 1.0, 1.0 + 1e-7]).unwrap_err();
        assert_eq!((e.key.as_str(), e.allowed.as_str()), ("y_m[2]", "each place once"));
        assert!(apart("y_m", &[-1.0, 1.0, 1.001]).is_ok());
    }
}
