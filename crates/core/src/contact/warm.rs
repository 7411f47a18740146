//! Connectors alone under a load that creeps: each solution starts from the states of the one before.
//!
//! Knows `e = e_free - connectors N(e)` with its factor and memory kept, by the same Newton as every other contact. Does
//! not know where the load is, nor what to do where it does not settle.

use super::{ContactSolution, LinkLaw, NotSettled, PiecewiseLinear, ask, settle};
use crate::connector::State;
use crate::response::DeadState;
use nalgebra::{Cholesky, DMatrix, DVector, DVectorViewMut, Dyn};
use std::borrow::Cow;

/// Connectors and their laws, with the states, forces and elongations of the last load.
#[derive(Debug)]
pub(crate) struct WarmContact<'a> {
    laws: Vec<LinkLaw>,
    /// Elongations that the forces at rest would undo `[m]`; nothing without a dead load.
    held: Vec<f64>,
    states: Vec<State>,
    seen: Vec<State>,
    tangent: Tangent<'a>,
}

impl<'a> WarmContact<'a> {
    /// Connectors with the flexibility `connectors` `[m/N]` among them, at rest.
    pub(crate) fn new(connectors: &'a DMatrix<f64>, laws: Vec<LinkLaw>, dead: Option<&DeadState>) -> Self {
        let nc = connectors.nrows();
        let held = dead.map(|dead| connectors * DVector::from_column_slice(&dead.forces_n));
        Self {
            states: laws.iter().map(|law| law.state(0.0)).collect(),
            held: held.map_or_else(Vec::new, |held| held.iter().copied().collect()),
            laws,
            seen: Vec::new(),
            tangent: Tangent {
                connectors,
                active: Vec::with_capacity(nc),
                factor: None,
                active_forces: Vec::with_capacity(nc),
                forces: vec![0.0; nc],
                elongations: vec![0.0; nc],
            },
        }
    }

    /// Solves for the elongations without more forces than at rest `e_free` `[m]`, from the last states on; gives the number of Newton
    /// solutions.
    ///
    /// # Errors
    /// [`NotSettled`] on a cycle, after `limit` solutions, or where the small matrix is not positive definite; forces
    /// are then no solution's until [`Self::restart`].
    pub(crate) fn solve(&mut self, e_free: &[f64], limit: usize) -> Result<usize, NotSettled> {
        let mut from_rest = Cow::Borrowed(e_free);
        if !self.held.is_empty() {
            from_rest
                .to_mut()
                .iter_mut()
                .zip(&self.held)
                .for_each(|(e, held)| *e += held);
        }
        let mut system = UnderLoad {
            laws: &self.laws,
            tangent: &mut self.tangent,
            e_free: &from_rest,
        };
        let ((), iterations) = settle(&mut system, &mut self.states, &mut self.seen, limit)?;
        Ok(iterations)
    }

    /// Goes on from a solution that was found otherwise.
    pub(crate) fn restart(&mut self, solution: &ContactSolution) {
        self.states.copy_from_slice(&solution.states);
        self.tangent.forces.copy_from_slice(&solution.forces);
        self.tangent.elongations.copy_from_slice(&solution.elongations);
    }

    /// Force of each connector, tension positive `[N]`.
    pub(crate) fn forces(&self) -> &[f64] {
        &self.tangent.forces
    }
}

/// Connectors under one load.
struct UnderLoad<'a, 'c> {
    laws: &'a [LinkLaw],
    tangent: &'a mut Tangent<'c>,
    e_free: &'a [f64],
}

impl PiecewiseLinear for UnderLoad<'_, '_> {
    type Solution = ();

    fn solve(&mut self, states: &[State], asked: &mut [State]) -> Option<()> {
        self.tangent.solve(self.laws, states, self.e_free)?;
        ask(self.laws, &self.tangent.elongations, asked);
        Some(())
    }
}

/// The linear system of an active set, factorised for as long as the same connectors are at work.
#[derive(Debug)]
struct Tangent<'a> {
    connectors: &'a DMatrix<f64>,
    /// Connectors at work, and the factor of `connectors + 1/k` among them.
    active: Vec<usize>,
    factor: Option<Cholesky<f64, Dyn>>,
    active_forces: Vec<f64>,
    forces: Vec<f64>,
    elongations: Vec<f64>,
}

impl Tangent<'_> {
    /// Forces and elongations of an active set; none where its matrix is not positive definite.
    fn solve(&mut self, laws: &[LinkLaw], states: &[State], e_free: &[f64]) -> Option<()> {
        let at_work = |&i: &usize| states[i] != State::Open;
        if self.factor.is_none() || self.active.iter().copied().ne((0..states.len()).filter(at_work)) {
            self.active.clear();
            self.active.extend((0..states.len()).filter(at_work));
            self.factorise(laws, states);
        }
        let branches = || self.active.iter().map(|&i| (i, laws[i].branch(states[i])));
        self.active_forces.clear();
        self.active_forces
            .extend(branches().map(|(i, branch)| e_free[i] - branch.offset / branch.stiffness));
        let n = self.active_forces.len();
        let mut x = DVectorViewMut::from_slice(&mut self.active_forces, n);
        self.factor.as_ref()?.solve_mut(&mut x);
        self.forces.fill(0.0);
        for (&i, &force) in self.active.iter().zip(&self.active_forces) {
            self.forces[i] = force;
        }
        for (i, e) in self.elongations.iter_mut().enumerate() {
            *e = if states[i] == State::Open {
                let seen = self.connectors.column(i);
                let shortening = |(&j, force): (&usize, &f64)| seen[j] * force;
                let forces = self.active.iter().zip(&self.active_forces);
                e_free[i] - forces.map(shortening).sum::<f64>()
            } else {
                // the active line holds exactly: the elongation follows from the force, without cancellation
                let branch = laws[i].branch(states[i]);
                (self.forces[i] + branch.offset) / branch.stiffness
            };
        }
        Some(())
    }

    /// Factorises the matrix of the active set in the memory of the last.
    fn factorise(&mut self, laws: &[LinkLaw], states: &[State]) {
        let last = self.factor.take();
        let mut a: Vec<f64> = last.map_or_else(Vec::new, |factor| factor.unpack_dirty().data.into());
        a.clear();
        for &j in &self.active {
            let compliance = 1.0 / laws[j].branch(states[j]).stiffness;
            let own = |i: usize| if i == j { compliance } else { 0.0 };
            a.extend(self.active.iter().map(|&i| self.connectors[(i, j)] + own(i)));
        }
        let n = self.active.len();
        self.factor = Cholesky::new(DMatrix::from_vec(n, n, a));
    }
}
