//! Results held against a reference, or against older results.
//!
//! Knows what a check asks of tables and what becomes of it. Does not know how a comparison is written down.

mod baseline;
mod check_result;
mod judge;
mod tolerances;

pub use baseline::against_baseline;
pub use check_result::{Case, CaseColumns, CheckResult, Comparison, Verdict};
pub(crate) use judge::ReferenceJudge;
pub use tolerances::Tolerances;

use crate::reference::Reference;
use pontoon_plan::input::Refusal;
use pontoon_plan::study_file::Study;
use pontoon_results::Results;

/// Makes every check of a reference on results.
///
/// # Errors
/// [`Refusal`] where the reference belongs to another study, or names a column, word or job that the results do not have.
pub fn against_reference(results: &Results, reference: &Reference) -> Result<Comparison, Refusal> {
    let study = reference.study_of(&results.name, &results.place)?;
    let judge = ReferenceJudge::new(results, reference);
    let lines = (0..reference.checks.len())
        .map(|i| judge.line(i))
        .collect::<Result<_, _>>()?;
    Ok(Comparison {
        results: results.name.clone(),
        with: reference.name.clone(),
        source: reference.source.clone(),
        notes: study.map(|study| changes(results, &study)).unwrap_or_default(),
        lines,
    })
}

/// What of a study has changed since its results.
fn changes(results: &Results, study: &Study) -> Vec<String> {
    let now = [("study", &study.document), ("bridge", &study.bridge.document)];
    let then = results.documents.hashes();
    let differ = now.iter().zip(then).filter(|((_, now), then)| now.hash() != *then);
    differ
        .map(|((what, _), _)| format!("the {what} has changed since these results: run it again"))
        .collect()
}
