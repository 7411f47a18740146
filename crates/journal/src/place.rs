//! Files that are replaced whole or not at all.
//!
//! Knows hidden names, syncing and renaming. Does not know what a file holds.

use crate::fault::{self, Watched};
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};
use tempfile::{Builder, NamedTempFile};
use thiserror::Error;

/// A file could not be written.
#[derive(Debug, Error)]
#[error("{}: {cause}", path.display())]
pub struct FolderError {
    /// The file.
    pub path: PathBuf,
    /// What the system said.
    pub cause: io::Error,
}

/// A file under a hidden name beside its place. One that is dropped before it is put there is removed.
#[derive(Debug)]
pub struct HiddenFile {
    hidden: NamedTempFile,
    place: PathBuf,
}

impl HiddenFile {
    /// Begins a file as `.NAME.partial`, for a process that alone writes in the folder; what a dead process left under that
    /// name is removed.
    ///
    /// # Errors
    /// What the system says.
    pub fn begin(place: &Path) -> io::Result<Self> {
        let hidden = hidden_name(place);
        match fs::remove_file(&hidden) {
            Err(cause) if cause.kind() != io::ErrorKind::NotFound => return Err(cause),
            _ => {}
        }
        let name = hidden.file_name().unwrap_or_default().to_os_string();
        Self::named(place, Builder::new().prefix(&name).rand_bytes(0))
    }

    /// Begins a file under a name of its own, where several processes may write the file at once: the last one stays.
    ///
    /// # Errors
    /// What the system says.
    pub fn begin_among_others(place: &Path) -> io::Result<Self> {
        Self::named(place, &Builder::new())
    }

    fn named(place: &Path, builder: &Builder<'_, '_>) -> io::Result<Self> {
        let folder = place.parent().filter(|folder| !folder.as_os_str().is_empty());
        // as every new file is made: the library's own way keeps other people from reading it, and names it in errors
        let create = |hidden: &Path| File::options().read(true).write(true).create_new(true).open(hidden);
        Ok(Self {
            hidden: builder.make_in(folder.unwrap_or(Path::new(".")), create)?,
            place: place.to_owned(),
        })
    }

    /// The file, to be written.
    pub fn file(&self) -> &File {
        self.hidden.as_file()
    }

    /// Where it is until it is put in its place.
    pub fn path(&self) -> &Path {
        self.hidden.path()
    }

    /// Where it belongs.
    pub fn place(&self) -> &Path {
        &self.place
    }

    /// Puts the file in its place. Whoever wants it to outlast a loss of power syncs it before and the folder after.
    ///
    /// # Errors
    /// What the system says; the file of that name is then as it was.
    pub fn put(self) -> io::Result<()> {
        self.hidden
            .persist(&self.place)
            .map(drop)
            .map_err(|failed| failed.error)
    }
}

/// The hidden name of a file that one process alone writes.
fn hidden_name(place: &Path) -> PathBuf {
    let name = place.file_name().unwrap_or_default().to_string_lossy();
    place.with_file_name(format!(".{name}.partial"))
}

/// A folder that can be written to.
#[derive(Debug, Clone)]
pub struct Folder {
    path: PathBuf,
}

impl Folder {
    /// Makes the folder where it is missing and tries whether a file can be written there, before hours are spent.
    ///
    /// # Errors
    /// [`FolderError`].
    pub fn create(path: &Path) -> Result<Self, FolderError> {
        let error = |cause| FolderError {
            path: path.to_owned(),
            cause,
        };
        fs::create_dir_all(path).map_err(error)?;
        let folder = Self { path: path.to_owned() };
        HiddenFile::begin(&path.join("probe")).map_err(error)?;
        Ok(folder)
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Writes a file under a temporary name, syncs it and renames it into place.
    ///
    /// # Errors
    /// [`FolderError`]; the file of that name is then as it was.
    pub fn write(&self, name: &str, content: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), FolderError> {
        let partial = self.begin(name)?;
        content(&mut partial.watched()?).map_err(|cause| partial.error(cause))?;
        partial.place()
    }

    /// Begins a file under a temporary name.
    ///
    /// # Errors
    /// [`FolderError`].
    pub fn begin(&self, name: &str) -> Result<Partial, FolderError> {
        let path = self.path.join(name);
        match HiddenFile::begin(&path) {
            Ok(hidden) => Ok(Partial {
                hidden,
                failure: Arc::default(),
            }),
            Err(cause) => Err(FolderError { path, cause }),
        }
    }

    /// Removes what a process that died had begun of a file; that it stays where removing fails changes nothing.
    pub fn remove_begun(&self, name: &str) {
        let _ = fs::remove_file(hidden_name(&self.path.join(name)));
    }

    /// Brings removed and renamed files to the disk.
    ///
    /// # Errors
    /// [`FolderError`].
    pub fn sync(&self) -> Result<(), FolderError> {
        sync_folder(&self.path).map_err(|cause| FolderError {
            path: self.path.clone(),
            cause,
        })
    }

    /// Removes a file that an earlier run left, whole or begun, and this one does not write.
    ///
    /// # Errors
    /// [`FolderError`].
    pub fn remove(&self, name: &str) -> Result<(), FolderError> {
        let path = self.path.join(name);
        for path in [hidden_name(&path), path] {
            match fs::remove_file(&path) {
                Err(cause) if cause.kind() != io::ErrorKind::NotFound => return Err(FolderError { path, cause }),
                _ => {}
            }
        }
        Ok(())
    }
}

/// A file of a folder under way. One that is dropped before it was placed is removed.
#[derive(Debug)]
pub struct Partial {
    hidden: HiddenFile,
    failure: Arc<OnceLock<(io::ErrorKind, String)>>,
}

impl Partial {
    /// The file, to be written.
    ///
    /// # Errors
    /// [`FolderError`].
    pub fn watched(&self) -> Result<Watched, FolderError> {
        let file = self.hidden.file().try_clone().map_err(|cause| self.error(cause))?;
        Ok(Watched {
            place: "tables.write",
            file,
            failure: Arc::clone(&self.failure),
        })
    }

    /// The error of this file.
    pub fn error(&self, cause: io::Error) -> FolderError {
        error(self.hidden.place(), &self.failure, cause)
    }

    /// Syncs what was written, so that placing it can hardly fail any more, and leaves its blake3 hash.
    ///
    /// # Errors
    /// [`FolderError`].
    pub fn sync(&self) -> Result<String, FolderError> {
        let synced = fault::at("tables.sync")
            .and_then(|()| self.hidden.file().sync_all())
            .and_then(|()| fault::at("tables.synced"))
            .and_then(|()| hash_of(self.hidden.path()));
        synced.map_err(|cause| self.error(cause))
    }

    /// Syncs the file and puts it in its place.
    ///
    /// # Errors
    /// [`FolderError`]; the file of that name is then as it was.
    pub fn place(self) -> Result<(), FolderError> {
        let Self { hidden, failure } = self;
        let path = hidden.place().to_owned();
        let folder = path.parent().unwrap_or(Path::new(""));
        let placed = hidden.file().sync_all().and_then(|()| {
            fault::at("tables.rename")?;
            hidden.put()?;
            fault::at("tables.renamed")?;
            sync_folder(folder)
        });
        placed.map_err(|cause| error(&path, &failure, cause))
    }
}

/// Brings the names in a folder to the disk: of files that were made, renamed or removed there.
///
/// # Errors
/// What the system says. Where a system opens no folder as a file, as Windows does not, nothing is done: such names are then
/// as lasting as the file system makes them by itself.
pub fn sync_folder(folder: &Path) -> io::Result<()> {
    if cfg!(unix) {
        File::open(folder)?.sync_all()
    } else {
        Ok(())
    }
}

/// The error of a file: what the system said of its first failed write, else `cause`.
fn error(path: &Path, failure: &OnceLock<(io::ErrorKind, String)>, cause: io::Error) -> FolderError {
    let said = failure.get().map(|(kind, text)| io::Error::new(*kind, text.clone()));
    FolderError {
        path: path.to_owned(),
        cause: said.unwrap_or(cause),
    }
}

/// The blake3 hash of a file's bytes.
pub fn hash_of(path: &Path) -> io::Result<String> {
    let mut hasher = blake3::Hasher::new();
    io::copy(&mut File::open(path)?, &mut hasher)?;
    Ok(hasher.finalize().to_hex().to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_that_fails_half_way_leaves_the_old_one() {
        let dir = tempfile::tempdir().unwrap();
        let folder = Folder::create(&dir.path().join("a/b")).unwrap();
        folder.write("t", |f| f.write_all(b"old")).unwrap();
        let failed = folder.write("t", |f| {
            f.write_all(b"ne")?;
            Err(io::Error::other("full"))
        });
        assert!(failed.unwrap_err().to_string().contains("full"));
        assert_eq!(fs::read(folder.path().join("t")).unwrap(), b"old");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn files_are_as_new_files_are_and_leave_nothing_when_dropped() {
        let dir = tempfile::tempdir().unwrap();
        let (place, other) = (dir.path().join("t"), dir.path().join("u"));
        fs::write(&other, b"").unwrap();
        // what a dead process left
        fs::write(dir.path().join(".t.partial"), b"torn").unwrap();
        for begin in [HiddenFile::begin, HiddenFile::begin_among_others] {
            drop(begin(&place).unwrap());
            let hidden = begin(&place).unwrap();
            hidden.file().write_all(b"new").unwrap();
            hidden.put().unwrap();
            assert_eq!(fs::read(&place).unwrap(), b"new");
            let mode = |path: &Path| fs::metadata(path).unwrap().permissions();
            assert_eq!(mode(&place), mode(&other));
            assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 2);
        }
    }

    #[test]
    fn what_the_system_says_is_said_as_it_is() {
        let dir = tempfile::tempdir().unwrap();
        let said = HiddenFile::begin_among_others(&dir.path().join("missing/t")).unwrap_err();
        assert_eq!(said.to_string(), "No such file or directory (os error 2)");
        assert_eq!(said.raw_os_error(), Some(2));
    }

    #[test]
    fn a_folder_that_cannot_be_is_an_error_with_its_path() {
        let dir = tempfile::tempdir().unwrap();
        let file = dir.path().join("f");
        fs::write(&file, b"x").unwrap();
        assert!(
            Folder::create(&file.join("r"))
                .unwrap_err()
                .to_string()
                .contains("/f/r")
        );
    }
}
