//! Tells the program which commit it is built from, and puts the script of its page together.

use std::error::Error;
use std::path::Path;
use std::process::Command;
use std::{env, fs};

fn git(arguments: &[&str]) -> Option<String> {
    let told = Command::new("git").args(arguments).output().ok()?;
    let text = String::from_utf8(told.stdout).ok()?;
    told.status
        .success()
        .then(|| text.trim().to_owned())
        .filter(|text| !text.is_empty())
}

/// The files that `page/order.txt` names, one after the other.
fn page_script() -> Result<(), Box<dyn Error>> {
    println!("cargo:rerun-if-changed=page/order.txt");
    let mut script = String::new();
    for name in fs::read_to_string("page/order.txt")?
        .lines()
        .filter(|line| !line.is_empty())
    {
        let file = format!("page/{name}");
        println!("cargo:rerun-if-changed={file}");
        script += &fs::read_to_string(&file).map_err(|cause| format!("{file}: {cause}"))?;
        script.push('\n');
    }
    let out = env::var_os("OUT_DIR").ok_or("no OUT_DIR")?;
    fs::write(Path::new(&out).join("page.js"), script)?;
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo:rerun-if-changed=build.rs");
    page_script()?;
    // the journal of HEAD grows with every commit, checkout and merge
    if let Some(log) = git(&["rev-parse", "--git-path", "logs/HEAD"]).filter(|log| Path::new(log).exists()) {
        println!("cargo:rerun-if-changed={log}");
    }
    if let Some(commit) = git(&["rev-parse", "HEAD"]) {
        println!("cargo:rustc-env=PONTOON_COMMIT={commit}");
    }
    Ok(())
}
