//! The file of a calibration: what may move, between which bounds, what is held, what is fitted.
//!
//! Knows its keys and that each names something of the bridge. Does not know references' checks or fits.

use super::fit::{Parameter, Settings};
use super::quantities::{FOLLOWS, QUANTITIES, quantity};
use pontoon_plan::input::{Cell, Document, DocumentPath, FoundValue, Refusal, RefusalKind, leaves, to_value, typed};
use pontoon_plan::study_file::BridgeFile;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// A file of parameters as it is written.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ParametersSpec {
    /// What may move.
    #[schemars(length(min = 1))]
    pub parameters: Vec<ParameterSpec>,
    /// Quantities that keep a value whatever moves: `structural_mass_kg` (of a module, by the density of its material),
    /// `total_mass_kg_m` (structure and added mass per metre of bridge, by the added mass).
    #[serde(default)]
    pub hold: BTreeMap<String, f64>,
    /// Ids of the checks to fit; every check of one value with the role hold where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fit: Option<Vec<String>>,
    /// Factors on the residuals of single checks, by their ids, above 0; 1 where absent.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub weights: BTreeMap<String, f64>,
    /// Step of the differences by which derivatives are formed, as a share of the width between bounds; 0.005 where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub difference_share: Option<f64>,
    /// Relative change at which the search ends; 1e-4 where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tolerance: Option<f64>,
    /// Candidates after which the search gives up; 300 where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub evaluations_limit: Option<usize>,
}

/// One parameter.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ParameterSpec {
    /// Its name, ending in its unit: a word of one's own with `sets`, or a quantity as in `hold`.
    pub name: String,
    /// Numbers of the bridge that follow it, by their paths, each as the factor by which it is multiplied; a number that
    /// its name names as a path needs none.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub sets: BTreeMap<String, f64>,
    /// Least value allowed.
    pub lower: f64,
    /// Largest value allowed.
    pub upper: f64,
}

/// A file of parameters, read.
#[derive(Debug, Clone)]
pub struct Parameters {
    /// The file.
    pub file: PathBuf,
    /// Its document.
    pub document: Document,
    /// What it says.
    pub spec: ParametersSpec,
    /// What steers the fit: its numbers checked, its defaults filled in.
    settings: Settings,
}

impl ParametersSpec {
    /// Refuses numbers of the bridge that two parameters move, or a parameter and a quantity.
    fn each_number_once(&self, file: &Path) -> Result<(), Refusal> {
        let mut taken: Vec<(&str, &str)> = Vec::new();
        for name in self
            .hold
            .keys()
            .chain(self.parameters.iter().filter(|p| p.sets.is_empty()).map(|p| &p.name))
        {
            let own = FOLLOWS.iter().filter(|(quantity, _)| quantity == name);
            taken.extend(own.map(|(_, follows)| (*follows, name.as_str())));
        }
        for (i, parameter) in self.parameters.iter().enumerate() {
            let own = parameter.sets.is_empty().then_some(&parameter.name);
            for path in own.into_iter().chain(parameter.sets.keys()) {
                if let Some((_, other)) = taken.iter().find(|(number, _)| number == path) {
                    let key = match own {
                        Some(_) => format!("parameters[{i}].name"),
                        None => format!("parameters[{i}].sets.{path}"),
                    };
                    let found = FoundValue::value(path.as_str()).which(format!("which follows '{other}'"));
                    let refused = Refusal::new(file, key, found, "numbers that nothing else moves");
                    return Err(refused.because(RefusalKind::Conflict));
                }
                taken.push((path, &parameter.name));
            }
        }
        Ok(())
    }

    /// Refuses quantities that are not known, moved as well, or not above zero.
    fn check_held(&self, file: &Path) -> Result<(), Refusal> {
        let known = QUANTITIES.map(str::to_owned);
        for (name, value) in &self.hold {
            let path = format!("hold.{name}");
            if !known.contains(name) {
                return Err(Refusal::unknown_key(file, path, name, &known));
            }
            if self.parameters.iter().any(|p| p.name == *name) {
                let refused = Refusal::new(file, path, "a parameter of the same name", "held or moved, not both");
                return Err(refused.because(RefusalKind::Misplaced));
            }
            if *value <= 0.0 {
                return Err(Refusal::new(file, path, *value, "a number above 0"));
            }
        }
        Ok(())
    }

    /// What steers the fit, with its defaults.
    fn settings(&self, file: &Path) -> Result<Settings, Refusal> {
        let settings = Settings {
            evaluations_limit: self.evaluations_limit.unwrap_or(300),
            difference_share: self.difference_share.unwrap_or(0.005),
            tolerance: self.tolerance.unwrap_or(1e-4),
            ..Settings::default()
        };
        for (key, value, most) in [
            ("difference_share", settings.difference_share, 0.25),
            ("tolerance", settings.tolerance, 0.1),
        ] {
            if !(value > 1e-14 && value <= most) {
                let allowed = format!("above 1e-14 and at most {most}");
                return Err(Refusal::new(file, key, value, allowed));
            }
        }
        if settings.evaluations_limit == 0 {
            return Err(Refusal::new(
                file,
                "evaluations_limit",
                0.0,
                "a whole number of at least 1",
            ));
        }
        Ok(settings)
    }
}

impl ParameterSpec {
    /// Refuses bounds that hold nothing between them, and a factor of 0; `key` is the parameter's path.
    fn check(&self, file: &Path, key: &str) -> Result<(), Refusal> {
        let upper = format!("{key}.upper");
        if !(self.upper - self.lower).is_finite() {
            let found =
                FoundValue::from(self.upper).which(format!("too far from lower, {}", Cell::written(self.lower)));
            return Err(Refusal::new(file, upper, found, "bounds whose distance is a number"));
        }
        if self.lower >= self.upper {
            let refused = Refusal::new(file, upper, self.upper, format!("above lower, {}", self.lower));
            return Err(refused.because(RefusalKind::Conflict));
        }
        match self.sets.iter().find(|(_, factor)| **factor == 0.0) {
            Some((path, factor)) => {
                let path = format!("{key}.sets.{path}");
                Err(Refusal::new(file, path, *factor, "a factor other than 0"))
            }
            None => Ok(()),
        }
    }
}

impl Parameters {
    /// Reads a file of parameters.
    ///
    /// # Errors
    /// [`Refusal`].
    pub fn open(file: &Path) -> Result<Self, Refusal> {
        let document = Document::read(file)?;
        let spec: ParametersSpec = typed(file, "", &document)?;
        if spec.parameters.is_empty() {
            return Err(Refusal::new(
                file,
                "parameters",
                "an empty list",
                "at least one parameter",
            ));
        }
        for (i, parameter) in spec.parameters.iter().enumerate() {
            parameter.check(file, &format!("parameters[{i}]"))?;
            if spec.parameters[..i].iter().any(|other| other.name == parameter.name) {
                let found = FoundValue::value(parameter.name.as_str());
                let refused = Refusal::new(file, format!("parameters[{i}].name"), found, "each name once");
                return Err(refused.because(RefusalKind::Repeated));
            }
        }
        spec.each_number_once(file)?;
        spec.check_held(file)?;
        if let Some((id, weight)) = spec.weights.iter().find(|(_, weight)| **weight <= 0.0) {
            return Err(Refusal::new(file, format!("weights.{id}"), *weight, "a number above 0"));
        }
        Ok(Self {
            file: file.to_owned(),
            document,
            settings: spec.settings(file)?,
            spec,
        })
    }

    /// A point in words: each name with its value.
    pub(super) fn point(&self, values: &[f64]) -> String {
        let each = self.spec.parameters.iter().zip(values);
        let words: Vec<String> = each.map(|(spec, value)| format!("{} {value:.6e}", spec.name)).collect();
        words.join(", ")
    }

    /// What steers the fit.
    pub(super) fn settings(&self) -> &Settings {
        &self.settings
    }

    /// The parameters with their starts, which are the bridge's own values.
    pub(super) fn starts(&self, bridge: &BridgeFile) -> Result<Vec<Parameter>, Refusal> {
        let document = to_value(&bridge.design);
        let starts = self.spec.parameters.iter().enumerate().map(|(i, parameter)| {
            let key = format!("parameters[{i}]");
            let start = self.start(&key, parameter, bridge, &document)?;
            if !(parameter.lower..=parameter.upper).contains(&start) {
                let found = FoundValue::from(start).which(format!("where {} starts", parameter.name));
                let allowed = format!(
                    "bounds that hold the start: {} to {} do not",
                    parameter.lower, parameter.upper
                );
                return Err(Refusal::new(&self.file, key, found, allowed));
            }
            Ok(Parameter {
                name: parameter.name.clone(),
                start,
                lower: parameter.lower,
                upper: parameter.upper,
            })
        });
        starts.collect()
    }

    fn start(
        &self,
        key: &str,
        parameter: &ParameterSpec,
        bridge: &BridgeFile,
        document: &Value,
    ) -> Result<f64, Refusal> {
        if let (Some(known), true) = (quantity(&bridge.design, &parameter.name), parameter.sets.is_empty()) {
            return Ok(known);
        }
        let mut known: Vec<String> = Vec::new();
        if let Value::Object(map) = document {
            map.iter().for_each(|(name, value)| leaves(name, value, &mut known));
        }
        if parameter.sets.is_empty() {
            known.extend(QUANTITIES.map(str::to_owned));
        }
        let number = |at: String, path: &str| {
            let value = DocumentPath::parse(path).and_then(|p| p.get(document).cloned());
            match value.as_ref().map(Value::as_f64) {
                Some(_) if value.as_ref().is_some_and(Value::is_u64) => {
                    let found = FoundValue::value(path).which("a whole number, which cannot move a little");
                    let allowed = "the path of a number that need not be whole";
                    Err(Refusal::new(&self.file, at, found, allowed))
                }
                Some(Some(number)) => Ok(number),
                Some(None) => {
                    let found = FoundValue::value(path).which("which is no number");
                    Err(Refusal::new(&self.file, at, found, "the path of a number"))
                }
                None => Err(Refusal {
                    allowed: "the path of a number of the bridge".to_owned(),
                    ..Refusal::unknown(&self.file, at, path, &known)
                }),
            }
        };
        if parameter.sets.is_empty() {
            return number(format!("{key}.name"), &parameter.name);
        }
        let mut start = None;
        for (path, factor) in &parameter.sets {
            let at = format!("{key}.sets.{path}");
            let own = number(at.clone(), path)? / factor;
            let first = *start.get_or_insert(own);
            if (own - first).abs() > 1e-9 * first.abs() {
                let found = format!("{} in the bridge, which makes {} {own}", own * factor, parameter.name);
                let allowed = format!("{}, as its other numbers make it", first * factor);
                return Err(Refusal::new(&self.file, at, found, allowed).because(RefusalKind::Conflict));
            }
        }
        Ok(start.unwrap_or(0.0))
    }
}
