//! What a check asks for, held against what results have, before anything is evaluated.
//!
//! Knows tables, columns, words and jobs, and where in the reference each is named. Does not know values.

use super::spec::{HistoryQuantity, Quantity, SelectQuantity};
use pontoon_plan::design::{AxisValues, NamedAxis};
use pontoon_plan::input::filter::{Allowed, Filter};
use pontoon_plan::input::{Cell, FoundValue, Refusal, RefusalKind};
use pontoon_results::{CellKind, Column, ColumnKind, Results, Table, TableName};
use std::path::Path;

/// A check with the results that it is made on.
pub(crate) struct CheckInput<'a> {
    pub(crate) results: &'a Results,
    /// The reference's file.
    pub(crate) file: &'a Path,
    /// The check's path in it.
    pub(crate) key: String,
    /// Which rows the check's quantities are taken from.
    pub(crate) filter: &'a Filter,
    /// Columns that the check is made for each combination of.
    pub(crate) each: &'a [String],
}

impl<'a> CheckInput<'a> {
    /// Refuses columns that the check is made for each of and the table of jobs does not have.
    pub(crate) fn check_each(&self) -> Result<(), Refusal> {
        for (j, column) in self.each.iter().enumerate() {
            self.column(&format!("{}.each[{j}]", self.key), self.results.jobs(), column)?;
        }
        Ok(())
    }

    /// Refuses a quantity at a key of the check that asks for what the results cannot have.
    pub(crate) fn quantity(&self, key: &str, quantity: &Quantity) -> Result<(), Refusal> {
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

    /// The path of a key of the check.
    pub(crate) fn at(&self, key: &str) -> String {
        format!("{}.{key}", self.key)
    }

    /// A table, refused where the run left none.
    pub(crate) fn table(&self, key: &str, name: TableName) -> Result<&'a Table, Refusal> {
        self.results.table(name).ok_or_else(|| {
            let left: Vec<&str> = TableName::ALL
                .iter()
                .filter(|name| self.results.table(**name).is_some())
                .map(|name| name.word())
                .collect();
            let found = FoundValue::value(name.word()).which("which the results do not hold");
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
    pub(crate) fn number_column(&self, key: &str, table: &Table, column: &str) -> Result<(), Refusal> {
        self.column(key, table, column)?;
        if table.kind(column) == Some(ColumnKind::Words) {
            let found = FoundValue::value(column).which("a column of words");
            return Err(Refusal::new(self.file, key, found, "a column of numbers"));
        }
        Ok(())
    }

    /// Both filters of a quantity at a key, its own and, for columns that it does not name, the check's.
    pub(crate) fn filters(&self, key: &str, own: &Filter, table: Option<&Table>) -> Result<(), Refusal> {
        for (column, allowed) in &own.0 {
            self.allowed(&format!("{key}.where.{column}"), table, column, allowed)?;
        }
        let outer = self.filter.0.iter();
        for (column, allowed) in outer.filter(|(column, _)| own.of(column).is_none()) {
            self.allowed(&self.at(&format!("where.{column}")), table, column, allowed)?;
        }
        Ok(())
    }

    /// Refuses a key of a filter that is no column of a table or of the table of jobs, and values that it cannot hold.
    pub(crate) fn allowed(
        &self,
        key: &str,
        table: Option<&Table>,
        column: &str,
        allowed: &Allowed,
    ) -> Result<(), Refusal> {
        let jobs = self.results.jobs();
        let home = table.filter(|table| table.has(column)).unwrap_or(jobs);
        if !home.has(column) {
            let mut known: Vec<String> = Vec::new();
            for name in table.into_iter().chain([jobs]).flat_map(Table::names) {
                if !known.iter().any(|k| k == name) {
                    known.push(name.to_owned());
                }
            }
            return Err(Refusal::unknown_key(self.file, key, column, &known));
        }
        let kind = home.kind(column);
        if let Some((found, kind)) = kind.and_then(|kind| Some((stranger(allowed, kind)?, kind))) {
            let allowed = format!("{}, as the column '{column}' holds", kind.word());
            return Err(Refusal::new(self.file, key, found, allowed).because(RefusalKind::WrongType));
        }
        let words = vocabulary(column).map_or_else(|| home.words(column), <[&str]>::to_vec);
        if let Some(word) = allowed.words().find(|word| !words.is_empty() && !words.contains(word)) {
            let known: Vec<String> = words.iter().map(|&word| word.to_owned()).collect();
            return Err(Refusal::unknown(self.file, key, word, &known));
        }
        if column == "job" && !(0..jobs.rows()).any(|row| allowed.allows(&jobs.cell("job", row))) {
            let last = jobs.rows().saturating_sub(1);
            let found = match allowed.single() {
                Some(job) => FoundValue::value(job.value()).which("which is no job"),
                None => format!("no job {}", allowed.written()).into(),
            };
            return Err(Refusal::new(self.file, key, found, format!("0 to {last}")));
        }
        Ok(())
    }
}

/// The words that a column may hold whatever the results hold; none where it holds any.
fn vocabulary(column: &str) -> Option<&'static [&'static str]> {
    let axis = NamedAxis::of(column).map(|axis| axis.values);
    match (axis, Column::named(column).map(|column| column.cells)) {
        (Some(AxisValues::Words(words)), _) | (None, Some(CellKind::Words(words))) => Some(words),
        _ => None,
    }
}

/// What a filter names that a column of a kind cannot hold.
fn stranger(allowed: &Allowed, kind: ColumnKind) -> Option<FoundValue> {
    match allowed {
        Allowed::OneOf(values) => {
            let fits = |cell: &&Cell<'static>| match kind {
                ColumnKind::Numbers => cell.number().is_some(),
                ColumnKind::Words => cell.word().is_some(),
                ColumnKind::Flags => matches!(cell, Cell::Flag(_)),
            };
            let mut strange = values.iter().filter(|cell| !cell.is_nothing() && !fits(cell));
            strange.next().map(|cell| FoundValue::value(cell.value()))
        }
        Allowed::Range(..) if kind != ColumnKind::Numbers => Some("a range".into()),
        Allowed::Range(..) => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::{Value, json};

    #[test]
    fn strangers_are_values_of_another_kind_and_nothing_is_none() {
        let of = |written: Value, kind: ColumnKind| stranger(&serde_json::from_value(written).unwrap(), kind);
        for (written, kind, found) in [
            (json!([1, null, 2.5]), ColumnKind::Numbers, None),
            (json!([1, "x"]), ColumnKind::Numbers, Some(FoundValue::value("x"))),
            (json!(true), ColumnKind::Numbers, Some(FoundValue::value(true))),
            (json!({ "from": 1 }), ColumnKind::Numbers, None),
            (json!({ "from": 1 }), ColumnKind::Words, Some("a range".into())),
            (json!(["x", null]), ColumnKind::Words, None),
            (json!(1), ColumnKind::Words, Some(FoundValue::value(1))),
            (json!([true, null]), ColumnKind::Flags, None),
            (json!(1), ColumnKind::Flags, Some(FoundValue::value(1))),
            (json!({ "to": 1 }), ColumnKind::Flags, Some("a range".into())),
        ] {
            assert_eq!(of(written.clone(), kind), found, "{written} {kind:?}");
        }
    }
}
