//! The reference solver as judge of the operator, on a share of the jobs.
//!
//! Knows which jobs are solved again and what a deviation is. Does not know tables.

use super::bench::Bench;
use super::record::{JobRecord, Summary};
use super::{crossing, guard};
use crate::plan::Job;
use pontoon_core::response::Record;
use serde::Serialize;

/// What came of the jobs that were solved again.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Verification {
    /// Jobs solved again.
    pub jobs: usize,
    /// Those beyond a tolerance, or without an answer of the reference solver.
    pub beyond: usize,
    /// Largest deviations: of deflections as a share of the reference solver's, of compression and tension as a share of the
    /// job's largest joint force.
    pub worst_deflection: f64,
    /// See `worst_deflection`.
    pub worst_compression: f64,
    /// See `worst_deflection`.
    pub worst_tension: f64,
}

/// Solves a job again by the reference solver, where that is asked for, and notes how far the operator is off.
pub(super) fn judge(job: &Job, record: &mut JobRecord, bench: &Bench) {
    let (Some(verify), None) = (job.verify(), &record.reason) else {
        return;
    };
    let again = guard::guarded(|| crossing::solve(job, Record::default(), bench));
    let of = |summary: &Summary| {
        let all = [
            summary.peak_deflection_m,
            summary.peak_compression_n,
            summary.peak_tension_n,
        ];
        all.map(Option::unwrap_or_default)
    };
    let Ok(again) = again else {
        record.summary.verify_held = Some(false);
        return;
    };
    let ([w, c, t], [w_ref, c_ref, t_ref]) = (of(&record.summary), of(&again.summary));
    let share = |difference: f64, scale: f64| if difference == 0.0 { 0.0 } else { difference / scale };
    let largest_n = c_ref.max(t_ref);
    let deflection = share(w - w_ref, w_ref);
    let (compression, tension) = (share(c - c_ref, largest_n), share(t - t_ref, largest_n));
    let held = deflection.abs() <= verify.deflection_tolerance
        && compression.abs() <= verify.compression_tolerance
        && tension.abs() <= verify.tension_tolerance;
    let finite = |x: f64| x.is_finite().then_some(x);
    record.summary.verify_deflection = finite(deflection);
    record.summary.verify_compression = finite(compression);
    record.summary.verify_tension = finite(tension);
    record.summary.verify_held = Some(held);
}

impl Verification {
    /// Takes the next records.
    pub(super) fn take(&mut self, records: &[JobRecord]) {
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
