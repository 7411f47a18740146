//! A JSON document as this program holds it: its canonical text.
//!
//! Knows files, and what a refused text is told as. Does not know what any key means.

use super::path::join_steps;
use super::refusal::{FoundValue, Refusal, RefusalKind};
use super::strict::{self, FaultKind, MARK, MOST_LEVELS, SyntaxFault, canonical};
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
    /// [`Refusal`] where the file cannot be read, is not JSON, names a key twice or holds a number that is not finite.
    pub fn read(file: &Path) -> Result<Self, Refusal> {
        let text = std::fs::read_to_string(file)
            .map_err(|e| Refusal::new(file, "", format!("no readable file ({e})"), "a JSON file"))?;
        Self::parse(file, &text)
    }

    /// Reads a text as one document; `file` stands for it in messages.
    ///
    /// # Errors
    /// As above.
    pub fn parse(file: &Path, text: &str) -> Result<Self, Refusal> {
        if text.trim().is_empty() {
            return Err(Refusal::new(file, "", "an empty file", "a JSON file"));
        }
        match strict::canonical_of(text) {
            Ok(canonical) => Ok(Self(canonical.into())),
            Err(fault) => Err(refusal(file, text, fault)),
        }
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
        FaultKind::ByteOrderMark => {
            debug_assert!(text.starts_with(MARK));
            syntax(
                String::new(),
                "a byte order mark before the text".to_owned(),
                "JSON without one",
            )
        }
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
            ("\u{feff}{}", "a byte order mark before the text"),
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
