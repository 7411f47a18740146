//! One process at a time in a folder of results.
//!
//! Knows that the system lets go of a lock when its process dies, however it does. Does not know what is done in the folder.

use super::JournalError;
use std::fs::{self, File, TryLockError};
use std::io::{self, Write};
use std::path::Path;
use std::time::Duration;

/// Name of the lock's file. The file stays; the lock on it is what counts.
pub(super) const FILE: &str = "lock";

/// How often a folder that is held is asked for again: who only wants to know whether it is held, holds it for an instant.
const TRIES: usize = 20;
const BETWEEN_TRIES: Duration = Duration::from_millis(10);

/// A folder that is this process's own as long as this lives.
#[derive(Debug)]
pub struct Lock {
    _file: File,
}

impl Lock {
    /// Takes a folder.
    ///
    /// # Errors
    /// [`JournalError::InUse`] with what its holder wrote of itself; [`JournalError::Io`].
    pub fn take(folder: &Path) -> Result<Self, JournalError> {
        let path = folder.join(FILE);
        let error = |cause| JournalError::io(&path, cause);
        let options = File::options()
            .create(true)
            .truncate(false)
            .read(true)
            .write(true)
            .clone();
        let mut file = options.open(&path).map_err(error)?;
        let mut tried = file.try_lock();
        for _ in 0..TRIES {
            if !matches!(tried, Err(TryLockError::WouldBlock)) {
                break;
            }
            std::thread::sleep(BETWEEN_TRIES);
            tried = file.try_lock();
        }
        match tried {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                let holder = fs::read_to_string(&path).unwrap_or_default();
                return Err(JournalError::InUse {
                    folder: folder.to_owned(),
                    holder: holder.trim().to_owned(),
                });
            }
            Err(TryLockError::Error(cause)) => return Err(error(said(cause))),
        }
        let me = format!("process {} on {}\n", std::process::id(), super::host());
        // who holds the lock is told to others where it can be; the lock does not hang on it
        let _ = file.set_len(0).and_then(|()| file.write_all(me.as_bytes()));
        Ok(Self { _file: file })
    }

    /// Whether a process has ever taken a folder.
    pub fn is_known(folder: &Path) -> bool {
        folder.join(FILE).exists()
    }

    /// Whether a process holds a folder now.
    pub fn is_held(folder: &Path) -> bool {
        File::open(folder.join(FILE)).is_ok_and(|file| matches!(file.try_lock_shared(), Err(TryLockError::WouldBlock)))
    }
}

/// Numbers by which Linux says that a file system knows no locks: ENOLCK, ENOSYS, EOPNOTSUPP.
const NO_LOCKS: [i32; 3] = [37, 38, 95];

/// What the system said, and what it means where the file system has no locks.
fn said(cause: io::Error) -> io::Error {
    let without = cause.kind() == io::ErrorKind::Unsupported
        || cause.raw_os_error().is_some_and(|number| NO_LOCKS.contains(&number));
    if !without {
        return cause;
    }
    let words = format!(
        "this file system has no locks (flock), by which one process at a time works in a folder; put the results on one that has them ({cause})"
    );
    io::Error::new(cause.kind(), words)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_system_without_locks_is_named() {
        for number in NO_LOCKS {
            let told = said(io::Error::from_raw_os_error(number)).to_string();
            assert!(told.starts_with("this file system has no locks (flock)"), "{told}");
        }
        let other = said(io::Error::from_raw_os_error(5)).to_string();
        assert!(!other.contains("flock"), "{other}");
    }

    #[test]
    fn a_folder_has_one_holder_and_a_stale_file_holds_nothing() {
        let dir = tempfile::tempdir().unwrap();
        fs::write(dir.path().join(FILE), "process 1 on elsewhere").unwrap();
        assert!(!Lock::is_held(dir.path()));
        let lock = Lock::take(dir.path()).unwrap();
        assert!(Lock::is_held(dir.path()));
        let refused = Lock::take(dir.path()).unwrap_err().to_string();
        assert!(
            refused.contains(&format!("process {}", std::process::id())),
            "{refused}"
        );
        drop(lock);
        // who asks whether it is held keeps nobody out
        let stop = std::sync::atomic::AtomicBool::new(false);
        std::thread::scope(|scope| {
            scope.spawn(|| {
                while !stop.load(std::sync::atomic::Ordering::Relaxed) {
                    Lock::is_held(dir.path());
                }
            });
            for _ in 0..200 {
                drop(Lock::take(dir.path()).unwrap());
            }
            stop.store(true, std::sync::atomic::Ordering::Relaxed);
        });
        assert!(!Lock::is_held(dir.path()));
        Lock::take(dir.path()).unwrap();
    }
}
