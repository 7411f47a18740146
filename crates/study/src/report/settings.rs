//! What a study was run with, in words.
//!
//! Knows the study's spec. Does not know results.

use super::axes::Axis;
use super::{Item, words};
use crate::spec::{AnalysisSpec, Kind, ModelSpec, SolverSpec, Study, TimeStepSpec};
use pontoon_core::vehicle::Inertia;
use serde_json::Value;

/// Values of an axis that are listed.
const MOST_LISTED: usize = 8;

/// The settings of a study and its axes.
pub(super) fn settings(study: &Study, axes: &[Axis]) -> Vec<Item> {
    let mut list = vec![
        Item::new("bridge", bridge(study)),
        Item::new("connectors", connectors(study)),
    ];
    if study.spec.analysis.kind != Kind::Modes {
        list.push(Item::new("vehicle", vehicle(study)));
    }
    let checked = study.spec.analysis.clone().checked();
    list.push(Item::new(
        "analysis",
        analysis(checked.as_ref().unwrap_or(&study.spec.analysis)),
    ));
    list.extend(axes.iter().filter(|axis| !axis.values.is_empty()).map(axis_item));
    list
}

fn bridge(study: &Study) -> String {
    let design = &study.bridge.design;
    let module = &design.module;
    let metres = |x: f64| words::number(x);
    format!(
        "{}: {} modules of {} m, {} m wide, {} m deep; water {} kPa/m and {} kg/m",
        design.name,
        design.modules,
        metres(module.length_m),
        metres(module.breadth_m),
        metres(module.depth_m),
        words::number(1e-3 * design.p_b()),
        words::number(design.m_a()),
    )
}

fn connectors(study: &Study) -> String {
    let connectors = &study.bridge.design.connectors;
    let places: Vec<String> = connectors.y_m.iter().map(|y| words::number(*y)).collect();
    format!(
        "at y = {} m, {} N/m each; gaps {} in tension, {} in compression where no axis says otherwise",
        places.join(", "),
        words::number(connectors.stiffness_n_m),
        words::value("_gap_m", &connectors.gap_tension_m.into()),
        words::value("_gap_m", &connectors.gap_compression_m.into()),
    )
}

fn vehicle(study: &Study) -> String {
    let vehicle = &study.spec.vehicle;
    let inertia = match vehicle.inertia {
        Inertia::None => "moving weight without inertia",
        Inertia::Local => "moving mass with local inertia",
        Inertia::Convective => "moving mass with convective inertia",
    };
    let axles = vehicle.axles().unwrap_or_default();
    match axles.as_slice() {
        [one] => {
            let tracks: Vec<String> = one.track_y_m.iter().map(|y| words::number(*y)).collect();
            let length = words::number(one.patch_length_m);
            format!(
                "footprint of {length} m on tracks at y = {} m; {inertia}",
                tracks.join(", ")
            )
        }
        axles => {
            let behind: Vec<String> = axles.iter().map(|axle| words::number(axle.behind_front_m)).collect();
            format!(
                "{} axles at {} m behind the front; {inertia}",
                axles.len(),
                behind.join(", ")
            )
        }
    }
}

fn analysis(spec: &AnalysisSpec) -> String {
    let model = match spec.model {
        ModelSpec::Full => "full modules",
        ModelSpec::SuperElement => "modules as super-elements",
    };
    match spec.kind {
        Kind::Static => format!("static, {model}"),
        Kind::Modes => format!("natural modes, {model}"),
        Kind::Crossing => {
            let solver = match spec.solver {
                Some(SolverSpec::Reference) => "reference solver",
                _ => "bridge operator",
            };
            let step = match spec.time_step_s {
                Some(TimeStepSpec::Auto(_)) => "time step of each job's own".to_owned(),
                step => format!(
                    "time step {} ms",
                    words::number(1e3 * step.map_or(0.01, TimeStepSpec::seconds))
                ),
            };
            let damping = spec.damping.unwrap_or_default();
            format!(
                "crossing by the {solver}, {model}, {step}, {} s after the vehicle has left, damping {} %",
                words::number(spec.tail_s.unwrap_or_default()),
                words::number(100.0 * damping.ratio)
            )
        }
    }
}

fn axis_item(axis: &Axis) -> Item {
    let said = |value: &Value| words::value(&axis.name, value);
    let values: Vec<&Value> = axis.values.iter().filter(|value| !value.is_null()).collect();
    let text = match (&axis.bins, values.as_slice()) {
        (Some(bins), _) => {
            let ends: Vec<[f64; 2]> = bins.iter().flatten().copied().collect();
            let [from, to] = [ends.first().map(|e| e[0]), ends.last().map(|e| e[1])].map(|x| said(&x.into()));
            format!("{from} to {to}, in {} ranges here", ends.len())
        }
        (None, few) if few.len() <= MOST_LISTED => few.iter().map(|v| said(v)).collect::<Vec<_>>().join(", "),
        (None, [first, .., last]) => format!("{} to {}, {} values", said(first), said(last), values.len()),
        (None, _) => String::new(),
    };
    Item::new(axis.label.clone(), text)
}
