//! Which share of a study's jobs exceeds each limit, where its points were drawn at random.
//!
//! Knows counts and their interval. Does not know what a limit bounds.

use super::results::Results;
use super::results_error::ResultsError;
use super::table::TableName;
use pontoon_plan::study_file::Limit;
use serde::Serialize;
use serde_json::Value;
use statrs::distribution::{Beta, ContinuousCDF};
use std::io::{self, Write};

/// How often a limit is exceeded.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Exceedance {
    /// The limit, by its word.
    pub limit: &'static str,
    /// Jobs that exceed it.
    pub exceeded: u64,
    /// Jobs that came to their end.
    pub jobs: u64,
    /// Jobs that failed, of which nothing is known.
    pub failed: u64,
    /// `exceeded / jobs`.
    pub share: f64,
    /// The interval that holds the true share with 95 %, by Clopper and Pearson (Biometrika 26, 1934).
    pub interval: [f64; 2],
}

/// Probability that the true share is outside the interval.
const OUTSIDE: f64 = 0.05;

/// The interval of a share of `n` of which `k` were found: quantiles of beta distributions.
fn interval(k: u64, n: u64) -> [f64; 2] {
    let quantile = |a: u64, b: u64, p: f64| Beta::new(a as f64, b as f64).map_or(f64::NAN, |beta| beta.inverse_cdf(p));
    let low = if k == 0 {
        0.0
    } else {
        quantile(k, n - k + 1, 0.5 * OUTSIDE)
    };
    let high = if k == n {
        1.0
    } else {
        quantile(k + 1, n - k, 1.0 - 0.5 * OUTSIDE)
    };
    [low, high]
}

/// Counts of jobs under way.
#[derive(Debug, Clone)]
pub(super) struct ExceedanceCounts {
    /// Of each limit the jobs that exceed it, that came to their end, that failed.
    of: [[u64; 3]; Limit::ALL.len()],
    wanted: bool,
}

impl ExceedanceCounts {
    /// Nothing yet of a study, by its file. Counts only where points are drawn at random and a job is a crossing or a static case: a rating's
    /// rows are of crossings that it looked for.
    pub(super) fn new(study: &Value) -> Self {
        let drawn = |design: &Value| ["latin_hypercube", "sobol"].iter().any(|form| !design[form].is_null());
        let random = study["design"]
            .as_array()
            .is_some_and(|designs| designs.iter().any(drawn));
        Self {
            of: [[0; 3]; Limit::ALL.len()],
            wanted: random && !study["limits"].is_null() && study["find"].is_null(),
        }
    }

    /// Takes what a job uses up of a limit, by its word; none of a job that failed.
    pub(super) fn take(&mut self, limit: &str, utilisation: Option<f64>) {
        let Some(of) = Limit::WORDS.iter().position(|known| *known == limit) else {
            return;
        };
        let [exceeded, jobs, failed] = &mut self.of[of];
        match utilisation {
            Some(utilisation) => {
                *exceeded += u64::from(utilisation > 1.0);
                *jobs += 1;
            }
            None => *failed += 1,
        }
    }

    /// How often each limit is exceeded; nothing of one that no job knows.
    pub(super) fn exceedances(&self) -> Vec<Exceedance> {
        let counted = Limit::WORDS
            .into_iter()
            .zip(self.of)
            .filter(|(_, of)| self.wanted && of[1] > 0);
        let one = |(limit, [exceeded, jobs, failed]): (&'static str, [u64; 3])| Exceedance {
            limit,
            exceeded,
            jobs,
            failed,
            share: exceeded as f64 / jobs as f64,
            interval: interval(exceeded, jobs),
        };
        counted.map(one).collect()
    }
}

impl Exceedance {
    /// Of each limit of results; nothing where no limits were stated or no point was drawn at random.
    ///
    /// # Errors
    /// [`ResultsError::Damaged`].
    pub fn of(results: &Results, study: &Value) -> Result<Vec<Self>, ResultsError> {
        let mut counts = ExceedanceCounts::new(study);
        if counts.wanted {
            results.scan(TableName::Limits, &["limit", "utilisation"], |part| {
                if let (Some(limits), Some(utilisations)) = (part.word_cells("limit"), part.numbers("utilisation")) {
                    for (word, utilisation) in limits.iter().zip(utilisations) {
                        counts.take(word.as_deref().unwrap_or_default(), *utilisation);
                    }
                }
            })?;
        }
        Ok(counts.exceedances())
    }

    /// Writes some as CSV, a line a limit.
    pub(super) fn write_csv(some: &[Self], to: impl Write) -> io::Result<()> {
        let mut to = csv::Writer::from_writer(to);
        to.write_record([
            "limit",
            "exceeded",
            "jobs",
            "failed",
            "share",
            "share_low",
            "share_high",
        ])?;
        for of in some {
            let counts = [of.exceeded, of.jobs, of.failed].map(|count| count.to_string());
            let shares = [of.share, of.interval[0], of.interval[1]].map(|share| share.to_string());
            to.write_record(
                [of.limit]
                    .into_iter()
                    .chain(counts.iter().chain(&shares).map(String::as_str)),
            )?;
        }
        to.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::interval;

    /// Intervals from exact sums of binomial terms, bisected by an independent program, to the digits told; those at the ends by
    /// hand: `1 - (a/2)^(1/n)`.
    #[test]
    fn intervals_are_those_of_clopper_and_pearson() {
        for (k, n, low, high) in [
            (1, 10, 0.0025, 0.4450),
            (5, 10, 0.1871, 0.8129),
            (2, 50, 0.0049, 0.1371),
        ] {
            let [found_low, found_high] = interval(k, n);
            assert!(
                (found_low - low).abs() < 6e-5 && (found_high - high).abs() < 6e-5,
                "{found_low} {found_high}"
            );
        }
        let none = interval(0, 20);
        assert!(
            none[0] == 0.0 && (none[1] - (1.0 - 0.025_f64.powf(0.05))).abs() < 1e-9,
            "{none:?}"
        );
        let all = interval(20, 20);
        assert!(all[1] == 1.0 && (all[0] - 0.025_f64.powf(0.05)).abs() < 1e-9, "{all:?}");
    }
}
