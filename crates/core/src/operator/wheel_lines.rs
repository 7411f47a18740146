//! What vehicles see of the deck: their points on lines along the bridge, and what a force there does.
//!
//! Knows the traffic of a crossing on one operator. Does not know loads, speeds or steps but for the flexibilities that it is asked
//! for.

use super::basis::BridgeOperator;
use super::step_constants::StepConstants;
use crate::bridge::Track;
use crate::response::AxlePlace;
use crate::traffic::Traffic;
use crate::vehicle::{Inertia, Vehicle};
use nalgebra::DMatrix;
use std::sync::Arc;

/// A wheel point on its line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct LinePoint {
    /// Number of its place along the vehicle.
    pub along: usize,
    /// Share of the vehicle's weight that lies on the deck without a spring.
    pub share: f64,
    /// Its axle, numbered through all vehicles.
    pub axle: usize,
}

/// Wheel points of one vehicle on one line along the bridge, or on several that carry the same.
#[derive(Debug)]
pub(super) struct WheelLine {
    /// Number of the vehicle.
    pub vehicle: usize,
    /// Lines of nodes that carry these points.
    pub lines: Vec<usize>,
    /// Points in the order of x.
    pub points: Vec<LinePoint>,
    /// For each station the influence of a unit force there: `phi`, `R_BL`, `R_VL`, edges inside modules.
    pub influence: Arc<[f64]>,
}

/// A node of the deck under the vehicles: line of [`WheelLines`] and station.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct DeckNode {
    pub line: usize,
    pub station: usize,
}

/// A vehicle on an operator's deck.
#[derive(Debug)]
pub(super) struct VehicleLines {
    pub vehicle: Arc<Vehicle>,
    /// Lines of nodes under its points that carry mass without a spring, and these points in the order of x.
    pub masses: Vec<(usize, Vec<LinePoint>)>,
    /// Line of nodes of each point of each patch.
    pub points: Vec<Vec<usize>>,
    /// The first of its axles among those of all vehicles.
    pub first_axle: usize,
}

/// The vehicles of a crossing on an operator's deck.
#[derive(Debug)]
pub(crate) struct WheelLines {
    pub(super) vehicles: Vec<VehicleLines>,
    /// Lines for the weights, those of a vehicle that carry the same taken together.
    pub(super) weights: Vec<WheelLine>,
    /// Influences of the lines of nodes, one a place across; none where nothing rides along.
    pub(super) nodes: Vec<Arc<[f64]>>,
    /// What the modes leave out between nodes: for each node every line from `station - residual_band` on.
    residual: Vec<f64>,
    residual_band: usize,
    /// Columns of an influence.
    pub(super) influence_width: usize,
    /// Stations farther apart than this never carry the vehicles at once.
    pub(super) band: usize,
    stations: usize,
    /// Nodes that may be under the vehicles at once.
    most_nodes: usize,
    /// Whether what rides along asks for velocities and displacements too.
    pub(super) needs_motion: bool,
}

impl WheelLines {
    /// The vehicle and its own axle of an axle numbered through all vehicles.
    pub(super) fn axle_place(&self, axle: usize) -> AxlePlace {
        let vehicle = self.vehicles.partition_point(|of| of.first_axle <= axle);
        let first = self.vehicles[..vehicle].last().map_or(0, |of| of.first_axle);
        AxlePlace {
            vehicle,
            axle: axle - first + 1,
        }
    }

    /// The vehicles on the deck of an operator.
    pub(crate) fn new(operator: &BridgeOperator, traffic: &Traffic) -> Self {
        let track = &operator.track;
        let places_y = places_across(traffic);
        let influences: Vec<Arc<[f64]>> = places_y.iter().map(|y| line_influence(operator, *y).into()).collect();
        let (mut vehicles, mut weights): (Vec<VehicleLines>, Vec<WheelLine>) = (Vec::new(), Vec::new());
        let mut axles = 0;
        for (number, driven) in traffic.vehicles.iter().enumerate() {
            let vehicle = &driven.vehicle;
            let mut lines: Vec<(usize, Vec<LinePoint>)> = Vec::new();
            let mut points = Vec::new();
            for patch in &vehicle.patches {
                let mut own = Vec::new();
                for p in &patch.points {
                    let line = places_y.iter().position(|y| *y == p.y_m).unwrap_or_default();
                    own.push(line);
                    if patch.rigid == 0.0 {
                        continue;
                    }
                    let at = lines.iter().position(|(of, _)| *of == line).unwrap_or_else(|| {
                        lines.push((line, Vec::new()));
                        lines.len() - 1
                    });
                    lines[at].1.push(LinePoint {
                        along: p.along,
                        share: p.share * patch.rigid,
                        axle: axles + patch.axle,
                    });
                }
                points.push(own);
            }
            for (_, points) in &mut lines {
                points.sort_by(|a, b| vehicle.along_m[a.along].total_cmp(&vehicle.along_m[b.along]));
                if driven.drive.backward {
                    points.reverse();
                }
            }
            let first = weights.len();
            for (line, points) in &lines {
                match weights[first..].iter_mut().find(|w| w.points == *points) {
                    Some(same) => {
                        same.lines.push(*line);
                        let sum = same.influence.iter().zip(&*influences[*line]).map(|(a, b)| a + b);
                        same.influence = sum.collect();
                    }
                    None => weights.push(WheelLine {
                        vehicle: number,
                        lines: vec![*line],
                        points: points.clone(),
                        influence: Arc::clone(&influences[*line]),
                    }),
                }
            }
            // equal vehicles share what they see
            for at in first..weights.len() {
                let same = weights[..first].iter().find(|w| w.lines == weights[at].lines);
                if let Some(influence) = same.map(|w| Arc::clone(&w.influence)) {
                    weights[at].influence = influence;
                }
            }
            vehicles.push(VehicleLines {
                vehicle: Arc::clone(vehicle),
                masses: if vehicle.inertia == Inertia::None {
                    Vec::new()
                } else {
                    lines
                },
                points,
                first_axle: axles,
            });
            axles += vehicle.axles;
        }
        let band = band(track, traffic);
        let ride = traffic.vehicles.iter().any(|driven| rides(&driven.vehicle));
        let across: Vec<_> = places_y.iter().map(|y| track.across(*y)).collect();
        let residual_band = if vehicles.len() > 1 {
            band.min(operator.near)
        } else {
            band
        };
        let residual = if ride {
            residual(operator, &across, residual_band)
        } else {
            Vec::new()
        };
        Self {
            band,
            residual,
            residual_band,
            most_nodes: Self::most_nodes_of(operator, traffic),
            needs_motion: traffic.vehicles.iter().any(|driven| needs_motion(&driven.vehicle)),
            vehicles,
            weights,
            nodes: if ride { influences } else { Vec::new() },
            influence_width: operator.sizes.influence(),
            stations: track.stations(),
        }
    }

    /// The most nodes of the deck under what rides at once.
    pub(crate) fn most_nodes(&self) -> usize {
        self.most_nodes
    }

    /// No fewer nodes, masses and wheels than vehicles have that are not on the deck yet.
    pub(crate) fn most_nodes_of(operator: &BridgeOperator, traffic: &Traffic) -> usize {
        let of = |vehicle: &Vehicle| {
            let wheels = if vehicle.springs.is_some() {
                vehicle.patches.len()
            } else {
                0
            };
            // as many masses as nodes at most, and the wheels
            lines_across(vehicle).len() * (vehicle_band(&operator.track, vehicle) + 1) + wheels
        };
        let vehicles = traffic.vehicles.iter().filter(|driven| rides(&driven.vehicle));
        vehicles.map(|driven| of(&driven.vehicle)).sum()
    }
}

/// Whether anything of a vehicle rides along: masses or wheels on springs.
fn rides(vehicle: &Vehicle) -> bool {
    vehicle.springs.is_some() || vehicle.inertia != Inertia::None
}

/// Whether what rides along asks for velocities and displacements of the deck.
fn needs_motion(vehicle: &Vehicle) -> bool {
    vehicle.springs.is_some() || vehicle.inertia == Inertia::Convective
}

/// Places of a vehicle's points across, in their order, each once `[m]`.
fn lines_across(vehicle: &Vehicle) -> Vec<f64> {
    let mut places_y: Vec<f64> = Vec::new();
    for point in vehicle.points() {
        if !places_y.contains(&point.y_m) {
            places_y.push(point.y_m);
        }
    }
    places_y
}

/// Places of all vehicles' points across, each once `[m]`.
fn places_across(traffic: &Traffic) -> Vec<f64> {
    let mut places_y: Vec<f64> = Vec::new();
    for y_m in traffic.vehicles.iter().flat_map(|driven| lines_across(&driven.vehicle)) {
        if !places_y.contains(&y_m) {
            places_y.push(y_m);
        }
    }
    places_y
}

/// Entries of a row from `station - band` to `station + band`, and a zero after the last, for those who look at the next.
fn row_width(band: usize) -> usize {
    2 * band + 2
}

/// R between the nodes of lines that lie between lines of the deck.
fn residual(operator: &BridgeOperator, across: &[[(usize, f64); 2]], band: usize) -> Vec<f64> {
    let (stations, width) = (operator.track.stations(), row_width(band));
    let mut all = vec![0.0; across.len() * stations * across.len() * width];
    for (line, own) in across.iter().enumerate() {
        for s in 0..stations {
            for (other_line, other) in across.iter().enumerate() {
                for t in s.saturating_sub(band)..(s + band + 1).min(stations) {
                    let mut sum = 0.0;
                    for (i, a) in own {
                        for (j, b) in other {
                            if a * b != 0.0 {
                                sum += a * b * operator.residual(i * stations + s, j * stations + t);
                            }
                        }
                    }
                    all[((line * stations + s) * across.len() + other_line) * width + t + band - s] = sum;
                }
            }
        }
    }
    all
}

impl WheelLines {
    /// R between a node and the stations of a line, from `station - residual_band` on.
    #[inline(always)]
    pub(super) fn residual(&self, line: usize, station: usize, other_line: usize) -> &[f64] {
        let width = row_width(self.residual_band);
        &self.residual[((line * self.stations + station) * self.nodes.len() + other_line) * width..][..width]
    }

    /// Stations farther apart than this see nothing of each other beside the modes.
    #[inline(always)]
    pub(super) fn residual_band(&self) -> usize {
        self.residual_band
    }

    /// R between two nodes.
    fn residual_at(&self, line: usize, station: usize, other_line: usize, other: usize) -> f64 {
        if station.abs_diff(other) > self.residual_band {
            return 0.0;
        }
        self.residual(line, station, other_line)[other + self.residual_band - station]
    }

    /// The influence of a node.
    #[inline(always)]
    pub(super) fn influence(&self, node: DeckNode) -> &[f64] {
        &self.nodes[node.line][node.station * self.influence_width..][..self.influence_width]
    }

    /// Stations along.
    pub(super) fn stations(&self) -> usize {
        self.stations
    }
}

/// Lines along the bridge with the influence of each of their stations.
pub(super) trait DeckLines {
    /// The influences of a line's stations, one after the other.
    fn influences(&self, line: usize) -> &[f64];
}

impl DeckLines for [WheelLine] {
    #[inline(always)]
    fn influences(&self, line: usize) -> &[f64] {
        &self[line].influence
    }
}

impl DeckLines for [Arc<[f64]>] {
    #[inline(always)]
    fn influences(&self, line: usize) -> &[f64] {
        &self[line]
    }
}

/// Influence of unit forces at the stations of the line `y_m`.
fn line_influence(operator: &BridgeOperator, y_m: f64) -> Vec<f64> {
    let stations = operator.track.stations();
    let [(left, w_left), (right, w_right)] = operator.track.across(y_m);
    (0..stations)
        .flat_map(|s| {
            let (a, b) = (
                operator.influence(left * stations + s),
                operator.influence(right * stations + s),
            );
            a.iter().zip(b).map(move |(a, b)| w_left * a + w_right * b)
        })
        .collect()
}

/// How many stations the vehicles span at most, both sides of a joint counted: of several all.
fn band(track: &Track, traffic: &Traffic) -> usize {
    match traffic.vehicles.as_slice() {
        [one] => vehicle_band(track, &one.vehicle),
        _ => track.stations() - 1,
    }
}

/// How many stations a vehicle spans at most.
fn vehicle_band(track: &Track, vehicle: &Vehicle) -> usize {
    let ends = vehicle
        .patches
        .iter()
        .map(|p| (p.ahead_m - 0.5 * p.length_m, p.ahead_m + 0.5 * p.length_m));
    let points = vehicle.points().map(|p| (p.ahead_m, p.ahead_m));
    let (rear, front) = ends
        .chain(points)
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), (a, b)| {
            (lo.min(a), hi.max(b))
        });
    let span = front - rear;
    let stations = (span / track.shortest_m()).ceil() as usize + 2;
    let joints = (span / track.shortest_module_m()).floor() as usize + 1;
    (stations + joints).min(track.stations() - 1)
}

/// Small flexibilities of a step at the deck's stations under what rides along.
#[derive(Debug)]
pub(crate) struct WheelCompliance {
    /// Stations farther apart are not kept.
    pub(super) band: usize,
    lines: usize,
    stations: usize,
    /// What the acceleration at one station sees of a force at another.
    among: Vec<f64>,
    /// Between nodes and connectors, for each line and station one number a connector.
    with_connectors: Vec<f64>,
    connectors: usize,
}

impl WheelCompliance {
    /// The flexibilities of a crossing's vehicles at a step length.
    pub(crate) fn new(operator: &BridgeOperator, constants: &StepConstants, wheels: &WheelLines) -> Self {
        let (m, nc) = (operator.sizes.modes, operator.sizes.connectors);
        let (lines, stations, band) = (wheels.nodes.len(), wheels.stations, wheels.band);
        let row = |node: usize| {
            wheels.influence(DeckNode {
                line: node / stations,
                station: node % stations,
            })
        };
        let c_b: DMatrix<f64> = DMatrix::from_fn(m, nc, |k, i| constants.c[k] * operator.b[(i, k)]);
        let mut compliance = Self {
            band,
            lines,
            stations,
            among: vec![0.0; lines * stations * lines * row_width(band)],
            with_connectors: Vec::with_capacity(lines * stations * nc),
            connectors: nc,
        };
        let mut c_phi = vec![0.0; m];
        for node in 0..lines * stations {
            let own = row(node);
            for (c_phi, (c, phi)) in c_phi.iter_mut().zip(constants.c.iter().zip(own)) {
                *c_phi = c * phi;
            }
            for i in 0..nc {
                let modal: f64 = own[..m]
                    .iter()
                    .zip(c_b.column(i).iter())
                    .map(|(phi, cb)| phi * cb)
                    .sum();
                compliance.with_connectors.push(modal + constants.rho * own[m + i]);
            }
            let station = node % stations;
            for line in 0..lines {
                for s in station.saturating_sub(band)..=(station + band).min(stations - 1) {
                    let other = row(line * stations + s);
                    let at = compliance.at(node / stations, station, line, s);
                    let modal: f64 = c_phi.iter().zip(other).map(|(a, b)| a * b).sum();
                    let residual = wheels.residual_at(node / stations, station, line, s);
                    compliance.among[at] = modal + constants.rho * residual;
                }
            }
        }
        compliance
    }

    #[inline(always)]
    fn at(&self, line: usize, station: usize, other_line: usize, other_station: usize) -> usize {
        ((line * self.stations + station) * self.lines + other_line) * row_width(self.band) + other_station + self.band
            - station
    }

    /// What the acceleration at a node sees of forces at the stations of a line, from `station - band` on.
    #[inline(always)]
    pub(super) fn row(&self, line: usize, station: usize, other_line: usize) -> &[f64] {
        let width = row_width(self.band);
        &self.among[((line * self.stations + station) * self.lines + other_line) * width..][..width]
    }

    /// What the acceleration at a node sees of the connectors, and they of a force there.
    #[inline(always)]
    pub(super) fn with_connectors(&self, line: usize, station: usize) -> &[f64] {
        &self.with_connectors[(line * self.stations + station) * self.connectors..][..self.connectors]
    }
}
