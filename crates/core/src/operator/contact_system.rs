//! The small piecewise-linear system of one lane's step (C1): links, each with a law of its own, and what rides along.
//!
//! Knows numbers laid out once, so that a step allocates nothing. Does not know modes, nor what a link or a rider is. It is
//! the problem of [`crate::contact`]: the active set decides the tangent, a state changes only between Newton solutions.

use super::rider_block::RiderBlock;
use super::small_matrix::{SmallMatrix, subtract};
use crate::connector::State;
use crate::contact::{LinkLaw, NotSettled, PiecewiseLinear, ask, settle};
use nalgebra::DMatrix;

/// The small system of one lane, kept from step to step.
#[derive(Debug)]
pub(super) struct ContactSystem {
    /// State of each link, behind them of each one-sided rider: at work in compression, or open.
    pub(super) states: Vec<State>,
    links: usize,
    /// The states before, and active sets met in this step, one after the other.
    before: Vec<State>,
    seen: Vec<State>,
    /// What is solved on one active set.
    pub(super) linear: LinearSystem,
}

/// The linear system of an active set, with room for the largest.
#[derive(Debug)]
pub(super) struct LinearSystem {
    /// Elongations without link and rider forces, then with them `[m]`.
    pub(super) e: Vec<f64>,
    /// Scaled forces `N' = weight N` of the active links, 0 of the others `[N]`.
    pub(super) forces: Vec<f64>,
    /// Scaled rider forces q'.
    pub(super) riders: Vec<f64>,
    found: Vec<f64>,
    active: Vec<usize>,
    matrix: SmallMatrix,
    rhs: Vec<f64>,
    /// The states that `matrix` was factored for, without riders.
    factored_states: Vec<State>,
    /// Whether there are such.
    factored: bool,
}

/// The system of one step.
struct OfStep<'a> {
    linear: &'a mut LinearSystem,
    input: ContactInput<'a>,
}

/// What a step asks of the system.
#[derive(Clone, Copy)]
pub(super) struct ContactInput<'a> {
    /// The law of each link.
    pub laws: &'a [LinkLaw],
    /// Compliance of the step among links `[m/N]`.
    pub compliance: &'a DMatrix<f64>,
    /// Weight of the new force in the balance, `N' = weight N`.
    pub weight: f64,
    /// What rides along.
    pub riders: &'a RiderBlock,
}

impl PiecewiseLinear for OfStep<'_> {
    type Solution = ();

    #[inline(always)]
    fn solve(&mut self, states: &[State], asked: &mut [State]) -> Option<()> {
        self.linear.solve(states, self.input);
        self.linear.elongate(states, self.input);
        let links = self.input.laws.len();
        let (of_links, of_riders) = asked.split_at_mut(links);
        ask(self.input.laws, &self.linear.found, of_links);
        self.linear.ask_riders(&states[links..], of_riders, self.input.riders);
        Some(())
    }
}

impl ContactSystem {
    /// Room for so many links and riders.
    pub(super) fn new(links: usize, riders: usize, newton_limit: usize) -> Self {
        let open = vec![State::Open; links];
        Self {
            states: open.clone(),
            links,
            before: open.clone(),
            seen: Vec::with_capacity(links * (newton_limit + 1)),
            linear: LinearSystem {
                e: vec![0.0; links],
                forces: vec![0.0; links],
                riders: vec![0.0; riders],
                found: vec![0.0; links],
                active: Vec::with_capacity(links),
                matrix: SmallMatrix::new(links + riders),
                rhs: vec![0.0; links + riders],
                factored_states: open,
                factored: false,
            },
        }
    }

    /// Forgets what was factored for other laws or another step length.
    pub(super) fn forget(&mut self) {
        self.linear.factored = false;
    }

    /// Begins a step whose one-sided riders press or are off the deck.
    #[inline(always)]
    pub(super) fn begin_riders(&mut self, pressing: impl Iterator<Item = bool>) {
        self.states.truncate(self.links);
        self.states
            .extend(pressing.map(|presses| if presses { State::Compression } else { State::Open }));
    }

    /// Operations of a solution with so many riders: factors, substitutions and elongations of each Newton solution; factors
    /// that were kept are counted as if they were made.
    pub(super) fn flop(&self, riders: usize, solved: &Result<(usize, usize), NotSettled>) -> f64 {
        let solutions = match solved {
            Ok((solutions, _)) => *solutions,
            Err(stuck) => stuck.iterations,
        };
        let (c, n) = (self.links, self.linear.active.len() + riders);
        (solutions * (n * n * n / 3 + 2 * n * n + 2 * c * n)) as f64
    }

    /// Solves from `states`, with `e` the elongations without forces; leaves the new states, elongations, forces and rider
    /// forces and gives the number of Newton solutions and of states that changed. Where it does not settle, the states are
    /// as before.
    #[inline(always)]
    pub(super) fn solve(&mut self, input: ContactInput, limit: usize) -> Result<(usize, usize), NotSettled> {
        self.before.clone_from(&self.states);
        let mut system = OfStep {
            linear: &mut self.linear,
            input,
        };
        match settle(&mut system, &mut self.states, &mut self.seen, limit) {
            Ok(((), iterations)) => {
                self.linear.e.copy_from_slice(&self.linear.found);
                let links = self.states.iter().zip(&self.before).zip(input.laws);
                let switched = links.filter(|((a, b), _)| a != b);
                let switches = switched.map(|(_, law)| law.links).sum();
                Ok((iterations, switches))
            }
            Err(stuck) => {
                self.states.copy_from_slice(&self.before);
                Err(stuck)
            }
        }
    }
}

impl LinearSystem {
    /// One Newton solution (C2): riders first, then the active links, eliminated in that order. Symmetric and positive
    /// definite but for the convective terms, so that no pivots are sought. Without riders the matrix depends on the active
    /// set alone and its factors are kept.
    #[inline(always)]
    fn solve(&mut self, states: &[State], input: ContactInput) {
        let (laws, riders) = (input.laws, input.riders);
        let nr = riders.count();
        let (states, of_riders) = states.split_at(laws.len());
        if !(nr == 0 && self.factored && self.factored_states == states) {
            self.active.clear();
            for (i, state) in states.iter().enumerate() {
                if *state != State::Open {
                    self.active.push(i);
                }
            }
            self.assemble(states, input);
            for (r, _) in lifted(of_riders, nr) {
                self.lift(r, nr + self.active.len());
            }
            self.matrix.factor(nr + self.active.len(), riders.symmetric());
            self.factored_states.copy_from_slice(states);
            self.factored = nr == 0;
        }
        let n = nr + self.active.len();
        self.rhs[..nr].copy_from_slice(riders.free());
        for (r, _) in lifted(of_riders, nr) {
            self.rhs[r] = 0.0;
        }
        for (p, &i) in self.active.iter().enumerate() {
            let branch = laws[i].branch(states[i]);
            self.rhs[nr + p] = self.e[i] - branch.offset / branch.stiffness;
        }
        self.matrix.solve(&mut self.rhs[..n]);
        self.riders[..nr].copy_from_slice(&self.rhs[..nr]);
        self.forces.fill(0.0);
        for (p, &i) in self.active.iter().enumerate() {
            self.forces[i] = self.rhs[nr + p];
        }
    }

    /// Writes the matrix of the active set; below the diagonal only where it is not symmetric.
    #[inline(always)]
    fn assemble(&mut self, states: &[State], input: ContactInput) {
        let ContactInput {
            laws,
            compliance,
            weight,
            riders,
        } = input;
        let nr = riders.count();
        let n = nr + self.active.len();
        for i in 0..nr {
            let row = self.matrix.row_mut(i, n);
            row[..nr].copy_from_slice(riders.among(i));
            let of = riders.of_links(i);
            for (entry, &j) in row[nr..].iter_mut().zip(&self.active) {
                *entry = of[j];
            }
        }
        for (p, &i) in self.active.iter().enumerate() {
            let row = self.matrix.row_mut(nr + p, n);
            if !riders.symmetric() {
                for (r, entry) in row[..nr].iter_mut().enumerate() {
                    *entry = riders.on_links(r)[i];
                }
            }
            let seen = column(compliance, i);
            for (entry, &j) in row[nr..].iter_mut().zip(&self.active) {
                *entry = seen[j];
            }
            row[nr + p] += 1.0 / (weight * laws[i].branch(states[i]).stiffness);
        }
    }

    /// Takes a rider that is off the deck out of the matrix of order `n`.
    #[cold]
    fn lift(&mut self, rider: usize, n: usize) {
        for i in 0..n {
            self.matrix.row_mut(i, n)[rider] = 0.0;
        }
        let row = self.matrix.row_mut(rider, n);
        row.fill(0.0);
        row[rider] = 1.0;
    }

    /// The states that the one-sided riders ask for: one that presses stays while its force does, one that is off the deck comes
    /// back where it would press.
    #[inline(always)]
    fn ask_riders(&self, states: &[State], asked: &mut [State], riders: &RiderBlock) {
        let first = riders.count() - states.len();
        for ((r, is), asked) in (first..).zip(states).zip(asked) {
            let presses = match is {
                State::Open => self.left_over(r, riders) > 0.0,
                _ => self.riders[r] > 0.0,
            };
            *asked = if presses { State::Compression } else { State::Open };
        }
    }

    /// What a rider without force is measured by under the forces of the others.
    fn left_over(&self, r: usize, riders: &RiderBlock) -> f64 {
        let sum = |seen: &[f64], forces: &[f64]| seen.iter().zip(forces).map(|(a, b)| a * b).sum::<f64>();
        riders.free()[r] - sum(riders.among(r), &self.riders) - sum(riders.of_links(r), &self.forces)
    }

    /// Elongations under the forces found. On an active branch they follow from the force, without cancellation.
    #[inline(always)]
    fn elongate(&mut self, states: &[State], input: ContactInput) {
        self.found.copy_from_slice(&self.e);
        for &j in &self.active {
            subtract(&mut self.found, self.forces[j], column(input.compliance, j));
        }
        for r in 0..input.riders.count() {
            subtract(&mut self.found, self.riders[r], input.riders.on_links(r));
        }
        for &i in &self.active {
            let branch = input.laws[i].branch(states[i]);
            self.found[i] = (self.forces[i] / input.weight + branch.offset) / branch.stiffness;
        }
    }
}

/// The one-sided riders that are off the deck, of so many riders the last.
#[inline(always)]
fn lifted(states: &[State], riders: usize) -> impl Iterator<Item = (usize, &State)> {
    let first = riders - states.len();
    (first..).zip(states).filter(|(_, state)| **state == State::Open)
}

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
    use crate::operator::rider_block::RiderBlock;
    use nalgebra::{DMatrix, DVector};

    const WEIGHT: f64 = 0.6;

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
        let mut block = RiderBlock::new(2, n);
        block.begin(riders, symmetric);
        for r in 0..riders {
            let row = block.row_mut(r);
            row.among.copy_from_slice(among.row(r).into_owned().as_slice());
            for i in 0..n {
                row.of_links[i] = coupling(r, i, symmetric, false);
                if !symmetric {
                    row.on_links[i] = coupling(r, i, symmetric, true);
                }
            }
            *row.free = free;
        }
        let mut wrong = laws;
        if factor != 1.0 {
            let gaps = Connection::Nonlinear {
                gap_tension_m: 0.1,
                gap_compression_m: 0.2,
            };
            wrong[0] = LinkLaw::connector(2.0 * factor, gaps);
        }
        let mut system = ContactSystem::new(n, 2, 20);
        system.linear.e.copy_from_slice(&e_free);
        let input = ContactInput {
            laws: &wrong,
            compliance: &compliance,
            weight: WEIGHT,
            riders: &block,
        };
        system.solve(input, 20).expect("settled");
        let lane = &system.linear;
        let forces = lane.forces.iter().map(|f| f / WEIGHT);
        let numbers = forces
            .chain(lane.e.iter().copied())
            .chain(lane.riders[..riders].iter().copied());
        let of_reference = [reference.forces, reference.elongations, reference.riders].concat();
        [(reference.states, of_reference), (system.states, numbers.collect())]
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
