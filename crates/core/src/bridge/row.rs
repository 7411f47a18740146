//! A row of modules: the numbering of its dofs with ties and supports exact.
//!
//! Knows which dofs are one and which do not move. Does not know what is loaded or read.

use super::modules::Modules;
use super::prepared::{PreparedModule, Side, X, Y, Z};
use super::{BridgeDesign, Direction, Ends};
use crate::fem::{NodeId, SparseRow, SymmetricMatrix};

/// A held dof: where it is and the reaction it gives, `row . u` less the dead load there.
#[derive(Debug, Clone)]
pub(crate) struct HeldDof {
    pub x_m: f64,
    pub y_m: f64,
    pub vertical: bool,
    pub row: SparseRow,
    /// Upward dead load on it `[N]`: what lies there, and of water that has risen by 1 m.
    pub dead_n: [f64; 2],
}

/// The numbering of a row of modules.
pub(super) struct Row<'a> {
    /// For each module and each of its dofs the number in the bridge; none where held.
    pub(super) map: Vec<Vec<Option<usize>>>,
    pub(super) dofs: usize,
    modules: &'a Modules<'a>,
}

impl<'a> Row<'a> {
    /// Numbers module after module; a left hinge node takes the numbers of the right hinge node it is tied to.
    pub(super) fn number(design: &BridgeDesign, modules: &'a Modules<'a>, ends: Ends) -> Self {
        let mut row = Self {
            map: Vec::with_capacity(modules.len()),
            dofs: 0,
            modules,
        };
        for (j, module) in modules.each().enumerate() {
            let mut own: Vec<Option<Option<usize>>> = vec![None; module.dofs()];
            if j > 0 {
                let before = modules.module(j - 1);
                for &y_m in &design.hinges_of(j + 1).y_m {
                    for direction in [X, Y, Z] {
                        let left = module.end_dof(Side::Left, y_m, direction);
                        let right = before.end_dof(Side::Right, y_m, direction);
                        if let (Some(left), Some(right)) = (left, right) {
                            own[left] = Some(row.map[j - 1][right]);
                        }
                    }
                }
            }
            if ends == Ends::Supported {
                for (side, at_end, held) in [
                    (Side::Left, j == 0, &design.supports.left),
                    (Side::Right, j + 1 == modules.len(), &design.supports.right),
                ] {
                    if at_end {
                        for dof in held_dofs(module, side, held, &design.hinges.y_m) {
                            own[dof] = Some(None);
                        }
                    }
                }
            }
            let numbered = own
                .into_iter()
                .map(|known| {
                    known.unwrap_or_else(|| {
                        row.dofs += 1;
                        Some(row.dofs - 1)
                    })
                })
                .collect();
            row.map.push(numbered);
        }
        row
    }

    /// Entries of every module's matrix at its place.
    pub(super) fn entries(&self, matrix: fn(&PreparedModule) -> &SymmetricMatrix) -> Vec<(usize, usize, f64)> {
        let place =
            |map: &Vec<Option<usize>>, (i, j, v): (usize, usize, f64)| map[i].zip(map[j]).map(|(i, j)| (i, j, v));
        self.map
            .iter()
            .zip(self.modules.each())
            .flat_map(|(map, module)| matrix(module).entries().filter_map(|e| place(map, e)))
            .collect()
    }

    /// A row of module `j` in terms of the bridge's dofs; held dofs do not move.
    pub(super) fn global(&self, j: usize, row: &SparseRow) -> SparseRow {
        SparseRow::from_entries(
            row.0
                .iter()
                .filter_map(|&(i, v)| self.map[j][i].map(|i| (i, v)))
                .collect(),
        )
    }

    /// Number of a translation that is a dof of its own and not held; every deck z is.
    pub(super) fn direct(&self, j: usize, node: NodeId, direction: usize) -> usize {
        self.modules
            .module(j)
            .dof(node, direction)
            .and_then(|dof| self.map[j][dof])
            .unwrap_or(usize::MAX)
    }

    /// The water's force up, or its moment about x or y through the bridge's left end.
    pub(super) fn water_resultant(&self, which: usize) -> SparseRow {
        let modules = self.modules.each().enumerate();
        let rows: Vec<SparseRow> = modules
            .map(|(j, module)| {
                let own = self.global(j, &module.water[which]);
                if which < 2 {
                    return own;
                }
                // about y: the module's own moment and its force times its place
                let force = self.global(j, &module.water[0]);
                SparseRow::combine(&[(1.0, &own), (-self.modules.left_m(j), &force)])
            })
            .collect();
        SparseRow::combine(&rows.iter().map(|r| (1.0, r)).collect::<Vec<_>>())
    }

    /// Surge, sway and yaw: a module's own, a yaw further along with the sway that it brings.
    pub(super) fn horizontal_rigid(&self) -> [Vec<f64>; 3] {
        let mut motions = [(); 3].map(|()| vec![0.0; self.dofs]);
        for (j, (map, module)) in self.map.iter().zip(self.modules.each()).enumerate() {
            let [surge, sway, yaw] = &module.horizontal_rigid;
            for (i, dof) in map.iter().enumerate() {
                if let Some(dof) = *dof {
                    motions[0][dof] = surge[i];
                    motions[1][dof] = sway[i];
                    motions[2][dof] = yaw[i] + self.modules.left_m(j) * sway[i];
                }
            }
        }
        motions
    }

    /// The held dofs of the bridge, each with the row of the stiffness that gives its reaction; `dead_n` is the dead load on a dof
    /// of a module.
    pub(super) fn held(&self, dead_n: impl Fn(usize, usize) -> [f64; 2]) -> Vec<HeldDof> {
        let mut held = Vec::new();
        for (j, (map, module)) in self.map.iter().zip(self.modules.each()).enumerate() {
            let grid = &module.grid;
            for side in [Side::Left, Side::Right] {
                let ix = module.end_line(side);
                for iy in 0..grid.y.len() {
                    for direction in [X, Y, Z] {
                        let Some(dof) = module.dof(grid.bottom(ix, iy), direction) else {
                            continue;
                        };
                        if map[dof].is_some() {
                            continue;
                        }
                        let row = self.global(j, &SparseRow(module.k.column(dof).collect()));
                        held.push(HeldDof {
                            x_m: self.modules.left_m(j) + grid.x[ix],
                            y_m: grid.y[iy],
                            vertical: direction == Z,
                            row,
                            dead_n: dead_n(j, dof),
                        });
                    }
                }
            }
        }
        held
    }
}

/// Dofs of a module end that its support holds: z along the whole bottom edge, x and y at the places of `hinges_y_m`.
fn held_dofs(module: &PreparedModule, side: Side, held: &[Direction], hinges_y_m: &[f64]) -> Vec<usize> {
    let along_edge = |direction: usize, places: &[f64]| -> Vec<usize> {
        let dof = |&y_m: &f64| module.end_dof(side, y_m, direction);
        places.iter().filter_map(dof).collect()
    };
    held.iter()
        .flat_map(|direction| match direction {
            Direction::X => along_edge(X, hinges_y_m),
            Direction::Y => along_edge(Y, hinges_y_m),
            Direction::Z => along_edge(Z, &module.grid.y),
        })
        .collect()
}
