//! How far a run has come, for those who ask from outside: a small file beside the journal, replaced every second.
//!
//! Knows counts and up to which byte of the journal they hold; what was written since is counted by its frames. Nothing else
//! hangs on it: where it is missing or does not fit the journal, the journal is read.

use super::book::record_head;
use super::frame::Frames;
use super::{Book, EXTENSION, FOLDER, JournalError, Lock, kind};
use serde::{Deserialize, Serialize};
use std::fs;
use std::io;
use std::path::Path;

/// Name of the file.
pub(super) const FILE: &str = "progress.json";

/// Name of the file that a folder of whole results has.
const MANIFEST: &str = "manifest.json";

/// Counts as they stood at a byte of a file of the journal.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Counts {
    pub study: String,
    pub shard: Option<String>,
    /// Jobs of the study, or of the share asked for.
    pub jobs: usize,
    /// Of these, recorded; and failed among them.
    pub done: usize,
    pub failed: usize,
    /// File of the journal under way, and its length at these counts.
    pub file: String,
    pub bytes: u64,
    /// How many files the journal had.
    pub files: usize,
    /// How the run ended; none where it has not.
    pub ended: Option<String>,
}

/// The file: counts, and a checksum of their text.
#[derive(Debug, Serialize, Deserialize)]
struct Told {
    counts: Counts,
    crc32: u32,
}

impl Told {
    fn checksum(counts: &Counts) -> u32 {
        crc32fast::hash(&serde_json::to_vec(counts).unwrap_or_default())
    }
}

/// How far a run has come.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Standing {
    /// Name of the study.
    pub study: String,
    /// The share of the jobs, `K/N`; none where all were asked for.
    pub shard: Option<String>,
    /// Jobs asked for.
    pub jobs: usize,
    /// Recorded, failed ones among them.
    pub done: usize,
    /// Failed.
    pub failed: usize,
    /// Not recorded.
    pub missing: usize,
    /// Whether a process is at work in the folder.
    pub running: bool,
    /// `complete`, `running`, `interrupted`, `died`, or why the last run could not go on.
    pub state: String,
}

impl Standing {
    /// How far the run of a folder has come; none where there is no journal.
    ///
    /// # Errors
    /// [`JournalError`].
    pub fn of(folder: &Path) -> Result<Option<Self>, JournalError> {
        let running = Lock::is_held(folder);
        let journal = folder.join(FOLDER);
        let files = match fs::read_dir(&journal) {
            Ok(listed) => listed
                .filter_map(Result::ok)
                .filter(|entry| entry.path().extension().is_some_and(|e| e == EXTENSION))
                .count(),
            Err(cause) if cause.kind() == io::ErrorKind::NotFound => return Ok(None),
            Err(cause) => return Err(JournalError::io(&journal, cause)),
        };
        let told = fs::read(folder.join(FILE)).ok();
        let told: Option<Told> = told.and_then(|bytes| serde_json::from_slice(&bytes).ok());
        let told = told.filter(|told| told.crc32 == Told::checksum(&told.counts) && told.counts.files == files);
        let counts = match told.map(|told| since(told.counts, &journal)) {
            Some(Some(counts)) => counts,
            _ => match counted(folder)? {
                Some(counts) => counts,
                None => return Ok(None),
            },
        };
        let missing = counts.jobs.saturating_sub(counts.done);
        // a share leaves no tables
        let whole = missing == 0 && (counts.shard.is_some() || folder.join(MANIFEST).exists());
        let state = match (running, &counts.ended) {
            (true, _) => "running".to_owned(),
            _ if whole => "complete".to_owned(),
            (false, Some(ended)) => ended.clone(),
            (false, None) => "died".to_owned(),
        };
        Ok(Some(Self {
            study: counts.study,
            shard: counts.shard,
            jobs: counts.jobs,
            done: counts.done,
            failed: counts.failed,
            missing,
            running,
            state,
        }))
    }
}

/// Counts with the records written since; none where they do not fit the journal.
fn since(mut counts: Counts, journal: &Path) -> Option<Counts> {
    let path = journal.join(&counts.file);
    if counts.bytes > fs::metadata(&path).ok()?.len() {
        return None;
    }
    let mut frames = Frames::open(&path, counts.bytes).ok()?;
    while let Some(frame) = frames.next().ok()? {
        if frame.kind == kind::RECORD {
            let (_, failed) = record_head(frame.payload)?;
            counts.done += 1;
            counts.failed += usize::from(failed);
        }
    }
    Some(counts)
}

/// Counts of the whole journal.
fn counted(folder: &Path) -> Result<Option<Counts>, JournalError> {
    let book = Book::read(folder)?;
    let Some((binding, session)) = book
        .files
        .iter()
        .rev()
        .find_map(|written| written.binding.as_ref().zip(written.session.as_ref()))
    else {
        return Ok(None);
    };
    let ended = book.files.last().and_then(|written| written.ending.as_ref());
    Ok(Some(Counts {
        study: binding.name.clone(),
        shard: binding.shard.clone(),
        jobs: session.jobs,
        done: book.entries().len().min(session.jobs),
        failed: book.entries().iter().filter(|entry| entry.failed).count(),
        ended: ended.map(|ending| ending.how.clone()),
        ..Counts::default()
    }))
}

/// Replaces the file; where that fails the journal tells the same, more slowly.
pub(super) fn replace(folder: &Path, counts: &Counts) {
    let partial = folder.join(format!(".{FILE}.partial"));
    let told = Told {
        crc32: Told::checksum(counts),
        counts: counts.clone(),
    };
    let text = serde_json::to_vec(&told).unwrap_or_default();
    let _ = fs::write(&partial, text).and_then(|()| fs::rename(&partial, folder.join(FILE)));
}
