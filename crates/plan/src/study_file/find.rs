//! What a rating searches: an axis, its bracket, and which values are tried.
//!
//! Knows values alone: which are tried depends on what is written and on which of them passed. Does not know crossings.

use crate::design::{Axis, AxisValues, NamedAxis};
use crate::input::{FoundValue, Refusal, RefusalKind};
use pontoon_core::input::{InvalidInput, Problem, bound, positive};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::path::Path;

/// The search of a rating: exactly one of `largest` and `smallest`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FindSpec {
    /// The axis whose largest value is sought at which all limits hold.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub largest: Option<String>,
    /// The axis whose smallest value is sought.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub smallest: Option<String>,
    /// From where to where values are tried.
    pub between: [f64; 2],
    /// Ratio of a value of the ladder to the one before, above 1; 1.02 where absent. The ladder of a bracket that begins at 0 or
    /// below has equal steps: the ratio less 1, times the bracket.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 1.0))]
    pub ladder_ratio: Option<f64>,
    /// How far the rated value may be from the first that fails, as a share of it, or of a bracket that begins at 0 or below;
    /// 0.002 where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(max = 0.5), extend("exclusiveMinimum" = 0.0))]
    pub relative_width: Option<f64>,
}

/// A search, checked.
#[derive(Debug, Clone, PartialEq)]
pub struct Find {
    /// The axis along which values are tried.
    pub axis: Axis,
    /// Whether its largest value is sought.
    pub is_largest: bool,
    between: [f64; 2],
    ladder_ratio: f64,
    relative_width: f64,
}

/// Values that a ladder may have.
const MOST_RUNGS: f64 = 2000.0;
/// Values tried at once between one that passes and one that fails.
const SECTIONS: usize = 15;

impl FindSpec {
    /// The search; `known` are names to suggest, `documents` the study's documents, `varied` the axes that its designs vary.
    pub(super) fn read(
        &self,
        file: &Path,
        known: &[String],
        documents: &Value,
        varied: &[&Axis],
    ) -> Result<Find, Refusal> {
        let (key, name, is_largest) = match (&self.largest, &self.smallest) {
            (Some(name), None) => ("find.largest", name, true),
            (None, Some(name)) => ("find.smallest", name, false),
            (both, _) => {
                let (found, kind) = match both {
                    Some(_) => ("both", RefusalKind::Misplaced),
                    None => ("neither", RefusalKind::Missing),
                };
                return Err(Refusal::new(file, "find", found, "either largest or smallest").because(kind));
            }
        };
        let axis = Axis::read(file, key, name, known)?;
        let at_path = documents.pointer(&format!("/{}", name.replace(['.', '['], "/").replace(']', "")));
        let is_number = match NamedAxis::of(name) {
            Some(named) => named.values == AxisValues::Numbers,
            None => at_path.is_none_or(|value| value.is_number() || value.is_null()),
        };
        if !is_number {
            let found = FoundValue::value(name.as_str()).which("which is no number");
            return Err(Refusal::new(file, key, found, "an axis of numbers").because(RefusalKind::WrongType));
        }
        if let Some(other) = varied.iter().find(|other| other.sets_what(name)) {
            let found =
                FoundValue::value(name.as_str()).which(format!("which the design's axis {} sets too", other.name));
            return Err(Refusal::new(file, key, found, "an axis that no design has").because(RefusalKind::Misplaced));
        }
        let checked = self.checked(axis, is_largest);
        checked.map_err(|e| Refusal::of(file, "find", e))
    }

    fn checked(&self, axis: Axis, is_largest: bool) -> Result<Find, InvalidInput> {
        let [from, to] = self.between;
        for (i, end) in self.between.into_iter().enumerate() {
            if !end.is_finite() {
                return Err(InvalidInput::new(format!("between[{i}]"), end, "a finite number"));
            }
        }
        if to <= from {
            return Err(InvalidInput::new("between[1]", to, format!("above {}", bound(from))));
        }
        let ladder_ratio = self.ladder_ratio.unwrap_or(1.02);
        if !(ladder_ratio.is_finite() && ladder_ratio > 1.0) {
            return Err(InvalidInput::new(
                "ladder_ratio",
                ladder_ratio,
                "a finite number above 1",
            ));
        }
        let relative_width = positive("relative_width", self.relative_width.unwrap_or(0.002))?;
        if relative_width > 0.5 {
            return Err(InvalidInput::new(
                "relative_width",
                relative_width,
                "above 0 and at most 0.5",
            ));
        }
        let find = Find {
            axis,
            is_largest,
            between: self.between,
            ladder_ratio,
            relative_width,
        };
        if find.rungs() > MOST_RUNGS {
            let found = format!("{ladder_ratio}, a ladder of {:.0} values", find.rungs());
            let refused = InvalidInput::new(
                "ladder_ratio",
                found,
                format!("a ladder of at most {MOST_RUNGS} values"),
            );
            return Err(refused.because(Problem::Conflict));
        }
        Ok(find)
    }
}

impl Find {
    fn is_geometric(&self) -> bool {
        self.between[0] > 0.0
    }

    fn rungs(&self) -> f64 {
        let [from, to] = self.between;
        if self.is_geometric() {
            ((to / from).ln() / self.ladder_ratio.ln()).ceil()
        } else {
            (1.0 / (self.ladder_ratio - 1.0)).ceil()
        }
    }

    /// The values of the ladder, from the end at which the limits are to hold: each times the ratio the one before, the last one
    /// the bracket's end.
    pub fn ladder(&self) -> Vec<f64> {
        let [from, to] = self.between;
        let mut values: Vec<f64> = (0..)
            .map(|i| {
                let i = f64::from(i);
                if self.is_geometric() {
                    from * self.ladder_ratio.powf(i)
                } else {
                    from + i * (self.ladder_ratio - 1.0) * (to - from)
                }
            })
            .take_while(|value| *value < to - 1e-9 * (to - from))
            .chain([to])
            .collect();
        if !self.is_largest {
            values.reverse();
        }
        values
    }

    /// Values to try between one that passes and the first that fails, from the one that passes; none where they are close
    /// enough.
    pub fn sections(&self, passes: f64, fails: f64) -> Vec<f64> {
        let (parts, geometric) = if self.is_geometric() {
            ((fails / passes).ln().abs() / (1.0 + self.relative_width).ln(), true)
        } else {
            let width = self.relative_width * (self.between[1] - self.between[0]);
            ((fails - passes).abs() / width, false)
        };
        // a hair more than a whole number of parts is rounding
        let parts = ((parts - 1e-6).ceil() as usize).clamp(1, SECTIONS + 1);
        let at = |i: usize| {
            let share = i as f64 / parts as f64;
            if geometric {
                passes * (fails / passes).powf(share)
            } else {
                passes + share * (fails - passes)
            }
        };
        (1..parts).map(at).collect()
    }

    /// The value as far behind one as that is behind another; none outside of the bracket.
    pub fn next(&self, before: f64, value: f64) -> Option<f64> {
        let next = if self.is_geometric() {
            value * (value / before)
        } else {
            value + (value - before)
        };
        Some(next).filter(|next| (self.between[0]..=self.between[1]).contains(next))
    }

    /// The bracket, its smaller end first.
    pub fn between(&self) -> [f64; 2] {
        self.between
    }

    /// The ends of the bracket, from the one at which the limits are to hold.
    pub fn ends(&self) -> [f64; 2] {
        let [from, to] = self.between;
        if self.is_largest { [from, to] } else { [to, from] }
    }

    /// Of two values the one farther from where the limits are to hold.
    pub fn is_beyond(&self, value: f64, other: f64) -> bool {
        if self.is_largest { value > other } else { value < other }
    }

    /// Everything that the values tried depend on.
    pub fn key(&self) -> String {
        let Self {
            axis,
            is_largest,
            between: [from, to],
            ladder_ratio,
            relative_width,
        } = self;
        format!("{};{is_largest};{from};{to};{ladder_ratio};{relative_width}", axis.name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::{JobAxis, Varies};

    fn find(between: [f64; 2], is_largest: bool) -> Find {
        Find {
            axis: Axis {
                name: "load_n".to_owned(),
                varies: Varies::Job(JobAxis::Load),
            },
            is_largest,
            between,
            ladder_ratio: 1.1,
            relative_width: 0.01,
        }
    }

    #[test]
    fn a_ladder_goes_from_end_to_end_by_its_ratio() {
        let ladder = find([100.0, 200.0], true).ladder();
        assert!(
            ladder[0] == 100.0 && ladder.last() == Some(&200.0) && ladder.len() == 9,
            "{ladder:?}"
        );
        assert!(
            ladder
                .windows(2)
                .take(7)
                .all(|pair| (pair[1] / pair[0] - 1.1).abs() < 1e-12)
        );
        let down = find([100.0, 200.0], false).ladder();
        assert!(down[0] == 200.0 && down.last() == Some(&100.0));
        let even = find([0.0, 0.03], true).ladder();
        assert!(even.len() == 11 && (even[1] - 0.003).abs() < 1e-15, "{even:?}");
        // a bracket whose end is a rung has it once
        let whole = find([100.0, 121.0], true).ladder();
        assert_eq!(whole.len(), 3, "{whole:?}");
    }

    #[test]
    fn sections_end_within_the_width() {
        for (of, passes, fails) in [
            (find([100.0, 200.0], true), 150.0, 165.0),
            (find([100.0, 200.0], false), 165.0, 150.0),
            (find([0.0, 2.0], true), 0.5, 1.0),
        ] {
            let (mut passes, mut fails, mut rounds) = (passes, fails, 0);
            loop {
                let values = of.sections(passes, fails);
                if values.is_empty() {
                    break;
                }
                assert!(values.len() <= SECTIONS);
                // fails from the middle on
                let middle = values.len() / 2;
                fails = values[middle];
                passes = if middle > 0 { values[middle - 1] } else { passes };
                rounds += 1;
            }
            let width = if of.is_geometric() {
                (fails - passes).abs() / passes
            } else {
                (fails - passes).abs() / 2.0
            };
            assert!(width <= 0.0101 && rounds <= 2, "{width} after {rounds}");
        }
    }
}
