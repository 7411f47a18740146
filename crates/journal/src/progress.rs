//! How far a run has come, for those who ask from outside: a small file beside the journal, replaced at every sync.
//!
//! Knows counts and up to which byte of the journal they hold; what was written since is counted by its frames. Nothing else
//! hangs on it: where it is missing or does not fit the journal, the journal is read.

use super::frame::Frames;
use super::journal_index::record_head;
use super::place::HiddenFile;
use super::{EXTENSION, FOLDER, Lock, SessionEnd, kind};
use serde::{Deserialize, Serialize};
use std::fs;
use std::io::Write;
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
    /// Hash of the study's document.
    pub study_blake3: String,
    /// How the run ended; none where it has not.
    pub ended: Option<String>,
}

/// The file: counts, and a checksum of their text.
#[derive(Debug, Serialize, Deserialize)]
struct ProgressFile {
    counts: Counts,
    crc32: u32,
}

impl ProgressFile {
    fn checksum(counts: &Counts) -> u32 {
        crc32fast::hash(&serde_json::to_vec(counts).unwrap_or_default())
    }
}

/// What of a manifest tells which study its tables are of; the rest is passed over unread.
#[derive(Debug, Deserialize)]
struct ManifestHead {
    study_blake3: String,
    failed: usize,
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
    /// `complete`, `running`, `interrupted`, `died`, `without tables`, or why the last run could not go on.
    pub state: String,
}

impl Standing {
    /// How far the run of a folder has come by what is told beside its journal; none where that is missing or does not fit.
    pub fn told(folder: &Path) -> Option<Self> {
        let journal = folder.join(FOLDER);
        let files = fs::read_dir(&journal).ok()?.filter_map(Result::ok);
        let files = files
            .filter(|entry| entry.path().extension().is_some_and(|e| e == EXTENSION))
            .count();
        let told: ProgressFile = serde_json::from_slice(&fs::read(folder.join(FILE)).ok()?).ok()?;
        let fits = told.crc32 == ProgressFile::checksum(&told.counts) && told.counts.files == files;
        let counts = fits.then(|| since(told.counts, &journal)).flatten()?;
        let (jobs, done, failed) = (counts.jobs, counts.done, counts.failed);
        let standing = Self {
            study: counts.study,
            shard: counts.shard,
            jobs,
            done,
            failed,
            missing: jobs.saturating_sub(done),
            running: false,
            state: String::new(),
        };
        Some(standing.with_state(folder, &counts.study_blake3, counts.ended.as_deref()))
    }

    /// Adds the state: how the last process ended, unless it is still at work or nothing is missing any more.
    pub fn with_state(mut self, folder: &Path, study_blake3: &str, ended: Option<&str>) -> Self {
        self.running = Lock::is_held(folder);
        // a share leaves no tables; a whole run's are of the study that its manifest names, before failed jobs were tried again
        let manifest = || fs::read(folder.join(MANIFEST)).ok();
        let manifest = || serde_json::from_slice::<ManifestHead>(&manifest()?).ok();
        let whole = self.shard.is_some()
            || manifest().is_some_and(|told| told.study_blake3 == study_blake3 && told.failed == self.failed);
        self.state = match ended {
            _ if self.running => "running",
            _ if self.missing == 0 && whole => "complete",
            Some("complete") => "without tables",
            Some(ended) => ended,
            None => "died",
        }
        .to_owned();
        self
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
        match frame.kind {
            kind::RECORD => {
                let (_, failed) = record_head(frame.payload)?;
                counts.done += 1;
                counts.failed += usize::from(failed);
            }
            kind::ENDING => {
                let ending: SessionEnd = serde_json::from_slice(frame.payload).ok()?;
                counts.ended = Some(ending.how);
            }
            _ => {}
        }
    }
    Some(counts)
}

/// Replaces the file; where that fails the journal tells the same, more slowly.
pub(super) fn replace(folder: &Path, counts: &Counts) {
    let told = ProgressFile {
        crc32: ProgressFile::checksum(counts),
        counts: counts.clone(),
    };
    let Ok(text) = serde_json::to_vec(&told) else { return };
    let _ = HiddenFile::begin(&folder.join(FILE)).and_then(|hidden| {
        hidden.file().write_all(&text)?;
        hidden.put()
    });
}
