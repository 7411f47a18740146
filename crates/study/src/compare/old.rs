//! New results held against old ones, job by job, matched by their axes.
//!
//! Knows which rows of two runs are the same. Does not know why they may differ.

use super::line::{Case, Comparison, Line, Verdict};
use super::tolerances::Tolerances;
use crate::reference::{Role, Tolerance};
use crate::refusal::Refusal;
use crate::tables::{Results, Table, TableName};
use serde_json::{Map, Value, json};
use std::collections::{HashMap, HashSet};

/// Columns that say which row it is of its job.
const ROW_KEYS: [&str; 6] = ["position", "joint", "y_m", "number", "quantity", "time_s"];

/// Holds every number of new results against that of old ones: a line a column, and one for the jobs themselves. An old
/// job without a new one, a job that fails now and did not then, and a number where there was none fall short.
///
/// # Errors
/// [`Refusal`] where the two have different axes, or the tolerances name what is no column.
pub fn against_old(new: &Results, old: &Results, tolerances: &Tolerances) -> Result<Comparison, Refusal> {
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
            (Some(now), Some(then)) => lines.extend(columns(name, (now, then), &pairs, &axes, tolerances, new)),
            (None, Some(_)) => lines.push(missing(name)),
            (_, None) => {}
        }
    }
    Ok(Comparison {
        results: new.name.clone(),
        with: format!("{} in {}", old.name, old.place.display()),
        source: "older results".to_owned(),
        lines,
    })
}

/// For each old job the new one of the same axes.
type Pairs = HashMap<u64, u64>;

fn match_jobs(new: &Results, old: &Results, axes: &[String]) -> (Pairs, Line) {
    let key = |r: &Results, row: usize| axes.iter().map(|a| r.jobs().cell(a, row)).collect::<Vec<_>>();
    let text = |r: &Results, row: usize| key(r, row).iter().map(place_text).collect::<String>();
    let number = |r: &Results, row: usize| r.jobs().number("job", row).unwrap_or_default() as u64;
    let failed = |r: &Results, row: usize| r.jobs().cell("status", row) == json!("failed");
    let rows: HashMap<String, usize> = (0..new.jobs().rows()).map(|row| (text(new, row), row)).collect();
    let (mut pairs, mut lost, mut broken, mut first) = (Pairs::new(), 0, 0, None);
    for row in 0..old.jobs().rows() {
        match rows.get(&text(old, row)) {
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
    tell(lost, "old jobs without a new one");
    tell(broken, "jobs that fail now and did not then");
    tell(
        new.jobs().rows().saturating_sub(old.jobs().rows()),
        "more new jobs than old ones",
    );
    if pairs.is_empty() {
        reasons.push("no job succeeded in both".to_owned());
    }
    let case = first
        .map(|row| axes.iter().cloned().zip(key(old, row)).collect::<Map<_, _>>())
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

/// A place as text: numbers to twelve digits, so that two ways of writing one are one.
fn place_text(value: &Value) -> String {
    match value.as_f64() {
        Some(x) => format!("{:.11e};", x + 0.0),
        None => format!("{value};"),
    }
}

fn line(id: String, expected: String, worst: Case) -> Line {
    Line {
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

fn missing(name: TableName) -> Line {
    let worst = Case {
        case: Map::new(),
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
    /// Row of the new table, old value, new value.
    at: Option<(usize, Option<f64>, Option<f64>)>,
    margin: Option<f64>,
    compared: usize,
}

fn columns(
    name: TableName,
    (now, then): (&Table, &Table),
    pairs: &Pairs,
    axes: &[String],
    tolerances: &Tolerances,
    new: &Results,
) -> Vec<Line> {
    let keys: Vec<&str> = ROW_KEYS
        .into_iter()
        .filter(|k| name != TableName::Jobs && now.has(k))
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
    let new_jobs: HashSet<u64> = pairs.values().copied().collect();
    let count = (0..now.rows()).filter(|&row| new_jobs.contains(&job(now, row))).count();
    let mut lines = Vec::new();
    if count != matched.len() {
        let worst = Case {
            case: Map::new(),
            values: vec![count as f64],
            deviation: None,
            margin: None,
            holds: false,
            reason: None,
        };
        let expected = format!("{} rows of jobs in both", matched.len());
        lines.push(line(name.word().to_owned(), expected, worst));
    }
    let place = |row: usize| -> Map<String, Value> {
        let of_job = new.row_of_job(job(now, row)).into_iter();
        let axes = of_job.flat_map(|r| axes.iter().map(move |a| (a.clone(), new.jobs().cell(a, r))));
        let own = keys.iter().map(|k| ((*k).to_owned(), now.cell(k, row)));
        axes.chain(own).filter(|(_, value)| !value.is_null()).collect()
    };
    let is_axis = |column: &str| name == TableName::Jobs && axes.iter().any(|axis| axis == column);
    for column in then
        .names()
        .filter(|c| *c != "job" && *c != "reason" && !keys.contains(c) && !is_axis(c))
    {
        let id = format!("{}.{column}", name.word());
        let old_numbers = || matched.iter().filter_map(|&(row, _)| then.number(column, row));
        let largest = old_numbers().fold(0.0, |most: f64, x| most.max(x.abs()));
        let Some(tolerance) = tolerances.of(name.word(), column, largest) else {
            continue;
        };
        if then.is_word_or_flag(column) || now.is_word_or_flag(column) {
            lines.extend(words(id, column, (now, then), &matched, place));
            continue;
        }
        let mut worst = Worst::default();
        for &(old_row, new_row) in &matched {
            let found = new_row.and_then(|row| now.number(column, row));
            worst.take(new_row, then.number(column, old_row), found, tolerance);
        }
        if worst.compared > 0 {
            lines.push(worst.line(id, tolerance, place));
        }
    }
    lines
}

/// A column of words, or of yes and no: each is what it was. No line where it is empty in both.
fn words(
    id: String,
    column: &str,
    (now, then): (&Table, &Table),
    matched: &[(usize, Option<usize>)],
    place: impl Fn(usize) -> Map<String, Value>,
) -> Option<Line> {
    let cells = |&(old, new): &(usize, Option<usize>)| {
        let found = new.map(|row| now.cell(column, row)).unwrap_or_default();
        (new, then.cell(column, old), found)
    };
    let filled = matched
        .iter()
        .map(cells)
        .filter(|(_, old, found)| !(old.is_null() && found.is_null()));
    let different: Vec<_> = filled.clone().filter(|(_, old, found)| old != found).collect();
    let rows = filled.count();
    let first = different.first();
    let worst = Case {
        case: first.and_then(|(row, ..)| *row).map(place).unwrap_or_default(),
        values: vec![(rows - different.len()) as f64],
        deviation: None,
        margin: None,
        holds: different.is_empty(),
        reason: first.map(|(_, old, found)| format!("{found} where it was {old}")),
    };
    (rows > 0).then(|| line(id, format!("the same in {rows} rows"), worst))
}

impl Worst {
    fn take(&mut self, row: Option<usize>, old: Option<f64>, new: Option<f64>, tolerance: Tolerance) {
        let margin = match (row, old, new) {
            (Some(_), None, None) => return,
            (_, Some(old), Some(new)) => {
                let scale = if old == 0.0 { 1.0 } else { old.abs() };
                let margin = (tolerance.allowed(old) - (new - old).abs()) / scale;
                if margin.is_nan() { f64::NEG_INFINITY } else { margin }
            }
            _ => f64::NEG_INFINITY,
        };
        self.compared += 1;
        if self.margin.is_none_or(|least| margin < least) {
            self.margin = Some(margin);
            self.at = Some((row.unwrap_or(usize::MAX), old, new));
        }
    }

    fn line(self, id: String, tolerance: Tolerance, place: impl Fn(usize) -> Map<String, Value>) -> Line {
        let (row, old, new) = self.at.unwrap_or((usize::MAX, None, None));
        let holds = self.margin.is_none_or(|margin| margin >= 0.0);
        let reason = match (old, new) {
            (Some(_), None) => Some("nothing where there was a number".to_owned()),
            (None, Some(_)) => Some("a number where there was nothing".to_owned()),
            _ => None,
        };
        let deviation = old
            .zip(new)
            .map(|(old, new)| (new - old) / if old == 0.0 { 1.0 } else { old.abs() });
        let relative = tolerance.relative.map(|share| format!("+- {share:e} of it"));
        let absolute = tolerance.absolute.map(|x| format!("+- {x:e}"));
        let within = relative.into_iter().chain(absolute).collect::<Vec<_>>().join(" or ");
        let expected = old.map_or("as before".to_owned(), |old| {
            format!("{} {within}", super::line::number(old))
        });
        let worst = Case {
            case: if row == usize::MAX { Map::new() } else { place(row) },
            values: new.into_iter().collect(),
            deviation,
            margin: self.margin.filter(|margin| margin.is_finite()),
            holds,
            reason,
        };
        Line {
            expected_value: old,
            ..line(id, expected, worst)
        }
    }
}
