//! The small piecewise-linear systems of a step (C1), one a lane: links, each with a law of its own, and what rides along.
//!
//! Knows numbers laid out once, so that a step allocates nothing. Does not know modes, nor what a link or a rider is. Each is
//! the problem of [`crate::contact`]: the active set decides the tangent, a state changes only between Newton solutions.
//!
//! Lanes are solved together, each on its own active set: a link that is open in a lane is left out of that lane's matrix, which
//! changes no bit of the others.

use super::active_sets::{ContactInput, LaneStates, LinearSystem};
use super::panel::MOST_LANES;
use super::state_bounds::StateBounds;
use super::vector::Ops;
use crate::connector::State;
use crate::contact::{LinkLaw, NotSettled};
use pulp::Simd;

/// The small systems of all lanes, kept from step to step.
#[derive(Debug)]
pub(super) struct ContactSystem {
    /// States and what became of them, of each lane.
    lanes: Vec<LaneStates>,
    links: usize,
    /// What is solved on the active sets.
    pub(super) linear: LinearSystem,
    bounds: StateBounds,
}

impl ContactSystem {
    /// Room for so many links and riders in each lane.
    pub(super) fn new(links: usize, riders: usize, newton_limit: usize, lanes: usize) -> Self {
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
            linear: LinearSystem::new(links, riders, lanes),
            bounds: StateBounds::new(links, lanes),
        }
    }

    /// Forgets what was factored for other laws or another step length.
    pub(super) fn forget(&mut self) {
        self.linear.forget();
        self.bounds.forget();
    }

    /// Laws of dashpots change in every step.
    #[inline(always)]
    pub(super) fn forget_laws(&mut self) {
        self.linear.forget_laws();
        self.bounds.forget();
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
        let (c, n) = (self.links, self.linear.links.active.len() + riders);
        (solutions * (n * n * n / 3 + 2 * n * n + 2 * c * n)) as f64
    }

    /// Solves from the states of the lanes; leaves new states, elongations, forces and rider forces. Where a lane does not settle, its
    /// states are as before and the others say nothing.
    #[inline(always)]
    pub(super) fn solve<S: Simd>(&mut self, o: Ops<S>, input: ContactInput, limit: usize) {
        for &lane in input.lanes {
            let of = &mut self.lanes[lane];
            of.seen.clear();
            (of.iterations, of.ended) = (0, None);
        }
        loop {
            self.linear.solve(o, &self.lanes, input);
            self.linear.elongate(o, input);
            for (&lane, laws) in input.lanes.iter().zip(input.laws) {
                self.bounds.take(lane, &self.lanes[lane].states, laws);
            }
            let staying = self.bounds.staying(o, &self.linear.found);
            let mut all = true;
            for (&lane, laws) in input.lanes.iter().zip(input.laws) {
                let of = &mut self.lanes[lane];
                if of.ended.is_some() {
                    continue;
                }
                of.iterations += 1;
                // riders may press on one side alone
                of.ended = match staying[lane] > 0.0 && of.states.len() == self.links {
                    true => Some(Ok(())),
                    false => self.linear.ask(lane, of, laws, input, limit),
                };
                all &= of.ended.is_some();
            }
            if all {
                break;
            }
        }
        for &lane in input.lanes {
            let of = &mut self.lanes[lane];
            if let (Some(Err(_)), true) = (of.ended, of.iterations > 1) {
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
        if of.iterations == 1 {
            return Ok((1, 0));
        }
        let links = of.states.iter().zip(&of.before).zip(laws);
        let switched = links.filter(|((a, b), _)| a != b);
        Ok((of.iterations, switched.map(|(_, law)| law.links).sum()))
    }
}

/// More lanes than any vector has may be asked for at once.
pub(super) type LaneLaws<'a> = [&'a [LinkLaw]; MOST_LANES];

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

    struct Solve<'a>(&'a mut ContactSystem, ContactInput<'a>, usize);

    impl WithSimd for Solve<'_> {
        type Output = ();

        fn with_simd<S: Simd>(self, simd: S) {
            self.0.solve(Ops(simd), self.1, self.2);
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
        Arch::new().dispatch(Solve(&mut system, input, 20));
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
