//! The two forms in which a bridge file writes its modules.
//!
//! Knows how a number with one module and a list with kinds become one design, and how a design is written again. Does not
//! know whether the numbers are a bridge's.

use super::{BridgeDesign, Condensation, Supports, WaterSpec};
use crate::bridge::Provenance;
use crate::bridge::ballast::DeadSpec;
use crate::bridge::banks::BankSpec;
use crate::bridge::buoyancy::{DraftBuoyancy, Todd};
use crate::bridge::joints::{Connectors, Hinges, Joints};
use crate::bridge::kinds::{ModuleKind, ModuleRow, ModuleRun};
use crate::input::{InvalidInput, Problem};
use crate::module::ModuleDesign;
use crate::water::WaterDistribution;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::SeqAccessDeserializer;
use serde::de::{Error, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fmt;

/// A bridge of modules side by side: `modules` equal ones of `module` and the water beside it, or a list of modules of
/// `module_kinds`.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename = "BridgeDesign")]
pub(super) struct WrittenBridge {
    /// Name of the bridge.
    name: String,
    /// Where the numbers come from.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    source: Option<String>,
    /// How its numbers were identified, where a fit left them; nothing is computed from it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    provenance: Option<Provenance>,
    /// Number of modules, or the modules from left to right by their kinds.
    modules: WrittenModules,
    /// The module. Either this or `module_kinds`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    module: Option<ModuleDesign>,
    /// Kinds of modules by name.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    module_kinds: Option<BTreeMap<String, ModuleKind>>,
    /// Hydrostatic stiffness p_b: pressure per metre of sinking `[Pa/m]`. Either this or `draft_buoyancy`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    hydrostatic_stiffness_pa_m: Option<f64>,
    /// Draft-buoyancy table, whose slope at the still-water draft gives p_b.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    draft_buoyancy: Option<DraftBuoyancy>,
    /// Added mass per metre of bridge `[kg/m]`. Either this or `todd`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    added_mass_kg_m: Option<f64>,
    /// Todd's formula for the added mass.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    todd: Option<Todd>,
    /// Where the wet part of the module begins, from its left end `[m]`; absent: 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    wet_from_m: Option<f64>,
    /// Where it ends `[m]`; absent: the length. A module whose wet part begins where it ends is dry.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    wet_to_m: Option<f64>,
    /// How both waters are shared among the nodes of the wetted bottom.
    #[serde(default)]
    water_distribution: WaterDistribution,
    /// Water with memory, in place of an added mass.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    water: Option<WaterSpec>,
    /// Hinges at the bottom of every joint.
    hinges: Hinges,
    /// Connectors at the deck of every joint.
    connectors: Connectors,
    /// What single joints have of their own.
    #[serde(default, skip_serializing_if = "Joints::is_empty")]
    joints: Joints,
    /// Supports of the two ends.
    #[serde(default)]
    supports: Supports,
    /// Springs between the bridge and the ground.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    banks: Vec<BankSpec>,
    /// What lies on the bridge at rest.
    #[serde(default, skip_serializing_if = "DeadSpec::is_empty")]
    dead: DeadSpec,
    /// How much the river has risen since the bridge was laid on its supports and banks `[m]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    water_level_m: Option<f64>,
    /// Still-water draft `[m]`, for reporting whether the bottom emerged.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    draft_m: Option<f64>,
    /// Height of the deck above the still water `[m]`, for reporting whether the deck was submerged.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    freeboard_m: Option<f64>,
    /// How a module is condensed to a super-element.
    #[serde(default)]
    condensation: Condensation,
}

/// What `modules` is.
#[derive(Serialize)]
#[serde(untagged)]
enum WrittenModules {
    /// A number of equal ones.
    Count(usize),
    /// Modules by their kinds.
    Row(Vec<ModuleRun>),
}

impl<'de> Deserialize<'de> for WrittenModules {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct ModulesVisitor;

        impl<'de> Visitor<'de> for ModulesVisitor {
            type Value = WrittenModules;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a whole number of at least 0, or a list of modules")
            }

            fn visit_u64<E: Error>(self, count: u64) -> Result<WrittenModules, E> {
                Ok(WrittenModules::Count(usize::try_from(count).unwrap_or(usize::MAX)))
            }

            fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<WrittenModules, A::Error> {
                Vec::deserialize(SeqAccessDeserializer::new(list)).map(WrittenModules::Row)
            }
        }

        deserializer.deserialize_any(ModulesVisitor)
    }
}

impl JsonSchema for WrittenModules {
    fn schema_name() -> Cow<'static, str> {
        "Modules".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let run = generator.subschema_for::<ModuleRun>();
        json_schema!({ "anyOf": [
            { "type": "integer", "minimum": 1, "maximum": 500 },
            { "type": "array", "items": run, "minItems": 1 }
        ] })
    }
}

impl WrittenBridge {
    /// The first key that has no place beside the form that `modules` chooses.
    fn fault(&self) -> Option<InvalidInput> {
        let beside = match self.modules {
            WrittenModules::Count(_) => {
                let allowed = "nothing beside a number of modules, which are those of module";
                return self
                    .module_kinds
                    .is_some()
                    .then(|| InvalidInput::new("module_kinds", "kinds", allowed).because(Problem::Misplaced));
            }
            WrittenModules::Row(_) => [
                ("module", self.module.is_some()),
                ("hydrostatic_stiffness_pa_m", self.hydrostatic_stiffness_pa_m.is_some()),
                ("draft_buoyancy", self.draft_buoyancy.is_some()),
                ("added_mass_kg_m", self.added_mass_kg_m.is_some()),
                ("todd", self.todd.is_some()),
                ("wet_from_m", self.wet_from_m.is_some()),
                ("wet_to_m", self.wet_to_m.is_some()),
                ("draft_m", self.draft_m.is_some()),
                ("freeboard_m", self.freeboard_m.is_some()),
            ],
        };
        let (key, _) = beside.into_iter().find(|(_, given)| *given)?;
        let allowed = "nothing beside a list of modules, whose kinds have it";
        Some(InvalidInput::new(key, "a value", allowed).because(Problem::Misplaced))
    }

    /// The design.
    ///
    /// # Errors
    /// The key that is missing: of a design without a module nothing can be said.
    pub(super) fn design(self) -> Result<BridgeDesign, &'static str> {
        let fault = self.fault().map(Box::new);
        let (modules, row) = match self.modules {
            WrittenModules::Count(count) => (count, None),
            WrittenModules::Row(runs) => {
                let kinds = self.module_kinds.ok_or("module_kinds")?;
                let row = ModuleRow { kinds, runs };
                (row.count(), Some(row))
            }
        };
        let first = match &row {
            Some(row) => Some(row.first().ok_or("module_kinds")?.clone()),
            None => None,
        };
        let module = match &first {
            Some(kind) => kind.module.clone(),
            None => self.module.ok_or("module")?,
        };
        let design = BridgeDesign {
            name: self.name,
            source: self.source,
            provenance: self.provenance,
            modules,
            module,
            hydrostatic_stiffness_pa_m: self.hydrostatic_stiffness_pa_m,
            draft_buoyancy: self.draft_buoyancy,
            added_mass_kg_m: self.added_mass_kg_m,
            todd: self.todd,
            wet_from_m: self.wet_from_m,
            wet_to_m: self.wet_to_m,
            water_distribution: self.water_distribution,
            water: self.water,
            hinges: self.hinges,
            connectors: self.connectors,
            joints: self.joints,
            supports: self.supports,
            banks: self.banks,
            dead: self.dead,
            water_level_m: self.water_level_m,
            draft_m: self.draft_m,
            freeboard_m: self.freeboard_m,
            condensation: self.condensation,
            row: None,
            fault,
        };
        Ok(match first {
            Some(kind) => BridgeDesign {
                row,
                ..design.of_kind(&kind)
            },
            None => design,
        })
    }

    /// How a design is written.
    pub(super) fn of(design: &BridgeDesign) -> Self {
        let of = design.clone();
        let plain = Self {
            name: of.name,
            source: of.source,
            provenance: of.provenance,
            modules: WrittenModules::Count(of.modules),
            module: Some(of.module),
            module_kinds: None,
            hydrostatic_stiffness_pa_m: of.hydrostatic_stiffness_pa_m,
            draft_buoyancy: of.draft_buoyancy,
            added_mass_kg_m: of.added_mass_kg_m,
            todd: of.todd,
            wet_from_m: of.wet_from_m,
            wet_to_m: of.wet_to_m,
            water_distribution: of.water_distribution,
            water: of.water,
            hinges: of.hinges,
            connectors: of.connectors,
            joints: of.joints,
            supports: of.supports,
            banks: of.banks,
            dead: of.dead,
            water_level_m: of.water_level_m,
            draft_m: of.draft_m,
            freeboard_m: of.freeboard_m,
            condensation: of.condensation,
        };
        let Some(row) = of.row else { return plain };
        Self {
            modules: WrittenModules::Row(row.runs),
            module_kinds: Some(row.kinds),
            module: None,
            hydrostatic_stiffness_pa_m: None,
            draft_buoyancy: None,
            added_mass_kg_m: None,
            todd: None,
            wet_from_m: None,
            wet_to_m: None,
            draft_m: None,
            freeboard_m: None,
            ..plain
        }
    }
}
