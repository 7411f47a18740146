//! The least-squares problem as the optimiser asks for it: residuals and Jacobian by the variable without bounds.
//!
//! Knows the optimiser's trait and what it takes for a refused step. Does not know when a search ends.

use std::cell::RefCell;

use levenberg_marquardt::LeastSquaresProblem;
use nalgebra::{DMatrix, DVector, Dyn, storage::Owned};

use super::evaluation::{Evaluation, JacobianColumns, ModelEvaluator, Purpose};
use super::variable::{bounded, unbounded};
use super::{Parameter, sum_of_squares};

/// Cosine between residuals and column from which on the residuals pull a parameter off its bound, or push it there.
pub(super) const PULL: f64 = 0.01;
/// A failed trial counts as residuals with this many times the first norm; from 10 on the optimiser cuts its region.
const REFUSED_NORM: f64 = 100.0;

/// Cosine between residuals and a column of the Jacobian, positive if the sum of squares falls, d(sum)/dt = 2 column .
/// r, as the parameter goes from `x` to the nearer bound; zero without a column or with one of zeros.
pub(super) fn outward_cosine(parameter: &Parameter, x: f64, column: Option<&[f64]>, residuals: &[f64]) -> f64 {
    let Some(column) = column else { return 0.0 };
    let product: f64 = column.iter().zip(residuals).map(|(a, b)| a * b).sum();
    let norms = sum_of_squares(column).sqrt() * sum_of_squares(residuals).sqrt();
    let outward = if parameter.nearer_bound(x) == parameter.lower {
        product
    } else {
        -product
    };
    if norms > 0.0 { outward / norms } else { 0.0 }
}

/// The least-squares problem as the optimiser asks for it.
pub(super) struct LeastSquares<'p, 'a> {
    /// Where the search starts: an `u` that has not moved gives back its value bit by bit.
    origin: (DVector<f64>, Vec<f64>),
    u: DVector<f64>,
    point: Vec<f64>,
    evaluations_limit: usize,
    left_alone_share: f64,
    refused: DVector<f64>,
    evaluator: RefCell<&'p mut ModelEvaluator<'a>>,
    notes: RefCell<Notes>,
}

/// What a search remembers of its way.
pub(super) struct Notes {
    /// The best of all points tried, or what was best before.
    pub best: Evaluation,
    /// The last Jacobian, and the point it is of.
    pub columns: Option<(Vec<f64>, JacobianColumns)>,
    /// Whether the limit of evaluations kept from going on.
    pub limit_reached: bool,
    /// Whether the model failed at the last point tried.
    pub trial_failed: bool,
    last: Evaluation,
}

impl<'p, 'a> LeastSquares<'p, 'a> {
    /// A search from `from`, where `best` is the best point so far. A parameter closer to a bound than
    /// `left_alone_share` of the width that is pushed outwards is left alone.
    pub(super) fn new(
        evaluator: &'p mut ModelEvaluator<'a>,
        evaluations_limit: usize,
        left_alone_share: f64,
        best: Evaluation,
        from: Evaluation,
    ) -> Self {
        let count = from.residuals.len();
        let level = REFUSED_NORM * (sum_of_squares(&from.residuals) / count as f64).sqrt();
        let parameters = evaluator.parameters;
        let u = DVector::from_fn(from.point.len(), |k, _| unbounded(&parameters[k], from.point[k]));
        Self {
            origin: (u.clone(), from.point.clone()),
            u,
            point: from.point.clone(),
            evaluations_limit,
            left_alone_share,
            refused: DVector::from_element(count, level),
            evaluator: RefCell::new(evaluator),
            notes: RefCell::new(Notes {
                best,
                last: from,
                columns: None,
                limit_reached: false,
                trial_failed: false,
            }),
        }
    }

    /// Where a search ended, and what it remembers.
    pub(super) fn into_parts(self) -> (Vec<f64>, Notes) {
        (self.point, self.notes.into_inner())
    }

    /// Whether `wanted` more evaluations are within the limit; notes if they are not.
    fn has_room(&self, wanted: usize) -> bool {
        let within = self.evaluator.borrow().evaluations + wanted <= self.evaluations_limit;
        self.notes.borrow_mut().limit_reached |= !within;
        within
    }
}

impl LeastSquaresProblem<f64, Dyn, Dyn> for LeastSquares<'_, '_> {
    type ParameterStorage = Owned<f64, Dyn>;
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, Dyn>;

    fn set_params(&mut self, u: &DVector<f64>) {
        self.u.copy_from(u);
        let parameters = self.evaluator.get_mut().parameters;
        let (origin_u, origin_point) = &self.origin;
        self.point = (0..parameters.len())
            .map(|k| {
                if u[k] == origin_u[k] {
                    origin_point[k]
                } else {
                    bounded(&parameters[k], u[k])
                }
            })
            .collect();
    }

    fn params(&self) -> DVector<f64> {
        self.u.clone()
    }

    fn residuals(&self) -> Option<DVector<f64>> {
        if self.notes.borrow().last.point != self.point {
            if !self.has_room(1) {
                return None;
            }
            let point = std::slice::from_ref(&self.point);
            let residuals = self
                .evaluator
                .borrow_mut()
                .evaluate(point, |_| Purpose::Trial)
                .pop()
                .flatten();
            let mut notes = self.notes.borrow_mut();
            notes.trial_failed = residuals.is_none();
            let Some(residuals) = residuals else {
                return Some(self.refused.clone());
            };
            notes.last = Evaluation {
                point: self.point.clone(),
                residuals,
            };
            if !notes.best.is_no_worse_than(&notes.last) {
                notes.best = notes.last.clone();
            }
        }
        Some(DVector::from_column_slice(&self.notes.borrow().last.residuals))
    }

    /// Asked for only at an accepted point, the last one that `residuals` answered for.
    fn jacobian(&self) -> Option<DMatrix<f64>> {
        let wanted = self.evaluator.borrow().jacobian_batch(&self.point);
        if !self.has_room(wanted) {
            return None;
        }
        let mut notes = self.notes.borrow_mut();
        let columns = self.evaluator.borrow_mut().jacobian(&notes.last);
        let parameters = self.evaluator.borrow().parameters;
        let factors: Vec<f64> = (0..columns.len())
            .map(|k| {
                let x = self.point[k];
                let is_left_alone = parameters[k].share_from_bound(x) < self.left_alone_share
                    && outward_cosine(&parameters[k], x, columns[k].as_deref(), &notes.last.residuals) > PULL;
                if is_left_alone || x == parameters[k].nearer_bound(x) {
                    0.0
                } else {
                    self.u[k].cos() / 2.0
                }
            })
            .collect();
        let matrix = DMatrix::from_fn(notes.last.residuals.len(), columns.len(), |row, k| {
            columns[k].as_ref().map_or(0.0, |column| column[row] * factors[k])
        });
        notes.columns = Some((self.point.clone(), columns));
        Some(matrix)
    }
}
