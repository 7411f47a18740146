//! Faults on demand, so that what the program promises of a dying process and a full disk can be tried on the program that
//! people run.
//!
//! Knows one fault of this process, asked for in the environment as `PONTOON_FAULT=place:number:how`: at the `number`th
//! passage of `place`, from 1, `die` ends the process as a kill would, `short` writes half of what is to be written and dies,
//! `full` and `error` are the system's answers from there on. Does not know what a place does.

use std::fs::File;
use std::io::{self, ErrorKind, Write};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, OnceLock};
use thiserror::Error;

/// Name of the environment's variable.
const VARIABLE: &str = "PONTOON_FAULT";

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum How {
    Die,
    Short,
    Full,
    Error,
}

#[derive(Debug)]
struct Fault {
    place: String,
    number: u64,
    how: How,
    passed: AtomicU64,
}

fn asked() -> Option<&'static Fault> {
    static FAULT: OnceLock<Option<Fault>> = OnceLock::new();
    FAULT.get_or_init(|| parse(&std::env::var(VARIABLE).ok()?)).as_ref()
}

/// The places that a fault may strike, but those of jobs: `job.NUMBER`, and `prepare.NUMBER` for the bridge of one.
const PLACES: [&str; 22] = [
    "aside.rename",
    "canary",
    "documents.rename",
    "documents.write",
    "export.rename",
    "export.renamed",
    "export.sync",
    "export.write",
    "journal.begin",
    "journal.begin.sync",
    "journal.begun",
    "journal.sync",
    "journal.synced",
    "journal.write",
    "journal.written",
    "merge.copy",
    "merge.rename",
    "tables.rename",
    "tables.renamed",
    "tables.sync",
    "tables.synced",
    "tables.write",
];

/// What is asked for and is no fault: nobody should take a run without one for a run that outlived one.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error(
    "PONTOON_FAULT: found \"{found}\", allowed: PLACE:NUMBER:HOW, a place of {}, job.N or prepare.N; a number from 1; die, short, full or error",
    PLACES.join(", ")
)]
pub struct NoFault {
    /// What the environment has.
    pub found: String,
}

/// Checks the fault that the environment asks for, if it asks for one.
///
/// # Errors
/// [`NoFault`].
pub fn check() -> Result<(), NoFault> {
    let Some(asked) = std::env::var_os(VARIABLE).filter(|asked| !asked.is_empty()) else {
        return Ok(());
    };
    let found = asked.to_string_lossy().into_owned();
    parse(&found).map(|_| ()).ok_or(NoFault { found })
}

fn parse(text: &str) -> Option<Fault> {
    let mut parts = text.split(':');
    let (place, number, how) = (parts.next()?, parts.next()?.parse().ok()?, parts.next()?);
    let job = place.strip_prefix("job.").or_else(|| place.strip_prefix("prepare."));
    let of_job = job.is_some_and(|job| job.parse::<usize>().is_ok());
    if !(of_job || PLACES.contains(&place)) || number == 0 || parts.next().is_some() {
        return None;
    }
    let how = match how {
        "die" => How::Die,
        "short" => How::Short,
        "full" => How::Full,
        "error" => How::Error,
        _ => return None,
    };
    Some(Fault {
        place: place.to_owned(),
        number,
        how,
        passed: AtomicU64::new(0),
    })
}

/// The fault of this passage of a place.
fn due(place: &str) -> Option<How> {
    let fault = asked().filter(|fault| fault.place == place)?;
    let passage = fault.passed.fetch_add(1, Ordering::Relaxed) + 1;
    match fault.how {
        How::Full | How::Error => (passage >= fault.number).then_some(fault.how),
        How::Die | How::Short => (passage == fault.number).then_some(fault.how),
    }
}

fn answer(how: How) -> io::Error {
    match how {
        How::Full => io::Error::new(ErrorKind::StorageFull, "no space left on device"),
        _ => io::Error::other("input/output error"),
    }
}

/// A place where the process may die or the system fail.
///
/// # Errors
/// The system's answer that was asked for.
pub fn at(place: &str) -> io::Result<()> {
    match due(place) {
        None => Ok(()),
        Some(How::Die | How::Short) => std::process::abort(),
        Some(how) => Err(answer(how)),
    }
}

/// The place of a job.
pub fn at_job(number: usize) {
    if asked().is_some() {
        // the system has no answer to give here: the process goes on or dies
        let _ = at(&format!("job.{number}"));
    }
}

/// The places of the bridges of jobs, passed when these are prepared.
pub fn at_preparation(jobs: impl Iterator<Item = usize>) {
    if asked().is_some_and(|fault| fault.place.starts_with("prepare.")) {
        for number in jobs {
            let _ = at(&format!("prepare.{number}"));
        }
    }
}

/// Writes all bytes, or as many as the fault leaves.
///
/// # Errors
/// What the system says, or the answer that was asked for.
pub fn write_all(place: &str, mut file: &File, bytes: &[u8]) -> io::Result<()> {
    match due(place) {
        None => file.write_all(bytes),
        Some(How::Die) => std::process::abort(),
        Some(how) => {
            file.write_all(&bytes[..bytes.len() / 2])?;
            if how == How::Short {
                std::process::abort();
            }
            Err(answer(how))
        }
    }
}

/// A file whose writes pass a place.
#[derive(Debug)]
pub struct Watched {
    /// The place.
    pub place: &'static str,
    /// The file.
    pub file: File,
    /// What the system said of the first write that failed: whoever writes may put it in other words, or in none.
    pub failure: Arc<OnceLock<(ErrorKind, String)>>,
}

impl Write for Watched {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = write_all(self.place, &self.file, bytes);
        if let Err(cause) = &written {
            self.failure.get_or_init(|| (cause.kind(), cause.to_string()));
        }
        written.map(|()| bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_asked_is_understood_or_is_nothing() {
        let fault = parse("journal.write:3:full").unwrap();
        assert_eq!(
            (fault.place.as_str(), fault.number, fault.how),
            ("journal.write", 3, How::Full)
        );
        assert!(parse("job.12:1:die").is_some());
        assert!(parse("prepare.12:1:die").is_some());
        for wrong in [
            "",
            "canary",
            "canary:b:die",
            "canary:1:sleep",
            "canary:0:die",
            "canary:1:die:1",
            "cannary:1:die",
            "job.x:1:die",
            "prepare.:1:die",
        ] {
            assert!(parse(wrong).is_none(), "{wrong}");
        }
    }
}
