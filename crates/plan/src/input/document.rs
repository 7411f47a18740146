//! A JSON document as this program holds it: its canonical text.
//!
//! Knows files, and what a refused text is told as. Does not know what any key means.

use super::path::join_steps;
use super::refusal::{FoundValue, Refusal, RefusalKind};
use super::strict::{self, FaultKind, MOST_LEVELS, SyntaxFault, canonical};
use serde_json::Value;
use std::path::Path;
use std::sync::Arc;

/// A document: its text on one line, whole numbers written as whole numbers, so that equal documents have equal texts.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Document(Arc<str>);

impl Document {
    /// Reads a file as one document.
    ///
    /// # Errors
    /// [`Refusal`] where the file cannot be read, is not JSON in UTF-8, names a key twice or holds a number that is not finite.
    pub fn read(file: &Path) -> Result<Self, Refusal> {
        let bytes = std::fs::read(file)
            .map_err(|e| Refusal::new(file, "", format!("no readable file ({e})"), "a JSON file"))?;
        let text = String::from_utf8(bytes).map_err(|no_text| {
            let found = match no_text.as_bytes() {
                bytes if is_utf16(bytes) => "a text in UTF-16".to_owned(),
                _ => format!("byte {} that is no UTF-8", no_text.utf8_error().valid_up_to()),
            };
            Refusal::new(file, "", found, "a JSON file in UTF-8")
        })?;
        if is_utf16(text.as_bytes()) {
            return Err(Refusal::new(file, "", "a text in UTF-16", "a JSON file in UTF-8"));
        }
        Self::parse(file, &text)
    }

    /// Reads a text as one document; `file` stands for it in messages.
    ///
    /// # Errors
    /// As above.
    pub fn parse(file: &Path, text: &str) -> Result<Self, Refusal> {
        let text = without_mark(text);
        if text.trim().is_empty() {
            return Err(Refusal::new(file, "", "an empty file", "a JSON file"));
        }
        match strict::canonical_of(text) {
            Ok(canonical) if canonical.contains(SCHEMA) => without_schema(file, &canonical),
            Ok(canonical) => Ok(Self(canonical.into())),
            Err(fault) => Err(refusal(file, text, fault)),
        }
    }

    /// The document of a text that a document had, see [`Self::text`].
    pub fn of_canonical(text: String) -> Self {
        Self(text.into())
    }

    /// The text.
    pub fn text(&self) -> &str {
        &self.0
    }

    /// The blake3 hash of the text.
    pub fn hash(&self) -> String {
        blake3::hash(self.0.as_bytes()).to_hex().to_string()
    }

    /// The document as a tree.
    pub fn value(&self) -> Value {
        serde_json::from_str(&self.0).unwrap_or_default()
    }
}

impl From<&Value> for Document {
    fn from(value: &Value) -> Self {
        Self(canonical_text(value).into())
    }
}

/// What an editor may write before the text of a file, and is no part of it.
const MARK: char = '\u{feff}';

/// The text of a file without a byte order mark before it.
pub fn without_mark(text: &str) -> &str {
    text.strip_prefix(MARK).unwrap_or(text)
}

/// Whether a text that begins in ASCII, as JSON does, is one in UTF-16.
fn is_utf16(bytes: &[u8]) -> bool {
    matches!(
        bytes,
        [0xff, 0xfe, ..] | [0xfe, 0xff, ..] | [0, 1..=255, ..] | [1..=255, 0, ..]
    )
}

/// The key by which an editor finds the schema of a file; nothing is read from it.
const SCHEMA: &str = "$schema";

/// The document of a canonical text without the address of its schema.
fn without_schema(file: &Path, canonical: &str) -> Result<Document, Refusal> {
    let mut value: Value = serde_json::from_str(canonical).unwrap_or_default();
    match value.as_object_mut().and_then(|keys| keys.shift_remove(SCHEMA)) {
        None => Ok(Document(canonical.into())),
        Some(Value::String(_)) => Ok(Document(value.to_string().into())),
        Some(other) => {
            let refused = Refusal::new(file, SCHEMA, &other, "the address of a schema, a text");
            Err(refused.because(RefusalKind::WrongType))
        }
    }
}

/// The text of the canonical value, on one line.
pub fn canonical_text(value: &Value) -> String {
    canonical(value).to_string()
}

fn refusal(file: &Path, text: &str, fault: SyntaxFault) -> Refusal {
    let before = text.get(..fault.bytes.start).unwrap_or_default();
    let line = before.matches('\n').count() + 1;
    let column = before.chars().rev().take_while(|c| *c != '\n').count() + 1;
    let place = format!("line {line}, column {column}");
    let token = text.get(fault.bytes.clone()).unwrap_or_default();
    let path = join_steps(&fault.path);
    let syntax = |path: String, found: String, allowed: &str| {
        Refusal::new(file, path, found, allowed).because(RefusalKind::Syntax)
    };
    match fault.kind {
        FaultKind::RepeatedKey(name) => {
            let found = FoundValue::value(name).which(place);
            Refusal::new(file, path, found, "each key once").because(RefusalKind::RepeatedKey)
        }
        FaultKind::TooDeep => {
            let found = format!("lists and objects nested too deep ({place})");
            syntax(String::new(), found, &format!("at most {MOST_LEVELS} levels"))
        }
        FaultKind::NotFinite => syntax(path, format!("{token} ({place})"), "a finite number"),
        FaultKind::Syntax(message) if token.is_empty() => syntax(path, format!("the end ({place}: {message})"), "JSON"),
        FaultKind::Syntax(message) => syntax(path, format!("'{token}' ({place}: {message})"), "JSON"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(text: &str) -> Refusal {
        Document::parse(Path::new("f.json"), text).unwrap_err()
    }

    #[test]
    fn a_key_written_twice_is_refused_with_its_path() {
        let e = refused(r#"{"a": {"b": 1, "b": 2}}"#);
        assert_eq!(
            (e.kind, e.path.as_str(), e.found.value.as_ref()),
            (RefusalKind::RepeatedKey, "a", Some(&Value::from("b"))),
            "{e}"
        );
        // more keys than are compared one by one
        let keys: Vec<String> = (0..40).map(|i| format!("\"k{i}\": {i}")).collect();
        let text = format!("{{{}, \"k3\": 0}}", keys.join(", "));
        assert_eq!(refused(&text).found.value, Some("k3".into()));
        let once = Document::parse(Path::new("f.json"), &format!("{{{}}}", keys.join(", "))).unwrap();
        assert_eq!(once.value().as_object().unwrap().len(), 40);
    }

    #[test]
    fn numbers_that_are_not_finite_are_refused_with_path_and_token() {
        for token in ["1e999", "-1e999", "NaN", "Infinity", "-Infinity"] {
            let e = refused(&format!("{{\n  \"a\": {{ \"b\": [1, {token}] }}\n}}"));
            assert_eq!(e.path, "a.b[1]", "{token}: {e}");
            assert_eq!(e.allowed, "a finite number", "{token}: {e}");
            assert!(e.found.words.starts_with(token), "{token}: {e}");
        }
    }

    #[test]
    fn what_is_no_document_is_told_without_noise() {
        for (text, found) in [
            ("", "an empty file"),
            (" \n", "an empty file"),
            (
                &"[".repeat(1000),
                "lists and objects nested too deep (line 1, column 128)",
            ),
            (
                &"{\"a\":".repeat(1000),
                "lists and objects nested too deep (line 1, column 636)",
            ),
            (r#"{"a":1,}"#, "'}' (line 1, column 8: trailing comma)"),
        ] {
            let e = refused(text);
            assert_eq!((e.path.as_str(), e.found.words.as_str()), ("", found), "{e}");
        }
    }

    #[test]
    fn as_many_levels_as_are_allowed_are_read() {
        let text = "[".repeat(MOST_LEVELS) + &"]".repeat(MOST_LEVELS);
        assert_eq!(Document::parse(Path::new("f.json"), &text).unwrap().text(), text);
    }

    #[test]
    fn a_mark_and_the_address_of_a_schema_are_no_part_of_a_document() {
        let read = |text: &str| Document::parse(Path::new("f.json"), text).map(|document| document.text().to_owned());
        assert_eq!(read("\u{feff}{\"a\": 1}").unwrap(), r#"{"a":1}"#);
        assert_eq!(
            read(r#"{"a": 1, "$schema": "x.json", "b": 2}"#).unwrap(),
            r#"{"a":1,"b":2}"#
        );
        assert_eq!(read(r#"{"a": {"$schema": "x"}}"#).unwrap(), r#"{"a":{"$schema":"x"}}"#);
        let e = refused(r#"{"$schema": 3}"#);
        assert_eq!((e.path.as_str(), e.kind), ("$schema", RefusalKind::WrongType), "{e}");
        // places are those of the text behind the mark
        assert!(refused("\u{feff}{\"a\":1,}").to_string().contains("line 1, column 8"));
    }

    #[test]
    fn a_text_of_another_encoding_is_named() {
        let dir = tempfile::tempdir().unwrap();
        let file = dir.path().join("f.json");
        let told = |bytes: &[u8]| {
            std::fs::write(&file, bytes).unwrap();
            Document::read(&file).unwrap_err().found.words.clone()
        };
        let utf16 = |units: &mut dyn Iterator<Item = u16>| units.flat_map(u16::to_le_bytes).collect::<Vec<u8>>();
        assert_eq!(told(&utf16(&mut "\u{feff}{}".encode_utf16())), "a text in UTF-16");
        assert_eq!(told(&utf16(&mut "{}".encode_utf16())), "a text in UTF-16");
        assert_eq!(told(&[0xfe, 0xff, 0, b'{', 0, b'}']), "a text in UTF-16");
        assert_eq!(told(b"{\"a\": \"\xe9\"}"), "byte 7 that is no UTF-8");
    }

    #[test]
    fn text_after_the_document_is_refused() {
        assert_eq!(refused("{} x").allowed, "JSON");
    }

    #[test]
    fn equal_numbers_have_equal_canonical_texts() {
        let text = r#"{"b": [3.0, 3, -0.0, 0.5, 1e300], "a": 1e3, "\u00fc\n": {}, "c": [], "d": [true, null, "x\"y"]}"#;
        let expected = r#"{"b":[3,3,0,0.5,1e+300],"a":1000,"ü\n":{},"c":[],"d":[true,null,"x\"y"]}"#;
        let document = Document::parse(Path::new("f.json"), text).unwrap();
        assert_eq!(document.text(), expected);
        // the tree of the same text has the same canonical text
        let tree: Value = serde_json::from_str(text).unwrap();
        assert_eq!(Document::from(&tree), document);
        assert_eq!(document.value(), canonical(&tree));
    }

    proptest::proptest! {
        #[test]
        fn a_text_and_its_tree_have_one_canonical_text(
            numbers in proptest::collection::vec(proptest::num::f64::NORMAL, 0..8),
            words in proptest::collection::vec("\\PC{0,6}", 0..4),
        ) {
            let tree = serde_json::json!({ "numbers": numbers, "words": words, "of": [{ "n": numbers }, {}] });
            let document = Document::parse(Path::new("f.json"), &format!("{tree:#}")).unwrap();
            proptest::prop_assert_eq!(document, Document::from(&tree));
        }
    }
}
