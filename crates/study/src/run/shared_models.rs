//! What jobs share, prepared once: modules, bridges, damping, factored solvers, static peaks.
//!
//! Knows which jobs share what, by keys made of the jobs' own numbers. Does not know what a job does with it.

use super::cache::{Cache, CacheLookup};
use super::cancel::CancelToken;
use super::failure::JobFailure;
use super::finer::finer_analysis;
use super::guard::guarded;
use super::made_once::{SharedResult, each, not_prepared, shared};
use super::model_keys::{
    BridgeKey, CreepingKey, CrossingKey, DampingKey, DeadKey, LaneBatchKey, ModuleKey, OperatorKey, bridge_key,
    creeping_key, crossing_key, damping_key, dead_key, model, module_keys, operator_key, word,
};
use super::progress::{Progress, Silent};
use super::retry::RETRY_STEP_SHARE;
use pontoon_core::analysis::crossing::{CrossingSettings, CrossingSolver, OperatorSolver};
use pontoon_core::analysis::modes::{Rayleigh, bending_frequencies_hz};
use pontoon_core::analysis::statics::{DeadCase, StaticCase, StaticSolver};
use pontoon_core::bridge::{Bridge, Ends, Model, PreparedModule};
use pontoon_core::operator::{BridgeOperator, WaveStates};
use pontoon_core::response::DeadState;
use pontoon_core::stop::Stop;
use pontoon_plan::job::{CrossingJob, Job, Task};
use pontoon_plan::study_file::CrossingAnalysis;
use pontoon_plan::water_file::BridgeWater;
use pontoon_results::{BridgeReport, OperatorCounts, Preparation, WaterReport};
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Damping and where it came from.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Damping {
    /// Of Rayleigh's; none of the structure's own.
    frequencies_hz: Option<[f64; 2]>,
    coefficients: Rayleigh,
}

/// Modules prepared, to be handed on to a later run that needs some of them again.
#[derive(Debug, Clone, Default)]
pub struct PreparedModules(BTreeMap<ModuleKey, SharedResult<PreparedModule>>);

impl PreparedModules {
    /// Lets go of modules that none of some jobs needs.
    pub(super) fn keep_for(&mut self, jobs: &[&Job]) {
        self.0
            .retain(|key, _| jobs.iter().any(|job| module_keys(job).contains(key)));
    }
}

/// All that the jobs of a run share.
#[derive(Debug, Default)]
pub(super) struct SharedModels {
    modules: BTreeMap<ModuleKey, SharedResult<PreparedModule>>,
    bridges: BTreeMap<BridgeKey, SharedResult<Bridge>>,
    damping: BTreeMap<DampingKey, SharedResult<Damping>>,
    operators: BTreeMap<OperatorKey, SharedResult<BridgeOperator>>,
    operated: BTreeMap<LaneBatchKey, SharedResult<OperatorSolver>>,
    crossings: BTreeMap<CrossingKey, SharedResult<CrossingSolver>>,
    statics: BTreeMap<BridgeKey, SharedResult<StaticSolver>>,
    dead: BTreeMap<DeadKey, SharedResult<Option<Arc<DeadState>>>>,
    creeping: BTreeMap<CreepingKey, SharedResult<Vec<f64>>>,
    /// Whether nobody asks for static peaks.
    no_static_peaks: bool,
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

impl SharedModels {
    /// Prepares everything that `all` jobs need, each thing once, on the current pool; modules that are `known` are taken
    /// from there. What is not begun when a stop is asked for is not prepared.
    pub(super) fn prepare(
        all: &[&Job],
        known: &PreparedModules,
        cache: Option<&Cache>,
        cancel: &CancelToken,
        progress: &dyn Progress,
    ) -> Self {
        Self::prepare_after(all, &Self::of_modules(known), true, (cache, cancel), progress)
    }

    /// Prepares everything that `all` jobs need. What was prepared `before` is taken from there; what they do not need of it is
    /// left out. Static peaks of creeping loads are prepared where they are asked for.
    pub(super) fn prepare_after<'j>(
        all: &[&'j Job],
        before: &Self,
        static_peaks: bool,
        (cache, cancel): (Option<&Cache>, &CancelToken),
        progress: &dyn Progress,
    ) -> Self {
        let finer = |job: &&'j Job| Some((*job, finer_analysis(job)?));
        let finer: Vec<(&Job, CrossingAnalysis)> = all.iter().filter_map(finer).collect();
        Self::prepare_beside(all, &finer, (before, static_peaks), (cache, cancel), progress)
    }

    fn of_modules(known: &PreparedModules) -> Self {
        Self {
            modules: known.0.clone(),
            ..Self::default()
        }
    }

    /// None yet, and never static peaks.
    pub(super) fn without_static_peaks() -> Self {
        Self {
            no_static_peaks: true,
            ..Self::default()
        }
    }

    /// Takes over what another has and this has not, but for what failed there, and the static peaks and dead states, which
    /// are those of single loads and gaps.
    pub(super) fn keep(&mut self, other: &Self) {
        fn add<K: Ord + Clone, T>(own: &mut BTreeMap<K, SharedResult<T>>, other: &BTreeMap<K, SharedResult<T>>) {
            for (key, made) in other.iter().filter(|(_, made)| made.is_ok()) {
                own.entry(key.clone()).or_insert_with(|| made.clone());
            }
        }
        add(&mut self.modules, &other.modules);
        add(&mut self.bridges, &other.bridges);
        add(&mut self.damping, &other.damping);
        add(&mut self.operators, &other.operators);
        add(&mut self.operated, &other.operated);
        add(&mut self.crossings, &other.crossings);
        add(&mut self.statics, &other.statics);
    }

    /// Bridges and modules, of which each takes megabytes.
    pub(super) fn large_parts(&self) -> usize {
        self.modules.len() + self.bridges.len() + self.operated.len() + self.crossings.len()
    }

    /// Prepares what some candidates of a rating need, and nothing that judges them.
    pub(super) fn prepare_candidates(all: &[&Job], known: &PreparedModules) -> Self {
        let before = Self::of_modules(known);
        Self::prepare_beside(all, &[], (&before, true), (None, &CancelToken::default()), &Silent)
    }

    /// Prepares what all jobs need beyond what was prepared before, and operators of some for other analyses beside.
    fn prepare_beside(
        all: &[&Job],
        beside: &[(&Job, CrossingAnalysis)],
        (before, static_peaks): (&Self, bool),
        (cache, cancel): (Option<&Cache>, &CancelToken),
        progress: &dyn Progress,
    ) -> Self {
        let mut models = Self {
            no_static_peaks: !static_peaks,
            ..Self::default()
        };
        let crossings: Vec<CrossingJob<'_>> = all.iter().filter_map(|job| job.as_crossing()).collect();
        let judges = beside.iter().filter_map(|(job, analysis)| {
            let crossing = job.as_crossing()?;
            Some(CrossingJob { analysis, ..crossing })
        });
        let by_operator: Vec<CrossingJob<'_>> = crossings.iter().copied().chain(judges).collect();
        progress.stage("modules: finite elements, condensation");
        models.modules = models.all_modules(all, &before.modules, cancel);
        progress.stage("bridges: assembly");
        let loaded: Vec<&Job> = all.iter().copied().filter(|job| job.task != Task::Modes).collect();
        let bridge = |job: &&Job| Some(bridge_key(job));
        let damping = || {
            let key = |job: &CrossingJob<'_>| Some(damping_key(job));
            each(cancel, &crossings, &before.damping, key, |job| {
                models.damping_of(job, cancel)
            })
        };
        let bridges_and_operators = || {
            let bridges = each(cancel, &loaded, &before.bridges, bridge, |job| {
                models.bridge(job, Ends::Supported)
            });
            progress.stage("damping, operators: modes and what they leave out");
            let operator = |job: &CrossingJob<'_>| models.operator(job, &bridges, cache, cancel);
            let operators = each(cancel, &by_operator, &before.operators, operator_key, operator);
            (bridges, operators)
        };
        // damping has a bridge of its own, and the search for its modes runs on one thread
        ((models.bridges, models.operators), models.damping) = rayon::join(bridges_and_operators, damping);
        progress.stage("solvers: factors");
        let held: Vec<&Job> = loaded.iter().copied().filter(|job| is_held(job)).collect();
        models.statics = each(cancel, &held, &before.statics, bridge, |job| {
            Ok(StaticSolver::new(&shared(&models.bridges, &bridge_key(job))?)?)
        });
        let integrated =
            |crossing: &&CrossingJob<'_>| crossing.operator_tolerance().is_none() || crossing.verify().is_some();
        let judged: Vec<CrossingJob<'_>> = crossings.iter().filter(integrated).copied().collect();
        models.crossings = each(
            cancel,
            &judged,
            &before.crossings,
            |job| Some(crossing_key(job)),
            |job| models.crossing_solver(job),
        );
        models.operated = each(cancel, &by_operator, &before.operated, Self::lane_batch_key, |job| {
            models.operator_solver(job)
        });
        models.dead = models.dead_states(cancel, &loaded, &before.dead);
        progress.stage("static peaks of creeping loads");
        let creeping: Vec<&Job> = crossings
            .iter()
            .map(|crossing| crossing.job)
            .filter(|job| models.has_static_peak(job))
            .collect();
        models.creeping = models.creeping_peaks(cancel, &creeping, &before.creeping);
        models
    }

    fn all_modules<'j>(
        &self,
        all: &[&'j Job],
        known: &BTreeMap<ModuleKey, SharedResult<PreparedModule>>,
        cancel: &CancelToken,
    ) -> BTreeMap<ModuleKey, SharedResult<PreparedModule>> {
        let each_module = |job: &&'j Job| {
            let job: &'j Job = job;
            module_keys(job)
                .into_iter()
                .enumerate()
                .map(move |(variant, key)| (job, variant, key))
        };
        let all: Vec<(&Job, usize, ModuleKey)> = all.iter().flat_map(each_module).collect();
        let key = |(.., key): &(&Job, usize, ModuleKey)| Some(key.clone());
        each(cancel, &all, known, key, |(job, variant, _)| self.module(job, *variant))
    }

    fn module(&self, job: &Job, variant: usize) -> Result<PreparedModule, JobFailure> {
        let model = model(job);
        if model == Model::SuperElement {
            self.condensations.fetch_add(1, Ordering::Relaxed);
        }
        Ok(PreparedModule::new(
            &job.shared.bridge.design.variants().designs[variant],
            model,
        )?)
    }

    /// The modules of a job, in the order of its bridge's variants.
    fn modules_of(&self, job: &Job) -> Result<Vec<Arc<PreparedModule>>, JobFailure> {
        let keys = module_keys(job).into_iter();
        keys.map(|key| shared(&self.modules, &key)).collect()
    }

    /// Structural mass of a module of a job's bridge `[kg]`; of modules that are not alike the mean.
    pub(super) fn mean_mass_kg(&self, job: &Job) -> Result<f64, JobFailure> {
        let modules = self.modules_of(job)?;
        if let [only] = &modules[..] {
            return Ok(only.structural_mass_kg());
        }
        let of_module = job.shared.bridge.design.variants().of_module;
        let total: f64 = of_module.iter().map(|&of| modules[of].structural_mass_kg()).sum();
        Ok(total / of_module.len() as f64)
    }

    /// The bridge of a job, assembled anew.
    pub(super) fn bridge(&self, job: &Job, ends: Ends) -> Result<Bridge, JobFailure> {
        Ok(Bridge::of_kinds(
            &job.shared.bridge.design,
            &self.modules_of(job)?,
            ends,
        )?)
    }

    fn damping_of(&self, crossing: &CrossingJob<'_>, cancel: &CancelToken) -> Result<Damping, JobFailure> {
        let asked = || cancel.is_asked();
        let bending_hz = || {
            bending_frequencies_hz(&self.bridge(crossing.job, Ends::Free)?, Stop::when(&asked))
                .map_err(|e| JobFailure::from(e).said("damping: ", "; state analysis.damping.frequencies_hz"))
        };
        let (frequencies_hz, coefficients) = crossing.analysis.damping.coefficients(bending_hz)?;
        Ok(Damping {
            frequencies_hz,
            coefficients,
        })
    }

    /// The operator of a crossing, from the cache where it is there whole, else built and kept.
    fn operator(
        &self,
        crossing: &CrossingJob<'_>,
        bridges: &BTreeMap<BridgeKey, SharedResult<Bridge>>,
        cache: Option<&Cache>,
        cancel: &CancelToken,
    ) -> Result<BridgeOperator, JobFailure> {
        let (Some(tolerance), Some(key)) = (crossing.operator_tolerance(), operator_key(crossing)) else {
            return Err(JobFailure::of_program("an operator of the reference solver"));
        };
        let (bridge, made) = (shared(bridges, &key.bridge)?, &self.operators_made);
        let name = key.name();
        match cache.map_or(CacheLookup::Nothing, |cache| cache.read(&name, &bridge)) {
            CacheLookup::Whole(operator) => {
                made.from_cache.fetch_add(1, Ordering::Relaxed);
                return Ok(*operator);
            }
            CacheLookup::Refused => made.refused.fetch_add(1, Ordering::Relaxed),
            CacheLookup::Nothing => 0,
        };
        made.built.fetch_add(1, Ordering::Relaxed);
        let asked = || cancel.is_asked();
        let operator = BridgeOperator::new_unless(&bridge, tolerance, &key.followed(), Stop::when(&asked))?;
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

    fn operator_solver(&self, crossing: &CrossingJob<'_>) -> Result<OperatorSolver, JobFailure> {
        let bridge = shared(&self.bridges, &bridge_key(crossing.job))?;
        let operator = self.operator_of(crossing)?;
        Ok(OperatorSolver::new(&bridge, &operator, &self.settings(crossing)?))
    }

    fn operator_of(&self, crossing: &CrossingJob<'_>) -> SharedResult<BridgeOperator> {
        let key = operator_key(crossing).ok_or_else(not_prepared)?;
        shared(&self.operators, &key)
    }

    /// Crossings of one key are solved side by side; none of the reference solver's, which are solved one by one.
    pub(super) fn lane_batch_key(crossing: &CrossingJob<'_>) -> Option<LaneBatchKey> {
        let auto = crossing.analysis.time_step.tolerance().map(f64::to_bits);
        Some((crossing_key(crossing), operator_key(crossing)?, auto))
    }

    /// The operator's solver of a crossing.
    pub(super) fn operated(&self, crossing: &CrossingJob<'_>) -> SharedResult<OperatorSolver> {
        shared(
            &self.operated,
            &Self::lane_batch_key(crossing).ok_or_else(not_prepared)?,
        )
    }

    fn crossing_solver(&self, crossing: &CrossingJob<'_>) -> Result<CrossingSolver, JobFailure> {
        let bridge = shared(&self.bridges, &bridge_key(crossing.job))?;
        Ok(CrossingSolver::new(&bridge, &self.settings(crossing)?)?)
    }

    /// The reference solver of a crossing at half its time step, made anew.
    pub(super) fn crossing_at_half_step(&self, crossing: &CrossingJob<'_>) -> Result<CrossingSolver, JobFailure> {
        let mut settings = self.settings(crossing)?;
        settings.time_step_s *= RETRY_STEP_SHARE;
        let bridge = shared(&self.bridges, &bridge_key(crossing.job))?;
        Ok(CrossingSolver::new(&bridge, &settings)?)
    }

    fn settings(&self, crossing: &CrossingJob<'_>) -> Result<CrossingSettings, JobFailure> {
        let damping = shared(&self.damping, &damping_key(crossing))?;
        Ok(crossing.settings(damping.coefficients))
    }

    /// The static peaks of creeping loads; cases of one vehicle on one bridge share what it does at its places, which is let
    /// go before the next vehicle's.
    fn creeping_peaks(
        &self,
        cancel: &CancelToken,
        jobs: &[&Job],
        known: &BTreeMap<CreepingKey, SharedResult<Vec<f64>>>,
    ) -> BTreeMap<CreepingKey, SharedResult<Vec<f64>>> {
        let (old, new): (Vec<&Job>, Vec<&Job>) = jobs.iter().partition(|job| known.contains_key(&creeping_key(job)));
        let mut vehicles: BTreeMap<(BridgeKey, Arc<str>), Vec<&Job>> = BTreeMap::new();
        for job in new {
            let key = (bridge_key(job), job.shared.vehicle.key.clone());
            vehicles.entry(key).or_default().push(job);
        }
        let peaks = |((bridge, _), jobs): ((BridgeKey, _), Vec<&Job>)| {
            let load = guarded(|| Ok(shared(&self.statics, &bridge)?.creeping(&jobs[0].shared.vehicle.vehicle)));
            let key = |job: &&Job| Some(creeping_key(job));
            each(cancel, &jobs, known, key, |job| {
                let load = load.as_ref().map_err(Clone::clone)?;
                Ok(load.peaks_m(&static_case(job, 0.0, self.dead(job)?))?)
            })
        };
        let vehicles: Vec<_> = vehicles.into_iter().collect();
        let made: Vec<_> = vehicles.into_par_iter().with_max_len(1).map(peaks).collect();
        let old = old
            .into_iter()
            .filter_map(|job| known.get_key_value(&creeping_key(job)));
        let old = old.map(|(key, peaks)| (key.clone(), peaks.clone()));
        made.into_iter().flatten().chain(old).collect()
    }

    /// The dead states of bridges that are loaded before any vehicle comes.
    fn dead_states(
        &self,
        cancel: &CancelToken,
        jobs: &[&Job],
        known: &BTreeMap<DeadKey, SharedResult<Option<Arc<DeadState>>>>,
    ) -> BTreeMap<DeadKey, SharedResult<Option<Arc<DeadState>>>> {
        let loaded: Vec<&Job> = jobs
            .iter()
            .copied()
            .filter(|job| job.shared.bridge.design.has_dead_load())
            .collect();
        each(
            cancel,
            &loaded,
            known,
            |job| Some(dead_key(job)),
            |job| {
                let case = DeadCase::new(&job.shared.bridge.design, job.connection, job.laws_at_rest());
                Ok(shared(&self.statics, &bridge_key(job))?.dead_state(&case)?)
            },
        )
    }

    /// The state at rest from which a job's vehicle starts; none of a bridge without a dead load.
    pub(super) fn dead(&self, job: &Job) -> Result<Option<Arc<DeadState>>, JobFailure> {
        if !job.shared.bridge.design.has_dead_load() {
            return Ok(None);
        }
        shared(&self.dead, &dead_key(job)).map(|state| (*state).clone())
    }

    /// The reference solver of a crossing, made anew where it was not prepared.
    pub(super) fn crossing(&self, crossing: &CrossingJob<'_>) -> SharedResult<CrossingSolver> {
        match self.crossings.get(&crossing_key(crossing)) {
            Some(prepared) => prepared.clone(),
            None => self.crossing_solver(crossing).map(Arc::new),
        }
    }

    /// The solver of a static case.
    pub(super) fn statics(&self, job: &Job) -> SharedResult<StaticSolver> {
        shared(&self.statics, &bridge_key(job))
    }

    /// The largest static deflection of each position under the job's load over its places `[m]`; none where nothing linear
    /// holds the bridge.
    pub(super) fn creeping_peaks_m(&self, job: &Job) -> Result<Option<Arc<Vec<f64>>>, JobFailure> {
        if !self.has_static_peak(job) {
            return Ok(None);
        }
        shared(&self.creeping, &creeping_key(job))
            .map(Some)
            .map_err(|failure| failure.said("static peak: ", ""))
    }

    /// Whether a load can creep over the bridge of a job: something linear holds it.
    fn has_static_peak(&self, job: &Job) -> bool {
        !self.no_static_peaks
            && job.rating.is_none()
            && job.is_single()
            && is_held(job)
            && !self.statics(job).is_ok_and(|solver| solver.is_loose())
    }

    /// Whether all is there that a crossing is solved with.
    pub(super) fn holds(&self, crossing: &CrossingJob<'_>) -> bool {
        let solver = match Self::lane_batch_key(crossing) {
            Some(key) => self.operated.contains_key(&key),
            None => self.crossings.contains_key(&crossing_key(crossing)),
        };
        solver
            && (!crossing.job.shared.bridge.design.has_dead_load() || self.dead.contains_key(&dead_key(crossing.job)))
    }

    /// Whether a job can be solved with what is there, on one thread: a crossing by the operator at a stated time step, which
    /// nobody judges and of which no static peak is asked.
    pub(super) fn suffice(&self, job: &Job) -> bool {
        let holds = |crossing: &CrossingJob<'_>| {
            let is_plain = crossing.verify().is_none() && crossing.analysis.time_step.tolerance().is_none();
            is_plain && crossing.operator_tolerance().is_some() && self.holds(crossing)
        };
        self.no_static_peaks && job.rating.is_none() && job.as_crossing().as_ref().is_some_and(holds)
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
            if !seen.insert((job.shared.bridge.id, job.shared.analysis.id)) {
                continue;
            }
            let modules = self.modules_of(job).ok();
            let largest = |size: fn(&PreparedModule) -> usize| {
                let sizes = modules.iter().flatten().map(|module| size(module));
                sizes.max()
            };
            let crossing = job.as_crossing();
            let damping = crossing.and_then(|crossing| shared(&self.damping, &damping_key(&crossing)).ok());
            let operator = crossing.and_then(|crossing| self.operator_of(&crossing).ok());
            let solver = crossing.and_then(|crossing| self.operated(&crossing).ok());
            let waves = operator.as_ref().and_then(|operator| operator.wave_states());
            let operator = operator.map(|operator| operator.cutoff());
            let report = BridgeReport {
                blake3: job.shared.bridge.hash.clone(),
                name: job.shared.bridge.design.name.clone(),
                model: word(model(job)).to_owned(),
                modules: job.shared.bridge.design.modules,
                module_full_dofs: largest(PreparedModule::full_dofs),
                module_dofs: largest(PreparedModule::dofs),
                structural_mass_kg: self.mean_mass_kg(job).ok(),
                dofs: shared(&self.bridges, &bridge_key(job)).ok().map(|b| b.dofs()),
                damping_frequencies_hz: damping.as_ref().and_then(|d| d.frequencies_hz),
                damping_stiffness_s: damping.as_ref().map(|d| d.coefficients.a),
                damping_mass_1_s: damping.as_ref().map(|d| d.coefficients.b),
                operator_modes: operator.map(|o| o.modes),
                operator_cutoff_hz: operator.map(|o| o.frequency_hz),
                operator_tolerance: operator.map(|o| o.tolerance),
                operator_error: operator.map(|o| o.error),
                one_side_modes: solver.and_then(|solver| solver.one_side_modes()),
                water: job
                    .shared
                    .bridge
                    .water
                    .as_ref()
                    .map(|water| water_report(job, water, waves)),
            };
            if !reports.contains(&report) {
                reports.push(report);
            }
        }
        reports
    }
}

/// What is told of the water with memory under a job's bridge.
fn water_report(job: &Job, water: &BridgeWater, states: Option<WaveStates>) -> WaterReport {
    let spec = job.shared.bridge.design.water.as_ref();
    let accepts = |name: &str| spec.is_some_and(|spec| spec.accept.iter().any(|own| own == name));
    let accepted = water.judged.refused().filter(|check| accepts(check.check));
    WaterReport {
        name: water.name.clone(),
        file: spec.map_or_else(String::new, |spec| spec.file.clone()),
        blake3: water.blake3.clone(),
        depth_m: water.depth_m,
        infinite_heave_kg_m: water.judged.infinite_heave_kg_m,
        memory_heave_n_m2: water.judged.memory_heave_n_m2,
        accepted: accepted.map(|check| (check.check.to_owned(), check.figure)).collect(),
        states: states.map(|states| states.real_states),
        kernel_error: states.map(|states| states.kernel_error),
        passivity: states.map(|states| states.least_over_largest),
    }
}

/// The static case of a job with its load at a place.
pub(super) fn static_case(job: &Job, load_x_m: f64, dead: Option<Arc<DeadState>>) -> StaticCase {
    StaticCase {
        connection: job.connection,
        connector_stiffness_n_m: job.shared.bridge.design.connectors.stiffness_n_m,
        own_laws: job.laws_at_rest(),
        load_n: job.load_n,
        load_x_m,
        places_x_m: job.shared.record.places_x_m.clone(),
        dead,
    }
}

/// Whether the bridge of a job has static cases.
fn is_held(job: &Job) -> bool {
    job.shared.bridge.design.check_held().is_ok()
}
