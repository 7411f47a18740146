//! The values of an axis as they are written: a list, one value, an evenly spaced range.
//!
//! Knows the forms and that ranges hold both ends exactly. Does not know what an axis may be called.

use crate::document::canonical;
use crate::refusal::Refusal;
use serde_json::{Value, json};
use std::path::Path;

/// Most values of a range.
const MOST_VALUES: f64 = 1e6;

const FORMS: &str = "a list of values, one number or word, {\"linspace\": [from, to, count]} or {\"geomspace\": [...]}";

/// The values of an axis, at least one.
pub(super) fn axis_values(file: &Path, key: &str, written: &Value) -> Result<Vec<Value>, Refusal> {
    match written {
        Value::Array(list) if list.is_empty() => Err(Refusal::new(file, key, "an empty list", "at least one value")),
        Value::Array(list) => Ok(list.iter().map(canonical).collect()),
        Value::Number(_) | Value::String(_) | Value::Bool(_) => Ok(vec![canonical(written)]),
        Value::Object(map) => match map.iter().next() {
            Some((form, ends)) if map.len() == 1 && (form == "linspace" || form == "geomspace") => {
                spaced(file, &format!("{key}.{form}"), form == "geomspace", ends)
            }
            Some((form, _)) if map.len() == 1 => {
                let known = ["linspace".to_owned(), "geomspace".to_owned()];
                Err(Refusal::unknown(file, format!("{key}.{form}"), form, &known))
            }
            _ => Err(Refusal::new(
                file,
                key,
                format!("an object of {} keys", map.len()),
                FORMS,
            )),
        },
        Value::Null => Err(Refusal::new(file, key, "null", FORMS)),
    }
}

/// The values of `[from, to, count]`, both ends exact.
fn spaced(file: &Path, key: &str, geometric: bool, ends: &Value) -> Result<Vec<Value>, Refusal> {
    let refuse = |found: String, allowed: &str| Err(Refusal::new(file, key, found, allowed));
    let numbers: Vec<f64> = ends
        .as_array()
        .into_iter()
        .flatten()
        .filter_map(Value::as_f64)
        .collect();
    let (&[from, to, count], Some(3)) = (numbers.as_slice(), ends.as_array().map(Vec::len)) else {
        return refuse(ends.to_string(), "[from, to, count], three numbers");
    };
    if count.fract() != 0.0 || !(2.0..=MOST_VALUES).contains(&count) {
        return refuse(format!("count {count}"), "a whole count from 2 to 1000000");
    }
    if geometric && !(from > 0.0 && to > 0.0) {
        return refuse(format!("from {from} to {to}"), "both ends above 0");
    }
    let last = count as usize - 1;
    let value = |i: usize| {
        let s = i as f64 / last as f64;
        match i {
            0 => from,
            i if i == last => to,
            _ if geometric => from * (to / from).powf(s),
            _ => from + (to - from) * s,
        }
    };
    Ok((0..=last).map(|i| canonical(&json!(value(i)))).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(written: Value) -> Vec<f64> {
        let values = axis_values(Path::new("study.json"), "axis", &written).unwrap();
        values.iter().map(|v| v.as_f64().unwrap()).collect()
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
}
