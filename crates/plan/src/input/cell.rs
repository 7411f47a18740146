//! A value of an axis or of a table's cell, as it is computed with: no number goes by way of a text or a tree.
//!
//! Knows numbers, words, yes and no, nothing, and whatever else a file may write. Does not know columns.

use super::strict::canonical;
use serde::{Serialize, Serializer};
use serde_json::Value;
use std::borrow::Cow;
use std::fmt;
use std::hash::{Hash, Hasher};
use std::sync::Arc;

/// A value. Numbers are equal whether they are written whole or not.
#[derive(Debug, Clone, Default)]
pub enum Cell<'a> {
    /// Nothing.
    #[default]
    Nothing,
    /// A whole number.
    Whole(i64),
    /// A number.
    Number(f64),
    /// Yes or no.
    Flag(bool),
    /// A word.
    Word(Cow<'a, str>),
    /// A list or an object.
    Tree(Arc<Value>),
}

impl<'a> Cell<'a> {
    /// The value at a place of a document.
    pub fn of(value: &'a Value) -> Self {
        match value {
            Value::Null => Self::Nothing,
            Value::Bool(yes) => Self::Flag(*yes),
            Value::Number(number) => match (number.as_i64(), number.as_f64()) {
                (Some(whole), _) => Self::Whole(whole),
                (None, Some(x)) => Self::Number(x),
                (None, None) => Self::Nothing,
            },
            Value::String(word) => Self::Word(Cow::Borrowed(word)),
            tree => Self::Tree(Arc::new(canonical(tree))),
        }
    }

    /// The value of a number as a file would write it: a whole one without a point.
    pub fn written(x: f64) -> Self {
        if x.fract() == 0.0 && x.abs() < 9.0e15 {
            Self::Whole(x as i64)
        } else {
            Self::Number(x)
        }
    }

    /// The value with a whole number written as one.
    #[must_use]
    pub fn canonical(self) -> Self {
        match self {
            Self::Number(x) => Self::written(x),
            other => other,
        }
    }

    /// The number; none of anything else.
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::Whole(x) => Some(*x as f64),
            Self::Number(x) => Some(*x),
            _ => None,
        }
    }

    /// The word; none of anything else.
    pub fn word(&self) -> Option<&str> {
        match self {
            Self::Word(word) => Some(word),
            _ => None,
        }
    }

    /// Whether there is nothing.
    pub fn is_nothing(&self) -> bool {
        matches!(self, Self::Nothing)
    }

    /// The value, borrowed.
    pub fn borrowed(&'a self) -> Self {
        match self {
            Self::Word(word) => Self::Word(Cow::Borrowed(word)),
            other => other.clone(),
        }
    }

    /// The value, owned.
    pub fn owned(&self) -> Cell<'static> {
        match self {
            Self::Nothing => Cell::Nothing,
            Self::Whole(x) => Cell::Whole(*x),
            Self::Number(x) => Cell::Number(*x),
            Self::Flag(yes) => Cell::Flag(*yes),
            Self::Word(word) => Cell::Word(Cow::Owned(word.to_string())),
            Self::Tree(tree) => Cell::Tree(Arc::clone(tree)),
        }
    }

    /// The value as a document holds it.
    pub fn value(&self) -> Value {
        match self {
            Self::Nothing => Value::Null,
            Self::Whole(x) => (*x).into(),
            Self::Number(x) => (*x).into(),
            Self::Flag(yes) => (*yes).into(),
            Self::Word(word) => word.as_ref().into(),
            Self::Tree(tree) => tree.as_ref().clone(),
        }
    }

    /// A word as it is, nothing as no text, anything else as JSON.
    pub fn text(&self) -> String {
        match self {
            Self::Nothing => String::new(),
            Self::Word(word) => word.to_string(),
            other => other.to_string(),
        }
    }
}

impl From<&Value> for Cell<'static> {
    fn from(value: &Value) -> Self {
        Cell::of(value).owned()
    }
}

impl From<f64> for Cell<'_> {
    fn from(x: f64) -> Self {
        Self::Number(x)
    }
}

impl From<usize> for Cell<'_> {
    fn from(count: usize) -> Self {
        i64::try_from(count).map_or(Self::Number(count as f64), Self::Whole)
    }
}

impl From<bool> for Cell<'_> {
    fn from(yes: bool) -> Self {
        Self::Flag(yes)
    }
}

impl<'a> From<&'a str> for Cell<'a> {
    fn from(word: &'a str) -> Self {
        Self::Word(Cow::Borrowed(word))
    }
}

impl<'a, T: Into<Cell<'a>>> From<Option<T>> for Cell<'a> {
    fn from(value: Option<T>) -> Self {
        value.map_or(Self::Nothing, Into::into)
    }
}

impl PartialEq for Cell<'_> {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Nothing, Self::Nothing) => true,
            (Self::Flag(a), Self::Flag(b)) => a == b,
            (Self::Word(a), Self::Word(b)) => a == b,
            (Self::Tree(a), Self::Tree(b)) => a == b,
            (a, b) => match (a.number(), b.number()) {
                (Some(a), Some(b)) => (a + 0.0).to_bits() == (b + 0.0).to_bits(),
                _ => false,
            },
        }
    }
}

impl Eq for Cell<'_> {}

impl Hash for Cell<'_> {
    fn hash<H: Hasher>(&self, state: &mut H) {
        match self {
            Self::Nothing => state.write_u8(0),
            Self::Whole(_) | Self::Number(_) => {
                state.write_u8(1);
                // 0 and -0 are one number
                state.write_u64((self.number().unwrap_or_default() + 0.0).to_bits());
            }
            Self::Flag(yes) => {
                state.write_u8(2);
                yes.hash(state);
            }
            Self::Word(word) => {
                state.write_u8(3);
                word.hash(state);
            }
            Self::Tree(tree) => {
                state.write_u8(4);
                tree.to_string().hash(state);
            }
        }
    }
}

/// The value as JSON.
impl fmt::Display for Cell<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Whole(x) => write!(f, "{x}"),
            Self::Flag(yes) => write!(f, "{yes}"),
            other => write!(f, "{}", other.value()),
        }
    }
}

impl Serialize for Cell<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Nothing => serializer.serialize_unit(),
            Self::Whole(x) => serializer.serialize_i64(*x),
            Self::Number(x) => serializer.serialize_f64(*x),
            Self::Flag(yes) => serializer.serialize_bool(*yes),
            Self::Word(word) => serializer.serialize_str(word),
            Self::Tree(tree) => tree.serialize(serializer),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;
    use std::collections::HashSet;

    #[test]
    fn numbers_are_equal_however_they_are_written() {
        let cells = [Cell::Whole(3), Cell::Number(3.0), Cell::from(&json!(3))];
        assert_eq!(cells.iter().collect::<HashSet<_>>().len(), 1);
        assert_eq!(Cell::Number(-0.0), Cell::Whole(0));
        assert_ne!(Cell::Number(0.1), Cell::Number(0.1 + 1e-16));
        assert_ne!(Cell::from("3"), Cell::Whole(3));
        assert_eq!(Cell::Number(3.0).canonical().to_string(), "3");
        assert_eq!(Cell::Number(3.0).to_string(), "3.0");
    }

    #[test]
    fn a_value_of_a_file_is_written_as_it_was_read() {
        for value in [
            json!(null),
            json!(7),
            json!(-7),
            json!(0.5),
            json!(true),
            json!("a\"b"),
            json!([1, 2.5]),
            json!({"a": [1]}),
        ] {
            let cell = Cell::from(&value);
            assert_eq!(cell.value(), value);
            assert_eq!(cell.to_string(), value.to_string());
            assert_eq!(serde_json::to_value(&cell).unwrap(), value);
            assert_eq!(cell.owned(), cell.borrowed());
        }
    }
}
