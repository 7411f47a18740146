//! What a job is known by from run to run.
//!
//! Knows all that a job's record depends on beside the program. Does not know its number: a study may grow.

use super::{Job, Task};

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

/// Equal for jobs that leave the same record, in whatever study and at whatever number they stand.
pub(super) fn key_of(job: &Job) -> JobKey {
    let mut hasher = blake3::Hasher::new();
    for text in [&*job.bridge.structure_key, &*job.vehicle.key, &*job.analysis.key] {
        hasher.update(&(text.len() as u64).to_le_bytes());
        hasher.update(text.as_bytes());
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
