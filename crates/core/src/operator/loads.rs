//! Downward forces of every lane's vehicles on the deck, as modes, connectors and observed rows see them.
//!
//! Knows weights at their places and inertia forces of masses that ride along. Does not know how masses are solved for.

use super::basis::Sizes;
use super::deck_forces::{NodeForces, StationForce};
use super::lane_array::LaneArray;
use super::lane_group::{LaneGroup, UnitForce};
use super::panel::write_sums;
use super::vector::Ops;
use super::wheel_lines::{DeckLines, WheelLines};
use crate::scheme::Arithmetic;
use pulp::Simd;

/// Columns that are summed at once.
const COLUMNS: usize = 16;

/// Rows that are summed at once in all lanes, and in one alone.
const ROWS: usize = 8;
const ROWS_OF_ONE: usize = 32;

/// Forces at the last step and at the one under way, one row a mode, connector and observed row.
#[derive(Debug, Clone)]
pub(super) struct Loads {
    pub(super) weights: LaneArray,
    pub(super) weights_now: LaneArray,
    pub(super) inertia: LaneArray,
    pub(super) inertia_now: LaneArray,
    /// What the rows see of a unit load of one vehicle.
    unit: Vec<f64>,
}

impl Loads {
    pub(super) fn new(sizes: &Sizes, lanes: usize) -> Self {
        let zeros = || LaneArray::new(sizes.followed(), lanes);
        Self {
            weights: zeros(),
            weights_now: zeros(),
            inertia: zeros(),
            inertia_now: zeros(),
            unit: vec![0.0; sizes.followed()],
        }
    }

    /// Puts the weights of the vehicles of a group on their stations: what the rows see of a unit load of each, times the loads.
    #[inline(always)]
    pub(super) fn apply_weights<S: Simd>(&mut self, o: Ops<S>, wheels: &WheelLines, group: &LaneGroup) {
        let mut is_first = true;
        for forces in group.weights.chunk_by(|a, b| a.vehicle == b.vehicle) {
            see_unit_load(o, wheels, forces, &mut self.unit);
            let vehicle = forces[0].vehicle;
            if let Some(lane) = group.alone() {
                let load_n = group.load_in(vehicle, lane);
                for (row, seen) in self.weights_now.lane_mut(lane).zip(&self.unit) {
                    *row = seen.mul_add(load_n, if is_first { 0.0 } else { *row });
                }
            } else {
                let (mask, load_n, zero) = (group.mask(o), group.load_n::<S>(vehicle), o.splat(0.0));
                for (row, seen) in self.weights_now.vectors_mut::<S>().iter_mut().zip(&self.unit) {
                    let sum = o.fma(o.splat(*seen), load_n, if is_first { zero } else { *row });
                    *row = o.0.select_f64s(mask, sum, *row);
                }
            }
            is_first = false;
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

/// What the rows see of a unit load of a vehicle, whose forces on stations are given; numbers of one vector are rows.
#[inline(always)]
fn see_unit_load<S: Simd>(o: Ops<S>, wheels: &WheelLines, forces: &[UnitForce], seen: &mut [f64]) {
    let width = wheels.influence_width;
    let (vectors, rest) = S::as_mut_simd_f64s(seen);
    let first_of_rest = vectors.len() * S::F64_LANES;
    for (block, sums_to) in vectors.chunks_mut(ROWS).enumerate() {
        let mut sums = [o.splat(0.0); ROWS];
        for of in forces {
            let from = of.station * width + block * ROWS * S::F64_LANES;
            let influences = &wheels.weights.influences(of.line)[from..][..sums_to.len() * S::F64_LANES];
            let (influences, share) = (S::as_simd_f64s(influences).0, o.splat(of.share));
            if let Some(influences) = influences.first_chunk::<ROWS>() {
                for i in 0..ROWS {
                    sums[i] = o.fma(share, influences[i], sums[i]);
                }
            } else {
                for (sum, influence) in sums.iter_mut().zip(influences) {
                    *sum = o.fma(share, *influence, *sum);
                }
            }
        }
        write_sums(&sums, sums_to);
    }
    rest.fill(0.0);
    for of in forces {
        let influences = &wheels.weights.influences(of.line)[of.station * width + first_of_rest..];
        for (sum, influence) in rest.iter_mut().zip(influences) {
            *sum = of.share.mul_add(*influence, *sum);
        }
    }
}

/// Inertia forces of masses on nodes, as the rows see them in the lanes of a mask.
#[inline(always)]
pub(super) fn apply_inertia<S: Simd>(
    o: Ops<S>,
    mask: S::m64s,
    wheels: &WheelLines,
    of: NodeForces<'_>,
    to: &mut LaneArray,
) {
    let (to, mut from) = (to.vectors_mut::<S>(), 0);
    // numbers of one lane are summed as vectors
    while S::F64_LANES == 1 && from + ROWS_OF_ONE <= to.len() {
        sum_rows::<S, ROWS_OF_ONE>(o, wheels, of, (mask, to, from));
        from += ROWS_OF_ONE;
    }
    while from + ROWS <= to.len() {
        sum_rows::<S, ROWS>(o, wheels, of, (mask, to, from));
        from += ROWS;
    }
    if from + 4 <= to.len() {
        sum_rows::<S, 4>(o, wheels, of, (mask, to, from));
        from += 4;
    }
    while from < to.len() {
        sum_rows::<S, 1>(o, wheels, of, (mask, to, from));
        from += 1;
    }
}

/// As [`apply_inertia`], `MANY` rows from one on.
#[inline(always)]
fn sum_rows<S: Simd, const MANY: usize>(
    o: Ops<S>,
    wheels: &WheelLines,
    of: NodeForces<'_>,
    (mask, to, from): (S::m64s, &mut [S::f64s], usize),
) {
    let (factor, forces) = (o.splat(of.factor), of.forces.vectors::<S>());
    let mut sums = [o.splat(0.0); MANY];
    for (node, force) in of.nodes.iter().zip(forces) {
        let n = o.mul(factor, *force);
        let influences = &wheels.nodes.influences(node.line)[node.station * wheels.influence_width + from..][..MANY];
        for row in 0..MANY {
            sums[row] = o.fma(o.splat(influences[row]), n, sums[row]);
        }
    }
    for (row, sum) in to[from..][..MANY].iter_mut().zip(&sums) {
        *row = o.0.select_f64s(mask, *sum, *row);
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
