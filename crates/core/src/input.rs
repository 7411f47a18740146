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
