//! The documents that a run is of, each in a file of its own under its hash.
//!
//! Knows that a text stands once, however many processes and tables are of it, and that a file proves to be whole by its name.
//! Does not know what a document means.

use super::place::{FolderError, HiddenFile, hash_of, sync_folder};
use super::{JournalError, fault};
use std::fs;
use std::io;
use std::path::Path;

/// Name of their folder in a folder of results.
pub const DOCUMENTS: &str = "documents";

/// The name of a document's file within a folder of results.
pub fn document_file(hash: &str) -> String {
    format!("{DOCUMENTS}/{hash}.json")
}

/// Keeps the text of a hash in a folder of results; one that is there and whole stays as it is.
///
/// # Errors
/// [`FolderError`] with the file.
pub fn keep_document(folder: &Path, hash: &str, text: &str) -> Result<(), FolderError> {
    let (documents, path) = (folder.join(DOCUMENTS), folder.join(document_file(hash)));
    if hash_of(&path).is_ok_and(|found| found == hash) {
        return Ok(());
    }
    let keep = || {
        fs::create_dir_all(&documents)?;
        let hidden = HiddenFile::begin(&path)?;
        fault::write_all("documents.write", hidden.file(), text.as_bytes())?;
        hidden.file().sync_all()?;
        fault::at("documents.rename")?;
        hidden.put()?;
        sync_folder(&documents)?;
        sync_folder(folder)
    };
    keep().map_err(|cause| FolderError { path, cause })
}

/// Reads the text of a hash from a folder of results.
///
/// # Errors
/// [`JournalError::Document`] where it is not there or not whole.
pub fn read_document(folder: &Path, hash: &str) -> Result<String, JournalError> {
    let path = folder.join(document_file(hash));
    let read = fs::read(&path).and_then(|bytes| match blake3::hash(&bytes).to_hex().as_str() == hash {
        true => String::from_utf8(bytes).map_err(io::Error::other),
        false => Err(io::Error::other("its bytes are not the ones of the hash in its name")),
    });
    read.map_err(|cause| JournalError::Document { path, cause })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_document_is_kept_once_and_written_again_where_it_is_damaged() {
        let dir = tempfile::tempdir().unwrap();
        let text = r#"{"name":"a"}"#;
        let hash = blake3::hash(text.as_bytes()).to_hex().to_string();
        let path = dir.path().join(document_file(&hash));
        let written = || fs::metadata(&path).unwrap().modified().unwrap();
        keep_document(dir.path(), &hash, text).unwrap();
        let first = written();
        keep_document(dir.path(), &hash, text).unwrap();
        assert_eq!(written(), first);
        assert_eq!(read_document(dir.path(), &hash).unwrap(), text);
        fs::write(&path, r#"{"name":"b"}"#).unwrap();
        let told = read_document(dir.path(), &hash).unwrap_err().to_string();
        assert!(
            told.contains("its bytes are not the ones of the hash in its name"),
            "{told}"
        );
        keep_document(dir.path(), &hash, text).unwrap();
        assert_eq!(read_document(dir.path(), &hash).unwrap(), text);
        fs::remove_file(&path).unwrap();
        assert!(read_document(dir.path(), &hash).is_err());
    }
}
