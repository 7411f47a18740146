//! The dashpot of a link: in one step it stiffens the link's law and shifts where its force begins.
//!
//! Knows the elongations of the last two instants and how far the link was beyond its gap. Does not know how the link moves.
//!
//! What a dashpot gives to the balance is `c delta'`, `delta` how far the link is beyond its gap. Over a step in which the link
//! meets the gap that is the right impulse, whenever within the step that happens, and the law of the step has no jump, which
//! no active set could settle.

use super::link::{Branch, LinkLaw};
use crate::connector::{OwnLaws, State};
use std::borrow::Cow;

/// The rate at a step's end by the differences over it and over the step before (C3):
/// `x' = on_step (x_1 - x_0) - on_before (x_0 - x_b)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct BackwardRate {
    on_step: f64,
    on_before: f64,
}

impl BackwardRate {
    /// The rate for a step of length `step_s` after one of length `before_s` `[s]`, infinite where all was at rest.
    pub(crate) fn new(step_s: f64, before_s: f64) -> Self {
        let ratio = step_s / (step_s + before_s);
        Self {
            on_step: (1.0 + ratio) / step_s,
            on_before: ratio / before_s,
        }
    }

    /// The rate at the end of the step of what is x there, `x_0` before it and `x_b` one step before that.
    #[inline]
    pub(crate) fn of(&self, x: f64, [x_0, x_b]: [f64; 2]) -> f64 {
        self.on_step * (x - x_0) - self.on_before * (x_0 - x_b)
    }
}

/// A link with a dashpot.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Dashpot {
    /// Which link.
    pub link: usize,
    /// Its law at rest.
    law: LinkLaw,
    /// Coefficient in tension and in compression, both alike where both trusses are at work at once `[N s/m]`.
    damping: [f64; 2],
}

impl Dashpot {
    /// The dashpots of connectors.
    pub(crate) fn of_connectors(own: &OwnLaws) -> Vec<Self> {
        let damped = own.iter().filter(|(_, law)| law.dampings_n_s_m() != [0.0; 2]);
        let dashpot = |(link, law): &(usize, _)| Self {
            link: *link,
            law: LinkLaw::new(law),
            damping: law.dampings_n_s_m(),
        };
        damped.map(dashpot).collect()
    }

    /// The law of a step whose elongations before it and one step earlier are `past` `[m]`.
    /// Equation (C4).
    pub(crate) fn in_step(&self, rate: BackwardRate, past: [f64; 2]) -> LinkLaw {
        let mut law = self.law;
        if law.at_rest() == State::Both {
            let both = &mut law.branches[State::Both as usize];
            both.stiffness += self.damping[0] * rate.on_step;
            both.offset -= self.damping[0] * rate.of(0.0, past);
            return law;
        }
        let begins = [
            (law.tension_above_m, law.tension_stop_above_m),
            (law.compression_below_m, law.compression_stop_below_m),
        ];
        let states = [
            (1.0, [State::Tension, State::TensionStop]),
            (-1.0, [State::Compression, State::CompressionStop]),
        ];
        let of = |i: usize| (self.damping[i], states[i], begins[i]);
        (law.tension_above_m, law.tension_stop_above_m) = damped(&mut law.branches, of(0), rate, past);
        (law.compression_below_m, law.compression_stop_below_m) = damped(&mut law.branches, of(1), rate, past);
        law
    }

    /// The force of the law at elongation `e` after the `past` `[N]`: without the dashpot, and with it.
    /// Equation (J5).
    pub(crate) fn forces(&self, rate: BackwardRate, e: f64, past: [f64; 2]) -> [f64; 2] {
        let spring = self.law.force(e);
        let with = |damping: f64| spring + damping * rate.of(e, past);
        let force = match self.law.state(e) {
            State::Open => 0.0,
            State::Tension | State::TensionStop => with(self.damping[0]).max(0.0),
            State::Compression | State::CompressionStop => with(self.damping[1]).min(0.0),
            State::Both => with(self.damping[0]),
        };
        [spring, force]
    }
}

/// Stiffens and shifts the branches of one sense, whose two branches begin at `begins` and `stop`; gives the elongations
/// beyond which they hold in the step. The force begins where it would change its sign.
fn damped(
    branches: &mut [Branch],
    (damping, (sense, states), (begins, stop)): (f64, (f64, [State; 2]), (f64, f64)),
    rate: BackwardRate,
    past: [f64; 2],
) -> (f64, f64) {
    if damping == 0.0 {
        return (begins, stop);
    }
    let beyond = past.map(|e| (sense * (e - begins)).max(0.0));
    let stiffer = damping * rate.on_step;
    // a link that is leaving its gap does not push for how fast it left
    let less = (-damping * rate.of(0.0, beyond)).max(0.0);
    let [first, last] = states.map(|state| {
        let branch = &mut branches[state as usize];
        if branch.stiffness > 0.0 {
            branch.stiffness += stiffer;
            branch.offset += stiffer * begins + sense * less;
        }
        *branch
    });
    let starts = begins + sense * less / first.stiffness;
    if sense * starts <= sense * stop {
        return (starts, stop);
    }
    let starts = last.offset / last.stiffness;
    (starts, starts)
}

/// What the dashpots of a motion carry from step to step; nothing where there are none.
#[derive(Debug, Clone, Default)]
pub(crate) struct DashpotTrail {
    /// Elongations one step before `[m]`, and the length of that step `[s]`; none at rest.
    before: Option<(Vec<f64>, f64)>,
    /// What the dashpots give of the forces in the balance `[N]`.
    pub in_balance: Vec<f64>,
    /// The forces by the law `[N]`.
    by_law: Vec<f64>,
}

impl DashpotTrail {
    /// The laws of a step of length `step_s` `[s]` from elongations `e` on.
    pub(crate) fn laws<'l>(
        &self,
        dashpots: &[Dashpot],
        laws: &'l [LinkLaw],
        e: &[f64],
        step_s: f64,
    ) -> Cow<'l, [LinkLaw]> {
        let mut of_step = Cow::Borrowed(laws);
        for dashpot in dashpots {
            of_step.to_mut()[dashpot.link] = dashpot.in_step(self.rate(step_s), self.past(dashpot.link, e));
        }
        of_step
    }

    /// The trail behind a step from elongations `e` to those `now`, at whose end the balance has the `forces`.
    pub(crate) fn follow(&self, dashpots: &[Dashpot], [e, now]: [&[f64]; 2], forces: &[f64], step_s: f64) -> Self {
        if dashpots.is_empty() {
            return Self::default();
        }
        let mut trail = Self {
            before: Some((e.to_vec(), step_s)),
            in_balance: vec![0.0; forces.len()],
            by_law: forces.to_vec(),
        };
        for dashpot in dashpots {
            let i = dashpot.link;
            let [spring, force] = dashpot.forces(self.rate(step_s), now[i], self.past(i, e));
            trail.in_balance[i] = forces[i] - spring;
            trail.by_law[i] = force;
        }
        trail
    }

    /// The forces by the law, which are those of the balance but for dashpots in the steps that meet a gap `[N]`.
    pub(crate) fn by_law<'a>(&'a self, in_balance: &'a [f64]) -> &'a [f64] {
        if self.by_law.is_empty() {
            in_balance
        } else {
            &self.by_law
        }
    }

    fn rate(&self, step_s: f64) -> BackwardRate {
        BackwardRate::new(
            step_s,
            self.before.as_ref().map_or(f64::INFINITY, |(_, before_s)| *before_s),
        )
    }

    fn past(&self, link: usize, e: &[f64]) -> [f64; 2] {
        [
            e[link],
            self.before.as_ref().map_or(e[link], |(before, _)| before[link]),
        ]
    }
}
