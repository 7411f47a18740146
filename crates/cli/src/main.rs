//! The program `pontoon`.
//!
//! Knows how this process is started again. Does not know what the words mean.

use std::ffi::OsString;
use std::process::ExitCode;

fn main() -> ExitCode {
    let again: Vec<OsString> = std::env::current_exe().ok().map(OsString::from).into_iter().collect();
    ExitCode::from(pontoon_program::program(std::env::args_os(), &again))
}
