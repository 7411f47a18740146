//! What rides along in lanes that go together, masses and wheels on springs: what they see of each other and of the connectors.
//!
//! Knows flexibilities, laid out once so that a step allocates nothing. Does not know the scheme but for its factors, nor where
//! vehicles are: that is for `riding_places`.

use super::deck_forces::{NodeForces, StationForce};
use super::lane::Lane;
use super::lane_array::LaneArray;
use super::lane_group::LaneGroup;
use super::local_residual::LocalResidual;
use super::panel::{MOST_LANES, lanes};
use super::rider_block::RiderBlock;
use super::rides::WheelOnDeck;
use super::riding_places::{MovingMass, RidingPlaces};
use super::step_constants::StepConstants;
use super::sums::add_to;
use super::vector::Ops;
use super::wheel_lines::{DeckNode, WheelCompliance, WheelLines};
use crate::bridge::Track;
use crate::scheme::{Arithmetic, Newmark};
use pulp::Simd;

/// What rides along in a group of lanes after another, and the nodes near it in all of them.
#[derive(Debug)]
pub(super) struct MovingMasses {
    connectors: usize,
    pub(super) places: RidingPlaces,
    /// Free motion of each node: acceleration, velocity, displacement.
    dots: [LaneArray; 3],
    /// What a node sees of a unit force of each mass.
    seen: Vec<f64>,
    /// Their rows in the contact systems.
    pub(super) block: RiderBlock,
    /// Wheels on springs of each lane.
    wheels: Vec<Vec<WheelOnDeck>>,
    /// Nodes' motion beside the modes, near the vehicles; and that at the end of the step under way.
    local: LocalResidual,
    next: LocalResidual,
    /// Scaled force on each node, of masses and of wheels on springs, and what it has of motion.
    by_masses: LaneArray,
    by_springs: LaneArray,
    on_nodes: LaneArray,
}

/// What is known where riders of a group are looked at.
#[derive(Debug, Clone, Copy)]
pub(super) struct OfGroup<'a> {
    pub group: &'a LaneGroup,
    pub wheels: &'a WheelLines,
    pub compliance: &'a WheelCompliance,
    pub constants: &'a StepConstants,
}

impl MovingMasses {
    /// Room for vehicles of at most `nodes` nodes in each lane.
    pub(super) fn new(connectors: usize, nodes: usize, lanes: usize) -> Self {
        let of = || LaneArray::new(nodes, lanes);
        Self {
            connectors,
            places: RidingPlaces::new(nodes),
            dots: [of(), of(), of()],
            seen: vec![0.0; nodes * nodes],
            block: RiderBlock::new(nodes, connectors, lanes),
            wheels: vec![Vec::new(); lanes],
            local: LocalResidual::new(nodes, lanes),
            next: LocalResidual::new(nodes, lanes),
            by_masses: of(),
            by_springs: of(),
            on_nodes: of(),
        }
    }

    pub(super) fn count(&self) -> usize {
        self.places.list.len()
    }

    /// Operations of [`MovingMasses::follow`] and [`MovingMasses::couple`] on so many modes, a lane.
    pub(super) fn flop_of_coupling(&self, modes: usize) -> f64 {
        let (n, r, c) = (self.places.nodes.len(), self.places.list.len(), self.connectors);
        let motions = if self.needs_motion() { 3 } else { 1 };
        let entries = self.places.force.len() + self.places.slopes.len();
        (2 * motions * modes * n + 2 * n * r + entries * 2 * (r + c) + 12 * n) as f64
    }

    /// Operations of the masses' forces on so many rows and of [`MovingMasses::lead`], a lane.
    pub(super) fn flop_of_leading(&self, rows: usize) -> f64 {
        let (n, r, c) = (self.places.nodes.len(), self.places.list.len(), self.connectors);
        (2 * n * rows + 2 * n * (r + c) + 2 * n * c + 2 * self.places.force.len() + 14 * n) as f64
    }

    /// Puts what rides along in a group where it is.
    #[inline(always)]
    pub(super) fn place(&mut self, wheels: &WheelLines, track: &Track, group: &LaneGroup, lanes: &[Lane]) {
        let rides = &lanes[group.first()].rides;
        if group.is_still {
            self.places.clear();
        } else {
            self.places.place(wheels, track, &group.placements, rides);
        }
        let (riders, symmetric) = (self.places.list.len(), self.places.slopes.is_empty());
        self.block.begin(riders, symmetric, self.places.first_wheel);
        if riders == self.places.first_wheel {
            return;
        }
        for &lane in &group.lanes {
            let of = &mut self.wheels[lane];
            of.clear();
            for ride in lanes[lane].rides.iter().filter(|ride| ride.is_awake()) {
                let placement = &group.placements[ride.vehicle];
                of.extend((0..ride.wheels()).map(|wheel| ride.wheel(wheel, placement)));
            }
        }
    }

    /// Whether rows ask for velocities and displacements too.
    #[inline(always)]
    pub(super) fn needs_motion(&self) -> bool {
        self.places.needs_motion()
    }

    /// The part of the small systems that rides along, from the free motion `[q, v, a]` of the modes at the step's end. Masses are
    /// measured in displacement:
    /// `q' / ((1 - alpha_m) m c_a) = r u'' / c_a + (2 V / c_a) r_x u' + ((V^2 r_xx + V' r_x) / c_a) u` with
    /// `q' = (1 - alpha_m) q`; wheels on springs by [`WheelOnDeck`].
    #[inline(always)]
    pub(super) fn couple<S: Simd>(&mut self, o: Ops<S>, of: OfGroup<'_>, lanes: &[Lane], free: &[LaneArray; 3]) {
        let nr = self.places.list.len();
        if nr == 0 {
            return;
        }
        self.free_nodes(o, of, free);
        if self.places.runs.is_empty() {
            self.see_rows(of.compliance);
        } else {
            self.see_pairs(of.compliance);
        }
        for i in 0..self.places.first_wheel {
            let mass = self.places.list[i];
            self.couple_mass(o, of, i, &mass);
        }
        for i in self.places.first_wheel..nr {
            self.couple_wheel(o, of, i);
        }
        let first = self.places.first_wheel;
        for &lane in &of.group.lanes {
            let mut from = first;
            for ride in lanes[lane].rides.iter().filter(|ride| ride.is_awake()) {
                let many = ride.wheels();
                for w in 0..many {
                    for other in 0..many {
                        if let Some(at) = self.block.beside_at(from + w, from + other) {
                            *self.block.beside.at_mut(at, lane) = ride.among(w, other);
                        }
                    }
                    *self.block.own.at_mut(from + w, lane) = self.wheels[lane][from + w - first].own;
                }
                from += many;
            }
        }
    }

    #[inline(always)]
    fn couple_mass<S: Simd>(&mut self, o: Ops<S>, of: OfGroup<'_>, i: usize, mass: &MovingMass) {
        let (nr, s) = (self.places.list.len(), &of.constants.scheme);
        let row = self.block.row_mut(i);
        let [accelerations, velocities, places] = self.dots.each_ref().map(|of| of.vectors::<S>());
        let mut free = o.splat(0.0);
        for &(node, w) in &self.places.force[mass.force.0..mass.force.1] {
            let DeckNode { line, station } = self.places.nodes[node];
            add_to(row.among, w, &self.seen[node * nr..][..nr]);
            let there = of.compliance.with_connectors(line, station);
            add_to(row.of_links, w, there);
            add_to(row.on_links, w, there);
            free = o.fma(o.splat(w / s.c_a), accelerations[node], free);
        }
        let (speed, rate) = (mass.heading.speed_m_s, mass.heading.acceleration_m_s2);
        let (on_x, on_xx) = (2.0 * speed / s.c_a, speed * speed / s.c_a);
        for &(node, r_x, r_xx) in &self.places.slopes[mass.slopes.0..mass.slopes.1] {
            let of_u = on_xx * r_xx + rate / s.c_a * r_x;
            let (w, DeckNode { line, station }) = (on_x * s.c_v * r_x + of_u, self.places.nodes[node]);
            add_to(row.among, w, &self.seen[node * nr..][..nr]);
            add_to(row.of_links, w, of.compliance.with_connectors(line, station));
            free = o.fma(
                o.splat(on_x * r_x),
                velocities[node],
                o.fma(o.splat(of_u), places[node], free),
            );
        }
        let per_load = o.splat((1.0 - s.alpha_m) * s.c_a * mass.mass_kg_n);
        let own =
            o.0.div_f64s(o.splat(1.0), o.mul(per_load, of.group.load_n::<S>(mass.vehicle)));
        // lanes of other groups have no load
        let mask = of.group.mask(o);
        self.block.own.vectors_mut::<S>()[i] = o.0.select_f64s(mask, own, o.splat(1.0));
        self.block.free.vectors_mut::<S>()[i] = o.0.select_f64s(mask, free, o.splat(0.0));
    }

    #[inline(always)]
    fn couple_wheel<S: Simd>(&mut self, o: Ops<S>, group: OfGroup<'_>, i: usize) {
        let nr = self.places.list.len();
        let (number, of) = (i - self.places.first_wheel, self.places.list[i]);
        let (wheel, row) = (&self.places.wheels[number], self.block.row_mut(i));
        let [_, velocities, places] = self.dots.each_ref().map(|of| of.vectors::<S>());
        let mut known = [0.0; MOST_LANES];
        for &lane in &group.group.lanes {
            known[lane] = self.wheels[lane][number].known;
        }
        let mut free = lanes::<S>(&known)[0];
        let slopes = &self.places.slopes[of.slopes.0..of.slopes.1];
        for (&(node, w), (_, r_x, _)) in self.places.force[of.force.0..of.force.1].iter().zip(slopes) {
            let DeckNode { line, station } = self.places.nodes[node];
            let (there, damped) = (group.compliance.with_connectors(line, station), wheel.by_slope * r_x);
            add_to(row.among, w + damped, &self.seen[node * nr..][..nr]);
            add_to(row.of_links, w + damped, there);
            add_to(row.on_links, w, there);
            let of_place = o.splat(w * wheel.of_spring + damped);
            free = o.fma(
                o.splat(w * wheel.of_damper),
                velocities[node],
                o.fma(of_place, places[node], free),
            );
        }
        let mask = group.group.mask(o);
        self.block.own.vectors_mut::<S>()[i] = o.splat(1.0);
        self.block.free.vectors_mut::<S>()[i] = o.0.select_f64s(mask, free, o.splat(0.0));
    }

    /// Number of wheels on springs; they are the last riders.
    #[inline(always)]
    pub(super) fn wheels_on_springs(&self) -> usize {
        self.places.wheels.len()
    }

    /// Tells of each wheel on springs in a lane how high the deck under it is at the step's end, and its rate `[m, m/s]`; the nodes have
    /// moved, see [`Self::move_nodes`].
    #[inline(always)]
    pub(super) fn under_wheels(
        &self,
        lane: usize,
        constants: &StepConstants,
        mut tell: impl FnMut(usize, &WheelOnDeck, [f64; 2]),
    ) {
        let c_v = constants.scheme.c_v;
        let at = |of: &LaneArray, node: usize| of.at(node, lane);
        let [_, velocities, places] = &self.dots;
        for (number, of) in self.places.list[self.places.first_wheel..].iter().enumerate() {
            let (mut height_m, mut rate_m_s) = (0.0, 0.0);
            for &(node, w) in &self.places.force[of.force.0..of.force.1] {
                let down = at(&self.on_nodes, node);
                height_m += w * (at(places, node) - down);
                rate_m_s += w * (at(velocities, node) - c_v * down);
            }
            for &(node, r_x, _) in &self.places.slopes[of.slopes.0..of.slopes.1] {
                rate_m_s += of.heading.speed_m_s * r_x * (at(places, node) - at(&self.on_nodes, node));
            }
            tell(number, &self.wheels[lane][number], [height_m, rate_m_s]);
        }
    }

    /// Free motion of the nodes, without new connector and inertia forces.
    #[inline(always)]
    fn free_nodes<S: Simd>(&mut self, o: Ops<S>, of: OfGroup<'_>, [q, v, a]: &[LaneArray; 3]) {
        let (all, m) = (self.needs_motion(), of.constants.c.len());
        let newmark = Newmark::of(o, &of.constants.scheme);
        let lane = of.group.first();
        let [to_a, to_v, to_x] = self.dots.each_mut().map(|of| of.vectors_mut::<S>());
        for (i, node) in self.places.nodes.iter().enumerate() {
            let phi = &of.wheels.influence(*node)[..m];
            let [local_a, local_v, local_x] = self.next.free(o, lane, *node, &newmark);
            to_a[i] = o.add(local_a, sum_of_modes(o, phi, a));
            if all {
                to_v[i] = o.add(local_v, sum_of_modes(o, phi, v));
                to_x[i] = o.add(local_x, sum_of_modes(o, phi, q));
            }
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

    /// Follows the nodes near the vehicles of a group, see [`LocalResidual::follow`]; of each of its lanes the forces of masses and of
    /// springs in the last step, and those of the connectors.
    #[inline(always)]
    pub(super) fn follow<S: Simd>(&mut self, o: Ops<S>, of: OfGroup<'_>, lanes: &[Lane], n: &LaneArray) {
        let mut before: [[&[StationForce]; 2]; MOST_LANES] = [[&[]; 2]; MOST_LANES];
        for (before, &lane) in before.iter_mut().zip(&of.group.lanes) {
            let (masses, springs) = lanes[lane].rider_forces.split_at(lanes[lane].first_spring);
            *before = [masses, springs];
        }
        let nodes = &self.places.nodes;
        self.next
            .follow(o, &self.local, of.group, nodes, (of.wheels, of.constants), (&before, n));
    }

    /// No nodes near a lane's vehicles at the end of the step.
    pub(super) fn leave(&mut self, lane: usize) {
        self.next.clear(lane);
    }

    /// Begins a step in the only lane with the nodes of a lane of others.
    #[inline(always)]
    pub(super) fn begin_alone(&mut self, (from, lane): (&Self, usize)) {
        self.local.take_lane(0, (&from.local, lane));
        self.next.clear(0);
    }

    /// Takes what the only lane of others has at the end of the step.
    #[inline(always)]
    pub(super) fn take_alone(&mut self, lane: usize, from: &Self) {
        self.next.take_lane(lane, (&from.next, 0));
    }

    /// Ends the step of all lanes.
    pub(super) fn end_step(&mut self) {
        std::mem::swap(&mut self.local, &mut self.next);
    }

    /// Whether two lanes have the same nodes before the step.
    pub(super) fn alike(&self, lane: usize, other: usize) -> bool {
        self.local.alike(lane, other)
    }

    /// Puts the scaled forces of the riders on nodes, and moves these by them and by the scaled forces of the links that are active.
    #[inline(always)]
    pub(super) fn move_nodes<S: Simd>(
        &mut self,
        o: Ops<S>,
        compliance: &WheelCompliance,
        scaled: &LaneArray,
        (active, links): (&[usize], &LaneArray),
    ) {
        let (nr, nodes) = (self.places.list.len(), &self.places.nodes);
        let (scaled, links) = (&scaled.vectors::<S>()[..nr], links.vectors::<S>());
        let (masses, springs) = (self.by_masses.vectors_mut::<S>(), self.by_springs.vectors_mut::<S>());
        let zero = o.splat(0.0);
        masses[..nodes.len()].fill(zero);
        springs[..nodes.len()].fill(zero);
        for (i, (of, q)) in self.places.list.iter().zip(scaled).enumerate() {
            let to = if i < self.places.first_wheel {
                &mut *masses
            } else {
                &mut *springs
            };
            for &(node, w) in &self.places.force[of.force.0..of.force.1] {
                to[node] = o.fma(o.splat(w), *q, to[node]);
            }
        }
        if self.places.points.is_empty() && self.places.wheels.is_empty() {
            return;
        }
        let moved = self.on_nodes.vectors_mut::<S>();
        for (i, DeckNode { line, station }) in nodes.iter().enumerate() {
            let mut down = zero;
            for (seen, q) in self.seen[i * nr..][..nr].iter().zip(scaled) {
                down = o.fma(o.splat(*seen), *q, down);
            }
            let seen = compliance.with_connectors(*line, *station);
            for &link in active {
                down = o.fma(o.splat(seen[link]), links[link], down);
            }
            moved[i] = down;
        }
    }

    /// Adds each axle's force beyond its weight to `axles`: inertia force `m u''`, force of springs, given the scaled forces of riders.
    #[inline(always)]
    pub(super) fn add_forces<S: Simd>(&self, o: Ops<S>, of: OfGroup<'_>, scaled: &LaneArray, axles: &mut LaneArray) {
        let s = &of.constants.scheme;
        let (axles, scaled) = (axles.vectors_mut::<S>(), scaled.vectors::<S>());
        let (by_m, by_f) = (o.splat(1.0 / (1.0 - s.alpha_m)), o.splat(1.0 / (1.0 - s.alpha_f)));
        for (i, rider) in self.places.list.iter().enumerate() {
            // patches and wheels on springs have forces by themselves
            let factor = match i < self.places.first_wheel {
                true if rider.slopes.0 == rider.slopes.1 => continue,
                true => by_m,
                false => by_f,
            };
            axles[rider.axle] = o.fma(factor, scaled[i], axles[rider.axle]);
        }
        let (free, moved, c_a) = (
            self.dots[0].vectors::<S>(),
            self.on_nodes.vectors::<S>(),
            o.splat(s.c_a),
        );
        for p in &self.places.points {
            let left = o.less(free[p.node], c_a, moved[p.node]);
            let right = o.less(free[p.node + 1], c_a, moved[p.node + 1]);
            let between = o.fma(o.splat(1.0 - p.part), left, o.mul(o.splat(p.part), right));
            let mass = o.mul(o.splat(p.mass_kg_n), of.group.load_n::<S>(p.vehicle));
            axles[p.axle] = o.fma(mass, between, axles[p.axle]);
        }
    }

    /// Forces of masses and of wheels on springs on nodes.
    pub(super) fn forces(&self, constants: &StepConstants) -> [NodeForces<'_>; 2] {
        node_forces(&self.places, [&self.by_masses, &self.by_springs], constants)
    }

    /// Takes the nodes near the vehicles to the end of the step in the lanes of a mask, see [`LocalResidual::lead`].
    #[inline(always)]
    pub(super) fn lead<S: Simd>(&mut self, o: Ops<S>, of: OfGroup<'_>, mask: S::m64s, n: &LaneArray) {
        let forces = node_forces(&self.places, [&self.by_masses, &self.by_springs], of.constants);
        let lane = of.group.first();
        self.next.lead(o, (lane, mask), (of.wheels, of.constants), forces, n);
    }

    /// The nodes near vehicles.
    pub(super) fn local_residual(&mut self) -> &mut LocalResidual {
        &mut self.local
    }
}

/// Forces of masses and of wheels on springs on nodes.
#[inline(always)]
fn node_forces<'a>(
    places: &'a RidingPlaces,
    [masses, springs]: [&'a LaneArray; 2],
    constants: &StepConstants,
) -> [NodeForces<'a>; 2] {
    let s = &constants.scheme;
    let of = |there: bool, forces: &'a LaneArray, alpha: f64| NodeForces {
        nodes: if there { &places.nodes } else { &[] },
        forces,
        factor: 1.0 / (1.0 - alpha),
    };
    [
        of(places.first_wheel > 0, masses, s.alpha_m),
        of(!places.wheels.is_empty(), springs, s.alpha_f),
    ]
}

/// `phi x` over the modes, in four running sums.
#[inline(always)]
fn sum_of_modes<S: Simd>(o: Ops<S>, phi: &[f64], x: &LaneArray) -> S::f64s {
    let x = x.vectors::<S>();
    let mut sums = [o.splat(0.0); 4];
    let (phi_4, phi_rest) = phi.as_chunks::<4>();
    let (x_4, x_rest) = x[..phi.len()].as_chunks::<4>();
    for (phi, x) in phi_4.iter().zip(x_4) {
        for i in 0..4 {
            sums[i] = o.fma(o.splat(phi[i]), x[i], sums[i]);
        }
    }
    for (phi, x) in phi_rest.iter().zip(x_rest) {
        sums[0] = o.fma(o.splat(*phi), *x, sums[0]);
    }
    o.add(o.add(sums[0], sums[1]), o.add(sums[2], sums[3]))
}
