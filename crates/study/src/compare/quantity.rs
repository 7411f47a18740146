//! A quantity of a reference evaluated on results.
//!
//! Knows rows, filters and what is made of them. Does not know what a quantity should be.

use super::history::{History, moments_of};
use crate::reference::{Filter, HistoryQuantity, Quantity, Reduction, SelectQuantity};
use crate::refusal::Refusal;
use crate::tables::{Results, Table, TableName};
use serde_json::Value;
use std::cell::{OnceCell, RefCell};
use std::collections::{BTreeSet, HashMap};
use std::path::Path;

/// Why a quantity has no value.
#[derive(Debug)]
pub(super) enum Trouble {
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
    /// Failed jobs that a filter met since the last look.
    left_out: RefCell<BTreeSet<u64>>,
}

impl<'a> Evaluator<'a> {
    pub(super) fn new(results: &'a Results, file: &'a Path) -> Self {
        Self {
            results,
            file,
            histories: OnceCell::new(),
            left_out: RefCell::default(),
        }
    }

    /// How many failed jobs were met since the last call.
    pub(super) fn take_left_out(&self) -> usize {
        std::mem::take(&mut *self.left_out.borrow_mut()).len()
    }

    /// The value of a quantity; `filter` holds for all its parts unless they say otherwise.
    pub(super) fn value(&self, key: &str, quantity: &Quantity, filter: &Filter) -> Result<f64, Trouble> {
        let parts = |name: &str, list: &[Quantity]| {
            let each = list.iter().enumerate();
            each.map(|(i, part)| self.value(&format!("{key}.{name}[{i}]"), part, filter))
                .collect::<Result<Vec<f64>, Trouble>>()
        };
        let value = match quantity {
            Quantity::Number(number) => *number,
            Quantity::Select(select) => self.select(&format!("{key}.select"), select, filter)?,
            Quantity::History(history) => self.history(&format!("{key}.history"), history, filter)?,
            Quantity::Ratio(two) => {
                let parts = parts("ratio", two.as_slice())?;
                parts[0] / parts[1]
            }
            Quantity::Difference(two) => {
                let parts = parts("difference", two.as_slice())?;
                parts[0] - parts[1]
            }
            Quantity::Largest(list) => parts("largest", list)?.into_iter().fold(f64::NEG_INFINITY, f64::max),
            Quantity::Smallest(list) => parts("smallest", list)?.into_iter().fold(f64::INFINITY, f64::min),
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
        let rows = self.rows(&format!("{key}.where"), select.table, &select.filter.within(outer))?;
        let values: Vec<f64> = rows
            .iter()
            .filter_map(|&row| table.number(&select.column, row))
            .collect();
        if select.reduce == Reduction::Count {
            return Ok(values.len() as f64);
        }
        if values.is_empty() {
            return short(format!("{} empty in all {} rows that match", select.column, rows.len()));
        }
        Ok(match select.reduce {
            Reduction::Only if values.len() > 1 => {
                return short(format!("{} rows match where one is meant", values.len()));
            }
            Reduction::Only | Reduction::Count => values[0],
            Reduction::Max => values.into_iter().fold(f64::NEG_INFINITY, f64::max),
            Reduction::Min => values.into_iter().fold(f64::INFINITY, f64::min),
            Reduction::Mean => values.iter().sum::<f64>() / values.len() as f64,
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

    /// The rows of a table that a filter means, those of failed jobs left out.
    pub(super) fn rows(&self, key: &str, name: TableName, filter: &Filter) -> Result<Vec<usize>, Trouble> {
        let table = self.table(key, name)?;
        self.check_filter(key, filter, Some(table))?;
        let of_jobs = Filter(
            filter
                .0
                .iter()
                .filter(|(c, _)| name == TableName::Jobs || !table.has(c) || c == "job")
                .cloned()
                .collect(),
        );
        let whole = self.whole_jobs(&of_jobs)?;
        if name == TableName::Jobs {
            return Ok(whole);
        }
        let own: Vec<_> = filter.0.iter().filter(|(c, _)| table.has(c)).collect();
        let meant: BTreeSet<usize> = whole.into_iter().collect();
        let job_row = |row| {
            table
                .number("job", row)
                .and_then(|job| self.results.row_of_job(job as u64))
        };
        let rows: Vec<usize> = (0..table.rows())
            .filter(|&row| job_row(row).is_some_and(|job| meant.contains(&job)))
            .filter(|&row| {
                own.iter()
                    .all(|(column, allowed)| allowed.allows(&table.cell(column, row)))
            })
            .collect();
        if rows.is_empty() {
            return short(format!("no row of {} matches", name.word()));
        }
        Ok(rows)
    }

    /// The rows of the table of jobs that a filter means and that did not fail, at least one.
    fn whole_jobs(&self, filter: &Filter) -> Result<Vec<usize>, Trouble> {
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
        let mut left_out = self.left_out.borrow_mut();
        left_out.extend(
            failed
                .iter()
                .filter_map(|&row| jobs.number("job", row))
                .map(|job| job as u64),
        );
        Ok(whole)
    }

    fn history(&self, key: &str, asked: &HistoryQuantity, outer: &Filter) -> Result<f64, Trouble> {
        let filter = asked.filter.within(outer);
        self.table(key, TableName::Histories)?;
        self.check_filter(&format!("{key}.where"), &filter, None)?;
        let [row] = self.whole_jobs(&filter)?[..] else {
            return short("several jobs match where one history is meant");
        };
        let job = self.results.jobs().number("job", row).unwrap_or_default() as u64;
        let history = self.recorded(job, &asked.quantity, asked.position as u64)?;
        let moments = moments_of(self.results, row, asked.position).map_err(Trouble::Short)?;
        history
            .part(&moments, asked.from, asked.to)
            .and_then(|part| part.reduced(&moments, asked.reduce))
            .map_err(Trouble::Short)
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
        let column = |name: &str| {
            rows.iter()
                .filter_map(|&row| table.number(name, row))
                .collect::<Vec<f64>>()
        };
        Ok(History {
            time_s: column("time_s"),
            values: column("value"),
        })
    }
}
