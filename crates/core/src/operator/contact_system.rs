//! The small piecewise-linear system of one lane's step: connectors that work or not, and masses that ride along.
//!
//! Knows numbers laid out once, so that a step allocates nothing. Does not know modes. The same problem as
//! [`crate::contact`]: the active set decides the tangent, a state changes only between Newton solutions.

use super::moving_masses::MovingMasses;
use crate::connector::{Law, State};
use crate::contact::{NotSettled, PiecewiseLinear, ask, settle};
use nalgebra::DMatrix;

/// The small system of one lane, kept from step to step.
#[derive(Debug)]
pub(super) struct ContactSystem {
    /// State of each connector.
    pub(super) states: Vec<State>,
    /// The states before, and active sets met in this step, one after the other.
    before: Vec<State>,
    seen: Vec<State>,
    /// What is solved on one active set.
    pub(super) linear: LinearSystem,
}

/// The linear system of an active set, with room for the largest.
#[derive(Debug)]
pub(super) struct LinearSystem {
    /// Elongations without connector and mass forces, then with them `[m]`.
    pub(super) e: Vec<f64>,
    /// Scaled forces `N' = weight N` of the active connectors, 0 of the others `[N]`.
    pub(super) forces: Vec<f64>,
    /// Scaled mass forces q'.
    pub(super) masses: Vec<f64>,
    found: Vec<f64>,
    active: Vec<usize>,
    /// The factored matrix, `stride` columns a row.
    matrix: Vec<f64>,
    lower: Vec<f64>,
    rhs: Vec<f64>,
    stride: usize,
    /// The active set that `matrix` was factored for, without masses.
    factored: Vec<State>,
    /// Whether there is such a one, and the stiffness of a truss in it.
    factored_for: Option<f64>,
}

/// The system of one step.
struct OfStep<'a> {
    linear: &'a mut LinearSystem,
    law: &'a Law,
    compliance: &'a DMatrix<f64>,
    weight: f64,
    masses: &'a MovingMasses,
}

impl PiecewiseLinear for OfStep<'_> {
    type Solution = ();

    #[inline(always)]
    fn solve(&mut self, states: &[State], asked: &mut [State]) -> Option<()> {
        let (law, compliance, weight, masses) = (self.law, self.compliance, self.weight, self.masses);
        self.linear.solve(states, law, compliance, weight, masses);
        self.linear.elongate(states, law, compliance, weight, masses);
        ask(law, &self.linear.found, asked);
        Some(())
    }
}

impl ContactSystem {
    pub(super) fn new(connectors: usize, masses: usize, newton_limit: usize) -> Self {
        let stride = (connectors + masses).next_multiple_of(CHUNK);
        let open = vec![State::Open; connectors];
        Self {
            states: open.clone(),
            before: open.clone(),
            seen: Vec::with_capacity(connectors * (newton_limit + 1)),
            linear: LinearSystem {
                e: vec![0.0; connectors],
                forces: vec![0.0; connectors],
                masses: vec![0.0; masses],
                found: vec![0.0; connectors],
                active: Vec::with_capacity(connectors),
                matrix: vec![0.0; stride * stride],
                lower: vec![0.0; stride * stride],
                rhs: vec![0.0; stride],
                stride,
                factored: open,
                factored_for: None,
            },
        }
    }

    /// Forgets what was factored for another job.
    pub(super) fn forget(&mut self) {
        self.linear.factored_for = None;
    }

    /// Operations of a solution with so many masses: factors, substitutions and elongations of each Newton solution; factors
    /// that were kept are counted as if they were made.
    pub(super) fn flop(&self, masses: usize, solved: &Result<(usize, usize), NotSettled>) -> f64 {
        let solutions = match solved {
            Ok((solutions, _)) => *solutions,
            Err(stuck) => stuck.iterations,
        };
        let (c, n) = (self.states.len(), self.linear.active.len() + masses);
        (solutions * (n * n * n / 3 + 2 * n * n + 2 * c * n)) as f64
    }

    /// Solves from `states`, with `e` the elongations without forces; leaves the new states, elongations, forces and mass
    /// forces and gives the number of Newton solutions and of states that changed. Where it does not settle, the states are
    /// as before.
    #[inline(always)]
    pub(super) fn solve(
        &mut self,
        law: &Law,
        compliance: &DMatrix<f64>,
        weight: f64,
        masses: &MovingMasses,
        limit: usize,
    ) -> Result<(usize, usize), NotSettled> {
        self.before.copy_from_slice(&self.states);
        let mut system = OfStep {
            linear: &mut self.linear,
            law,
            compliance,
            weight,
            masses,
        };
        match settle(&mut system, &mut self.states, &mut self.seen, limit) {
            Ok(((), iterations)) => {
                self.linear.e.copy_from_slice(&self.linear.found);
                let switches = self.states.iter().zip(&self.before).filter(|(a, b)| a != b).count();
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
    /// One Newton solution: masses first, then the active connectors, eliminated in that order. Symmetric and positive
    /// definite but for the convective terms, so that no pivots are sought. Without masses the matrix depends on the active
    /// set alone and its factors are kept.
    #[inline(always)]
    fn solve(&mut self, states: &[State], law: &Law, compliance: &DMatrix<f64>, weight: f64, masses: &MovingMasses) {
        let (nr, stride) = (masses.count(), self.stride);
        let known = nr == 0 && self.factored_for == Some(law.k) && self.factored == states;
        if !known {
            self.active.clear();
            for (i, state) in states.iter().enumerate() {
                if *state != State::Open {
                    self.active.push(i);
                }
            }
            let n = nr + self.active.len();
            for i in 0..nr {
                let row = &mut self.matrix[i * stride..][..n];
                row[..nr].copy_from_slice(masses.row(i));
                let of = masses.of_connectors(i);
                for (entry, &j) in row[nr..].iter_mut().zip(&self.active) {
                    *entry = of[j];
                }
            }
            for (p, &i) in self.active.iter().enumerate() {
                let row = &mut self.matrix[(nr + p) * stride..][..n];
                if !masses.symmetric() {
                    for (r, entry) in row[..nr].iter_mut().enumerate() {
                        *entry = masses.on_connectors(r)[i];
                    }
                }
                // a column is a row, the matrix being symmetric
                let column = &compliance.as_slice()[i * states.len()..][..states.len()];
                for (entry, &j) in row[nr..].iter_mut().zip(&self.active) {
                    *entry = column[j];
                }
                row[nr + p] += 1.0 / (weight * law.branch(states[i]).stiffness);
            }
            if masses.symmetric() {
                factor_symmetric(&mut self.matrix, &mut self.lower, stride, n);
            } else {
                factor(&mut self.matrix, &mut self.lower, stride, n);
            }
            self.factored.copy_from_slice(states);
            self.factored_for = if nr == 0 { Some(law.k) } else { None };
        }
        let n = nr + self.active.len();
        self.rhs[..nr].copy_from_slice(masses.free());
        for (p, &i) in self.active.iter().enumerate() {
            let branch = law.branch(states[i]);
            self.rhs[nr + p] = self.e[i] - branch.offset / branch.stiffness;
        }
        substitute(&self.matrix, &self.lower, stride, &mut self.rhs[..n]);
        self.masses[..nr].copy_from_slice(&self.rhs[..nr]);
        self.forces.fill(0.0);
        for (p, &i) in self.active.iter().enumerate() {
            self.forces[i] = self.rhs[nr + p];
        }
    }

    /// Elongations under the forces found. On an active line they follow from the force, without cancellation.
    #[inline(always)]
    fn elongate(&mut self, states: &[State], law: &Law, compliance: &DMatrix<f64>, weight: f64, masses: &MovingMasses) {
        self.found.copy_from_slice(&self.e);
        let n = states.len();
        for &j in &self.active {
            // a column is a row, the matrix being symmetric
            take(&mut self.found, &compliance.as_slice()[j * n..][..n], self.forces[j]);
        }
        for r in 0..masses.count() {
            take(&mut self.found, masses.on_connectors(r), self.masses[r]);
        }
        for &i in &self.active {
            let branch = law.branch(states[i]);
            self.found[i] = (self.forces[i] / weight + branch.offset) / branch.stiffness;
        }
    }
}

/// `e := e - column * force`.
#[inline(always)]
fn take(e: &mut [f64], column: &[f64], force: f64) {
    for (e, c) in e.iter_mut().zip(column) {
        *e = (-force).mul_add(*c, *e);
    }
}

/// Entries that are computed at once.
const CHUNK: usize = 4;

/// `A = L U`, L with a unit diagonal: U in place, L by columns in `lower`; rows and columns are `stride` apart, a multiple of
/// [`CHUNK`]. Row operations run over whole chunks: what they do beside the part that is left is of no account.
#[inline(always)]
fn factor(a: &mut [f64], lower: &mut [f64], stride: usize, n: usize) {
    for p in 0..n {
        let (above, below) = a.split_at_mut((p + 1) * stride);
        let chunks = (p + 1) / CHUNK * CHUNK..n.next_multiple_of(CHUNK).max(p + 1);
        let pivot_row = &above[p * stride..][..stride];
        let reciprocal = 1.0 / pivot_row[p];
        let column = &mut lower[p * stride..][..n];
        let pivots = pivot_row[chunks.clone()].as_chunks::<CHUNK>().0;
        for (row, ratio_kept) in below.chunks_exact_mut(stride).zip(&mut column[p + 1..]) {
            let ratio = row[p] * reciprocal;
            *ratio_kept = ratio;
            for (entries, pivots) in row[chunks.clone()].as_chunks_mut::<CHUNK>().0.iter_mut().zip(pivots) {
                for i in 0..CHUNK {
                    entries[i] = (-ratio).mul_add(pivots[i], entries[i]);
                }
            }
        }
    }
}

/// `A = L U` of a symmetric matrix, whose upper half is enough.
#[inline(always)]
fn factor_symmetric(a: &mut [f64], lower: &mut [f64], stride: usize, n: usize) {
    let end = n.next_multiple_of(CHUNK);
    for p in 0..n {
        let (above, below) = a.split_at_mut((p + 1) * stride);
        let pivot_row = &above[p * stride..][..stride];
        let reciprocal = 1.0 / pivot_row[p];
        let column = &mut lower[p * stride..][..stride];
        for ((row, ratio_kept), i) in below.chunks_exact_mut(stride).zip(&mut column[p + 1..n]).zip(p + 1..) {
            let ratio = pivot_row[i] * reciprocal;
            *ratio_kept = ratio;
            let chunks = i / CHUNK * CHUNK..end;
            let pivots = pivot_row[chunks.clone()].as_chunks::<CHUNK>().0;
            for (entries, pivots) in row[chunks].as_chunks_mut::<CHUNK>().0.iter_mut().zip(pivots) {
                for k in 0..CHUNK {
                    entries[k] = (-ratio).mul_add(pivots[k], entries[k]);
                }
            }
        }
    }
}

/// `x := (L U)^-1 x`.
#[inline(always)]
fn substitute(a: &[f64], lower: &[f64], stride: usize, x: &mut [f64]) {
    let n = x.len();
    for p in 0..n {
        let (known, left) = x.split_at_mut(p + 1);
        take(left, &lower[p * stride + p + 1..][..n - p - 1], known[p]);
    }
    for i in (0..n).rev() {
        let row = &a[i * stride..][..n];
        let mut sums = [0.0; CHUNK];
        let (u, u_rest) = row[i + 1..].as_chunks::<CHUNK>();
        let (x_known, x_rest) = x[i + 1..].as_chunks::<CHUNK>();
        for (u, x) in u.iter().zip(x_known) {
            for k in 0..CHUNK {
                sums[k] = f64::mul_add(u[k], x[k], sums[k]);
            }
        }
        let mut sum = (sums[0] + sums[1]) + (sums[2] + sums[3]);
        for (u, x) in u_rest.iter().zip(x_rest) {
            sum = u.mul_add(*x, sum);
        }
        x[i] = (x[i] - sum) / row[i];
    }
}
