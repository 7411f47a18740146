//! What is told of a sweep: to people by the bar or lines, to signals' handler for whoever asks.
//!
//! Knows how this program is started again for work that is to be done apart. Does not know what runs.

use crate::progress::ProgressDisplay;
use crate::signals::Signals;
use crate::text;
use pontoon_journal::JournalWriter;
use pontoon_study::run::{Progress, Tally};
use pontoon_study::sweep::{Apart, ApartEnd, ApartTask, Watcher};
use std::os::unix::process::ExitStatusExt;
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::sync::Arc;
use std::time::Duration;

/// Time between two looks whether a process has ended.
const BETWEEN_LOOKS: Duration = Duration::from_millis(10);

/// The signal that no process can answer.
const KILLED: i32 = 9;

/// Who is told of a sweep.
pub(crate) struct Watching<'a> {
    shown: ProgressDisplay,
    signals: &'a Signals,
    /// Study and folder of results, for a process of its own.
    again: Option<(PathBuf, PathBuf)>,
}

impl<'a> Watching<'a> {
    /// Shows and counts.
    pub(crate) fn new(shown: ProgressDisplay, signals: &'a Signals, again: Option<(PathBuf, PathBuf)>) -> Self {
        Self { shown, signals, again }
    }

    /// Takes a bar away.
    pub(crate) fn finish(&self) {
        self.shown.finish();
    }
}

impl Progress for Watching<'_> {
    fn stage(&self, what: &str) {
        self.shown.stage(what);
    }

    fn jobs(&self, tally: Tally) {
        self.signals.count(tally);
        self.shown.jobs(tally);
    }
}

impl Watcher for Watching<'_> {
    fn note(&self, what: &str) {
        if !matches!(self.shown, ProgressDisplay::Not) {
            text::note(what);
        }
    }

    fn warn(&self, what: &str) {
        text::note(what);
    }

    fn writing(&self, journal: &Arc<JournalWriter>) {
        self.signals.writing(journal);
    }

    fn work_apart(&self, task: ApartTask, study: &str, jobs: &[usize]) -> Option<Apart> {
        let (file, out) = self.again.as_ref()?;
        let numbers: Vec<String> = jobs.iter().map(ToString::to_string).collect();
        // its standard input tells it when this process is gone
        let mut child = Command::new(std::env::current_exe().ok()?)
            .args(["run", "--quiet", "--apart", &format!("{study}:{}", numbers.join(","))])
            .args((task == ApartTask::Prepare).then_some("--prepare-only"))
            .arg("--out")
            .arg(out)
            .arg(file)
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .spawn()
            .ok()?;
        let process = child.id();
        let mut input = child.stdin.take();
        let ended = loop {
            if let Some(ended) = child.try_wait().ok()? {
                break ended;
            }
            if self.signals.stop.is_asked() {
                input = None;
            }
            std::thread::sleep(BETWEEN_LOOKS);
        };
        drop(input);
        // a process that ends by itself has a status
        let end = match (ended.code(), ended.signal()) {
            (None, Some(KILLED)) => ApartEnd::Killed,
            (None, _) => ApartEnd::Died,
            (Some(_), _) => ApartEnd::Own,
        };
        Some(Apart { process, end })
    }
}
