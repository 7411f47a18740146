//! What a job is known by from run to run.
//!
//! Knows all that a job's record depends on beside the program. Does not know its number: a study may grow.

use super::{Job, Task};
use pontoon_core::connector::ConnectorLaw;

/// What a job is known by from run to run: equal for jobs whose numbers are equal.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct JobKey(pub [u8; 16]);

impl JobKey {
    /// The key of what was hashed.
    fn of(hasher: &blake3::Hasher) -> Self {
        let mut key = [0; 16];
        key.copy_from_slice(&hasher.finalize().as_bytes()[..16]);
        Self(key)
    }
}

impl std::fmt::Display for JobKey {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.0.iter().try_for_each(|byte| write!(f, "{byte:02x}"))
    }
}

/// Equal for equal laws of single connectors; none where no connector has one of its own.
pub(super) fn laws_key(laws: &[(usize, ConnectorLaw)]) -> Option<[u8; 32]> {
    if laws.is_empty() {
        return None;
    }
    let mut hasher = blake3::Hasher::new();
    let mut number = |x: f64| {
        hasher.update(&(x + 0.0).to_bits().to_le_bytes());
    };
    for (place, law) in laws {
        number(*place as f64);
        // a law without dashpots is known as it was before there were any
        let dampings_n_s_m = law.dampings_n_s_m();
        if dampings_n_s_m != [0.0; 2] {
            number(-1.0);
            dampings_n_s_m.into_iter().for_each(&mut number);
        }
        match law {
            ConnectorLaw::Linear { stiffness_n_m, .. } => number(*stiffness_n_m),
            ConnectorLaw::Gaps { tension, compression } => {
                for truss in [tension, compression] {
                    let (stop_gap_m, stop_n_m) = truss.stop.map_or((-1.0, 0.0), |s| (s.gap_m, s.stiffness_n_m));
                    [truss.stiffness_n_m, truss.gap_m, stop_gap_m, stop_n_m]
                        .into_iter()
                        .for_each(&mut number);
                }
            }
        }
    }
    Some(*hasher.finalize().as_bytes())
}

/// Equal for jobs that leave the same record, in whatever study and at whatever number they stand.
pub(super) fn key_of(job: &Job) -> JobKey {
    let mut hasher = blake3::Hasher::new();
    for text in [
        &*job.shared.bridge.structure_key,
        &*job.shared.vehicle.key,
        &*job.shared.analysis.key,
    ] {
        hasher.update(&(text.len() as u64).to_le_bytes());
        hasher.update(text.as_bytes());
    }
    // a single vehicle on a level road is known as it was before there were others
    if let Some(traffic) = &job.traffic {
        hasher.update(b"traffic");
        hasher.update(&traffic.key);
    }
    let mut number = |x: f64| {
        // zero has one sign
        hasher.update(&(x + 0.0).to_bits().to_le_bytes());
    };
    match job.gaps_m() {
        None => number(-1.0),
        Some((tension, compression)) => {
            number(tension);
            number(compression);
        }
    }
    if let Some(laws) = job.laws_key() {
        hasher.update(&laws);
    }
    // a river that has not risen is known as it was before any could
    let level_m = job.shared.bridge.design.risen_m();
    if level_m != 0.0 {
        hasher.update(b"water level");
        hasher.update(&level_m.to_bits().to_le_bytes());
    }
    // a crossing without limits is known as it was before there were any
    for of in &*job.shared.limits {
        hasher.update(of.limit.word().as_bytes());
        hasher.update(&of.allowed.to_bits().to_le_bytes());
        hasher.update(&of.beside.to_bits().to_le_bytes());
    }
    if let Some(rating) = &job.rating {
        hasher.update(rating.search.as_bytes());
    }
    let mut number = |x: f64| {
        hasher.update(&(x + 0.0).to_bits().to_le_bytes());
    };
    number(job.load_n);
    let (kind, of_kind) = match job.task {
        Task::Crossing { speed_m_s } => (0.0, speed_m_s),
        Task::Static(load) => (1.0, load.x_m),
        Task::Modes => (2.0, 0.0),
    };
    number(kind);
    number(of_kind);
    // whether a job is solved again is told by its number
    let verified = job.as_crossing().and_then(|crossing| crossing.verify()).is_some();
    number(if verified { 1.0 } else { 0.0 });
    JobKey::of(&hasher)
}
