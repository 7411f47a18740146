//! A text made into the canonical text of its document, strictly: nothing that a reader might drop or repair passes.
//!
//! Knows that a key written twice, a number out of range and a NaN are faults, and where in the text they are. Does not know
//! keys. No tree is built: a document of any size costs its two texts.

use super::path::PathStep;
use serde::de::{DeserializeSeed, Deserializer, Error as _, MapAccess, SeqAccess, Visitor};
use serde_json::{Number, Value};
use std::collections::HashSet;
use std::fmt::{self, Write};
use std::ops::Range;

/// Lists and objects within each other that the reader goes into.
pub(super) const MOST_LEVELS: usize = 127;

/// What makes a text no JSON document.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct SyntaxFault {
    /// Its bytes; none at the end of a text that ends too early.
    pub(super) bytes: Range<usize>,
    /// What it is.
    pub(super) kind: FaultKind,
    /// The way to the value that could not be read.
    pub(super) path: Vec<PathStep>,
}

/// What is wrong with a text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum FaultKind {
    /// Lists and objects are nested too deep.
    TooDeep,
    /// A key is there twice in one object; the second stands at the fault's bytes.
    RepeatedKey(String),
    /// A number is not finite.
    NotFinite,
    /// It is no JSON, in the reader's words.
    Syntax(String),
}

/// The canonical text of a document: no blanks, whole numbers written as whole numbers (`3.0` as `3`, `-0.0` as `0`), so that
/// equal documents have equal texts.
pub(super) fn canonical_of(text: &str) -> Result<String, SyntaxFault> {
    let (mut to, mut state) = (String::with_capacity(text.len()), FaultState::default());
    let mut reader = serde_json::Deserializer::from_str(text);
    let root = Copied {
        to: &mut to,
        state: &mut state,
        level: 0,
    };
    let copied = root.deserialize(&mut reader).and_then(|()| reader.end());
    match copied {
        Ok(()) => Ok(to),
        Err(error) => Err(SyntaxFault::new(text, &error, state)),
    }
}

/// What is wrong with a text, if anything is. An empty one has no place to show.
pub(super) fn fault(text: &str) -> Option<SyntaxFault> {
    canonical_of(text).err().filter(|_| !text.trim().is_empty())
}

/// What is known of a fault before its place is.
#[derive(Debug, Default)]
struct FaultState {
    /// The way to the value at fault, from the inside out.
    path: Vec<PathStep>,
    /// The key that was there before.
    repeated: Option<String>,
    /// Level of the innermost value that could not be read.
    level: Option<usize>,
}

impl SyntaxFault {
    fn new(text: &str, error: &serde_json::Error, state: FaultState) -> Self {
        let lines = text.split_inclusive('\n');
        let before: usize = lines.take(error.line().saturating_sub(1)).map(str::len).sum();
        let (from, to) = token_in(text.get(before..).unwrap_or_default(), error.column());
        let end = text.trim_end().len();
        let bytes = match &state.repeated {
            // the reader has just read the second of the two
            Some(name) => {
                let read = text.get(..text.floor_char_boundary(before + error.column() + 1));
                let second = read.and_then(|read| last_string(read, name));
                second.unwrap_or(before + from..before + to)
            }
            None if error.is_eof() => end..end,
            None => before + from..before + to,
        };
        let token = text.get(bytes.clone()).unwrap_or_default();
        let kind = match state.repeated {
            Some(name) => FaultKind::RepeatedKey(name),
            None if state.level == Some(MOST_LEVELS) && ["[", "{"].contains(&token) => FaultKind::TooDeep,
            None if is_not_finite(token) => FaultKind::NotFinite,
            None => {
                let place = format!(" at line {} column {}", error.line(), error.column());
                let said = error.to_string();
                FaultKind::Syntax(said.strip_suffix(&place).unwrap_or(&said).to_owned())
            }
        };
        let path = state.path.into_iter().rev().collect();
        Self { bytes, kind, path }
    }
}

/// The bytes of the string that a text ends with, if it is this one, however it is written.
fn last_string(text: &str, string: &str) -> Option<Range<usize>> {
    let end = text.rfind('"')? + 1;
    let begins = text[..end - 1].rmatch_indices('"').map(|(at, _)| at);
    let is_it = |at: &usize| serde_json::from_str::<String>(&text[*at..end]).is_ok_and(|read| read == string);
    begins
        .take_while(|at| end - at <= 6 * string.len() + 2)
        .find(is_it)
        .map(|at| at..end)
}

/// Whether a token is a number beyond the finite ones, or a name of one.
fn is_not_finite(token: &str) -> bool {
    let bare = token.trim_start_matches(['-', '+']).to_ascii_lowercase();
    bare.starts_with("nan") || bare.starts_with("inf") || token.parse::<f64>().is_ok_and(f64::is_infinite)
}

/// From where to where in a line the bare word or number is whose byte is at a column from 1; else the character there.
fn token_in(line: &str, column: usize) -> (usize, usize) {
    let bare = |b: u8| b.is_ascii_alphanumeric() || matches!(b, b'.' | b'+' | b'-' | b'_');
    let bytes = line.as_bytes();
    let mut from = column.saturating_sub(1).min(bytes.len());
    let mut to = from;
    while from > 0 && bare(bytes[from - 1]) {
        from -= 1;
    }
    while to < bytes.len() && bare(bytes[to]) {
        to += 1;
    }
    if from == to {
        from = line.floor_char_boundary(from);
        let here = line[from..].chars().next().filter(|c| !c.is_control());
        to = from + here.map_or(0, char::len_utf8);
    }
    (from, to)
}

/// A value on its way from one text to the other.
struct Copied<'a> {
    to: &'a mut String,
    state: &'a mut FaultState,
    /// Lists and objects that it is in.
    level: usize,
}

impl Copied<'_> {
    fn inner(&mut self) -> Copied<'_> {
        Copied {
            to: self.to,
            state: self.state,
            level: self.level + 1,
        }
    }
}

impl<'de> DeserializeSeed<'de> for Copied<'_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(mut self, deserializer: D) -> Result<(), D::Error> {
        let level = self.level;
        let copied = deserializer.deserialize_any(CopyVisitor(&mut self));
        if copied.is_err() {
            self.state.level.get_or_insert(level);
        }
        copied
    }
}

struct CopyVisitor<'a, 'b>(&'a mut Copied<'b>);

impl<'de> Visitor<'de> for CopyVisitor<'_, '_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a JSON value")
    }

    fn visit_unit<E>(self) -> Result<(), E> {
        self.0.to.push_str("null");
        Ok(())
    }

    fn visit_bool<E: serde::de::Error>(self, v: bool) -> Result<(), E> {
        write!(self.0.to, "{v}").map_err(E::custom)
    }

    fn visit_i64<E: serde::de::Error>(self, v: i64) -> Result<(), E> {
        write!(self.0.to, "{v}").map_err(E::custom)
    }

    fn visit_u64<E: serde::de::Error>(self, v: u64) -> Result<(), E> {
        write!(self.0.to, "{v}").map_err(E::custom)
    }

    fn visit_f64<E: serde::de::Error>(self, v: f64) -> Result<(), E> {
        let written = match whole(v) {
            Some(whole) => write!(self.0.to, "{whole}"),
            None => match Number::from_f64(v) {
                Some(number) => write!(self.0.to, "{number}"),
                None => return Err(E::custom("a number that is not finite")),
            },
        };
        written.map_err(E::custom)
    }

    fn visit_str<E>(self, v: &str) -> Result<(), E> {
        write_string(self.0.to, v);
        Ok(())
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<(), A::Error> {
        self.0.to.push('[');
        let mut place = 0;
        loop {
            let begin = self.0.to.len();
            if place > 0 {
                self.0.to.push(',');
            }
            match seq.next_element_seed(self.0.inner()) {
                Ok(Some(())) => place += 1,
                Ok(None) => {
                    self.0.to.truncate(begin);
                    self.0.to.push(']');
                    return Ok(());
                }
                Err(error) => {
                    self.0.state.path.push(PathStep::Place(place));
                    return Err(error);
                }
            }
        }
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<(), A::Error> {
        self.0.to.push('{');
        let mut keys = Keys::default();
        loop {
            let begin = self.0.to.len();
            if begin > 0 && !self.0.to.ends_with('{') {
                self.0.to.push(',');
            }
            let from = self.0.to.len();
            if map.next_key_seed(CopiedKey(self.0.to))?.is_none() {
                self.0.to.truncate(begin);
                self.0.to.push('}');
                return Ok(());
            }
            let key = from..self.0.to.len();
            if keys.has(self.0.to, &key) {
                self.0.state.repeated = Some(key_at(self.0.to, &key));
                return Err(A::Error::custom("a key written twice"));
            }
            self.0.to.push(':');
            if let Err(error) = map.next_value_seed(self.0.inner()) {
                let name = key_at(self.0.to, &key);
                self.0.state.path.push(PathStep::Key(name));
                return Err(error);
            }
        }
    }
}

/// A key on its way from one text to the other.
struct CopiedKey<'a>(&'a mut String);

impl<'de> DeserializeSeed<'de> for CopiedKey<'_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<(), D::Error> {
        deserializer.deserialize_str(self)
    }
}

impl Visitor<'_> for CopiedKey<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a key")
    }

    fn visit_str<E>(self, v: &str) -> Result<(), E> {
        write_string(self.0, v);
        Ok(())
    }
}

/// Keys of an object that are compared one by one; more are looked up.
const FEW_KEYS: usize = 16;

/// The keys of an object so far, as ranges of the text that they were written to.
#[derive(Default)]
struct Keys {
    few: Vec<Range<usize>>,
    many: HashSet<String>,
}

impl Keys {
    /// Whether a key was there before; adds it.
    fn has(&mut self, text: &str, key: &Range<usize>) -> bool {
        let own = &text[key.clone()];
        if self.few.len() < FEW_KEYS {
            let known = self.few.iter().any(|other| text[other.clone()] == *own);
            self.few.push(key.clone());
            return known;
        }
        if self.many.is_empty() {
            let few = self.few.iter().map(|other| text[other.clone()].to_owned());
            self.many.extend(few);
        }
        !self.many.insert(own.to_owned())
    }
}

/// The key that is written at a range of a text.
fn key_at(text: &str, key: &Range<usize>) -> String {
    serde_json::from_str(&text[key.clone()]).unwrap_or_default()
}

/// Writes a string as JSON.
fn write_string(to: &mut String, v: &str) {
    let plain = v.bytes().all(|b| b >= 0x20 && b != b'"' && b != b'\\');
    if plain {
        to.push('"');
        to.push_str(v);
        to.push('"');
    } else {
        to.push_str(&Value::from(v).to_string());
    }
}

/// The whole number that a number is, where it is one that its digits tell exactly.
fn whole(x: f64) -> Option<i64> {
    (x.fract() == 0.0 && x.abs() < 9.0e15).then_some(x as i64)
}

/// A value with whole numbers written as whole numbers (`3.0` as `3`, `-0.0` as `0`), so that equal values have
/// equal texts.
pub(crate) fn canonical(value: &Value) -> Value {
    match value {
        Value::Number(n) if n.is_f64() => match n.as_f64().and_then(whole) {
            Some(whole) => whole.into(),
            None => value.clone(),
        },
        Value::Array(list) => Value::Array(list.iter().map(canonical).collect()),
        Value::Object(map) => Value::Object(map.iter().map(|(k, v)| (k.clone(), canonical(v))).collect()),
        other => other.clone(),
    }
}
