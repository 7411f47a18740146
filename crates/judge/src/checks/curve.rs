//! A check of a curve: a column runs along points, with linear interpolation between its rows.

use super::finding::{Finding, scale, tolerance_text};
use super::kind::{CheckCurve, CheckKind, Expectation};
use crate::quantity::{CheckInput, Evaluator, NoValue, Place, Tolerance};
use pontoon_plan::input::filter::Filter;
use pontoon_plan::input::{Refusal, RefusalKind};
use pontoon_results::TableName;
use pontoon_results::labels::all_digits;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A curve through points, held against a column with linear interpolation between its rows.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CurveCheck {
    /// The table.
    pub table: TableName,
    /// The column that runs along the curve.
    pub column: String,
    /// The column against which it runs: `position`, `x_m`, `time_s`, ...
    pub against: String,
    /// Points `[against, column]`, increasing in the first.
    #[schemars(length(min = 1))]
    pub points: Vec<[f64; 2]>,
    /// How far any point may be off as a share of the largest magnitude of the points.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub relative_tolerance: Option<f64>,
    /// How far any point may be off in its own unit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub absolute_tolerance: Option<f64>,
}

/// Digits of a point in a remark.
const DIGITS: usize = 4;

impl CurveCheck {
    fn tolerance(&self) -> Tolerance {
        Tolerance {
            relative: self.relative_tolerance,
            absolute: self.absolute_tolerance,
        }
    }

    /// The rows that a filter means as points, rising.
    fn run(&self, on: &Evaluator<'_>, filter: &Filter) -> Result<Vec<(f64, f64)>, NoValue> {
        let table = on.table(self.table)?;
        let (rows, _) = on.rows(self.table, filter)?;
        let point = |&row: &usize| table.number(&self.against, row).zip(table.number(&self.column, row));
        let run = rows.iter().map(point).collect::<Option<Vec<(f64, f64)>>>();
        let mut run = run.ok_or_else(|| NoValue::EmptyRow(self.column.clone()))?;
        run.sort_by(|a, b| a.0.total_cmp(&b.0));
        if run.windows(2).any(|w| w[0].0 == w[1].0) {
            return Err(NoValue::SeveralAt(self.against.clone()));
        }
        Ok(run)
    }
}

impl CheckKind for CurveCheck {
    fn refuse(&self, place: &Place<'_>) -> Result<(), Refusal> {
        place.tolerance("curve", self.tolerance())?;
        if self.points.is_empty() {
            return Err(place.refuse("curve.points", "an empty list", "at least one point"));
        }
        match (1..self.points.len()).find(|&i| self.points[i][0] <= self.points[i - 1][0]) {
            Some(i) => {
                let allowed = format!("above {}", self.points[i - 1][0]);
                let refused = place.refuse(&format!("curve.points[{i}][0]"), self.points[i][0], &allowed);
                Err(refused.because(RefusalKind::Conflict))
            }
            None => Ok(()),
        }
    }

    fn select(&self, input: &CheckInput<'_>) -> Result<(), Refusal> {
        let table = input.table(&input.at("curve.table"), self.table)?;
        input.number_column(&input.at("curve.column"), table, &self.column)?;
        input.number_column(&input.at("curve.against"), table, &self.against)?;
        input.filters(&input.at("curve"), &Filter::default(), Some(table))
    }

    fn evaluate(&self, on: &Evaluator<'_>, filter: &Filter) -> Result<Finding, NoValue> {
        let run = self.run(on, filter)?;
        let largest = self.points.iter().map(|p| p[1].abs()).fold(0.0, f64::max);
        let allowed = self.tolerance().allowed(largest);
        let mut worst: Option<([f64; 2], f64)> = None;
        for &[x, y] in &self.points {
            let got = interpolated(&run, x).ok_or_else(|| NoValue::Outside {
                against: self.against.clone(),
                x,
            })?;
            if worst.is_none_or(|([_, y0], got0)| (got - y).abs() > (got0 - y0).abs()) {
                worst = Some(([x, y], got));
            }
        }
        let ([x, y], got) = worst.unwrap_or_default();
        let off = (got - y).abs();
        let [x, expected] = [x, y].map(|x| all_digits(x, DIGITS));
        Ok(Finding {
            values: vec![got],
            deviation: Some((got - y) / scale(largest)),
            margin: Some((allowed - off) / scale(largest)),
            holds: off <= allowed,
            reason: Some(format!("at {} {x}, where {expected} is expected", self.against)),
        })
    }

    fn expected(&self) -> (String, Option<f64>) {
        let points = self.points.len();
        (
            format!("curve of {points} points{}", tolerance_text(self.tolerance())),
            None,
        )
    }

    fn expectation(&self) -> Expectation<'_> {
        Expectation::Curve(CheckCurve {
            table: self.table,
            column: &self.column,
            against: &self.against,
            points: &self.points,
        })
    }
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

#[cfg(test)]
mod tests {
    use super::*;

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
