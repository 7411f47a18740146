//! The folder of results: files are replaced whole or not at all.
//!
//! Knows temporary names, syncing and renaming. Does not know what a file holds.

use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
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
    pub fn write(&self, name: &str, content: impl FnOnce(&mut File) -> io::Result<()>) -> Result<(), FolderError> {
        let (partial, path) = (self.partial(name), self.path.join(name));
        let written = File::create(&partial).and_then(|mut file| {
            content(&mut file)?;
            file.sync_all()?;
            fs::rename(&partial, &path)?;
            File::open(&self.path)?.sync_all()
        });
        written.map_err(|cause| {
            // The partial file is of no use to anybody; that it stays where removing fails too changes nothing.
            let _ = fs::remove_file(&partial);
            FolderError { path, cause }
        })
    }

    /// Removes a file that an earlier run left and this one does not write.
    ///
    /// # Errors
    /// [`FolderError`].
    pub fn remove(&self, name: &str) -> Result<(), FolderError> {
        let path = self.path.join(name);
        match fs::remove_file(&path) {
            Err(cause) if cause.kind() != io::ErrorKind::NotFound => Err(FolderError { path, cause }),
            _ => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;

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
