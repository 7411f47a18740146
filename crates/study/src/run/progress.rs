//! How a run tells what it is doing.
//!
//! Knows counts. Does not know terminals.

/// Jobs so far.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Tally {
    /// Jobs done, failed ones included.
    pub done: usize,
    /// Jobs failed.
    pub failed: usize,
    /// Jobs in all.
    pub total: usize,
    /// Jobs that this run has done: the others were recorded before.
    pub ran: usize,
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
