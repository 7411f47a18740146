//! Crossings side by side: the motion of each, one a SIMD lane.
//!
//! Knows the state that a crossing carries from step to step, and how a lane is begun, saved and taken elsewhere. Does not
//! know the step's arithmetic or when a crossing ends.

use super::basis::BridgeOperator;
use super::clock::{StepClock, StepPart};
use super::connectors::Connectors;
use super::contact_step::{Alone, Coupling, OfStep, Ports, begin_dashpots, end_dashpots, spring_factor};
use super::deck_forces::StationForce;
use super::energy::{Energy, Terms};
use super::envelope::{Envelope, LanePeaks};
use super::lane::{CrossingInput, Lane};
use super::lane_array::LaneArray;
use super::lane_group::{LaneGroup, LaneGroups, UnitForce};
use super::lane_waves::LaneWaves;
use super::loads::{Loads, apply_forces, sum_forces};
use super::local_residual::SavedResidual;
use super::modes::Modes;
use super::panel::{InstructionPath, MOST_LANES};
use super::pins::Pins;
use super::placed::Placed;
use super::residual::Residual;
use super::step_constants::StepConstants;
use super::vector::Ops;
use super::wheel_lines::WheelCompliance;
use crate::connector::State;
use crate::contact::NotSettled;
use crate::response::{DeadState, JointReading, PinPeaks, Reading, RideReading, Statistics};
use crate::riding::{Ride, RidingStep};
use pulp::Simd;
use std::sync::Arc;

/// Crossings side by side on one operator.
#[derive(Debug)]
pub(crate) struct Crossings {
    most_nodes: usize,
    pub(super) modes: Modes,
    pub(super) residual: Residual,
    pub(super) connectors: Connectors,
    pub(super) loads: Loads,
    pub(super) energy: Energy,
    pub(super) envelope: Envelope,
    pub(super) pins: Pins,
    /// Water with memory, where the bridge has it.
    pub(super) waves: Option<LaneWaves>,
    pub(super) lanes: Vec<Lane>,
    /// Lanes that go together in the step, and what is settled for one group of them after the other.
    pub(super) groups: LaneGroups,
    pub(super) coupling: Coupling,
    pub(super) alone: Alone,
    /// What each axle presses with beyond its weight `[N]`.
    pub(super) beyond_weight: LaneArray,
}

/// A lane's numbers by themselves.
#[derive(Debug, Clone)]
pub(crate) struct Saved {
    numbers: Vec<f64>,
    states: Vec<State>,
    local: SavedResidual,
    rider_forces: (Vec<StationForce>, usize),
    /// Motion of each vehicle on springs.
    rides: Vec<Ride>,
    statistics: Statistics,
    placed: Placed,
    /// Length of the last step, where dashpots ask for it `[s]`.
    before_s: f64,
}

/// Lanes that did not settle, as they stood before the step.
pub(super) type Unsettled = Option<Vec<(usize, Saved)>>;

impl Crossings {
    /// As many lanes as this machine's vectors have, with room for traffic of `most_nodes` nodes.
    pub(crate) fn new(operator: &BridgeOperator, most_nodes: usize, newton_limit: usize) -> Self {
        let width = InstructionPath::of_this_machine().lanes;
        let sizes = &operator.sizes;
        let lane = || Lane::new(sizes, most_nodes);
        Self {
            most_nodes,
            modes: Modes::new(sizes, width),
            residual: Residual::new(sizes, width),
            connectors: Connectors::new(sizes, width),
            loads: Loads::new(sizes, width),
            energy: Energy::new(width),
            envelope: Envelope::new(operator, width),
            pins: Pins::new(sizes, &operator.pins.places, width),
            waves: operator
                .waves
                .as_ref()
                .map(|waves| LaneWaves::new(waves, sizes.modes, width)),
            lanes: (0..width).map(|_| lane()).collect(),
            groups: LaneGroups::default(),
            coupling: Coupling::new(sizes, most_nodes, newton_limit, width),
            alone: Alone::new(sizes, most_nodes, newton_limit),
            beyond_weight: LaneArray::new(0, width),
        }
    }

    /// Number of lanes.
    pub(crate) fn width(&self) -> usize {
        self.lanes.len()
    }

    /// What a lane carries from step to step.
    fn carried(&mut self) -> impl Iterator<Item = &mut LaneArray> {
        let motion = self.modes.carried().into_iter().chain(self.residual.carried());
        let forces = self.connectors.carried().into_iter().chain(self.loads.carried());
        let told = self.energy.carried().into_iter().chain(self.envelope.carried());
        let waves = self.waves.iter_mut().flat_map(LaneWaves::carried);
        motion.chain(forces).chain(told).chain(self.pins.carried()).chain(waves)
    }

    /// Begins a crossing at rest, the front of the vehicle where it is one step before the first one.
    pub(crate) fn begin(&mut self, operator: &BridgeOperator, lane: usize, crossing: CrossingInput, time_s: f64) {
        self.rest(lane);
        self.take_connectors(lane, &crossing);
        self.forget();
        self.coupling
            .contact
            .put_states(lane, crossing.laws.iter().map(|law| law.state(0.0)));
        self.coupling.masses.local_residual().clear(lane);
        let of = &mut self.lanes[lane];
        of.statistics = Statistics::default();
        of.unloaded = 0;
        of.clear_riders();
        // before the first step no vehicle is on the bridge
        of.take(crossing, operator.track.length_m());
        of.place(time_s);
    }

    /// Takes the laws, the dashpots and the rest of a lane's connectors.
    fn take_connectors(&mut self, lane: usize, crossing: &CrossingInput) {
        self.connectors.take_laws(lane, &crossing.laws);
        self.connectors.dashpots.take(lane, !crossing.dashpots.is_empty());
        self.take_rest(lane, Some(crossing));
    }

    /// Takes the state at rest of a lane's crossing, or none.
    fn take_rest(&mut self, lane: usize, crossing: Option<&CrossingInput>) {
        let dead = crossing.and_then(|crossing| crossing.dead.as_deref());
        let laws = crossing.map_or(&[][..], |crossing| &crossing.laws);
        self.connectors.take_rest(lane, (laws, dead));
        self.envelope.corners.take_rest(lane, dead);
        self.pins.take_rest(lane, dead);
    }

    /// Says where a lane's vehicle is at the end of the coming step.
    pub(crate) fn place(&mut self, lane: usize, time_s: f64) {
        self.lanes[lane].place(time_s);
    }

    /// Frees a lane, which then rests.
    pub(crate) fn end(&mut self, lane: usize) {
        self.rest(lane);
        self.envelope.corners.end(lane);
        self.connectors.dashpots.take(lane, false);
        self.take_rest(lane, None);
        let of = &mut self.lanes[lane];
        of.crossing = None;
        of.dashpots = None;
        of.dead = None;
        of.unsettled = None;
        of.clear_riders();
        of.rides.clear();
        of.leave();
    }

    /// Zeros in a lane.
    fn rest(&mut self, lane: usize) {
        self.carried().for_each(|array| array.clear(lane));
        self.envelope.placed[lane] = Placed::default();
        let left = self.loads.left().into_iter().chain(self.connectors.left());
        left.chain(self.pins.left()).for_each(|array| array.clear(lane));
    }

    /// Whether a lane's last step found no equilibrium; it then stands where it stood before.
    pub(crate) fn unsettled(&self, lane: usize) -> Option<NotSettled> {
        self.lanes[lane].unsettled
    }

    /// Whether a lane's energies are finite.
    pub(crate) fn is_finite(&self, lane: usize) -> bool {
        self.energy.is_finite(lane)
    }

    /// What the solver did in a lane.
    pub(crate) fn statistics(&mut self, lane: usize) -> &mut Statistics {
        &mut self.lanes[lane].statistics
    }

    /// A lane's numbers.
    pub(crate) fn save(&mut self, lane: usize) -> Saved {
        let mut numbers = Vec::new();
        self.carried().for_each(|array| numbers.extend(array.lane(lane)));
        let of = &self.lanes[lane];
        Saved {
            numbers,
            states: self.coupling.contact.states(lane).to_vec(),
            local: self.coupling.masses.local_residual().save(lane),
            rider_forces: (of.rider_forces.clone(), of.first_spring),
            rides: of.rides.iter().map(|of| of.ride.clone()).collect(),
            statistics: of.statistics,
            placed: self.envelope.placed[lane],
            before_s: of.dashpots.as_ref().map_or(f64::INFINITY, |of| of.before_s),
        }
    }

    /// Puts numbers back into a lane, or into another of the same operator.
    pub(crate) fn restore(&mut self, lane: usize, saved: &Saved) {
        let places = self.carried().flat_map(|array| array.lane_mut(lane));
        places.zip(&saved.numbers).for_each(|(x, saved)| *x = *saved);
        self.envelope.placed[lane] = saved.placed;
        self.forget();
        self.coupling.contact.put_states(lane, saved.states.iter().copied());
        self.coupling.masses.local_residual().restore(lane, &saved.local);
        let of = &mut self.lanes[lane];
        of.statistics = saved.statistics;
        if let Some(dashpots) = &mut of.dashpots {
            dashpots.before_s = saved.before_s;
        }
        of.rider_forces.clone_from(&saved.rider_forces.0);
        of.first_spring = saved.rider_forces.1;
        for (of, saved) in of.rides.iter_mut().zip(&saved.rides) {
            of.ride.clone_from(saved);
        }
        // the load's traces in the step under way are written anew
        of.unloaded = 0;
    }

    /// Takes up a crossing that was saved elsewhere, with the small compliances of its step length.
    pub(crate) fn resume(&mut self, operator: &BridgeOperator, lane: usize, crossing: CrossingInput, saved: &Saved) {
        // a crossing without riding masses writes no inertia forces, so that none may be left of the one before
        self.rest(lane);
        self.take_connectors(lane, &crossing);
        self.lanes[lane].take(crossing, operator.track.length_m());
        self.restore(lane, saved);
    }

    /// Changes to another step length.
    pub(crate) fn take_step(
        &mut self,
        lane: usize,
        compliance: Arc<WheelCompliance>,
        riding: &Arc<[Option<Arc<RidingStep>>]>,
    ) {
        self.forget();
        let of = &mut self.lanes[lane];
        if let Some(crossing) = &mut of.crossing {
            crossing.compliance = compliance;
            crossing.riding = Arc::clone(riding);
        }
        for ride in &mut of.rides {
            if let Some(step) = &riding[ride.vehicle] {
                ride.take_step(step);
            }
        }
    }

    /// Nodes of the largest vehicle that has room.
    pub(crate) fn most_nodes(&self) -> usize {
        self.most_nodes
    }

    /// Reads what is observed at the step's end.
    #[inline(always)]
    pub(super) fn update_envelope<S: Simd>(&mut self, o: Ops<S>, operator: &BridgeOperator, constants: &StepConstants) {
        let motion = (&self.modes, &self.residual, &self.connectors, &self.energy);
        let lanes = (&self.groups, &self.lanes[..]);
        self.envelope.update(o, operator, constants, motion, lanes);
    }

    /// Finds the forces of the pins where the step's balance holds.
    #[inline(always)]
    pub(super) fn update_pins<S: Simd>(&mut self, o: Ops<S>, operator: &BridgeOperator, constants: &StepConstants) {
        if self.pins.is_empty() {
            return;
        }
        let first = operator.sizes.before_pins();
        let mut end_s = [0.0; MOST_LANES];
        for (lane, of) in self.lanes.iter().enumerate() {
            end_s[lane] = of.time_s;
            let Some(crossing) = &of.crossing else { continue };
            let (wheels, [weights, inertia]) = (&crossing.wheels, self.pins.loads_now());
            let width = wheels.influence_width;
            let group = &self.groups.all()[of.group];
            let force = |of: &UnitForce| (of.line, of.station, of.share * group.load_in(of.vehicle, lane));
            let on_lines: Vec<StationForce> = group.weights.iter().map(force).collect();
            apply_forces((&wheels.weights[..], width, first), &on_lines, weights, lane);
            let (masses, springs) = of.rider_forces.split_at(of.first_spring);
            apply_forces((&wheels.nodes[..], width, first), masses, inertia, lane);
            if !springs.is_empty() {
                let rows = weights.rows();
                sum_forces((&wheels.nodes[..], width, first), springs, rows, |from, sums| {
                    for (row, sum) in weights.rows_from_mut(from).zip(sums) {
                        row[lane] += sum;
                    }
                });
            }
        }
        let end_s = &end_s[..self.lanes.len()];
        let motion = (&self.modes, self.waves.as_ref(), &self.connectors);
        self.pins.update(o, constants, motion, end_s);
    }

    /// Whether anything rides along in any lane.
    #[inline(always)]
    pub(super) fn any_mass(&self) -> bool {
        self.lanes.iter().any(Lane::has_masses)
    }

    /// The crossing of a lane.
    pub(crate) fn crossing(&self, lane: usize) -> Option<&CrossingInput> {
        self.lanes[lane].crossing.as_ref()
    }

    /// What a lane's crossing leaves behind, peaks in the order of positions and joints.
    pub(crate) fn peaks(&self, lane: usize) -> LanePeaks {
        self.envelope.peaks(lane, self.energy.summary(lane))
    }

    /// Extremes of the pins; none where they are not followed.
    pub(crate) fn pin_peaks(&self, lane: usize) -> Vec<PinPeaks> {
        self.pins.peaks(lane)
    }

    /// A lane as it stands after a step, to be read.
    pub(crate) fn reading(&self, lane: usize) -> LaneReading<'_> {
        LaneReading { of: self, lane }
    }

    /// Puts the vehicles of all lanes and their weights where they are at the end of the step (V1).
    #[inline(always)]
    pub(super) fn place_loads<S: Simd>(&mut self, o: Ops<S>, operator: &BridgeOperator) {
        let Self {
            groups,
            lanes,
            loads,
            coupling,
            ..
        } = self;
        groups.form(lanes, |lane, other| coupling.masses.alike(lane, other), &operator.track);
        for group in groups.all() {
            let first = group.base + group.first();
            if let (Some(crossing), false) = (&lanes[first].crossing, group.weights.is_empty()) {
                loads.apply_weights(o, &crossing.wheels, group);
            }
            for lane in group.numbers() {
                let of = &mut lanes[lane];
                for ride in &mut of.rides {
                    ride.begin_step(&group.placements[ride.vehicle]); // (V4)
                }
                if !group.weights.is_empty() {
                    of.unloaded = 0;
                } else if of.unloaded < 2 || of.pressed {
                    // springs of the last step stand where this one begins
                    of.unloaded = if of.pressed { 0 } else { of.unloaded + 1 };
                    loads.left().into_iter().for_each(|forces| forces.clear(lane));
                }
            }
        }
    }

    /// Solves the contact of each lane (C1); those that do not settle as they stood before the step.
    #[inline(always)]
    pub(super) fn solve_contact<S: Simd>(
        &mut self,
        o: Ops<S>,
        of_step: (&BridgeOperator, &StepConstants, usize),
        clock: &mut impl StepClock,
    ) -> Unsettled {
        let (operator, constants, newton_limit) = of_step;
        let of_step = OfStep {
            operator,
            constants,
            newton_limit,
        };
        let h = constants.scheme.h;
        if begin_dashpots(&mut self.lanes, &self.connectors, h) {
            self.forget();
        }
        let Self {
            groups,
            lanes,
            coupling,
            alone,
            modes,
            connectors,
            loads,
            beyond_weight,
            ..
        } = self;
        (0..lanes.len()).for_each(|lane| coupling.masses.leave(lane));
        let axles = groups.all().iter().map(|group| group.axles.len()).max().unwrap_or(0);
        beyond_weight.ensure_rows(axles);
        beyond_weight.clear_rows(axles);
        for group in groups.settled() {
            let ports = Ports {
                free: &modes.free,
                n: &connectors.n,
                e_now: &mut connectors.e_now,
                n_now: &mut connectors.n_now,
                inertia_now: &mut loads.inertia_now,
                beyond_weight: &mut *beyond_weight,
            };
            match group.alone() {
                Some(lane) => alone.settle((group, lane), lanes, (coupling, ports), of_step, clock),
                None => coupling.settle(o, group, lanes, ports, of_step, clock),
            }
        }
        for (lane, of) in lanes.iter().enumerate() {
            if of.pressed && of.unsettled.is_none() {
                loads.add_springs(lane, &of.seen_springs, spring_factor(constants));
            }
        }
        for group in groups.all() {
            for lane in group.numbers() {
                if let (Some(crossing), None) = (&lanes[lane].crossing, lanes[lane].unsettled) {
                    let placed = &mut self.envelope.placed[lane];
                    placed.note_axles(lanes[lane].time_s, &crossing.wheels, (lane, group), beyond_weight);
                }
            }
        }
        end_dashpots(lanes, connectors, h);
        let mut unsettled: Unsettled = None;
        for lane in 0..self.lanes.len() {
            if self.lanes[lane].unsettled.is_some() {
                let saved = self.save(lane);
                unsettled.get_or_insert_default().push((lane, saved));
            }
        }
        self.coupling.masses.end_step();
        clock.lap(StepPart::GatherAndScatter, || 0.0);
        unsettled
    }

    /// Forgets what was factored for other laws or another step length.
    pub(super) fn forget(&mut self) {
        self.coupling.contact.forget();
        self.alone.forget();
    }

    /// Operations of placing the weights, of all lanes.
    pub(super) fn flop_of_loads(&self) -> f64 {
        let of_group = |group: &LaneGroup| group.weights.len() * group.lanes.len();
        let forces: usize = self.groups.all().iter().map(of_group).sum();
        (2 * forces * self.loads.weights.rows()) as f64
    }

    /// Operations of reading what is observed, a lane: `V [q; s]`, and peaks.
    pub(super) fn flop_of_observed(&self) -> f64 {
        let columns = self.modes.count() + self.connectors.count();
        let rows = self.envelope.rows_read();
        (2 * columns * rows + 10 * rows + 20 * self.envelope.modules()) as f64
    }

    /// Takes all lanes to the step's end, contact solved (O6), (O7).
    #[inline(always)]
    pub(super) fn correct<S: Simd>(
        &mut self,
        o: Ops<S>,
        operator: &BridgeOperator,
        constants: &StepConstants,
        clock: &mut impl StepClock,
    ) -> Terms<S> {
        let mut terms = Terms::new(o);
        if !self.pins.is_empty() {
            self.pins.keep(&self.modes);
        }
        self.connectors.apply(o, constants, &mut self.modes.contact_now);
        let waves = self.waves.as_ref().map(|waves| &waves.modal);
        self.modes
            .correct(o, operator, constants, (&self.loads, waves), &mut terms);
        clock.lap(StepPart::Modes, || {
            self.modes.flop_of_correction() + self.connectors.flop_of_application(self.modes.count())
        });
        if let Some(waves) = &mut self.waves {
            waves.follow(o, constants, self.modes.motion()[1]); // (W7)
            clock.lap(StepPart::Waves, || waves.flop(constants));
        }
        self.residual
            .correct(o, constants, &self.loads, &self.connectors, &mut terms);
        self.connectors.correct(o, constants, &mut terms);
        for (lane, of) in self.lanes.iter().enumerate() {
            // forces of springs then weigh as weights do
            if of.pressed && of.unsettled.is_none() {
                self.loads.end_springs(lane, &of.seen_springs, spring_factor(constants));
            }
        }
        self.loads.end_step();
        clock.lap(StepPart::Residual, || self.residual.flop_of_correction());
        terms
    }

    /// Puts lanes back to before the step.
    #[inline(always)]
    pub(super) fn restore_all(&mut self, unsettled: Unsettled) {
        for (lane, saved) in unsettled.into_iter().flatten() {
            self.restore(lane, &saved);
        }
    }
}

/// A lane after a step, to be read.
pub(crate) struct LaneReading<'a> {
    of: &'a Crossings,
    lane: usize,
}

impl LaneReading<'_> {
    fn dead(&self) -> Option<&DeadState> {
        self.of.lanes[self.lane].dead.as_ref().map(|dead| &*dead.state)
    }
}

impl JointReading for LaneReading<'_> {
    fn force_n(&self, connector: usize) -> f64 {
        let now = self.of.connectors.by_law().at(connector, self.lane);
        now + self.dead().map_or(0.0, |dead| dead.forces_n[connector])
    }

    fn connector_n(&self, connector: usize) -> [f64; 2] {
        let connectors = &self.of.connectors;
        let now = connectors.by_law().at(connector, self.lane);
        let at_balance = self.of.pins.connector_n(connector, self.lane);
        match self.dead() {
            None => [now, at_balance],
            Some(dead) => [now, at_balance].map(|force| force + dead.forces_n[connector]),
        }
    }

    fn elongation_m(&self, connector: usize) -> f64 {
        self.of.connectors.e.at(connector, self.lane) + self.dead().map_or(0.0, |dead| dead.elongations_m[connector])
    }

    fn pin_n(&self, pin: usize) -> [f64; 3] {
        self.of.pins.force_n(pin, self.lane)
    }

    fn spring_m(&self, spring: usize) -> f64 {
        self.of.envelope.spring_m(spring, self.lane) + self.dead().map_or(0.0, |dead| dead.springs_m[spring])
    }
}

impl Reading for LaneReading<'_> {
    fn ride(&self, vehicle: usize) -> Option<RideReading<'_>> {
        let mut rides = self.of.lanes[self.lane].rides.iter();
        rides.find(|ride| ride.vehicle == vehicle)?.reading()
    }

    fn is_on(&self, vehicle: usize, wheel: usize) -> bool {
        let lane = &self.of.lanes[self.lane];
        let of = lane
            .crossing
            .as_ref()
            .map(|crossing| &crossing.wheels.vehicles[vehicle].vehicle);
        let placement = self.of.groups.placement(lane.group, vehicle);
        of.is_some_and(|of| placement.is_on(&of.patches[wheel]))
    }

    fn times_s(&self) -> [f64; 2] {
        let now_s = self.of.lanes[self.lane].time_s;
        [now_s, self.of.pins.balance_s(self.lane).unwrap_or(now_s)]
    }

    fn position_m(&self, index: usize) -> f64 {
        self.of.envelope.position_m(index, self.lane)
    }

    fn place_m(&self, index: usize) -> f64 {
        self.of.envelope.place_m(index, self.lane)
    }

    fn corner_m(&self, index: usize) -> f64 {
        self.of.envelope.corner_m(index, self.lane)
    }
}
