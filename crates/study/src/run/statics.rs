//! A static job to its record.
//!
//! Knows which number of a response fills which field of a record. Does not know columns, or how a case is solved.

use super::failure::JobFailure;
use super::shared_models::{SharedModels, static_case};
use pontoon_core::response::StaticResponse;
use pontoon_plan::job::{Job, StandingLoad};
use pontoon_results::{ConnectorRow, Extreme, HistoryRows, JobRecord, PinRow, PositionRow, Summary};

/// Solves the static case of a job.
pub(super) fn solve(job: &Job, load: StandingLoad, models: &SharedModels) -> Result<JobRecord, JobFailure> {
    let response = models
        .statics(job)?
        .solve(&job.vehicle.vehicle, &static_case(job, load.x_m))?;
    Ok(rows(job, &response))
}

fn rows(job: &Job, response: &StaticResponse) -> JobRecord {
    let positions: Vec<PositionRow> = (1..)
        .zip(&response.deflection_m)
        .map(|(position, &deflection_m)| PositionRow {
            position,
            x_m: job.bridge.design.position_x_m(position),
            deflection: Extreme::timeless(deflection_m.max(0.0)),
            uplift: Extreme::timeless((0.0 - deflection_m).max(0.0)),
            static_deflection_m: Some(deflection_m),
            static_peak_deflection_m: None,
        })
        .collect();
    let mut connectors = Vec::new();
    for joint in &response.joints {
        connectors.push(ConnectorRow::force(joint.joint, None, joint.sum_n));
        connectors.extend(
            joint
                .connectors
                .iter()
                .map(|(y_m, n)| ConnectorRow::force(joint.joint, Some(*y_m), *n)),
        );
    }
    let mut summary = Summary {
        peak_edge_deflection_m: Some(response.peak_edge_deflection_m),
        peak_roll_rad: Some(response.peak_roll_rad),
        influential_length_m: Some(response.influential_length_m),
        bottom_emerged: response.bottom_emerged,
        deck_submerged: response.deck_submerged,
        newton_iterations: Some(response.newton_iterations),
        ..Summary::default()
    };
    summary.take_peaks(&positions, &connectors);
    JobRecord {
        job: job.number,
        failure: None,
        retried: None,
        summary,
        positions,
        connectors,
        histories: HistoryRows::default(),
        modes: Vec::new(),
        pins: if job.pins {
            pin_rows(job, &response.pins_n)
        } else {
            Vec::new()
        },
    }
}

/// The rows of the pins, joint after joint, and of each joint's sum.
fn pin_rows(job: &Job, forces_n: &[[f64; 3]]) -> Vec<PinRow> {
    let design = &job.bridge.design;
    let (mut forces, mut rows) = (forces_n.iter().copied(), Vec::new());
    for joint in 2..=design.modules {
        let mut sum = [0.0; 3];
        for (&y_m, force) in design.hinges_of(joint).y_m.iter().zip(&mut forces) {
            (0..3).for_each(|axis| sum[axis] += force[axis]);
            rows.push(pin_row(joint, Some(y_m), force));
        }
        rows.push(pin_row(joint, None, sum));
    }
    rows
}

fn pin_row(joint: usize, y_m: Option<f64>, force_n: [f64; 3]) -> PinRow {
    let sides = |force: f64| [0.0 - force, force].map(|side| Extreme::timeless(side.max(0.0)));
    PinRow {
        joint,
        y_m,
        components: force_n.map(sides),
        resultant: Extreme::timeless(force_n.iter().map(|f| f * f).sum::<f64>().sqrt()),
    }
}
