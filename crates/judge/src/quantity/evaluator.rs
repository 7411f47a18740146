//! A quantity of a reference evaluated on results.
//!
//! Knows rows, filters and what is made of them. Does not know what a quantity should be, nor whether the results can
//! have what it names.

use super::history::{Along, Moments, ValueHistory, moments_of};
use super::no_value::{NoValue, failed_jobs};
use super::spec::{HistoryQuantity, Quantity, Reduction, SelectQuantity};
use pontoon_plan::input::filter::Filter;
use pontoon_results::{Results, Table, TableName};
use std::cell::{OnceCell, RefCell};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::rc::Rc;

/// Evaluates quantities of one reference on results.
pub(crate) struct Evaluator<'a> {
    pub(crate) results: &'a Results,
    /// Rows of each job in each table that was looked at, jobs in the order of their own table.
    of_jobs: RefCell<BTreeMap<TableName, Rc<Vec<Vec<usize>>>>>,
    /// Rows of each history.
    histories: OnceCell<HashMap<HistoryKey, Vec<usize>>>,
    /// What is to be said of the quantities evaluated since the last look.
    notes: RefCell<BTreeSet<String>>,
}

impl<'a> Evaluator<'a> {
    pub(crate) fn new(results: &'a Results) -> Self {
        Self {
            results,
            of_jobs: RefCell::default(),
            histories: OnceCell::new(),
            notes: RefCell::default(),
        }
    }

    /// What is to be said of the quantities evaluated since the last call.
    pub(crate) fn take_notes(&self) -> BTreeSet<String> {
        std::mem::take(&mut *self.notes.borrow_mut())
    }

    fn note(&self, text: String) {
        self.notes.borrow_mut().insert(text);
    }

    /// The value of a quantity; `filter` holds for all its parts unless they say otherwise.
    pub(crate) fn value(&self, quantity: &Quantity, filter: &Filter) -> Result<f64, NoValue> {
        let value = match quantity {
            Quantity::Number(number) => *number,
            Quantity::Select(select) => self.select(select, filter)?,
            Quantity::History(history) => self.history(history, filter)?,
            several => {
                let parts = several.parts().into_iter().map(|(_, part)| self.value(part, filter));
                combined(several, &parts.collect::<Result<Vec<f64>, NoValue>>()?)
            }
        };
        if value.is_finite() {
            Ok(value)
        } else {
            Err(NoValue::NotFinite(value))
        }
    }

    /// A table of the results.
    pub(crate) fn table(&self, name: TableName) -> Result<&'a Table, NoValue> {
        self.results.table(name).ok_or(NoValue::NoTable(name))
    }

    fn select(&self, select: &SelectQuantity, outer: &Filter) -> Result<f64, NoValue> {
        let table = self.table(select.table)?;
        let (rows, failed) = self.rows(select.table, &select.filter.within(outer))?;
        let values: Vec<f64> = rows
            .iter()
            .filter_map(|&row| table.number(&select.column, row))
            .collect();
        if select.reduce == Reduction::Count {
            return Ok(values.len() as f64);
        }
        if values.is_empty() {
            return Err(NoValue::Empty {
                column: select.column.clone(),
                rows: rows.len(),
            });
        }
        if select.reduce == Reduction::Only {
            return match values.as_slice() {
                [value] if rows.len() == 1 => Ok(*value),
                _ => Err(NoValue::SeveralRows(rows.len())),
            };
        }
        if failed > 0 {
            return Err(NoValue::FailedAmong(failed));
        }
        if values.len() < rows.len() {
            let empty = rows.len() - values.len();
            self.note(format!("{} empty in {empty} of {} rows", select.column, rows.len()));
        }
        Ok(match select.reduce {
            Reduction::Max => values.into_iter().fold(f64::NEG_INFINITY, f64::max),
            Reduction::Min => values.into_iter().fold(f64::INFINITY, f64::min),
            Reduction::Mean | Reduction::Only | Reduction::Count => values.iter().sum::<f64>() / values.len() as f64,
        })
    }

    /// The rows of the table of jobs that a filter means, failed ones among them; keys that are no columns of jobs are
    /// passed over.
    pub(crate) fn jobs(&self, filter: &Filter) -> Vec<usize> {
        let jobs = self.results.jobs();
        let means = |row: &usize| {
            let mut of_jobs = filter.0.iter().filter(|(name, _)| jobs.has(name));
            of_jobs.all(|(name, allowed)| allowed.allows(&jobs.cell(name, *row)))
        };
        (0..jobs.rows()).filter(means).collect()
    }

    /// The rows of a table that a filter means, those of failed jobs left out; and how many jobs failed of those that match.
    pub(crate) fn rows(&self, name: TableName, filter: &Filter) -> Result<(Vec<usize>, usize), NoValue> {
        let table = self.table(name)?;
        let of_jobs = Filter(
            filter
                .0
                .iter()
                .filter(|(c, _)| name == TableName::Jobs || !table.has(c) || c == "job")
                .cloned()
                .collect(),
        );
        let (whole, failed) = self.whole_jobs(&of_jobs)?;
        if name == TableName::Jobs {
            return Ok((whole, failed));
        }
        let own: Vec<_> = filter.0.iter().filter(|(c, _)| table.has(c)).collect();
        let means = |row: &usize| {
            let mut cells = own
                .iter()
                .map(|(column, allowed)| allowed.allows(&table.cell(column, *row)));
            cells.all(|meant| meant)
        };
        let of_jobs = self.rows_of_jobs(name, table);
        let (mut rows, mut without) = (Vec::new(), 0);
        for &job in &whole {
            let before = rows.len();
            rows.extend(of_jobs[job].iter().copied().filter(means));
            without += usize::from(rows.len() == before);
        }
        if rows.is_empty() {
            return Err(NoValue::NoRow(name));
        }
        if without > 0 {
            self.note(format!("{without} of {} jobs have no such row", whole.len()));
        }
        Ok((rows, failed))
    }

    /// The rows of each job in a table.
    fn rows_of_jobs(&self, name: TableName, table: &Table) -> Rc<Vec<Vec<usize>>> {
        let mut indices = self.of_jobs.borrow_mut();
        let index = indices.entry(name).or_insert_with(|| {
            let mut rows = vec![Vec::new(); self.results.jobs().rows()];
            for row in 0..table.rows() {
                let job = table
                    .number("job", row)
                    .and_then(|job| self.results.row_of_job(job as u64));
                if let Some(job) = job {
                    rows[job].push(row);
                }
            }
            Rc::new(rows)
        });
        Rc::clone(index)
    }

    /// The rows of the table of jobs that a filter means and that did not fail, at least one; and how many failed.
    fn whole_jobs(&self, filter: &Filter) -> Result<(Vec<usize>, usize), NoValue> {
        let jobs = self.results.jobs();
        let rows = self.jobs(filter);
        let (failed, whole): (Vec<usize>, Vec<usize>) = rows
            .iter()
            .partition(|&&row| jobs.cell("status", row).word() == Some("failed"));
        if rows.is_empty() {
            return Err(NoValue::NoJob);
        }
        if whole.is_empty() {
            return Err(NoValue::OnlyFailed(failed.len()));
        }
        if !failed.is_empty() {
            self.note(format!("{} left out", failed_jobs(failed.len())));
        }
        Ok((whole, failed.len()))
    }

    fn history(&self, asked: &HistoryQuantity, outer: &Filter) -> Result<f64, NoValue> {
        let filter = asked.filter.within(outer);
        let (whole, _) = self.whole_jobs(&filter)?;
        let [row] = whole[..] else {
            return Err(NoValue::SeveralJobs);
        };
        let job = self.results.jobs().number("job", row).unwrap_or_default() as u64;
        let along = match (asked.position, asked.x_m) {
            (Some(position), _) => Along::Position(position),
            (None, x_m) => Along::X(x_m.unwrap_or_default()),
        };
        let history = self.recorded(job, asked, along)?;
        if !asked.needs_moments() {
            return history.reduced(&Moments::default(), asked.reduce);
        }
        let moments = moments_of(self.results, row, along)?;
        history
            .part(&moments, asked.from, asked.to)
            .and_then(|part| part.reduced(&moments, asked.reduce))
    }

    /// A recorded history.
    fn recorded(&self, job: u64, asked: &HistoryQuantity, along: Along) -> Result<ValueHistory, NoValue> {
        let table = self.table(TableName::Histories)?;
        let index = self.histories.get_or_init(|| {
            let mut index: HashMap<HistoryKey, Vec<usize>> = HashMap::new();
            for row in 0..table.rows() {
                let number = |column| table.number(column, row);
                let job = number("job").unwrap_or_default() as u64;
                let quantity = table.cell("quantity", row).text();
                let place = ["position", "x_m", "y_m"].map(|column| number(column).map(place_bits));
                index.entry((job, quantity, place)).or_default().push(row);
            }
            index
        });
        let place = [asked.position.map(|position| position as f64), asked.x_m, asked.y_m];
        let key = (job, asked.quantity.clone(), place.map(|of| of.map(place_bits)));
        let Some(rows) = index.get(&key) else {
            let across = asked.y_m.map(|y_m| format!(" and y {y_m} m")).unwrap_or_default();
            return Err(NoValue::NoHistory {
                quantity: asked.quantity.clone(),
                place: format!("{along}{across}"),
            });
        };
        let point = |&row: &usize| table.number("time_s", row).zip(table.number("value", row));
        match rows.iter().map(point).collect::<Option<Vec<(f64, f64)>>>() {
            Some(points) => {
                let (time_s, values) = points.into_iter().unzip();
                Ok(ValueHistory { time_s, values })
            }
            None => Err(NoValue::BrokenHistory),
        }
    }
}

/// A history's job, quantity and place: its position or joint, its x and its y, by their bits.
type HistoryKey = (u64, String, [Option<u64>; 3]);

/// The bits of a place; zero has one sign.
fn place_bits(place: f64) -> u64 {
    (place + 0.0).to_bits()
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
