//! Measured points of a reference: what an experiment left, to be drawn beside results.
//!
//! Knows which columns can be drawn against what, and what fixes the place of a measurement. Does not know results, and
//! judges nothing: a measurement that decides is a check.

use pontoon_plan::input::filter::Filter;
use pontoon_plan::input::{Cell, FoundValue, Refusal, RefusalKind};
use pontoon_results::{Column, TableName};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// Points that were measured on one curve. They are drawn as marks where results show the same; no check looks at them.
///
/// `where` fixes the place and the conditions of the measurement, a single value each: `position` of a table of positions
/// (unless the points run along `x_m`), `position` or joint number of a history, `joint` of a table of connectors, and any axes of
/// the study. Axes that it does not name may have any value.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MeasuredSpec {
    /// Its id, unlike any other measurement's; the legend's words.
    pub id: String,
    /// How it was measured, and whatever else a reader should know.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub note: Option<String>,
    /// What was measured.
    pub of: MeasuredOf,
    /// Against what it is drawn.
    pub against: Against,
    /// Where and under which conditions it was measured.
    #[serde(default, rename = "where", skip_serializing_if = "Filter::is_empty")]
    pub filter: Filter,
    /// Points `[against, of]`, each in the unit of its name.
    #[schemars(length(min = 1))]
    pub points: Vec<[f64; 2]>,
}

/// What was measured: a column of a table of results, with its unit and its sense.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MeasuredOf {
    /// The table: jobs, positions, connectors or histories.
    pub table: TableName,
    /// The column; of histories the quantity, `deflection_m` or `force_n`.
    pub column: String,
}

/// The axis across a chart.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum Against {
    /// Along the bridge `[m]`: a profile, of the table of positions.
    #[serde(rename = "x_m")]
    X,
    /// The vehicle's speed `[m/s]`, of the tables of jobs, positions and connectors.
    #[serde(rename = "speed_m_s")]
    Speed,
    /// Time `[s]`, of histories.
    #[serde(rename = "time_s")]
    Time,
}

impl Against {
    /// Its column.
    pub fn word(self) -> &'static str {
        match self {
            Self::X => "x_m",
            Self::Speed => "speed_m_s",
            Self::Time => "time_s",
        }
    }
}

/// The quantities whose histories figures draw.
const DRAWN_HISTORIES: [&str; 2] = ["deflection_m", "force_n"];

/// What of a table can be drawn: columns, of histories their quantities.
fn drawn(table: TableName) -> Vec<String> {
    match table {
        TableName::Histories => DRAWN_HISTORIES.map(str::to_owned).to_vec(),
        table => {
            let drawn = Column::of_table(table).filter(|column| column.drawn);
            drawn.map(|column| column.name.to_owned()).collect()
        }
    }
}

/// What the columns of a table may be drawn against.
fn against(table: TableName) -> &'static [Against] {
    match table {
        TableName::Jobs | TableName::Connectors => &[Against::Speed],
        TableName::Positions => &[Against::X, Against::Speed],
        TableName::Histories => &[Against::Time],
        TableName::Modes
        | TableName::Joints
        | TableName::Pins
        | TableName::Sections
        | TableName::Places
        | TableName::AtPeaks
        | TableName::Banks
        | TableName::Dead
        | TableName::Freeboards
        | TableName::Wheels
        | TableName::Bodies
        | TableName::Limits => &[],
    }
}

impl MeasuredSpec {
    /// The column of `where` that fixes the place; none where the points have their own or are the whole bridge's.
    pub fn place(&self) -> Option<&'static str> {
        match (self.of.table, self.against) {
            (TableName::Positions, Against::X) => None,
            (TableName::Positions | TableName::Histories, _) => Some("position"),
            (TableName::Connectors, _) => Some("joint"),
            _ => None,
        }
    }

    /// Refuses what cannot be drawn, whatever the results.
    pub(super) fn check(&self, file: &Path, key: &str) -> Result<(), Refusal> {
        let at = |part: &str| format!("{key}.{part}");
        let known = drawn(self.of.table);
        if known.is_empty() {
            let allowed = "jobs, positions, connectors, histories; a frequency is a check of kind mode";
            let found = FoundValue::value(self.of.table.word());
            return Err(Refusal::new(file, at("of.table"), found, allowed));
        }
        if !known.contains(&self.of.column) {
            return Err(Refusal::unknown(file, at("of.column"), &self.of.column, &known));
        }
        let axes = against(self.of.table);
        if !axes.contains(&self.against) {
            let words: Vec<&str> = axes.iter().map(|axis| axis.word()).collect();
            let allowed = format!("{} of the table of {}", words.join(" or "), self.of.table.word());
            let found = FoundValue::value(self.against.word());
            return Err(Refusal::new(file, at("against"), found, allowed).because(RefusalKind::Conflict));
        }
        self.check_where(file, key)?;
        if self.points.is_empty() {
            return Err(Refusal::new(file, at("points"), "an empty list", "at least one point"));
        }
        let bad = |point: &[f64; 2]| point.iter().position(|value| !value.is_finite());
        let first = self.points.iter().enumerate().find_map(|(i, p)| Some((i, bad(p)?)));
        match first {
            Some((i, j)) => {
                let key = at(&format!("points[{i}][{j}]"));
                Err(Refusal::new(file, key, self.points[i][j], "a finite number"))
            }
            None => Ok(()),
        }
    }

    fn check_where(&self, file: &Path, key: &str) -> Result<(), Refusal> {
        let place = self.place();
        for (name, allowed) in &self.filter.0 {
            let key = format!("{key}.where.{name}");
            if name == self.against.word() {
                let allowed = "no column that the points themselves run along";
                let refused = Refusal::new(file, key, "a column of the points", allowed);
                return Err(refused.because(RefusalKind::Misplaced));
            }
            if ["position", "joint"].contains(&name.as_str()) && place != Some(name) {
                let allowed = match place {
                    Some(place) => format!("{place}, as the table of {} has it", self.of.table.word()),
                    None => "none: the points have no one place".to_owned(),
                };
                let refused = Refusal::new(file, key, format!("a {name}"), allowed);
                return Err(refused.because(RefusalKind::Misplaced));
            }
            if allowed.single().is_none() {
                let found = allowed.written().to_string();
                let allowed = "a single value: a measurement has its own conditions";
                return Err(Refusal::new(file, key, found, allowed));
            }
        }
        let Some(place) = place else { return Ok(()) };
        let key = format!("{key}.where.{place}");
        let allowed = "a whole number from 1";
        match self.filter.of(place).map(|allowed| (allowed, allowed.single())) {
            None => Err(Refusal::new(file, key, FoundValue::NOTHING, allowed)),
            Some((_, Some(cell))) if is_place(cell) => Ok(()),
            Some((_, Some(cell))) => Err(Refusal::new(file, key, &cell.value(), allowed)),
            Some((several, None)) => Err(Refusal::new(file, key, several.written().to_string(), allowed)),
        }
    }
}

/// Whether a value is the number of a position or joint.
fn is_place(cell: &Cell<'_>) -> bool {
    let whole = |number: f64| number >= 1.0 && number.fract() == 0.0 && number <= f64::from(u32::MAX);
    cell.number().is_some_and(whole)
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::{Value, json};

    fn refused(written: Value) -> String {
        match pontoon_plan::input::typed_value::<MeasuredSpec>(Path::new("r.json"), "measured[0]", &written) {
            Err(error) => error.to_string(),
            Ok(spec) => match spec.check(Path::new("r.json"), "measured[0]") {
                Err(refusal) => refusal.to_string(),
                Ok(()) => "nothing".to_owned(),
            },
        }
    }

    fn profile() -> Value {
        json!({ "id": "a", "of": { "table": "positions", "column": "deflection_m" }, "against": "x_m",
            "where": { "connection": "nonlinear" }, "points": [[40.2, 0.21]] })
    }

    #[test]
    fn what_can_be_drawn_is_taken_and_written_as_it_was_read() {
        let history = json!({ "id": "b", "note": "n", "of": { "table": "histories", "column": "force_n" }, "against": "time_s",
            "where": { "position": 7, "speed_m_s": 6.09 }, "points": [[1.0, -2.0], [0.5, 3.0]] });
        let joint = json!({ "id": "c", "of": { "table": "connectors", "column": "peak_tension_n" }, "against": "speed_m_s",
            "where": { "joint": 7 }, "points": [[3.0, 1.0]] });
        for written in [profile(), history, joint] {
            assert_eq!(refused(written.clone()), "nothing", "{written}");
            let spec: MeasuredSpec = serde_json::from_value(written.clone()).unwrap();
            assert_eq!(serde_json::to_value(spec).unwrap(), written);
        }
    }

    #[test]
    fn what_cannot_be_drawn_is_refused_at_its_key() {
        for (key, value, expected) in [
            ("/of/table", json!("modes"), "measured[0].of.table"),
            ("/of/column", json!("deflection_cm"), "nearest known: deflection_m"),
            ("/of/column", json!("steps"), "measured[0].of.column"),
            ("/against", json!("time_s"), "measured[0].against"),
            ("/against", json!("x"), "measured[0].against: found unknown \"x\""),
            ("/where", json!({ "position": 7 }), "measured[0].where.position"),
            ("/where", json!({ "x_m": 7 }), "measured[0].where.x_m"),
            (
                "/where",
                json!({ "gap_tension_m": [0, 1] }),
                "measured[0].where.gap_tension_m",
            ),
            (
                "/where",
                json!({ "gap_tension_m": { "from": 0 } }),
                "measured[0].where.gap_tension_m",
            ),
            ("/points", json!([]), "measured[0].points"),
            (
                "/points",
                json!([[1.0]]),
                "measured[0].points[0]: found a list of length 1",
            ),
            ("/points", json!([[1.0, null]]), "measured[0].points[0][1]: found null"),
            ("/judge", json!(true), "measured[0].judge: found unknown key"),
        ] {
            let mut written = profile();
            if key == "/judge" {
                written["judge"] = value;
            } else {
                *written.pointer_mut(key).unwrap() = value;
            }
            let found = refused(written);
            assert!(found.contains(expected), "{key}: {found}");
        }
    }

    #[test]
    fn a_place_is_asked_for_where_the_points_have_none() {
        let against_speed = |filter: Value| {
            let mut written = profile();
            written["against"] = json!("speed_m_s");
            written["where"] = filter;
            refused(written)
        };
        assert_eq!(against_speed(json!({ "position": 7 })), "nothing");
        for bad in [
            json!({}),
            json!({ "position": 0 }),
            json!({ "position": 1.5 }),
            json!({ "position": "7" }),
        ] {
            let found = against_speed(bad);
            assert!(
                found.contains("measured[0].where.position") && found.contains("whole number"),
                "{found}"
            );
        }
        assert!(against_speed(json!({ "position": 7, "joint": 7 })).contains("where.joint"));
        assert!(against_speed(json!({ "position": 7, "speed_m_s": 3 })).contains("where.speed_m_s"));
    }
}
