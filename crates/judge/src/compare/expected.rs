//! What a check expects, in words.
//!
//! Knows how a person writes a reference. Does not know results.

use crate::reference::{CheckKind, CheckSpec, Tolerance, Trend};

/// What a check expects, for people, and its value where it is one.
pub(super) fn expected(check: &CheckSpec) -> (String, Option<f64>) {
    let with = |value: f64, tolerance: Tolerance| {
        let relative = tolerance
            .relative
            .map(|share| format!(" +- {} %", short(100.0 * share)));
        let absolute = tolerance.absolute.map(|x| format!(" +- {}", short(x)));
        let both = [relative, absolute]
            .into_iter()
            .flatten()
            .collect::<Vec<_>>()
            .join(" or");
        (format!("{}{both}", short(value)), Some(value))
    };
    match check.kind() {
        Some(CheckKind::Value(v)) => match v.expected {
            Some(expected) => with(expected, v.tolerance()),
            None => ("-".to_owned(), None),
        },
        Some(CheckKind::Mode(m)) => with(m.expected_hz, m.tolerance()),
        Some(CheckKind::Measured(m)) => with(
            m.value,
            Tolerance {
                relative: None,
                absolute: Some(m.uncertainty),
            },
        ),
        Some(CheckKind::Bound(b)) => {
            let bounds = [(">=", b.at_least), (">", b.above), ("<=", b.at_most), ("<", b.below)];
            let given = bounds
                .iter()
                .filter_map(|(sign, x)| x.map(|x| format!("{sign} {}", short(x))));
            (given.collect::<Vec<_>>().join(", "), None)
        }
        Some(CheckKind::Trend(t)) => {
            let what = match t.trend {
                Trend::Rises => "rises".to_owned(),
                Trend::Falls => "falls".to_owned(),
                Trend::Positive => "positive".to_owned(),
                Trend::Negative => "negative".to_owned(),
                Trend::Flat => format!("flat within {} %", short(100.0 * t.within.unwrap_or_default())),
            };
            (format!("{what} over {}", t.along), None)
        }
        Some(CheckKind::Curve(c)) => {
            let (text, _) = with(0.0, c.tolerance());
            (
                format!("curve of {} points{}", c.points.len(), text.trim_start_matches('0')),
                None,
            )
        }
        None => (String::new(), None),
    }
}

/// A number of a reference as a person wrote it.
fn short(x: f64) -> String {
    if x != 0.0 && x.abs() < 1e-6 {
        return format!("{x:e}");
    }
    format!("{}", (x * 1e9).round() / 1e9)
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::{Value, json};

    #[test]
    fn what_is_expected_is_written_as_a_person_wrote_it() {
        let written = |check: Value| {
            let check: CheckSpec = serde_json::from_value(check).unwrap();
            expected(&check).0
        };
        let of = json!({ "number": 1 });
        let made = |kind: &str, what: Value| json!({ "id": "a", kind: what });
        for (kind, what, text) in [
            (
                "value",
                json!({ "of": of, "expected": 0.141, "relative_tolerance": 0.02 }),
                "0.141 +- 2 %",
            ),
            (
                "value",
                json!({ "of": of, "expected": 74, "relative_tolerance": 0.1, "absolute_tolerance": 3 }),
                "74 +- 10 % or +- 3",
            ),
            (
                "measured",
                json!({ "of": of, "value": 2, "uncertainty": 0.5 }),
                "2 +- 0.5",
            ),
            ("bound", json!({ "of": of, "at_least": 1, "at_most": 2 }), ">= 1, <= 2"),
            (
                "trend",
                json!({ "of": of, "along": "x", "trend": "flat", "within": 0.05 }),
                "flat within 5 % over x",
            ),
            (
                "trend",
                json!({ "of": of, "along": "x", "trend": "negative" }),
                "negative over x",
            ),
            (
                "mode",
                json!({ "shape": "heave", "expected_hz": 0.36, "relative_tolerance": 0.01 }),
                "0.36 +- 1 %",
            ),
            (
                "curve",
                json!({ "table": "jobs", "column": "a", "against": "b", "points": [[0, 1]], "absolute_tolerance": 0.1 }),
                "curve of 1 points +- 0.1",
            ),
        ] {
            assert_eq!(written(made(kind, what)), text);
        }
    }
}
