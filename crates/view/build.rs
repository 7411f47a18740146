//! Puts the script of the page together.

use std::error::Error;
use std::path::Path;
use std::{env, fs};

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
    page_script()
}
