//! A file of the journal under way.
//!
//! Knows that what is written reaches the disk within a second, by a thread of its own, and that after a failed write or sync
//! nothing more is written. Does not know what is read back.

use super::place::sync_folder;
use super::progress::{self, Counts};
use super::{
    Binding, EXTENSION, FOLDER, JournalError, PreparationKey, RecordKey, Session, SessionEnd, fault, frame, kind,
};
use serde::Serialize;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

/// Time between two syncs: two a second leave room for the sync itself within the second that may be lost.
const BETWEEN_SYNCS: Duration = Duration::from_millis(500);

/// A file of the journal that this process writes.
#[derive(Debug)]
pub struct JournalWriter {
    shared: Arc<SharedFile>,
    syncing: Option<JoinHandle<()>>,
}

#[derive(Debug)]
struct SharedFile {
    folder: PathBuf,
    path: PathBuf,
    state: Mutex<WriterState>,
    wake: Condvar,
    /// One sync at a time: the system tells of a failed one only once.
    syncs: Mutex<()>,
}

#[derive(Debug)]
struct WriterState {
    file: File,
    counts: Counts,
    /// Bytes on the disk for sure.
    synced: u64,
    /// Counts that were told; none are told of jobs solved apart.
    told: Counts,
    apart: bool,
    broken: Option<String>,
    closing: bool,
}

/// A record to be written.
#[derive(Debug, Clone, Copy)]
pub struct NewRecord<'a> {
    /// Key of the job.
    pub key: RecordKey,
    /// Whether it failed.
    pub failed: bool,
    /// What it left.
    pub left: &'a [u8],
}

impl JournalWriter {
    /// Begins a file in the journal of a folder of results: what it is bound to and who writes, both on the disk before
    /// this returns. Of `session.jobs` jobs `session.known` are recorded, `failed` of these failed.
    ///
    /// # Errors
    /// [`JournalError`].
    pub fn begin(folder: &Path, binding: &Binding, session: &Session, failed: usize) -> Result<Self, JournalError> {
        let begun = Begun::on_disk(folder, binding, session)?;
        let counts = begun.counts(binding, session, failed);
        if !session.apart {
            progress::replace(folder, &counts);
        }
        let shared = Arc::new(SharedFile {
            folder: folder.to_owned(),
            path: begun.path,
            state: Mutex::new(WriterState {
                file: begun.file,
                synced: counts.bytes,
                told: counts.clone(),
                counts,
                apart: session.apart,
                broken: None,
                closing: false,
            }),
            wake: Condvar::new(),
            syncs: Mutex::new(()),
        });
        let own = Arc::clone(&shared);
        let syncing = std::thread::Builder::new()
            .name("journal".to_owned())
            .spawn(move || own.keep_syncing());
        let syncing = syncing.map_err(|cause| JournalError::io(&shared.path, cause))?;
        Ok(Self {
            shared,
            syncing: Some(syncing),
        })
    }

    /// Says which jobs are about to be solved together.
    ///
    /// # Errors
    /// [`JournalError`].
    pub fn started(&self, keys: &[RecordKey]) -> Result<(), JournalError> {
        let payload: Vec<u8> = keys.iter().flat_map(|key| key.0).collect();
        self.one(kind::STARTED, &payload)
    }

    /// Says which bridges are about to be prepared: what the process dies with, unless [`Self::prepared`] follows.
    ///
    /// # Errors
    /// [`JournalError`].
    pub fn preparing(&self, keys: &[PreparationKey]) -> Result<(), JournalError> {
        let payload: Vec<u8> = keys.iter().flat_map(|key| key.0).collect();
        self.one(kind::PREPARING, &payload)
    }

    /// Keeps what jobs share, as it was prepared.
    ///
    /// # Errors
    /// [`JournalError`].
    pub fn prepared(&self, what: &impl Serialize) -> Result<(), JournalError> {
        self.one(kind::PREPARED, &json(what, "what jobs share")?)
    }

    fn one(&self, kind: u32, payload: &[u8]) -> Result<(), JournalError> {
        let mut bytes = Vec::with_capacity(frame::HEAD + payload.len());
        frame::append(&mut bytes, kind, payload);
        self.shared.write(&bytes, 0, 0)
    }

    /// Keeps records, all in one piece.
    ///
    /// # Errors
    /// [`JournalError`].
    pub fn record<'a>(&self, records: impl Iterator<Item = NewRecord<'a>>) -> Result<(), JournalError> {
        let now = SystemTime::now()
            .duration_since(UNIX_EPOCH)
            .unwrap_or_default()
            .as_millis();
        let now = u64::try_from(now).unwrap_or(u64::MAX).to_le_bytes();
        let (mut bytes, mut payload, mut done, mut failed) = (Vec::new(), Vec::new(), 0, 0);
        for record in records {
            payload.clear();
            payload.extend_from_slice(&record.key.0);
            payload.push(u8::from(record.failed));
            payload.extend_from_slice(&now);
            payload.extend_from_slice(record.left);
            frame::append(&mut bytes, kind::RECORD, &payload);
            done += 1;
            failed += usize::from(record.failed);
        }
        self.shared.write(&bytes, done, failed)
    }

    /// Brings all that was written to the disk.
    ///
    /// # Errors
    /// [`JournalError`], after which nothing more is written.
    pub fn sync(&self) -> Result<(), JournalError> {
        self.shared.sync();
        self.shared.whole(&self.shared.lock())
    }

    /// Says how the process came to its end, and ends the file. After a failed write or sync it is said in the place of what
    /// that left, as far as the disk allows.
    ///
    /// # Errors
    /// [`JournalError`].
    pub fn end(&self, ending: &SessionEnd) -> Result<(), JournalError> {
        if self.shared.lock().broken.is_some() {
            return self
                .shared
                .end_broken(&json(ending, "how the process ended")?, &ending.how);
        }
        self.one(kind::ENDING, &json(ending, "how the process ended")?)?;
        self.shared.lock().counts.ended = Some(ending.how.clone());
        self.sync()
    }

    /// Says how a process came to an end that is to be at once: nothing is waited for, and nothing is told.
    pub fn end_at_once(&self, ending: &SessionEnd) {
        if let Ok(mut state) = self.shared.state.try_lock() {
            let mut bytes = Vec::new();
            if let Ok(payload) = json(ending, "how the process ended") {
                frame::append(&mut bytes, kind::ENDING, &payload);
                let _ = state.file.write_all(&bytes);
            }
        }
    }
}

impl Drop for JournalWriter {
    fn drop(&mut self) {
        self.shared.lock().closing = true;
        self.shared.wake.notify_all();
        if let Some(syncing) = self.syncing.take() {
            let _ = syncing.join();
        }
    }
}

/// A file of the journal with its beginning: what it is bound to and who writes.
struct Begun {
    path: PathBuf,
    file: File,
    /// Bytes of the beginning.
    bytes: u64,
    /// Files that the journal has with this one.
    files: usize,
}

impl Begun {
    /// Creates a file in the journal of a folder of results, and brings its beginning and its name to the disk.
    fn on_disk(folder: &Path, binding: &Binding, session: &Session) -> Result<Self, JournalError> {
        let journal = folder.join(FOLDER);
        let error = |cause| JournalError::io(&journal, cause);
        fs::create_dir_all(&journal).map_err(error)?;
        let files = fs::read_dir(&journal).map_err(error)?.count();
        let (path, file) = create(&journal)?;
        let bytes = beginning(binding, session)?;
        let begun = fault::write_all("journal.begin", &file, &bytes)
            .and_then(|()| fault::at("journal.begin.sync"))
            .and_then(|()| file.sync_all())
            .and_then(|()| sync_folder(&journal))
            .and_then(|()| sync_folder(folder))
            .and_then(|()| fault::at("journal.begun"));
        begun.map_err(|cause| JournalError::io(&path, cause))?;
        Ok(Self {
            path,
            file,
            bytes: bytes.len() as u64,
            files: files + 1,
        })
    }

    /// Counts the jobs as they stand before any is solved; `failed` of those known failed.
    fn counts(&self, binding: &Binding, session: &Session, failed: usize) -> Counts {
        Counts {
            study: binding.name.clone(),
            shard: binding.shard.clone(),
            jobs: session.jobs,
            done: session.known,
            failed,
            file: self
                .path
                .file_name()
                .map(|name| name.to_string_lossy().into_owned())
                .unwrap_or_default(),
            bytes: self.bytes,
            files: self.files,
            study_blake3: session.study_blake3.clone(),
            ended: None,
        }
    }
}

impl SharedFile {
    fn lock(&self) -> MutexGuard<'_, WriterState> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn whole(&self, state: &WriterState) -> Result<(), JournalError> {
        match &state.broken {
            None => Ok(()),
            Some(cause) => Err(JournalError::Broken {
                path: self.path.clone(),
                cause: cause.clone(),
            }),
        }
    }

    fn write(&self, bytes: &[u8], done: usize, failed: usize) -> Result<(), JournalError> {
        let mut state = self.lock();
        self.whole(&state)?;
        if let Err(cause) = fault::write_all("journal.write", &state.file, bytes) {
            state.broken = Some(cause.to_string());
            return Err(JournalError::io(&self.path, cause));
        }
        // a process that dies here has written, and told nobody
        let _ = fault::at("journal.written");
        state.counts.bytes += bytes.len() as u64;
        state.counts.done += done;
        state.counts.failed += failed;
        Ok(())
    }

    /// Cuts off what a failed write left of a frame, which makes room on a full disk, and says how the process ended. What
    /// was whole is as it was, and each frame proves itself.
    fn end_broken(&self, payload: &[u8], how: &str) -> Result<(), JournalError> {
        let mut bytes = Vec::with_capacity(frame::HEAD + payload.len());
        frame::append(&mut bytes, kind::ENDING, payload);
        let mut state = self.lock();
        let written = state.file.set_len(state.counts.bytes);
        let written = written.and_then(|()| (&state.file).write_all(&bytes));
        let written = written.and_then(|()| state.file.sync_data());
        written.map_err(|cause| JournalError::io(&self.path, cause))?;
        state.counts.bytes += bytes.len() as u64;
        state.counts.ended = Some(how.to_owned());
        if !state.apart {
            progress::replace(&self.folder, &state.counts);
        }
        Ok(())
    }

    /// Syncs what was written so far. A sync that failed may have lost what it was to save: nothing is written after it.
    fn sync(&self) {
        let _one = self.syncs.lock().unwrap_or_else(PoisonError::into_inner);
        let (counts, file, due, apart) = {
            let state = self.lock();
            if state.broken.is_some() || state.counts == state.told {
                return;
            }
            let due = state.counts.bytes > state.synced;
            (state.counts.clone(), state.file.try_clone(), due, state.apart)
        };
        // jobs go on while the disk works
        let synced = match file {
            Ok(file) if due => fault::at("journal.sync")
                .and_then(|()| file.sync_data())
                .and_then(|()| fault::at("journal.synced")),
            Ok(_) => Ok(()),
            Err(cause) => Err(cause),
        };
        if synced.is_ok() && !apart {
            progress::replace(&self.folder, &counts);
        }
        let mut state = self.lock();
        match synced {
            Ok(()) => {
                state.synced = state.synced.max(counts.bytes);
                state.told = counts;
            }
            Err(cause) => state.broken = Some(format!("sync: {cause}")),
        }
    }

    fn keep_syncing(&self) {
        let mut state = self.lock();
        while !state.closing {
            let waited = self.wake.wait_timeout(state, BETWEEN_SYNCS);
            drop(waited);
            self.sync();
            state = self.lock();
        }
        drop(state);
        self.sync();
    }
}

/// Makes the frames that a file begins with: binding and session, twice, so that it outlives damage to one of them.
fn beginning(binding: &Binding, session: &Session) -> Result<Vec<u8>, JournalError> {
    let mut bytes = Vec::new();
    for _ in 0..2 {
        frame::append(&mut bytes, kind::BINDING, &json(binding, "what records are bound to")?);
        frame::append(&mut bytes, kind::SESSION, &json(session, "who writes")?);
    }
    Ok(bytes)
}

/// A new file whose name sorts after those of files begun before.
fn create(journal: &Path) -> Result<(PathBuf, File), JournalError> {
    let now = SystemTime::now()
        .duration_since(UNIX_EPOCH)
        .unwrap_or_default()
        .as_nanos();
    let mut number = u64::try_from(now)
        .unwrap_or(u64::MAX)
        .max(greatest(journal).map_or(0, |number| number + 1));
    loop {
        let name = format!("{number:016x}-{:08x}.{EXTENSION}", std::process::id());
        let path = journal.join(name);
        match File::options().create_new(true).read(true).append(true).open(&path) {
            Ok(file) => return Ok((path, file)),
            Err(cause) if cause.kind() == io::ErrorKind::AlreadyExists => number += 1,
            Err(cause) => return Err(JournalError::io(&path, cause)),
        }
    }
}

/// The greatest number of the files that are there: clocks step back, and machines do not agree on the time.
fn greatest(journal: &Path) -> Option<u64> {
    let names = fs::read_dir(journal)
        .ok()?
        .filter_map(Result::ok)
        .map(|entry| entry.file_name());
    let number = |name: std::ffi::OsString| u64::from_str_radix(name.to_str()?.get(..16)?, 16).ok();
    names.filter_map(number).max()
}

fn json(value: &impl Serialize, what: &str) -> Result<Vec<u8>, JournalError> {
    serde_json::to_vec(value).map_err(|cause| JournalError::NotEncoded {
        what: what.to_owned(),
        cause: cause.to_string(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{FORM, JournalIndex};
    use serde::Serializer;
    use serde::ser::Error as _;
    use serde_json::Value;

    /// What nothing can be made of.
    struct Never;

    impl Serialize for Never {
        fn serialize<S: Serializer>(&self, _: S) -> Result<S::Ok, S::Error> {
            Err(S::Error::custom("never"))
        }
    }

    fn begun(folder: &Path) -> JournalWriter {
        begun_as(folder, false)
    }

    fn begun_as(folder: &Path, apart: bool) -> JournalWriter {
        let binding = Binding {
            form: FORM,
            name: "s".to_owned(),
            numerics: String::new(),
            instruction_path: String::new(),
            shard: None,
            bridge: Value::Null,
            vehicle: Value::Null,
            analysis: Value::Null,
            record: Value::Null,
        };
        let session = Session {
            started: String::new(),
            host: String::new(),
            process: 1,
            version: String::new(),
            commit: None,
            threads: 1,
            jobs: 1,
            known: 0,
            apart,
            study_blake3: String::new(),
            bridge_blake3: String::new(),
            waters: Vec::new(),
        };
        JournalWriter::begin(folder, &binding, &session, 0).unwrap()
    }

    #[test]
    fn what_cannot_be_made_into_bytes_is_an_error_and_leaves_nothing() {
        let dir = tempfile::tempdir().unwrap();
        let writer = begun(dir.path());
        let refused = writer.prepared(&Never).unwrap_err();
        assert!(matches!(refused, JournalError::NotEncoded { .. }), "{refused}");
        writer.prepared(&1).unwrap();
        writer.sync().unwrap();
        let index = JournalIndex::read(dir.path()).unwrap();
        let prepared: Vec<&Value> = index.files.iter().flat_map(|file| &file.prepared).collect();
        assert_eq!(prepared, [&Value::from(1)]);
    }

    #[test]
    fn a_bridge_that_was_prepared_is_no_death_of_an_earlier_process() {
        let dir = tempfile::tempdir().unwrap();
        let [first, second] = [PreparationKey([1; 16]), PreparationKey([2; 16])];
        let deaths = || JournalIndex::read(dir.path()).unwrap().deaths_in_preparation();
        // none of these says that it came to its end
        for died in 1..=2 {
            begun(dir.path()).preparing(&[first, second]).unwrap();
            assert_eq!(deaths(), [(first, died), (second, died)].into());
        }
        let writer = begun(dir.path());
        writer.preparing(&[first]).unwrap();
        writer.prepared(&1).unwrap();
        assert_eq!(deaths(), [(second, 2)].into());
        // nor is one that ended by itself, nor one that solves jobs apart
        writer.preparing(&[first]).unwrap();
        writer
            .end(&SessionEnd {
                how: "interrupted".to_owned(),
                finished: String::new(),
                offline_s: 0.0,
                jobs_s: 0.0,
            })
            .unwrap();
        let apart = begun_as(dir.path(), true);
        apart.preparing(&[first]).unwrap();
        drop(apart);
        assert_eq!(deaths(), [(second, 2)].into());
        let index = JournalIndex::read(dir.path()).unwrap();
        assert_eq!(index.preparing_apart(1).collect::<Vec<_>>(), [&first]);
        assert_eq!(index.preparing_apart(2).count(), 0);
    }
}
