//! Vehicle files that a study names: read, and put where their paths stand.
//!
//! Knows where a study may name a vehicle and what becomes of a refusal of one from a file. Does not know what a vehicle is.

use crate::input::{Document, FoundValue, Refusal, typed};
use pontoon_core::vehicle::VehicleDesign;
use serde_json::{Map, Value};
use std::path::{Path, PathBuf};

/// The key of the vehicles that an axis names.
const NAMED: &str = "vehicles";
/// The key by which a vehicle is named, and its axis.
const VEHICLE: &str = "vehicle";

/// A vehicle of a study that stands in a file of its own.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct VehicleFile {
    /// Where in the study's document it was put.
    pub path: String,
    /// Its file.
    pub file: PathBuf,
}

/// Reads a vehicle file.
///
/// # Errors
/// [`Refusal`] of the file.
pub fn read_vehicle(file: &Path) -> Result<(Document, VehicleDesign), Refusal> {
    let document = Document::read(file)?;
    let design = typed(file, "", &document)?;
    Ok((document, design))
}

/// A study's document with the vehicles of all files that it names in their place, and where these are.
///
/// # Errors
/// [`Refusal`] of a path that is no file, at its key, or of what is wrong in a vehicle file.
pub(super) fn with_vehicle_files(file: &Path, document: Document) -> Result<(Document, Vec<VehicleFile>), Refusal> {
    // a study of a million cases is not made a tree for nothing
    let text = document.text();
    let may_name = ["\"vehicle\":\"", "\"vehicle\":[", "\"vehicle\":{\"values\""];
    if !may_name.iter().any(|part| text.contains(part)) {
        return Ok((document, Vec::new()));
    }
    let Value::Object(mut keys) = document.value() else {
        return Ok((document, Vec::new()));
    };
    let mut reader = Reader {
        study: file,
        named: keys.get(NAMED).and_then(Value::as_object).cloned().unwrap_or_default(),
        files: Vec::new(),
    };
    reader.put(&mut keys, VEHICLE)?;
    if let Some(Value::Object(column)) = keys.get_mut("column") {
        reader.put(column, &format!("column.{VEHICLE}"))?;
    }
    for (number, entry) in keys
        .get_mut("traffic")
        .and_then(Value::as_array_mut)
        .into_iter()
        .flatten()
        .enumerate()
    {
        if let Value::Object(entry) = entry {
            reader.put(entry, &format!("traffic[{number}].{VEHICLE}"))?;
        }
    }
    let mut words = Vec::new();
    if let Some(design) = keys.get("design") {
        axis_words("design", design, &mut words);
    }
    for (path, word) in words {
        reader.name(&path, &word)?;
    }
    let Reader { named, files, .. } = reader;
    if !named.is_empty() {
        keys.insert(NAMED.to_owned(), Value::Object(named));
    }
    Ok((Document::from(&Value::Object(keys)), files))
}

/// The words of axes named `vehicle`, with their paths.
fn axis_words(path: &str, value: &Value, words: &mut Vec<(String, String)>) {
    match value {
        Value::Object(map) => {
            for (key, value) in map {
                let path = format!("{path}.{key}");
                if key == VEHICLE {
                    words_of(&path, value, words);
                } else {
                    axis_words(&path, value, words);
                }
            }
        }
        Value::Array(list) => {
            for (number, value) in list.iter().enumerate() {
                axis_words(&format!("{path}[{number}]"), value, words);
            }
        }
        _ => {}
    }
}

/// All words of an axis, however it lists them.
fn words_of(path: &str, value: &Value, words: &mut Vec<(String, String)>) {
    match value {
        Value::String(word) => words.push((path.to_owned(), word.clone())),
        Value::Array(list) => {
            for (number, value) in list.iter().enumerate() {
                words_of(&format!("{path}[{number}]"), value, words);
            }
        }
        Value::Object(map) => map
            .iter()
            .for_each(|(key, value)| words_of(&format!("{path}.{key}"), value, words)),
        _ => {}
    }
}

struct Reader<'a> {
    study: &'a Path,
    named: Map<String, Value>,
    files: Vec<VehicleFile>,
}

impl Reader<'_> {
    /// Puts the vehicle of a file in the place of its path.
    fn put(&mut self, of: &mut Map<String, Value>, path: &str) -> Result<(), Refusal> {
        let Some(Value::String(word)) = of.get(VEHICLE) else {
            return Ok(());
        };
        let vehicle = match self.named.get(word) {
            Some(named) => named.clone(),
            None => self.read(path, &word.clone(), path)?,
        };
        of.insert(VEHICLE.to_owned(), vehicle);
        Ok(())
    }

    /// Reads the vehicle that an axis names, where the study does not have it.
    fn name(&mut self, path: &str, word: &str) -> Result<(), Refusal> {
        if !self.named.contains_key(word) {
            let vehicle = self.read(path, word, &format!("{NAMED}.{word}"))?;
            self.named.insert(word.to_owned(), vehicle);
        }
        Ok(())
    }

    /// The vehicle of a file named at `path`, which is put at `place`.
    fn read(&mut self, path: &str, word: &str, place: &str) -> Result<Value, Refusal> {
        let file = self.study.parent().unwrap_or(Path::new("")).join(word);
        if !file.is_file() {
            let found = FoundValue::value(word).which("which is no file");
            let allowed =
                "the path of a vehicle file, relative to the study file, or a name among the study's vehicles";
            return Err(Refusal::new(self.study, path, found, allowed));
        }
        let (document, _) = read_vehicle(&file)?;
        self.files.push(VehicleFile {
            path: place.to_owned(),
            file,
        });
        Ok(document.value())
    }
}

/// A refusal of a vehicle from a file, at its place in that file.
pub(crate) fn at_home(files: &[VehicleFile], refusal: Refusal) -> Refusal {
    let beyond = |of: &&VehicleFile| {
        let rest = refusal.path.strip_prefix(of.path.as_str());
        rest.is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
    };
    let Some(of) = files.iter().find(beyond) else {
        return refusal;
    };
    let path = refusal.path[of.path.len()..].trim_start_matches('.').to_owned();
    Refusal {
        path,
        file: of.file.clone(),
        ..refusal
    }
}
