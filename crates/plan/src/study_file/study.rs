//! A study opened: its file and its bridge's file read, its own numbers checked.
//!
//! Knows files. Does not know jobs: what holds for a single point is checked where jobs are made.

use super::analysis::AnalysisSpec;
use crate::design::{Block, Design, SHORT_NAMES};
use crate::input::{Refusal, leaves, read, text_and_hash, to_value, typed};
use pontoon_core::bridge::BridgeDesign;
use pontoon_core::response::Record;
use pontoon_core::vehicle::VehicleDesign;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// A study as its file writes it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StudySpec {
    /// Name of the study and of its folder of results: letters, digits, `_`, `-` and `.`, not beginning with `.`.
    #[schemars(regex(pattern = r"^[A-Za-z0-9_-][A-Za-z0-9_.-]*$"))]
    pub name: String,
    /// What the study asks, in a sentence, for whoever reads its report.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub question: Option<String>,
    /// Path of the bridge file, relative to the study file.
    pub bridge: String,
    /// The vehicle; a single footprint of 3.35 m on two tracks where absent.
    #[serde(default)]
    pub vehicle: VehicleDesign,
    /// What is asked and how it is computed.
    pub analysis: AnalysisSpec,
    /// The designs, united in order; equal jobs run once.
    #[schemars(length(min = 1))]
    pub design: Vec<Design>,
    /// What to keep of each job beyond its peaks.
    #[serde(default)]
    pub record: RecordSpec,
}

/// What to keep of each job beyond its peaks.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RecordSpec {
    /// Histories of crossings.
    #[serde(default)]
    pub histories: HistoriesSpec,
    /// Whether to write the table of positions.
    #[serde(default = "yes")]
    pub positions: bool,
    /// Whether to write the table of connectors.
    #[serde(default = "yes")]
    pub connectors: bool,
}

fn yes() -> bool {
    true
}

impl Default for RecordSpec {
    fn default() -> Self {
        Self {
            histories: HistoriesSpec::default(),
            positions: true,
            connectors: true,
        }
    }
}

/// Whose histories to keep.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HistoriesSpec {
    /// Position numbers, 1 to modules + 1: deflection.
    #[serde(default)]
    pub positions: Vec<usize>,
    /// Joint numbers, 2 to modules: force.
    #[serde(default)]
    pub joints: Vec<usize>,
}

impl HistoriesSpec {
    /// Whether any history is asked for.
    pub fn asked(&self) -> bool {
        !(self.positions.is_empty() && self.joints.is_empty())
    }

    /// The same as the mechanics takes it.
    pub fn record(&self) -> Record {
        Record {
            positions: self.positions.clone(),
            joints: self.joints.clone(),
        }
    }
}

/// A bridge file, read and checked.
#[derive(Debug, Clone)]
pub struct BridgeFile {
    /// The file.
    pub file: PathBuf,
    /// Its document.
    pub document: Value,
    /// Its design.
    pub design: BridgeDesign,
}

/// Reads and checks a bridge file.
///
/// # Errors
/// [`Refusal`].
pub fn read_bridge(file: &Path) -> Result<BridgeFile, Refusal> {
    bridge_of(file, read(file)?)
}

fn bridge_of(file: &Path, document: Value) -> Result<BridgeFile, Refusal> {
    let design: BridgeDesign = typed(file, "", &document)?;
    design.check().map_err(|e| Refusal::of(file, "", e))?;
    Ok(BridgeFile {
        file: file.to_owned(),
        document,
        design,
    })
}

/// A study with everything that its jobs are made of.
#[derive(Debug, Clone)]
pub struct Study {
    /// The study file.
    pub file: PathBuf,
    /// Its document.
    pub document: Value,
    /// The document typed.
    pub spec: StudySpec,
    /// Its bridge before axes.
    pub bridge: BridgeFile,
    /// Its designs with their axes read.
    pub blocks: Vec<Block>,
}

impl Study {
    /// Opens a study: `path` is a study file or the folder that holds `study.json`.
    ///
    /// # Errors
    /// [`Refusal`] of what is wrong with the files apart from single points.
    pub fn open(path: &Path) -> Result<Self, Refusal> {
        let file = if path.is_dir() {
            path.join("study.json")
        } else {
            path.to_owned()
        };
        let document = read(&file)?;
        let spec: StudySpec = typed(&file, "", &document)?;
        let bridge_path = file.parent().unwrap_or(Path::new("")).join(&spec.bridge);
        if !bridge_path.is_file() {
            let found = format!("'{}', which is no file", spec.bridge);
            return Err(Refusal::new(
                &file,
                "bridge",
                found,
                "the path of a bridge file, relative to the study file",
            ));
        }
        let bridge = read_bridge(&bridge_path)?;
        Self::checked(file, document, spec, bridge)
    }

    /// The study of documents that were read before; `file` stands for both in messages.
    ///
    /// # Errors
    /// [`Refusal`].
    pub fn of_documents(file: &Path, document: Value, bridge: Value) -> Result<Self, Refusal> {
        let spec: StudySpec = typed(file, "", &document)?;
        let bridge = bridge_of(file, bridge)?;
        Self::checked(file.to_owned(), document, spec, bridge)
    }

    fn checked(file: PathBuf, document: Value, spec: StudySpec, bridge: BridgeFile) -> Result<Self, Refusal> {
        check_name(&file, &spec.name)?;
        let vehicle = filled_vehicle(&spec.vehicle).and_then(|v| v.check(bridge.design.module.breadth_m).map(|_| v));
        let vehicle = vehicle.map_err(|e| Refusal::of(&file, "vehicle", e))?;
        let analysis = spec
            .analysis
            .clone()
            .checked()
            .map_err(|e| Refusal::of(&file, "analysis", e))?;
        check_histories(&file, &spec.record.histories, bridge.design.modules)?;
        let mut known = SHORT_NAMES.map(str::to_owned).to_vec();
        for (root, value) in [
            ("bridge", to_value(&bridge.design)),
            ("vehicle", to_value(&vehicle)),
            ("analysis", to_value(&analysis)),
        ] {
            leaves(root, &value, &mut known);
        }
        let blocks = Block::read(&file, &spec.design, &known)?;
        Ok(Self {
            file,
            document,
            spec,
            bridge,
            blocks,
        })
    }

    /// Number of points of all designs, equal ones counted as often as they occur.
    pub fn points(&self) -> usize {
        self.blocks.iter().map(Block::len).sum()
    }

    /// Seeds of its designs, in the order of the file.
    pub fn seeds(&self) -> Vec<u64> {
        let drawn = self
            .spec
            .design
            .iter()
            .flat_map(|design| [&design.latin_hypercube, &design.sobol]);
        drawn.flatten().map(|sample| sample.seed).collect()
    }

    /// The columns that the study's axes make: their names as written, each once, in the order of the file.
    pub fn path_axes(&self) -> Vec<String> {
        let mut names: Vec<String> = Vec::new();
        for axis in self.blocks.iter().flat_map(|b| &b.axes) {
            if !SHORT_NAMES.contains(&axis.name.as_str()) && !names.contains(&axis.name) {
                names.push(axis.name.clone());
            }
        }
        names
    }

    /// The document without what it asks in words, on which no number depends.
    pub fn computed(&self) -> Value {
        let mut document = self.document.clone();
        if let Some(keys) = document.as_object_mut() {
            keys.shift_remove("question");
        }
        document
    }

    /// The study's document on one line and the blake3 hash of that text.
    pub fn text_and_hash(&self) -> (String, String) {
        text_and_hash(&self.document)
    }

    /// The bridge's document on one line and the blake3 hash of that text.
    pub fn bridge_text_and_hash(&self) -> (String, String) {
        text_and_hash(&self.bridge.document)
    }
}

/// The vehicle with the defaults of the single footprint written out, so that a column can show them.
pub fn filled_vehicle(design: &VehicleDesign) -> Result<VehicleDesign, pontoon_core::input::InvalidInput> {
    let mut filled = design.clone();
    if let (None, Some(axle)) = (&design.axles, design.axles()?.pop()) {
        filled.footprint_length_m = Some(axle.patch_length_m);
        filled.track_y_m = Some(axle.track_y_m);
    }
    Ok(filled)
}

fn check_name(file: &Path, name: &str) -> Result<(), Refusal> {
    let good = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '-' | '.');
    if name.is_empty() || name.starts_with('.') || !name.chars().all(good) {
        return Err(Refusal::new(
            file,
            "name",
            format!("'{name}'"),
            "letters, digits, _, - and ., not beginning with .",
        ));
    }
    Ok(())
}

/// Refuses histories of what the bridge does not have, and the same one twice.
pub(crate) fn check_histories(file: &Path, histories: &HistoriesSpec, modules: usize) -> Result<(), Refusal> {
    for (of, list, from, to) in [
        ("positions", &histories.positions, 1, modules + 1),
        ("joints", &histories.joints, 2, modules),
    ] {
        for (i, &number) in list.iter().enumerate() {
            let key = format!("record.histories.{of}[{i}]");
            if !(from..=to).contains(&number) {
                let allowed = if from > to {
                    "none: the bridge has no joint".to_owned()
                } else {
                    format!("{from} to {to}")
                };
                return Err(Refusal::new(file, key, number, allowed));
            }
            if list[..i].contains(&number) {
                return Err(Refusal::new(file, key, format!("{number} twice"), "each number once"));
            }
        }
    }
    Ok(())
}
