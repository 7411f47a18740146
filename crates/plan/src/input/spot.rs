//! Where in a text something stands that was refused.
//!
//! Knows key paths as refusals write them and the bytes of a text that they mean. Does not know how a place is shown, nor
//! what any key means.

use super::strict;
use jsonc_parser::ast::{Object, ObjectProp, Value};
use jsonc_parser::common::Ranged;
use jsonc_parser::{CollectOptions, ParseOptions, parse_to_ast};
use std::ops::Range;

/// A place in a text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Spot {
    /// Its bytes; empty where a text ends too early.
    pub bytes: Range<usize>,
    /// What stands there.
    pub kind: SpotKind,
}

/// What stands at a place that is to be shown.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum SpotKind {
    /// What makes the text no JSON, in the reader's words.
    Fault(String),
    /// A key that was written before, and where.
    Twice(Range<usize>),
    /// A key: there is none of that name, or none is allowed here.
    Key,
    /// A value.
    Value,
    /// The object or list that lacks something.
    Around,
}

/// Finds what a refusal of `key` means that has `found` something; none where the text has no such place.
///
/// A text that is no JSON has its one place, whatever the key. An axis is a key with points in its name, and what was found
/// is looked for among its values.
pub fn spot(text: &str, key: &str, found: &str) -> Option<Spot> {
    if let Some(fault) = strict::fault(text) {
        return Some(of_fault(text, fault));
    }
    // "block (key)": several axes of a block made another number wrong
    let (path, beside) = key.split_once(" (").map_or((key, false), |(path, _)| (path, true));
    let parsed = parsed(text)?;
    let root = parsed.as_ref()?;
    if path.is_empty() {
        return None;
    }
    let trail = trail(root, path);
    let last = trail.last()?;
    let named = |at: &Way<'_, '_>| at.name.clone().unwrap_or_else(|| opening(text, at.value));
    if beside {
        return Some(Spot {
            bytes: named(last),
            kind: SpotKind::Around,
        });
    }
    if trail.len() == 1 && !is_lack(found) {
        return None;
    }
    if let Some(value) = value_found(&trail, found) {
        return Some(Spot {
            bytes: shown(text, value),
            kind: SpotKind::Value,
        });
    }
    if let Some(bytes) = last.rest.is_empty().then(|| key_found(last.value, found)).flatten() {
        return Some(Spot {
            bytes,
            kind: SpotKind::Key,
        });
    }
    if last.rest.is_empty() && says_of_key(found) {
        return Some(Spot {
            bytes: named(last),
            kind: SpotKind::Key,
        });
    }
    if !last.rest.is_empty() || is_lack(found) {
        let bytes = last.name.as_ref().map_or_else(
            || opening(text, last.value),
            |name| name.start..opening(text, last.value).end,
        );
        let kind = if is_lack(found) {
            SpotKind::Around
        } else {
            SpotKind::Value
        };
        return Some(Spot { bytes, kind });
    }
    Some(Spot {
        bytes: shown(text, last.value),
        kind: SpotKind::Value,
    })
}

/// The place of what makes a text no JSON.
fn of_fault(text: &str, fault: strict::Fault) -> Spot {
    if fault.twice.is_some() {
        let first = parsed(text).flatten().and_then(|root| first_of(&root, &fault.bytes));
        return Spot {
            kind: first.map_or(SpotKind::Key, SpotKind::Twice),
            bytes: fault.bytes,
        };
    }
    Spot {
        bytes: fault.bytes,
        kind: SpotKind::Fault(fault.message),
    }
}

/// A text as a tree with places, read no less strictly than elsewhere.
fn parsed(text: &str) -> Option<Option<Value<'_>>> {
    let strict = ParseOptions {
        allow_comments: false,
        allow_loose_object_property_names: false,
        allow_trailing_commas: false,
        allow_missing_commas: false,
        allow_single_quoted_strings: false,
        allow_hexadecimal_numbers: false,
        allow_unary_plus_numbers: false,
        allow_bare_decimal_point_numbers: false,
        allow_non_finite_numbers: false,
        allow_extended_string_escapes: false,
    };
    Some(parse_to_ast(text, &CollectOptions::default(), &strict).ok()?.value)
}

/// A value on the way along a path.
struct Way<'a, 'p> {
    /// Where its key stands; none of the root and of a list's entry.
    name: Option<Range<usize>>,
    value: &'a Value<'a>,
    /// What is left of the path.
    rest: &'p str,
}

/// The values along a path from the root to the last that there is. Of keys that begin the path the longest counts: an axis
/// is named by a path.
fn trail<'a, 'p>(root: &'a Value<'a>, path: &'p str) -> Vec<Way<'a, 'p>> {
    let mut trail = vec![Way {
        name: None,
        value: root,
        rest: path,
    }];
    while let Some(next) = trail.last().and_then(|at| step(at.value, at.rest)) {
        trail.push(next);
    }
    trail
}

fn step<'a, 'p>(value: &'a Value<'a>, path: &'p str) -> Option<Way<'a, 'p>> {
    let after = |rest: &'p str| rest.strip_prefix('.').unwrap_or(rest);
    match value {
        Value::Object(object) => {
            let begins = |property: &&ObjectProp<'a>| {
                let rest = path.strip_prefix(property.name.as_str());
                rest.is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
            };
            let found = object
                .properties
                .iter()
                .filter(begins)
                .max_by_key(|p| p.name.as_str().len())?;
            Some(Way {
                name: Some(range(&found.name)),
                value: &found.value,
                rest: after(&path[found.name.as_str().len()..]),
            })
        }
        Value::Array(array) => {
            let (place, rest) = path.strip_prefix('[')?.split_once(']')?;
            let value = array.elements.get(place.parse::<usize>().ok()?)?;
            Some(Way {
                name: None,
                value,
                rest: after(rest),
            })
        }
        _ => None,
    }
}

/// The value on a trail that is what was found: its end, an entry of its end, or what the rest of the path leads to from an
/// entry of a list on the way (a value of an axis that is itself a list).
fn value_found<'a>(trail: &[Way<'a, '_>], found: &str) -> Option<&'a Value<'a>> {
    trail.iter().rev().find_map(|at| {
        if at.rest.is_empty() && is(at.value, found) {
            return Some(at.value);
        }
        let Value::Array(array) = at.value else { return None };
        array.elements.iter().find_map(|entry| {
            let end = self::trail(entry, at.rest).pop()?;
            (end.rest.is_empty() && is(end.value, found)).then_some(end.value)
        })
    })
}

/// The key of an object that is the word found: a word where one of several is allowed as its only key.
fn key_found(value: &Value<'_>, found: &str) -> Option<Range<usize>> {
    let Value::Object(object) = value else { return None };
    let word = found.strip_prefix('\'')?.strip_suffix('\'')?;
    let property = object
        .properties
        .iter()
        .find(|property| property.name.as_str() == word)?;
    Some(range(&property.name))
}

/// Whether a value is a number or word that was found; what follows a comma is the finder's comment.
fn is(value: &Value<'_>, found: &str) -> bool {
    let found = found.split_once(", which").map_or(found, |(found, _)| found);
    let found = found.strip_suffix(" twice").unwrap_or(found);
    match value {
        Value::NumberLit(number) => match (number.value.parse::<f64>(), found.parse::<f64>()) {
            (Ok(number), Ok(found)) => number == found,
            _ => false,
        },
        Value::StringLit(word) => {
            let bare = found.strip_prefix("unknown ").unwrap_or(found);
            [
                format!("'{}'", word.value),
                serde_json::Value::from(&*word.value).to_string(),
            ]
            .contains(&bare.to_owned())
        }
        Value::BooleanLit(word) => found == word.value.to_string(),
        Value::NullKeyword(_) => found == "null",
        Value::Object(_) | Value::Array(_) => false,
    }
}

/// Whether something was looked for and not found.
fn is_lack(found: &str) -> bool {
    found == "nothing" || ["no ", "neither "].iter().any(|word| found.starts_with(word))
}

/// Whether what was found is said of a key and not of its value.
fn says_of_key(found: &str) -> bool {
    let words = [
        "unknown ",
        "a key ",
        "an axis ",
        "the kind of ",
        "no list ",
        "no place ",
        "no object ",
    ];
    words.iter().any(|word| found.starts_with(word))
}

/// What of a value is shown: all of it, of one that goes over several lines its beginning.
fn shown(text: &str, value: &Value<'_>) -> Range<usize> {
    let all = range(value);
    let one_line = text.get(all.clone()).is_some_and(|written| !written.contains('\n'));
    if one_line { all } else { opening(text, value) }
}

/// The first character of a value.
fn opening(text: &str, value: &Value<'_>) -> Range<usize> {
    let start = value.start();
    let first = text.get(start..).and_then(|rest| rest.chars().next());
    start..start + first.map_or(0, char::len_utf8)
}

/// The first key of the name that stands at `second` too, in the same object.
fn first_of(value: &Value<'_>, second: &Range<usize>) -> Option<Range<usize>> {
    let among = |object: &Object<'_>| {
        let again = object.properties.iter().find(|p| range(&p.name) == *second)?;
        let same = |p: &&ObjectProp<'_>| p.name.as_str() == again.name.as_str();
        object.properties.iter().find(same).map(|p| range(&p.name))
    };
    match value {
        Value::Object(object) => {
            among(object).or_else(|| object.properties.iter().find_map(|p| first_of(&p.value, second)))
        }
        Value::Array(array) => array.elements.iter().find_map(|entry| first_of(entry, second)),
        _ => None,
    }
}

fn range(of: &impl Ranged) -> Range<usize> {
    of.start()..of.end()
}
