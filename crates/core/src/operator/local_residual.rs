//! Residual (static-correction) displacement of the deck nodes near the vehicles: `x + a x' = R f`, f = wheel and connector
//! forces.
//!
//! Knows how nodes follow forces in a time step, those of lanes that go together at once. Does not know who exerts them.

use super::deck_forces::{NodeForces, StationForce};
use super::lane_array::{LaneArray, Trace};
use super::lane_group::{LaneGroup, UnitForce};
use super::step_constants::{ResidualRule, StepConstants};
use super::vector::{Mean, Ops};
use super::wheel_lines::{DeckNode, WheelLines};
use crate::scheme::{Arithmetic, Newmark};
use pulp::Simd;

/// Stations of a line side by side, the vehicle's own and one more at each end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct NodeRun {
    line: usize,
    first: usize,
    count: usize,
    /// Where its nodes begin in the lists.
    from: usize,
}

/// The nodes' motion, one row a node. Forces are what a node sees of them, `R f`, downward and pulling positive.
/// Equation (O2).
#[derive(Debug)]
pub(super) struct LocalResidual {
    /// Of each lane.
    runs: Vec<Vec<NodeRun>>,
    x: Trace,
    /// Of weights, inertia and connectors at the last step.
    weights: LaneArray,
    inertia: LaneArray,
    contact: LaneArray,
    /// Of the weights at the step under way; the change of x without new inertia and connector forces.
    weights_now: LaneArray,
    free: LaneArray,
    /// Forces being added up.
    sum: LaneArray,
}

/// The nodes' motion in one lane.
#[derive(Debug, Clone, Default)]
pub(super) struct SavedResidual {
    runs: Vec<NodeRun>,
    numbers: Vec<f64>,
}

impl LocalResidual {
    /// Room for vehicles of at most `nodes` nodes.
    pub(super) fn new(nodes: usize, lanes: usize) -> Self {
        // two more on each line, of which there are fewer than nodes
        let of = || LaneArray::new(3 * nodes, lanes);
        Self {
            runs: vec![Vec::with_capacity(nodes); lanes],
            x: Trace::new(3 * nodes, lanes),
            weights: of(),
            inertia: of(),
            contact: of(),
            weights_now: of(),
            free: of(),
            sum: of(),
        }
    }

    /// What is carried from step to step.
    fn carried(&mut self) -> [&mut LaneArray; 6] {
        let [x, v, a] = self.x.all();
        [x, v, a, &mut self.weights, &mut self.inertia, &mut self.contact]
    }

    /// Has room for so many nodes: one vehicle after another on a line makes all stations between them near.
    #[inline(always)]
    fn ensure_rows(&mut self, rows: usize) {
        if self.sum.rows() < rows {
            for list in self.carried() {
                list.ensure_rows(rows);
            }
            for list in [&mut self.weights_now, &mut self.free, &mut self.sum] {
                list.ensure_rows(rows);
            }
        }
    }

    /// No nodes in a lane.
    pub(super) fn clear(&mut self, lane: usize) {
        self.runs[lane].clear();
    }

    /// A lane's nodes.
    pub(super) fn save(&mut self, lane: usize) -> SavedResidual {
        let runs = self.runs[lane].clone();
        let rows: usize = runs.iter().map(|run| run.count).sum();
        let numbers = self
            .carried()
            .into_iter()
            .flat_map(|list| list.lane(lane).take(rows).collect::<Vec<_>>());
        SavedResidual {
            numbers: numbers.collect(),
            runs,
        }
    }

    /// Puts a lane's nodes.
    pub(super) fn restore(&mut self, lane: usize, saved: &SavedResidual) {
        self.runs[lane].clone_from(&saved.runs);
        let rows: usize = saved.runs.iter().map(|run| run.count).sum();
        if rows == 0 {
            return;
        }
        self.ensure_rows(rows);
        for (list, saved) in self.carried().into_iter().zip(saved.numbers.chunks_exact(rows)) {
            list.lane_mut(lane).zip(saved).for_each(|(to, x)| *to = *x);
        }
    }

    /// Takes a lane's nodes from a lane of another.
    #[inline(always)]
    pub(super) fn take_lane(&mut self, lane: usize, (from, of): (&Self, usize)) {
        self.runs[lane].clone_from(&from.runs[of]);
        let rows = self.runs[lane].iter().map(|run| run.count).sum();
        self.ensure_rows(rows);
        for (to, list) in self.carried().into_iter().zip(from.listed()) {
            to.take_lane(lane, rows, (list, of));
        }
    }

    /// Whether two lanes have the same nodes.
    pub(super) fn alike(&self, lane: usize, other: usize) -> bool {
        self.runs[lane] == self.runs[other]
    }

    /// Follows the nodes near the vehicles of a group from where they were, `old`, through the step as far as it is known: weights
    /// now and before, inertia and connector forces before, which are masses and springs of each lane and the connectors `n`. A node
    /// that comes near has stood still until then.
    #[inline(always)]
    pub(super) fn follow<S: Simd>(
        &mut self,
        o: Ops<S>,
        old: &Self,
        group: &LaneGroup,
        nodes: &[DeckNode],
        (wheels, constants): (&WheelLines, &StepConstants),
        (before, n): (&[[&[StationForce]; 2]], &LaneArray),
    ) {
        let first = group.first();
        let count = self.find_runs(group, nodes, wheels.stations());
        self.ensure_rows(count);
        let (mask, modes) = (group.mask(o), constants.c.len());
        self.sum.clear_rows(count);
        for &UnitForce {
            line,
            station,
            vehicle,
            share,
        } in &group.weights
        {
            let force = o.mul(o.splat(share), group.load_n::<S>(vehicle));
            for &line in &wheels.weights[line].lines {
                press(o, &self.runs[first], &mut self.sum, (wheels, line, station), force);
            }
        }
        set(o, mask, &mut self.weights_now, &self.sum, count);
        for i in 0..self.runs[first].len() {
            let run = self.runs[first][i];
            let known = self.take_over(o, mask, run, (old, first));
            for station in (run.first..known[0]).chain(known[1]..run.first + run.count) {
                let at = run.from + station - run.first;
                for (&lane, forces) in group.lanes.iter().zip(before) {
                    self.stand(
                        lane,
                        at,
                        DeckNode {
                            line: run.line,
                            station,
                        },
                        (wheels, modes),
                        (forces, n),
                    );
                }
            }
        }
        let s = &constants.scheme;
        let (f, m_old) = (Mean::<S>::of(o, s.alpha_f), o.splat(s.alpha_m));
        let rule = ResidualRule::of(o, constants);
        let (now, weights) = (
            &self.weights_now.vectors::<S>()[..count],
            &self.weights.vectors::<S>()[..count],
        );
        let (inertia, contact) = (
            &self.inertia.vectors::<S>()[..count],
            &self.contact.vectors::<S>()[..count],
        );
        let (x, free) = (self.x.first_mut::<S>(count), &mut self.free.vectors_mut::<S>()[..count]);
        for i in 0..count {
            let force = o.fma(f.old, contact[i], o.fma(m_old, inertia[i], f.at(o, now[i], weights[i])));
            free[i] = o.0.select_f64s(mask, x.change(o, &rule, i, o.neg(force)), free[i]);
        }
    }

    /// The stations near the nodes of a group; how many there are.
    #[inline(always)]
    fn find_runs(&mut self, group: &LaneGroup, nodes: &[DeckNode], stations: usize) -> usize {
        let (first, rest) = (group.first(), &group.lanes[1..]);
        let runs = &mut self.runs[first];
        runs.clear();
        for node in nodes {
            match runs.iter_mut().find(|run| run.line == node.line) {
                Some(run) => {
                    let end = (run.first + run.count).max(node.station + 1);
                    run.first = run.first.min(node.station);
                    run.count = end - run.first;
                }
                None => runs.push(NodeRun {
                    line: node.line,
                    first: node.station,
                    count: 1,
                    from: 0,
                }),
            }
        }
        let mut count = 0;
        for run in runs {
            let end = (run.first + run.count + 1).min(stations);
            run.first = run.first.saturating_sub(1);
            run.count = end - run.first;
            run.from = count;
            count += run.count;
        }
        for &lane in rest {
            // the first lane stands before the others
            let (head, tail) = self.runs.split_at_mut(lane);
            tail[0].clone_from(&head[first]);
        }
        count
    }

    /// The motion of a run's nodes that were known before; from which station to which they are.
    #[inline(always)]
    fn take_over<S: Simd>(
        &mut self,
        o: Ops<S>,
        mask: S::m64s,
        run: NodeRun,
        (old, lane): (&Self, usize),
    ) -> [usize; 2] {
        let mut known = [run.first; 2];
        for before in old.runs[lane].iter().filter(|before| before.line == run.line) {
            let first = run.first.max(before.first);
            let end = (run.first + run.count).min(before.first + before.count);
            if first >= end {
                continue;
            }
            known = [first, end];
            let (to, from) = (run.from + first - run.first, before.from + first - before.first);
            let many = end - first;
            for (to_list, from_list) in self.carried().into_iter().zip(old.listed()) {
                let to_rows = &mut to_list.vectors_mut::<S>()[to..][..many];
                for (to, from) in to_rows.iter_mut().zip(&from_list.vectors::<S>()[from..][..many]) {
                    *to = o.0.select_f64s(mask, *from, *to);
                }
            }
        }
        known
    }

    fn listed(&self) -> [&LaneArray; 6] {
        let [x, v, a] = self.x.each();
        [x, v, a, &self.weights, &self.inertia, &self.contact]
    }

    /// A node that comes near in one lane, at rest under the forces that the last step had on other nodes.
    fn stand(
        &mut self,
        lane: usize,
        at: usize,
        node: DeckNode,
        (wheels, modes): (&WheelLines, usize),
        ([masses, springs], n): (&[&[StationForce]; 2], &LaneArray),
    ) {
        let seen = |forces: &[StationForce]| -> f64 {
            let of = |&(line, station, force): &StationForce| {
                let row = wheels.residual(line, station, node.line);
                let seen = row.get((node.station + wheels.residual_band()).wrapping_sub(station));
                force * seen.copied().unwrap_or(0.0)
            };
            forces.iter().map(of).sum()
        };
        let weights = self.weights_now.at(at, lane) + seen(springs);
        let inertia = seen(masses);
        let of_links = &wheels.influence(node)[modes..][..n.rows()];
        let contact = of_links.iter().zip(n.lane(lane)).map(|(seen, n)| seen * n).sum::<f64>();
        *self.weights.at_mut(at, lane) = weights;
        *self.inertia.at_mut(at, lane) = inertia;
        *self.contact.at_mut(at, lane) = contact;
        let [x, v, a] = self.x.all();
        *x.at_mut(at, lane) = -(weights + inertia + contact);
        (*v.at_mut(at, lane), *a.at_mut(at, lane)) = (0.0, 0.0);
    }

    /// Takes the nodes of a group's settled lanes to the end of the step, forces of masses, springs and connectors found.
    #[inline(always)]
    pub(super) fn lead<S: Simd>(
        &mut self,
        o: Ops<S>,
        (lane, mask): (usize, S::m64s),
        (wheels, constants): (&WheelLines, &StepConstants),
        [masses, springs]: [NodeForces<'_>; 2],
        n: &LaneArray,
    ) {
        let s = &constants.scheme;
        let runs = &self.runs[lane];
        let count: usize = runs.iter().map(|run| run.count).sum();
        self.sum.clear_rows(count);
        press_all(o, runs, &mut self.sum, wheels, masses);
        set(o, mask, &mut self.inertia, &self.sum, count);
        let (n, modes) = (n.vectors::<S>(), constants.c.len());
        let contact = self.contact.vectors_mut::<S>();
        for run in runs {
            for (i, contact) in contact[run.from..][..run.count].iter_mut().enumerate() {
                let (line, station) = (run.line, run.first + i);
                let of_links = &wheels.influence(DeckNode { line, station })[modes..];
                let mut sum = o.splat(0.0);
                for (seen, n) in of_links.iter().zip(n) {
                    sum = o.fma(o.splat(*seen), *n, sum);
                }
                *contact = o.0.select_f64s(mask, sum, *contact);
            }
        }
        if !springs.nodes.is_empty() {
            // with the connectors in this step, with the weights in the next
            self.sum.clear_rows(count);
            press_all(o, runs, &mut self.sum, wheels, springs);
            let factor = o.splat(constants.rho * (1.0 - s.alpha_f));
            let (free, now) = (self.free.vectors_mut::<S>(), self.weights_now.vectors_mut::<S>());
            for (i, spring) in self.sum.vectors::<S>()[..count].iter().enumerate() {
                free[i] = o.0.select_f64s(mask, o.less(free[i], factor, *spring), free[i]);
                now[i] = o.0.select_f64s(mask, o.add(now[i], *spring), now[i]);
            }
        }
        let (by_m, by_f) = (o.splat(1.0 - s.alpha_m), o.splat(1.0 - s.alpha_f));
        let (rho, newmark) = (o.splat(constants.rho), Newmark::of(o, s));
        let (inertia, contact) = (
            &self.inertia.vectors::<S>()[..count],
            &self.contact.vectors::<S>()[..count],
        );
        let (free, mut x) = (&self.free.vectors::<S>()[..count], self.x.first_mut::<S>(count));
        for i in 0..count {
            let late = o.fma(by_m, inertia[i], o.mul(by_f, contact[i]));
            x.advance_where(o, mask, &newmark, i, o.less(free[i], rho, late));
        }
        set(o, mask, &mut self.weights, &self.weights_now, count);
    }

    /// A node's acceleration, velocity and displacement at the end of the step without new inertia and connector forces, in the lanes
    /// of a group.
    #[inline(always)]
    pub(super) fn free<S: Simd>(
        &self,
        o: Ops<S>,
        lane: usize,
        node: DeckNode,
        newmark: &Newmark<Ops<S>>,
    ) -> [S::f64s; 3] {
        let Some(run) = self.runs[lane].iter().find(|run| run.line == node.line) else {
            return [o.splat(0.0); 3];
        };
        let i = run.from + node.station - run.first;
        let [x, v, a] = newmark.advance(o, self.free.vectors::<S>()[i], self.x.row::<S>(i));
        [a, v, x]
    }
}

/// Takes the first so many rows in the lanes of a mask.
#[inline(always)]
fn set<S: Simd>(o: Ops<S>, mask: S::m64s, to: &mut LaneArray, from: &LaneArray, rows: usize) {
    let (to, from) = (&mut to.vectors_mut::<S>()[..rows], &from.vectors::<S>()[..rows]);
    for (to, from) in to.iter_mut().zip(from) {
        *to = o.0.select_f64s(mask, *from, *to);
    }
}

/// Adds what nodes see of forces on nodes.
#[inline(always)]
fn press_all<S: Simd>(o: Ops<S>, runs: &[NodeRun], seen: &mut LaneArray, wheels: &WheelLines, of: NodeForces<'_>) {
    let factor = o.splat(of.factor);
    for (node, force) in of.nodes.iter().zip(of.forces.vectors::<S>()) {
        press(o, runs, seen, (wheels, node.line, node.station), o.mul(factor, *force));
    }
}

/// Adds what nodes see of a force on a station.
#[inline(always)]
fn press<S: Simd>(
    o: Ops<S>,
    runs: &[NodeRun],
    seen: &mut LaneArray,
    (wheels, line, station): (&WheelLines, usize, usize),
    force: S::f64s,
) {
    let (band, seen) = (wheels.residual_band(), seen.vectors_mut::<S>());
    for run in runs {
        let lo = run.first.max(station.saturating_sub(band));
        let hi = (run.first + run.count).min(station + band + 1);
        if lo < hi {
            let row = &wheels.residual(line, station, run.line)[lo + band - station..hi + band - station];
            for (seen, r) in seen[run.from + lo - run.first..].iter_mut().zip(row) {
                *seen = o.fma(o.splat(*r), force, *seen);
            }
        }
    }
}
