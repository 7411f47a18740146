//! `pontoon man`: manual pages, one a command.

use crate::args::{Arguments, Common, Format, ManArguments};
use crate::exit_status::ExitStatus;
use crate::text;
use anyhow::{Context, Result};
use clap::builder::Resettable;
use clap::{Command, CommandFactory};
use clap_mangen::Man;
use pontoon_journal::place::Folder;
use pontoon_plan::input::Refusal;
use pontoon_results::{labels, replaceable};
use serde_json::json;

/// Writes the pages of the definitions that words are understood by.
pub(crate) fn man(arguments: &ManArguments, common: Common) -> Result<ExitStatus> {
    let to = &arguments.to;
    if to.exists() && !to.is_dir() {
        return Err(Refusal::new(to, "", "a file", "a folder for the pages").into());
    }
    let commands = commands();
    for command in &commands {
        replaceable(&to.join(file_of(command)), "a page of `pontoon man`", is_page)?;
    }
    let folder = Folder::create(to).context("no place for the pages")?;
    let mut names = Vec::new();
    for command in commands {
        let name = file_of(&command);
        let page = page(command).context("no page")?;
        folder
            .write(&name, |file| file.write_all(&page))
            .context("page not written")?;
        names.push(name);
    }
    text::result(&match common.format {
        Format::Json => format!("{:#}\n", json!({ "to": to.display().to_string(), "pages": names })),
        _ => format!("{} in {}\n", labels::counted(names.len(), "page"), to.display()),
    })?;
    Ok(ExitStatus::Good)
}

/// The program and each of its commands, named as their pages are; hidden ones left out.
fn commands() -> Vec<Command> {
    let mut program = Arguments::command().disable_help_subcommand(true);
    program.build();
    let commands = program
        .get_subcommands()
        .filter(|command| !command.is_hide_set())
        .cloned();
    let commands: Vec<Command> = commands.collect();
    [vec![program], commands].concat()
}

/// The file of a command's page.
fn file_of(command: &Command) -> String {
    format!("{}.1", name(command))
}

/// Whether a file is a page of this program, of whatever version: it ends in the name of the manual.
fn is_page(bytes: &[u8]) -> bool {
    let title = |line: &[u8]| line.starts_with(b".TH pontoon") && line.trim_ascii_end().ends_with(b"pontoon");
    bytes.split(|&byte| byte == b'\n').take(TITLE_WITHIN).any(title)
}

/// Lines of a page within which its title stands.
const TITLE_WITHIN: usize = 10;

/// The name of a command's page: `pontoon-run`.
fn name(command: &Command) -> &str {
    command.get_display_name().unwrap_or(command.get_name())
}

/// A page; examples stand as they are typed, which a paragraph of its text would not keep.
fn page(command: Command) -> std::io::Result<Vec<u8>> {
    let examples = command.get_after_help().map(ToString::to_string);
    let mut page = Vec::new();
    let command = command.after_help(Resettable::Reset);
    Man::new(command).manual("pontoon").render(&mut page)?;
    if let Some(examples) = examples {
        page.extend(b".SH EXAMPLES\n.nf\n");
        for line in examples.lines().skip(1) {
            let line = line.trim().replace('\\', "\\e").replace('-', "\\-");
            page.extend(format!("{line}\n").bytes());
        }
        page.extend(b".fi\n");
    }
    Ok(page)
}
