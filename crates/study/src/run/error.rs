//! Why a run did not come to its end.
//!
//! Knows who ended it. Does not know exit statuses.

use super::cancel::Why;
use super::pool::PoolError;
use super::progress::Tally;
use pontoon_journal::JournalError;
use std::error::Error as StdError;
use thiserror::Error;

/// Why a run did not come to its end.
#[derive(Debug, Error)]
pub enum RunError<E: StdError + 'static> {
    /// It could not begin.
    #[error(transparent)]
    Pool(#[from] PoolError),
    /// Its records were not taken.
    #[error(transparent)]
    Sink(E),
    /// The journal was not written or could not be read.
    #[error(transparent)]
    Journal(#[from] JournalError),
    /// It was asked to stop.
    #[error("stopped after {} of {} jobs", tally.done, tally.total)]
    Stopped {
        /// Why.
        why: Why,
        /// How far it came.
        tally: Tally,
    },
}
