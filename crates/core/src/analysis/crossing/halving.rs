//! Steps that are halved where their contact does not settle, the same way for both solvers.
//!
//! Knows instants and halves. Does not know how a step is solved.

use crate::analysis::AnalysisError;
use crate::contact::NotSettled;

/// What can step from one instant to another at a step length halved so many times.
pub(super) trait Halving {
    /// Halvings allowed.
    fn limit(&self) -> usize;

    /// Takes a step; where its contact does not settle it stands as before.
    ///
    /// # Errors
    /// [`AnalysisError`] of what no smaller step helps.
    fn step(&mut self, to_s: f64, halvings: usize) -> Result<Result<(), NotSettled>, AnalysisError>;

    /// Takes note of a step that is halved.
    fn record_bisection(&mut self, stuck: NotSettled);

    /// The error of a step that may be halved no more.
    fn not_converged(&self, stuck: NotSettled, time_s: f64, bisections: usize) -> AnalysisError;
}

/// Steps over a span of time, in halves where it does not settle.
///
/// # Errors
/// [`AnalysisError::NotConverged`] beyond the limit; what a step ends with.
pub(super) fn advance(solver: &mut impl Halving, span_s: [f64; 2], halvings: usize) -> Result<(), AnalysisError> {
    match solver.step(span_s[1], halvings)? {
        Ok(()) => Ok(()),
        Err(stuck) => halve(solver, stuck, span_s, halvings),
    }
}

/// The two halves of a span whose step did not settle after so many halvings.
///
/// # Errors
/// As [`advance`].
pub(super) fn halve(
    solver: &mut impl Halving,
    stuck: NotSettled,
    [from_s, to_s]: [f64; 2],
    halvings: usize,
) -> Result<(), AnalysisError> {
    if halvings == solver.limit() {
        return Err(solver.not_converged(stuck, to_s, halvings));
    }
    solver.record_bisection(stuck);
    let middle_s = from_s + 0.5 * (to_s - from_s);
    advance(solver, [from_s, middle_s], halvings + 1)?;
    advance(solver, [middle_s, to_s], halvings + 1)
}
