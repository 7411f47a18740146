//! Every node of the whole bridge: what is solved of few dofs, held against the full model.

#![allow(clippy::expect_used)]

use pontoon_core::analysis::crossing::CrossingSolver;
use pontoon_core::analysis::modes::modes;
use pontoon_core::analysis::snapshot::Snapshot;
use pontoon_core::analysis::statics::StaticSolver;
use pontoon_core::bridge::{Bridge, BridgeDesign, Ends, MeshedBridge, Model, PreparedModule, Track};
use pontoon_core::connector::{Connection, State};
use pontoon_core::fem::{DOFS_PER_NODE, MassKind, SparseRow, SymmetricMatrix, assemble};
use pontoon_core::vehicle::Inertia;
use pontoon_core::water::spread;
use pontoon_tests::*;
use std::f64::consts::PI;
use std::sync::Arc;

const GAPS: Connection = Connection::Nonlinear {
    gap_tension_m: 0.0,
    gap_compression_m: 0.0055,
};

struct Whole {
    meshed: MeshedBridge,
    bridge: Arc<Bridge>,
}

fn whole(design: &BridgeDesign, model: Model, ends: Ends) -> Whole {
    let module = PreparedModule::new(design, model).expect("a module");
    Whole {
        meshed: MeshedBridge::new(design, &module, ends).expect("a mesh"),
        bridge: Arc::new(Bridge::new(design, &module, ends).expect("a bridge")),
    }
}

/// Largest distance of two fields of displacement as a share of the second's largest component.
fn field_miss(found: &[[f64; 3]], expected: &[[f64; 3]]) -> f64 {
    assert_eq!(found.len(), expected.len());
    let size = expected.iter().flatten().fold(0.0_f64, |most, x| most.max(x.abs()));
    let each = found.iter().flatten().zip(expected.iter().flatten());
    each.fold(0.0_f64, |most, (a, b)| most.max((a - b).abs())) / size
}

fn static_state(design: &BridgeDesign, model: Model) -> (Whole, Snapshot) {
    let whole = whole(design, model, Ends::Supported);
    let setup = Ready::new(design, model);
    let state = StaticSolver::new(&whole.bridge)
        .and_then(|solver| solver.state(&footprint(&[-1.4, 1.4], Inertia::None), &setup.case(GAPS, 2e5, 9.0)))
        .expect("a state");
    (whole, state)
}

/// 1e-9: rounding of the solves on a stiffness of condition 1e7; statics of a super-element are exact, for loads and
/// connectors stand on masters. Twin: E.
#[test]
fn a_static_state_goes_on_to_every_node_as_in_the_full_model() {
    let design = design("smoke");
    let field = |design: &BridgeDesign, model: Model| {
        let (whole, state) = static_state(design, model);
        whole.meshed.displacement_m(&state.u)
    };
    let full = field(&design, Model::Full);
    let condensed = field(&design, Model::SuperElement);
    let stiffer = field(&with_e(&design, 1.05), Model::SuperElement);
    held(
        "displacement of all nodes",
        1e-9,
        field_miss(&condensed, &full),
        field_miss(&stiffer, &full),
    );
}

/// The right end is free to move along the bridge: hinges and connectors of a joint balance each other. 1e-10 of the largest force:
/// rounding of stiff plates' forces that cancel. Twin: hinges.
#[test]
fn hinges_balance_connectors_in_a_static_state() {
    for model in [Model::Full, Model::SuperElement] {
        let (whole, state) = static_state(&design("smoke"), model);
        let hinges: Vec<f64> = state.pin_forces_n(&whole.bridge).iter().map(|force| force[0]).collect();
        let miss_of = |factor: f64| {
            let mut worst = 0.0_f64;
            let mut largest = 0.0_f64;
            for joint in 2..=3 {
                let own = whole
                    .meshed
                    .hinges
                    .iter()
                    .zip(&hinges)
                    .filter(|(h, _)| h.joint == joint);
                let hinged: f64 = own.map(|(_, n)| factor * n).sum();
                let own = whole.meshed.connectors.iter().zip(&state.connectors);
                let connected: f64 = own.filter(|(c, _)| c.joint == joint).map(|(_, now)| now.force_n).sum();
                worst = worst.max((hinged + connected).abs());
                largest = largest.max(connected.abs());
            }
            assert!(largest > 1e4, "{largest}");
            worst / largest
        };
        held("forces of a joint", 1e-10, miss_of(1.0), miss_of(1.05));
    }
}

/// A mode's frequency by Rayleigh's quotient over all modules' own matrices, every node moving as the mesh says:
/// `omega^2 = (sum u^T k u + sum 2 k_c e^2) / sum u^T m u`, e from the nodes that connectors join.
fn quotients_hz(design: &BridgeDesign, model: Model, connector_factor: f64) -> Vec<(f64, f64)> {
    let whole = whole(design, model, Ends::Free);
    let own = design.module_mesh();
    let n = own.mesh.dofs();
    let (k, m) = assemble(&own.mesh, MassKind::Consistent).expect("matrices");
    let water = |per_area: f64| -> SymmetricMatrix {
        let entries: Vec<_> = spread(&own.grid, design.wet_m(), per_area, design.water_distribution)
            .iter()
            .map(|(a, b, v)| (a.dof(2), b.dof(2), *v))
            .collect();
        SymmetricMatrix::from_entries(n, &entries).expect("a matrix")
    };
    let (k_b, m_a) = (water(design.p_b()), water(design.m_a() / design.module.breadth_m));
    let (found, pairs) = modes(&whole.bridge, 12).expect("modes");
    found
        .iter()
        .enumerate()
        .map(|(j, mode)| {
            let shape: Vec<f64> = pairs.shapes.col(j).iter().copied().collect();
            let (moved, turned) = (whole.meshed.displacement_m(&shape), whole.meshed.rotation_rad(&shape));
            let all: Vec<f64> = moved.iter().zip(&turned).flat_map(|(u, r)| [*u, *r].concat()).collect();
            let (mut strain, mut kinetic) = (0.0, 0.0);
            for u in all.chunks(n) {
                strain += k.form(u, u) + k_b.form(u, u);
                kinetic += m.form(u, u) + m_a.form(u, u);
            }
            assert_eq!(all.len(), n * design.modules, "{DOFS_PER_NODE} dofs a node");
            for link in &whole.meshed.connectors {
                let e = moved[link.nodes[1]][0] - moved[link.nodes[0]][0];
                strain += 2.0 * connector_factor * design.connectors.stiffness_n_m * e * e;
            }
            (mode.frequency_hz, (strain / kinetic).max(0.0).sqrt() / (2.0 * PI))
        })
        .collect()
}

/// 1e-9: rounding of forms over matrices whose entries reach 1e7 times the eigenvalue's. Unrestored motions (surge, sway, yaw) have no frequency to compare.
/// Twin: connectors.
#[test]
fn a_mode_on_the_mesh_has_its_frequency() {
    let design = design("smoke");
    for model in [Model::Full, Model::SuperElement] {
        let worst = |factor: f64| {
            let list = quotients_hz(&design, model, factor);
            let restored = list.iter().filter(|(told, _)| *told > 0.01);
            assert!(restored.clone().count() >= 6, "{list:?}");
            largest(restored.map(|(told, found)| miss(*found, *told)))
        };
        held("frequency", 1e-9, worst(1.0), worst(1.05));
    }
}

/// The state between steps is that of the histories, a point's forces are the axle's, and a connector's state is that of its
/// force. Hinges and connectors of a joint balance but for the inertia along the bridge, and for what the scheme balances between
/// two steps and not at their ends: 1 % of the largest force, 0.5 % found. Twin: hinges. The deck under a point moves as the track's
/// row says, 1e-12 m beside centimetres: the same sum of the same nodes. Twin: a column further.
#[test]
fn a_crossing_looked_at_is_the_one_that_is_solved() {
    let design = design("smoke");
    let whole = whole(&design, Model::SuperElement, Ends::Supported);
    let track = Track::new(&whole.bridge);
    let setup = Ready::new(&design, Model::SuperElement);
    for inertia in [Inertia::None, Inertia::Local, Inertia::Convective] {
        let vehicle = footprint(&[-1.4, 1.4], inertia);
        let solver = CrossingSolver::new(&whole.bridge, &settings(setup.rayleigh(), 0.02, 0.9)).expect("a solver");
        let mut crossing = setup.crossing(GAPS, 2e5, 8.0);
        crossing.record.positions = vec![2, 3];
        crossing.record.joints = vec![2];
        let solved = solver.solve_single(&vehicle, &crossing).expect("a crossing");
        let (traffic, asked) = (crossing.traffic(&vehicle), crossing.crossing());
        let mut under = solver.begin(&traffic, &asked);
        let (mut states, mut smallest) = (vec![under.snapshot()], f64::INFINITY);
        while under.step().expect("a step") {
            states.push(under.snapshot());
        }
        assert_eq!(under.finish(), solved);
        assert_eq!(states.len(), solved.recorded.history_time_s.len());
        let closed = |state: State| states.iter().flat_map(|s| &s.connectors).any(|c| c.state == state);
        assert!(closed(State::Open) && closed(State::Tension) && closed(State::Compression));
        let largest = solved.joints[0]
            .sum
            .compression
            .value
            .max(solved.joints[0].sum.tension.value);
        let (mut unbalanced, mut unbalanced_twin) = (0.0_f64, 0.0_f64);
        let (mut off_deck, mut off_deck_twin) = (0.0_f64, 0.0_f64);
        for (i, state) in states.iter().enumerate() {
            assert_eq!(state.time_s, solved.recorded.history_time_s[i]);
            let joint: f64 = state.connectors[..2].iter().map(|c| c.force_n).sum();
            assert_eq!(joint, solved.recorded.histories[2].values[i]);
            let hinged: f64 = state.pin_forces_n(&whole.bridge)[..3]
                .iter()
                .map(|force| force[0])
                .sum();
            unbalanced = unbalanced.max((joint + hinged).abs() / largest);
            unbalanced_twin = unbalanced_twin.max((joint + 1.05 * hinged).abs() / largest);
            for connector in &state.connectors {
                let sense = match connector.state {
                    State::Open => connector.force_n == 0.0,
                    State::Tension | State::TensionStop => connector.force_n >= 0.0,
                    State::Compression | State::CompressionStop => connector.force_n <= 0.0,
                    State::Both => false,
                };
                assert!(sense, "{connector:?}");
            }
            // the bottom's centre line at position 2, by the mesh
            let moved = whole.meshed.displacement_m(&state.u);
            let at_2 = whole
                .meshed
                .hinges
                .iter()
                .find(|h| h.joint == 2 && h.y_m == 0.0)
                .expect("a hinge");
            let deflection = -moved[at_2.nodes[0]][2];
            assert!((deflection - solved.recorded.histories[0].values[i]).abs() < 1e-12);
            if state.wheels.iter().all(|wheel| wheel.row.is_some()) {
                // an axle counts from 50 ms after its last point came onto a module
                let length_m = design.module.length_m;
                let on_module_m = |x_m: f64| x_m - length_m * (x_m / length_m).floor().min(design.modules as f64 - 1.0);
                if state
                    .wheels
                    .iter()
                    .all(|w| on_module_m(w.x_m) >= 0.05 * crossing.speed_m_s)
                {
                    let force: f64 = state.wheels.iter().map(|w| w.contact_force_n).sum();
                    smallest = force.min(smallest);
                }
                for wheel in &state.wheels {
                    let row = wheel.row.as_ref().expect("on the bridge");
                    let by_row: f64 = row.0.iter().map(|&(c, part)| part * state.u[track.dof(c)]).sum();
                    let off = |row: &SparseRow| (whole.meshed.of_deck_m(row, &moved)[2] - by_row).abs();
                    off_deck = off_deck.max(off(row));
                    let shifted = row.0.iter().map(|&(c, part)| ((c + 1) % track.columns(), part));
                    let shifted = SparseRow(shifted.collect());
                    off_deck_twin = off_deck_twin.max(off(&shifted));
                }
            }
        }
        held("forces of a joint", 0.01, unbalanced, unbalanced_twin);
        held("deck under a point", 1e-12, off_deck, off_deck_twin);
        // steps were not halved, so that the smallest force is one of those seen
        assert_eq!(solved.statistics.bisections, 0);
        let told = solved.least_contact.force_n;
        assert!(
            (smallest - told).abs() <= 1e-9 * told.abs(),
            "{inertia:?}: {smallest} {told}"
        );
    }
}
