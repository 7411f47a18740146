//! The checks of a reference made on results: their cases, and the verdict of each.
//!
//! Knows cases and roles. Does not know what any kind of check asks, nor how a quantity is found.

use super::check_result::{Case, CaseColumns, CheckResult, Verdict};
use crate::checks::{Check, Role};
use crate::quantity::{CheckInput, Evaluator, NoValue};
use crate::reference::Reference;
use pontoon_plan::input::Refusal;
use pontoon_results::Results;
use std::collections::HashSet;

/// Makes the checks of one reference on results.
pub(crate) struct ReferenceJudge<'a> {
    reference: &'a Reference,
    evaluator: Evaluator<'a>,
}

impl<'a> ReferenceJudge<'a> {
    pub(crate) fn new(results: &'a Results, reference: &'a Reference) -> Self {
        Self {
            reference,
            evaluator: Evaluator::new(results),
        }
    }

    /// Makes check number `i`.
    pub(super) fn line(&self, i: usize) -> Result<CheckResult, Refusal> {
        let check = self.selected(i)?;
        let combinations = self.combinations(check);
        let cases: Vec<Case> = if combinations.is_empty() {
            vec![Case::without_values(CaseColumns::default(), NoValue::NoJob.to_string())]
        } else {
            combinations.into_iter().map(|case| self.case(check, case)).collect()
        };
        let mut worst = &cases[0];
        for case in &cases[1..] {
            if case.is_worse_than(worst) {
                worst = case;
            }
        }
        let (expected, expected_value) = check.kind.of().expected();
        Ok(CheckResult {
            id: check.id.clone(),
            statement: check.statement.clone(),
            role: check.role,
            expected,
            expected_value,
            verdict: verdict(check.role, &cases),
            worst: worst.clone(),
            cases: if cases.len() > 1 { cases } else { Vec::new() },
        })
    }

    /// Check number `i`, refused where it names what the results cannot have.
    fn selected(&self, i: usize) -> Result<&'a Check, Refusal> {
        let check = &self.reference.checks[i];
        check.select(&CheckInput {
            results: self.evaluator.results,
            file: &self.reference.file,
            key: format!("checks[{i}]"),
            filter: &check.filter,
            each: &check.each,
        })?;
        Ok(check)
    }

    /// What check number `i` of one value finds; in the inner result an error where it finds nothing or is of another
    /// kind.
    ///
    /// # Errors
    /// [`Refusal`] where it names what the results cannot have.
    pub(crate) fn value(&self, i: usize) -> Result<Result<f64, NoValue>, Refusal> {
        let check = self.selected(i)?;
        Ok(match check.one_value() {
            Some(one) => self.evaluator.value(&one.of, &check.filter),
            None => Err(NoValue::NotOneValue),
        })
    }

    /// The combinations that a check is made for: one without columns where it has no `each`.
    fn combinations(&self, check: &Check) -> Vec<CaseColumns> {
        if check.each.is_empty() {
            return vec![CaseColumns::default()];
        }
        let jobs = self.evaluator.results.jobs();
        let mut each: Vec<&String> = Vec::new();
        for column in &check.each {
            if !each.contains(&column) {
                each.push(column);
            }
        }
        let (mut combinations, mut seen) = (Vec::new(), HashSet::new());
        for row in self.evaluator.jobs(&check.filter) {
            let cells: Vec<_> = each.iter().map(|column| jobs.cell(column, row).owned()).collect();
            if seen.insert(cells.clone()) {
                combinations.push(CaseColumns(each.iter().copied().cloned().zip(cells).collect()));
            }
        }
        combinations
    }

    fn case(&self, check: &Check, case: CaseColumns) -> Case {
        let filter = case.0.iter().fold(check.filter.clone(), |filter, (column, cell)| {
            filter.fixed(column, cell)
        });
        self.evaluator.take_notes();
        let found = check.kind.of().evaluate(&self.evaluator, &filter);
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
            Err(reason) => Case::without_values(case, reason.to_string()),
        }
    }
}

/// What becomes of a check with these cases.
fn verdict(role: Role, cases: &[Case]) -> Verdict {
    let empty = cases.iter().any(|case| case.values.is_empty());
    match (role, empty, cases.iter().all(|case| case.holds)) {
        (_, true, _) | (Role::Hold, false, false) => Verdict::FallsShort,
        (Role::Hold, false, true) => Verdict::Holds,
        (Role::ExpectedFail, false, false) => Verdict::ExpectedFail,
        (Role::ExpectedFail, false, true) => Verdict::NowHolds,
        (Role::Record, false, _) => Verdict::Record,
    }
}
