//! A bar on a terminal, plain lines otherwise.
//!
//! Knows terminals. Does not know what runs.

use crate::bar::set_bar;
use crate::caller::{Caller, caller};
use crate::terminal::TextStyle;
use crate::text;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use pontoon_study::run::{Progress, Tally};
use std::io::IsTerminal;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};
use unicode_width::UnicodeWidthStr;

/// How a run is shown.
pub(crate) enum ProgressDisplay {
    /// Not at all.
    Not,
    /// As a bar with what a line says beside it.
    Bar(ProgressBar, Mutex<Pace>),
    /// To the caller of the command.
    Caller(Caller),
    /// As lines, no more than one in a few seconds.
    Lines(Mutex<Pace>),
}

/// When jobs began, and what was last said of them.
pub(crate) struct Pace {
    began: Instant,
    last: Instant,
    most: usize,
}

/// Time between two lines of progress.
const BETWEEN_LINES: Duration = Duration::from_secs(5);

/// Characters of the longest bar and of the shortest that shows anything.
const LONGEST_BAR: usize = 24;
const SHORTEST_BAR: usize = 5;
/// Characters of most lines beside the bar.
const BESIDE_BAR: usize = 62;

impl ProgressDisplay {
    /// What fits where standard error goes.
    pub(crate) fn fitting(quiet: bool) -> Self {
        if let Some(caller) = caller() {
            return Self::Caller(caller);
        }
        let now = Instant::now();
        let pace = Mutex::new(Pace {
            began: now,
            last: now,
            most: 0,
        });
        match (quiet, std::io::stderr().is_terminal()) {
            (true, _) => Self::Not,
            (false, true) => {
                let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr_with_hz(5));
                bar.set_style(style("{spinner} {msg} ({elapsed})"));
                bar.enable_steady_tick(Duration::from_millis(200));
                set_bar(Some(&bar));
                Self::Bar(bar, pace)
            }
            (false, false) => Self::Lines(pace),
        }
    }

    /// Takes the bar away.
    pub(crate) fn finish(&self) {
        if let Self::Bar(bar, _) = self {
            set_bar(None);
            bar.finish_and_clear();
        }
    }
}

fn style(template: &str) -> ProgressStyle {
    ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar())
}

/// Characters of the bar: none on a narrow terminal, where what is said is all.
fn bar_length(width: Option<usize>) -> usize {
    let left = width.map_or(LONGEST_BAR, |width| width.saturating_sub(BESIDE_BAR));
    if left < SHORTEST_BAR { 0 } else { left.min(LONGEST_BAR) }
}

fn bar_style(width: Option<usize>) -> ProgressStyle {
    match bar_length(width) {
        0 => style("{msg}"),
        length => style(&format!("{{bar:{length}}} {{msg}}")),
    }
}

impl Progress for ProgressDisplay {
    fn stage(&self, what: &str) {
        match self {
            Self::Not => {}
            Self::Bar(bar, _) => bar.set_message(what.to_owned()),
            Self::Lines(_) => text::note(what),
            Self::Caller(caller) => caller.progress.stage(what),
        }
    }

    fn jobs(&self, tally: Tally) {
        if let Self::Caller(caller) = self {
            caller.progress.jobs(tally);
        }
        let (Self::Bar(_, pace) | Self::Lines(pace)) = self else {
            return;
        };
        let mut pace = pace.lock().unwrap_or_else(PoisonError::into_inner);
        let now = Instant::now();
        if tally.ran == 0 {
            pace.began = now;
            pace.most = tally.done;
        }
        // tallies come in no order: what was said is not taken back
        if tally.done < pace.most {
            return;
        }
        pace.most = tally.done;
        let seconds = now.duration_since(pace.began).as_secs_f64();
        match self {
            Self::Bar(bar, _) => {
                let width = TextStyle::of_notes().width;
                if tally.ran == 0 {
                    bar.set_length(tally.total as u64);
                    bar.set_style(bar_style(width));
                }
                bar.set_position(tally.done as u64);
                bar.set_message(line(tally, seconds, width.map(|width| width - bar_length(Some(width)))));
            }
            _ if tally.ran == 0 && tally.done == 0 => {}
            _ if tally.ran == 0 || tally.done == tally.total || now.duration_since(pace.last) >= BETWEEN_LINES => {
                pace.last = now;
                text::note(&line(tally, seconds, None));
            }
            _ => {}
        }
    }
}

/// Done of all, failed so far, jobs a second, time left; of a run that goes on how many were there before. What does not fit
/// a width is left out: first what was there before, then the rate.
fn line(tally: Tally, seconds: f64, width: Option<usize>) -> String {
    let Tally {
        done,
        failed,
        total,
        ran,
    } = tally;
    let before = match done.saturating_sub(ran) {
        0 => String::new(),
        before => format!(" ({before} before)"),
    };
    let (rate, left) = if ran == 0 {
        Default::default()
    } else {
        let rate = ran as f64 / seconds.max(1e-9);
        let left = text::duration(total.saturating_sub(done) as f64 / rate);
        (format!(", {}", text::rate(rate)), format!(", {left} left"))
    };
    let said = |before: &str, rate: &str| format!("{done}/{total} jobs{before}, {failed} failed{rate}{left}");
    let fits = |said: &String| width.is_none_or(|width| said.width() < width);
    let all = [said(&before, &rate), said("", &rate)];
    all.into_iter().find(fits).unwrap_or_else(|| said("", ""))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tally(done: usize, ran: usize) -> Tally {
        Tally {
            done,
            failed: 1,
            total: 20,
            ran,
        }
    }

    #[test]
    fn a_line_says_done_failed_rate_and_time_left() {
        let said = line(tally(5, 5), 10.0, None);
        assert_eq!(said, "5/20 jobs, 1 failed, 0.50 jobs/s, 30 s left");
    }

    #[test]
    fn jobs_recorded_before_count_as_done_but_not_for_the_rate() {
        let said = line(tally(12, 2), 4.0, None);
        assert_eq!(said, "12/20 jobs (10 before), 1 failed, 0.50 jobs/s, 16 s left");
        assert_eq!(line(tally(10, 0), 0.0, None), "10/20 jobs (10 before), 1 failed");
    }

    #[test]
    fn a_narrow_line_keeps_done_failed_and_time_left() {
        let said = |width| line(tally(12, 2), 4.0, Some(width));
        assert_eq!(said(50), "12/20 jobs, 1 failed, 0.50 jobs/s, 16 s left");
        assert_eq!(said(40), "12/20 jobs, 1 failed, 16 s left");
        assert_eq!(said(10), "12/20 jobs, 1 failed, 16 s left");
    }

    #[test]
    fn the_bar_gives_way_on_a_narrow_terminal_and_has_an_end_on_a_wide_one() {
        assert_eq!(
            [0, 40, 66, 67, 80, 500].map(|w| bar_length(Some(w))),
            [0, 0, 0, 5, 18, 24]
        );
        assert_eq!(bar_length(None), 24);
    }
}
