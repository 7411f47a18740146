//! A study that is asked at points call after call: what its points do not change is read once.
//!
//! Knows what calls share. Does not know who asks, nor what is kept of answers.

use super::Job;
use super::jobs::{JobParts, Jobs};
use super::point_jobs::PointJobs;
use crate::design::Block;
use crate::input::Refusal;
use crate::study_file::Study;

/// A study of one zip, whose first axes have other values in each call. It never changes, so calls may share it.
#[derive(Debug)]
pub struct PointStudy {
    study: Study,
    /// What was made for the first point; what is made for those of a call goes with the call.
    parts: JobParts,
}

/// The points of a call.
#[derive(Debug)]
pub struct AskedPoints {
    /// The study with these points.
    pub study: Study,
    /// Its jobs.
    pub jobs: Vec<Job>,
    /// Of each point the number of its job.
    pub rows: Vec<usize>,
}

impl PointStudy {
    /// Of a study with one point or more.
    pub fn new(study: Study) -> Self {
        let mut jobs = Jobs::of_no_point(&study, JobParts::default());
        let first = study.blocks.iter().flat_map(Block::points).next();
        // a point that makes no job is refused where it is asked for
        let _ = first.map(|point| jobs.of_point(&point));
        let parts = jobs.into_parts();
        Self { study, parts }
    }

    /// The points with some values of the first axes: of each axis a list.
    ///
    /// # Errors
    /// [`Refusal`] of lists that make no points, and of a point that makes no job.
    pub fn at(&self, lists: &[Vec<f64>]) -> Result<AskedPoints, Refusal> {
        let study = self.study.with_lists(lists)?;
        let (mut jobs, mut rows) = (Vec::new(), Vec::with_capacity(study.points()));
        for job in PointJobs::after(&study, self.parts.clone()) {
            let job = job?;
            rows.push(job.number);
            if job.number == jobs.len() {
                jobs.push(job);
            }
        }
        Ok(AskedPoints { study, jobs, rows })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::Document;
    use crate::study_file::{BridgeFile, read_bridge};
    use serde_json::{Value, json};
    use std::path::Path;

    fn smoke() -> BridgeFile {
        read_bridge(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies/bridges/smoke.json")).unwrap()
    }

    fn study(design: &Value) -> Result<Study, Refusal> {
        let spec = json!({ "name": "s", "bridge": "", "analysis": { "kind": "crossing" }, "design": [design] });
        Study::of_values(Path::new("f()"), Document::from(&spec), &smoke())
    }

    /// The jobs of a study by their keys, and the job of each point.
    fn keys(study: &Study) -> (Vec<String>, Vec<usize>) {
        let jobs = Jobs::new(study).map(|job| format!("{:?}", job.unwrap().key()));
        (
            jobs.collect(),
            PointJobs::new(study).map(|job| job.unwrap().number).collect(),
        )
    }

    #[test]
    fn each_call_has_the_jobs_of_a_study_of_its_own() {
        let path = "bridge.connectors.stiffness_n_m";
        let zip = |stiffness: Value, gap: Value, connection: &str| json!({ "zip": { path: stiffness, "gap_tension_m": gap, "connection": connection, "speed_m_s": 5, "load_n": 1e5 } });
        let asked = PointStudy::new(study(&zip(json!([3e8]), json!([0.01]), "nonlinear")).unwrap());
        let linear = PointStudy::new(study(&zip(json!([3e8]), json!([0.01]), "linear")).unwrap());
        let calls = [
            (vec![3e8], vec![0.01]),
            (vec![2e8, 3e8, 2e8], vec![0.0, 0.01, 0.0]),
            (vec![4e8; 2], vec![0.02, 0.03]),
            (vec![3e8], vec![0.01]),
        ];
        for (stiffness, gap) in &calls {
            for (of, connection) in [(&asked, "nonlinear"), (&linear, "linear")] {
                let AskedPoints { study: _, jobs, rows } = of.at(&[stiffness.clone(), gap.clone()]).unwrap();
                let expected = keys(&study(&zip(json!(stiffness), json!(gap), connection)).unwrap());
                let found: Vec<String> = jobs.iter().map(|job| format!("{:?}", job.key())).collect();
                assert_eq!((found, rows), expected, "{stiffness:?} {gap:?} {connection}");
            }
        }
    }

    #[test]
    fn calls_share_the_documents_that_their_points_do_not_change() {
        let of = PointStudy::new(study(&json!({ "zip": { "speed_m_s": [5], "load_n": 1e5 } })).unwrap());
        let bridge = |speed: f64| of.at(&[vec![speed]]).unwrap().jobs.remove(0).shared.bridge.clone();
        assert!(std::sync::Arc::ptr_eq(&bridge(6.0), &bridge(7.0)));
    }

    #[test]
    fn points_are_refused_as_those_of_a_study() {
        let zip = |speed: &[f64]| json!({ "zip": { "speed_m_s": speed, "load_n": [1e5, 2e5] } });
        let of = PointStudy::new(study(&zip(&[5.0, -1.0])).unwrap());
        for speed in [&[-1.0, 5.0][..], &[5.0, -1.0], &[1.0, 2.0, 3.0], &[]] {
            let refused = of.at(&[speed.to_vec()]).unwrap_err();
            let expected = match study(&zip(speed)) {
                Ok(study) => Jobs::new(&study).find_map(Result::err).unwrap(),
                Err(refusal) => refusal,
            };
            assert_eq!(refused.to_string(), expected.to_string());
        }
        assert!(of.at(&[vec![5.0]]).is_ok());
        let refused = |design: Value, lists: usize| {
            let of = PointStudy::new(study(&design).unwrap());
            of.at(&vec![vec![5.0]; lists]).unwrap_err().to_string()
        };
        let grid = json!({ "grid": { "speed_m_s": 5, "load_n": 1e5 } });
        assert_eq!(
            refused(grid, 1),
            "f(): design[0].grid: found another design, allowed: a zip of at least 1 axes, without conditions"
        );
        assert!(refused(zip(&[5.0]), 3).contains("a zip of at least 3 axes"));
    }
}
