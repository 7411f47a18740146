//! The memory of the water as a convolution over what has been: the reference for states.
//!
//! Knows velocities at the ends of whole steps and, in a step that is halved, at the ends of its parts. Does not know bridges.

use super::{Radiation, Window};
use nalgebra::{DMatrix, DVector};
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
    /// Velocities r' at the ends of whole steps, the last one behind; the first was rest.
    whole: Arc<Vec<Vec<f64>>>,
    /// Times since the last of these `[s]` and velocities, where a step is halved.
    parts: Vec<(f64, Vec<f64>)>,
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
        let all = kernel.windowed(h, samples, window);
        let n = kernel.freedoms();
        let scaled: Vec<DMatrix<f64>> = all.iter().map(|k| radiation.scales().scaled(k)).collect();
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
            samples,
        }
    }

    /// Rest.
    pub(crate) fn at_rest(&self) -> Remembered {
        let zero = || vec![0.0; self.first[0].nrows()];
        Remembered {
            whole: Arc::new(vec![zero()]),
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
        let begin = (0.0, old.whole.last().cloned().unwrap_or_default());
        let ends: Vec<&(f64, Vec<f64>)> = [&begin].into_iter().chain(&old.parts).collect();
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
            new.parts.push((since, velocity));
            return new;
        }
        new.parts.clear();
        let whole = Arc::make_mut(&mut new.whole);
        whole.push(velocity);
        new.faded = [new.force.clone(), self.faded(whole)];
        new
    }

    /// The force a whole step later of the velocities so far, the last one at half its weight.
    fn faded(&self, whole: &[Vec<f64>]) -> Vec<f64> {
        let mut force = vec![0.0; self.first[0].nrows()];
        for (group, entries) in &self.groups {
            let n = group.len();
            let mut sum = vec![0.0; n];
            // lag j of the velocity j - 1 before the last
            let lags = entries
                .chunks_exact(n * n)
                .skip(1)
                .zip(whole.iter().rev())
                .take(self.samples);
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
