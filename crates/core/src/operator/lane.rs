//! One crossing in its lane: its vehicle, law and speed, and what it has beside the numbers of all lanes.
//!
//! Knows where the vehicle is and how its contact is solved. Does not know the lanes beside it.

use super::basis::BridgeOperator;
use super::clock::{StepClock, StepPart};
use super::connectors::Connectors;
use super::contact_system::{ContactInput, ContactSystem};
use super::dashpots::LaneDashpots;
use super::dead::LaneDead;
use super::lane_array::LaneArray;
use super::loads::{Loads, StationForce};
use super::local_residual::StepForces;
use super::modes::Modes;
use super::moving_masses::{FreeMotion, MovingMasses};
use super::step_constants::StepConstants;
use super::wheel_lines::{WheelCompliance, WheelLine, WheelLines};
use crate::bridge::{VehiclePlacement, front_x_m};
use crate::contact::{Dashpot, LinkLaw, NotSettled};
use crate::response::{DeadState, Statistics};
use std::sync::Arc;

/// One crossing as its lane knows it.
#[derive(Debug, Clone)]
pub(crate) struct CrossingInput {
    /// The vehicle on the deck.
    pub wheels: Arc<WheelLines>,
    /// Its small compliances at the step length.
    pub compliance: Arc<WheelCompliance>,
    /// The law of each connector.
    pub laws: Arc<[LinkLaw]>,
    /// The connectors that have dashpots.
    pub dashpots: Arc<[Dashpot]>,
    /// Weight of the vehicle `[N]`.
    pub load_n: f64,
    /// Speed `[m/s]`.
    pub speed_m_s: f64,
    /// The state at rest from which it starts, where the bridge has a dead load.
    pub dead: Option<Arc<DeadState>>,
}

/// What a lane has beside its numbers.
#[derive(Debug)]
pub(super) struct Lane {
    pub(super) crossing: Option<CrossingInput>,
    /// Time at the end of the step under way `[s]`, and where the vehicle is then.
    pub(super) time_s: f64,
    placement: VehiclePlacement,
    pub(super) contact: ContactSystem,
    pub(super) dashpots: Option<LaneDashpots>,
    pub(super) dead: Option<LaneDead>,
    pub(super) masses: MovingMasses,
    /// Weight on each axle that is on the bridge `[N]`, and whether the contact force of all its points has settled.
    pub(super) axles: Vec<(f64, bool)>,
    pub(super) inertia: Vec<f64>,
    /// Downward forces on stations of the lines of the weights, then of the masses.
    pub(super) weights: Vec<StationForce>,
    pub(super) mass_forces: Vec<StationForce>,
    /// Steps since the vehicle left, up to two: by then all traces of its load are zero.
    pub(super) unloaded: u8,
    pub(super) statistics: Statistics,
    pub(super) unsettled: Option<NotSettled>,
    /// Free motion of the modes at the step's end, and connector forces, of this lane alone.
    free: FreeMotion,
    n: Vec<f64>,
}

impl Lane {
    /// A free lane, with room for vehicles of at most `most_nodes` nodes.
    pub(super) fn new(modes: usize, connectors: usize, most_nodes: usize, newton_limit: usize) -> Self {
        Self {
            crossing: None,
            time_s: 0.0,
            placement: VehiclePlacement::default(),
            contact: ContactSystem::new(connectors, most_nodes, newton_limit),
            dashpots: None,
            dead: None,
            masses: MovingMasses::new(connectors, most_nodes),
            axles: Vec::new(),
            inertia: Vec::new(),
            weights: Vec::with_capacity(most_nodes),
            mass_forces: Vec::with_capacity(most_nodes),
            unloaded: 0,
            statistics: Statistics::default(),
            unsettled: None,
            free: FreeMotion::new(modes),
            n: vec![0.0; connectors],
        }
    }

    /// Takes up a crossing, without forces on the deck.
    pub(super) fn take(&mut self, crossing: CrossingInput) {
        let axles = crossing.wheels.vehicle.axles;
        self.axles = vec![(0.0, true); axles];
        self.inertia = vec![0.0; axles];
        self.dashpots = LaneDashpots::new(&crossing.dashpots, &crossing.laws);
        self.dead = crossing.dead.as_ref().map(LaneDead::new);
        self.crossing = Some(crossing);
    }

    /// Says where the vehicle is at the end of the coming step.
    pub(super) fn place(&mut self, time_s: f64) {
        self.time_s = time_s;
    }

    /// Whether the vehicle has masses that ride along.
    #[inline(always)]
    pub(super) fn has_masses(&self) -> bool {
        self.crossing.as_ref().is_some_and(|c| !c.wheels.masses.is_empty())
    }

    /// Puts the weights where the vehicle is at the end of the step (V1).
    #[inline(always)]
    pub(super) fn place_loads(&mut self, lane: usize, operator: &BridgeOperator, loads: &mut Loads) {
        let Some(crossing) = &self.crossing else {
            return;
        };
        let front_x_m = front_x_m(&operator.track, crossing.speed_m_s, self.time_s);
        self.placement
            .place(&operator.track, &crossing.wheels.vehicle, front_x_m, crossing.speed_m_s);
        self.axles.fill((0.0, true));
        self.weights.clear();
        for (line, of) in crossing.wheels.weights.iter().enumerate() {
            place_weights(
                (line, of),
                &self.placement,
                crossing.load_n,
                &mut self.axles,
                &mut self.weights,
            );
        }
        if !self.weights.is_empty() {
            self.unloaded = 0;
            loads.apply_weights(lane, &crossing.wheels, &self.weights);
        } else if self.unloaded < 2 {
            self.unloaded += 1;
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
        masses.place(wheels, &operator.track, crossing.load_n, &self.placement);
        clock.lap(StepPart::RidingMasses, || 0.0);
        if masses.count() > 0 {
            self.free.gather(lane, &modes.free, masses.block.symmetric());
            connectors.n.gather(lane, &mut self.n);
        }
        connectors.e_now.gather(lane, &mut self.contact.linear.e);
        clock.lap(StepPart::GatherAndScatter, || 0.0);
        let forces = StepForces {
            weights: &self.weights,
            masses: &self.mass_forces,
            n: &self.n,
        };
        masses.follow(wheels, constants, m, forces);
        masses.couple(wheels, compliance, constants, m, crossing.speed_m_s, &self.free);
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

    /// Inertia forces of the masses, forces settled.
    #[inline(always)]
    fn apply_masses(&mut self, lane: usize, constants: &StepConstants, n: &LaneArray, loads: &mut Loads) {
        let (Some(crossing), masses) = (&self.crossing, &mut self.masses) else {
            return;
        };
        self.inertia.fill(0.0);
        self.mass_forces.clear();
        if masses.count() == 0 {
            return;
        }
        let (wheels, scaled) = (&*crossing.wheels, &self.contact.linear.riders);
        masses.add_inertia(
            &crossing.compliance,
            constants,
            scaled,
            &self.contact.linear.forces,
            &mut self.inertia,
        );
        let unscale = 1.0 / (1.0 - constants.scheme.alpha_m);
        masses.on_nodes(scaled, unscale, &mut self.mass_forces);
        loads.apply_inertia(lane, wheels, &self.mass_forces);
        n.gather(lane, &mut self.n);
        masses.lead(wheels, constants, constants.c.len(), &self.mass_forces, &self.n);
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
