//! What a comparison comes to: a line a check.
//!
//! Knows verdicts and what they mean for the whole. Does not know how they were found.

use crate::reference::Role;
use serde::Serialize;
use serde_json::{Map, Value};

/// What became of a check.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// It holds.
    Holds,
    /// It does not, or there was nothing to make it on.
    FallsShort,
    /// It does not hold, as expected.
    ExpectedFail,
    /// It was expected to fail and holds.
    NowHolds,
    /// It is a record.
    Record,
}

impl Verdict {
    /// Its word for people.
    pub fn word(self) -> &'static str {
        match self {
            Self::Holds => "holds",
            Self::FallsShort => "FALLS SHORT",
            Self::ExpectedFail => "fails as expected",
            Self::NowHolds => "CHANGED: holds now",
            Self::Record => "record",
        }
    }
}

/// One case of a check: one combination of the columns that it is made for each of.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Case {
    /// The columns and their values.
    pub case: Map<String, Value>,
    /// The values found: one, or one for each value of the axis of a trend.
    pub values: Vec<f64>,
    /// By how much the value is off, as a share of what is expected (in its own unit where that is zero).
    pub deviation: Option<f64>,
    /// How much was left, as a share: of what is expected, of the bound, of the larger neighbour of a trend.
    pub margin: Option<f64>,
    /// Whether it holds.
    pub holds: bool,
    /// Why nothing was found, or what else is to be said.
    pub reason: Option<String>,
}

impl Case {
    /// Whether it decides before another: nothing found before something, the lesser margin before the larger, and where
    /// there are no margins the larger deviation.
    pub(super) fn is_worse_than(&self, other: &Self) -> bool {
        let found = |case: &Self| u8::from(!case.values.is_empty());
        let left = |case: &Self| {
            let off = case.deviation.map_or(0.0, |share| -share.abs());
            case.margin.unwrap_or(off)
        };
        found(self)
            .cmp(&found(other))
            .then(left(self).total_cmp(&left(other)))
            .is_lt()
    }

    /// A case for which nothing was found.
    pub(super) fn without_values(case: Map<String, Value>, reason: String) -> Self {
        Self {
            case,
            values: Vec::new(),
            deviation: None,
            margin: None,
            holds: false,
            reason: Some(reason),
        }
    }
}

/// One check.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Line {
    /// Its id.
    pub id: String,
    /// The statement behind it.
    pub statement: Option<String>,
    /// Its role.
    pub role: Role,
    /// What is expected, for people.
    pub expected: String,
    /// The value that is expected, where it is one.
    pub expected_value: Option<f64>,
    /// What became of it.
    pub verdict: Verdict,
    /// The case with the least margin; of a check without cases its only one.
    pub worst: Case,
    /// All cases, where there are several.
    pub cases: Vec<Case>,
}

impl Line {
    /// The value of the worst case for people: one, or the steps of a trend.
    pub fn got(&self) -> String {
        match self.worst.values.as_slice() {
            [] => "-".to_owned(),
            values => values.iter().map(|v| number(*v)).collect::<Vec<_>>().join(" -> "),
        }
    }

    /// The deviation of the worst case for people.
    pub fn deviation(&self) -> String {
        self.worst.deviation.map_or("-".to_owned(), percent)
    }

    /// The margin of the worst case for people.
    pub fn margin(&self) -> String {
        self.worst.margin.map_or("-".to_owned(), percent)
    }

    /// Which case is the worst and what else is to be said.
    pub fn remark(&self) -> String {
        let place = self.worst.case.iter().map(|(name, value)| match value {
            Value::String(word) => format!("{name} {word}"),
            other => format!("{name} {other}"),
        });
        let place = place.collect::<Vec<_>>().join(", ");
        let cases = match self.cases.len() {
            0 | 1 => place,
            n => format!("worst of {n}: {place}"),
        };
        let held = self.cases.iter().filter(|case| case.holds).count();
        let some_hold = (self.verdict == Verdict::ExpectedFail && held > 0)
            .then(|| format!("{held} of {} cases hold", self.cases.len()));
        let other = self
            .cases
            .iter()
            .filter(|case| case.reason.is_some() && case.reason != self.worst.reason);
        let others = Some(other.count())
            .filter(|n| *n > 0)
            .map(|n| format!("{n} other cases with remarks"));
        [
            Some(cases).filter(|c| !c.is_empty()),
            some_hold,
            self.worst.reason.clone(),
            others,
        ]
        .into_iter()
        .flatten()
        .collect::<Vec<_>>()
        .join("; ")
    }
}

/// All lines of a comparison.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Comparison {
    /// Name of the study whose results were held.
    pub results: String,
    /// Name of what they were held against.
    pub with: String,
    /// Where its numbers come from.
    pub source: String,
    /// What else is to be said of the results as a whole.
    pub notes: Vec<String>,
    /// The checks in the order of the reference.
    pub lines: Vec<Line>,
}

impl Comparison {
    /// How many lines have a verdict.
    pub fn count(&self, verdict: Verdict) -> usize {
        self.lines.iter().filter(|line| line.verdict == verdict).count()
    }

    /// Whether nothing falls short.
    pub fn good(&self) -> bool {
        self.count(Verdict::FallsShort) == 0
    }

    /// The counts of all verdicts in one line.
    pub fn tally(&self) -> String {
        format!(
            "{} hold, {} fall short, {} fail as expected, {} changed, {} recorded",
            self.count(Verdict::Holds),
            self.count(Verdict::FallsShort),
            self.count(Verdict::ExpectedFail),
            self.count(Verdict::NowHolds),
            self.count(Verdict::Record)
        )
    }
}

/// A number with four digits.
pub(super) fn number(x: f64) -> String {
    if x == 0.0 || !x.is_finite() {
        return format!("{x}");
    }
    let digits = x.abs().log10().floor() as i32;
    if (-5..9).contains(&digits) {
        let decimals = usize::try_from(3 - digits).unwrap_or(0);
        format!("{x:.decimals$}")
    } else {
        format!("{x:.3e}")
    }
}

fn percent(share: f64) -> String {
    let x = 100.0 * share;
    if x != 0.0 && x.abs() < 0.005 {
        format!("{x:+.0e} %")
    } else {
        format!("{x:+.2} %")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_four_digits() {
        let texts = [0.141_234, 74.0, 230_300.0, -0.000_123_46, 0.0, 1e12, 9.9999].map(number);
        assert_eq!(
            texts,
            ["0.1412", "74.00", "230300", "-0.0001235", "0", "1.000e12", "10.000"]
        );
        assert_eq!([0.021, -0.000_04, 1e-9].map(percent), ["+2.10 %", "-4e-3 %", "+1e-7 %"]);
    }

    fn case(values: &[f64], margin: Option<f64>, deviation: Option<f64>) -> Case {
        Case {
            values: values.to_vec(),
            margin,
            deviation,
            ..Case::without_values(Map::new(), String::new())
        }
    }

    #[test]
    fn nothing_found_is_worse_than_any_margin_and_a_lesser_margin_than_a_larger() {
        let (nothing, short, good) = (
            case(&[], None, None),
            case(&[1.0], Some(-2.0), Some(2.0)),
            case(&[1.0], Some(0.1), Some(0.0)),
        );
        assert!(nothing.is_worse_than(&short) && short.is_worse_than(&good) && nothing.is_worse_than(&good));
        assert!(!good.is_worse_than(&good) && !short.is_worse_than(&nothing));
        let (near, far) = (case(&[1.0], None, Some(0.01)), case(&[1.0], None, Some(-0.02)));
        assert!(far.is_worse_than(&near) && !near.is_worse_than(&far));
        assert!(nothing.is_worse_than(&far));
    }
}
