//! Names of the files of results.
//!
//! Knows which files a run leaves in its folder. Does not know what they hold.

use super::table::TableName;
use std::path::{Path, PathBuf};

/// Name of the manifest's file.
pub(crate) const MANIFEST: &str = "manifest.json";

/// Name of the summary's file.
pub(crate) const SUMMARY: &str = "summary.csv";

/// Name of a report's page beside the tables that it shows.
pub const PAGE: &str = "report.html";

/// The files of a run's results.
#[derive(Debug, Clone, Copy)]
pub struct OwnFiles;

impl OwnFiles {
    /// The ones that a folder holds, the manifest first: without it the others are no results.
    pub fn in_folder(folder: &Path) -> Vec<PathBuf> {
        let tables = TableName::ALL.map(TableName::file);
        let names = [MANIFEST, SUMMARY].into_iter().chain(tables.iter().map(String::as_str));
        names
            .map(|name| folder.join(name))
            .filter(|path| path.exists())
            .collect()
    }
}
