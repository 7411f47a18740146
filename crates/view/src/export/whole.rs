//! A folder that is there whole or not at all.
//!
//! Knows how files are gathered beside it under a hidden name, synced, and put in its place at once, and what of an older
//! folder may be replaced. Does not know what a file holds.
//!
//! On Windows no folder can be held by a lock: what a process left that died stays there under its hidden name, and with it
//! the old folder where it died between two steps of putting the new one in its place.

use super::ExportError;
use pontoon_journal::fault::{self, Watched};
use pontoon_journal::place::{FolderError, sync_folder};
use pontoon_plan::input::{Refusal, pretty};
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The file that says what a folder holds; by its list of files an earlier export is known.
pub(super) const CONTENTS: &str = "export.json";

/// How a hidden name ends: of a folder that is gathered, and of the old one while the two take each other's place.
const PARTIAL: &str = "partial";
const ASIDE: &str = "aside";

/// A folder being gathered. One that is dropped before it is placed leaves nothing.
#[derive(Debug)]
pub(super) struct WholeFolder {
    place: PathBuf,
    gathered: PathBuf,
    /// Held as long as this lives, so that what a process left that died is known by it.
    _held: Option<File>,
    files: BTreeSet<String>,
    placed: bool,
}

impl WholeFolder {
    /// Begins a folder at `to`: one that is not there, is empty or holds an earlier export.
    ///
    /// # Errors
    /// [`ExportError::Refused`] where it holds anything else, [`ExportError::Folder`].
    pub(super) fn begin(to: &Path) -> Result<Self, ExportError> {
        check_free(to)?;
        let place = if to.exists() {
            fs::canonicalize(to).map_err(|cause| error(to, cause))?
        } else {
            let parent = to.parent().filter(|parent| !parent.as_os_str().is_empty());
            fs::create_dir_all(parent.unwrap_or(Path::new("."))).map_err(|cause| error(to, cause))?;
            to.to_owned()
        };
        let Some(name) = place.file_name().map(|name| name.to_string_lossy().into_owned()) else {
            return Err(Refusal::new(to, "", "no name of a folder", "the path of a folder that can be made").into());
        };
        let parent = place.parent().unwrap_or(Path::new("")).to_owned();
        remove_dead(&parent, &name);
        let gathered = parent.join(format!(".{name}.{}.{PARTIAL}", std::process::id()));
        let begin = || {
            fs::create_dir(&gathered)?;
            hold(&gathered)
        };
        let held = begin().map_err(|cause| error(to, cause))?;
        Ok(Self {
            place,
            gathered,
            _held: held,
            files: BTreeSet::new(),
            placed: false,
        })
    }

    /// Writes and syncs a file; one of that name is replaced.
    ///
    /// # Errors
    /// [`FolderError`].
    pub(super) fn write(
        &mut self,
        name: &str,
        content: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> Result<(), FolderError> {
        let write = || {
            let file = File::create(self.gathered.join(name))?;
            let mut out = BufWriter::with_capacity(
                1 << 16,
                Watched {
                    place: "export.write",
                    file: file.try_clone()?,
                    failure: Arc::default(),
                },
            );
            content(&mut out)?;
            out.flush()?;
            fault::at("export.sync")?;
            file.sync_all()
        };
        write().map_err(|cause| error(&self.place.join(name), cause))?;
        self.files.insert(name.to_owned());
        Ok(())
    }

    /// Forgets the files written so far.
    pub(super) fn clear(&mut self) {
        for name in std::mem::take(&mut self.files) {
            // one that stays is no part of the folder's contents and goes with the rest
            let _ = fs::remove_file(self.gathered.join(name));
        }
    }

    /// Writes what the folder holds and puts it in its place, an earlier export's out of it.
    ///
    /// # Errors
    /// As [`Self::begin`]. What was there before is there still, but where the words say that the new folder is in its place.
    pub(super) fn place(mut self, mut contents: Value) -> Result<usize, ExportError> {
        self.files.insert(CONTENTS.to_owned());
        contents["files"] = json!(self.files);
        self.write(CONTENTS, |out| out.write_all(pretty(&contents).as_bytes()))?;
        check_free(&self.place)?;
        self.swap().map_err(|cause| error(&self.place, cause))?;
        Ok(self.files.len())
    }

    fn swap(&mut self) -> io::Result<()> {
        sync_folder(&self.gathered)?;
        fault::at("export.rename")?;
        let replaces = self.place.exists();
        if replaces {
            exchange(&self.gathered, &self.place)?;
        } else {
            fs::rename(&self.gathered, &self.place)?;
        }
        self.placed = true;
        let synced = self.synced();
        if replaces {
            // the new folder is in its place: what stays of the old one is out of the way
            let _ = fs::remove_dir_all(&self.gathered);
        }
        synced.map_err(|cause| {
            let words =
                format!("the new folder is in its place and whole, but may not outlast a loss of power: {cause}");
            io::Error::new(cause.kind(), words)
        })
    }

    /// Syncs the folder in which the place is.
    fn synced(&self) -> io::Result<()> {
        fault::at("export.renamed")?;
        let parent = self.place.parent().filter(|parent| !parent.as_os_str().is_empty());
        sync_folder(parent.unwrap_or(Path::new(".")))
    }
}

/// Two folders take each other's place at once; one after the other where the file system knows no better.
fn exchange(new: &Path, old: &Path) -> io::Result<()> {
    #[cfg(target_os = "linux")]
    {
        use rustix::fs::{CWD, RenameFlags, renameat_with};
        if renameat_with(CWD, new, CWD, old, RenameFlags::EXCHANGE).is_ok() {
            return Ok(());
        }
    }
    take_turns(new, old)
}

/// Two folders take each other's place in three steps. Who dies between them leaves the old folder under a name by which
/// [`remove_dead`] finds it.
fn take_turns(new: &Path, old: &Path) -> io::Result<()> {
    // held as long as the steps last, so that nobody takes the old folder for a dead one's
    let _held = hold(old)?;
    let aside = new.with_extension(ASIDE);
    fs::rename(old, &aside)?;
    if let Err(cause) = fs::rename(new, old) {
        fs::rename(&aside, old)?;
        return Err(cause);
    }
    fs::rename(&aside, new)
}

/// Holds a folder by a lock as long as the file lives; none where a system opens no folder as a file, as Windows does not.
fn hold(folder: &Path) -> io::Result<Option<File>> {
    if !cfg!(unix) {
        return Ok(None);
    }
    let file = File::open(folder)?;
    file.lock()?;
    Ok(Some(file))
}

/// Whether a folder is one that its process died over: nobody holds it. Nobody can say where none can be held.
fn is_dead(folder: &Path) -> bool {
    cfg!(unix) && File::open(folder).is_ok_and(|folder| folder.try_lock().is_ok())
}

impl Drop for WholeFolder {
    fn drop(&mut self) {
        if !self.placed {
            // It is of no use to anybody; that it stays where removing fails too changes nothing.
            let _ = fs::remove_dir_all(&self.gathered);
        }
    }
}

fn error(path: &Path, cause: io::Error) -> FolderError {
    FolderError {
        path: path.to_owned(),
        cause,
    }
}

/// Refuses a place that holds anything but an earlier export.
fn check_free(to: &Path) -> Result<(), ExportError> {
    let refuse = |found: String| {
        let allowed = "a folder that is not there, is empty, or holds an earlier export and nothing else";
        Err(ExportError::from(Refusal::new(to, "", found, allowed)))
    };
    if !to.exists() {
        return Ok(());
    }
    if !to.is_dir() {
        return refuse("a file".to_owned());
    }
    let own = files_of(to);
    let entries = fs::read_dir(to).map_err(|cause| error(to, cause))?;
    let mut names = Vec::new();
    for entry in entries {
        let entry = entry.map_err(|cause| error(to, cause))?;
        names.push(entry.file_name().to_string_lossy().into_owned());
    }
    names.sort();
    match names.into_iter().find(|name| !own.contains(name)) {
        Some(foreign) => refuse(format!("'{foreign}', which no export has written there")),
        None => Ok(()),
    }
}

/// The files of an earlier export in a folder; none where there was none.
fn files_of(folder: &Path) -> BTreeSet<String> {
    let contents = fs::read(folder.join(CONTENTS)).ok();
    let contents: Option<Value> = contents.and_then(|bytes| serde_json::from_slice(&bytes).ok());
    let files = contents.as_ref().and_then(|contents| contents["files"].as_array());
    let names = files.into_iter().flatten().filter_map(Value::as_str);
    names.map(str::to_owned).collect()
}

/// Removes what processes gathered for this place and died over; that something of it stays changes nothing. An old folder
/// that one of them had put aside is put back where nothing is in its place.
fn remove_dead(parent: &Path, name: &str) {
    let here = if parent.as_os_str().is_empty() {
        Path::new(".")
    } else {
        parent
    };
    let start = format!(".{name}.");
    for entry in fs::read_dir(here).into_iter().flatten().flatten() {
        let found = entry.file_name().to_string_lossy().into_owned();
        let Some((number, end)) = found.strip_prefix(&start).and_then(|rest| rest.split_once('.')) else {
            continue;
        };
        let numbered = !number.is_empty() && number.bytes().all(|b| b.is_ascii_digit());
        if !numbered || ![PARTIAL, ASIDE].contains(&end) {
            continue;
        }
        if !is_dead(&entry.path()) {
            continue;
        }
        let place = here.join(name);
        if end == ASIDE && !place.exists() {
            let _ = fs::rename(entry.path(), place);
        } else {
            let _ = fs::remove_dir_all(entry.path());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<String> = fs::read_dir(folder)
            .unwrap()
            .map(|e| e.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    fn export(to: &Path, files: &[&str]) -> Result<usize, ExportError> {
        let mut folder = WholeFolder::begin(to)?;
        for file in files {
            folder.write(file, |out| out.write_all(file.as_bytes()))?;
        }
        folder.place(json!({}))
    }

    #[test]
    fn an_earlier_export_is_replaced_and_nothing_else_is() {
        let dir = tempfile::tempdir().unwrap();
        let to = dir.path().join("a/vtk");
        assert_eq!(export(&to, &["a.vtu", "b.vtu"]).unwrap(), 3);
        assert_eq!(export(&to, &["c.vtu"]).unwrap(), 2);
        assert_eq!(names(&to), ["c.vtu", CONTENTS]);
        fs::write(to.join("notes.txt"), "mine").unwrap();
        let refused = export(&to, &["d.vtu"]).unwrap_err().to_string();
        assert!(refused.contains("'notes.txt'"), "{refused}");
        assert_eq!(names(&to), ["c.vtu", CONTENTS, "notes.txt"]);
        assert_eq!(names(&dir.path().join("a")), ["vtk"]);
    }

    #[test]
    fn a_folder_that_fails_half_way_leaves_nothing() {
        let dir = tempfile::tempdir().unwrap();
        let to = dir.path().join("vtk");
        let mut folder = WholeFolder::begin(&to).unwrap();
        folder.write("a", |out| out.write_all(b"a")).unwrap();
        folder.write("b", |_| Err(io::Error::other("full"))).unwrap_err();
        drop(folder);
        assert!(names(dir.path()).is_empty());
    }

    #[test]
    fn what_a_dead_process_left_is_removed_and_what_a_living_one_gathers_is_not() {
        let dir = tempfile::tempdir().unwrap();
        let dead = dir.path().join(".vtk.1.partial");
        fs::create_dir(&dead).unwrap();
        fs::write(dead.join("a.vtu"), "").unwrap();
        fs::create_dir(dir.path().join(".vtk.notes.partial")).unwrap();
        let folder = WholeFolder::begin(&dir.path().join("vtk")).unwrap();
        let own = format!(".vtk.{}.partial", std::process::id());
        assert_eq!(names(dir.path()), [own.as_str(), ".vtk.notes.partial"]);
        remove_dead(dir.path(), "vtk");
        assert_eq!(names(dir.path()), [own.as_str(), ".vtk.notes.partial"]);
        drop(folder);
    }
    /// On a file system that cannot exchange two folders at once.
    #[test]
    fn folders_take_turns_where_they_cannot_be_exchanged_at_once() {
        let dir = tempfile::tempdir().unwrap();
        let (new, old) = (dir.path().join(".vtk.1.partial"), dir.path().join("vtk"));
        for (folder, file) in [(&new, "new"), (&old, "old")] {
            fs::create_dir(folder).unwrap();
            fs::write(folder.join(file), "").unwrap();
        }
        take_turns(&new, &old).unwrap();
        assert_eq!(
            (names(&old), names(&new)),
            (vec!["new".to_owned()], vec!["old".to_owned()])
        );
        assert_eq!(names(dir.path()), [".vtk.1.partial", "vtk"]);
        // the new folder cannot take its place: the old one is back in it
        fs::remove_dir_all(&new).unwrap();
        take_turns(&new, &old).unwrap_err();
        assert_eq!(
            (names(&old), names(dir.path())),
            (vec!["new".to_owned()], vec!["vtk".to_owned()])
        );
    }

    #[test]
    fn an_export_that_a_dead_process_put_aside_is_put_back() {
        let dir = tempfile::tempdir().unwrap();
        let to = dir.path().join("vtk");
        export(&to, &["a.vtu"]).unwrap();
        // dead after the first of its three steps
        fs::create_dir(dir.path().join(".vtk.1.partial")).unwrap();
        fs::rename(&to, dir.path().join(".vtk.1.aside")).unwrap();
        let folder = WholeFolder::begin(&to).unwrap();
        assert_eq!(names(&to), ["a.vtu", CONTENTS]);
        drop(folder);
        assert_eq!(names(dir.path()), ["vtk"]);
        // dead after the second
        fs::create_dir(dir.path().join(".vtk.1.aside")).unwrap();
        fs::write(dir.path().join(".vtk.1.aside/b.vtu"), "").unwrap();
        assert_eq!(export(&to, &["c.vtu"]).unwrap(), 2);
        assert_eq!(
            (names(&to), names(dir.path())),
            (vec!["c.vtu".to_owned(), CONTENTS.to_owned()], vec!["vtk".to_owned()])
        );
    }
}
