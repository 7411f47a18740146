//! Why a job failed: its kind, the numbers that tell this failure from others of the kind, and its words.
//!
//! Knows the kinds of failures. Does not know how a job is solved.

use serde::{Deserialize, Serialize};

/// Why a job failed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Failure {
    /// Its kind.
    pub kind: FailureKind,
    /// The numbers of this one, each under its name, which ends in its unit.
    pub numbers: Vec<(String, f64)>,
    /// In words.
    pub text: String,
}

/// What failed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FailureKind {
    /// The contacts of a crossing did not settle at any step size allowed.
    ContactNotSettled,
    /// The contacts of a static case did not settle.
    StaticContactNotSettled,
    /// The bridge has no state at rest under its dead load, or none was found.
    NoDeadState,
    /// A number left the finite range.
    NotFinite,
    /// The peak force still changed at the finest time step.
    PeakForceNotSettled,
    /// The crossing has more time steps than it may.
    TooManySteps,
    /// The histories are longer than a record may be.
    HistoriesTooLong,
    /// The module, the bridge or a solver of it could not be made.
    NotPrepared,
    /// A mode that is needed was not found.
    ModeMissing,
    /// The process died while the job ran, or while its bridge was prepared.
    ProcessDied,
    /// The run was stopped before the job's bridge was prepared.
    Stopped,
    /// Limits do not hold at the end of a bracket where they are to.
    BracketFails,
    /// Limits hold over the whole bracket.
    BracketPasses,
    /// Finer solvers find no pair of values of which one passes and the next fails.
    RatingNotSettled,
    /// The program is at fault.
    ProgramError,
}

impl FailureKind {
    /// All kinds.
    pub const ALL: [Self; 15] = [
        Self::ContactNotSettled,
        Self::StaticContactNotSettled,
        Self::NoDeadState,
        Self::NotFinite,
        Self::PeakForceNotSettled,
        Self::TooManySteps,
        Self::HistoriesTooLong,
        Self::NotPrepared,
        Self::ModeMissing,
        Self::ProcessDied,
        Self::Stopped,
        Self::BracketFails,
        Self::BracketPasses,
        Self::RatingNotSettled,
        Self::ProgramError,
    ];

    /// The words of all kinds.
    pub const WORDS: [&'static str; Self::ALL.len()] = {
        let mut words = [""; Self::ALL.len()];
        let mut i = 0;
        while i < words.len() {
            words[i] = Self::ALL[i].word();
            i += 1;
        }
        words
    };

    /// Its word in tables.
    pub const fn word(self) -> &'static str {
        match self {
            Self::ContactNotSettled => "contact_not_settled",
            Self::StaticContactNotSettled => "static_contact_not_settled",
            Self::NoDeadState => "no_dead_state",
            Self::NotFinite => "not_finite",
            Self::PeakForceNotSettled => "peak_force_not_settled",
            Self::TooManySteps => "too_many_steps",
            Self::HistoriesTooLong => "histories_too_long",
            Self::NotPrepared => "not_prepared",
            Self::ModeMissing => "mode_missing",
            Self::ProcessDied => "process_died",
            Self::Stopped => "stopped",
            Self::BracketFails => "bracket_fails",
            Self::BracketPasses => "bracket_passes",
            Self::RatingNotSettled => "rating_not_settled",
            Self::ProgramError => "program_error",
        }
    }
}

impl Failure {
    /// A failure without numbers.
    pub fn new(kind: FailureKind, text: impl Into<String>) -> Self {
        Self {
            kind,
            numbers: Vec::new(),
            text: text.into(),
        }
    }

    /// Adds a number.
    #[must_use]
    pub fn with(mut self, name: &str, number: f64) -> Self {
        self.numbers.push((name.to_owned(), number));
        self
    }

    /// Puts words before and behind its own.
    #[must_use]
    pub fn said(self, before: &str, behind: &str) -> Self {
        Self {
            text: format!("{before}{}{behind}", self.text),
            ..self
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_word_of_a_kind_is_the_one_that_it_is_written_by() {
        for kind in FailureKind::ALL {
            assert_eq!(serde_json::to_value(kind).unwrap(), kind.word());
        }
    }
}
