//! The small piecewise-linear systems of a step (C1), one a lane: links, each with a law of its own, and what rides along.
//!
//! Knows numbers laid out once, so that a step allocates nothing. Does not know modes, nor what a link or a rider is. Each is
//! the problem of [`crate::contact`]: the active set decides the tangent, a state changes only between Newton solutions.
//!
//! Lanes are solved together, each on its own active set: a link that is open in a lane is left out of that lane's matrix, which
//! changes no bit of the others.

use super::lane_array::LaneArray;
use super::panel::MOST_LANES;
use super::rider_block::RiderBlock;
use super::small_matrix::SmallMatrix;
use super::vector::Ops;
use crate::connector::State;
use crate::contact::{LinkLaw, NotSettled};
use crate::scheme::Arithmetic;
use nalgebra::DMatrix;
use pulp::Simd;

/// The small systems of all lanes, kept from step to step.
#[derive(Debug)]
pub(super) struct ContactSystem {
    /// States and what became of them, of each lane.
    lanes: Vec<LaneStates>,
    links: usize,
    /// What is solved on the active sets.
    pub(super) linear: LinearSystem,
}

/// The states of one lane.
#[derive(Debug, Clone)]
struct LaneStates {
    /// State of each link, behind them of each one-sided rider: at work in compression, or open.
    states: Vec<State>,
    /// The states before, and active sets met in this step, one after the other.
    before: Vec<State>,
    seen: Vec<State>,
    /// Newton solutions so far, and whether that was all.
    iterations: usize,
    ended: Option<Result<(), NotSettled>>,
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
    /// Links that are active in any lane; for each of them in which lanes, then what its branch adds to the diagonal, and its stiffness
    /// and offset.
    active: Vec<usize>,
    all: Vec<usize>,
    is_active: LaneArray,
    own: LaneArray,
    stiffness: LaneArray,
    offset: LaneArray,
    /// In which lanes each rider is on the deck, and whether one is off it in any.
    is_on: LaneArray,
    any_lifted: bool,
    matrix: SmallMatrix,
    rhs: LaneArray,
    /// The lanes and the states that `matrix` was factored for, without riders.
    factored_lanes: Vec<usize>,
    factored_states: Vec<State>,
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

impl ContactSystem {
    /// Room for so many links and riders in each lane.
    pub(super) fn new(links: usize, riders: usize, newton_limit: usize, lanes: usize) -> Self {
        let of = |rows: usize| LaneArray::new(rows, lanes);
        let states = LaneStates {
            states: vec![State::Open; links],
            before: Vec::with_capacity(links + riders),
            seen: Vec::with_capacity(links * (newton_limit + 1)),
            iterations: 0,
            ended: None,
        };
        Self {
            lanes: vec![states; lanes],
            links,
            linear: LinearSystem {
                found: of(links),
                forces: of(links),
                riders: of(riders),
                active: Vec::with_capacity(links),
                all: (0..links).collect(),
                is_active: of(links),
                own: of(links),
                stiffness: of(links),
                offset: of(links),
                is_on: of(riders),
                any_lifted: false,
                matrix: SmallMatrix::new(links + riders, lanes),
                rhs: of(links + riders),
                factored_lanes: Vec::with_capacity(lanes),
                factored_states: Vec::with_capacity(lanes * links),
            },
        }
    }

    /// Forgets what was factored for other laws or another step length.
    pub(super) fn forget(&mut self) {
        self.linear.factored_lanes.clear();
    }

    /// Changes the states of two lanes of systems.
    #[inline(always)]
    pub(super) fn swap_states(&mut self, lane: usize, (other, of): (&mut Self, usize)) {
        std::mem::swap(&mut self.lanes[lane], &mut other.lanes[of]);
    }

    /// The states of a lane's links and one-sided riders.
    pub(super) fn states(&self, lane: usize) -> &[State] {
        &self.lanes[lane].states
    }

    /// Puts a lane's states.
    pub(super) fn put_states(&mut self, lane: usize, states: impl IntoIterator<Item = State>) {
        let to = &mut self.lanes[lane].states;
        to.clear();
        to.extend(states);
    }

    /// Begins a step whose one-sided riders press or are off the deck in a lane.
    #[inline(always)]
    pub(super) fn begin_riders(&mut self, lane: usize, pressing: impl Iterator<Item = bool>) {
        let states = &mut self.lanes[lane].states;
        states.truncate(self.links);
        states.extend(pressing.map(|presses| if presses { State::Compression } else { State::Open }));
    }

    /// Operations of a solution with so many riders, of one of so many lanes: factors, substitutions and elongations of each Newton
    /// solution; factors that were kept are counted as if they were made.
    pub(super) fn flop(&self, lanes: &[usize], riders: usize) -> f64 {
        let solutions: usize = lanes.iter().map(|&lane| self.lanes[lane].iterations).sum();
        let (c, n) = (self.links, self.linear.active.len() + riders);
        (solutions * (n * n * n / 3 + 2 * n * n + 2 * c * n)) as f64
    }

    /// Solves from the states of the lanes; leaves new states, elongations, forces and rider forces. Where a lane does not settle, its
    /// states are as before and the others say nothing.
    #[inline(always)]
    pub(super) fn solve<S: Simd>(&mut self, o: Ops<S>, input: ContactInput, limit: usize) {
        for &lane in input.lanes {
            let of = &mut self.lanes[lane];
            of.before.clone_from(&of.states);
            of.seen.clear();
            (of.iterations, of.ended) = (0, None);
        }
        loop {
            self.linear.solve(o, &self.lanes, input);
            self.linear.elongate(o, input);
            let mut all = true;
            for (&lane, laws) in input.lanes.iter().zip(input.laws) {
                let of = &mut self.lanes[lane];
                if of.ended.is_none() {
                    of.ended = self.linear.ask(lane, of, laws, input, limit);
                    all &= of.ended.is_some();
                }
            }
            if all {
                break;
            }
        }
        for &lane in input.lanes {
            let of = &mut self.lanes[lane];
            if let Some(Err(_)) = of.ended {
                of.states.clone_from(&of.before);
            }
        }
    }

    /// What became of a lane in the last solution: Newton solutions, and how many links have changed their states.
    pub(super) fn outcome(&self, lane: usize, laws: &[LinkLaw]) -> Result<(usize, usize), NotSettled> {
        let of = &self.lanes[lane];
        if let Some(Err(stuck)) = of.ended {
            return Err(stuck);
        }
        let links = of.states.iter().zip(&of.before).zip(laws);
        let switched = links.filter(|((a, b), _)| a != b);
        Ok((of.iterations, switched.map(|(_, law)| law.links).sum()))
    }
}

impl LinearSystem {
    /// Links that have forces in some lane: those that are active, or all where forces count from a state at rest.
    pub(super) fn pressed(&self, from_rest: bool) -> &[usize] {
        if from_rest { &self.all } else { &self.active }
    }

    /// One Newton solution (C2): riders first, then the active links, eliminated in that order. Symmetric and positive
    /// definite but for the convective terms, so that no pivots are sought. Without riders the matrix depends on the active
    /// sets alone and its factors are kept.
    #[inline(always)]
    fn solve<S: Simd>(&mut self, o: Ops<S>, lanes: &[LaneStates], input: ContactInput) {
        let nr = input.riders.count();
        self.activate(lanes, input);
        let n = nr + self.active.len();
        if !(nr == 0 && self.is_factored(lanes, input)) {
            self.assemble(o, input);
            self.matrix.factor(o, n, input.riders.symmetric());
            self.factored_lanes.clear();
            self.factored_states.clear();
            if nr == 0 {
                self.factored_lanes.extend(input.lanes);
                let states = input.lanes.iter().flat_map(|&lane| &lanes[lane].states);
                self.factored_states.extend(states);
            }
        }
        let (rhs, e) = (&mut self.rhs.vectors_mut::<S>()[..n], input.e.vectors::<S>());
        let (free, is_on) = (input.riders.free.vectors::<S>(), self.is_on.vectors::<S>());
        for (i, to) in rhs[..nr].iter_mut().enumerate() {
            *to = o.mul(is_on[i], free[i]);
        }
        let (is_active, stiffness) = (self.is_active.vectors::<S>(), self.stiffness.vectors::<S>());
        let offset = self.offset.vectors::<S>();
        for (p, &i) in self.active.iter().enumerate() {
            let beyond = o.sub(e[i], o.0.div_f64s(offset[p], stiffness[p]));
            rhs[nr + p] = o.mul(is_active[p], beyond);
        }
        self.matrix.solve(o, rhs);
        self.riders.vectors_mut::<S>()[..nr].copy_from_slice(&rhs[..nr]);
        let forces = self.forces.vectors_mut::<S>();
        forces.fill(o.splat(0.0));
        for (p, &i) in self.active.iter().enumerate() {
            // of a lane that leaves the link out 0, and not -0, as where no lane has it
            forces[i] = o.add(rhs[nr + p], o.splat(0.0));
        }
    }

    fn is_factored(&self, lanes: &[LaneStates], input: ContactInput) -> bool {
        let states = || input.lanes.iter().flat_map(|&lane| &lanes[lane].states);
        self.factored_lanes == input.lanes && self.factored_states.iter().eq(states())
    }

    /// Lists what is active in any lane, and how.
    #[inline(always)]
    fn activate(&mut self, lanes: &[LaneStates], input: ContactInput) {
        let (nr, links) = (input.riders.count(), input.compliance.nrows());
        self.active.clear();
        for i in 0..links {
            if !input.lanes.iter().any(|&lane| lanes[lane].states[i] != State::Open) {
                continue;
            }
            let p = self.active.len();
            self.active.push(i);
            let rows = [
                &mut self.is_active,
                &mut self.own,
                &mut self.stiffness,
                &mut self.offset,
            ];
            let [is_active, own, stiffness, offset] = rows.map(|of| of.row_mut(p));
            // of a lane that has the link open, or is not asked for: a row that couples with no other
            is_active.fill(0.0);
            own.fill(1.0);
            stiffness.fill(1.0);
            offset.fill(0.0);
            for (&lane, laws) in input.lanes.iter().zip(input.laws) {
                let state = lanes[lane].states[i];
                if state != State::Open {
                    let branch = laws[i].branch(state);
                    is_active[lane] = 1.0;
                    own[lane] = 1.0 / (input.weight * branch.stiffness);
                    (stiffness[lane], offset[lane]) = (branch.stiffness, branch.offset);
                }
            }
        }
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
    }

    /// Writes the matrices of the active sets; below the diagonal only where they are not symmetric.
    #[inline(always)]
    fn assemble<S: Simd>(&mut self, o: Ops<S>, input: ContactInput) {
        if S::F64_LANES == 1 && !self.any_lifted {
            self.write_matrices::<S, false>(o, input);
        } else {
            self.write_matrices::<S, true>(o, input);
        }
    }

    /// As [`Self::assemble`]; `LEFT_OUT` where a lane may leave unknowns out that another has.
    #[inline(always)]
    fn write_matrices<S: Simd, const LEFT_OUT: bool>(&mut self, o: Ops<S>, input: ContactInput) {
        let (riders, nr, one) = (input.riders, input.riders.count(), o.splat(1.0));
        let n = nr + self.active.len();
        let (is_active, is_on) = (self.is_active.vectors::<S>(), self.is_on.vectors::<S>());
        let (beside, own_of_riders) = (riders.beside.vectors::<S>(), riders.own.vectors::<S>());
        for i in 0..nr {
            let row = self.matrix.row_mut::<S>(i, n);
            let from = if riders.symmetric() { i } else { 0 };
            for (j, seen) in riders.among(i).iter().enumerate().skip(from) {
                let seen = match riders.beside_at(i, j) {
                    Some(at) => o.add(o.splat(*seen), beside[at]),
                    None => o.splat(*seen),
                };
                row[j] = match (i == j, LEFT_OUT) {
                    (true, false) => o.add(seen, own_of_riders[i]),
                    // 1 of a rider that is off the deck
                    (true, true) => o.fma(is_on[i], o.add(seen, own_of_riders[i]), o.sub(one, is_on[i])),
                    (false, false) => seen,
                    (false, true) => o.mul(o.mul(is_on[i], is_on[j]), seen),
                };
            }
            let of = riders.of_links(i);
            for (p, (entry, &j)) in row[nr..].iter_mut().zip(&self.active).enumerate() {
                *entry = o.splat(of[j]);
                if LEFT_OUT {
                    *entry = o.mul(o.mul(is_on[i], is_active[p]), *entry);
                }
            }
        }
        let own = self.own.vectors::<S>();
        for (p, &i) in self.active.iter().enumerate() {
            let row = self.matrix.row_mut::<S>(nr + p, n);
            if !riders.symmetric() {
                for (r, entry) in row[..nr].iter_mut().enumerate() {
                    *entry = o.splat(riders.on_links(r)[i]);
                    if LEFT_OUT {
                        *entry = o.mul(o.mul(is_on[r], is_active[p]), *entry);
                    }
                }
            }
            let seen = column(input.compliance, i);
            let from = if riders.symmetric() { p } else { 0 };
            for (q, (entry, &j)) in row[nr..].iter_mut().zip(&self.active).enumerate().skip(from) {
                *entry = o.splat(seen[j]);
                if LEFT_OUT {
                    *entry = o.mul(o.mul(is_active[p], is_active[q]), *entry);
                }
            }
            row[nr + p] = o.add(row[nr + p], own[p]);
        }
    }

    /// Elongations under the forces found. On an active branch they follow from the force, without cancellation.
    #[inline(always)]
    fn elongate<S: Simd>(&mut self, o: Ops<S>, input: ContactInput) {
        let (found, forces) = (self.found.vectors_mut::<S>(), self.forces.vectors::<S>());
        found.copy_from_slice(input.e.vectors::<S>());
        for (p, &j) in self.active.iter().enumerate() {
            let here = o.0.greater_than_f64s(self.is_active.vectors::<S>()[p], o.splat(0.0));
            for (found, seen) in found.iter_mut().zip(column(input.compliance, j)) {
                *found = o.0.select_f64s(here, o.less(*found, o.splat(*seen), forces[j]), *found);
            }
        }
        let riders = &self.riders.vectors::<S>()[..input.riders.count()];
        for (r, force) in riders.iter().enumerate() {
            for (found, seen) in found.iter_mut().zip(input.riders.on_links(r)) {
                *found = o.less(*found, o.splat(*seen), *force);
            }
        }
        let (is_active, stiffness) = (self.is_active.vectors::<S>(), self.stiffness.vectors::<S>());
        let (offset, unscaled) = (self.offset.vectors::<S>(), o.splat(1.0 / input.weight));
        for (p, &i) in self.active.iter().enumerate() {
            let on_branch = o.0.div_f64s(o.fma(forces[i], unscaled, offset[p]), stiffness[p]);
            let here = o.0.greater_than_f64s(is_active[p], o.splat(0.0));
            found[i] = o.0.select_f64s(here, on_branch, found[i]);
        }
    }

    /// What a lane's forces ask for: the end of its solution, or other states, which it then has.
    #[inline(always)]
    fn ask(
        &self,
        lane: usize,
        of: &mut LaneStates,
        laws: &[LinkLaw],
        input: ContactInput,
        limit: usize,
    ) -> Option<Result<(), NotSettled>> {
        of.iterations += 1;
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

/// More lanes than any vector has may be asked for at once.
pub(super) type LaneLaws<'a> = [&'a [LinkLaw]; MOST_LANES];

/// A column of the compliance, which is a row, the matrix being symmetric.
#[inline(always)]
fn column(compliance: &DMatrix<f64>, i: usize) -> &[f64] {
    let n = compliance.nrows();
    &compliance.as_slice()[i * n..][..n]
}

#[cfg(test)]
mod tests {
    use super::{ContactInput, ContactSystem};
    use crate::connector::{Connection, State};
    use crate::contact::{ContactProblem, LinkLaw};
    use crate::operator::lane_array::LaneArray;
    use crate::operator::panel::InstructionPath;
    use crate::operator::rider_block::RiderBlock;
    use crate::operator::vector::Ops;
    use nalgebra::{DMatrix, DVector};
    use pulp::{Arch, Simd, WithSimd};

    const WEIGHT: f64 = 0.6;

    struct Solve<'a>(&'a mut ContactSystem, ContactInput<'a>);

    impl WithSimd for Solve<'_> {
        type Output = ();

        fn with_simd<S: Simd>(self, simd: S) {
            self.0.solve(Ops(simd), self.1, 20);
        }
    }

    /// Links of unlike laws: three with gaps, one linear.
    fn laws() -> [LinkLaw; 4] {
        let gaps = |gap_tension_m, gap_compression_m| Connection::Nonlinear {
            gap_tension_m,
            gap_compression_m,
        };
        [
            LinkLaw::connector(2.0, gaps(0.1, 0.2)),
            LinkLaw::connector(3.0, gaps(0.5, 0.05)),
            LinkLaw::connector(1.5, Connection::Linear),
            LinkLaw::connector(4.0, gaps(2.0, 2.0)),
        ]
    }

    /// What riders see of links, and links of riders.
    fn coupling(r: usize, i: usize, symmetric: bool, back: bool) -> f64 {
        let plain = 0.1 * ((2 * r + i) as f64 + 0.3).sin();
        if back && !symmetric { 1.3 * plain + 0.02 } else { plain }
    }

    /// The reference solver's answer and the lane's, the stiffness of the lane's first link multiplied by `factor`: states,
    /// then forces, elongations and riders.
    fn answers(riders: usize, symmetric: bool, factor: f64) -> [(Vec<State>, Vec<f64>); 2] {
        let (laws, n) = (laws(), 4);
        let compliance = DMatrix::from_fn(n, n, |i, j| {
            if i == j {
                0.4
            } else {
                0.1 / (1.0 + i.abs_diff(j) as f64)
            }
        });
        let among = DMatrix::from_fn(riders, riders, |i, j| if i == j { 0.9 } else { 0.05 });
        let (e_free, free) = (vec![0.7, -0.6, 0.3, 0.4], 0.25);
        let problem = ContactProblem {
            e_free: e_free.clone(),
            connectors: &compliance,
            weight: WEIGHT,
            connectors_riders: DMatrix::from_fn(n, riders, |i, r| coupling(r, i, symmetric, true)),
            riders_connectors: DMatrix::from_fn(riders, n, |r, i| coupling(r, i, symmetric, false)),
            riders: among.clone(),
            riders_free: DVector::from_element(riders, free),
            one_sided: Vec::new(),
        };
        let reference = problem.solve(&laws, &[State::Open; 4], 20).expect("settled");
        let width = InstructionPath::of_this_machine().lanes;
        let mut block = RiderBlock::new(2, n, width);
        block.begin(riders, symmetric, riders);
        for r in 0..riders {
            let row = block.row_mut(r);
            row.among.copy_from_slice(among.row(r).into_owned().as_slice());
            for i in 0..n {
                row.of_links[i] = coupling(r, i, symmetric, false);
                if !symmetric {
                    row.on_links[i] = coupling(r, i, symmetric, true);
                }
            }
            block.free.row_mut(r).fill(free);
        }
        let mut wrong = laws;
        if factor != 1.0 {
            let gaps = Connection::Nonlinear {
                gap_tension_m: 0.1,
                gap_compression_m: 0.2,
            };
            wrong[0] = LinkLaw::connector(2.0 * factor, gaps);
        }
        let mut e = LaneArray::new(n, width);
        for (i, free) in e_free.iter().enumerate() {
            e.row_mut(i).fill(*free);
        }
        let mut system = ContactSystem::new(n, 2, 20, width);
        // the last lane alone, the others at rest
        let lane = width - 1;
        let input = ContactInput {
            lanes: &[lane],
            laws: &[&wrong],
            e: &e,
            compliance: &compliance,
            weight: WEIGHT,
            riders: &block,
        };
        Arch::new().dispatch(Solve(&mut system, input));
        system.outcome(lane, &wrong).expect("settled");
        let linear = &system.linear;
        let forces = linear.forces.lane(lane).map(|f| f / WEIGHT);
        let riders = linear.riders.lane(lane).take(riders);
        let numbers = forces.chain(linear.found.lane(lane)).chain(riders);
        let of_reference = [reference.forces, reference.elongations, reference.riders].concat();
        let numbers = numbers.collect();
        [
            (reference.states, of_reference),
            (system.states(lane).to_vec(), numbers),
        ]
    }

    fn apart([(states, a), (lane_states, b)]: [(Vec<State>, Vec<f64>); 2]) -> f64 {
        assert_eq!(states, [State::Tension, State::Compression, State::Both, State::Open]);
        assert_eq!(states, lane_states);
        assert_eq!(a.len(), b.len());
        a.iter().zip(&b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    }

    /// Each link follows its own law, with riders and without, whose coupling may differ there and back: the lane's system
    /// and the reference solver's agree to rounding of numbers near 1. A stiffness that is 5 % off is found.
    #[test]
    fn links_of_unlike_laws_agree_with_the_reference() {
        for (riders, symmetric) in [(0, true), (2, true), (2, false)] {
            let off = apart(answers(riders, symmetric, 1.0));
            assert!(off < 1e-13, "{riders} riders: {off:e}");
            let wrong = apart(answers(riders, symmetric, 1.05));
            assert!(wrong > 1e-4, "{riders} riders: a wrong law passes, {wrong:e}");
        }
    }
}
