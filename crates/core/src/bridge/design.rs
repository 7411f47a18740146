//! A bridge as its file writes it: modules, water, hinges, connectors, supports, condensation.
//!
//! Knows which numbers describe a bridge and refuses those that cannot. Does not know files or studies.

use super::banks::{BankRoom, BankSpec, bank_law, check_banks};
use super::joints::{Connectors, Hinges, JointGaps, Joints, places};
use super::supports::{Direction, Supports};
use super::{Model, Provenance};
use crate::connector::{Connection, OwnLaws};
use crate::input::{InvalidInput, Problem, not_negative, positive, within};
use crate::module::{ModuleDesign, lines_across, mesh_module, mesh_size};
use crate::water::WaterDistribution;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A bridge of identical modules.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BridgeDesign {
    /// Name of the bridge.
    pub name: String,
    /// Where the numbers come from.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub source: Option<String>,
    /// How its numbers were identified, where a fit left them; nothing is computed from it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub provenance: Option<Provenance>,
    /// Number of modules.
    pub modules: usize,
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
    /// How both waters are shared among the nodes of the wetted bottom.
    #[serde(default)]
    pub water_distribution: WaterDistribution,
    /// Hinges at the bottom of every joint.
    pub hinges: Hinges,
    /// Connectors at the deck of every joint.
    pub connectors: Connectors,
    /// What single joints have of their own.
    #[serde(default, skip_serializing_if = "Joints::is_empty")]
    pub joints: Joints,
    /// Supports of the two ends.
    #[serde(default)]
    pub supports: Supports,
    /// Springs between the bridge and the ground.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub banks: Vec<BankSpec>,
    /// Still-water draft `[m]`, for reporting whether the bottom emerged.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub draft_m: Option<f64>,
    /// Height of the deck above the still water `[m]`, for reporting whether the deck was submerged.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub freeboard_m: Option<f64>,
    /// How a module is condensed to a super-element.
    #[serde(default)]
    pub condensation: Condensation,
}

/// Buoyancy of one module against draft.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DraftBuoyancy {
    /// Drafts, increasing `[m]`.
    pub draft_m: Vec<f64>,
    /// Buoyancy of a module at each draft `[N]`.
    pub buoyancy_n: Vec<f64>,
    /// The draft at which the unloaded module floats `[m]`.
    pub still_water_draft_m: f64,
}

/// Todd's formula, `m_a = 1/2 pi rho_w C J (B/2)^2` per metre.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Todd {
    /// Density of the water rho_w `[kg/m^3]`.
    pub water_density_kg_m3: f64,
    /// Section coefficient C.
    pub section_coefficient: f64,
    /// Three-dimensional correction J.
    pub three_dimensional_correction: f64,
}

/// Masters and modes of the super-element. Hinges, connectors, the deck's z and the ends' bottom edges are always
/// masters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Condensation {
    /// Fixed-master modes kept (Craig-Bampton); 0 is Guyan's condensation.
    #[serde(default = "default_fixed_master_modes")]
    pub fixed_master_modes: usize,
    /// Whether z of all bottom nodes, which carry the water, are masters too.
    #[serde(default)]
    pub bottom_masters: bool,
}

fn default_fixed_master_modes() -> usize {
    16
}

impl Default for Condensation {
    fn default() -> Self {
        Self {
            fixed_master_modes: default_fixed_master_modes(),
            bottom_masters: false,
        }
    }
}

/// How far the sum of a draft and a freeboard may be off the depth, as both are rounded `[m]`, and as a share of it.
const ROUNDED_M: f64 = 0.010_001;
const ROUNDED: f64 = 0.01;

/// Density of fresh water `[kg/m^3]`, by which a mass gives a draft.
const WATER_KG_M3: f64 = 1000.0;

/// How often a draft may be that of the box with the model's mass, or that one it: a hull is no box, and a model may leave
/// out what a deck carries.
const FULLNESS: f64 = 2.0;

/// Most memory that the dense matrices of one bridge may take `[GiB]`.
const MOST_GIB: f64 = 4.0;

impl BridgeDesign {
    /// Refuses numbers that describe no bridge.
    ///
    /// # Errors
    /// [`InvalidInput`] with the key's path.
    pub fn check(&self) -> Result<(), InvalidInput> {
        if !(1..=500).contains(&self.modules) {
            return Err(InvalidInput::new(
                "modules",
                self.modules,
                "a whole number from 1 to 500",
            ));
        }
        self.module.check().map_err(|e| e.under("module"))?;
        self.check_water()?;
        let half = 0.5 * self.module.breadth_m;
        places("hinges.y_m", &self.hinges.y_m, half)?;
        self.connectors.check(half).map_err(|e| e.under("connectors"))?;
        self.joints.check(self.modules, half, &self.connectors)?;
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
        for (key, value) in [("draft_m", self.draft_m), ("freeboard_m", self.freeboard_m)] {
            if let Some(value) = value {
                positive(key, value)?;
            }
        }
        if self.condensation.fixed_master_modes > 400 {
            return Err(InvalidInput::new(
                "condensation.fixed_master_modes",
                self.condensation.fixed_master_modes,
                "a whole number from 0 to 400",
            ));
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
    /// buoyancies.
    ///
    /// # Errors
    /// [`InvalidInput`] with the key's path.
    pub fn check_water_line(&self) -> Result<(), InvalidInput> {
        let conflict = |key: &str, found: f64, allowed: String| {
            Err(InvalidInput::new(key, found, allowed).because(Problem::Conflict))
        };
        let depth_m = self.module.depth_m;
        let rounded = ROUNDED_M.max(ROUNDED * depth_m);
        for (key, value) in [("draft_m", self.draft_m), ("freeboard_m", self.freeboard_m)] {
            if let Some(value) = value.filter(|&value| value > depth_m) {
                return conflict(key, value, format!("at most {depth_m}, the depth of the module"));
            }
        }
        if let (Some(draft), Some(freeboard)) = (self.draft_m, self.freeboard_m)
            && (draft + freeboard - depth_m).abs() > rounded
        {
            let rest = metres(depth_m - draft);
            let allowed = format!("about {rest}, what the depth of {depth_m} leaves above the draft of {draft}");
            return conflict("freeboard_m", freeboard, allowed);
        }
        let Some(draft) = self.draft_m else { return Ok(()) };
        if let Some(table) = &self.draft_buoyancy
            && (draft - table.still_water_draft_m).abs() > rounded
        {
            let still = table.still_water_draft_m;
            let allowed = format!("about {still}, the draft of draft_buoyancy.still_water_draft_m");
            return conflict("draft_m", draft, allowed);
        }
        let mass_kg = self.structural_mass_kg();
        let of_mass = mass_kg / (WATER_KG_M3 * self.module.length_m * self.module.breadth_m);
        if !(of_mass / FULLNESS..=of_mass * FULLNESS).contains(&draft) {
            let [least, most] = [of_mass / FULLNESS, of_mass * FULLNESS].map(metres);
            let allowed = format!(
                "about {}, which the mass of the module gives ({mass_kg:.0} kg), and no less than {least} or more than {most}",
                metres(of_mass)
            );
            return conflict("draft_m", draft, allowed);
        }
        Ok(())
    }

    /// Refuses a bridge that supports and hinges leave free to move horizontally, against which water does nothing: it
    /// has no static case, for its stiffness without connectors is singular.
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
            let on_spring = self
                .banks
                .iter()
                .any(|bank| !bank.one_sided && bank.direction == direction);
            if !(left.contains(&direction) || right.contains(&direction) || on_spring) {
                let found = format!("no end that holds {word}");
                let allowed = "x and y held at an end at least, or by a bank both ways, in a static case";
                return Err(InvalidInput::new("supports", found, allowed).because(Problem::Missing));
            }
        }
        if single && !(left.contains(&Direction::Y) && right.contains(&Direction::Y)) {
            let allowed = "y held at both ends in a static case of one module with a single hinge place";
            return Err(InvalidInput::new("supports", "y held at one end", allowed).because(Problem::Conflict));
        }
        Ok(())
    }

    /// Refuses a bridge whose dense matrices would take too much memory: the condensation of a module, and what its
    /// places on the deck see of each other in a solver with four lines of wheels.
    ///
    /// # Errors
    /// [`InvalidInput`] on the mesh.
    pub fn check_size(&self, model: Model) -> Result<(), InvalidInput> {
        let size = mesh_size(&self.module, &self.joint_lines_y_m());
        let nodes = (size.lines_along * size.lines_across) as f64;
        let (module_dofs, condensation) = match model {
            Model::Full => (size.dofs as f64, 0.0),
            Model::SuperElement => {
                let bottoms = if self.condensation.bottom_masters { 2.0 } else { 1.0 };
                let kept = bottoms * nodes + self.condensation.fixed_master_modes as f64;
                (kept, 3.0 * size.dofs as f64 * kept)
            }
        };
        let modules = self.modules as f64;
        let places = modules * (self.connectors.y_m.len() + 4 * size.lines_along) as f64;
        let solvers = 2.0 * places * (modules * module_dofs + places);
        let gib = 8.0 * condensation.max(solvers) / f64::from(1 << 30);
        if gib > MOST_GIB {
            let found = format!(
                "a mesh of {} degrees of freedom a module, which needs about {gib:.0} GiB",
                size.dofs
            );
            return Err(InvalidInput::new(
                "module.mesh",
                found,
                format!("a mesh and a number of modules that need at most {MOST_GIB} GiB"),
            ));
        }
        Ok(())
    }

    fn check_water(&self) -> Result<(), InvalidInput> {
        match (self.hydrostatic_stiffness_pa_m, &self.draft_buoyancy) {
            (Some(p_b), None) => positive("hydrostatic_stiffness_pa_m", p_b).map(|_| ())?,
            (None, Some(table)) => table.check().map_err(|e| e.under("draft_buoyancy"))?,
            (found, _) => {
                let (found, problem) = both_or_neither(found.is_some());
                let refused = InvalidInput::new("hydrostatic_stiffness_pa_m", found, "either this or draft_buoyancy");
                return Err(refused.because(problem));
            }
        }
        match (self.added_mass_kg_m, &self.todd) {
            (Some(m_a), None) => not_negative("added_mass_kg_m", m_a).map(|_| ()),
            (None, Some(todd)) => todd.check().map_err(|e| e.under("todd")),
            (found, _) => {
                let (found, problem) = both_or_neither(found.is_some());
                Err(InvalidInput::new("added_mass_kg_m", found, "either this or todd").because(problem))
            }
        }
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
        bank.places_y_m(&self.hinges.y_m, || lines_across(&self.module, &self.joint_lines_y_m()))
    }

    /// Length of the bridge `[m]`.
    pub fn length_m(&self) -> f64 {
        self.modules as f64 * self.module.length_m
    }

    /// Lines across that a module's mesh has for its joints: places of hinges, then of connectors `[m]`.
    pub fn joint_lines_y_m(&self) -> Vec<f64> {
        self.hinge_lines_y_m()
            .iter()
            .chain(&self.connectors.y_m)
            .copied()
            .collect()
    }

    /// Number of positions: the module ends.
    pub fn positions(&self) -> usize {
        self.modules + 1
    }

    /// Place of a position (from 1) along the bridge `[m]`.
    pub fn position_x_m(&self, position: usize) -> f64 {
        (position as f64 - 1.0) * self.module.length_m
    }

    /// Mass of one module's plates and beams `[kg]`: the sum of `rho t A` and `rho A L`, which is `r^T M r` of a unit heave.
    /// Verified by `tests/solvers/superelement.rs`.
    pub fn structural_mass_kg(&self) -> f64 {
        mesh_module(&self.module, &self.joint_lines_y_m()).mesh.mass_kg()
    }

    /// p_b `[Pa/m]`, from the value or the table.
    pub fn p_b(&self) -> f64 {
        match (self.hydrostatic_stiffness_pa_m, &self.draft_buoyancy) {
            (Some(p_b), _) => p_b,
            (None, Some(table)) => table.slope_n_m() / (self.module.length_m * self.module.breadth_m),
            (None, None) => f64::NAN,
        }
    }

    /// m_a per metre of bridge `[kg/m]`, from the value or Todd's formula.
    pub fn m_a(&self) -> f64 {
        match (self.added_mass_kg_m, &self.todd) {
            (Some(m_a), _) => m_a,
            (None, Some(todd)) => todd.added_mass_kg_m(self.module.breadth_m),
            (None, None) => f64::NAN,
        }
    }
}

/// A length to the millimetre, for a message.
fn metres(length_m: f64) -> f64 {
    (length_m * 1e3).round() / 1e3
}

impl DraftBuoyancy {
    fn check(&self) -> Result<(), InvalidInput> {
        if self.draft_m.len() < 2 {
            return Err(InvalidInput::new(
                "draft_m",
                format!("{} entries", self.draft_m.len()),
                "at least two drafts",
            ));
        }
        if self.buoyancy_n.len() != self.draft_m.len() {
            return Err(InvalidInput::new(
                "buoyancy_n",
                format!("{} entries", self.buoyancy_n.len()),
                format!("{} entries, one a draft", self.draft_m.len()),
            ));
        }
        for (key, list) in [("draft_m", &self.draft_m), ("buoyancy_n", &self.buoyancy_n)] {
            for (i, w) in list.windows(2).enumerate() {
                not_negative(&format!("{key}[{i}]"), w[0])?;
                if !(w[1].is_finite() && w[1] > w[0]) {
                    return Err(InvalidInput::new(
                        format!("{key}[{}]", i + 1),
                        w[1],
                        format!("above {}", w[0]),
                    ));
                }
            }
        }
        let last = self.draft_m[self.draft_m.len() - 1];
        within("still_water_draft_m", self.still_water_draft_m, self.draft_m[0], last).map(|_| ())
    }

    /// Slope of the table at the still-water draft `[N/m]`: of the segment that holds it, of the two neighbours' mean
    /// on a table point.
    pub(crate) fn slope_n_m(&self) -> f64 {
        let slope = |i: usize| (self.buoyancy_n[i + 1] - self.buoyancy_n[i]) / (self.draft_m[i + 1] - self.draft_m[i]);
        let at = self.still_water_draft_m;
        let segments: Vec<f64> = (0..self.draft_m.len() - 1)
            .filter(|&i| self.draft_m[i] <= at && at <= self.draft_m[i + 1])
            .map(slope)
            .collect();
        segments.iter().sum::<f64>() / segments.len() as f64
    }
}

impl Todd {
    fn check(&self) -> Result<(), InvalidInput> {
        positive("water_density_kg_m3", self.water_density_kg_m3)?;
        positive("section_coefficient", self.section_coefficient)?;
        positive("three_dimensional_correction", self.three_dimensional_correction)?;
        Ok(())
    }

    /// `m_a = 1/2 pi rho_w C J (B/2)^2` `[kg/m]`.
    /// Equation (W1).
    pub fn added_mass_kg_m(&self, breadth_m: f64) -> f64 {
        0.5 * std::f64::consts::PI
            * self.water_density_kg_m3
            * self.section_coefficient
            * self.three_dimensional_correction
            * (0.5 * breadth_m).powi(2)
    }
}

/// What is wrong where exactly one of two keys is needed and both or neither are given.
fn both_or_neither(both: bool) -> (&'static str, Problem) {
    if both {
        ("both", Problem::Misplaced)
    } else {
        ("neither", Problem::Missing)
    }
}
