//! Crossing jobs to their records: by the operator side by side, or by the reference solver one by one.
//!
//! Knows which number of a response fills which field of a record, and when a time step has been halved enough. Does not know
//! columns, or how a crossing is stepped.

use super::dead_rows::{dead_rows, freeboard_rows, lowest};
use super::demands::Demands;
use super::failure::{JobFailure, too_many_steps};
use super::joint_rows::Rounding;
use super::quantity_words::quantity_word;
use super::retry::RETRY_STEP_SHARE;
use super::shared_models::SharedModels;
use pontoon_core::analysis::AnalysisError;
use pontoon_core::analysis::crossing::{Crossing, OperatorSolver, REFINEMENTS};
use pontoon_core::bridge::BridgeDesign;
use pontoon_core::response::{
    AtPeak, BankPeaks, CrossingResponse, DeadState, ForcePeaks, JointPeaks, MotionPeaks, Peak, PlacePeaks,
    PositionPeaks, Record, Recorded, Subject, WheelPeaks,
};
use pontoon_core::traffic::Traffic;
use pontoon_core::vehicle::Patch;
use pontoon_plan::job::{CrossingJob, Job, body_word};
use pontoon_plan::study_file::PeakColumn;
use pontoon_results::{
    AtPeakRow, BankRow, BodyRow, ConnectorRow, Extreme, Failure, FailureKind, HistoryRows, HistorySeries, JobRecord,
    NumberPlace, PinRow, PlaceRow, PositionRow, SectionRow, Summary, WheelRow,
};
use std::sync::Arc;

/// A job's record or why it failed.
pub(super) type JobResult = Result<JobRecord, JobFailure>;

/// Solves a crossing by the reference solver.
pub(super) fn solve(crossing: &CrossingJob<'_>, record: Record, models: &SharedModels) -> JobResult {
    let (response, _) = integrated(crossing, record, models)?;
    recorded(crossing, response, models)
}

/// Solves a crossing that failed once more at half its time step.
pub(super) fn again_at_half_step(
    crossing: &CrossingJob<'_>,
    record: Record,
    models: &SharedModels,
    failed: &JobFailure,
) -> JobResult {
    let half = crossing.first_time_step_s() * RETRY_STEP_SHARE;
    crossing.check_steps(half).map_err(|beyond| {
        let behind = format!("; at half the time step: {}", too_many_steps(beyond).text);
        JobFailure::from(failed.failure.clone().said("", &behind))
    })?;
    let dead = models.dead(crossing.job)?;
    let (traffic, input) = (crossing.traffic(), crossing.input(record, dead));
    let again = if crossing.operator_tolerance().is_some() {
        let mut answers = models.operated(crossing)?.solve_all(&[(&traffic, &input)], 1);
        answers.pop().ok_or_else(|| JobFailure::of_program("no answer"))?
    } else {
        models.crossing_at_half_step(crossing)?.solve(&traffic, &input)
    };
    let again = again.map_err(|error| {
        let behind = format!("; at half the time step: {error}");
        JobFailure::from(failed.failure.clone().said("", &behind))
    })?;
    let mut record = recorded(crossing, again, models)?;
    record.retried = Some(failed.failure.clone());
    Ok(record)
}

/// Solves crossings that share a solver by the operator.
pub(super) fn solve_lane_batch(lane_batch: &[(CrossingJob<'_>, Record)], models: &SharedModels) -> Vec<JobResult> {
    let answers = operated(lane_batch, models).into_iter();
    let record = |((crossing, _), answer): (&(CrossingJob<'_>, Record), Result<SteppedResponse, JobFailure>)| {
        let (response, time_step_s) = answer?;
        let mut record = recorded(crossing, response, models)?;
        record.summary.time_step_s = time_step_s;
        Ok(record)
    };
    lane_batch.iter().zip(answers).map(record).collect()
}

/// The responses of crossings that share a solver, by the operator.
pub(super) fn operated(
    lane_batch: &[(CrossingJob<'_>, Record)],
    models: &SharedModels,
) -> Vec<Result<SteppedResponse, JobFailure>> {
    let Some((first, _)) = lane_batch.first() else {
        return Vec::new();
    };
    let solver = match models.operated(first) {
        Ok(solver) => solver,
        Err(failure) => return lane_batch.iter().map(|_| Err(failure.clone())).collect(),
    };
    // one whose bridge has no dead state fails alone
    let inputs: Vec<Result<Crossing, JobFailure>> = lane_batch
        .iter()
        .map(|(crossing, record)| Ok(crossing.input(record.clone(), models.dead(crossing.job)?)))
        .collect();
    let started = lane_batch.iter().zip(&inputs);
    let started: Vec<(&CrossingJob<'_>, &Crossing)> = started
        .filter_map(|((crossing, _), input)| Some((crossing, input.as_ref().ok()?)))
        .collect();
    let traffics: Vec<Traffic> = started.iter().map(|(crossing, _)| crossing.traffic()).collect();
    let asked: Vec<(&Traffic, &Crossing)> = traffics
        .iter()
        .zip(&started)
        .map(|(traffic, (_, input))| (traffic, *input))
        .collect();
    let answers = match first.analysis.time_step.tolerance() {
        Some(tolerance) => {
            let may_run = |place: usize, time_step_s: f64| {
                let (crossing, _) = started[place];
                crossing.check_steps(time_step_s).map_err(too_many_steps)
            };
            refined(&solver, &asked, tolerance, may_run)
        }
        None => {
            let plain = |answer: Result<CrossingResponse, AnalysisError>| Ok((answer?, None));
            solver.solve_all(&asked, 0).into_iter().map(plain).collect()
        }
    };
    let mut answers = answers.into_iter();
    let answer = |input: Result<Crossing, JobFailure>| {
        input?;
        answers
            .next()
            .unwrap_or_else(|| Err(JobFailure::of_program("no answer")))
    };
    inputs.into_iter().map(answer).collect()
}

/// The response of a crossing by the reference solver.
pub(super) fn integrated(
    crossing: &CrossingJob<'_>,
    record: Record,
    models: &SharedModels,
) -> Result<SteppedResponse, JobFailure> {
    let solver = models.crossing(crossing)?;
    let input = crossing.input(record, models.dead(crossing.job)?);
    Ok((solver.solve(&crossing.traffic(), &input)?, None))
}

/// A response and the time step that the program has found for it.
pub(super) type SteppedResponse = (CrossingResponse, Option<f64>);

/// Solves crossings at half the time step again and again, each until its peak force has settled: the last halving changed
/// it by no more than half the tolerance and the one before by no more than the tolerance. One small change alone may be
/// chance where contacts decide. One that may not run at a time step has no finer one.
fn refined(
    solver: &OperatorSolver,
    asked: &[(&Traffic, &Crossing)],
    tolerance: f64,
    may_run: impl Fn(usize, f64) -> Result<(), Failure>,
) -> Vec<Result<SteppedResponse, JobFailure>> {
    let mut answers: Vec<Option<Result<SteppedResponse, JobFailure>>> = vec![None; asked.len()];
    // peak force at the last step and by how much it had changed there
    let mut before = vec![(f64::NAN, f64::NAN); asked.len()];
    let mut open: Vec<usize> = (0..asked.len()).collect();
    for refinement in 0..=REFINEMENTS {
        let h = solver.time_step_s(refinement);
        open.retain(|&place| {
            let may = may_run(place, h);
            let beyond = may
                .err()
                .map(|failure| failure.said(&format!("at a time step of {h} s: "), ""));
            answers[place] = beyond.map(|failure| Err(failure.into()));
            answers[place].is_none()
        });
        let list: Vec<_> = open.iter().map(|&i| asked[i]).collect();
        let solved = solver.solve_all(&list, refinement);
        let mut next = Vec::new();
        for (place, answer) in open.into_iter().zip(solved) {
            let response = match answer {
                Ok(response) => response,
                // a smaller step may settle what this one did not
                Err(_) if refinement < REFINEMENTS => {
                    next.push(place);
                    continue;
                }
                Err(error) => {
                    answers[place] = Some(Err(JobFailure {
                        half_step_may_help: false,
                        ..error.into()
                    }));
                    continue;
                }
            };
            let peak = peak_force_n(&response);
            let (last, last_change) = before[place];
            let change = (peak - last).abs();
            if change <= 0.5 * tolerance * peak && last_change <= tolerance * peak {
                answers[place] = Some(Ok((response, Some(h))));
            } else if refinement == REFINEMENTS {
                answers[place] = Some(Err(not_settled(change / peak, h).into()));
            } else {
                before[place] = (peak, change);
                next.push(place);
            }
        }
        open = next;
    }
    let lost = || Err(JobFailure::of_program("no answer"));
    answers.into_iter().map(|answer| answer.unwrap_or_else(lost)).collect()
}

/// The peak force still changes by a share of itself at the finest time step `[s]`.
fn not_settled(share: f64, time_step_s: f64) -> Failure {
    let text = format!("peak force still changes by {share:.1e} of itself at a time step of {time_step_s} s");
    Failure::new(FailureKind::PeakForceNotSettled, text)
        .with("share", share)
        .with("time_step_s", time_step_s)
}

/// Largest force of any joint `[N]`.
fn peak_force_n(response: &CrossingResponse) -> f64 {
    let of_joint = response
        .joints
        .iter()
        .map(|j| j.sum.compression.value.max(j.sum.tension.value));
    of_joint.fold(0.0, f64::max)
}

fn recorded(crossing: &CrossingJob<'_>, response: CrossingResponse, models: &SharedModels) -> JobResult {
    let static_peaks_m = models.creeping_peaks_m(crossing.job)?;
    recorded_beside(crossing, response, static_peaks_m, models)
}

/// The record of a crossing beside what the same load does creeping.
pub(super) fn recorded_beside(
    crossing: &CrossingJob<'_>,
    response: CrossingResponse,
    static_peaks_m: Option<Arc<Vec<f64>>>,
    models: &SharedModels,
) -> JobResult {
    let job = crossing.job;
    let mut record = rows(
        (job, &crossing.traffic()),
        response,
        models.dead(job)?.as_deref(),
        static_peaks_m.as_deref().map(Vec::as_slice),
    );
    record.summary.step_warning = crossing.is_step_long();
    Ok(record)
}

fn extreme(peak: Peak) -> Extreme {
    Extreme::at(peak.value, peak.time_s)
}

/// The row of a force's peaks.
fn peaks_row(joint: usize, y_m: Option<f64>, peaks: &ForcePeaks) -> ConnectorRow {
    ConnectorRow {
        joint,
        y_m,
        compression: extreme(peaks.compression),
        tension: extreme(peaks.tension),
    }
}

fn position_row(peaks: &PositionPeaks, static_peak_deflection_m: Option<f64>) -> PositionRow {
    PositionRow {
        position: peaks.position,
        x_m: peaks.x_m,
        deflection: extreme(peaks.deflection),
        uplift: extreme(peaks.uplift),
        static_deflection_m: None,
        static_peak_deflection_m,
    }
}

/// The rows of a joint: the sum of its connectors, then each of them.
fn joint_rows(joint: &JointPeaks) -> impl Iterator<Item = ConnectorRow> {
    let each = joint
        .connectors
        .iter()
        .map(|(y_m, peaks)| peaks_row(joint.joint, Some(*y_m), peaks));
    std::iter::once(peaks_row(joint.joint, None, &joint.sum)).chain(each)
}

fn rows(
    (job, traffic): (&Job, &Traffic),
    mut response: CrossingResponse,
    dead: Option<&DeadState>,
    static_peaks_m: Option<&[f64]>,
) -> JobRecord {
    let positions: Vec<PositionRow> = (0..)
        .zip(&response.positions)
        .map(|(i, peaks): (usize, _)| position_row(peaks, static_peaks_m.map(|of| of[i])))
        .collect();
    let connectors: Vec<ConnectorRow> = response.joints.iter().flat_map(joint_rows).collect();
    let rounding = Rounding::of_peaks(&response.pins);
    let mut pins: Vec<PinRow> = response.pins.iter().map(|pin| rounding.pin_row(pin)).collect();
    let sections = response.recorded.sections.iter();
    let mut sections: Vec<SectionRow> = sections.map(|section| rounding.section_row(section)).collect();
    let demands = Demands {
        positions: &positions,
        connectors: &connectors,
        pins: &pins,
        sections: &sections,
        response: &response,
        dead,
    };
    let limits = demands.limit_rows(&job.shared.limits);
    // what limits alone have asked for
    if !job.shared.record.pins {
        pins.clear();
    }
    if !job.shared.record.sections {
        sections.clear();
    }
    let named = Named {
        design: &job.shared.bridge.design,
        traffic,
        places_x_m: &job.shared.record.places_x_m,
    };
    let static_peak_m = static_peaks_m.map(|peaks| peaks.iter().copied().fold(0.0, f64::max));
    let waves = job.shared.bridge.design.water.is_some();
    let mut summary = Summary {
        peak_edge_deflection_m: Some(response.peak_edge.value),
        peak_roll_rad: Some(response.peak_roll.value),
        peak_trim_rad: Some(response.peak_trim.value),
        static_peak_deflection_m: static_peak_m,
        bottom_emerged: response.bottom_emerged,
        deck_submerged: response.deck_submerged,
        contact_lost_s: response.recorded.contact_lost_s,
        min_contact_force_n: Some(response.least_contact.force_n).filter(|force| force.is_finite()),
        steps: Some(response.statistics.steps),
        newton_iterations: Some(response.statistics.newton_iterations),
        contact_switches: Some(response.statistics.contact_switches),
        energy_residual: Some(response.energy.energy_residual),
        numerical_dissipation: Some(response.energy.numerical_dissipation),
        radiated_energy_j: waves.then_some(response.energy.radiated_j),
        least_radiated_energy_j: waves.then_some(response.energy.least_radiated_j),
        ..Summary::default()
    };
    summary.take_peaks(&positions, &connectors);
    summary.take_joint_peaks(&pins, &sections);
    summary.take_limits(&limits);
    let freeboards = freeboard_rows(job, dead, &lowest(&response.recorded.corners));
    summary.take_freeboards(&freeboards);
    summary.dynamic_amplification = summary
        .peak_deflection_m
        .zip(static_peak_m.filter(|&peak| peak > 0.0))
        .map(|(moving, creeping)| moving / creeping);
    let recorded = &mut response.recorded;
    JobRecord {
        job: job.number,
        failure: None,
        retried: None,
        summary,
        positions,
        connectors,
        places: recorded.places.iter().map(place_row).collect(),
        banks: recorded.banks.iter().map(bank_row).collect(),
        dead: dead_rows(job, dead),
        freeboards,
        wheels: recorded.wheels.iter().map(wheel_row).collect(),
        bodies: recorded.motions.iter().map(body_row).collect(),
        at_peaks: recorded.at_peaks.iter().flat_map(|at| named.at_peak(at)).collect(),
        histories: named.histories(recorded),
        modes: Vec::new(),
        pins,
        sections,
        limits,
    }
}

/// What rows tell of the numbers of a bridge's response.
struct Named<'a> {
    design: &'a BridgeDesign,
    traffic: &'a Traffic,
    places_x_m: &'a [f64],
}

impl Named<'_> {
    fn patch(&self, vehicle: usize, wheel: usize) -> Option<&Patch> {
        self.traffic.vehicles.get(vehicle)?.vehicle.patches.get(wheel)
    }

    fn place(&self, subject: Subject) -> NumberPlace {
        let (x_m, y_m) = match subject {
            Subject::Place(index) => (self.places_x_m.get(index).copied(), None),
            Subject::Connector { index, .. } => (None, self.design.connectors.y_m.get(index).copied()),
            Subject::Pin { joint, index, .. } => (None, self.design.hinges_of(joint).y_m.get(index).copied()),
            Subject::Wheel { vehicle, wheel } => (None, self.patch(vehicle, wheel).map(|patch| patch.y_m)),
            Subject::Position(_) | Subject::Joint(_) | Subject::Section { .. } | Subject::Body { .. } => (None, None),
        };
        let (vehicle, axle) = match subject {
            Subject::Wheel { vehicle, wheel } => (
                Some(vehicle + 1),
                self.patch(vehicle, wheel).map(|patch| patch.axle + 1),
            ),
            Subject::Body { vehicle, .. } => (Some(vehicle + 1), None),
            _ => (None, None),
        };
        NumberPlace {
            quantity: quantity_word(subject.quantity()).to_owned(),
            position: subject.position(),
            vehicle,
            axle,
            x_m,
            y_m,
        }
    }

    fn histories(&self, recorded: &mut Recorded) -> HistoryRows {
        let histories = std::mem::take(&mut recorded.histories);
        let any_of_balance = histories.iter().any(|history| history.subject.is_of_balance());
        let series = histories.into_iter().map(|history| HistorySeries {
            of: self.place(history.subject),
            of_balance: history.subject.is_of_balance(),
            values: history.values,
        });
        HistoryRows {
            series: series.collect(),
            time_s: std::mem::take(&mut recorded.history_time_s),
            balance_time_s: if any_of_balance {
                std::mem::take(&mut recorded.balance_time_s)
            } else {
                Vec::new()
            },
        }
    }

    fn at_peak(&self, at: &AtPeak) -> Vec<AtPeakRow> {
        let row = |&(subject, value): &(Subject, f64)| AtPeakRow {
            at_peak_of: PeakColumn::word_of(at.peak.of).to_owned(),
            peak_at: at.peak.number,
            time_s: if subject.is_of_balance() {
                at.balance_s
            } else {
                at.time_s
            },
            of: self.place(subject),
            value: value + 0.0,
        };
        at.numbers.iter().map(row).collect()
    }
}

fn wheel_row(peaks: &WheelPeaks) -> WheelRow {
    let least = Extreme {
        value: Some(peaks.least.value).filter(|force| force.is_finite()),
        time_s: Some(peaks.least.time_s).filter(|_| peaks.least.value.is_finite()),
    };
    WheelRow {
        vehicle: peaks.vehicle + 1,
        axle: peaks.axle + 1,
        y_m: peaks.y_m,
        largest: extreme(peaks.largest),
        least,
        lost_s: Some(peaks.lost_s),
    }
}

fn body_row(peaks: &MotionPeaks) -> BodyRow {
    BodyRow {
        vehicle: peaks.vehicle + 1,
        quantity: body_word(peaks.motion).to_owned(),
        sides: [extreme(peaks.up), extreme(peaks.down)],
        acceleration: extreme(peaks.acceleration),
    }
}

fn bank_row(peaks: &BankPeaks) -> BankRow {
    BankRow {
        bank: peaks.bank,
        y_m: peaks.y_m,
        toward: extreme(peaks.force.tension),
        away: extreme(peaks.force.compression),
    }
}

fn place_row(peaks: &PlacePeaks) -> PlaceRow {
    PlaceRow {
        x_m: peaks.x_m,
        deflection: extreme(peaks.deflection),
        uplift: extreme(peaks.uplift),
        static_deflection_m: None,
    }
}
