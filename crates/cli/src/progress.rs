//! A bar on a terminal, plain lines otherwise.
//!
//! Knows terminals. Does not know what runs.

use crate::words;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use pontoon_study::run::{Progress, Tally};
use std::io::IsTerminal;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// How a run is shown.
pub enum Shown {
    /// Not at all.
    Not,
    /// As a bar: jobs done, rate, time left.
    Bar(ProgressBar),
    /// As lines, no more than one in a few seconds.
    Lines(Mutex<Lines>),
}

/// When lines were written.
pub struct Lines {
    began: Instant,
    last: Instant,
}

/// Time between two lines of progress.
const BETWEEN_LINES: Duration = Duration::from_secs(5);

impl Shown {
    /// What fits where standard error goes.
    pub fn fitting(quiet: bool) -> Self {
        match (quiet, std::io::stderr().is_terminal()) {
            (true, _) => Self::Not,
            (false, true) => {
                let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr_with_hz(5));
                bar.set_style(style("{spinner} {msg} ({elapsed})"));
                bar.enable_steady_tick(Duration::from_millis(200));
                Self::Bar(bar)
            }
            (false, false) => {
                let now = Instant::now();
                Self::Lines(Mutex::new(Lines { began: now, last: now }))
            }
        }
    }

    /// Takes the bar away.
    pub fn finish(&self) {
        if let Self::Bar(bar) = self {
            bar.finish_and_clear();
        }
    }
}

fn style(template: &str) -> ProgressStyle {
    ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar())
}

impl Progress for Shown {
    fn stage(&self, what: &str) {
        match self {
            Self::Not => {}
            Self::Bar(bar) => bar.set_message(what.to_owned()),
            Self::Lines(_) => words::note(what),
        }
    }

    fn jobs(&self, tally: Tally) {
        match self {
            Self::Not => {}
            Self::Bar(bar) if tally.ran == 0 => {
                bar.set_length(tally.total as u64);
                bar.set_style(style("{bar:30} {pos}/{len} jobs, {per_sec}, {eta} left{msg}"));
                bar.set_message("");
                bar.reset();
                bar.set_position(tally.done as u64);
                bar.reset_eta();
            }
            Self::Bar(bar) => {
                bar.set_position(bar.position().max(tally.done as u64));
                if tally.failed > 0 {
                    bar.set_message(format!(", {} failed", tally.failed));
                }
            }
            Self::Lines(lines) => {
                let mut lines = lines.lock().unwrap_or_else(PoisonError::into_inner);
                let now = Instant::now();
                if tally.ran == 0 {
                    lines.began = now;
                } else if tally.done == tally.total || now.duration_since(lines.last) >= BETWEEN_LINES {
                    lines.last = now;
                    words::note(&line(tally, now.duration_since(lines.began).as_secs_f64()));
                }
            }
        }
    }
}

fn line(tally: Tally, seconds: f64) -> String {
    let Tally {
        done,
        failed,
        total,
        ran,
    } = tally;
    let rate = ran as f64 / seconds.max(1e-9);
    let left = words::duration((total - done) as f64 / rate);
    let failed = if failed > 0 {
        format!(", {failed} failed")
    } else {
        String::new()
    };
    format!("{done}/{total} jobs{failed}, {rate:.2} jobs/s, {left} left")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_says_done_failed_rate_and_time_left() {
        let tally = Tally {
            done: 5,
            failed: 1,
            total: 20,
            ran: 5,
        };
        assert_eq!(line(tally, 10.0), "5/20 jobs, 1 failed, 0.50 jobs/s, 30 s left");
    }
}
