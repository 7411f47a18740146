//! What a comparison comes to: a line a check.
//!
//! Knows verdicts and what they mean for the whole. Does not know how they were found.

use crate::checks::Role;
use pontoon_plan::input::Cell;
use pontoon_results::labels::{all_digits, as_written, counted, percent};
use serde::{Serialize, Serializer};

/// Digits of a value of a line.
pub(super) const DIGITS: usize = 4;

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

/// The columns of a case with their values, in their order.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct CaseColumns(pub Vec<(String, Cell<'static>)>);

impl Serialize for CaseColumns {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(column, cell)| (column, cell)))
    }
}

/// One case of a check: one combination of the columns that it is made for each of.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Case {
    /// The columns and their values.
    pub case: CaseColumns,
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
    pub(super) fn without_values(case: CaseColumns, reason: String) -> Self {
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
pub struct CheckResult {
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

impl CheckResult {
    /// The value of the worst case for people: one, or the steps of a trend.
    pub fn got(&self) -> String {
        match self.worst.values.as_slice() {
            [] => "-".to_owned(),
            values => {
                let texts: Vec<String> = values.iter().map(|v| all_digits(*v, DIGITS)).collect();
                texts.join(" -> ")
            }
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
        let columns = self.worst.case.0.iter();
        let place = columns.map(|(name, cell)| match cell {
            Cell::Nothing => format!("{name} null"),
            Cell::Number(x) => format!("{name} {}", as_written(*x)),
            other => format!("{name} {}", other.text()),
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
            .map(|n| format!("{} with remarks", counted(n, "other case")));
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
    pub lines: Vec<CheckResult>,
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

#[cfg(test)]
mod tests {
    use super::*;

    fn case(values: &[f64], margin: Option<f64>, deviation: Option<f64>) -> Case {
        Case {
            values: values.to_vec(),
            margin,
            deviation,
            ..Case::without_values(CaseColumns::default(), String::new())
        }
    }

    #[test]
    fn a_remark_names_the_worst_case_with_its_numbers_as_they_are_written() {
        let columns = [("load_n", Cell::Number(300_000.0)), ("gap_tension_m", Cell::Nothing)];
        let columns = columns.map(|(name, cell)| (name.to_owned(), cell));
        let of = |reason: Option<&str>| Case {
            reason: reason.map(str::to_owned),
            ..Case::without_values(CaseColumns(columns.to_vec()), String::new())
        };
        let result = CheckResult {
            id: "id".to_owned(),
            statement: None,
            role: Role::Record,
            expected: "-".to_owned(),
            expected_value: None,
            verdict: Verdict::Record,
            worst: of(None),
            cases: vec![of(None), of(Some("no job matches"))],
        };
        let expected = "worst of 2: load_n 300000, gap_tension_m null; 1 other case with remarks";
        assert_eq!(result.remark(), expected);
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
