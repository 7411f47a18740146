//! A link: a row of the contact problem with a piecewise-linear law of its own.
//!
//! Knows force against elongation. Does not know what the link joins or where the elongation comes from.

use crate::connector::{Connection, State};

/// A branch `N = k e - n0` of a law.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Branch {
    /// Stiffness k `[N/m]`.
    pub stiffness: f64,
    /// Offset n0 `[N]`.
    pub offset: f64,
}

/// The law of one link: a branch in tension, one in compression, and what holds between them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LinkLaw {
    /// Elongation above which the tension branch works, and below which the compression branch does `[m]`.
    tension_above_m: f64,
    compression_below_m: f64,
    /// The state between them.
    between: State,
    /// The branch of each state.
    branches: [Branch; 4],
}

impl LinkLaw {
    /// The law of a connector of two trusses of stiffness k `[N/m]`.
    /// Equations (J2), (J3).
    pub(crate) fn connector(k: f64, connection: Connection) -> Self {
        let mut law = Self {
            tension_above_m: f64::INFINITY,
            compression_below_m: f64::NEG_INFINITY,
            between: State::Both,
            branches: [Branch::default(); 4],
        };
        law.branches[State::Both as usize].stiffness = 2.0 * k;
        if let Connection::Nonlinear {
            gap_tension_m,
            gap_compression_m,
        } = connection
        {
            law.tension_above_m = gap_tension_m;
            law.compression_below_m = -gap_compression_m;
            law.between = State::Open;
            for (state, end_m) in [
                (State::Tension, gap_tension_m),
                (State::Compression, -gap_compression_m),
            ] {
                law.branches[state as usize] = Branch {
                    stiffness: k,
                    offset: k * end_m,
                };
            }
        }
        law
    }

    /// The state that elongation `e` `[m]` asks for.
    #[inline]
    pub(crate) fn state(&self, e: f64) -> State {
        if e > self.tension_above_m {
            State::Tension
        } else if e < self.compression_below_m {
            State::Compression
        } else {
            self.between
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

    /// Stiffness of the link wherever it is not open `[N/m]`.
    pub(crate) fn stiffness_at_work(&self) -> f64 {
        let at_work = match self.between {
            State::Open => State::Tension,
            both => both,
        };
        self.branch(at_work).stiffness
    }

    /// Strain energy at elongation `e` `[J]`.
    #[inline]
    pub(crate) fn energy(&self, e: f64) -> f64 {
        let branch = self.branch(self.state(e));
        if branch.stiffness == 0.0 {
            0.0
        } else {
            0.5 * (branch.stiffness * e - branch.offset).powi(2) / branch.stiffness
        }
    }
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
    use crate::connector::{Connection, State};

    const K: f64 = 2.0e7;

    fn force(law: &LinkLaw, e: f64) -> f64 {
        let branch = law.branch(law.state(e));
        branch.stiffness * e - branch.offset
    }

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
            assert!((force(&law, e) - n).abs() < 1e-6, "{} N at {e} m", force(&law, e));
            assert!((law.energy(e) - 0.5 * n * n / K).abs() < 1e-9, "at {e} m");
        }
        assert_eq!(law.at_rest(), State::Open);
        assert_eq!(law.stiffness_at_work(), K);
    }

    /// Without gaps and with both trusses at work `N = 2 k e`, whatever the sign.
    #[test]
    fn linear_connector_has_both_trusses_at_work() {
        let law = LinkLaw::connector(K, Connection::Linear);
        for e in [-0.1, 0.0, 1e-9, 0.2] {
            assert_eq!(law.state(e), State::Both);
            assert!((force(&law, e) - 2.0 * K * e).abs() < 1e-6);
        }
        assert_eq!(law.stiffness_at_work(), 2.0 * K);
    }
}
