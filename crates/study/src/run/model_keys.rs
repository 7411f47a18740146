//! Keys of what jobs share, made of the jobs' own numbers.
//!
//! Knows which numbers a module, a bridge, its damping, its operator, its dead state and its solvers depend on. Does not know how any
//! of them is made.

use super::cache::Cache;
use pontoon_core::bridge::Model;
use pontoon_core::operator::Followed;
use pontoon_journal::PreparationKey;
use pontoon_plan::job::{CrossingJob, Job};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::sync::Arc;

pub(super) type ModuleKey = (Model, Arc<str>);
pub(super) type BridgeKey = (Model, Arc<str>);
pub(super) type DampingKey = (BridgeKey, u64, [Option<[u64; 2]>; 2]);
pub(super) type CrossingKey = (DampingKey, [u64; 2], [usize; 2]);
/// Crossings of one key are solved side by side.
pub(super) type LaneBatchKey = (CrossingKey, OperatorKey, Option<u64>);
pub(super) type CreepingKey = (DeadKey, Arc<str>, u64);
/// What a dead state depends on: a bridge, its connectors' gaps and own laws, and the river.
pub(super) type DeadKey = (BridgeKey, Option<(u64, u64)>, Option<[u8; 32]>, u64);

/// What an operator depends on: a bridge, and how far its flexibility may be off.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct OperatorKey {
    pub(super) bridge: BridgeKey,
    tolerance: u64,
    pins: bool,
    /// Places that are followed, by their bits.
    places: Vec<u64>,
}

impl OperatorKey {
    /// What its file in the cache is named by.
    pub(super) fn name(&self) -> String {
        let (model, structure) = &self.bridge;
        let mut name = format!("{} {structure} {:016x}", word(*model), self.tolerance);
        if self.pins {
            name.push_str(" pins");
        }
        for place in &self.places {
            let _ = write!(name, " {place:016x}");
        }
        Cache::name(&name)
    }

    /// What it follows.
    pub(super) fn followed(&self) -> Followed {
        Followed {
            pins: self.pins,
            places_x_m: self.places.iter().copied().map(f64::from_bits).collect(),
        }
    }
}

pub(super) fn model(job: &Job) -> Model {
    job.model().into()
}

/// A model's word in tables and keys.
pub(super) const fn word(model: Model) -> &'static str {
    match model {
        Model::Full => "full",
        Model::SuperElement => "super-element",
    }
}

/// Jobs by the bridge whose preparation they share; bridges of the same module stand side by side.
pub(super) fn by_bridge<'j>(jobs: impl Iterator<Item = &'j Job>) -> Vec<(PreparationKey, Vec<&'j Job>)> {
    let mut bridges: BTreeMap<(Vec<ModuleKey>, BridgeKey), Vec<&Job>> = BTreeMap::new();
    for job in jobs {
        let key = (module_keys(job), bridge_key(job));
        bridges.entry(key).or_default().push(job);
    }
    let keyed = bridges
        .into_iter()
        .map(|((_, key), jobs)| (preparation_key(&key), jobs));
    keyed.collect()
}

/// What the preparation of a job's bridge is found by in the journal.
pub(crate) fn preparation_key_of(job: &Job) -> PreparationKey {
    preparation_key(&bridge_key(job))
}

pub(super) fn preparation_key((model, structure): &BridgeKey) -> PreparationKey {
    let hash = blake3::hash(format!("{} {structure}", word(*model)).as_bytes());
    let mut key = [0; 16];
    key.copy_from_slice(&hash.as_bytes()[..16]);
    PreparationKey(key)
}

/// The keys of a job's modules, in the order of its bridge's variants.
pub(super) fn module_keys(job: &Job) -> Vec<ModuleKey> {
    let keys = job.shared.bridge.module_keys.iter();
    keys.map(|key| (model(job), key.clone())).collect()
}

pub(super) fn bridge_key(job: &Job) -> BridgeKey {
    (model(job), job.shared.bridge.structure_key.clone())
}

pub(super) fn damping_key(crossing: &CrossingJob<'_>) -> DampingKey {
    let damping = crossing.analysis.damping;
    (
        bridge_key(crossing.job),
        damping.rayleigh_ratio().to_bits(),
        [damping.frequencies_hz, damping.structure.map(|of| [of.ratio, of.at_hz])]
            .map(|pair| pair.map(|x| x.map(f64::to_bits))),
    )
}

pub(super) fn crossing_key(crossing: &CrossingJob<'_>) -> CrossingKey {
    let analysis = crossing.analysis;
    let scheme = [crossing.first_time_step_s(), analysis.spectral_radius].map(f64::to_bits);
    let limits = [analysis.newton_limit, analysis.bisection_limit];
    (damping_key(crossing), scheme, limits)
}

pub(super) fn operator_key(crossing: &CrossingJob<'_>) -> Option<OperatorKey> {
    let job = crossing.job;
    let record = job.shared.record.of_bridge(&job.shared.bridge.design);
    Some(OperatorKey {
        bridge: bridge_key(crossing.job),
        tolerance: crossing.operator_tolerance()?.to_bits(),
        pins: record.needs_pins(),
        places: record.places_x_m.into_iter().map(f64::to_bits).collect(),
    })
}

pub(super) fn creeping_key(job: &Job) -> CreepingKey {
    (dead_key(job), job.shared.vehicle.key.clone(), job.load_n.to_bits())
}

pub(super) fn dead_key(job: &Job) -> DeadKey {
    let gaps = job
        .gaps_m()
        .map(|(tension, compression)| (tension.to_bits(), compression.to_bits()));
    let level = job.shared.bridge.design.risen_m();
    (bridge_key(job), gaps, job.laws_at_rest_key(), level.to_bits())
}
