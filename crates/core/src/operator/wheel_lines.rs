//! What a vehicle sees of the deck: its points on lines along the bridge, and what a force there does.
//!
//! Knows one vehicle on one operator. Does not know loads, speeds or steps but for the flexibilities that it is asked for.

use super::basis::BridgeOperator;
use super::step_constants::StepConstants;
use crate::bridge::Track;
use crate::vehicle::{Inertia, Vehicle};
use nalgebra::DMatrix;

/// A wheel point on its line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct LinePoint {
    /// Number of its place along the vehicle.
    pub along: usize,
    /// Share of the vehicle's weight.
    pub share: f64,
    /// Its axle.
    pub axle: usize,
}

/// Wheel points on one line along the bridge, or on several that carry the same.
#[derive(Debug)]
pub(super) struct WheelLine {
    /// Lines of the masses that carry these points.
    pub lines: Vec<usize>,
    /// Points in the order of x.
    pub points: Vec<LinePoint>,
    /// For each station the influence of a unit force there: `phi`, `R_BL`, `R_VL`, edges inside modules.
    pub influence: Vec<f64>,
}

/// A node of the deck under the vehicle: line of [`WheelLines`] and station.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct DeckNode {
    pub line: usize,
    pub station: usize,
}

/// A vehicle on an operator's deck.
#[derive(Debug)]
pub(crate) struct WheelLines {
    pub(super) vehicle: Vehicle,
    /// Lines for the weights, those that carry the same taken together.
    pub(super) weights: Vec<WheelLine>,
    /// Lines for the masses, one a place across; none where the mass stays out.
    pub(super) masses: Vec<WheelLine>,
    /// Line of `masses` of each point of each patch.
    pub(super) point_lines: Vec<Vec<usize>>,
    /// What the modes leave out between nodes of the masses' lines: for each node every line from `station - band` on.
    residual: Vec<f64>,
    /// Columns of an influence.
    pub(super) influence_width: usize,
    /// Stations farther apart than this never carry the vehicle at once.
    pub(super) band: usize,
    stations: usize,
}

impl WheelLines {
    /// A vehicle on the deck of an operator, which drives toward x = 0 or away from there.
    pub(crate) fn new(operator: &BridgeOperator, vehicle: &Vehicle, backward: bool) -> Self {
        let track = &operator.track;
        let mut lines: Vec<(f64, Vec<LinePoint>)> = Vec::new();
        let mut point_lines = Vec::new();
        for patch in &vehicle.patches {
            let mut own = Vec::new();
            for p in &patch.points {
                let line = lines.iter().position(|(y, _)| *y == p.y_m).unwrap_or_else(|| {
                    lines.push((p.y_m, Vec::new()));
                    lines.len() - 1
                });
                lines[line].1.push(LinePoint {
                    along: p.along,
                    share: p.share,
                    axle: patch.axle,
                });
                own.push(line);
            }
            point_lines.push(own);
        }
        for (_, points) in &mut lines {
            points.sort_by(|a, b| vehicle.along_m[a.along].total_cmp(&vehicle.along_m[b.along]));
            if backward {
                points.reverse();
            }
        }
        let mut weights: Vec<WheelLine> = Vec::new();
        let mut masses = Vec::new();
        for (number, (y, points)) in lines.iter().enumerate() {
            let influence = line_influence(operator, *y);
            match weights.iter_mut().find(|w| w.points == *points) {
                Some(same) => {
                    same.lines.push(number);
                    same.influence.iter_mut().zip(&influence).for_each(|(a, b)| *a += b);
                }
                None => weights.push(WheelLine {
                    lines: vec![number],
                    points: points.clone(),
                    influence: influence.clone(),
                }),
            }
            if vehicle.inertia != Inertia::None {
                masses.push(WheelLine {
                    lines: vec![number],
                    points: points.clone(),
                    influence,
                });
            }
        }
        let band = band(track, vehicle);
        let across: Vec<_> = lines.iter().map(|(y, _)| track.across(*y)).collect();
        let residual = if masses.is_empty() {
            Vec::new()
        } else {
            residual(operator, &across, band)
        };
        Self {
            band,
            residual,
            vehicle: vehicle.clone(),
            weights,
            masses,
            point_lines,
            influence_width: operator.sizes.influence(),
            stations: track.stations(),
        }
    }

    /// The most nodes of the deck under the masses at once.
    pub(crate) fn most_nodes(&self) -> usize {
        self.masses.len() * (self.band + 1)
    }

    /// No fewer nodes than a vehicle takes that is not on the deck yet.
    pub(crate) fn most_nodes_of(operator: &BridgeOperator, vehicle: &Vehicle) -> usize {
        let mut lines: Vec<f64> = vehicle.points().map(|p| p.y_m).collect();
        lines.sort_by(f64::total_cmp);
        lines.dedup();
        match vehicle.inertia {
            Inertia::None => 0,
            _ => lines.len() * (band(&operator.track, vehicle) + 1),
        }
    }
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
    /// R between a node and the stations of a line, from `station - band` on.
    #[inline(always)]
    pub(super) fn residual(&self, line: usize, station: usize, other_line: usize) -> &[f64] {
        let width = row_width(self.band);
        &self.residual[((line * self.stations + station) * self.masses.len() + other_line) * width..][..width]
    }

    /// Stations along.
    pub(super) fn stations(&self) -> usize {
        self.stations
    }
}

impl WheelLine {
    /// The influence of a station.
    #[inline(always)]
    pub(super) fn influence(&self, station: usize, width: usize) -> &[f64] {
        &self.influence[station * width..][..width]
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

/// How many stations the vehicle spans at most, both sides of a joint counted.
fn band(track: &Track, vehicle: &Vehicle) -> usize {
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

/// Small flexibilities of a step at the deck's stations under the masses of one vehicle.
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
    /// The flexibilities of a vehicle at a step length.
    pub(crate) fn new(operator: &BridgeOperator, constants: &StepConstants, wheels: &WheelLines) -> Self {
        let (m, nc) = (operator.sizes.modes, operator.sizes.connectors);
        let (lines, stations, band) = (wheels.masses.len(), wheels.stations, wheels.band);
        let row = |node: usize| wheels.masses[node / stations].influence(node % stations, wheels.influence_width);
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
                    compliance.among[at] = modal + constants.rho * wheels.residual[at];
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
