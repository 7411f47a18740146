//! How a process says in the journal that it came to its own end.
//!
//! Knows the clock. Does not know what was solved.

use pontoon_journal::SessionEnd;
use pontoon_results::Moment;

/// A process that comes to its own end now, and how.
pub fn ended_now(how: &str) -> SessionEnd {
    ending(how.to_owned(), 0.0, 0.0)
}

/// A process that comes to its own end now, how, and what it took.
pub(super) fn ending(how: String, offline_s: f64, jobs_s: f64) -> SessionEnd {
    SessionEnd {
        finished: Moment::now().text(),
        how,
        offline_s,
        jobs_s,
    }
}
