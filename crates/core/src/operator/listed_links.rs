//! The links that are active in any of some lanes, with the branch that each lane is on.
//!
//! Knows states and laws of links, and what changes with them. Does not know how forces are found.

use super::lane_array::LaneArray;
use super::state_bounds::are_same;
use crate::connector::State;
use crate::contact::{Branch, LinkLaw};

/// The links of some lanes as they were listed last.
#[derive(Debug)]
pub(super) struct ListedLinks {
    /// Links that are active in any lane.
    pub(super) active: Vec<usize>,
    /// Of each link in which lanes it is active, what its branch adds to the diagonal, and its stiffness, offset and the elongation
    /// where its force would be 0; of lanes that leave it out numbers that change nothing.
    pub(super) is_active: LaneArray,
    pub(super) own: LaneArray,
    pub(super) stiffness: LaneArray,
    pub(super) offset: LaneArray,
    pub(super) begins: LaneArray,
    /// The lanes and the states of their links.
    lanes: Vec<usize>,
    states: Vec<State>,
    /// In how many of these lanes each link is active.
    count: Vec<usize>,
    /// Whether laws may be others than they were.
    is_stale: bool,
    /// Whether any of these lanes has a link open that another has not.
    pub(super) any_left_out: bool,
}

impl ListedLinks {
    /// No lanes yet.
    pub(super) fn new(links: usize, lanes: usize) -> Self {
        let of = || LaneArray::new(links, lanes);
        Self {
            active: Vec::with_capacity(links),
            is_active: of(),
            own: of(),
            stiffness: of(),
            offset: of(),
            begins: of(),
            lanes: Vec::with_capacity(lanes),
            states: Vec::with_capacity(lanes * links),
            count: vec![0; links],
            is_stale: true,
            any_left_out: false,
        }
    }

    /// Laws may be others from now on.
    #[inline(always)]
    pub(super) fn forget_laws(&mut self) {
        self.is_stale = true;
    }

    /// Forgets the lanes.
    pub(super) fn forget(&mut self) {
        self.lanes.clear();
    }

    /// Takes the states that lanes have now; whether they are others than before. `weight` is that of the new force in the balance.
    #[inline(always)]
    pub(super) fn take<'s>(
        &mut self,
        (lanes, laws): (&[usize], &[&[LinkLaw]]),
        states: impl Fn(usize) -> &'s [State],
        weight: f64,
    ) -> bool {
        let is_new = self.lanes != lanes;
        if is_new {
            self.begin(lanes);
        }
        let (links, mut changed) = (self.count.len(), is_new);
        for (number, (&lane, laws)) in lanes.iter().zip(laws).enumerate() {
            let (from, now) = (number * links, &states(lane)[..links]);
            if !self.is_stale && are_same(&self.states[from..][..links], now) {
                continue;
            }
            for (i, &state) in now.iter().enumerate() {
                let before = self.states[from + i];
                if before == state && !self.is_stale {
                    continue;
                }
                changed |= before != state;
                self.count[i] += usize::from(state != State::Open);
                self.count[i] -= usize::from(before != State::Open);
                self.states[from + i] = state;
                self.put((i, lane), &laws[i], state, weight);
            }
        }
        self.is_stale = false;
        if changed {
            self.active.clear();
            self.any_left_out = false;
            for (i, &count) in self.count.iter().enumerate() {
                if count > 0 {
                    self.active.push(i);
                    self.any_left_out |= count < lanes.len();
                }
            }
        }
        changed
    }

    /// Begins with other lanes, all of whose links are open.
    fn begin(&mut self, lanes: &[usize]) {
        let links = self.count.len();
        self.lanes.clear();
        self.lanes.extend(lanes);
        self.states.clear();
        self.states.resize(lanes.len() * links, State::Open);
        self.count.fill(0);
        self.is_stale = true;
        for i in 0..links {
            self.is_active.row_mut(i).fill(0.0);
            self.own.row_mut(i).fill(1.0);
            self.stiffness.row_mut(i).fill(1.0);
            self.offset.row_mut(i).fill(0.0);
            self.begins.row_mut(i).fill(0.0);
        }
    }

    /// Puts the state of a link in a lane.
    fn put(&mut self, (link, lane): (usize, usize), law: &LinkLaw, state: State, weight: f64) {
        let is_open = state == State::Open;
        let Branch { stiffness, offset } = if is_open {
            Branch {
                stiffness: 1.0,
                offset: 0.0,
            }
        } else {
            law.branch(state)
        };
        *self.is_active.at_mut(link, lane) = if is_open { 0.0 } else { 1.0 };
        *self.own.at_mut(link, lane) = if is_open { 1.0 } else { 1.0 / (weight * stiffness) };
        *self.stiffness.at_mut(link, lane) = stiffness;
        *self.offset.at_mut(link, lane) = offset;
        *self.begins.at_mut(link, lane) = offset / stiffness;
    }
}
