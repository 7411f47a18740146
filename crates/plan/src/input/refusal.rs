//! What a refused input is: which place of which file, what is wrong there, what was found, what is allowed. Its words are made
//! here and nowhere else.
//!
//! Knows the kinds of faults. Does not know how the input was read, or where in a text its place is (`span`).

use pontoon_core::input::{self, InvalidInput, Problem};
use serde_json::Value;
use std::fmt::{self, Display, Formatter};
use std::path::{Path, PathBuf};

/// An input that was refused.
#[derive(Debug, Clone, PartialEq)]
pub struct Refusal {
    /// The file that holds the path.
    pub file: PathBuf,
    /// Path of the key inside the file, `design[0].grid.speed_m_s`; empty where the file as a whole is meant. Of a missing key
    /// the path that it would have.
    pub path: String,
    /// What is wrong there.
    pub kind: RefusalKind,
    /// What was found.
    pub found: Box<FoundValue>,
    /// What is allowed, in words; empty where the kind says all.
    pub allowed: String,
    /// The nearest known name, where a name is unknown.
    pub nearest: Option<Box<str>>,
    /// The value that several axes of the block at `path` made wrong together, where no one of them did.
    pub made_wrong: Option<Box<str>>,
}

impl std::error::Error for Refusal {}

/// What is wrong with an input.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum RefusalKind {
    /// The file or folder as a whole: it cannot be read, is empty, or is another one than is needed.
    Whole,
    /// The text is no JSON.
    Syntax,
    /// A key is written twice in one object.
    RepeatedKey,
    /// A key, or one of several, is missing.
    Missing,
    /// A key is not known.
    UnknownKey,
    /// A key has no place here.
    Misplaced,
    /// A word is not known.
    UnknownWord,
    /// A value is of another type.
    WrongType,
    /// A value is out of its range, or of no form that is allowed.
    NotAllowed,
    /// A value is given twice.
    Repeated,
    /// A value contradicts another one.
    Conflict,
}

impl From<Problem> for RefusalKind {
    fn from(problem: Problem) -> Self {
        match problem {
            Problem::Missing => Self::Missing,
            Problem::NotAllowed => Self::NotAllowed,
            Problem::Misplaced => Self::Misplaced,
            Problem::Repeated => Self::Repeated,
            Problem::Conflict => Self::Conflict,
        }
    }
}

/// What stands in the place of an allowed value: a value of the file, words, both, or nothing.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct FoundValue {
    /// The value, where it is a single one of the file.
    pub value: Option<Value>,
    /// What else is to be said; what was found in words where there is no value.
    pub words: String,
}

impl FoundValue {
    /// Nothing.
    pub const NOTHING: Self = Self {
        value: None,
        words: String::new(),
    };

    /// A value of a file.
    pub fn value(value: impl Into<Value>) -> Self {
        Self {
            value: Some(super::canonical(&value.into())),
            words: String::new(),
        }
    }

    /// Adds what is to be said of it: `0.001, which makes 2e7 steps`.
    #[must_use]
    pub fn which(self, words: impl Into<String>) -> Self {
        Self {
            words: words.into(),
            ..self
        }
    }

    /// Whether there is nothing.
    pub fn is_nothing(&self) -> bool {
        *self == Self::NOTHING
    }
}

impl From<&str> for FoundValue {
    fn from(words: &str) -> Self {
        Self::NOTHING.which(words)
    }
}

impl From<String> for FoundValue {
    fn from(words: String) -> Self {
        Self::NOTHING.which(words)
    }
}

impl From<f64> for FoundValue {
    fn from(number: f64) -> Self {
        if number.is_finite() {
            Self::value(number)
        } else {
            number.to_string().into()
        }
    }
}

impl From<usize> for FoundValue {
    fn from(count: usize) -> Self {
        Self::value(count)
    }
}

impl From<&Value> for FoundValue {
    fn from(value: &Value) -> Self {
        Self::value(value.clone())
    }
}

impl From<input::Found> for FoundValue {
    fn from(found: input::Found) -> Self {
        match found {
            input::Found::Nothing => Self::NOTHING,
            input::Found::Number(number) => number.into(),
            input::Found::Words(words) => words.into(),
        }
    }
}

/// Names beyond which a message does not list what is known.
const MOST_LISTED: usize = 30;

impl Refusal {
    /// A refusal of the value at `path` in `file`; of the file as a whole where the path is empty, of a missing key where
    /// nothing was found.
    pub fn new(file: &Path, path: impl Into<String>, found: impl Into<FoundValue>, allowed: impl Into<String>) -> Self {
        let (path, found) = (path.into(), found.into());
        let kind = match (path.is_empty(), found.is_nothing()) {
            (true, _) => RefusalKind::Whole,
            (false, true) => RefusalKind::Missing,
            (false, false) => RefusalKind::NotAllowed,
        };
        Self {
            file: file.to_owned(),
            path,
            kind,
            found: Box::new(found),
            allowed: allowed.into(),
            nearest: None,
            made_wrong: None,
        }
    }

    /// A refusal of a key that is required and missing; `path` is the one that it would have.
    pub fn missing(file: &Path, path: impl Into<String>) -> Self {
        Self::new(file, path, FoundValue::NOTHING, "")
    }

    /// Makes it a refusal of another kind.
    #[must_use]
    pub fn because(self, kind: RefusalKind) -> Self {
        Self { kind, ..self }
    }

    /// A refusal of a key that is not among `known`.
    pub fn unknown_key(file: &Path, path: impl Into<String>, key: &str, known: &[String]) -> Self {
        Self::unknown(file, path, key, known).because(RefusalKind::UnknownKey)
    }

    /// A refusal of a word that is not among `known`.
    pub fn unknown(file: &Path, path: impl Into<String>, word: &str, known: &[String]) -> Self {
        let allowed = if known.len() <= MOST_LISTED {
            known.join(", ")
        } else {
            format!("one of {} names", known.len())
        };
        Self {
            kind: RefusalKind::UnknownWord,
            nearest: nearest(word, known).map(String::into_boxed_str),
            ..Self::new(file, path, FoundValue::value(word), allowed)
        }
    }

    /// A number that the mechanics refused, its key put under `prefix`.
    pub fn of(file: &Path, prefix: &str, error: InvalidInput) -> Self {
        let path = match (prefix.is_empty(), error.key.is_empty()) {
            (true, _) => error.key,
            (false, true) => prefix.to_owned(),
            (false, false) => format!("{prefix}.{}", error.key),
        };
        Self::new(file, path, error.found, error.allowed).because(error.problem.into())
    }
}

impl Display for Refusal {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{}: ", self.file.display())?;
        if !self.path.is_empty() {
            write!(f, "{}", self.path)?;
            if let Some(of) = &self.made_wrong {
                write!(f, " ({of})")?;
            }
            f.write_str(": ")?;
        }
        f.write_str(&self.fault())?;
        if let Some(nearest) = &self.nearest {
            write!(f, " (nearest known: {nearest})")?;
        }
        match self.allowed.as_str() {
            "" => Ok(()),
            allowed => write!(f, ", allowed: {allowed}"),
        }
    }
}

impl Refusal {
    /// What is wrong, without the place and without what is allowed: what a person needs first.
    pub fn fault(&self) -> String {
        let found = &self.found;
        match self.kind {
            RefusalKind::Missing if found.is_nothing() => {
                let required = if self.allowed.is_empty() { " (required)" } else { "" };
                format!("missing key `{}`{required}", self.name())
            }
            RefusalKind::UnknownKey => format!("found unknown key `{}`", name_of(found)),
            RefusalKind::UnknownWord => format!("found unknown {}", found.text()),
            RefusalKind::RepeatedKey => {
                format!("found the key `{}` twice ({})", name_of(found), found.words)
            }
            RefusalKind::Repeated => format!("found {} twice", found.text()),
            RefusalKind::Whole
            | RefusalKind::Syntax
            | RefusalKind::Missing
            | RefusalKind::Misplaced
            | RefusalKind::WrongType
            | RefusalKind::NotAllowed
            | RefusalKind::Conflict => format!("found {}", found.text()),
        }
    }

    /// The last key of the path.
    pub fn name(&self) -> &str {
        self.path.rsplit('.').next().unwrap_or_default()
    }
}

impl FoundValue {
    /// What was found, in words.
    pub fn text(&self) -> String {
        match &self.value {
            Some(value) => format!("{value}{}", behind(self)),
            None if self.words.is_empty() => "nothing".to_owned(),
            None => self.words.clone(),
        }
    }
}

/// What is said of a value behind it.
fn behind(found: &FoundValue) -> String {
    match found.words.as_str() {
        "" => String::new(),
        words => format!(", {words}"),
    }
}

/// A name that was found, without the quotes of JSON.
fn name_of(found: &FoundValue) -> String {
    match &found.value {
        Some(Value::String(name)) => name.clone(),
        _ => found.text(),
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
    fn a_number_keeps_its_path_under_the_prefix() {
        let error = InvalidInput::new("axles[1].share", -0.5, "above 0");
        let refused = Refusal::of(Path::new("s.json"), "vehicle", error);
        assert_eq!(refused.path, "vehicle.axles[1].share");
        assert_eq!(refused.found.value, Some(Value::from(-0.5)));
    }

    #[test]
    fn a_refusal_without_a_path_is_of_the_whole_file_and_one_of_nothing_of_a_missing_key() {
        let kind = |path: &str, found: FoundValue| Refusal::new(Path::new("s.json"), path, found, "").kind;
        assert_eq!(kind("", "no file".into()), RefusalKind::Whole);
        assert_eq!(kind("name", FoundValue::NOTHING), RefusalKind::Missing);
        assert_eq!(kind("name", "x".into()), RefusalKind::NotAllowed);
    }

    #[test]
    fn numbers_are_values_as_a_file_would_write_them() {
        assert_eq!(FoundValue::from(3.0).value, Some(Value::from(3)));
        assert_eq!(FoundValue::from(f64::NAN).words, "NaN");
    }

    fn told(refusal: &Refusal) -> String {
        refusal.to_string()
    }

    #[test]
    fn a_message_says_first_what_a_person_needs() {
        let file = Path::new("b.json");
        let known = ["modules".to_owned(), "module".to_owned(), "name".to_owned()];
        for (refusal, text) in [
            (
                Refusal::missing(file, "analysis.kind"),
                "b.json: analysis.kind: missing key `kind` (required)",
            ),
            (
                Refusal::new(
                    file,
                    "value.expected",
                    FoundValue::NOTHING,
                    "a number; only a record needs none",
                ),
                "b.json: value.expected: missing key `expected`, allowed: a number; only a record needs none",
            ),
            (
                Refusal::unknown_key(file, "modles", "modles", &known),
                "b.json: modles: found unknown key `modles` (nearest known: modules), allowed: modules, module, name",
            ),
            (
                Refusal::unknown(file, "a", "moddule", &known),
                "b.json: a: found unknown \"moddule\" (nearest known: module), allowed: modules, module, name",
            ),
            (
                Refusal::new(
                    file,
                    "a",
                    FoundValue::value(1e-3).which("which makes 2e7 steps"),
                    "fewer",
                ),
                "b.json: a: found 0.001, which makes 2e7 steps, allowed: fewer",
            ),
            (
                Refusal::new(file, "a[1]", FoundValue::value("x"), "each name once").because(RefusalKind::Repeated),
                "b.json: a[1]: found \"x\" twice, allowed: each name once",
            ),
            (
                Refusal {
                    made_wrong: Some("bridge.module.mesh".into()),
                    ..Refusal::new(file, "design[0].grid", "9 GiB", "at most 8 GiB")
                },
                "b.json: design[0].grid (bridge.module.mesh): found 9 GiB, allowed: at most 8 GiB",
            ),
            (
                Refusal::new(file, "", "an empty file", "a JSON file"),
                "b.json: found an empty file, allowed: a JSON file",
            ),
        ] {
            assert_eq!(told(&refusal), text);
        }
    }
}
