//! Residual (static-correction) displacement of the deck nodes near the vehicle: `x + a x' = R f`, f = wheel and connector
//! forces.
//!
//! Knows how a node follows forces in a time step. Does not know who exerts them.

use super::loads::StationForce;
use super::step_constants::{ResidualRule, StepConstants};
use super::sums::{add_to, dot};
use super::wheel_lines::{DeckNode, WheelLines};
use crate::scheme::{Newmark, Scalar, Scheme};

/// Stations of a line side by side, the vehicle's own and one more at each end.
#[derive(Debug, Clone, Copy)]
struct NodeRun {
    line: usize,
    first: usize,
    count: usize,
    /// Where its nodes begin in the lists.
    from: usize,
}

/// The nodes' motion, one entry a node. Forces are what a node sees of them, `R f`, downward and pulling positive.
/// Equation (O2).
#[derive(Debug, Default)]
pub(super) struct LocalResidual {
    runs: Vec<NodeRun>,
    x: [Vec<f64>; 3],
    /// Of weights, inertia and connectors at the last step.
    weights: Vec<f64>,
    inertia: Vec<f64>,
    contact: Vec<f64>,
    /// Of the weights at the step under way; the change of x without new inertia and connector forces.
    weights_now: Vec<f64>,
    free: Vec<f64>,
    /// Of wheels on springs at the step under way, to add them up; of the last step they are among the weights.
    springs: Vec<f64>,
}

impl Clone for LocalResidual {
    fn clone(&self) -> Self {
        let mut clone = Self::default();
        clone.clone_from(self);
        clone
    }

    /// Keeps the room that is there.
    fn clone_from(&mut self, other: &Self) {
        self.runs.clone_from(&other.runs);
        for (own, other) in self.lists().into_iter().zip(other.listed()) {
            own.clone_from(other);
        }
    }
}

/// Forces on stations: line, station, force; and of the connectors.
#[derive(Debug, Clone, Copy)]
pub(super) struct StepForces<'a> {
    /// Lines of the weights.
    pub weights: &'a [StationForce],
    /// Of masses and of wheels on springs, on lines of nodes, at the last step.
    pub masses: &'a [StationForce],
    pub springs: &'a [StationForce],
    /// Connectors, at the last step.
    pub n: &'a [f64],
}

impl LocalResidual {
    /// Room for vehicles of at most `nodes` nodes.
    pub(super) fn new(nodes: usize) -> Self {
        let mut new = Self {
            runs: Vec::with_capacity(nodes),
            ..Self::default()
        };
        // two more on each line, of which there are fewer than nodes
        for list in new.lists() {
            list.reserve(3 * nodes);
        }
        new
    }

    fn lists(&mut self) -> [&mut Vec<f64>; 8] {
        let ([x, v, a], now, free) = (&mut self.x, &mut self.weights_now, &mut self.free);
        [
            x,
            v,
            a,
            &mut self.weights,
            &mut self.inertia,
            &mut self.contact,
            now,
            free,
        ]
    }

    fn listed(&self) -> [&Vec<f64>; 8] {
        let ([x, v, a], now, free) = (&self.x, &self.weights_now, &self.free);
        [x, v, a, &self.weights, &self.inertia, &self.contact, now, free]
    }

    /// No nodes.
    pub(super) fn clear(&mut self) {
        self.runs.clear();
        for list in self.lists() {
            list.clear();
        }
    }

    /// Follows the nodes near the vehicle from where they were, `old`, through the step as far as it is known: weights now
    /// and before, inertia and connector forces before. A node that comes near has stood still until then.
    #[inline(always)]
    pub(super) fn follow(
        &mut self,
        old: &Self,
        nodes: &[DeckNode],
        wheels: &WheelLines,
        constants: &StepConstants,
        modes: usize,
        pressing: StepForces,
    ) {
        self.runs.clear();
        for node in nodes {
            let mut new = true;
            for run in &mut self.runs {
                if run.line == node.line {
                    let end = (run.first + run.count).max(node.station + 1);
                    run.first = run.first.min(node.station);
                    run.count = end - run.first;
                    new = false;
                }
            }
            if new {
                self.runs.push(NodeRun {
                    line: node.line,
                    first: node.station,
                    count: 1,
                    from: 0,
                });
            }
        }
        let mut count = 0;
        for run in &mut self.runs {
            let end = (run.first + run.count + 1).min(wheels.stations());
            run.first = run.first.saturating_sub(1);
            run.count = end - run.first;
            run.from = count;
            count += run.count;
        }
        for list in self.lists() {
            list.clear();
            list.resize(count, 0.0);
        }
        for &(group, at, force) in pressing.weights {
            for &line in &wheels.weights[group].lines {
                press(&self.runs, &mut self.weights_now, wheels, line, at, force);
            }
        }
        for i in 0..self.runs.len() {
            self.take_over(self.runs[i], old, wheels, modes, pressing);
        }
        let s = &constants.scheme;
        let (now, before) = (&self.weights_now[..count], &self.weights[..count]);
        let (inertia, contact) = (&self.inertia[..count], &self.contact[..count]);
        let [x, v, a] = self.x.each_ref().map(|x| &x[..count]);
        let rule = ResidualRule::of(Scalar, constants);
        for (i, free) in self.free[..count].iter_mut().enumerate() {
            let force = -(s.at_f(now[i], before[i]) + s.alpha_m * inertia[i] + s.alpha_f * contact[i]);
            *free = rule.change(Scalar, force, [x[i], v[i], a[i]]);
        }
    }

    /// A run's motion: that of nodes known before, rest of the others.
    #[inline(always)]
    fn take_over(&mut self, run: NodeRun, old: &Self, wheels: &WheelLines, modes: usize, pressing: StepForces) {
        let (mut lo, mut hi) = (run.first, run.first);
        for before in &old.runs {
            if before.line == run.line {
                let first = run.first.max(before.first);
                let end = (run.first + run.count).min(before.first + before.count);
                if first < end {
                    (lo, hi) = (first, end);
                    let (to, from) = (run.from + lo - run.first, before.from + lo - before.first);
                    for (to_list, from_list) in self.lists().into_iter().zip(old.listed()).take(6) {
                        to_list[to..][..hi - lo].copy_from_slice(&from_list[from..][..hi - lo]);
                    }
                }
            }
        }
        for station in (run.first..lo).chain(hi..run.first + run.count) {
            let (i, line) = (run.from + station - run.first, run.line);
            self.weights[i] = self.weights_now[i];
            for (forces, to) in [
                (pressing.masses, &mut self.inertia[i]),
                (pressing.springs, &mut self.weights[i]),
            ] {
                for &(other, at, force) in forces {
                    let row = wheels.residual(other, at, line);
                    let seen = row.get((station + wheels.residual_band()).wrapping_sub(at));
                    *to += force * seen.copied().unwrap_or(0.0);
                }
            }
            self.contact[i] = of_connectors(wheels, line, station, modes, pressing.n);
            self.x[0][i] = -(self.weights[i] + self.inertia[i] + self.contact[i]);
        }
    }

    /// Takes the nodes to the end of the step, forces of masses, springs and connectors found.
    #[inline(always)]
    pub(super) fn lead(&mut self, wheels: &WheelLines, constants: &StepConstants, modes: usize, found: StepForces) {
        let n = found.n;
        self.inertia.fill(0.0);
        for &(line, at, force) in found.masses {
            press(&self.runs, &mut self.inertia, wheels, line, at, force);
        }
        for run in &self.runs {
            for (i, contact) in self.contact[run.from..][..run.count].iter_mut().enumerate() {
                *contact = of_connectors(wheels, run.line, run.first + i, modes, n);
            }
        }
        let s = &constants.scheme;
        if !found.springs.is_empty() {
            self.press_springs(wheels, constants, found.springs);
        }
        let count = self.free.len();
        let (inertia, contact, free) = (&self.inertia[..count], &self.contact[..count], &self.free[..count]);
        let [x, v, a] = self.x.each_mut().map(|x| &mut x[..count]);
        let newmark = Newmark::of(Scalar, s);
        for i in 0..count {
            let late = (1.0 - s.alpha_m) * inertia[i] + (1.0 - s.alpha_f) * contact[i];
            [x[i], v[i], a[i]] = newmark.advance(Scalar, free[i] - constants.rho * late, [x[i], v[i], a[i]]);
        }
        self.weights.copy_from_slice(&self.weights_now);
    }

    /// Forces of wheels on springs: with the connectors in this step, with the weights in the next.
    fn press_springs(&mut self, wheels: &WheelLines, constants: &StepConstants, springs: &[StationForce]) {
        self.springs.clear();
        self.springs.resize(self.free.len(), 0.0);
        for &(line, at, force) in springs {
            press(&self.runs, &mut self.springs, wheels, line, at, force);
        }
        let factor = constants.rho * (1.0 - constants.scheme.alpha_f);
        for ((free, now), spring) in self.free.iter_mut().zip(&mut self.weights_now).zip(&self.springs) {
            *free -= factor * spring;
            *now += spring;
        }
    }

    /// A node's acceleration, velocity and displacement at the end of the step without new inertia and connector forces.
    #[inline(always)]
    pub(super) fn free(&self, node: DeckNode, s: &Scheme) -> [f64; 3] {
        for run in &self.runs {
            if run.line == node.line {
                let i = run.from + node.station - run.first;
                let old = [self.x[0][i], self.x[1][i], self.x[2][i]];
                let [x, v, a] = Newmark::of(Scalar, s).advance(Scalar, self.free[i], old);
                return [a, v, x];
            }
        }
        [0.0; 3]
    }
}

/// Adds what nodes see of a force on a station.
#[inline(always)]
fn press(runs: &[NodeRun], seen: &mut [f64], wheels: &WheelLines, line: usize, station: usize, force: f64) {
    let band = wheels.residual_band();
    for run in runs {
        let lo = run.first.max(station.saturating_sub(band));
        let hi = (run.first + run.count).min(station + band + 1);
        if lo < hi {
            let row = &wheels.residual(line, station, run.line)[lo + band - station..hi + band - station];
            add_to(&mut seen[run.from + lo - run.first..][..hi - lo], force, row);
        }
    }
}

/// What a node sees of the connectors.
#[inline(always)]
fn of_connectors(wheels: &WheelLines, line: usize, station: usize, modes: usize, n: &[f64]) -> f64 {
    let influence = wheels.influence(DeckNode { line, station });
    dot(&influence[modes..][..n.len()], n)
}
