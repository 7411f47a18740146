//! New results held against old ones, job by job, matched by their axes.
//!
//! Knows which rows of two runs are the same. Does not know why they may differ.

use super::check_result::{Case, CaseColumns, CheckResult, Comparison, DIGITS, Verdict};
use super::tolerances::Tolerances;
use crate::checks::Role;
use crate::quantity::Tolerance;
use pontoon_plan::input::{Cell, Refusal};
use pontoon_results::labels::all_digits;
use pontoon_results::{Column, ColumnKind, ColumnRole, Results, Table, TableName};
use std::collections::HashMap;

/// Holds every number of new results against that of old ones: a line a column, and one for the jobs themselves. An old
/// job without a new one, a job that fails now and did not then, and a number where there was none fall short.
///
/// # Errors
/// [`Refusal`] where the two have different axes, or the tolerances name what is no column.
pub fn against_baseline(new: &Results, old: &Results, tolerances: &Tolerances) -> Result<Comparison, Refusal> {
    let axes = new.axes();
    let old_axes = old.axes();
    if let Some(axis) = axes
        .iter()
        .find(|a| !old_axes.contains(a))
        .or(old_axes.iter().find(|a| !axes.contains(a)))
    {
        let found = format!("the axis '{axis}', which only one of both results has");
        let allowed = format!("results with the axes of {}: {}", new.place.display(), axes.join(", "));
        return Err(Refusal::new(&old.place, "", found, allowed));
    }
    let mut known = Vec::new();
    for name in TableName::ALL {
        let columns = new
            .table(name)
            .into_iter()
            .flat_map(Table::names)
            .map(|c| format!("{}.{c}", name.word()));
        known.extend(columns);
    }
    tolerances.check(&known)?;
    let (pairs, jobs) = match_jobs(new, old, &axes);
    let mut lines = vec![jobs];
    for name in TableName::ALL {
        match (new.table(name), old.table(name)) {
            (Some(now), Some(then)) => lines.extend(columns(name, (now, then), &pairs, &axes, tolerances, old)),
            (None, Some(_)) => lines.push(missing(name)),
            (_, None) => {}
        }
    }
    Ok(Comparison {
        results: new.name.clone(),
        with: format!("{} in {}", old.name, old.place.display()),
        source: "older results".to_owned(),
        notes: Vec::new(),
        lines,
    })
}

/// For each old job the new one of the same axes.
type Pairs = HashMap<u64, u64>;

fn match_jobs(new: &Results, old: &Results, axes: &[String]) -> (Pairs, CheckResult) {
    let text = |r: &Results, row: usize| {
        let cells = axes.iter().map(|axis| r.jobs().cell(axis, row));
        cells.map(|cell| place_text(&cell)).collect::<String>()
    };
    let number = |r: &Results, row: usize| r.jobs().number("job", row).unwrap_or_default() as u64;
    let failed = |r: &Results, row: usize| r.jobs().cell("status", row).word() == Some("failed");
    let rows: HashMap<String, usize> = (0..new.jobs().rows()).map(|row| (text(new, row), row)).collect();
    let (mut pairs, mut known, mut lost, mut broken, mut first) = (Pairs::new(), 0, 0, 0, None);
    for row in 0..old.jobs().rows() {
        let now = rows.get(&text(old, row));
        known += usize::from(now.is_some());
        match now {
            Some(&now) if failed(new, now) && !failed(old, row) => {
                broken += 1;
                first.get_or_insert(row);
            }
            Some(&now) if !failed(new, now) && !failed(old, row) => {
                pairs.insert(number(old, row), number(new, now));
            }
            Some(_) => {}
            None => {
                lost += 1;
                first.get_or_insert(row);
            }
        }
    }
    let mut reasons = Vec::new();
    let mut tell = |count: usize, what: &str| {
        if count > 0 {
            reasons.push(format!("{count} {what}"));
        }
    };
    tell(lost, "of the old jobs without a new one");
    tell(broken, "of the jobs fail now and did not then");
    tell(
        new.jobs().rows().saturating_sub(known),
        "of the new jobs without an old one",
    );
    if pairs.is_empty() {
        reasons.push("no job succeeded in both".to_owned());
    }
    let case = first
        .map(|row| {
            let cell = |axis: &String| (axis.clone(), old.jobs().cell(axis, row).owned());
            CaseColumns(axes.iter().map(cell).collect())
        })
        .unwrap_or_default();
    let holds = lost == 0 && broken == 0 && !pairs.is_empty();
    let worst = Case {
        case,
        values: vec![pairs.len() as f64],
        deviation: None,
        margin: None,
        holds,
        reason: Some(reasons.join(", ")).filter(|r| !r.is_empty()),
    };
    let expected = format!("{} jobs", old.jobs().rows());
    (pairs, line("jobs".to_owned(), expected, worst))
}

/// A place as text: one for all ways of writing a number, another for another number, as jobs are told apart.
fn place_text(cell: &Cell<'_>) -> String {
    match cell.number() {
        Some(x) => format!("{:e};", x + 0.0),
        None => format!("{cell};"),
    }
}

fn line(id: String, expected: String, worst: Case) -> CheckResult {
    CheckResult {
        id,
        statement: None,
        role: Role::Hold,
        expected,
        expected_value: None,
        verdict: if worst.holds {
            Verdict::Holds
        } else {
            Verdict::FallsShort
        },
        worst,
        cases: Vec::new(),
    }
}

fn missing(name: TableName) -> CheckResult {
    let worst = Case {
        case: CaseColumns::default(),
        values: Vec::new(),
        deviation: None,
        margin: None,
        holds: false,
        reason: Some("the new results do not hold this table".to_owned()),
    };
    line(name.word().to_owned(), "as before".to_owned(), worst)
}

/// The largest difference of one column so far.
#[derive(Default)]
struct Worst {
    /// Row of the old table, old value, new value.
    at: Option<(usize, Option<f64>, Option<f64>)>,
    /// Rows of the old table without one of the new.
    lost: usize,
    margin: Option<f64>,
    compared: usize,
}

fn columns(
    name: TableName,
    (now, then): (&Table, &Table),
    pairs: &Pairs,
    axes: &[String],
    tolerances: &Tolerances,
    old: &Results,
) -> Vec<CheckResult> {
    let is_key = |column: &&Column| column.role == ColumnRole::Key && column.name != "job" && now.has(column.name);
    let keys: Vec<&str> = Column::of_table(name)
        .filter(is_key)
        .map(|column| column.name)
        .collect();
    let key = |table: &Table, row: usize, job: u64| {
        let own = keys.iter().map(|k| place_text(&table.cell(k, row)));
        format!("{job};") + &own.collect::<String>()
    };
    let job = |table: &Table, row: usize| table.number("job", row).unwrap_or_default() as u64;
    let rows: HashMap<String, usize> = (0..now.rows()).map(|row| (key(now, row, job(now, row)), row)).collect();
    let matched: Vec<(usize, Option<usize>)> = (0..then.rows())
        .filter_map(|row| Some((row, *pairs.get(&job(then, row))?)))
        .map(|(row, job)| (row, rows.get(&key(then, row, job)).copied()))
        .collect();
    let mut lines = Vec::new();
    let place = |row: usize| {
        let of_job = old.row_of_job(job(then, row)).into_iter();
        let axes = of_job.flat_map(|r| axes.iter().map(move |a| (a.clone(), old.jobs().cell(a, r).owned())));
        let own = keys.iter().map(|k| ((*k).to_owned(), then.cell(k, row).owned()));
        CaseColumns(axes.chain(own).filter(|(_, cell)| !cell.is_nothing()).collect())
    };
    let is_axis = |column: &str| name == TableName::Jobs && axes.iter().any(|axis| axis == column);
    let of_words = |c: &str| c == "reason" || c == "failure";
    let is_outcome = |c: &&str| *c != "job" && !of_words(c) && !keys.contains(c) && !is_axis(c);
    for column in then.names().filter(is_outcome) {
        let id = format!("{}.{column}", name.word());
        let was = || matched.iter().filter_map(|&(row, _)| then.number(column, row));
        let largest = was().fold(0.0, |most: f64, x| most.max(x.abs()));
        let Some(tolerance) = tolerances.of(name.word(), column, largest) else {
            continue;
        };
        let of_words = [now, then]
            .iter()
            .any(|table| table.kind(column) == Some(ColumnKind::Words));
        if of_words {
            lines.push(words(id, column, (now, then), &matched, place));
            continue;
        }
        let mut worst = Worst::default();
        for &(old_row, new_row) in &matched {
            let found = new_row.map(|row| now.number(column, row));
            worst.take(old_row, then.number(column, old_row), found, tolerance);
        }
        if worst.compared > 0 {
            lines.push(worst.line(id, tolerance, place));
        }
    }
    lines
}

/// A column of words: each is what it was.
fn words(
    id: String,
    column: &str,
    (now, then): (&Table, &Table),
    matched: &[(usize, Option<usize>)],
    place: impl Fn(usize) -> CaseColumns,
) -> CheckResult {
    let cells = |&(old, new): &(usize, Option<usize>)| {
        let found = new.map(|row| now.cell(column, row)).unwrap_or_default();
        (old, then.cell(column, old), found)
    };
    let different: Vec<_> = matched
        .iter()
        .map(cells)
        .filter(|(_, old, found)| old != found)
        .collect();
    let mut worst = short_of((matched.len() - different.len()) as f64, String::new());
    worst.holds = different.is_empty();
    worst.reason = different
        .first()
        .map(|(_, old, found)| format!("{found} where it was {old}"));
    worst.case = different.first().map(|(row, ..)| place(*row)).unwrap_or_default();
    line(id, format!("the same in {} rows", matched.len()), worst)
}

/// A case that falls short with a count.
fn short_of(count: f64, reason: String) -> Case {
    Case {
        case: CaseColumns::default(),
        values: vec![count],
        deviation: None,
        margin: None,
        holds: false,
        reason: Some(reason),
    }
}

impl Worst {
    /// Takes a row of the old table with its old and its new value; there is no new value where there is no such row.
    fn take(&mut self, row: usize, old: Option<f64>, new: Option<Option<f64>>, tolerance: Tolerance) {
        self.lost += usize::from(new.is_none());
        let margin = match (old, new) {
            (None, Some(None)) => return,
            (Some(old), Some(Some(new))) => {
                let scale = if old == 0.0 { 1.0 } else { old.abs() };
                let margin = (tolerance.allowed(old) - (new - old).abs()) / scale;
                if margin.is_nan() { f64::NEG_INFINITY } else { margin }
            }
            _ => f64::NEG_INFINITY,
        };
        self.compared += 1;
        if self.margin.is_none_or(|least| margin < least) {
            self.margin = Some(margin);
            self.at = Some((row, old, new.flatten()));
        }
    }

    fn line(self, id: String, tolerance: Tolerance, place: impl Fn(usize) -> CaseColumns) -> CheckResult {
        let (row, old, new) = self
            .at
            .map_or((None, None, None), |(row, old, new)| (Some(row), old, new));
        let holds = self.margin.is_none_or(|margin| margin >= 0.0);
        let reason = match (old, new, self.lost) {
            (_, _, lost @ 1..) => Some(format!("{lost} of the rows are no longer there")),
            (Some(_), None, ..) => Some("nothing where there was a number".to_owned()),
            (None, Some(_), ..) => Some("a number where there was nothing".to_owned()),
            _ => None,
        };
        let deviation = old
            .zip(new)
            .map(|(old, new)| (new - old) / if old == 0.0 { 1.0 } else { old.abs() });
        let relative = tolerance.relative.map(|share| format!("+- {share:e} of it"));
        let absolute = tolerance.absolute.map(|x| format!("+- {x:e}"));
        let within = relative.into_iter().chain(absolute).collect::<Vec<_>>().join(" or ");
        let expected = old.map_or("as before".to_owned(), |old| {
            format!("{} {within}", all_digits(old, DIGITS))
        });
        let worst = Case {
            case: row.map(place).unwrap_or_default(),
            values: new.into_iter().collect(),
            deviation,
            margin: self.margin.filter(|margin| margin.is_finite()),
            holds,
            reason,
        };
        CheckResult {
            expected_value: old,
            ..line(id, expected, worst)
        }
    }
}
