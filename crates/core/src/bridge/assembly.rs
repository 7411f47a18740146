//! Modules in a row: numbering with ties and supports, matrices, and the rows by which the bridge is loaded and read.
//!
//! Knows where everything is along the bridge. Does not know what is done with it.

use super::fit::check_fit;
use super::prepared::{PreparedModule, Side, X, Y, Z};
use super::product::ModuleProduct;
use super::row::{HeldDof, Row};
use super::{BridgeDesign, BridgeError, Ends, Model};
use crate::fem::{NodeId, SparseRow, SymmetricMatrix};

/// One connector: where it is and the row of B that gives its elongation.
#[derive(Debug, Clone)]
pub struct ConnectorPlace {
    /// Position number of the joint, 2 to modules.
    pub joint: usize,
    /// Place across `[m]`.
    pub y_m: f64,
    /// `e = row . u`: the right deck node's motion along x minus the left one's.
    pub row: SparseRow,
}

/// An assembled bridge: `K`, `M` with ties and supports exact, connectors apart. Shared read-only between jobs and threads.
#[derive(Debug)]
pub struct Bridge {
    design: BridgeDesign,
    model: Model,
    pub(crate) k: SymmetricMatrix,
    pub(crate) m: SymmetricMatrix,
    /// Products with `k` and `m`.
    pub(crate) times_k: ModuleProduct,
    /// See `times_k`.
    pub(crate) times_m: ModuleProduct,
    /// Connectors, joint after joint, each joint's in the design's order.
    pub(crate) connectors: Vec<ConnectorPlace>,
    /// z at the bottom's centre line of positions 1 to modules + 1.
    pub(crate) positions: Vec<SparseRow>,
    /// Place along the bridge and z at the bottom's centre line, node after node.
    pub(crate) centre_line: Vec<(f64, SparseRow)>,
    /// z of the deck's two edges.
    pub(crate) edges: Vec<SparseRow>,
    /// z of the deck's and the bottom's corners.
    pub(crate) deck_corners: Vec<SparseRow>,
    /// See `deck_corners`.
    pub(crate) bottom_corners: Vec<SparseRow>,
    /// Motion along, across and up of each module's eight corners, see [`crate::analysis::modes::shapes`].
    pub(crate) corners: Vec<[SparseRow; 3]>,
    /// Roll of the module ends `[rad per unit dof]`.
    pub(crate) rolls: Vec<SparseRow>,
    /// z across the deck at each line along, for telling shapes apart (the bottom's plates carry the water, and shapes of
    /// their own would pass for the bridge's): place x, then (y, row) for each line across.
    pub(crate) sections: Vec<(f64, Vec<(f64, SparseRow)>)>,
    /// Mean motion of the hinge nodes along and across at each module end: place x, row along, row across.
    pub(crate) hinge_lines: Vec<(f64, SparseRow, SparseRow)>,
    /// Resultants of the water on the whole bridge.
    pub(crate) water: [SparseRow; 3],
    pub(crate) held: Vec<HeldDof>,
    /// Surge, sway and yaw of the whole bridge; motions of the bridge where no support holds them.
    pub(crate) horizontal_rigid: [Vec<f64>; 3],
    pub(crate) structural_mass_kg_m: f64,
    pub(crate) roll_inertia_kg_m: f64,
    /// Dofs of the deck's z: `[module][ix][iy]`, with the lines they lie on.
    pub(super) deck_z: Vec<Vec<Vec<usize>>>,
    pub(super) lines_x: Vec<f64>,
    pub(super) lines_y: Vec<f64>,
}

impl Bridge {
    /// Assembles the bridge from one prepared module.
    ///
    /// # Errors
    /// [`BridgeError`]; a module whose mesh does not span the design's or has no line at one of its hinges or connectors is
    /// refused.
    pub fn new(design: &BridgeDesign, module: &PreparedModule, ends: Ends) -> Result<Self, BridgeError> {
        check_fit(design, &module.grid)?;
        let row = Row::number(design, module, ends);
        let k = SymmetricMatrix::from_entries(row.dofs, &row.entries(&module.k))?;
        let m = SymmetricMatrix::from_entries(row.dofs, &row.entries(&module.m))?;
        let grid = &module.grid;
        let (nx, ny, l) = (grid.x.len(), grid.y.len(), design.module.length_m);
        let of = |j: usize, node: NodeId, direction: usize| row.global(j, &module.row(node, direction));
        let centre = |j: usize, ix: usize| {
            let rows: Vec<(f64, SparseRow)> = grid
                .centre()
                .into_iter()
                .map(|(weight, iy)| (weight, of(j, grid.bottom(ix, iy), Z)))
                .collect();
            SparseRow::combine(&rows.iter().map(|(w, row)| (*w, row)).collect::<Vec<_>>())
        };
        let ends_of = |j: usize| [(j, Side::Left), (j, Side::Right)];
        let all_ends = || {
            (0..design.modules)
                .flat_map(ends_of)
                .map(|(j, side)| (j, module.end_line(side)))
        };
        let hinge_lines_y: Vec<usize> = design.hinges.y_m.iter().filter_map(|&y| grid.y_line(y)).collect();

        let mut connectors = Vec::new();
        for j in 1..design.modules {
            for &y_m in &design.connectors.y_m {
                if let Some(iy) = grid.y_line(y_m) {
                    let (left, right) = (of(j - 1, grid.deck(nx - 1, iy), X), of(j, grid.deck(0, iy), X));
                    connectors.push(ConnectorPlace {
                        joint: j + 1,
                        y_m,
                        row: SparseRow::combine(&[(-1.0, &left), (1.0, &right)]),
                    });
                }
            }
        }
        let mut positions: Vec<SparseRow> = (0..design.modules).map(|j| centre(j, 0)).collect();
        positions.push(centre(design.modules - 1, nx - 1));
        let stations = || (0..design.modules).flat_map(|j| (0..nx).map(move |ix| (j, ix)));
        let centre_line = stations()
            .map(|(j, ix)| (j as f64 * l + grid.x[ix], centre(j, ix)))
            .collect();
        let edges = stations()
            .flat_map(|s| [(s, 0), (s, ny - 1)])
            .map(|((j, ix), iy)| of(j, grid.deck(ix, iy), Z))
            .collect();
        let corner = |deck: bool| -> Vec<SparseRow> {
            all_ends()
                .flat_map(|end| [(end, 0), (end, ny - 1)])
                .map(|((j, ix), iy)| of(j, if deck { grid.deck(ix, iy) } else { grid.bottom(ix, iy) }, Z))
                .collect()
        };
        let corners = (0..design.modules)
            .flat_map(|j| {
                let around = [(0, 0), (nx - 1, 0), (nx - 1, ny - 1), (0, ny - 1)];
                let bottom = around.map(|(ix, iy)| grid.bottom(ix, iy));
                let deck = around.map(|(ix, iy)| grid.deck(ix, iy));
                bottom.into_iter().chain(deck).map(move |node| (j, node))
            })
            .map(|(j, node)| [X, Y, Z].map(|direction| of(j, node, direction)))
            .collect();
        let rolls = all_ends()
            .map(|(j, ix)| {
                let (right, left) = (of(j, grid.deck(ix, 0), Z), of(j, grid.deck(ix, ny - 1), Z));
                let per = 1.0 / design.module.breadth_m;
                SparseRow::combine(&[(-per, &right), (per, &left)])
            })
            .collect();
        let sections = stations()
            .map(|(j, ix)| {
                let across = (0..ny).map(|iy| (grid.y[iy], of(j, grid.deck(ix, iy), Z))).collect();
                (j as f64 * l + grid.x[ix], across)
            })
            .collect();
        let hinge_lines = all_ends()
            .map(|(j, ix)| {
                let mean = |direction: usize| {
                    let rows: Vec<SparseRow> = hinge_lines_y
                        .iter()
                        .map(|&iy| of(j, grid.bottom(ix, iy), direction))
                        .collect();
                    let share = 1.0 / rows.len() as f64;
                    SparseRow::combine(&rows.iter().map(|r| (share, r)).collect::<Vec<_>>())
                };
                (j as f64 * l + grid.x[ix], mean(X), mean(Y))
            })
            .collect();
        let water = std::array::from_fn(|which| row.water_resultant(module, which, l));
        let deck_z = (0..design.modules)
            .map(|j| {
                let line = |ix: usize| (0..ny).map(|iy| row.direct(j, module, grid.deck(ix, iy), Z)).collect();
                (0..nx).map(line).collect()
            })
            .collect();
        let held = row.held(module, l);
        let horizontal_rigid = row.horizontal_rigid(module, l);
        Ok(Self {
            design: design.clone(),
            model: module.model,
            k,
            m,
            times_k: ModuleProduct::new(&module.k, &row.map, row.dofs),
            times_m: ModuleProduct::new(&module.m, &row.map, row.dofs),
            connectors,
            positions,
            centre_line,
            edges,
            deck_corners: corner(true),
            bottom_corners: corner(false),
            corners,
            rolls,
            sections,
            hinge_lines,
            water,
            held,
            horizontal_rigid,
            structural_mass_kg_m: module.structural_mass_kg() / l,
            roll_inertia_kg_m: module.roll_inertia_kg_m2() / l,
            deck_z,
            lines_x: grid.x.clone(),
            lines_y: grid.y.clone(),
        })
    }

    /// The design it was built from.
    pub fn design(&self) -> &BridgeDesign {
        &self.design
    }

    /// Which matrices its modules contributed.
    pub fn model(&self) -> Model {
        self.model
    }

    /// Degrees of freedom.
    pub fn dofs(&self) -> usize {
        self.k.order()
    }
}
