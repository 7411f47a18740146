//! The job of each point of a study: equal points have one job.
//!
//! Knows that jobs are numbered where the first of their points stands. Does not know what is made of points that belong
//! together.

use super::Job;
use super::jobs::{JobParts, Jobs};
use super::seen::fingerprint;
use crate::design::DesignPoint;
use crate::input::Refusal;
use crate::study_file::Study;
use std::collections::HashMap;

/// The jobs of the points of a study, point after point and block after block; each has the number that [`Jobs`] gives it.
pub struct PointJobs<'a> {
    jobs: Jobs<'a>,
    points: Box<dyn Iterator<Item = DesignPoint<'a>> + 'a>,
    /// The number of a job by what tells it apart.
    numbers: HashMap<u128, usize>,
}

impl<'a> PointJobs<'a> {
    /// Of a study.
    pub fn new(study: &'a Study) -> Self {
        Self::after(study, JobParts::default())
    }

    /// Of a study for which some parts were made before.
    pub(super) fn after(study: &'a Study, parts: JobParts) -> Self {
        Self {
            jobs: Jobs::of_no_point(study, parts),
            points: Box::new(study.blocks.iter().flat_map(|block| block.points())),
            numbers: HashMap::new(),
        }
    }
}

impl Iterator for PointJobs<'_> {
    type Item = Result<Job, Refusal>;

    fn next(&mut self) -> Option<Self::Item> {
        let point = self.points.next()?;
        let numbered = |job: Job| {
            let next = self.numbers.len();
            let number = *self.numbers.entry(fingerprint(&job.identity())).or_insert(next);
            Job { number, ..job }
        };
        Some(self.jobs.of_point(&point).map(numbered))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;
    use std::path::Path;

    #[test]
    fn each_point_has_the_number_of_its_job() {
        let dir = tempfile::tempdir().unwrap();
        let smoke = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies/bridges/smoke.json");
        std::fs::copy(smoke, dir.path().join("b.json")).unwrap();
        let grid = json!({ "connection": ["linear", "nonlinear"], "gap_tension_m": [0.01, 0.02], "speed_m_s": 5, "load_n": 1e5 });
        let case = json!({ "gap_tension_m": 0.01, "speed_m_s": 5, "load_n": 1e5 });
        let study = json!({ "name": "s", "bridge": "b.json", "analysis": { "kind": "crossing" },
                            "design": [{ "grid": grid }, { "cases": [case] }] });
        std::fs::write(dir.path().join("study.json"), study.to_string()).unwrap();
        let study = Study::open(dir.path()).unwrap();
        let of_points: Vec<Job> = PointJobs::new(&study).map(Result::unwrap).collect();
        // linear jobs know no gap
        assert_eq!(
            of_points.iter().map(|job| job.number).collect::<Vec<_>>(),
            [0, 0, 1, 2, 1]
        );
        for job in Jobs::new(&study).map(Result::unwrap) {
            let first = of_points.iter().find(|of| of.number == job.number).unwrap();
            assert_eq!(first.key(), job.key());
        }
    }
}
