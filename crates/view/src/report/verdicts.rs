//! A comparison as a page shows it.
//!
//! Knows the words of a line. Does not know how it was judged.

use pontoon_judge::checks::Role;
use pontoon_judge::compare::{CheckResult, Comparison, Verdict};
use serde::Serialize;

/// Results held against a reference.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Verdicts {
    /// Where the reference's numbers come from.
    pub source: String,
    /// The counts of all verdicts.
    pub tally: String,
    /// Whether nothing falls short.
    pub good: bool,
    /// A line a check.
    pub lines: Vec<VerdictLine>,
}

/// One check.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct VerdictLine {
    /// Its id.
    pub id: String,
    /// The statement behind it.
    pub statement: Option<String>,
    /// Its role.
    pub role: Role,
    /// What became of it.
    pub verdict: Verdict,
    /// The verdict in words.
    pub word: &'static str,
    /// How that is to be taken.
    pub tone: Tone,
    /// What is expected.
    pub expected: String,
    /// What was found.
    pub found: String,
    /// By how much that is off.
    pub deviation: String,
    /// How much was left.
    pub margin: String,
    /// Which case decided, and what else is to be said.
    pub note: String,
}

/// How a verdict is to be taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Tone {
    /// As it should be.
    Good,
    /// Not as it should be.
    Bad,
    /// Neither.
    Plain,
}

fn tone(verdict: Verdict) -> Tone {
    match verdict {
        Verdict::Holds => Tone::Good,
        Verdict::FallsShort => Tone::Bad,
        Verdict::ExpectedFail | Verdict::NowHolds | Verdict::Record => Tone::Plain,
    }
}

impl Verdicts {
    /// The lines of a comparison.
    pub(super) fn new(compared: &Comparison) -> Self {
        let line = |line: &CheckResult| VerdictLine {
            id: line.id.clone(),
            statement: line.statement.clone(),
            role: line.role,
            verdict: line.verdict,
            word: line.verdict.word(),
            tone: tone(line.verdict),
            expected: line.expected.clone(),
            found: line.got(),
            deviation: line.deviation(),
            margin: line.margin(),
            note: line.remark(),
        };
        Self {
            source: compared.source.clone(),
            tally: compared.tally(),
            good: compared.good(),
            lines: compared.lines.iter().map(line).collect(),
        }
    }
}
