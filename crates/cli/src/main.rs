//! The program: words in, words out.
//!
//! | module | charter |
//! |---|---|
//! | `args` | the words that are understood |
//! | `axes` | the axes of a study for people |
//! | `bar` | the progress bar that stands on the terminal |
//! | `commands` | a file a command: what it asks of the other crates and how it answers |
//! | `commit` | the sources that the program was built from |
//! | `comparison` | a comparison as text, JSON, Markdown, JUnit XML |
//! | `exit_status` | how a command ended that could go on to its end |
//! | `excerpt` | the place of a file that a refusal is about, with its line and a mark under it |
//! | `signals` | interrupts and questions from outside |
//! | `progress` | a bar on a terminal, plain lines otherwise |
//! | `watching` | what is told of a sweep |
//! | `summary` | what a run ends with: its summary as a person looks at it |
//! | `terminal` | what the place is like where something is written: its width, whether it shows colours |
//! | `text` | aligned tables, times, what goes where when a reader has left |
//!
//! Knows the exit status of every end: 0 all good; 1 done, but something fell short; 2 input refused; 3 could not go on; 130 interrupted. Does
//! not know mechanics or files of results.

mod args;
mod axes;
mod bar;
mod commands;
mod commit;
mod comparison;
mod excerpt;
mod exit_status;
mod progress;
mod signals;
mod summary;
mod terminal;
mod text;
mod watching;

use args::{Arguments, Command, Format};
use clap::{CommandFactory, FromArgMatches, error::ErrorKind};
use exit_status::ExitStatus;
use pontoon_judge::calibrate::CalibrateError;
use pontoon_plan::input::Refusal;
use pontoon_results::ResultsError;
use pontoon_study::sweep::SweepError;
use pontoon_view::drawing::DrawingError;
use std::process::ExitCode;
use terminal::TextStyle;

fn main() -> ExitCode {
    let read = Arguments::from_arg_matches(&Arguments::words().get_matches());
    let arguments = read.unwrap_or_else(|error| error.format(&mut Arguments::words()).exit());
    let common = arguments.common;
    let compares = match &arguments.command {
        Command::Compare(_) => true,
        Command::Run(run) => run.with.is_some(),
        _ => false,
    };
    if matches!(common.format, Format::Markdown | Format::Junit) && !compares {
        let refused = "--format markdown and junit are those of a comparison: text or json";
        Arguments::command().error(ErrorKind::InvalidValue, refused).exit();
    }
    if let Err(no_fault) = pontoon_journal::fault::check() {
        text::note(&format!("pontoon: {}", text::printable(&no_fault.to_string())));
        return ExitCode::from(2);
    }
    let ended = match arguments.command {
        Command::Run(run) => commands::run::run(&run, common),
        Command::Rate(rate) => commands::rate::rate(&rate, common),
        Command::Status(status) => commands::status::status(&status, common),
        Command::Explain(explain) => commands::explain::explain(&explain, common),
        Command::Merge(merge) => commands::merge::merge(&merge, common),
        Command::Plan(plan) => commands::plan::plan(&plan, common),
        Command::Modes(modes) => commands::modes::modes(&modes, common),
        Command::Indices(indices) => commands::indices::indices(&indices, common),
        Command::Calibrate(calibrate) => commands::calibrate::calibrate(&calibrate, common),
        Command::Compare(compare) => commands::compare::compare(&compare, common),
        Command::Report(report) => commands::report::report(&report, common),
        Command::Export(export) => commands::export::export(&export, common),
        Command::Schema(schema) => commands::schema::schema(&schema),
        Command::Completions(completions) => commands::completions::completions(&completions),
        Command::Man(man) => commands::man::man(&man, common),
    };
    match ended {
        Ok(ExitStatus::Good) => ExitCode::SUCCESS,
        Ok(ExitStatus::Short) => ExitCode::from(1),
        Err(error) => {
            tell(&error, common.format);
            ExitCode::from(status_of(&error))
        }
    }
}

/// Says what is wrong: for people with the place in the file that was refused.
fn tell(error: &anyhow::Error, format: Format) {
    let text_style = TextStyle::of_notes();
    let message = text::printable(&format!("{error:#}"));
    text::note(&format!("{} {message}", text_style.painted(terminal::BAD, "pontoon:")));
    let place = refusal_of(error).filter(|_| format != Format::Json);
    if let Some(place) = place.and_then(|refused| excerpt::excerpt(refused, text_style)) {
        text::note(place.trim_end());
    }
}

/// The refusal that an error is or holds.
fn refusal_of(error: &anyhow::Error) -> Option<&Refusal> {
    if let Some(SweepError::Refused(refused)) = error.downcast_ref() {
        return Some(refused);
    }
    if let Some(CalibrateError::Refused(refused)) = error.downcast_ref() {
        return Some(refused);
    }
    if let Some(DrawingError::Refused(refused)) = error.downcast_ref() {
        return Some(refused);
    }
    if let Some(ResultsError::Refused(refused)) = error.downcast_ref() {
        return Some(refused);
    }
    error.downcast_ref()
}

/// The exit status of an error: 130 interrupted, 2 the input's, 3 any other.
fn status_of(error: &anyhow::Error) -> u8 {
    let swept = error.downcast_ref::<SweepError>();
    if matches!(swept, Some(SweepError::Interrupted { .. })) {
        return 130;
    }
    if refusal_of(error).is_some() { 2 } else { 3 }
}
