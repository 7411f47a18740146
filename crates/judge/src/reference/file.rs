//! A reference opened: its file read, its checks made sure to be checks.
//!
//! Knows files, and the study that a reference belongs to. Does not know results: what they do not have is found when
//! they are compared.

use super::spec::{
    BoundCheck, CheckKind, CheckSpec, CurveCheck, Quantity, ReferenceSpec, Role, Tolerance, Trend, TrendCheck,
};
use pontoon_plan::input::{Refusal, read, typed};
use pontoon_plan::study_file::Study;
use std::path::{Path, PathBuf};

/// A reference file, read and checked.
#[derive(Debug, Clone, PartialEq)]
pub struct Reference {
    /// The file.
    pub file: PathBuf,
    /// What it holds.
    pub spec: ReferenceSpec,
}

impl Reference {
    /// Opens a reference: `path` is a reference file or the folder that holds `reference.json`.
    ///
    /// # Errors
    /// [`Refusal`].
    pub fn open(path: &Path) -> Result<Self, Refusal> {
        let file = if path.is_dir() {
            path.join("reference.json")
        } else {
            path.to_owned()
        };
        let spec: ReferenceSpec = typed(&file, "", &read(&file)?)?;
        let reference = Self { file, spec };
        reference.check()?;
        Ok(reference)
    }

    /// The path of the study it belongs to.
    pub fn study(&self) -> Option<PathBuf> {
        let folder = self.file.parent().unwrap_or(Path::new(""));
        self.spec.study.as_ref().map(|study| folder.join(study))
    }

    /// The study it belongs to, which has to be the one of a name; none where it holds any results. `place` is where that
    /// name stands.
    ///
    /// # Errors
    /// [`Refusal`] where the study is another, or cannot be opened.
    pub fn study_of(&self, name: &str, place: &Path) -> Result<Option<Study>, Refusal> {
        let Some(path) = self.study() else {
            return Ok(None);
        };
        let study = Study::open(&path)?;
        if study.spec.name == name {
            return Ok(Some(study));
        }
        let allowed = format!(
            "results of '{}', to which {} belongs",
            study.spec.name,
            self.file.display()
        );
        Err(Refusal::new(
            place,
            "",
            format!("results of the study '{name}'"),
            allowed,
        ))
    }

    fn check(&self) -> Result<(), Refusal> {
        if self.spec.checks.is_empty() {
            return Err(Refusal::new(
                &self.file,
                "checks",
                "an empty list",
                "at least one check",
            ));
        }
        for (i, check) in self.spec.checks.iter().enumerate() {
            let key = format!("checks[{i}]");
            let place = Place {
                file: &self.file,
                key: &key,
            };
            if check.id.trim().is_empty() {
                return Err(place.refuse("id", "an empty id", "a name unlike any other check's"));
            }
            if self.spec.checks[..i].iter().any(|other| other.id == check.id) {
                return Err(place.refuse("id", format!("'{}' twice", check.id), "each id once"));
            }
            place.check(check)?;
        }
        for (i, group) in self.spec.measured.iter().enumerate() {
            let refuse = |key: String, found: String, allowed: &str| {
                Refusal::new(&self.file, format!("measured[{i}].{key}"), found, allowed)
            };
            if group.id.trim().is_empty() {
                return Err(refuse(
                    "id".to_owned(),
                    "an empty id".to_owned(),
                    "a name unlike any other's",
                ));
            }
            if self.spec.measured[..i].iter().any(|other| other.id == group.id) {
                return Err(refuse("id".to_owned(), format!("'{}' twice", group.id), "each id once"));
            }
            group.check(&self.file, &format!("measured[{i}]"))?;
        }
        Ok(())
    }
}

/// A check's place in its file.
struct Place<'a> {
    file: &'a Path,
    key: &'a str,
}

impl Place<'_> {
    fn refuse(&self, key: &str, found: impl ToString, allowed: &str) -> Refusal {
        Refusal::new(self.file, format!("{}.{key}", self.key), found, allowed)
    }

    fn check(&self, check: &CheckSpec) -> Result<(), Refusal> {
        const KINDS: &str = "exactly one of value, bound, trend, mode, curve, measured";
        let kind = check.kind().ok_or_else(|| {
            let count = check.kinds().count();
            let found = if count == 0 {
                "nothing to check".to_owned()
            } else {
                format!("{count} things to check")
            };
            Refusal::new(self.file, self.key, found, KINDS)
        })?;
        let needed = check.role != Role::Record;
        match kind {
            CheckKind::Value(value) => {
                if needed && value.expected.is_none() {
                    return Err(self.refuse("value.expected", "nothing", "a number; only a record needs none"));
                }
                self.tolerance("value", value.tolerance(), needed)?;
                self.quantity("value.of", &value.of, check, None)
            }
            CheckKind::Mode(mode) => {
                if mode.expected_hz.is_nan() || mode.expected_hz <= 0.0 {
                    return Err(self.refuse("mode.expected_hz", mode.expected_hz, "a number above 0"));
                }
                self.tolerance("mode", mode.tolerance(), needed)
            }
            CheckKind::Bound(bound) => {
                self.bound(bound)?;
                self.quantity("bound.of", &bound.of, check, None)
            }
            CheckKind::Trend(trend) => {
                self.trend(trend)?;
                self.quantity("trend.of", &trend.of, check, Some(&trend.along))
            }
            CheckKind::Curve(curve) => self.curve(curve, needed),
            CheckKind::Measured(measured) => {
                if measured.uncertainty < 0.0 {
                    return Err(self.refuse("measured.uncertainty", measured.uncertainty, "a number of at least 0"));
                }
                self.quantity("measured.of", &measured.of, check, None)
            }
        }
    }

    /// A tolerance is there where it is needed and never negative.
    fn tolerance(&self, of: &str, tolerance: Tolerance, needed: bool) -> Result<(), Refusal> {
        for (key, value) in [
            ("relative_tolerance", tolerance.relative),
            ("absolute_tolerance", tolerance.absolute),
        ] {
            if let Some(value) = value.filter(|value| *value < 0.0) {
                return Err(self.refuse(&format!("{of}.{key}"), value, "a number of at least 0"));
            }
        }
        if needed && tolerance == Tolerance::default() {
            let allowed = "relative_tolerance or, where there is one, absolute_tolerance; only a record needs none";
            return Err(self.refuse(of, "no tolerance", allowed));
        }
        Ok(())
    }

    fn bound(&self, bound: &BoundCheck) -> Result<(), Refusal> {
        let (lower, upper) = (bound.lower(), bound.upper());
        match (lower, upper) {
            (None, None) => {
                return Err(self.refuse(
                    "bound",
                    "no bound",
                    "at_least, above, at_most, below, one or two of them",
                ));
            }
            (Some(least), Some(most)) if least > most => {
                let key = if bound.at_least.is_some() {
                    "bound.at_least"
                } else {
                    "bound.above"
                };
                return Err(self.refuse(key, least, &format!("at most the upper bound, {most}")));
            }
            _ => {}
        }
        for (first, second, names) in [
            (bound.at_least, bound.above, "at_least and above"),
            (bound.at_most, bound.below, "at_most and below"),
        ] {
            if first.is_some() && second.is_some() {
                return Err(self.refuse("bound", names, "one of the two"));
            }
        }
        Ok(())
    }

    fn trend(&self, trend: &TrendCheck) -> Result<(), Refusal> {
        match (trend.trend, trend.within) {
            (Trend::Flat, None) => {
                return Err(self.refuse("trend.within", "nothing", "a share: the trend is flat within it"));
            }
            (Trend::Flat, Some(within)) if within < 0.0 => {
                return Err(self.refuse("trend.within", within, "a number of at least 0"));
            }
            (Trend::Flat, Some(_)) | (_, None) => {}
            (_, Some(within)) => return Err(self.refuse("trend.within", within, "nothing, unless the trend is flat")),
        }
        Ok(())
    }

    fn curve(&self, curve: &CurveCheck, needed: bool) -> Result<(), Refusal> {
        self.tolerance("curve", curve.tolerance(), needed)?;
        if curve.points.is_empty() {
            return Err(self.refuse("curve.points", "an empty list", "at least one point"));
        }
        match (1..curve.points.len()).find(|&i| curve.points[i][0] <= curve.points[i - 1][0]) {
            Some(i) => {
                let allowed = format!("above {}", curve.points[i - 1][0]);
                Err(self.refuse(&format!("curve.points[{i}][0]"), curve.points[i][0], &allowed))
            }
            None => Ok(()),
        }
    }

    /// A quantity looks at results somewhere, and no part of it fixes a column that the check itself moves.
    fn quantity(&self, key: &str, quantity: &Quantity, check: &CheckSpec, along: Option<&str>) -> Result<(), Refusal> {
        self.part(key, quantity, check, along)?;
        if quantity.looks_at_results() {
            return Ok(());
        }
        Err(self.refuse(key, "numbers alone", "a select or a history somewhere in it"))
    }

    fn part(&self, key: &str, quantity: &Quantity, check: &CheckSpec, along: Option<&str>) -> Result<(), Refusal> {
        for (name, part) in quantity.parts() {
            self.part(&format!("{key}.{name}"), part, check, along)?;
        }
        let filter = match quantity {
            Quantity::Largest(list) | Quantity::Smallest(list) if list.is_empty() => {
                return Err(self.refuse(key, "an empty list", "at least one quantity"));
            }
            Quantity::History(history) => {
                if !["deflection_m", "force_n"].contains(&history.quantity.as_str()) {
                    let known = ["deflection_m", "force_n"].map(str::to_owned);
                    let key = format!("{}.{key}.history.quantity", self.key);
                    return Err(Refusal::unknown(self.file, key, &history.quantity, &known));
                }
                Some(("history", &history.filter))
            }
            Quantity::Select(select) => Some(("select", &select.filter)),
            _ => None,
        };
        let moved = |name: &str| check.each.iter().any(|c| c == name) || along == Some(name);
        match filter.and_then(|(of, filter)| Some((of, filter.0.iter().find(|(name, _)| moved(name))?))) {
            Some((of, (name, _))) => {
                let key = format!("{key}.{of}.where.{name}");
                Err(self.refuse(
                    &key,
                    "a column that the check itself moves",
                    "no column of each or along",
                ))
            }
            None => Ok(()),
        }
    }
}
