//! The documents that results are of, read when they are asked for.
//!
//! Knows where they stand: in files of their own, or, as version 0.1 left them, in the manifest. Does not know what they say
//! beyond the study's name and vehicle.

use super::results_error::ResultsError;
use pontoon_journal::place::FolderError;
use pontoon_journal::{JournalError, document_file, keep_document, read_document};
use pontoon_plan::input::Document;
use pontoon_plan::study_file::Study;
use serde::Deserialize;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// A document with its hash.
#[derive(Debug, Clone)]
struct StoredDocument {
    hash: String,
    read: OnceLock<Document>,
}

impl StoredDocument {
    fn of(document: Document) -> Self {
        Self {
            hash: document.hash(),
            read: OnceLock::from(document),
        }
    }

    fn get(&self, folder: &Path) -> Result<&Document, ResultsError> {
        if let Some(document) = self.read.get() {
            return Ok(document);
        }
        let text = read_document(folder, &self.hash).map_err(|error| ResultsError::Damaged {
            file: folder.join(document_file(&self.hash)),
            found: match error {
                JournalError::Document { cause, .. } => cause.to_string(),
                other => other.to_string(),
            },
        })?;
        Ok(self.read.get_or_init(|| Document::of_canonical(text)))
    }
}

/// The documents of a run: they may be large, and few readers need them.
#[derive(Debug, Clone)]
pub struct RunDocuments {
    folder: PathBuf,
    name: String,
    study: StoredDocument,
    bridge: StoredDocument,
    /// Water files by the paths that bridges name them by.
    waters: Vec<(String, StoredDocument)>,
    trees: OnceLock<[Value; 2]>,
}

/// What is read of a study without the rest of it.
#[derive(Deserialize)]
struct StudyHead {
    name: String,
    #[serde(default)]
    vehicle: Value,
}

/// Keeps the documents of a study in a folder of results, before any record or table names them: the study, its bridge, and the
/// water files that its bridges name.
///
/// # Errors
/// [`FolderError`] with the file that could not be written.
pub fn keep_documents(folder: &Path, study: &Study) -> Result<(), FolderError> {
    let mut documents = [&study.document, &study.bridge.document].into_iter();
    documents.try_for_each(|document| keep_document(folder, &document.hash(), document.text()))?;
    let mut waters = study.bridge.waters().into_iter();
    waters.try_for_each(|water| keep_document(folder, &water.blake3, water.document.text()))
}

impl RunDocuments {
    /// The documents of a study that is at hand.
    pub(super) fn of_study(study: &Study) -> Self {
        Self {
            folder: PathBuf::new(),
            name: study.name.clone(),
            study: StoredDocument::of(study.document.clone()),
            bridge: StoredDocument::of(study.bridge.document.clone()),
            waters: Vec::new(),
            trees: OnceLock::new(),
        }
    }

    /// The documents that a manifest names.
    ///
    /// # Errors
    /// [`ResultsError::Damaged`] with the manifest's `file`.
    pub(super) fn of_manifest(folder: &Path, file: &Path, name: &str, manifest: &Value) -> Result<Self, ResultsError> {
        let damaged = |found: String| ResultsError::Damaged {
            file: file.to_owned(),
            found,
        };
        let stored = |which: &str| {
            let hash = manifest[format!("{which}_blake3")].as_str();
            let hash = hash
                .ok_or_else(|| damaged(format!("no hash of its {which}")))?
                .to_owned();
            if manifest["documents"].is_null() {
                let document = Document::from(&manifest[which]);
                if document.hash() != hash {
                    return Err(damaged(format!("a {which} that is not the one of its hash")));
                }
                return Ok(StoredDocument::of(document));
            }
            if manifest["documents"][which]["file"].as_str() != Some(&document_file(&hash)) {
                return Err(damaged(format!(
                    "a file of its {which} that is not the one of its hash"
                )));
            }
            let read = OnceLock::new();
            Ok(StoredDocument { hash, read })
        };
        let mut waters: Vec<(String, StoredDocument)> = Vec::new();
        for water in manifest["bridges"]
            .as_array()
            .into_iter()
            .flatten()
            .map(|of| &of["water"])
        {
            let (Some(file), Some(hash)) = (water["file"].as_str(), water["blake3"].as_str()) else {
                continue;
            };
            if waters.iter().all(|(known, _)| known != file) {
                let (hash, read) = (hash.to_owned(), OnceLock::new());
                waters.push((file.to_owned(), StoredDocument { hash, read }));
            }
        }
        Ok(Self {
            folder: folder.to_owned(),
            name: name.to_owned(),
            waters,
            study: stored("study")?,
            bridge: stored("bridge")?,
            trees: OnceLock::new(),
        })
    }

    /// Hashes of the study and of the bridge.
    pub fn hashes(&self) -> [&str; 2] {
        [&self.study.hash, &self.bridge.hash]
    }

    /// The study.
    ///
    /// # Errors
    /// [`ResultsError::Damaged`].
    pub fn study(&self) -> Result<&Document, ResultsError> {
        self.study.get(&self.folder)
    }

    /// The bridge, before the axes.
    ///
    /// # Errors
    /// [`ResultsError::Damaged`].
    pub fn bridge(&self) -> Result<&Document, ResultsError> {
        self.bridge.get(&self.folder)
    }

    /// The water files, each with the path that bridges name it by.
    ///
    /// # Errors
    /// [`ResultsError::Damaged`].
    pub fn waters(&self) -> Result<Vec<(String, Document)>, ResultsError> {
        let read = |(file, stored): &(String, StoredDocument)| Ok((file.clone(), stored.get(&self.folder)?.clone()));
        self.waters.iter().map(read).collect()
    }

    /// The bridge and the study's vehicle as trees; null where the study names no vehicle.
    ///
    /// # Errors
    /// [`ResultsError::Damaged`].
    pub fn bridge_and_vehicle(&self) -> Result<&[Value; 2], ResultsError> {
        if let Some(trees) = self.trees.get() {
            return Ok(trees);
        }
        let damaged = |found: String| ResultsError::Damaged {
            file: self.folder.join(document_file(&self.study.hash)),
            found,
        };
        let head: StudyHead = serde_json::from_str(self.study()?.text()).map_err(|e| damaged(e.to_string()))?;
        if head.name != self.name {
            let found = format!("the study '{}' where the manifest names '{}'", head.name, self.name);
            return Err(damaged(found));
        }
        let bridge = self.bridge()?.value();
        Ok(self.trees.get_or_init(|| [bridge, head.vehicle]))
    }
}
