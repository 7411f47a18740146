//! How a bridge's numbers were identified.
//!
//! Knows what a reader wants to know of a fit. Nothing is computed from it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How a bridge's numbers were identified, as the fit leaves it in the bridge file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Provenance {
    /// Program and version that made the fit.
    pub program: String,
    /// Name and blake3 hash of each document that went into it: the bridge it started from, parameters, references, studies.
    pub documents: Vec<ProvenanceDocument>,
    /// The parameters, whose names end in their units.
    pub parameters: Vec<ProvenanceParameter>,
    /// What was held while the parameters moved.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub held: Vec<ProvenanceHeld>,
    /// Checks that were fitted.
    pub checks: usize,
    /// Sum of the squares of `(found - expected) / tolerance` at the start.
    pub sum_of_squares_start: f64,
    /// The sum of squares at the end.
    pub sum_of_squares_best: f64,
    /// Why the fit ended.
    pub ending: String,
}

/// A document that went into a fit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ProvenanceDocument {
    /// What it is.
    pub role: String,
    /// Its name.
    pub name: String,
    /// Hash of its text on one line.
    pub blake3: String,
}

/// A parameter of a fit, in the unit that its name ends in.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ProvenanceParameter {
    /// Its name.
    pub name: String,
    /// Where it started.
    pub start: f64,
    /// What was found.
    pub found: f64,
    /// Standard error of what was found; absent where the data do not determine it or it lies at a bound.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub standard_error: Option<f64>,
    /// Least value allowed.
    pub lower: f64,
    /// Largest value allowed.
    pub upper: f64,
}

/// A quantity that was held, in the unit that its name ends in.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ProvenanceHeld {
    /// Its name.
    pub name: String,
    /// Its value.
    pub held: f64,
}
