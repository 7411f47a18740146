//! Water files that bridges name: read, held against the bridge and what it accepts, and shared.
//!
//! Knows where a water file is and what of it may be refused. Does not know what moves in the water.

use super::{JudgedWater, WaterFile};
use crate::input::{Document, FoundValue, Refusal, RefusalKind, nearest};
use pontoon_core::bridge::{BridgeDesign, WaterSpec};
use pontoon_core::radiation::Radiation;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// Waters that are kept at most: those of an axis.
const KEPT: usize = 8;

/// A water file as a bridge has it.
#[derive(Debug)]
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
pub struct Waters(Mutex<Vec<(WaterKey, Arc<BridgeWater>)>>);

/// What a water is made of: its file, the hash of what stands in it, and the lengths that scale its freedoms.
type WaterKey = (PathBuf, String, Vec<u64>);

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
        let water = self.water(file, folder, design, &spec)?;
        check_accepted(file, &spec, &water.judged)?;
        design.water = Some(WaterSpec {
            blake3: Some(water.blake3.clone()),
            radiation: Some(Arc::clone(&water.radiation)),
            ..spec
        });
        Ok(Some(water))
    }

    fn water(
        &self,
        file: &Path,
        folder: &Path,
        design: &BridgeDesign,
        spec: &WaterSpec,
    ) -> Result<Arc<BridgeWater>, Refusal> {
        let path = folder.join(&spec.file);
        if !path.is_file() {
            let found = FoundValue::value(spec.file.as_str()).which("which is no file");
            let allowed = "the path of a water file, relative to the bridge file";
            return Err(Refusal::new(file, "water.file", found, allowed));
        }
        let document = Document::read(&path)?;
        let blake3 = document.hash();
        if let Some(asked) = spec.blake3.as_ref().filter(|asked| **asked != blake3) {
            let allowed = format!("{blake3}, the hash of {}", spec.file);
            return Err(Refusal::new(
                file,
                "water.blake3",
                FoundValue::value(asked.as_str()),
                allowed,
            ));
        }
        let ends_m = design.positions_m();
        let lengths = ends_m.into_iter().chain([design.module.breadth_m, design.p_b()]);
        let key = (path, blake3, lengths.map(f64::to_bits).collect());
        let lock = || self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, known)) = lock().iter().find(|(of, _)| *of == key) {
            return Ok(Arc::clone(known));
        }
        let water = WaterFile::of(&key.0, &document)?;
        let (judged, radiation) = JudgedWater::with_radiation(&key.0, &water, design, &key.1)?;
        let read = Arc::new(BridgeWater {
            name: water.name,
            depth_m: water.depth_m,
            blake3: key.1.clone(),
            judged,
            radiation: Arc::new(radiation),
        });
        let mut kept = lock();
        if kept.len() == KEPT {
            kept.remove(0);
        }
        kept.push((key, Arc::clone(&read)));
        Ok(read)
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
