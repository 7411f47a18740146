//! One crossing in its lane: its traffic and laws, and what it has beside the numbers of all lanes.
//!
//! Knows how one crossing is begun and how its vehicles are heading. Does not know the lanes beside it.

use super::basis::Sizes;
use super::dashpots::LaneDashpots;
use super::dead::LaneDead;
use super::deck_forces::StationForce;
use super::rides::LaneRide;
use super::wheel_lines::{WheelCompliance, WheelLines};
use crate::bridge::{Heading, Track};
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
    /// Whether the corners of the decks are asked for after every step.
    pub asks_for_corners: bool,
}

/// What a lane has beside its numbers.
#[derive(Debug)]
pub(super) struct Lane {
    pub(super) crossing: Option<CrossingInput>,
    /// Time at the end of the step under way `[s]`, how the vehicles are heading then, and the group of lanes that it goes with.
    pub(super) time_s: f64,
    pub(super) headings: Vec<Heading>,
    pub(super) group: usize,
    pub(super) dashpots: Option<LaneDashpots>,
    pub(super) dead: Option<LaneDead>,
    pub(super) rides: Vec<LaneRide>,
    /// Downward forces of masses, then of wheels on springs, on nodes at the end of the step.
    pub(super) rider_forces: Vec<StationForce>,
    /// The first of those of wheels on springs.
    pub(super) first_spring: usize,
    /// What the rows see of the springs, and whether there are any in the step under way.
    pub(super) seen_springs: Vec<f64>,
    pub(super) pressed: bool,
    /// Scaled forces of the wheels of one vehicle `[N]`.
    pub(super) wheel_forces: Vec<f64>,
    /// Energies of vehicles on springs over the step.
    pub(super) ridden: RideEnergies,
    /// Steps since the vehicles left, up to two: by then all traces of its load are zero.
    pub(super) unloaded: u8,
    pub(super) statistics: Statistics,
    pub(super) unsettled: Option<NotSettled>,
}

impl Lane {
    /// A free lane, with room for vehicles of at most `most_nodes` nodes.
    pub(super) fn new(sizes: &Sizes, most_nodes: usize) -> Self {
        Self {
            crossing: None,
            time_s: 0.0,
            headings: Vec::new(),
            group: 0,
            dashpots: None,
            dead: None,
            rides: Vec::new(),
            rider_forces: Vec::with_capacity(most_nodes),
            first_spring: 0,
            seen_springs: vec![0.0; sizes.followed()],
            pressed: false,
            wheel_forces: Vec::new(),
            ridden: RideEnergies::default(),
            unloaded: 0,
            statistics: Statistics::default(),
            unsettled: None,
        }
    }

    /// Takes up a crossing, without forces on the deck.
    pub(super) fn take(&mut self, crossing: CrossingInput, length_m: f64) {
        self.headings = vec![Heading::default(); crossing.traffic.vehicles.len()];
        self.rides = LaneRide::all(&crossing.traffic, &crossing.riding, length_m);
        self.leave();
        self.unsettled = None;
        self.dashpots = LaneDashpots::new(&crossing.dashpots, &crossing.laws);
        self.dead = crossing.dead.as_ref().map(LaneDead::new);
        self.crossing = Some(crossing);
    }

    /// No vehicle on springs has moved in the last step.
    pub(super) fn leave(&mut self) {
        (self.pressed, self.ridden) = (false, RideEnergies::default());
    }

    /// Nothing rides along.
    pub(super) fn clear_riders(&mut self) {
        self.rider_forces.clear();
        self.first_spring = 0;
    }

    /// Says when the coming step ends.
    pub(super) fn place(&mut self, time_s: f64) {
        self.time_s = time_s;
    }

    /// Whether the corners of the decks are asked for after every step.
    #[inline(always)]
    pub(super) fn asks_for_corners(&self) -> bool {
        self.crossing.as_ref().is_some_and(|of| of.asks_for_corners)
    }

    /// The laws of its links in the step under way; none where nothing crosses.
    #[inline(always)]
    pub(super) fn laws(&self) -> Option<&[LinkLaw]> {
        let crossing = self.crossing.as_ref()?;
        Some(self.dashpots.as_ref().map_or(&crossing.laws[..], LaneDashpots::laws))
    }

    /// Whether anything rides along.
    #[inline(always)]
    pub(super) fn has_masses(&self) -> bool {
        self.crossing.as_ref().is_some_and(|c| !c.wheels.nodes.is_empty())
    }

    /// Finds how the vehicles are heading at the end of the coming step; whether there is a crossing.
    #[inline(always)]
    pub(super) fn head(&mut self, track: &Track) -> bool {
        let Some(crossing) = &self.crossing else {
            return false;
        };
        for (driven, heading) in crossing.traffic.vehicles.iter().zip(&mut self.headings) {
            *heading = Heading::of(track, &driven.drive, self.time_s);
        }
        for ride in &mut self.rides {
            ride.wake(self.time_s);
        }
        true
    }

    /// Whether another lane's vehicles see the deck from the same places, and its riders pressed on the same places before.
    #[inline(always)]
    pub(super) fn goes_with(&self, other: &Self) -> bool {
        let (Some(own), Some(others)) = (&self.crossing, &other.crossing) else {
            return false;
        };
        let stations = |of: &Self| (of.rider_forces.len(), of.first_spring);
        let same_stations = || {
            let pairs = self.rider_forces.iter().zip(&other.rider_forces);
            stations(self) == stations(other) && pairs.into_iter().all(|(a, b)| (a.0, a.1) == (b.0, b.1))
        };
        let awake = |of: &Self| {
            of.rides
                .iter()
                .fold(0_u64, |bits, ride| bits << 1 | u64::from(ride.is_awake()))
        };
        Arc::ptr_eq(&own.wheels, &others.wheels)
            && Arc::ptr_eq(&own.compliance, &others.compliance)
            && alike(&self.headings, &other.headings)
            && self.rides.len() <= 64
            && awake(self) == awake(other)
            && same_stations()
    }
}

/// Whether vehicles are at the same places and move there alike.
fn alike(a: &[Heading], b: &[Heading]) -> bool {
    let bits = |of: &Heading| {
        (
            of.front_x_m.to_bits(),
            of.speed_m_s.to_bits(),
            of.acceleration_m_s2.to_bits(),
            of.backward,
        )
    };
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| bits(a) == bits(b))
}
