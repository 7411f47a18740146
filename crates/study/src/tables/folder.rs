//! The folder of results: files are replaced whole or not at all.
//!
//! Knows temporary names, syncing and renaming. Does not know what a file holds.

use super::table::TableName;
use super::{manifest, writer};
use crate::journal::fault::{self, Watched};
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};
use thiserror::Error;

/// A file of the results could not be written.
#[derive(Debug, Error)]
#[error("{}: {cause}", path.display())]
pub struct FolderError {
    /// The file.
    pub path: PathBuf,
    /// What the system said.
    pub cause: io::Error,
}

/// Name of a report's page beside the tables that it shows.
pub const PAGE: &str = "report.html";

/// The files of a run's results.
#[derive(Debug, Clone, Copy)]
pub struct OwnFiles;

impl OwnFiles {
    /// The ones that a folder holds, the manifest first: without it the others are no results.
    pub fn in_folder(folder: &Path) -> Vec<PathBuf> {
        let tables = TableName::ALL.map(TableName::file);
        let names = [manifest::FILE, writer::SUMMARY]
            .into_iter()
            .chain(tables.iter().map(String::as_str));
        names
            .map(|name| folder.join(name))
            .filter(|path| path.exists())
            .collect()
    }
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
        let probe = folder.partial("probe");
        File::create(&probe)
            .and_then(|_| fs::remove_file(&probe))
            .map_err(error)?;
        Ok(folder)
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    fn partial(&self, name: &str) -> PathBuf {
        self.path.join(format!(".{name}.partial"))
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
    pub(super) fn begin(&self, name: &str) -> Result<Partial, FolderError> {
        let (partial, path) = (self.partial(name), self.path.join(name));
        match File::create(&partial) {
            Ok(file) => Ok(Partial {
                file,
                partial,
                path,
                placed: false,
                failure: Arc::default(),
            }),
            Err(cause) => Err(FolderError { path, cause }),
        }
    }

    /// Removes what runs that died had begun; that something of it stays where removing fails changes nothing.
    pub(super) fn remove_partials(&self) {
        for name in TableName::ALL.map(TableName::file) {
            let _ = fs::remove_file(self.partial(&name));
        }
    }

    /// Brings removed and renamed files to the disk.
    ///
    /// # Errors
    /// [`FolderError`].
    pub(super) fn sync(&self) -> Result<(), FolderError> {
        let synced = File::open(&self.path).and_then(|folder| folder.sync_all());
        synced.map_err(|cause| FolderError {
            path: self.path.clone(),
            cause,
        })
    }

    /// Removes a file that an earlier run left, whole or begun, and this one does not write.
    ///
    /// # Errors
    /// [`FolderError`].
    pub fn remove(&self, name: &str) -> Result<(), FolderError> {
        for path in [self.partial(name), self.path.join(name)] {
            match fs::remove_file(&path) {
                Err(cause) if cause.kind() != io::ErrorKind::NotFound => return Err(FolderError { path, cause }),
                _ => {}
            }
        }
        Ok(())
    }
}

/// A file under its temporary name. One that is dropped before it was placed is removed.
#[derive(Debug)]
pub(super) struct Partial {
    file: File,
    partial: PathBuf,
    path: PathBuf,
    placed: bool,
    failure: Arc<OnceLock<(io::ErrorKind, String)>>,
}

impl Partial {
    /// The file, to be written.
    ///
    /// # Errors
    /// [`FolderError`].
    pub(super) fn watched(&self) -> Result<Watched, FolderError> {
        let file = self.file.try_clone().map_err(|cause| self.error(cause))?;
        Ok(Watched {
            place: "tables.write",
            file,
            failure: Arc::clone(&self.failure),
        })
    }

    /// The error of this file.
    pub(super) fn error(&self, cause: io::Error) -> FolderError {
        let path = self.path.clone();
        let said = self
            .failure
            .get()
            .map(|(kind, text)| io::Error::new(*kind, text.clone()));
        FolderError {
            path,
            cause: said.unwrap_or(cause),
        }
    }

    /// Syncs what was written, so that placing it can hardly fail any more, and leaves its blake3 hash.
    ///
    /// # Errors
    /// [`FolderError`].
    pub(super) fn sync(&self) -> Result<String, FolderError> {
        let synced = fault::at("tables.sync")
            .and_then(|()| self.file.sync_all())
            .and_then(|()| fault::at("tables.synced"))
            .and_then(|()| hash_of(&self.partial));
        synced.map_err(|cause| self.error(cause))
    }

    /// Syncs the file and renames it into place.
    ///
    /// # Errors
    /// [`FolderError`]; the file of that name is then as it was.
    pub(super) fn place(mut self) -> Result<(), FolderError> {
        let folder = self.path.parent().unwrap_or(Path::new(""));
        let placed = self.file.sync_all().and_then(|()| {
            fault::at("tables.rename")?;
            fs::rename(&self.partial, &self.path)?;
            self.placed = true;
            fault::at("tables.renamed")?;
            File::open(folder)?.sync_all()
        });
        placed.map_err(|cause| self.error(cause))
    }
}

impl Drop for Partial {
    fn drop(&mut self) {
        if !self.placed {
            // It is of no use to anybody; that it stays where removing fails too changes nothing.
            let _ = fs::remove_file(&self.partial);
        }
    }
}

/// The blake3 hash of a file's bytes.
pub(crate) fn hash_of(path: &Path) -> io::Result<String> {
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
