//! The search: from the start to the best point, in rounds of the optimiser.
//!
//! Close to a bound the change of variable makes the optimiser slow. So a parameter within a hundredth of its bound
//! that is pushed outwards is left alone, and moved onto the bound when the others have settled; there it stays, as
//! cos(u) is zero. A parameter that is pulled inside from its bound is moved off it. Rounds follow until there is
//! neither: the conditions of Kuhn and Tucker (Bjorck 1996, chapter 5).
//!
//! Knows the optimiser's settings and endings. Does not know standard errors.

use levenberg_marquardt::{LevenbergMarquardt, TerminationReason};

use super::evaluation::{Evaluation, JacobianColumns, ModelEvaluator};
use super::problem::{LeastSquares, Notes, PULL, outward_cosine};
use super::variable::nudged;
use super::{FitError, Parameter, Settings};

/// First trust region, as a share of the norm of u; u lies around 2 pi, so this is up to a third of the width.
const STEP_BOUND: f64 = 0.1;
/// Searches from a point where parameters were moved onto bounds or off them.
const ROUNDS: usize = 10;
/// A parameter closer to a bound than this share of the width is next to it.
const ON_BOUND_SHARE: f64 = 1e-4;
/// A parameter closer to a bound than this share of the width, and pushed outwards, is left alone and then moved onto
/// it.
const SNAP_SHARE: f64 = 0.01;
/// Where that made the sum of squares larger, the next round leaves alone only from this many times closer, ...
const CLOSER: f64 = 0.01;
/// ... until closer than this share.
const CLOSEST_SHARE: f64 = 1e-7;

/// Why a search ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StopReason {
    /// All residuals are zero.
    ResidualsZero,
    /// The residuals are orthogonal to every column of the Jacobian.
    Orthogonal,
    /// The sum of squares changes no more.
    SumOfSquaresSettled,
    /// The parameters change no more.
    ParametersSettled,
    /// The limit of evaluations was reached.
    EvaluationsLimit,
    /// Steps became tiny because the model fails at the points that the search wants to go to.
    StoppedByFailures,
    /// A parameter lies close to a bound that the residuals pull it away from.
    StuckNearBound,
    /// The model fails on both sides of the best point: the search was blind to a parameter.
    Blind,
    /// No parameter changes the residuals.
    NoInfluence,
    /// Numbers too large or too small for the optimiser.
    Numerical,
}

impl StopReason {
    /// Whether the best point is a minimum, as far as the tolerance tells.
    pub fn converged(self) -> bool {
        matches!(
            self,
            Self::ResidualsZero | Self::Orthogonal | Self::SumOfSquaresSettled | Self::ParametersSettled
        )
    }

    /// In words.
    pub fn text(self) -> &'static str {
        match self {
            Self::ResidualsZero => "all residuals are zero",
            Self::Orthogonal => "the residuals are orthogonal to all derivatives",
            Self::SumOfSquaresSettled => "the sum of squares changes no more",
            Self::ParametersSettled => "the parameters change no more",
            Self::EvaluationsLimit => "the limit of model evaluations was reached",
            Self::StoppedByFailures => "the model fails at the points that the search wants to go to",
            Self::StuckNearBound => "a parameter lies close to a bound that the residuals pull it away from",
            Self::Blind => "the model fails on both sides of the best point, so that a parameter has no derivative",
            Self::NoInfluence => "no parameter changes the residuals",
            Self::Numerical => "numbers too large or too small for the optimiser",
        }
    }
}

/// What a search found.
pub(super) struct SearchResult {
    /// The start as given.
    pub start: Evaluation,
    /// The best of all points tried.
    pub best: Evaluation,
    /// Columns of the Jacobian at the best point, see [`ModelEvaluator::jacobian`].
    pub columns: JacobianColumns,
    /// Why it ended.
    pub ending: StopReason,
}

/// Searches from the start of the parameters.
pub(super) fn search(evaluator: &mut ModelEvaluator<'_>, settings: &Settings) -> Result<SearchResult, FitError> {
    let parameters = evaluator.parameters;
    let (start, mut from) = starts(evaluator)?;
    let optimiser = optimiser(settings);
    let mut best = if start.is_no_worse_than(&from) {
        start.clone()
    } else {
        from.clone()
    };
    let (mut rounds, mut left_alone_share) = (0, SNAP_SHARE);
    loop {
        rounds += 1;
        let problem = LeastSquares::new(evaluator, settings.evaluations_limit, left_alone_share, best, from);
        let (problem, report) = optimiser.minimize(problem);
        let (ended_at, notes) = problem.into_parts();
        best = snapped(evaluator, notes.best.clone());
        let columns = match &notes.columns {
            Some((point, columns)) if *point == best.point => columns.clone(),
            _ => evaluator.jacobian(&best),
        };
        let pulled = pulled_inside(parameters, &best, &columns);
        let ending = ending(&report.termination, &notes, &columns, !pulled.is_empty());
        let is_short_of_bound = is_short_of_bound(parameters, &best, &columns, left_alone_share);
        if is_short_of_bound {
            left_alone_share *= CLOSER;
        }
        let is_open = match ending {
            StopReason::StuckNearBound => true,
            _ if !ending.converged() => false,
            _ => best.point != ended_at || (is_short_of_bound && left_alone_share > CLOSEST_SHARE),
        };
        let next = if is_open && rounds < ROUNDS {
            released(evaluator, &best, &pulled)
        } else {
            None
        };
        match next {
            Some(next) => from = next,
            None => {
                return Ok(SearchResult {
                    start,
                    best,
                    columns,
                    ending,
                });
            }
        }
    }
}

/// Asks the model at the start as given, and at the start with parameters on a bound moved inside, from which the first
/// round goes.
fn starts(evaluator: &mut ModelEvaluator<'_>) -> Result<(Evaluation, Evaluation), FitError> {
    let parameters = evaluator.parameters;
    let start: Vec<f64> = parameters.iter().map(|parameter| parameter.start).collect();
    let moved: Vec<f64> = parameters
        .iter()
        .map(|parameter| nudged(parameter, parameter.start))
        .collect();
    let points = if moved == start {
        vec![start]
    } else {
        vec![start, moved]
    };
    let mut answers = evaluate_start(evaluator, points)?;
    let from = answers.pop().ok_or(FitError::NoResiduals)?;
    let start = answers.pop().unwrap_or_else(|| from.clone());
    if start.residuals.is_empty() {
        return Err(FitError::NoResiduals);
    }
    Ok((start, from))
}

/// Sets up the optimiser of every round.
fn optimiser(settings: &Settings) -> LevenbergMarquardt<f64> {
    LevenbergMarquardt::new()
        .with_ftol(settings.tolerance)
        .with_xtol(settings.tolerance)
        .with_gtol(settings.tolerance)
        .with_stepbound(STEP_BOUND)
        // The bounds are the scale: an undetermined parameter then stays near its start.
        .with_scale_diag(false)
        // The limit is kept by the problem; patience is that many evaluations for each parameter.
        .with_patience(settings.evaluations_limit.min(1_000_000))
}

/// Tells whether the search left a parameter alone short of its bound: off it by less than `left_alone_share` of the width,
/// and pushed outwards.
fn is_short_of_bound(
    parameters: &[Parameter],
    best: &Evaluation,
    columns: &JacobianColumns,
    left_alone_share: f64,
) -> bool {
    parameters
        .iter()
        .zip(&best.point)
        .zip(columns)
        .any(|((parameter, &x), column)| {
            let share = parameter.share_from_bound(x);
            let outward = || outward_cosine(parameter, x, column.as_deref(), &best.residuals);
            share > 0.0 && share < left_alone_share && outward() > PULL
        })
}

/// Parameters on or next to a bound that would lower the sum of squares by going inside.
fn pulled_inside(parameters: &[Parameter], best: &Evaluation, columns: &[Option<Vec<f64>>]) -> Vec<usize> {
    (0..parameters.len())
        .filter(|&k| parameters[k].share_from_bound(best.point[k]) < ON_BOUND_SHARE)
        .filter(|&k| outward_cosine(&parameters[k], best.point[k], columns[k].as_deref(), &best.residuals) < -PULL)
        .collect()
}

/// `best` with the parameters that are pulled inside moved there; `None` where the model fails.
fn released(evaluator: &mut ModelEvaluator<'_>, best: &Evaluation, pulled: &[usize]) -> Option<Evaluation> {
    if pulled.is_empty() {
        return Some(best.clone());
    }
    let mut point = best.point.clone();
    for &k in pulled {
        point[k] = nudged(&evaluator.parameters[k], point[k]);
    }
    evaluator.answers(vec![point]).pop().flatten()
}

fn ending(termination: &TerminationReason, notes: &Notes, columns: &JacobianColumns, is_pulled: bool) -> StopReason {
    match termination {
        _ if notes.limit_reached => StopReason::EvaluationsLimit,
        TerminationReason::ResidualsZero => StopReason::ResidualsZero,
        _ if columns.iter().any(Option::is_none) => StopReason::Blind,
        _ if columns.iter().flatten().flatten().all(|&slope| slope == 0.0) => StopReason::NoInfluence,
        TerminationReason::Converged { ftol: false, .. } if notes.trial_failed => StopReason::StoppedByFailures,
        TerminationReason::LostPatience => StopReason::EvaluationsLimit,
        TerminationReason::Orthogonal | TerminationReason::Converged { .. } if is_pulled => StopReason::StuckNearBound,
        TerminationReason::Orthogonal => StopReason::Orthogonal,
        TerminationReason::Converged { ftol: true, .. } => StopReason::SumOfSquaresSettled,
        TerminationReason::Converged { .. } => StopReason::ParametersSettled,
        _ => StopReason::Numerical,
    }
}

fn evaluate_start(evaluator: &mut ModelEvaluator<'_>, points: Vec<Vec<f64>>) -> Result<Vec<Evaluation>, FitError> {
    let answers = evaluator.answers(points);
    if let Some(failed) = evaluator.failed.first() {
        return Err(FitError::Start {
            parameters: failed.parameters.clone(),
            reason: failed.reason.clone(),
        });
    }
    Ok(answers.into_iter().flatten().collect())
}

/// The best of `best` and what comes of moving its parameters that are close to a bound onto it: each alone, then all
/// together that were better alone.
fn snapped(evaluator: &mut ModelEvaluator<'_>, best: Evaluation) -> Evaluation {
    let parameters = evaluator.parameters;
    let bound = |k: usize| parameters[k].nearer_bound(best.point[k]);
    let with_on_bound = |moved: &[usize]| -> Vec<f64> {
        (0..best.point.len())
            .map(|k| if moved.contains(&k) { bound(k) } else { best.point[k] })
            .collect()
    };
    let close: Vec<usize> = (0..best.point.len())
        .filter(|&k| {
            let distance = (best.point[k] - bound(k)).abs();
            distance > 0.0 && distance < SNAP_SHARE * parameters[k].width()
        })
        .collect();
    let alone: Vec<Vec<f64>> = close.iter().map(|&k| with_on_bound(&[k])).collect();
    let mut candidates = Vec::new();
    let mut moved = Vec::new();
    for (k, answer) in close.into_iter().zip(evaluator.answers(alone)) {
        let Some(answer) = answer.filter(|answer| !best.is_no_worse_than(answer)) else {
            continue;
        };
        moved.push(k);
        candidates.push(answer);
    }
    if moved.len() > 1 {
        candidates.extend(evaluator.answers(vec![with_on_bound(&moved)]).into_iter().flatten());
    }
    candidates.into_iter().fold(
        best,
        |best, answer| if best.is_no_worse_than(&answer) { best } else { answer },
    )
}
