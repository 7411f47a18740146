//! A check made on results: its cases, their margins, its verdict.
//!
//! Knows what each kind of check asks of its quantity. Does not know how a quantity is found.

use super::asked::Asked;
use super::expected::expected;
use super::line::{Case, Line, Verdict, number};
use super::quantity::Evaluator;
use crate::reference::{
    Allowed, BoundCheck, CheckKind, CheckSpec, CurveCheck, Filter, MeasuredCheck, ModeCheck, Quantity, Reduction,
    Reference, Role, SelectQuantity, Tolerance, Trend, TrendCheck,
};
use pontoon_plan::input::Refusal;
use pontoon_results::{Results, TableName};
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
            evaluator: Evaluator::new(results),
        }
    }

    /// Makes check number `i`.
    pub(super) fn line(&self, i: usize) -> Result<Line, Refusal> {
        self.asked(i).check()?;
        let check = &self.reference.spec.checks[i];
        let combinations = self.combinations(check);
        let cases: Vec<Case> = if combinations.is_empty() {
            vec![Case::without_values(Map::new(), "no job matches".to_owned())]
        } else {
            combinations.into_iter().map(|case| self.case(check, case)).collect()
        };
        let mut worst = &cases[0];
        for case in &cases[1..] {
            if case.is_worse_than(worst) {
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

    fn asked(&self, i: usize) -> Asked<'_> {
        Asked {
            results: self.evaluator.results,
            file: &self.reference.file,
            key: format!("checks[{i}]"),
            check: &self.reference.spec.checks[i],
        }
    }

    /// What check number `i` of one value finds; in the inner result an error where it finds nothing or is of another
    /// kind.
    ///
    /// # Errors
    /// [`Refusal`] where it names what the results cannot have.
    pub(crate) fn value(&self, i: usize) -> Result<Result<f64, String>, Refusal> {
        self.asked(i).check()?;
        let check = &self.reference.spec.checks[i];
        let quantity = match check.kind() {
            Some(CheckKind::Value(value)) => Some(value.of.clone()),
            Some(CheckKind::Mode(mode)) => Some(frequency_of(mode)),
            Some(CheckKind::Measured(measured)) => Some(measured.of.clone()),
            _ => None,
        };
        Ok(quantity
            .filter(|_| check.each.is_empty())
            .ok_or_else(|| "not a check of one value".to_owned())
            .and_then(|quantity| self.evaluator.value(&quantity, &check.filter)))
    }

    /// The combinations that a check is made for: one without columns where it has no `each`.
    fn combinations(&self, check: &CheckSpec) -> Vec<Map<String, Value>> {
        if check.each.is_empty() {
            return vec![Map::new()];
        }
        let jobs = self.evaluator.results.jobs();
        let (mut combinations, mut seen) = (Vec::new(), HashSet::new());
        for row in self.evaluator.jobs(&check.filter) {
            let of_row: Map<_, _> = check.each.iter().map(|c| (c.clone(), jobs.cell(c, row))).collect();
            if seen.insert(Value::from(of_row.clone()).to_string()) {
                combinations.push(of_row);
            }
        }
        combinations
    }

    fn case(&self, check: &CheckSpec, case: Map<String, Value>) -> Case {
        let filter = case.iter().fold(check.filter.clone(), |filter, (column, value)| {
            filter.fixed(column, value)
        });
        self.evaluator.take_notes();
        let found = match check.kind() {
            Some(CheckKind::Value(v)) => self.held(&v.of, &filter, v.expected, v.tolerance()),
            Some(CheckKind::Mode(m)) => self.held(&frequency_of(m), &filter, Some(m.expected_hz), m.tolerance()),
            Some(CheckKind::Measured(m)) => self.measured(m, &filter),
            Some(CheckKind::Bound(b)) => self.bound(b, &filter),
            Some(CheckKind::Trend(t)) => self.trend(t, &filter),
            Some(CheckKind::Curve(c)) => self.curve(c, &filter),
            None => Err("nothing to check".to_owned()),
        };
        let notes = self.evaluator.take_notes();
        match found {
            Ok(found) => Case {
                case,
                values: found.values,
                deviation: found.deviation,
                margin: found.margin,
                holds: found.holds,
                reason: found.reason.into_iter().chain(notes).reduce(|a, b| format!("{a}; {b}")),
            },
            Err(reason) => Case::without_values(case, reason),
        }
    }

    /// `|got - expected|` within a tolerance.
    fn held(
        &self,
        of: &Quantity,
        filter: &Filter,
        expected: Option<f64>,
        tolerance: Tolerance,
    ) -> Result<Finding, String> {
        let got = self.evaluator.value(of, filter)?;
        Ok(expected.map_or_else(|| Finding::of(got), |expected| off(got, expected, tolerance)))
    }

    fn measured(&self, check: &MeasuredCheck, filter: &Filter) -> Result<Finding, String> {
        let band = Tolerance {
            relative: None,
            absolute: Some(check.uncertainty),
        };
        self.held(&check.of, filter, Some(check.value), band)
    }

    fn bound(&self, check: &BoundCheck, filter: &Filter) -> Result<Finding, String> {
        let got = self.evaluator.value(&check.of, filter)?;
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

    fn trend(&self, check: &TrendCheck, filter: &Filter) -> Result<Finding, String> {
        let jobs = self.evaluator.results.jobs();
        let meant = self.evaluator.jobs(filter);
        let along = meant.iter().map(|&row| jobs.number(&check.along, row));
        let Some(mut axis) = along.collect::<Option<Vec<f64>>>() else {
            return Err(format!("jobs that match have no {}", check.along));
        };
        axis.sort_by(f64::total_cmp);
        axis.dedup();
        if axis.len() < 2 {
            return Err(format!(
                "{} values of {} match, a trend needs two",
                axis.len(),
                check.along
            ));
        }
        let at = |x: &f64| {
            let filter = filter.fixed(&check.along, &Value::from(*x));
            self.evaluator.value(&check.of, &filter)
        };
        let values = axis.iter().map(at).collect::<Result<Vec<f64>, String>>()?;
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

    fn curve(&self, check: &CurveCheck, filter: &Filter) -> Result<Finding, String> {
        let table = self.evaluator.table(check.table)?;
        let (rows, _) = self.evaluator.rows(check.table, filter)?;
        let point = |&row: &usize| table.number(&check.against, row).zip(table.number(&check.column, row));
        let Some(mut run) = rows.iter().map(point).collect::<Option<Vec<(f64, f64)>>>() else {
            return Err(format!("{} is empty in a row that matches", check.column));
        };
        run.sort_by(|a, b| a.0.total_cmp(&b.0));
        if run.windows(2).any(|w| w[0].0 == w[1].0) {
            return Err(format!("several rows with one {}: several jobs match", check.against));
        }
        let largest = check.points.iter().map(|p| p[1].abs()).fold(0.0, f64::max);
        let allowed = check.tolerance().allowed(largest);
        let mut worst: Option<([f64; 2], f64)> = None;
        for &[x, y] in &check.points {
            let got = interpolated(&run, x)
                .ok_or_else(|| format!("{} {x} lies outside the rows that match", check.against))?;
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
    /// A value of which nothing is expected.
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

/// The frequency that a check of a mode looks at.
fn frequency_of(mode: &ModeCheck) -> Quantity {
    let shape = Allowed::OneOf(vec![Value::from(mode.shape.clone())]);
    Quantity::Select(SelectQuantity {
        table: TableName::Modes,
        column: "frequency_hz".to_owned(),
        filter: Filter(vec![("shape".to_owned(), shape)]),
        reduce: Reduction::Only,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tolerance(relative: Option<f64>, absolute: Option<f64>) -> Tolerance {
        Tolerance { relative, absolute }
    }

    #[test]
    fn a_margin_is_what_the_tolerance_leaves() {
        let within = off(1.02, 1.0, tolerance(Some(0.05), None));
        assert!(within.holds && (within.margin.unwrap() - 0.03).abs() < 1e-12);
        let beyond = off(0.94, 1.0, tolerance(Some(0.05), None));
        assert!(!beyond.holds && (beyond.margin.unwrap() + 0.01).abs() < 1e-12);
        assert!((beyond.deviation.unwrap() + 0.06).abs() < 1e-12);
        // a share of the magnitude: what is expected below zero has the same room
        assert!(off(-1.04, -1.0, tolerance(Some(0.05), None)).holds);
        // on the edge it holds still
        assert!(off(1.5, 1.0, tolerance(None, Some(0.5))).holds);
    }

    #[test]
    fn the_wider_tolerance_counts_and_nothing_is_expected_in_its_own_unit() {
        assert!(off(1.04, 1.0, tolerance(Some(0.01), Some(0.05))).holds);
        assert!(off(1.04, 1.0, tolerance(Some(0.05), Some(0.01))).holds);
        let of_nothing = off(0.02, 0.0, tolerance(Some(0.5), Some(0.03)));
        assert!(of_nothing.holds && (of_nothing.margin.unwrap() - 0.01).abs() < 1e-12);
        assert!(!off(1e-9, 0.0, tolerance(Some(0.5), None)).holds);
    }

    #[test]
    fn without_a_tolerance_there_is_no_margin() {
        let record = off(1.3, 1.0, Tolerance::default());
        assert!(record.margin.is_none() && (record.deviation.unwrap() - 0.3).abs() < 1e-12);
    }

    #[test]
    fn between_rows_is_a_line_and_outside_them_nothing() {
        let run = [(0.0, 1.0), (2.0, 3.0), (3.0, -1.0)];
        for (x, y) in [
            (0.0, Some(1.0)),
            (1.0, Some(2.0)),
            (2.0, Some(3.0)),
            (2.5, Some(1.0)),
            (3.0, Some(-1.0)),
        ] {
            assert_eq!(interpolated(&run, x), y, "{x}");
        }
        // a point of a file differs from a row in its last bits
        assert_eq!(interpolated(&run, 3.0 + 1e-12), Some(-1.0));
        assert_eq!(
            (
                interpolated(&run, -0.1),
                interpolated(&run, 3.1),
                interpolated(&[], 0.0)
            ),
            (None, None, None)
        );
    }
}
