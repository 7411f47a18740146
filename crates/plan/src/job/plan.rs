//! What a study would run: jobs, distinct bridges, steps.
//!
//! Knows what kinds of work there are. Knows roughly what a step costs, so that shards take equally long.
//! Does not know this machine.

use super::{Doubts, Job, Jobs, Task};
use crate::input::Refusal;
use crate::study_file::{ModelSpec, Study};
use serde::Serialize;
use std::collections::{BTreeSet, HashSet};

/// What a study would run. Making one checks every job.
#[derive(Debug, Clone, Serialize)]
pub struct Plan {
    /// The study's name.
    pub study: String,
    /// Points of all designs.
    pub points: usize,
    /// Jobs: points, equal ones counted once.
    pub jobs: usize,
    /// Bridges whose documents differ.
    pub distinct_bridges: usize,
    /// Modules to condense: bridges that differ in more than the connectors' stiffness and gaps.
    pub condensations: usize,
    /// Time steps of all crossings, bisected ones apart.
    pub steps: u64,
    /// Numbers that look as if they were in another unit, in words.
    pub notes: Vec<String>,
    /// What crossings by each solver and other jobs come to.
    #[serde(skip)]
    pub work: Work,
}

/// What the jobs of a plan come to, by what they cost.
#[derive(Debug, Clone, Default)]
pub struct Work {
    /// Crossings by the operator.
    pub operated: Share,
    /// Crossings by the reference solver.
    pub integrated: Share,
    /// Static cases and modes.
    pub other: Share,
}

/// Jobs of one kind.
#[derive(Debug, Clone, Default)]
pub struct Share {
    /// How many.
    pub jobs: usize,
    /// Steps times modules.
    pub module_steps: f64,
    /// The first of them, to be tried.
    pub first: Vec<Job>,
    /// Some of all, with one chance for each, to be tried.
    pub sample: Vec<Job>,
}

/// Jobs that are kept to be tried, from the front and from everywhere.
const KEPT: usize = 64;
const KEPT_OF_ALL: usize = 512;

impl Share {
    fn take(&mut self, job: &Job) {
        self.module_steps += module_steps(job);
        if self.first.len() < KEPT {
            self.first.push(job.clone());
        }
        if self.sample.len() < KEPT_OF_ALL {
            self.sample.push(job.clone());
        } else {
            // reservoir sampling; the same jobs whenever the study is the same
            let place = any_below(self.jobs, self.jobs + 1);
            if let Some(kept) = self.sample.get_mut(place) {
                kept.clone_from(job);
            }
        }
        self.jobs += 1;
    }
}

/// A number below `limit` that depends on `index` alone, as if drawn (SplitMix64: Steele, Lea, Flood, OOPSLA 2014).
fn any_below(index: usize, limit: usize) -> usize {
    let mut z = (index as u64).wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) % limit as u64) as usize
}

impl Work {
    fn take(&mut self, job: &Job) {
        match (job.task, job.by_operator()) {
            (Task::Crossing { .. }, true) => self.operated.take(job),
            (Task::Crossing { .. }, false) => self.integrated.take(job),
            _ => self.other.take(job),
        }
    }

    /// The kinds of jobs that there are.
    pub fn shares(&self) -> impl Iterator<Item = &Share> {
        [&self.operated, &self.integrated, &self.other]
            .into_iter()
            .filter(|share| share.jobs > 0)
    }
}

/// Steps of a job's crossings times the modules that each of them moves.
pub fn module_steps(job: &Job) -> f64 {
    (job.steps() * job.crossings()) as f64 * job.shared.bridge.design.modules as f64
}

/// Cost of a step of one module by the reference solver `[s]`, optimised, on one core.
const SECONDS_A_STEP_AND_MODULE: f64 = 2.0e-5;
/// Cost of a step of one module by the operator with all its lanes at work `[s]`.
const SECONDS_A_STEP_AND_MODULE_OPERATED: f64 = 3.0e-7;
/// Cost of meshing, condensing and assembling one bridge `[s]`.
pub(super) const SECONDS_A_BRIDGE: f64 = 2.0;
/// Cost of the static cases of one job `[s]`.
const SECONDS_A_STATIC_JOB: f64 = 1.0e-3;

/// What a job costs on a usual machine `[s]`, what it shares with others apart.
pub(super) fn cost_s(job: &Job) -> f64 {
    let step = if job.by_operator() {
        SECONDS_A_STEP_AND_MODULE_OPERATED
    } else {
        SECONDS_A_STEP_AND_MODULE
    };
    SECONDS_A_STATIC_JOB + step * module_steps(job)
}

impl Plan {
    /// Checks every job of a study and counts; `look` sees each of them.
    ///
    /// # Errors
    /// [`Refusal`] of the first job that is refused.
    pub fn new(study: &Study, mut look: impl FnMut(&Job)) -> Result<Self, Refusal> {
        let mut plan = Self {
            study: study.name.clone(),
            points: study.points(),
            jobs: 0,
            distinct_bridges: 0,
            condensations: 0,
            steps: 0,
            notes: Vec::new(),
            work: Work::default(),
        };
        let mut doubts = Doubts::default();
        let (mut bridges, mut modules) = (HashSet::new(), BTreeSet::new());
        for job in Jobs::new(study) {
            let job = job?;
            look(&job);
            plan.work.take(&job);
            doubts.take(&job);
            plan.jobs += 1;
            plan.steps += (job.steps() * job.crossings()) as u64;
            let model = job.model();
            if bridges.insert((job.shared.bridge.id, model)) && model == ModelSpec::SuperElement {
                modules.extend(job.shared.bridge.module_keys.iter().cloned());
            }
        }
        plan.distinct_bridges = bridges.iter().map(|(id, _)| id).collect::<HashSet<_>>().len();
        plan.condensations = modules.len();
        plan.notes = doubts.notes();
        Ok(plan)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::Cell;
    use serde_json::{Value, json};
    use std::path::Path;

    /// The jobs of designs on the smoke study's bridge.
    fn jobs(designs: Value) -> Result<Vec<Job>, Refusal> {
        let dir = tempfile::tempdir().unwrap();
        let smoke = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies/bridges/smoke.json");
        std::fs::copy(smoke, dir.path().join("b.json")).unwrap();
        let study = json!({ "name": "s", "bridge": "b.json", "analysis": { "kind": "crossing" }, "design": designs });
        std::fs::write(dir.path().join("study.json"), study.to_string()).unwrap();
        let study = Study::open(dir.path())?;
        Jobs::new(&study).collect()
    }

    fn case(more: Value) -> Value {
        let mut case = json!({ "speed_m_s": 10, "load_n": 1e5 });
        case.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
        case
    }

    /// The first jobs are kept, and of the others as many from each fifth of a study: 102 of 512 and four standard deviations.
    #[test]
    fn jobs_to_be_tried_come_from_everywhere() {
        let job = jobs(json!([{ "cases": [case(json!({}))] }])).unwrap().remove(0);
        let mut share = Share::default();
        for index in 0..5000 {
            share.take(&Job {
                number: index,
                ..job.clone()
            });
        }
        assert_eq!((share.jobs, share.sample.len()), (5000, KEPT_OF_ALL));
        assert!(share.first.iter().map(|job| job.number).eq(0..KEPT));
        let mut fifths = [0; 5];
        for job in &share.sample {
            fifths[job.number / 1000] += 1;
        }
        assert!(fifths.iter().all(|count| (66..138).contains(count)), "{fifths:?}");
    }

    #[test]
    fn points_that_come_to_the_same_are_one_job() {
        let same = [
            json!({}),
            json!({ "connection": "nonlinear" }),
            json!({ "gap_tension_m": 0.028 }),
            json!({ "speed_m_s": 10.0 }),
            json!({ "bridge.hydrostatic_stiffness_pa_m": 7486 }),
            json!({ "vehicle.track_y_m": [-1.4, 1.4] }),
            json!({ "analysis.time_step_s": 0.01 }),
        ];
        assert_eq!(jobs(json!([{ "cases": same.map(case) }])).unwrap().len(), 1);
        let linear = [
            json!({ "connection": "linear", "gap_tension_m": 0.01 }),
            json!({ "connection": "linear" }),
        ];
        assert_eq!(jobs(json!([{ "cases": linear.map(case) }])).unwrap().len(), 1);
        let grid = json!({ "connection": "linear", "bridge.connectors.gap_tension_m": [0, 0.01], "bridge.name": ["a", "b"],
                           "speed_m_s": 10, "load_n": 1e5 });
        let merged = jobs(json!([{ "grid": grid }])).unwrap();
        assert_eq!(merged.len(), 1);
        assert_eq!(merged[0].column("bridge.connectors.gap_tension_m"), Cell::Nothing);
    }

    #[test]
    fn designs_of_all_forms_are_united_and_equal_points_are_one_job() {
        let constant = json!({ "count": 5, "seed": 1, "ranges": { "connection": "linear", "speed_m_s": 10, "load_n": 1e5,
                               "gap_tension_m": [0, 0.1] } });
        let found = jobs(json!([
            { "grid": { "speed_m_s": [10, 20], "load_n": [1e5, 2e5], "gap_tension_m": 0.028 } },
            { "zip": { "speed_m_s": { "linspace": [10, 20, 2] }, "load_n": [100000, 2e5], "connection": "nonlinear" } },
            { "cases": [{ "speed_m_s": 20.0, "load_n": 1e5, "bridge.connectors.gap_tension_m": 0.028 },
                        { "speed_m_s": 30, "load_n": 1e5, "connection": "linear" }] },
            { "grid": { "speed_m_s": { "geomspace": [10, 40, 3] }, "load_n": 1e5, "vehicle.track_y_m": [[-1.4, 1.4]] },
              "where": { "speed_m_s": { "from": 20 } } },
            { "latin_hypercube": constant },
            { "sobol": constant },
        ]))
        .unwrap();
        let told: Vec<(f64, f64, bool)> = found
            .iter()
            .map(|job| {
                let Task::Crossing { speed_m_s } = job.task else {
                    panic!("{:?}", job.task)
                };
                (speed_m_s, job.load_n, job.gaps_m().is_some())
            })
            .collect();
        assert_eq!(
            told,
            [
                (10.0, 1e5, true),
                (10.0, 2e5, true),
                (20.0, 1e5, true),
                (20.0, 2e5, true),
                (30.0, 1e5, false),
                (40.0, 1e5, true),
                (10.0, 1e5, false),
            ]
        );
        assert!(found.iter().enumerate().all(|(i, job)| job.number == i));
    }

    #[test]
    fn any_number_of_the_documents_is_an_axis_of_every_form() {
        for axis in [
            "bridge.hydrostatic_stiffness_pa_m",
            "vehicle.track_y_m[0]",
            "analysis.tail_s",
            "analysis.damping.ratio",
        ] {
            let listed = json!({ axis: [0.5, 0.75], "speed_m_s": 10, "load_n": 1e5 });
            let drawn = json!({ "count": 2, "seed": 1,
                                "ranges": { axis: [0.5, 0.75], "speed_m_s": 10, "load_n": 1e5 } });
            for form in [
                json!({ "grid": listed, "where": { axis: { "to": 0.8 } } }),
                json!({ "zip": listed }),
                json!({ "latin_hypercube": drawn }),
                json!({ "sobol": drawn }),
            ] {
                let found = jobs(json!([form])).unwrap_or_else(|e| panic!("{axis}: {e}"));
                let values: Vec<f64> = found.iter().map(|job| job.column(axis).number().unwrap()).collect();
                assert!(values.len() == 2 && values[0] != values[1], "{form}: {values:?}");
                assert!(values.iter().all(|x| (0.5..=0.75).contains(x)), "{form}: {values:?}");
            }
        }
    }

    #[test]
    fn a_part_of_a_default_may_be_an_axis() {
        for axis in ["vehicle.track_y_m[0]", "bridge.supports.left", "analysis.damping.ratio"] {
            let value = match axis {
                "bridge.supports.left" => json!([["x", "y"], ["x", "y", "z"]]),
                _ => json!([0.1, 0.2]),
            };
            let grid = json!({ axis: value, "speed_m_s": 10, "load_n": 1e5 });
            let found = jobs(json!([{ "grid": grid }])).unwrap_or_else(|e| panic!("{axis}: {e}"));
            assert_eq!(found.len(), 2, "{axis}");
        }
        let axles = json!([[{ "behind_front_m": 0, "share": 1, "patch_length_m": 0.3, "track_y_m": [0] }]]);
        let grid = json!({ "vehicle.axles": axles, "speed_m_s": 10, "load_n": 1e5 });
        assert_eq!(jobs(json!([{ "grid": grid }])).unwrap().len(), 1);
    }

    #[test]
    fn points_that_differ_in_anything_are_jobs_of_their_own() {
        let different = [
            json!({}),
            json!({ "connection": "linear" }),
            json!({ "gap_tension_m": 0.0281 }),
            json!({ "gap_compression_m": 0.0 }),
            json!({ "speed_m_s": 10.1 }),
            json!({ "load_n": 2e5 }),
            json!({ "bridge.hydrostatic_stiffness_pa_m": 7487 }),
            json!({ "bridge.connectors.stiffness_n_m": 2e7 }),
            json!({ "vehicle.track_y_m": [1, 3] }),
            json!({ "vehicle.inertia": "none" }),
            json!({ "analysis.time_step_s": 0.02 }),
            json!({ "analysis.model": "full" }),
        ];
        let count = different.len();
        let jobs = jobs(json!([{ "cases": different.map(case) }])).unwrap();
        assert_eq!(
            jobs.iter().map(|job| job.number).collect::<Vec<_>>(),
            (0..count).collect::<Vec<_>>()
        );
    }

    #[test]
    fn numbers_in_another_unit_are_noted_and_not_refused() {
        let notes = |more: Value| Doubts::of(&jobs(json!([{ "cases": [case(more)] }])).unwrap()).notes();
        assert_eq!(notes(json!({})), Vec::<String>::new());
        for (more, told) in [
            (
                json!({ "speed_m_s": 54, "analysis.time_step_s": 0.001 }),
                "speed_m_s 54: above 30 m/s",
            ),
            (json!({ "load_n": 230 }), "load_n 230: below 1000 N"),
            (
                json!({ "speed_m_s": 20, "analysis.time_step_s": 0.1 }),
                "analysis.time_step_s 0.1: the vehicle goes more than half of its shortest patch in a time step",
            ),
            (json!({ "gap_tension_m": 28 }), "gap_tension_m 28: above the depth"),
            (
                json!({ "gap_compression_m": 5.5 }),
                "gap_compression_m 5.5: above the depth",
            ),
            (
                json!({ "bridge.module.material.youngs_modulus_pa": 200 }),
                "bridge.module.material.youngs_modulus_pa 200: below 1e9 Pa: is it in GPa",
            ),
            (
                json!({ "bridge.module.longitudinal_walls.thickness_m": 2.1, "bridge.draft_m": null,
                        "bridge.freeboard_m": null }),
                "bridge.module.longitudinal_walls.thickness_m 2.1: above 0.1 m: is it in mm?",
            ),
        ] {
            let notes = notes(more);
            assert!(notes.len() == 1 && notes[0].starts_with(told), "{notes:?}");
        }
        let three = json!([{ "grid": { "speed_m_s": [40, 50, 60], "load_n": 1e5, "analysis.time_step_s": 0.001 } }]);
        assert_eq!(
            Doubts::of(&jobs(three).unwrap()).notes(),
            ["speed_m_s 40: above 30 m/s, which is 108 km/h: is it in km/h? (2 more jobs)"]
        );
    }

    #[test]
    fn axles_state_shares_or_loads() {
        let axles = |a: Value, b: Value| {
            let mut axles = [a, b];
            for axle in &mut axles {
                let more = json!({ "behind_front_m": 0, "patch_length_m": 0.3, "track_y_m": [0] });
                axle.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
            }
            json!({ "vehicle.axles": [axles] })
        };
        let with = |design: Value, more: Value| {
            let mut grid = json!({ "speed_m_s": 10 });
            for of in [design, more] {
                grid.as_object_mut().unwrap().extend(of.as_object().unwrap().clone());
            }
            jobs(json!([{ "grid": grid }]))
        };
        let shares = |job: &Job| {
            job.shared
                .vehicle
                .vehicle
                .patches
                .iter()
                .map(|patch| patch.share)
                .collect::<Vec<_>>()
        };
        let by_loads = axles(json!({ "load_n": 3e4 }), json!({ "load_n": 5e4 }));
        let found = with(by_loads.clone(), json!({})).unwrap();
        assert_eq!((found[0].load_n, shares(&found[0])), (8e4, vec![0.375, 0.625]));
        assert_eq!(found[0].column("load_n"), Cell::Whole(80_000));
        // a weight that is stated scales them
        let found = with(by_loads, json!({ "load_n": 1.6e5 })).unwrap();
        assert_eq!((found[0].load_n, shares(&found[0])), (1.6e5, vec![0.375, 0.625]));
        // rounded shares are shares
        let third = |share: f64| axles(json!({ "share": share }), json!({ "share": 0.667 }));
        let found = with(third(0.3333), json!({ "load_n": 1e5 })).unwrap();
        assert_eq!(found[0].load_n, 1e5);
        assert!((shares(&found[0]).iter().sum::<f64>() - 1.0).abs() < 1e-15);
        let load = json!({ "load_n": 1e5 });
        for (refused, path, told) in [
            (
                with(third(0.34), load.clone()),
                "vehicle.axles[*].share",
                "a sum of 1.007, allowed: shares that sum to 1 within 0.001",
            ),
            (
                with(axles(json!({ "share": 0.4 }), json!({ "load_n": 1e5 })), load.clone()),
                "vehicle.axles[1].load_n",
                "share alone, the same for all axles",
            ),
            (
                with(axles(json!({ "load_n": 1e5 }), json!({})), load.clone()),
                "vehicle.axles[1].load_n",
                "a share of each axle, or a load_n of each",
            ),
            (
                with(axles(json!({ "share": 40 }), json!({ "share": 60 })), load),
                "vehicle.axles[*].share",
                "a sum of 100",
            ),
        ] {
            let message = refused.unwrap_err().to_string();
            assert!(
                message.contains(told) && message.contains(path.rsplit('.').next().unwrap()),
                "{message}"
            );
        }
    }

    #[test]
    fn a_time_step_beyond_a_module_is_told_as_it_was_typed() {
        for (more, path, found) in [
            (
                json!({ "analysis.time_step_s": 0.03, "speed_m_s": 400 }),
                "design[0].cases[0].analysis.time_step_s",
                "0.03",
            ),
            (
                json!({ "speed_m_s": 700 }),
                "analysis.time_step_s",
                "none, which stands for 0.01 s",
            ),
            (
                json!({ "speed_m_s": 1e-5, "analysis.tail_s": 0 }),
                "analysis.time_step_s",
                "none, which stands for 0.01 s and makes 2.3e8 steps",
            ),
        ] {
            let refused = jobs(json!([{ "cases": [case(more)] }])).unwrap_err();
            assert_eq!((refused.path.as_str(), refused.found.text().as_str()), (path, found));
        }
    }

    #[test]
    fn a_vehicle_is_checked_on_every_deck() {
        let on = |breadth_m: f64| {
            let more = json!({ "bridge.module.breadth_m": breadth_m, "vehicle.track_y_m": [-4.4, 4.4] });
            case(more)
        };
        assert_eq!(jobs(json!([{ "cases": [on(9.0), on(10.0)] }])).unwrap().len(), 2);
        let refused = jobs(json!([{ "cases": [on(9.0), on(8.082)] }])).unwrap_err();
        assert_eq!(refused.path, "design[0].cases[1].vehicle.track_y_m[0]", "{refused}");
    }

    #[test]
    fn what_is_data_of_a_job_is_no_part_of_the_module() {
        let same = [
            json!({ "bridge.connectors.stiffness_n_m": 2e7 }),
            json!({ "bridge.connectors.gap_tension_m": 0.01 }),
            json!({ "bridge.draft_m": 0.1, "bridge.freeboard_m": 0.97 }),
        ];
        let jobs =
            jobs(json!([{ "cases": same.map(case) }, { "cases": [case(json!({ "bridge.modules": 4 }))] }])).unwrap();
        assert!(
            jobs[..3]
                .iter()
                .all(|job| job.shared.bridge.module_keys == jobs[0].shared.bridge.module_keys)
        );
        assert_ne!(jobs[0].shared.bridge.structure_key, jobs[1].shared.bridge.structure_key);
        assert_eq!(jobs[0].shared.bridge.module_keys, jobs[3].shared.bridge.module_keys);
        assert_ne!(jobs[0].shared.bridge.structure_key, jobs[3].shared.bridge.structure_key);
        assert_eq!(jobs[1].column("gap_tension_m"), Cell::Number(0.01));
        assert_eq!(jobs[3].column("bridge.modules"), Cell::Whole(4));
    }

    #[test]
    fn a_number_that_an_axis_makes_wrong_elsewhere_is_told_beside_the_axis() {
        let refused = jobs(json!([{ "cases": [case(json!({ "bridge.module.breadth_m": 2.0 }))] }])).unwrap_err();
        assert!(
            refused.path == "design[0].cases[0]"
                && refused.made_wrong.as_ref().is_some_and(|of| of.starts_with("bridge.")),
            "{refused}"
        );
    }
}
