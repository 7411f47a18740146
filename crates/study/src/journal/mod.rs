//! The journal: what jobs left, kept as soon as they left it, whatever becomes of the process.
//!
//! Knows a folder, its lock and its files of frames. Does not know what a record holds nor what a job is beyond its key.
//!
//! A journal is a folder of files, one for each process that wrote to it, which is never written to again once that process
//! has ended: what a torn end costs is passed over where it lies. Every file begins with what its records are bound to; a
//! record is whole or it is not there.
//!
//! | kind | payload |
//! |---|---|
//! | 1 | [`Binding`], JSON: the first frame of a file |
//! | 2 | [`Session`], JSON: who writes, when, for which study |
//! | 3 | a record: key of the job (16 bytes), 1 where it failed else 0, milliseconds since 1970 (8 bytes), what it left |
//! | 4 | keys of jobs about to be solved together |
//! | 5 | [`Ending`], JSON: the process came to its own end |
//! | 6 | what jobs share, prepared: JSON |

mod binding;
mod book;
pub(crate) mod fault;
mod frame;
mod lock;
mod progress;
mod writer;

pub use binding::{Binding, Ending, Session};
pub use book::{Book, Entry, Place};
pub use frame::Damage;
pub use lock::Lock;
pub use progress::Standing;
pub use writer::{NewRecord, Writer};

pub(crate) use writer::study_hash;

pub(crate) use frame::LONGEST;

use std::io;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Version of the journal's form.
pub const FORM: u32 = 1;

/// Name of the journal's folder in a folder of results.
pub const FOLDER: &str = "journal";

/// How the name of a journal's file ends.
pub(crate) const EXTENSION: &str = "pontoon";

mod kind {
    pub(super) const BINDING: u32 = 1;
    pub(super) const SESSION: u32 = 2;
    pub(super) const RECORD: u32 = 3;
    pub(super) const STARTED: u32 = 4;
    pub(super) const ENDING: u32 = 5;
    pub(super) const PREPARED: u32 = 6;
}

/// What a job is known by from run to run: equal for jobs whose numbers are equal.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct JobKey(pub [u8; 16]);

impl JobKey {
    /// The key of what a text says.
    pub fn of(hasher: &blake3::Hasher) -> Self {
        let mut key = [0; 16];
        key.copy_from_slice(&hasher.finalize().as_bytes()[..16]);
        Self(key)
    }
}

impl std::fmt::Display for JobKey {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.0.iter().try_for_each(|byte| write!(f, "{byte:02x}"))
    }
}

/// Why a journal cannot be used.
#[derive(Debug, Error)]
pub enum JournalError {
    /// The system said no.
    #[error("{}: {cause}", path.display())]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// What it said.
        cause: io::Error,
    },
    /// Another process is at work in the folder.
    #[error("{} is in use by {holder}", folder.display())]
    InUse {
        /// The folder.
        folder: PathBuf,
        /// What the holder says of itself.
        holder: String,
    },
    /// A file of another form of journal.
    #[error("{}: a journal of form {found}; this program reads form {FORM}", path.display())]
    Form {
        /// The file.
        path: PathBuf,
        /// Its form.
        found: u64,
    },
    /// A record that was whole when the journal was opened.
    #[error("{}: the record at byte {at} is damaged", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// Where.
        at: u64,
    },
    /// An earlier write or sync failed; nothing is written after it.
    #[error("{}: not written after an earlier failure: {cause}", path.display())]
    Broken {
        /// The file.
        path: PathBuf,
        /// What had failed.
        cause: String,
    },
}

impl JournalError {
    fn io(path: &Path, cause: io::Error) -> Self {
        Self::Io {
            path: path.to_owned(),
            cause,
        }
    }
}

/// The machine's name, where the system tells it.
pub(crate) fn host() -> String {
    let told = std::fs::read_to_string("/proc/sys/kernel/hostname")
        .ok()
        .or_else(|| std::env::var("HOSTNAME").ok());
    told.map(|name| name.trim().to_owned())
        .filter(|name| !name.is_empty())
        .unwrap_or_else(|| "unknown".to_owned())
}
