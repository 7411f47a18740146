//! Crossings, by two solvers: `step`, `run` and `observe` integrate directly (the reference solver), `operated` goes
//! through the bridge operator. Both answer a [`Crossing`] with a [`CrossingResponse`].
//!
//! Knows the traffic on one bridge at one time step, on any model. Does not know studies or threads.

#[cfg(test)]
mod free_bodies;
mod halving;
#[cfg(test)]
mod in_waves;
mod mounts;
mod observe;
mod one_side;
mod operated;
mod riders;
mod run;
mod step;
mod stepped;

use super::AnalysisError;
use super::modes::Rayleigh;
use crate::bridge::{Bridge, Track};
use crate::connector::{Connection, OwnLaws};
use crate::contact::{Dashpot, LinkLaw};
use crate::fem::{FemError, SymmetricMatrix};
use crate::flexibility::Flexibility;
use crate::radiation::Convolution;
use crate::response::{CrossingResponse, DeadState, Record};
use crate::riding::RidingStep;
use crate::scheme::Scheme;
use crate::traffic::{Driven, Traffic};
use observe::Observer;
pub use operated::OperatorSolver;
pub use run::CrossingRun;
use std::sync::{Arc, OnceLock};
use step::Stepper;
pub use stepped::REFINEMENTS;

/// What all crossings of a solver share.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CrossingSettings {
    /// Time step `[s]`.
    pub time_step_s: f64,
    /// Spectral radius of the generalized-alpha scheme, 0 to 1.
    pub spectral_radius: f64,
    /// Rayleigh coefficients `C = a K + b M`.
    pub rayleigh: Rayleigh,
    /// Newton solutions allowed in a step.
    pub newton_limit: usize,
    /// How often a step may be halved.
    pub bisection_limit: usize,
}

/// One crossing.
#[derive(Debug, Clone, PartialEq)]
pub struct Crossing {
    /// How the connectors work.
    pub connection: Connection,
    /// Stiffness of one truss `[N/m]`.
    pub connector_stiffness_n_m: f64,
    /// Connectors that have laws of their own in place of these.
    pub own_laws: OwnLaws,
    /// How long to go on after the last point has left or stands `[s]`.
    pub tail_s: f64,
    /// Histories to keep.
    pub record: Record,
    /// The state at rest from which it starts and deflections are counted, where the bridge has a dead load.
    pub dead: Option<Arc<DeadState>>,
}

impl Crossing {
    /// The law of each of so many connectors.
    fn laws(&self, connectors: usize) -> Vec<LinkLaw> {
        let laws = LinkLaw::connectors(
            connectors,
            self.connector_stiffness_n_m,
            self.connection,
            &self.own_laws,
        );
        LinkLaw::from_rest(laws, self.dead.as_deref())
    }

    /// The connectors that have dashpots.
    fn dashpots(&self) -> Vec<Dashpot> {
        Dashpot::of_connectors(&self.own_laws, self.dead.as_deref())
    }
}

/// A bridge made ready for crossings at one time step. Shared read-only between jobs and threads.
#[derive(Debug)]
pub struct CrossingSolver {
    bridge: Arc<Bridge>,
    track: Track,
    settings: CrossingSettings,
    /// The step's matrix for each number of halvings, factorised when first needed.
    step_matrices: Vec<OnceLock<Result<StepMatrix, FemError>>>,
    /// The memory of the water, where it has one.
    convolution: Option<Convolution>,
}

/// One step length.
#[derive(Debug)]
struct StepMatrix {
    /// How often the time step is halved.
    halvings: usize,
    scheme: Scheme,
    flexibility: Flexibility,
}

impl CrossingSolver {
    /// Factorises once for the bridge and the time step.
    ///
    /// # Errors
    /// [`AnalysisError::Factor`].
    pub fn new(bridge: &Arc<Bridge>, settings: &CrossingSettings) -> Result<Self, AnalysisError> {
        let step_matrices = (0..=settings.bisection_limit).map(|_| OnceLock::new()).collect();
        let waves = bridge.waves.as_ref();
        let solver = Self {
            bridge: Arc::clone(bridge),
            track: Track::new(bridge),
            settings: *settings,
            step_matrices,
            convolution: waves.map(|waves| Convolution::new(&waves.radiation, settings.time_step_s)),
        };
        solver.step_matrix(0)?;
        Ok(solver)
    }

    /// Steps that a crossing will take, bisections apart.
    pub fn steps(bridge_length_m: f64, traffic: &Traffic, time_step_s: f64, tail_s: f64) -> usize {
        StepSpan::new(bridge_length_m, traffic, time_step_s, tail_s).steps
    }

    /// Solves one crossing. The motion starts from rest, the dead state, at the step before the first point reaches the bridge, or
    /// a vehicle on springs its run-in.
    ///
    /// # Errors
    /// [`AnalysisError::NotConverged`] with time and connector, [`AnalysisError::NotFinite`], [`AnalysisError::Factor`].
    pub fn solve(&self, traffic: &Traffic, crossing: &Crossing) -> Result<CrossingResponse, AnalysisError> {
        let mut under = self.begin(traffic, crossing);
        while under.step()? {}
        Ok(under.finish())
    }

    /// Begins a crossing that can be looked at between its steps; taken to its end it is the one of [`Self::solve`].
    pub fn begin<'a>(&'a self, traffic: &'a Traffic, crossing: &Crossing) -> CrossingRun<'a> {
        let length_m = self.track.length_m();
        let at_halvings = |halvings: usize| {
            let scheme = Scheme::new(self.time_step_s(halvings), self.settings.spectral_radius);
            let of = |driven: &Driven| Some(RidingStep::new(driven.vehicle.springs.as_ref()?, scheme));
            traffic.vehicles.iter().map(of).collect()
        };
        let stepper = Stepper {
            bridge: &self.bridge,
            track: &self.track,
            traffic,
            presences: traffic.presences(length_m),
            riding: (0..=self.settings.bisection_limit).map(at_halvings).collect(),
            rayleigh: self.settings.rayleigh,
            laws: crossing.laws(self.bridge.links.len()),
            pins: crossing.record.needs_pins(),
            dashpots: crossing.dashpots(),
            dead: crossing.dead.clone(),
            convolution: self.convolution.as_ref(),
        };
        let span = StepSpan::new(length_m, traffic, self.settings.time_step_s, crossing.tail_s);
        let from_s = span.time_s(0, self.settings.time_step_s);
        let observer = Observer::new(&self.bridge, traffic, crossing, from_s);
        CrossingRun::new(self, stepper, observer, span)
    }

    /// The time step after some halvings `[s]`.
    fn time_step_s(&self, halvings: usize) -> f64 {
        self.settings.time_step_s / (1_u64 << halvings) as f64
    }

    fn step_matrix(&self, halvings: usize) -> Result<&StepMatrix, AnalysisError> {
        let matrix = self.step_matrices[halvings].get_or_init(|| {
            let h = self.time_step_s(halvings);
            let scheme = Scheme::new(h, self.settings.spectral_radius);
            let (c_m, c_c, c_k) = scheme.effective();
            let Rayleigh { a, b, .. } = self.settings.rayleigh;
            let (bridge, beyond_water) = (&self.bridge, self.settings.rayleigh.beyond_water());
            let mut terms = vec![(c_m + c_c * b, &bridge.m), (c_k + c_c * a, &bridge.k)];
            let of_water = match beyond_water {
                0.0 => None,
                _ => Some(bridge.times_k_water.of_modules()?),
            };
            terms.extend(of_water.iter().map(|of_water| (-c_c * beyond_water, of_water)));
            let of_waves = match (&bridge.waves, &self.convolution) {
                (Some(waves), Some(convolution)) => {
                    let entries = waves.entries(&convolution.at_end(h));
                    Some(SymmetricMatrix::from_entries(bridge.dofs(), &entries)?)
                }
                _ => None,
            };
            terms.extend(of_waves.iter().map(|of_waves| (c_c, of_waves)));
            let matrix = SymmetricMatrix::combine(&terms)?;
            let flexibility = Flexibility::new("matrix of the time step", &matrix, &self.bridge)?;
            Ok(StepMatrix {
                halvings,
                scheme,
                flexibility,
            })
        });
        matrix.as_ref().map_err(|error| AnalysisError::Factor(error.clone()))
    }
}

/// The whole steps of a crossing, counted from t = 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct StepSpan {
    /// The step at which it rests, the last before the first vehicle is there; negative where that is before t = 0.
    rest: i64,
    /// Steps from there to the end.
    steps: usize,
}

impl StepSpan {
    fn new(bridge_length_m: f64, traffic: &Traffic, h: f64, tail_s: f64) -> Self {
        let presences = traffic.presences(bridge_length_m);
        let from_s = presences.iter().map(|of| of.from_s).fold(f64::INFINITY, f64::min);
        let until_s = presences.iter().map(|of| of.until_s).fold(f64::NEG_INFINITY, f64::max);
        let rest = -((-from_s / h + 1e-9).floor() as i64 + 1);
        let end = ((until_s + tail_s) / h - 1e-9).ceil() as i64;
        Self {
            rest,
            steps: end.saturating_sub(rest).max(0) as usize,
        }
    }

    /// The time after so many steps of so many seconds `[s]`.
    fn time_s(self, taken: usize, h: f64) -> f64 {
        (taken as f64 + self.rest as f64) * h
    }
}
