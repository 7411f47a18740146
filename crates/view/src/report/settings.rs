//! What a study was run with, in words.
//!
//! Knows the study's spec. Does not know results.

use super::Item;
use crate::asked;
use pontoon_core::vehicle::Inertia;
use pontoon_plan::design::{Root, Varies};
use pontoon_plan::study_file::{Analysis, DampingSpec, Kind, ModelSpec, Solver, Study, TimeStep};
use pontoon_results::labels::{self, SHOWN};

/// The settings of a study, its axes apart.
pub(super) fn settings(study: &Study) -> Vec<Item> {
    // what an axis changes is not what every job has
    let axes = || study.blocks.iter().flat_map(|block| &block.axes);
    let apart = |root: Root, text: String| {
        let changes = |varies: &Varies| matches!(varies, Varies::Path(of, _) if *of == root);
        match axes().any(|axis| changes(&axis.varies)) {
            true => format!("{text}; where no axis says otherwise"),
            false => text,
        }
    };
    let mut list = vec![
        Item::new("bridge", apart(Root::Bridge, bridge(study))),
        Item::new("connectors", connectors(study)),
    ];
    if study.analysis.kind() != Kind::Modes {
        list.push(Item::new("vehicle", apart(Root::Vehicle, vehicle(study))));
    }
    list.push(Item::new("analysis", apart(Root::Analysis, analysis(&study.analysis))));
    list.extend(asked::limits(study).map(|limits| Item::new("limits", limits)));
    list.extend(asked::search(study).map(|search| Item::new("rated value", search)));
    list
}

fn bridge(study: &Study) -> String {
    let design = &study.bridge.design;
    let kinds = design.named_kinds().into_iter().map(|(key, kind)| {
        let module = &kind.module;
        let name = key
            .rsplit_once('.')
            .map_or(String::new(), |(_, name)| format!("{name} "));
        format!(
            "{name}{} m, {} m wide, {} m deep; water {} kPa/m and {}",
            number(module.length_m),
            number(module.breadth_m),
            number(module.depth_m),
            number(1e-3 * kind.p_b()),
            match &kind.water {
                None => format!("{} kg/m", number(kind.m_a())),
                Some(water) => format!("radiated waves of {}", water.file),
            },
        )
    });
    let kinds = kinds.collect::<Vec<_>>().join("; ");
    format!(
        "{}: {} of {kinds}",
        design.name,
        labels::counted(design.modules, "module")
    )
}

fn connectors(study: &Study) -> String {
    let connectors = &study.bridge.design.connectors;
    let places: Vec<String> = connectors.y_m.iter().map(|y| number(*y)).collect();
    format!(
        "at y = {} m, {} N/m each; gaps {} in tension, {} in compression where no axis says otherwise",
        places.join(", "),
        number(connectors.stiffness_n_m),
        labels::value("gap_tension_m", &connectors.gap_tension_m.into()),
        labels::value("gap_compression_m", &connectors.gap_compression_m.into()),
    )
}

fn vehicle(study: &Study) -> String {
    let vehicle = &study.vehicle;
    let inertia = match vehicle.inertia {
        _ if study.analysis.kind() == Kind::Static => "standing",
        Inertia::None => "moving weight without inertia",
        Inertia::Local => "moving mass with local inertia",
        Inertia::Convective => "moving mass with convective inertia",
    };
    let axles = vehicle.axles().unwrap_or_default();
    match axles.as_slice() {
        [one] => {
            let tracks: Vec<String> = one.track_y_m.iter().map(|y| number(*y)).collect();
            let length = number(one.patch_length_m);
            format!(
                "footprint of {length} m on tracks at y = {} m; {inertia}",
                tracks.join(", ")
            )
        }
        axles => {
            let behind: Vec<String> = axles.iter().map(|axle| number(axle.behind_front_m)).collect();
            format!(
                "{} at {} m behind the front; {inertia}",
                labels::counted(axles.len(), "axle"),
                behind.join(", ")
            )
        }
    }
}

fn analysis(analysis: &Analysis) -> String {
    let model = match analysis.model() {
        ModelSpec::Full => "full modules",
        ModelSpec::SuperElement => "modules as super-elements",
    };
    match analysis {
        Analysis::Static(_) => format!("static, {model}"),
        Analysis::Modes(_) => format!("natural modes, {model}"),
        Analysis::Crossing(crossing) => {
            let solver = match crossing.solver {
                Solver::Reference => "reference solver",
                Solver::Operator { .. } => "bridge operator",
            };
            let step = match crossing.time_step {
                TimeStep::Auto { .. } => "time step of each job's own".to_owned(),
                TimeStep::Stated(seconds) => format!("time step {} ms", number(1e3 * seconds)),
            };
            format!(
                "crossing by the {solver}, {model}, {step}, {} s after the vehicle has left, {}",
                number(crossing.tail_s),
                damping(&crossing.damping)
            )
        }
    }
}

fn damping(of: &DampingSpec) -> String {
    match of.structure {
        None => format!("damping {} %", number(100.0 * of.rayleigh_ratio())),
        Some(own) => format!(
            "damping of the structure {} % at {} Hz",
            number(100.0 * own.ratio),
            number(own.at_hz)
        ),
    }
}

fn number(x: f64) -> String {
    labels::number(x, SHOWN)
}
