//! The contact problem of one step or one static case: connectors that work or not, and masses that ride along.
//!
//! Knows a small piecewise-linear system. The active set decides the tangent; a state changes only between Newton
//! solutions, never inside one. Does not know time.

mod dashpot;
mod link;
mod warm;

use crate::connector::State;
pub(crate) use dashpot::{BackwardRate, Dashpot, DashpotTrail};
pub(crate) use link::{Branch, LinkLaw, Uptake, ask, rest_force_n};
use nalgebra::{DMatrix, DVector};
pub(crate) use warm::WarmContact;

/// The small system: with `N' = weight N(e)` and the scaled rider forces q',
///
/// `e = e_free - connectors N' - connectors_riders q'`, `riders q' = riders_free - riders_connectors N'`.
/// Equation (C1).
#[derive(Debug)]
pub(crate) struct ContactProblem<'a> {
    /// Elongations without connector and rider forces `[m]`.
    pub e_free: Vec<f64>,
    /// Flexibility among the connectors `[m/N]`.
    pub connectors: &'a DMatrix<f64>,
    /// Weight of the new force in the balance: `N' = weight N` (1 in statics, `1 - alpha_f` in a step).
    pub weight: f64,
    /// Elongation from unit rider forces, connectors x riders.
    pub connectors_riders: DMatrix<f64>,
    /// What a rider's measure sees of unit connector forces, riders x connectors.
    pub riders_connectors: DMatrix<f64>,
    /// What a rider's measure sees of unit rider forces plus its own compliance on the diagonal, riders x riders.
    pub riders: DMatrix<f64>,
    /// Riders' measure without forces.
    pub riders_free: DVector<f64>,
    /// The riders that only press: wheels on springs, which leave the deck where their force would pull.
    pub one_sided: Vec<usize>,
}

/// The answer of the small system.
#[derive(Debug, Clone)]
pub(crate) struct ContactSolution {
    /// State of each connector, then of each one-sided rider: at work in compression, or open.
    pub states: Vec<State>,
    /// Force of each connector, tension positive `[N]`.
    pub forces: Vec<f64>,
    /// Elongation of each connector `[m]`.
    pub elongations: Vec<f64>,
    /// Scaled rider forces q'.
    pub riders: Vec<f64>,
    /// Newton solutions.
    pub iterations: usize,
}

/// The active set came back to one it had been before, or the limit was reached.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct NotSettled {
    /// A connector that still wanted to change; beyond their number a one-sided rider.
    pub connector: usize,
    /// Newton solutions made.
    pub iterations: usize,
}

impl ContactProblem<'_> {
    /// Solves from a first guess of the states, those of one-sided riders behind those of connectors.
    ///
    /// # Errors
    /// [`NotSettled`] on a cycle, after `limit` solutions, or where the small matrix is singular.
    pub(crate) fn solve(&self, laws: &[LinkLaw], first: &[State], limit: usize) -> Result<ContactSolution, NotSettled> {
        let guess = |(law, &first): (&LinkLaw, &State)| match law.at_rest() {
            State::Both => State::Both,
            _ => first,
        };
        let of_riders = first[laws.len()..].iter().copied();
        let mut states: Vec<State> = laws.iter().zip(first).map(guess).chain(of_riders).collect();
        let mut system = UnderLaws { problem: self, laws };
        let (solution, iterations) = settle(&mut system, &mut states, &mut Vec::new(), limit)?;
        Ok(ContactSolution { iterations, ..solution })
    }

    /// What a rider without force is measured by under the forces of the others: above 0 it would press.
    fn left_over(&self, rider: usize, found: &ContactSolution) -> f64 {
        let of_riders: f64 = (0..).zip(&found.riders).map(|(j, q)| self.riders[(rider, j)] * q).sum();
        let of_links = (0..).zip(&found.forces);
        let of_links: f64 = of_links
            .map(|(i, n)| self.riders_connectors[(rider, i)] * self.weight * n)
            .sum();
        self.riders_free[rider] - of_riders - of_links
    }

    /// The problem where the structure feels what the links' forces are beyond those at rest `[N]`.
    /// Equation (D3).
    #[must_use]
    pub(crate) fn with_rest(mut self, forces_n: &[f64]) -> Self {
        let held = DVector::from_iterator(forces_n.len(), forces_n.iter().map(|n| self.weight * n));
        let among = self.connectors * &held;
        self.e_free
            .iter_mut()
            .zip(among.iter())
            .for_each(|(e, held)| *e += held);
        self.riders_free += &self.riders_connectors * held;
        self
    }

    /// One Newton solution: the linear system of an active set.
    /// Equation (C2).
    fn linear(&self, laws: &[LinkLaw], states: &[State]) -> Option<ContactSolution> {
        let active: Vec<usize> = (0..laws.len()).filter(|&i| states[i] != State::Open).collect();
        let off = self.one_sided.iter().zip(&states[laws.len()..]);
        let off: Vec<usize> = off
            .filter(|(_, state)| **state == State::Open)
            .map(|(r, _)| *r)
            .collect();
        let (na, nr) = (active.len(), self.riders_free.len());
        let branches: Vec<_> = states.iter().zip(laws).map(|(&s, law)| law.branch(s)).collect();
        let mut a = DMatrix::zeros(na + nr, na + nr);
        let mut b = DVector::zeros(na + nr);
        for (p, &i) in active.iter().enumerate() {
            for (q, &j) in active.iter().enumerate() {
                a[(p, q)] = self.connectors[(i, j)];
            }
            a[(p, p)] += 1.0 / (self.weight * branches[i].stiffness);
            for r in 0..nr {
                a[(p, na + r)] = self.connectors_riders[(i, r)];
                a[(na + r, p)] = self.riders_connectors[(r, i)];
            }
            b[p] = self.e_free[i] - branches[i].offset / branches[i].stiffness;
        }
        a.view_mut((na, na), (nr, nr)).copy_from(&self.riders);
        b.rows_mut(na, nr).copy_from(&self.riders_free);
        for r in off {
            // a wheel that is off the deck has no force
            a.row_mut(na + r).fill(0.0);
            a.column_mut(na + r).fill(0.0);
            (a[(na + r, na + r)], b[na + r]) = (1.0, 0.0);
        }
        let x = if na + nr == 0 { b } else { a.lu().solve(&b)? };
        let riders: Vec<f64> = x.rows(na, nr).iter().copied().collect();
        let mut elongations = self.e_free.clone();
        for (i, e) in elongations.iter_mut().enumerate() {
            *e -= active
                .iter()
                .enumerate()
                .map(|(p, &j)| self.connectors[(i, j)] * x[p])
                .sum::<f64>();
            *e -= riders
                .iter()
                .enumerate()
                .map(|(r, q)| self.connectors_riders[(i, r)] * q)
                .sum::<f64>();
        }
        let mut forces = vec![0.0; laws.len()];
        for (p, &i) in active.iter().enumerate() {
            forces[i] = x[p] / self.weight;
            // the active line holds exactly: the elongation follows from the force, without cancellation
            elongations[i] = (forces[i] + branches[i].offset) / branches[i].stiffness;
        }
        Some(ContactSolution {
            states: states.to_vec(),
            forces,
            elongations,
            riders,
            iterations: 0,
        })
    }
}

/// A problem under the laws of its connectors.
struct UnderLaws<'a> {
    problem: &'a ContactProblem<'a>,
    laws: &'a [LinkLaw],
}

impl PiecewiseLinear for UnderLaws<'_> {
    type Solution = ContactSolution;

    fn solve(&mut self, states: &[State], asked: &mut [State]) -> Option<ContactSolution> {
        let solution = self.problem.linear(self.laws, states)?;
        let (of_links, of_riders) = asked.split_at_mut(self.laws.len());
        ask(self.laws, &solution.elongations, of_links);
        for ((&r, is), asked) in self
            .problem
            .one_sided
            .iter()
            .zip(&states[self.laws.len()..])
            .zip(of_riders)
        {
            let presses = match is {
                State::Open => self.problem.left_over(r, &solution) > 0.0,
                _ => solution.riders[r] > 0.0,
            };
            *asked = if presses { State::Compression } else { State::Open };
        }
        Some(solution)
    }
}

/// A piecewise-linear system, which is linear on one active set.
pub(crate) trait PiecewiseLinear {
    /// Its solution on an active set.
    type Solution;

    /// Solves on the active set of some states and writes the states that its elongations ask for; none where the matrix is
    /// singular.
    fn solve(&mut self, states: &[State], asked: &mut [State]) -> Option<Self::Solution>;
}

/// Newton on the active set (C2), from `states` on. Gives the solution that asks for no other states and the number of
/// solutions; `seen` is memory.
///
/// # Errors
/// [`NotSettled`] on a cycle, after `limit` solutions, or where a matrix is singular; the states are then of no solution.
#[inline(always)]
pub(crate) fn settle<P: PiecewiseLinear>(
    system: &mut P,
    states: &mut [State],
    seen: &mut Vec<State>,
    limit: usize,
) -> Result<(P::Solution, usize), NotSettled> {
    seen.clear();
    let mut iterations = 0;
    loop {
        iterations += 1;
        let met = seen.len();
        seen.resize(met + states.len(), State::Open);
        let (met, asked) = seen.split_at_mut(met);
        let Some(solution) = system.solve(states, asked) else {
            return Err(NotSettled {
                connector: 0,
                iterations,
            });
        };
        let mut wants = None;
        for (i, (is, asked)) in states.iter().zip(&*asked).enumerate() {
            if wants.is_none() && is != asked {
                wants = Some(i);
            }
        }
        let Some(connector) = wants else {
            return Ok((solution, iterations));
        };
        if iterations >= limit || met.chunks_exact(states.len()).any(|earlier| earlier == asked) {
            return Err(NotSettled { connector, iterations });
        }
        states.copy_from_slice(asked);
    }
}
