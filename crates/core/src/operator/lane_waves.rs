//! The water of every lane: its states, the forces that they give, and how a step takes them on (W7).
//!
//! Knows states and velocities of motions. Does not know connectors or vehicles.

use super::lane_array::LaneArray;
use super::step_constants::StepConstants;
use super::vector::{Mean, Ops};
use super::waves::{OperatorWaves, WaveKind};
use crate::scheme::Arithmetic;
use pulp::Simd;

/// Share of the largest motion in heave and pitch so far above which rolls are driven; below, they are rounding.
const ROLLS: f64 = 1e-6;

/// The water of every lane.
#[derive(Debug, Clone)]
pub(super) struct LaneWaves {
    kinds: [KindStates; 2],
    /// Largest motion in heave and pitch so far, and whether rolls are driven: 1 or 0.
    reach: LaneArray,
    awake: LaneArray,
    any_awake: bool,
    /// Forces of the water on the modes at alpha.
    pub(super) modal: LaneArray,
    spare: LaneArray,
}

/// States of one kind of motions.
#[derive(Debug, Clone)]
struct KindStates {
    /// States and what drives them, group after group: real parts, then imaginary parts.
    states: LaneArray,
    inputs: LaneArray,
    /// States, and after those of a group its velocities, as they are at the step's end without what is found in it.
    ahead: LaneArray,
    filtered: LaneArray,
    /// Velocities of the motions, their slopes, and forces at the end of the last step.
    velocity: LaneArray,
    slope: LaneArray,
    force: LaneArray,
    /// Forces at the end of the step under way, and at alpha.
    force_now: LaneArray,
    at_alpha: LaneArray,
}

impl KindStates {
    fn new(motions: usize, poles: usize, lanes: usize) -> Self {
        let zeros = |rows: usize| LaneArray::new(rows, lanes);
        Self {
            states: zeros(2 * poles),
            inputs: zeros(2 * poles),
            ahead: zeros(2 * poles + motions),
            filtered: zeros(2 * poles),
            velocity: zeros(motions),
            slope: zeros(motions),
            force: zeros(motions),
            force_now: zeros(motions),
            at_alpha: zeros(motions),
        }
    }

    fn carried(&mut self) -> [&mut LaneArray; 5] {
        [
            &mut self.states,
            &mut self.inputs,
            &mut self.velocity,
            &mut self.slope,
            &mut self.force,
        ]
    }

    /// Forces at the step's end, and at alpha: the velocity there is the last one and its slope.
    #[inline(always)]
    fn predict<S: Simd>(&mut self, o: Ops<S>, constants: &StepConstants, of: &WaveKind) {
        let (h, f) = (o.splat(constants.scheme.h), Mean::<S>::of(o, constants.scheme.alpha_f));
        let (velocity, slope) = (self.velocity.vectors::<S>(), self.slope.vectors::<S>());
        let (mut first, mut motion) = (0, 0);
        for group in &of.groups {
            let n = group.poles.len();
            let x = &self.states.vectors::<S>()[first..][..2 * n];
            let u = &self.inputs.vectors::<S>()[first..][..2 * n];
            let ahead = &mut self.ahead.vectors_mut::<S>()[first + motion..][..2 * n + group.motions];
            for (k, step) in group.poles.iter().enumerate() {
                let [e_re, e_im, p_re, p_im] = [step[0], step[1], step[2], step[3]].map(|c| o.splat(c));
                let [x_re, x_im, u_re, u_im] = [x[k], x[n + k], u[k], u[n + k]];
                let driven = o.less(o.mul(p_re, u_re), p_im, u_im);
                ahead[k] = o.fma(e_re, x_re, o.less(driven, e_im, x_im));
                let driven = o.fma(p_re, u_im, o.mul(p_im, u_re));
                ahead[n + k] = o.fma(e_re, x_im, o.fma(e_im, x_re, driven));
            }
            for i in 0..group.motions {
                ahead[2 * n + i] = o.fma(h, slope[motion + i], velocity[motion + i]);
            }
            let now = &mut self.force_now.vectors_mut::<S>()[motion..][..group.motions];
            group.outputs.multiply(o, ahead, now);
            first += 2 * n;
            motion += group.motions;
        }
        self.predict_filters(o, of);
        let (now, before) = (self.force_now.vectors::<S>(), self.force.vectors::<S>());
        for (i, at_alpha) in self.at_alpha.vectors_mut::<S>().iter_mut().enumerate() {
            *at_alpha = f.at(o, now[i], before[i]);
        }
    }

    /// Adds the forces of filters at the step's end. Their states stand behind all others: of each group the real parts of all
    /// filters, then the imaginary ones.
    #[inline(always)]
    fn predict_filters<S: Simd>(&mut self, o: Ops<S>, of: &WaveKind) {
        let (behind, mut first, mut motion) = (2 * of.poles(), 0, 0);
        let (velocity, x) = (self.velocity.vectors::<S>(), &self.states.vectors::<S>()[behind..]);
        let now = self.force_now.vectors_mut::<S>();
        for group in &of.groups {
            let (g, rows) = (group.motions, group.motions * group.filters.len());
            let ahead = &mut self.filtered.vectors_mut::<S>()[first..][..2 * rows];
            for (k, step) in group.filters.iter().enumerate() {
                let [e_re, e_im, p_re, p_im] = [step[0], step[1], step[2], step[3]].map(|c| o.splat(c));
                for i in 0..g {
                    let at = k * g + i;
                    let (x_re, x_im, u) = (x[first + at], x[first + rows + at], velocity[motion + i]);
                    ahead[at] = o.fma(e_re, x_re, o.less(o.mul(p_re, u), e_im, x_im));
                    ahead[rows + at] = o.fma(e_re, x_im, o.fma(e_im, x_re, o.mul(p_im, u)));
                }
            }
            if rows > 0 {
                let pressed = &mut self.at_alpha.vectors_mut::<S>()[motion..][..g];
                group.filtered.multiply(o, ahead, pressed);
                for (now, pressed) in now[motion..].iter_mut().zip(&*pressed) {
                    *now = o.add(*now, *pressed);
                }
            }
            first += 2 * rows;
            motion += g;
        }
    }

    /// The states of filters at the step's end.
    #[inline(always)]
    fn follow_filters<S: Simd>(&mut self, o: Ops<S>, of: &WaveKind) {
        let (behind, mut first, mut motion) = (2 * of.poles(), 0, 0);
        let (velocity, ahead) = (self.velocity.vectors::<S>(), self.filtered.vectors::<S>());
        let x = &mut self.states.vectors_mut::<S>()[behind..];
        for group in &of.groups {
            let (g, rows) = (group.motions, group.motions * group.filters.len());
            for (k, step) in group.filters.iter().enumerate() {
                let (p_re, p_im) = (o.splat(step[4]), o.splat(step[5]));
                for i in 0..g {
                    let (at, u) = (k * g + i, velocity[motion + i]);
                    x[first + at] = o.fma(p_re, u, ahead[first + at]);
                    x[first + rows + at] = o.fma(p_im, u, ahead[first + rows + at]);
                }
            }
            first += 2 * rows;
            motion += g;
        }
    }

    /// The states at the step's end, where the modes have the velocity `v`; of lanes that are not `awake` nothing.
    #[inline(always)]
    fn follow<S: Simd>(&mut self, o: Ops<S>, h: f64, of: &WaveKind, v: &[S::f64s], awake: Option<S::f64s>) {
        let per_s = o.splat(1.0 / h);
        // the velocities of the last step make way in `force_now`, whose forces are kept first
        std::mem::swap(&mut self.force, &mut self.force_now);
        let new = self.force_now.vectors_mut::<S>();
        of.motions.multiply(o, v, new);
        if let Some(awake) = awake {
            for new in &mut *new {
                *new = o.mul(awake, *new);
            }
        }
        let (velocity, slope) = (self.velocity.vectors_mut::<S>(), self.slope.vectors_mut::<S>());
        for (i, new) in new.iter().enumerate() {
            slope[i] = o.mul(per_s, o.sub(*new, velocity[i]));
            velocity[i] = *new;
        }
        let (mut first, mut motion) = (0, 0);
        for group in &of.groups {
            let n = group.poles.len();
            let u = &mut self.inputs.vectors_mut::<S>()[first..][..2 * n];
            group.inputs.multiply(o, &velocity[motion..][..group.motions], u);
            let x = &mut self.states.vectors_mut::<S>()[first..][..2 * n];
            let ahead = &self.ahead.vectors::<S>()[first + motion..][..2 * n];
            for (k, step) in group.poles.iter().enumerate() {
                let (p_re, p_im) = (o.splat(step[4]), o.splat(step[5]));
                x[k] = o.fma(p_re, u[k], o.less(ahead[k], p_im, u[n + k]));
                x[n + k] = o.fma(p_re, u[n + k], o.fma(p_im, u[k], ahead[n + k]));
            }
            first += 2 * n;
            motion += group.motions;
        }
        self.follow_filters(o, of);
    }

    /// Operations of a step of `modes` modes, a lane.
    fn flop(&self, of: &WaveKind, modes: usize) -> f64 {
        let motions = self.velocity.rows();
        let of_groups = of.groups.iter().map(|group| {
            let n = group.poles.len();
            8 * n * group.motions
                + 2 * group.motions * group.motions
                + 24 * n
                + (18 + 2 * group.motions) * group.filters.len() * group.motions
        });
        (4 * motions * modes + 8 * motions + of_groups.sum::<usize>()) as f64
    }
}

impl LaneWaves {
    /// Rest.
    pub(super) fn new(of: &OperatorWaves, modes: usize, lanes: usize) -> Self {
        let (motions, poles) = (of.motions(), of.poles());
        Self {
            kinds: [0, 1].map(|kind| KindStates::new(motions[kind], poles[kind], lanes)),
            reach: LaneArray::new(1, lanes),
            awake: LaneArray::new(1, lanes),
            any_awake: false,
            modal: LaneArray::new(modes, lanes),
            spare: LaneArray::new(modes, lanes),
        }
    }

    /// What a lane carries from step to step.
    pub(super) fn carried(&mut self) -> impl Iterator<Item = &mut LaneArray> {
        let kinds = self.kinds.iter_mut().flat_map(KindStates::carried);
        kinds.chain([&mut self.reach, &mut self.awake])
    }

    /// The forces on the modes at alpha, with the velocities at the step's end as they go on (W7).
    #[inline(always)]
    pub(super) fn predict<S: Simd>(&mut self, o: Ops<S>, constants: &StepConstants) {
        let Some(waves) = &constants.waves else { return };
        self.any_awake = (0..S::F64_LANES).any(|lane| self.awake.at(0, lane) > 0.0);
        let [upright, rolls] = &mut self.kinds;
        upright.predict(o, constants, &waves.kinds[0]);
        let modal = self.modal.vectors_mut::<S>();
        waves.kinds[0]
            .forces
            .multiply(o, upright.at_alpha.vectors::<S>(), modal);
        if self.any_awake {
            rolls.predict(o, constants, &waves.kinds[1]);
            let spare = self.spare.vectors_mut::<S>();
            waves.kinds[1].forces.multiply(o, rolls.at_alpha.vectors::<S>(), spare);
            for (modal, spare) in modal.iter_mut().zip(spare) {
                *modal = o.add(*modal, *spare);
            }
        }
    }

    /// The states at the step's end, where the modes have the velocity `v`.
    #[inline(always)]
    pub(super) fn follow<S: Simd>(&mut self, o: Ops<S>, constants: &StepConstants, v: &LaneArray) {
        let Some(waves) = &constants.waves else { return };
        let (h, v) = (constants.scheme.h, v.vectors::<S>());
        let [upright, rolls] = &mut self.kinds;
        upright.follow(o, h, &waves.kinds[0], v, None);
        if self.any_awake {
            let awake = self.awake.vectors::<S>()[0];
            rolls.follow(o, h, &waves.kinds[1], v, Some(awake));
        }
        // a lane that wakes now rolls from the next step on, whatever the lanes beside it do
        let mut reach = self.reach.vectors::<S>()[0];
        for velocity in upright.velocity.vectors::<S>() {
            reach = o.max(reach, o.abs(*velocity));
        }
        self.reach.vectors_mut::<S>()[0] = reach;
        let mut rolling = o.splat(0.0);
        for &(k, roll) in &waves.rolling {
            rolling = o.max(rolling, o.mul(o.splat(roll), o.abs(v[k])));
        }
        self.spare.vectors_mut::<S>()[0] = rolling;
        for lane in 0..S::F64_LANES {
            if self.spare.at(0, lane) > ROLLS * self.reach.at(0, lane) {
                *self.awake.at_mut(0, lane) = 1.0;
            }
        }
    }

    /// Takes off the forces of pins what the water presses on their modules.
    #[inline(always)]
    pub(super) fn take_off_pins<S: Simd>(
        &self,
        o: Ops<S>,
        constants: &StepConstants,
        forces: &mut [S::f64s],
        spare: &mut [S::f64s],
    ) {
        let Some(waves) = &constants.waves else { return };
        for (kind, of) in self
            .kinds
            .iter()
            .zip(&waves.kinds)
            .take(1 + usize::from(self.any_awake))
        {
            of.pins.multiply(o, kind.at_alpha.vectors::<S>(), spare);
            for (force, pressed) in forces.iter_mut().zip(&*spare) {
                *force = o.sub(*force, *pressed);
            }
        }
    }

    /// Operations of a step, a lane.
    pub(super) fn flop(&self, constants: &StepConstants) -> f64 {
        let Some(waves) = &constants.waves else { return 0.0 };
        let kinds = self
            .kinds
            .iter()
            .zip(&waves.kinds)
            .take(1 + usize::from(self.any_awake));
        kinds.map(|(kind, of)| kind.flop(of, self.modal.rows())).sum()
    }
}
