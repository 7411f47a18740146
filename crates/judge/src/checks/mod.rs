//! Checks: what a reference says that results should be, a file for each kind.
//!
//! A kind is an entry in the list below and a file of its own, which holds its keys (and so its schema), what of it is refused by
//! the file alone, what of results it selects, how it is evaluated, and what it expects in words.
//!
//! Knows how a check is written. Does not know references or comparisons.

mod bound;
mod curve;
mod finding;
mod kind;
mod measured;
mod mode;
mod trend;
mod value;

pub use bound::BoundCheck;
pub use curve::CurveCheck;
pub(crate) use kind::CheckKind;
pub use kind::{CheckCurve, Expectation, OneValue};
pub use measured::MeasuredCheck;
pub use mode::ModeCheck;
pub use trend::{Trend, TrendCheck};
pub use value::ValueCheck;

use crate::quantity::{CheckInput, Place};
use pontoon_plan::input::filter::Filter;
use pontoon_plan::input::{Refusal, RefusalKind};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// What becomes of a check.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Role {
    /// It must hold.
    #[default]
    Hold,
    /// It is run and expected to fail; that it holds is told as a change.
    ExpectedFail,
    /// It is printed beside what is expected and never judged; but where nothing is found it falls short like any other.
    Record,
}

/// Makes the written and the resolved check of a list of kinds.
macro_rules! kinds {
    ($($(#[$text:meta])* $key:ident: $variant:ident($type:ty),)*) => {
        /// One check as its file writes it. Exactly one of the keys of its kinds says what is checked.
        #[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
        #[serde(deny_unknown_fields)]
        pub struct CheckSpec {
            /// Its id, unlike any other's.
            pub id: String,
            /// The statement it checks, as its source has it.
            #[serde(default, skip_serializing_if = "Option::is_none")]
            pub statement: Option<String>,
            /// How the statement is measured, and whatever else a reader should know.
            #[serde(default, skip_serializing_if = "Option::is_none")]
            pub note: Option<String>,
            /// What becomes of it.
            #[serde(default)]
            pub role: Role,
            /// Which rows all quantities of the check are taken from.
            #[serde(default, rename = "where", skip_serializing_if = "Filter::is_empty")]
            pub filter: Filter,
            /// Columns of the table of jobs: the check is made for each combination of their values, and the worst decides.
            #[serde(default, skip_serializing_if = "Vec::is_empty")]
            pub each: Vec<String>,
            $(
                $(#[$text])*
                #[serde(default, skip_serializing_if = "Option::is_none")]
                pub $key: Option<$type>,
            )*
        }

        /// The one kind of a check.
        #[derive(Debug, Clone, PartialEq)]
        pub enum Kind {
            $($(#[$text])* $variant($type),)*
        }

        impl Kind {
            /// The keys of the kinds.
            pub const NAMES: &'static [&'static str] = &[$(stringify!($key)),*];

            /// What the file says is checked.
            fn written(check: &CheckSpec) -> Vec<Self> {
                let kinds = [$(check.$key.clone().map(Self::$variant)),*];
                kinds.into_iter().flatten().collect()
            }

            /// What a check of the kind can do.
            pub(crate) fn of(&self) -> &dyn CheckKind {
                match self {
                    $(Self::$variant(check) => check,)*
                }
            }
        }
    };
}

kinds! {
    /// A quantity has a value.
    value: Value(ValueCheck),
    /// A quantity keeps within bounds.
    bound: Bound(BoundCheck),
    /// A quantity has a trend over an axis.
    trend: Trend(TrendCheck),
    /// A mode, by the name of its shape, has a frequency.
    mode: Mode(ModeCheck),
    /// A column runs along a curve.
    curve: Curve(CurveCheck),
    /// A quantity lies within the uncertainty of a measurement.
    measured: Measured(MeasuredCheck),
}

/// One check.
#[derive(Debug, Clone, PartialEq)]
pub struct Check {
    /// Its id, unlike any other's.
    pub id: String,
    /// The statement it checks, as its source has it.
    pub statement: Option<String>,
    /// How the statement is measured, and whatever else a reader should know.
    pub note: Option<String>,
    /// What becomes of it.
    pub role: Role,
    /// Which rows all its quantities are taken from.
    pub filter: Filter,
    /// Columns of the table of jobs: it is made for each combination of their values, and the worst decides.
    pub each: Vec<String>,
    /// What is checked.
    pub kind: Kind,
}

impl Check {
    /// A check as its file writes it, refused where it cannot be one whatever the results; `key` is its path.
    ///
    /// # Errors
    /// [`Refusal`].
    pub(crate) fn of(file: &Path, key: &str, written: &CheckSpec) -> Result<Self, Refusal> {
        let mut kinds = Kind::written(written);
        let one = kinds.pop().filter(|_| kinds.is_empty());
        let kind = one.ok_or_else(|| {
            let (found, problem) = match Kind::written(written).len() {
                0 => ("nothing to check".to_owned(), RefusalKind::Missing),
                count => (format!("{count} things to check"), RefusalKind::Misplaced),
            };
            let allowed = format!("exactly one of {}", Kind::NAMES.join(", "));
            Refusal::new(file, key, found, allowed).because(problem)
        })?;
        let check = Self {
            id: written.id.clone(),
            statement: written.statement.clone(),
            note: written.note.clone(),
            role: written.role,
            filter: written.filter.clone(),
            each: written.each.clone(),
            kind,
        };
        check.kind.of().refuse(&Place {
            file,
            key,
            each: &check.each,
            decides: check.role != Role::Record,
        })?;
        Ok(check)
    }

    /// Refuses what results cannot have: tables, columns, words, jobs.
    pub(crate) fn select(&self, input: &CheckInput<'_>) -> Result<(), Refusal> {
        input.check_each()?;
        self.kind.of().select(input)
    }

    /// The one value that it is of, what is expected of it and how far it may be off; none of another kind.
    pub fn one_value(&self) -> Option<OneValue> {
        self.kind.of().one_value().filter(|_| self.each.is_empty())
    }

    /// What it says that a chart can show.
    pub fn expectation(&self) -> Expectation<'_> {
        self.kind.of().expectation()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::{Value, json};

    fn read(written: Value) -> Result<Check, Refusal> {
        let written: CheckSpec = serde_json::from_value(written).unwrap();
        Check::of(Path::new("r.json"), "checks[0]", &written)
    }

    #[test]
    fn what_is_left_out_of_a_check_is_held_everywhere() {
        let written = json!({ "id": "a", "mode": { "shape": "heave", "expected_hz": 0.4, "relative_tolerance": 0.1 } });
        let check = read(written.clone()).unwrap();
        assert_eq!(
            (check.role, check.filter.is_empty(), check.each.len()),
            (Role::Hold, true, 0)
        );
        let spec: CheckSpec = serde_json::from_value(written.clone()).unwrap();
        let mut back = serde_json::to_value(&spec).unwrap();
        assert_eq!(back.as_object_mut().unwrap().shift_remove("role"), Some(json!("hold")));
        assert_eq!(back, written);
    }

    #[test]
    fn a_check_is_of_exactly_one_kind() {
        let mode = json!({ "shape": "heave", "expected_hz": 0.4, "relative_tolerance": 0.1 });
        let bound = json!({ "of": { "select": { "table": "jobs", "column": "steps" } }, "at_least": 1 });
        for (written, kind) in [
            (json!({ "id": "a" }), RefusalKind::Missing),
            (
                json!({ "id": "a", "mode": mode, "bound": bound }),
                RefusalKind::Misplaced,
            ),
        ] {
            let e = read(written).unwrap_err();
            assert_eq!((e.kind, e.path.as_str()), (kind, "checks[0]"), "{e}");
            assert!(e.allowed.ends_with(&Kind::NAMES.join(", ")), "{e}");
        }
    }

    #[test]
    fn what_is_expected_is_written_as_a_person_wrote_it() {
        let of = json!({ "select": { "table": "jobs", "column": "a" } });
        for (kind, what, text) in [
            (
                "value",
                json!({ "of": of, "expected": 0.141, "relative_tolerance": 0.02 }),
                "0.141 +- 2 %",
            ),
            (
                "value",
                json!({ "of": of, "expected": 74, "relative_tolerance": 0.1, "absolute_tolerance": 3 }),
                "74 +- 10 % or +- 3",
            ),
            (
                "measured",
                json!({ "of": of, "value": 2, "uncertainty": 0.5 }),
                "2 +- 0.5",
            ),
            ("bound", json!({ "of": of, "at_least": 1, "at_most": 2 }), ">= 1, <= 2"),
            (
                "trend",
                json!({ "of": of, "along": "x", "trend": "flat", "within": 0.05 }),
                "flat within 5 % over x",
            ),
            (
                "trend",
                json!({ "of": of, "along": "x", "trend": "negative" }),
                "negative over x",
            ),
            (
                "mode",
                json!({ "shape": "heave", "expected_hz": 0.36, "relative_tolerance": 0.01 }),
                "0.36 +- 1 %",
            ),
            (
                "curve",
                json!({ "table": "jobs", "column": "a", "against": "b", "points": [[0, 1]], "absolute_tolerance": 0.1 }),
                "curve of 1 points +- 0.1",
            ),
        ] {
            let check = read(json!({ "id": "a", kind: what })).unwrap();
            assert_eq!(check.kind.of().expected().0, text);
        }
    }
}
