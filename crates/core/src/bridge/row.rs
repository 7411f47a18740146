//! A row of modules: the numbering of its dofs with ties and supports exact.
//!
//! Knows which dofs are one and which do not move. Does not know what is loaded or read.

use super::prepared::{PreparedModule, Side, X, Y, Z};
use super::{BridgeDesign, Direction, Ends};
use crate::fem::{NodeId, SparseRow, SymmetricMatrix};

/// A held dof: where it is and the reaction it gives, `row . u`.
#[derive(Debug, Clone)]
pub(crate) struct HeldDof {
    pub x_m: f64,
    pub y_m: f64,
    pub vertical: bool,
    pub row: SparseRow,
}

/// The numbering of a row of modules.
pub(super) struct Row<'a> {
    /// For each module and each of its dofs the number in the bridge; none where held.
    pub(super) map: Vec<Vec<Option<usize>>>,
    pub(super) dofs: usize,
    module: &'a PreparedModule,
}

impl<'a> Row<'a> {
    /// Numbers module after module; a left hinge node takes the numbers of the right hinge node it is tied to.
    pub(super) fn number(design: &BridgeDesign, module: &'a PreparedModule, ends: Ends) -> Self {
        let grid = &module.grid;
        let hinges: Vec<usize> = design.hinges.y_m.iter().filter_map(|&y| grid.y_line(y)).collect();
        let mut row = Self {
            map: Vec::with_capacity(design.modules),
            dofs: 0,
            module,
        };
        for j in 0..design.modules {
            let mut own: Vec<Option<Option<usize>>> = vec![None; module.dofs()];
            if j > 0 {
                let of_joint = design.hinges_of(j + 1).y_m.iter().filter_map(|&y| grid.y_line(y));
                for iy in of_joint {
                    for direction in [X, Y, Z] {
                        let left = module.dof(grid.bottom(module.end_line(Side::Left), iy), direction);
                        let right = module.dof(grid.bottom(module.end_line(Side::Right), iy), direction);
                        if let (Some(left), Some(right)) = (left, right) {
                            own[left] = Some(row.map[j - 1][right]);
                        }
                    }
                }
            }
            if ends == Ends::Supported {
                for (side, at_end, held) in [
                    (Side::Left, j == 0, &design.supports.left),
                    (Side::Right, j + 1 == design.modules, &design.supports.right),
                ] {
                    if at_end {
                        for dof in held_dofs(module, side, held, &hinges) {
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

    /// Entries of a module's matrix at every module's place.
    pub(super) fn entries(&self, a: &SymmetricMatrix) -> Vec<(usize, usize, f64)> {
        let place =
            |map: &Vec<Option<usize>>, (i, j, v): (usize, usize, f64)| map[i].zip(map[j]).map(|(i, j)| (i, j, v));
        self.map
            .iter()
            .flat_map(|map| a.entries().filter_map(|e| place(map, e)))
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
    pub(super) fn direct(&self, j: usize, module: &PreparedModule, node: NodeId, direction: usize) -> usize {
        module
            .dof(node, direction)
            .and_then(|dof| self.map[j][dof])
            .unwrap_or(usize::MAX)
    }

    /// The water's force up, or its moment about x or y through the bridge's left end.
    pub(super) fn water_resultant(&self, module: &PreparedModule, which: usize, l: f64) -> SparseRow {
        let rows: Vec<SparseRow> = (0..self.map.len())
            .map(|j| {
                let own = self.global(j, &module.water[which]);
                if which < 2 {
                    return own;
                }
                // about y: the module's own moment and its force times its place
                let force = self.global(j, &module.water[0]);
                SparseRow::combine(&[(1.0, &own), (-(j as f64) * l, &force)])
            })
            .collect();
        SparseRow::combine(&rows.iter().map(|r| (1.0, r)).collect::<Vec<_>>())
    }

    /// Surge, sway and yaw: a module's own, a yaw further along with the sway that it brings.
    pub(super) fn horizontal_rigid(&self, module: &PreparedModule, l: f64) -> [Vec<f64>; 3] {
        let mut motions = [(); 3].map(|()| vec![0.0; self.dofs]);
        let [surge, sway, yaw] = &module.horizontal_rigid;
        for (j, map) in self.map.iter().enumerate() {
            for (i, dof) in map.iter().enumerate() {
                if let Some(dof) = *dof {
                    motions[0][dof] = surge[i];
                    motions[1][dof] = sway[i];
                    motions[2][dof] = yaw[i] + j as f64 * l * sway[i];
                }
            }
        }
        motions
    }

    /// The held dofs of the bridge, each with the row of the stiffness that gives its reaction.
    pub(super) fn held(&self, module: &PreparedModule, l: f64) -> Vec<HeldDof> {
        let grid = &module.grid;
        let mut held = Vec::new();
        for (j, map) in self.map.iter().enumerate() {
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
                        let row = self.global(j, &SparseRow(self.module.k.column(dof).collect()));
                        held.push(HeldDof {
                            x_m: j as f64 * l + grid.x[ix],
                            y_m: grid.y[iy],
                            vertical: direction == Z,
                            row,
                        });
                    }
                }
            }
        }
        held
    }
}

/// Dofs of a module end that its support holds: z along the whole bottom edge, x and y at the hinge places.
fn held_dofs(module: &PreparedModule, side: Side, held: &[Direction], hinges: &[usize]) -> Vec<usize> {
    let ix = module.end_line(side);
    let along_edge = |direction: usize, lines: Vec<usize>| -> Vec<usize> {
        lines
            .iter()
            .filter_map(|&iy| module.dof(module.grid.bottom(ix, iy), direction))
            .collect()
    };
    held.iter()
        .flat_map(|direction| match direction {
            Direction::X => along_edge(X, hinges.to_vec()),
            Direction::Y => along_edge(Y, hinges.to_vec()),
            Direction::Z => along_edge(Z, (0..module.grid.y.len()).collect()),
        })
        .collect()
}
