//! Where in a text something stands that was refused: found by the refusal's kind, path and value, never by its words.
//!
//! Knows paths as refusals have them and the bytes of a text that they mean. A text is read with its places only once something
//! in it was refused. Does not know how a place is shown, nor what any key means.

use super::refusal::{Refusal, RefusalKind};
use super::strict::{self, FaultKind};
use jsonc_parser::ast::{Object, ObjectProp, Value};
use jsonc_parser::common::Ranged;
use jsonc_parser::{CollectOptions, ParseOptions, parse_to_ast};
use std::ops::Range;

/// A place in a text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Mark {
    /// Its bytes; empty where a text ends too early.
    pub bytes: Range<usize>,
    /// What stands there.
    pub kind: MarkKind,
}

/// What stands at a place that is to be shown.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum MarkKind {
    /// What makes the text no JSON; the reader's words, where there are any.
    Fault(Option<String>),
    /// A key that was written before, and where.
    Twice(Range<usize>),
    /// A key: there is none of that name, or none is allowed here.
    Key,
    /// A value.
    Value,
    /// The object or list that lacks something.
    Around,
}

/// Finds what a refusal means in the text of its file; none where the text has no such place.
///
/// A text that is no JSON has its one place, whatever was refused. An axis is a key with points in its name, and the value that
/// was found is looked for among its values.
pub fn mark(text: &str, refusal: &Refusal) -> Option<Mark> {
    if let Some(fault) = strict::fault(text) {
        return Some(of_fault(text, fault));
    }
    let parsed = parsed(text)?;
    let root = parsed.as_ref()?;
    if refusal.path.is_empty() {
        return None;
    }
    let trail = trail(root, &refusal.path);
    let last = trail.last()?;
    let name = || last.name.clone().unwrap_or_else(|| opening(text, last.value));
    if refusal.made_wrong.is_some() {
        return Some(Mark {
            bytes: name(),
            kind: MarkKind::Around,
        });
    }
    let lacks = refusal.kind == RefusalKind::Missing;
    if trail.len() == 1 && !lacks {
        return None;
    }
    let found = refusal.found.value.as_ref();
    if let Some(value) = found.and_then(|found| value_found(&trail, found)) {
        return Some(Mark {
            bytes: shown(text, value),
            kind: MarkKind::Value,
        });
    }
    let whole = last.rest.is_empty();
    let of_key = matches!(
        refusal.kind,
        RefusalKind::UnknownKey | RefusalKind::UnknownWord | RefusalKind::Misplaced
    );
    if whole && of_key {
        return Some(Mark {
            bytes: name(),
            kind: MarkKind::Key,
        });
    }
    if lacks || !whole {
        let bytes = last.name.as_ref().map_or_else(
            || opening(text, last.value),
            |name| name.start..opening(text, last.value).end,
        );
        let kind = if lacks { MarkKind::Around } else { MarkKind::Value };
        return Some(Mark { bytes, kind });
    }
    Some(Mark {
        bytes: shown(text, last.value),
        kind: MarkKind::Value,
    })
}

/// The place of what makes a text no JSON.
fn of_fault(text: &str, fault: strict::SyntaxFault) -> Mark {
    let kind = match fault.kind {
        FaultKind::RepeatedKey(_) => {
            let first = parsed(text).flatten().and_then(|root| first_of(&root, &fault.bytes));
            first.map_or(MarkKind::Key, MarkKind::Twice)
        }
        FaultKind::Syntax(message) => MarkKind::Fault(Some(message)),
        FaultKind::TooDeep | FaultKind::NotFinite => MarkKind::Fault(None),
    };
    Mark {
        bytes: fault.bytes,
        kind,
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
        Value::Object(object) if path.starts_with('[') => {
            let (name, rest) = path.strip_prefix('[')?.split_once(']')?;
            let found = object.properties.iter().find(|p| p.name.as_str() == name)?;
            Some(Way {
                name: Some(range(&found.name)),
                value: &found.value,
                rest: after(rest),
            })
        }
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
fn value_found<'a>(trail: &[Way<'a, '_>], found: &serde_json::Value) -> Option<&'a Value<'a>> {
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

/// Whether a value of the text is a number or word that was found.
fn is(value: &Value<'_>, found: &serde_json::Value) -> bool {
    match (value, found) {
        (Value::NumberLit(number), found) => found.is_number() && number.value.parse().ok() == found.as_f64(),
        (Value::StringLit(word), serde_json::Value::String(found)) => word.value == found.as_str(),
        (Value::BooleanLit(word), serde_json::Value::Bool(found)) => word.value == *found,
        (Value::NullKeyword(_), serde_json::Value::Null) => true,
        _ => false,
    }
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
