//! How a command ended that could go on to its end.
//!
//! Knows good and short. Does not know exit statuses of errors.

/// How a command ended that could go on to its end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ExitStatus {
    /// All good.
    Good,
    /// Something fell short.
    Short,
}

impl ExitStatus {
    /// How two things ended that were asked for at once.
    pub(crate) fn and(self, other: Self) -> Self {
        if self == Self::Good { other } else { self }
    }
}
