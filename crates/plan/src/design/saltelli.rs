//! The points of Saltelli: two samples of a sequence, and of each row the points that have one factor of the other sample.
//!
//! Knows the order of the points. Does not know axes or values.

use super::sampling::SobolPoints;

/// The points of one row of the samples A and B, row after row (Saltelli, Making best use of model evaluations to compute
/// sensitivity indices, Comput. Phys. Commun. 145, 2002; (I1)): A, A with each factor of B in turn, of a design for pairs B with
/// each factor of A in turn, B. A has the coordinates of the points of [`SobolPoints`] of the same seed, B those behind.
pub(super) struct SaltelliRow {
    points: SobolPoints,
    /// The dimension of each factor in A; in B it is as many further as there are factors.
    dimensions: Vec<usize>,
    /// Points of a row.
    width: usize,
    /// The coordinates of A and, behind them, of B.
    shares: Vec<f64>,
    /// The point under way, from 0 in each row.
    point: usize,
}

impl SaltelliRow {
    /// Before the first row; of each factor its dimension.
    pub(super) fn new(dimensions: Vec<usize>, seed: u64, second_order: bool) -> Self {
        Self {
            points: SobolPoints::new(2 * dimensions.len(), seed),
            width: Self::width(dimensions.len(), second_order),
            shares: Vec::new(),
            point: 0,
            dimensions,
        }
    }

    /// Points of a row of so many factors.
    pub(super) fn width(factors: usize, second_order: bool) -> usize {
        if second_order { 2 * factors + 2 } else { factors + 2 }
    }

    /// Goes to a point; to be asked point by point. Nothing where the sequence ends.
    pub(super) fn go_to(&mut self, number: usize) -> Option<()> {
        self.point = number % self.width;
        if self.point == 0 {
            self.shares = self.points.next()?;
        }
        Some(())
    }

    /// The coordinate of a factor at the point under way.
    pub(super) fn share(&self, factor: usize) -> f64 {
        let factors = self.dimensions.len();
        let is_of_b = match self.point {
            last if last + 1 == self.width => true,
            point if point <= factors => point == factor + 1,
            point => point != factor + factors + 1,
        };
        self.shares[self.dimensions[factor] + if is_of_b { factors } else { 0 }]
    }
}
