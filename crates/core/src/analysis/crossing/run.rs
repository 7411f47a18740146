//! A crossing under way: step after step, to be looked at between them.
//!
//! Knows where it is, when it ends and how its state is told. Does not know the step's arithmetic, nor who looks.

use super::halving::{Halving, advance};
use super::observe::Observer;
use super::step::{Motion, Stepper};
use super::{CrossingSolver, StepSpan};
use crate::analysis::AnalysisError;
use crate::analysis::modes::Rayleigh;
use crate::analysis::snapshot::{Snapshot, connectors, wheels};
use crate::contact::NotSettled;
use crate::response::CrossingResponse;

/// A crossing that was begun, see [`CrossingSolver::begin`].
#[derive(Debug)]
pub struct CrossingRun<'a> {
    solver: &'a CrossingSolver,
    stepper: Stepper<'a>,
    observer: Observer<'a>,
    now: Motion,
    /// Whole steps taken.
    taken: usize,
    span: StepSpan,
}

impl<'a> CrossingRun<'a> {
    pub(super) fn new(
        solver: &'a CrossingSolver,
        stepper: Stepper<'a>,
        mut observer: Observer<'a>,
        span: StepSpan,
    ) -> Self {
        let now = stepper.at_rest(span.time_s(0, solver.settings.time_step_s));
        observer.record_history(&now);
        Self {
            solver,
            stepper,
            observer,
            now,
            taken: 0,
            span,
        }
    }

    /// Takes the next whole step; whether there was one.
    ///
    /// # Errors
    /// As [`CrossingSolver::solve`].
    pub fn step(&mut self) -> Result<bool, AnalysisError> {
        if self.taken == self.span.steps {
            return Ok(false);
        }
        self.taken += 1;
        let to_s = self.span.time_s(self.taken, self.solver.settings.time_step_s);
        advance(self, [self.now.time_s, to_s], 0)?;
        self.observer.record_history(&self.now);
        Ok(true)
    }

    /// Whole steps that it takes from its beginning at rest to its end.
    pub fn steps(&self) -> usize {
        self.span.steps
    }

    /// The state after the last whole step, or the rest before the first.
    pub fn snapshot(&self) -> Snapshot {
        let (now, stepper) = (&self.now, &self.stepper);
        let Rayleigh { a, b, .. } = stepper.rayleigh;
        let beyond_water = stepper.rayleigh.beyond_water();
        let sum =
            |x: &[f64], factor: f64, y: &[f64]| -> Vec<f64> { x.iter().zip(y).map(|(x, y)| x + factor * y).collect() };
        let (mut u, mut elongations) = (now.u.clone(), now.elongations.clone());
        if let Some(dead) = &stepper.dead {
            u = sum(&u, 1.0, &dead.displacements);
            elongations = sum(&elongations, 1.0, &dead.elongations_m);
        }
        Snapshot {
            time_s: now.time_s,
            elastic: sum(&u, a, &now.v),
            u,
            beyond_water: (beyond_water != 0.0).then(|| now.v.iter().map(|v| beyond_water * v).collect()),
            inertial: Some(sum(&now.a, b, &now.v)),
            waves: stepper.convolution.map(|_| now.remembered.force.clone()),
            connectors: connectors(&now.states, now.connector_forces(), &elongations),
            wheels: {
                let vehicles = stepper.traffic.vehicles.iter();
                let vehicles = vehicles.map(|driven| (&*driven.vehicle, driven.load_n));
                wheels(stepper.track, vehicles, &now.load, &now.rider_forces)
            },
            rides: stepper.rides_now(now),
            dead: stepper.dead.clone(),
        }
    }

    /// What it reports of the steps taken.
    pub fn finish(self) -> CrossingResponse {
        self.observer.finish()
    }
}

impl Halving for CrossingRun<'_> {
    fn limit(&self) -> usize {
        self.solver.settings.bisection_limit
    }

    fn step(&mut self, to_s: f64, halvings: usize) -> Result<Result<(), NotSettled>, AnalysisError> {
        let matrix = self.solver.step_matrix(halvings)?;
        let limit = self.solver.settings.newton_limit;
        let next = match self.stepper.step(matrix, &self.now, to_s, limit) {
            Ok(next) => next,
            Err(stuck) => return Ok(Err(stuck)),
        };
        if !next.is_finite() {
            return Err(AnalysisError::NotFinite { time_s: to_s });
        }
        self.observer.record_step(&self.now, &next);
        self.now = next;
        Ok(Ok(()))
    }

    fn record_bisection(&mut self, stuck: NotSettled) {
        self.observer.record_bisection(stuck.iterations);
    }

    fn not_converged(&self, stuck: NotSettled, time_s: f64, bisections: usize) -> AnalysisError {
        AnalysisError::NotConverged {
            time_s,
            link: self.solver.bridge.links.get(stuck.connector).map(|link| link.place),
            bisections,
        }
    }
}
