//! The modes of every lane: their motion and how it is stepped.
//!
//! Knows uncoupled modes under modal forces. Does not know connectors or vehicles.

use super::basis::{BridgeOperator, Sizes};
use super::energy::Terms;
use super::lane_array::LaneArray;
use super::loads::Loads;
use super::step_constants::StepConstants;
use super::vector::{Mean, Ops};
use crate::scheme::{Arithmetic, Newmark};
use pulp::Simd;

/// Modal motion.
#[derive(Debug, Clone)]
pub(super) struct Modes {
    /// `q, q', q''`.
    pub(super) q: LaneArray,
    v: LaneArray,
    a: LaneArray,
    /// Modal forces of the connectors, `Phi^T B^T N`, at the last step and at the one under way.
    contact: LaneArray,
    pub(super) contact_now: LaneArray,
    /// Change of q in the step without new connector and inertia forces.
    pub(super) d: LaneArray,
    /// `q, q', q''` at the step's end without those forces.
    pub(super) free: [LaneArray; 3],
}

impl Modes {
    pub(super) fn new(sizes: &Sizes, lanes: usize) -> Self {
        let zeros = || LaneArray::new(sizes.modes, lanes);
        Self {
            q: zeros(),
            v: zeros(),
            a: zeros(),
            contact: zeros(),
            contact_now: zeros(),
            d: zeros(),
            free: [zeros(), zeros(), zeros()],
        }
    }

    /// Number of modes.
    #[inline(always)]
    pub(super) fn count(&self) -> usize {
        self.q.rows()
    }

    /// `q, q', q''` now.
    pub(super) fn motion(&self) -> [&LaneArray; 3] {
        [&self.q, &self.v, &self.a]
    }

    /// Operations of [`Modes::predict`], a lane, counted in it.
    pub(super) fn flop_of_prediction(&self) -> f64 {
        14.0 * self.count() as f64
    }

    /// Operations of [`Modes::correct`], a lane, counted in it and in [`Terms::take_mode`].
    pub(super) fn flop_of_correction(&self) -> f64 {
        57.0 * self.count() as f64
    }

    /// What a lane carries from step to step.
    pub(super) fn carried(&mut self) -> [&mut LaneArray; 4] {
        [&mut self.q, &mut self.v, &mut self.a, &mut self.contact]
    }

    /// The step without new connector and inertia forces (O6): d, and where masses ride along the motion that it leads to.
    #[inline(always)]
    pub(super) fn predict<S: Simd>(
        &mut self,
        o: Ops<S>,
        constants: &StepConstants,
        (loads, waves): (&Loads, Option<&LaneArray>),
        masses: bool,
    ) {
        let s = &constants.scheme;
        let m = constants.c.len();
        let f = Mean::<S>::of(o, s.alpha_f);
        let m_old = o.splat(s.alpha_m);
        let (w_now, w_old) = (
            &loads.weights_now.vectors::<S>()[..m],
            &loads.weights.vectors::<S>()[..m],
        );
        let inertia = &loads.inertia.vectors::<S>()[..m];
        let (on_q, on_v) = (&constants.on_q[..m], &constants.on_v[..m]);
        let (on_a, c) = (&constants.on_a[..m], &constants.c[..m]);
        let (q, v, a) = (
            &self.q.vectors::<S>()[..m],
            &self.v.vectors::<S>()[..m],
            &self.a.vectors::<S>()[..m],
        );
        let contact = &self.contact.vectors::<S>()[..m];
        let d = &mut self.d.vectors_mut::<S>()[..m];
        for k in 0..m {
            // downward forces of the vehicle that do not wait for the new instant
            let down = o.fma(m_old, inertia[k], f.at(o, w_now[k], w_old[k]));
            let force = o.fma(f.old, contact[k], down);
            let from_a = o.mul(o.splat(on_a[k]), a[k]);
            let motion = o.fma(o.splat(on_q[k]), q[k], o.fma(o.splat(on_v[k]), v[k], from_a));
            d[k] = o.less(motion, o.splat(c[k]), force);
        }
        if let Some(waves) = waves {
            let waves = &waves.vectors::<S>()[..m];
            for k in 0..m {
                d[k] = o.fma(o.splat(c[k]), waves[k], d[k]);
            }
        }
        if masses {
            let newmark = Newmark::of(o, s);
            let [free_q, free_v, free_a] = &mut self.free;
            let free_q = &mut free_q.vectors_mut::<S>()[..m];
            let free_v = &mut free_v.vectors_mut::<S>()[..m];
            let free_a = &mut free_a.vectors_mut::<S>()[..m];
            for k in 0..m {
                [free_q[k], free_v[k], free_a[k]] = newmark.advance(o, d[k], [q[k], v[k], a[k]]);
            }
        }
    }

    /// The step's end, connector and inertia forces found (O6).
    #[inline(always)]
    pub(super) fn correct<S: Simd>(
        &mut self,
        o: Ops<S>,
        operator: &BridgeOperator,
        constants: &StepConstants,
        (loads, waves): (&Loads, Option<&LaneArray>),
        terms: &mut Terms<S>,
    ) {
        let s = &constants.scheme;
        let m = constants.c.len();
        let (f, by_m, newmark) = (
            Mean::<S>::of(o, s.alpha_f),
            Mean::<S>::of(o, s.alpha_m),
            Newmark::of(o, s),
        );
        let (w_now, w_old) = (
            &loads.weights_now.vectors::<S>()[..m],
            &loads.weights.vectors::<S>()[..m],
        );
        let (i_now, i_old) = (
            &loads.inertia_now.vectors::<S>()[..m],
            &loads.inertia.vectors::<S>()[..m],
        );
        let (omega2, c) = (&operator.omega2[..m], &constants.c[..m]);
        let q = &mut self.q.vectors_mut::<S>()[..m];
        let v = &mut self.v.vectors_mut::<S>()[..m];
        let a = &mut self.a.vectors_mut::<S>()[..m];
        let (contact, d_free) = (&self.contact_now.vectors::<S>()[..m], &self.d.vectors::<S>()[..m]);
        let waves = waves.map(|waves| &waves.vectors::<S>()[..m]);
        let undamped = constants.undamped.as_deref().map(|undamped| &undamped[..m]);
        for k in 0..m {
            let force = o.fma(f.new, contact[k], o.mul(by_m.new, i_now[k]));
            let d = o.less(d_free[k], o.splat(c[k]), force);
            let old = [q[k], v[k], a[k]];
            let new = newmark.advance(o, d, old);
            let down = o.add(f.at(o, w_now[k], w_old[k]), by_m.at(o, i_now[k], i_old[k]));
            terms.take_mode(o, o.splat(omega2[k]), d, [old, new], [f, by_m], down);
            if let Some(waves) = waves {
                terms.take_waves(o, d, waves[k]);
            }
            if let Some(undamped) = undamped {
                terms.take_undamped(o, o.splat(undamped[k]), d, f.at(o, new[1], old[1]));
            }
            [q[k], v[k], a[k]] = new;
        }
        terms.end_of_modes();
        std::mem::swap(&mut self.contact, &mut self.contact_now);
    }
}
