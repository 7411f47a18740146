//! Work on a thread of its own while the thread of Python waits: interrupts are heard, other threads of Python run.
//!
//! Knows how work is told to stop and how far it has come. Does not know what it does.

use crate::errors::failed;
use pontoon_study::run::{CancelToken, Progress, Tally, Why};
use pyo3::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

/// Time between two looks for an interrupt.
const BETWEEN_LOOKS: Duration = Duration::from_millis(50);

/// Work that may be stopped, and how far it has come.
#[derive(Debug, Default)]
pub(crate) struct Watched {
    pub stop: Arc<CancelToken>,
    so_far: Mutex<SoFar>,
}

#[derive(Debug, Clone, Default)]
struct SoFar {
    stage: String,
    tally: Option<Tally>,
}

impl Watched {
    fn so_far(&self) -> SoFar {
        self.so_far.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

impl Progress for Watched {
    fn stage(&self, what: &str) {
        let mut so_far = self.so_far.lock().unwrap_or_else(PoisonError::into_inner);
        so_far.stage = what.to_owned();
    }

    fn jobs(&self, tally: Tally) {
        let mut so_far = self.so_far.lock().unwrap_or_else(PoisonError::into_inner);
        if so_far.tally.is_none_or(|last| last.done <= tally.done) {
            so_far.tally = Some(tally);
        }
    }
}

/// Does work and waits for it. `told(stage, done, failed, total)` is called now and then; an exception from there, as an
/// interrupt is one, stops the work and is raised once jobs under way have ended.
pub(crate) fn wait<T: Send>(
    py: Python<'_>,
    told: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(&Arc<Watched>) -> T + Send,
) -> PyResult<T> {
    let watched = Arc::new(Watched::default());
    let mut raised: Option<PyErr> = None;
    // a thread that has done its work is not finished yet when it wakes the other
    let is_done = AtomicBool::new(false);
    let done = thread::scope(|scope| {
        let (own, waiting, is_done) = (Arc::clone(&watched), thread::current(), &is_done);
        let worker = scope.spawn(move || {
            let result = work(&own);
            is_done.store(true, Ordering::Release);
            waiting.unpark();
            result
        });
        // one that panics does not wake
        let has_ended = || is_done.load(Ordering::Acquire) || worker.is_finished();
        while !has_ended() {
            py.detach(|| thread::park_timeout(BETWEEN_LOOKS));
            if raised.is_some() || has_ended() {
                continue;
            }
            if let Err(exception) = py.check_signals().and_then(|()| tell(told, &watched.so_far())) {
                watched.stop.ask(Why::Interrupted);
                raised = Some(exception);
            }
        }
        worker.join()
    });
    match (raised, done) {
        (Some(exception), _) => Err(exception),
        (None, Ok(result)) => Ok(result),
        (None, Err(_)) => Err(failed(py, &"program error: the engine panicked; see standard error")),
    }
}

fn tell(told: Option<&Bound<'_, PyAny>>, so_far: &SoFar) -> PyResult<()> {
    let Some(told) = told else {
        return Ok(());
    };
    let (done, failed, total) = so_far
        .tally
        .map_or((0, 0, 0), |tally| (tally.done, tally.failed, tally.total));
    told.call1((so_far.stage.as_str(), done, failed, total))?;
    Ok(())
}
