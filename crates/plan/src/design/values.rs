//! The values of an axis as they are written: a list, one value, an evenly spaced range.
//!
//! Knows the forms, that ranges hold both ends exactly, and how many digits a computed value has. Does not know what an axis may be called.

use super::column::ValueColumn;
use crate::input::{Cell, FoundValue, Refusal};
use serde_json::Value;
use std::path::Path;

/// Most points of a study, equal ones counted as often as they occur, and so most values of an axis: each point costs a
/// check and, in a run, some 0.3 kB of memory (a job of 88 bytes, what tells it apart, its line of the summary), 3 GB for
/// as many as this.
pub(super) const MOST_POINTS: usize = 10_000_000;

const FORMS: &str = "a list of values, one number or word, {\"linspace\": [from, to, count]} or {\"geomspace\": [...]}";

/// The values of an axis, at least one. A spaced range is computed value by value, so that a long one costs nothing.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Values {
    /// As listed.
    Listed(ValueColumn),
    /// From one end to the other.
    Spaced {
        /// The first value.
        from: f64,
        /// The last value.
        to: f64,
        /// The place of the last value.
        last: usize,
        /// Whether ratios are even, not differences.
        geometric: bool,
    },
}

impl Values {
    /// Reads the values of an axis.
    pub(super) fn read(file: &Path, key: &str, written: &Value) -> Result<Self, Refusal> {
        match written {
            Value::Array(list) if list.is_empty() => {
                Err(Refusal::new(file, key, "an empty list", "at least one value"))
            }
            Value::Array(list) => Ok(Self::Listed(list.iter().map(Cell::from).collect())),
            Value::Number(_) | Value::String(_) | Value::Bool(_) => {
                Ok(Self::Listed(std::iter::once(Cell::from(written)).collect()))
            }
            Value::Object(map) => match map.iter().next() {
                Some((form, ends)) if map.len() == 1 && (form == "linspace" || form == "geomspace") => {
                    spaced(file, &format!("{key}.{form}"), form == "geomspace", ends)
                }
                Some((form, _)) if map.len() == 1 => {
                    let known = ["linspace".to_owned(), "geomspace".to_owned()];
                    Err(Refusal::unknown_key(file, format!("{key}.{form}"), form, &known))
                }
                _ => Err(Refusal::new(
                    file,
                    key,
                    format!("an object of {} keys", map.len()),
                    FORMS,
                )),
            },
            Value::Null => Err(Refusal::new(file, key, written, FORMS)),
        }
    }

    /// Number of values.
    pub(super) fn len(&self) -> usize {
        match self {
            Self::Listed(values) => values.len(),
            Self::Spaced { last, .. } => last + 1,
        }
    }

    /// The value at a place below the number of values; both ends of a range are exact.
    pub(super) fn at(&self, place: usize) -> Cell<'_> {
        match *self {
            Self::Listed(ref values) => values.at(place),
            Self::Spaced {
                from,
                to,
                last,
                geometric,
            } => {
                let s = place as f64 / last as f64;
                Cell::written(match place {
                    0 => from,
                    place if place == last => to,
                    _ if geometric => rounded(from * (to / from).powf(s)),
                    _ => rounded(from + (to - from) * s),
                })
            }
        }
    }
}

/// A computed value to 15 significant digits, which every decimal of so many digits survives: the third of `[0, 0.3, 4]` is
/// the number that a person writes as 0.2.
pub(super) fn rounded(x: f64) -> f64 {
    format!("{x:.14e}").parse().unwrap_or(x)
}

/// A list of so many numbers; none where it is anything else.
pub(super) fn numbers<const N: usize>(list: &Value) -> Option<[f64; N]> {
    let numbers: Option<Vec<f64>> = list.as_array()?.iter().map(Value::as_f64).collect();
    numbers?.try_into().ok()
}

/// The range of `[from, to, count]`.
fn spaced(file: &Path, key: &str, geometric: bool, ends: &Value) -> Result<Values, Refusal> {
    let refuse = |found: FoundValue, allowed: &str| Err(Refusal::new(file, key, found, allowed));
    let Some([from, to, count]) = numbers(ends) else {
        return refuse(ends.into(), "[from, to, count], three numbers");
    };
    if count.fract() != 0.0 || !(2.0..=MOST_POINTS as f64).contains(&count) {
        return refuse(
            FoundValue::from(count).which("as the count"),
            "a whole count from 2 to 10000000",
        );
    }
    if geometric && !(from > 0.0 && to > 0.0) {
        return refuse(format!("from {from} to {to}").into(), "both ends above 0");
    }
    let span = if geometric { (to / from).ln() } else { to - from };
    if !span.is_finite() {
        let found = format!("from {from:e} to {to:e}");
        return refuse(found.into(), "ends that are not so far apart");
    }
    Ok(Values::Spaced {
        from,
        to,
        last: count as usize - 1,
        geometric,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use serde_json::json;

    fn values(written: Value) -> Vec<f64> {
        let values = Values::read(Path::new("study.json"), "axis", &written).unwrap();
        (0..values.len()).map(|i| values.at(i).number().unwrap()).collect()
    }

    #[test]
    fn ranges_hold_both_ends_exactly_and_are_even_between() {
        let line = values(json!({"linspace": [0.1, 0.7, 7]}));
        assert_eq!((line.len(), line[0], line[6]), (7, 0.1, 0.7));
        for pair in line.windows(2) {
            assert!((pair[1] - pair[0] - 0.1).abs() < 1e-15, "{line:?}");
        }
        let ratio = values(json!({"geomspace": [0.1, 1000, 5]}));
        assert_eq!((ratio[0], ratio[4]), (0.1, 1000.0));
        for pair in ratio.windows(2) {
            assert!((pair[1] / pair[0] - 10.0).abs() < 1e-12, "{ratio:?}");
        }
        assert_eq!(values(json!({"linspace": [3, 1, 3]})), [3.0, 2.0, 1.0]);
    }

    #[test]
    fn values_of_a_range_are_the_numbers_that_a_person_writes() {
        assert_eq!(values(json!({"linspace": [0, 0.3, 4]})), [0.0, 0.1, 0.2, 0.3]);
        assert_eq!(
            values(json!({"linspace": [0, 1, 11]})),
            [0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0]
        );
        assert_eq!(
            values(json!({"geomspace": [0.001, 10, 5]})),
            [0.001, 0.01, 0.1, 1.0, 10.0]
        );
        assert_eq!(values(json!({"linspace": [1e-300, 3e-300, 3]}))[1], 2e-300);
    }

    #[test]
    fn ends_too_far_apart_for_their_difference_are_refused() {
        for written in [
            json!({"linspace": [-1.7e308, 1.7e308, 3]}),
            json!({"geomspace": [1e-300, 1e300, 3]}),
            json!({"geomspace": [1e300, 1e-300, 3]}),
        ] {
            let e = Values::read(Path::new("study.json"), "axis", &written).unwrap_err();
            assert_eq!(e.allowed, "ends that are not so far apart", "{e}");
        }
    }

    proptest! {
        #[test]
        fn a_range_of_any_ends_has_its_count_and_its_ends_and_runs_one_way(
            (from, to, count) in (1e-3..1e6_f64, 1e-3..1e6_f64, 2_usize..300),
            form in prop_oneof![Just("linspace"), Just("geomspace")],
        ) {
            let found = values(json!({ form: [from, to, count] }));
            prop_assert_eq!(found.len(), count);
            prop_assert_eq!((found[0], found[count - 1]), (from, to));
            prop_assert!(found.windows(2).all(|pair| (pair[1] - pair[0]) * (to - from) >= 0.0));
        }
    }
}
