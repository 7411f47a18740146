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

/// Values of a spaced range up to which they are computed once: rounding one costs as much as all else about a point.
const COMPUTED_ONCE: usize = 10_000;

/// The values of an axis, at least one. A long spaced range is computed value by value, so that it costs nothing.
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
            Value::Array(list) => Self::listed(file, key, list.iter().map(Cell::from)),
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

    /// Values in a list.
    pub(super) fn listed(
        file: &Path,
        key: &str,
        cells: impl ExactSizeIterator<Item = Cell<'static>>,
    ) -> Result<Self, Refusal> {
        if cells.len() == 0 {
            return Err(Refusal::new(file, key, "an empty list", "at least one value"));
        }
        Ok(Self::Listed(cells.collect()))
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
    rounded_fast(x).unwrap_or_else(|| format!("{x:.14e}").parse().unwrap_or(x))
}

/// Powers of ten that floating-point numbers hold without loss.
const POWERS: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20,
    1e21, 1e22,
];

/// [`rounded`] without a text: the number times an exact power of ten is a whole number of 15 digits but for its fraction, and
/// a whole number below 2^53 over an exact power is the number nearest to that decimal. None for numbers out of range and
/// where rounding of the product could cross a half.
fn rounded_fast(x: f64) -> Option<f64> {
    let size = x.abs();
    if !(1e-8..1e15).contains(&size) {
        return None;
    }
    // the power that makes 15 digits before the point of it
    let guess = (14.0 - size.log10().floor()) as usize;
    let power = (guess.saturating_sub(1)..=guess + 1).find_map(|k| {
        let power = *POWERS.get(k)?;
        (1e14..1e15).contains(&(size * power)).then_some(power)
    })?;
    let scaled = size * power;
    let whole = scaled.floor();
    let fraction = scaled - whole;
    // half a unit in the last place of numbers up to 1e15 is 1/16
    if (fraction - 0.5).abs() < 0.07 {
        return None;
    }
    let digits = if fraction > 0.5 { whole + 1.0 } else { whole };
    Some((digits / power).copysign(x))
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
    let range = Values::Spaced {
        from,
        to,
        last: count as usize - 1,
        geometric,
    };
    if range.len() > COMPUTED_ONCE {
        return Ok(range);
    }
    let values = (0..range.len()).map(|place| range.at(place).owned());
    Ok(Values::Listed(values.collect()))
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
        /// The text has the last word: both ways give the same bits, also beside halves and powers of ten.
        #[test]
        fn rounding_is_that_of_the_text(
            x in prop_oneof![
                any::<f64>().prop_filter("finite", |x| x.is_finite()),
                (-1e9..1e9_f64),
                (0..2_000_000_000_000_000_u64, 0..22_i32).prop_map(|(n, k)| n as f64 / 10_f64.powi(k)),
                (-9..16_i32, -3..4_i64).prop_map(|(k, ulps)| {
                    f64::from_bits((10_f64.powi(k).to_bits() as i64 + ulps) as u64)
                }),
            ],
        ) {
            let text: f64 = format!("{x:.14e}").parse().unwrap();
            prop_assert_eq!(rounded(x).to_bits(), text.to_bits(), "{}", x);
        }

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
