//! Crossings through the bridge operator: many at once, one a SIMD lane.
//!
//! Knows when a crossing begins, is halved and ends, and what a lane leaves behind. Does not know the step's arithmetic.

use super::halving::{Halving, halve};
use super::{Crossing, CrossingSettings, StepSpan};
use crate::analysis::AnalysisError;
use crate::bridge::{Bridge, BridgeDesign, LinkPlace, joint_parts};
use crate::contact::NotSettled;
use crate::operator::{
    BridgeOperator, CrossingInput, Crossings, StepClock, StepConstants, WheelCompliance, WheelLines, step,
};
use crate::response::{
    BankPart, CrossingResponse, DeadState, JointReading, PositionPeaks, Reading, Record, Recorder, RideReading,
};
use crate::riding::RidingStep;
use crate::traffic::{Driven, Traffic};
use std::sync::{Arc, OnceLock};

/// A bridge operator made ready for crossings at one time step and its halves. Shared read-only between threads.
#[derive(Debug)]
pub struct OperatorSolver {
    design: BridgeDesign,
    /// Least draft and freeboard of a module `[m]`.
    least_draft_m: Option<f64>,
    least_freeboard_m: Option<f64>,
    banks: Vec<BankPart>,
    /// Where each link is.
    link_places: Vec<LinkPlace>,
    operator: Arc<BridgeOperator>,
    settings: CrossingSettings,
    constants: Vec<OnceLock<StepConstants>>,
}

/// Vehicles that are kept ready at once.
const VEHICLES_KEPT: usize = 8;

/// How often a whole crossing may be asked for at half the time step.
pub const REFINEMENTS: usize = 6;

/// Vehicles on the deck, with their small flexibilities and springs at each step length asked for.
#[derive(Debug)]
struct Mount {
    traffic: Arc<Traffic>,
    wheels: Arc<WheelLines>,
    steps: Vec<Option<MountedStep>>,
}

/// What a step length makes of vehicles on the deck.
type MountedStep = (Arc<WheelCompliance>, Arc<[Option<Arc<RidingStep>>]>);

impl Mount {
    /// Whether the vehicles of another traffic see the deck as these do, whatever they weigh and however fast they are.
    fn fits(&self, traffic: &Traffic) -> bool {
        let alike = |(a, b): (&Driven, &Driven)| a.vehicle == b.vehicle && a.drive.backward == b.drive.backward;
        let (own, other) = (&self.traffic.vehicles, &traffic.vehicles);
        own.len() == other.len() && own.iter().zip(other).all(alike)
    }
}

/// Crossings under way.
struct Crew<'a, C> {
    solver: &'a OperatorSolver,
    mounts: Vec<Mount>,
    lanes: Crossings,
    /// One lane by itself, for steps that are halved.
    solo: Option<Crossings>,
    /// How often the time step is halved from the beginning.
    refinement: usize,
    clock: &'a mut C,
}

/// One crossing under way.
struct Under<'a> {
    index: usize,
    traffic: &'a Traffic,
    record: &'a Record,
    step: usize,
    span: StepSpan,
    recorder: Recorder,
}

impl OperatorSolver {
    /// A solver on the operator of `bridge`.
    pub fn new(bridge: &Bridge, operator: &Arc<BridgeOperator>, settings: &CrossingSettings) -> Self {
        Self {
            design: bridge.design().clone(),
            least_draft_m: bridge.least_draft_m(),
            least_freeboard_m: bridge.least_freeboard_m(),
            banks: bridge.bank_parts(),
            link_places: bridge.links.iter().map(|link| link.place).collect(),
            operator: Arc::clone(operator),
            settings: *settings,
            constants: (0..=settings.bisection_limit + REFINEMENTS)
                .map(|_| OnceLock::new())
                .collect(),
        }
    }

    /// The operator.
    pub fn operator(&self) -> &BridgeOperator {
        &self.operator
    }

    /// Solves one crossing.
    ///
    /// # Errors
    /// As [`CrossingSolver::solve`](super::CrossingSolver::solve).
    pub fn solve(&self, traffic: &Traffic, crossing: &Crossing) -> Result<CrossingResponse, AnalysisError> {
        let none = || Err(AnalysisError::NotFinite { time_s: 0.0 });
        self.solve_all(&[(traffic, crossing)], 0).pop().unwrap_or_else(none)
    }

    /// Solves crossings side by side, each as if it were alone, at the time step halved `refinement` times (at most
    /// [`REFINEMENTS`]); answers in their order. Verified by `tests/solvers/operator_lanes.rs`.
    ///
    /// # Errors
    /// Of each as [`CrossingSolver::solve`](super::CrossingSolver::solve).
    pub fn solve_all(
        &self,
        crossings: &[(&Traffic, &Crossing)],
        refinement: usize,
    ) -> Vec<Result<CrossingResponse, AnalysisError>> {
        self.solve_all_timed(crossings, refinement, &mut ())
    }

    /// Solves crossings side by side under a clock that is looked at between the parts of each step; halved steps are not.
    ///
    /// # Errors
    /// As [`Self::solve_all`].
    pub fn solve_all_timed(
        &self,
        crossings: &[(&Traffic, &Crossing)],
        refinement: usize,
        clock: &mut impl StepClock,
    ) -> Vec<Result<CrossingResponse, AnalysisError>> {
        let most_nodes = crossings
            .iter()
            .map(|(traffic, _)| WheelLines::most_nodes_of(&self.operator, traffic));
        let mut crew = Crew {
            solver: self,
            mounts: Vec::new(),
            lanes: Crossings::new(
                &self.operator,
                most_nodes.max().unwrap_or(0),
                self.settings.newton_limit,
            ),
            solo: None,
            refinement: refinement.min(REFINEMENTS),
            clock,
        };
        crew.run(crossings)
    }

    /// The time step after some halvings `[s]`.
    pub fn time_step_s(&self, halvings: usize) -> f64 {
        self.settings.time_step_s / (1_u64 << halvings) as f64
    }

    fn constants(&self, halvings: usize) -> &StepConstants {
        self.constants[halvings].get_or_init(|| {
            let CrossingSettings {
                spectral_radius,
                rayleigh,
                ..
            } = self.settings;
            StepConstants::new(&self.operator, self.time_step_s(halvings), spectral_radius, rayleigh)
        })
    }
}

impl<C: StepClock> Crew<'_, C> {
    fn run(&mut self, crossings: &[(&Traffic, &Crossing)]) -> Vec<Result<CrossingResponse, AnalysisError>> {
        let mut answers: Vec<Option<Result<CrossingResponse, AnalysisError>>> = vec![None; crossings.len()];
        let mut under: Vec<Option<Under<'_>>> = (0..self.lanes.width()).map(|_| None).collect();
        let mut next = 0;
        loop {
            for (lane, of) in under.iter_mut().enumerate() {
                if of.is_none() && next < crossings.len() {
                    *of = Some(self.begin(lane, next, crossings[next]));
                    next += 1;
                }
            }
            if under.iter().all(Option::is_none) {
                let lost = || Err(AnalysisError::NotFinite { time_s: 0.0 });
                return answers.into_iter().map(|answer| answer.unwrap_or_else(lost)).collect();
            }
            for (lane, of) in under.iter_mut().enumerate() {
                if let Some(of) = of {
                    of.step += 1;
                    self.lanes.place(lane, self.time_s(of));
                }
            }
            let level = self.solver.constants(self.refinement);
            let limit = self.solver.settings.newton_limit;
            step(&mut self.lanes, &self.solver.operator, level, limit, self.clock);
            for (lane, slot) in under.iter_mut().enumerate() {
                let Some(of) = slot else {
                    continue;
                };
                if let Some(ending) = self.after_step(lane, of) {
                    answers[of.index] = Some(ending);
                    self.lanes.end(lane);
                    *slot = None;
                }
            }
        }
    }

    fn time_s(&self, of: &Under<'_>) -> f64 {
        self.time_after(of.step, of)
    }

    fn time_after(&self, steps: usize, of: &Under<'_>) -> f64 {
        of.span.time_s(steps, self.solver.time_step_s(self.refinement))
    }

    fn begin<'c>(&mut self, lane: usize, index: usize, (traffic, crossing): (&'c Traffic, &'c Crossing)) -> Under<'c> {
        let mount = self.mount(traffic);
        let (compliance, riding) = self.mounted_step(mount, self.refinement);
        let crossing_input = CrossingInput {
            traffic: Arc::new(traffic.clone()),
            wheels: Arc::clone(&self.mounts[mount].wheels),
            compliance,
            riding,
            laws: crossing.laws(self.solver.operator.connectors()).into(),
            dashpots: crossing.dashpots().into(),
            dead: crossing.dead.clone(),
        };
        let h = self.solver.time_step_s(self.refinement);
        let length_m = self.solver.design.length_m();
        let span = StepSpan::new(length_m, traffic, h, crossing.tail_s);
        let start_s = span.time_s(0, h);
        self.lanes.begin(&self.solver.operator, lane, crossing_input, start_s);
        let design = &self.solver.design;
        let parts = (joint_parts(design), self.solver.banks.clone());
        let rides = (traffic.ride_parts(), start_s);
        let mut recorder = Recorder::new(design.positions(), parts, rides, &crossing.record);
        recorder.note(&Start {
            time_s: start_s,
            dead: crossing.dead.as_deref(),
        });
        Under {
            index,
            traffic,
            record: &crossing.record,
            step: 0,
            span,
            recorder,
        }
    }

    /// The place of a traffic's vehicles among those kept ready.
    fn mount(&mut self, traffic: &Traffic) -> usize {
        if let Some(known) = self.mounts.iter().position(|mount| mount.fits(traffic)) {
            return known;
        }
        let mount = Mount {
            traffic: Arc::new(traffic.clone()),
            wheels: Arc::new(WheelLines::new(&self.solver.operator, traffic)),
            steps: Vec::new(),
        };
        // lanes hold what they need, so that any other may go
        if self.mounts.len() == VEHICLES_KEPT {
            self.mounts.remove(0);
        }
        self.mounts.push(mount);
        self.mounts.len() - 1
    }

    fn mounted_step(&mut self, mount: usize, halvings: usize) -> MountedStep {
        let (operator, level) = (&*self.solver.operator, self.solver.constants(halvings));
        let mount = &mut self.mounts[mount];
        if mount.steps.len() <= halvings {
            mount.steps.resize(halvings + 1, None);
        }
        let (compliance, riding) = mount.steps[halvings].get_or_insert_with(|| {
            let compliance = WheelCompliance::new(operator, level, &mount.wheels);
            let of = |driven: &Driven| Some(Arc::new(level.riding(driven.vehicle.springs.as_ref()?)));
            (Arc::new(compliance), mount.traffic.vehicles.iter().map(of).collect())
        });
        (Arc::clone(compliance), Arc::clone(riding))
    }

    /// What is to be done with a lane after its step: halve it where it did not settle, record, finish.
    fn after_step(&mut self, lane: usize, of: &mut Under<'_>) -> Option<Result<CrossingResponse, AnalysisError>> {
        let time_s = self.time_s(of);
        if let Some(stuck) = self.lanes.unsettled(lane) {
            let mount = self.mount(of.traffic);
            let span_s = [self.time_after(of.step - 1, of), time_s];
            if let Err(error) = self.halve((lane, mount), stuck, span_s, &mut of.recorder) {
                return Some(Err(error));
            }
            if let Some(solo) = &self.solo {
                of.recorder.note(&solo.reading(0));
            }
        } else {
            let reading = self.lanes.reading(lane);
            of.recorder.take(&reading);
            of.recorder.note(&reading);
        }
        if !self.lanes.is_finite(lane) {
            return Some(Err(AnalysisError::NotFinite { time_s }));
        }
        (of.step == of.span.steps).then(|| Ok(self.response(lane, of)))
    }

    /// Does a lane's step again in halves, by itself.
    fn halve(
        &mut self,
        (lane, mount): (usize, usize),
        stuck: NotSettled,
        span_s: [f64; 2],
        recorder: &mut Recorder,
    ) -> Result<(), AnalysisError> {
        let Some(input) = self.lanes.crossing(lane).cloned() else {
            return Ok(());
        };
        let saved = self.lanes.save(lane);
        let (operator, limit) = (&self.solver.operator, self.solver.settings.newton_limit);
        let most = input.wheels.most_nodes();
        let fits = |solo: &Crossings| solo.most_nodes() >= most;
        let mut solo = self
            .solo
            .take()
            .filter(fits)
            .unwrap_or_else(|| Crossings::new(operator, most, limit));
        solo.resume(operator, 0, input, &saved);
        let mut alone = Alone {
            crew: self,
            lane: &mut solo,
            mount,
            recorder,
        };
        let done = halve(&mut alone, stuck, span_s, 0);
        self.lanes.restore(lane, &solo.save(0));
        self.solo = Some(solo);
        done
    }

    fn response(&mut self, lane: usize, of: &mut Under<'_>) -> CrossingResponse {
        let (peaks, design) = (self.lanes.peaks(lane), &self.solver.design);
        let positions = (1..)
            .zip(&peaks.positions)
            .map(|(position, [deflection, uplift])| PositionPeaks {
                position,
                x_m: design.position_x_m(position),
                deflection: *deflection,
                uplift: *uplift,
            });
        CrossingResponse {
            positions: positions.collect(),
            joints: peaks.joints(&design.connectors.y_m),
            pins: if of.record.needs_pins() {
                self.lanes.pin_peaks(lane)
            } else {
                Vec::new()
            },
            peak_edge: peaks.placed.edge,
            peak_roll: peaks.placed.roll,
            peak_trim: peaks.placed.trim,
            least_contact: peaks.placed.least_contact,
            bottom_emerged: self.solver.least_draft_m.map(|draft| peaks.bottom_m > draft),
            deck_submerged: self.solver.least_freeboard_m.map(|board| peaks.corner_m > board),
            statistics: *self.lanes.statistics(lane),
            energy: peaks.energy,
            recorded: of.recorder.finish(),
        }
    }
}

/// A lane by itself, whose steps are halved.
struct Alone<'a, 's, C> {
    crew: &'a mut Crew<'s, C>,
    lane: &'a mut Crossings,
    mount: usize,
    recorder: &'a mut Recorder,
}

impl<C: StepClock> Halving for Alone<'_, '_, C> {
    fn limit(&self) -> usize {
        self.crew.solver.settings.bisection_limit
    }

    fn step(&mut self, to_s: f64, halvings: usize) -> Result<Result<(), NotSettled>, AnalysisError> {
        let halvings = self.crew.refinement + halvings;
        let (compliance, riding) = self.crew.mounted_step(self.mount, halvings);
        self.lane.take_step(0, compliance, &riding);
        self.lane.place(0, to_s);
        let solver = self.crew.solver;
        let limit = solver.settings.newton_limit;
        step(self.lane, &solver.operator, solver.constants(halvings), limit, &mut ());
        let unsettled = self.lane.unsettled(0);
        if unsettled.is_none() {
            self.recorder.take(&self.lane.reading(0));
        }
        Ok(unsettled.map_or(Ok(()), Err))
    }

    fn record_bisection(&mut self, stuck: NotSettled) {
        let statistics = self.lane.statistics(0);
        statistics.bisections += 1;
        statistics.newton_iterations += stuck.iterations;
    }

    fn not_converged(&self, stuck: NotSettled, time_s: f64, bisections: usize) -> AnalysisError {
        AnalysisError::NotConverged {
            time_s,
            link: self.crew.solver.link_places.get(stuck.connector).copied(),
            bisections,
        }
    }
}

/// The rest before the first step.
struct Start<'a> {
    time_s: f64,
    dead: Option<&'a DeadState>,
}

impl JointReading for Start<'_> {
    fn connector_n(&self, connector: usize) -> [f64; 2] {
        [self.dead.map_or(0.0, |dead| dead.forces_n[connector]); 2]
    }

    fn elongation_m(&self, connector: usize) -> f64 {
        self.dead.map_or(0.0, |dead| dead.elongations_m[connector])
    }

    fn pin_n(&self, pin: usize) -> [f64; 3] {
        self.dead.map_or([0.0; 3], |dead| dead.pins_n[pin])
    }

    fn spring_m(&self, spring: usize) -> f64 {
        self.dead.map_or(0.0, |dead| dead.springs_m[spring])
    }
}

impl Reading for Start<'_> {
    fn times_s(&self) -> [f64; 2] {
        [self.time_s; 2]
    }

    fn position_m(&self, _: usize) -> f64 {
        0.0
    }

    fn place_m(&self, _: usize) -> f64 {
        0.0
    }

    fn corner_m(&self, _: usize) -> f64 {
        0.0
    }

    fn ride(&self, _: usize) -> Option<RideReading<'_>> {
        None
    }

    fn is_on(&self, _: usize, _: usize) -> bool {
        false
    }
}
