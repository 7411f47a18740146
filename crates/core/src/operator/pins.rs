//! The pins of every lane: their forces where the balance holds, and extremes of these.
//!
//! Knows the motion and the forces of a step, and how a force is looked at. Does not know what the rows of pins are made of.

use super::basis::Sizes;
use super::connectors::Connectors;
use super::lane_array::LaneArray;
use super::lane_waves::LaneWaves;
use super::modes::Modes;
use super::step_constants::StepConstants;
use super::vector::{Mean, Ops};
use crate::response::{DeadState, ForcePeaks, Peak, PinExtremes, PinPeaks};
use crate::scheme::Arithmetic;
use pulp::Simd;

/// Directions of a pin: along, across, up.
const DIRECTIONS: usize = 3;

/// Pins of every lane.
#[derive(Debug, Clone)]
pub(super) struct Pins {
    /// Joint of each pin.
    places: Vec<(usize, f64)>,
    /// `q, q', q''` before the step.
    old: [LaneArray; 3],
    /// What pins see of weights and of inertia forces beside the modes, at the last step and at the one under way.
    weights: LaneArray,
    weights_now: LaneArray,
    inertia: LaneArray,
    inertia_now: LaneArray,
    /// Motion of the modes and forces of the connectors at the balance, and the forces of the pins there.
    balance: LaneArray,
    forces: LaneArray,
    /// Velocity of the modes at the balance, and forces that are taken off.
    velocity: LaneArray,
    taken: LaneArray,
    /// Forces at rest, and whether there are any in a lane.
    rest: LaneArray,
    from_rest: Vec<bool>,
    /// When that is `[s]`.
    time_s: LaneArray,
    /// Extremes and their times: of each pin against and with each axis and the resultant, and of each joint's sum behind its
    /// pins.
    value: LaneArray,
    time: LaneArray,
}

/// Extremes of a pin: against and with three axes, the resultant.
const EXTREMES: usize = 2 * DIRECTIONS + 1;

impl Pins {
    pub(super) fn new(sizes: &Sizes, places: &[(usize, f64)], lanes: usize) -> Self {
        let rows = sizes.pins;
        let modes = if rows == 0 { 0 } else { sizes.modes };
        let connectors = if rows == 0 { 0 } else { sizes.connectors };
        let of = |rows: usize| LaneArray::new(rows, lanes);
        let joints = places.chunk_by(|a, b| a.0 == b.0).count();
        let extremes = EXTREMES * (places.len() + joints);
        Self {
            places: places.to_vec(),
            old: [of(modes), of(modes), of(modes)],
            weights: of(rows),
            weights_now: of(rows),
            inertia: of(rows),
            inertia_now: of(rows),
            balance: of(2 * modes + connectors),
            forces: of(rows),
            velocity: of(modes),
            taken: of(rows),
            rest: of(rows),
            from_rest: vec![false; lanes],
            time_s: of(1),
            value: of(extremes),
            time: of(extremes),
        }
    }

    /// Whether pins are followed.
    #[inline(always)]
    pub(super) fn is_empty(&self) -> bool {
        self.places.is_empty()
    }

    /// What a lane carries from step to step.
    pub(super) fn carried(&mut self) -> [&mut LaneArray; 4] {
        [&mut self.weights, &mut self.inertia, &mut self.value, &mut self.time]
    }

    /// What a step leaves in a lane that no crossing writes any more.
    pub(super) fn left(&mut self) -> [&mut LaneArray; 2] {
        [&mut self.weights_now, &mut self.inertia_now]
    }

    /// Takes the forces of a lane at rest.
    pub(super) fn take_rest(&mut self, lane: usize, dead: Option<&DeadState>) {
        self.from_rest[lane] = dead.is_some() && !self.is_empty();
        self.rest.clear(lane);
        if let Some(dead) = dead {
            self.rest
                .lane_mut(lane)
                .zip(dead.pins_n.iter().flatten())
                .for_each(|(to, n)| *to = *n);
        }
    }

    /// What pins see of weights and of inertia forces in the step under way.
    pub(super) fn loads_now(&mut self) -> [&mut LaneArray; 2] {
        [&mut self.weights_now, &mut self.inertia_now]
    }

    /// Keeps the motion before the step's end.
    #[inline(always)]
    pub(super) fn keep(&mut self, modes: &Modes) {
        for (old, now) in self.old.iter_mut().zip(modes.motion()) {
            old.copy_all(now);
        }
    }

    /// The forces of the step's balance, and their extremes (O9). The connectors have ended the step.
    #[inline(always)]
    pub(super) fn update<S: Simd>(
        &mut self,
        o: Ops<S>,
        constants: &StepConstants,
        (modes, waves, connectors): (&Modes, Option<&LaneWaves>, &Connectors),
        end_s: &[f64],
    ) {
        let s = &constants.scheme;
        let (f, m) = (Mean::<S>::of(o, s.alpha_f), Mean::<S>::of(o, s.alpha_m));
        let (a, b) = (o.splat(constants.rayleigh.a), o.splat(constants.rayleigh.b));
        let [q, v, acceleration] = modes.motion().map(|of| of.vectors::<S>());
        let [old_q, old_v, old_a] = self.old.each_ref().map(|of| of.vectors::<S>());
        let count = q.len();
        let balance = self.balance.vectors_mut::<S>();
        for k in 0..count {
            let velocity = f.at(o, v[k], old_v[k]);
            balance[k] = o.fma(a, velocity, f.at(o, q[k], old_q[k]));
            balance[count + k] = o.fma(b, velocity, m.at(o, acceleration[k], old_a[k]));
        }
        let [now, before] = connectors.forces().map(|of| of.vectors::<S>());
        for (i, force) in balance[2 * count..].iter_mut().enumerate() {
            *force = f.at(o, now[i], before[i]);
        }
        let forces = self.forces.vectors_mut::<S>();
        constants.panels.pins.multiply(o, self.balance.vectors::<S>(), forces);
        if let Some(undamped) = &constants.panels.pins_undamped {
            let alpha = self.velocity.vectors_mut::<S>();
            for k in 0..count {
                alpha[k] = f.at(o, v[k], old_v[k]);
            }
            let taken = self.taken.vectors_mut::<S>();
            undamped.multiply(o, alpha, taken);
            for (force, taken) in forces.iter_mut().zip(&*taken) {
                *force = o.sub(*force, *taken);
            }
        }
        if let Some(waves) = waves {
            waves.take_off_pins(o, constants, forces, self.taken.vectors_mut::<S>());
        }
        let (w_now, w_old) = (self.weights_now.vectors::<S>(), self.weights.vectors::<S>());
        let (i_now, i_old) = (self.inertia_now.vectors::<S>(), self.inertia.vectors::<S>());
        for (i, force) in forces.iter_mut().enumerate() {
            let down = o.add(f.at(o, w_now[i], w_old[i]), m.at(o, i_now[i], i_old[i]));
            *force = o.sub(*force, down);
        }
        if self.from_rest.contains(&true) {
            for (force, rest) in forces.iter_mut().zip(self.rest.vectors::<S>()) {
                *force = o.add(*force, *rest);
            }
        }
        self.time_s.write_row(end_s.iter().map(|end_s| end_s - s.alpha_f * s.h));
        self.update_extremes(o);
        std::mem::swap(&mut self.weights, &mut self.weights_now);
        std::mem::swap(&mut self.inertia, &mut self.inertia_now);
    }

    /// Raises the extremes of each pin and of each joint's sum.
    #[inline(always)]
    fn update_extremes<S: Simd>(&mut self, o: Ops<S>) {
        let now = self.time_s.vectors::<S>()[0];
        let forces = self.forces.vectors::<S>();
        let (value, time) = (self.value.vectors_mut::<S>(), self.time.vectors_mut::<S>());
        let (mut at, mut sum) = (0, [o.splat(0.0); DIRECTIONS]);
        for (pin, force) in forces.chunks_exact(DIRECTIONS).enumerate() {
            raise(
                o,
                now,
                [force[0], force[1], force[2]],
                &mut value[at..],
                &mut time[at..],
            );
            at += EXTREMES;
            for (sum, force) in sum.iter_mut().zip(force) {
                *sum = o.add(*sum, *force);
            }
            if self.places.get(pin + 1).is_none_or(|next| next.0 != self.places[pin].0) {
                raise(o, now, sum, &mut value[at..], &mut time[at..]);
                at += EXTREMES;
                sum = [o.splat(0.0); DIRECTIONS];
            }
        }
    }

    /// Instant of the last step's balance in a lane `[s]`; none where pins are not followed.
    pub(super) fn balance_s(&self, lane: usize) -> Option<f64> {
        (!self.is_empty()).then(|| self.time_s.at(0, lane))
    }

    /// Force of a connector at that instant `[N]`.
    pub(super) fn connector_n(&self, connector: usize, lane: usize) -> f64 {
        let first = 2 * self.old[0].rows();
        if first + connector < self.balance.rows() {
            self.balance.at(first + connector, lane)
        } else {
            0.0
        }
    }

    /// Force of a pin at that instant `[N]`.
    pub(super) fn force_n(&self, pin: usize, lane: usize) -> [f64; DIRECTIONS] {
        std::array::from_fn(|axis| {
            let row = DIRECTIONS * pin + axis;
            if row < self.forces.rows() {
                self.forces.at(row, lane)
            } else {
                0.0
            }
        })
    }

    /// The peaks of a lane.
    pub(super) fn peaks(&self, lane: usize) -> Vec<PinPeaks> {
        let mut at = 0;
        let mut extremes = || {
            let peak = |i: usize| Peak {
                value: self.value.at(at + i, lane),
                time_s: self.time.at(at + i, lane),
            };
            let components = [0, 1, 2].map(|d| ForcePeaks {
                compression: peak(2 * d),
                tension: peak(2 * d + 1),
            });
            let resultant = peak(2 * DIRECTIONS);
            at += EXTREMES;
            PinExtremes { components, resultant }
        };
        let mut peaks = Vec::new();
        for joint in self.places.chunk_by(|a, b| a.0 == b.0) {
            for y_m in joint.iter().map(|(_, y_m)| Some(*y_m)).chain([None]) {
                peaks.push(PinPeaks {
                    joint: joint[0].0,
                    y_m,
                    extremes: extremes(),
                });
            }
        }
        peaks
    }
}

/// Raises the extremes of one force.
#[inline(always)]
fn raise<S: Simd>(o: Ops<S>, now: S::f64s, force: [S::f64s; DIRECTIONS], value: &mut [S::f64s], time: &mut [S::f64s]) {
    let [x, y, z] = force;
    let resultant = o.0.sqrt_f64s(o.fma(x, x, o.fma(y, y, o.mul(z, z))));
    let all = [o.neg(x), x, o.neg(y), y, o.neg(z), z, resultant];
    for ((new, value), time) in all.into_iter().zip(value).zip(time) {
        let larger = o.0.greater_than_f64s(new, *value);
        *value = o.0.select_f64s(larger, new, *value);
        *time = o.0.select_f64s(larger, now, *time);
    }
}
