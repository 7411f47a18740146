//! Names of columns and values as heads and cells of a table for people.
//!
//! Knows which part of a name tells columns apart. Does not know what is in a table.

use pontoon_plan::input::Cell;
use pontoon_results::labels::{self, printable};

/// A column as its head names it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct ColumnHead {
    /// In words.
    pub name: String,
    /// Its unit, where it has one.
    pub unit: Option<&'static str>,
}

impl ColumnHead {
    /// Of a column or axis: `gap_tension_m` is "tension gap" in "m".
    pub(super) fn of(name: &str) -> Self {
        Self {
            name: printable(&labels::label(name)),
            unit: Some(labels::unit(name)).filter(|unit| !unit.is_empty()),
        }
    }

    /// With its unit in brackets.
    pub(super) fn united(&self) -> String {
        let name = &self.name;
        self.unit.map_or(name.clone(), |unit| format!("{name} [{unit}]"))
    }

    /// A value with its name and unit: "tension gap 0.028 m".
    pub(super) fn told(&self, value: &Cell<'_>) -> String {
        self.told_as(&axis(value))
    }

    /// A value that is written already, with its name and unit.
    pub(super) fn told_as(&self, value: &str) -> String {
        let unit = self.unit.map_or(String::new(), |unit| format!(" {unit}"));
        format!("{} {value}{unit}", self.name)
    }
}

/// Heads of axes: of a path its last part, where no other axis ends in the same.
pub(super) fn heads(names: &[String]) -> Vec<ColumnHead> {
    let last = |name: &str| name.rsplit('.').next().unwrap_or_default().to_owned();
    let short = |name: &String| {
        let alone = names.iter().filter(|other| last(other) == last(name)).count() == 1;
        ColumnHead::of(&if alone { last(name) } else { name.clone() })
    };
    names.iter().map(short).collect()
}

/// A value of an axis; nothing is a dash.
pub(crate) fn axis(value: &Cell<'_>) -> String {
    labels::listed("", value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn names_are_words_and_units() {
        let head = |name: &str| (ColumnHead::of(name).name, ColumnHead::of(name).unit);
        assert_eq!(head("gap_tension_m"), ("tension gap".to_owned(), Some("m")));
        assert_eq!(head("speed_m_s"), ("speed".to_owned(), Some("m/s")));
        assert_eq!(head("hydrostatic_stiffness_pa_m").1, Some("Pa/m"));
        assert_eq!(head("connection"), ("connection".to_owned(), None));
        assert_eq!(head("y_m[0]"), ("y m[0]".to_owned(), None));
        let names = ["bridge.a.depth_m", "bridge.b.depth_m", "bridge.b.width_m"].map(str::to_owned);
        let heads: Vec<String> = heads(&names).into_iter().map(|head| head.name).collect();
        assert_eq!(heads, ["a depth", "b depth", "width"]);
    }

    #[test]
    fn values_have_no_more_digits_than_say_something() {
        let texts = [
            json!(3.0),
            json!(0.0055),
            json!(230_300),
            json!(1.0 / 3.0),
            json!(-0.0),
            json!(2e11),
            json!(null),
        ];
        assert_eq!(
            texts.map(|v| axis(&Cell::of(&v))),
            ["3", "0.0055", "230300", "0.333333", "0", "2e11", "-"]
        );
        assert_eq!(axis(&Cell::of(&json!([-1.4, 1.4]))), "[-1.4,1.4]");
        assert_eq!(axis(&Cell::of(&json!("a\nb"))), "a b");
    }
}
