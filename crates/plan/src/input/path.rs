//! Paths into a document: `module.stiffeners.longitudinal_y_m[0]`.
//!
//! Knows how a path is written, how a value is read and set at it, and which paths a document has. Does not know
//! which paths make sense: reading the document as its type decides that.

use serde_json::{Map, Value};
use thiserror::Error;

/// Most steps of a path; no document of this program is as deep as a tenth of it.
const MOST_STEPS: usize = 100;

/// A step of a path.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum PathStep {
    /// A key of an object.
    Key(String),
    /// A place in a list, from 0.
    Place(usize),
}

/// What stands in the way of a path.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum Obstacle {
    /// A key is asked of what is no object.
    #[error("no object to hold '{0}'")]
    NoObject(String),
    /// A place is asked of what is no list.
    #[error("no list to hold [{0}]")]
    NoList(usize),
    /// A list has no such place.
    #[error("no place [{place}] in a list of {length}")]
    NoPlace {
        /// The place, from 0.
        place: usize,
        /// Length of the list.
        length: usize,
    },
}

/// The key of the one object whose entries are named by numbers; in a path they stand in brackets, `joints[3..14]`.
const NUMBERED: &str = "joints";

/// Whether a key is a number or a range of numbers, as those of [`NUMBERED`] are.
fn is_numbered(key: &str) -> bool {
    let number = |text: &str| !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit());
    key.split_once("..")
        .map_or_else(|| number(key), |(first, last)| number(first) && number(last))
}

/// Steps as a path is written: `module.y_m[0]`.
pub(super) fn join_steps(steps: &[PathStep]) -> String {
    let mut text = String::new();
    for step in steps {
        match step {
            PathStep::Key(key) if is_numbered(key) => text.extend(["[", key, "]"]),
            PathStep::Key(key) if text.is_empty() => text.push_str(key),
            PathStep::Key(key) => text.extend([".", key]),
            PathStep::Place(place) => text.push_str(&format!("[{place}]")),
        }
    }
    text
}

/// Two paths one after the other.
pub(crate) fn join(prefix: &str, path: &str) -> String {
    match (prefix.is_empty(), path.is_empty()) {
        (true, _) => path.to_owned(),
        (_, true) => prefix.to_owned(),
        _ if path.starts_with('[') => format!("{prefix}{path}"),
        _ => format!("{prefix}.{path}"),
    }
}

/// A path into a document.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DocumentPath(Vec<PathStep>);

impl DocumentPath {
    /// Reads a path; `None` where it is not well formed or has more than a hundred steps.
    pub fn parse(text: &str) -> Option<Self> {
        let mut steps = Vec::new();
        let mut inside = false;
        let between_keys = |c: char| {
            inside = c == '[' || (inside && c != ']');
            c == '.' && !inside
        };
        for segment in text.split(between_keys) {
            let (key, mut places) = match segment.find('[') {
                Some(i) => segment.split_at(i),
                None => (segment, ""),
            };
            if key.is_empty() {
                return None;
            }
            steps.push(PathStep::Key(key.to_owned()));
            while !places.is_empty() {
                let (place, rest) = places.strip_prefix('[')?.split_once(']')?;
                steps.push(match place.parse() {
                    Ok(number) if usize::to_string(&number) == place => PathStep::Place(number),
                    _ if place.contains("..") && is_numbered(place) => PathStep::Key(place.to_owned()),
                    _ => return None,
                });
                places = rest;
            }
        }
        Some(Self(steps)).filter(|path| path.0.len() <= MOST_STEPS)
    }

    /// What of another path lies beyond this one, where one of the two is the beginning of the other; nothing of an equal or
    /// shorter one.
    pub fn beyond(&self, other: &Self) -> Option<String> {
        let common = self.0.len().min(other.0.len());
        let meet = self.0[..common] == other.0[..common];
        meet.then(|| join_steps(&other.0[common..]))
    }

    /// Whether the first key is this one.
    pub fn begins_with(&self, key: &str) -> bool {
        matches!(self.0.first(), Some(PathStep::Key(first)) if first == key)
    }

    /// The value at the path, if there is one.
    pub fn get<'a>(&self, document: &'a Value) -> Option<&'a Value> {
        self.0.iter().try_fold(document, |at, step| match step {
            PathStep::Key(key) => at.get(key),
            PathStep::Place(place) if at.is_object() => at.get(place.to_string()),
            PathStep::Place(place) => at.get(place),
        })
    }

    /// Puts a value at the path, making objects on the way where there are none.
    ///
    /// # Errors
    /// [`Obstacle`]: a list that is too short, a key of something that is not an object.
    pub fn set(&self, document: &mut Value, value: Value) -> Result<(), Obstacle> {
        let mut at = document;
        let before = std::iter::once(None).chain(self.0.iter().map(Some));
        for (step, before) in self.0.iter().zip(before) {
            if at.is_null() && matches!(before, Some(PathStep::Key(key)) if key == NUMBERED) {
                *at = Value::Object(Map::new());
            }
            at = match (step, at) {
                (PathStep::Key(key), Value::Object(map)) => map.entry(key.clone()).or_insert(Value::Null),
                (PathStep::Key(key), at @ Value::Null) => {
                    *at = Value::Object(Map::from_iter([(key.clone(), Value::Null)]));
                    &mut at[key]
                }
                (PathStep::Key(key), _) => return Err(Obstacle::NoObject(key.clone())),
                (PathStep::Place(place), Value::Object(map)) => map.entry(place.to_string()).or_insert(Value::Null),
                (PathStep::Place(place), Value::Array(list)) => {
                    let (place, length) = (*place, list.len());
                    list.get_mut(place).ok_or(Obstacle::NoPlace { place, length })?
                }
                (PathStep::Place(place), _) => return Err(Obstacle::NoList(*place)),
            };
        }
        *at = value;
        Ok(())
    }
}

/// The paths of all values of a document that are not objects, each under `prefix`; lists as wholes and by place.
pub fn leaves(prefix: &str, document: &Value, out: &mut Vec<String>) {
    match document {
        Value::Object(map) => map.iter().for_each(|(key, value)| match is_numbered(key) {
            true => leaves(&format!("{prefix}[{key}]"), value, out),
            false => leaves(&format!("{prefix}.{key}"), value, out),
        }),
        Value::Array(list) => {
            out.push(prefix.to_owned());
            list.iter()
                .enumerate()
                .for_each(|(i, value)| leaves(&format!("{prefix}[{i}]"), value, out));
        }
        _ => out.push(prefix.to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn path(text: &str) -> DocumentPath {
        DocumentPath::parse(text).unwrap()
    }

    #[test]
    fn a_path_tells_what_lies_beyond_it() {
        let beyond = |of: &str, other: &str| path(of).beyond(&path(other));
        assert_eq!(beyond("a.b", "a.b[0].c").as_deref(), Some("[0].c"));
        assert_eq!(beyond("a.b", "a.b").as_deref(), Some(""));
        assert_eq!(beyond("a.b[0]", "a.b").as_deref(), Some(""));
        assert_eq!((beyond("a.b", "a.bc"), beyond("a.b", "a.c")), (None, None));
        assert!(path("a[0].b").begins_with("a") && !path("ab").begins_with("a"));
    }

    #[test]
    fn what_is_set_is_read_back_and_nothing_else_changes() {
        let mut document = json!({"a": {"b": [1, {"c": 2}]}, "d": 3});
        path("a.b[1].c").set(&mut document, json!(7)).unwrap();
        assert_eq!(path("a.b[1].c").get(&document), Some(&json!(7)));
        assert_eq!(document, json!({"a": {"b": [1, {"c": 7}]}, "d": 3}));
    }

    #[test]
    fn objects_are_made_on_the_way_but_lists_are_not_lengthened() {
        let mut document = json!({"l": [1]});
        path("x.y").set(&mut document, json!(1)).unwrap();
        assert_eq!(document["x"]["y"], json!(1));
        assert!(path("l[1]").set(&mut document, json!(1)) == Err(Obstacle::NoPlace { place: 1, length: 1 }));
        assert!(path("l.k").set(&mut document, json!(1)).is_err());
    }

    #[test]
    fn joints_are_named_by_numbers_in_brackets() {
        let mut document = json!({"other": {"7": 1}});
        for (text, value) in [("joints[7].a", 1), ("joints[3..14].a", 2), ("joints[7].b", 3)] {
            path(text).set(&mut document, json!(value)).unwrap();
            assert_eq!(path(text).get(&document), Some(&json!(value)), "{text}");
        }
        assert_eq!(document["joints"], json!({"7": {"a": 1, "b": 3}, "3..14": {"a": 2}}));
        let mut out = Vec::new();
        leaves("bridge", &document, &mut out);
        let known = [
            "bridge.other[7]",
            "bridge.joints[7].a",
            "bridge.joints[7].b",
            "bridge.joints[3..14].a",
        ];
        assert_eq!(out, known);
        for text in ["joints[3..]", "joints[..3]", "joints[3.14]", "joints[a..b]"] {
            assert_eq!(DocumentPath::parse(text), None, "{text}");
        }
    }

    #[test]
    fn what_is_not_a_path_is_not_read() {
        for text in ["", ".a", "a..b", "a[", "a[x]", "a[0]b", "[0]", "a[01]", "a[+1]"] {
            assert_eq!(DocumentPath::parse(text), None, "{text}");
        }
        let steps = |n: usize| vec!["a"; n].join(".");
        assert!(DocumentPath::parse(&steps(MOST_STEPS)).is_some());
        assert_eq!(DocumentPath::parse(&steps(MOST_STEPS + 1)), None);
    }

    #[test]
    fn leaves_are_all_values_that_are_not_objects() {
        let mut out = Vec::new();
        leaves("v", &json!({"a": {"b": 1}, "l": [1, 2]}), &mut out);
        assert_eq!(out, ["v.a.b", "v.l", "v.l[0]", "v.l[1]"]);
    }
}
