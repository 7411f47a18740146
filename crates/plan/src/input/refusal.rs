//! What a refused input looks like.
//!
//! Knows how to say which key of which file was wrong, what was found, what is allowed and what may have been meant.
//! Does not know how the input was read.

use pontoon_core::input::InvalidInput;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// An input that was refused. One message says all of it.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{}: {}found {found}, allowed: {allowed}{}", file.display(), key_text(key), nearest_text(nearest.as_deref()))]
pub struct Refusal {
    /// The file that holds the key.
    pub file: PathBuf,
    /// Path of the key inside the file; empty where the file as a whole is meant.
    pub key: String,
    /// What was found.
    pub found: String,
    /// What is allowed.
    pub allowed: String,
    /// The nearest known name, where a name is unknown.
    pub nearest: Option<String>,
}

fn key_text(key: &str) -> String {
    if key.is_empty() {
        String::new()
    } else {
        format!("{key}: ")
    }
}

fn nearest_text(nearest: Option<&str>) -> String {
    nearest.map(|n| format!("; nearest known: {n}")).unwrap_or_default()
}

impl Refusal {
    /// A refusal of `key` in `file`.
    pub fn new(file: &Path, key: impl Into<String>, found: impl ToString, allowed: impl Into<String>) -> Self {
        Self {
            file: file.to_owned(),
            key: key.into(),
            found: found.to_string(),
            allowed: allowed.into(),
            nearest: None,
        }
    }

    /// A refusal of a name that is not among `known`.
    pub fn unknown(file: &Path, key: impl Into<String>, name: &str, known: &[String]) -> Self {
        let allowed = if known.len() <= 30 {
            known.join(", ")
        } else {
            format!("one of {} names", known.len())
        };
        Self {
            nearest: nearest(name, known),
            ..Self::new(file, key, format!("unknown '{name}'"), allowed)
        }
    }

    /// A number that the mechanics refused, its key put under `prefix`.
    pub fn of(file: &Path, prefix: &str, error: InvalidInput) -> Self {
        let key = match (prefix.is_empty(), error.key.is_empty()) {
            (true, _) => error.key,
            (false, true) => prefix.to_owned(),
            (false, false) => format!("{prefix}.{}", error.key),
        };
        Self::new(file, key, error.found, error.allowed)
    }
}

/// Longest name that a known one may be near to; to compare a longer one with all would take long.
const LONGEST_NAME: usize = 200;

/// The known name nearest to `name`, by the Damerau-Levenshtein distance over the longer length (the first of equals);
/// none for a name longer than any that is known can be.
pub fn nearest(name: &str, known: &[String]) -> Option<String> {
    if name.len() > LONGEST_NAME {
        return None;
    }
    let mut best: Option<(f64, &String)> = None;
    for candidate in known {
        let likeness = strsim::normalized_damerau_levenshtein(name, candidate);
        if best.is_none_or(|(b, _)| likeness > b) {
            best = Some((likeness, candidate));
        }
    }
    best.map(|(_, candidate)| candidate.clone())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn message_holds_file_key_found_allowed_and_nearest() {
        let known = ["modules".to_owned(), "module".to_owned(), "name".to_owned()];
        let text = Refusal::unknown(Path::new("b.json"), "modles", "modles", &known).to_string();
        assert_eq!(
            text,
            "b.json: modles: found unknown 'modles', allowed: modules, module, name; nearest known: modules"
        );
    }

    #[test]
    fn a_number_keeps_its_path_under_the_prefix() {
        let error = InvalidInput::new("axles[1].share", -0.5, "above 0");
        assert_eq!(
            Refusal::of(Path::new("s.json"), "vehicle", error).key,
            "vehicle.axles[1].share"
        );
    }
}
