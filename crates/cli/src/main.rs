//! The program: words in, words out.
//!
//! | module | charter |
//! |---|---|
//! | `args` | the words that are understood |
//! | `commands` | a file a command: what it asks of the study's rooms and how it answers |
//! | `progress` | a bar on a terminal, plain lines otherwise |
//! | `words` | aligned tables, times, what goes where when a reader has left |
//!
//! Knows the exit status of every end: 0 all good; 1 done, but a job failed; 2 input refused; 3 could not go on. Does
//! not know mechanics or files of results.

mod args;
mod commands;
mod progress;
mod words;

use args::{Arguments, Command};
use clap::Parser;
use pontoon_study::Refusal;
use std::process::ExitCode;

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
    let ended = match arguments.command {
        Command::Run(run) => commands::run::run(&run, common),
        Command::Plan(plan) => commands::plan::plan(&plan, common),
        Command::Modes(modes) => commands::modes::modes(&modes, common),
        Command::Schema(schema) => commands::schema::schema(&schema),
    };
    match ended {
        Ok(Ending::Good) => ExitCode::SUCCESS,
        Ok(Ending::Short) => ExitCode::from(1),
        Err(error) => {
            words::note(&format!("pontoon: {error:#}"));
            ExitCode::from(if error.is::<Refusal>() { 2 } else { 3 })
        }
    }
}
