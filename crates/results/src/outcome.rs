//! What a run leaves behind beside its records.
//!
//! Knows counts, times and the first reasons of failure. Keeps no record.

use super::preparation::Preparation;
use super::record::JobRecord;
use super::verification::Verification;

/// Causes that are told apart.
const CAUSES_KEPT: usize = 100;

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

/// Jobs that failed for the same cause: their reasons differ in numbers alone.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Cause {
    /// How many.
    pub count: usize,
    /// The first of them.
    pub job: usize,
    /// Its reason.
    pub reason: String,
    words: String,
}

impl Failures {
    /// Counts those among the next records.
    pub fn take(&mut self, records: &[JobRecord]) {
        for record in records {
            let Some(reason) = &record.reason else { continue };
            self.count += 1;
            if self.first.len() < FAILURES_KEPT {
                self.first.push((record.job, reason.clone()));
            }
            let words = words_of_reason(reason);
            match self.causes.iter().position(|cause| cause.words == words) {
                Some(known) => self.causes[known].count += 1,
                None if self.causes.len() < CAUSES_KEPT => self.causes.push(Cause {
                    count: 1,
                    job: record.job,
                    reason: reason.clone(),
                    words,
                }),
                None => {}
            }
        }
        self.causes.sort_by_key(|cause| std::cmp::Reverse(cause.count));
    }
}

/// A reason without its numbers: what is the same for all jobs that fail for it.
pub fn words_of_reason(reason: &str) -> String {
    let numeric = |c: char| c.is_ascii_digit() || matches!(c, '.' | '-' | '+');
    let mut words = String::new();
    for word in reason.split_whitespace() {
        let word = word.trim_matches(|c: char| matches!(c, '(' | ')' | ',' | ';' | ':'));
        // 0.1, -3, 1.5e-7
        if !word.starts_with(numeric) {
            words.push_str(word);
            words.push(' ');
        }
    }
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reasons_that_differ_in_numbers_are_one_cause() {
        let record = |job, reason: &str| JobRecord {
            job,
            reason: Some(reason.to_owned()),
            ..JobRecord::default()
        };
        let mut failures = Failures::default();
        failures.take(&[
            record(1, "response not finite at t = 1.250000 s"),
            record(
                2,
                "contact not settled at t = 0.5 s in connector 3 (joint 2, y = -1.4 m) after 6 bisections",
            ),
            record(
                3,
                "contact not settled at t = 1.5e-3 s in connector 11 (joint 8, y = 1.4 m) after 6 bisections",
            ),
        ]);
        let causes: Vec<(usize, usize)> = failures.causes.iter().map(|c| (c.count, c.job)).collect();
        assert_eq!((failures.count, causes), (3, vec![(2, 2), (1, 1)]));
    }
}
