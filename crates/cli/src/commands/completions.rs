//! `pontoon completions`: what makes a shell complete the words of this program.

use crate::args::{Arguments, CompletionsArguments};
use crate::exit_status::ExitStatus;
use crate::text;
use anyhow::Result;
use clap::{Arg, Command, CommandFactory};

/// Writes the script of a shell, made of the definitions that words are understood by.
pub(crate) fn completions(arguments: &CompletionsArguments) -> Result<ExitStatus> {
    let mut script = Vec::new();
    clap_complete::generate(
        arguments.shell,
        &mut visible(Arguments::command()),
        "pontoon",
        &mut script,
    );
    text::results(|to| to.write_all(&script))?;
    Ok(ExitStatus::Good)
}

/// The program without what its help hides: a shell would offer it.
fn visible(program: Command) -> Command {
    let hidden = |argument: &&Arg| argument.is_hide_set();
    let names: Vec<String> = program
        .get_subcommands()
        .filter(|command| command.get_arguments().any(|argument| hidden(&argument)))
        .map(|command| command.get_name().to_owned())
        .collect();
    names.iter().fold(program, |program, name| {
        program.mut_subcommand(name, |command| {
            let shown = command.get_arguments().filter(|argument| !hidden(argument)).cloned();
            let shown: Vec<Arg> = shown.collect();
            let about = command.get_about().cloned().unwrap_or_default();
            Command::new(command.get_name().to_owned()).about(about).args(shown)
        })
    })
}
