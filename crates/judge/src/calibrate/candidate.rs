//! A point of the parameters made into a bridge.
//!
//! Knows paths and the quantities that are no number of the file: masses. Does not know what is computed of it.

use super::parameters::Parameters;
use super::quantities::QUANTITIES;
use pontoon_core::bridge::BridgeDesign;
use pontoon_core::input::InvalidInput;
use pontoon_plan::input::{Document, DocumentPath, FoundValue, Refusal, RefusalKind, to_value, typed_value};
use pontoon_plan::study_file::BridgeFile;
use serde_json::json;
use std::path::Path;

/// A bridge at a point of the parameters.
#[derive(Debug, Clone)]
pub(super) struct Candidate {
    /// The bridge.
    pub(super) design: BridgeDesign,
}

/// The refusal of what parameters make of a number of the bridge.
fn of_numbers(file: &Path, wrong: InvalidInput) -> Refusal {
    let found = FoundValue::from(wrong.found).which(format!("which they make of {} of the bridge", wrong.key));
    Refusal::new(file, "parameters", found, wrong.allowed)
}

impl Candidate {
    /// The bridge with every parameter's numbers in place; then the masses, the structure's before the whole's.
    pub(super) fn new(parameters: &Parameters, bridge: &BridgeFile, point: &[f64]) -> Result<Self, Refusal> {
        let file = &parameters.file;
        let mut document = to_value(&bridge.design);
        let mut set = |at: &str, path: &str, value: f64| {
            let path =
                DocumentPath::parse(path).ok_or_else(|| Refusal::new(file, at, FoundValue::value(path), "a path"))?;
            path.set(&mut document, json!(value)).map_err(|obstacle| {
                let refused = Refusal::new(file, at, obstacle.to_string(), "the path of a number");
                refused.because(RefusalKind::Misplaced)
            })
        };
        let mut masses: Vec<(&str, f64)> = parameters
            .spec
            .hold
            .iter()
            .map(|(name, value)| (name.as_str(), *value))
            .collect();
        for (i, (parameter, &value)) in parameters.spec.parameters.iter().zip(point).enumerate() {
            let at = format!("parameters[{i}]");
            if QUANTITIES.contains(&parameter.name.as_str()) && parameter.sets.is_empty() {
                masses.push((&parameter.name, value));
            } else if parameter.sets.is_empty() {
                set(&at, &parameter.name, value)?;
            } else {
                for (path, factor) in &parameter.sets {
                    set(&at, path, factor * value)?;
                }
            }
        }
        let design: BridgeDesign = typed_value(file, "", &document)?;
        let mut candidate = Self { design };
        candidate.design.provenance = None;
        candidate.design.check().map_err(|wrong| of_numbers(file, wrong))?;
        if let (Some(_), Some((name, _))) = (&candidate.design.row, masses.first()) {
            let allowed = "numbers of the bridge file: its modules are not alike, so that no module stands for all";
            let refused = Refusal::new(file, format!("hold.{name}"), "a quantity of a module", allowed);
            return Err(refused.because(RefusalKind::Misplaced));
        }
        for quantity in QUANTITIES {
            if let Some((_, value)) = masses.iter().find(|(name, _)| *name == quantity) {
                candidate.take_mass(quantity, *value);
            }
        }
        candidate.design.check().map_err(|wrong| of_numbers(file, wrong))?;
        Ok(candidate)
    }

    fn take_mass(&mut self, quantity: &str, value: f64) {
        let mass_kg = self.design.structural_mass_kg();
        if quantity == "structural_mass_kg" {
            self.design.module.material.density_kg_m3 *= value / mass_kg;
        } else {
            self.design.todd = None;
            self.design.added_mass_kg_m =
                Some((value - mass_kg / self.design.module.length_m) / self.design.wet_share());
        }
    }

    /// The bridge as a file's document.
    pub(super) fn document(&self) -> Document {
        Document::from(&to_value(&self.design))
    }
}
