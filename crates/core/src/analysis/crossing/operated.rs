//! Crossings through the bridge operator: many at once, one a SIMD lane.
//!
//! Knows when a crossing begins, is halved and ends, and what a lane leaves behind. Does not know the step's arithmetic.

use super::halving::{Halving, halve};
use super::mounts::{Mount, MountedStep, Mounts};
use super::one_side::{BridgeReading, OneSide, SideTraffic, peaks_of_bridge};
use super::stepped::{REFINEMENTS, Stepped};
use super::{Crossing, CrossingSettings, StepSpan};
use crate::analysis::AnalysisError;
use crate::bridge::{Bridge, BridgeDesign, LinkPlace, joint_parts};
use crate::contact::NotSettled;
use crate::operator::{BridgeOperator, CrossingInput, Crossings, StepClock, WheelLines, step};
use crate::response::{
    BankPart, CrossingResponse, DeadState, JointReading, PositionPeaks, Reading, Record, Recorder, RideReading,
};
use crate::traffic::Traffic;
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
    settings: CrossingSettings,
    whole: Stepped,
    mounts: Mounts,
    /// Its side for crossings that are their own mirror images, made when the first one comes; none where the bridge is not its own,
    /// or no side is to be used.
    side: OnceLock<Option<OneSide>>,
}

/// Crossings under way.
struct Crew<'a, C> {
    solver: &'a OperatorSolver,
    /// What they step on, and where that is one side of the bridge its links.
    on: &'a Stepped,
    mounts: &'a Mounts,
    side: Option<&'a OneSide>,
    lanes: Crossings,
    /// One lane by itself, for steps that are halved.
    solo: Option<Crossings>,
    /// How often the time step is halved from the beginning.
    refinement: usize,
    clock: &'a mut C,
}

/// One crossing to be solved.
#[derive(Clone, Copy)]
struct Job<'a> {
    /// What drives over the bridge, and over what the job is solved on.
    traffic: &'a Traffic,
    driving: &'a Traffic,
    /// Of each vehicle the wheels of one side that stand for its own; none where it drives over the whole.
    wheels: &'a [Vec<(usize, f64)>],
    crossing: &'a Crossing,
}

/// One crossing under way.
struct Under<'a> {
    index: usize,
    driving: &'a Traffic,
    wheels: &'a [Vec<(usize, f64)>],
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
            settings: *settings,
            whole: Stepped::new(Arc::clone(operator), settings),
            mounts: Mounts::default(),
            side: OnceLock::new(),
        }
    }

    /// Solves all crossings on the whole bridge, those too that are their own mirror images.
    #[must_use]
    pub fn without_sides(self) -> Self {
        Self {
            side: OnceLock::from(None),
            ..self
        }
    }

    /// The operator.
    pub fn operator(&self) -> &BridgeOperator {
        self.whole.operator()
    }

    /// The side of the bridge.
    fn side(&self) -> Option<&OneSide> {
        let of = || OneSide::of(&self.design, self.whole.operator(), &self.settings);
        self.side.get_or_init(of).as_ref()
    }

    /// Modes of one side of the bridge, on which crossings are solved that are their own mirror images; none of a bridge that is not
    /// its own.
    pub fn one_side_modes(&self) -> Option<usize> {
        self.side().map(|side| side.stepped.operator().modes())
    }

    /// Whether a crossing is its own mirror image on a bridge that is, so that it is solved on one side.
    pub fn is_on_one_side(&self, traffic: &Traffic, crossing: &Crossing) -> bool {
        self.side()
            .is_some_and(|side| side.traffic(traffic, crossing).is_some())
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
        let side = self.side();
        let on_side = |&(traffic, crossing): &(&Traffic, &Crossing)| side?.traffic(traffic, crossing);
        let on_side: Vec<Option<SideTraffic>> = crossings.iter().map(on_side).collect();
        let (mut of_side, mut of_whole) = (Vec::new(), Vec::new());
        for (number, (&(traffic, crossing), own)) in crossings.iter().zip(&on_side).enumerate() {
            let whole = Job {
                traffic,
                driving: traffic,
                wheels: &[],
                crossing,
            };
            match own {
                Some(SideTraffic {
                    traffic: driving,
                    wheels,
                }) => of_side.push((
                    number,
                    Job {
                        driving,
                        wheels,
                        ..whole
                    },
                )),
                None => of_whole.push((number, whole)),
            }
        }
        let mut answers = self.solve_on(None, &of_whole, refinement, clock);
        answers.extend(self.solve_on(side, &of_side, refinement, clock));
        answers.sort_unstable_by_key(|(number, _)| *number);
        answers.into_iter().map(|(_, answer)| answer).collect()
    }

    /// Solves numbered crossings on one side of the bridge or on the whole.
    fn solve_on(
        &self,
        side: Option<&OneSide>,
        numbered: &[(usize, Job<'_>)],
        refinement: usize,
        clock: &mut impl StepClock,
    ) -> Vec<(usize, Result<CrossingResponse, AnalysisError>)> {
        if numbered.is_empty() {
            return Vec::new();
        }
        let whole = (&self.whole, &self.mounts);
        let (on, mounts) = side.map_or(whole, |side| (&side.stepped, &side.mounts));
        let (numbers, crossings): (Vec<usize>, Vec<_>) = numbered.iter().copied().unzip();
        let most_nodes = crossings
            .iter()
            .map(|job: &Job<'_>| WheelLines::most_nodes_of(on.operator(), job.driving));
        let most_nodes = most_nodes.max().unwrap_or(0);
        let mut crew = Crew {
            solver: self,
            on,
            mounts,
            side,
            lanes: Crossings::new(on.operator(), most_nodes, self.settings.newton_limit),
            solo: None,
            refinement: refinement.min(REFINEMENTS),
            clock,
        };
        numbers.into_iter().zip(crew.run(&crossings)).collect()
    }

    /// The time step after some halvings `[s]`.
    pub fn time_step_s(&self, halvings: usize) -> f64 {
        self.whole.time_step_s(halvings)
    }
}

impl<C: StepClock> Crew<'_, C> {
    fn run(&mut self, crossings: &[Job<'_>]) -> Vec<Result<CrossingResponse, AnalysisError>> {
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
            let level = self.on.constants(self.refinement);
            let limit = self.solver.settings.newton_limit;
            step(&mut self.lanes, self.on.operator(), level, limit, self.clock);
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

    fn begin<'c>(&mut self, lane: usize, index: usize, job: Job<'c>) -> Under<'c> {
        let Job {
            traffic,
            driving,
            wheels,
            crossing,
        } = job;
        let mount = self.mounts.of(self.on, driving);
        let MountedStep { compliance, riding } = mount.step(self.on, self.refinement);
        let on_whole = || (crossing.laws(self.on.operator().connectors()), crossing.dashpots());
        let (laws, dashpots) = self.side.and_then(|side| side.laws(crossing)).unwrap_or_else(on_whole);
        let crossing_input = CrossingInput {
            traffic: Arc::new(driving.clone()),
            wheels: Arc::clone(&mount.wheels),
            compliance,
            riding,
            laws: laws.into(),
            dashpots: dashpots.into(),
            dead: crossing.dead.clone(),
            asks_for_corners: crossing.record.corners,
        };
        let h = self.solver.time_step_s(self.refinement);
        let length_m = self.solver.design.length_m();
        let span = StepSpan::new(length_m, traffic, h, crossing.tail_s);
        let start_s = span.time_s(0, h);
        self.lanes.begin(self.on.operator(), lane, crossing_input, start_s);
        let design = &self.solver.design;
        let parts = (joint_parts(design), self.solver.banks.clone());
        let rides = (traffic.ride_parts(), start_s);
        let mut recorder = Recorder::new(design.positions(), parts, rides, &crossing.record);
        recorder.expect(span.steps);
        recorder.note(&Start {
            time_s: start_s,
            dead: crossing.dead.as_deref(),
        });
        Under {
            index,
            driving,
            wheels,
            record: &crossing.record,
            step: 0,
            span,
            recorder,
        }
    }

    /// What is to be done with a lane after its step: halve it where it did not settle, record, finish.
    fn after_step(&mut self, lane: usize, of: &mut Under<'_>) -> Option<Result<CrossingResponse, AnalysisError>> {
        let time_s = self.time_s(of);
        if let Some(stuck) = self.lanes.unsettled(lane) {
            let mount = self.mounts.of(self.on, of.driving);
            let span_s = [self.time_after(of.step - 1, of), time_s];
            let recorder = (&mut of.recorder, of.wheels);
            if let Err(error) = self.halve((lane, &mount), stuck, span_s, recorder) {
                return Some(Err(error));
            }
            if let Some(solo) = &self.solo {
                let (reading, side, wheels) = (solo.reading(0), self.side, of.wheels);
                of.recorder.note(&BridgeReading {
                    of: reading,
                    side,
                    wheels,
                });
            }
        } else {
            let (reading, side, wheels) = (self.lanes.reading(lane), self.side, of.wheels);
            let reading = BridgeReading {
                of: reading,
                side,
                wheels,
            };
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
        (lane, mount): (usize, &Mount),
        stuck: NotSettled,
        span_s: [f64; 2],
        (recorder, wheels): (&mut Recorder, &[Vec<(usize, f64)>]),
    ) -> Result<(), AnalysisError> {
        let Some(input) = self.lanes.crossing(lane).cloned() else {
            return Ok(());
        };
        let saved = self.lanes.save(lane);
        let (operator, limit) = (self.on.operator(), self.solver.settings.newton_limit);
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
            wheels,
        };
        let done = halve(&mut alone, stuck, span_s, 0);
        self.lanes.restore(lane, &solo.save(0));
        self.solo = Some(solo);
        done
    }

    fn response(&mut self, lane: usize, of: &mut Under<'_>) -> CrossingResponse {
        let (mut peaks, design) = (self.lanes.peaks(lane), &self.solver.design);
        if let Some(side) = self.side {
            peaks.forces = peaks_of_bridge(&side.links, &peaks.forces, design.connectors.y_m.len());
        }
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
    mount: &'a Mount,
    recorder: &'a mut Recorder,
    wheels: &'a [Vec<(usize, f64)>],
}

impl<C: StepClock> Halving for Alone<'_, '_, C> {
    fn limit(&self) -> usize {
        self.crew.solver.settings.bisection_limit
    }

    fn step(&mut self, to_s: f64, halvings: usize) -> Result<Result<(), NotSettled>, AnalysisError> {
        let halvings = self.crew.refinement + halvings;
        let MountedStep { compliance, riding } = self.mount.step(self.crew.on, halvings);
        self.lane.take_step(0, compliance, &riding);
        self.lane.place(0, to_s);
        let solver = self.crew.solver;
        let limit = solver.settings.newton_limit;
        let on = self.crew.on;
        step(self.lane, on.operator(), on.constants(halvings), limit, &mut ());
        let unsettled = self.lane.unsettled(0);
        if unsettled.is_none() {
            let (reading, side, wheels) = (self.lane.reading(0), self.crew.side, self.wheels);
            self.recorder.take(&BridgeReading {
                of: reading,
                side,
                wheels,
            });
        }
        Ok(unsettled.map_or(Ok(()), Err))
    }

    fn record_bisection(&mut self, stuck: NotSettled) {
        let statistics = self.lane.statistics(0);
        statistics.bisections += 1;
        statistics.newton_iterations += stuck.iterations;
    }

    fn not_converged(&self, stuck: NotSettled, time_s: f64, bisections: usize) -> AnalysisError {
        let link = match self.crew.side {
            None => Some(stuck.connector),
            Some(side) => side.links.whole(stuck.connector),
        };
        AnalysisError::NotConverged {
            time_s,
            link: link.and_then(|link| self.crew.solver.link_places.get(link)).copied(),
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
