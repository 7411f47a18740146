//! Old results moved out of the way, under their hash.
//!
//! Knows which files of a folder are results. Removes nothing: a later `mv` brings everything back.

use super::SweepError;
use pontoon_journal::place::sync_folder;
use pontoon_journal::{DOCUMENTS, FOLDER, JournalError, JournalIndex};
use pontoon_results::{OwnFiles, PAGE};
use std::fs;
use std::path::{Path, PathBuf};

/// Folder of what was moved aside, in the folder of results.
const ASIDE: &str = "aside";

/// Moves the results of a folder to `aside/HASH`, the journal last: until then the folder is what it was, and the next run
/// with the same wish goes on moving. Tells where to; nothing where there is nothing to move.
pub(super) fn archive(folder: &Path, index: Option<&JournalIndex>) -> Result<Option<PathBuf>, SweepError> {
    let mut list = OwnFiles::in_folder(folder);
    let rest = [DOCUMENTS, FOLDER].map(|name| folder.join(name));
    list.extend(rest.into_iter().filter(|path| path.exists()));
    if list.is_empty() {
        return Ok(None);
    }
    // a page of theirs goes with them, before the journal
    let page = folder.join(PAGE);
    if page.exists() {
        list.insert(0, page);
    }
    let to = free(&folder.join(ASIDE), &name(index));
    let error = |path: &Path, cause| JournalError::Io {
        path: path.to_owned(),
        cause,
    };
    fs::create_dir_all(&to).map_err(|cause| error(&to, cause))?;
    // the new entries first, so that nothing is moved into what may be gone
    for dir in [folder, &folder.join(ASIDE)] {
        sync_folder(dir).map_err(|cause| error(dir, cause))?;
    }
    for path in list {
        let target = to.join(path.file_name().unwrap_or_default());
        pontoon_journal::fault::at("aside.rename")
            .and_then(|()| fs::rename(&path, &target))
            .map_err(|cause| error(&path, cause))?;
    }
    for dir in [to.as_path(), folder] {
        sync_folder(dir).map_err(|cause| error(dir, cause))?;
    }
    Ok(Some(to))
}

/// A hash of what the records are bound to and of the study.
fn name(index: Option<&JournalIndex>) -> String {
    let mut hasher = blake3::Hasher::new();
    for written in index.into_iter().flat_map(|index| &index.files) {
        let parts = (
            &written.binding,
            written.session.as_ref().map(|session| &session.study_blake3),
        );
        hasher.update(serde_json::to_string(&parts).unwrap_or_default().as_bytes());
    }
    hasher.finalize().to_hex()[..12].to_owned()
}

/// The first name that no folder has which holds a journal already.
fn free(within: &Path, name: &str) -> PathBuf {
    let mut number = 1;
    loop {
        let path = if number == 1 {
            within.join(name)
        } else {
            within.join(format!("{name}-{number}"))
        };
        if !path.join(FOLDER).exists() {
            return path;
        }
        number += 1;
    }
}
