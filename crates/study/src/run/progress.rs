//! How a run tells what it is doing.
//!
//! Knows counts. Does not know terminals.

use super::record::JobRecord;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Jobs so far.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Tally {
    /// Jobs done, failed ones included.
    pub done: usize,
    /// Jobs failed.
    pub failed: usize,
    /// Jobs in all.
    pub total: usize,
}

/// Who wants to know. Calls come from any thread, tallies not necessarily in order.
pub trait Progress: Sync {
    /// A stage of the run begins.
    fn stage(&self, what: &str);
    /// The jobs so far.
    fn jobs(&self, tally: Tally);
}

/// Nobody wants to know.
#[derive(Debug, Clone, Copy, Default)]
pub struct Silent;

impl Progress for Silent {
    fn stage(&self, _: &str) {}
    fn jobs(&self, _: Tally) {}
}

/// Jobs counted as they are done, whatever thread tells it.
pub(super) struct Count<'a> {
    done: AtomicUsize,
    failed: AtomicUsize,
    total: usize,
    progress: &'a dyn Progress,
}

impl<'a> Count<'a> {
    /// Nothing is done yet, which is told.
    pub(super) fn new(total: usize, progress: &'a dyn Progress) -> Self {
        let (done, failed) = (0, 0);
        progress.jobs(Tally { done, failed, total });
        let (done, failed) = (AtomicUsize::new(done), AtomicUsize::new(failed));
        Self {
            done,
            failed,
            total,
            progress,
        }
    }

    /// A job is done.
    pub(super) fn done(&self, record: &JobRecord) {
        let fails = usize::from(record.reason.is_some());
        let failed = self.failed.fetch_add(fails, Ordering::Relaxed) + fails;
        let done = self.done.fetch_add(1, Ordering::Relaxed) + 1;
        let total = self.total;
        self.progress.jobs(Tally { done, failed, total });
    }
}
