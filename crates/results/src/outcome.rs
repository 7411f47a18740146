//! What a run leaves behind beside its records.
//!
//! Knows counts, times and the first reasons of failure. Keeps no record.

use super::failure::FailureKind;
use super::preparation::Preparation;
use super::record::JobRecord;
use super::verification::Verification;

/// Reasons that are kept of jobs that failed; all are in the table of jobs.
const FAILURES_KEPT: usize = 10;

/// What a run leaves behind beside its records.
#[derive(Debug)]
pub struct Outcome {
    /// Jobs asked for.
    pub jobs: usize,
    /// Those that ran, the others being recorded before.
    pub ran: usize,
    /// Those that failed.
    pub failures: Failures,
    /// Those solved again by the reference solver.
    pub verification: Verification,
    /// What jobs share, as it was prepared for those that ran.
    pub preparation: Preparation,
    /// Threads used.
    pub threads: usize,
    /// Wall time of what jobs share: finite elements, condensation, assembly, factors, static peaks `[s]`.
    pub offline_s: f64,
    /// Wall time of the jobs, what becomes of their records included `[s]`.
    pub jobs_s: f64,
}

/// Jobs that failed.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Failures {
    /// Number of failed jobs.
    pub count: usize,
    /// The first of them in the order of jobs with why they failed, ten at most.
    pub first: Vec<(usize, String)>,
    /// Causes, the most frequent first.
    pub causes: Vec<Cause>,
}

/// Jobs that failed for one cause: failures of one kind.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Cause {
    /// The kind.
    pub kind: FailureKind,
    /// How many.
    pub count: usize,
    /// The first of them.
    pub job: usize,
    /// Why that one did.
    pub reason: String,
}

impl Failures {
    /// Counts those among the next records.
    pub fn take(&mut self, records: &[JobRecord]) {
        for record in records {
            let Some(failure) = &record.failure else { continue };
            self.count += 1;
            if self.first.len() < FAILURES_KEPT {
                self.first.push((record.job, failure.text.clone()));
            }
            match self.causes.iter_mut().find(|cause| cause.kind == failure.kind) {
                Some(known) => known.count += 1,
                None => self.causes.push(Cause {
                    kind: failure.kind,
                    count: 1,
                    job: record.job,
                    reason: failure.text.clone(),
                }),
            }
        }
        self.causes.sort_by_key(|cause| std::cmp::Reverse(cause.count));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Failure;

    #[test]
    fn failures_of_one_kind_are_one_cause_whatever_their_numbers_and_words() {
        let record = |job, kind, text: &str, time_s| JobRecord {
            job,
            failure: Some(Failure::new(kind, text).with("time_s", time_s)),
            ..JobRecord::default()
        };
        let mut failures = Failures::default();
        failures.take(&[
            record(1, FailureKind::NotFinite, "a", 1.25),
            record(2, FailureKind::ContactNotSettled, "a", 0.5),
            record(3, FailureKind::ContactNotSettled, "b", 1.5e-3),
        ]);
        let causes: Vec<(FailureKind, usize, usize)> =
            failures.causes.iter().map(|c| (c.kind, c.count, c.job)).collect();
        assert_eq!(failures.count, 3);
        assert_eq!(
            causes,
            [(FailureKind::ContactNotSettled, 2, 2), (FailureKind::NotFinite, 1, 1)]
        );
    }
}
