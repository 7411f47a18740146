//! Names of the files of results, and which file may be written over.
//!
//! Knows which files a run leaves in its folder. Does not know what they hold: each writer tells its own files.

use super::table::TableName;
use pontoon_plan::input::Refusal;
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};

/// Name of the manifest's file.
pub(crate) const MANIFEST: &str = "manifest.json";

/// Name of the summary's file.
pub(crate) const SUMMARY: &str = "summary.csv";

/// Name of the file that says how often limits are exceeded.
pub(crate) const SUMMARY_OF_LIMITS: &str = "summary_limits.csv";

/// Name of a report's page beside the tables that it shows.
pub const PAGE: &str = "report.html";

/// The files of a run's results.
#[derive(Debug, Clone, Copy)]
pub struct OwnFiles;

impl OwnFiles {
    /// The ones that a folder holds, the manifest first: without it the others are no results.
    pub fn in_folder(folder: &Path) -> Vec<PathBuf> {
        let tables = TableName::ALL.map(TableName::file);
        let names = [MANIFEST, SUMMARY, SUMMARY_OF_LIMITS]
            .into_iter()
            .chain(tables.iter().map(String::as_str));
        names
            .map(|name| folder.join(name))
            .filter(|path| path.exists())
            .collect()
    }
}

/// Most bytes of a file that are looked at for whose it is.
const LOOKED_AT: u64 = 1 << 20;

/// The place of a file to be written, through a link to the file that it names: a new one, an empty one, or one of the
/// writer's `own`, which sees the first bytes of a file. `allowed` says in words which files these are.
///
/// # Errors
/// [`Refusal`] of a folder, of what is no regular file, of a name that is no text, and of every other file, which somebody
/// may miss.
pub fn replaceable(asked: &Path, allowed: &str, own: impl Fn(&[u8]) -> bool) -> Result<PathBuf, Refusal> {
    let out = match fs::canonicalize(asked) {
        Ok(target) if asked.is_symlink() => target,
        _ => asked.to_owned(),
    };
    let refuse = |found: &str| Err(Refusal::new(&out, "", found, format!("a new file, or {allowed}")));
    if out.is_dir() {
        return refuse("a folder");
    }
    if out.file_name().and_then(|name| name.to_str()).is_none() {
        return refuse("no name of a file in Unicode");
    }
    if out.is_symlink() {
        return refuse("a link to nothing");
    }
    if out.exists() {
        if !out.is_file() {
            return refuse("no regular file");
        }
        if !beginning(&out).is_ok_and(|bytes| bytes.is_empty() || own(&bytes)) {
            return refuse("another file");
        }
    }
    Ok(out)
}

fn beginning(path: &Path) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    File::open(path)?.take(LOOKED_AT).read_to_end(&mut bytes)?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_written_over_but_ones_own_files() {
        let dir = tempfile::tempdir().unwrap();
        let path = |name: &str| dir.path().join(name);
        let told = |name: &str| {
            let own = |bytes: &[u8]| bytes.starts_with(b"mine");
            replaceable(&path(name), "one of mine", own).map_err(|refused| refused.to_string())
        };
        assert_eq!(told("new"), Ok(path("new")));
        for (name, text, good) in [("own", "mine: 1", true), ("empty", "", true), ("notes", "his", false)] {
            fs::write(path(name), text).unwrap();
            assert_eq!(told(name).is_ok(), good, "{name}");
        }
        let refused = told("notes").unwrap_err();
        assert!(
            refused.ends_with("found another file, allowed: a new file, or one of mine"),
            "{refused}"
        );
        assert!(told("").unwrap_err().contains("found a folder"));
        assert_eq!(fs::read(path("notes")).unwrap(), b"his");
    }
}
