//! A static job to its record.
//!
//! Knows which number of a response fills which field of a record. Does not know columns, or how a case is solved.

use super::failure::JobFailure;
use super::quantity_words::quantity_word;
use super::shared_models::{SharedModels, static_case};
use pontoon_core::response::{Quantity, SECTIONS, Section, StaticResponse, resultant_n};
use pontoon_plan::job::{Job, StandingLoad};
use pontoon_results::{ConnectorRow, Extreme, JobRecord, PinRow, PlaceRow, PositionRow, SectionRow, Summary};

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
    let pins = if job.record.pins {
        pin_rows(job, &response.pins_n)
    } else {
        Vec::new()
    };
    let sections = if job.record.sections {
        section_rows(&response.sections)
    } else {
        Vec::new()
    };
    summary.take_joint_peaks(&pins, &sections);
    JobRecord {
        job: job.number,
        summary,
        positions,
        connectors,
        pins,
        sections,
        places: place_rows(job, &response.places_m),
        ..JobRecord::default()
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
    PinRow {
        joint,
        y_m,
        components: force_n.map(sides),
        resultant: Extreme::timeless(resultant_n(force_n)),
    }
}

/// The rows of angles and section forces, joint after joint.
fn section_rows(sections: &[[f64; SECTIONS]]) -> Vec<SectionRow> {
    let row = |joint: usize, (of, value): (Section, f64)| SectionRow {
        joint,
        quantity: quantity_word(Quantity::Section(of)).to_owned(),
        sides: sides(value),
    };
    let joints = (2..).zip(sections);
    let of_joint = |(joint, values): (usize, &[f64; SECTIONS])| {
        Section::ALL.into_iter().zip(*values).map(move |of| row(joint, of))
    };
    joints.flat_map(of_joint).collect()
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
    job.record.places_x_m.iter().zip(places_m).map(row).collect()
}

/// A static number against its sense and with it.
fn sides(number: f64) -> [Extreme; 2] {
    [0.0 - number, number].map(|side| Extreme::timeless(side.max(0.0)))
}
