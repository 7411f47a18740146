//! The program: words in, words out. The binary and the Python package start it by [`program`].
//!
//! | module | charter |
//! |---|---|
//! | `args` | the words that are understood |
//! | `axes` | the axes of a study for people |
//! | `bar` | the progress bar that stands on the terminal |
//! | `caller` | a command that another process calls as a function |
//! | `commands` | a file a command: what it asks of the other crates and how it answers |
//! | `commit` | the sources that the program was built from |
//! | `comparison` | a comparison as text, JSON, Markdown, JUnit XML |
//! | `exit_status` | how a command ended that could go on to its end |
//! | `excerpt` | the place of a file that a refusal is about, with its line and a mark under it |
//! | `signals` | interrupts and questions from outside |
//! | `progress` | a bar on a terminal, plain lines otherwise |
//! | `water_arguments` | the words of `pontoon water` |
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
mod caller;
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
mod water_arguments;

use args::{Arguments, Command, Format};
use clap::{CommandFactory, FromArgMatches, error::ErrorKind};
use exit_status::ExitStatus;
use pontoon_journal::fault::NoFault;
use pontoon_judge::calibrate::CalibrateError;
use pontoon_plan::input::Refusal;
use pontoon_results::ResultsError;
use pontoon_study::sweep::SweepError;
use pontoon_view::drawing::DrawingError;
use std::ffi::OsString;
use terminal::TextStyle;

pub use caller::{Called, Caller};
pub use commit::COMMIT;
pub use excerpt::{PlaceInFile, place_in_file};
pub use watching::StartedAgain;

/// Runs the program with its command line, whose first word names the program, and gives its exit status.
///
/// `again` is the start of a command line that starts the program as a process of its own, for work that may end one.
pub fn program(words: impl IntoIterator<Item = OsString>, again: &[OsString]) -> u8 {
    let read = Arguments::words().try_get_matches_from(words).and_then(|matched| {
        Arguments::from_arg_matches(&matched).map_err(|error| error.format(&mut Arguments::words()))
    });
    match read {
        Ok(arguments) => answer(arguments, again),
        Err(error) => not_understood(&error),
    }
}

/// Answers a command line that is not understood, or that asks for help: 0 for help, 2 otherwise.
fn not_understood(error: &clap::Error) -> u8 {
    // who reads no further needs no answer
    let _closed = error.print();
    u8::try_from(error.exit_code()).unwrap_or(2)
}

/// Does what a command line says and gives the exit status.
fn answer(arguments: Arguments, again: &[OsString]) -> u8 {
    let format = arguments.common.format;
    if let Err(misplaced) = check_format(&arguments) {
        return not_understood(&misplaced);
    }
    match command(arguments, again) {
        Ok(ExitStatus::Good) => 0,
        Ok(ExitStatus::Short) => 1,
        Err(error) => {
            tell(&error, format);
            status_of(&error)
        }
    }
}

/// Refuses the formats of a comparison of any other command.
fn check_format(arguments: &Arguments) -> Result<(), clap::Error> {
    let compares = match &arguments.command {
        Command::Compare(_) => true,
        Command::Run(run) => run.with.is_some(),
        _ => false,
    };
    if matches!(arguments.common.format, Format::Markdown | Format::Junit) && !compares {
        let refused = "--format markdown and junit are those of a comparison: text or json";
        return Err(Arguments::command().error(ErrorKind::InvalidValue, refused));
    }
    Ok(())
}

/// Runs a command.
fn command(arguments: Arguments, again: &[OsString]) -> anyhow::Result<ExitStatus> {
    let common = arguments.common;
    pontoon_journal::fault::check()?;
    match arguments.command {
        Command::Run(run) => commands::run::run(&run, common, again),
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
        Command::Water(water) => commands::water::water(&water, common),
        Command::Schema(schema) => commands::schema::schema(&schema),
        Command::Completions(completions) => commands::completions::completions(&completions),
        Command::Man(man) => commands::man::man(&man, common),
    }
}

/// Runs a command for a caller, with its words as they stand behind the program's name.
///
/// # Errors
/// [`CallError`].
pub fn call(words: &[OsString], caller: Caller) -> Result<Called, CallError> {
    let program = std::iter::once(OsString::from("pontoon"));
    let read = Arguments::words()
        .try_get_matches_from(program.chain(words.iter().cloned()))
        .and_then(|matched| Arguments::from_arg_matches(&matched));
    let arguments = read.and_then(|arguments| check_format(&arguments).map(|()| arguments));
    let arguments = arguments.map_err(|error| CallError::Words(in_a_call(&error)))?;
    let again = caller.again.clone();
    let called = caller::called(caller, || {
        command(arguments, &again).map(|status| status == ExitStatus::Good)
    });
    called.map_err(CallError::Ended)
}

/// What is wrong with words, without advice for a command line.
fn in_a_call(error: &clap::Error) -> String {
    let text = error.to_string();
    let first = text.split("\n\n").next().unwrap_or_default();
    first.strip_prefix("error: ").unwrap_or(first).to_owned()
}

/// Why a command that was called did not come to its end.
#[derive(Debug)]
pub enum CallError {
    /// Its words are not those of a command.
    Words(String),
    /// It ended.
    Ended(anyhow::Error),
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
pub fn refusal_of(error: &anyhow::Error) -> Option<&Refusal> {
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
    if is_interrupted(error) {
        return 130;
    }
    let of_input = refusal_of(error).is_some() || error.is::<NoFault>();
    if of_input { 2 } else { 3 }
}

/// Whether an error is that somebody asked for an end.
pub fn is_interrupted(error: &anyhow::Error) -> bool {
    matches!(error.downcast_ref(), Some(SweepError::Interrupted { .. }))
}
