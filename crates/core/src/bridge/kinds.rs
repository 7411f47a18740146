//! Modules that are not alike: kinds by name, and the row in which they stand.
//!
//! Knows which kind stands at each place of the row, and which ends can be joined. Does not know the rest of a bridge.

use super::buoyancy::{DraftBuoyancy, Todd};
use crate::input::{InvalidInput, Problem, SAME_PLACE_M};
use crate::module::{ModuleDesign, Outline};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A kind of module: its box and the water under it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ModuleKind {
    /// The module.
    pub module: ModuleDesign,
    /// Hydrostatic stiffness p_b: pressure per metre of sinking `[Pa/m]`. Either this or `draft_buoyancy`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hydrostatic_stiffness_pa_m: Option<f64>,
    /// Draft-buoyancy table, whose slope at the still-water draft gives p_b.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub draft_buoyancy: Option<DraftBuoyancy>,
    /// Added mass per metre of bridge `[kg/m]`. Either this or `todd`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub added_mass_kg_m: Option<f64>,
    /// Todd's formula for the added mass.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub todd: Option<Todd>,
    /// Where the wet part of the bottom begins, from its left end `[m]`; absent: 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wet_from_m: Option<f64>,
    /// Where it ends `[m]`; absent: the length. A module whose wet part begins where it ends is dry.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wet_to_m: Option<f64>,
    /// Still-water draft `[m]`, for reporting whether the bottom emerged.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub draft_m: Option<f64>,
    /// Height of the deck above the still water `[m]`, for reporting whether the deck was submerged.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub freeboard_m: Option<f64>,
}

impl ModuleKind {
    /// Whether some of its bottom is dry.
    pub(super) fn is_dry_in_part(&self) -> bool {
        let [from_m, to_m] = wet_m(self.module.length_m, [self.wet_from_m, self.wet_to_m]);
        self.module.length_m - (to_m - from_m) > SAME_PLACE_M
    }
}

/// Modules of one kind side by side.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ModuleRun {
    /// Name of their kind.
    pub kind: String,
    /// How many they are.
    #[serde(default = "one", skip_serializing_if = "is_one")]
    pub count: usize,
    /// Whether their left ends are the kind's right ones.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub mirrored: bool,
}

fn one() -> usize {
    1
}

// serde asks for a reference
#[allow(clippy::trivially_copy_pass_by_ref)]
fn is_one(count: &usize) -> bool {
    *count == 1
}

/// A row of modules of named kinds.
#[derive(Debug, Clone, PartialEq)]
pub struct ModuleRow {
    /// The kinds by name.
    pub kinds: BTreeMap<String, ModuleKind>,
    /// The modules from left to right.
    pub runs: Vec<ModuleRun>,
}

impl ModuleKind {
    /// Its mirror image along x, ends exchanged; none where that is the kind itself.
    fn mirrored(&self) -> Option<Self> {
        let length_m = self.module.length_m;
        let [from_m, to_m] = wet_m(length_m, [self.wet_from_m, self.wet_to_m]);
        let is_own_image = (from_m - (length_m - to_m)).abs() <= SAME_PLACE_M;
        let module = self.module.mirrored();
        if is_own_image && module.is_none() {
            return None;
        }
        let mut mirrored = self.clone();
        if let Some(module) = module {
            mirrored.module = module;
        }
        if !is_own_image {
            mirrored.wet_from_m = Some(length_m - to_m);
            mirrored.wet_to_m = Some(length_m - from_m);
        }
        Some(mirrored)
    }
}

/// Where the wet part of a bottom begins and ends `[m]`; the whole where nothing is given.
pub(super) fn wet_m(length_m: f64, [from_m, to_m]: [Option<f64>; 2]) -> [f64; 2] {
    [from_m.unwrap_or(0.0), to_m.unwrap_or(length_m)]
}

impl ModuleRow {
    /// Number of modules.
    pub(super) fn count(&self) -> usize {
        self.runs.iter().map(|run| run.count).fold(0, usize::saturating_add)
    }

    /// Of each module its run; of a row that was checked.
    fn each(&self) -> impl Iterator<Item = &ModuleRun> {
        self.runs.iter().flat_map(|run| std::iter::repeat_n(run, run.count))
    }

    /// The kind of each module.
    pub(super) fn kinds_in_row(&self) -> impl Iterator<Item = &ModuleKind> {
        self.each().filter_map(|run| self.kinds.get(&run.kind))
    }

    /// The first kind of the row; any other of a row that was not checked.
    pub(super) fn first(&self) -> Option<&ModuleKind> {
        self.kinds_in_row().next().or_else(|| self.kinds.values().next())
    }

    /// Refuses a row that names kinds that do not exist, leaves kinds out or joins ends that do not fit.
    ///
    /// # Errors
    /// [`InvalidInput`] with the key's path.
    pub(super) fn check(&self) -> Result<(), InvalidInput> {
        if self.runs.is_empty() {
            let allowed = "a whole number from 1 to 500, or a list of modules";
            return Err(InvalidInput::new("modules", "an empty list", allowed));
        }
        for (i, run) in self.runs.iter().enumerate() {
            if !self.kinds.contains_key(&run.kind) {
                let known = self.kinds.keys().map(String::as_str).collect::<Vec<_>>().join(", ");
                let key = format!("modules[{i}].kind");
                return Err(InvalidInput::new(
                    key,
                    run.kind.clone(),
                    format!("a kind of module_kinds: {known}"),
                ));
            }
            if !(1..=500).contains(&run.count) {
                let key = format!("modules[{i}].count");
                return Err(InvalidInput::new(key, run.count, "a whole number from 1 to 500"));
            }
        }
        if self.count() > 500 {
            return Err(InvalidInput::new("modules", self.count(), "at most 500 modules"));
        }
        for name in self.kinds.keys() {
            let key = || key_of(name);
            if !is_word(name) {
                let allowed = "a name of letters, digits, - and _ that begins with a letter";
                return Err(InvalidInput::new(key(), name.clone(), allowed));
            }
            if !self.runs.iter().any(|run| run.kind == *name) {
                let allowed = "a kind that modules names";
                return Err(InvalidInput::new(key(), "a kind of no module", allowed).because(Problem::Conflict));
            }
        }
        self.check_ends()
    }

    /// Refuses kinds whose ends cannot be joined: one breadth, and as many elements between two lines across.
    fn check_ends(&self) -> Result<(), InvalidInput> {
        let mut kinds = self.kinds.iter();
        let Some((first, of_first)) = kinds.next() else {
            return Ok(());
        };
        let (breadth_m, elements) = (of_first.module.breadth_m, of_first.module.mesh.elements_between_lines);
        for (name, kind) in kinds {
            let refused = |found: InvalidInput| Err(found.because(Problem::Conflict).under(&key_of(name)));
            let module = &kind.module;
            // a breadth that is no number is refused for what it is
            if (module.breadth_m - breadth_m).abs() > SAME_PLACE_M {
                let allowed =
                    format!("{breadth_m}, the breadth of {first}: ends of modules meet over their whole breadth");
                let found = InvalidInput::new("module.breadth_m", module.breadth_m, allowed);
                return refused(found);
            }
            if module.mesh.elements_between_lines != elements {
                let allowed = format!("{elements}, as of {first}: modules share their lines across");
                let found = module.mesh.elements_between_lines;
                let found = InvalidInput::new("module.mesh.elements_between_lines", found, allowed);
                return refused(found);
            }
        }
        Ok(())
    }

    /// Lines across that a kind needs for the sake of its neighbours `[m]`: those of other kinds where it has none.
    fn lines_of_others(&self, kind: &ModuleKind, joint_lines_y_m: &[f64]) -> Vec<f64> {
        let mut known: Vec<f64> = kind
            .module
            .lines_across_m()
            .chain(joint_lines_y_m.iter().copied())
            .collect();
        let own = known.len();
        for y_m in self.kinds.values().flat_map(|other| other.module.lines_across_m()) {
            if !known.iter().any(|line| (line - y_m).abs() <= SAME_PLACE_M) {
                known.push(y_m);
            }
        }
        known.split_off(own)
    }

    /// What the row is built of, each with the name of its kind, and of each module which it is: what differs stands there once, a
    /// mirrored kind apart from the kind unless it is its own mirror image.
    pub(super) fn built(&self, joint_lines_y_m: &[f64]) -> (Vec<(&str, ModuleKind)>, Vec<usize>) {
        let (mut built, mut of_module): (Vec<(&str, ModuleKind)>, _) = (Vec::new(), Vec::new());
        for run in &self.runs {
            let Some(kind) = self.kinds.get(&run.kind) else {
                continue;
            };
            let mut own = kind.clone();
            own.module.lines_y_m.extend(self.lines_of_others(kind, joint_lines_y_m));
            if let Some(mirrored) = own.mirrored().filter(|_| run.mirrored) {
                own = mirrored;
            }
            let known = built.iter().position(|(_, kind)| *kind == own);
            let number = known.unwrap_or(built.len());
            if known.is_none() {
                built.push((run.kind.as_str(), own));
            }
            of_module.extend(std::iter::repeat_n(number, run.count));
        }
        (built, of_module)
    }

    /// The outline of each module as it stands there.
    pub(super) fn outlines(&self) -> impl Iterator<Item = Outline> {
        self.each().filter_map(|run| {
            let outline = self.kinds.get(&run.kind)?.module.outline();
            Some(if run.mirrored { outline.mirrored() } else { outline })
        })
    }
}

/// The key of a kind.
pub(super) fn key_of(name: &str) -> String {
    format!("module_kinds.{name}")
}

/// Whether a name can stand in a path.
fn is_word(name: &str) -> bool {
    let of_word = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    name.starts_with(|c: char| c.is_ascii_alphabetic()) && name.chars().all(of_word)
}
