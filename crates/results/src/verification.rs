//! What came of jobs that the reference solver solved again.
//!
//! Knows deviations as records have them. Does not know how they are found.

use super::record::JobRecord;
use serde::Serialize;

/// What came of the jobs that were solved again.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Verification {
    /// Jobs solved again.
    pub jobs: usize,
    /// Those beyond a tolerance, or without an answer of the reference solver.
    pub beyond: usize,
    /// Largest deviation of a deflection, as a share of the reference solver's.
    pub worst_deflection: f64,
    /// Largest deviation of a compression, as a share of the job's largest joint force.
    pub worst_compression: f64,
    /// Largest deviation of a tension, as a share of the job's largest joint force.
    pub worst_tension: f64,
}

impl Verification {
    /// Takes the next records.
    pub fn take(&mut self, records: &[JobRecord]) {
        for summary in records.iter().map(|record| &record.summary) {
            let Some(held) = summary.verify_held else { continue };
            self.jobs += 1;
            self.beyond += usize::from(!held);
            let worst = |worst: &mut f64, found: Option<f64>| *worst = worst.max(found.unwrap_or_default().abs());
            worst(&mut self.worst_deflection, summary.verify_deflection);
            worst(&mut self.worst_compression, summary.verify_compression);
            worst(&mut self.worst_tension, summary.verify_tension);
        }
    }
}
