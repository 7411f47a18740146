//! One crossing in its lane: its traffic and laws, and what it has beside the numbers of all lanes.
//!
//! Knows where the vehicles are and how contact is solved. Does not know the lanes beside it.

use super::basis::{BridgeOperator, Sizes};
use super::clock::{StepClock, StepPart};
use super::connectors::Connectors;
use super::contact_system::{ContactInput, ContactSystem};
use super::dashpots::LaneDashpots;
use super::dead::LaneDead;
use super::lane_array::LaneArray;
use super::loads::{Loads, StationForce, sum_forces};
use super::local_residual::StepForces;
use super::modes::Modes;
use super::moving_masses::{FreeMotion, MovingMasses};
use super::rides::LaneRide;
use super::step_constants::StepConstants;
use super::wheel_lines::{VehicleLines, WheelCompliance, WheelLine, WheelLines};
use crate::bridge::{Heading, VehiclePlacement};
use crate::contact::{Dashpot, LinkLaw, NotSettled};
use crate::response::{DeadState, Statistics};
use crate::riding::{RideEnergies, RidingStep};
use crate::traffic::Traffic;
use std::sync::Arc;

/// One crossing as its lane knows it.
#[derive(Debug, Clone)]
pub(crate) struct CrossingInput {
    /// What drives.
    pub traffic: Arc<Traffic>,
    /// The vehicles on the deck.
    pub wheels: Arc<WheelLines>,
    /// Their small compliances and their springs at the step length.
    pub compliance: Arc<WheelCompliance>,
    pub riding: Arc<[Option<Arc<RidingStep>>]>,
    /// The law of each connector.
    pub laws: Arc<[LinkLaw]>,
    /// The connectors that have dashpots.
    pub dashpots: Arc<[Dashpot]>,
    /// The state at rest from which it starts, where the bridge has a dead load.
    pub dead: Option<Arc<DeadState>>,
}

/// What a lane has beside its numbers.
#[derive(Debug)]
pub(super) struct Lane {
    pub(super) crossing: Option<CrossingInput>,
    /// Time at the end of the step under way `[s]`, and where the vehicles are then.
    pub(super) time_s: f64,
    pub(super) placements: Vec<VehiclePlacement>,
    pub(super) contact: ContactSystem,
    pub(super) dashpots: Option<LaneDashpots>,
    pub(super) dead: Option<LaneDead>,
    pub(super) masses: MovingMasses,
    pub(super) rides: Vec<LaneRide>,
    /// Weight on each axle of each vehicle that lies on the bridge `[N]`, and whether the contact force of all its points has
    /// settled; what its masses and springs add.
    pub(super) axles: Vec<(f64, bool)>,
    pub(super) beyond_weight: Vec<f64>,
    /// Downward forces on stations of the lines of the weights, then on nodes of the masses and of wheels on springs.
    pub(super) weights: Vec<StationForce>,
    pub(super) rider_forces: Vec<StationForce>,
    /// The first of those of wheels on springs.
    pub(super) first_spring: usize,
    /// What the rows see of the springs, and whether there are any in the step under way.
    seen_springs: Vec<f64>,
    pressed: bool,
    /// Energies of vehicles on springs over the step.
    pub(super) ridden: RideEnergies,
    /// Steps since the vehicles left, up to two: by then all traces of its load are zero.
    pub(super) unloaded: u8,
    pub(super) statistics: Statistics,
    pub(super) unsettled: Option<NotSettled>,
    /// Free motion of the modes at the step's end, and connector forces, of this lane alone.
    free: FreeMotion,
    n: Vec<f64>,
}

impl Lane {
    /// A free lane, with room for vehicles of at most `most_nodes` nodes.
    pub(super) fn new(sizes: &Sizes, most_nodes: usize, newton_limit: usize) -> Self {
        let (modes, connectors) = (sizes.modes, sizes.connectors);
        Self {
            crossing: None,
            time_s: 0.0,
            placements: Vec::new(),
            contact: ContactSystem::new(connectors, most_nodes, newton_limit),
            dashpots: None,
            dead: None,
            masses: MovingMasses::new(connectors, most_nodes),
            rides: Vec::new(),
            axles: Vec::new(),
            beyond_weight: Vec::new(),
            weights: Vec::with_capacity(most_nodes),
            rider_forces: Vec::with_capacity(most_nodes),
            first_spring: 0,
            seen_springs: vec![0.0; sizes.followed()],
            pressed: false,
            ridden: RideEnergies::default(),
            unloaded: 0,
            statistics: Statistics::default(),
            unsettled: None,
            free: FreeMotion::new(modes),
            n: vec![0.0; connectors],
        }
    }

    /// Takes up a crossing, without forces on the deck.
    pub(super) fn take(&mut self, crossing: CrossingInput, length_m: f64) {
        let axles = crossing.wheels.axles;
        self.axles = vec![(0.0, true); axles];
        self.beyond_weight = vec![0.0; axles];
        self.placements = vec![VehiclePlacement::default(); crossing.traffic.vehicles.len()];
        self.rides = LaneRide::all(&crossing.traffic, &crossing.riding, length_m);
        self.leave();
        self.dashpots = LaneDashpots::new(&crossing.dashpots, &crossing.laws);
        self.dead = crossing.dead.as_ref().map(LaneDead::new);
        self.crossing = Some(crossing);
    }

    /// No vehicle on springs has moved in the last step.
    pub(super) fn leave(&mut self) {
        (self.pressed, self.ridden) = (false, RideEnergies::default());
    }

    /// Says when the coming step ends.
    pub(super) fn place(&mut self, time_s: f64) {
        self.time_s = time_s;
    }

    /// Whether anything rides along.
    #[inline(always)]
    pub(super) fn has_masses(&self) -> bool {
        self.crossing.as_ref().is_some_and(|c| !c.wheels.nodes.is_empty())
    }

    /// Puts the weights where the vehicles are at the end of the step (V1).
    #[inline(always)]
    pub(super) fn place_loads(&mut self, lane: usize, operator: &BridgeOperator, loads: &mut Loads) {
        let Some(crossing) = &self.crossing else {
            return;
        };
        self.axles.fill((0.0, true));
        self.weights.clear();
        let track = &operator.track;
        let vehicles = crossing.traffic.vehicles.iter().zip(&crossing.wheels.vehicles);
        for ((driven, of), placement) in vehicles.zip(&mut self.placements) {
            placement.place(track, &driven.vehicle, Heading::of(track, &driven.drive, self.time_s));
            if driven.vehicle.springs.is_some() {
                settle_axles(of, placement, &mut self.axles);
            }
        }
        for (line, of) in crossing.wheels.weights.iter().enumerate() {
            place_weights(
                (line, of),
                &self.placements[of.vehicle],
                crossing.traffic.vehicles[of.vehicle].load_n,
                &mut self.axles,
                &mut self.weights,
            );
        }
        for ride in &mut self.rides {
            ride.begin_step(self.time_s, &self.placements[ride.vehicle]); // (V4)
        }
        if !self.weights.is_empty() {
            self.unloaded = 0;
            loads.apply_weights(lane, &crossing.wheels, &self.weights);
        } else if self.unloaded < 2 || self.pressed {
            // springs of the last step stand where this one begins
            self.unloaded = if self.pressed { 0 } else { self.unloaded + 1 };
            loads.left().into_iter().for_each(|forces| forces.clear(lane));
        }
    }

    /// Connectors and moving masses together (C1): leaves their forces. Whether they settled.
    #[inline(always)]
    pub(super) fn solve(
        &mut self,
        lane: usize,
        (operator, constants, newton_limit): (&BridgeOperator, &StepConstants, usize),
        (modes, connectors, loads): (&Modes, &mut Connectors, &mut Loads),
        clock: &mut impl StepClock,
    ) -> bool {
        let Some(crossing) = &self.crossing else {
            return true;
        };
        let m = constants.c.len();
        let (wheels, compliance, masses) = (&*crossing.wheels, &*crossing.compliance, &mut self.masses);
        let load_n = |vehicle: usize| crossing.traffic.vehicles[vehicle].load_n;
        masses.place(wheels, &operator.track, load_n, &self.placements, &self.rides);
        clock.lap(StepPart::RidingMasses, || 0.0);
        if masses.count() > 0 {
            self.free.gather(lane, &modes.free, !masses.needs_motion());
            connectors.n.gather(lane, &mut self.n);
        }
        connectors.e_now.gather(lane, &mut self.contact.linear.e);
        clock.lap(StepPart::GatherAndScatter, || 0.0);
        let forces = StepForces {
            weights: &self.weights,
            masses: &self.rider_forces[..self.first_spring],
            springs: &self.rider_forces[self.first_spring..],
            n: &self.n,
        };
        masses.follow(wheels, constants, m, forces);
        masses.couple(wheels, compliance, constants, m, &self.rides, &self.free); // (V5)
        let awake = self.rides.iter().filter(|ride| ride.is_awake());
        self.contact.begin_riders(awake.flat_map(LaneRide::pressing));
        clock.lap(StepPart::RidingMasses, || masses.flop_of_coupling(m));
        let (h, weight) = (constants.scheme.h, 1.0 - constants.scheme.alpha_f);
        if let Some(dashpots) = &mut self.dashpots
            && dashpots.begin_step(lane, h, &connectors.e, &connectors.dashpots)
        {
            self.contact.forget();
        }
        if let Some(dead) = &mut self.dead {
            let (e, riders) = (&mut self.contact.linear.e, &mut masses.block);
            dead.begin_step((h, weight), &constants.connector_compliance, e, riders); // (D3)
        }
        let input = ContactInput {
            laws: self.dashpots.as_ref().map_or(&*crossing.laws, LaneDashpots::laws),
            compliance: &constants.connector_compliance,
            weight,
            riders: &masses.block,
        };
        let solved = self.contact.solve(input, newton_limit);
        clock.lap(StepPart::Contact, || self.contact.flop(masses.count(), &solved));
        match solved {
            Ok((iterations, switches)) => {
                self.unsettled = None;
                self.statistics.steps += 1;
                self.statistics.newton_iterations += iterations;
                self.statistics.contact_switches += switches;
            }
            Err(stuck) => {
                self.unsettled = Some(stuck);
                masses.unfollow();
                return false;
            }
        }
        if let Some(dead) = &self.dead {
            dead.end_step(&mut self.contact.linear.forces);
        }
        connectors.e_now.scatter(lane, &self.contact.linear.e);
        for (to, scaled) in connectors.n_now.rows_from_mut(0).zip(&self.contact.linear.forces) {
            to[lane] = scaled / weight;
        }
        if let Some(dashpots) = &mut self.dashpots {
            let Connectors {
                e,
                e_now,
                n_now,
                dashpots: given,
                rest,
                ..
            } = &mut *connectors;
            dashpots.end_step(lane, h, [e, e_now, n_now, rest], given);
        }
        clock.lap(StepPart::GatherAndScatter, || 0.0);
        self.apply_masses(lane, constants, &connectors.n_now, loads);
        clock.lap(StepPart::RidingMasses, || {
            self.masses.flop_of_leading(loads.inertia.rows())
        });
        true
    }

    /// Forces of masses and of wheels on springs, settled.
    #[inline(always)]
    fn apply_masses(&mut self, lane: usize, constants: &StepConstants, n: &LaneArray, loads: &mut Loads) {
        let (Some(crossing), masses) = (&self.crossing, &mut self.masses) else {
            return;
        };
        self.beyond_weight.fill(0.0);
        self.rider_forces.clear();
        self.first_spring = 0;
        (self.pressed, self.ridden) = (false, RideEnergies::default());
        if masses.count() == 0 {
            return;
        }
        let (wheels, scaled) = (&*crossing.wheels, &self.contact.linear.riders);
        let (compliance, links) = (&*crossing.compliance, &self.contact.linear.forces);
        masses.add_forces(compliance, constants, scaled, links, &mut self.beyond_weight);
        let s = &constants.scheme;
        masses.masses_on_nodes(scaled, 1.0 / (1.0 - s.alpha_m), &mut self.rider_forces);
        self.first_spring = self.rider_forces.len();
        loads.apply_inertia(lane, wheels, &self.rider_forces);
        if masses.wheels_on_springs() > 0 {
            self.pressed = true;
            masses.springs_on_nodes(scaled, 1.0 / (1.0 - s.alpha_f), &mut self.rider_forces);
            let (columns, seen) = (self.seen_springs.len(), &mut self.seen_springs);
            sum_forces(
                (&wheels.nodes[..], wheels.influence_width, 0),
                &self.rider_forces[self.first_spring..],
                columns,
                |from, sums| seen[from..][..sums.len()].copy_from_slice(sums),
            );
            loads.add_springs(lane, seen, spring_factor(constants));
            self.ridden = end_rides(
                masses,
                &mut self.rides,
                &self.placements,
                constants,
                (compliance, scaled, links),
            );
        }
        n.gather(lane, &mut self.n);
        let found = StepForces {
            weights: &[],
            masses: &self.rider_forces[..self.first_spring],
            springs: &self.rider_forces[self.first_spring..],
            n: &self.n,
        };
        masses.lead(wheels, constants, constants.c.len(), found);
    }

    /// Ends the step: forces of springs then weigh as weights do.
    #[inline(always)]
    pub(super) fn end_step(&mut self, lane: usize, constants: &StepConstants, loads: &mut Loads) {
        if self.pressed && self.unsettled.is_none() {
            loads.end_springs(lane, &self.seen_springs, spring_factor(constants));
        }
    }
}

/// What forces of springs are multiplied by to stand among inertia forces in the balance at alpha.
fn spring_factor(constants: &StepConstants) -> f64 {
    (1.0 - constants.scheme.alpha_f) / (1.0 - constants.scheme.alpha_m)
}

/// Takes the vehicles on springs to the step's end; their energies beside the work on the deck.
#[inline(always)]
fn end_rides(
    masses: &mut MovingMasses,
    rides: &mut [LaneRide],
    placements: &[VehiclePlacement],
    constants: &StepConstants,
    (compliance, scaled, links): (&WheelCompliance, &[f64], &[f64]),
) -> RideEnergies {
    // wheels come in the order of the vehicles that are there
    let (mut number, mut first) = (0, 0);
    masses.under_wheels(compliance, constants, scaled, links, |rider, on_deck, under| {
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
    for ride in rides.iter_mut().filter(|ride| ride.is_awake()) {
        let many = ride.wheels();
        sum = sum.and(ride.end_step(&scaled[from..][..many], &placements[ride.vehicle]));
        from += many;
    }
    sum
}

/// Whether the contact forces of the axles of a vehicle on springs have settled.
#[inline(always)]
fn settle_axles(of: &VehicleLines, placement: &VehiclePlacement, axles: &mut [(f64, bool)]) {
    for patch in &of.vehicle.patches {
        axles[of.first_axle + patch.axle].1 &= placement.tells(patch);
    }
}

/// Weights of a line's points on its stations, and on axles.
#[inline(always)]
fn place_weights(
    (line, of): (usize, &WheelLine),
    placement: &VehiclePlacement,
    load_n: f64,
    axles: &mut [(f64, bool)],
    weights: &mut Vec<StationForce>,
) {
    let own = weights.len();
    for point in &of.points {
        axles[point.axle].1 &= placement.is_settled(point.along);
        let Some(cell) = placement.cell(point.along) else {
            continue;
        };
        let w = load_n * point.share;
        axles[point.axle].0 += w * of.lines.len() as f64;
        for (station, part) in cell.shares() {
            match weights[own..].iter_mut().rev().find(|(_, s, _)| *s == station) {
                Some((_, _, sum)) => *sum += w * part,
                None => weights.push((line, station, w * part)),
            }
        }
    }
}
