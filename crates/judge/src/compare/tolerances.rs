//! How far new results may be from old ones, column by column.
//!
//! Knows the file of tolerances and what holds without one. Does not know results.

use crate::quantity::Tolerance;
use pontoon_plan::input::{Document, Refusal, RefusalKind, typed};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// A file of tolerances: one for all columns, others for single ones, as `table.column` or `column`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct TolerancesSpec {
    /// For every column that is not named; where absent 1e-6 of the value or of its column's largest, at least 1e-9.
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

/// Without a file: what rounding on another machine leaves after some thousand steps, as a share of the value or of the
/// largest magnitude in its column (a force that is nothing beside the others is rounding itself), and never less than a
/// billionth of the unit (a roll that symmetry makes 0, the energy's residual).
const DEFAULT_SHARE: f64 = 1e-6;

/// Least tolerance without a file, in the unit of the column; its reason stands at [`DEFAULT_SHARE`].
const DEFAULT_LEAST: f64 = 1e-9;

impl Tolerances {
    /// Reads a file of tolerances.
    ///
    /// # Errors
    /// [`Refusal`].
    pub fn open(file: &Path) -> Result<Self, Refusal> {
        let spec: TolerancesSpec = typed(file, "", &Document::read(file)?)?;
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
                let refused = Refusal::new(file, key, "no tolerance", allowed);
                return Err(refused.because(RefusalKind::Missing));
            }
        }
        Ok(Self {
            file: file.to_owned(),
            spec,
        })
    }

    /// Refuses names that are no columns of the results.
    pub(super) fn check(&self, known: &[String]) -> Result<(), Refusal> {
        let is_known = |name: &str| {
            known
                .iter()
                .any(|k| k == name || k.split_once('.').is_some_and(|(_, column)| column == name))
        };
        match self.spec.columns.keys().find(|name| !is_known(name)) {
            Some(name) => Err(Refusal::unknown_key(&self.file, format!("columns.{name}"), name, known)),
            None => Ok(()),
        }
    }

    /// The tolerance of a column whose largest magnitude is `largest`; none where it is not compared.
    pub(super) fn of(&self, table: &str, column: &str, largest: f64) -> Option<Tolerance> {
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
            None => Some(Tolerance {
                relative: Some(DEFAULT_SHARE),
                absolute: Some((DEFAULT_SHARE * largest).max(DEFAULT_LEAST)),
            }),
        }
    }
}
