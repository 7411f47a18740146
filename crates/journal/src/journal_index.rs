//! What a journal holds: an entry a record, and what was passed over.
//!
//! Knows the kinds of frames and keeps of a record its key and place alone. Does not write.

use super::frame::{Damage, Frame, Frames, read_at};
use super::{Binding, EXTENSION, FOLDER, FORM, JournalError, PreparationKey, RecordKey, Session, SessionEnd, kind};
use serde_json::Value;
use std::cmp::Ordering;
use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// Bytes of a record before what the job left: key, whether it failed, time.
pub(super) const RECORD_HEAD: usize = 16 + 1 + 8;

/// Where a record stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RecordLocation {
    file: u32,
    length: u32,
    at: u64,
}

/// A record by its key.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RecordEntry {
    /// Key of the job.
    pub key: RecordKey,
    /// Whether it failed.
    pub failed: bool,
    /// Where the record stands.
    pub place: RecordLocation,
}

impl RecordEntry {
    /// The order of records by key; of one key the one that counts comes first. One that did not fail counts before one that
    /// did, as the job was tried again. Those that did not fail say the same, and of those that failed the last one counts.
    fn before(&self, other: &Self) -> Ordering {
        let place = |entry: &Self| (entry.place.file, entry.place.at);
        let order = (self.key, self.failed).cmp(&(other.key, other.failed));
        order.then_with(|| match self.failed {
            true => place(other).cmp(&place(self)),
            false => place(self).cmp(&place(other)),
        })
    }
}

/// A file of the journal.
#[derive(Debug)]
pub struct Written {
    /// The file.
    pub path: PathBuf,
    /// What its records are bound to; none where its beginning is damaged, and then nothing of it is used.
    pub binding: Option<Binding>,
    /// Who wrote it.
    pub session: Option<Session>,
    /// How that came to its own end; none where the process died or is still at work.
    pub ending: Option<SessionEnd>,
    /// Records in it.
    pub records: usize,
    /// What was passed over.
    pub damages: Vec<Damage>,
    /// Jobs that it had begun and not recorded.
    pub begun: BTreeSet<RecordKey>,
    /// What jobs share, as it was prepared.
    pub prepared: Vec<Value>,
    /// Bridges whose preparation it had begun and not done.
    pub bridges_begun: BTreeSet<PreparationKey>,
    /// Bridges that it had prepared.
    pub bridges_prepared: BTreeSet<PreparationKey>,
}

impl Written {
    /// Makes a file of which nothing has been read.
    fn empty(path: PathBuf) -> Self {
        Self {
            path,
            binding: None,
            session: None,
            ending: None,
            records: 0,
            damages: Vec::new(),
            begun: BTreeSet::new(),
            prepared: Vec::new(),
            bridges_begun: BTreeSet::new(),
            bridges_prepared: BTreeSet::new(),
        }
    }

    /// Whether its process worked apart, for another one that waited.
    fn is_apart(&self) -> bool {
        self.session.as_ref().is_some_and(|session| session.apart)
    }

    /// Counts a record and gives its entry; `file` is the number of this file in the index.
    fn take_record(&mut self, frame: &Frame<'_>, file: u32) -> Option<RecordEntry> {
        let (key, failed) = record_head(frame.payload)?;
        self.records += 1;
        self.begun.remove(&key);
        Some(RecordEntry {
            key,
            failed,
            place: RecordLocation {
                file,
                length: u32::try_from(frame.payload.len()).unwrap_or(u32::MAX),
                at: frame.at,
            },
        })
    }

    /// Keeps what a frame says that is neither a binding nor a record.
    fn take_other(&mut self, frame: &Frame<'_>) {
        match frame.kind {
            kind::SESSION => {
                let session = serde_json::from_slice(frame.payload).ok();
                self.session = self.session.take().or(session);
            }
            kind::STARTED => self
                .begun
                .extend(frame.payload.as_chunks().0.iter().map(|key| RecordKey(*key))),
            kind::ENDING => self.ending = serde_json::from_slice(frame.payload).ok(),
            kind::PREPARED => {
                self.prepared
                    .extend(serde_json::from_slice::<Value>(frame.payload).ok());
                self.bridges_prepared.append(&mut self.bridges_begun);
            }
            kind::PREPARING => self
                .bridges_begun
                .extend(frame.payload.as_chunks().0.iter().map(|key| PreparationKey(*key))),
            // of a later minor form, which this one need not know
            _ => {}
        }
    }
}

/// What a record's frame says beside what the job left.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct JournalRecord {
    /// Milliseconds since 1970.
    pub unix_ms: u64,
    /// What the job left.
    pub left: Vec<u8>,
}

/// What a journal holds.
#[derive(Debug, Default)]
pub struct JournalIndex {
    /// Its files in the order they were begun.
    pub files: Vec<Written>,
    /// Its records by key, each key once.
    entries: Vec<RecordEntry>,
    /// The file that was read last: a system lets a process have few open.
    open: Mutex<Option<(u32, Arc<File>)>>,
}

impl JournalIndex {
    /// Reads the journal of a folder of results; none is an empty one.
    ///
    /// # Errors
    /// [`JournalError::Form`] of a file of another form; [`JournalError::Io`].
    pub fn read(folder: &Path) -> Result<Self, JournalError> {
        let folder = folder.join(FOLDER);
        let mut paths = Vec::new();
        match fs::read_dir(&folder) {
            Ok(listed) => {
                for entry in listed {
                    let path = entry.map_err(|cause| JournalError::io(&folder, cause))?.path();
                    if path.extension().is_some_and(|e| e == EXTENSION) {
                        paths.push(path);
                    }
                }
            }
            Err(cause) if cause.kind() == io::ErrorKind::NotFound => {}
            Err(cause) => return Err(JournalError::io(&folder, cause)),
        }
        paths.sort();
        let mut index = Self::default();
        for path in paths {
            index.take(path)?;
        }
        index.entries.sort_by(RecordEntry::before);
        index.entries.dedup_by_key(|entry| entry.key);
        Ok(index)
    }

    /// Takes in a file of the journal, with the entries of its records.
    fn take(&mut self, path: PathBuf) -> Result<(), JournalError> {
        let error = |cause| JournalError::io(&path, cause);
        let number = u32::try_from(self.files.len()).unwrap_or(u32::MAX);
        let mut frames = Frames::open(&path, 0).map_err(error)?;
        let mut written = Written::empty(path.clone());
        let mut recorded = false;
        while let Some(frame) = frames.next().map_err(error)? {
            // it stands there twice, so that a file outlives damage to its beginning
            if frame.kind == kind::BINDING && written.binding.is_none() && !recorded {
                written.binding = read_binding(&path, frame.payload)?;
            }
            recorded |= frame.kind == kind::RECORD;
            if written.binding.is_none() {
                // bound to who knows what: its jobs run again
                continue;
            }
            if frame.kind == kind::RECORD {
                self.entries.extend(written.take_record(&frame, number));
            } else {
                written.take_other(&frame);
            }
        }
        written.damages = frames.damages;
        self.files.push(written);
        Ok(())
    }

    /// The records, by key.
    pub fn entries(&self) -> &[RecordEntry] {
        &self.entries
    }

    /// The record of a key.
    pub fn find(&self, key: &RecordKey) -> Option<&RecordEntry> {
        let at = self.entries.binary_search_by(|entry| entry.key.cmp(key)).ok()?;
        Some(&self.entries[at])
    }

    /// A record, its checksum checked again.
    ///
    /// # Errors
    /// [`JournalError::Damaged`], [`JournalError::Io`].
    pub fn record(&self, place: RecordLocation) -> Result<JournalRecord, JournalError> {
        let written = &self.files[place.file as usize];
        let read = self
            .opened(place.file)
            .and_then(|file| read_at(&file, place.at, place.length));
        let mut payload = read.map_err(|cause| match cause.kind() {
            io::ErrorKind::InvalidData | io::ErrorKind::UnexpectedEof => JournalError::Damaged {
                path: written.path.clone(),
                at: place.at,
            },
            _ => JournalError::io(&written.path, cause),
        })?;
        let mut time = [0; 8];
        time.copy_from_slice(&payload[17..RECORD_HEAD]);
        Ok(JournalRecord {
            unix_ms: u64::from_le_bytes(time),
            left: payload.split_off(RECORD_HEAD),
        })
    }

    /// A file, open to be read.
    fn opened(&self, number: u32) -> io::Result<Arc<File>> {
        let mut open = self.open.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((kept, file)) = open.as_ref()
            && *kept == number
        {
            return Ok(Arc::clone(file));
        }
        let file = Arc::new(File::open(&self.files[number as usize].path)?);
        *open = Some((number, Arc::clone(&file)));
        Ok(file)
    }

    /// What the last process was bound to that worked on the study, and who it was; those that solved jobs apart left out.
    pub fn newest(&self) -> Option<(&Binding, &Session)> {
        let known = |written: &'_ &Written| written.session.as_ref().is_some_and(|session| !session.apart);
        let newest = self.files.iter().rev().filter(known);
        newest
            .filter_map(|written| written.binding.as_ref().zip(written.session.as_ref()))
            .next()
    }

    /// The error of a record that cannot be understood.
    pub fn damaged(&self, place: RecordLocation) -> JournalError {
        JournalError::Damaged {
            path: self.files[place.file as usize].path.clone(),
            at: place.at,
        }
    }

    /// The file that a record stands in.
    pub fn file_of(&self, place: RecordLocation) -> &Written {
        &self.files[place.file as usize]
    }

    /// In how many files whose process died each job had been begun and not recorded, of jobs that no file records. Processes
    /// that solve jobs apart are not counted: they end with the one that waits for them.
    pub fn deaths(&self) -> BTreeMap<RecordKey, usize> {
        let mut deaths = BTreeMap::new();
        for written in self
            .files
            .iter()
            .filter(|written| written.ending.is_none() && !written.is_apart())
        {
            for key in written.begun.iter().filter(|key| self.find(key).is_none()) {
                *deaths.entry(*key).or_insert(0) += 1;
            }
        }
        deaths
    }

    /// Processes that died with a job, those of the last file left out: its process is at work.
    pub fn deaths_before(&self, key: &RecordKey) -> usize {
        let before = &self.files[..self.files.len().saturating_sub(1)];
        before
            .iter()
            .filter(|written| written.ending.is_none() && written.begun.contains(key))
            .count()
    }

    /// Jobs that the process of the last file had begun apart and not recorded; none where it is not that process.
    pub fn begun_apart(&self, process: u32) -> impl Iterator<Item = &RecordKey> {
        self.died_apart(process).flat_map(|written| &written.begun)
    }

    /// How many processes died while they prepared each bridge, since one prepared it. Processes that prepare bridges apart
    /// are not counted: they end with the one that waits for them.
    pub fn deaths_in_preparation(&self) -> BTreeMap<PreparationKey, usize> {
        let mut deaths = BTreeMap::new();
        for written in &self.files {
            for key in &written.bridges_prepared {
                deaths.remove(key);
            }
            if written.ending.is_none() && !written.is_apart() {
                for key in &written.bridges_begun {
                    *deaths.entry(*key).or_insert(0) += 1;
                }
            }
        }
        deaths
    }

    /// Bridges that the process of the last file had begun to prepare apart and not done; none where it is not that process.
    pub fn preparing_apart(&self, process: u32) -> impl Iterator<Item = &PreparationKey> {
        self.died_apart(process).flat_map(|written| &written.bridges_begun)
    }

    /// The last file, where a process of that number wrote it apart and died. The system gives numbers again: an older file may
    /// be of another process.
    fn died_apart(&self, process: u32) -> impl Iterator<Item = &Written> {
        let of = |written: &&Written| {
            written
                .session
                .as_ref()
                .is_some_and(|s| s.apart && s.process == process)
        };
        let last = self.files.last().filter(of);
        last.filter(|written| written.ending.is_none()).into_iter()
    }

    /// What was passed over, file by file.
    pub fn damages(&self) -> impl Iterator<Item = (&Path, &Damage)> {
        self.files
            .iter()
            .flat_map(|written| written.damages.iter().map(|damage| (written.path.as_path(), damage)))
    }
}

/// Reads what the records of a file are bound to, none where the frame is no binding, and refuses a file of another form.
fn read_binding(path: &Path, payload: &[u8]) -> Result<Option<Binding>, JournalError> {
    let document: Value = serde_json::from_slice(payload).unwrap_or_default();
    match document["form"].as_u64() {
        Some(found) if found != u64::from(FORM) => Err(JournalError::Form {
            path: path.to_owned(),
            found,
        }),
        _ => Ok(serde_json::from_value(document).ok()),
    }
}

/// Key and state of a record.
pub(super) fn record_head(payload: &[u8]) -> Option<(RecordKey, bool)> {
    let key: [u8; 16] = *payload.first_chunk()?;
    let failed = payload.get(16)?;
    (payload.len() >= RECORD_HEAD && *failed <= 1).then_some((RecordKey(key), *failed == 1))
}
