//! What a study will take, and what of it is done.
//!
//! Knows the journal of a folder of results from outside, and tries a few jobs to learn what one costs here. Writes nothing.

use super::fingerprint::binding;
use super::{SweepError, results_folder};
use crate::run::{Cache, Measured, measure, record_key};
use pontoon_journal::JournalIndex;
use pontoon_plan::job::{Plan, Share};
use pontoon_plan::study_file::Study;
use serde::Serialize;
use std::path::Path;
use std::time::{Duration, Instant};

/// What a study will take.
#[derive(Debug, Clone, Serialize)]
pub struct Forecast {
    /// What would run.
    #[serde(flatten)]
    pub plan: Plan,
    /// What a folder of results holds of it; null where it has no journal.
    pub found: Option<RecordedJobs>,
    /// Time that the jobs not recorded will take `[s]`; null where the few that were tried failed or are too long to try, and
    /// where trying them was given up.
    pub expected_seconds: Option<f64>,
    /// Jobs that were tried for it.
    pub tried: usize,
    /// Whether trying jobs was given up after ten seconds.
    pub time_not_probed: bool,
    /// Threads that it reckons with.
    pub threads: usize,
}

/// What a folder of results holds of a study.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize)]
pub struct RecordedJobs {
    /// Jobs of the study that are recorded, failed ones included.
    pub done: usize,
    /// Failed.
    pub failed: usize,
    /// Not recorded.
    pub missing: usize,
    /// Why none of the records is of use; empty where they are.
    pub refused: Vec<String>,
}

/// How long jobs are prepared for being tried.
const PROBED: Duration = Duration::from_secs(10);

/// Checks every job of a study, looks into the folder of its results, and tries a few jobs, for ten seconds at most. `planned`
/// is told what is known before that.
///
/// # Errors
/// [`SweepError::Refused`] of the first job that is refused; [`SweepError::Journal`].
pub fn forecast(
    study: &Study,
    folder: &Path,
    threads: usize,
    cache: Option<&Cache>,
    planned: impl FnOnce(&Plan, Option<&RecordedJobs>),
) -> Result<Forecast, SweepError> {
    let index = JournalIndex::read(folder)?;
    let now = binding(study, None);
    let refused = results_folder::bindings(&index)
        .map(|then| then.differences(&now))
        .find(|told| !told.is_empty());
    let refused = refused.unwrap_or_default();
    let (mut done, mut failed) = (0, 0);
    let known = refused.is_empty() && !index.entries().is_empty();
    let plan = Plan::new(study, |job| {
        if let Some(entry) = known.then(|| index.find(&record_key(job))).flatten() {
            done += 1;
            failed += usize::from(entry.failed);
        }
    })?;
    let missing = plan.jobs - done;
    let found = (!index.files.is_empty()).then_some(RecordedJobs {
        done,
        failed,
        missing,
        refused,
    });
    planned(&plan, found.as_ref());
    let (mut tried, mut seconds) = (0, Some(0.0));
    let deadline = Instant::now() + PROBED;
    if missing > 0 {
        // costs of all jobs, then the part of them that is missing
        let threads = threads.min(plan.jobs).max(1) as f64;
        let mut bridge_s: f64 = 0.0;
        for share in plan.work.shares() {
            let measured = measure(study, share, cache, deadline);
            tried += measured.map_or(0, |m| m.jobs);
            bridge_s = measured.map_or(bridge_s, |m| bridge_s.max(m.bridge_s));
            seconds = seconds.zip(measured).map(|(sum, m)| sum + share_s(share, &m) / threads);
        }
        let part = missing as f64 / plan.jobs as f64;
        seconds = seconds.map(|jobs_s| bridge_s * plan.distinct_bridges as f64 + part * jobs_s);
    }
    Ok(Forecast {
        plan,
        found,
        expected_seconds: seconds,
        tried,
        time_not_probed: seconds.is_none() && Instant::now() >= deadline,
        threads,
    })
}

/// What the jobs of one kind cost of one thread, by their steps where they have any.
fn share_s(share: &Share, measured: &Measured) -> f64 {
    let tried: f64 = measured.module_steps;
    if tried > 0.0 {
        measured.job_s * share.module_steps / tried
    } else {
        measured.job_s * share.jobs as f64
    }
}
