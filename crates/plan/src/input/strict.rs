//! Reading a file as JSON, strictly: nothing that a reader might silently drop or repair passes.
//!
//! Knows that a key written twice, a number out of range and a NaN are errors. Does not know keys.

use crate::input::Refusal;
use serde::de::{Deserialize, Deserializer, Error as _, MapAccess, SeqAccess, Visitor};
use serde_json::{Map, Number, Value};
use std::fmt;
use std::ops::Range;
use std::path::Path;

/// Reads a file as one JSON document.
///
/// # Errors
/// [`Refusal`] where the file cannot be read, is not JSON, names a key twice or holds a number that is not finite.
pub fn read(file: &Path) -> Result<Value, Refusal> {
    let text = std::fs::read_to_string(file)
        .map_err(|e| Refusal::new(file, "", format!("no readable file ({e})"), "a JSON file"))?;
    parse(file, &text)
}

fn parse(file: &Path, text: &str) -> Result<Value, Refusal> {
    if text.trim().is_empty() {
        return Err(Refusal::new(file, "", "an empty file", "a JSON file"));
    }
    if text.starts_with(MARK) {
        return Err(Refusal::new(
            file,
            "",
            "a byte order mark before the text",
            "JSON without one",
        ));
    }
    strict(text).map_err(|(key, error)| refusal(file, text, key, &Fault::new(text, &error)))
}

/// The value of a text, or the path of a key and what the reader says of it.
fn strict(text: &str) -> Result<Value, (String, serde_json::Error)> {
    let mut reader = serde_json::Deserializer::from_str(text);
    let value = serde_path_to_error::deserialize::<_, Strict>(&mut reader).map_err(|error| {
        let path = error.path().to_string();
        let path = path.trim_end_matches('?').trim_end_matches('.');
        (path.to_owned(), error.into_inner())
    })?;
    reader.end().map_err(|error| (String::new(), error))?;
    Ok(value.0)
}

/// What makes a text no JSON document.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Fault {
    /// Its bytes; none at the end of a text that ends too early.
    pub(super) bytes: Range<usize>,
    /// What the reader says.
    pub(super) message: String,
    /// The key that is there twice, where that is what is wrong; it stands at `bytes`.
    pub(super) twice: Option<String>,
}

impl Fault {
    fn new(text: &str, error: &serde_json::Error) -> Self {
        let message = error.to_string();
        let message = message.split(" at line ").next().unwrap_or_default().to_owned();
        let lines = text.split_inclusive('\n');
        let before: usize = lines.take(error.line().saturating_sub(1)).map(str::len).sum();
        let (from, to) = token_in(text.get(before..).unwrap_or_default(), error.column());
        let end = text.trim_end().len();
        let mut bytes = if error.is_eof() {
            end..end
        } else {
            before + from..before + to
        };
        let twice = message.strip_prefix(TWICE).map(str::to_owned);
        if let Some(name) = &twice {
            // the reader has just read the second of the two
            let written = Value::from(name.as_str()).to_string();
            let read = text.get(..text.floor_char_boundary(before + error.column() + 1));
            bytes = read
                .and_then(|read| read.rfind(&written))
                .map_or(bytes, |at| at..at + written.len());
        }
        Self { bytes, message, twice }
    }
}

/// What makes a text no JSON document, if anything does. An empty one has no place to show.
pub(super) fn fault(text: &str) -> Option<Fault> {
    if text.starts_with(MARK) {
        let message = "a byte order mark".to_owned();
        return Some(Fault {
            bytes: 0..MARK.len_utf8(),
            message,
            twice: None,
        });
    }
    let (_, error) = strict(text).err().filter(|_| !text.trim().is_empty())?;
    Some(Fault::new(text, &error))
}

/// What may stand before the text of a file and is no part of it.
const MARK: char = '\u{feff}';

fn refusal(file: &Path, text: &str, key: String, fault: &Fault) -> Refusal {
    let before = text.get(..fault.bytes.start).unwrap_or_default();
    let line = before.matches('\n').count() + 1;
    let column = before.chars().rev().take_while(|c| *c != '\n').count() + 1;
    let place = format!("line {line}, column {column}");
    let message = &fault.message;
    if let Some(name) = &fault.twice {
        return Refusal::new(file, key, format!("the key '{name}' twice ({place})"), "each key once");
    }
    if message.starts_with("recursion limit") {
        return Refusal::new(
            file,
            "",
            format!("lists and objects nested too deep ({place})"),
            "at most 127 levels",
        );
    }
    let token = text.get(fault.bytes.clone()).unwrap_or_default();
    let number = token.trim_start_matches(['-', '+']).to_ascii_lowercase();
    if message.contains("out of range") || number.starts_with("nan") || number.starts_with("inf") {
        return Refusal::new(file, key, format!("{token} ({place})"), "a finite number");
    }
    let token = if token.is_empty() {
        "the end".to_owned()
    } else {
        format!("'{token}'")
    };
    Refusal::new(file, key, format!("{token} ({place}: {message})"), "JSON")
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

/// How the message of a key written twice begins.
const TWICE: &str = "key written twice: ";

/// A JSON value whose objects name each key once.
struct Strict(Value);

impl<'de> Deserialize<'de> for Strict {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(StrictVisitor).map(Self)
    }
}

struct StrictVisitor;

impl<'de> Visitor<'de> for StrictVisitor {
    type Value = Value;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a JSON value")
    }

    fn visit_unit<E>(self) -> Result<Value, E> {
        Ok(Value::Null)
    }

    fn visit_bool<E>(self, v: bool) -> Result<Value, E> {
        Ok(Value::Bool(v))
    }

    fn visit_i64<E>(self, v: i64) -> Result<Value, E> {
        Ok(v.into())
    }

    fn visit_u64<E>(self, v: u64) -> Result<Value, E> {
        Ok(v.into())
    }

    fn visit_f64<E: serde::de::Error>(self, v: f64) -> Result<Value, E> {
        Number::from_f64(v)
            .map(Value::Number)
            .ok_or_else(|| E::custom("number out of range"))
    }

    fn visit_str<E>(self, v: &str) -> Result<Value, E> {
        Ok(Value::String(v.to_owned()))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Value, A::Error> {
        let mut list = Vec::new();
        while let Some(Strict(value)) = seq.next_element()? {
            list.push(value);
        }
        Ok(Value::Array(list))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Value, A::Error> {
        let mut object = Map::new();
        while let Some(key) = map.next_key::<String>()? {
            if object.contains_key(&key) {
                return Err(A::Error::custom(format!("{TWICE}{key}")));
            }
            let Strict(value) = map.next_value()?;
            object.insert(key, value);
        }
        Ok(Value::Object(object))
    }
}

/// The same value with whole numbers written as whole numbers (`3.0` as `3`, `-0.0` as `0`), so that equal values have
/// equal texts.
pub(crate) fn canonical(value: &Value) -> Value {
    match value {
        Value::Number(n) => match n.as_f64() {
            Some(x) if n.is_f64() && x.fract() == 0.0 && x.abs() < 9.0e15 => Value::from(x as i64),
            _ => value.clone(),
        },
        Value::Array(list) => Value::Array(list.iter().map(canonical).collect()),
        Value::Object(map) => Value::Object(map.iter().map(|(k, v)| (k.clone(), canonical(v))).collect()),
        other => other.clone(),
    }
}

/// The text of the canonical value, on one line.
pub fn canonical_text(value: &Value) -> String {
    canonical(value).to_string()
}

/// A document on one line and the blake3 hash of that text.
pub fn text_and_hash(document: &Value) -> (String, String) {
    let text = canonical_text(document);
    let hash = blake3::hash(text.as_bytes()).to_hex().to_string();
    (text, hash)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(text: &str) -> Refusal {
        parse(Path::new("f.json"), text).unwrap_err()
    }

    #[test]
    fn a_key_written_twice_is_refused_with_its_path() {
        let e = refused(r#"{"a": {"b": 1, "b": 2}}"#);
        assert!(e.found.contains("'b' twice"), "{e}");
        assert!(e.key.starts_with('a'), "{e}");
    }

    #[test]
    fn numbers_that_are_not_finite_are_refused_with_path_and_token() {
        for token in ["1e999", "-1e999", "NaN", "Infinity", "-Infinity"] {
            let e = refused(&format!("{{\n  \"a\": {{ \"b\": [1, {token}] }}\n}}"));
            assert_eq!(e.key, "a.b[1]", "{token}: {e}");
            assert_eq!(e.allowed, "a finite number", "{token}: {e}");
            assert!(e.found.starts_with(token), "{token}: {e}");
        }
    }

    #[test]
    fn what_is_no_document_is_told_without_noise() {
        for (text, found) in [
            ("", "an empty file"),
            (" \n", "an empty file"),
            ("\u{feff}{}", "a byte order mark before the text"),
            (
                &"[".repeat(1000),
                "lists and objects nested too deep (line 1, column 128)",
            ),
            (r#"{"a":1,}"#, "'}' (line 1, column 8: trailing comma)"),
        ] {
            let e = refused(text);
            assert_eq!((e.key.as_str(), e.found.as_str()), ("", found), "{e}");
        }
    }

    #[test]
    fn text_after_the_document_is_refused() {
        assert_eq!(refused("{} x").allowed, "JSON");
    }

    #[test]
    fn equal_numbers_have_equal_canonical_texts() {
        let value: Value = serde_json::from_str(r#"{"b": [3.0, 3, -0.0, 0.5], "a": 1e3}"#).unwrap();
        assert_eq!(canonical_text(&value), r#"{"b":[3,3,0,0.5],"a":1000}"#);
    }
}
