//! A state of the bridge as grids: its mesh, its joints, the vehicle.
//!
//! Knows which array says what. Does not know files or how the state was found.

use super::ready::Ready;
use super::stresses::{self, StressEnvelope};
use super::vtk::{Array, CellType, VtkGrid, VtkValues};
use pontoon_core::analysis::snapshot::Snapshot;
use pontoon_core::bridge::{BridgeStresses, Link};
use pontoon_core::connector::State;
use pontoon_core::module::Plate;

/// What a number in `link` says.
pub(super) const LINKS: [&str; 2] = ["connector", "hinge"];

/// What a number in `state` says.
pub(super) const STATES: [&str; 3] = ["open", "compression", "tension"];

/// What a number in `plate` says; the last is a beam.
pub(super) fn plates() -> Vec<&'static str> {
    let plates = Plate::ALL.iter().map(|plate| plate.word());
    plates.chain(["stiffener beam"]).collect()
}

/// How far to either side of its joint a link is drawn, as a share of a module: at rest its ends are at one place.
const DRAWN: f64 = 0.05;

/// The name of every grid's vectors of motion.
const MOTION: &str = "displacement";

/// The grids of one bridge, with what does not change filled in.
#[derive(Debug)]
pub(super) struct Pictures {
    mesh: VtkGrid,
    joints: VtkGrid,
}

impl Pictures {
    /// The grids of a bridge.
    pub(super) fn of(ready: &Ready) -> Self {
        let design = ready.bridge.design();
        Self {
            mesh: mesh(ready),
            joints: joints(ready, DRAWN * design.shortest_module_m()),
        }
    }

    /// The mesh with its nodes moved, and its cells' stresses where they are wanted.
    pub(super) fn mesh(
        &self,
        displacement_m: &[[f64; 3]],
        stresses: Option<&BridgeStresses>,
        fields: Vec<Array>,
    ) -> VtkGrid {
        let mut grid = self.mesh.clone();
        grid.point_data.push(Array::vectors(MOTION, displacement_m));
        grid.cell_data
            .extend(stresses.map(stresses::arrays).into_iter().flatten());
        grid.field_data.extend(fields);
        grid
    }

    /// The mesh at rest with the envelope of its cells' stresses.
    pub(super) fn envelope(&self, envelope: &StressEnvelope) -> VtkGrid {
        let mut grid = self.mesh.clone();
        grid.cell_data.extend(envelope.arrays());
        grid
    }

    /// Connectors and hinges: each end moves as the node that it stands for.
    pub(super) fn joints(
        &self,
        ready: &Ready,
        state: &Snapshot,
        displacement_m: &[[f64; 3]],
        fields: Vec<Array>,
    ) -> VtkGrid {
        let meshed = &ready.meshed;
        let pins = state.pin_forces_n(&ready.bridge);
        let hinges: Vec<f64> = pins.iter().map(|force| force[0]).collect();
        let sense = |force_n: f64| i32::from(force_n < 0.0) + 2 * i32::from(force_n > 0.0);
        let now = &state.connectors[..meshed.connectors.len()];
        let of_connectors = now.iter().map(|connector| match connector.state {
            State::Open => 0,
            State::Compression | State::CompressionStop => 1,
            State::Tension | State::TensionStop => 2,
            State::Both => sense(connector.force_n),
        });
        let states = of_connectors.chain(hinges.iter().map(|&force_n| sense(force_n)));
        let forces = now.iter().map(|c| c.force_n).chain(hinges.iter().copied());
        let on_left = now.iter().map(|c| [c.force_n, 0.0, 0.0]).chain(pins.iter().copied());
        let on_left: Vec<[f64; 3]> = on_left.collect();
        let elongations = now.iter().map(|c| c.elongation_m).chain(hinges.iter().map(|_| 0.0));
        let moved: Vec<[f64; 3]> = links(ready)
            .flat_map(|link| link.nodes)
            .map(|n| displacement_m[n])
            .collect();
        let mut grid = self.joints.clone();
        grid.point_data.push(Array::vectors(MOTION, &moved));
        grid.cell_data.extend([
            Array::new("state", VtkValues::I32(states.collect())),
            Array::new("force_n", VtkValues::F64(forces.collect())),
            Array::new("elongation_m", VtkValues::F64(elongations.collect())),
            Array::vectors("force_on_left_n", &on_left),
        ]);
        grid.field_data.extend(fields);
        grid
    }

    /// The vehicle's points on the deck, moved with it; off the bridge they stand at its height.
    pub(super) fn vehicle(ready: &Ready, state: &Snapshot, displacement_m: &[[f64; 3]], fields: Vec<Array>) -> VtkGrid {
        let wheels = &state.wheels;
        let design = ready.bridge.design();
        let places: Vec<[f64; 3]> = wheels.iter().map(|w| [w.x_m, w.y_m, design.deck_m(w.x_m)]).collect();
        let moved = wheels.iter().map(|wheel| {
            let row = wheel.row.as_ref();
            row.map_or([0.0; 3], |row| ready.meshed.of_deck_m(row, displacement_m))
        });
        let numbers = |of: &dyn Fn(usize) -> usize| VtkValues::I32((0..wheels.len()).map(|i| of(i) as i32).collect());
        let mut grid = VtkGrid::new(&places);
        (0..wheels.len()).for_each(|i| grid.cell(CellType::Vertex, &[i]));
        grid.point_data = vec![
            Array::vectors(MOTION, &moved.collect::<Vec<_>>()),
            Array::new(
                "contact_force_n",
                VtkValues::F64(wheels.iter().map(|w| w.contact_force_n).collect()),
            ),
            Array::new("axle", numbers(&|i| wheels[i].axle + 1)),
            Array::new("patch", numbers(&|i| wheels[i].patch + 1)),
            Array::new("on_bridge", numbers(&|i| usize::from(wheels[i].row.is_some()))),
        ];
        grid.field_data = vec![version()];
        grid.field_data.extend(fields);
        grid
    }
}

/// The program's version as a field.
fn version() -> Array {
    Array::text("program_version", pontoon_results::VERSION)
}

fn mesh(ready: &Ready) -> VtkGrid {
    let meshed = &ready.meshed;
    let mut grid = VtkGrid::new(&meshed.nodes_m);
    let number = |plate: Plate| Plate::ALL.iter().position(|p| *p == plate).unwrap_or(Plate::ALL.len()) as i32;
    let (mut plates, mut thicknesses, mut modules) = (Vec::new(), Vec::new(), Vec::new());
    for shell in &meshed.shells {
        grid.cell(CellType::Quad, &shell.nodes);
        plates.push(number(shell.plate));
        thicknesses.push(shell.thickness_m);
        modules.push(shell.module as i32);
    }
    for beam in &meshed.beams {
        grid.cell(CellType::Line, &beam.nodes);
        plates.push(Plate::ALL.len() as i32);
        thicknesses.push(0.0);
        modules.push(beam.module as i32);
    }
    grid.cell_data = vec![
        Array::new("plate", VtkValues::I32(plates)),
        Array::new("thickness_m", VtkValues::F64(thicknesses)),
        Array::new("module", VtkValues::I32(modules)),
    ];
    grid.field_data = vec![version()];
    grid
}

/// Connectors, then hinges.
fn links(ready: &Ready) -> impl Iterator<Item = &Link> {
    ready.meshed.connectors.iter().chain(&ready.meshed.hinges)
}

fn joints(ready: &Ready, drawn_m: f64) -> VtkGrid {
    let places = links(ready).flat_map(|link| {
        [(0, -drawn_m), (1, drawn_m)].map(|(end, aside)| {
            let [x, y, z] = ready.meshed.nodes_m[link.nodes[end]];
            [x + aside, y, z]
        })
    });
    let mut grid = VtkGrid::new(&places.collect::<Vec<_>>());
    (0..links(ready).count()).for_each(|i| grid.cell(CellType::Line, &[2 * i, 2 * i + 1]));
    let connectors = ready.meshed.connectors.len();
    let kinds = (0..links(ready).count()).map(|i| i32::from(i >= connectors));
    grid.cell_data = vec![
        Array::new("link", VtkValues::I32(kinds.collect())),
        Array::new(
            "joint",
            VtkValues::I32(links(ready).map(|link| link.joint as i32).collect()),
        ),
        Array::new("y_m", VtkValues::F64(links(ready).map(|link| link.y_m).collect())),
    ];
    grid.field_data = vec![version()];
    grid
}
