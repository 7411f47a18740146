//! A bridge as its file writes it: modules, water, hinges, connectors, supports, condensation.
//!
//! Knows which numbers describe a bridge and refuses those that cannot. Does not know files or studies.

mod condensation;
mod heights;
mod image;
mod wet;
mod written;

use super::ballast::DeadSpec;
use super::banks::{BankRoom, BankSpec, bank_law, check_banks};
use super::buoyancy::{DraftBuoyancy, Todd};
use super::joints::{Connectors, Hinges, JointGaps, Joints, places};
use super::kinds::{ModuleKind, ModuleRow, key_of, wet_m};
use super::supports::{Direction, Supports};
use super::water_spec::WaterSpec;
use super::{Model, Provenance};
use crate::connector::{Connection, OwnLaws};
use crate::input::{InvalidInput, Problem, SAME_PLACE_M, positive, within};
use crate::module::{MeshSize, ModuleDesign, ModuleMesh, Outline, lines_across, mesh_module, mesh_size};
use crate::water::WaterDistribution;
pub use condensation::Condensation;
pub(crate) use image::is_own_image;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::borrow::Cow;
use wet::{OF_DRY, check_dry_held, check_modules_in_waves, check_own_water_line, check_water};
use written::WrittenBridge;

/// A bridge of modules side by side, as one of the two forms of its file has it: equal modules, or a row of kinds.
#[derive(Debug, Clone, PartialEq)]
pub struct BridgeDesign {
    /// Name of the bridge.
    pub name: String,
    /// Where the numbers come from.
    pub source: Option<String>,
    /// How its numbers were identified, where a fit left them; nothing is computed from it.
    pub provenance: Option<Provenance>,
    /// Number of modules.
    pub modules: usize,
    /// The module; of a row of kinds this and the water below are those of the first module.
    pub module: ModuleDesign,
    /// Hydrostatic stiffness p_b: pressure per metre of sinking `[Pa/m]`. Either this or `draft_buoyancy`.
    pub hydrostatic_stiffness_pa_m: Option<f64>,
    /// Draft-buoyancy table, whose slope at the still-water draft gives p_b.
    pub draft_buoyancy: Option<DraftBuoyancy>,
    /// Added mass per metre of bridge `[kg/m]`. Either this or `todd`.
    pub added_mass_kg_m: Option<f64>,
    /// Todd's formula for the added mass.
    pub todd: Option<Todd>,
    /// Where the wet part of the bottom begins, from the module's left end `[m]`; absent: 0.
    pub wet_from_m: Option<f64>,
    /// Where it ends `[m]`; absent: the length.
    pub wet_to_m: Option<f64>,
    /// How both waters are shared among the nodes of the wetted bottom.
    pub water_distribution: WaterDistribution,
    /// Water with memory, in place of the added mass.
    pub water: Option<WaterSpec>,
    /// Hinges at the bottom of every joint.
    pub hinges: Hinges,
    /// Connectors at the deck of every joint.
    pub connectors: Connectors,
    /// What single joints have of their own.
    pub joints: Joints,
    /// Supports of the two ends.
    pub supports: Supports,
    /// Springs between the bridge and the ground.
    pub banks: Vec<BankSpec>,
    /// What lies on the bridge at rest.
    pub dead: DeadSpec,
    /// How much the river has risen since the bridge was laid on its supports and banks `[m]`, see [`BridgeDesign::risen_m`].
    pub water_level_m: Option<f64>,
    /// Still-water draft `[m]`, for reporting whether the bottom emerged.
    pub draft_m: Option<f64>,
    /// Height of the deck above the still water `[m]`, for reporting whether the deck was submerged.
    pub freeboard_m: Option<f64>,
    /// How a module is condensed to a super-element.
    pub condensation: Condensation,
    /// The kinds in their row, where modules are not alike.
    pub row: Option<ModuleRow>,
    /// What its file says beside the form that it has chosen; [`BridgeDesign::check`] refuses it.
    fault: Option<Box<InvalidInput>>,
}

/// The modules of a row as they are built: what differs stands here once, a mirrored kind apart from the kind unless it is its
/// own mirror image.
#[derive(Debug, Clone, PartialEq)]
pub struct Variants {
    /// The design of a bridge of each variant alone: what [`PreparedModule::new`](super::PreparedModule::new) takes.
    pub designs: Vec<BridgeDesign>,
    /// Of each module of the row which variant it is.
    pub of_module: Vec<usize>,
    /// What the keys of each variant's kind begin with, see [`BridgeDesign::named_kinds`].
    pub keys: Vec<String>,
}

impl<'de> Deserialize<'de> for BridgeDesign {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let written = WrittenBridge::deserialize(deserializer)?;
        written.design().map_err(D::Error::missing_field)
    }
}

impl Serialize for BridgeDesign {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        WrittenBridge::of(self).serialize(serializer)
    }
}

impl JsonSchema for BridgeDesign {
    fn schema_name() -> Cow<'static, str> {
        "BridgeDesign".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        WrittenBridge::json_schema(generator)
    }
}

/// Most that a river may rise or fall `[m]`: the water is linear.
const MOST_LEVEL_M: f64 = 100.0;

/// Most memory that the dense matrices of one bridge may take `[GiB]`.
const MOST_GIB: f64 = 4.0;

impl BridgeDesign {
    /// Refuses numbers that describe no bridge.
    ///
    /// # Errors
    /// [`InvalidInput`] with the key's path.
    pub fn check(&self) -> Result<(), InvalidInput> {
        if let Some(fault) = &self.fault {
            return Err((**fault).clone());
        }
        match &self.row {
            Some(row) => row.check()?,
            None if (1..=500).contains(&self.modules) => {}
            None => {
                return Err(InvalidInput::new(
                    "modules",
                    self.modules,
                    "a whole number from 1 to 500",
                ));
            }
        }
        check_modules_in_waves(self)?;
        for (key, kind) in self.named_kinds() {
            kind.check_kind().map_err(|e| e.within_kind(&key))?;
        }
        let half = 0.5 * self.module.breadth_m;
        places("hinges.y_m", &self.hinges.y_m, half)?;
        self.connectors.check(half).map_err(|e| e.under("connectors"))?;
        self.joints.check(self.modules, half, &self.connectors)?;
        heights::check_unlike_depths(self)?;
        check_banks(
            &self.banks,
            &BankRoom {
                modules: self.modules,
                supports: &self.supports,
                hinges_y_m: self.hinge_lines_y_m(),
                connectors_y_m: &self.connectors.y_m,
                half_breadth_m: half,
            },
        )?;
        let lengths_m: Vec<f64> = self.boxes().iter().map(|module| module.length_m).collect();
        self.dead.check(&lengths_m, half)?;
        within("water_level_m", self.risen_m(), -MOST_LEVEL_M, MOST_LEVEL_M)?;
        if self.condensation.fixed_master_modes > 400 {
            return Err(InvalidInput::new(
                "condensation.fixed_master_modes",
                self.condensation.fixed_master_modes,
                "a whole number from 0 to 400",
            ));
        }
        Ok(())
    }

    /// Refuses numbers that describe no module of the only kind.
    fn check_kind(&self) -> Result<(), InvalidInput> {
        self.module.check().map_err(|e| e.under("module"))?;
        check_water(self)?;
        let [bottom_m, deck_m] = {
            let outline = self.module.outline();
            [outline.bottom_m, outline.deck_m]
        };
        for (key, value, heights_m) in [
            ("draft_m", self.draft_m, bottom_m),
            ("freeboard_m", self.freeboard_m, deck_m),
        ] {
            let Some(value) = value else { continue };
            positive(key, value)?;
            if heights_m[0] != heights_m[1] {
                let allowed =
                    "nothing of a module whose deck or bottom slopes there: it has no one height above the water";
                return Err(InvalidInput::new(key, value, allowed).because(Problem::Misplaced));
            }
        }
        if let Some(draft) = self.draft_m.filter(|_| self.is_dry()) {
            return Err(InvalidInput::new("draft_m", draft, OF_DRY).because(Problem::Misplaced));
        }
        Ok(())
    }

    /// The design without its words, from which nothing is computed: name, source, provenance.
    #[must_use]
    pub fn without_words(&self) -> Self {
        Self {
            name: String::new(),
            source: None,
            provenance: None,
            ..self.clone()
        }
    }

    /// Refuses a draft and a freeboard that contradict the depth of the module, each other, its mass or its table of
    /// buoyancies, of each kind.
    ///
    /// # Errors
    /// [`InvalidInput`] with the key's path.
    pub fn check_water_line(&self) -> Result<(), InvalidInput> {
        let mut kinds = self.named_kinds().into_iter();
        kinds.try_for_each(|(key, kind)| check_own_water_line(&kind).map_err(|e| e.within_kind(&key)))
    }

    /// Refuses a bridge that supports, banks and hinges leave free to move horizontally, against which water does nothing, or whose
    /// dry modules are free to fall: it has no static case and no dead state.
    ///
    /// # Errors
    /// [`InvalidInput`] with the key's path.
    pub fn check_held(&self) -> Result<(), InvalidInput> {
        let single = (2..=self.modules).any(|joint| self.hinges_of(joint).y_m.len() == 1) || self.hinges.y_m.len() == 1;
        if single && self.modules > 1 {
            let allowed = "at least two places in a static case: modules turn about a single hinge";
            return Err(InvalidInput::new("hinges.y_m", "one place", allowed).because(Problem::Conflict));
        }
        let Supports { left, right } = &self.supports;
        for (direction, word) in [(Direction::X, "x"), (Direction::Y, "y")] {
            let on_spring = self.banks.iter().any(|bank| bank.direction == direction);
            if !(left.contains(&direction) || right.contains(&direction) || on_spring) {
                let found = format!("no end that holds {word}");
                let allowed = "x and y held at an end or by a bank, in a static case and under a dead load";
                return Err(InvalidInput::new("supports", found, allowed).because(Problem::Missing));
            }
        }
        if single && !(left.contains(&Direction::Y) && right.contains(&Direction::Y)) {
            let allowed = "y held at both ends in a static case of one module with a single hinge place";
            return Err(InvalidInput::new("supports", "y held at one end", allowed).because(Problem::Conflict));
        }
        check_dry_held(self)
    }

    /// Refuses a bridge whose dense matrices would take too much memory: the condensation of a module, and what its
    /// places on the deck see of each other in a solver with four lines of wheels.
    ///
    /// # Errors
    /// [`InvalidInput`] on the mesh.
    pub fn check_size(&self, model: Model) -> Result<(), InvalidInput> {
        let Variants {
            designs,
            of_module,
            keys,
        } = self.variants();
        let lines_y_m = self.joint_lines_y_m();
        let needs = designs.iter().map(|design| {
            let size = mesh_size(&design.module, &design.lines_along_m(), &lines_y_m);
            let nodes = (size.lines_along * size.lines_across) as f64;
            let (dofs, condensation) = match model {
                Model::Full => (size.dofs as f64, 0.0),
                Model::SuperElement => {
                    let bottoms = if self.condensation.bottom_masters { 2.0 } else { 1.0 };
                    let kept = bottoms * nodes + self.condensation.fixed_master_modes as f64;
                    (kept, 3.0 * size.dofs as f64 * kept)
                }
            };
            (size, dofs, condensation)
        });
        let needs: Vec<(MeshSize, f64, f64)> = needs.collect();
        let of_places = |&of: &usize| (self.connectors.y_m.len() + 4 * needs[of].0.lines_along) as f64;
        let places: f64 = of_module.iter().map(of_places).sum();
        let dofs: f64 = of_module.iter().map(|&of| needs[of].1).sum();
        let solvers = 2.0 * places * (dofs + places);
        let condensation = needs.iter().map(|need| need.2).fold(0.0, f64::max);
        let gib = 8.0 * condensation.max(solvers) / f64::from(1 << 30);
        if gib > MOST_GIB {
            let largest = (0..needs.len()).max_by_key(|&of| needs[of].0.dofs).unwrap_or(0);
            let found = format!(
                "a mesh of {} degrees of freedom a module, which needs about {gib:.0} GiB",
                needs[largest].0.dofs
            );
            let allowed = format!("a mesh and a number of modules that need at most {MOST_GIB} GiB");
            return Err(InvalidInput::new("module.mesh", found, allowed).within_kind(&keys[largest]));
        }
        Ok(())
    }

    /// The hinges of a joint: the last of its own, or the bridge's.
    pub fn hinges_of(&self, joint: usize) -> &Hinges {
        self.joints.hinges_of(joint, &self.hinges)
    }

    /// Places across that some joint has a hinge at `[m]`: those of the bridge, then others in the order of joints.
    pub fn hinge_lines_y_m(&self) -> Vec<f64> {
        self.joints.hinge_lines_y_m(&self.hinges)
    }

    /// The gaps (tension, compression) of a connector before a job's wear `[m]`: its own, or those of the job.
    pub fn nominal_gaps_m(&self, joint: usize, y_m: f64, of_job: [f64; 2]) -> [f64; 2] {
        self.joints.nominal_gaps_m(joint, y_m, of_job)
    }

    /// The connectors whose laws differ from that of the connection; `worn` is what a job does to the gaps of a joint.
    /// In the linear connection a truss that is not there leaves half the stiffness and half the damping, and gaps and stops
    /// have no meaning.
    ///
    /// # Errors
    /// [`InvalidInput`] on a stop that begins within the gap before it.
    /// Equations (J4), (J5).
    pub fn own_laws(&self, connection: Connection, worn: Option<&JointGaps<'_>>) -> Result<OwnLaws, InvalidInput> {
        let laws = self.joints.own_laws(self.modules, &self.connectors, connection, worn)?;
        if self.banks.iter().all(|bank| !bank.one_sided) {
            return Ok(laws);
        }
        let mut all = laws.to_vec();
        let mut link = (self.modules - 1) * self.connectors.y_m.len();
        for bank in self.banks.iter().filter(|bank| bank.one_sided) {
            let places = self.bank_places_y_m(bank).len();
            let law = bank_law(bank, 1.0 / places as f64);
            all.extend((link..link + places).map(|link| (link, law)));
            link += places;
        }
        Ok(all.into())
    }

    /// Places across of the springs of a bank `[m]`: its own, or for z all lines of a module's bottom edge and for x and y the
    /// hinge places.
    pub fn bank_places_y_m(&self, bank: &BankSpec) -> Vec<f64> {
        // a row's variants share their lines across
        let lines = || match &self.variants().designs[..] {
            [first, ..] => lines_across(&first.module, &self.joint_lines_y_m()),
            [] => Vec::new(),
        };
        bank.places_y_m(&self.hinges.y_m, lines)
    }

    /// Freeboard of each module `[m]`; none where its kind has none.
    pub fn freeboards_m(&self) -> Vec<Option<f64>> {
        let Variants { designs, of_module, .. } = self.variants();
        of_module.iter().map(|&of| designs[of].freeboard_m).collect()
    }

    /// Draft of each module `[m]`; none where its kind has none.
    pub fn drafts_m(&self) -> Vec<Option<f64>> {
        let Variants { designs, of_module, .. } = self.variants();
        of_module.iter().map(|&of| designs[of].draft_m).collect()
    }

    /// How much the river has risen `[m]`; 0 where the file does not say.
    pub fn risen_m(&self) -> f64 {
        self.water_level_m.unwrap_or(0.0)
    }

    /// Whether the bridge is loaded before any vehicle comes, so that it has a dead state.
    pub fn has_dead_load(&self) -> bool {
        let presses = |bank: &BankSpec| bank.preload_n.is_some_and(|n| n > 0.0);
        let dry = || match &self.row {
            Some(row) => row.kinds.values().any(ModuleKind::is_dry_in_part),
            None => self.is_dry_in_part(),
        };
        !self.dead.is_empty() || self.risen_m() != 0.0 || self.banks.iter().any(presses) || dry()
    }

    /// Length of the bridge `[m]`.
    pub fn length_m(&self) -> f64 {
        self.position_x_m(self.positions())
    }

    /// Lines across that a module's mesh has for its joints: places of hinges, then of connectors `[m]`.
    pub fn joint_lines_y_m(&self) -> Vec<f64> {
        self.hinge_lines_y_m()
            .iter()
            .chain(&self.connectors.y_m)
            .copied()
            .collect()
    }

    /// The mesh of the module, with the lines that its joints and its water need; of a row of kinds the first one's.
    pub fn module_mesh(&self) -> ModuleMesh {
        mesh_module(&self.module, &self.lines_along_m(), &self.joint_lines_y_m())
    }

    /// Lines along that a module's mesh has for its water: where its wet part begins and ends, where the file says so `[m]`.
    pub fn lines_along_m(&self) -> Vec<f64> {
        self.wet_from_m.into_iter().chain(self.wet_to_m).collect()
    }

    /// Where the wet part of the module's bottom begins and ends `[m]`.
    pub fn wet_m(&self) -> [f64; 2] {
        wet_m(self.module.length_m, [self.wet_from_m, self.wet_to_m])
    }

    /// Length of the module's wet part `[m]`.
    pub(crate) fn wet_length_m(&self) -> f64 {
        let [from_m, to_m] = self.wet_m();
        to_m - from_m
    }

    /// Share of the module's length that is wet.
    pub fn wet_share(&self) -> f64 {
        self.wet_length_m() / self.module.length_m
    }

    /// Number of positions: the module ends.
    pub fn positions(&self) -> usize {
        self.modules + 1
    }

    /// Place of a position (from 1) along the bridge `[m]`.
    pub fn position_x_m(&self, position: usize) -> f64 {
        match &self.row {
            None => (position as f64 - 1.0) * self.module.length_m,
            Some(_) => self.positions_m().get(position - 1).copied().unwrap_or(f64::NAN),
        }
    }

    /// The bridge as one of modules of a kind alone.
    fn of_kind(&self, kind: &ModuleKind) -> Self {
        Self {
            row: None,
            module: kind.module.clone(),
            hydrostatic_stiffness_pa_m: kind.hydrostatic_stiffness_pa_m,
            draft_buoyancy: kind.draft_buoyancy.clone(),
            added_mass_kg_m: kind.added_mass_kg_m,
            todd: kind.todd,
            wet_from_m: kind.wet_from_m,
            wet_to_m: kind.wet_to_m,
            draft_m: kind.draft_m,
            freeboard_m: kind.freeboard_m,
            ..self.clone()
        }
    }

    /// What its modules are built as. In a row of unlike depths connectors reach below decks, at nodes that are then masters.
    pub fn variants(&self) -> Variants {
        let Some(row) = &self.row else {
            let mut design = self.clone();
            design.condensation.end_masters |= heights::has_unlike_depths(self);
            return Variants {
                designs: vec![design],
                of_module: vec![0; self.modules],
                keys: vec![String::new()],
            };
        };
        let (built, of_module) = row.built(&self.joint_lines_y_m());
        let unlike = heights::has_unlike_depths(self);
        let design = |(_, kind): &(&str, ModuleKind)| {
            let mut design = Self {
                modules: 1,
                hinges: Hinges {
                    y_m: self.hinge_lines_y_m(),
                },
                joints: Joints::default(),
                banks: Vec::new(),
                dead: DeadSpec::default(),
                water_level_m: None,
                ..self.of_kind(kind)
            };
            design.condensation.end_masters |= unlike;
            design
        };
        Variants {
            designs: built.iter().map(design).collect(),
            of_module,
            keys: built.iter().map(|(name, _)| key_of(name)).collect(),
        }
    }

    /// Each kind with what its keys begin with: `module_kinds.ramp` of a named kind, nothing of the only one.
    pub fn named_kinds(&self) -> Vec<(String, Self)> {
        let Some(row) = &self.row else {
            return vec![(String::new(), self.clone())];
        };
        let kinds = row.kinds.iter();
        kinds.map(|(name, kind)| (key_of(name), self.of_kind(kind))).collect()
    }

    /// The box of each module from left to right; of a mirrored one as its kind has it.
    pub fn boxes(&self) -> Vec<&ModuleDesign> {
        match &self.row {
            Some(row) => row.kinds_in_row().map(|kind| &kind.module).collect(),
            None => vec![&self.module; self.modules],
        }
    }

    /// The outline of each module from left to right as it stands there.
    pub fn outlines(&self) -> Vec<Outline> {
        heights::outlines(self)
    }

    /// Height of each module's bottom at its left end above that of the first module, as bottoms meet in the hinges `[m]`.
    pub fn bases_m(&self) -> Vec<f64> {
        heights::bases_m(self)
    }

    /// Height of the deck at a place along the bridge above the bottom of its left end `[m]`; beyond an end that of the end.
    pub fn deck_m(&self, x_m: f64) -> f64 {
        heights::deck_m(self, x_m)
    }

    /// Depth of the deepest module, and its still-water draft where its kind has one `[m]`.
    pub fn deepest_m(&self) -> (f64, Option<f64>) {
        heights::deepest_m(self)
    }

    /// Length of the shortest module `[m]`.
    pub fn shortest_module_m(&self) -> f64 {
        match &self.row {
            None => self.module.length_m,
            Some(row) => {
                let lengths = row.kinds_in_row().map(|kind| kind.module.length_m);
                lengths.fold(f64::INFINITY, f64::min)
            }
        }
    }

    /// Place of each position along the bridge `[m]`: the left end of each module and the right end of the last. Modules of one
    /// length side by side are multiplied, not added.
    pub fn positions_m(&self) -> Vec<f64> {
        let lengths: Vec<f64> = self.boxes().iter().map(|module| module.length_m).collect();
        let (mut places, mut first, mut from_m) = (vec![0.0], 0, 0.0);
        for (j, &length_m) in lengths.iter().enumerate() {
            if length_m.to_bits() != lengths[first].to_bits() {
                from_m += (j - first) as f64 * lengths[first];
                first = j;
            }
            places.push(from_m + (j + 1 - first) as f64 * length_m);
        }
        places
    }

    /// Mass of one module's plates and beams `[kg]`, of a row of kinds the first one's: the sum of `rho t A` and `rho A L`, which is `r^T M r` of a unit heave.
    /// Verified by `tests/solvers/superelement.rs`.
    pub fn structural_mass_kg(&self) -> f64 {
        self.module_mesh().mesh.mass_kg()
    }

    /// Whether no water is under the module.
    pub(crate) fn is_dry(&self) -> bool {
        self.wet_length_m() <= SAME_PLACE_M
    }

    /// Whether some of the module's bottom is dry.
    pub(crate) fn is_dry_in_part(&self) -> bool {
        self.module.length_m - self.wet_length_m() > SAME_PLACE_M
    }

    /// p_b `[Pa/m]`, from the value or the table, whose slope is that of the wet part; 0 of a dry module.
    pub fn p_b(&self) -> f64 {
        match (self.hydrostatic_stiffness_pa_m, &self.draft_buoyancy) {
            (Some(p_b), _) => p_b,
            (None, Some(table)) => table.slope_n_m() / (self.wet_length_m() * self.module.breadth_m),
            (None, None) if self.is_dry() => 0.0,
            (None, None) => f64::NAN,
        }
    }

    /// m_a per metre of the wet part `[kg/m]`, from the value or Todd's formula; 0 of a dry module, and in water with memory.
    pub fn m_a(&self) -> f64 {
        match (self.added_mass_kg_m, &self.todd) {
            (Some(m_a), _) => m_a,
            (None, Some(todd)) => todd.added_mass_kg_m(self.module.breadth_m),
            (None, None) if self.is_dry() || self.water.is_some() => 0.0,
            (None, None) => f64::NAN,
        }
    }
}
