//! What is told of a sweep: to people by the bar or lines, to signals' handler for whoever asks.
//!
//! Knows how this program is started again for jobs that are to be solved apart. Does not know what runs.

use crate::progress::Shown;
use crate::signals::Heard;
use crate::words;
use pontoon_study::journal::Writer;
use pontoon_study::run::{Progress, Tally};
use pontoon_study::sweep::{Apart, Watcher};
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::sync::Arc;

/// Who is told of a sweep.
pub struct Watching<'a> {
    shown: Shown,
    heard: &'a Heard,
    /// Study and folder of results, for a process of its own.
    again: Option<(PathBuf, PathBuf)>,
}

impl<'a> Watching<'a> {
    /// Shows and counts.
    pub fn new(shown: Shown, heard: &'a Heard, again: Option<(PathBuf, PathBuf)>) -> Self {
        Self { shown, heard, again }
    }

    /// Takes a bar away.
    pub fn finish(&self) {
        self.shown.finish();
    }
}

impl Progress for Watching<'_> {
    fn stage(&self, what: &str) {
        self.shown.stage(what);
    }

    fn jobs(&self, tally: Tally) {
        self.heard.count(tally);
        self.shown.jobs(tally);
    }
}

impl Watcher for Watching<'_> {
    fn note(&self, what: &str) {
        if !matches!(self.shown, Shown::Not) {
            words::note(what);
        }
    }

    fn warn(&self, what: &str) {
        words::note(what);
    }

    fn writing(&self, journal: &Arc<Writer>) {
        self.heard.writing(journal);
    }

    fn solve_apart(&self, jobs: &[usize]) -> Option<Apart> {
        let (study, out) = self.again.as_ref()?;
        let numbers: Vec<String> = jobs.iter().map(ToString::to_string).collect();
        // its standard input tells it when this process is gone
        let mut child = Command::new(std::env::current_exe().ok()?)
            .args(["run", "--quiet", "--apart", &numbers.join(",")])
            .arg("--out")
            .arg(out)
            .arg(study)
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .spawn()
            .ok()?;
        let (process, input) = (child.id(), child.stdin.take());
        let ended = child.wait().ok()?;
        drop(input);
        // a process that ends by itself has a status
        let died = ended.code().is_none();
        Some(Apart { process, died })
    }
}
