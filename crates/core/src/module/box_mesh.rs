//! From the box's design to its mesh.
//!
//! Knows lines, plates and beams. Every line of a wall, a stiffener or a given extra place is a mesh line.

use super::grid::{Grid, ModuleMesh, cells, line};
use super::{ModuleDesign, Outline};
use crate::fem::{BeamSection, Mesh, NodeId, ShellSection};
use crate::input::SAME_PLACE_M;
use nalgebra::Vector3;
use std::collections::{BTreeMap, BTreeSet};

/// Meshes a checked design, with extra lines along at `extra_x` and across at `extra_y` `[m]`.
pub fn mesh_module(design: &ModuleDesign, extra_x: &[f64], extra_y: &[f64]) -> ModuleMesh {
    Builder::new(design, extra_x, extra_y).build()
}

/// Size of a mesh that has not been made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct MeshSize {
    /// Lines along the module.
    pub lines_along: usize,
    /// Lines across.
    pub lines_across: usize,
    /// Degrees of freedom of all nodes.
    pub dofs: usize,
}

/// The size of the mesh of [`mesh_module`], counted from its lines.
pub(crate) fn mesh_size(design: &ModuleDesign, extra_x: &[f64], extra_y: &[f64]) -> MeshSize {
    let Builder { x, y, over, .. } = Builder::new(design, extra_x, extra_y);
    let (nx, ny) = (x.len(), y.len());
    let plates = |lines: &[f64], walls: &[f64]| {
        let at: BTreeSet<usize> = walls.iter().filter_map(|&wall| line(lines, wall)).collect();
        at.len() + [0, lines.len() - 1].iter().filter(|end| !at.contains(end)).count()
    };
    let (px, py) = (
        plates(&x, &design.transverse_walls.x_m),
        plates(&y, &design.longitudinal_walls.y_m),
    );
    let on_plates = nx * ny - (nx - px) * (ny - py);
    MeshSize {
        lines_along: nx,
        lines_across: ny,
        dofs: 6 * (2 * nx * ny + (over - 1) * on_plates),
    }
}

/// The lines across of the mesh of [`mesh_module`] `[m]`.
pub(crate) fn lines_across(design: &ModuleDesign, extra_y: &[f64]) -> Vec<f64> {
    Builder::new(design, &[], extra_y).y
}

/// Sorted lines without near-duplicates, each interval divided into `parts(length)` equal parts.
fn divide(mut lines: Vec<f64>, parts: impl Fn(f64) -> usize) -> Vec<f64> {
    lines.sort_by(f64::total_cmp);
    lines.dedup_by(|a, b| (*a - *b).abs() <= SAME_PLACE_M);
    let mut divided = vec![lines[0]];
    for w in lines.windows(2) {
        let n = parts(w[1] - w[0]).max(1);
        divided.extend((1..n).map(|k| w[0] + (w[1] - w[0]) * k as f64 / n as f64));
        divided.push(w[1]);
    }
    divided
}

struct Builder<'a> {
    design: &'a ModuleDesign,
    x: Vec<f64>,
    y: Vec<f64>,
    /// Elements over the depth.
    over: usize,
    outline: Outline,
    mesh: Mesh,
    nodes: BTreeMap<(usize, usize, usize), NodeId>,
}

impl<'a> Builder<'a> {
    fn new(design: &'a ModuleDesign, extra_x: &[f64], extra_y: &[f64]) -> Self {
        let (l, half) = (design.length_m, 0.5 * design.breadth_m);
        let mut x = vec![0.0, l];
        x.extend(&design.transverse_walls.x_m);
        x.extend(&design.stiffeners.transverse_x_m);
        x.extend(extra_x);
        let longest = l / design.mesh.elements_along as f64;
        let x = divide(x, |length| (length / longest - 1e-6).ceil() as usize);
        let mut y = vec![-half, half, 0.0];
        y.extend(design.lines_across_m());
        y.extend(extra_y);
        let y = divide(y, |_| design.mesh.elements_between_lines);
        Self {
            design,
            x,
            y,
            over: design.mesh.elements_over_depth,
            outline: design.outline(),
            mesh: Mesh::default(),
            nodes: BTreeMap::new(),
        }
    }

    fn node(&mut self, ix: usize, iy: usize, iz: usize) -> NodeId {
        let (x, over) = (self.x[ix], self.over as f64);
        let (bottom, deck) = (self.outline.bottom_at_m(x), self.outline.deck_at_m(x));
        let place = Vector3::new(x, self.y[iy], bottom + (deck - bottom) * iz as f64 / over);
        let mesh = &mut self.mesh;
        *self.nodes.entry((ix, iy, iz)).or_insert_with(|| mesh.add_node(place))
    }

    fn plate(&self, thickness_m: f64) -> ShellSection {
        let material = &self.design.material;
        ShellSection {
            thickness_m,
            youngs_modulus_pa: material.youngs_modulus_pa,
            poissons_ratio: material.poissons_ratio,
            density_kg_m3: material.density_kg_m3,
        }
    }

    fn build(mut self) -> ModuleMesh {
        let (nx, ny, top) = (self.x.len(), self.y.len(), self.over);
        let level = |b: &mut Self, iz: usize| -> Vec<NodeId> {
            (0..nx)
                .flat_map(|i| (0..ny).map(move |j| (i, j)))
                .map(|(i, j)| b.node(i, j, iz))
                .collect()
        };
        let bottom = level(&mut self, 0);
        let deck = level(&mut self, top);
        for (iz, thickness) in [(0, self.design.bottom_thickness_m), (top, self.design.deck_thickness_m)] {
            let section = self.plate(thickness);
            for (i, j) in cells(nx, ny) {
                let corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| self.node(i, j, iz));
                self.mesh.add_shell(corners, section);
            }
        }
        self.longitudinal_plates();
        self.transverse_plates();
        self.stiffeners();
        let grid = Grid {
            x: self.x,
            y: self.y,
            deck,
            bottom,
        };
        ModuleMesh { mesh: self.mesh, grid }
    }

    fn longitudinal_plates(&mut self) {
        let walls = &self.design.longitudinal_walls;
        let mut plates: Vec<(usize, f64)> = walls
            .y_m
            .iter()
            .filter_map(|&y| line(&self.y, y))
            .map(|j| (j, walls.thickness_m))
            .collect();
        plates.extend([
            (0, self.design.side_thickness_m),
            (self.y.len() - 1, self.design.side_thickness_m),
        ]);
        for (j, thickness) in plates {
            let section = self.plate(thickness);
            for (i, k) in cells(self.x.len(), self.over + 1) {
                let corners = [(i, k), (i + 1, k), (i + 1, k + 1), (i, k + 1)].map(|(i, k)| self.node(i, j, k));
                self.mesh.add_shell(corners, section);
            }
        }
    }

    fn transverse_plates(&mut self) {
        let walls = &self.design.transverse_walls;
        let mut plates: Vec<(usize, f64)> = walls
            .x_m
            .iter()
            .filter_map(|&x| line(&self.x, x))
            .map(|i| (i, walls.thickness_m))
            .collect();
        plates.extend([
            (0, self.design.end_thickness_m),
            (self.x.len() - 1, self.design.end_thickness_m),
        ]);
        for (i, thickness) in plates {
            let section = self.plate(thickness);
            for (j, k) in cells(self.y.len(), self.over + 1) {
                let corners = [(j, k), (j + 1, k), (j + 1, k + 1), (j, k + 1)].map(|(j, k)| self.node(i, j, k));
                self.mesh.add_shell(corners, section);
            }
        }
    }

    /// Beams along the lines of deck and bottom, posts on sides and end walls at the same lines.
    fn stiffeners(&mut self) {
        let stiffeners = &self.design.stiffeners;
        let material = &self.design.material;
        let section = BeamSection {
            area_m2: stiffeners.area_m2,
            i_y_m4: stiffeners.second_moment_m4,
            i_z_m4: stiffeners.second_moment_m4,
            torsion_m4: stiffeners.torsion_constant_m4,
            shear_area_m2: stiffeners.shear_area_m2,
            youngs_modulus_pa: material.youngs_modulus_pa,
            poissons_ratio: material.poissons_ratio,
            density_kg_m3: material.density_kg_m3,
        };
        let across: BTreeSet<usize> = stiffeners
            .transverse_x_m
            .iter()
            .filter_map(|&x| line(&self.x, x))
            .collect();
        let along: BTreeSet<usize> = stiffeners
            .longitudinal_y_m
            .iter()
            .filter_map(|&y| line(&self.y, y))
            .collect();
        let (nx, ny, top) = (self.x.len(), self.y.len(), self.over);
        for iz in [0, top] {
            for &i in &across {
                for j in 0..ny - 1 {
                    self.beam([(i, j, iz), (i, j + 1, iz)], section, Vector3::z());
                }
            }
            for &j in &along {
                for i in 0..nx - 1 {
                    self.beam([(i, j, iz), (i + 1, j, iz)], section, Vector3::z());
                }
            }
        }
        let mut posts: BTreeSet<(usize, usize)> = across.iter().flat_map(|&i| [(i, 0), (i, ny - 1)]).collect();
        posts.extend(along.iter().flat_map(|&j| [(0, j), (nx - 1, j)]));
        for (i, j) in posts {
            for k in 0..top {
                self.beam([(i, j, k), (i, j, k + 1)], section, Vector3::x());
            }
        }
    }

    fn beam(&mut self, ends: [(usize, usize, usize); 2], section: BeamSection, up: Vector3<f64>) {
        let nodes = ends.map(|(i, j, k)| self.node(i, j, k));
        self.mesh.add_beam(nodes, section, up);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::module::{LongitudinalWalls, Material, MeshDesign, TransverseWalls};

    fn module(along: usize, between: usize, over: usize, walls: &[f64]) -> ModuleDesign {
        ModuleDesign {
            length_m: 6.0,
            breadth_m: 8.0,
            depth_m: 1.0,
            deck_right_m: None,
            bottom_right_m: None,
            deck_thickness_m: 0.003,
            bottom_thickness_m: 0.003,
            side_thickness_m: 0.003,
            end_thickness_m: 0.003,
            longitudinal_walls: LongitudinalWalls {
                thickness_m: 0.002,
                y_m: walls.to_vec(),
            },
            transverse_walls: TransverseWalls {
                thickness_m: 0.002,
                x_m: walls.iter().map(|w| 1.0 + w.abs()).collect(),
            },
            stiffeners: crate::module::Stiffeners::default(),
            lines_y_m: Vec::new(),
            material: Material {
                youngs_modulus_pa: 2e11,
                poissons_ratio: 0.3,
                density_kg_m3: 7850.0,
            },
            mesh: MeshDesign {
                elements_along: along,
                elements_between_lines: between,
                elements_over_depth: over,
            },
        }
    }

    #[test]
    fn a_mesh_has_the_size_that_was_counted() {
        for (along, between, over, walls) in [(1, 1, 1, vec![]), (4, 2, 3, vec![0.5, 1.5]), (3, 1, 2, vec![0.0, -4.0])]
        {
            let design = module(along, between, over, &walls);
            let made = mesh_module(&design, &[0.7], &[1.25]);
            let size = mesh_size(&design, &[0.7], &[1.25]);
            assert_eq!(size.dofs, made.mesh.dofs());
            assert_eq!(
                (size.lines_along, size.lines_across),
                (made.grid.x.len(), made.grid.y.len())
            );
        }
    }

    #[test]
    fn a_module_whose_ends_are_one_place_is_refused() {
        let module = module(1, 1, 1, &[]);
        assert_eq!(module.check(), Ok(()));
        for (key, length_m, breadth_m, depth_m) in [
            ("length_m", 1e-6, 8.0, 1.0),
            ("breadth_m", 6.0, 2e-6, 1.0),
            ("depth_m", 6.0, 8.0, 1e-300),
        ] {
            let flat = ModuleDesign {
                length_m,
                breadth_m,
                depth_m,
                ..module.clone()
            };
            assert_eq!(flat.check().unwrap_err().key, key);
        }
    }
}
