//! The balance of energy of every lane (R1): each term of the balance at alpha times the step's motion. What a term gives beyond
//! the change of its energy is numerical dissipation.
//!
//! Knows the terms of a step and their sums over a crossing. Does not know how the motion came about.

use super::lane_array::LaneArray;
use super::step_constants::StepConstants;
use super::vector::{Mean, Ops};
use crate::response::EnergySummary;
use crate::riding::RideEnergies;
use crate::scheme::Arithmetic;
use pulp::Simd;

/// Terms of one step, summed over modes, connectors and observed rows.
#[derive(Debug, Clone, Copy)]
pub(super) struct Terms<S: Simd> {
    inertia: S::f64s,
    stiffness: S::f64s,
    damping_m: S::f64s,
    damping_k: S::f64s,
    undamped: S::f64s,
    radiated: S::f64s,
    work: S::f64s,
    springs: S::f64s,
    dashpots: S::f64s,
    /// Twice the energies at the step's end.
    kinetic: S::f64s,
    strain: S::f64s,
    /// Of the strain what the modes have, `sum of omega^2 q^2`, and `s^T R s` of the connectors.
    modal_strain: S::f64s,
    residual_strain: S::f64s,
    /// How far modes and links have moved (O11): `sum of (omega^2 + 1) d^2`, `sum of ds^2`.
    modes_moved: S::f64s,
    links_moved: S::f64s,
}

impl<S: Simd> Terms<S> {
    /// Nothing yet.
    #[inline(always)]
    pub(super) fn new(o: Ops<S>) -> Self {
        let zero = o.splat(0.0);
        Self {
            inertia: zero,
            stiffness: zero,
            damping_m: zero,
            damping_k: zero,
            undamped: zero,
            radiated: zero,
            work: zero,
            springs: zero,
            dashpots: zero,
            kinetic: zero,
            strain: zero,
            modal_strain: zero,
            residual_strain: zero,
            modes_moved: zero,
            links_moved: zero,
        }
    }

    /// A mode that changes by `d` from `old` to `new` under the downward force `down` of the vehicle at alpha.
    #[inline(always)]
    pub(super) fn take_mode(
        &mut self,
        o: Ops<S>,
        omega2: S::f64s,
        d: S::f64s,
        [[q, v, a], [q_new, v_new, a_new]]: [[S::f64s; 3]; 2],
        [by_f, by_m]: [Mean<S>; 2],
        down: S::f64s,
    ) {
        let (v_alpha, w2_d) = (by_f.at(o, v_new, v), o.mul(omega2, d));
        self.kinetic = o.fma(v_new, v_new, self.kinetic);
        self.strain = o.fma(o.mul(omega2, q_new), q_new, self.strain);
        self.inertia = o.fma(d, by_m.at(o, a_new, a), self.inertia);
        self.stiffness = o.fma(w2_d, by_f.at(o, q_new, q), self.stiffness);
        self.damping_m = o.fma(d, v_alpha, self.damping_m);
        self.damping_k = o.fma(w2_d, v_alpha, self.damping_k);
        self.work = o.less(self.work, d, down);
        self.modes_moved = o.fma(o.add(w2_d, d), d, self.modes_moved);
    }

    /// A mode that changes by `d` under the force `waves` of water with memory at alpha, upward.
    #[inline(always)]
    pub(super) fn take_waves(&mut self, o: Ops<S>, d: S::f64s, waves: S::f64s) {
        self.radiated = o.less(self.radiated, d, waves);
    }

    /// What damping in proportion to all of the stiffness would take more of a mode that changes by `d`.
    #[inline(always)]
    pub(super) fn take_undamped(&mut self, o: Ops<S>, undamped: S::f64s, d: S::f64s, v_alpha: S::f64s) {
        self.undamped = o.fma(o.mul(undamped, d), v_alpha, self.undamped);
    }

    /// All modes were taken.
    #[inline(always)]
    pub(super) fn end_of_modes(&mut self) {
        self.modal_strain = self.strain;
    }

    /// What the modes leave out at a connector, whose energy is `1/2 s^T R s - s^T r`: the changes of s and of `R s - r`, s and r
    /// with their derivatives before and behind, and R s behind.
    #[inline(always)]
    pub(super) fn take_residual(
        &mut self,
        o: Ops<S>,
        [ds, moved]: [S::f64s; 2],
        [s, s_new]: [[S::f64s; 2]; 2],
        [r, r_new]: [[S::f64s; 2]; 2],
        (sigma_new, by_f, down): (S::f64s, Mean<S>, S::f64s),
    ) {
        self.stiffness = o.fma(
            by_f.at(o, s_new[0], s[0]),
            moved,
            o.less(self.stiffness, by_f.at(o, r_new[0], r[0]), ds),
        );
        self.damping_k = o.fma(
            by_f.at(o, s_new[1], s[1]),
            moved,
            o.less(self.damping_k, by_f.at(o, r_new[1], r[1]), ds),
        );
        self.residual_strain = o.fma(s_new[0], sigma_new, self.residual_strain);
        let twice = o.sub(o.sub(sigma_new, r_new[0]), r_new[0]);
        self.strain = o.fma(s_new[0], twice, self.strain);
        self.work = o.fma(ds, down, self.work);
        self.links_moved = o.fma(ds, ds, self.links_moved);
    }

    /// A dashpot that lengthens by `de` under the force `n` at alpha.
    #[inline(always)]
    pub(super) fn take_dashpot(&mut self, o: Ops<S>, de: S::f64s, n: S::f64s) {
        self.dashpots = o.fma(de, n, self.dashpots);
    }

    /// A connector that lengthens by `de` under the force `n` at alpha.
    #[inline(always)]
    pub(super) fn take_connector(&mut self, o: Ops<S>, de: S::f64s, n: S::f64s) {
        self.springs = o.fma(de, n, self.springs);
    }
}

/// Energies of every lane and their sums since the crossing began `[J]`.
#[derive(Debug, Clone)]
pub(super) struct Energy {
    /// At the end of the last step.
    kinetic: LaneArray,
    strain: LaneArray,
    springs: LaneArray,
    /// What vehicles on springs have taken up since the crossing began, and over the step: what dampers and scheme dissipate, work.
    vehicles: LaneArray,
    ridden: LaneArray,
    any_ride: bool,
    /// Rayleigh damping and dashpots, numerical dissipation, work; largest work, largest gap of the balance, largest numerical dissipation.
    sums: LaneArray,
    /// What waves have taken since the crossing began, and the least of it.
    radiated: LaneArray,
    /// `sum of omega^2 q^2`, `s^T R s`.
    pub(super) modal_strain: LaneArray,
    pub(super) residual_strain: LaneArray,
    /// The square of the step's path (O11).
    pub(super) moved: LaneArray,
}

impl Energy {
    pub(super) fn new(lanes: usize) -> Self {
        let zeros = |rows: usize| LaneArray::new(rows, lanes);
        Self {
            kinetic: zeros(1),
            strain: zeros(1),
            springs: zeros(1),
            vehicles: zeros(1),
            ridden: zeros(3),
            any_ride: false,
            sums: zeros(6),
            radiated: zeros(2),
            modal_strain: zeros(1),
            residual_strain: zeros(1),
            moved: zeros(1),
        }
    }

    /// What a lane carries from step to step.
    pub(super) fn carried(&mut self) -> [&mut LaneArray; 6] {
        [
            &mut self.kinetic,
            &mut self.strain,
            &mut self.springs,
            &mut self.vehicles,
            &mut self.sums,
            &mut self.radiated,
        ]
    }

    /// Takes what vehicles on springs do over the step, lane after lane; nothing where there are none.
    #[inline(always)]
    pub(super) fn take_rides(&mut self, any: bool, ridden: impl Iterator<Item = RideEnergies>) {
        self.any_ride = any;
        if !any {
            return;
        }
        for (lane, of) in ridden.enumerate() {
            *self.vehicles.at_mut(0, lane) += of.stored;
            for (row, value) in [of.dampers, of.numerical, of.work].into_iter().enumerate() {
                *self.ridden.at_mut(row, lane) = value;
            }
        }
    }

    /// Whether a lane's energies are finite.
    pub(super) fn is_finite(&self, lane: usize) -> bool {
        self.kinetic.at(0, lane).is_finite() && self.strain.at(0, lane).is_finite()
    }

    /// Accounts for a step, at whose end the connectors have the energy `springs`.
    #[inline(always)]
    pub(super) fn account<S: Simd>(
        &mut self,
        o: Ops<S>,
        constants: &StepConstants,
        terms: &Terms<S>,
        springs: S::f64s,
    ) {
        let half = o.splat(0.5);
        let (kinetic, strain) = (o.mul(half, terms.kinetic), o.mul(half, terms.strain));
        let before = o.add(
            o.add(self.kinetic.vectors::<S>()[0], self.strain.vectors::<S>()[0]),
            self.springs.vectors::<S>()[0],
        );
        let stored = o.add(o.add(kinetic, strain), springs);
        let spent = o.add(o.add(terms.inertia, terms.stiffness), terms.springs);
        let numerical = o.sub(spent, o.sub(stored, before));
        let rayleigh = o.fma(
            o.splat(constants.rayleigh.a),
            terms.damping_k,
            o.mul(o.splat(constants.rayleigh.b), terms.damping_m),
        );
        let rayleigh = match constants.undamped {
            None => rayleigh,
            Some(_) => o.sub(rayleigh, terms.undamped),
        };
        self.kinetic.vectors_mut::<S>()[0] = kinetic;
        self.strain.vectors_mut::<S>()[0] = strain;
        self.springs.vectors_mut::<S>()[0] = springs;
        self.modal_strain.vectors_mut::<S>()[0] = terms.modal_strain;
        self.residual_strain.vectors_mut::<S>()[0] = terms.residual_strain;
        self.moved.vectors_mut::<S>()[0] = o.fma(o.splat(constants.link_weight), terms.links_moved, terms.modes_moved);
        let sums = self.sums.vectors_mut::<S>();
        sums[0] = o.add(sums[0], o.add(rayleigh, terms.dashpots));
        sums[1] = o.add(sums[1], numerical);
        sums[2] = o.add(sums[2], terms.work);
        let mut stored = stored;
        if self.any_ride {
            let ridden = self.ridden.vectors::<S>();
            for (sum, of_rides) in sums.iter_mut().zip(ridden) {
                *sum = o.add(*sum, *of_rides);
            }
            stored = o.add(stored, self.vehicles.vectors::<S>()[0]);
        }
        if constants.waves.is_some() {
            let radiated = self.radiated.vectors_mut::<S>();
            radiated[0] = o.add(radiated[0], terms.radiated);
            radiated[1] = o.neg(o.max(o.neg(radiated[1]), o.neg(radiated[0])));
            stored = o.add(stored, radiated[0]);
        }
        let gap = o.sub(o.add(stored, o.add(sums[0], sums[1])), sums[2]);
        sums[3] = o.max(sums[3], o.abs(sums[2]));
        sums[4] = o.max(sums[4], o.abs(gap));
        sums[5] = o.max(sums[5], o.abs(sums[1]));
    }

    /// The balance of a lane's crossing.
    pub(super) fn summary(&self, lane: usize) -> EnergySummary {
        let most_work = self.sums.at(3, lane);
        let per_work = |x: f64| if most_work == 0.0 { 0.0 } else { x / most_work };
        EnergySummary {
            energy_residual: per_work(self.sums.at(4, lane)),
            numerical_dissipation: per_work(self.sums.at(5, lane)),
            radiated_j: self.radiated.at(0, lane),
            least_radiated_j: self.radiated.at(1, lane),
        }
    }
}
