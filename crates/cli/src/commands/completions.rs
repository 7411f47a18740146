//! `pontoon completions`: what makes a shell complete the words of this program.

use crate::args::{Arguments, CompletionsArguments};
use crate::exit_status::ExitStatus;
use crate::text;
use anyhow::Result;
use clap::builder::PossibleValue;
use clap::{Arg, Command, CommandFactory};
use clap_complete::Shell;

/// Writes the script of a shell, made of the definitions that words are understood by.
pub(crate) fn completions(arguments: &CompletionsArguments) -> Result<ExitStatus> {
    let mut script = Vec::new();
    clap_complete::generate(
        arguments.shell,
        &mut visible(Arguments::command()),
        "pontoon",
        &mut script,
    );
    if arguments.shell == Shell::Fish {
        script = fish(&String::from_utf8(script)?).into_bytes();
    }
    text::results(|to| to.write_all(&script))?;
    Ok(ExitStatus::Good)
}

/// The script for fish, which offers files wherever it is not told otherwise: words where an argument is one of some words,
/// the commands behind `help`, nothing where an option takes a number.
fn fish(generated: &str) -> String {
    const SEEN: &str = "__fish_seen_subcommand_from";
    let line = |line: &str| match line.strip_suffix("' -r") {
        Some(option) => format!("{option}' -x\n"),
        // `help` itself is seen behind `help`
        None if line.contains(SEEN) => line.replacen(" help\" -f -a", "\" -f -a", 1) + "\n",
        None => format!("{line}\n"),
    };
    let mut script: String = generated.lines().map(line).collect();
    for command in visible(Arguments::command()).get_subcommands() {
        let words = command.get_positionals().map(Arg::get_possible_values);
        for words in words.filter(|words| !words.is_empty()) {
            let names: Vec<&str> = words.iter().map(PossibleValue::get_name).collect();
            let name = command.get_name();
            let none_yet = format!(
                "__fish_pontoon_using_subcommand {name}; and not {SEEN} {}",
                names.join(" ")
            );
            for word in words.iter().filter(|word| !word.is_hide_set()) {
                let help = word.get_help().map(|help| help.to_string().replace('\'', "\\'"));
                let help = help.map_or(String::new(), |help| format!(" -d '{help}'"));
                script += &format!(
                    "complete -c pontoon -n \"{none_yet}\" -f -a \"{}\"{help}\n",
                    word.get_name()
                );
            }
            script += &format!("complete -c pontoon -n \"__fish_pontoon_using_subcommand {name}\" -f\n");
        }
    }
    script + "complete -c pontoon -n \"__fish_pontoon_using_subcommand help\" -f\n"
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
