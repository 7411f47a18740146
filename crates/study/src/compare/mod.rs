//! Results held against a reference, or against older results.
//!
//! Knows what a check asks of tables and what becomes of it. Does not know how a comparison is written down.

mod expectation;
mod history;
mod judge;
mod line;
mod old;
mod quantity;
mod tolerances;

pub(crate) use judge::Judge;
pub use line::{Case, Comparison, Line, Verdict};
pub use old::against_old;
pub(crate) use quantity::Trouble;
pub use tolerances::Tolerances;

use crate::reference::Reference;
use crate::refusal::Refusal;
use crate::spec::Study;
use crate::tables::Results;

/// Refuses a reference that belongs to another study than the one of a name.
///
/// # Errors
/// [`Refusal`].
pub fn check_study(reference: &Reference, name: &str) -> Result<(), Refusal> {
    let Some(path) = reference.study() else {
        return Ok(());
    };
    let own = Study::open(&path)?.spec.name;
    if own == name {
        return Ok(());
    }
    let allowed = format!("results of '{own}', to which the reference belongs");
    Err(Refusal::new(
        &reference.file,
        "study",
        format!("results of the study '{name}'"),
        allowed,
    ))
}

/// Makes every check of a reference on results.
///
/// # Errors
/// [`Refusal`] where the reference belongs to another study, or names a column, word or job that the results do not have.
pub fn against_reference(results: &Results, reference: &Reference) -> Result<Comparison, Refusal> {
    check_study(reference, &results.name)?;
    let judge = Judge::new(results, reference);
    let lines = (0..reference.spec.checks.len())
        .map(|i| judge.line(i))
        .collect::<Result<_, _>>()?;
    Ok(Comparison {
        results: results.name.clone(),
        with: reference.spec.name.clone(),
        source: reference.spec.source.clone(),
        lines,
    })
}
