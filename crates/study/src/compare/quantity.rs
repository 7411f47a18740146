//! A quantity of a reference evaluated on results.
//!
//! Knows rows, filters and what is made of them. Does not know what a quantity should be.

use super::history::{History, Moments, moments_of};
use crate::reference::{Filter, HistoryQuantity, Quantity, Reduction, SelectQuantity};
use crate::refusal::Refusal;
use crate::tables::{Results, Table, TableName};
use serde_json::Value;
use std::cell::{OnceCell, RefCell};
use std::collections::{BTreeSet, HashMap};
use std::path::Path;

/// Why a quantity has no value.
#[derive(Debug)]
pub(crate) enum Trouble {
    /// The reference is wrong.
    Refused(Refusal),
    /// The results do not give it.
    Short(String),
}

impl From<Refusal> for Trouble {
    fn from(refusal: Refusal) -> Self {
        Self::Refused(refusal)
    }
}

fn short<T>(reason: impl Into<String>) -> Result<T, Trouble> {
    Err(Trouble::Short(reason.into()))
}

/// Words that a column may hold whatever the results hold.
const VOCABULARY: [(&str, [&str; 2]); 3] = [
    ("connection", ["linear", "nonlinear"]),
    ("status", ["ok", "failed"]),
    ("quantity", ["deflection_m", "force_n"]),
];

/// Evaluates quantities of one reference on results.
pub(super) struct Evaluator<'a> {
    pub(super) results: &'a Results,
    pub(super) file: &'a Path,
    /// Rows of each history, by job, quantity and position.
    histories: OnceCell<HashMap<(u64, String, u64), Vec<usize>>>,
    /// What is to be said of the quantities evaluated since the last look.
    notes: RefCell<BTreeSet<String>>,
}

impl<'a> Evaluator<'a> {
    pub(super) fn new(results: &'a Results, file: &'a Path) -> Self {
        Self {
            results,
            file,
            histories: OnceCell::new(),
            notes: RefCell::default(),
        }
    }

    /// What is to be said of the quantities evaluated since the last call.
    pub(super) fn take_notes(&self) -> Vec<String> {
        std::mem::take(&mut *self.notes.borrow_mut()).into_iter().collect()
    }

    fn note(&self, text: String) {
        self.notes.borrow_mut().insert(text);
    }

    /// The value of a quantity; `filter` holds for all its parts unless they say otherwise.
    pub(super) fn value(&self, key: &str, quantity: &Quantity, filter: &Filter) -> Result<f64, Trouble> {
        let value = match quantity {
            Quantity::Number(number) => *number,
            Quantity::Select(select) => self.select(&format!("{key}.select"), select, filter)?,
            Quantity::History(history) => self.history(&format!("{key}.history"), history, filter)?,
            Quantity::Ratio(_) | Quantity::Difference(_) | Quantity::Largest(_) | Quantity::Smallest(_) => {
                let parts = quantity.parts().into_iter();
                let values = parts.map(|(place, part)| self.value(&format!("{key}.{place}"), part, filter));
                combined(quantity, &values.collect::<Result<Vec<f64>, Trouble>>()?)
            }
        };
        if value.is_finite() {
            Ok(value)
        } else {
            short(format!("not a finite number: {value}"))
        }
    }

    /// A table, refused where the run left none.
    pub(super) fn table(&self, key: &str, name: TableName) -> Result<&'a Table, Refusal> {
        self.results.table(name).ok_or_else(|| {
            let left: Vec<&str> = TableName::ALL
                .iter()
                .filter(|name| self.results.table(**name).is_some())
                .map(|name| name.word())
                .collect();
            let found = format!("'{}', which the results do not hold", name.word());
            Refusal::new(self.file, format!("{key}.table"), found, left.join(", "))
        })
    }

    fn select(&self, key: &str, select: &SelectQuantity, outer: &Filter) -> Result<f64, Trouble> {
        let table = self.table(key, select.table)?;
        self.number_column(&format!("{key}.column"), table, &select.column)?;
        let (rows, failed) = self.rows(&format!("{key}.where"), select.table, &select.filter, outer)?;
        let values: Vec<f64> = rows
            .iter()
            .filter_map(|&row| table.number(&select.column, row))
            .collect();
        if select.reduce == Reduction::Count {
            return Ok(values.len() as f64);
        }
        if values.is_empty() {
            let column = &select.column;
            return short(format!("{column} empty in all {} rows that match", rows.len()));
        }
        if select.reduce == Reduction::Only {
            return match values.as_slice() {
                [value] if rows.len() == 1 => Ok(*value),
                _ => short(format!("{} rows match where one is meant", rows.len())),
            };
        }
        if failed > 0 {
            return short(format!("{failed} failed jobs among those that match"));
        }
        if values.len() < rows.len() {
            self.note(format!(
                "{} empty in {} of {} rows",
                select.column,
                rows.len() - values.len(),
                rows.len()
            ));
        }
        Ok(match select.reduce {
            Reduction::Max => values.into_iter().fold(f64::NEG_INFINITY, f64::max),
            Reduction::Min => values.into_iter().fold(f64::INFINITY, f64::min),
            Reduction::Mean | Reduction::Only | Reduction::Count => values.iter().sum::<f64>() / values.len() as f64,
        })
    }

    /// Refuses a column that a table does not have, or that holds words.
    pub(super) fn number_column(&self, key: &str, table: &Table, column: &str) -> Result<(), Refusal> {
        if !table.has(column) {
            let known: Vec<String> = table.names().map(str::to_owned).collect();
            return Err(Refusal::unknown(self.file, key, column, &known));
        }
        if table.words(column).is_empty() {
            Ok(())
        } else {
            Err(Refusal::new(
                self.file,
                key,
                format!("'{column}', a column of words"),
                "a column of numbers",
            ))
        }
    }

    /// The rows of the table of jobs that a filter means, failed ones among them; keys that are no columns of jobs are
    /// passed over.
    pub(super) fn jobs(&self, filter: &Filter) -> Vec<usize> {
        let jobs = self.results.jobs();
        let means = |row: &usize| {
            let of_jobs = filter.0.iter().filter(|(name, _)| jobs.has(name));
            of_jobs
                .map(|(name, allowed)| allowed.allows(&jobs.cell(name, *row)))
                .all(|meant| meant)
        };
        (0..jobs.rows()).filter(means).collect()
    }

    /// Refuses keys of a filter that are no columns, and words and jobs that there are none of.
    pub(super) fn check_filter(&self, key: &str, filter: &Filter, table: Option<&Table>) -> Result<(), Refusal> {
        let jobs = self.results.jobs();
        for (name, allowed) in &filter.0 {
            let at = format!("{key}.{name}");
            let home = table.filter(|table| table.has(name)).unwrap_or(jobs);
            if !home.has(name) {
                let mut known: Vec<String> = table
                    .map(|t| t.names().map(str::to_owned).collect())
                    .unwrap_or_default();
                known.extend(jobs.names().map(str::to_owned));
                return Err(Refusal::unknown(self.file, at, name, &known));
            }
            let fixed = VOCABULARY.iter().find(|(column, _)| column == name);
            let words = fixed.map_or_else(|| home.words(name), |(_, words)| words.to_vec());
            if let Some(word) = allowed.words().find(|word| !words.is_empty() && !words.contains(word)) {
                let known: Vec<String> = words.iter().map(|&word| word.to_owned()).collect();
                return Err(Refusal::unknown(self.file, at, word, &known));
            }
            if name == "job" && !(0..jobs.rows()).any(|row| allowed.allows(&jobs.cell("job", row))) {
                let found = serde_json::to_value(filter).unwrap_or_default()["job"].to_string();
                let last = jobs.rows().saturating_sub(1);
                return Err(Refusal::new(
                    self.file,
                    at,
                    format!("no job {found}"),
                    format!("0 to {last}"),
                ));
            }
        }
        Ok(())
    }

    /// The rows of a table that two filters mean, the inner before the outer, those of failed jobs left out; and how many
    /// jobs failed of those that match. What the outer says of other tables is passed over.
    pub(super) fn rows(
        &self,
        key: &str,
        name: TableName,
        inner: &Filter,
        outer: &Filter,
    ) -> Result<(Vec<usize>, usize), Trouble> {
        let table = self.table(key.trim_end_matches(".where"), name)?;
        self.check_filter(key, inner, Some(table))?;
        let filter = inner.within(outer);
        let in_jobs = |column: &str| name == TableName::Jobs || !table.has(column) || column == "job";
        let of_jobs = filter.0.iter().filter(|(column, _)| in_jobs(column));
        let (whole, failed) = self.whole_jobs(&Filter(of_jobs.cloned().collect()))?;
        if name == TableName::Jobs {
            return Ok((whole, failed));
        }
        let own: Vec<_> = filter.0.iter().filter(|(column, _)| table.has(column)).collect();
        let meant: BTreeSet<usize> = whole.into_iter().collect();
        let job_row = |row| {
            let job = table.number("job", row)?;
            self.results.row_of_job(job as u64).filter(|job| meant.contains(job))
        };
        let mut without = meant.clone();
        let mut rows = Vec::new();
        for row in 0..table.rows() {
            if let Some(job) = job_row(row)
                && own
                    .iter()
                    .all(|(column, allowed)| allowed.allows(&table.cell(column, row)))
            {
                without.remove(&job);
                rows.push(row);
            }
        }
        if rows.is_empty() {
            return short(format!("no row of {} matches", name.word()));
        }
        if !without.is_empty() {
            self.note(format!("{} of {} jobs have no such row", without.len(), meant.len()));
        }
        Ok((rows, failed))
    }

    /// The rows of the table of jobs that a filter means and that did not fail, at least one; and how many failed.
    fn whole_jobs(&self, filter: &Filter) -> Result<(Vec<usize>, usize), Trouble> {
        let jobs = self.results.jobs();
        let rows = self.jobs(filter);
        let (failed, whole): (Vec<usize>, Vec<usize>) = rows
            .iter()
            .partition(|&&row| jobs.cell("status", row) == Value::from("failed"));
        if rows.is_empty() {
            return short("no job matches");
        }
        if whole.is_empty() {
            return short(format!("only failed jobs match, {} of them", failed.len()));
        }
        if !failed.is_empty() {
            self.note(format!("{} failed jobs left out", failed.len()));
        }
        Ok((whole, failed.len()))
    }

    fn history(&self, key: &str, asked: &HistoryQuantity, outer: &Filter) -> Result<f64, Trouble> {
        self.table(key, TableName::Histories)?;
        self.check_filter(&format!("{key}.where"), &asked.filter, None)?;
        let of_jobs = |(column, _): &&(String, _)| self.results.jobs().has(column);
        let filter = asked.filter.within(outer);
        let filter = Filter(filter.0.iter().filter(of_jobs).cloned().collect());
        let (whole, _) = self.whole_jobs(&filter)?;
        let [row] = whole[..] else {
            return short(format!("{} jobs match where one history is meant", whole.len()));
        };
        let job = self.results.jobs().number("job", row).unwrap_or_default() as u64;
        let history = self.recorded(job, &asked.quantity, asked.position as u64)?;
        let reduced = if asked.needs_moments() {
            let moments = moments_of(self.results, row, asked.position).map_err(Trouble::Short)?;
            let part = history.part(&moments, asked.from, asked.to);
            part.and_then(|part| part.reduced(&moments, asked.reduce))
        } else {
            history.reduced(&Moments::default(), asked.reduce)
        };
        reduced.map_err(Trouble::Short)
    }

    /// A recorded history.
    fn recorded(&self, job: u64, quantity: &str, position: u64) -> Result<History, Trouble> {
        let Some(table) = self.results.table(TableName::Histories) else {
            return short("no histories");
        };
        let index = self.histories.get_or_init(|| {
            let mut index: HashMap<(u64, String, u64), Vec<usize>> = HashMap::new();
            for row in 0..table.rows() {
                let number = |column| table.number(column, row).unwrap_or_default() as u64;
                let quantity = table.cell("quantity", row).as_str().unwrap_or_default().to_owned();
                index
                    .entry((number("job"), quantity, number("position")))
                    .or_default()
                    .push(row);
            }
            index
        });
        let Some(rows) = index.get(&(job, quantity.to_owned(), position)) else {
            return short(format!("no history of {quantity} at {position} was recorded"));
        };
        let point = |&row: &usize| table.number("time_s", row).zip(table.number("value", row));
        let points: Option<Vec<(f64, f64)>> = rows.iter().map(point).collect();
        match points {
            Some(points) => {
                let (time_s, values) = points.into_iter().unzip();
                Ok(History { time_s, values })
            }
            None => short("a history with empty values"),
        }
    }
}

/// A quantity of several parts, from their values.
fn combined(quantity: &Quantity, values: &[f64]) -> f64 {
    match (quantity, values) {
        (Quantity::Ratio(_), [a, b]) => a / b,
        (Quantity::Difference(_), [a, b]) => a - b,
        (Quantity::Largest(_), list) => list.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        (Quantity::Smallest(_), list) => list.iter().copied().fold(f64::INFINITY, f64::min),
        _ => f64::NAN,
    }
}
