//! The file of a calibration: what may move, between which bounds, what is held, what is fitted.
//!
//! Knows its keys and that each names something of the bridge. Does not know references' checks or fits.

use super::fit::{Parameter, Settings};
use super::quantities::{FOLLOWS, QUANTITIES, quantity};
use pontoon_plan::input::{DocumentPath, Refusal, leaves, read, to_value, typed};
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
#[derive(Debug, Clone, PartialEq)]
pub struct Parameters {
    /// The file.
    pub file: PathBuf,
    /// Its document.
    pub document: Value,
    /// What it says.
    pub spec: ParametersSpec,
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
                    let found = format!("'{path}', which follows '{other}'");
                    return Err(Refusal::new(file, key, found, "numbers that nothing else moves"));
                }
                taken.push((path, &parameter.name));
            }
        }
        Ok(())
    }
}

impl Parameters {
    /// Reads a file of parameters.
    ///
    /// # Errors
    /// [`Refusal`].
    pub fn open(file: &Path) -> Result<Self, Refusal> {
        let document = read(file)?;
        let spec: ParametersSpec = typed(file, "", &document)?;
        let refuse = |key: String, found: String, allowed: &str| Err(Refusal::new(file, key, found, allowed));
        if spec.parameters.is_empty() {
            return refuse(
                "parameters".to_owned(),
                "an empty list".to_owned(),
                "at least one parameter",
            );
        }
        for (i, parameter) in spec.parameters.iter().enumerate() {
            let key = |name: &str| format!("parameters[{i}].{name}");
            if !(parameter.upper - parameter.lower).is_finite() {
                let found = format!("{}, too far from lower, {}", parameter.upper, parameter.lower);
                return refuse(key("upper"), found, "bounds whose distance is a number");
            }
            if parameter.lower >= parameter.upper {
                return refuse(
                    key("upper"),
                    parameter.upper.to_string(),
                    &format!("above lower, {}", parameter.lower),
                );
            }
            if spec.parameters[..i].iter().any(|other| other.name == parameter.name) {
                return refuse(key("name"), format!("'{}' twice", parameter.name), "each name once");
            }
            if let Some((path, factor)) = parameter.sets.iter().find(|(_, factor)| **factor == 0.0) {
                return refuse(
                    key(&format!("sets.{path}")),
                    factor.to_string(),
                    "a factor other than 0",
                );
            }
        }
        spec.each_number_once(file)?;
        let known = QUANTITIES.map(str::to_owned);
        for (name, value) in &spec.hold {
            let key = format!("hold.{name}");
            if !known.contains(name) {
                return Err(Refusal::unknown(file, key, name, &known));
            }
            if spec.parameters.iter().any(|p| p.name == *name) {
                return refuse(
                    key,
                    "a parameter of the same name".to_owned(),
                    "held or moved, not both",
                );
            }
            if *value <= 0.0 {
                return refuse(key, value.to_string(), "a number above 0");
            }
        }
        if let Some((id, weight)) = spec.weights.iter().find(|(_, weight)| **weight <= 0.0) {
            return refuse(format!("weights.{id}"), weight.to_string(), "a number above 0");
        }
        for (key, value, most) in [
            ("difference_share", spec.difference_share, 0.25),
            ("tolerance", spec.tolerance, 0.1),
        ] {
            if let Some(value) = value.filter(|v| !(*v > 1e-14 && *v <= most)) {
                return refuse(
                    key.to_owned(),
                    value.to_string(),
                    &format!("above 1e-14 and at most {most}"),
                );
            }
        }
        if spec.evaluations_limit == Some(0) {
            return refuse(
                "evaluations_limit".to_owned(),
                "0".to_owned(),
                "a whole number of at least 1",
            );
        }
        Ok(Self {
            file: file.to_owned(),
            document,
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
    pub(super) fn settings(&self) -> Settings {
        let default = Settings::default();
        Settings {
            evaluations_limit: self.spec.evaluations_limit.unwrap_or(300),
            difference_share: self.spec.difference_share.unwrap_or(0.005),
            tolerance: self.spec.tolerance.unwrap_or(1e-4),
            ..default
        }
    }

    /// The parameters with their starts, which are the bridge's own values.
    pub(super) fn starts(&self, bridge: &BridgeFile) -> Result<Vec<Parameter>, Refusal> {
        let document = to_value(&bridge.design);
        let starts = self.spec.parameters.iter().enumerate().map(|(i, parameter)| {
            let key = format!("parameters[{i}]");
            let start = self.start(&key, parameter, bridge, &document)?;
            if !(parameter.lower..=parameter.upper).contains(&start) {
                let found = format!("{start}, where {} starts", parameter.name);
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
                Some(_) if value.as_ref().is_some_and(Value::is_u64) => Err(Refusal::new(
                    &self.file,
                    at,
                    format!("'{path}', a whole number, which cannot move a little"),
                    "the path of a number that need not be whole",
                )),
                Some(Some(number)) => Ok(number),
                Some(None) => Err(Refusal::new(
                    &self.file,
                    at,
                    format!("'{path}', which is no number"),
                    "the path of a number",
                )),
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
                return Err(Refusal::new(
                    &self.file,
                    at,
                    found,
                    format!("{}, as its other numbers make it", first * factor),
                ));
            }
        }
        Ok(start.unwrap_or_default())
    }
}
