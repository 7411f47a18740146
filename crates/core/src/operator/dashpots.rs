//! Dashpots of connectors: the laws of a lane's step, and what dashpots give in every lane.
//!
//! Knows what a step needs of the elongations before it. Does not know how contact is settled. Where no lane has a dashpot
//! nothing here is done in a step.

use super::basis::Sizes;
use super::lane_array::LaneArray;
use crate::contact::{BackwardRate, Dashpot, LinkLaw};
use std::sync::Arc;

/// The dashpots of one lane.
#[derive(Debug)]
pub(super) struct LaneDashpots {
    dashpots: Arc<[Dashpot]>,
    /// The laws of the step under way.
    laws: Vec<LinkLaw>,
    /// Length of the last step `[s]`, infinite at rest.
    pub(super) before_s: f64,
    /// The rate of the step under way; none before the first.
    rate: Option<BackwardRate>,
}

/// What the dashpots of all lanes give.
#[derive(Debug, Clone)]
pub(super) struct DashpotForces {
    /// Lanes that have dashpots, and whether any has.
    lanes: Vec<bool>,
    pub(super) any: bool,
    /// Elongations one step before the last `[m]`.
    pub(super) before: LaneArray,
    /// What they give of the forces in the balance `[N]`, at the last step and at the one under way.
    pub(super) part: LaneArray,
    pub(super) part_now: LaneArray,
    /// By how much the forces in the balance of the step under way are above those of the law `[N]`.
    pub(super) above_law: LaneArray,
    /// At the step's end, the forces of all connectors by their laws and without dashpots `[N]`.
    pub(super) by_law: LaneArray,
    pub(super) springs: LaneArray,
}

impl LaneDashpots {
    /// The dashpots of a crossing at rest, whose connectors have the laws given; none where it has none.
    pub(super) fn new(dashpots: &Arc<[Dashpot]>, laws: &[LinkLaw]) -> Option<Self> {
        let of_lane = || Self {
            dashpots: Arc::clone(dashpots),
            laws: laws.to_vec(),
            before_s: f64::INFINITY,
            rate: None,
        };
        (!dashpots.is_empty()).then(of_lane)
    }

    /// Changes to the laws of a step of length `step_s` `[s]` (C4); whether their stiffnesses are others than before.
    pub(super) fn begin_step(&mut self, lane: usize, step_s: f64, e: &LaneArray, forces: &DashpotForces) -> bool {
        let rate = BackwardRate::new(step_s, self.before_s);
        for dashpot in &*self.dashpots {
            self.laws[dashpot.link] = dashpot.in_step(rate, past(dashpot, lane, e, forces));
        }
        self.rate.replace(rate) != Some(rate)
    }

    /// The laws of the step under way.
    pub(super) fn laws(&self) -> &[LinkLaw] {
        &self.laws
    }

    /// Leaves what they give in the step under way, whose balance has the forces `n_now` beyond those at rest at the elongations
    /// `e_now`.
    pub(super) fn end_step(
        &mut self,
        lane: usize,
        step_s: f64,
        [e, e_now, n_now, rest]: [&LaneArray; 4],
        forces: &mut DashpotForces,
    ) {
        self.before_s = step_s;
        let Some(rate) = self.rate else { return };
        for dashpot in &*self.dashpots {
            let i = dashpot.link;
            let [spring, by_law] = dashpot.forces(rate, e_now.at(i, lane), past(dashpot, lane, e, forces));
            let force = n_now.at(i, lane) + rest.at(i, lane);
            *forces.part_now.at_mut(i, lane) = force - spring;
            *forces.above_law.at_mut(i, lane) = force - by_law;
        }
    }
}

/// The elongations of a link before the step and one step earlier.
fn past(dashpot: &Dashpot, lane: usize, e: &LaneArray, forces: &DashpotForces) -> [f64; 2] {
    [e, &forces.before].map(|of| of.at(dashpot.link, lane))
}

impl DashpotForces {
    pub(super) fn new(sizes: &Sizes, lanes: usize) -> Self {
        let zeros = || LaneArray::new(sizes.connectors, lanes);
        Self {
            lanes: vec![false; lanes],
            any: false,
            before: zeros(),
            part: zeros(),
            part_now: zeros(),
            above_law: zeros(),
            by_law: zeros(),
            springs: zeros(),
        }
    }

    /// Takes note of whether a lane has dashpots.
    pub(super) fn take(&mut self, lane: usize, has: bool) {
        self.lanes[lane] = has;
        self.any = self.lanes.contains(&true);
    }
}
