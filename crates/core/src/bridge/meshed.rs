//! The whole bridge as its mesh: every node, shell and beam of every module, and how far each node moves.
//!
//! Knows how a module's dofs go on to all its nodes: by themselves, or by the condensation's own transformation. Does not
//! know what the motion is, nor files.

use super::modules::Modules;
use super::prepared::{PreparedModule, Side};
use super::row::Row;
use super::{BridgeDesign, BridgeError, Ends};
use crate::fem::{DOFS_PER_NODE, NodeId, SparseRow};
use crate::module::{Grid, Plate};
use faer::{Accum, Mat, MatRef, Par, linalg::matmul::matmul};
use std::borrow::Borrow;

/// A shell of the whole bridge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShellCell {
    /// Its corner nodes in cyclic order, as places in [`MeshedBridge::nodes_m`].
    pub nodes: [usize; 4],
    /// Number of its module, from 1.
    pub module: usize,
    /// The plate that it is part of.
    pub plate: Plate,
    /// Its thickness `[m]`.
    pub thickness_m: f64,
}

/// A beam of the whole bridge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BeamCell {
    /// Its end nodes, as places in [`MeshedBridge::nodes_m`].
    pub nodes: [usize; 2],
    /// Number of its module, from 1.
    pub module: usize,
}

/// What joins two modules at one place across: a connector at the deck or a hinge at the bottom.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Link {
    /// Position number of the joint, 2 to modules.
    pub joint: usize,
    /// Place across `[m]`.
    pub y_m: f64,
    /// The left and the right module's node, as places in [`MeshedBridge::nodes_m`]; at rest they are at one place.
    pub nodes: [usize; 2],
}

/// The mesh of a whole bridge and its motion. Nodes are numbered module after module, each in the order of its mesh.
#[derive(Debug)]
pub struct MeshedBridge {
    /// Places of the nodes `[m]`; heights above the bottom of the bridge's left end, bottoms meeting in the hinges.
    pub nodes_m: Vec<[f64; 3]>,
    /// Shells, module after module.
    pub shells: Vec<ShellCell>,
    /// Beams, module after module.
    pub beams: Vec<BeamCell>,
    /// Connectors in the order of a bridge's.
    pub connectors: Vec<Link>,
    /// Hinges, joint after joint, each joint's in the design's order.
    pub hinges: Vec<Link>,
    /// Node of the deck behind each column of the bridge's track.
    deck: Vec<usize>,
    /// For each module and each of its dofs the number in the bridge; none where held.
    map: Vec<Vec<Option<usize>>>,
    /// Of each module its variant.
    of_module: Vec<usize>,
    /// Number of nodes of each variant.
    nodes: Vec<usize>,
    /// Of each variant the motion of a condensed module's nodes in terms of its dofs: a row a translation, node after node, and
    /// below them a row a rotation. None where nothing is condensed.
    condensed: Option<Vec<Mat<f64>>>,
}

impl MeshedBridge {
    /// The mesh of the bridge that [`Bridge::new`](super::Bridge::new) assembles from the same things.
    ///
    /// # Errors
    /// [`BridgeError`] as there.
    pub fn new(design: &BridgeDesign, module: &PreparedModule, ends: Ends) -> Result<Self, BridgeError> {
        Self::of_kinds(design, &[module], ends)
    }

    /// The mesh of the bridge that [`Bridge::of_kinds`](super::Bridge::of_kinds) assembles from the same things.
    ///
    /// # Errors
    /// [`BridgeError`] as there.
    pub fn of_kinds<M: Borrow<PreparedModule>>(
        design: &BridgeDesign,
        prepared: &[M],
        ends: Ends,
    ) -> Result<Self, BridgeError> {
        let modules = Modules::new(design, prepared)?;
        let mut first_node = vec![0];
        first_node.extend(modules.each().scan(0, |nodes, module| {
            *nodes += module.mesh.nodes.len();
            Some(*nodes)
        }));
        let each = || modules.each().enumerate();
        let bases_m = design.bases_m();
        let nodes_m = each().flat_map(|(j, module)| {
            let (left_m, base_m) = (modules.left_m(j), bases_m[j]);
            module.mesh.nodes.iter().map(move |p| [p.x + left_m, p.y, p.z + base_m])
        });
        let of_node = |j: usize, node: NodeId| first_node[j] + node.0;
        let shells = each().flat_map(|(j, module)| {
            let (modules, mesh) = (&modules, &module.mesh);
            mesh.shells.iter().map(move |shell| ShellCell {
                nodes: shell.nodes.map(|node| of_node(j, node)),
                module: j + 1,
                plate: Plate::of(&modules.design(j).module, shell.nodes.map(|node| mesh.place(node))),
                thickness_m: shell.section.thickness_m,
            })
        });
        let beams = each().flat_map(|(j, module)| {
            module.mesh.beams.iter().map(move |beam| BeamCell {
                nodes: beam.nodes.map(|node| of_node(j, node)),
                module: j + 1,
            })
        });
        let links = |node: fn(&Grid, usize, usize) -> NodeId, places: &dyn Fn(usize) -> Vec<f64>| -> Vec<Link> {
            let link = |j: usize, y_m: f64| {
                let end = |j: usize, side: Side| {
                    let (grid, ix) = (modules.grid(j), modules.module(j).end_line(side));
                    Some(of_node(j, node(grid, ix, grid.y_line(y_m)?)))
                };
                Some(Link {
                    joint: j + 1,
                    y_m,
                    nodes: [end(j - 1, Side::Right)?, end(j, Side::Left)?],
                })
            };
            let of_joint = |j: usize| places(j + 1).into_iter().filter_map(move |y_m| link(j, y_m));
            (1..modules.len()).flat_map(of_joint).collect()
        };
        let deck = (0..modules.lines_y().len()).flat_map(|iy| {
            let stations = each().flat_map(|(j, module)| (0..module.grid.x.len()).map(move |ix| (j, ix)));
            stations.map(move |(j, ix)| (j, ix, iy))
        });
        let condensed = modules
            .variants
            .iter()
            .map(|module| module.transformation().map(translations_first));
        Ok(Self {
            nodes_m: nodes_m.collect(),
            shells: shells.collect(),
            beams: beams.collect(),
            connectors: links(Grid::deck, &|_| design.connectors.y_m.clone()),
            hinges: links(Grid::bottom, &|joint| design.hinges_of(joint).y_m.clone()),
            deck: deck
                .map(|(j, ix, iy)| of_node(j, modules.grid(j).deck(ix, iy)))
                .collect(),
            map: Row::number(design, &modules, ends).map,
            nodes: modules.variants.iter().map(|module| module.mesh.nodes.len()).collect(),
            condensed: condensed.collect(),
            of_module: modules.of_module.clone(),
        })
    }

    /// How far each node moves where the bridge's dofs move by `u` `[m or rad]`: x, y and z `[m]`. The dofs inside a condensed
    /// module follow as they were condensed, `u2 = -k22^-1 k21 u1 + Phi q`: statically exact where no force acts on them,
    /// else as exact as the super-element. Verified by `tests/solvers/meshed.rs`.
    pub fn displacement_m(&self, u: &[f64]) -> Vec<[f64; 3]> {
        self.triples(u, 0)
    }

    /// How far each node turns about x, y and z `[rad]`, as [`Self::displacement_m`].
    pub fn rotation_rad(&self, u: &[f64]) -> Vec<[f64; 3]> {
        self.triples(u, 3)
    }

    /// Three dofs of each node, from the first of them on: 0 or 3.
    pub(super) fn triples(&self, u: &[f64], first: usize) -> Vec<[f64; 3]> {
        let of = |dof: Option<usize>| dof.map_or(0.0, |dof| u[dof]);
        let Some(condensed) = &self.condensed else {
            let nodes = self.map.iter().flat_map(|map| map.chunks_exact(DOFS_PER_NODE));
            return nodes
                .map(|node| [0, 1, 2].map(|direction| of(node[first + direction])))
                .collect();
        };
        self.triples_by(condensed, u, first)
    }

    /// [`Self::triples`] by a matrix of each variant, whose rows [`translations_first`] has put in order.
    pub(super) fn triples_by(&self, matrices: &[Mat<f64>], u: &[f64], first: usize) -> Vec<[f64; 3]> {
        let of = |dof: Option<usize>| dof.map_or(0.0, |dof| u[dof]);
        let moved = matrices.iter().enumerate().map(|(variant, matrix)| {
            let rows = matrix.nrows() / 2;
            let t = matrix.subrows(if first == 0 { 0 } else { rows }, rows);
            let own = self.map.iter().zip(&self.of_module).filter(|(_, of)| **of == variant);
            let own: Vec<_> = own.map(|(map, _)| map).collect();
            let motion = Mat::from_fn(t.ncols(), own.len(), |i, j| of(own[j][i]));
            let mut moved = Mat::<f64>::zeros(rows, own.len());
            matmul(moved.as_mut(), Accum::Replace, t, motion.as_ref(), 1.0, Par::Seq);
            moved
        });
        let moved: Vec<Mat<f64>> = moved.collect();
        let mut seen = vec![0; moved.len()];
        let columns = self.of_module.iter().map(|&variant| {
            seen[variant] += 1;
            moved[variant].col(seen[variant] - 1)
        });
        let nodes = columns.flat_map(|column| (0..column.nrows() / 3).map(move |node| (column, node)));
        nodes
            .map(|(column, node)| [0, 1, 2].map(|direction| column[3 * node + direction]))
            .collect()
    }

    /// Number of nodes of each module from left to right, with its variant.
    pub(super) fn nodes_of_modules(&self) -> impl Iterator<Item = (usize, usize)> {
        self.of_module.iter().map(|&variant| (variant, self.nodes[variant]))
    }

    /// How far a point of the deck moves with the nodes around it: `row` is the track's at that point, `displacement_m` that
    /// of all nodes.
    pub fn of_deck_m(&self, row: &SparseRow, displacement_m: &[[f64; 3]]) -> [f64; 3] {
        [0, 1, 2].map(|direction| {
            let share = |&(column, part): &(usize, f64)| part * displacement_m[self.deck[column]][direction];
            row.0.iter().map(share).sum()
        })
    }
}

/// The rows of a matrix with one for each dof of a module: the translations of node after node, then their rotations.
pub(super) fn translations_first(matrix: MatRef<'_, f64>) -> Mat<f64> {
    let nodes = matrix.nrows() / DOFS_PER_NODE;
    let dof = |i: usize| (i / 3 % nodes) * DOFS_PER_NODE + i / 3 / nodes * 3 + i % 3;
    Mat::from_fn(matrix.nrows(), matrix.ncols(), |i, j| matrix[(dof(i), j)])
}

#[cfg(test)]
#[allow(clippy::expect_used)]
mod tests {
    use super::*;
    use crate::bridge::{Bridge, Model};

    /// Smoke's bridge, its bottom's z among the masters: then water acts on masters alone, and what is inside a module
    /// follows a rigid motion rigidly.
    fn free(model: Model) -> (BridgeDesign, PreparedModule) {
        let text = include_str!("../../../../studies/bridges/smoke.json");
        let mut design: BridgeDesign = serde_json::from_str(text).expect("a design");
        design.condensation.bottom_masters = true;
        let module = PreparedModule::new(&design, model).expect("a module");
        (design, module)
    }

    /// Translation and rotation of a place in a rigid motion: three translations and three rotations.
    fn rigid(motion: [f64; 6], [x, y, z]: [f64; 3]) -> [[f64; 3]; 2] {
        let [tx, ty, tz, rx, ry, rz] = motion;
        [
            [tx + ry * z - rz * y, ty + rz * x - rx * z, tz + rx * y - ry * x],
            [rx, ry, rz],
        ]
    }

    /// Largest distance of the mesh's motion from a rigid one that the bridge's dofs have been given.
    fn miss(model: Model, motion: [f64; 6], wrong: f64) -> f64 {
        let (design, module) = free(model);
        let meshed = MeshedBridge::new(&design, &module, Ends::Free).expect("a mesh");
        let own = module.mesh.nodes.len();
        let mut u = vec![0.0; Bridge::new(&design, &module, Ends::Free).expect("a bridge").dofs()];
        for (i, place) in meshed.nodes_m.iter().enumerate() {
            let [translation, rotation] = rigid(motion, *place);
            for direction in 0..DOFS_PER_NODE {
                let dof = module.dof(crate::fem::NodeId(i % own), direction);
                if let Some(at) = dof.and_then(|dof| meshed.map[i / own][dof]) {
                    u[at] = wrong * [translation, rotation][direction / 3][direction % 3];
                }
            }
        }
        let (moved, turned) = (meshed.displacement_m(&u), meshed.rotation_rad(&u));
        let mut most = 0.0_f64;
        for (i, place) in meshed.nodes_m.iter().enumerate() {
            let expected = rigid(motion, *place);
            for (found, expected) in [moved[i], turned[i]].iter().zip(&expected) {
                for (found, expected) in found.iter().zip(expected) {
                    most = most.max((found - expected).abs());
                }
            }
        }
        most
    }

    /// 1e-7 of motions of 20 m (a unit rotation over the bridge's length): rounding of the condensation's solves on a stiffness of
    /// condition 1e7. Twin: dofs 5 % off.
    #[test]
    fn a_rigid_motion_of_the_dofs_is_that_of_every_node() {
        for model in [Model::Full, Model::SuperElement] {
            for which in 0..6 {
                let motion: [f64; 6] = std::array::from_fn(|i| if i == which { 1.0 } else { 0.0 });
                let (right, wrong) = (miss(model, motion, 1.0), miss(model, motion, 1.05));
                assert!(right < 1e-7, "{model:?}, motion {which}: {right:.1e}");
                assert!(wrong > 1e-2, "{model:?}, motion {which}: {wrong:.1e}");
            }
        }
    }

    #[test]
    fn a_link_joins_two_nodes_at_one_place_and_every_plate_is_known() {
        let (design, module) = free(Model::SuperElement);
        let meshed = MeshedBridge::new(&design, &module, Ends::Free).expect("a mesh");
        assert_eq!((meshed.connectors.len(), meshed.hinges.len()), (4, 6));
        for (links, z) in [(&meshed.connectors, design.module.depth_m), (&meshed.hinges, 0.0)] {
            for link in links {
                let place = [design.position_x_m(link.joint), link.y_m, z];
                for node in link.nodes {
                    assert_eq!(meshed.nodes_m[node], place, "{link:?}");
                }
                assert_ne!(link.nodes[0], link.nodes[1]);
            }
        }
        let area = |plate: Plate| -> f64 {
            let of = |cell: &&ShellCell| cell.plate == plate;
            let size = |cell: &ShellCell| -> f64 {
                let [a, _, c, _] = cell.nodes.map(|node| meshed.nodes_m[node]);
                (0..3).map(|i| (c[i] - a[i]).abs()).filter(|d| *d > 1e-9).product()
            };
            meshed.shells.iter().filter(of).map(size).sum()
        };
        let (l, b, d) = (design.module.length_m, design.module.breadth_m, design.module.depth_m);
        let expected = [l * b, l * b, 2.0 * l * d, 2.0 * b * d, 3.0 * l * d, b * d, 0.0];
        for (plate, expected) in Plate::ALL.iter().zip(expected) {
            let found = area(*plate);
            assert!((found - 3.0 * expected).abs() < 1e-9, "{plate:?}: {found} {expected}");
        }
    }
}
