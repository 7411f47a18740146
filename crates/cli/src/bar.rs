//! The progress bar that stands on the terminal, if one does.
//!
//! Knows that a line of text and a bar must not stand in one line. Does not know what the bar shows.

use indicatif::ProgressBar;
use std::sync::{Mutex, PoisonError};

/// The bar that is on the terminal.
static BAR: Mutex<Option<ProgressBar>> = Mutex::new(None);

/// Writes on standard error with the bar out of the way.
pub(crate) fn aside(write: impl FnOnce()) {
    let bar = BAR.lock().unwrap_or_else(PoisonError::into_inner).clone();
    match bar {
        Some(bar) => bar.suspend(write),
        None => write(),
    }
}

pub(crate) fn set_bar(bar: Option<&ProgressBar>) {
    *BAR.lock().unwrap_or_else(PoisonError::into_inner) = bar.cloned();
}
