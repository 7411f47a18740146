//! The connectors of every lane: forces and elongations.
//!
//! Knows the forces of the last step and of the one under way. Does not know how contact is settled.

use super::basis::Sizes;
use super::energy::Terms;
use super::lane_array::LaneArray;
use super::step_constants::StepConstants;
use super::vector::{Mean, Ops};
use crate::contact::LinkLaw;
use crate::scheme::Arithmetic;
use pulp::Simd;

/// Connectors of every lane.
#[derive(Debug, Clone)]
pub(super) struct Connectors {
    /// Force N, tension positive `[N]`, at the last step and at the one under way.
    pub(super) n: LaneArray,
    pub(super) n_now: LaneArray,
    /// `R_BB N` of both.
    pub(super) rn: LaneArray,
    pub(super) rn_now: LaneArray,
    /// Elongation `[m]`, and in the step under way first without, then with its forces.
    e: LaneArray,
    pub(super) e_now: LaneArray,
    /// `1 / (2 k)` of the first connector at work, and each one's compliance over the first one's.
    half_compliance: LaneArray,
    relative_compliance: LaneArray,
    /// Those that pull or push in any lane.
    active: Vec<usize>,
}

impl Connectors {
    pub(super) fn new(sizes: &Sizes, lanes: usize) -> Self {
        let zeros = || LaneArray::new(sizes.connectors, lanes);
        Self {
            n: zeros(),
            n_now: zeros(),
            rn: zeros(),
            rn_now: zeros(),
            e: zeros(),
            e_now: zeros(),
            half_compliance: LaneArray::new(1, lanes),
            relative_compliance: zeros(),
            active: Vec::with_capacity(sizes.connectors),
        }
    }

    /// Number of connectors.
    #[inline(always)]
    pub(super) fn count(&self) -> usize {
        self.n.rows()
    }

    /// What a lane carries from step to step.
    pub(super) fn carried(&mut self) -> [&mut LaneArray; 3] {
        [&mut self.n, &mut self.rn, &mut self.e]
    }

    /// What a step leaves in a lane that no crossing writes any more.
    pub(super) fn left(&mut self) -> [&mut LaneArray; 2] {
        [&mut self.n_now, &mut self.e_now]
    }

    /// Takes the laws of a lane's connectors.
    pub(super) fn take_laws(&mut self, lane: usize, laws: &[LinkLaw]) {
        let first = laws.first().map_or(1.0, LinkLaw::stiffness_at_work);
        *self.half_compliance.at_mut(0, lane) = 0.5 / first;
        for (i, law) in laws.iter().enumerate() {
            *self.relative_compliance.at_mut(i, lane) = first / law.stiffness_at_work();
        }
    }

    /// Trial elongations, without new connector and inertia forces (O4): `e + B Phi d + dr - R_BB ds`, from the
    /// changes of modes, load residuals and connector residuals.
    #[inline(always)]
    pub(super) fn predict<S: Simd>(
        &mut self,
        o: Ops<S>,
        constants: &StepConstants,
        d: &LaneArray,
        [d_load, d_connector]: [&LaneArray; 2],
    ) {
        let (e_now, e) = (self.e_now.vectors_mut::<S>(), self.e.vectors::<S>());
        constants.panels.b.multiply(o, d.vectors::<S>(), e_now);
        let (d_load, d_connector) = (d_load.vectors::<S>(), d_connector.vectors::<S>());
        for i in 0..e.len() {
            e_now[i] = o.add(e[i], o.add(e_now[i], o.sub(d_load[i], d_connector[i])));
        }
    }

    /// Forces found, as modes and residual see them, the modes in `on_modes`: `Phi^T B^T N` and `R_BB N`.
    #[inline(always)]
    pub(super) fn apply<S: Simd>(&mut self, o: Ops<S>, constants: &StepConstants, on_modes: &mut LaneArray) {
        let zero = o.splat(0.0);
        let n = self.n_now.vectors::<S>();
        self.active.clear();
        for (i, n) in n.iter().enumerate() {
            if o.0.first_true_m64s(o.0.not_m64s(o.0.equal_f64s(*n, zero))) < S::F64_LANES {
                self.active.push(i);
            }
        }
        let panels = &constants.panels;
        let on_modes = on_modes.vectors_mut::<S>();
        panels.b_t.multiply_listed(o, &self.active, n, on_modes);
        let rn = self.rn_now.vectors_mut::<S>();
        panels.r_bb.multiply_listed(o, &self.active, n, rn);
    }

    /// Operations of [`Connectors::apply`] on so many modes, a lane.
    pub(super) fn flop_of_application(&self, modes: usize) -> f64 {
        (2 * self.active.len() * (modes + self.count())) as f64
    }

    /// The step's end: what the connectors took up, and the new forces in place of the old.
    #[inline(always)]
    pub(super) fn correct<S: Simd>(&mut self, o: Ops<S>, constants: &StepConstants, terms: &mut Terms<S>) {
        let f = Mean::<S>::of(o, constants.scheme.alpha_f);
        let (n_now, n) = (self.n_now.vectors::<S>(), self.n.vectors::<S>());
        let (e_now, e) = (self.e_now.vectors::<S>(), self.e.vectors_mut::<S>());
        for i in 0..n.len() {
            terms.take_connector(o, o.sub(e_now[i], e[i]), f.at(o, n_now[i], n[i]));
            e[i] = e_now[i];
        }
        std::mem::swap(&mut self.n, &mut self.n_now);
        std::mem::swap(&mut self.rn, &mut self.rn_now);
    }

    /// Strain energy, the sum of `1/2 N^2 / k` of the branches at work.
    #[inline(always)]
    pub(super) fn energy<S: Simd>(&self, o: Ops<S>) -> S::f64s {
        let mut squares = o.splat(0.0);
        for (n, relative) in self
            .n
            .vectors::<S>()
            .iter()
            .zip(self.relative_compliance.vectors::<S>())
        {
            squares = o.fma(o.mul(*relative, *n), *n, squares);
        }
        o.mul(squares, self.half_compliance.vectors::<S>()[0])
    }
}
