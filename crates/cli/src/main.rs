//! The program: words in, words out.
//!
//! | module | charter |
//! |---|---|
//! | `args` | the words that are understood |
//! | `commands` | a file a command: what it asks of the study's rooms and how it answers |
//! | `comparison` | a comparison as text, JSON, Markdown, JUnit XML |
//! | `page` | the page of a report, whole |
//! | `signals` | interrupts and questions from outside |
//! | `progress` | a bar on a terminal, plain lines otherwise |
//! | `watching` | what is told of a sweep |
//! | `words` | aligned tables, times, what goes where when a reader has left |
//!
//! Knows the exit status of every end: 0 all good; 1 done, but something fell short; 2 input refused; 3 could not go on; 130 interrupted. Does
//! not know mechanics or files of results.

mod args;
mod commands;
mod comparison;
mod page;
mod progress;
mod signals;
mod watching;
mod words;

use args::{Arguments, Command, Format};
use clap::{CommandFactory, Parser, error::ErrorKind};
use pontoon_study::Refusal;
use pontoon_study::calibrate::CalibrateError;
use pontoon_study::sweep::SweepError;
use pontoon_study::tables::ResultsError;
use std::process::ExitCode;

/// Commit of the sources that this program was built from, where they were a repository's.
const COMMIT: Option<&str> = option_env!("PONTOON_COMMIT");

/// How a command ended that could go on to its end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Ending {
    /// All good.
    Good,
    /// Something fell short.
    Short,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
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
    let ended = match arguments.command {
        Command::Run(run) => commands::run::run(&run, common),
        Command::Status(status) => commands::status::status(&status, common),
        Command::Explain(explain) => commands::explain::explain(&explain, common),
        Command::Merge(merge) => commands::merge::merge(&merge, common),
        Command::Plan(plan) => commands::plan::plan(&plan, common),
        Command::Modes(modes) => commands::modes::modes(&modes, common),
        Command::Calibrate(calibrate) => commands::calibrate::calibrate(&calibrate, common),
        Command::Compare(compare) => commands::compare::compare(&compare, common),
        Command::Report(report) => commands::report::report(&report, common),
        Command::Export(export) => commands::export::export(&export, common),
        Command::Schema(schema) => commands::schema::schema(&schema),
    };
    match ended {
        Ok(Ending::Good) => ExitCode::SUCCESS,
        Ok(Ending::Short) => ExitCode::from(1),
        Err(error) => {
            words::note(&format!("pontoon: {error:#}"));
            ExitCode::from(status_of(&error))
        }
    }
}

/// The exit status of an error: 130 interrupted, 2 the input's, 3 any other.
fn status_of(error: &anyhow::Error) -> u8 {
    let swept = error.downcast_ref::<SweepError>();
    if matches!(swept, Some(SweepError::Interrupted { .. })) {
        return 130;
    }
    let refused = error.is::<Refusal>()
        || matches!(swept, Some(SweepError::Refused(_)))
        || matches!(error.downcast_ref::<CalibrateError>(), Some(CalibrateError::Refused(_)))
        || matches!(error.downcast_ref::<ResultsError>(), Some(ResultsError::Refused(_)));
    if refused { 2 } else { 3 }
}
