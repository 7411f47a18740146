//! The memory of the water as a convolution over what has been: the reference for states.
//!
//! Knows velocities at the ends of whole steps and, in a step that is halved, at the ends of its parts. Does not know bridges.

use super::{Radiation, Scales, Window};
use nalgebra::{DMatrix, DVector};
use std::collections::VecDeque;
use std::sync::Arc;

/// Largest entry of a coupling, in scaled freedoms and as a share of the memory's largest, of freedoms that do not drive each other.
const NO_COUPLING: f64 = 1e-9;

/// A kernel at the ends of whole steps, in its window: `F_1 = -(h/2) k_0 r'_1 - h sum over j >= 1 of k_j r'_(1-j)`.
#[derive(Debug)]
pub(crate) struct Convolution {
    /// Length of a whole step `[s]`.
    h: f64,
    /// Freedoms that drive each other, and their k_j one after the other, each column by column.
    groups: Vec<(Vec<usize>, Vec<f64>)>,
    /// `k_0`, `k_1`.
    first: [DMatrix<f64>; 2],
    samples: usize,
}

/// What a convolution remembers at an instant.
#[derive(Debug, Clone, Default)]
pub(crate) struct Remembered {
    /// Velocities r' at the ends of whole steps, the last one behind, as far back as the kernel reaches.
    whole: VecDeque<Arc<[f64]>>,
    /// Times since the last of these `[s]` and velocities, where a step is halved.
    parts: Vec<(f64, Arc<[f64]>)>,
    /// Force of the water at the last whole step, and a whole step later of what was until then.
    faded: [Vec<f64>; 2],
    /// Force at the instant `[N, N m]`.
    pub(crate) force: Vec<f64>,
}

impl Convolution {
    /// The memory of a water at whole steps of `h` `[s]`.
    pub(crate) fn new(radiation: &Radiation, h: f64) -> Self {
        let window = Window::CONVOLUTION;
        let samples = (window.zero_from_s() / h).ceil() as usize + 1;
        let kernel = radiation.kernel();
        Self::of_samples(h, &kernel.windowed(h, samples, window), radiation.scales())
    }

    /// The memory of a kernel at whole steps of `h` `[s]`, 0 beyond its samples.
    fn of_samples(h: f64, all: &[DMatrix<f64>], scales: &Scales) -> Self {
        let n = scales.freedoms();
        let scaled: Vec<DMatrix<f64>> = all.iter().map(|k| scales.scaled(k)).collect();
        let largest = scaled.iter().map(DMatrix::amax).fold(0.0, f64::max);
        let coupled = |i: usize, j: usize| scaled.iter().any(|k| k[(i, j)].abs() > NO_COUPLING * largest);
        let mut groups: Vec<Vec<usize>> = Vec::new();
        for i in 0..n {
            let (with, without): (Vec<_>, Vec<_>) = groups
                .into_iter()
                .partition(|group: &Vec<usize>| group.iter().any(|&j| coupled(i, j)));
            let mut own: Vec<usize> = with.into_iter().flatten().chain([i]).collect();
            own.sort_unstable();
            groups = without;
            groups.push(own);
        }
        let of_group = |group: Vec<usize>| {
            let column = |k: &DMatrix<f64>, j: usize| group.iter().map(|&i| k[(i, j)]).collect::<Vec<_>>();
            let entries = all
                .iter()
                .flat_map(|k| group.iter().flat_map(|&j| column(k, j)).collect::<Vec<_>>());
            let entries = entries.collect();
            (group, entries)
        };
        Self {
            h,
            first: [0, 1].map(|j| all.get(j).cloned().unwrap_or_else(|| DMatrix::zeros(n, n))),
            groups: groups.into_iter().map(of_group).collect(),
            samples: all.len(),
        }
    }

    /// Rest.
    pub(crate) fn at_rest(&self) -> Remembered {
        let zero = || vec![0.0; self.first[0].nrows()];
        Remembered {
            whole: VecDeque::from([zero().into()]),
            parts: Vec::new(),
            faded: [zero(), zero()],
            force: zero(),
        }
    }

    /// What r'_1 adds to the force at the end of a step of `step_s` is `-(step_s / 2) k_0 r'_1` `[s, and as k_0]`.
    pub(crate) fn at_end(&self, step_s: f64) -> DMatrix<f64> {
        &self.first[0] * (0.5 * step_s)
    }

    /// The force at the end of a step of `step_s` without what the velocity there adds.
    pub(crate) fn known(&self, old: &Remembered, step_s: f64) -> Vec<f64> {
        let since = old.parts.last().map_or(0.0, |part| part.0);
        let at = since + step_s;
        let share = at / self.h;
        let faded = old.faded[0].iter().zip(&old.faded[1]);
        let mut known: Vec<f64> = faded.map(|(now, later)| now + share * (later - now)).collect();
        // trapezoids over the parts, the kernel linear over a whole step
        let begin = old.whole.back().map(|velocity| (0.0, Arc::clone(velocity)));
        let ends: Vec<&(f64, Arc<[f64]>)> = begin.iter().chain(&old.parts).collect();
        for (i, (time, velocity)) in ends.iter().enumerate() {
            let before = if i == 0 { *time } else { ends[i - 1].0 };
            let after = ends.get(i + 1).map_or(at, |end| end.0);
            let lag = (at - time) / self.h;
            let weight = 0.5 * (after - before);
            let kernel = &self.first[0] * (1.0 - lag) + &self.first[1] * lag;
            let pressed = kernel * DVector::from_column_slice(velocity);
            known.iter_mut().zip(pressed.iter()).for_each(|(f, p)| *f -= weight * p);
        }
        known
    }

    /// Takes the velocity and the force at the end of a step of `step_s`.
    pub(crate) fn follow(&self, old: &Remembered, step_s: f64, velocity: Vec<f64>, force: Vec<f64>) -> Remembered {
        let since = old.parts.last().map_or(0.0, |part| part.0) + step_s;
        let mut new = Remembered { force, ..old.clone() };
        if (since - self.h).abs() > 1e-9 * self.h {
            new.parts.push((since, velocity.into()));
            return new;
        }
        new.parts.clear();
        if new.whole.len() == self.samples {
            new.whole.pop_front();
        }
        new.whole.push_back(velocity.into());
        new.faded = [new.force.clone(), self.faded(&new.whole)];
        new
    }

    /// The force a whole step later of the velocities so far, the last one at half its weight.
    fn faded(&self, whole: &VecDeque<Arc<[f64]>>) -> Vec<f64> {
        let mut force = vec![0.0; self.first[0].nrows()];
        for (group, entries) in &self.groups {
            let n = group.len();
            let mut sum = vec![0.0; n];
            // lag j of the velocity j - 1 before the last
            let lags = entries.chunks_exact(n * n).skip(1).zip(whole.iter().rev());
            for (j, (kernel, velocity)) in lags.enumerate() {
                let weight = if j == 0 { 0.5 * self.h } else { self.h };
                for (column, &freedom) in kernel.chunks_exact(n).zip(group) {
                    let v = weight * velocity[freedom];
                    sum.iter_mut().zip(column).for_each(|(sum, k)| *sum += k * v);
                }
            }
            group.iter().zip(&sum).for_each(|(&freedom, sum)| force[freedom] = -sum);
        }
        force
    }
}

#[cfg(test)]
mod tests {
    use super::super::StepCoefficients;
    use super::*;
    use crate::scheme::Scheme;
    use nalgebra::Complex;

    /// `u'' + 5 u + int 3 e^(-1.2 (t - s)) u'(s) ds = 0` from u = 1 at rest, at 1, 2 and 5 s: the roots of
    /// `s^3 + 1.2 s^2 + 8 s + 6`.
    const EXACT: [f64; 3] = [-0.303_123_78, 0.321_684_77, 0.130_037_88];

    /// How the memory of the one freedom is kept: force at the step's end by what is known, part of the end's velocity, and how to go on.
    trait Memory {
        fn known(&self, h: f64) -> (f64, f64);
        fn follow(&mut self, h: f64, v: f64, force: f64);
    }

    struct Convolved(Convolution, Remembered);

    impl Memory for Convolved {
        fn known(&self, h: f64) -> (f64, f64) {
            (self.0.known(&self.1, h)[0], self.0.at_end(h)[(0, 0)])
        }

        fn follow(&mut self, h: f64, v: f64, force: f64) {
            self.1 = self.0.follow(&self.1, h, vec![v, 0.0, 0.0], vec![force, 0.0, 0.0]);
        }
    }

    /// One state; the velocity at the step's end goes on by its last slope.
    struct State {
        step: StepCoefficients,
        x: f64,
        v: f64,
        slope: f64,
        ahead: f64,
        factor: f64,
    }

    impl Memory for State {
        fn known(&self, h: f64) -> (f64, f64) {
            let ahead = self.step.decay.re * self.x + self.step.p0_s.re * self.v;
            let v = self.v + h * self.slope;
            (-3.0 * self.factor * (ahead + self.step.p1_s.re * v), 0.0)
        }

        fn follow(&mut self, h: f64, v: f64, _: f64) {
            self.ahead = self.step.decay.re * self.x + self.step.p0_s.re * self.v;
            self.x = self.ahead + self.step.p1_s.re * v;
            self.slope = (v - self.v) / h;
            self.v = v;
        }
    }

    /// u at 1, 2 and 5 s.
    fn solved(h: f64, rho: f64, memory: &mut dyn Memory) -> [f64; 3] {
        let s = Scheme::new(h, rho);
        let (c_m, c_c, c_k) = s.effective();
        let (mut u, mut v, mut a, mut force) = (1.0, 0.0, -5.0, 0.0);
        let mut found = Vec::new();
        for step in 1..=(5.0 / h).round() as usize {
            let (known, at_end) = memory.known(h);
            let (free_v, free_a) = (s.v_v * v + s.v_a * a, s.a_v * v + s.a_a * a);
            let right = s.at_f(known - at_end * free_v, force) - s.at_m(free_a, a) - 5.0 * u;
            let d = right / (c_m + c_c * at_end + 5.0 * c_k);
            let new_v = s.c_v * d + free_v;
            force = known - at_end * new_v;
            (u, v, a) = (u + d, new_v, s.c_a * d + free_a);
            memory.follow(h, v, force);
            if [1.0, 2.0, 5.0].iter().any(|t| (step as f64 * h - t).abs() < 0.5 * h) {
                found.push(u);
            }
        }
        [found[0], found[1], found[2]]
    }

    fn convolved(h: f64, rho: f64, factor: f64) -> [f64; 3] {
        let sample = |i: usize| {
            let k = 3.0 * factor * (-1.2 * h * i as f64).exp();
            DMatrix::from_fn(3, 3, |a, b| if a == 0 && b == 0 { k } else { 0.0 })
        };
        let samples: Vec<_> = (0..=(6.0 / h) as usize).map(sample).collect();
        let memory = Convolution::of_samples(h, &samples, &Scales::new(&[1.0], 1.0).unwrap());
        let rest = memory.at_rest();
        solved(h, rho, &mut Convolved(memory, rest))
    }

    fn by_state(h: f64, rho: f64, factor: f64) -> [f64; 3] {
        let step = StepCoefficients::new(Complex::new(-1.2, 0.0), h);
        let (x, v, slope, ahead) = (0.0, 0.0, -5.0, 0.0);
        solved(
            h,
            rho,
            &mut State {
                step,
                x,
                v,
                slope,
                ahead,
                factor,
            },
        )
    }

    /// Steps of 2 and 1 ms, taken to 0, are the closed form to 1e-6, and errors fall as the square of the step: 1.9 to 2.1. A memory
    /// 5 % weaker is off by more than 1e-3.
    #[test]
    fn an_exponential_memory_has_its_closed_form() {
        for (what, solved) in [
            ("convolution", convolved as fn(f64, f64, f64) -> [f64; 3]),
            ("state", by_state),
        ] {
            for rho in [0.9, 1.0] {
                let limit = |factor: f64| -> f64 {
                    let [coarse, fine] = [0.002, 0.001].map(|h| solved(h, rho, factor));
                    let miss = |i: usize| ((4.0 * fine[i] - coarse[i]) / 3.0 - EXACT[i]).abs();
                    (0..3).map(miss).fold(0.0, f64::max)
                };
                assert!(limit(1.0) < 1e-6, "{what}, rho {rho}: {:e}", limit(1.0));
                assert!(limit(0.95) > 1e-3, "{what}: a weaker memory passes");
                let error = |h: f64| {
                    (0..3)
                        .map(|i| (solved(h, rho, 1.0)[i] - EXACT[i]).abs())
                        .fold(0.0, f64::max)
                };
                let order = (error(0.02) / error(0.01)).log2();
                assert!((1.9..2.1).contains(&order), "{what}, rho {rho}: order {order}");
            }
        }
    }

    /// Steps in halves, one after another, are as good as whole ones.
    #[test]
    fn halved_steps_go_on_as_whole_ones() {
        let sample = |i: usize| {
            DMatrix::from_fn(3, 3, |a, b| {
                if a == b {
                    3.0 * (-1.2 * 0.02 * i as f64).exp()
                } else {
                    0.0
                }
            })
        };
        let samples: Vec<_> = (0..300).map(sample).collect();
        let memory = Convolution::of_samples(0.02, &samples, &Scales::new(&[1.0], 1.0).unwrap());
        // the memory of v = sin t in closed form
        let exact = |t: f64| -3.0 * (1.2 * t.sin() - t.cos() + (-1.2 * t).exp()) / (1.0 + 1.44);
        let run = |parts: &dyn Fn(usize) -> usize| {
            let (mut state, mut t) = (memory.at_rest(), 0.0_f64);
            for whole in 0..100 {
                let parts = parts(whole);
                for part in 1..=parts {
                    let h = 0.02 / parts as f64;
                    t = 0.02 * whole as f64 + h * part as f64;
                    let v = vec![t.sin(); 3];
                    let mut force = memory.known(&state, h);
                    let at_end = memory.at_end(h) * DVector::from_column_slice(&v);
                    force.iter_mut().zip(at_end.iter()).for_each(|(f, p)| *f -= p);
                    state = memory.follow(&state, h, v, force);
                }
            }
            (state.force[0] - exact(t)).abs()
        };
        let (whole, halved) = (run(&|_| 1), run(&|whole| if whole % 3 == 1 { 4 } else { 1 }));
        assert!(whole < 1e-4 && halved < 1e-4, "{whole:e} {halved:e}");
    }
}
