//! Crossings side by side: the motion of each, one a SIMD lane.
//!
//! Knows the state that a crossing carries from step to step, and how a lane is begun, saved and taken elsewhere. Does not
//! know the step's arithmetic or when a crossing ends.

use super::basis::BridgeOperator;
use super::beside::Beside;
use super::lane::{Lane, Passage};
use super::motion::{Motion, Scratch};
use super::panel::InstructionPath;
use super::settle::Unsettled;
use super::watch::{LanePeaks, Watch};
use super::wheels::Ride;
use crate::connector::{Law, State};
use crate::response::Statistics;
use std::sync::Arc;

/// Crossings side by side on one operator.
#[derive(Debug)]
pub(crate) struct Lanes {
    pub(super) width: usize,
    most_nodes: usize,
    /// `1 / (2 k)` of the connectors at work.
    pub(super) half_compliance: Vec<f64>,
    pub(super) motion: Motion,
    pub(super) watch: Watch,
    pub(super) lanes: Vec<Lane>,
    pub(super) scratch: Scratch,
}

/// A lane's numbers by themselves.
#[derive(Debug, Clone)]
pub(crate) struct Saved {
    numbers: Vec<f64>,
    states: Vec<State>,
    beside: Beside,
    masses: Vec<(usize, usize, f64)>,
    statistics: Statistics,
}

impl Lanes {
    /// As many lanes as this machine's vectors have, with room for vehicles of `most_nodes` nodes.
    pub(crate) fn new(operator: &BridgeOperator, most_nodes: usize, newton_limit: usize) -> Self {
        let width = InstructionPath::of_this_machine().lanes;
        let sizes = &operator.sizes;
        let lane = || Lane::new(sizes.connectors, most_nodes, newton_limit);
        Self {
            width,
            most_nodes,
            half_compliance: vec![0.0; width],
            motion: Motion::new(sizes, width),
            watch: Watch::new(operator, width),
            lanes: (0..width).map(|_| lane()).collect(),
            scratch: Scratch::new(sizes, width),
        }
    }

    /// Number of lanes.
    pub(crate) fn width(&self) -> usize {
        self.width
    }

    /// Begins a crossing at rest, the front of the vehicle where it is one step before the first one.
    pub(crate) fn begin(&mut self, operator: &BridgeOperator, lane: usize, passage: Passage, time_s: f64) {
        self.rest(lane);
        self.watch.begin(lane);
        let of = &mut self.lanes[lane];
        of.small.forget();
        of.small.states.fill(passage.law.state(0.0));
        of.statistics = Statistics::default();
        of.unloaded = 0;
        of.riders.leave();
        of.masses.clear();
        of.axles = vec![(0.0, true); passage.wheels.vehicle.axles];
        of.inertia = vec![0.0; passage.wheels.vehicle.axles];
        self.half_compliance[lane] = half_compliance(&passage.law);
        of.passage = Some(passage);
        self.place(lane, time_s);
        self.weigh(operator, lane);
        let weights = &mut self.motion.weights;
        for (numbers, now) in weights
            .chunks_exact_mut(self.width)
            .zip(self.scratch.weights.chunks_exact(self.width))
        {
            numbers[lane] = now[lane];
        }
    }

    /// Says where a lane's vehicle is at the end of the coming step.
    pub(crate) fn place(&mut self, lane: usize, time_s: f64) {
        let of = &mut self.lanes[lane];
        of.time_s = time_s;
        of.front_x_m = of.passage.as_ref().map_or(0.0, |p| p.speed_m_s * time_s);
    }

    /// Frees a lane, which then rests.
    pub(crate) fn end(&mut self, lane: usize) {
        self.rest(lane);
        let of = &mut self.lanes[lane];
        of.passage = None;
        of.weights.clear();
        of.masses.clear();
    }

    /// Zeros in a lane.
    fn rest(&mut self, lane: usize) {
        let now = &mut self.scratch;
        let step = [&mut now.weights, &mut now.inertia, &mut now.n, &mut now.e];
        for numbers in self.motion.all().chain(self.watch.all()).chain(step) {
            numbers.iter_mut().skip(lane).step_by(self.width).for_each(|x| *x = 0.0);
        }
    }

    /// Whether a lane's last step found no equilibrium; it then stands where it stood before.
    pub(crate) fn unsettled(&self, lane: usize) -> Option<Unsettled> {
        self.lanes[lane].unsettled
    }

    /// Whether a lane's energies are finite.
    pub(crate) fn is_finite(&self, lane: usize) -> bool {
        self.motion.kinetic[lane].is_finite() && self.motion.strain[lane].is_finite()
    }

    /// What the solver did in a lane.
    pub(crate) fn statistics(&mut self, lane: usize) -> &mut Statistics {
        &mut self.lanes[lane].statistics
    }

    /// A lane's numbers.
    pub(crate) fn save(&mut self, lane: usize) -> Saved {
        let width = self.width;
        let numbers = self.motion.all().chain(self.watch.all());
        Saved {
            numbers: numbers
                .flat_map(|x| x.iter().skip(lane).step_by(width).copied())
                .collect(),
            states: self.lanes[lane].small.states.clone(),
            beside: self.lanes[lane].riders.beside().clone(),
            masses: self.lanes[lane].masses.clone(),
            statistics: self.lanes[lane].statistics,
        }
    }

    /// Puts numbers back into a lane, or into another of the same operator.
    pub(crate) fn restore(&mut self, lane: usize, saved: &Saved) {
        let width = self.width;
        let places = self.motion.all().chain(self.watch.all());
        let places = places.flat_map(|x| x.iter_mut().skip(lane).step_by(width));
        places.zip(&saved.numbers).for_each(|(x, saved)| *x = *saved);
        let of = &mut self.lanes[lane];
        of.small.forget();
        of.small.states.copy_from_slice(&saved.states);
        of.statistics = saved.statistics;
        of.riders.put_beside(&saved.beside);
        of.masses.clone_from(&saved.masses);
        // the load's traces in the step under way are written anew
        of.unloaded = 0;
    }

    /// Takes up a crossing that was saved elsewhere, with the small flexibilities of its step length.
    pub(crate) fn resume(&mut self, lane: usize, passage: Passage, saved: &Saved) {
        // a crossing without riding masses writes no inertia forces, so that none may be left of the one before
        self.rest(lane);
        let of = &mut self.lanes[lane];
        of.axles = vec![(0.0, true); passage.wheels.vehicle.axles];
        of.inertia = vec![0.0; passage.wheels.vehicle.axles];
        self.half_compliance[lane] = half_compliance(&passage.law);
        of.passage = Some(passage);
        self.restore(lane, saved);
    }

    /// Changes to another step length.
    pub(crate) fn take_ride(&mut self, lane: usize, ride: Arc<Ride>) {
        let of = &mut self.lanes[lane];
        of.small.forget();
        if let Some(passage) = &mut of.passage {
            passage.ride = ride;
        }
    }

    /// Nodes of the largest vehicle that has room.
    pub(crate) fn most_nodes(&self) -> usize {
        self.most_nodes
    }

    /// Whether any lane's vehicle has masses that ride along.
    #[inline(always)]
    pub(super) fn any_mass(&self) -> bool {
        let has = |lane: &Lane| lane.passage.as_ref().is_some_and(|p| !p.wheels.masses.is_empty());
        self.lanes.iter().any(has)
    }

    /// The passage of a lane.
    pub(crate) fn passage(&self, lane: usize) -> Option<&Passage> {
        self.lanes[lane].passage.as_ref()
    }

    /// What a lane's crossing leaves behind, peaks in the order of positions and joints.
    pub(crate) fn peaks(&self, lane: usize) -> LanePeaks {
        self.watch.peaks(lane, self.width)
    }

    /// Deflection of a position now, positive downward `[m]`.
    pub(crate) fn deflection_m(&self, lane: usize, position: usize) -> f64 {
        // nothing is 0, not -0
        0.0 - self.scratch.w[(position - 1) * self.width + lane]
    }

    /// Force of a joint now, its connectors added, tension positive `[N]`.
    pub(crate) fn joint_force_n(&self, lane: usize, joint: usize) -> f64 {
        let per_joint = self.watch.per_joint();
        let forces = self.motion.n.chunks_exact(self.width).skip((joint - 2) * per_joint);
        forces.take(per_joint).map(|n| n[lane]).sum()
    }

    /// Downward weights on the deck at the vehicle's place, as modes, connectors and observed rows see them.
    #[inline(always)]
    pub(super) fn weigh(&mut self, operator: &BridgeOperator, lane: usize) {
        let width = self.width;
        let Lane {
            passage: Some(passage),
            axles,
            weights,
            unloaded,
            front_x_m,
            ..
        } = &mut self.lanes[lane]
        else {
            return;
        };
        let wheels = &*passage.wheels;
        axles.fill((0.0, true));
        weights.clear();
        for (line, of) in wheels.weights.iter().enumerate() {
            let own = weights.len();
            for &(ahead_m, share, axle) in &of.points {
                let Some(place) = operator.track.along(*front_x_m + ahead_m) else {
                    axles[axle].1 = false;
                    continue;
                };
                let w = passage.load_n * share;
                axles[axle].0 += w * of.lines.len() as f64;
                for (station, part) in [(place.station, 1.0 - place.part), (place.station + 1, place.part)] {
                    match weights[own..].iter_mut().rev().find(|(_, s, _)| *s == station) {
                        Some((_, _, sum)) => *sum += w * part,
                        None => weights.push((line, station, w * part)),
                    }
                }
            }
        }
        if weights.is_empty() {
            if *unloaded < 2 {
                *unloaded += 1;
                for numbers in [&mut self.scratch.weights, &mut self.scratch.inertia] {
                    numbers.iter_mut().skip(lane).step_by(width).for_each(|x| *x = 0.0);
                }
            }
            return;
        }
        *unloaded = 0;
        spread(
            &wheels.weights,
            wheels.width,
            weights,
            &mut self.scratch.weights,
            lane,
            width,
        );
    }
}

fn half_compliance(law: &Law) -> f64 {
    let at_work = match law.state(0.0) {
        State::Both => State::Both,
        _ => State::Tension,
    };
    0.5 / law.line(at_work).k
}

/// Columns that are summed at once.
const COLUMNS: usize = 16;

/// Writes the sum of forces times the reach of their stations into a lane.
#[inline(always)]
pub(super) fn spread(
    lines: &[super::wheels::WheelLine],
    reach: usize,
    forces: &[(usize, usize, f64)],
    to: &mut [f64],
    lane: usize,
    width: usize,
) {
    let columns = to.len() / width;
    let mut from = 0;
    while from < columns {
        let many = COLUMNS.min(columns - from);
        let mut sums = [0.0; COLUMNS];
        for &(line, station, force) in forces {
            let of = &lines[line].reach(station, reach)[from..from + many];
            if let Some(of) = of.first_chunk::<COLUMNS>() {
                for i in 0..COLUMNS {
                    sums[i] = f64::mul_add(force, of[i], sums[i]);
                }
            } else {
                for (sum, x) in sums.iter_mut().zip(of) {
                    *sum = force.mul_add(*x, *sum);
                }
            }
        }
        for (to, sum) in to[from * width..(from + many) * width]
            .chunks_exact_mut(width)
            .zip(&sums)
        {
            to[lane] = *sum;
        }
        from += many;
    }
}

/// Writes a lane's numbers between those of the others.
#[inline(always)]
pub(super) fn scatter(numbers: &[f64], to: &mut [f64], lane: usize, width: usize) {
    for (to, x) in to.chunks_exact_mut(width).zip(numbers) {
        to[lane] = *x;
    }
}
