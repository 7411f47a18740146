//! Where what rides along in lanes that go together is: nodes of the deck, masses, wheels on springs, and their rows on nodes.
//!
//! Knows the vehicles' places at one instant, laid out once so that a step allocates nothing. Does not know flexibilities or the
//! scheme.

use super::line_mass::LineMass;
use super::rides::{LaneRide, WheelOnDeck};
use super::wheel_lines::{DeckNode, LinePoint, VehicleLines, WheelLines};
use crate::bridge::{Heading, Track, VehiclePlacement};
use crate::vehicle::{GRAVITY_M_S2, Inertia};

/// A mass or a wheel on its spring, and its rows on nodes.
#[derive(Debug, Clone, Copy)]
pub(super) struct MovingMass {
    /// Mass for a unit load of its vehicle; 0 of a wheel `[kg/N]`.
    pub mass_kg_n: f64,
    pub vehicle: usize,
    pub axle: usize,
    /// Speed and acceleration along x.
    pub heading: Heading,
    /// Entries of its row r.
    pub force: (usize, usize),
    /// Entries of its rows r_x and r_xx, where convective; of a wheel r_x on the nodes of r.
    pub slopes: (usize, usize),
}

/// Masses on neighbouring stations of a line.
#[derive(Debug, Clone, Copy)]
pub(super) struct MassRun {
    pub line: usize,
    pub first: usize,
    pub count: usize,
    /// The first one's number.
    pub from: usize,
}

/// A point of a patch between a node and the next.
#[derive(Debug, Clone, Copy)]
pub(super) struct MassPoint {
    pub node: usize,
    pub part: f64,
    /// Mass for a unit load of its vehicle `[kg/N]`.
    pub mass_kg_n: f64,
    pub vehicle: usize,
    pub axle: usize,
}

/// What rides along at one instant. Masses of [`LineMass`] stand for the points of a `local` vehicle.
#[derive(Debug, Default)]
pub(super) struct RidingPlaces {
    pub(super) nodes: Vec<DeckNode>,
    /// Masses, behind them wheels on springs; the first of these.
    pub(super) list: Vec<MovingMass>,
    pub(super) first_wheel: usize,
    /// Wheels of the lane that stands for its group: what of them is no lane's own.
    pub(super) wheels: Vec<WheelOnDeck>,
    pub(super) points: Vec<MassPoint>,
    pub(super) force: Vec<(usize, f64)>,
    pub(super) slopes: Vec<(usize, f64, f64)>,
    /// Masses on a station and the next, where all are; and the second entry of the row of each.
    pub(super) runs: Vec<MassRun>,
    pub(super) nexts: Vec<f64>,
    line: LineMass,
}

impl RidingPlaces {
    /// Room for traffic of at most `nodes` nodes.
    pub(super) fn new(nodes: usize) -> Self {
        Self {
            nodes: Vec::with_capacity(nodes),
            list: Vec::with_capacity(nodes),
            nexts: Vec::with_capacity(nodes),
            ..Self::default()
        }
    }

    /// Nothing rides along.
    #[inline(always)]
    pub(super) fn clear(&mut self) {
        self.nodes.clear();
        self.list.clear();
        self.wheels.clear();
        self.points.clear();
        self.force.clear();
        self.slopes.clear();
        self.runs.clear();
        self.nexts.clear();
        self.first_wheel = 0;
    }

    /// Puts what rides along where it is: nodes, masses, wheels on springs and their rows.
    #[inline(always)]
    pub(super) fn place(
        &mut self,
        wheels: &WheelLines,
        track: &Track,
        placements: &[VehiclePlacement],
        rides: &[LaneRide],
    ) {
        self.clear();
        for (number, (of, placement)) in wheels.vehicles.iter().zip(placements).enumerate() {
            match of.vehicle.inertia {
                Inertia::None => {}
                Inertia::Local => {
                    for (line, points) in &of.masses {
                        self.place_line(*line, points, number, placement);
                    }
                }
                Inertia::Convective => self.place_patches(of, track, number, placement),
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
    }

    /// Wheels on springs: the mean over a patch's points and the mean slope, on one list of nodes.
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
                        match self.force[forces..].iter().position(|(n, _)| *n == node) {
                            Some(known) => {
                                self.force[forces + known].1 += w * part;
                                self.slopes[slopes + known].1 += slope;
                            }
                            None => {
                                self.force.push((node, w * part));
                                self.slopes.push((node, slope, 0.0));
                            }
                        }
                    }
                }
            }
            self.list.push(MovingMass {
                mass_kg_n: 0.0,
                vehicle: ride.vehicle,
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
    fn place_line(&mut self, line: usize, points: &[LinePoint], vehicle: usize, placement: &VehiclePlacement) {
        let first = self.gather_line(points, vehicle, placement);
        let base = self.nodes.len();
        for at in 0..self.line.stations() {
            let station = first + at;
            self.nodes.push(DeckNode { line, station });
            let [mass_kg_n, next] = self.line.factor(at);
            if mass_kg_n > 0.0 {
                let mass = (vehicle, mass_kg_n, placement.heading);
                self.add_mass(DeckNode { line, station }, base + at, mass, next);
            }
        }
    }

    /// The mass matrix of a line's points for a unit load of their vehicle, and its first station.
    #[inline(always)]
    fn gather_line(&mut self, points: &[LinePoint], vehicle: usize, placement: &VehiclePlacement) -> usize {
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
            let (at, mass_kg_n) = (cell.station - first, point.share / GRAVITY_M_S2);
            self.line.add(at, cell.fraction, mass_kg_n);
            self.points.push(MassPoint {
                node: base + at,
                part: cell.fraction,
                mass_kg_n,
                vehicle,
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
        (vehicle, mass_kg_n, heading): (usize, f64, Heading),
        next: f64,
    ) {
        let from = self.force.len();
        self.force.push((node, 1.0));
        if next != 0.0 {
            self.force.push((node + 1, next / mass_kg_n));
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
        self.nexts.push(next / mass_kg_n);
        self.list.push(MovingMass {
            mass_kg_n,
            vehicle,
            axle: 0,
            heading,
            force: (from, self.force.len()),
            slopes: (0, 0),
        });
    }

    /// The patches' means, measured by `r u'' + 2 V r_x u' + V^2 r_xx u`; the derivatives are differences of the row and of
    /// its slope between the ends of the patch.
    #[inline(always)]
    fn place_patches(&mut self, of: &VehicleLines, track: &Track, vehicle: usize, placement: &VehiclePlacement) {
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
                mass_kg_n: share * patch.rigid / GRAVITY_M_S2,
                vehicle,
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
}

/// Adds to the entry of a row that begins at `from`.
#[inline(always)]
fn add(row: &mut Vec<(usize, f64)>, from: usize, node: usize, w: f64) {
    match row[from..].iter_mut().find(|(n, _)| *n == node) {
        Some((_, sum)) => *sum += w,
        None => row.push((node, w)),
    }
}
