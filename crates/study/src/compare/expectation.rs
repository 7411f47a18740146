//! What a check expects, in words.
//!
//! Knows the kinds of checks. Does not know results.

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
