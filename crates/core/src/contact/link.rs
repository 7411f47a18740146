//! A link: a row of the contact problem with a piecewise-linear law of its own.
//!
//! Knows force against elongation. Does not know what the link joins or where the elongation comes from.

use crate::connector::{Connection, ConnectorLaw, OwnLaws, State, Truss};
use crate::response::DeadState;

/// A branch `N = k e - n0` of a law.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Branch {
    /// Stiffness k `[N/m]`.
    pub stiffness: f64,
    /// Offset n0 `[N]`.
    pub offset: f64,
}

impl Branch {
    /// The force at elongation `e` `[N]`.
    #[inline]
    pub(crate) fn force(&self, e: f64) -> f64 {
        self.stiffness * e - self.offset
    }
}

/// The law of one link: up to two branches in tension, as many in compression, and what holds between them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LinkLaw {
    /// Elongation beyond which the first and the second branch of each sense work `[m]`; infinite where there is none.
    pub(super) tension_above_m: f64,
    pub(super) tension_stop_above_m: f64,
    pub(super) compression_below_m: f64,
    pub(super) compression_stop_below_m: f64,
    /// The state between them.
    between: State,
    /// The branch of each state.
    pub(super) branches: [Branch; State::COUNT],
    /// Links that it stands for, side by side.
    pub(crate) links: usize,
}

/// How a link takes up energy in one sense: `N^2 / 2 k` of its last branch, and of a buffer before that
/// `min(N, N_1)^2 / 2 (1/k_1 - 1/k)` beside it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Uptake {
    /// Stiffness k of the last branch `[N/m]`; 0 where there is none.
    pub stiffness: f64,
    /// `1/k_1 - 1/k`, by which the buffer is softer `[m/N]`.
    pub softer: f64,
    /// Force N_1 at which the stop is met `[N]`.
    pub at_stop: f64,
}

impl LinkLaw {
    /// The law of a link that never works.
    const LOST: Self = Self {
        tension_above_m: f64::INFINITY,
        tension_stop_above_m: f64::INFINITY,
        compression_below_m: f64::NEG_INFINITY,
        compression_stop_below_m: f64::NEG_INFINITY,
        between: State::Open,
        branches: [Branch {
            stiffness: 0.0,
            offset: 0.0,
        }; State::COUNT],
        links: 1,
    };

    /// The law of a connector of two trusses of stiffness k `[N/m]`.
    /// Equations (J2), (J3).
    pub(crate) fn connector(k: f64, connection: Connection) -> Self {
        Self::new(&ConnectorLaw::new(k, connection))
    }

    /// The laws of so many connectors of one law, some of which have laws of their own.
    pub(crate) fn connectors(count: usize, k: f64, connection: Connection, own: &OwnLaws) -> Vec<Self> {
        let mut laws = vec![Self::connector(k, connection); count];
        for (place, law) in own.iter() {
            laws[*place] = Self::new(law);
        }
        laws
    }

    /// Laws whose elongations count from a dead state on.
    /// Equation (D3).
    pub(crate) fn from_rest(mut laws: Vec<Self>, dead: Option<&DeadState>) -> Vec<Self> {
        if let Some(dead) = dead {
            for (law, &e) in laws.iter_mut().zip(&dead.elongations_m) {
                *law = law.counted_from(e);
            }
        }
        laws
    }

    /// The law of two such links side by side.
    #[must_use]
    pub(crate) fn doubled(mut self) -> Self {
        for branch in &mut self.branches {
            branch.stiffness *= 2.0;
            branch.offset *= 2.0;
        }
        self.links *= 2;
        self
    }

    /// The law, its elongations counted from `e` on `[m]`.
    #[must_use]
    pub(crate) fn counted_from(mut self, e: f64) -> Self {
        for begins in [
            &mut self.tension_above_m,
            &mut self.tension_stop_above_m,
            &mut self.compression_below_m,
            &mut self.compression_stop_below_m,
        ] {
            *begins -= e;
        }
        for branch in &mut self.branches {
            branch.offset -= branch.stiffness * e;
        }
        self
    }

    /// A law as the step takes it. Equations (J2) to (J4).
    pub(crate) fn new(law: &ConnectorLaw) -> Self {
        let mut of = Self::LOST;
        match law {
            ConnectorLaw::Linear { stiffness_n_m, .. } if *stiffness_n_m > 0.0 => {
                of.between = State::Both;
                of.branches[State::Both as usize].stiffness = 2.0 * stiffness_n_m;
            }
            ConnectorLaw::Linear { .. } => {}
            ConnectorLaw::Gaps { tension, compression } => {
                [of.tension_above_m, of.tension_stop_above_m] =
                    of.take_truss(tension, 1.0, [State::Tension, State::TensionStop]);
                [of.compression_below_m, of.compression_stop_below_m] =
                    of.take_truss(compression, -1.0, [State::Compression, State::CompressionStop]);
            }
        }
        of
    }

    /// Takes the branches of a truss that works in the `sense` of elongations; gives the elongations where they begin.
    fn take_truss(&mut self, truss: &Truss, sense: f64, states: [State; 2]) -> [f64; 2] {
        let never = sense * f64::INFINITY;
        let Truss {
            stiffness_n_m: k,
            gap_m,
            stop,
            damping_n_s_m: _,
        } = *truss;
        if k == 0.0 {
            return [never; 2];
        }
        let begins_m = sense * gap_m;
        self.branches[states[0] as usize] = Branch {
            stiffness: k,
            offset: k * begins_m,
        };
        let Some(stop) = stop else { return [begins_m, never] };
        let stop_m = sense * stop.gap_m;
        self.branches[states[1] as usize] = Branch {
            stiffness: stop.stiffness_n_m,
            offset: stop.stiffness_n_m * stop_m - k * (stop_m - begins_m),
        };
        [begins_m, stop_m]
    }

    /// The state that elongation `e` `[m]` asks for.
    #[inline]
    pub(crate) fn state(&self, e: f64) -> State {
        if e > self.tension_above_m {
            if e > self.tension_stop_above_m {
                State::TensionStop
            } else {
                State::Tension
            }
        } else if e < self.compression_below_m {
            if e < self.compression_stop_below_m {
                State::CompressionStop
            } else {
                State::Compression
            }
        } else {
            self.between
        }
    }

    /// Elongations strictly between which a state is the one that they ask for `[m]`; at the bounds themselves it may be.
    pub(crate) fn within_m(&self, state: State) -> [f64; 2] {
        let (tension, compression) = (self.tension_above_m, self.compression_below_m.min(self.tension_above_m));
        match state {
            State::Tension => [tension, self.tension_stop_above_m],
            State::TensionStop => [tension.max(self.tension_stop_above_m), f64::INFINITY],
            State::Compression => [self.compression_stop_below_m, compression],
            State::CompressionStop => [f64::NEG_INFINITY, compression.min(self.compression_stop_below_m)],
            between if between == self.between => [self.compression_below_m, tension],
            _ => [f64::INFINITY, f64::NEG_INFINITY],
        }
    }

    /// The state of a link without elongation and force.
    #[inline]
    pub(crate) fn at_rest(&self) -> State {
        self.between
    }

    /// The branch of the law in a state; of an open link it is zero.
    #[inline]
    pub(crate) fn branch(&self, state: State) -> Branch {
        self.branches[state as usize]
    }

    /// The force at elongation `e` `[N]`.
    #[inline]
    pub(crate) fn force(&self, e: f64) -> f64 {
        self.branch(self.state(e)).force(e)
    }

    /// How it takes up energy in tension and in compression.
    pub(crate) fn uptakes(&self) -> [Uptake; 2] {
        let both = self.branch(State::Both).stiffness;
        [
            ([State::Tension, State::TensionStop], self.tension_stop_above_m),
            (
                [State::Compression, State::CompressionStop],
                self.compression_stop_below_m,
            ),
        ]
        .map(|([first, stop], stop_m)| {
            let [k, k_stop] = [first, stop].map(|state| self.branch(state).stiffness);
            if k_stop == 0.0 {
                return Uptake {
                    stiffness: if both > 0.0 { both } else { k },
                    ..Uptake::default()
                };
            }
            Uptake {
                stiffness: k_stop,
                softer: 1.0 / k - 1.0 / k_stop,
                at_stop: (k * stop_m - self.branch(first).offset).abs(),
            }
        })
    }

    /// Strain energy at elongation `e` `[J]`.
    #[inline]
    pub(crate) fn energy(&self, e: f64) -> f64 {
        let state = self.state(e);
        let branch = self.branch(state);
        if branch.stiffness == 0.0 {
            return 0.0;
        }
        let force = branch.force(e);
        let energy = 0.5 * force.powi(2) / branch.stiffness;
        match state {
            State::TensionStop | State::CompressionStop => {
                let uptake = self.uptakes()[usize::from(state == State::CompressionStop)];
                energy + 0.5 * uptake.at_stop.powi(2) * uptake.softer
            }
            _ => energy,
        }
    }
}

/// Force of a link at rest `[N]`.
#[inline]
pub(crate) fn rest_force_n(dead: Option<&DeadState>, link: usize) -> f64 {
    dead.map_or(0.0, |dead| dead.forces_n[link])
}

/// The state that each elongation asks for.
#[inline(always)]
pub(crate) fn ask(laws: &[LinkLaw], elongations: &[f64], asked: &mut [State]) {
    for ((asked, law), &e) in asked.iter_mut().zip(laws).zip(elongations) {
        *asked = law.state(e);
    }
}

#[cfg(test)]
mod tests {
    use super::LinkLaw;
    use crate::connector::{Connection, ConnectorLaw, EndStop, State, Truss};

    const K: f64 = 2.0e7;

    /// Force and energy at elongations on both sides of each gap, by hand: `N = k (e - 0.03)`, `N = k (e + 0.01)`.
    #[test]
    fn force_and_energy_follow_the_gaps() {
        let law = LinkLaw::connector(
            K,
            Connection::Nonlinear {
                gap_tension_m: 0.03,
                gap_compression_m: 0.01,
            },
        );
        for (e, state, n) in [
            (0.031, State::Tension, 20_000.0),
            (0.03, State::Open, 0.0),
            (-0.01, State::Open, 0.0),
            (-0.012, State::Compression, -40_000.0),
        ] {
            assert_eq!(law.state(e), state, "at {e} m");
            assert!((law.force(e) - n).abs() < 1e-6, "{} N at {e} m", law.force(e));
            assert!((law.energy(e) - 0.5 * n * n / K).abs() < 1e-9, "at {e} m");
        }
        assert_eq!(law.at_rest(), State::Open);
        assert_eq!(law.uptakes().map(|of| of.stiffness), [K; 2]);
    }

    /// Strictly between its bounds a state is the one that is asked for, and a state that is asked for lies within its bounds: of gaps, of
    /// gaps with stops, of both trusses at work, of one truss, and of a lost connector. A bound that is 5 % off is found.
    #[test]
    fn states_stay_between_their_bounds() {
        let truss = |gap_m, stop| Truss {
            stiffness_n_m: K,
            gap_m,
            damping_n_s_m: 0.0,
            stop,
        };
        let stop = |gap_m| {
            Some(EndStop {
                gap_m,
                stiffness_n_m: 2.0 * K,
            })
        };
        let gaps = |tension, compression| LinkLaw::new(&ConnectorLaw::Gaps { tension, compression });
        let laws = [
            gaps(truss(0.03, None), truss(0.01, None)),
            gaps(truss(0.03, stop(0.05)), truss(0.01, stop(0.02))),
            gaps(truss(0.0, None), truss(0.0, None)),
            gaps(
                truss(0.02, None),
                Truss {
                    stiffness_n_m: 0.0,
                    ..truss(0.0, None)
                },
            ),
            gaps(truss(0.03, stop(0.05)), truss(0.01, None)).counted_from(0.04),
            LinkLaw::connector(K, Connection::Linear),
            LinkLaw::LOST,
        ];
        let states = [
            State::Open,
            State::Tension,
            State::TensionStop,
            State::Compression,
            State::CompressionStop,
            State::Both,
        ];
        let mut wrong = 0;
        for law in laws {
            let steps = (-2000..=2000).map(|i| f64::from(i) * 5e-5);
            for e in steps.chain([f64::MIN, f64::MAX]) {
                let asked = law.state(e);
                let [least, most] = law.within_m(asked);
                assert!(
                    (least..=most).contains(&e),
                    "{asked:?} at {e} m, between {least} and {most}"
                );
                for state in states {
                    let [least, most] = law.within_m(state);
                    assert!(!(least < e && e < most) || asked == state, "{state:?} at {e} m");
                    wrong += usize::from(1.05 * least < e && e < 1.05 * most && asked != state);
                }
            }
        }
        assert!(wrong > 0, "wrong bounds pass");
    }

    /// Without gaps and with both trusses at work `N = 2 k e`, whatever the sign.
    #[test]
    fn linear_connector_has_both_trusses_at_work() {
        let law = LinkLaw::connector(K, Connection::Linear);
        for e in [-0.1, 0.0, 1e-9, 0.2] {
            assert_eq!(law.state(e), State::Both);
            assert!((law.force(e) - 2.0 * K * e).abs() < 1e-6);
        }
        assert_eq!(law.uptakes().map(|of| of.stiffness), [2.0 * K; 2]);
    }

    /// A buffer of 2e6 N/m from 5 mm on and a stop of 5e7 N/m from 15 mm on, by hand: 20 kN at the stop, then 50 kN a
    /// millimetre. The energy is the area below the force.
    #[test]
    fn stop_goes_on_where_the_buffer_ends() {
        let buffer = |stiffness_n_m, stop| Truss {
            stiffness_n_m,
            gap_m: 0.005,
            damping_n_s_m: 0.0,
            stop,
        };
        let stop = EndStop {
            stiffness_n_m: 5e7,
            gap_m: 0.015,
        };
        let law = LinkLaw::new(&ConnectorLaw::Gaps {
            tension: buffer(0.0, None),
            compression: buffer(2e6, Some(stop)),
        });
        for (e, state, n) in [
            (1.0, State::Open, 0.0),
            (-0.005, State::Open, 0.0),
            (-0.010, State::Compression, -10_000.0),
            (-0.015, State::Compression, -20_000.0),
            (-0.016, State::CompressionStop, -70_000.0),
        ] {
            assert_eq!(law.state(e), state, "at {e} m");
            assert!((law.force(e) - n).abs() < 1e-6, "{} N at {e} m", law.force(e));
            let parts = 100_000;
            let width = e / f64::from(parts);
            let area: f64 = (0..parts)
                .map(|i| law.force((f64::from(i) + 0.5) * width) * width)
                .sum();
            assert!(
                (law.energy(e) - area).abs() < 1e-6 * area.max(1.0),
                "{} {area} J at {e} m",
                law.energy(e)
            );
        }
        let [tension, compression] = law.uptakes();
        assert_eq!((tension.stiffness, compression.stiffness), (0.0, 5e7));
    }

    /// A branch of stiffness 0 is never entered, however far the link goes.
    #[test]
    fn lost_link_never_works() {
        let none = Truss {
            stiffness_n_m: 0.0,
            gap_m: 0.0,
            damping_n_s_m: 0.0,
            stop: None,
        };
        for law in [
            ConnectorLaw::Linear {
                stiffness_n_m: 0.0,
                damping_n_s_m: 0.0,
            },
            ConnectorLaw::Gaps {
                tension: none,
                compression: none,
            },
        ] {
            let law = LinkLaw::new(&law);
            for e in [-10.0, 0.0, 10.0] {
                assert_eq!((law.state(e), law.energy(e)), (State::Open, 0.0));
            }
        }
    }
}
