//! A command that another process calls as a function: what it writes is handed to the caller.
//!
//! Knows that a command writes from the thread that runs it. Does not know what commands say.

use pontoon_study::run::{CancelToken, Progress};
use std::cell::RefCell;
use std::ffi::OsString;
use std::sync::Arc;

/// Who calls a command.
#[derive(Clone)]
pub struct Caller {
    /// Ends what runs, in place of signals.
    pub stop: Arc<CancelToken>,
    /// Is told how far a run has come.
    pub progress: Arc<dyn Progress + Send + Sync>,
    /// The start of a command line that starts the program as a process of its own.
    pub again: Vec<OsString>,
}

/// What a command left that was called.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Called {
    /// What it writes on standard output.
    pub result: String,
    /// Its lines on standard error.
    pub notes: Vec<String>,
    /// Whether nothing fell short.
    pub good: bool,
}

/// A call under way.
struct Call {
    caller: Caller,
    result: Vec<u8>,
    notes: Vec<String>,
}

thread_local! {
    static CALL: RefCell<Option<Call>> = const { RefCell::new(None) };
}

/// Runs a command for a caller; whether nothing fell short, with what it wrote.
pub(crate) fn called<E>(caller: Caller, command: impl FnOnce() -> Result<bool, E>) -> Result<Called, E> {
    let call = Call {
        caller,
        result: Vec::new(),
        notes: Vec::new(),
    };
    CALL.with_borrow_mut(|current| *current = Some(call));
    let ended = command();
    let call = CALL.with_borrow_mut(Option::take);
    ended.map(|good| {
        let (result, notes) = call.map(|call| (call.result, call.notes)).unwrap_or_default();
        Called {
            result: String::from_utf8_lossy(&result).into_owned(),
            notes,
            good,
        }
    })
}

/// The caller of the command that this thread runs.
pub(crate) fn caller() -> Option<Caller> {
    CALL.with_borrow(|call| call.as_ref().map(|call| call.caller.clone()))
}

/// Keeps a line for the caller; whether there is one.
pub(crate) fn keep_note(line: &str) -> bool {
    CALL.with_borrow_mut(|call| call.as_mut().map(|call| call.notes.push(line.to_owned())).is_some())
}

/// Keeps a part of the result for the caller; whether there is one.
pub(crate) fn keep_result(bytes: &[u8]) -> bool {
    CALL.with_borrow_mut(|call| call.as_mut().map(|call| call.result.extend(bytes)).is_some())
}
