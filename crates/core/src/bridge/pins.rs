//! Pins: the forces in the hinges, which one module of a joint needs to move as it does.
//!
//! Knows the rows of a module's own matrices at its hinges. Does not know how the motion came about, nor peaks.

use super::BridgeDesign;
use super::dead::DeadLoads;
use super::modules::Modules;
use super::prepared::{Side, X, Y, Z};
use super::row::Row;
use super::waves::BridgeWaves;
use crate::fem::{SparseRow, SymmetricMatrix};
use crate::radiation::FREEDOMS_PER_MODULE;
use crate::response::JointParts;

/// A hinge place of a joint, by the module left of it.
#[derive(Debug, Clone)]
pub(crate) struct PinPlace {
    /// Number of the joint, 2 to modules.
    pub joint: usize,
    /// Place across `[m]`.
    pub y_m: f64,
    /// Along, across and up.
    pub rows: [PinRow; 3],
}

/// The rows of one direction of a pin.
#[derive(Debug, Clone)]
pub(crate) struct PinRow {
    /// Stiffness and mass of the module in the tied freedom, by the bridge's dofs, and what of the stiffness the water has.
    pub stiffness: SparseRow,
    pub mass: SparseRow,
    pub water: SparseRow,
    /// Share of the forces of water with memory that act on the module there, by their freedoms.
    pub waves: SparseRow,
    /// Columns of the track that lie on the tied freedom and belong to this module, where the deck ends in the hinges.
    pub columns: Vec<usize>,
    /// Dead load on the module there, in the direction `[N]`: what lies on it, and of water that has risen by 1 m.
    pub dead_n: [f64; 2],
}

/// What acts on a bridge where a balance holds.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Acting<'a> {
    /// `u + a u'`, on which the stiffness acts.
    pub elastic: &'a [f64],
    /// `(a - a_w) u'`, which the water's springs do not feel of it; none where they feel all.
    pub beyond_water: Option<&'a [f64]>,
    /// `u'' + b u'`, on which the mass acts; none at rest.
    pub inertial: Option<&'a [f64]>,
    /// Forces of water with memory `[N, N m]`; none where there is none.
    pub waves: Option<&'a [f64]>,
    /// What presses on each column of the track `[N]`.
    pub down: &'a [SparseRow],
}

impl PinRow {
    /// Force of the pin on the module `[N]`: what moves it, less what acts on it from elsewhere.
    /// Equation (J6).
    pub(crate) fn force_n(&self, acting: &Acting<'_>) -> f64 {
        let pressed = |row: &SparseRow| -> f64 {
            let here = row.0.iter().filter(|(column, _)| self.columns.contains(column));
            here.map(|(_, force)| force).sum()
        };
        let pressed: f64 = if self.columns.is_empty() {
            0.0
        } else {
            acting.down.iter().map(pressed).sum()
        };
        let on = |row: &SparseRow, what: Option<&[f64]>| what.map_or(0.0, |what| row.dot(what));
        let dynamic = on(&self.mass, acting.inertial) - on(&self.water, acting.beyond_water);
        self.stiffness.dot(acting.elastic) + (dynamic - on(&self.waves, acting.waves)) + pressed
    }
}

/// The pins of all joints, joint after joint, each joint's in the order of its hinges.
/// `deck_z` are the dofs of the deck's z, `[module][ix][iy]`.
pub(super) fn pins(
    design: &BridgeDesign,
    modules: &Modules<'_>,
    row: &Row<'_>,
    deck_z: &[Vec<Vec<usize>>],
    (dead, waves): (&DeadLoads, Option<&BridgeWaves>),
) -> Vec<PinPlace> {
    let (lines, stations) = (modules.lines_y().len(), deck_z.iter().map(Vec::len).sum::<usize>());
    let columns = |j: usize, dof: usize| -> Vec<usize> {
        let first: usize = deck_z[..j].iter().map(Vec::len).sum();
        let nodes = (0..lines).flat_map(|line| (0..deck_z[j].len()).map(move |ix| (line, ix)));
        let here = nodes.filter(|&(line, ix)| deck_z[j][ix][line] == dof);
        here.map(|(line, ix)| line * stations + first + ix).collect()
    };
    let place = |joint: usize, y_m: f64| {
        let (j, module) = (joint - 2, modules.module(joint - 2));
        let pin = |direction: usize| {
            let dof = module.end_dof(Side::Right, y_m, direction)?;
            let of = |matrix: &SymmetricMatrix| row.global(j, &SparseRow(matrix.column(dof).collect()));
            let own = module.motions.iter().enumerate().flat_map(|(freedom, motion)| {
                let here = motion.0.iter().filter(|(of, _)| *of == dof);
                here.map(move |(_, g)| (FREEDOMS_PER_MODULE * j + freedom, *g))
            });
            let on_module = SparseRow(own.filter(|(_, g)| waves.is_some() && *g != 0.0).collect());
            let in_waves = waves.map_or_else(SparseRow::default, |waves| waves.mass_row(&on_module));
            Some(PinRow {
                stiffness: of(&module.k),
                mass: SparseRow::combine(&[(1.0, &of(&module.m)), (1.0, &dead.mass_row(j, dof)), (1.0, &in_waves)]),
                water: of(&module.k_water),
                waves: on_module,
                dead_n: dead.at(j, dof),
                columns: match (direction, row.map[j][dof]) {
                    (Z, Some(tied)) => columns(j, tied),
                    _ => Vec::new(),
                },
            })
        };
        let [x, y, z] = [X, Y, Z].map(pin);
        Some(PinPlace {
            joint,
            y_m,
            rows: [x?, y?, z?],
        })
    };
    (2..=design.modules)
        .flat_map(|joint| {
            design
                .hinges_of(joint)
                .y_m
                .iter()
                .filter_map(move |&y| place(joint, y))
                .collect::<Vec<_>>()
        })
        .collect()
}

/// The parts of all joints.
pub(crate) fn joint_parts(design: &BridgeDesign) -> Vec<JointParts> {
    let (mut first_pin, outlines) = (0, design.outlines());
    (2..=design.modules)
        .map(|joint| {
            let parts = JointParts {
                joint,
                first_connector: (joint - 2) * design.connectors.y_m.len(),
                connectors_y_m: design.connectors.y_m.clone(),
                first_pin,
                pins_y_m: design.hinges_of(joint).y_m.clone(),
                depth_m: outlines[joint - 2].depths_m()[1].min(outlines[joint - 1].depths_m()[0]),
            };
            first_pin += parts.pins_y_m.len();
            parts
        })
        .collect()
}

/// What acts on each dof of each module, for tests of free bodies.
#[cfg(test)]
pub(crate) struct ModuleForces {
    /// Dof of the bridge; none where a support holds it.
    pub global: Option<usize>,
    /// Direction of a translation on the modules' ends that hinges may tie: side, place across, direction.
    pub tied: Option<(Side, f64, usize)>,
    /// What moves the module there, less what presses on its deck `[N or N m]`.
    pub force: f64,
    /// Translations of the dof along, across and up, where it is one.
    pub rigid: [f64; 3],
}

#[cfg(test)]
#[allow(clippy::expect_used)]
impl ModuleForces {
    /// Of each module, at each of its dofs.
    pub(crate) fn of(
        design: &BridgeDesign,
        module: &super::PreparedModule,
        waves: Option<&BridgeWaves>,
        acting: &Acting<'_>,
    ) -> Vec<Vec<Self>> {
        let (down, nothing) = (acting.down, vec![0.0; acting.elastic.len()]);
        // forces of the water's memory and of its mass on heave, pitch and roll of each module
        let of_waves: Vec<f64> = waves.map_or_else(Vec::new, |waves| {
            let moved = nalgebra::DVector::from_vec(waves.motion(acting.inertial.unwrap_or(&nothing)));
            let mass = waves.radiation.infinite() * moved;
            let memory = acting.waves.unwrap_or(&[]);
            mass.iter().zip(memory).map(|(mass, memory)| mass - memory).collect()
        });
        let prepared = [module];
        let modules = Modules::new(design, &prepared).expect("the modules of the design");
        let row = Row::number(design, &modules, super::Ends::Supported);
        let (grid, nx, ny) = (&module.grid, module.grid.x.len(), module.grid.y.len());
        let of_module = |j: usize| {
            let own = |x: &[f64]| -> Vec<f64> { row.map[j].iter().map(|dof| dof.map_or(0.0, |dof| x[dof])).collect() };
            let (elastic, inertial) = (own(acting.elastic), acting.inertial.map(own));
            let beyond_water = acting.beyond_water.map(own);
            let on_water = |dof: usize| -> f64 {
                let motions = of_waves.iter().skip(FREEDOMS_PER_MODULE * j).zip(&module.motions);
                let at = |row: &SparseRow| row.0.iter().filter(|(of, _)| *of == dof).map(|(_, g)| g).sum::<f64>();
                motions.map(|(force, row)| at(row) * force).sum()
            };
            let mut forces: Vec<Self> = (0..module.dofs())
                .map(|dof| {
                    let of = |matrix: &SymmetricMatrix, x: &[f64]| SparseRow(matrix.column(dof).collect()).dot(x);
                    Self {
                        global: row.map[j][dof],
                        tied: None,
                        force: of(&module.k, &elastic) + inertial.as_ref().map_or(0.0, |x| of(&module.m, x))
                            - beyond_water.as_ref().map_or(0.0, |x| of(&module.k_water, x))
                            + on_water(dof),
                        rigid: [0.0; 3],
                    }
                })
                .collect();
            for node in 0..module.mesh.nodes.len() {
                for direction in [X, Y, Z] {
                    if let Some(dof) = module.dof(crate::fem::NodeId(node), direction) {
                        forces[dof].rigid[direction] = 1.0;
                    }
                }
            }
            for side in [Side::Left, Side::Right] {
                for (iy, direction) in (0..ny).flat_map(|iy| [X, Y, Z].map(|direction| (iy, direction))) {
                    if let Some(dof) = module.dof(grid.bottom(module.end_line(side), iy), direction) {
                        forces[dof].tied = Some((side, grid.y[iy], direction));
                    }
                }
            }
            for (line, ix) in (0..ny).flat_map(|line| (0..nx).map(move |ix| (line, ix))) {
                let column = (line * design.modules + j) * nx + ix;
                let pressed = down.iter().flat_map(|row| &row.0).filter(|(of, _)| *of == column);
                if let Some(dof) = module.dof(grid.deck(ix, line), Z) {
                    forces[dof].force += pressed.map(|(_, force)| force).sum::<f64>();
                }
            }
            forces
        };
        (0..design.modules).map(of_module).collect()
    }
}
