//! Rows of what a bridge does at rest, and of the freeboards of a job.
//!
//! Knows which corner of which module a number is of. Does not know how it was found.

use pontoon_core::response::{DeadState, Peak};
use pontoon_plan::job::Job;
use pontoon_results::{DEAD_QUANTITIES, DeadRow, Extreme, FreeboardRow};

/// The rows of a dead state; none without one.
pub(super) fn dead_rows(job: &Job, dead: Option<&DeadState>) -> Vec<DeadRow> {
    let Some(dead) = dead else { return Vec::new() };
    let design = &job.shared.bridge.design;
    let [deflection, force, reaction, sinkage, trim, heel, freeboard] = DEAD_QUANTITIES;
    let row = |quantity: &str, value: f64| DeadRow {
        quantity: quantity.to_owned(),
        position: None,
        module: None,
        bank: None,
        y_m: None,
        // nothing is 0, not -0
        value: value + 0.0,
    };
    let mut rows: Vec<DeadRow> = (1..)
        .zip(&dead.deflection_m)
        .map(|(position, &w)| DeadRow {
            position: Some(position),
            ..row(deflection, w)
        })
        .collect();
    let across = &design.connectors.y_m;
    for (joint, forces) in (2..=design.modules).zip(dead.forces_n.chunks(across.len().max(1))) {
        let of_joint = |y_m: Option<f64>, n: f64| DeadRow {
            position: Some(joint),
            y_m,
            ..row(force, n)
        };
        rows.push(of_joint(None, forces.iter().sum()));
        rows.extend(across.iter().zip(forces).map(|(&y_m, &n)| of_joint(Some(y_m), n)));
    }
    for of in dead.banks.chunk_by(|a, b| a.0 == b.0) {
        let of_bank = |y_m: Option<f64>, n: f64| DeadRow {
            bank: Some(of[0].0),
            y_m,
            ..row(reaction, n)
        };
        rows.push(of_bank(None, of.iter().map(|place| place.2).sum()));
        rows.extend(of.iter().map(|(_, y_m, n)| of_bank(Some(*y_m), *n)));
    }
    for (module, at_rest) in (1..).zip(&dead.modules) {
        let of_module = |(quantity, value): (&str, f64)| DeadRow {
            module: Some(module),
            ..row(quantity, value)
        };
        let numbers = [
            (sinkage, at_rest.sinkage_m),
            (trim, at_rest.trim_rad),
            (heel, at_rest.heel_rad),
        ];
        rows.extend(numbers.map(of_module));
    }
    let boards = design.freeboards_m();
    for (corner, risen_m) in dead.deck_corners_m.iter().enumerate() {
        let Some(board_m) = boards[corner / 4] else { continue };
        let at = FreeboardRow::of_corner(corner, job, Extreme::default());
        rows.push(DeadRow {
            position: Some(at.position),
            module: Some(at.module),
            y_m: Some(at.y_m),
            ..row(freeboard, board_m + risen_m)
        });
    }
    rows
}

/// The rows of freeboards, of corners whose largest deflections from rest are `lowest`.
pub(super) fn freeboard_rows(job: &Job, dead: Option<&DeadState>, lowest: &[Extreme]) -> Vec<FreeboardRow> {
    let boards = job.shared.bridge.design.freeboards_m();
    let row = |(corner, lowest): (usize, &Extreme)| {
        let risen_m = dead.map_or(0.0, |dead| dead.deck_corners_m[corner]);
        let afloat_m = boards[corner / 4].map(|board_m| board_m + risen_m);
        let least = Extreme {
            value: afloat_m.zip(lowest.value).map(|(afloat_m, down_m)| afloat_m - down_m),
            time_s: lowest.time_s,
        };
        FreeboardRow::of_corner(corner, job, least)
    };
    lowest.iter().enumerate().map(row).collect()
}

/// Largest deflections of corners in a crossing.
pub(super) fn lowest(corners: &[Peak]) -> Vec<Extreme> {
    corners
        .iter()
        .map(|peak| Extreme::at(peak.value, peak.time_s))
        .collect()
}
