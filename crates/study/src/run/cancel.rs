//! A run that is asked to stop.
//!
//! Knows that jobs under way end and no other begins. Does not know who asks.

use std::sync::atomic::{AtomicU8, Ordering};

/// Asked of a run from any thread; the first to ask says why.
#[derive(Debug, Default)]
pub struct CancelToken(AtomicU8);

/// Why a run was stopped.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Why {
    /// Somebody wants it to.
    Interrupted,
    /// More jobs failed than may.
    Failures,
    /// The journal cannot be written.
    Journal,
}

impl CancelToken {
    /// Asks for a stop.
    pub fn ask(&self, why: Why) {
        let code = match why {
            Why::Interrupted => 1,
            Why::Failures => 2,
            Why::Journal => 3,
        };
        let _ = self.0.compare_exchange(0, code, Ordering::Relaxed, Ordering::Relaxed);
    }

    /// Whether and why a stop is asked for.
    pub fn why(&self) -> Option<Why> {
        match self.0.load(Ordering::Relaxed) {
            0 => None,
            1 => Some(Why::Interrupted),
            2 => Some(Why::Failures),
            _ => Some(Why::Journal),
        }
    }

    /// Whether a stop is asked for.
    pub fn is_asked(&self) -> bool {
        self.why().is_some()
    }
}
