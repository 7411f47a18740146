//! Crossings that a page can play: solved once more with the motion of every position and the force of every joint.
//!
//! Knows which jobs are worth it and how many frames an eye needs. Does not know how a crossing is solved.

use super::BridgeNote;
use super::cells::PageMeasure;
use super::packed::{Packed, Scaled};
use super::rows::severest;
use crate::thinning::spread;
use pontoon_core::traffic::Driven;
use pontoon_core::vehicle::Vehicle;
use pontoon_plan::job::{Candidates, Job, Task};
use pontoon_plan::study_file::{ModelSpec, Study};
use pontoon_results::{HistoryRows, JobRecord, Results, Table};
use pontoon_study::run::{Cache, replay};
use serde::Serialize;
use std::collections::BTreeSet;

/// Frames of a crossing, evenly spaced, beside those of its peaks.
const FRAMES: usize = 320;

/// Crossings by the reference solver that are solved again: each takes as long as hundreds by the operator.
const MOST_INTEGRATED: usize = 4;

/// Time steps beyond which a crossing is too long to be solved again.
const MOST_STEPS: usize = 400_000;

/// Axle of a vehicle, as a page draws it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct AxlePatch {
    /// Distance of the patch's centre behind the vehicle's front `[m]`.
    pub behind_front_m: f64,
    /// Share of the weight.
    pub share: f64,
    /// Length of the patch `[m]`.
    pub patch_length_m: f64,
}

/// A vehicle of a crossing to be played.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PlayedVehicle {
    /// Place of its front in each frame `[m]`.
    pub front_x_m: Packed,
    /// Whether it drives toward the left end.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub backward: bool,
    /// Its axles.
    pub axles: Vec<AxlePatch>,
    /// Its weight `[N]`.
    pub load_n: f64,
}

/// A crossing to be played.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Play {
    /// The job.
    pub job: u32,
    /// Its bridge, where that is not the first job's.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bridge: Option<BridgeNote>,
    /// Number of frames.
    pub frames: usize,
    /// Time of each frame `[s]`.
    pub time_s: Packed,
    /// The vehicles in the order of their numbers.
    pub vehicles: Vec<PlayedVehicle>,
    /// Deflection of each position at rest, from where the modules float by themselves `[m]`; empty without a dead load.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub rest_m: Vec<f64>,
    /// Deflection of each position from rest, frame after frame, positive downward `[m]`.
    pub deflection_m: Scaled,
    /// Force of each joint, its connectors added, tension positive `[N]`.
    pub force_n: Scaled,
    /// State of each joint by the sum of its connectors: 0 open, 1 in compression, 2 in tension.
    pub state: Packed,
}

/// Crossings to be played, and what a reader must know of them.
#[derive(Debug, Default)]
pub(super) struct Played {
    pub plays: Vec<Play>,
    pub notes: Vec<String>,
}

/// Plays of at most `most` of the jobs in `rows` of the table of jobs.
pub(super) fn plays(
    study: &Study,
    all: &[Job],
    results: &Results,
    (measures, rows): (&[PageMeasure], &[usize]),
    most: usize,
    cache: Option<&Cache>,
) -> Played {
    let jobs = results.jobs();
    let crossing = |row: &usize| {
        let job = all.get(super::job(results, *row) as usize)?;
        (matches!(job.task, Task::Crossing { .. }) && !results.is_failed(*row)).then_some((*row, job))
    };
    let able: Vec<(usize, &Job)> = rows.iter().filter_map(crossing).collect();
    let light = |job: &Job| job.steps() <= MOST_STEPS && job.model() == ModelSpec::SuperElement;
    let fit: Vec<(usize, &Job)> = able.iter().copied().filter(|(_, job)| light(job)).collect();
    let chosen = choose(jobs, measures, &fit, most);
    let mut played = Played::default();
    if chosen.len() < able.len() && most > 0 {
        let which = match (fit.len() > most, fit.len() < able.len()) {
            (true, _) => "the ones with the largest values and an even sample",
            (false, true) => "crossings of full models and very long ones are not solved again",
            (false, false) => "few crossings by the reference solver are solved again",
        };
        played.notes.push(format!(
            "{} of {} crossings listed can be played: {which}.",
            chosen.len(),
            able.len()
        ));
    }
    let told = chosen.iter().filter_map(|&at| {
        let (row, job) = fit[at];
        Candidates::told_crossing(study, job, jobs.number("rated_value", row))
    });
    let told: Vec<Job> = told.collect();
    let list: Vec<&Job> = told.iter().collect();
    let mut furthest = 0.0_f64;
    replay(study, &list, cache, |job, record| {
        let row = fit
            .iter()
            .find(|(_, other)| other.number == job.number)
            .map(|(row, _)| *row);
        let told = row.and_then(|row| jobs.number("peak_deflection_m", row));
        if let (Some(told), Some(now)) = (told, record.summary.peak_deflection_m)
            && told > 0.0
        {
            furthest = furthest.max((now - told).abs() / told);
        }
        played.plays.extend(play(job, &record, all.first()));
    });
    if furthest > 0.0 {
        played.notes.push(format!(
            "Crossings that are played here were solved again by this program ({}); their peak deflections are up to {:.1e} of themselves off the tables'.",
            pontoon_results::VERSION,
            furthest
        ));
    }
    played
}

/// Places in `fit` of the jobs to be played: all where they are few, else in turn the one with the largest value of each
/// measure, then the second ones, up to half of them, and an even sample. Of those by the reference solver only the first few.
fn choose(jobs: &Table, measures: &[PageMeasure], fit: &[(usize, &Job)], most: usize) -> BTreeSet<usize> {
    let rows: Vec<usize> = fit.iter().map(|(row, _)| *row).collect();
    let ranked: Vec<Vec<usize>> = measures.iter().take(4).map(|m| severest(jobs, m.name, &rows)).collect();
    let severe = (0..most.div_ceil(2)).flat_map(|rank| ranked.iter().filter_map(move |list| list.get(rank).copied()));
    let all = if fit.len() <= most { most } else { most.div_ceil(2) };
    let (mut chosen, mut integrated) = (BTreeSet::new(), 0);
    let mut take = |chosen: &mut BTreeSet<usize>, at: usize| {
        if chosen.contains(&at) {
            return;
        }
        integrated += usize::from(!fit[at].1.by_operator());
        if fit[at].1.by_operator() || integrated <= MOST_INTEGRATED {
            chosen.insert(at);
        }
    };
    for at in severe {
        if chosen.len() < all {
            take(&mut chosen, at);
        }
    }
    let left: Vec<usize> = (0..fit.len()).filter(|at| !chosen.contains(at)).collect();
    for place in spread(left.len(), most.saturating_sub(chosen.len())) {
        take(&mut chosen, left[place]);
    }
    chosen
}

/// The frames of a record; none where it failed this time.
fn play(job: &Job, record: &JobRecord, first: Option<&Job>) -> Option<Play> {
    let traffic = job.as_crossing()?.traffic();
    let histories = &record.histories;
    let of = |quantity: &str| -> Vec<&Vec<f64>> {
        let named = histories.series.iter().filter(|series| series.of.quantity == quantity);
        named.map(|series| &series.values).collect()
    };
    let (deflections, forces) = (of("deflection_m"), of("force_n"));
    let frames = frames(histories);
    if frames.is_empty() || deflections.is_empty() {
        return None;
    }
    let flat = |lines: &[&Vec<f64>]| -> Vec<f64> {
        frames
            .iter()
            .flat_map(|&frame| lines.iter().map(move |line| line[frame]))
            .collect()
    };
    let force = flat(&forces);
    let state = |force: &f64| match *force {
        f if f < 0.0 => 1,
        f if f > 0.0 => 2,
        _ => 0,
    };
    let time = |frame: &usize| histories.time_s[*frame];
    let length_m = job.shared.bridge.design.length_m();
    let played = |driven: &Driven| {
        let front_x_m = |frame: &usize| {
            let way_m = driven.drive.at(time(frame)).way_m;
            Some(if driven.drive.backward { length_m - way_m } else { way_m })
        };
        PlayedVehicle {
            front_x_m: Packed::numbers(frames.iter().map(front_x_m)),
            backward: driven.drive.backward,
            axles: axles(&driven.vehicle),
            load_n: driven.load_n,
        }
    };
    Some(Play {
        job: u32::try_from(job.number).unwrap_or(u32::MAX),
        bridge: Some(BridgeNote::of(job)).filter(|own| first.map(BridgeNote::of).as_ref() != Some(own)),
        frames: frames.len(),
        time_s: Packed::numbers(frames.iter().map(|frame| Some(time(frame)))),
        vehicles: traffic.vehicles.iter().map(played).collect(),
        rest_m: record
            .dead
            .iter()
            .filter(|row| row.quantity == "deflection_m")
            .map(|row| row.value)
            .collect(),
        deflection_m: Scaled::new(&flat(&deflections)),
        state: Packed::U8(force.iter().map(state).collect()),
        force_n: Scaled::new(&force),
    })
}

/// The axles of a vehicle, each as its first patch is.
fn axles(vehicle: &Vehicle) -> Vec<AxlePatch> {
    let mut axles: Vec<AxlePatch> = Vec::new();
    for patch in &vehicle.patches {
        if axles.len() == patch.axle {
            axles.push(AxlePatch {
                behind_front_m: -patch.ahead_m,
                share: 0.0,
                patch_length_m: patch.length_m,
            });
        }
        if let Some(axle) = axles.last_mut() {
            axle.share += patch.share;
        }
    }
    axles
}

/// Steps that are frames: evenly spaced ones, and those of the largest deflection, uplift, compression and tension.
fn frames(histories: &HistoryRows) -> Vec<usize> {
    let steps = histories.time_s.len();
    let Some(last) = steps.checked_sub(1) else {
        return Vec::new();
    };
    let every = steps.div_ceil(FRAMES).max(1);
    let mut frames: BTreeSet<usize> = (0..steps).step_by(every).collect();
    frames.insert(last);
    for quantity in ["deflection_m", "force_n"] {
        let lines = || histories.series.iter().filter(|series| series.of.quantity == quantity);
        for sign in [1.0, -1.0] {
            let mut largest = (0.0, None);
            for (step, value) in lines().flat_map(|series| series.values.iter().enumerate()) {
                if sign * value > largest.0 {
                    largest = (sign * value, Some(step));
                }
            }
            frames.extend(largest.1);
        }
    }
    frames.into_iter().collect()
}
