//! What is told of a sweep: to people by the bar or lines, to signals' handler for whoever asks.
//!
//! Knows how this program is started again for work that is to be done apart. Does not know what runs.

use crate::progress::ProgressDisplay;
use crate::signals::Signals;
use crate::text;
use pontoon_journal::JournalWriter;
use pontoon_study::run::{Progress, Tally};
use pontoon_study::sweep::{Apart, ApartEnd, ApartTask, Watcher};
use std::ffi::OsString;
use std::path::PathBuf;
use std::process::{Command, ExitStatus, Stdio};
use std::sync::Arc;
use std::time::Duration;

/// Time between two looks whether a process has ended.
const BETWEEN_LOOKS: Duration = Duration::from_millis(10);

/// Who is told of a sweep.
pub(crate) struct Watching<'a> {
    shown: ProgressDisplay,
    signals: &'a Signals,
    again: Option<StartedAgain<'a>>,
}

/// How this program is started again for jobs of a study, in a process of its own.
pub struct StartedAgain<'a> {
    /// The start of the command line: the program, and what it needs before its first word.
    pub program: &'a [OsString],
    /// The study's file.
    pub study: PathBuf,
    /// Its folder of results.
    pub out: PathBuf,
}

impl StartedAgain<'_> {
    /// Does a task on jobs of a study in a process of its own and waits for its end; `stopped` says whether it is to end
    /// before. Nothing where no process can be started.
    pub fn work(&self, task: ApartTask, study: &str, jobs: &[usize], stopped: &dyn Fn() -> bool) -> Option<Apart> {
        let (program, before) = self.program.split_first()?;
        let numbers: Vec<String> = jobs.iter().map(ToString::to_string).collect();
        // its standard input tells it when this process is gone
        let mut child = Command::new(program)
            .args(before)
            .args(["run", "--quiet", "--apart", &format!("{study}:{}", numbers.join(","))])
            .args((task == ApartTask::Prepare).then_some("--prepare-only"))
            .arg("--out")
            .arg(&self.out)
            .arg(&self.study)
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
            if stopped() {
                input = None;
            }
            std::thread::sleep(BETWEEN_LOOKS);
        };
        drop(input);
        let end = end_of(ended);
        Some(Apart { process, end })
    }
}

/// How a process ended, by what the system says of it.
#[cfg(unix)]
fn end_of(ended: ExitStatus) -> ApartEnd {
    use std::os::unix::process::ExitStatusExt;
    /// The signal that no process can answer.
    const KILLED: i32 = 9;
    // a process that ends by itself has a status
    match (ended.code(), ended.signal()) {
        (None, Some(KILLED)) => ApartEnd::Killed,
        (None, _) => ApartEnd::Died,
        (Some(_), _) => ApartEnd::Own,
    }
}

/// How a process ended, by what the system says of it: Windows gives one that died the number of its fault, a negative one.
/// Who kills a process gives it a status there, so that it looks like one that ended by itself.
#[cfg(not(unix))]
fn end_of(ended: ExitStatus) -> ApartEnd {
    match ended.code() {
        Some(code) if code >= 0 => ApartEnd::Own,
        _ => ApartEnd::Died,
    }
}

impl<'a> Watching<'a> {
    /// Shows and counts.
    pub(crate) fn new(shown: ProgressDisplay, signals: &'a Signals, again: Option<StartedAgain<'a>>) -> Self {
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
        let again = self.again.as_ref()?;
        again.work(task, study, jobs, &|| self.signals.stop.is_asked())
    }
}
