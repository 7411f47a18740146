//! A reference opened: its file read, its checks made sure to be checks.
//!
//! Knows files, and the study that a reference belongs to. Does not know results: what they do not have is found when
//! they are compared.

use super::measured::MeasuredSpec;
use crate::checks::{Check, CheckSpec};
use pontoon_plan::input::{Document, FoundValue, Refusal, RefusalKind, to_value, typed};
use pontoon_plan::study_file::Study;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// A reference as its file writes it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ReferenceSpec {
    /// Name of the reference.
    pub name: String,
    /// Where its numbers come from.
    pub source: String,
    /// Path of the study whose results it holds, relative to this file; results of another study are refused. Any results
    /// where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub study: Option<String>,
    /// The checks, each with an id of its own.
    #[schemars(length(min = 1))]
    pub checks: Vec<CheckSpec>,
    /// Points that were measured, each group with an id of its own: drawn as marks, never judged.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub measured: Vec<MeasuredSpec>,
}

/// A reference file, read and checked.
#[derive(Debug, Clone, PartialEq)]
pub struct Reference {
    /// The file.
    pub file: PathBuf,
    /// Its name.
    pub name: String,
    /// Where its numbers come from.
    pub source: String,
    /// Its checks.
    pub checks: Vec<Check>,
    /// Points that were measured.
    pub measured: Vec<MeasuredSpec>,
    /// What results are judged by, as a document: the reference without the measured points, which no verdict and no fit
    /// depends on.
    pub judged: Value,
    /// Path of the study that it belongs to, relative to the file.
    study: Option<String>,
}

impl Reference {
    /// Opens a reference: `path` is a reference file or the folder that holds `reference.json`.
    ///
    /// # Errors
    /// [`Refusal`].
    pub fn open(path: &Path) -> Result<Self, Refusal> {
        let file = if path.is_dir() {
            path.join("reference.json")
        } else {
            path.to_owned()
        };
        let spec: ReferenceSpec = typed(&file, "", &Document::read(&file)?)?;
        Self::checked(file, spec)
    }

    /// The path of the study it belongs to.
    pub fn study(&self) -> Option<PathBuf> {
        let folder = self.file.parent().unwrap_or(Path::new(""));
        self.study.as_ref().map(|study| folder.join(study))
    }

    /// The study it belongs to, which has to be the one of a name; none where it holds any results. `place` is where that
    /// name stands.
    ///
    /// # Errors
    /// [`Refusal`] where the study is another, or cannot be opened.
    pub fn study_of(&self, name: &str, place: &Path) -> Result<Option<Study>, Refusal> {
        let Some(path) = self.study() else {
            return Ok(None);
        };
        let study = Study::open(&path)?;
        if study.name == name {
            return Ok(Some(study));
        }
        let allowed = format!("results of '{}', to which {} belongs", study.name, self.file.display());
        Err(Refusal::new(
            place,
            "",
            format!("results of the study '{name}'"),
            allowed,
        ))
    }

    fn checked(file: PathBuf, mut spec: ReferenceSpec) -> Result<Self, Refusal> {
        if spec.checks.is_empty() {
            return Err(Refusal::new(&file, "checks", "an empty list", "at least one check"));
        }
        let ids: Vec<&str> = spec.checks.iter().map(|check| check.id.as_str()).collect();
        let mut checks = Vec::new();
        for (i, check) in spec.checks.iter().enumerate() {
            let key = format!("checks[{i}]");
            check_id(&file, &key, &ids, i, "a name unlike any other check's")?;
            checks.push(Check::of(&file, &key, check)?);
        }
        let ids: Vec<&str> = spec.measured.iter().map(|group| group.id.as_str()).collect();
        for (i, group) in spec.measured.iter().enumerate() {
            let key = format!("measured[{i}]");
            check_id(&file, &key, &ids, i, "a name unlike any other's")?;
            group.check(&file, &key)?;
        }
        let measured = std::mem::take(&mut spec.measured);
        Ok(Self {
            file,
            checks,
            measured,
            judged: to_value(&spec),
            name: spec.name,
            source: spec.source,
            study: spec.study,
        })
    }
}

/// Refuses the id in a place of a list where it is empty or was there before.
fn check_id(file: &Path, key: &str, ids: &[&str], place: usize, allowed: &str) -> Result<(), Refusal> {
    let (id, path) = (ids[place], format!("{key}.id"));
    if id.trim().is_empty() {
        return Err(Refusal::new(file, path, "an empty id", allowed));
    }
    if ids[..place].contains(&id) {
        let refused = Refusal::new(file, path, FoundValue::value(id), "each id once");
        return Err(refused.because(RefusalKind::Repeated));
    }
    Ok(())
}
