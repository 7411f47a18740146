//! What a study was run with, in words.
//!
//! Knows the study's spec. Does not know results.

use super::Item;
use crate::labels;
use pontoon_core::vehicle::Inertia;
use pontoon_plan::study_file::{AnalysisSpec, Kind, ModelSpec, SolverSpec, Study, TimeStepSpec};

/// The settings of a study, its axes apart.
pub(super) fn settings(study: &Study) -> Vec<Item> {
    // what an axis changes is not what every job has
    let apart = |root: &str, text: String| match study.path_axes().iter().any(|axis| axis.starts_with(root)) {
        true => format!("{text}; where no axis says otherwise"),
        false => text,
    };
    let mut list = vec![
        Item::new("bridge", apart("bridge.", bridge(study))),
        Item::new("connectors", connectors(study)),
    ];
    if study.spec.analysis.kind != Kind::Modes {
        list.push(Item::new("vehicle", apart("vehicle.", vehicle(study))));
    }
    let checked = study.spec.analysis.clone().checked();
    list.push(Item::new(
        "analysis",
        apart("analysis.", analysis(checked.as_ref().unwrap_or(&study.spec.analysis))),
    ));
    list
}

fn bridge(study: &Study) -> String {
    let design = &study.bridge.design;
    let module = &design.module;
    let metres = |x: f64| labels::number(x);
    format!(
        "{}: {} modules of {} m, {} m wide, {} m deep; water {} kPa/m and {} kg/m",
        design.name,
        design.modules,
        metres(module.length_m),
        metres(module.breadth_m),
        metres(module.depth_m),
        labels::number(1e-3 * design.p_b()),
        labels::number(design.m_a()),
    )
}

fn connectors(study: &Study) -> String {
    let connectors = &study.bridge.design.connectors;
    let places: Vec<String> = connectors.y_m.iter().map(|y| labels::number(*y)).collect();
    format!(
        "at y = {} m, {} N/m each; gaps {} in tension, {} in compression where no axis says otherwise",
        places.join(", "),
        labels::number(connectors.stiffness_n_m),
        labels::value("_gap_m", &connectors.gap_tension_m.into()),
        labels::value("_gap_m", &connectors.gap_compression_m.into()),
    )
}

fn vehicle(study: &Study) -> String {
    let vehicle = &study.spec.vehicle;
    let inertia = match vehicle.inertia {
        _ if study.spec.analysis.kind == Kind::Static => "standing",
        Inertia::None => "moving weight without inertia",
        Inertia::Local => "moving mass with local inertia",
        Inertia::Convective => "moving mass with convective inertia",
    };
    let axles = vehicle.axles().unwrap_or_default();
    match axles.as_slice() {
        [one] => {
            let tracks: Vec<String> = one.track_y_m.iter().map(|y| labels::number(*y)).collect();
            let length = labels::number(one.patch_length_m);
            format!(
                "footprint of {length} m on tracks at y = {} m; {inertia}",
                tracks.join(", ")
            )
        }
        axles => {
            let behind: Vec<String> = axles.iter().map(|axle| labels::number(axle.behind_front_m)).collect();
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
                    labels::number(1e3 * step.map_or(0.01, TimeStepSpec::seconds))
                ),
            };
            let damping = spec.damping.unwrap_or_default();
            format!(
                "crossing by the {solver}, {model}, {step}, {} s after the vehicle has left, damping {} %",
                labels::number(spec.tail_s.unwrap_or_default()),
                labels::number(100.0 * damping.ratio)
            )
        }
    }
}
