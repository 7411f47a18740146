//! Crossing jobs to their records: by the operator side by side, or by the reference solver one by one.
//!
//! Knows which number of a response fills which field of a record, and when a time step has been halved enough. Does not know
//! columns, or how a crossing is stepped.

use super::bench::Bench;
use super::retry::half_step_may_help;
use pontoon_core::analysis::AnalysisError;
use pontoon_core::analysis::crossing::{Crossing, OperatorSolver, REFINEMENTS};
use pontoon_core::response::{CrossingResponse, ForcePeaks, Peak, Quantity, Record};
use pontoon_core::vehicle::Vehicle;
use pontoon_plan::job::Job;
use pontoon_plan::study_file::TimeStepSpec;
use pontoon_results::{ConnectorRow, Extreme, HistoryRows, JobRecord, PositionRow, Summary};

/// Why a job failed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Failure {
    /// In words.
    pub reason: String,
    /// Whether half the time step may help.
    pub half_step_may_help: bool,
}

impl From<String> for Failure {
    fn from(reason: String) -> Self {
        Self {
            reason,
            half_step_may_help: false,
        }
    }
}

impl From<AnalysisError> for Failure {
    fn from(error: AnalysisError) -> Self {
        Self {
            half_step_may_help: half_step_may_help(&error),
            reason: error.to_string(),
        }
    }
}

/// A job's record or why it failed.
pub(super) type Solved = Result<JobRecord, Failure>;

/// Solves the crossing of a job by the reference solver.
pub(super) fn solve(job: &Job, record: Record, bench: &Bench) -> Solved {
    let solved = bench.crossing(job)?.solve(&job.vehicle.vehicle, &job.crossing(record));
    Ok(recorded(job, solved?, bench)?)
}

/// Solves a crossing that failed once more at half its time step.
pub(super) fn again_at_half_step(job: &Job, record: Record, bench: &Bench, failure: &Failure) -> Solved {
    let (vehicle, crossing) = (&job.vehicle.vehicle, job.crossing(record));
    let again = if job.by_operator() {
        let mut answers = bench.operated(job)?.solve_all(&[(vehicle, &crossing)], 1);
        answers.pop().ok_or_else(|| "program error: no answer".to_owned())?
    } else {
        bench.crossing_at_half_step(job)?.solve(vehicle, &crossing)
    };
    let again = again.map_err(|error| format!("{}; at half the time step: {error}", failure.reason))?;
    let mut record = recorded(job, again, bench)?;
    record.summary.retried = Some(format!("at half the time step; at its own: {}", failure.reason));
    Ok(record)
}

/// Solves crossings that share a solver by the operator.
pub(super) fn solve_crew(crew: &[(&Job, Record)], bench: &Bench) -> Vec<Solved> {
    let Some((first, _)) = crew.first() else {
        return Vec::new();
    };
    let solver = match bench.operated(first) {
        Ok(solver) => solver,
        Err(reason) => return crew.iter().map(|_| Err(reason.clone().into())).collect(),
    };
    let crossings: Vec<Crossing> = crew.iter().map(|(job, record)| job.crossing(record.clone())).collect();
    let asked: Vec<(&Vehicle, &Crossing)> = crew
        .iter()
        .zip(&crossings)
        .map(|((job, _), crossing)| (&job.vehicle.vehicle, crossing))
        .collect();
    let auto = matches!(first.analysis.spec.time_step_s, Some(TimeStepSpec::Auto(_)));
    let answers = if auto {
        let tolerance = first.analysis.spec.time_step_tolerance.unwrap_or_default();
        refined(&solver, &asked, tolerance)
    } else {
        let plain = |answer: Result<CrossingResponse, AnalysisError>| Ok((answer?, None));
        solver.solve_all(&asked, 0).into_iter().map(plain).collect()
    };
    let record = |((job, _), answer): (&(&Job, Record), Result<Answer, Failure>)| {
        let (response, time_step_s) = answer?;
        let mut record = recorded(job, response, bench)?;
        record.summary.time_step_s = time_step_s;
        Ok(record)
    };
    crew.iter().zip(answers).map(record).collect()
}

/// A response and the time step that the program has found for it.
type Answer = (CrossingResponse, Option<f64>);

/// Solves crossings at half the time step again and again, each until its peak force has settled: the last halving changed
/// it by no more than half the tolerance and the one before by no more than the tolerance. One small change alone may be
/// chance where contacts decide.
fn refined(solver: &OperatorSolver, asked: &[(&Vehicle, &Crossing)], tolerance: f64) -> Vec<Result<Answer, Failure>> {
    let mut answers: Vec<Option<Result<Answer, Failure>>> = vec![None; asked.len()];
    // peak force at the last step and by how much it had changed there
    let mut before = vec![(f64::NAN, f64::NAN); asked.len()];
    let mut open: Vec<usize> = (0..asked.len()).collect();
    for refinement in 0..=REFINEMENTS {
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
                    answers[place] = Some(Err(error.to_string().into()));
                    continue;
                }
            };
            let (peak, h) = (peak_force_n(&response), solver.time_step_s(refinement));
            let (last, last_change) = before[place];
            let change = (peak - last).abs();
            if change <= 0.5 * tolerance * peak && last_change <= tolerance * peak {
                answers[place] = Some(Ok((response, Some(h))));
            } else if refinement == REFINEMENTS {
                let share = change / peak;
                let reason = format!("peak force still changes by {share:.1e} of itself at a time step of {h} s");
                answers[place] = Some(Err(reason.into()));
            } else {
                before[place] = (peak, change);
                next.push(place);
            }
        }
        open = next;
    }
    let lost = || Err("program error: no answer".to_owned().into());
    answers.into_iter().map(|answer| answer.unwrap_or_else(lost)).collect()
}

/// Largest force of any joint `[N]`.
fn peak_force_n(response: &CrossingResponse) -> f64 {
    let of_joint = response
        .joints
        .iter()
        .map(|j| j.sum.compression.value.max(j.sum.tension.value));
    of_joint.fold(0.0, f64::max)
}

fn recorded(job: &Job, response: CrossingResponse, bench: &Bench) -> Result<JobRecord, String> {
    let static_peaks_m = bench.creeping_peaks_m(job)?;
    Ok(rows(job.number, response, static_peaks_m.as_deref().map(Vec::as_slice)))
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

fn rows(job: usize, response: CrossingResponse, static_peaks_m: Option<&[f64]>) -> JobRecord {
    let static_peak_m = static_peaks_m.map(|peaks| peaks.iter().copied().fold(0.0, f64::max));
    let positions: Vec<PositionRow> = response
        .positions
        .iter()
        .enumerate()
        .map(|(i, p)| PositionRow {
            position: p.position,
            x_m: p.x_m,
            deflection: extreme(p.deflection),
            uplift: extreme(p.uplift),
            static_deflection_m: None,
            static_peak_deflection_m: static_peaks_m.map(|peaks| peaks[i]),
        })
        .collect();
    let mut connectors = Vec::new();
    for joint in &response.joints {
        connectors.push(peaks_row(joint.joint, None, &joint.sum));
        connectors.extend(
            joint
                .connectors
                .iter()
                .map(|(y_m, peaks)| peaks_row(joint.joint, Some(*y_m), peaks)),
        );
    }
    let mut summary = Summary {
        peak_edge_deflection_m: Some(response.peak_edge_deflection_m),
        peak_roll_rad: Some(response.peak_roll_rad),
        static_peak_deflection_m: static_peak_m,
        bottom_emerged: response.bottom_emerged,
        deck_submerged: response.deck_submerged,
        min_contact_force_n: Some(response.min_contact_force_n).filter(|force| force.is_finite()),
        steps: Some(response.statistics.steps),
        newton_iterations: Some(response.statistics.newton_iterations),
        contact_switches: Some(response.statistics.contact_switches),
        energy_residual: Some(response.energy.energy_residual),
        numerical_dissipation: Some(response.energy.numerical_dissipation),
        ..Summary::default()
    };
    summary.take_peaks(&positions, &connectors);
    summary.dynamic_amplification = summary
        .peak_deflection_m
        .zip(static_peak_m.filter(|&peak| peak > 0.0))
        .map(|(moving, creeping)| moving / creeping);
    let series = response.histories.into_iter().map(|history| {
        let quantity = match history.quantity {
            Quantity::Deflection => "deflection_m",
            Quantity::Force => "force_n",
        };
        (quantity.to_owned(), history.position, history.values)
    });
    let histories = HistoryRows {
        time_s: response.history_time_s,
        series: series.collect(),
    };
    JobRecord {
        job,
        reason: None,
        summary,
        positions,
        connectors,
        histories,
        modes: Vec::new(),
    }
}
