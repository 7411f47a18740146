//! Downward forces of every lane's vehicles on the deck, as modes, connectors and observed rows see them.
//!
//! Knows weights at their places and inertia forces of masses that ride along. Does not know how masses are solved for.

use super::basis::Sizes;
use super::lane_array::LaneArray;
use super::wheel_lines::{DeckLines, WheelLines};

/// A force on a station of a line of the deck: line, station, downward force `[N]`.
pub(super) type StationForce = (usize, usize, f64);

/// Columns that are summed at once.
const COLUMNS: usize = 16;

/// Forces at the last step and at the one under way, one row a mode, connector and observed row.
#[derive(Debug, Clone)]
pub(super) struct Loads {
    pub(super) weights: LaneArray,
    pub(super) weights_now: LaneArray,
    pub(super) inertia: LaneArray,
    pub(super) inertia_now: LaneArray,
}

impl Loads {
    pub(super) fn new(sizes: &Sizes, lanes: usize) -> Self {
        let zeros = || LaneArray::new(sizes.followed(), lanes);
        Self {
            weights: zeros(),
            weights_now: zeros(),
            inertia: zeros(),
            inertia_now: zeros(),
        }
    }

    /// What a lane carries from step to step.
    pub(super) fn carried(&mut self) -> [&mut LaneArray; 2] {
        [&mut self.weights, &mut self.inertia]
    }

    /// What a step leaves in a lane that no crossing writes any more.
    pub(super) fn left(&mut self) -> [&mut LaneArray; 2] {
        [&mut self.weights_now, &mut self.inertia_now]
    }

    /// Weights of a lane's vehicles on stations.
    #[inline(always)]
    pub(super) fn apply_weights(&mut self, lane: usize, wheels: &WheelLines, weights: &[StationForce]) {
        let to = &mut self.weights_now;
        apply_forces((&wheels.weights[..], wheels.influence_width, 0), weights, to, lane);
    }

    /// Inertia forces of a lane's masses on stations.
    #[inline(always)]
    pub(super) fn apply_inertia(&mut self, lane: usize, wheels: &WheelLines, forces: &[StationForce]) {
        let to = &mut self.inertia_now;
        apply_forces((&wheels.nodes[..], wheels.influence_width, 0), forces, to, lane);
    }

    /// Adds what the rows see of a lane's springs to the inertia forces, times a factor.
    #[inline(always)]
    pub(super) fn add_springs(&mut self, lane: usize, seen: &[f64], factor: f64) {
        self.inertia_now
            .lane_mut(lane)
            .zip(seen)
            .for_each(|(to, seen)| *to = factor.mul_add(*seen, *to));
    }

    /// Makes a lane's springs forces of the step's end, which weigh in the next step as weights do.
    #[inline(always)]
    pub(super) fn end_springs(&mut self, lane: usize, seen: &[f64], factor: f64) {
        self.add_springs(lane, seen, -factor);
        self.weights_now
            .lane_mut(lane)
            .zip(seen)
            .for_each(|(to, seen)| *to += seen);
    }

    /// Ends the step: its forces are the old ones of the next.
    pub(super) fn end_step(&mut self) {
        std::mem::swap(&mut self.weights, &mut self.weights_now);
        std::mem::swap(&mut self.inertia, &mut self.inertia_now);
    }
}

/// Writes the sum of forces times the influence of their stations into a lane: of lines whose influences have a width, the
/// columns from `first` on.
#[inline(always)]
pub(super) fn apply_forces<L: DeckLines + ?Sized>(
    lines: (&L, usize, usize),
    forces: &[StationForce],
    to: &mut LaneArray,
    lane: usize,
) {
    sum_forces(lines, forces, to.rows(), |from, sums| {
        for (row, sum) in to.rows_from_mut(from).take(sums.len()).zip(sums) {
            row[lane] = *sum;
        }
    });
}

/// Gives the sum of forces times the influence of their stations, as many columns from `first` on, block after block.
#[inline(always)]
pub(super) fn sum_forces<L: DeckLines + ?Sized>(
    (lines, influence_width, first): (&L, usize, usize),
    forces: &[StationForce],
    columns: usize,
    mut write: impl FnMut(usize, &[f64]),
) {
    let mut from = 0;
    while from < columns {
        let many = COLUMNS.min(columns - from);
        let mut sums = [0.0; COLUMNS];
        for &(line, station, force) in forces {
            let of = &lines.influences(line)[station * influence_width + first + from..][..many];
            if let Some(of) = of.first_chunk::<COLUMNS>() {
                for i in 0..COLUMNS {
                    sums[i] = f64::mul_add(force, of[i], sums[i]);
                }
            } else {
                for (sum, x) in sums.iter_mut().zip(of) {
                    *sum = force.mul_add(*x, *sum);
                }
            }
        }
        write(from, &sums[..many]);
        from += many;
    }
}
