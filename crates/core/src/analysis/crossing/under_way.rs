//! A crossing under way: step after step, to be looked at between them.
//!
//! Knows where it is, when it ends and how its state is told. Does not know the step's arithmetic, nor who looks.

use super::observe::Observer;
use super::step::{Instant, Stepper};
use super::{CrossingSolver, span};
use crate::analysis::AnalysisError;
use crate::analysis::modes::Rayleigh;
use crate::analysis::snapshot::{Snapshot, connectors, wheels};
use crate::response::CrossingResponse;

/// A crossing that was begun, see [`CrossingSolver::begin`].
#[derive(Debug)]
pub struct UnderWay<'a> {
    solver: &'a CrossingSolver,
    stepper: Stepper<'a>,
    observer: Observer<'a>,
    now: Instant,
    /// Whole steps taken.
    taken: usize,
    /// Steps before t = 0 and all steps.
    before: usize,
    steps: usize,
}

impl<'a> UnderWay<'a> {
    pub(super) fn new(
        solver: &'a CrossingSolver,
        stepper: Stepper<'a>,
        mut observer: Observer<'a>,
        tail_s: f64,
    ) -> Self {
        let h = solver.settings.time_step_s;
        let length_m = solver.bridge.design().length_m();
        let (before, after) = span(length_m, stepper.vehicle, h, stepper.speed_m_s, tail_s);
        let now = stepper.at_rest(-(before as f64) * h);
        observer.note_history(&now);
        Self {
            solver,
            stepper,
            observer,
            now,
            taken: 0,
            before,
            steps: before + after,
        }
    }

    /// Takes the next whole step; whether there was one.
    ///
    /// # Errors
    /// As [`CrossingSolver::solve`].
    pub fn step(&mut self) -> Result<bool, AnalysisError> {
        if self.taken == self.steps {
            return Ok(false);
        }
        self.taken += 1;
        let to_s = (self.taken as f64 - self.before as f64) * self.solver.settings.time_step_s;
        self.now = self
            .solver
            .advance(&self.stepper, &mut self.observer, &self.now, to_s, 0)?;
        self.observer.note_history(&self.now);
        Ok(true)
    }

    /// Whole steps that it takes from its beginning at rest to its end.
    pub fn steps(&self) -> usize {
        self.steps
    }

    /// The state after the last whole step, or the rest before the first.
    pub fn snapshot(&self) -> Snapshot {
        let (now, stepper) = (&self.now, &self.stepper);
        let Rayleigh { a, b } = stepper.rayleigh;
        let sum = |x: &[f64], factor: f64, y: &[f64]| x.iter().zip(y).map(|(x, y)| x + factor * y).collect();
        let place = (stepper.load_n, stepper.speed_m_s * now.time_s);
        Snapshot {
            time_s: now.time_s,
            u: now.u.clone(),
            elastic: sum(&now.u, a, &now.v),
            inertial: Some(sum(&now.a, b, &now.v)),
            connectors: connectors(&now.states, &now.forces, &now.elongations),
            wheels: wheels(stepper.track, stepper.vehicle, place, &now.load, &now.inertia),
        }
    }

    /// What it reports of the steps taken.
    pub fn finish(self) -> CrossingResponse {
        self.observer.finish()
    }
}
