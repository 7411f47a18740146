//! What outlives a kill: the journal of frames, files put whole in place, locks, faults on demand.
//!
//! | module | charter |
//! |---|---|
//! | `frame` | a frame of bytes that is whole or is not there |
//! | `binding` | what the records of a journal are bound to, and who wrote them |
//! | `documents` | the documents that a run is of, each once under its hash |
//! | `writer`, `journal_index` | a file of the journal under way; what a journal holds |
//! | `progress` | how far a run has come, for those who ask from outside |
//! | `lock` | one process at a time in a folder |
//! | [`place`] | files that are replaced whole or not at all |
//! | [`fault`] | faults on demand: deaths and full disks at named places |
//!
//! Knows a disk. Does not know what a record holds, nor what the documents mean that records are bound to.
//!
//! # The journal
//!
//! Records are kept as soon as jobs left them, whatever becomes of the process.
//!
//! A journal is a folder of files, one for each process that wrote to it, which is never written to again once that process
//! has ended: what a torn end costs is passed over where it lies. Every file begins with what its records are bound to; a
//! record is whole or it is not there.
//!
//! | kind | payload |
//! |---|---|
//! | 1 | [`Binding`], JSON: the first frame of a file |
//! | 2 | [`Session`], JSON: who writes, when, for which study, by the hashes of its documents |
//! | 3 | a record: key of the job (16 bytes), 1 where it failed else 0, milliseconds since 1970 (8 bytes), what it left |
//! | 4 | keys of jobs about to be solved together |
//! | 5 | [`SessionEnd`], JSON: the process came to its own end |
//! | 6 | what jobs share, prepared: JSON; nothing of frame 7 is under way any more |
//! | 7 | keys of bridges whose preparation begins (16 bytes each) |

mod binding;
mod documents;
pub mod fault;
mod frame;
mod journal_index;
mod lock;
pub mod place;
mod progress;
mod writer;

pub use binding::{Binding, Session, SessionEnd};
pub use documents::{DOCUMENTS, document_file, keep_document, read_document};
pub use frame::{Damage, LONGEST};
pub use journal_index::{JournalIndex, RecordEntry, RecordLocation};
pub use lock::Lock;
pub use progress::Standing;
pub use writer::{JournalWriter, NewRecord};

use std::io;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Version of the journal's form.
pub const FORM: u32 = 7;

/// Name of the journal's folder in a folder of results.
pub const FOLDER: &str = "journal";

/// How the name of a journal's file ends.
pub const EXTENSION: &str = "pontoon";

mod kind {
    pub(super) const BINDING: u32 = 1;
    pub(super) const SESSION: u32 = 2;
    pub(super) const RECORD: u32 = 3;
    pub(super) const STARTED: u32 = 4;
    pub(super) const ENDING: u32 = 5;
    pub(super) const PREPARED: u32 = 6;
    pub(super) const PREPARING: u32 = 7;
}

/// What a record is found by: equal for jobs that leave the same record.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct RecordKey(pub [u8; 16]);

impl std::fmt::Display for RecordKey {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.0.iter().try_for_each(|byte| write!(f, "{byte:02x}"))
    }
}

/// What a bridge to be prepared is found by: equal for jobs that share the preparation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PreparationKey(pub [u8; 16]);

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
    #[error("{}: a journal of form {found}, which another version of this program wrote; this one reads form {FORM}; pontoon run --fresh moves the results aside and begins anew", path.display())]
    Form {
        /// The file.
        path: PathBuf,
        /// Its form.
        found: u64,
    },
    /// A document of the run is not there, or not whole.
    #[error("{}: a document of this run that cannot be read: {cause}; the same run again writes it", path.display())]
    Document {
        /// The file.
        path: PathBuf,
        /// Why.
        cause: io::Error,
    },
    /// A record that was whole when the journal was opened.
    #[error("{}: the record at byte {at} is damaged", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// Where.
        at: u64,
    },
    /// What is to be kept could not be made into bytes; nothing of it is written.
    #[error("{what} could not be made into bytes: {cause}")]
    NotEncoded {
        /// What.
        what: String,
        /// Why.
        cause: String,
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

/// The machine's name, as the system tells it.
pub fn host() -> String {
    #[cfg(unix)]
    let name = rustix::system::uname().nodename().to_string_lossy().into_owned();
    // Windows tells it every process in its environment
    #[cfg(not(unix))]
    let name = std::env::var("COMPUTERNAME").unwrap_or_default();
    if name.is_empty() { "unknown".to_owned() } else { name }
}
