//! A check made on results: its cases, their margins, its verdict.
//!
//! Knows what each kind of check asks of its quantity. Does not know how a quantity is found.

use super::expectation::expected;
use super::line::{Case, Line, Verdict, number};
use super::quantity::{Evaluator, Trouble};
use crate::reference::{
    Allowed, BoundCheck, CheckKind, CheckSpec, CurveCheck, Filter, MeasuredCheck, ModeCheck, Quantity, Reduction,
    Reference, Role, SelectQuantity, Tolerance, Trend, TrendCheck,
};
use crate::refusal::Refusal;
use crate::tables::{Results, TableName};
use serde_json::{Map, Value};
use std::collections::HashSet;

/// Makes the checks of one reference on results.
pub(crate) struct Judge<'a> {
    reference: &'a Reference,
    evaluator: Evaluator<'a>,
}

/// What a kind of check finds in one case.
#[derive(Debug, Default)]
struct Finding {
    values: Vec<f64>,
    deviation: Option<f64>,
    margin: Option<f64>,
    holds: bool,
    reason: Option<String>,
}

impl<'a> Judge<'a> {
    pub(crate) fn new(results: &'a Results, reference: &'a Reference) -> Self {
        Self {
            reference,
            evaluator: Evaluator::new(results, &reference.file),
        }
    }

    /// Makes check number `i`.
    pub(super) fn line(&self, i: usize) -> Result<Line, Refusal> {
        let check = &self.reference.spec.checks[i];
        let key = format!("checks[{i}]");
        self.check_outer(&key, check)?;
        let cases = match self.combinations(&key, check)? {
            Ok(combinations) => combinations
                .into_iter()
                .map(|case| self.case(&key, check, case))
                .collect::<Result<Vec<Case>, Refusal>>()?,
            Err(reason) => vec![Case::without_values(Map::new(), reason)],
        };
        let of_case = |case: &Case| case.margin.unwrap_or(f64::NEG_INFINITY);
        let mut worst = &cases[0];
        for case in &cases[1..] {
            if of_case(case) < of_case(worst) {
                worst = case;
            }
        }
        let empty = cases.iter().any(|case| case.values.is_empty());
        let verdict = match (check.role, empty, cases.iter().all(|case| case.holds)) {
            (_, true, _) | (Role::Hold, false, false) => Verdict::FallsShort,
            (Role::Hold, false, true) => Verdict::Holds,
            (Role::ExpectedFail, false, false) => Verdict::ExpectedFail,
            (Role::ExpectedFail, false, true) => Verdict::NowHolds,
            (Role::Record, false, _) => Verdict::Record,
        };
        let (expected, expected_value) = expected(check);
        Ok(Line {
            id: check.id.clone(),
            statement: check.statement.clone(),
            role: check.role,
            expected,
            expected_value,
            verdict,
            worst: worst.clone(),
            cases: if cases.len() > 1 { cases } else { Vec::new() },
        })
    }

    /// What check number `i` of one value finds.
    pub(crate) fn value(&self, i: usize) -> Result<f64, Trouble> {
        let check = &self.reference.spec.checks[i];
        let key = format!("checks[{i}]");
        self.check_outer(&key, check)?;
        let (place, quantity) = match check.kind() {
            Some(CheckKind::Value(value)) => ("value.of", value.of.clone()),
            Some(CheckKind::Mode(mode)) => ("mode", mode.quantity()),
            Some(CheckKind::Measured(measured)) => ("measured.of", measured.of.clone()),
            _ => return Err(Trouble::Short("not a check of one value".to_owned())),
        };
        self.evaluator
            .value(&format!("{key}.{place}"), &quantity, &check.filter)
    }

    /// Refuses columns of a check's own filter that neither the jobs nor any table that the check looks at has.
    fn check_outer(&self, key: &str, check: &CheckSpec) -> Result<(), Refusal> {
        let mut tables = Vec::new();
        match check.kind() {
            Some(CheckKind::Value(value)) => tables_of(&value.of, &mut tables),
            Some(CheckKind::Bound(bound)) => tables_of(&bound.of, &mut tables),
            Some(CheckKind::Trend(trend)) => tables_of(&trend.of, &mut tables),
            Some(CheckKind::Measured(measured)) => tables_of(&measured.of, &mut tables),
            Some(CheckKind::Mode(_)) => tables.push(TableName::Modes),
            Some(CheckKind::Curve(curve)) => tables.push(curve.table),
            None => {}
        }
        let results = self.evaluator.results;
        for column in &check.filter.0 {
            let own = |name: &&TableName| results.table(**name).is_some_and(|table| table.has(&column.0));
            let first = tables.iter().find(own).or(tables.first());
            let table = first.and_then(|name| results.table(*name));
            self.evaluator
                .check_filter(&format!("{key}.where"), &Filter(vec![column.clone()]), table)?;
        }
        Ok(())
    }

    /// The combinations that a check is made for; the reason where there is none.
    fn combinations(&self, key: &str, check: &CheckSpec) -> Result<Result<Vec<Map<String, Value>>, String>, Refusal> {
        if check.each.is_empty() {
            return Ok(Ok(vec![Map::new()]));
        }
        let jobs = self.evaluator.results.jobs();
        for (j, column) in check.each.iter().enumerate() {
            self.job_column(&format!("{key}.each[{j}]"), column)?;
        }
        let (mut combinations, mut seen) = (Vec::new(), HashSet::new());
        for row in self.evaluator.jobs(&check.filter) {
            let of_row: Map<_, _> = check.each.iter().map(|c| (c.clone(), jobs.cell(c, row))).collect();
            if seen.insert(Value::from(of_row.clone()).to_string()) {
                combinations.push(of_row);
            }
        }
        Ok(if combinations.is_empty() {
            Err("no job matches".to_owned())
        } else {
            Ok(combinations)
        })
    }

    fn job_column(&self, key: &str, column: &str) -> Result<(), Refusal> {
        let jobs = self.evaluator.results.jobs();
        if jobs.has(column) {
            return Ok(());
        }
        let known: Vec<String> = jobs.names().map(str::to_owned).collect();
        Err(Refusal::unknown(self.evaluator.file, key, column, &known))
    }

    fn case(&self, key: &str, check: &CheckSpec, case: Map<String, Value>) -> Result<Case, Refusal> {
        let filter = case.iter().fold(check.filter.clone(), |filter, (column, value)| {
            filter.fixed(column, value)
        });
        self.evaluator.take_notes();
        let found = match check.kind() {
            Some(CheckKind::Value(v)) => {
                self.held(&format!("{key}.value.of"), &v.of, &filter, v.expected, v.tolerance())
            }
            Some(CheckKind::Mode(m)) => self.held(
                &format!("{key}.mode"),
                &m.quantity(),
                &filter,
                Some(m.expected_hz),
                m.tolerance(),
            ),
            Some(CheckKind::Measured(m)) => self.measured(&format!("{key}.measured.of"), m, &filter),
            Some(CheckKind::Bound(b)) => self.bound(&format!("{key}.bound.of"), b, &filter),
            Some(CheckKind::Trend(t)) => self.trend(&format!("{key}.trend"), t, &filter),
            Some(CheckKind::Curve(c)) => self.curve(&format!("{key}.curve"), c, &filter),
            None => Err(Trouble::Short("nothing to check".to_owned())),
        };
        let mut remarks = self.evaluator.take_notes();
        match found {
            Ok(found) => Ok({
                remarks.splice(0..0, found.reason);
                Case {
                    case,
                    values: found.values,
                    deviation: found.deviation,
                    margin: found.margin,
                    holds: found.holds,
                    reason: Some(remarks.join("; ")).filter(|text| !text.is_empty()),
                }
            }),
            Err(Trouble::Short(reason)) => Ok(Case::without_values(case, reason)),
            Err(Trouble::Refused(refusal)) => Err(refusal),
        }
    }

    /// `|got - expected|` within a tolerance.
    fn held(
        &self,
        key: &str,
        of: &Quantity,
        filter: &Filter,
        expected: Option<f64>,
        tolerance: Tolerance,
    ) -> Result<Finding, Trouble> {
        let got = self.evaluator.value(key, of, filter)?;
        Ok(expected.map_or_else(|| Finding::of(got), |expected| off(got, expected, tolerance)))
    }

    fn measured(&self, key: &str, check: &MeasuredCheck, filter: &Filter) -> Result<Finding, Trouble> {
        let band = Tolerance {
            relative: None,
            absolute: Some(check.uncertainty),
        };
        self.held(key, &check.of, filter, Some(check.value), band)
    }

    fn bound(&self, key: &str, check: &BoundCheck, filter: &Filter) -> Result<Finding, Trouble> {
        let got = self.evaluator.value(key, &check.of, filter)?;
        let lower = check.lower().map(|bound| (got - bound) / scale(bound));
        let upper = check.upper().map(|bound| (bound - got) / scale(bound));
        let margin = lower.into_iter().chain(upper).fold(f64::INFINITY, f64::min);
        let holds = check.at_least.is_none_or(|bound| got >= bound)
            && check.above.is_none_or(|bound| got > bound)
            && check.at_most.is_none_or(|bound| got <= bound)
            && check.below.is_none_or(|bound| got < bound);
        Ok(Finding {
            values: vec![got],
            margin: Some(margin),
            holds,
            ..Finding::default()
        })
    }

    fn trend(&self, key: &str, check: &TrendCheck, filter: &Filter) -> Result<Finding, Trouble> {
        self.job_column(&format!("{key}.along"), &check.along)?;
        let jobs = self.evaluator.results.jobs();
        self.evaluator
            .number_column(&format!("{key}.along"), jobs, &check.along)?;
        let meant = self.evaluator.jobs(filter);
        let along = meant.iter().map(|&row| jobs.number(&check.along, row));
        let Some(mut axis) = along.collect::<Option<Vec<f64>>>() else {
            return Err(Trouble::Short(format!("jobs that match have no {}", check.along)));
        };
        axis.sort_by(f64::total_cmp);
        axis.dedup();
        if axis.len() < 2 {
            return Err(Trouble::Short(format!(
                "{} values of {} match, a trend needs two",
                axis.len(),
                check.along
            )));
        }
        let at = |x: &f64| {
            self.evaluator.value(
                &format!("{key}.of"),
                &check.of,
                &filter.fixed(&check.along, &Value::from(*x)),
            )
        };
        let values = axis.iter().map(at).collect::<Result<Vec<f64>, Trouble>>()?;
        let (least, most) = (
            values.iter().copied().fold(f64::INFINITY, f64::min),
            values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        );
        let steps = |sign: f64| {
            let step = |w: &[f64]| sign * (w[1] - w[0]) / scale(w[0].abs().max(w[1].abs()));
            values.windows(2).map(step).fold(f64::INFINITY, f64::min)
        };
        let size = scale(least.abs().max(most.abs()));
        let (margin, holds) = match check.trend {
            Trend::Rises => (steps(1.0), steps(1.0) > 0.0),
            Trend::Falls => (steps(-1.0), steps(-1.0) > 0.0),
            Trend::Positive => (least / size, least > 0.0),
            Trend::Negative => (-most / size, most < 0.0),
            Trend::Flat => {
                let margin = check.within.unwrap_or_default() - (most - least) / scale(least);
                (margin, margin >= 0.0)
            }
        };
        Ok(Finding {
            values,
            margin: Some(margin),
            holds,
            ..Finding::default()
        })
    }

    fn curve(&self, key: &str, check: &CurveCheck, filter: &Filter) -> Result<Finding, Trouble> {
        let table = self.evaluator.table(key, check.table)?;
        self.evaluator
            .number_column(&format!("{key}.column"), table, &check.column)?;
        self.evaluator
            .number_column(&format!("{key}.against"), table, &check.against)?;
        let (rows, _) = self
            .evaluator
            .rows(&format!("{key}.where"), check.table, &Filter::default(), filter)?;
        let point = |&row: &usize| table.number(&check.against, row).zip(table.number(&check.column, row));
        let Some(mut run) = rows.iter().map(point).collect::<Option<Vec<(f64, f64)>>>() else {
            return Err(Trouble::Short(format!(
                "{} is empty in a row that matches",
                check.column
            )));
        };
        run.sort_by(|a, b| a.0.total_cmp(&b.0));
        if run.windows(2).any(|w| w[0].0 == w[1].0) {
            return Err(Trouble::Short(format!(
                "several rows with one {}: several jobs, or rows of other places, match",
                check.against
            )));
        }
        let largest = check.points.iter().map(|p| p[1].abs()).fold(0.0, f64::max);
        let allowed = check.tolerance().allowed(largest);
        let mut worst: Option<([f64; 2], f64)> = None;
        for &[x, y] in &check.points {
            let got = interpolated(&run, x)
                .ok_or_else(|| Trouble::Short(format!("{} {x} lies outside the rows that match", check.against)))?;
            if worst.is_none_or(|([_, y0], got0)| (got - y).abs() > (got0 - y0).abs()) {
                worst = Some(([x, y], got));
            }
        }
        let ([x, y], got) = worst.unwrap_or_default();
        let off = (got - y).abs();
        Ok(Finding {
            values: vec![got],
            deviation: Some((got - y) / scale(largest)),
            margin: Some((allowed - off) / scale(largest)),
            holds: off <= allowed,
            reason: Some(format!(
                "at {} {}, where {} is expected",
                check.against,
                number(x),
                number(y)
            )),
        })
    }
}

impl Finding {
    /// A value that nothing is expected of.
    fn of(got: f64) -> Self {
        Self {
            values: vec![got],
            holds: true,
            ..Self::default()
        }
    }
}

fn off(got: f64, expected: f64, tolerance: Tolerance) -> Finding {
    let (off, allowed) = (got - expected, tolerance.allowed(expected));
    let margin = (allowed - off.abs()) / scale(expected);
    Finding {
        values: vec![got],
        deviation: Some(off / scale(expected)),
        margin: (tolerance != Tolerance::default()).then_some(margin),
        holds: off.abs() <= allowed,
        reason: None,
    }
}

/// What a share is taken of; a share of nothing is taken in the unit itself.
fn scale(x: f64) -> f64 {
    if x == 0.0 { 1.0 } else { x.abs() }
}

fn interpolated(run: &[(f64, f64)], x: f64) -> Option<f64> {
    let tiny = 1e-9 * scale(x);
    let i = run.partition_point(|p| p.0 < x - tiny);
    let (x1, y1) = *run.get(i)?;
    if (x1 - x).abs() <= tiny {
        return Some(y1);
    }
    let (x0, y0) = *run.get(i.checked_sub(1)?)?;
    Some(y0 + (y1 - y0) * (x - x0) / (x1 - x0))
}

impl Case {
    fn without_values(case: Map<String, Value>, reason: String) -> Self {
        Self {
            case,
            values: Vec::new(),
            deviation: None,
            margin: None,
            holds: false,
            reason: Some(reason),
        }
    }
}

impl ModeCheck {
    fn quantity(&self) -> Quantity {
        let shape = Allowed::OneOf(vec![Value::from(self.shape.clone())]);
        Quantity::Select(SelectQuantity {
            table: TableName::Modes,
            column: "frequency_hz".to_owned(),
            filter: Filter(vec![("shape".to_owned(), shape)]),
            reduce: Reduction::Only,
        })
    }
}

/// The tables that a quantity looks at.
fn tables_of(quantity: &Quantity, tables: &mut Vec<TableName>) {
    match quantity {
        Quantity::Select(select) => tables.push(select.table),
        Quantity::History(_) => tables.push(TableName::Jobs),
        _ => quantity.parts().iter().for_each(|(_, part)| tables_of(part, tables)),
    }
}
