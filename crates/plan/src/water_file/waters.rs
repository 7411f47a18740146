//! Water files that bridges name: read, held against the bridge and what it accepts, and shared.
//!
//! Knows where a water file is and what of it may be refused. Does not know what moves in the water.

use super::{JudgedWater, WaterFile};
use crate::input::{Document, FoundValue, Refusal, RefusalKind, nearest};
use pontoon_core::bridge::{BridgeDesign, WaterSpec};
use pontoon_core::radiation::Radiation;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Waters that are kept at most: those of the bridges of an axis.
const KEPT: usize = 8;

/// A water file as a bridge has it.
#[derive(Debug, Clone)]
pub struct BridgeWater {
    /// Name of the water.
    pub name: String,
    /// Depth of the water `[m]`; none where it is deep.
    pub depth_m: Option<f64>,
    /// The blake3 hash of the file.
    pub blake3: String,
    /// What its checks found.
    pub judged: JudgedWater,
    /// What the bridge moves in.
    pub radiation: Arc<Radiation>,
}

/// Waters read so far.
#[derive(Debug, Default)]
pub struct Waters(Mutex<Known>);

/// What is kept of them: a file is read once, and what it comes to is made once for lengths that scale its freedoms.
#[derive(Debug, Default)]
struct Known {
    files: Vec<ReadWater>,
    waters: Vec<(WaterKey, Arc<BridgeWater>)>,
}

/// A water file that was read.
#[derive(Debug, Clone)]
struct ReadWater {
    path: PathBuf,
    kept: WaterDocument,
    water: Arc<WaterFile>,
}

/// The document of a water file, to be kept with results.
#[derive(Debug, Clone)]
pub struct WaterDocument {
    /// The path by which bridges name the file.
    pub file: String,
    /// Its hash.
    pub blake3: String,
    /// Its text.
    pub document: Document,
}

/// What a water is made of: its file and the lengths that scale its freedoms.
type WaterKey = (PathBuf, Vec<u64>);

impl Waters {
    /// Reads the water file that a bridge names and leaves its hash and the water in the design; `folder` is what the path is relative
    /// to, `file` stands for the bridge in messages. None of a bridge that names no water.
    ///
    /// # Errors
    /// [`Refusal`] of a file that is none, of one with another hash than the bridge asks for, of a water of other modules, of a check
    /// that refuses the water and is not accepted, and of an accepted name that is no check.
    pub fn attach(
        &self,
        file: &Path,
        folder: &Path,
        design: &mut BridgeDesign,
    ) -> Result<Option<Arc<BridgeWater>>, Refusal> {
        let Some(spec) = design.water.clone() else {
            return Ok(None);
        };
        check_names(file, &spec)?;
        let path = folder.join(&spec.file);
        let read = match self.known_file(&path) {
            Some(known) => known,
            None if path.is_file() => self.hold(folder, &spec.file, Document::read(&path)?)?,
            None => {
                let found = FoundValue::value(spec.file.as_str()).which("which is no file");
                let allowed = "the path of a water file, relative to the bridge file";
                return Err(Refusal::new(file, "water.file", found, allowed));
            }
        };
        let blake3 = read.kept.blake3.clone();
        if let Some(asked) = spec.blake3.as_ref().filter(|asked| **asked != blake3) {
            let allowed = format!("{blake3}, the hash of {}", spec.file);
            let found = FoundValue::value(asked.as_str());
            return Err(Refusal::new(file, "water.blake3", found, allowed));
        }
        let water = self.water(&read, design)?;
        check_accepted(file, &spec, &water.judged)?;
        design.water = Some(WaterSpec {
            blake3: Some(blake3),
            radiation: Some(Arc::clone(&water.radiation)),
            ..spec
        });
        Ok(Some(water))
    }

    /// The water files that were read.
    pub fn documents(&self) -> Vec<WaterDocument> {
        self.known().files.iter().map(|read| read.kept.clone()).collect()
    }

    /// Takes the document of a water file that bridges in `folder` name by a path.
    fn hold(&self, folder: &Path, file: &str, document: Document) -> Result<ReadWater, Refusal> {
        let path = folder.join(file);
        let read = ReadWater {
            water: Arc::new(WaterFile::of(&path, &document)?),
            kept: WaterDocument {
                file: file.to_owned(),
                blake3: document.hash(),
                document,
            },
            path,
        };
        self.known().files.push(read.clone());
        Ok(read)
    }

    /// Takes the documents of water files that bridges in `folder` name by these paths.
    ///
    /// # Errors
    /// [`Refusal`] of a document that is no water file.
    pub fn hold_all(
        &self,
        folder: &Path,
        documents: impl IntoIterator<Item = (String, Document)>,
    ) -> Result<(), Refusal> {
        let mut documents = documents.into_iter();
        documents.try_for_each(|(file, document)| self.hold(folder, &file, document).map(|_| ()))
    }

    fn known_file(&self, path: &Path) -> Option<ReadWater> {
        self.known().files.iter().find(|read| read.path == path).cloned()
    }

    /// The water under a bridge. Memory and states hang on lengths alone; the water plane is that of each bridge.
    fn water(&self, read: &ReadWater, design: &BridgeDesign) -> Result<Arc<BridgeWater>, Refusal> {
        let (path, blake3) = (&read.path, &read.kept.blake3);
        let read = &read.water;
        let lengths = design.positions_m().into_iter().chain([design.module.breadth_m]);
        let key = (path.clone(), lengths.map(f64::to_bits).collect());
        let known = self
            .known()
            .waters
            .iter()
            .find(|(of, _)| *of == key)
            .map(|(_, known)| Arc::clone(known));
        if let Some(known) = known {
            let judged = known.judged.beside(read, design);
            return Ok(Arc::new(BridgeWater {
                judged,
                ..(*known).clone()
            }));
        }
        let (judged, radiation) = JudgedWater::with_radiation(path, read, design, blake3)?;
        let water = Arc::new(BridgeWater {
            name: read.name.clone(),
            depth_m: read.depth_m,
            blake3: blake3.clone(),
            judged,
            radiation: Arc::new(radiation),
        });
        let mut known = self.known();
        if known.waters.len() == KEPT {
            known.waters.remove(0);
        }
        known.waters.push((key, Arc::clone(&water)));
        drop(known);
        Ok(water)
    }

    fn known(&self) -> MutexGuard<'_, Known> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Refuses accepted names that are no checks.
fn check_names(file: &Path, spec: &WaterSpec) -> Result<(), Refusal> {
    let known: Vec<String> = JudgedWater::names().into_iter().map(str::to_owned).collect();
    match spec.accept.iter().position(|name| !known.contains(name)) {
        None => Ok(()),
        Some(i) => {
            let near = nearest(&spec.accept[i], &known);
            let found = FoundValue::value(spec.accept[i].as_str());
            let found = match near {
                Some(near) => found.which(format!("which is near {near}")),
                None => found,
            };
            let refused = Refusal::new(file, format!("water.accept[{i}]"), found, known.join(", "));
            Err(refused.because(RefusalKind::UnknownWord))
        }
    }
}

/// Refuses a water by the first check that refuses it and is not accepted.
fn check_accepted(file: &Path, spec: &WaterSpec, judged: &JudgedWater) -> Result<(), Refusal> {
    let not_accepted = |check: &&super::JudgedCheck| !spec.accept.iter().any(|name| name == check.check);
    match judged.refused().find(not_accepted) {
        None => Ok(()),
        Some(check) => {
            let figure = check
                .figure
                .map_or("no figure".to_owned(), |figure| format!("{figure:.3}"));
            let found =
                FoundValue::value(spec.file.as_str()).which(format!("which {} refuses with {figure}", check.check));
            let allowed = format!(
                "a water with {} {}, or that check among water.accept",
                check.check,
                check.allowed.as_deref().unwrap_or("that can be told")
            );
            Err(Refusal::new(file, "water.file", found, allowed).because(RefusalKind::NotAllowed))
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::study_file::read_bridge;
    use std::path::Path;
    use std::sync::Arc;

    /// Bridges of the same lengths share memory and states, which are dear; each has its own water plane.
    #[test]
    fn bridges_of_the_same_lengths_share_a_water() {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies/bridges/fu2005_waves.json");
        let bridge = read_bridge(&file).unwrap();
        let attached = |stiffness: f64| {
            let mut design = bridge.design.clone();
            design.hydrostatic_stiffness_pa_m = design.hydrostatic_stiffness_pa_m.map(|p_b| stiffness * p_b);
            let water = bridge
                .waters
                .attach(&file, bridge.folder(), &mut design)
                .unwrap()
                .unwrap();
            let plane = water.judged.checks.iter().find(|check| check.check == "water_plane");
            let plane = plane.unwrap().figure.unwrap();
            (water, plane)
        };
        let ((own, own_plane), (other, other_plane)) = (attached(1.0), attached(1.2));
        assert!(Arc::ptr_eq(&own.radiation, &other.radiation));
        assert_eq!(own.judged.checks.len(), other.judged.checks.len());
        assert!(own_plane < 0.05 && other_plane > 0.1, "{own_plane} {other_plane}");
    }
}
