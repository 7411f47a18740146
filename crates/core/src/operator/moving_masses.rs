//! What rides along in one lane, masses and wheels on springs: what they see of each other and of the connectors.
//!
//! Knows flexibilities, laid out once so that a step allocates nothing. Does not know the scheme but for its factors, nor where
//! vehicles are: that is for `riding_places`.

use super::lane_array::LaneArray;
use super::loads::StationForce;
use super::local_residual::{LocalResidual, StepForces};
use super::rider_block::RiderBlock;
use super::rides::{LaneRide, WheelOnDeck};
use super::riding_places::RidingPlaces;
use super::step_constants::StepConstants;
use super::sums::{add_to, dot};
use super::wheel_lines::{DeckNode, WheelCompliance, WheelLines};
use crate::bridge::{Track, VehiclePlacement};
use crate::scheme::Scheme;

/// Free motion of the modes at the end of a step: `q, v, a` as they would be without connector and mass forces.
#[derive(Debug, Default)]
pub(super) struct FreeMotion {
    pub q: Vec<f64>,
    pub v: Vec<f64>,
    pub a: Vec<f64>,
}

impl FreeMotion {
    /// Rest of so many modes.
    pub(super) fn new(modes: usize) -> Self {
        let zeros = || vec![0.0; modes];
        Self {
            q: zeros(),
            v: zeros(),
            a: zeros(),
        }
    }

    /// Reads a lane; accelerations alone where no more is asked for.
    #[inline(always)]
    pub(super) fn gather(&mut self, lane: usize, [q, v, a]: &[LaneArray; 3], accelerations_alone: bool) {
        if !accelerations_alone {
            q.gather(lane, &mut self.q);
            v.gather(lane, &mut self.v);
        }
        a.gather(lane, &mut self.a);
    }
}

/// What rides along in one lane.
#[derive(Debug)]
pub(super) struct MovingMasses {
    connectors: usize,
    places: RidingPlaces,
    /// Free motion of each node: acceleration, velocity, displacement.
    dots: Vec<[f64; 3]>,
    /// What a node sees of a unit force of each mass.
    seen: Vec<f64>,
    /// Their rows in the contact system.
    pub(super) block: RiderBlock,
    /// Nodes' motion local the modes, near the vehicle; and room for the next list.
    local: LocalResidual,
    next: LocalResidual,
    /// Scaled force on each node.
    on_nodes: Vec<f64>,
}

impl MovingMasses {
    /// Room for vehicles of at most `nodes` nodes.
    pub(super) fn new(connectors: usize, nodes: usize) -> Self {
        Self {
            connectors,
            places: RidingPlaces::new(nodes),
            dots: Vec::with_capacity(nodes),
            seen: vec![0.0; nodes * nodes],
            block: RiderBlock::new(nodes, connectors),
            local: LocalResidual::new(nodes),
            next: LocalResidual::new(nodes),
            on_nodes: vec![0.0; nodes],
        }
    }

    pub(super) fn count(&self) -> usize {
        self.places.list.len()
    }

    /// Operations of [`MovingMasses::follow`] and [`MovingMasses::couple`] on so many modes.
    pub(super) fn flop_of_coupling(&self, modes: usize) -> f64 {
        let (n, r, c) = (self.places.nodes.len(), self.places.list.len(), self.connectors);
        let motions = if self.needs_motion() { 3 } else { 1 };
        let entries = self.places.force.len() + self.places.slopes.len();
        (2 * motions * modes * n + 2 * n * r + entries * 2 * (r + c) + 12 * n) as f64
    }

    /// Operations of the masses' forces on so many rows and of [`MovingMasses::lead`].
    pub(super) fn flop_of_leading(&self, rows: usize) -> f64 {
        let (n, r, c) = (self.places.nodes.len(), self.places.list.len(), self.connectors);
        (2 * n * rows + 2 * n * (r + c) + 2 * n * c + 2 * self.places.force.len() + 14 * n) as f64
    }

    /// Puts what rides along where it is.
    #[inline(always)]
    pub(super) fn place(
        &mut self,
        wheels: &WheelLines,
        track: &Track,
        loads_n: impl Fn(usize) -> f64,
        placements: &[VehiclePlacement],
        rides: &[LaneRide],
    ) {
        self.places.place(wheels, track, loads_n, placements, rides);
        let (riders, symmetric) = (self.places.list.len(), self.places.slopes.is_empty());
        self.block.begin(riders, symmetric);
    }

    /// Whether rows ask for velocities and displacements too.
    #[inline(always)]
    pub(super) fn needs_motion(&self) -> bool {
        self.places.needs_motion()
    }

    /// The part of the small system that rides along, from the free motion at the step's end. Masses are measured in displacement:
    /// `q' / ((1 - alpha_m) m c_a) = r u'' / c_a + (2 V / c_a) r_x u' + ((V^2 r_xx + V' r_x) / c_a) u` with
    /// `q' = (1 - alpha_m) q`; wheels on springs by [`WheelOnDeck`].
    #[inline(always)]
    pub(super) fn couple(
        &mut self,
        wheels: &WheelLines,
        compliance: &WheelCompliance,
        constants: &StepConstants,
        modes: usize,
        rides: &[LaneRide],
        free: &FreeMotion,
    ) {
        let nr = self.places.list.len();
        if nr == 0 {
            return;
        }
        let s = &constants.scheme;
        self.free_nodes(wheels, constants, modes, free);
        if self.places.runs.is_empty() {
            self.see_rows(compliance);
        } else {
            self.see_pairs(compliance);
        }
        for (i, mass) in self.places.list[..self.places.first_wheel].iter().enumerate() {
            let row = self.block.row_mut(i);
            let mut free = 0.0;
            for &(node, w) in &self.places.force[mass.force.0..mass.force.1] {
                let DeckNode { line, station } = self.places.nodes[node];
                add_to(row.among, w, &self.seen[node * nr..][..nr]);
                let there = compliance.with_connectors(line, station);
                add_to(row.of_links, w, there);
                add_to(row.on_links, w, there);
                free += w * self.dots[node][0] / s.c_a;
            }
            let (speed, rate) = (mass.heading.speed_m_s, mass.heading.acceleration_m_s2);
            let (on_x, on_xx) = (2.0 * speed / s.c_a, speed * speed / s.c_a);
            for &(node, r_x, r_xx) in &self.places.slopes[mass.slopes.0..mass.slopes.1] {
                let of_u = on_xx * r_xx + rate / s.c_a * r_x;
                let (w, DeckNode { line, station }) = (on_x * s.c_v * r_x + of_u, self.places.nodes[node]);
                add_to(row.among, w, &self.seen[node * nr..][..nr]);
                add_to(row.of_links, w, compliance.with_connectors(line, station));
                free += on_x * r_x * self.dots[node][1] + of_u * self.dots[node][2];
            }
            row.among[i] += 1.0 / ((1.0 - s.alpha_m) * mass.mass_kg * s.c_a);
            *row.free = free;
        }
        for (i, wheel) in (self.places.first_wheel..).zip(&self.places.wheels) {
            let (row, of) = (self.block.row_mut(i), self.places.list[i]);
            let mut free = wheel.known;
            let slopes = &self.places.slopes[of.slopes.0..of.slopes.1];
            for (&(node, w), (_, r_x, _)) in self.places.force[of.force.0..of.force.1].iter().zip(slopes) {
                let DeckNode { line, station } = self.places.nodes[node];
                let (there, damped) = (compliance.with_connectors(line, station), wheel.by_slope * r_x);
                add_to(row.among, w + damped, &self.seen[node * nr..][..nr]);
                add_to(row.of_links, w + damped, there);
                add_to(row.on_links, w, there);
                let [_, v, x] = self.dots[node];
                free += (w * wheel.of_spring + damped) * x + w * wheel.of_damper * v;
            }
            *row.free = free;
        }
        let mut from = self.places.first_wheel;
        for ride in rides.iter().filter(|ride| ride.is_awake()) {
            let many = ride.wheels();
            for w in 0..many {
                let row = self.block.row_mut(from + w);
                ride.add_among(w, &mut row.among[from..][..many]);
                row.among[from + w] += self.places.wheels[from + w - self.places.first_wheel].own;
            }
            from += many;
        }
    }

    /// Number of wheels on springs; they are the last riders.
    #[inline(always)]
    pub(super) fn wheels_on_springs(&self) -> usize {
        self.places.wheels.len()
    }

    /// Height of the deck under each wheel on springs at the step's end and its rate `[m, m/s]`, given the scaled forces of riders
    /// and connectors.
    #[inline(always)]
    pub(super) fn under_wheels(
        &mut self,
        compliance: &WheelCompliance,
        constants: &StepConstants,
        scaled: &[f64],
        connectors: &[f64],
        mut tell: impl FnMut(usize, &WheelOnDeck, [f64; 2]),
    ) {
        let (nr, s) = (self.places.list.len(), &constants.scheme);
        for (node, DeckNode { line, station }) in self.places.nodes.iter().enumerate() {
            let from_riders = dot(&self.seen[node * nr..][..nr], scaled);
            let from_connectors = dot(compliance.with_connectors(*line, *station), connectors);
            self.on_nodes[node] = from_riders + from_connectors;
        }
        for (number, of) in self.places.list[self.places.first_wheel..].iter().enumerate() {
            let (mut height_m, mut rate_m_s) = (0.0, 0.0);
            for &(node, w) in &self.places.force[of.force.0..of.force.1] {
                let ([_, v, x], down) = (self.dots[node], self.on_nodes[node]);
                height_m += w * (x - down);
                rate_m_s += w * (v - s.c_v * down);
            }
            for &(node, r_x, _) in &self.places.slopes[of.slopes.0..of.slopes.1] {
                rate_m_s += of.heading.speed_m_s * r_x * (self.dots[node][2] - self.on_nodes[node]);
            }
            tell(number, &self.places.wheels[number], [height_m, rate_m_s]);
        }
    }

    /// Free motion of the nodes, without new connector and inertia forces.
    #[inline(always)]
    fn free_nodes(&mut self, wheels: &WheelLines, constants: &StepConstants, modes: usize, free: &FreeMotion) {
        let all = self.needs_motion();
        self.dots.clear();
        for node in &self.places.nodes {
            let phi = &wheels.influence(*node)[..modes];
            let [a, v, x] = self.local.free(*node, &constants.scheme);
            self.dots.push(if all {
                [a + dot(phi, &free.a), v + dot(phi, &free.v), x + dot(phi, &free.q)]
            } else {
                [a + dot(phi, &free.a), 0.0, 0.0]
            });
        }
    }

    /// What nodes see of masses on any rows.
    #[inline(always)]
    fn see_rows(&mut self, compliance: &WheelCompliance) {
        let nr = self.places.list.len();
        for (a, node) in self.places.nodes.iter().enumerate() {
            let seen = &mut self.seen[a * nr..][..nr];
            for (seen, mass) in seen.iter_mut().zip(&self.places.list) {
                let row = &self.places.force[mass.force.0..mass.force.1];
                if row.is_empty() {
                    // a wheel on the road beside the bridge
                    *seen = 0.0;
                    continue;
                }
                let first = self.places.nodes[row[0].0];
                // rows lie on few lines, their nodes side by side
                let (mut line, mut there) = (first.line, compliance.row(node.line, node.station, first.line));
                let mut sum = 0.0;
                for &(b, w) in row {
                    let other = self.places.nodes[b];
                    if other.line != line {
                        (line, there) = (other.line, compliance.row(node.line, node.station, other.line));
                    }
                    sum += w * there[other.station + compliance.band - node.station];
                }
                *seen = sum;
            }
        }
    }

    /// What nodes see of masses on pairs of stations.
    #[inline(always)]
    fn see_pairs(&mut self, compliance: &WheelCompliance) {
        let nr = self.places.list.len();
        for (a, node) in self.places.nodes.iter().enumerate() {
            let seen = &mut self.seen[a * nr..][..nr];
            for run in &self.places.runs {
                let row =
                    &compliance.row(node.line, node.station, run.line)[run.first + compliance.band - node.station..];
                let (near, far) = (&row[..run.count], &row[1..][..run.count]);
                let nexts = &self.places.nexts[run.from..][..run.count];
                let seen = &mut seen[run.from..][..run.count];
                for i in 0..run.count {
                    seen[i] = nexts[i].mul_add(far[i], near[i]);
                }
            }
        }
    }

    /// Follows the nodes near the vehicle, see [`LocalResidual::follow`].
    #[inline(always)]
    pub(super) fn follow(
        &mut self,
        wheels: &WheelLines,
        constants: &StepConstants,
        modes: usize,
        pressing: StepForces,
    ) {
        self.next
            .follow(&self.local, &self.places.nodes, wheels, constants, modes, pressing);
        std::mem::swap(&mut self.local, &mut self.next);
    }

    /// Back to before [`MovingMasses::follow`], for a step that did not settle.
    pub(super) fn unfollow(&mut self) {
        std::mem::swap(&mut self.local, &mut self.next);
    }

    /// Takes the nodes near the vehicle to the end of the step, see [`LocalResidual::lead`].
    #[inline(always)]
    pub(super) fn lead(&mut self, wheels: &WheelLines, constants: &StepConstants, modes: usize, found: StepForces) {
        self.local.lead(wheels, constants, modes, found);
    }

    /// The nodes near the vehicle.
    pub(super) fn local_residual(&self) -> &LocalResidual {
        &self.local
    }

    /// Puts them back.
    pub(super) fn put_local_residual(&mut self, saved: &LocalResidual) {
        self.local.clone_from(saved);
    }

    /// No nodes near a vehicle.
    pub(super) fn leave(&mut self) {
        self.local.clear();
    }

    /// Force on each node from the masses' scaled forces times `factor`: line, station, force.
    #[inline(always)]
    pub(super) fn masses_on_nodes(&mut self, scaled: &[f64], factor: f64, forces: &mut Vec<StationForce>) {
        self.put_on_nodes((0, self.places.first_wheel), scaled, factor, forces);
    }

    /// Force on each node from the scaled forces of wheels on springs times `factor`.
    #[inline(always)]
    pub(super) fn springs_on_nodes(&mut self, scaled: &[f64], factor: f64, forces: &mut Vec<StationForce>) {
        self.put_on_nodes(
            (self.places.first_wheel, self.places.list.len()),
            scaled,
            factor,
            forces,
        );
    }

    #[inline(always)]
    fn put_on_nodes(
        &mut self,
        (from, end): (usize, usize),
        scaled: &[f64],
        factor: f64,
        forces: &mut Vec<StationForce>,
    ) {
        if from == end {
            return;
        }
        let nn = self.places.nodes.len();
        self.on_nodes[..nn].fill(0.0);
        for (mass, q) in self.places.list[from..end].iter().zip(&scaled[from..end]) {
            for &(node, w) in &self.places.force[mass.force.0..mass.force.1] {
                self.on_nodes[node] += w * q;
            }
        }
        for (node, f) in self.places.nodes.iter().zip(&self.on_nodes) {
            forces.push((node.line, node.station, factor * f));
        }
    }

    /// Adds each axle's force beyond its weight to `axles`: inertia force `m u''`, force of springs, given the scaled forces of
    /// riders and connectors.
    #[inline(always)]
    pub(super) fn add_forces(
        &mut self,
        compliance: &WheelCompliance,
        constants: &StepConstants,
        scaled: &[f64],
        connectors: &[f64],
        axles: &mut [f64],
    ) {
        let (nr, s) = (self.places.list.len(), &constants.scheme);
        if self.places.needs_motion() {
            self.add_own_forces(s, scaled, axles);
        }
        if self.places.points.is_empty() {
            return;
        }
        for (node, DeckNode { line, station }) in self.places.nodes.iter().enumerate() {
            let from_riders = dot(&self.seen[node * nr..][..nr], scaled);
            let from_connectors = dot(compliance.with_connectors(*line, *station), connectors);
            self.on_nodes[node] = self.dots[node][0] - s.c_a * (from_riders + from_connectors);
        }
        for p in &self.places.points {
            let (left, right) = (self.on_nodes[p.node], self.on_nodes[p.node + 1]);
            axles[p.axle] += p.mass_kg * ((1.0 - p.part) * left + p.part * right);
        }
    }

    /// Adds forces that riders have by themselves: of patches and of wheels on springs.
    fn add_own_forces(&self, s: &Scheme, scaled: &[f64], axles: &mut [f64]) {
        for (wheel, q) in self.places.list.iter().zip(scaled).skip(self.places.first_wheel) {
            axles[wheel.axle] += q / (1.0 - s.alpha_f);
        }
        let patches = self.places.list[..self.places.first_wheel].iter().zip(scaled);
        for (mass, q) in patches.filter(|(mass, _)| mass.slopes.0 != mass.slopes.1) {
            axles[mass.axle] += q / (1.0 - s.alpha_m);
        }
    }
}
