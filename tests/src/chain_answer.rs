//! The answer to a scenario of the plane chain: peaks with places and times, or what a load does that stands.
//!
//! Knows who solves it and how the answer is written down. Does not know how a scenario is written.

use crate::chain_scenario::{ChainScenario, ChainTask};
use crate::settings;
use pontoon_core::analysis::AnalysisError;
use pontoon_core::analysis::crossing::{Crossing, CrossingSolver};
use pontoon_core::analysis::modes::Mode;
use pontoon_core::analysis::statics::{DeadCase, StaticCase, StaticSolver};
use pontoon_core::bridge::Bridge;
use pontoon_core::connector::{Connection, OwnLaws};
use pontoon_core::response::{CrossingResponse, DeadState, Peak, Section, StaticResponse, WheelPeaks};
use pontoon_core::vehicle::Inertia;
use serde_json::{Map, Value, json};
use std::sync::Arc;

/// Solves a scenario, every degree of freedom kept, crossings by the reference solver.
///
/// # Errors
/// The solver's.
pub fn answer(scenario: &ChainScenario) -> Result<Value, AnalysisError> {
    let ready = scenario.chain.ready_of(&scenario.design);
    match &scenario.task {
        ChainTask::Modes => Ok(of_modes(&ready.modes(MODES))),
        ChainTask::Static(case) => {
            let dead = dead_state(scenario, &ready.bridge, case.connection, &case.own_laws)?;
            let case = StaticCase {
                dead: dead.clone(),
                ..case.clone()
            };
            let response = ready.statics(&scenario.vehicle).solve(&case)?;
            Ok(with_dead(
                scenario,
                of_static(scenario, &case, &response),
                dead.as_deref(),
            ))
        }
        ChainTask::Crossing {
            traffic,
            crossing,
            time_step_s,
            spectral_radius,
        } => {
            let settings = settings(scenario.chain.rayleigh, *time_step_s, *spectral_radius);
            let dead = dead_state(scenario, &ready.bridge, crossing.connection, &crossing.own_laws)?;
            let crossing = Crossing {
                dead: dead.clone(),
                ..crossing.clone()
            };
            let response = CrossingSolver::new(&ready.bridge, &settings)?.solve(traffic, &crossing)?;
            let found = of_crossing(scenario, *time_step_s, &response);
            Ok(with_dead(scenario, found, dead.as_deref()))
        }
    }
}

/// The dead state of a scenario's bridge; none without a dead load.
fn dead_state(
    scenario: &ChainScenario,
    bridge: &Arc<Bridge>,
    connection: Connection,
    own_laws: &OwnLaws,
) -> Result<Option<Arc<DeadState>>, AnalysisError> {
    let design = &scenario.design;
    if !design.has_dead_load() {
        return Ok(None);
    }
    StaticSolver::new(bridge)?.dead_state(&DeadCase::new(design, connection, own_laws.clone()))
}

/// Force of each bank of a scenario, its places added; `places` are bank, place across `[m]` and force `[N]`.
fn of_banks(scenario: &ChainScenario, places: &[(usize, f64, f64)]) -> Vec<Value> {
    let sum = |bank: usize| places.iter().filter(|of| of.0 == bank).map(|of| of.2).sum::<f64>();
    let banks = 0..scenario.design.banks.len();
    banks
        .map(|bank| json!({ "bank": bank, "force_n": sum(bank) }))
        .collect()
}

/// An answer with what the bridge does at rest.
fn with_dead(scenario: &ChainScenario, mut found: Value, dead: Option<&DeadState>) -> Value {
    let Some(dead) = dead else { return found };
    let positions = (1..).zip(&dead.deflection_m);
    let positions: Vec<_> = positions
        .map(|(position, w)| json!({ "position": position, "deflection_m": w }))
        .collect();
    let per_joint = scenario.design.connectors.y_m.len();
    let of_joints = dead.forces_n[..(scenario.design.modules - 1) * per_joint].chunks(per_joint);
    let joints: Vec<_> = (2..)
        .zip(of_joints)
        .map(|(joint, forces)| json!({ "joint": joint, "force_n": forces.iter().sum::<f64>() }))
        .collect();
    let banks = of_banks(scenario, &dead.banks);
    found["dead"] = json!({ "positions": positions, "joints": joints, "banks": banks });
    found
}

/// How many modes are told.
const MODES: usize = 30;

fn of_modes(modes: &[Mode]) -> Value {
    let of_mode = |mode: &Mode| json!({ "frequency_hz": mode.frequency_hz, "shape": mode.name, "vertical_share": mode.vertical_share });
    json!({ "kind": "modes", "modes": modes.iter().map(of_mode).collect::<Vec<_>>() })
}

fn of_crossing(scenario: &ChainScenario, time_step_s: f64, response: &CrossingResponse) -> Value {
    let positions = response.positions.iter().map(|p| {
        let mut row = Map::from_iter([("position".into(), json!(p.position)), ("x_m".into(), json!(p.x_m))]);
        put(&mut row, "peak_deflection", "m", p.deflection);
        put(&mut row, "peak_uplift", "m", p.uplift);
        Value::from(row)
    });
    let joints = response.joints.iter().map(|j| {
        let mut row = Map::from_iter([("joint".into(), json!(j.joint))]);
        put(&mut row, "peak_compression", "n", j.sum.compression);
        put(&mut row, "peak_tension", "n", j.sum.tension);
        Value::from(row)
    });
    let pins = response.pins.iter().filter(|pin| pin.y_m.is_none()).map(|sum| {
        let mut row = Map::from_iter([("joint".into(), json!(sum.joint))]);
        let [x, _, z] = sum.extremes.components;
        put(&mut row, "peak_minus_x", "n", x.compression);
        put(&mut row, "peak_plus_x", "n", x.tension);
        put(&mut row, "peak_minus_z", "n", z.compression);
        put(&mut row, "peak_plus_z", "n", z.tension);
        put(&mut row, "peak_resultant", "n", sum.extremes.resultant);
        let of = response.recorded.sections.iter();
        let mut angle = of.filter(|of| of.joint == sum.joint && of.of == Section::Angle);
        if let Some(angle) = angle.next() {
            put(&mut row, "peak_closing", "rad", angle.peaks.compression);
            put(&mut row, "peak_opening", "rad", angle.peaks.tension);
        }
        Value::from(row)
    });
    let pins: Vec<_> = pins.collect();
    let banks = response
        .recorded
        .banks
        .iter()
        .filter(|bank| bank.y_m.is_none())
        .map(|bank| {
            let mut row = Map::from_iter([("bank".into(), json!(bank.bank))]);
            put(&mut row, "peak_toward", "n", bank.force.tension);
            put(&mut row, "peak_away", "n", bank.force.compression);
            Value::from(row)
        });
    let banks: Vec<_> = banks.collect();
    let (positions, joints): (Vec<_>, Vec<_>) = (positions.collect(), joints.collect());
    let mut largest = Map::new();
    for (list, of, unit, place) in [
        (&positions, "peak_deflection", "m", "position"),
        (&positions, "peak_uplift", "m", "position"),
        (&joints, "peak_compression", "n", "joint"),
        (&joints, "peak_tension", "n", "joint"),
        (&pins, "peak_resultant", "n", "pin_joint"),
    ] {
        let (key, time) = (format!("{of}_{unit}"), format!("{of}_time_s"));
        let number = place.rsplit('_').next().unwrap_or(place);
        let row = largest_of(list, |row| row[&key].as_f64().unwrap_or(0.0));
        largest.insert(key.clone(), row.map_or(json!(0.0), |row| row[&key].clone()));
        largest.insert(
            format!("{of}_{place}"),
            row.map_or(Value::Null, |row| row[number].clone()),
        );
        largest.insert(time.clone(), row.map_or(Value::Null, |row| row[&time].clone()));
    }
    let sprung = !response.recorded.wheels.is_empty();
    if scenario.vehicle.inertia != Inertia::None || sprung {
        largest.insert("min_contact_force_n".into(), json!(response.least_contact.force_n));
    }
    let mut found = json!({ "kind": "crossing", "time_step_s": time_step_s, "positions": positions, "joints": joints,
                            "pins": pins, "banks": banks, "largest": largest });
    if sprung {
        found["axles"] = json!(axles(&response.recorded.wheels));
        found["contact_lost_s"] = json!(response.recorded.contact_lost_s);
    }
    found
}

/// Forces of the axles on springs, whose two wheels press alike.
fn axles(wheels: &[WheelPeaks]) -> Vec<Value> {
    let of = |wheels: &[WheelPeaks]| {
        let all = wheels.len() as f64;
        let first = wheels[0];
        json!({ "vehicle": first.vehicle + 1, "axle": first.axle + 1, "largest_n": all * first.largest.value,
                "largest_time_s": first.largest.time_s, "least_n": all * first.least.value,
                "least_time_s": first.least.time_s, "contact_lost_s": first.lost_s })
    };
    wheels
        .chunk_by(|a, b| (a.vehicle, a.axle) == (b.vehicle, b.axle))
        .map(of)
        .collect()
}

fn of_static(scenario: &ChainScenario, case: &StaticCase, response: &StaticResponse) -> Value {
    let positions = (1..).zip(&response.deflection_m);
    let positions = positions.map(|(position, w)| {
        json!({ "position": position, "x_m": scenario.design.position_x_m(position), "deflection_m": w })
    });
    let joints = response.joints.iter();
    let joints = joints.map(|j| json!({ "joint": j.joint, "force_n": j.sum_n }));
    let places = scenario.design.hinges.y_m.len();
    let pins = response.pins_n.chunks(places).zip(&response.sections);
    let pins = (2..).zip(pins).map(|(joint, (each, sections))| {
        let sum = |axis: usize| each.iter().map(|force| force[axis]).sum::<f64>();
        json!({ "joint": joint, "x_n": sum(0), "z_n": sum(2), "angle_rad": sections[Section::Angle as usize] })
    });
    let pins: Vec<_> = pins.collect();
    let banks = of_banks(scenario, &response.banks);
    let (positions, joints): (Vec<_>, Vec<_>) = (positions.collect(), joints.collect());
    let mut largest = Map::new();
    for (key, list, of, sign, place) in [
        ("deflection_m", &positions, "deflection_m", 1.0, "deflection_position"),
        ("compression_n", &joints, "force_n", -1.0, "compression_joint"),
        ("tension_n", &joints, "force_n", 1.0, "tension_joint"),
    ] {
        let value = |row: &Value| sign * row[of].as_f64().unwrap_or(0.0);
        let row = largest_of(list, value);
        let number = place.rsplit('_').next().unwrap_or(place);
        largest.insert(key.into(), json!(row.map_or(0.0, value)));
        largest.insert(place.into(), row.map_or(Value::Null, |row| row[number].clone()));
    }
    json!({ "kind": "static", "time_step_s": null, "load_x_m": case.load_x_m, "positions": positions,
            "joints": joints, "pins": pins, "banks": banks, "largest": largest })
}

/// A peak and its time; a value that never rose above zero has none.
fn put(row: &mut Map<String, Value>, of: &str, unit: &str, peak: Peak) {
    row.insert(format!("{of}_{unit}"), json!(peak.value));
    row.insert(format!("{of}_time_s"), json!((peak.value > 0.0).then_some(peak.time_s)));
}

/// The row with the largest value, the first of equals; none where no value is above zero.
fn largest_of(rows: &[Value], value: impl Fn(&Value) -> f64) -> Option<&Value> {
    let above = rows.iter().filter(|row| value(row) > 0.0);
    above.reduce(|best, row| if value(row) > value(best) { row } else { best })
}
