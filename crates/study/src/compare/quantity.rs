//! A quantity of a reference evaluated on results.
//!
//! Knows rows, filters and what is made of them. Does not know what a quantity should be, nor whether the results can
//! have what it names.

use super::history::{History, moments_of};
use crate::reference::{Filter, HistoryQuantity, Quantity, Reduction, SelectQuantity};
use crate::tables::{Results, Table, TableName};
use std::cell::{OnceCell, RefCell};
use std::collections::{BTreeSet, HashMap};

/// Evaluates quantities of one reference on results.
pub(super) struct Evaluator<'a> {
    pub(super) results: &'a Results,
    /// Rows of each history, by job, quantity and position.
    histories: OnceCell<HashMap<(u64, String, u64), Vec<usize>>>,
    /// Failed jobs that a filter met since the last look.
    left_out: RefCell<BTreeSet<u64>>,
}

impl<'a> Evaluator<'a> {
    pub(super) fn new(results: &'a Results) -> Self {
        Self {
            results,
            histories: OnceCell::new(),
            left_out: RefCell::default(),
        }
    }

    /// How many failed jobs were met since the last call.
    pub(super) fn take_left_out(&self) -> usize {
        std::mem::take(&mut *self.left_out.borrow_mut()).len()
    }

    /// The value of a quantity; `filter` holds for all its parts unless they say otherwise.
    pub(super) fn value(&self, quantity: &Quantity, filter: &Filter) -> Result<f64, String> {
        let parts = |list: &[Quantity]| {
            let each = list.iter().map(|part| self.value(part, filter));
            each.collect::<Result<Vec<f64>, String>>()
        };
        let value = match quantity {
            Quantity::Number(number) => *number,
            Quantity::Select(select) => self.select(select, filter)?,
            Quantity::History(history) => self.history(history, filter)?,
            Quantity::Ratio(two) => {
                let parts = parts(two.as_slice())?;
                parts[0] / parts[1]
            }
            Quantity::Difference(two) => {
                let parts = parts(two.as_slice())?;
                parts[0] - parts[1]
            }
            Quantity::Largest(list) => parts(list)?.into_iter().fold(f64::NEG_INFINITY, f64::max),
            Quantity::Smallest(list) => parts(list)?.into_iter().fold(f64::INFINITY, f64::min),
        };
        if value.is_finite() {
            Ok(value)
        } else {
            Err(format!("not a finite number: {value}"))
        }
    }

    /// A table of the results.
    pub(super) fn table(&self, name: TableName) -> Result<&'a Table, String> {
        self.results
            .table(name)
            .ok_or_else(|| format!("the results hold no table of {}", name.word()))
    }

    fn select(&self, select: &SelectQuantity, outer: &Filter) -> Result<f64, String> {
        let table = self.table(select.table)?;
        let rows = self.rows(select.table, &select.filter.within(outer))?;
        let values: Vec<f64> = rows
            .iter()
            .filter_map(|&row| table.number(&select.column, row))
            .collect();
        if select.reduce == Reduction::Count {
            return Ok(values.len() as f64);
        }
        if values.is_empty() {
            return Err(format!("{} empty in all {} rows that match", select.column, rows.len()));
        }
        Ok(match select.reduce {
            Reduction::Only if rows.len() > 1 => {
                return Err(format!("{} rows match where one is meant", rows.len()));
            }
            Reduction::Only | Reduction::Count => values[0],
            Reduction::Max => values.into_iter().fold(f64::NEG_INFINITY, f64::max),
            Reduction::Min => values.into_iter().fold(f64::INFINITY, f64::min),
            Reduction::Mean => values.iter().sum::<f64>() / values.len() as f64,
        })
    }

    /// The rows of the table of jobs that a filter means, failed ones among them; keys that are no columns of jobs are
    /// passed over.
    pub(super) fn jobs(&self, filter: &Filter) -> Vec<usize> {
        let jobs = self.results.jobs();
        let means = |row: &usize| {
            let mut of_jobs = filter.0.iter().filter(|(name, _)| jobs.has(name));
            of_jobs.all(|(name, allowed)| allowed.allows(&jobs.cell(name, *row)))
        };
        (0..jobs.rows()).filter(means).collect()
    }

    /// The rows of a table that a filter means, those of failed jobs left out.
    pub(super) fn rows(&self, name: TableName, filter: &Filter) -> Result<Vec<usize>, String> {
        let table = self.table(name)?;
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
            return Err(format!("no row of {} matches", name.word()));
        }
        Ok(rows)
    }

    /// The rows of the table of jobs that a filter means and that did not fail, at least one.
    fn whole_jobs(&self, filter: &Filter) -> Result<Vec<usize>, String> {
        let jobs = self.results.jobs();
        let rows = self.jobs(filter);
        let (failed, whole): (Vec<usize>, Vec<usize>) =
            rows.iter().partition(|&&row| jobs.cell("status", row) == "failed");
        if rows.is_empty() {
            return Err("no job matches".to_owned());
        }
        if whole.is_empty() {
            return Err(format!("only failed jobs match, {} of them", failed.len()));
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

    fn history(&self, asked: &HistoryQuantity, outer: &Filter) -> Result<f64, String> {
        let filter = asked.filter.within(outer);
        let [row] = self.whole_jobs(&filter)?[..] else {
            return Err("several jobs match where one history is meant".to_owned());
        };
        let job = self.results.jobs().number("job", row).unwrap_or_default() as u64;
        let history = self.recorded(job, &asked.quantity, asked.position as u64)?;
        let moments = moments_of(self.results, row, asked.position)?;
        history
            .part(&moments, asked.from, asked.to)
            .and_then(|part| part.reduced(&moments, asked.reduce))
    }

    /// A recorded history.
    fn recorded(&self, job: u64, quantity: &str, position: u64) -> Result<History, String> {
        let table = self.table(TableName::Histories)?;
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
            return Err(format!("no history of {quantity} at {position} was recorded"));
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
