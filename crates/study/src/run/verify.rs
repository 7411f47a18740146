//! The reference solver as judge of the operator, on a share of the jobs.
//!
//! Knows which jobs are solved again and what a deviation is. Does not know tables.

use super::shared_models::SharedModels;
use super::{crossing, guard};
use pontoon_core::connector::Connection;
use pontoon_core::response::Record;
use pontoon_plan::job::Job;
use pontoon_results::{JobRecord, Summary};

/// Solves a job again by the reference solver, where that is asked for, and notes how far the operator is off.
pub(super) fn judge(job: &Job, record: &mut JobRecord, models: &SharedModels) {
    let asked = job
        .as_crossing()
        .and_then(|crossing| Some((crossing, crossing.verify()?)));
    let Some((crossing_job, verify)) = asked.filter(|_| record.failure.is_none()) else {
        return;
    };
    let again = guard::guarded(|| crossing::solve(&crossing_job, Record::default(), models));
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
    let contact = record
        .summary
        .min_contact_force_n
        .zip(again.summary.min_contact_force_n);
    let contact = contact.map(|(n, n_ref)| (n - n_ref) / job.load_n);
    let share = |difference: f64, scale: f64| if difference == 0.0 { 0.0 } else { difference / scale };
    let largest_n = c_ref.max(t_ref);
    let deflection = share(w - w_ref, w_ref);
    let (compression, tension) = (share(c - c_ref, largest_n), share(t - t_ref, largest_n));
    let held = deflection.abs() <= verify.deflection_tolerance
        && compression.abs() <= verify.compression_tolerance
        && tension.abs() <= verify.tension_tolerance
        // with gaps, impacts make the contact force depend on the solver as on the step
        && (job.connection != Connection::Linear || contact.is_none_or(|c| c.abs() <= verify.compression_tolerance));
    let finite = |x: f64| x.is_finite().then_some(x);
    record.summary.verify_deflection = finite(deflection);
    record.summary.verify_compression = finite(compression);
    record.summary.verify_tension = finite(tension);
    record.summary.verify_contact = contact.and_then(finite);
    record.summary.verify_held = Some(held);
}
