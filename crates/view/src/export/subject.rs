//! What is exported: a bridge file or a job of results, and what is asked of it.
//!
//! Knows what can be asked of which, and refuses the rest. Does not know how anything is solved.

use super::{ExportError, LoadRequest, Request};
use pontoon_core::analysis::statics::{DeadCase, StaticCase};
use pontoon_core::bridge::{BridgeDesign, Model};
use pontoon_core::connector::Connection;
use pontoon_core::input::bound;
use pontoon_core::vehicle::{Vehicle, VehicleDesign};
use pontoon_plan::input::{Refusal, RefusalKind};
use pontoon_plan::job::{Candidates, CrossingJob, Job, Jobs, Task};
use pontoon_plan::study_file::{ModelSpec, Study, read_bridge};
use pontoon_results::{Results, Table};
use pontoon_study::run::RETRY_STEP_SHARE;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// Whether stresses are wanted beside the motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Stresses {
    Wanted,
    Unwanted,
}

/// Modes where nothing else is asked for.
const MODES: usize = 20;

/// What is exported.
#[derive(Debug)]
pub(super) struct Subject {
    /// The bridge file or the folder of results.
    pub source: PathBuf,
    /// The source in words.
    pub words: Value,
    /// The bridge.
    pub design: BridgeDesign,
    pub modes: Option<ModesWanted>,
    pub statics: Option<StaticWanted>,
    pub crossing: Option<CrossingWanted>,
    /// Whether stresses of the static case and the crossing are wanted.
    pub stresses: Stresses,
}

/// Modes that are wanted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct ModesWanted {
    pub model: Model,
    pub count: usize,
    pub supports: bool,
}

/// A static case that is wanted.
#[derive(Debug)]
pub(super) struct StaticWanted {
    pub model: Model,
    pub vehicle: Vehicle,
    /// Under it, where it has a dead load.
    pub dead: DeadCase,
    pub case: StaticCase,
}

/// A crossing that is wanted.
#[derive(Debug)]
pub(super) struct CrossingWanted {
    pub job: Job,
    pub every: Option<usize>,
    /// The time step that its answer in the table was found with `[s]`.
    pub time_step_s: f64,
}

impl CrossingWanted {
    /// The job as a crossing, which it is.
    ///
    /// # Errors
    /// [`ExportError::Refused`].
    pub(super) fn crossing(&self) -> Result<CrossingJob<'_>, ExportError> {
        let no_crossing = || Refusal::new(Path::new("job"), "", "no crossing", "a crossing");
        Ok(self.job.as_crossing().ok_or_else(no_crossing)?)
    }
}

impl Subject {
    /// Reads a source and checks what is asked of it.
    ///
    /// # Errors
    /// [`ExportError::Refused`], [`ExportError::Results`].
    pub(super) fn read(source: &Path, request: &Request) -> Result<Self, ExportError> {
        let subject = if source.is_dir() {
            Self::of_results(source, request)?
        } else {
            Self::of_bridge(source, request)?
        };
        if subject.modes.is_none() && subject.statics.is_none() && subject.crossing.is_none() {
            let allowed = "at least one mode, or a load";
            return Err(Refusal::new(source, "--count", "0 modes and no load", allowed).into());
        }
        if request.stresses && subject.statics.is_none() && subject.crossing.is_none() {
            let allowed =
                "a static case or a crossing with it (--load-n makes one): a mode shape has no size, and so no stress";
            return Err(Refusal::new(source, "--stresses", "modes alone", allowed).into());
        }
        Ok(subject)
    }

    fn of_bridge(source: &Path, request: &Request) -> Result<Self, ExportError> {
        let file = read_bridge(source)?;
        for (flag, given) in [("--job", request.job), ("--every", request.every)] {
            if let Some(given) = given {
                let allowed = "a folder of results with it: a bridge file has no jobs";
                return Err(Refusal::new(source, flag, given, allowed).into());
            }
        }
        let design = file.design;
        let of_design = |refused| Refusal::of(source, "", refused);
        let count = request.count.unwrap_or(MODES);
        let modes = (count > 0).then_some(ModesWanted {
            model: Model::Full,
            count,
            supports: request.supports,
        });
        let statics = match &request.load {
            Some(load) => {
                let vehicle = VehicleDesign::default()
                    .check(design.module.breadth_m)
                    .map_err(|refused| Refusal::of(source, "the vehicle of 3.35 m on two tracks", refused))?;
                Some(static_case(source, &design, vehicle, load)?)
            }
            None => None,
        };
        for model in [modes.map(|m| m.model), statics.as_ref().map(|s| s.model)]
            .into_iter()
            .flatten()
        {
            design.check_size(model).map_err(of_design)?;
        }
        Ok(Self {
            source: source.to_owned(),
            words: json!({ "bridge": design.name }),
            design,
            modes,
            statics,
            crossing: None,
            stresses: stresses_of(request),
        })
    }

    fn of_results(source: &Path, request: &Request) -> Result<Self, ExportError> {
        let results = Results::read(source)?;
        let (study, bridge) = (results.documents.study()?, results.documents.bridge()?);
        let study =
            Study::of_documents(source, study.clone(), bridge.clone())?.in_waters(results.documents.waters()?)?;
        let (job, row) = job_of(source, &results, &study, request.job)?;
        let Some(job) = Candidates::told_crossing(&study, &job, results.jobs().number("rated_value", row)) else {
            let refused = Refusal::new(source, "--job", job.number, "a rating that has a rated value");
            return Err(refused.into());
        };
        let modes = modes_of(&job, request);
        let crossing = job.as_crossing().map(|crossing| CrossingWanted {
            every: request.every,
            time_step_s: time_step_s(&crossing, results.jobs(), row),
            job: job.clone(),
        });
        if let (None, Some(every)) = (&crossing, request.every) {
            let allowed = "results of a study of crossings with it";
            return Err(Refusal::new(source, "--every", every, allowed).into());
        }
        let statics = static_of(source, &job, request)?;
        if let Some(modes) = modes {
            let size = job.shared.bridge.design.check_size(modes.model);
            size.map_err(|mut refused| {
                refused.allowed += ", or --count 0: no modes";
                Refusal::of(source, "bridge", refused)
            })?;
        }
        let design = job.shared.bridge.design.clone();
        Ok(Self {
            source: source.to_owned(),
            words: json!({ "study": study.name, "job": job.number, "bridge": design.name, "axes": axes(&results, &job) }),
            design,
            modes,
            statics,
            crossing,
            stresses: stresses_of(request),
        })
    }
}

fn stresses_of(request: &Request) -> Stresses {
    if request.stresses {
        Stresses::Wanted
    } else {
        Stresses::Unwanted
    }
}

/// The job that is asked for, or the one with the largest deflection, and its row in the table of jobs.
fn job_of(source: &Path, results: &Results, study: &Study, asked: Option<usize>) -> Result<(Job, usize), Refusal> {
    let table = results.jobs();
    let number = match asked {
        Some(number) => number,
        None => largest(source, results)?,
    };
    let row = results.row_of_job(number as u64).ok_or_else(|| {
        let rows = table.rows();
        let allowed = format!("the number of a job, {rows} of which are there, from 0");
        Refusal::new(source, "--job", number, allowed)
    })?;
    if results.is_failed(row) {
        let reason = table.cell("reason", row);
        let found = format!("job {number}, which failed: {}", reason.word().unwrap_or("no reason"));
        return Err(Refusal::new(source, "--job", found, "a job that did not fail"));
    }
    let job = Jobs::new(study).find(|job| job.as_ref().map_or(true, |job| job.number == number));
    let job = job.transpose()?.ok_or_else(|| {
        let found = format!("no job {number} in the study of the results");
        let allowed = "results of a study that this version reads as the one that ran it did";
        Refusal::new(source, "", found, allowed)
    })?;
    Ok((job, row))
}

/// The modes that are asked for, of a job of modes those that it asks for.
fn modes_of(job: &Job, request: &Request) -> Option<ModesWanted> {
    let own = job.as_modes();
    let count = request.count.or(own.map(|own| own.count)).unwrap_or(MODES);
    (count > 0).then_some(ModesWanted {
        model: own.map_or(Model::Full, |own| own.model.into()),
        count,
        supports: request.supports || own.is_some_and(|own| own.supports),
    })
}

/// The static case that is asked for, or the job's own.
fn static_of(source: &Path, job: &Job, request: &Request) -> Result<Option<StaticWanted>, Refusal> {
    let (design, vehicle) = (&job.shared.bridge.design, &job.shared.vehicle.vehicle);
    match (&request.load, job.task) {
        (Some(load), Task::Static(_)) => {
            let allowed = "no load of its own with results of a static study: --job says which of its cases";
            let refused = Refusal::new(source, "--load-n", load.load_n, allowed);
            Err(refused.because(RefusalKind::Misplaced))
        }
        (None, Task::Static(load)) => Ok(Some(StaticWanted {
            model: job.model().into(),
            vehicle: vehicle.as_ref().clone(),
            case: StaticCase {
                connection: job.connection,
                connector_stiffness_n_m: design.connectors.stiffness_n_m,
                own_laws: job.laws_at_rest(),
                load_n: job.load_n,
                load_x_m: load.x_m,
                places_x_m: Vec::new(),
                dead: None,
            },
            dead: DeadCase::new(design, job.connection, job.laws_at_rest()),
        })),
        (Some(load), _) => static_case(source, design, vehicle.as_ref().clone(), load).map(Some),
        (None, _) => Ok(None),
    }
}

/// The values of a job's axes.
fn axes(results: &Results, job: &Job) -> Value {
    let axes = results.axes().into_iter();
    Value::Object(axes.map(|name| (name.clone(), job.column(&name).value())).collect())
}

/// The job with the largest deflection, the first of equals; of modes the first.
fn largest(source: &Path, results: &Results) -> Result<usize, Refusal> {
    let table = results.jobs();
    let mut best: Option<(f64, usize)> = None;
    for row in (0..table.rows()).filter(|row| !results.is_failed(*row)) {
        let peak = table.number("peak_deflection_m", row).unwrap_or_default();
        if best.is_none_or(|(most, _)| peak > most) {
            best = Some((peak, row));
        }
    }
    best.map(|(_, row)| results.job_of_row(row) as usize).ok_or_else(|| {
        let reason = (0..table.rows()).find_map(|row| table.cell("reason", row).word().map(str::to_owned));
        let found = match reason {
            Some(reason) => format!("failed jobs alone, the first of them: {reason}"),
            None => "no jobs".to_owned(),
        };
        Refusal::new(source, "", found, "results with a job that did not fail")
    })
}

/// The time step of a job's answer: the one that was found for it or its analysis's, or half of it where a reason says that
/// its contacts had not settled before.
fn time_step_s(crossing: &CrossingJob<'_>, table: &Table, row: usize) -> f64 {
    let stated_s = crossing.first_time_step_s();
    let own_s = table.number("time_step_s", row).unwrap_or(stated_s);
    if table.cell("reason", row).is_nothing() {
        own_s
    } else {
        RETRY_STEP_SHARE * own_s
    }
}

/// A static case of a bridge as it was asked for; on the super-element, which is exact in statics.
fn static_case(
    source: &Path,
    design: &BridgeDesign,
    vehicle: Vehicle,
    load: &LoadRequest,
) -> Result<StaticWanted, Refusal> {
    let refuse = |flag: &str, found: String, allowed: String| Refusal::new(source, flag, found, allowed);
    if !(load.load_n.is_finite() && load.load_n > 0.0) {
        let allowed = "a finite number above 0".to_owned();
        return Err(refuse("--load-n", load.load_n.to_string(), allowed));
    }
    let load_x_m = match (load.load_x_m, load.load_position) {
        (Some(x_m), None) if (0.0..=design.length_m()).contains(&x_m) => x_m,
        (Some(x_m), None) => {
            let allowed = format!("a number from 0 to {}", bound(design.length_m()));
            return Err(refuse("--load-x-m", x_m.to_string(), allowed));
        }
        (None, Some(position)) if (1..=design.positions()).contains(&position) => design.position_x_m(position),
        (None, Some(position)) => {
            let allowed = format!("a whole number from 1 to {}", design.positions());
            return Err(refuse("--load-position", position.to_string(), allowed));
        }
        (at, _) => {
            let found = if at.is_some() { "two places" } else { "no place" };
            let allowed = "--load-x-m or --load-position with it".to_owned();
            return Err(refuse("--load-n", found.to_owned(), allowed));
        }
    };
    let gap = |flag: &str, given: Option<f64>, own: f64| match given {
        Some(gap) if !(gap.is_finite() && gap >= 0.0) => {
            let allowed = "a finite number of at least 0".to_owned();
            Err(refuse(flag, gap.to_string(), allowed))
        }
        given => Ok(given.unwrap_or(own)),
    };
    let connectors = &design.connectors;
    let connection = Connection::Nonlinear {
        gap_tension_m: gap("--gap-tension-m", load.gap_tension_m, connectors.gap_tension_m)?,
        gap_compression_m: gap(
            "--gap-compression-m",
            load.gap_compression_m,
            connectors.gap_compression_m,
        )?,
    };
    let connection = if load.linear { Connection::Linear } else { connection };
    let of_bridge = |refused| Refusal::of(source, "", refused);
    design.check_held().map_err(of_bridge)?;
    let own_laws = design.own_laws(connection, None).map_err(of_bridge)?;
    Ok(StaticWanted {
        model: ModelSpec::SuperElement.into(),
        vehicle,
        dead: DeadCase::new(design, connection, own_laws.clone()),
        case: StaticCase {
            connection,
            connector_stiffness_n_m: connectors.stiffness_n_m,
            own_laws,
            load_n: load.load_n,
            load_x_m,
            places_x_m: Vec::new(),
            dead: None,
        },
    })
}
