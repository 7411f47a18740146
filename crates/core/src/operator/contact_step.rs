//! Contact and what rides along, settled together (C1): for one group of lanes after the other.
//!
//! Knows the order of the parts for a group. Does not know the arithmetic of any.

use super::active_sets::ContactInput;
use super::basis::{BridgeOperator, Sizes};
use super::clock::{StepClock, StepPart};
use super::connectors::Connectors;
use super::contact_system::{ContactSystem, LaneLaws};
use super::lane::Lane;
use super::lane_array::LaneArray;
use super::lane_group::LaneGroup;
use super::loads::{apply_inertia, sum_forces};
use super::moving_masses::{MovingMasses, OfGroup};
use super::panel::{MOST_LANES, lanes};
use super::rides::LaneRide;
use super::step_constants::StepConstants;
use super::vector::Ops;
use crate::riding::RideEnergies;
use crate::scheme::Arithmetic;
use pulp::Simd;
use std::sync::Arc;

/// What settles a group of lanes: room for what rides along and for the small systems.
#[derive(Debug)]
pub(super) struct Coupling {
    pub(super) masses: MovingMasses,
    pub(super) contact: ContactSystem,
}

/// Numbers of lanes that contact reads and writes.
#[derive(Debug)]
pub(super) struct Ports<'a> {
    /// Free motion of the modes.
    pub(super) free: &'a [LaneArray; 3],
    /// Connectors: forces at the last step, elongations without new forces and then with them, forces.
    pub(super) n: &'a LaneArray,
    pub(super) e_now: &'a mut LaneArray,
    pub(super) n_now: &'a mut LaneArray,
    /// What masses do, and what axles press with beyond their weight `[N]`.
    pub(super) inertia_now: &'a mut LaneArray,
    pub(super) beyond_weight: &'a mut LaneArray,
}

/// What is settled with one lane alone: its numbers side by side, so that vectors run along them.
#[derive(Debug)]
pub(super) struct Alone {
    coupling: Coupling,
    /// Whose factors are kept.
    lane: usize,
    free: [LaneArray; 3],
    n: LaneArray,
    e_now: LaneArray,
    n_now: LaneArray,
    rows: LaneArray,
    beyond_weight: LaneArray,
}

/// What a step is solved with.
#[derive(Clone, Copy)]
pub(super) struct OfStep<'a> {
    pub(super) operator: &'a BridgeOperator,
    pub(super) constants: &'a StepConstants,
    pub(super) newton_limit: usize,
}

impl Coupling {
    /// Room for traffic of `most_nodes` nodes in each lane.
    pub(super) fn new(sizes: &Sizes, most_nodes: usize, newton_limit: usize, lanes: usize) -> Self {
        Self {
            masses: MovingMasses::new(sizes.connectors, most_nodes, lanes),
            contact: ContactSystem::new(sizes.connectors, most_nodes, newton_limit, lanes),
        }
    }

    /// Settles a group of `lanes`, which count from its base on; what became of each, and its forces on nodes.
    #[inline(always)]
    pub(super) fn settle<S: Simd>(
        &mut self,
        o: Ops<S>,
        group: &LaneGroup,
        lanes: &mut [Lane],
        mut ports: Ports<'_>,
        of_step: OfStep<'_>,
        clock: &mut impl StepClock,
    ) {
        let Some(crossing) = &lanes[group.first()].crossing else {
            return;
        };
        let (wheels, compliance) = (Arc::clone(&crossing.wheels), Arc::clone(&crossing.compliance));
        let constants = of_step.constants;
        let of = OfGroup {
            group,
            wheels: &wheels,
            compliance: &compliance,
            constants,
        };
        let (masses, contact) = (&mut self.masses, &mut self.contact);
        masses.place(of.wheels, &of_step.operator.track, group, lanes);
        if masses.count() > 0 {
            masses.follow(o, of, lanes, ports.n);
            masses.couple(o, of, lanes, ports.free); // (V5)
        }
        for &lane in &group.lanes {
            let awake = lanes[lane].rides.iter().filter(|ride| ride.is_awake());
            contact.begin_riders(lane, awake.flat_map(LaneRide::pressing));
        }
        let count = group.lanes.len() as f64;
        clock.lap(StepPart::RidingMasses, || {
            count * masses.flop_of_coupling(constants.c.len())
        });
        self.settle_links(o, group, lanes, &mut ports, of_step);
        clock.lap(StepPart::Contact, || {
            self.contact.flop(&group.lanes, self.masses.count())
        });
        let mask = settled::<S>(o, group, lanes);
        for &lane in &group.lanes {
            if lanes[lane].unsettled.is_none() {
                lanes[lane].clear_riders();
                lanes[lane].leave();
            }
        }
        if self.masses.count() == 0 {
            return;
        }
        let (masses, linear) = (&mut self.masses, &self.contact.linear);
        let from_rest = group.lanes.iter().any(|&lane| lanes[lane].dead.is_some());
        masses.move_nodes(
            o,
            of.compliance,
            &linear.riders,
            (linear.pressed(from_rest), &linear.forces),
        );
        masses.add_forces(o, of, &linear.riders, ports.beyond_weight);
        let [on_masses, _] = masses.forces(constants);
        apply_inertia(o, mask, of.wheels, on_masses, ports.inertia_now);
        for &lane in &group.lanes {
            if lanes[lane].unsettled.is_none() {
                take_forces(masses, lane, &mut lanes[lane], constants);
                if masses.wheels_on_springs() > 0 {
                    press_springs(masses, (lane, &mut lanes[lane]), of, &linear.riders);
                }
            }
        }
        masses.lead(o, of, mask, ports.n_now);
        let rows = ports.inertia_now.rows();
        clock.lap(StepPart::RidingMasses, || count * masses.flop_of_leading(rows));
    }

    /// Solves the small systems of a group; leaves elongations, forces and what became of each lane.
    #[inline(always)]
    fn settle_links<S: Simd>(
        &mut self,
        o: Ops<S>,
        group: &LaneGroup,
        lanes: &mut [Lane],
        ports: &mut Ports<'_>,
        OfStep {
            constants,
            newton_limit,
            ..
        }: OfStep<'_>,
    ) {
        let (masses, contact) = (&mut self.masses, &mut self.contact);
        let (h, weight) = (constants.scheme.h, 1.0 - constants.scheme.alpha_f);
        for &lane in &group.lanes {
            if let Some(dead) = &mut lanes[lane].dead {
                let at = (lane, &mut *ports.e_now);
                dead.begin_step((h, weight), &constants.connector_compliance, at, &mut masses.block); // (D3)
            }
        }
        let mut laws: LaneLaws<'_> = [&[]; MOST_LANES];
        for (laws, &lane) in laws.iter_mut().zip(&group.lanes) {
            *laws = lanes[lane].laws().unwrap_or_default();
        }
        let laws = &laws[..group.lanes.len()];
        if group.lanes.iter().any(|&lane| lanes[lane].dashpots.is_some()) {
            contact.forget_laws();
        }
        let input = ContactInput {
            lanes: &group.lanes,
            laws,
            e: ports.e_now,
            compliance: &constants.connector_compliance,
            weight,
            riders: &masses.block,
        };
        contact.solve(o, input, newton_limit);
        let mut outcomes = [None; MOST_LANES];
        for ((outcome, laws), &lane) in outcomes.iter_mut().zip(laws).zip(&group.lanes) {
            *outcome = Some(contact.outcome(lane, laws));
        }
        for (outcome, &lane) in outcomes.into_iter().flatten().zip(&group.lanes) {
            let of = &mut lanes[lane];
            of.unsettled = outcome.err();
            if let Ok((iterations, switches)) = outcome {
                of.statistics.steps += 1;
                of.statistics.newton_iterations += iterations;
                of.statistics.contact_switches += switches;
                if let Some(dead) = &of.dead {
                    dead.end_step(lane, &mut contact.linear.forces);
                }
            }
        }
        let (mask, unscaled) = (settled::<S>(o, group, lanes), o.splat(1.0 / weight));
        let (e_now, n_now) = (ports.e_now.vectors_mut::<S>(), ports.n_now.vectors_mut::<S>());
        let (found, forces) = (
            contact.linear.found.vectors::<S>(),
            contact.linear.forces.vectors::<S>(),
        );
        for i in 0..e_now.len() {
            e_now[i] = o.0.select_f64s(mask, found[i], e_now[i]);
            n_now[i] = o.0.select_f64s(mask, o.mul(forces[i], unscaled), n_now[i]);
        }
    }
}

impl Alone {
    /// Room for one lane.
    pub(super) fn new(sizes: &Sizes, most_nodes: usize, newton_limit: usize) -> Self {
        let of = |rows: usize| LaneArray::new(rows, 1);
        Self {
            coupling: Coupling::new(sizes, most_nodes, newton_limit, 1),
            lane: 0,
            free: [of(sizes.modes), of(sizes.modes), of(sizes.modes)],
            n: of(sizes.connectors),
            e_now: of(sizes.connectors),
            n_now: of(sizes.connectors),
            rows: of(sizes.followed()),
            beyond_weight: of(0),
        }
    }

    /// Forgets what was factored.
    pub(super) fn forget(&mut self) {
        self.coupling.contact.forget();
    }

    /// Settles a lane by itself, and writes its numbers between those of the others.
    #[inline(always)]
    pub(super) fn settle(
        &mut self,
        (group, lane): (&LaneGroup, usize),
        each: &mut [Lane],
        (all, ports): (&mut Coupling, Ports<'_>),
        of_step: OfStep<'_>,
        clock: &mut impl StepClock,
    ) {
        if self.lane != lane {
            self.coupling.contact.forget();
            self.lane = lane;
        }
        let has_riders = !group.is_still;
        let (modes, links) = (ports.free[0].rows(), ports.n.rows());
        if has_riders {
            // masses with the deck's acceleration ask for nothing else
            let crossing = each[lane].crossing.as_ref();
            let first = if crossing.is_some_and(|of| of.wheels.needs_motion) {
                0
            } else {
                2
            };
            for (to, from) in self.free.iter_mut().zip(ports.free).skip(first) {
                to.take_lane(0, modes, (from, lane));
            }
            self.n.take_lane(0, links, (ports.n, lane));
        }
        self.e_now.take_lane(0, links, (ports.e_now, lane));
        self.beyond_weight.ensure_rows(ports.beyond_weight.rows());
        let axles = ports.beyond_weight.rows();
        self.beyond_weight.clear_rows(axles);
        self.coupling.masses.begin_alone((&all.masses, lane));
        all.contact.swap_states(lane, (&mut self.coupling.contact, 0));
        clock.lap(StepPart::GatherAndScatter, || 0.0);
        let own = Ports {
            free: &self.free,
            n: &self.n,
            e_now: &mut self.e_now,
            n_now: &mut self.n_now,
            inertia_now: &mut self.rows,
            beyond_weight: &mut self.beyond_weight,
        };
        let lanes = &mut each[lane..=lane];
        self.coupling
            .settle(Ops(pulp::Scalar), group, lanes, own, of_step, clock);
        all.contact.swap_states(lane, (&mut self.coupling.contact, 0));
        if each[lane].unsettled.is_none() {
            ports.e_now.take_lane(lane, links, (&self.e_now, 0));
            ports.n_now.take_lane(lane, links, (&self.n_now, 0));
            if self.coupling.masses.count() > 0 {
                let rows = ports.inertia_now.rows();
                ports.inertia_now.take_lane(lane, rows, (&self.rows, 0));
                ports.beyond_weight.take_lane(lane, axles, (&self.beyond_weight, 0));
                all.masses.take_alone(lane, &self.coupling.masses);
            }
        }
        clock.lap(StepPart::GatherAndScatter, || 0.0);
    }
}

/// The lanes of a group that have settled.
#[inline(always)]
fn settled<S: Simd>(o: Ops<S>, group: &LaneGroup, each: &[Lane]) -> S::m64s {
    let mut inside = [0.0; MOST_LANES];
    for &lane in &group.lanes {
        inside[lane] = if each[lane].unsettled.is_none() { 1.0 } else { 0.0 };
    }
    o.0.greater_than_f64s(lanes::<S>(&inside)[0], o.splat(0.0))
}

/// Keeps a lane's forces on nodes.
#[inline(always)]
fn take_forces(masses: &MovingMasses, lane: usize, of: &mut Lane, constants: &StepConstants) {
    for (kind, forces) in masses.forces(constants).into_iter().enumerate() {
        if kind == 1 {
            of.first_spring = of.rider_forces.len();
        }
        let force = |i: usize| forces.factor * forces.forces.at(i, lane);
        let on_nodes = forces.nodes.iter().enumerate();
        of.rider_forces
            .extend(on_nodes.map(|(i, node)| (node.line, node.station, force(i))));
    }
}

/// Presses the springs of a lane's wheels on the deck, and takes its vehicles to the step's end.
#[inline(always)]
fn press_springs(masses: &MovingMasses, (lane, of): (usize, &mut Lane), group: OfGroup<'_>, scaled: &LaneArray) {
    of.pressed = true;
    let (wheels, constants) = (group.wheels, group.constants);
    let (columns, seen) = (of.seen_springs.len(), &mut of.seen_springs);
    sum_forces(
        (&wheels.nodes[..], wheels.influence_width, 0),
        &of.rider_forces[of.first_spring..],
        columns,
        |from, sums| seen[from..][..sums.len()].copy_from_slice(sums),
    );
    // wheels come in the order of the vehicles that are there
    let (mut number, mut first, rides) = (0, 0, &mut of.rides);
    masses.under_wheels(lane, constants, |rider, on_deck, under| {
        while !rides[number].is_awake() || rider - first >= rides[number].wheels() {
            first += if rides[number].is_awake() {
                rides[number].wheels()
            } else {
                0
            };
            number += 1;
        }
        rides[number].note_deck(rider - first, under, on_deck);
    });
    let mut from = masses.count() - masses.wheels_on_springs();
    let mut sum = RideEnergies::default();
    let own = &mut of.wheel_forces;
    for ride in rides.iter_mut().filter(|ride| ride.is_awake()) {
        let many = ride.wheels();
        own.clear();
        own.extend((from..from + many).map(|rider| scaled.at(rider, lane)));
        sum = sum.and(ride.end_step(own, &group.group.placements[ride.vehicle]));
        from += many;
    }
    of.ridden = sum;
}

/// Changes to the laws of dashpots in a step of length `h` `[s]`; whether the stiffnesses of any are others than before.
#[inline(always)]
pub(super) fn begin_dashpots(lanes: &mut [Lane], connectors: &Connectors, h: f64) -> bool {
    let mut changed = false;
    for (lane, of) in lanes.iter_mut().enumerate() {
        if let Some(dashpots) = &mut of.dashpots {
            changed |= dashpots.begin_step(lane, h, &connectors.e, &connectors.dashpots);
        }
    }
    changed
}

/// Leaves what dashpots give in the step.
#[inline(always)]
pub(super) fn end_dashpots(lanes: &mut [Lane], connectors: &mut Connectors, h: f64) {
    let Connectors {
        e,
        e_now,
        n_now,
        dashpots: given,
        rest,
        ..
    } = connectors;
    for (lane, of) in lanes.iter_mut().enumerate() {
        if let (Some(dashpots), None) = (&mut of.dashpots, of.unsettled) {
            dashpots.end_step(lane, h, [e, e_now, n_now, rest], given);
        }
    }
}

/// What forces of springs are multiplied by to stand among inertia forces in the balance at alpha.
pub(super) fn spring_factor(constants: &StepConstants) -> f64 {
    (1.0 - constants.scheme.alpha_f) / (1.0 - constants.scheme.alpha_m)
}
