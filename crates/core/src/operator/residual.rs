//! What the modes leave out, in every lane: it follows forces without mass.
//!
//! Knows the followed connector forces and the displacements under deck loads beside the modes. Does not know modes.

use super::basis::Sizes;
use super::connectors::Connectors;
use super::energy::Terms;
use super::lane_array::{LaneArray, Trace};
use super::loads::Loads;
use super::step_constants::{ResidualRule, StepConstants};
use super::vector::{Mean, Ops};
use crate::scheme::{Arithmetic, Newmark};
use pulp::Simd;

/// The residual motion.
#[derive(Debug, Clone)]
pub(super) struct Residual {
    /// Connector forces as the residual has followed them, s.
    pub(super) followed_force: Trace,
    /// `R_BB s`.
    connector_residual: Trace,
    /// Displacements r of connectors, then of observed rows, by deck loads beside the modes.
    pub(super) load_residual: Trace,
    /// Changes of the three in the step without new connector and inertia forces.
    d_force: LaneArray,
    d_connector: LaneArray,
    d_load: LaneArray,
}

impl Residual {
    pub(super) fn new(sizes: &Sizes, lanes: usize) -> Self {
        let (nc, nv) = (sizes.connectors, sizes.observed);
        Self {
            followed_force: Trace::new(nc, lanes),
            connector_residual: Trace::new(nc, lanes),
            load_residual: Trace::new(nc + nv, lanes),
            d_force: LaneArray::new(nc, lanes),
            d_connector: LaneArray::new(nc, lanes),
            d_load: LaneArray::new(nc + nv, lanes),
        }
    }

    /// What a lane carries from step to step.
    pub(super) fn carried(&mut self) -> impl Iterator<Item = &mut LaneArray> {
        let traces = [
            &mut self.followed_force,
            &mut self.connector_residual,
            &mut self.load_residual,
        ];
        traces.into_iter().flat_map(Trace::all)
    }

    /// Operations of [`Residual::predict`] and of the trial elongations `B Phi d` of so many modes, a lane.
    pub(super) fn flop_of_prediction(&self, modes: usize) -> f64 {
        let c = self.d_force.rows();
        (2 * modes * c + 29 * c) as f64
    }

    /// Operations of [`Residual::correct`], a lane, counted in it and in [`Terms::take_residual`].
    pub(super) fn flop_of_correction(&self) -> f64 {
        let (c, rows) = (self.d_force.rows(), self.d_load.rows());
        (72 * c + 13 * rows + 12 * (rows - c)) as f64
    }

    /// Changes of load residuals in the step; of connectors without new forces.
    pub(super) fn observed_changes(&self) -> &LaneArray {
        &self.d_load
    }

    /// Changes of load residuals and connector residuals without new forces.
    pub(super) fn changes(&self) -> [&LaneArray; 2] {
        [&self.d_load, &self.d_connector]
    }

    /// The step without new connector and inertia forces (O7).
    #[inline(always)]
    pub(super) fn predict<S: Simd>(
        &mut self,
        o: Ops<S>,
        constants: &StepConstants,
        loads: &Loads,
        connectors: &Connectors,
    ) {
        let s = &constants.scheme;
        let (m, nc) = (constants.c.len(), connectors.count());
        let (f, m_old) = (Mean::<S>::of(o, s.alpha_f), o.splat(s.alpha_m));
        let rule = ResidualRule::of(o, constants);
        let (n, rn) = (&connectors.n.vectors::<S>()[..nc], &connectors.rn.vectors::<S>()[..nc]);
        let d_force = &mut self.d_force.vectors_mut::<S>()[..nc];
        let d_connector = &mut self.d_connector.vectors_mut::<S>()[..nc];
        let followed = self.followed_force.first_mut::<S>(nc);
        let connector = self.connector_residual.first_mut::<S>(nc);
        for i in 0..nc {
            d_force[i] = followed.change(o, &rule, i, o.mul(f.old, n[i]));
            d_connector[i] = connector.change(o, &rule, i, o.mul(f.old, rn[i]));
        }
        let (w_now, w_old) = (
            &loads.weights_now.vectors::<S>()[m..][..nc],
            &loads.weights.vectors::<S>()[m..][..nc],
        );
        let inertia = &loads.inertia.vectors::<S>()[m..][..nc];
        let load = self.load_residual.first_mut::<S>(nc);
        // nothing asks for those of observed rows before the step's end
        let d_load = &mut self.d_load.vectors_mut::<S>()[..nc];
        for i in 0..nc {
            let down = o.fma(m_old, inertia[i], f.at(o, w_now[i], w_old[i]));
            d_load[i] = load.change(o, &rule, i, o.neg(down));
        }
    }

    /// The step's end, connector and inertia forces found (O7).
    #[inline(always)]
    pub(super) fn correct<S: Simd>(
        &mut self,
        o: Ops<S>,
        constants: &StepConstants,
        loads: &Loads,
        connectors: &Connectors,
        terms: &mut Terms<S>,
    ) {
        let s = &constants.scheme;
        let (m, nc) = (constants.c.len(), connectors.count());
        let (f, by_m, newmark) = (
            Mean::<S>::of(o, s.alpha_f),
            Mean::<S>::of(o, s.alpha_m),
            Newmark::of(o, s),
        );
        let rho = o.splat(constants.rho);
        let (rho_f, rho_m) = (o.mul(rho, f.new), o.mul(rho, by_m.new));
        let (n, rn) = (
            &connectors.n_now.vectors::<S>()[..nc],
            &connectors.rn_now.vectors::<S>()[..nc],
        );
        let (rows, rule) = (self.d_load.rows(), ResidualRule::of(o, constants));
        let (w_now, w_old) = (
            &loads.weights_now.vectors::<S>()[m..][..rows],
            &loads.weights.vectors::<S>()[m..][..rows],
        );
        let (i_now, i_old) = (
            &loads.inertia_now.vectors::<S>()[m..][..rows],
            &loads.inertia.vectors::<S>()[m..][..rows],
        );
        let d_force = &self.d_force.vectors::<S>()[..nc];
        let d_connector = &self.d_connector.vectors::<S>()[..nc];
        let d_load = &mut self.d_load.vectors_mut::<S>()[..rows];
        let mut followed = self.followed_force.first_mut::<S>(nc);
        let mut connector = self.connector_residual.first_mut::<S>(nc);
        let mut load = self.load_residual.first_mut::<S>(rows);
        for i in 0..nc {
            let d_force = o.fma(rho_f, n[i], d_force[i]);
            let d_connector = o.fma(rho_f, rn[i], d_connector[i]);
            let d_load = o.less(d_load[i], rho_m, i_now[i]);
            let (s_old, r_old) = (followed.at(i), load.at(i));
            followed.advance(o, &newmark, i, d_force);
            connector.advance(o, &newmark, i, d_connector);
            load.advance(o, &newmark, i, d_load);
            let down = o.add(f.at(o, w_now[i], w_old[i]), by_m.at(o, i_now[i], i_old[i]));
            terms.take_residual(
                o,
                [d_force, o.sub(d_connector, d_load)],
                [s_old, followed.at(i)],
                [r_old, load.at(i)],
                (connector.at(i)[0], f, down),
            );
        }
        for i in nc..rows {
            let down = o.fma(by_m.old, i_old[i], f.at(o, w_now[i], w_old[i]));
            d_load[i] = o.less(load.change(o, &rule, i, o.neg(down)), rho_m, i_now[i]);
            load.advance(o, &newmark, i, d_load[i]);
        }
    }
}
