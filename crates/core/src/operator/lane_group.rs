//! Lanes whose vehicles are at the same places, so that what hangs on places alone is done once for all of them.
//!
//! Knows which lanes go together, where their vehicles are and what they weigh. Does not know what forces do to the deck.
//!
//! What a lane computes is the same to the last bit whichever lanes go with it: all of them run through the same operations.

use super::lane::Lane;
use super::panel::{MOST_LANES, lanes};
use super::vector::Ops;
use super::wheel_lines::{VehicleLines, WheelLine};
use crate::bridge::{Track, VehiclePlacement};
use crate::scheme::Arithmetic;
use pulp::Simd;

/// A force on a station of a line of the weights for a unit load of a vehicle.
#[derive(Debug, Clone, Copy)]
pub(super) struct UnitForce {
    pub line: usize,
    pub station: usize,
    pub vehicle: usize,
    pub share: f64,
}

/// What of a unit load of a vehicle lies on the bridge by an axle, and whether the contact force of all its points has settled.
#[derive(Debug, Clone, Copy)]
pub(super) struct UnitAxle {
    pub vehicle: usize,
    pub share: f64,
    pub is_settled: bool,
}

/// Lanes that go together, the first of which stands for them. Lanes count from `base` on: 0, or a lane that is alone.
#[derive(Debug, Default)]
pub(super) struct LaneGroup {
    pub(super) base: usize,
    pub(super) lanes: Vec<usize>,
    /// Whether nothing rides along.
    pub(super) is_still: bool,
    inside: [f64; MOST_LANES],
    /// Weight of each vehicle in each lane `[N]`; 0 in lanes of other groups.
    loads_n: Vec<[f64; MOST_LANES]>,
    pub(super) placements: Vec<VehiclePlacement>,
    /// Weights on stations, and on axles.
    pub(super) weights: Vec<UnitForce>,
    pub(super) axles: Vec<UnitAxle>,
}

impl LaneGroup {
    /// Begins with a lane.
    fn begin(&mut self, lane: usize) {
        self.clear();
        self.add(lane);
    }

    fn clear(&mut self) {
        self.lanes.clear();
        self.base = 0;
        self.inside = [0.0; MOST_LANES];
        self.loads_n.clear();
        self.weights.clear();
        self.axles.clear();
    }

    fn add(&mut self, lane: usize) {
        self.lanes.push(lane);
        self.inside[lane] = 1.0;
    }

    /// Counts the only lane from itself on.
    fn stand_alone(&mut self) {
        self.base = self.lanes[0];
        self.lanes[0] = 0;
        self.inside = [0.0; MOST_LANES];
        self.inside[0] = 1.0;
        for loads in &mut self.loads_n {
            loads[0] = loads[self.base];
        }
    }

    /// The lane, where it is alone.
    #[inline(always)]
    pub(super) fn alone(&self) -> Option<usize> {
        (self.lanes.len() == 1).then_some(self.base)
    }

    /// Numbers of its lanes among all.
    #[inline(always)]
    pub(super) fn numbers(&self) -> impl Iterator<Item = usize> {
        self.lanes.iter().map(|lane| self.base + lane)
    }

    /// The lane that stands for all.
    #[inline(always)]
    pub(super) fn first(&self) -> usize {
        self.lanes[0]
    }

    /// Which lanes it has.
    #[inline(always)]
    pub(super) fn mask<S: Simd>(&self, o: Ops<S>) -> S::m64s {
        o.0.greater_than_f64s(lanes::<S>(&self.inside)[0], o.splat(0.0))
    }

    /// Weight of a vehicle in each lane `[N]`.
    #[inline(always)]
    pub(super) fn load_n<S: Simd>(&self, vehicle: usize) -> S::f64s {
        lanes::<S>(&self.loads_n[vehicle])[0]
    }

    /// Weight of a vehicle in a lane `[N]`, by its number among all.
    #[inline(always)]
    pub(super) fn load_in(&self, vehicle: usize, number: usize) -> f64 {
        self.loads_n[vehicle][number - self.base]
    }

    /// Puts the vehicles and their weights where they are (V1).
    #[inline(always)]
    fn place(&mut self, each: &[Lane], track: &Track) {
        let first = self.first();
        let Some(crossing) = &each[first].crossing else { return };
        let vehicles = &crossing.traffic.vehicles;
        for vehicle in 0..vehicles.len() {
            let mut loads = [0.0; MOST_LANES];
            for &lane in &self.lanes {
                loads[lane] = each[lane]
                    .crossing
                    .as_ref()
                    .map_or(0.0, |of| of.traffic.vehicles[vehicle].load_n);
            }
            self.loads_n.push(loads);
        }
        self.placements.resize_with(vehicles.len(), VehiclePlacement::default);
        let lines = crossing.wheels.vehicles.iter();
        for (number, ((driven, of), placement)) in vehicles.iter().zip(lines).zip(&mut self.placements).enumerate() {
            placement.place(track, &driven.vehicle, each[first].headings[number]);
            let axle = UnitAxle {
                vehicle: number,
                share: 0.0,
                is_settled: true,
            };
            self.axles.extend(std::iter::repeat_n(axle, driven.vehicle.axles));
            if driven.vehicle.springs.is_some() {
                settle_axles(of, placement, &mut self.axles);
            }
        }
        for (line, of) in crossing.wheels.weights.iter().enumerate() {
            let placement = &self.placements[of.vehicle];
            place_weights((line, of), placement, &mut self.axles, &mut self.weights);
        }
        let is_asleep = each[first].rides.iter().all(|ride| !ride.is_awake());
        self.is_still = is_asleep && (self.weights.is_empty() || crossing.wheels.nodes.is_empty());
    }
}

/// The groups of a step.
#[derive(Debug, Default)]
pub(super) struct LaneGroups {
    /// Groups with room for more; those of the step come first.
    groups: Vec<LaneGroup>,
    count: usize,
    /// All lanes in which nothing rides along, wherever their vehicles are.
    still: LaneGroup,
}

impl LaneGroups {
    /// Puts the lanes that are at work into groups, and their vehicles where they are; lanes that go together have the same nodes.
    #[inline(always)]
    pub(super) fn form(&mut self, each: &mut [Lane], same_nodes: impl Fn(usize, usize) -> bool, track: &Track) {
        self.count = 0;
        for lane in 0..each.len() {
            if !each[lane].head(track) {
                continue;
            }
            let own = &each[lane];
            let fits = |group: &LaneGroup| same_nodes(lane, group.first()) && own.goes_with(&each[group.first()]);
            let known = self.groups[..self.count].iter_mut().enumerate();
            let number = match known.into_iter().find(|(_, group)| fits(group)) {
                Some((number, group)) => {
                    group.add(lane);
                    number
                }
                None => {
                    if self.groups.len() == self.count {
                        self.groups.push(LaneGroup::default());
                    }
                    self.groups[self.count].begin(lane);
                    self.count += 1;
                    self.count - 1
                }
            };
            each[lane].group = number;
        }
        self.still.clear();
        self.still.is_still = true;
        for group in &mut self.groups[..self.count] {
            group.place(each, track);
            if group.is_still {
                group.lanes.iter().for_each(|&lane| self.still.add(lane));
            }
            if group.lanes.len() == 1 {
                group.stand_alone();
            }
        }
        if self.still.lanes.len() == 1 {
            self.still.stand_alone();
        }
    }

    /// Those that are settled one after the other: groups in which something rides along, then all other lanes.
    #[inline(always)]
    pub(super) fn settled(&self) -> impl Iterator<Item = &LaneGroup> {
        let riding = self.groups[..self.count].iter().filter(|group| !group.is_still);
        riding.chain((!self.still.lanes.is_empty()).then_some(&self.still))
    }

    /// Those of the step.
    #[inline(always)]
    pub(super) fn all(&self) -> &[LaneGroup] {
        &self.groups[..self.count]
    }

    /// Where the vehicles of a lane are.
    pub(super) fn placement(&self, group: usize, vehicle: usize) -> &VehiclePlacement {
        &self.groups[group].placements[vehicle]
    }
}

/// Whether the contact forces of the axles of a vehicle on springs have settled.
#[inline(always)]
fn settle_axles(of: &VehicleLines, placement: &VehiclePlacement, axles: &mut [UnitAxle]) {
    for patch in &of.vehicle.patches {
        axles[of.first_axle + patch.axle].is_settled &= placement.tells(patch);
    }
}

/// Unit loads of a line's points on its stations, and on axles.
#[inline(always)]
fn place_weights(
    (line, of): (usize, &WheelLine),
    placement: &VehiclePlacement,
    axles: &mut [UnitAxle],
    weights: &mut Vec<UnitForce>,
) {
    let own = weights.len();
    for point in &of.points {
        let axle = &mut axles[point.axle];
        axle.is_settled &= placement.is_settled(point.along);
        let Some(cell) = placement.cell(point.along) else {
            continue;
        };
        axle.share += point.share * of.lines.len() as f64;
        for (station, part) in cell.shares() {
            match weights[own..].iter_mut().rev().find(|force| force.station == station) {
                Some(force) => force.share += point.share * part,
                None => weights.push(UnitForce {
                    line,
                    station,
                    vehicle: of.vehicle,
                    share: point.share * part,
                }),
            }
        }
    }
}
