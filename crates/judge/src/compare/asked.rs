//! What a check asks for, held against what results have, before anything is evaluated.
//!
//! Knows tables, columns, words and jobs, and where in the reference each is named. Does not know values.

use crate::reference::{
    Allowed, CheckKind, CheckSpec, CurveCheck, Filter, HistoryQuantity, ModeCheck, Quantity, SelectQuantity, TrendCheck,
};
use pontoon_plan::input::Refusal;
use pontoon_results::{Kind, Results, Table, TableName};
use serde_json::Value;
use std::path::Path;

/// Words that a column may hold whatever the results hold.
const VOCABULARY: [(&str, [&str; 2]); 3] = [
    ("connection", ["linear", "nonlinear"]),
    ("status", ["ok", "failed"]),
    ("quantity", ["deflection_m", "force_n"]),
];

/// A check with the results that it is made on.
pub(super) struct Asked<'a> {
    pub(super) results: &'a Results,
    /// The reference's file.
    pub(super) file: &'a Path,
    /// The check's path in it.
    pub(super) key: String,
    pub(super) check: &'a CheckSpec,
}

impl<'a> Asked<'a> {
    /// Refuses what the results cannot have: tables, columns, words, jobs.
    pub(super) fn check(&self) -> Result<(), Refusal> {
        for (j, column) in self.check.each.iter().enumerate() {
            self.column(&format!("{}.each[{j}]", self.key), self.results.jobs(), column)?;
        }
        match self.check.kind() {
            Some(CheckKind::Value(v)) => self.quantity("value.of", &v.of),
            Some(CheckKind::Measured(m)) => self.quantity("measured.of", &m.of),
            Some(CheckKind::Bound(b)) => self.quantity("bound.of", &b.of),
            Some(CheckKind::Trend(t)) => self.trend(t),
            Some(CheckKind::Mode(m)) => self.mode(m),
            Some(CheckKind::Curve(c)) => self.curve(c),
            None => Ok(()),
        }
    }

    fn trend(&self, trend: &TrendCheck) -> Result<(), Refusal> {
        self.number_column(&self.at("trend.along"), self.results.jobs(), &trend.along)?;
        self.quantity("trend.of", &trend.of)
    }

    fn mode(&self, mode: &ModeCheck) -> Result<(), Refusal> {
        let modes = self.table(&self.at("mode"), TableName::Modes)?;
        let shape = Allowed::OneOf(vec![Value::from(mode.shape.clone())]);
        self.allowed(&self.at("mode.shape"), Some(modes), "shape", &shape)?;
        self.filters(&self.at("mode"), &Filter::default(), Some(modes))
    }

    fn curve(&self, curve: &CurveCheck) -> Result<(), Refusal> {
        let table = self.table(&self.at("curve.table"), curve.table)?;
        self.number_column(&self.at("curve.column"), table, &curve.column)?;
        self.number_column(&self.at("curve.against"), table, &curve.against)?;
        self.filters(&self.at("curve"), &Filter::default(), Some(table))
    }

    fn quantity(&self, key: &str, quantity: &Quantity) -> Result<(), Refusal> {
        match quantity {
            Quantity::Select(select) => self.select(&self.at(&format!("{key}.select")), select),
            Quantity::History(history) => self.history(&self.at(&format!("{key}.history")), history),
            several => {
                let mut parts = several.parts().into_iter();
                parts.try_for_each(|(place, part)| self.quantity(&format!("{key}.{place}"), part))
            }
        }
    }

    fn select(&self, key: &str, select: &SelectQuantity) -> Result<(), Refusal> {
        let table = self.table(&format!("{key}.table"), select.table)?;
        self.number_column(&format!("{key}.column"), table, &select.column)?;
        self.filters(key, &select.filter, Some(table))
    }

    fn history(&self, key: &str, history: &HistoryQuantity) -> Result<(), Refusal> {
        self.table(key, TableName::Histories)?;
        self.filters(key, &history.filter, None)
    }

    fn at(&self, key: &str) -> String {
        format!("{}.{key}", self.key)
    }

    /// A table, refused where the run left none.
    fn table(&self, key: &str, name: TableName) -> Result<&'a Table, Refusal> {
        self.results.table(name).ok_or_else(|| {
            let left: Vec<&str> = TableName::ALL
                .iter()
                .filter(|name| self.results.table(**name).is_some())
                .map(|name| name.word())
                .collect();
            let found = format!("'{}', which the results do not hold", name.word());
            Refusal::new(self.file, key, found, left.join(", "))
        })
    }

    fn column(&self, key: &str, table: &Table, column: &str) -> Result<(), Refusal> {
        if table.has(column) {
            return Ok(());
        }
        let known: Vec<String> = table.names().map(str::to_owned).collect();
        Err(Refusal::unknown(self.file, key, column, &known))
    }

    /// Refuses a column that a table does not have, or that holds words.
    fn number_column(&self, key: &str, table: &Table, column: &str) -> Result<(), Refusal> {
        self.column(key, table, column)?;
        if table.kind(column) == Some(Kind::Words) {
            let found = format!("'{column}', a column of words");
            return Err(Refusal::new(self.file, key, found, "a column of numbers"));
        }
        Ok(())
    }

    /// Both filters of a quantity at a key, its own and, for columns that it does not name, the check's.
    fn filters(&self, key: &str, own: &Filter, table: Option<&Table>) -> Result<(), Refusal> {
        for (column, allowed) in &own.0 {
            self.allowed(&format!("{key}.where.{column}"), table, column, allowed)?;
        }
        let outer = self.check.filter.0.iter();
        for (column, allowed) in outer.filter(|(column, _)| own.of(column).is_none()) {
            self.allowed(&self.at(&format!("where.{column}")), table, column, allowed)?;
        }
        Ok(())
    }

    /// Refuses a key of a filter that is no column of a table or of the table of jobs, and values that it cannot hold.
    fn allowed(&self, key: &str, table: Option<&Table>, column: &str, allowed: &Allowed) -> Result<(), Refusal> {
        let jobs = self.results.jobs();
        let home = table.filter(|table| table.has(column)).unwrap_or(jobs);
        if !home.has(column) {
            let mut known: Vec<String> = Vec::new();
            for name in table.into_iter().chain([jobs]).flat_map(Table::names) {
                if !known.iter().any(|k| k == name) {
                    known.push(name.to_owned());
                }
            }
            return Err(Refusal::unknown(self.file, key, column, &known));
        }
        let kind = home.kind(column);
        if let Some((found, kind)) = kind.and_then(|kind| Some((stranger(allowed, kind)?, kind))) {
            let allowed = format!("{}, as the column '{column}' holds", kind.word());
            return Err(Refusal::new(self.file, key, found, allowed));
        }
        let fixed = VOCABULARY.iter().find(|(name, _)| *name == column);
        let words = fixed.map_or_else(|| home.words(column), |(_, words)| words.to_vec());
        if let Some(word) = allowed.words().find(|word| !words.is_empty() && !words.contains(word)) {
            let known: Vec<String> = words.iter().map(|&word| word.to_owned()).collect();
            return Err(Refusal::unknown(self.file, key, word, &known));
        }
        if column == "job" && !(0..jobs.rows()).any(|row| allowed.allows(&jobs.cell("job", row))) {
            let found = format!("no job {}", allowed.written());
            let last = jobs.rows().saturating_sub(1);
            return Err(Refusal::new(self.file, key, found, format!("0 to {last}")));
        }
        Ok(())
    }
}

/// What a filter names that a column of a kind cannot hold.
fn stranger(allowed: &Allowed, kind: Kind) -> Option<String> {
    match allowed {
        Allowed::OneOf(values) => {
            let fits = |value: &&Value| match kind {
                Kind::Numbers => value.is_number(),
                Kind::Words => value.is_string(),
                Kind::Flags => value.is_boolean(),
            };
            let mut strange = values.iter().filter(|value| !value.is_null() && !fits(value));
            strange.next().map(Value::to_string)
        }
        Allowed::Range(..) if kind != Kind::Numbers => Some("a range".to_owned()),
        Allowed::Range(..) => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn strangers_are_values_of_another_kind_and_nothing_is_none() {
        let of = |written: Value, kind: Kind| stranger(&serde_json::from_value(written).unwrap(), kind);
        for (written, kind, found) in [
            (json!([1, null, 2.5]), Kind::Numbers, None),
            (json!([1, "x"]), Kind::Numbers, Some("\"x\"")),
            (json!(true), Kind::Numbers, Some("true")),
            (json!({ "from": 1 }), Kind::Numbers, None),
            (json!({ "from": 1 }), Kind::Words, Some("a range")),
            (json!(["x", null]), Kind::Words, None),
            (json!(1), Kind::Words, Some("1")),
            (json!([true, null]), Kind::Flags, None),
            (json!(1), Kind::Flags, Some("1")),
            (json!({ "to": 1 }), Kind::Flags, Some("a range")),
        ] {
            assert_eq!(of(written.clone(), kind).as_deref(), found, "{written} {kind:?}");
        }
    }
}
