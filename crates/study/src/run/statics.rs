//! A static job to its record.
//!
//! Knows which number of a response fills which field of a record. Does not know columns, or how a case is solved.

use super::dead_rows::{dead_rows, freeboard_rows};
use super::failure::JobFailure;
use super::joint_rows::Rounding;
use super::shared_models::{SharedModels, static_case};
use pontoon_core::response::StaticResponse;
use pontoon_plan::job::{Job, StandingLoad};
use pontoon_results::{BankRow, ConnectorRow, Extreme, JobRecord, PlaceRow, PositionRow, Summary};

/// Solves the static case of a job.
pub(super) fn solve(job: &Job, load: StandingLoad, models: &SharedModels) -> Result<JobRecord, JobFailure> {
    let response = models.statics(job)?.solve(
        &job.shared.vehicle.vehicle,
        &static_case(job, load.x_m, models.dead(job)?),
    )?;
    Ok(rows(job, &response))
}

fn rows(job: &Job, response: &StaticResponse) -> JobRecord {
    let positions: Vec<PositionRow> = (1..)
        .zip(&response.deflection_m)
        .map(|(position, &deflection_m)| PositionRow {
            position,
            x_m: job.shared.bridge.design.position_x_m(position),
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
    let rounding = Rounding::of_forces(&response.pins_n);
    let (mut pins, mut sections) = (Vec::new(), Vec::new());
    if job.shared.record.pins {
        pins = rounding.static_pin_rows(job, &response.pins_n);
    }
    if job.shared.record.sections {
        sections = rounding.static_section_rows(&response.sections);
    }
    summary.take_joint_peaks(&pins, &sections);
    let dead = response.dead.as_deref();
    let mut freeboards = Vec::new();
    if job.shared.record.freeboards {
        let lowest: Vec<Extreme> = response.corners_m.iter().map(|down| Extreme::timeless(*down)).collect();
        freeboards = freeboard_rows(job, dead, &lowest);
    }
    summary.take_freeboards(&freeboards);
    JobRecord {
        job: job.number,
        summary,
        positions,
        connectors,
        pins,
        sections,
        places: place_rows(job, &response.places_m),
        banks: bank_rows(&response.banks),
        dead: dead_rows(job, dead),
        freeboards,
        ..JobRecord::default()
    }
}

/// The rows of banks: of each bank's sum, then of each place.
fn bank_rows(forces: &[(usize, f64, f64)]) -> Vec<BankRow> {
    let row = |bank: usize, y_m: Option<f64>, force_n: f64| {
        let [away, toward] = sides(force_n);
        BankRow {
            bank,
            y_m,
            toward,
            away,
        }
    };
    let of_bank = |of: &[(usize, f64, f64)]| {
        let (bank, sum) = (of[0].0, of.iter().map(|place| place.2).sum());
        let places = of.iter().map(|(_, y_m, force_n)| row(bank, Some(*y_m), *force_n));
        std::iter::once(row(bank, None, sum)).chain(places).collect::<Vec<_>>()
    };
    forces.chunk_by(|a, b| a.0 == b.0).flat_map(of_bank).collect()
}

fn place_rows(job: &Job, places_m: &[f64]) -> Vec<PlaceRow> {
    let row = |(&x_m, &deflection_m): (&f64, &f64)| {
        let [uplift, deflection] = sides(deflection_m);
        PlaceRow {
            x_m,
            deflection,
            uplift,
            static_deflection_m: Some(deflection_m),
        }
    };
    job.shared.record.places_x_m.iter().zip(places_m).map(row).collect()
}

/// A static number against its sense and with it.
fn sides(number: f64) -> [Extreme; 2] {
    [0.0 - number, number].map(|side| Extreme::timeless(side.max(0.0)))
}
