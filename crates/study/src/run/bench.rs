//! What jobs share, prepared once: modules, bridges, damping, factored solvers, static peaks.
//!
//! Knows which jobs share what, by keys made of the jobs' own numbers. Does not know what a job does with it.

use super::cache::{Cache, Found};
use super::guard::guarded;
use super::progress::Progress;
use super::retry::RETRY_STEP_SHARE;
use super::stop::Stop;
use pontoon_core::analysis::crossing::{CrossingSettings, CrossingSolver, OperatorSolver};
use pontoon_core::analysis::modes::{Rayleigh, bending_frequencies_hz, rayleigh};
use pontoon_core::analysis::statics::{StaticCase, StaticSolver};
use pontoon_core::bridge::{Bridge, Ends, Model, PreparedModule};
use pontoon_core::operator::BridgeOperator;
use pontoon_plan::job::{Job, Task};
use pontoon_plan::study_file::TimeStepSpec;
use pontoon_results::{BridgeReport, OperatorCounts, Preparation};
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// A thing that jobs share, or why it could not be made.
type Shared<T> = Result<Arc<T>, String>;
type ModuleKey = (Model, Arc<str>);
type BridgeKey = (Model, Arc<str>);
type DampingKey = (BridgeKey, u64, Option<[u64; 2]>);
type CrossingKey = (DampingKey, [u64; 2], [Option<usize>; 2]);
type OperatorKey = (BridgeKey, u64);
/// Crossings of one key are solved side by side.
pub(super) type CrewKey = (CrossingKey, u64, Option<u64>);
type CreepingKey = (BridgeKey, Arc<str>, Option<(u64, u64)>, u64);

/// Damping and where it came from.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Damping {
    frequencies_hz: [f64; 2],
    coefficients: Rayleigh,
}

/// Modules prepared, to be handed on to a later run that needs some of them again.
#[derive(Debug, Clone, Default)]
pub struct PreparedModules(BTreeMap<ModuleKey, Shared<PreparedModule>>);

/// All that the jobs of a run share.
#[derive(Debug)]
pub(super) struct Bench {
    modules: BTreeMap<ModuleKey, Shared<PreparedModule>>,
    bridges: BTreeMap<BridgeKey, Shared<Bridge>>,
    damping: BTreeMap<DampingKey, Shared<Damping>>,
    operators: BTreeMap<OperatorKey, Shared<BridgeOperator>>,
    operated: BTreeMap<CrewKey, Shared<OperatorSolver>>,
    crossings: BTreeMap<CrossingKey, Shared<CrossingSolver>>,
    statics: BTreeMap<BridgeKey, Shared<StaticSolver>>,
    creeping: BTreeMap<CreepingKey, Shared<Vec<f64>>>,
    condensations: AtomicUsize,
    operators_made: OperatorsMade,
}

/// Where operators came from.
#[derive(Debug, Default)]
struct OperatorsMade {
    built: AtomicUsize,
    from_cache: AtomicUsize,
    refused: AtomicUsize,
}

impl Bench {
    /// Prepares everything that `all` jobs need, each thing once, on the current pool; modules that are `known` are taken
    /// from there. What is not begun when a stop is asked for is not prepared.
    pub(super) fn prepare(
        all: &[&Job],
        known: &PreparedModules,
        cache: Option<&Cache>,
        stop: &Stop,
        progress: &dyn Progress,
    ) -> Self {
        let mut bench = Self {
            modules: BTreeMap::new(),
            bridges: BTreeMap::new(),
            damping: BTreeMap::new(),
            operators: BTreeMap::new(),
            operated: BTreeMap::new(),
            crossings: BTreeMap::new(),
            statics: BTreeMap::new(),
            creeping: BTreeMap::new(),
            condensations: AtomicUsize::new(0),
            operators_made: OperatorsMade::default(),
        };
        let crossing = |job: &&Job| matches!(job.task, Task::Crossing { .. });
        let crossings: Vec<&Job> = all.iter().copied().filter(crossing).collect();
        progress.stage("modules: finite elements, condensation");
        let is_known = |job: &&Job| known.0.contains_key(&module_key(job));
        let (old, new): (Vec<&Job>, Vec<&Job>) = all.iter().copied().partition(is_known);
        bench.modules = each(stop, &new, module_key, |job| bench.module(job));
        let taken = old.iter().filter_map(|job| known.0.get_key_value(&module_key(job)));
        bench
            .modules
            .extend(taken.map(|(key, module)| (key.clone(), module.clone())));
        progress.stage("bridges: assembly");
        let loaded: Vec<&Job> = all.iter().copied().filter(|job| job.task != Task::Modes).collect();
        bench.bridges = each(stop, &loaded, bridge_key, |job| bench.bridge(job, Ends::Supported));
        progress.stage("damping: bending modes of the free bridge");
        bench.damping = each(stop, &crossings, damping_key, |job| bench.damping_of(job));
        progress.stage("solvers: factors");
        let held: Vec<&Job> = loaded.iter().copied().filter(|job| is_held(job)).collect();
        bench.statics = each(stop, &held, bridge_key, |job| {
            StaticSolver::new(&shared(&bench.bridges, &bridge_key(job))?).map_err(text)
        });
        let (operated, integrated): (Vec<&Job>, Vec<&Job>) = crossings.iter().partition(|job| job.by_operator());
        let again = operated.iter().copied().filter(|job| job.verify().is_some());
        let judged: Vec<&Job> = integrated.into_iter().chain(again).collect();
        bench.crossings = each(stop, &judged, crossing_key, |job| bench.crossing_solver(job));
        progress.stage("operators: modes and what they leave out");
        bench.operators = each(stop, &operated, operator_key, |job| bench.operator(job, cache));
        bench.operated = each(stop, &operated, Self::crew_key, |job| bench.operator_solver(job));
        progress.stage("static peaks of creeping loads");
        let creeping: Vec<&Job> = crossings.iter().copied().filter(|job| is_held(job)).collect();
        bench.creeping = bench.creeping_peaks(stop, &creeping);
        bench
    }

    fn module(&self, job: &Job) -> Result<PreparedModule, String> {
        let model = model(job);
        if model == Model::SuperElement {
            self.condensations.fetch_add(1, Ordering::Relaxed);
        }
        PreparedModule::new(&job.bridge.design, model).map_err(text)
    }

    /// The module of a job.
    pub(super) fn module_of(&self, job: &Job) -> Shared<PreparedModule> {
        shared(&self.modules, &module_key(job))
    }

    /// The bridge of a job, assembled anew.
    pub(super) fn bridge(&self, job: &Job, ends: Ends) -> Result<Bridge, String> {
        Bridge::new(&job.bridge.design, &*shared(&self.modules, &module_key(job))?, ends).map_err(text)
    }

    fn damping_of(&self, job: &Job) -> Result<Damping, String> {
        let spec = job.analysis.spec.damping.unwrap_or_default();
        let frequencies_hz = match spec.frequencies_hz {
            Some(stated) => stated,
            None => bending_frequencies_hz(&self.bridge(job, Ends::Free)?)
                .map_err(|e| format!("damping: {e}; state analysis.damping.frequencies_hz"))?,
        };
        Ok(Damping {
            frequencies_hz,
            coefficients: rayleigh(spec.ratio, frequencies_hz),
        })
    }

    /// The operator of a job, from the cache where it is there whole, else built and kept.
    fn operator(&self, job: &Job, cache: Option<&Cache>) -> Result<BridgeOperator, String> {
        let tolerance = job.analysis.spec.operator_tolerance.unwrap_or_default();
        let (bridge, made) = (shared(&self.bridges, &bridge_key(job))?, &self.operators_made);
        let name = Cache::name(&format!("{:?}", operator_key(job)));
        match cache.map_or(Found::Nothing, |cache| cache.read(&name, &bridge)) {
            Found::Whole(operator) => {
                made.from_cache.fetch_add(1, Ordering::Relaxed);
                return Ok(*operator);
            }
            Found::Refused => made.refused.fetch_add(1, Ordering::Relaxed),
            Found::Nothing => 0,
        };
        made.built.fetch_add(1, Ordering::Relaxed);
        let operator = BridgeOperator::new(&bridge, tolerance).map_err(text)?;
        if let Some(cache) = cache {
            // a cache that cannot be written costs time at the next run, and nothing else
            let _ = cache.write(&name, &operator);
        }
        Ok(operator)
    }

    /// What is told of all that was prepared for jobs.
    pub(super) fn preparation(&self, jobs: &[&Job]) -> Preparation {
        Preparation {
            condensations: self.condensations(),
            operators: self.operator_counts(),
            bridges: self.reports(jobs),
        }
    }

    /// Where the operators came from.
    fn operator_counts(&self) -> OperatorCounts {
        let of = |count: &AtomicUsize| count.load(Ordering::Relaxed);
        OperatorCounts {
            built: of(&self.operators_made.built),
            from_cache: of(&self.operators_made.from_cache),
            replaced: of(&self.operators_made.refused),
        }
    }

    fn operator_solver(&self, job: &Job) -> Result<OperatorSolver, String> {
        let bridge = shared(&self.bridges, &bridge_key(job))?;
        let operator = shared(&self.operators, &operator_key(job))?;
        Ok(OperatorSolver::new(&bridge, &operator, &self.settings(job)?))
    }

    /// Crossings of one key are solved side by side.
    pub(super) fn crew_key(job: &Job) -> CrewKey {
        let spec = &job.analysis.spec;
        let auto = match spec.time_step_s {
            Some(TimeStepSpec::Auto(_)) => spec.time_step_tolerance.map(f64::to_bits),
            _ => None,
        };
        (
            crossing_key(job),
            spec.operator_tolerance.unwrap_or_default().to_bits(),
            auto,
        )
    }

    /// The operator's solver of a crossing.
    pub(super) fn operated(&self, job: &Job) -> Shared<OperatorSolver> {
        shared(&self.operated, &Self::crew_key(job))
    }

    fn crossing_solver(&self, job: &Job) -> Result<CrossingSolver, String> {
        CrossingSolver::new(&shared(&self.bridges, &bridge_key(job))?, &self.settings(job)?).map_err(text)
    }

    /// The reference solver of a crossing at half its time step, made anew.
    pub(super) fn crossing_at_half_step(&self, job: &Job) -> Result<CrossingSolver, String> {
        let mut settings = self.settings(job)?;
        settings.time_step_s *= RETRY_STEP_SHARE;
        CrossingSolver::new(&shared(&self.bridges, &bridge_key(job))?, &settings).map_err(text)
    }

    fn settings(&self, job: &Job) -> Result<CrossingSettings, String> {
        Ok(job.settings(shared(&self.damping, &damping_key(job))?.coefficients))
    }

    /// The static peaks of creeping loads; cases of one vehicle on one bridge share what it does at its places, which is let
    /// go before the next vehicle's.
    fn creeping_peaks(&self, stop: &Stop, jobs: &[&Job]) -> BTreeMap<CreepingKey, Shared<Vec<f64>>> {
        let mut vehicles: BTreeMap<(BridgeKey, Arc<str>), Vec<&Job>> = BTreeMap::new();
        for job in jobs {
            let key = (bridge_key(job), job.vehicle.key.clone());
            vehicles.entry(key).or_default().push(job);
        }
        let peaks = |((bridge, _), jobs): ((BridgeKey, _), Vec<&Job>)| {
            let load = guarded(|| Ok::<_, String>(shared(&self.statics, &bridge)?.creeping(&jobs[0].vehicle.vehicle)));
            each(stop, &jobs, creeping_key, |job| {
                load.as_ref()
                    .map_err(Clone::clone)?
                    .peaks_m(&static_case(job, 0.0))
                    .map_err(text)
            })
        };
        let vehicles: Vec<_> = vehicles.into_iter().collect();
        let made: Vec<_> = vehicles.into_par_iter().with_max_len(1).map(peaks).collect();
        made.into_iter().flatten().collect()
    }

    /// The solver of a crossing.
    pub(super) fn crossing(&self, job: &Job) -> Shared<CrossingSolver> {
        shared(&self.crossings, &crossing_key(job))
    }

    /// The solver of a static case.
    pub(super) fn statics(&self, job: &Job) -> Shared<StaticSolver> {
        shared(&self.statics, &bridge_key(job))
    }

    /// The largest static deflection of each position under the job's load over its places `[m]`; none where the bridge is
    /// not held.
    pub(super) fn creeping_peaks_m(&self, job: &Job) -> Result<Option<Arc<Vec<f64>>>, String> {
        if !is_held(job) {
            return Ok(None);
        }
        shared(&self.creeping, &creeping_key(job))
            .map(Some)
            .map_err(|e| format!("static peak: {e}"))
    }

    /// The modules, for a later run.
    pub(super) fn modules(&self) -> PreparedModules {
        PreparedModules(self.modules.clone())
    }

    /// Modules condensed.
    pub(super) fn condensations(&self) -> usize {
        self.condensations.load(Ordering::Relaxed)
    }

    /// What was prepared of each bridge and model, in the order of jobs.
    fn reports(&self, jobs: &[&Job]) -> Vec<BridgeReport> {
        let mut reports: Vec<BridgeReport> = Vec::new();
        let mut seen = BTreeSet::new();
        for job in jobs {
            // what a report is made of: the same entries make the same report
            if !seen.insert((job.bridge.id, job.analysis.id)) {
                continue;
            }
            let module = shared(&self.modules, &module_key(job)).ok();
            let damping = shared(&self.damping, &damping_key(job)).ok();
            let operator = shared(&self.operators, &operator_key(job)).ok().map(|o| o.cutoff());
            let report = BridgeReport {
                blake3: job.bridge.hash.clone(),
                name: job.bridge.design.name.clone(),
                model: if model(job) == Model::Full {
                    "full".to_owned()
                } else {
                    "super-element".to_owned()
                },
                modules: job.bridge.design.modules,
                module_full_dofs: module.as_ref().map(|m| m.full_dofs()),
                module_dofs: module.as_ref().map(|m| m.dofs()),
                structural_mass_kg: module.as_ref().map(|m| m.structural_mass_kg()),
                dofs: shared(&self.bridges, &bridge_key(job)).ok().map(|b| b.dofs()),
                damping_frequencies_hz: damping.as_ref().map(|d| d.frequencies_hz),
                damping_stiffness_s: damping.as_ref().map(|d| d.coefficients.a),
                damping_mass_1_s: damping.as_ref().map(|d| d.coefficients.b),
                operator_modes: operator.map(|o| o.modes),
                operator_cutoff_hz: operator.map(|o| o.frequency_hz),
                operator_tolerance: operator.map(|o| o.tolerance),
                operator_error: operator.map(|o| o.error),
            };
            if !reports.contains(&report) {
                reports.push(report);
            }
        }
        reports
    }
}

/// The static case of a job with its load at a place.
pub(super) fn static_case(job: &Job, load_x_m: f64) -> StaticCase {
    StaticCase {
        connection: job.connection,
        connector_stiffness_n_m: job.bridge.design.connectors.stiffness_n_m,
        load_n: job.load_n,
        load_x_m,
    }
}

/// Whether the bridge of a job has static cases.
fn is_held(job: &Job) -> bool {
    job.bridge.design.check_held().is_ok()
}

/// Makes one thing for each distinct key, in parallel; the first job with a key stands for the others.
fn each<K: Ord + Send, T: Send + Sync>(
    stop: &Stop,
    jobs: &[&Job],
    key: impl Fn(&Job) -> K,
    make: impl Fn(&Job) -> Result<T, String> + Sync,
) -> BTreeMap<K, Shared<T>> {
    let mut first: BTreeMap<K, &Job> = BTreeMap::new();
    for job in jobs {
        first.entry(key(job)).or_insert(job);
    }
    let list: Vec<(K, &Job)> = first.into_iter().collect();
    let made: Vec<(K, Shared<T>)> = list
        .into_par_iter()
        .with_max_len(1)
        .map(|(key, job)| {
            let made = if stop.is_asked() {
                Err("not prepared: the run was stopped".to_owned())
            } else {
                guarded(|| make(job))
            };
            (key, made.map(Arc::new))
        })
        .collect();
    made.into_iter().collect()
}

fn shared<K: Ord, T>(map: &BTreeMap<K, Shared<T>>, key: &K) -> Shared<T> {
    map.get(key)
        .cloned()
        .unwrap_or_else(|| Err("program error: not prepared".to_owned()))
}

fn text(error: impl ToString) -> String {
    error.to_string()
}

fn model(job: &Job) -> Model {
    job.analysis.spec.model.into()
}

fn module_key(job: &Job) -> ModuleKey {
    (model(job), job.bridge.module_key.clone())
}

fn bridge_key(job: &Job) -> BridgeKey {
    (model(job), job.bridge.structure_key.clone())
}

fn damping_key(job: &Job) -> DampingKey {
    let spec = job.analysis.spec.damping.unwrap_or_default();
    (
        bridge_key(job),
        spec.ratio.to_bits(),
        spec.frequencies_hz.map(|f| f.map(f64::to_bits)),
    )
}

fn crossing_key(job: &Job) -> CrossingKey {
    let bits = |x: Option<f64>| x.unwrap_or_default().to_bits();
    let spec = &job.analysis.spec;
    let scheme = [
        bits(spec.time_step_s.map(TimeStepSpec::seconds)),
        bits(spec.spectral_radius),
    ];
    (damping_key(job), scheme, [spec.newton_limit, spec.bisection_limit])
}

fn operator_key(job: &Job) -> OperatorKey {
    (
        bridge_key(job),
        job.analysis.spec.operator_tolerance.unwrap_or_default().to_bits(),
    )
}

fn creeping_key(job: &Job) -> CreepingKey {
    let gaps = job
        .gaps_m()
        .map(|(tension, compression)| (tension.to_bits(), compression.to_bits()));
    (bridge_key(job), job.vehicle.key.clone(), gaps, job.load_n.to_bits())
}
