//! Calls of the model: batches of points, their count, the points where it failed, and derivatives by differences.
//!
//! Knows the model, the bounds and the step of the differences. Does not know where a search goes, nor why.

use super::{Differences, ModelError, ModelFn, Parameter, Settings, sum_of_squares};

/// What a point was asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// A step of the search.
    Trial,
    /// A difference by the parameter of this index.
    Difference(usize),
}

/// A point inside the bounds at which the model gave no usable residuals.
#[derive(Clone, Debug, PartialEq)]
pub struct FailedPoint {
    /// The parameters.
    pub parameters: Vec<f64>,
    /// What the model said, or what was wrong with its answer.
    pub reason: String,
    /// What the point was asked for.
    pub purpose: Purpose,
}

/// A point and what the model answered there.
#[derive(Clone, Debug)]
pub(super) struct Evaluation {
    /// The parameters.
    pub point: Vec<f64>,
    /// The scaled residuals.
    pub residuals: Vec<f64>,
}

impl Evaluation {
    /// Whether the sum of squares is as low as that of `other`, or lower.
    pub(super) fn is_no_worse_than(&self, other: &Self) -> bool {
        sum_of_squares(&self.residuals) <= sum_of_squares(&other.residuals)
    }
}

/// Columns of a Jacobian, one a parameter; `None` where no derivative could be formed.
pub(super) type JacobianColumns = Vec<Option<Vec<f64>>>;

/// The model with its book-keeping.
pub(super) struct ModelEvaluator<'a> {
    /// The parameters.
    pub parameters: &'a [Parameter],
    /// Points asked for so far.
    pub evaluations: usize,
    /// Points at which the model failed so far.
    pub failed: Vec<FailedPoint>,
    model: &'a ModelFn<'a>,
    difference_share: f64,
    differences: Differences,
    residual_count: Option<usize>,
    known: Vec<(Vec<f64>, Option<Vec<f64>>)>,
}

impl<'a> ModelEvaluator<'a> {
    /// A model that has not been asked yet.
    pub(super) fn new(parameters: &'a [Parameter], model: &'a ModelFn<'a>, settings: &Settings) -> Self {
        Self {
            parameters,
            model,
            difference_share: settings.difference_share,
            differences: settings.differences,
            evaluations: 0,
            failed: Vec::new(),
            residual_count: None,
            known: Vec::new(),
        }
    }

    /// Residuals at `points`, `None` where the model fails, which goes into the list of failures. The model is asked
    /// for all of them at once, but for those that it was asked for before.
    pub(super) fn evaluate(
        &mut self,
        points: &[Vec<f64>],
        purpose: impl Fn(usize) -> Purpose,
    ) -> Vec<Option<Vec<f64>>> {
        let is_new = |k: &usize| self.known.iter().all(|(point, _)| *point != points[*k]);
        let new: Vec<usize> = (0..points.len()).filter(is_new).collect();
        let batch: Vec<Vec<f64>> = new.iter().map(|&k| points[k].clone()).collect();
        let count = batch.len();
        let mut answers = if batch.is_empty() {
            Vec::new()
        } else {
            (self.model)(&batch)
        }
        .into_iter();
        self.evaluations += count;
        for (i, (k, point)) in new.into_iter().zip(batch).enumerate() {
            let answer = answers
                .next()
                .unwrap_or_else(|| Err(ModelError(format!("no answer for point {i} of {count}"))));
            let residuals = match answer.and_then(|found| usable(found, self.residual_count)) {
                Ok(found) => {
                    self.residual_count = Some(found.len());
                    Some(found)
                }
                Err(ModelError(reason)) => {
                    self.failed.push(FailedPoint {
                        parameters: point.clone(),
                        reason,
                        purpose: purpose(k),
                    });
                    None
                }
            };
            self.known.push((point, residuals));
        }
        let lookup = |wanted: &Vec<f64>| self.known.iter().find(|(point, _)| point == wanted);
        points
            .iter()
            .map(|point| lookup(point).and_then(|(_, residuals)| residuals.clone()))
            .collect()
    }

    /// [`Self::evaluate`] for trial points, the answers with their points.
    pub(super) fn answers(&mut self, points: Vec<Vec<f64>>) -> Vec<Option<Evaluation>> {
        let answers = self.evaluate(&points, |_| Purpose::Trial);
        points
            .into_iter()
            .zip(answers)
            .map(|(point, r)| r.map(|residuals| Evaluation { point, residuals }))
            .collect()
    }

    /// Points in the first batch of a Jacobian at `point`.
    pub(super) fn jacobian_batch(&self, point: &[f64]) -> usize {
        (0..point.len()).map(|k| self.first_sides(point, k).len()).sum()
    }

    /// Columns of the Jacobian at `at`, by parameters in widths between their bounds; `None` where the model fails on
    /// both sides. One batch; a second one for the other sides of those that failed.
    pub(super) fn jacobian(&mut self, at: &Evaluation) -> JacobianColumns {
        let count = at.point.len();
        let mut sides: Vec<Vec<Evaluation>> = vec![Vec::new(); count];
        let first: Vec<(usize, Vec<f64>)> = (0..count)
            .flat_map(|k| self.first_sides(&at.point, k).into_iter().map(move |p| (k, p)))
            .collect();
        self.ask(first, &mut sides);
        if self.differences == Differences::Forward {
            // The lower side is a second choice only where the upper one, the first choice, has room.
            let other = (0..count)
                .filter(|&k| sides[k].is_empty() && self.neighbour(&at.point, k, 1.0).is_some())
                .filter_map(|k| self.neighbour(&at.point, k, -1.0).map(|p| (k, p)))
                .collect();
            self.ask(other, &mut sides);
        }
        let column = |k: usize, from: &Evaluation, to: &Evaluation| {
            let step = (to.point[k] - from.point[k]) / self.parameters[k].width();
            from.residuals
                .iter()
                .zip(&to.residuals)
                .map(|(a, b)| (b - a) / step)
                .collect()
        };
        (0..count)
            .map(|k| match sides[k].as_slice() {
                [] => None,
                [only] => Some(column(k, at, only)),
                [upper, lower, ..] => Some(column(k, lower, upper)),
            })
            .collect()
    }

    fn ask(&mut self, wanted: Vec<(usize, Vec<f64>)>, sides: &mut [Vec<Evaluation>]) {
        let (owners, points): (Vec<usize>, Vec<Vec<f64>>) = wanted.into_iter().unzip();
        let answers = self.evaluate(&points, |i| Purpose::Difference(owners[i]));
        for ((k, point), residuals) in owners.into_iter().zip(points).zip(answers) {
            sides[k].extend(residuals.map(|residuals| Evaluation { point, residuals }));
        }
    }

    fn first_sides(&self, point: &[f64], k: usize) -> Vec<Vec<f64>> {
        let [upper, lower] = [1.0, -1.0].map(|side| self.neighbour(point, k, side));
        match self.differences {
            Differences::Forward => upper.or(lower).into_iter().collect(),
            Differences::Central => upper.into_iter().chain(lower).collect(),
        }
    }

    /// The point one difference step away by parameter `k`; `None` where that leaves the bounds.
    fn neighbour(&self, point: &[f64], k: usize, side: f64) -> Option<Vec<f64>> {
        let parameter = &self.parameters[k];
        let moved = point[k] + side * self.difference_share * parameter.width();
        let inside = (parameter.lower..=parameter.upper).contains(&moved) && moved != point[k];
        inside.then(|| {
            point
                .iter()
                .enumerate()
                .map(|(i, &x)| if i == k { moved } else { x })
                .collect()
        })
    }
}

/// Residuals that are all finite and as many as before, else what is wrong with them.
fn usable(residuals: Vec<f64>, wanted: Option<usize>) -> Result<Vec<f64>, ModelError> {
    if let Some(wanted) = wanted.filter(|&wanted| wanted != residuals.len()) {
        let reason = format!("{} residuals where {wanted} came before", residuals.len());
        return Err(ModelError(reason));
    }
    match residuals.iter().position(|r| !r.is_finite()) {
        Some(k) => Err(ModelError(format!("residual {k} is {}", residuals[k]))),
        None => Ok(residuals),
    }
}
