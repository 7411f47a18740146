//! What a refused number looks like.
//!
//! Knows how to say which key was wrong, what was found and what is allowed. Does not know files: the caller adds
//! the file's name.

use thiserror::Error;

/// An input that was refused: the key's path, what was found, what is allowed.
///
/// `key` is relative to the document that was checked (`module.length_m`, `axles[1].share`).
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{key}: found {found}, allowed: {allowed}")]
pub struct InvalidInput {
    /// Path of the key inside its document, segments joined by dots, list places in brackets.
    pub key: String,
    /// The value found, as text.
    pub found: String,
    /// The values allowed, as text.
    pub allowed: String,
}

impl InvalidInput {
    /// An error on `key` with what was found and what is allowed.
    pub fn new(key: impl Into<String>, found: impl ToString, allowed: impl Into<String>) -> Self {
        Self {
            key: key.into(),
            found: found.to_string(),
            allowed: allowed.into(),
        }
    }

    /// The same error with `prefix` put before its key.
    #[must_use]
    pub fn under(mut self, prefix: &str) -> Self {
        self.key = if self.key.is_empty() {
            prefix.to_owned()
        } else {
            format!("{prefix}.{}", self.key)
        };
        self
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
        Err(InvalidInput::new(key, value, format!("a number from {from} to {to}")))
    }
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
            let found = format!("{place} twice");
            return Err(InvalidInput::new(format!("{key}[{i}]"), found, "each place once"));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_place_twice_is_refused_at_the_second() {
        let e = apart("y_m", &[-1.0, 1.0, 1.0 + 1e-7]).unwrap_err();
        assert_eq!((e.key.as_str(), e.allowed.as_str()), ("y_m[2]", "each place once"));
        assert!(apart("y_m", &[-1.0, 1.0, 1.001]).is_ok());
    }
}
