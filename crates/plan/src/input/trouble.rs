//! What a type does not take: the way to the place, the kind of the fault, what stands there, what is allowed.
//!
//! Knows the words for what a type asks for. Does not know how a text is read.

use super::path::{PathStep, join, join_steps};
use super::refusal::{FoundValue, Refusal, RefusalKind};
use serde::de::Unexpected;
use serde_json::Value;
use std::fmt::{self, Display};
use std::path::Path;

/// The type that a place asks for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Expected {
    Number,
    Whole,
    NotNegativeWhole,
    Flag,
    Word,
    Null,
    List,
    ListOf(usize),
    Object,
    SingleKey,
}

impl Display for Expected {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Number => "a number",
            Self::Whole => "a whole number",
            Self::NotNegativeWhole => "a whole number of at least 0",
            Self::Flag => "true or false",
            Self::Word => "a text",
            Self::Null => "null",
            Self::List => "a list",
            Self::ListOf(length) => return write!(f, "a list of length {length}"),
            Self::Object => "an object",
            Self::SingleKey => "an object with a single key",
        })
    }
}

/// What a type does not take.
#[derive(Debug)]
pub(super) struct Trouble {
    /// The way to it, from the inside out.
    path: Vec<PathStep>,
    kind: RefusalKind,
    found: Box<FoundValue>,
    allowed: String,
    /// Names that are known, where one is not.
    known: &'static [&'static str],
}

impl Trouble {
    pub(super) fn new(kind: RefusalKind, found: impl Into<FoundValue>, allowed: impl Display) -> Self {
        Self {
            path: Vec::new(),
            kind,
            found: Box::new(found.into()),
            allowed: allowed.to_string(),
            known: &[],
        }
    }

    pub(super) fn unknown(kind: RefusalKind, name: &str, known: &'static [&'static str]) -> Self {
        Self {
            known,
            ..Self::new(kind, FoundValue::value(name), "")
        }
    }

    pub(super) fn under(mut self, step: PathStep) -> Self {
        self.path.push(step);
        self
    }

    /// Makes it the trouble of a key whose name is none of those that are known.
    pub(super) fn of_key(self, key: &str) -> Self {
        Self {
            kind: RefusalKind::UnknownKey,
            ..self.under(PathStep::Key(key.to_owned()))
        }
    }

    pub(super) fn refusal(mut self, file: &Path, prefix: &str) -> Refusal {
        self.path.reverse();
        let path = join(prefix, &join_steps(&self.path));
        let known: Vec<String> = self.known.iter().map(|&name| name.to_owned()).collect();
        match (self.kind, self.found.value.as_ref().and_then(Value::as_str)) {
            (RefusalKind::UnknownKey, Some(name)) => Refusal::unknown_key(file, path, name, &known),
            (RefusalKind::UnknownWord, Some(name)) => Refusal::unknown(file, path, name, &known),
            _ => Refusal::new(file, path, *self.found, self.allowed).because(self.kind),
        }
    }
}

impl Display for Trouble {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "found {}, allowed: {}", self.found.text(), self.allowed)
    }
}

impl std::error::Error for Trouble {}

impl serde::de::Error for Trouble {
    fn custom<T: Display>(said: T) -> Self {
        Self::new(
            RefusalKind::NotAllowed,
            said.to_string(),
            "a document after `pontoon schema`",
        )
    }

    fn invalid_type(unexpected: Unexpected<'_>, expected: &dyn serde::de::Expected) -> Self {
        Self::new(RefusalKind::WrongType, found(&unexpected), expected)
    }

    fn invalid_value(unexpected: Unexpected<'_>, expected: &dyn serde::de::Expected) -> Self {
        Self::new(RefusalKind::NotAllowed, found(&unexpected), expected)
    }

    fn invalid_length(length: usize, expected: &dyn serde::de::Expected) -> Self {
        Self::new(RefusalKind::NotAllowed, format!("a list of length {length}"), expected)
    }

    fn unknown_variant(variant: &str, expected: &'static [&'static str]) -> Self {
        Self::unknown(RefusalKind::UnknownWord, variant, expected)
    }

    fn unknown_field(field: &str, expected: &'static [&'static str]) -> Self {
        Self::unknown(RefusalKind::UnknownKey, field, expected).under(PathStep::Key(field.to_owned()))
    }

    fn missing_field(field: &'static str) -> Self {
        Self::new(RefusalKind::Missing, FoundValue::NOTHING, "").under(PathStep::Key(field.to_owned()))
    }
}

/// What a type was given and does not take.
fn found(unexpected: &Unexpected<'_>) -> FoundValue {
    match *unexpected {
        Unexpected::Bool(flag) => FoundValue::value(flag),
        Unexpected::Unsigned(count) => FoundValue::value(count),
        Unexpected::Signed(number) => FoundValue::value(number),
        Unexpected::Float(number) => number.into(),
        Unexpected::Str(word) => FoundValue::value(word),
        Unexpected::Unit | Unexpected::Option => FoundValue::value(Value::Null),
        Unexpected::Seq => "a list".into(),
        Unexpected::Map => "an object".into(),
        Unexpected::Other(words) => words.into(),
        ref other => other.to_string().into(),
    }
}
