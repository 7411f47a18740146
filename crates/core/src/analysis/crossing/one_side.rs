//! Crossings that are their own mirror images, on one side of a bridge that is.
//!
//! Knows which crossings are, and how the bridge reads from its side. Does not know steps.

use super::mounts::Mounts;
use super::stepped::Stepped;
use super::{Crossing, CrossingSettings};
use crate::bridge::{BridgeDesign, is_own_image};
use crate::contact::{Dashpot, LinkLaw};
use crate::operator::{BridgeOperator, SideBridge, SideLinks, one_side};
use crate::response::{ForcePeaks, JointReading, Peak, Reading, RideReading};
use crate::road::Road;
use crate::traffic::{Driven, Traffic};
use crate::vehicle::{self, SideVehicle};
use std::sync::Arc;

/// One side of a bridge, made ready for crossings.
#[derive(Debug)]
pub(super) struct OneSide {
    pub(super) stepped: Stepped,
    pub(super) mounts: Mounts,
    pub(super) links: SideLinks,
}

/// What drives on one side of a bridge.
#[derive(Debug)]
pub(super) struct SideTraffic {
    pub(super) traffic: Traffic,
    /// Of each vehicle the wheels of the side that stand for those of the whole, and their shares.
    pub(super) wheels: Vec<Vec<(usize, f64)>>,
}

impl OneSide {
    /// The side of a bridge; none of one that is not its own mirror image.
    pub(super) fn of(design: &BridgeDesign, operator: &BridgeOperator, settings: &CrossingSettings) -> Option<Self> {
        if !is_own_image(design) {
            return None;
        }
        let links = SideLinks::new(design.modules - 1, &design.connectors.y_m)?;
        let SideBridge { operator, links } = one_side(operator, &links)?;
        Some(Self {
            stepped: Stepped::new(Arc::new(operator), settings),
            mounts: Mounts::default(),
            links,
        })
    }

    /// What drives on the side in a crossing; none where the crossing is not its own mirror image or starts from a dead state.
    pub(super) fn traffic(&self, traffic: &Traffic, crossing: &Crossing) -> Option<SideTraffic> {
        if crossing.dead.is_some() {
            return None;
        }
        if !crossing.own_laws.is_empty() {
            self.laws(crossing)?;
        }
        let (mut vehicles, mut wheels) = (Vec::new(), Vec::new());
        for driven in &traffic.vehicles {
            let SideVehicle { vehicle, of_patches } = vehicle::one_side(&driven.vehicle)?;
            let alike = |road: &Road| vehicle.patches.iter().all(|patch| road.is_alike_across(patch.y_m));
            if vehicle.springs.is_some() && !traffic.road.as_ref().is_none_or(|road| alike(road)) {
                return None;
            }
            wheels.push(of_patches);
            vehicles.push(Driven {
                vehicle: Arc::new(vehicle),
                ..driven.clone()
            });
        }
        let road = traffic.road.clone();
        Some(SideTraffic {
            traffic: Traffic { vehicles, road },
            wheels,
        })
    }

    /// The laws and the dashpots of its links; none where a link and its image have unlike ones.
    pub(super) fn laws(&self, crossing: &Crossing) -> Option<(Vec<LinkLaw>, Vec<Dashpot>)> {
        let laws = self.links.laws(&crossing.laws(self.links.count()))?;
        Some((laws, self.links.dashpots(&crossing.dashpots())?))
    }
}

/// The peaks of joints of the bridge from those of the side: of each joint the sum, then its connectors, of which the bridge has
/// so many a joint.
pub(super) fn peaks_of_bridge(links: &SideLinks, of_side: &[ForcePeaks], per_joint: usize) -> Vec<ForcePeaks> {
    let joints = links.count() / per_joint.max(1);
    let side_per_joint = of_side.len().checked_div(joints).unwrap_or(1);
    let of_joint = |(joint, peaks): (usize, &[ForcePeaks])| {
        let first = joint * (side_per_joint - 1);
        let connector = |i: usize| {
            let (link, share) = links.of(joint * per_joint + i);
            let of = |peak: Peak| Peak {
                value: share * peak.value,
                ..peak
            };
            let ForcePeaks { compression, tension } = peaks[1 + link - first];
            ForcePeaks {
                compression: of(compression),
                tension: of(tension),
            }
        };
        let sum = peaks[0];
        std::iter::once(sum)
            .chain((0..per_joint).map(connector))
            .collect::<Vec<_>>()
    };
    of_side
        .chunks_exact(side_per_joint)
        .enumerate()
        .flat_map(of_joint)
        .collect()
}

/// The bridge as it reads from one side, whose links are given, or from itself.
pub(super) struct BridgeReading<'a, R> {
    pub(super) of: R,
    pub(super) side: Option<&'a OneSide>,
    /// Of each vehicle the wheels of the side; none where the whole is read.
    pub(super) wheels: &'a [Vec<(usize, f64)>],
}

impl<R> BridgeReading<'_, R> {
    /// The link that stands for a connector, and its share of the force.
    fn link(&self, connector: usize) -> (usize, f64) {
        self.side.map_or((connector, 1.0), |side| side.links.of(connector))
    }
}

impl<R: JointReading> JointReading for BridgeReading<'_, R> {
    fn force_n(&self, connector: usize) -> f64 {
        let (link, share) = self.link(connector);
        share * self.of.force_n(link)
    }

    fn joint_n(&self, first: usize, count: usize) -> f64 {
        let Some(side) = self.side else {
            return self.of.joint_n(first, count);
        };
        let of_side = side.links.of_joint(first);
        self.of.joint_n(of_side.start, of_side.len())
    }

    fn connector_n(&self, connector: usize) -> [f64; 2] {
        let (link, share) = self.link(connector);
        self.of.connector_n(link).map(|force| share * force)
    }

    fn elongation_m(&self, connector: usize) -> f64 {
        self.of.elongation_m(self.link(connector).0)
    }

    fn pin_n(&self, pin: usize) -> [f64; 3] {
        self.of.pin_n(pin)
    }

    fn spring_m(&self, spring: usize) -> f64 {
        self.of.spring_m(spring)
    }
}

impl<R: Reading> Reading for BridgeReading<'_, R> {
    fn times_s(&self) -> [f64; 2] {
        self.of.times_s()
    }

    fn position_m(&self, index: usize) -> f64 {
        self.of.position_m(index)
    }

    fn place_m(&self, index: usize) -> f64 {
        self.of.place_m(index)
    }

    fn corner_m(&self, index: usize) -> f64 {
        self.of.corner_m(index)
    }

    fn ride(&self, vehicle: usize) -> Option<RideReading<'_>> {
        let ride = self.of.ride(vehicle)?;
        Some(RideReading {
            of_side: self.wheels.get(vehicle).map(Vec::as_slice),
            ..ride
        })
    }

    fn is_on(&self, vehicle: usize, wheel: usize) -> bool {
        let of_side = self.wheels.get(vehicle).map_or(wheel, |wheels| wheels[wheel].0);
        self.of.is_on(vehicle, of_side)
    }
}
