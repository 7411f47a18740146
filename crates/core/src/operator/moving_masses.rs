//! What rides along in one lane, masses and wheels on springs: where they are, what they see of each other and of the connectors.
//!
//! Knows the vehicles' places at one instant, laid out once so that a step allocates nothing. Does not know the scheme but
//! for its factors.

use super::lane_array::LaneArray;
use super::line_mass::LineMass;
use super::loads::StationForce;
use super::local_residual::{LocalResidual, StepForces};
use super::rider_block::RiderBlock;
use super::rides::{LaneRide, WheelOnDeck};
use super::step_constants::StepConstants;
use super::sums::{add_to, dot};
use super::wheel_lines::{DeckNode, LinePoint, VehicleLines, WheelCompliance, WheelLines};
use crate::bridge::{Heading, Track, VehiclePlacement};
use crate::vehicle::{GRAVITY_M_S2, Inertia};

/// A mass or a wheel on its spring, and its rows on nodes.
#[derive(Debug, Clone, Copy)]
struct MovingMass {
    /// Mass; 0 of a wheel `[kg]`.
    mass_kg: f64,
    axle: usize,
    /// Speed and acceleration along x.
    heading: Heading,
    /// Entries of its row r.
    force: (usize, usize),
    /// Entries of its rows r_x and r_xx, where convective.
    slopes: (usize, usize),
}

/// Masses on neighbouring stations of a line.
#[derive(Debug, Clone, Copy)]
struct MassRun {
    line: usize,
    first: usize,
    count: usize,
    /// The first one's number.
    from: usize,
}

/// A point of a patch between a node and the next.
#[derive(Debug, Clone, Copy)]
struct MassPoint {
    node: usize,
    part: f64,
    mass_kg: f64,
    axle: usize,
}

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

/// What rides along in one lane at one instant. Masses of [`LineMass`] stand for the points of a `local` vehicle.
#[derive(Debug)]
pub(super) struct MovingMasses {
    connectors: usize,
    nodes: Vec<DeckNode>,
    /// Masses, behind them wheels on springs; the first of these.
    list: Vec<MovingMass>,
    first_wheel: usize,
    wheels: Vec<WheelOnDeck>,
    points: Vec<MassPoint>,
    force: Vec<(usize, f64)>,
    slopes: Vec<(usize, f64, f64)>,
    /// Masses on a station and the next, where all are; and the second entry of the row of each.
    runs: Vec<MassRun>,
    nexts: Vec<f64>,
    line: LineMass,
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
            nodes: Vec::with_capacity(nodes),
            list: Vec::with_capacity(nodes),
            first_wheel: 0,
            wheels: Vec::new(),
            points: Vec::new(),
            force: Vec::new(),
            slopes: Vec::new(),
            runs: Vec::new(),
            nexts: Vec::with_capacity(nodes),
            line: LineMass::default(),
            dots: Vec::with_capacity(nodes),
            seen: vec![0.0; nodes * nodes],
            block: RiderBlock::new(nodes, connectors),
            local: LocalResidual::new(nodes),
            next: LocalResidual::new(nodes),
            on_nodes: vec![0.0; nodes],
        }
    }

    pub(super) fn count(&self) -> usize {
        self.list.len()
    }

    /// Operations of [`MovingMasses::follow`] and [`MovingMasses::couple`] on so many modes.
    pub(super) fn flop_of_coupling(&self, modes: usize) -> f64 {
        let (n, r, c) = (self.nodes.len(), self.list.len(), self.connectors);
        let motions = if self.needs_motion() { 3 } else { 1 };
        let entries = self.force.len() + self.slopes.len();
        (2 * motions * modes * n + 2 * n * r + entries * 2 * (r + c) + 12 * n) as f64
    }

    /// Operations of the masses' forces on so many rows and of [`MovingMasses::lead`].
    pub(super) fn flop_of_leading(&self, rows: usize) -> f64 {
        let (n, r, c) = (self.nodes.len(), self.list.len(), self.connectors);
        (2 * n * rows + 2 * n * (r + c) + 2 * n * c + 2 * self.force.len() + 14 * n) as f64
    }

    /// Puts what rides along where it is: nodes, masses, wheels on springs and their rows.
    #[inline(always)]
    pub(super) fn place(
        &mut self,
        wheels: &WheelLines,
        track: &Track,
        loads_n: impl Fn(usize) -> f64,
        placements: &[VehiclePlacement],
        rides: &[LaneRide],
    ) {
        self.nodes.clear();
        self.list.clear();
        self.wheels.clear();
        self.points.clear();
        self.force.clear();
        self.slopes.clear();
        self.runs.clear();
        self.nexts.clear();
        for (number, (of, placement)) in wheels.vehicles.iter().zip(placements).enumerate() {
            match of.vehicle.inertia {
                Inertia::None => {}
                Inertia::Local => {
                    for (line, points) in &of.masses {
                        self.place_line(*line, points, loads_n(number), placement);
                    }
                }
                Inertia::Convective => self.place_patches(of, track, loads_n(number), placement),
            }
        }
        // rows of any form are looked at one by one
        let pairs = self.slopes.is_empty();
        self.first_wheel = self.list.len();
        for ride in rides {
            self.place_wheels(&wheels.vehicles[ride.vehicle], &placements[ride.vehicle], ride);
        }
        if !pairs || self.list.len() > self.first_wheel {
            self.runs.clear();
        }
        self.block.begin(self.list.len(), self.slopes.is_empty());
    }

    /// Wheels on springs: the mean over a patch's points, and the slope where a damper asks for it.
    #[inline(always)]
    fn place_wheels(&mut self, of: &VehicleLines, placement: &VehiclePlacement, ride: &LaneRide) {
        if !ride.is_awake() {
            return;
        }
        for (wheel, (patch, lines)) in of.vehicle.patches.iter().zip(&of.points).enumerate() {
            let on_deck = ride.wheel(wheel, placement);
            let (forces, slopes) = (self.force.len(), self.slopes.len());
            for (p, &line) in patch.points.iter().zip(lines) {
                if let Some(place) = placement.cell(p.along) {
                    let w = p.share / patch.share;
                    for (station, part, slope) in [
                        (place.station, 1.0 - place.fraction, -w / place.length_m),
                        (place.station + 1, place.fraction, w / place.length_m),
                    ] {
                        let node = self.node(DeckNode { line, station });
                        if part != 0.0 {
                            add(&mut self.force, forces, node, w * part);
                        }
                        if on_deck.by_slope != 0.0 {
                            self.slopes.push((node, slope, 0.0));
                        }
                    }
                }
            }
            self.list.push(MovingMass {
                mass_kg: 0.0,
                axle: of.first_axle + patch.axle,
                heading: placement.heading,
                force: (forces, self.force.len()),
                slopes: (slopes, self.slopes.len()),
            });
            self.wheels.push(on_deck);
        }
    }

    /// Whether rows ask for velocities and displacements too.
    #[inline(always)]
    pub(super) fn needs_motion(&self) -> bool {
        !self.slopes.is_empty() || !self.wheels.is_empty()
    }

    /// `u''` of the deck under each point: the line's mass matrix and its factors.
    #[inline(always)]
    fn place_line(&mut self, line: usize, points: &[LinePoint], load_n: f64, placement: &VehiclePlacement) {
        let first = self.gather_line(points, load_n, placement);
        let base = self.nodes.len();
        for at in 0..self.line.stations() {
            let station = first + at;
            self.nodes.push(DeckNode { line, station });
            let [mass_kg, next] = self.line.factor(at);
            if mass_kg > 0.0 {
                self.add_mass(DeckNode { line, station }, base + at, mass_kg, next, placement.heading);
            }
        }
    }

    /// The mass matrix of a line's points, and its first station.
    #[inline(always)]
    fn gather_line(&mut self, points: &[LinePoint], load_n: f64, placement: &VehiclePlacement) -> usize {
        self.line.clear();
        let base = self.nodes.len();
        let mut first = 0;
        for point in points {
            let Some(cell) = placement.cell(point.along) else {
                continue;
            };
            if self.line.stations() == 0 {
                first = cell.station;
            }
            let (at, mass_kg) = (cell.station - first, point.share * load_n / GRAVITY_M_S2);
            self.line.add(at, cell.fraction, mass_kg);
            self.points.push(MassPoint {
                node: base + at,
                part: cell.fraction,
                mass_kg,
                axle: point.axle,
            });
        }
        first
    }

    /// A mass on the row of a station and of the next, to which the matrix has the entry `next`.
    #[inline(always)]
    fn add_mass(
        &mut self,
        DeckNode { line, station }: DeckNode,
        node: usize,
        mass_kg: f64,
        next: f64,
        heading: Heading,
    ) {
        let from = self.force.len();
        self.force.push((node, 1.0));
        if next != 0.0 {
            self.force.push((node + 1, next / mass_kg));
        }
        match self.runs.last_mut() {
            Some(run) if run.line == line && run.first + run.count == station => run.count += 1,
            _ => self.runs.push(MassRun {
                line,
                first: station,
                from: self.list.len(),
                count: 1,
            }),
        }
        self.nexts.push(next / mass_kg);
        self.list.push(MovingMass {
            mass_kg,
            axle: 0,
            heading,
            force: (from, self.force.len()),
            slopes: (0, 0),
        });
    }

    /// The patches' means, measured by `r u'' + 2 V r_x u' + V^2 r_xx u`; the derivatives are differences of the row and of
    /// its slope between the ends of the patch.
    #[inline(always)]
    fn place_patches(&mut self, of: &VehicleLines, track: &Track, load_n: f64, placement: &VehiclePlacement) {
        for (patch, lines) in of.vehicle.patches.iter().zip(&of.points) {
            let share = placement.share_on(patch);
            if share <= 0.0 || patch.rigid == 0.0 {
                continue;
            }
            let forces = self.force.len();
            for (p, &line) in patch.points.iter().zip(lines) {
                if let Some(place) = placement.cell(p.along) {
                    let w = p.share / share;
                    for (station, part) in place.shares() {
                        if part != 0.0 {
                            let node = self.node(DeckNode { line, station });
                            add(&mut self.force, forces, node, w * part);
                        }
                    }
                }
            }
            let slopes = self.slopes.len();
            let [left, right] = placement.ends_m(track, patch);
            let across = || {
                (0..lines.len())
                    .filter(|&i| !lines[..i].contains(&lines[i]))
                    .map(|i| lines[i])
            };
            let per = 1.0 / ((right - left) * across().count() as f64);
            for line in across() {
                for (x, sign) in [(right, per), (left, -per)] {
                    if let Some(place) = track.cell(x) {
                        let slope = sign / place.length_m;
                        for (station, r, r_x) in [
                            (place.station, sign * (1.0 - place.fraction), -slope),
                            (place.station + 1, sign * place.fraction, slope),
                        ] {
                            let node = self.node(DeckNode { line, station });
                            self.slopes.push((node, r, r_x));
                        }
                    }
                }
            }
            self.list.push(MovingMass {
                mass_kg: load_n * (share * patch.rigid) / GRAVITY_M_S2,
                axle: of.first_axle + patch.axle,
                heading: placement.heading,
                force: (forces, self.force.len()),
                slopes: (slopes, self.slopes.len()),
            });
        }
    }

    /// The number of a node, which is added where it is new.
    #[inline(always)]
    fn node(&mut self, node: DeckNode) -> usize {
        self.nodes.iter().position(|n| *n == node).unwrap_or_else(|| {
            self.nodes.push(node);
            self.nodes.len() - 1
        })
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
        let nr = self.list.len();
        if nr == 0 {
            return;
        }
        let s = &constants.scheme;
        self.free_nodes(wheels, constants, modes, free);
        if self.runs.is_empty() {
            self.see_rows(compliance);
        } else {
            self.see_pairs(compliance);
        }
        for (i, mass) in self.list[..self.first_wheel].iter().enumerate() {
            let row = self.block.row_mut(i);
            let mut free = 0.0;
            for &(node, w) in &self.force[mass.force.0..mass.force.1] {
                let DeckNode { line, station } = self.nodes[node];
                add_to(row.among, w, &self.seen[node * nr..][..nr]);
                let there = compliance.with_connectors(line, station);
                add_to(row.of_links, w, there);
                add_to(row.on_links, w, there);
                free += w * self.dots[node][0] / s.c_a;
            }
            let (speed, rate) = (mass.heading.speed_m_s, mass.heading.acceleration_m_s2);
            let (on_x, on_xx) = (2.0 * speed / s.c_a, speed * speed / s.c_a);
            for &(node, r_x, r_xx) in &self.slopes[mass.slopes.0..mass.slopes.1] {
                let of_u = on_xx * r_xx + rate / s.c_a * r_x;
                let (w, DeckNode { line, station }) = (on_x * s.c_v * r_x + of_u, self.nodes[node]);
                add_to(row.among, w, &self.seen[node * nr..][..nr]);
                add_to(row.of_links, w, compliance.with_connectors(line, station));
                free += on_x * r_x * self.dots[node][1] + of_u * self.dots[node][2];
            }
            row.among[i] += 1.0 / ((1.0 - s.alpha_m) * mass.mass_kg * s.c_a);
            *row.free = free;
        }
        for (i, wheel) in (self.first_wheel..).zip(&self.wheels) {
            let (row, of) = (self.block.row_mut(i), self.list[i]);
            let mut free = wheel.known;
            for &(node, w) in &self.force[of.force.0..of.force.1] {
                let DeckNode { line, station } = self.nodes[node];
                add_to(row.among, w, &self.seen[node * nr..][..nr]);
                let there = compliance.with_connectors(line, station);
                add_to(row.of_links, w, there);
                add_to(row.on_links, w, there);
                let [_, v, x] = self.dots[node];
                free += w * (wheel.of_spring * x + wheel.of_damper * v);
            }
            for &(node, r_x, _) in &self.slopes[of.slopes.0..of.slopes.1] {
                let (w, DeckNode { line, station }) = (wheel.by_slope * r_x, self.nodes[node]);
                add_to(row.among, w, &self.seen[node * nr..][..nr]);
                add_to(row.of_links, w, compliance.with_connectors(line, station));
                free += w * self.dots[node][2];
            }
            *row.free = free;
        }
        let mut from = self.first_wheel;
        for ride in rides.iter().filter(|ride| ride.is_awake()) {
            let many = ride.wheels();
            for w in 0..many {
                let row = self.block.row_mut(from + w);
                ride.add_among(w, &mut row.among[from..][..many]);
                row.among[from + w] += self.wheels[from + w - self.first_wheel].own;
            }
            from += many;
        }
    }

    /// Number of wheels on springs; they are the last riders.
    #[inline(always)]
    pub(super) fn wheels_on_springs(&self) -> usize {
        self.wheels.len()
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
        let (nr, s) = (self.list.len(), &constants.scheme);
        for (node, DeckNode { line, station }) in self.nodes.iter().enumerate() {
            let from_riders = dot(&self.seen[node * nr..][..nr], scaled);
            let from_connectors = dot(compliance.with_connectors(*line, *station), connectors);
            self.on_nodes[node] = from_riders + from_connectors;
        }
        for (number, of) in self.list[self.first_wheel..].iter().enumerate() {
            let (mut height_m, mut rate_m_s) = (0.0, 0.0);
            for &(node, w) in &self.force[of.force.0..of.force.1] {
                let ([_, v, x], down) = (self.dots[node], self.on_nodes[node]);
                height_m += w * (x - down);
                rate_m_s += w * (v - s.c_v * down);
            }
            for &(node, r_x, _) in &self.slopes[of.slopes.0..of.slopes.1] {
                rate_m_s += of.heading.speed_m_s * r_x * (self.dots[node][2] - self.on_nodes[node]);
            }
            tell(number, &self.wheels[number], [height_m, rate_m_s]);
        }
    }

    /// Free motion of the nodes, without new connector and inertia forces.
    #[inline(always)]
    fn free_nodes(&mut self, wheels: &WheelLines, constants: &StepConstants, modes: usize, free: &FreeMotion) {
        let all = self.needs_motion();
        self.dots.clear();
        for node in &self.nodes {
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
        let nr = self.list.len();
        for (a, node) in self.nodes.iter().enumerate() {
            let seen = &mut self.seen[a * nr..][..nr];
            for (seen, mass) in seen.iter_mut().zip(&self.list) {
                let row = &self.force[mass.force.0..mass.force.1];
                if row.is_empty() {
                    // a wheel on the road beside the bridge
                    *seen = 0.0;
                    continue;
                }
                let first = self.nodes[row[0].0];
                // rows lie on few lines, their nodes side by side
                let (mut line, mut there) = (first.line, compliance.row(node.line, node.station, first.line));
                let mut sum = 0.0;
                for &(b, w) in row {
                    let other = self.nodes[b];
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
        let nr = self.list.len();
        for (a, node) in self.nodes.iter().enumerate() {
            let seen = &mut self.seen[a * nr..][..nr];
            for run in &self.runs {
                let row =
                    &compliance.row(node.line, node.station, run.line)[run.first + compliance.band - node.station..];
                let (near, far) = (&row[..run.count], &row[1..][..run.count]);
                let nexts = &self.nexts[run.from..][..run.count];
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
            .follow(&self.local, &self.nodes, wheels, constants, modes, pressing);
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
        self.put_on_nodes((0, self.first_wheel), scaled, factor, forces);
    }

    /// Force on each node from the scaled forces of wheels on springs times `factor`.
    #[inline(always)]
    pub(super) fn springs_on_nodes(&mut self, scaled: &[f64], factor: f64, forces: &mut Vec<StationForce>) {
        self.put_on_nodes((self.first_wheel, self.list.len()), scaled, factor, forces);
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
        let nn = self.nodes.len();
        self.on_nodes[..nn].fill(0.0);
        for (mass, q) in self.list[from..end].iter().zip(&scaled[from..end]) {
            for &(node, w) in &self.force[mass.force.0..mass.force.1] {
                self.on_nodes[node] += w * q;
            }
        }
        for (node, f) in self.nodes.iter().zip(&self.on_nodes) {
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
        let (nr, s) = (self.list.len(), &constants.scheme);
        for (wheel, q) in self.list.iter().zip(scaled).skip(self.first_wheel) {
            axles[wheel.axle] += q / (1.0 - s.alpha_f);
        }
        let patches = self.list[..self.first_wheel].iter().zip(scaled);
        for (mass, q) in patches.filter(|(mass, _)| mass.slopes.0 != mass.slopes.1) {
            axles[mass.axle] += q / (1.0 - s.alpha_m);
        }
        if self.points.is_empty() {
            return;
        }
        for (node, DeckNode { line, station }) in self.nodes.iter().enumerate() {
            let from_riders = dot(&self.seen[node * nr..][..nr], scaled);
            let from_connectors = dot(compliance.with_connectors(*line, *station), connectors);
            self.on_nodes[node] = self.dots[node][0] - s.c_a * (from_riders + from_connectors);
        }
        for p in &self.points {
            let (left, right) = (self.on_nodes[p.node], self.on_nodes[p.node + 1]);
            axles[p.axle] += p.mass_kg * ((1.0 - p.part) * left + p.part * right);
        }
    }
}

/// Adds to the entry of a row that begins at `from`.
#[inline(always)]
fn add(row: &mut Vec<(usize, f64)>, from: usize, node: usize, w: f64) {
    match row[from..].iter_mut().find(|(n, _)| *n == node) {
        Some((_, sum)) => *sum += w,
        None => row.push((node, w)),
    }
}
