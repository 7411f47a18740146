//! The elongations between which the links of every lane stay in their states.
//!
//! Knows the states that it was told last. Does not know what happens where a link leaves its state.

use super::lane_array::LaneArray;
use super::panel::{MOST_LANES, lanes_mut};
use super::vector::Ops;
use crate::connector::State;
use crate::contact::LinkLaw;
use crate::scheme::Arithmetic;
use pulp::Simd;

/// Bounds of the elongations of all links.
#[derive(Debug)]
pub(super) struct StateBounds {
    /// Elongations strictly between which a link stays in its state `[m]`.
    least: LaneArray,
    most: LaneArray,
    /// The states, lane after lane, and of which lanes they are known.
    states: Vec<State>,
    is_known: Vec<bool>,
}

impl StateBounds {
    /// Of links whose states nobody knows yet.
    pub(super) fn new(links: usize, lanes: usize) -> Self {
        Self {
            least: LaneArray::new(links, lanes),
            most: LaneArray::new(links, lanes),
            states: vec![State::Open; links * lanes],
            is_known: vec![false; lanes],
        }
    }

    /// Laws may be others from now on.
    pub(super) fn forget(&mut self) {
        self.is_known.fill(false);
    }

    /// Takes the states of a lane's links.
    #[inline(always)]
    pub(super) fn take(&mut self, lane: usize, states: &[State], laws: &[LinkLaw]) {
        let links = self.least.rows();
        let (known, states) = (&mut self.states[lane * links..][..links], &states[..links]);
        if self.is_known[lane] && are_same(known, states) {
            return;
        }
        for i in 0..links {
            if self.is_known[lane] && known[i] == states[i] {
                continue;
            }
            known[i] = states[i];
            [*self.least.at_mut(i, lane), *self.most.at_mut(i, lane)] = laws[i].within_m(states[i]);
        }
        self.is_known[lane] = true;
    }

    /// The lanes in which all links stay well within their states at some elongations; in others they may stay as well.
    #[inline(always)]
    pub(super) fn staying<S: Simd>(&self, o: Ops<S>, elongation: &LaneArray) -> [f64; MOST_LANES] {
        let (least, most) = (self.least.vectors::<S>(), self.most.vectors::<S>());
        let (e, most) = (&elongation.vectors::<S>()[..least.len()], &most[..least.len()]);
        let (mut staying, none) = (o.splat(1.0), o.splat(0.0));
        for i in 0..least.len() {
            let inside =
                o.0.and_m64s(o.0.less_than_f64s(least[i], e[i]), o.0.less_than_f64s(e[i], most[i]));
            staying = o.0.select_f64s(inside, staying, none);
        }
        let mut lanes = [0.0; MOST_LANES];
        lanes_mut::<S>(&mut lanes)[0] = staying;
        lanes
    }
}

/// Whether links have the same states: all are looked at side by side, as most of them are.
#[inline(always)]
pub(super) fn are_same(states: &[State], others: &[State]) -> bool {
    let differ = |differ: u8, (a, b): (&State, &State)| differ | (*a as u8 ^ *b as u8);
    states.iter().zip(others).fold(0, differ) == 0
}
