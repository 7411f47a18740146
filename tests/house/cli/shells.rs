//! What is made of the definitions of words: completions that a shell loads, pages that `man` shows.

use crate::stage::{Stage, is_refused, stderr, stdout};
use std::fs;
use std::path::Path;
use std::process::Command;

/// The commands that the help tells.
fn commands(stage: &Stage) -> Vec<String> {
    let help = stdout(&stage.pontoon(&["--help"]));
    let listed = help.lines().skip_while(|line| *line != "Commands:").skip(1);
    let names = listed
        .take_while(|line| !line.is_empty())
        .filter(|line| line.starts_with("  ") && !line.starts_with("   "));
    let names = names.map(|line| line.split_whitespace().next().unwrap().to_owned());
    let names: Vec<String> = names.filter(|name| name != "help").collect();
    assert!(names.len() >= 10 && names.contains(&"run".to_owned()), "{names:?}");
    names
}

/// The long flags that the help of a command tells.
fn flags(stage: &Stage, command: &str) -> Vec<String> {
    let help = stdout(&stage.pontoon(&[command, "--help"]));
    let begins = help.lines().map(str::trim_start).filter(|line| line.starts_with('-'));
    let long = begins.filter_map(|line| {
        line.find("--")
            .map(|at| line[at..].split([' ', '=']).next().unwrap().to_owned())
    });
    let flags: Vec<String> = long.collect();
    assert!(flags.contains(&"--quiet".to_owned()), "{command}: {help}");
    flags
}

fn script(stage: &Stage, shell: &str) -> String {
    let output = stage.pontoon(&["completions", shell]);
    assert_eq!((output.status.code(), stderr(&output).as_str()), (Some(0), ""));
    stdout(&output)
}

/// What bash offers for a line whose last word is under way.
fn offered(stage: &Stage, line: &[&str]) -> Vec<String> {
    let words: Vec<String> = line.iter().map(|word| format!("'{word}'")).collect();
    let text = format!(
        "source ./pontoon.bash; COMP_WORDS=({}); COMP_CWORD={}; _pontoon pontoon '{}' '{}'; printf '%s\\n' \"${{COMPREPLY[@]}}\"",
        words.join(" "),
        line.len() - 1,
        line[line.len() - 1],
        line[line.len() - 2],
    );
    let output = Command::new("bash")
        .args(["--norc", "--noprofile", "-c", &text])
        .current_dir(stage.path(""))
        .output()
        .unwrap();
    assert_eq!(stderr(&output), "");
    // of nothing printf makes an empty line
    let offered = stdout(&output);
    offered
        .lines()
        .filter(|line| !line.is_empty())
        .map(str::to_owned)
        .collect()
}

#[test]
fn bash_loads_its_script_and_completes_commands_flags_and_values() {
    let stage = Stage::new();
    fs::write(stage.path("pontoon.bash"), script(&stage, "bash")).unwrap();
    assert_eq!(offered(&stage, &["pontoon", "comp"]), ["compare", "completions"]);
    assert_eq!(offered(&stage, &["pontoon", "run", "--max"]), ["--max-failures"]);
    assert_eq!(
        offered(&stage, &["pontoon", "plan", "--format", "j"]),
        ["json", "junit"]
    );
    assert_eq!(offered(&stage, &["pontoon", "completions", "z"]), ["zsh"]);
    assert_eq!(offered(&stage, &["pontoon", "nonsense", "--max"]), Vec::<String>::new());
    for command in commands(&stage) {
        let offered = offered(&stage, &["pontoon", &command, "--"]);
        for flag in flags(&stage, &command) {
            assert!(offered.contains(&flag), "{command} {flag}: {offered:?}");
        }
        // what the help hides is not offered
        assert!(!offered.contains(&"--apart".to_owned()), "{command}: {offered:?}");
    }
}

/// What fish offers for a line; nothing where it is not there.
fn offered_by_fish(stage: &Stage, line: &str) -> Option<Vec<String>> {
    let output = Command::new("fish")
        .args([
            "--no-config",
            "-c",
            &format!("source ./pontoon.fish; complete -C '{line}'"),
        ])
        .current_dir(stage.path(""))
        .env("HOME", stage.path(""))
        .output()
        .ok()?;
    assert_eq!(stderr(&output), "", "{line}");
    let first = |line: &str| line.split('\t').next().unwrap_or_default().to_owned();
    Some(stdout(&output).lines().map(first).collect())
}

#[test]
fn fish_completes_words_where_a_word_is_due_and_files_where_a_file_is() {
    let stage = Stage::new();
    fs::write(stage.path("pontoon.fish"), script(&stage, "fish")).unwrap();
    fs::write(stage.path("notes.txt"), "").unwrap();
    if offered_by_fish(&stage, "pontoon ").is_none() {
        return;
    }
    let offered = |line: &str| offered_by_fish(&stage, line).unwrap();
    let commands = commands(&stage);
    for (line, mut expected) in [
        (
            "pontoon schema ",
            vec![
                "study",
                "bridge",
                "reference",
                "parameters",
                "tables",
                "vehicle",
                "water",
            ],
        ),
        (
            "pontoon completions ",
            vec!["bash", "elvish", "fish", "powershell", "zsh"],
        ),
        ("pontoon schema st", vec!["study"]),
        ("pontoon schema study ", vec![]),
        ("pontoon plan --format j", vec!["json", "junit"]),
        ("pontoon comp", vec!["compare", "completions"]),
        ("pontoon run --max", vec!["--max-failures"]),
        ("pontoon run --threads ", vec![]),
        (
            "pontoon help ",
            [commands.iter().map(String::as_str).collect(), vec!["help"]].concat(),
        ),
        ("pontoon help comp", vec!["compare", "completions"]),
    ] {
        let mut found = offered(line);
        found.sort();
        expected.sort_unstable();
        assert_eq!(found, expected, "{line}");
    }
    for line in ["pontoon run ", "pontoon run --out ", "pontoon export not"] {
        assert!(
            offered(line).contains(&"notes.txt".to_owned()),
            "{line}: {:?}",
            offered(line)
        );
    }
    for command in &commands {
        let offered = offered(&format!("pontoon {command} --"));
        for flag in flags(&stage, command) {
            assert!(offered.contains(&flag), "{command} {flag}: {offered:?}");
        }
        assert!(!offered.contains(&"--apart".to_owned()), "{command}: {offered:?}");
    }
}

/// A shell at a terminal of its own that types lines and a tab, and its settings, by which it writes down what it offers.
const ZSH_TYPES: &str = r#"
zmodload zsh/zpty
zpty shell 'ZDOTDIR=$PWD FPATH=$PWD:$FPATH zsh -i'
# what is typed before there is a prompt would not be completed
zpty -w shell ": >offered"
repeat 200; do
  [[ -e offered ]] && break
  sleep 0.05
done
for line in "$@"; do
  before=$(wc -l <offered)
  zpty -w -n shell "$line"$'\t'
  repeat 200; do
    [[ $(wc -l <offered) != $before ]] && break
    sleep 0.05
  done
  zpty -w -n shell $'\x15'" print -r -- 'END:$line' >>offered"$'\n'
  repeat 200; do
    grep -qsxF "END:$line" offered && break
    sleep 0.05
  done
done
zpty -d shell
"#;
const ZSH_SETTINGS: &str = r#"
autoload -Uz compinit && compinit -u -D
compadd() {
  if [[ ${@[1,(i)(-|--)]} == *-(O|A|D)\ * ]]; then builtin compadd "$@"; return $?; fi
  local -a hits
  builtin compadd -A hits "$@"
  print -rl -- $hits >>offered
  builtin compadd "$@"
}
"#;

#[test]
fn zsh_completes_words_where_a_word_is_due() {
    let stage = Stage::new();
    for (name, text) in [
        ("_pontoon", script(&stage, "zsh").as_str()),
        (".zshrc", ZSH_SETTINGS),
        ("types", ZSH_TYPES),
    ] {
        fs::write(stage.path(name), text).unwrap();
    }
    let lines = [
        ("pontoon comp", vec!["compare", "completions"]),
        (
            "pontoon schema ",
            vec![
                "bridge",
                "parameters",
                "reference",
                "study",
                "tables",
                "vehicle",
                "water",
            ],
        ),
        (
            "pontoon completions ",
            vec!["bash", "elvish", "fish", "powershell", "zsh"],
        ),
        ("pontoon help comp", vec!["compare", "completions"]),
        ("pontoon plan --format j", vec!["json", "junit"]),
    ];
    let types = Command::new("zsh")
        .args(["-f", "types"])
        .args(lines.iter().map(|(line, _)| line))
        .current_dir(stage.path(""))
        .env("HOME", stage.path(""))
        .output();
    let Ok(output) = types else { return };
    assert_eq!(stderr(&output), "");
    let offered = fs::read_to_string(stage.path("offered")).unwrap();
    let mut rest = offered.as_str();
    for (line, expected) in lines {
        let (of_line, behind) = rest
            .split_once(&format!("END:{line}\n"))
            .unwrap_or_else(|| panic!("{line}: {offered}"));
        let mut found: Vec<&str> = of_line.lines().filter(|word| !word.is_empty()).collect();
        found.sort_unstable();
        found.dedup();
        assert_eq!(found, expected, "{line}");
        rest = behind;
    }
}

#[test]
fn every_shell_has_a_script_that_names_every_command_and_its_own_shell_reads_it() {
    let stage = Stage::new();
    let commands = commands(&stage);
    for (shell, check) in [
        ("bash", Some(["bash", "-n"])),
        ("zsh", Some(["zsh", "-n"])),
        ("fish", Some(["fish", "--no-execute"])),
        ("powershell", None),
        ("elvish", None),
    ] {
        let text = script(&stage, shell);
        let missing: Vec<&String> = commands
            .iter()
            .filter(|command| !text.contains(command.as_str()))
            .collect();
        assert!(missing.is_empty(), "{shell}: {missing:?}");
        assert!(text.contains("max-failures") && !text.contains("apart"), "{shell}");
        let file = format!("script.{shell}");
        fs::write(stage.path(&file), &text).unwrap();
        // a shell that is not there says nothing
        let read =
            check.and_then(|[program, flag]| Command::new(program).arg(flag).arg(stage.path(&file)).output().ok());
        if let Some(output) = read {
            assert!(
                output.status.success() && stderr(&output).is_empty(),
                "{shell}: {}",
                stderr(&output)
            );
        }
    }
    assert_eq!(stage.pontoon(&["completions", "tcsh"]).status.code(), Some(2));
}

/// What a formatter complains of in a page; nothing where it is not there.
fn complaints(program: &str, flags: &[&str], page: &Path) -> String {
    let output = Command::new(program)
        .args(flags)
        .arg(page)
        .env("LC_ALL", "C.UTF-8")
        .output();
    output.map_or(String::new(), |output| stderr(&output))
}

#[test]
fn a_page_a_command_tells_every_flag_and_no_formatter_complains() {
    let stage = Stage::new();
    let output = stage.pontoon(&["man", "--to", "new/man1"]);
    assert_eq!((output.status.code(), stderr(&output).as_str()), (Some(0), ""));
    let commands = commands(&stage);
    assert_eq!(stdout(&output), format!("{} pages in new/man1\n", commands.len() + 1));
    let whole = fs::read_to_string(stage.path("new/man1/pontoon.1")).unwrap();
    for command in &commands {
        let name = format!("pontoon-{command}");
        let page = stage.path(&format!("new/man1/{name}.1"));
        // a hyphen is written \-
        let text = fs::read_to_string(&page).unwrap().replace("\\-", "-");
        assert!(text.contains(&format!(".TH {name} 1")), "{text}");
        assert!(whole.replace("\\-", "-").contains(&format!("{name}(1)")), "{whole}");
        for flag in flags(&stage, command) {
            assert!(text.contains(&flag), "{command}: no {flag} in {text}");
        }
        assert!(!text.contains("--apart"), "{text}");
    }
    for page in fs::read_dir(stage.path("new/man1"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
    {
        assert_eq!(
            complaints("groff", &["-man", "-ww", "-z", "-Tutf8"], &page),
            "",
            "{page:?}"
        );
        assert_eq!(complaints("man", &["--warnings", "-l"], &page), "", "{page:?}");
        let lint = Command::new("mandoc")
            .args(["-T", "lint", "-W", "warning"])
            .arg(&page)
            .output();
        if let Ok(output) = lint {
            assert!(output.status.success(), "{page:?}: {}", stdout(&output));
        }
    }
}

#[test]
fn a_formatter_does_complain_of_a_page_that_is_none() {
    let stage = Stage::new();
    fs::write(stage.path("bad.1"), ".TH x 1\n.SH NAME\n.nonsense here\n").unwrap();
    if Command::new("groff").arg("--version").output().is_ok() {
        assert_ne!(
            complaints("groff", &["-man", "-ww", "-z", "-Tutf8"], &stage.path("bad.1")),
            ""
        );
    }
}

#[test]
fn pages_have_no_place_in_a_file() {
    let stage = Stage::new();
    stage.write();
    is_refused(
        &stage.pontoon(&["man", "--to", "study.json"]),
        &["study.json: found a file"],
    );
    let output = stage.pontoon(&["man", "--to", "study.json/man"]);
    assert_eq!(output.status.code(), Some(3), "{}", stderr(&output));
    // nor in place of what is no page of theirs
    fs::create_dir(stage.path("notes")).unwrap();
    fs::write(stage.path("notes/pontoon-run.1"), "mine").unwrap();
    is_refused(
        &stage.pontoon(&["man", "--to", "notes"]),
        &["notes/pontoon-run.1: found another file, allowed: a new file, or a page of `pontoon man`"],
    );
    assert_eq!(fs::read_dir(stage.path("notes")).unwrap().count(), 1);
    assert_eq!(stage.pontoon(&["man", "--to", "m"]).status.code(), Some(0));
    let json = stdout(&stage.pontoon(&["man", "--to", "m", "--format", "json"]));
    let told: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(
        told["pages"].as_array().unwrap().len(),
        fs::read_dir(stage.path("m")).unwrap().count()
    );
}
