//! Free bodies: on each module what pins, connectors, water, wheels and inertia do adds up to zero at the balance.

#![allow(clippy::expect_used)]

use super::{Crossing, CrossingSettings, CrossingSolver};
use crate::analysis::modes::Rayleigh;
use crate::analysis::snapshot::{Snapshot, WheelNow};
use crate::analysis::statics::{StaticCase, StaticSolver};
use crate::bridge::{Acting, Bridge, BridgeDesign, Ends, Model, ModuleForces, PreparedModule, WaterSpec};
use crate::connector::Connection;
use crate::fem::SparseRow;
use crate::radiation::chain_water;
use crate::response::{Axis, Record, Subject};
use crate::scheme::Scheme;
use crate::traffic::Traffic;
use crate::vehicle::{Inertia, Vehicle, VehicleDesign};
use std::collections::BTreeMap;
use std::sync::Arc;

const LOAD_N: f64 = 230_300.0;
const GAPS: Connection = Connection::Nonlinear {
    gap_tension_m: 0.001,
    gap_compression_m: 0.0005,
};

struct Setup {
    design: BridgeDesign,
    module: PreparedModule,
    bridge: Arc<Bridge>,
}

fn setup(model: Model) -> Setup {
    let text = include_str!("../../../../../studies/bridges/smoke.json");
    let mut design: BridgeDesign = serde_json::from_str(text).expect("a design");
    design.modules = 4;
    let module = PreparedModule::new(&design, model).expect("a module");
    let bridge = Arc::new(Bridge::new(&design, &module, Ends::Supported).expect("a bridge"));
    Setup { design, module, bridge }
}

/// Puts a bridge into a water that is made up.
fn in_waves(of: Setup) -> Setup {
    let mut design = of.design;
    design.added_mass_kg_m = None;
    design.water = Some(WaterSpec {
        radiation: Some(Arc::new(chain_water(
            design.modules,
            design.module.length_m,
            design.module.breadth_m,
            1.0,
        ))),
        ..WaterSpec::default()
    });
    let module = PreparedModule::new(&design, Model::SuperElement).expect("a module");
    let bridge = Arc::new(Bridge::new(&design, &module, Ends::Supported).expect("a bridge"));
    Setup { design, module, bridge }
}

fn vehicle(inertia: Inertia) -> Vehicle {
    let design = VehicleDesign {
        inertia,
        ..VehicleDesign::default()
    };
    design.check(8.0).expect("a vehicle")
}

/// Largest force that is left over on any free body, as a share of the load: off the pins at each dof, at the pins on both
/// sides of each joint, along, across and up of each module as a whole. `off` is a share by which the pins are wrong.
fn left_over(setup: &Setup, bodies: &[Vec<ModuleForces>], connectors_n: &[f64], pins_n: &[[f64; 3]], off: f64) -> f64 {
    let mut pulled: BTreeMap<usize, f64> = BTreeMap::new();
    for (connector, force) in setup.bridge.links.iter().zip(connectors_n) {
        for &(dof, factor) in &connector.row.0 {
            *pulled.entry(dof).or_default() += factor * force;
        }
    }
    let last = bodies.len() - 1;
    let mut worst = 0.0_f64;
    for (j, body) in bodies.iter().enumerate() {
        let mut sums = [0.0; 3];
        for dof in body {
            let connector = dof
                .global
                .and_then(|global| pulled.get(&global))
                .copied()
                .unwrap_or(0.0);
            let (joint, sign) = match dof.tied {
                Some((crate::bridge::Side::Right, ..)) if j < last => (j + 2, 1.0),
                Some((crate::bridge::Side::Left, ..)) if j > 0 => (j + 1, -1.0),
                _ => (0, 0.0),
            };
            let pin = dof.tied.and_then(|(_, y_m, direction)| {
                let mut places = setup.bridge.pins.iter().zip(pins_n);
                let (_, force) = places.find(|(pin, _)| pin.joint == joint && (pin.y_m - y_m).abs() < 1e-9)?;
                Some(sign * (1.0 + off) * force[direction])
            });
            // a support's reaction is the rest of it
            let left = if dof.global.is_none() {
                0.0
            } else {
                dof.force + connector - pin.unwrap_or(0.0)
            };
            worst = worst.max(left.abs());
            (0..3).for_each(|axis| sums[axis] += dof.rigid[axis] * left);
        }
        worst = sums.iter().fold(worst, |worst, sum| worst.max(sum.abs()));
    }
    worst / LOAD_N
}

fn connectors_n(state: &Snapshot) -> Vec<f64> {
    state.connectors.iter().map(|of| of.force_n).collect()
}

fn pressed(wheel: &WheelNow, force_n: f64) -> SparseRow {
    wheel
        .row
        .as_ref()
        .map_or_else(SparseRow::default, |row| SparseRow::combine(&[(force_n, row)]))
}

/// At rest: 1e-10 of the load, rounding of the solve. Twin: pins 5 % off.
#[test]
fn static_free_bodies_are_in_equilibrium() {
    for model in [Model::SuperElement, Model::Full] {
        let setup = setup(model);
        let solver = StaticSolver::new(&setup.bridge).expect("statics");
        let vehicle = vehicle(Inertia::None);
        for load_x_m in [3.0, 6.7, 11.0] {
            let case = StaticCase {
                connection: GAPS,
                connector_stiffness_n_m: setup.design.connectors.stiffness_n_m,
                own_laws: [].into(),
                load_n: LOAD_N,
                load_x_m,
                places_x_m: Vec::new(),
                dead: None,
            };
            let pins_n = solver.solve(&vehicle, &case).expect("solved").pins_n;
            let state = solver.state(&vehicle, &case).expect("a state");
            let down: Vec<SparseRow> = state.wheels.iter().map(|w| pressed(w, w.contact_force_n)).collect();
            let acting = Acting {
                elastic: &state.elastic,
                down: &down,
                ..Acting::default()
            };
            let bodies = ModuleForces::of(&setup.design, &setup.module, None, &acting);
            let [right, wrong] = [0.0, 0.05].map(|off| left_over(&setup, &bodies, &connectors_n(&state), &pins_n, off));
            assert!(
                right < 1e-10,
                "{model:?} at {load_x_m} m: {right:e} of the load is left over"
            );
            assert!(wrong > 1e-10, "pins 5 % off pass");
        }
    }
}

/// In a crossing, at each instant of the balance: 1e-8 of the load, rounding of some hundred steps. Twin: pins 5 % off.
#[test]
fn moving_free_bodies_are_in_equilibrium() {
    moving(&setup(Model::SuperElement), Rayleigh::new(0.02, 0.1));
}

/// In water with memory, damping that of the structure alone.
#[test]
fn moving_free_bodies_are_in_equilibrium_in_waves() {
    moving(&in_waves(setup(Model::SuperElement)), Rayleigh::of_structure(0.02, 1.0));
}

fn moving(setup: &Setup, rayleigh: Rayleigh) {
    let settings = CrossingSettings {
        rayleigh,
        time_step_s: 0.01,
        spectral_radius: 0.9,
        newton_limit: 60,
        bisection_limit: 4,
    };
    let scheme = Scheme::new(settings.time_step_s, settings.spectral_radius);
    let solver = CrossingSolver::new(&setup.bridge, &settings).expect("a solver");
    for inertia in [Inertia::None, Inertia::Local, Inertia::Convective] {
        let vehicle = vehicle(inertia);
        let mut more = Vec::new();
        for pin in &setup.bridge.pins {
            let joint = pin.joint;
            let index = more.iter().filter(|of: &&Subject| of.position() == Some(joint)).count() / 3;
            more.extend(Axis::ALL.map(|axis| Subject::Pin { joint, index, axis }));
        }
        let crossing = Crossing {
            connection: GAPS,
            connector_stiffness_n_m: setup.design.connectors.stiffness_n_m,
            own_laws: [].into(),
            tail_s: 1.0,
            record: Record {
                more,
                ..Record::default()
            },
            dead: None,
        };
        let traffic = Traffic::single(&vehicle, LOAD_N, 9.0);
        let mut run = solver.begin(&traffic, &crossing);
        let mut states = vec![run.snapshot()];
        while run.step().expect("a step") {
            states.push(run.snapshot());
        }
        let recorded = run.finish().recorded;
        let (mut right, mut wrong) = (0.0_f64, 0.0_f64);
        for (step, pair) in states.windows(2).enumerate() {
            let [old, new] = [&pair[0], &pair[1]];
            let balance = Balance::new(&scheme, settings.rayleigh, old, new);
            let pins: Vec<[f64; 3]> = recorded
                .histories
                .chunks(3)
                .map(|of| [0, 1, 2].map(|d| of[d].values[step + 1]))
                .collect();
            let down = balance.down(&vehicle);
            let acting = Acting {
                elastic: &balance.elastic,
                beyond_water: Some(&balance.beyond_water),
                inertial: Some(&balance.inertial),
                waves: balance.waves.as_deref(),
                down: &down,
            };
            let bodies = ModuleForces::of(&setup.design, &setup.module, setup.bridge.waves.as_ref(), &acting);
            let connectors: Vec<f64> = connectors_n(new)
                .iter()
                .zip(connectors_n(old))
                .map(|(n, o)| scheme.at_f(*n, o))
                .collect();
            let [r, w] = [0.0, 0.05].map(|off| left_over(setup, &bodies, &connectors, &pins, off));
            (right, wrong) = (right.max(r), wrong.max(w));
        }
        assert!(right < 1e-8, "{inertia:?}: {right:e} of the load is left over");
        assert!(wrong > 1e-8, "pins 5 % off pass");
    }
}

/// What two states of a step are at its balance.
struct Balance<'a> {
    scheme: &'a Scheme,
    states: [&'a Snapshot; 2],
    elastic: Vec<f64>,
    beyond_water: Vec<f64>,
    inertial: Vec<f64>,
    waves: Option<Vec<f64>>,
}

impl<'a> Balance<'a> {
    fn new(scheme: &'a Scheme, rayleigh: Rayleigh, old: &'a Snapshot, new: &'a Snapshot) -> Self {
        let Rayleigh { a, b, .. } = rayleigh;
        let v = |of: &Snapshot, i: usize| (of.elastic[i] - of.u[i]) / a;
        let acceleration = |of: &Snapshot, i: usize| of.inertial.as_ref().expect("a motion")[i] - b * v(of, i);
        let dofs = || 0..new.u.len();
        Self {
            elastic: dofs().map(|i| scheme.at_f(new.elastic[i], old.elastic[i])).collect(),
            beyond_water: dofs()
                .map(|i| rayleigh.beyond_water() * scheme.at_f(v(new, i), v(old, i)))
                .collect(),
            waves: new.waves.as_ref().zip(old.waves.as_ref()).map(|(new, old)| {
                let forces = new.iter().zip(old);
                forces.map(|(new, old)| scheme.at_f(*new, *old)).collect()
            }),
            inertial: dofs()
                .map(|i| {
                    scheme.at_m(acceleration(new, i), acceleration(old, i)) + b * scheme.at_f(v(new, i), v(old, i))
                })
                .collect(),
            scheme,
            states: [old, new],
        }
    }

    /// What wheels press on the deck with: weights by one mean, inertia by the other.
    fn down(&self, vehicle: &Vehicle) -> Vec<SparseRow> {
        let shares = || {
            vehicle
                .patches
                .iter()
                .flat_map(|patch| patch.points.iter().map(|point| point.share))
        };
        let [old, new] = self.states;
        let of = |state: &Snapshot, f: f64, m: f64| -> Vec<SparseRow> {
            let wheels = state.wheels.iter().zip(shares());
            wheels
                .map(|(wheel, share)| pressed(wheel, f * LOAD_N * share + m * (wheel.contact_force_n - LOAD_N * share)))
                .collect()
        };
        let (f, m) = (self.scheme.alpha_f, self.scheme.alpha_m);
        let mut down = of(new, 1.0 - f, 1.0 - m);
        down.extend(of(old, f, m));
        down
    }
}
