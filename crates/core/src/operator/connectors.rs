//! The connectors of every lane: forces and elongations.
//!
//! Knows the forces of the last step and of the one under way. Does not know how contact is settled.

use super::basis::Sizes;
use super::dashpots::DashpotForces;
use super::energy::Terms;
use super::lane_array::LaneArray;
use super::step_constants::StepConstants;
use super::vector::{Mean, Ops};
use crate::contact::{LinkLaw, Uptake};
use crate::response::DeadState;
use crate::scheme::Arithmetic;
use pulp::Simd;

/// Connectors of every lane.
#[derive(Debug, Clone)]
pub(super) struct Connectors {
    /// Force N beyond that at rest, tension positive `[N]`, at the last step and at the one under way.
    pub(super) n: LaneArray,
    pub(super) n_now: LaneArray,
    /// `R_BB N` of both.
    pub(super) rn: LaneArray,
    pub(super) rn_now: LaneArray,
    /// Elongation `[m]`, and in the step under way first without, then with its forces.
    pub(super) e: LaneArray,
    pub(super) e_now: LaneArray,
    /// Force at rest `[N]`, and in which lanes there is one at all.
    pub(super) rest: LaneArray,
    from_rest: Vec<bool>,
    pub(super) any_rest: bool,
    /// What dashpots give.
    pub(super) dashpots: DashpotForces,
    /// `1 / (2 k)` of the first connector that works at all.
    half_compliance: LaneArray,
    /// How each one takes up energy in tension and in compression, over that of the first.
    tension: UptakeLanes,
    compression: UptakeLanes,
    /// Lanes of which a connector takes up energy in one sense as it does not in the other, or has a stop.
    uneven: Vec<bool>,
    /// Energy at rest `[J]`.
    rest_energy: LaneArray,
    /// Those that pull or push in any lane.
    active: Vec<usize>,
}

/// How the connectors of every lane take up energy in one sense.
#[derive(Debug, Clone)]
struct UptakeLanes {
    /// Compliance of the last branch, and by how much a buffer before it is softer, over the compliance of the lane's first.
    relative_compliance: LaneArray,
    softer: LaneArray,
    /// Force at which the stop is met `[N]`.
    at_stop: LaneArray,
}

impl UptakeLanes {
    fn new(connectors: usize, lanes: usize) -> Self {
        let zeros = || LaneArray::new(connectors, lanes);
        Self {
            relative_compliance: zeros(),
            softer: zeros(),
            at_stop: zeros(),
        }
    }

    /// Takes what a connector does in a lane whose first one has stiffness `first` `[N/m]`.
    fn take(&mut self, connector: usize, lane: usize, of: Uptake, first: f64) {
        let works = of.stiffness > 0.0;
        *self.relative_compliance.at_mut(connector, lane) = if works { first / of.stiffness } else { 0.0 };
        *self.softer.at_mut(connector, lane) = first * of.softer;
        *self.at_stop.at_mut(connector, lane) = of.at_stop;
    }

    /// What a connector has here in lanes where it is in this sense, and in the `other` elsewhere.
    #[inline(always)]
    fn of_sense<S: Simd>(&self, o: Ops<S>, here: S::m64s, other: &Self, i: usize) -> [S::f64s; 3] {
        let (a, b) = (self, other);
        [
            o.0.select_f64s(
                here,
                a.relative_compliance.vectors::<S>()[i],
                b.relative_compliance.vectors::<S>()[i],
            ),
            o.0.select_f64s(here, a.softer.vectors::<S>()[i], b.softer.vectors::<S>()[i]),
            o.0.select_f64s(here, a.at_stop.vectors::<S>()[i], b.at_stop.vectors::<S>()[i]),
        ]
    }
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
            rest: zeros(),
            from_rest: vec![false; lanes],
            any_rest: false,
            rest_energy: LaneArray::new(1, lanes),
            dashpots: DashpotForces::new(sizes, lanes),
            half_compliance: LaneArray::new(1, lanes),
            tension: UptakeLanes::new(sizes.connectors, lanes),
            compression: UptakeLanes::new(sizes.connectors, lanes),
            uneven: vec![false; lanes],
            active: Vec::with_capacity(sizes.connectors),
        }
    }

    /// Number of connectors.
    #[inline(always)]
    pub(super) fn count(&self) -> usize {
        self.n.rows()
    }

    /// Forces by the laws at the end of a step, once it has ended: those of the balance but for dashpots in the steps that meet
    /// a gap.
    #[inline(always)]
    pub(super) fn by_law(&self) -> &LaneArray {
        if self.dashpots.any {
            &self.dashpots.by_law
        } else {
            &self.n
        }
    }

    /// Forces in the balance at the end of the step and before it, once the step has ended.
    pub(super) fn forces(&self) -> [&LaneArray; 2] {
        [&self.n, &self.n_now]
    }

    /// What a lane carries from step to step.
    pub(super) fn carried(&mut self) -> [&mut LaneArray; 5] {
        let DashpotForces { before, part, .. } = &mut self.dashpots;
        [&mut self.n, &mut self.rn, &mut self.e, before, part]
    }

    /// What a step leaves in a lane that no crossing writes any more.
    pub(super) fn left(&mut self) -> [&mut LaneArray; 4] {
        let DashpotForces {
            part_now, above_law, ..
        } = &mut self.dashpots;
        [&mut self.n_now, &mut self.e_now, part_now, above_law]
    }

    /// Takes the laws of a lane's connectors.
    pub(super) fn take_laws(&mut self, lane: usize, laws: &[LinkLaw]) {
        let uptakes = || laws.iter().map(LinkLaw::uptakes);
        let first = uptakes()
            .flatten()
            .map(|of| of.stiffness)
            .find(|k| *k > 0.0)
            .unwrap_or(1.0);
        *self.half_compliance.at_mut(0, lane) = 0.5 / first;
        self.uneven[lane] = uptakes().any(|[tension, compression]| tension != compression || tension.softer != 0.0);
        for (i, [tension, compression]) in uptakes().enumerate() {
            self.tension.take(i, lane, tension, first);
            self.compression.take(i, lane, compression, first);
        }
    }

    /// Takes the forces of a lane at rest; the laws are taken.
    pub(super) fn take_rest(&mut self, lane: usize, (laws, dead): (&[LinkLaw], Option<&DeadState>)) {
        self.from_rest[lane] = dead.is_some();
        self.any_rest = self.from_rest.contains(&true);
        self.rest.clear(lane);
        *self.rest_energy.at_mut(0, lane) = 0.0;
        if let Some(dead) = dead {
            self.rest.scatter(lane, &dead.forces_n);
            *self.rest_energy.at_mut(0, lane) = laws.iter().map(|law| law.energy(0.0)).sum();
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
        let count = self.e.rows();
        let (e_now, e) = (
            &mut self.e_now.vectors_mut::<S>()[..count],
            &self.e.vectors::<S>()[..count],
        );
        constants.panels.b.multiply(o, d.vectors::<S>(), e_now);
        let (d_load, d_connector) = (&d_load.vectors::<S>()[..count], &d_connector.vectors::<S>()[..count]);
        for i in 0..count {
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

    /// Those that pull or push in any lane.
    #[inline(always)]
    pub(super) fn active(&self) -> &[usize] {
        &self.active
    }

    /// Operations of [`Connectors::apply`] on so many modes, a lane.
    pub(super) fn flop_of_application(&self, modes: usize) -> f64 {
        (2 * self.active.len() * (modes + self.count())) as f64
    }

    /// The step's end: what the connectors took up, and the new forces in place of the old.
    #[inline(always)]
    pub(super) fn correct<S: Simd>(&mut self, o: Ops<S>, constants: &StepConstants, terms: &mut Terms<S>) {
        let f = Mean::<S>::of(o, constants.scheme.alpha_f);
        if self.dashpots.any {
            self.account_with_dashpots(o, f, terms);
        } else {
            let count = self.n.rows();
            let (n_now, n) = (&self.n_now.vectors::<S>()[..count], &self.n.vectors::<S>()[..count]);
            let (e_now, e) = (
                &self.e_now.vectors::<S>()[..count],
                &mut self.e.vectors_mut::<S>()[..count],
            );
            for i in 0..count {
                terms.take_connector(o, o.sub(e_now[i], e[i]), f.at(o, n_now[i], n[i]));
                e[i] = e_now[i];
            }
        }
        std::mem::swap(&mut self.n, &mut self.n_now);
        std::mem::swap(&mut self.rn, &mut self.rn_now);
    }

    /// What the connectors and their dashpots took up, in lanes of which some have dashpots; where there is none, the same bits
    /// as without looking.
    #[inline(always)]
    fn account_with_dashpots<S: Simd>(&mut self, o: Ops<S>, f: Mean<S>, terms: &mut Terms<S>) {
        let (n_now, n) = (self.n_now.vectors::<S>(), self.n.vectors::<S>());
        let (e_now, e) = (self.e_now.vectors::<S>(), self.e.vectors_mut::<S>());
        let dashpots = &mut self.dashpots;
        let (part_now, part) = (dashpots.part_now.vectors::<S>(), dashpots.part.vectors::<S>());
        let above_law = dashpots.above_law.vectors::<S>();
        let (by_law, springs) = (dashpots.by_law.vectors_mut::<S>(), dashpots.springs.vectors_mut::<S>());
        let before = dashpots.before.vectors_mut::<S>();
        for i in 0..n.len() {
            springs[i] = o.sub(n_now[i], part_now[i]);
            by_law[i] = o.sub(n_now[i], above_law[i]);
            let (lengthening, spring) = (o.sub(e_now[i], e[i]), o.sub(n[i], part[i]));
            terms.take_connector(o, lengthening, f.at(o, springs[i], spring));
            terms.take_dashpot(o, lengthening, f.at(o, part_now[i], part[i]));
            (before[i], e[i]) = (e[i], e_now[i]);
        }
        std::mem::swap(&mut dashpots.part, &mut dashpots.part_now);
    }

    /// Strain energy, the sum of `1/2 N^2 / k` of the branches at work, and what buffers before their stops have beside.
    #[inline(always)]
    pub(super) fn energy<S: Simd>(&self, o: Ops<S>) -> S::f64s {
        let mut squares = o.splat(0.0);
        let dashpots = &self.dashpots;
        let n = if dashpots.any { &dashpots.springs } else { &self.n }.vectors::<S>();
        if self.any_rest {
            return self.energy_from_rest(o, n);
        }
        if self.uneven.contains(&true) {
            for (i, n) in n.iter().enumerate() {
                squares = self.uneven_square(o, i, *n, squares);
            }
        } else {
            for (n, relative) in n.iter().zip(self.tension.relative_compliance.vectors::<S>()) {
                squares = o.fma(o.mul(*relative, *n), *n, squares);
            }
        }
        o.mul(squares, self.half_compliance.vectors::<S>()[0])
    }

    /// Strain energy beyond that at rest, less what the forces at rest do: that of the forces `n` beyond those at rest.
    #[inline(always)]
    fn energy_from_rest<S: Simd>(&self, o: Ops<S>, n: &[S::f64s]) -> S::f64s {
        let (rest, e) = (self.rest.vectors::<S>(), self.e.vectors::<S>());
        let (mut squares, mut work) = (o.splat(0.0), self.rest_energy.vectors::<S>()[0]);
        for (i, n) in n.iter().enumerate() {
            squares = self.uneven_square(o, i, o.add(*n, rest[i]), squares);
            work = o.fma(rest[i], e[i], work);
        }
        o.sub(o.mul(squares, self.half_compliance.vectors::<S>()[0]), work)
    }

    /// Adds the square of one connector whose senses may differ; of one whose senses do not, the same bits as without looking.
    #[inline(always)]
    fn uneven_square<S: Simd>(&self, o: Ops<S>, i: usize, n: S::f64s, squares: S::f64s) -> S::f64s {
        let pulls = o.0.less_than_f64s(o.splat(0.0), n);
        let [relative, softer, at_stop] = self.tension.of_sense(o, pulls, &self.compression, i);
        let squares = o.fma(o.mul(relative, n), n, squares);
        let buffered = o.0.min_f64s(o.abs(n), at_stop);
        o.fma(o.mul(softer, buffered), buffered, squares)
    }
}
