//! The dashpot of a link: in one step it stiffens the link's law and shifts where its force begins.
//!
//! Knows the elongations of the last two instants and how far the link was beyond its gap. Does not know how the link moves.
//!
//! What a dashpot gives to the balance is `c delta'`, `delta` how far the link is beyond its gap. Over a step in which the link
//! meets the gap that is the right impulse, whenever within the step that happens, and the law of the step has no jump, which
//! no active set could settle.

use super::link::{Branch, LinkLaw};
use crate::connector::{OwnLaws, State};
use crate::response::DeadState;
use std::borrow::Cow;

/// The rate at a step's end by the differences over it and over the step before (C3):
/// `x' = on_step (x_1 - x_0) - on_before (x_0 - x_b)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct BackwardRate {
    per_step: f64,
    on_step: f64,
    on_before: f64,
}

impl BackwardRate {
    /// The rate for a step of length `step_s` after one of length `before_s` `[s]`, infinite where all was at rest.
    pub(crate) fn new(step_s: f64, before_s: f64) -> Self {
        let ratio = step_s / (step_s + before_s);
        Self {
            per_step: 1.0 / step_s,
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
    /// The dashpots of connectors whose elongations count from a dead state on.
    pub(crate) fn of_connectors(own: &OwnLaws, dead: Option<&DeadState>) -> Vec<Self> {
        let damped = own.iter().filter(|(_, law)| law.dampings_n_s_m() != [0.0; 2]);
        let dashpot = |(link, law): &(usize, _)| Self {
            link: *link,
            law: LinkLaw::new(law).counted_from(dead.map_or(0.0, |dead| dead.elongations_m[*link])),
            damping: law.dampings_n_s_m(),
        };
        damped.map(dashpot).collect()
    }

    /// Whether another link has the same law and dashpot.
    pub(crate) fn is_like(&self, other: &Self) -> bool {
        (&self.law, self.damping) == (&other.law, other.damping)
    }

    /// As the dashpot of another link.
    pub(crate) fn at(&self, link: usize) -> Self {
        Self { link, ..self.clone() }
    }

    /// That of two such links side by side.
    #[must_use]
    pub(crate) fn doubled(self) -> Self {
        Self {
            law: self.law.doubled(),
            damping: self.damping.map(|c| 2.0 * c),
            ..self
        }
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

    /// The force at elongation `e` after the `past` `[N]`: of the law without the dashpot, and with it. In the two steps from a gap
    /// on, where the rate may have jumped, the rate is that of a step's mean.
    /// Equation (J5).
    pub(crate) fn forces(&self, rate: BackwardRate, e: f64, past: [f64; 2]) -> [f64; 2] {
        let spring = self.law.force(e);
        let [pulls, pushes] = self.damping;
        let beyond = |sense: f64, gap: f64| {
            let [now, x_0, x_b] = [e, past[0], past[1]].map(|e| (sense * (e - gap)).max(0.0));
            if x_b > 0.0 && x_0 > 0.0 {
                sense * rate.of(now, [x_0, x_b])
            } else {
                sense * rate.per_step * (now - x_0)
            }
        };
        let force = match self.law.state(e) {
            State::Open => 0.0,
            State::Tension | State::TensionStop => {
                let rate = beyond(1.0, self.law.tension_above_m);
                (spring + pulls * rate).max(0.0)
            }
            State::Compression | State::CompressionStop => {
                let rate = beyond(-1.0, self.law.compression_below_m);
                (spring + pushes * rate).min(0.0)
            }
            State::Both => spring + pulls * rate.of(e, past),
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

#[cfg(test)]
mod tests {
    use super::{BackwardRate, Dashpot};
    use crate::connector::{ConnectorLaw, EndStop, OwnLaws, Truss};

    const C: f64 = 3.0e5;

    /// A tension truss without dashpot and a compression truss with one: 2e6 N/m from 5 mm on, 5e7 N/m from 15 mm on.
    fn buffer(damping_n_s_m: f64) -> Dashpot {
        let truss = |damping_n_s_m, stop| Truss {
            stiffness_n_m: 2e6,
            gap_m: 0.005,
            damping_n_s_m,
            stop,
        };
        let stop = EndStop {
            stiffness_n_m: 5e7,
            gap_m: 0.015,
        };
        let law = ConnectorLaw::Gaps {
            tension: truss(0.0, None),
            compression: truss(damping_n_s_m, Some(stop)),
        };
        let own: OwnLaws = [(0, law)].into();
        Dashpot::of_connectors(&own, None).remove(0)
    }

    /// A link that shortens at 0.2 m/s into its buffer and stop: the force by the law is that of the place and the rate from the
    /// second step on and below it in the first, and the forces in the balance have the impulse `c delta` beside that of the
    /// trusses (trapezoidal sums, exact to rounding). A coefficient that is 5 % off is found.
    #[test]
    fn impulse_is_right_wherever_in_a_step_the_gap_is_met() {
        for damping in [C, 1.05 * C] {
            let dashpot = buffer(damping);
            for begins in [0.0, 0.3, 0.7, 0.999] {
                let (v, h) = (-0.2, 0.002);
                let e = |i: i32| -0.005 + v * h * (f64::from(i) - begins);
                let (mut impulse, mut last) = (0.0, 0.0);
                for i in -3..30 {
                    let (rate, past) = (BackwardRate::new(h, h), [e(i), e(i - 1)]);
                    let now = e(i + 1);
                    let [spring, force] = dashpot.forces(rate, now, past);
                    let of_rate = if past[0] < -0.005 {
                        damping * v
                    } else {
                        damping * (now + 0.005).min(0.0) / h
                    };
                    assert!((force - spring - of_rate).abs() < 1e-7, "{force} N at {now} m");
                    let in_balance = dashpot.in_step(rate, past).force(now) - spring;
                    impulse += 0.5 * h * (last + in_balance);
                    last = in_balance;
                }
                let off = impulse - C * (e(30) + 0.005);
                assert_eq!(off.abs() < 1e-9 * C, damping == C, "{off} N s");
            }
        }
        let rate = BackwardRate::new(0.002, 0.001);
        let [x_1, x_0, x_b] = [5.0, 3.0, 2.0].map(|t: f64| 4.0 * t * t - t);
        assert!(
            (rate.of(x_1, [x_0, x_b]) - 1000.0 * (8.0 * 5.0 - 1.0)).abs() < 1e-8,
            "exact of a parabola"
        );
    }

    /// Whatever the link did before, the force of a step nowhere falls with elongation nor jumps, has one sign in a sense and
    /// is none between the gaps: the step has one solution.
    #[test]
    fn law_of_a_step_neither_falls_nor_jumps() {
        let dashpot = buffer(C);
        let places = [-0.03, -0.016, -0.014, -0.006, -0.0049, 0.0, 0.004, 0.006];
        for before in places {
            for last in places {
                for rate in [(0.01, f64::INFINITY), (0.01, 0.01), (0.01, 0.005), (0.005, 0.01)] {
                    let law = dashpot.in_step(BackwardRate::new(rate.0, rate.1), [last, before]);
                    let force = |i: i32| law.force(-0.04 + 1e-6 * f64::from(i));
                    let steepest = 1e-6 * (5e7 + 2.0 * C / 0.005) + 1e-6;
                    for i in 0..50_000 {
                        let rise = force(i + 1) - force(i);
                        assert!(
                            (-1e-6..steepest).contains(&rise),
                            "{last} {before} {rate:?}: {rise} N at {i}"
                        );
                    }
                    assert!(law.force(-0.0049) == 0.0 && law.force(0.0049) == 0.0 && force(0) <= 0.0);
                }
            }
        }
    }
}
