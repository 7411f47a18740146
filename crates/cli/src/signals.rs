//! Interrupts and questions from outside.
//!
//! Knows what SIGINT, SIGTERM and SIGUSR1 ask of a run. Does not know how a run stops.

use crate::caller::caller;
use pontoon_journal::JournalWriter;
use pontoon_study::run::{CancelToken, Tally};
use std::sync::{Arc, Mutex, PoisonError, Weak};
#[cfg(unix)]
use {crate::text, pontoon_study::run::Why, pontoon_study::sweep::ended_now};

/// Exit status of a run that was interrupted.
#[cfg(unix)]
const INTERRUPTED: i32 = 130;

/// What signals act on.
#[derive(Debug, Default)]
pub(crate) struct Signals {
    /// The run is to stop.
    pub stop: Arc<CancelToken>,
    journal: Mutex<Weak<JournalWriter>>,
    tally: Mutex<Option<Tally>>,
}

impl Signals {
    /// Listens from now on; where the command is called, nothing but the caller's word stops it. Elsewhere than on Unix nothing
    /// is heard: Ctrl-C ends the process at once, as a death does, and the same command goes on from the journal.
    ///
    /// # Errors
    /// What the system says.
    pub(crate) fn listen() -> std::io::Result<Arc<Self>> {
        if let Some(caller) = caller() {
            return Ok(Arc::new(Self {
                stop: caller.stop,
                ..Self::default()
            }));
        }
        let signals = Arc::new(Self::default());
        #[cfg(unix)]
        signals.hear()?;
        Ok(signals)
    }

    /// The journal that is being written.
    pub(crate) fn writing(&self, journal: &Arc<JournalWriter>) {
        *self.journal.lock().unwrap_or_else(PoisonError::into_inner) = Arc::downgrade(journal);
    }

    /// How far the run has come.
    pub(crate) fn count(&self, tally: Tally) {
        let mut last = self.tally.lock().unwrap_or_else(PoisonError::into_inner);
        if last.is_none_or(|last| last.done <= tally.done) {
            *last = Some(tally);
        }
    }
}

/// What signals of Unix do.
#[cfg(unix)]
impl Signals {
    /// Answers signals on a thread of its own.
    fn hear(self: &Arc<Self>) -> std::io::Result<()> {
        use signal_hook::consts::{SIGINT, SIGTERM, SIGUSR1};
        let mut received = signal_hook::iterator::Signals::new([SIGINT, SIGTERM, SIGUSR1])?;
        let own = Arc::clone(self);
        let mut interrupted = false;
        std::thread::Builder::new().name("signals".to_owned()).spawn(move || {
            for signal in received.forever() {
                if signal == SIGUSR1 {
                    own.answer();
                } else if interrupted {
                    own.end_at_once();
                    std::process::exit(INTERRUPTED);
                } else {
                    interrupted = true;
                    own.stop.ask(Why::Interrupted);
                    text::note("interrupted: jobs under way are finished; once more stops at once");
                }
            }
        })?;
        Ok(())
    }

    /// Says in the journal that this was no death.
    fn end_at_once(&self) {
        let journal = self.journal.lock().unwrap_or_else(PoisonError::into_inner).upgrade();
        if let Some(journal) = journal {
            journal.end_at_once(&ended_now("interrupted"));
        }
    }

    /// Syncs the journal and says how far the run has come.
    fn answer(&self) {
        let journal = self.journal.lock().unwrap_or_else(PoisonError::into_inner).upgrade();
        let synced = match journal.map(|journal| journal.sync()) {
            None => "no journal yet".to_owned(),
            Some(Ok(())) => "journal synced".to_owned(),
            Some(Err(error)) => error.to_string(),
        };
        let tally = *self.tally.lock().unwrap_or_else(PoisonError::into_inner);
        text::note(&match tally {
            None => format!("preparing, {synced}"),
            Some(Tally {
                done, failed, total, ..
            }) => format!("{done}/{total} jobs done, {failed} failed, {synced}"),
        });
    }
}
