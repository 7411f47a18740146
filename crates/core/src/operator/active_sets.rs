//! The linear systems of a step's active sets (C2), one a lane: links that work, and what rides along.
//!
//! Knows the links that are active in any lane, matrices and forces. Does not know when a lane has settled.

use super::lane_array::LaneArray;
use super::listed_links::ListedLinks;
use super::rider_block::RiderBlock;
use super::small_matrix::SmallMatrix;
use super::vector::Ops;
use crate::connector::State;
use crate::contact::{LinkLaw, NotSettled};
use crate::scheme::Arithmetic;
use nalgebra::DMatrix;
use pulp::Simd;

/// Elongations that are summed at once.
const ROWS: usize = 8;

/// The states of one lane.
#[derive(Debug, Clone)]
pub(super) struct LaneStates {
    /// State of each link, behind them of each one-sided rider: at work in compression, or open.
    pub(super) states: Vec<State>,
    /// The states before the step where they have changed in it, and active sets met in this step, one after the other.
    pub(super) before: Vec<State>,
    pub(super) seen: Vec<State>,
    /// Newton solutions so far, and whether that was all.
    pub(super) iterations: usize,
    pub(super) ended: Option<Result<(), NotSettled>>,
}

/// The linear systems of active sets, with room for the largest.
#[derive(Debug)]
pub(super) struct LinearSystem {
    /// Elongations with the forces found `[m]`.
    pub(super) found: LaneArray,
    /// Scaled forces `N' = weight N` of the active links, 0 of the others `[N]`.
    pub(super) forces: LaneArray,
    /// Scaled rider forces q'; 0 of those that are off the deck.
    pub(super) riders: LaneArray,
    /// The links that are active in any lane.
    pub(super) links: ListedLinks,
    all: Vec<usize>,
    /// In which lanes each rider is on the deck, and whether one is off it in any.
    is_on: LaneArray,
    any_lifted: bool,
    matrix: SmallMatrix,
    rhs: LaneArray,
    /// Whether `matrix` was factored for the links as they are listed, without riders.
    is_factored: bool,
}

/// What a step asks of the systems of some lanes.
#[derive(Clone, Copy)]
pub(super) struct ContactInput<'a> {
    /// The lanes.
    pub lanes: &'a [usize],
    /// The law of each link, of each of these lanes.
    pub laws: &'a [&'a [LinkLaw]],
    /// Elongations without link and rider forces `[m]`.
    pub e: &'a LaneArray,
    /// Compliance of the step among links `[m/N]`.
    pub compliance: &'a DMatrix<f64>,
    /// Weight of the new force in the balance, `N' = weight N`.
    pub weight: f64,
    /// What rides along.
    pub riders: &'a RiderBlock,
}

impl LinearSystem {
    /// Room for so many links and riders in each lane.
    pub(super) fn new(links: usize, riders: usize, lanes: usize) -> Self {
        let of = |rows: usize| LaneArray::new(rows, lanes);
        Self {
            found: of(links),
            forces: of(links),
            riders: of(riders),
            links: ListedLinks::new(links, lanes),
            all: (0..links).collect(),
            is_on: of(riders),
            any_lifted: false,
            matrix: SmallMatrix::new(links + riders, lanes),
            rhs: of(links + riders),
            is_factored: false,
        }
    }

    /// Laws of dashpots change their offsets in every step.
    #[inline(always)]
    pub(super) fn forget_laws(&mut self) {
        self.links.forget_laws();
    }

    /// Forgets what was factored and listed for other laws or another step length.
    pub(super) fn forget(&mut self) {
        self.links.forget();
        self.is_factored = false;
    }

    /// Links that have forces in some lane: those that are active, or all where forces count from a state at rest.
    pub(super) fn pressed(&self, from_rest: bool) -> &[usize] {
        if from_rest { &self.all } else { &self.links.active }
    }

    /// One Newton solution (C2): riders first, then the active links, eliminated in that order. Symmetric and positive
    /// definite but for the convective terms, so that no pivots are sought. Without riders the matrix depends on the active
    /// sets alone and its factors are kept.
    #[inline(always)]
    pub(super) fn solve<S: Simd>(&mut self, o: Ops<S>, lanes: &[LaneStates], input: ContactInput) {
        let nr = input.riders.count();
        if self.activate(lanes, input) {
            self.is_factored = false;
        }
        let n = nr + self.links.active.len();
        if !(nr == 0 && self.is_factored) {
            self.assemble(o, input);
            self.matrix.factor(o, n, input.riders.symmetric());
            self.is_factored = nr == 0;
        }
        let (rhs, e) = (&mut self.rhs.vectors_mut::<S>()[..n], input.e.vectors::<S>());
        let (free, is_on) = (input.riders.free.vectors::<S>(), self.is_on.vectors::<S>());
        for (i, to) in rhs[..nr].iter_mut().enumerate() {
            *to = o.mul(is_on[i], free[i]);
        }
        let (is_active, begins) = (self.links.is_active.vectors::<S>(), self.links.begins.vectors::<S>());
        for (p, &i) in self.links.active.iter().enumerate() {
            rhs[nr + p] = o.mul(is_active[i], o.sub(e[i], begins[i]));
        }
        self.matrix.solve(o, rhs);
        self.riders.vectors_mut::<S>()[..nr].copy_from_slice(&rhs[..nr]);
        let forces = self.forces.vectors_mut::<S>();
        forces.fill(o.splat(0.0));
        for (p, &i) in self.links.active.iter().enumerate() {
            // of a lane that leaves the link out 0, and not -0, as where no lane has it
            forces[i] = o.add(rhs[nr + p], o.splat(0.0));
        }
    }

    /// Lists what is active in any lane, and how; whether links are active that were not, or the other way.
    #[inline(always)]
    fn activate(&mut self, lanes: &[LaneStates], input: ContactInput) -> bool {
        let (nr, links) = (input.riders.count(), input.compliance.nrows());
        let states = |lane: usize| &lanes[lane].states[..];
        let changed = self.links.take((input.lanes, input.laws), states, input.weight);
        for r in 0..nr {
            self.is_on.row_mut(r).fill(1.0);
        }
        self.any_lifted = false;
        for &lane in input.lanes {
            let of_riders = &lanes[lane].states[links..];
            for (r, state) in (nr - of_riders.len()..).zip(of_riders) {
                if *state == State::Open {
                    *self.is_on.at_mut(r, lane) = 0.0;
                    self.any_lifted = true;
                }
            }
        }
        changed
    }

    /// Writes the matrices of the active sets; below the diagonal only where they are not symmetric.
    #[inline(always)]
    fn assemble<S: Simd>(&mut self, o: Ops<S>, input: ContactInput) {
        // where nothing is left out, lanes that are not asked for may have any numbers
        match (self.links.any_left_out, self.any_lifted) {
            (false, false) => self.write_matrices::<S, false, false>(o, input),
            (true, false) => self.write_matrices::<S, true, false>(o, input),
            (_, true) => self.write_matrices::<S, true, true>(o, input),
        }
    }

    /// As [`Self::assemble`]; what a lane leaves out, links that are open and riders off the deck, stands in it with 1 on the diagonal
    /// and 0 beside it.
    #[inline(always)]
    fn write_matrices<S: Simd, const LEFT_OUT: bool, const LIFTED: bool>(&mut self, o: Ops<S>, input: ContactInput) {
        let (riders, nr, one) = (input.riders, input.riders.count(), o.splat(1.0));
        let active = &self.links.active[..];
        let n = nr + active.len();
        let (is_active, is_on) = (self.links.is_active.vectors::<S>(), self.is_on.vectors::<S>());
        let (beside, own_of_riders) = (riders.beside.vectors::<S>(), riders.own.vectors::<S>());
        for i in 0..nr {
            let row = self.matrix.row_mut::<S>(i, n);
            let from = if riders.symmetric() { i } else { 0 };
            for (j, seen) in riders.among(i).iter().enumerate().skip(from) {
                let seen = match riders.beside_at(i, j) {
                    Some(at) => o.add(o.splat(*seen), beside[at]),
                    None => o.splat(*seen),
                };
                row[j] = match (i == j, LIFTED) {
                    (true, false) => o.add(seen, own_of_riders[i]),
                    (true, true) => o.fma(is_on[i], o.add(seen, own_of_riders[i]), o.sub(one, is_on[i])),
                    (false, false) => seen,
                    (false, true) => o.mul(o.mul(is_on[i], is_on[j]), seen),
                };
            }
            let of = riders.of_links(i);
            for (entry, &j) in row[nr..].iter_mut().zip(active) {
                *entry = o.splat(of[j]);
                if LEFT_OUT {
                    *entry = o.mul(is_active[j], *entry);
                }
                if LIFTED {
                    *entry = o.mul(is_on[i], *entry);
                }
            }
        }
        let own = self.links.own.vectors::<S>();
        for (p, &i) in active.iter().enumerate() {
            let row = self.matrix.row_mut::<S>(nr + p, n);
            if !riders.symmetric() {
                for (r, entry) in row[..nr].iter_mut().enumerate() {
                    *entry = o.splat(riders.on_links(r)[i]);
                    if LEFT_OUT {
                        *entry = o.mul(is_active[i], *entry);
                    }
                    if LIFTED {
                        *entry = o.mul(is_on[r], *entry);
                    }
                }
            }
            let seen = column(input.compliance, i);
            let from = if riders.symmetric() { p } else { 0 };
            for (entry, &j) in row[nr..].iter_mut().zip(active).skip(from) {
                *entry = o.splat(seen[j]);
                if LEFT_OUT {
                    *entry = o.mul(o.mul(is_active[i], is_active[j]), *entry);
                }
            }
            row[nr + p] = o.add(row[nr + p], own[i]);
        }
    }

    /// Elongations under the forces found. On an active branch they follow from the force, without cancellation.
    #[inline(always)]
    pub(super) fn elongate<S: Simd>(&mut self, o: Ops<S>, input: ContactInput) {
        let (mut from, links) = (0, self.found.rows());
        while from + ROWS <= links {
            self.elongate_rows::<S, ROWS>(o, input, from);
            from += ROWS;
        }
        if from + 4 <= links {
            self.elongate_rows::<S, 4>(o, input, from);
            from += 4;
        }
        if from + 2 <= links {
            self.elongate_rows::<S, 2>(o, input, from);
            from += 2;
        }
        if from < links {
            self.elongate_rows::<S, 1>(o, input, from);
        }
        let found = self.found.vectors_mut::<S>();
        let forces = self.forces.vectors::<S>();
        let links = &self.links;
        let (is_active, stiffness) = (links.is_active.vectors::<S>(), links.stiffness.vectors::<S>());
        let (offset, unscaled) = (links.offset.vectors::<S>(), o.splat(1.0 / input.weight));
        for &i in &links.active {
            let on_branch = o.0.div_f64s(o.fma(forces[i], unscaled, offset[i]), stiffness[i]);
            let here = o.0.greater_than_f64s(is_active[i], o.splat(0.0));
            found[i] = o.0.select_f64s(here, on_branch, found[i]);
        }
    }

    /// Elongations of `MANY` links from one on, as far as forces off their branches make them.
    #[inline(always)]
    fn elongate_rows<S: Simd, const MANY: usize>(&mut self, o: Ops<S>, input: ContactInput, from: usize) {
        let (forces, riders) = (self.forces.vectors::<S>(), self.riders.vectors::<S>());
        let mut sums = [o.splat(0.0); MANY];
        let e = &input.e.vectors::<S>()[from..][..MANY];
        sums.copy_from_slice(e);
        // a lane that leaves a link out has no force of it
        for &j in &self.links.active {
            take_from(o, &mut sums, &column(input.compliance, j)[from..], forces[j]);
        }
        for (r, force) in riders[..input.riders.count()].iter().enumerate() {
            take_from(o, &mut sums, &input.riders.on_links(r)[from..], *force);
        }
        self.found.vectors_mut::<S>()[from..][..MANY].copy_from_slice(&sums);
    }

    /// What a lane's forces ask for: the end of its solution, or other states, which it then has.
    #[inline(always)]
    pub(super) fn ask(
        &self,
        lane: usize,
        of: &mut LaneStates,
        laws: &[LinkLaw],
        input: ContactInput,
        limit: usize,
    ) -> Option<Result<(), NotSettled>> {
        let (count, links) = (of.states.len(), laws.len());
        let met = of.seen.len();
        for (i, law) in laws.iter().enumerate() {
            of.seen.push(law.state(self.found.at(i, lane)));
        }
        // a one-sided rider that presses stays while its force does, one that is off the deck comes back where it would press
        let nr = input.riders.count();
        for (r, is) in (nr - (count - links)..).zip(&of.states[links..]) {
            let presses = match is {
                State::Open => self.left_over(r, lane, input) > 0.0,
                _ => self.riders.at(r, lane) > 0.0,
            };
            of.seen.push(if presses { State::Compression } else { State::Open });
        }
        let (met, asked) = of.seen.split_at(met);
        let Some(connector) = of.states.iter().zip(asked).position(|(is, asked)| is != asked) else {
            return Some(Ok(()));
        };
        let iterations = of.iterations;
        if iterations >= limit || met.chunks_exact(count).any(|earlier| earlier == asked) {
            return Some(Err(NotSettled { connector, iterations }));
        }
        if iterations == 1 {
            of.before.clone_from(&of.states);
        }
        of.states.copy_from_slice(asked);
        None
    }

    /// What a rider without force is measured by under the forces of the others in a lane.
    fn left_over(&self, r: usize, lane: usize, input: ContactInput) -> f64 {
        let sum =
            |seen: &[f64], forces: &LaneArray| -> f64 { seen.iter().zip(forces.lane(lane)).map(|(a, b)| a * b).sum() };
        let riders = input.riders;
        let beside = (0..riders.count()).filter_map(|j| Some((j, riders.beside_at(r, j)?)));
        let beside = beside.map(|(j, at)| riders.beside.at(at, lane) * self.riders.at(j, lane));
        riders.free.at(r, lane)
            - sum(riders.among(r), &self.riders)
            - beside.sum::<f64>()
            - sum(riders.of_links(r), &self.forces)
    }
}

/// `sums := sums - seen force`, of as many rows as there are sums.
#[inline(always)]
fn take_from<S: Simd, const MANY: usize>(o: Ops<S>, sums: &mut [S::f64s; MANY], seen: &[f64], force: S::f64s) {
    let seen = &seen[..MANY];
    for i in 0..MANY {
        sums[i] = o.less(sums[i], o.splat(seen[i]), force);
    }
}

/// A column of the compliance, which is a row, the matrix being symmetric.
#[inline(always)]
fn column(compliance: &DMatrix<f64>, i: usize) -> &[f64] {
    let n = compliance.nrows();
    &compliance.as_slice()[i * n..][..n]
}
