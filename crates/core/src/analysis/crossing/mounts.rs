//! Vehicles on the deck of an operator, made ready once for the crossings of a solver.
//!
//! Knows which traffics see the deck alike. Does not know crossings.

use super::stepped::Stepped;
use crate::operator::{WheelCompliance, WheelLines};
use crate::riding::RidingStep;
use crate::traffic::{Driven, Traffic};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// Vehicles that are kept ready at once.
const VEHICLES_KEPT: usize = 8;

/// Vehicles on the deck, with their small flexibilities and springs at each step length asked for.
#[derive(Debug)]
pub(super) struct Mount {
    traffic: Arc<Traffic>,
    pub(super) wheels: Arc<WheelLines>,
    steps: Vec<OnceLock<MountedStep>>,
}

/// What a step length makes of vehicles on the deck.
#[derive(Debug, Clone)]
pub(super) struct MountedStep {
    pub(super) compliance: Arc<WheelCompliance>,
    pub(super) riding: Arc<[Option<Arc<RidingStep>>]>,
}

impl Mount {
    /// Whether the vehicles of another traffic see the deck as these do, whatever they weigh and however fast they are.
    pub(super) fn fits(&self, traffic: &Traffic) -> bool {
        let alike = |(a, b): (&Driven, &Driven)| a.vehicle == b.vehicle && a.drive.backward == b.drive.backward;
        let (own, other) = (&self.traffic.vehicles, &traffic.vehicles);
        own.len() == other.len() && own.iter().zip(other).all(alike)
    }

    /// What a step length makes of them.
    pub(super) fn step(&self, on: &Stepped, halvings: usize) -> MountedStep {
        let of_step = self.steps[halvings].get_or_init(|| {
            let level = on.constants(halvings);
            let of = |driven: &Driven| Some(Arc::new(level.riding(driven.vehicle.springs.as_ref()?)));
            MountedStep {
                compliance: Arc::new(WheelCompliance::new(on.operator(), level, &self.wheels)),
                riding: self.traffic.vehicles.iter().map(of).collect(),
            }
        });
        of_step.clone()
    }
}

/// The vehicles that were asked for last, for all threads.
#[derive(Debug, Default)]
pub(super) struct Mounts(Mutex<Vec<Arc<Mount>>>);

impl Mounts {
    /// The vehicles of a traffic.
    pub(super) fn of(&self, on: &Stepped, traffic: &Traffic) -> Arc<Mount> {
        let find = |kept: &[Arc<Mount>]| kept.iter().find(|mount| mount.fits(traffic)).cloned();
        let kept = || self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = find(&kept()) {
            return known;
        }
        // other threads need not wait for this one
        let mount = Arc::new(Mount {
            traffic: Arc::new(traffic.clone()),
            wheels: Arc::new(WheelLines::new(on.operator(), traffic)),
            steps: (0..on.levels()).map(|_| OnceLock::new()).collect(),
        });
        let mut kept = kept();
        if let Some(known) = find(&kept) {
            return known;
        }
        // crossings hold what they need, so that any other may go
        if kept.len() == VEHICLES_KEPT {
            kept.remove(0);
        }
        kept.push(Arc::clone(&mount));
        mount
    }
}
