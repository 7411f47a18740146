//! The bridge under a vehicle: a static case, and a crossing over time.
//!
//! Knows which instants of a crossing are shown. Does not know the format.

use super::pictures::Pictures;
use super::ready::Ready;
use super::series::Series;
use super::stresses::StressEnvelope;
use super::subject::{CrossingWanted, StaticWanted, Stresses, Subject};
use super::vtk::{Array, Counter, VtkGrid, VtkValues};
use super::whole::WholeFolder;
use super::{ExportError, Part, check_size};
use pontoon_core::analysis::crossing::CrossingSettings;
use pontoon_core::analysis::snapshot::Snapshot;
use pontoon_core::analysis::statics::{DeadCase, StaticCase, StaticSolver};
use pontoon_core::bridge::{BridgeStresses, Ends};
use pontoon_core::response::Record;
use pontoon_plan::input::Refusal;
use pontoon_study::run::{RETRY_STEP_SHARE, half_step_may_help};

/// Instants of a crossing in a second, where nothing else is asked for.
const INSTANTS_A_SECOND: f64 = 20.0;

/// The series of a loaded bridge.
struct LoadedSeries {
    mesh: Series,
    joints: Series,
    vehicle: Series,
}

impl LoadedSeries {
    fn of_statics() -> Self {
        Self {
            mesh: Series::new("static", "static case: the mesh", 1),
            joints: Series::new("static-joints", "static case: connectors and hinges", 1),
            vehicle: Series::new("static-vehicle", "static case: the vehicle's points", 1),
        }
    }

    fn of_crossing(most: usize) -> Self {
        Self {
            mesh: Series::new("crossing", "crossing over time: the mesh", most),
            joints: Series::new("crossing-joints", "crossing over time: connectors and hinges", most),
            vehicle: Series::new("crossing-vehicle", "crossing over time: the vehicle's points", most),
        }
    }

    fn write(
        &mut self,
        folder: &mut WholeFolder,
        time_s: f64,
        [mesh, joints, vehicle]: [VtkGrid; 3],
    ) -> Result<(), ExportError> {
        let name = format!("{time_s:.3} s");
        self.mesh.write(folder, time_s, &name, &mesh)?;
        self.joints.write(folder, time_s, &name, &joints)?;
        self.vehicle.write(folder, time_s, &name, &vehicle)
    }

    fn finish(self, folder: &mut WholeFolder, peak_deflection_m: f64) -> Result<[Part; 3], ExportError> {
        Ok([
            self.joints.finish(folder, None)?,
            self.vehicle.finish(folder, None)?,
            self.mesh.finish(folder, Some(peak_deflection_m))?,
        ])
    }
}

/// The three grids of a state, whose stresses are those of the mesh.
fn grids(pictures: &Pictures, ready: &Ready, state: &Snapshot, stresses: Option<&BridgeStresses>) -> [VtkGrid; 3] {
    let displacement_m = ready.meshed.displacement_m(&state.u);
    let time = || vec![Array::new("time_s", VtkValues::F64(vec![state.time_s]))];
    [
        pictures.mesh(&displacement_m, stresses, time()),
        pictures.joints(ready, state, &displacement_m, time()),
        Pictures::vehicle(ready, state, &displacement_m, time()),
    ]
}

/// Writes a static case.
///
/// # Errors
/// [`ExportError`].
pub(super) fn statics(
    subject: &Subject,
    wanted: &StaticWanted,
    folder: &mut WholeFolder,
) -> Result<[Part; 3], ExportError> {
    let ready = Ready::new(&subject.design, wanted.model, Ends::Supported, subject.stresses)?;
    let solver = StaticSolver::new(&ready.bridge)?;
    let case = StaticCase {
        dead: solver.dead_state(&wanted.dead)?,
        ..wanted.case.clone()
    };
    let state = solver.state(&wanted.vehicle, &case)?;
    let peak = solver
        .solve(&wanted.vehicle, &case)?
        .deflection_m
        .into_iter()
        .fold(0.0, f64::max);
    let mut shown = LoadedSeries::of_statics();
    let stresses = ready.stresses(&state);
    shown.write(
        folder,
        0.0,
        grids(&Pictures::of(&ready), &ready, &state, stresses.as_ref()),
    )?;
    shown.finish(folder, peak)
}

/// Writes a crossing, solved by the reference solver; where its contacts do not settle, once more at half the time step, as a
/// run does.
///
/// # Errors
/// [`ExportError`].
pub(super) fn crossing(
    subject: &Subject,
    wanted: &CrossingWanted,
    folder: &mut WholeFolder,
    note: &dyn Fn(&str),
) -> Result<Vec<Part>, ExportError> {
    let (ready, settings) = Ready::of_crossing(wanted, subject.stresses)?;
    let default = (1.0 / (INSTANTS_A_SECOND * settings.time_step_s)).round().max(1.0);
    let every = wanted.every.unwrap_or(default as usize);
    if every == 0 {
        let allowed = "a whole number of at least 1";
        return Err(Refusal::new(&subject.source, "--every", every, allowed).into());
    }
    let passage = Passage {
        subject,
        wanted,
        ready: &ready,
        note,
    };
    let unsettled = |error: &ExportError| matches!(error, ExportError::Analysis(error) if half_step_may_help(error));
    match passage.write(&settings, every, folder) {
        Err(error) if unsettled(&error) => {
            note(&format!("{error}: once more at half the time step"));
            folder.clear();
            let half = CrossingSettings {
                time_step_s: RETRY_STEP_SHARE * settings.time_step_s,
                ..settings
            };
            passage.write(&half, every.saturating_mul(2), folder)
        }
        other => other,
    }
}

struct Passage<'a> {
    subject: &'a Subject,
    wanted: &'a CrossingWanted,
    ready: &'a Ready,
    note: &'a dyn Fn(&str),
}

impl Passage<'_> {
    /// Writes the state before the first step, after each `every` steps, and after the last; of stresses, where they are
    /// wanted, also the envelope over all steps.
    fn write(
        &self,
        settings: &CrossingSettings,
        every: usize,
        folder: &mut WholeFolder,
    ) -> Result<Vec<Part>, ExportError> {
        let pictures = Pictures::of(self.ready);
        let solver = self.ready.solver(settings)?;
        let crossing = self.wanted.crossing()?;
        let job = crossing.job;
        let mut dead = None;
        if job.shared.bridge.design.has_dead_load() {
            let case = DeadCase::new(&job.shared.bridge.design, job.connection, job.laws_at_rest());
            dead = StaticSolver::new(&self.ready.bridge)?.dead_state(&case)?;
        }
        let input = crossing.input(Record::default(), dead);
        let traffic = crossing.traffic();
        let mut under = solver.begin(&traffic, &input);
        let steps = under.steps();
        let instants = 1 + steps.div_ceil(every);
        let mut envelope = StressEnvelope::default();
        let state = under.snapshot();
        let at_rest = grids(
            &pictures,
            self.ready,
            &state,
            self.looked_at(&state, &mut envelope).as_ref(),
        );
        let mut size = Counter::default();
        for grid in &at_rest {
            // counting cannot fail
            let _ = grid.write(&mut size);
        }
        let found = format!(
            "{instants} instants of a crossing, one every {every} steps of {} s",
            settings.time_step_s
        );
        let whole = [3 * instants as u64, instants as u64 * size.0];
        check_size(self.subject, ("--every", found), whole, self.note)?;
        let mut shown = LoadedSeries::of_crossing(instants);
        shown.write(folder, state.time_s, at_rest)?;
        let mut taken = 0;
        while under.step()? {
            taken += 1;
            let is_shown = taken % every == 0 || taken == steps;
            if !is_shown && self.subject.stresses == Stresses::Unwanted {
                continue;
            }
            let state = under.snapshot();
            let stresses = self.looked_at(&state, &mut envelope);
            if is_shown {
                let grids = grids(&pictures, self.ready, &state, stresses.as_ref());
                shown.write(folder, state.time_s, grids)?;
            }
        }
        let mut parts = Vec::from(shown.finish(folder, under.finish().peak_deflection().deflection.value)?);
        if self.subject.stresses == Stresses::Wanted {
            parts.push(self.envelope(&pictures, &envelope, folder)?);
        }
        Ok(parts)
    }

    /// The stresses of a state, where they are wanted, also to the envelope.
    fn looked_at(&self, state: &Snapshot, envelope: &mut StressEnvelope) -> Option<BridgeStresses> {
        let stresses = self.ready.stresses(state)?;
        envelope.look_at(state.time_s, &stresses);
        Some(stresses)
    }

    fn envelope(
        &self,
        pictures: &Pictures,
        envelope: &StressEnvelope,
        folder: &mut WholeFolder,
    ) -> Result<Part, ExportError> {
        let shows = format!(
            "crossing: largest von Mises stress of each shell at {} time steps",
            envelope.states()
        );
        let mut series = Series::new("crossing-envelope", shows, 1);
        series.write(folder, 0.0, "all time steps", &pictures.envelope(envelope))?;
        series.finish(folder, None)
    }
}
