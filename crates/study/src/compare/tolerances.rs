//! How far new results may be from old ones, column by column.
//!
//! Knows the file of tolerances and what holds without one. Does not know results.

use crate::document::{read, typed};
use crate::reference::Tolerance;
use crate::refusal::Refusal;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// A file of tolerances: one for all columns, others for single ones, as `table.column` or `column`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct TolerancesSpec {
    /// For every column that is not named; `relative_tolerance` 1e-6 where absent.
    #[serde(default)]
    default: Option<ColumnTolerance>,
    /// For single columns.
    #[serde(default)]
    columns: BTreeMap<String, ColumnTolerance>,
}

/// How far a column may be off.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct ColumnTolerance {
    /// As a share of the old value.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    relative_tolerance: Option<f64>,
    /// In the column's unit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    absolute_tolerance: Option<f64>,
    /// Whether the column is not compared at all.
    #[serde(default)]
    ignore: bool,
}

/// Tolerances of a comparison with older results.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Tolerances {
    file: PathBuf,
    spec: TolerancesSpec,
}

/// Without a file: what rounding in another order of summation leaves of a peak after some thousand steps.
const DEFAULT: Tolerance = Tolerance {
    relative: Some(1e-6),
    absolute: None,
};

/// Without a file: what the energy balance may be off, which is rounding itself.
const DEFAULT_ENERGY: Tolerance = Tolerance {
    relative: Some(1e-6),
    absolute: Some(1e-9),
};

impl Tolerances {
    /// Reads a file of tolerances.
    ///
    /// # Errors
    /// [`Refusal`].
    pub fn open(file: &Path) -> Result<Self, Refusal> {
        let spec: TolerancesSpec = typed(file, "", &read(file)?)?;
        let named = spec
            .columns
            .iter()
            .map(|(name, tolerance)| (format!("columns.{name}"), tolerance));
        let all = spec
            .default
            .iter()
            .map(|tolerance| ("default".to_owned(), tolerance))
            .chain(named);
        for (key, tolerance) in all {
            for (name, value) in [
                ("relative_tolerance", tolerance.relative_tolerance),
                ("absolute_tolerance", tolerance.absolute_tolerance),
            ] {
                if let Some(value) = value.filter(|value| *value < 0.0) {
                    return Err(Refusal::new(
                        file,
                        format!("{key}.{name}"),
                        value,
                        "a number of at least 0",
                    ));
                }
            }
            if !tolerance.ignore && tolerance.relative_tolerance.is_none() && tolerance.absolute_tolerance.is_none() {
                let allowed = "relative_tolerance, absolute_tolerance or ignore";
                return Err(Refusal::new(file, key, "no tolerance", allowed));
            }
        }
        Ok(Self {
            file: file.to_owned(),
            spec,
        })
    }

    /// Refuses names that are no columns of the results.
    pub(super) fn check(&self, known: &[String]) -> Result<(), Refusal> {
        let is_known = |name: &str| known.iter().any(|k| k == name || k.split('.').nth(1) == Some(name));
        match self.spec.columns.keys().find(|name| !is_known(name)) {
            Some(name) => Err(Refusal::unknown(&self.file, format!("columns.{name}"), name, known)),
            None => Ok(()),
        }
    }

    /// The tolerance of a column; none where it is not compared.
    pub(super) fn of(&self, table: &str, column: &str) -> Option<Tolerance> {
        let named = self
            .spec
            .columns
            .get(&format!("{table}.{column}"))
            .or_else(|| self.spec.columns.get(column));
        let own = |t: &ColumnTolerance| Tolerance {
            relative: t.relative_tolerance,
            absolute: t.absolute_tolerance,
        };
        match named.or(self.spec.default.as_ref()) {
            Some(tolerance) if tolerance.ignore => None,
            Some(tolerance) => Some(own(tolerance)),
            None if ["energy_residual", "numerical_dissipation"].contains(&column) => Some(DEFAULT_ENERGY),
            None => Some(DEFAULT),
        }
    }
}
