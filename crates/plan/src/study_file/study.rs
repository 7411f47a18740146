//! A study opened: its file and its bridge's file read, its own numbers checked.
//!
//! Knows files. Does not know jobs: what holds for a single point is checked where jobs are made.

use super::analysis::Analysis;
use super::find::Find;
use super::limits::LimitsSpec;
use super::rated::rated;
use super::raw::{AnalysisSpec, Kind, StudySpec};
use super::record::RecordSpec;
use super::vehicle_files::{VehicleFile, at_home, with_vehicle_files};
use super::wear::WearSpec;
use crate::design::{Axis, Block, Design, Goes, JobAxis, NAMED_AXES, Varies};
use crate::input::{Document, FoundValue, Refusal, RefusalKind, canonical_text, leaves, to_value, typed};
use crate::water_file::{BridgeWater, WaterDocument, Waters};
use pontoon_core::bridge::BridgeDesign;
use pontoon_core::traffic::TrafficDesign;
use pontoon_core::vehicle::VehicleDesign;
use serde_json::{Map, Value};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A bridge file, read and checked.
#[derive(Debug, Clone)]
pub struct BridgeFile {
    /// The file.
    pub file: PathBuf,
    /// Its document.
    pub document: Document,
    /// Its design.
    pub design: BridgeDesign,
    /// The water with memory that it names.
    pub water: Option<Arc<BridgeWater>>,
    /// Waters read for it and for what axes make of it.
    pub(crate) waters: Arc<Waters>,
}

/// Reads and checks a bridge file.
///
/// # Errors
/// [`Refusal`].
pub fn read_bridge(file: &Path) -> Result<BridgeFile, Refusal> {
    bridge_of(file, Document::read(file)?)
}

/// Checks the document of a bridge that a program holds; `file` stands for it in messages.
///
/// # Errors
/// [`Refusal`].
pub fn bridge_of(file: &Path, document: Document) -> Result<BridgeFile, Refusal> {
    let mut bridge = stored_bridge_of(file, document)?;
    let waters = Arc::clone(&bridge.waters);
    bridge.water = waters.attach(file, file.parent().unwrap_or(Path::new("")), &mut bridge.design)?;
    if let Some(water) = &bridge.water {
        // what is kept of the bridge says which water it was
        let mut value = bridge.document.value();
        value["water"]["blake3"] = water.blake3.as_str().into();
        bridge.document = Document::of_canonical(canonical_text(&value));
    }
    Ok(bridge)
}

/// Checks the document of a bridge that results were computed with; its water file is not read, see [`Study::in_waters`].
fn stored_bridge_of(file: &Path, document: Document) -> Result<BridgeFile, Refusal> {
    let design: BridgeDesign = typed(file, "", &document)?;
    let checked = design.check().and_then(|()| design.check_water_line());
    checked.map_err(|e| Refusal::of(file, "", e))?;
    Ok(BridgeFile {
        file: file.to_owned(),
        document,
        design,
        water: None,
        waters: Arc::default(),
    })
}

impl BridgeFile {
    /// Another design in the place of this one, in this one's water.
    #[must_use]
    pub fn with(&self, document: Document, mut design: BridgeDesign) -> Self {
        design.water.clone_from(&self.design.water);
        Self {
            document,
            design,
            ..self.clone()
        }
    }

    /// The water files that it, or what axes made of it, names.
    pub fn waters(&self) -> Vec<WaterDocument> {
        self.waters.documents()
    }

    /// The folder that its paths are relative to.
    pub(crate) fn folder(&self) -> &Path {
        self.file.parent().unwrap_or(Path::new(""))
    }
}

/// A study with everything that its jobs are made of.
#[derive(Debug, Clone)]
pub struct Study {
    /// The study file.
    pub file: PathBuf,
    /// Its document.
    pub document: Document,
    /// Its name, and that of its folder of results.
    pub name: String,
    /// What it asks, in a sentence.
    pub question: Option<String>,
    /// Its vehicle before axes, as it is written.
    pub vehicle: VehicleDesign,
    /// Vehicles that the axis `vehicle` names.
    pub vehicles: BTreeMap<String, VehicleDesign>,
    /// Its traffic and road before axes.
    pub traffic: TrafficDesign,
    /// Vehicles that stand in files of their own.
    pub vehicle_files: Vec<VehicleFile>,
    /// Its analysis before axes.
    pub analysis: Analysis,
    /// The analysis as it is written, which is what axes change: a default is one of the kind and solver that they leave.
    pub(crate) analysis_written: AnalysisSpec,
    /// How the gaps of joints scatter before axes, where they do.
    pub wear: Option<WearSpec>,
    /// How far the bridge may go, where limits are stated.
    pub limits: Option<LimitsSpec>,
    /// What a rating searches; none of a study of another kind.
    pub find: Option<Find>,
    /// What to keep of each job beyond its peaks.
    pub record: Arc<RecordSpec>,
    /// Seeds of its designs, in the order of the file.
    pub seeds: Vec<u64>,
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
        Self::opened(path, |_, document| Ok(document))
    }

    /// Opens a study as a table of classes asks it: with all types of crossings where its designs have none, and the speeds of
    /// normal ones; nothing is searched.
    ///
    /// # Errors
    /// [`Refusal`] as [`Self::open`], of no limits, and of a design that is no grid.
    pub fn open_rated(path: &Path) -> Result<Self, Refusal> {
        Self::opened(path, |file, document| rated(file, &document))
    }

    fn opened(path: &Path, amend: impl FnOnce(&Path, Document) -> Result<Document, Refusal>) -> Result<Self, Refusal> {
        let file = if path.is_dir() {
            path.join("study.json")
        } else {
            path.to_owned()
        };
        let (document, vehicle_files) = with_vehicle_files(&file, amend(&file, Document::read(&file)?)?)?;
        let spec: StudySpec = typed(&file, "", &document)?;
        let bridge_path = file.parent().unwrap_or(Path::new("")).join(&spec.bridge);
        if !bridge_path.is_file() {
            let found = FoundValue::value(spec.bridge).which("which is no file");
            return Err(Refusal::new(
                &file,
                "bridge",
                found,
                "the path of a bridge file, relative to the study file",
            ));
        }
        let bridge = read_bridge(&bridge_path)?;
        Self::checked(file, document, spec, bridge, vehicle_files)
    }

    /// The study of documents that were read before; `file` stands for both in messages.
    ///
    /// # Errors
    /// [`Refusal`].
    pub fn of_documents(file: &Path, document: Document, bridge: Document) -> Result<Self, Refusal> {
        let spec: StudySpec = typed(file, "", &document)?;
        let bridge = stored_bridge_of(file, bridge)?;
        Self::checked(file.to_owned(), document, spec, bridge, Vec::new())
    }

    /// Gives a study of stored documents the waters that are stored beside them, each with the path by which bridges name it.
    ///
    /// # Errors
    /// [`Refusal`] of a document that is no water file, and of a water that the bridge may not have.
    pub fn in_waters(mut self, stored: Vec<(String, Document)>) -> Result<Self, Refusal> {
        if stored.is_empty() {
            return Ok(self);
        }
        let (bridge, file) = (&mut self.bridge, &self.file);
        let waters = Arc::clone(&bridge.waters);
        let folder = bridge.folder().to_owned();
        waters.hold_all(&folder, stored)?;
        bridge.water = waters.attach(file, &folder, &mut bridge.design)?;
        Ok(self)
    }

    /// The study of documents that a program holds: `file` stands for the study in messages, and paths of vehicle files in it
    /// are relative to its folder; the bridge is named by its own file.
    ///
    /// # Errors
    /// [`Refusal`].
    pub fn of_values(file: &Path, document: Document, bridge: &BridgeFile) -> Result<Self, Refusal> {
        let (document, vehicle_files) = with_vehicle_files(file, document)?;
        let spec: StudySpec = typed(file, "", &document)?;
        Self::checked(file.to_owned(), document, spec, bridge.clone(), vehicle_files)
    }

    fn checked(
        file: PathBuf,
        document: Document,
        spec: StudySpec,
        bridge: BridgeFile,
        vehicle_files: Vec<VehicleFile>,
    ) -> Result<Self, Refusal> {
        check_name(&file, &spec.name)?;
        let breadth_m = bridge.design.module.breadth_m;
        for (name, design) in &spec.vehicles {
            let checked = design
                .check(breadth_m)
                .map_err(|e| Refusal::of(&file, &format!("vehicles.{name}"), e));
            checked.map_err(|refusal| at_home(&vehicle_files, refusal))?;
        }
        let vehicle = filled_vehicle(&spec.vehicle).and_then(|v| v.check(breadth_m).map(|_| v));
        let vehicle = vehicle.map_err(|e| at_home(&vehicle_files, Refusal::of(&file, "vehicle", e)))?;
        let analysis = Analysis::of(&spec.analysis).map_err(|e| Refusal::of(&file, "analysis", e))?;
        spec.record.check(&file, &bridge.design)?;
        if let Some(wear) = &spec.wear {
            wear.check().map_err(|e| Refusal::of(&file, "wear", e))?;
            if analysis.kind() == Kind::Modes {
                let refused = Refusal::new(
                    &file,
                    "wear",
                    "a wear",
                    "no wear in a study of modes, which has no gaps",
                );
                return Err(refused.because(RefusalKind::Misplaced));
            }
        }
        let traffic = spec.traffic();
        if !analysis.kind().has_crossings() {
            let given = [
                ("traffic", traffic.traffic.is_some()),
                ("column", traffic.column.is_some()),
                ("roughness", traffic.roughness.is_some()),
                ("limits", spec.limits.is_some()),
            ];
            if let Some((key, _)) = given.iter().find(|(_, is)| *is) {
                let refused = Refusal::new(
                    &file,
                    *key,
                    format!("a {key}"),
                    "none but in a study of crossings or ratings",
                );
                return Err(refused.because(RefusalKind::Misplaced));
            }
        }
        if let Some(limits) = &spec.limits {
            limits.of(&bridge.design).map_err(|e| Refusal::of(&file, "limits", e))?;
        }
        let mut known: Vec<String> = NAMED_AXES.iter().map(|axis| axis.name.to_owned()).collect();
        let mut documents = Map::new();
        for (root, value) in [
            ("bridge", to_value(&bridge.design)),
            ("vehicle", to_value(&vehicle)),
            ("analysis", to_value(&analysis.written())),
            ("wear", to_value(&spec.wear)),
        ] {
            documents.insert(root.to_owned(), value);
        }
        if let Value::Object(keys) = to_value(&traffic) {
            documents.extend(keys);
        }
        documents.iter().for_each(|(key, value)| leaves(key, value, &mut known));
        let mut blocks = Block::read(&file, &spec.design, &known)?;
        let varied: Vec<&Axis> = blocks.iter().flat_map(|block| &block.axes).collect();
        let find = match (&spec.find, analysis.kind()) {
            (Some(find), Kind::Rating) => Some(find.read(&file, &known, &Value::Object(documents), &varied)?),
            (None, Kind::Rating) => return Err(Refusal::missing(&file, "find")),
            (Some(_), _) => {
                let refused = Refusal::new(&file, "find", "a search", "none but in a study of kind rating");
                return Err(refused.because(RefusalKind::Misplaced));
            }
            (None, _) => None,
        };
        if let Some(find) = &find {
            if spec.limits.is_none() {
                return Err(Refusal::missing(&file, "limits"));
            }
            blocks
                .iter_mut()
                .for_each(|block| block.searched = Some(find.axis.clone()));
        }
        Ok(Self {
            seeds: spec.design.iter().filter_map(Design::seed).collect(),
            file,
            document,
            name: spec.name,
            question: spec.question,
            vehicle: spec.vehicle,
            vehicles: spec.vehicles,
            traffic,
            vehicle_files,
            analysis_written: spec.analysis,
            analysis,
            wear: spec.wear,
            limits: spec.limits,
            find,
            record: Arc::new(spec.record),
            bridge,
            blocks,
        })
    }

    /// The study with other values of the first axes of its one design, a zip: of each axis a list. Its document stays as it
    /// was read.
    ///
    /// # Errors
    /// [`Refusal`] of another design, and of lists that make no points.
    pub fn with_lists(&self, lists: &[Vec<f64>]) -> Result<Self, Refusal> {
        let [block] = &self.blocks[..] else {
            let found = format!("{} designs", self.blocks.len());
            return Err(Refusal::new(&self.file, "design", found, "one"));
        };
        Ok(Self {
            blocks: vec![block.with_lists(&self.file, lists)?],
            ..self.clone()
        })
    }

    /// Whether an axis sets a number or word of the job.
    fn varies(&self, of: JobAxis) -> bool {
        let mut axes = self.blocks.iter().flat_map(|block| &block.axes);
        axes.any(|axis| axis.varies == Varies::Job(of))
    }

    /// Number of points of all designs, equal ones counted as often as they occur.
    pub fn points(&self) -> usize {
        self.blocks.iter().map(Block::len).sum()
    }

    /// The columns of the study's axes: those with a name of their own that its kind has, then every other axis as written,
    /// each once, in the order of the file.
    pub fn axis_columns(&self) -> Vec<String> {
        let kind = self.analysis.kind();
        let own = NAMED_AXES.iter().filter(|axis| match (axis.goes, kind) {
            (
                Goes::Job {
                    axis: JobAxis::WearSeed,
                    ..
                },
                _,
            ) => self.wear.is_some(),
            (
                Goes::Job {
                    axis: axis @ (JobAxis::Vehicle | JobAxis::CrossingType),
                    ..
                },
                _,
            ) => self.varies(axis),
            (Goes::Job { crossings, .. }, Kind::Crossing | Kind::Rating) => crossings,
            (Goes::Job { statics, .. }, Kind::Static) => statics,
            _ => false,
        });
        // what is searched has a column of its own
        let searched = self.find.as_ref().map(|find| &find.axis);
        let own = own.filter(|axis| searched.is_none_or(|searched| !searched.sets_what(axis.name)));
        let mut names: Vec<String> = own.map(|axis| axis.name.to_owned()).collect();
        for axis in self.blocks.iter().flat_map(|block| &block.axes) {
            if matches!(axis.varies, Varies::Path(..)) && !names.contains(&axis.name) {
                names.push(axis.name.clone());
            }
        }
        names
    }

    /// The document without what it asks in words, on which no number depends.
    pub fn computed(&self) -> Value {
        let mut document = self.document.value();
        if let Some(keys) = document.as_object_mut() {
            keys.shift_remove("question");
        }
        document
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

/// Longest name of a study in bytes: the name of a folder has 255, and files beside it are named after it.
const LONGEST_NAME: usize = 200;

/// Names that are devices on Windows, with any ending and in any case.
const DEVICES: [&str; 6] = ["con", "prn", "aux", "nul", "com", "lpt"];

/// Refuses a name of which some file system makes no folder, or a shell no word.
fn check_name(file: &Path, name: &str) -> Result<(), Refusal> {
    let refuse = |found: FoundValue, allowed: &str| Err(Refusal::new(file, "name", found, allowed));
    if name.len() > LONGEST_NAME {
        let found = format!("a name of {} bytes", name.len());
        return refuse(
            found.into(),
            &format!("at most {LONGEST_NAME}: it is the name of a folder"),
        );
    }
    let good = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '-' | '.');
    if name.is_empty() || name.starts_with(['.', '-']) || name.ends_with('.') || !name.chars().all(good) {
        return refuse(
            FoundValue::value(name),
            "letters, digits, _, - and ., not beginning with . or - and not ending with .",
        );
    }
    if is_device(name) {
        let found = FoundValue::value(name).which("which is a device on Windows");
        return refuse(found, "the name of a folder on every system");
    }
    Ok(())
}

/// Whether Windows takes a name for a device: `CON`, `nul.txt`, `com1`.
fn is_device(name: &str) -> bool {
    let stem = name.split('.').next().unwrap_or_default().to_ascii_lowercase();
    let numbered = stem.strip_suffix(|c: char| ('1'..='9').contains(&c));
    DEVICES[..4].contains(&stem.as_str()) || numbered.is_some_and(|stem| DEVICES[4..].contains(&stem))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_is_one_of_a_folder_on_every_system() {
        let refused = |name: &str| check_name(Path::new("s.json"), name).map_err(|e| e.to_string());
        for name in [
            "a",
            "fu2005",
            "A_b-c.d",
            "0",
            "_x",
            "console",
            "com",
            "com0",
            "lpt12",
            &"x".repeat(200),
        ] {
            assert_eq!(refused(name), Ok(()), "{name}");
        }
        for name in [
            "", ".", "..", ".x", "x.", "-x", "x ", " x", "a/b", "a\\b", "a\nb", "a\u{7f}", "\u{e9}", "a:b", "CON",
            "nul", "Aux.1", "com1", "LPT9.txt", "prn",
        ] {
            let message = refused(name).unwrap_err();
            assert!(message.starts_with("s.json: name: found "), "{message}");
        }
        let message = refused(&"x".repeat(201)).unwrap_err();
        assert!(
            message.contains("found a name of 201 bytes, allowed: at most 200"),
            "{message}"
        );
    }
}
