//! What of a check is refused by its file alone.
//!
//! Knows where in the reference a check stands. Does not know results.

use super::spec::{HistoryQuantity, Quantity, Tolerance};
use pontoon_plan::input::{FoundValue, Refusal, RefusalKind};
use pontoon_results::QUANTITIES;
use std::path::Path;

/// A check's place in its file.
pub(crate) struct Place<'a> {
    pub(crate) file: &'a Path,
    /// The check's path.
    pub(crate) key: &'a str,
    /// Columns that the check is made for each combination of.
    pub(crate) each: &'a [String],
    /// Whether the check decides, so that it needs a tolerance.
    pub(crate) decides: bool,
}

impl Place<'_> {
    /// A refusal of a key of the check.
    pub(crate) fn refuse(&self, key: &str, found: impl Into<FoundValue>, allowed: &str) -> Refusal {
        Refusal::new(self.file, format!("{}.{key}", self.key), found, allowed)
    }

    /// Refuses a tolerance that is negative, and none where one is needed.
    pub(crate) fn tolerance(&self, of: &str, tolerance: Tolerance) -> Result<(), Refusal> {
        for (key, value) in [
            ("relative_tolerance", tolerance.relative),
            ("absolute_tolerance", tolerance.absolute),
        ] {
            if let Some(value) = value.filter(|value| *value < 0.0) {
                return Err(self.refuse(&format!("{of}.{key}"), value, "a number of at least 0"));
            }
        }
        if self.decides && tolerance == Tolerance::default() {
            let allowed = "relative_tolerance or, where there is one, absolute_tolerance; only a record needs none";
            return Err(self.refuse(of, "no tolerance", allowed).because(RefusalKind::Missing));
        }
        Ok(())
    }

    /// Refuses a quantity that looks at no results, or a part of which fixes a column that the check itself moves: one of
    /// `each` or the one that it runs along.
    pub(crate) fn quantity(&self, key: &str, quantity: &Quantity, along: Option<&str>) -> Result<(), Refusal> {
        self.part(key, quantity, along)?;
        if quantity.looks_at_results() {
            return Ok(());
        }
        Err(self.refuse(key, "numbers alone", "a select or a history somewhere in it"))
    }

    /// Refuses a history that is nowhere or at two places, and one of a pin that says not which.
    fn history_place(&self, key: &str, history: &HistoryQuantity) -> Result<(), Refusal> {
        let refuse = |part: &str, found: &str, allowed: &str, kind: RefusalKind| {
            let refused = self.refuse(&format!("{key}.history{part}"), found, allowed);
            Err(refused.because(kind))
        };
        match (history.position, history.x_m) {
            (None, None) => return refuse("", "no place", "position, or x_m of a place", RefusalKind::Missing),
            (Some(_), Some(_)) => {
                return refuse(".x_m", "a position beside it", "position or x_m", RefusalKind::Conflict);
            }
            _ => {}
        }
        match (history.quantity.starts_with("pin_"), history.y_m) {
            (true, None) => refuse("", "no y_m", "y_m, the place of the pin across", RefusalKind::Missing),
            (false, Some(_)) => refuse(".y_m", "a place across", "none but of pins", RefusalKind::Misplaced),
            _ => Ok(()),
        }
    }

    fn part(&self, key: &str, quantity: &Quantity, along: Option<&str>) -> Result<(), Refusal> {
        for (name, part) in quantity.parts() {
            self.part(&format!("{key}.{name}"), part, along)?;
        }
        let filter = match quantity {
            Quantity::Largest(list) | Quantity::Smallest(list) if list.is_empty() => {
                return Err(self.refuse(key, "an empty list", "at least one quantity"));
            }
            Quantity::History(history) => {
                if !QUANTITIES.contains(&history.quantity.as_str()) {
                    let known = QUANTITIES.map(str::to_owned);
                    let key = format!("{}.{key}.history.quantity", self.key);
                    return Err(Refusal::unknown(self.file, key, &history.quantity, &known));
                }
                self.history_place(key, history)?;
                Some(("history", &history.filter))
            }
            Quantity::Select(select) => Some(("select", &select.filter)),
            _ => None,
        };
        let moved = |name: &str| self.each.iter().any(|column| column == name) || along == Some(name);
        match filter.and_then(|(of, filter)| Some((of, filter.0.iter().find(|(name, _)| moved(name))?))) {
            Some((of, (name, _))) => {
                let key = format!("{key}.{of}.where.{name}");
                let refused = self.refuse(
                    &key,
                    "a column that the check itself moves",
                    "no column of each or along",
                );
                Err(refused.because(RefusalKind::Misplaced))
            }
            None => Ok(()),
        }
    }
}
