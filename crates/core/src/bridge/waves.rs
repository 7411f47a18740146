//! The bridge in water with memory: which motions of its modules the water feels, and where its forces act.
//!
//! Knows the rows of heave, pitch and roll of each module by the bridge's dofs. Does not know time.

use super::modules::Modules;
use super::row::Row;
use crate::fem::SparseRow;
use crate::radiation::Radiation;
use nalgebra::DMatrix;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Water with memory under a bridge (W4): `r = G u`, forces `G^T F`.
#[derive(Debug, Clone)]
pub(crate) struct BridgeWaves {
    /// The water.
    pub(crate) radiation: Arc<Radiation>,
    /// G: heave, pitch and roll of module 1, then of module 2, ... by the bridge's dofs.
    pub(crate) motions: Vec<SparseRow>,
}

impl BridgeWaves {
    /// The water under a row of modules.
    pub(super) fn new(radiation: &Arc<Radiation>, modules: &Modules<'_>, row: &Row<'_>) -> Self {
        let of_module = |j: usize| modules.module(j).motions.each_ref().map(|motion| row.global(j, motion));
        Self {
            radiation: Arc::clone(radiation),
            motions: (0..modules.len()).flat_map(of_module).collect(),
        }
    }

    /// `r = G u`.
    pub(crate) fn motion(&self, u: &[f64]) -> Vec<f64> {
        self.motions.iter().map(|row| row.dot(u)).collect()
    }

    /// `f := f + G^T F`.
    pub(crate) fn add_forces(&self, forces: &[f64], f: &mut [f64]) {
        for (row, force) in self.motions.iter().zip(forces) {
            row.add_to(*force, f);
        }
    }

    /// `s^T A_inf G`, by the bridge's dofs, of shares s of the water's forces.
    pub(super) fn mass_row(&self, shares: &SparseRow) -> SparseRow {
        let infinite = self.radiation.infinite();
        let of = |freedom: usize| shares.0.iter().map(|&(i, s)| s * infinite[(i, freedom)]).sum::<f64>();
        let weighted: Vec<(f64, &SparseRow)> = self
            .motions
            .iter()
            .enumerate()
            .map(|(freedom, row)| (of(freedom), row))
            .collect();
        SparseRow::combine(&weighted)
    }

    /// The entries of `G^T X G` of a symmetric matrix X of the water's freedoms: every dof of a wet bottom with every other.
    pub(crate) fn entries(&self, x: &DMatrix<f64>) -> Vec<(usize, usize, f64)> {
        let mut by_dof: BTreeMap<usize, Vec<(usize, f64)>> = BTreeMap::new();
        for (freedom, row) in self.motions.iter().enumerate() {
            for &(dof, g) in row.0.iter().filter(|(_, g)| *g != 0.0) {
                by_dof.entry(dof).or_default().push((freedom, g));
            }
        }
        let mut entries = Vec::with_capacity(by_dof.len() * by_dof.len());
        let mut pressed = vec![0.0; x.nrows()];
        for (&j, of_j) in &by_dof {
            pressed.fill(0.0);
            for &(freedom, g) in of_j {
                pressed
                    .iter_mut()
                    .zip(x.column(freedom).iter())
                    .for_each(|(p, x)| *p += g * x);
            }
            // the same sum for (i, j) and (j, i): only one of them is computed
            for (&i, of_i) in by_dof.range(..=j) {
                let value: f64 = of_i.iter().map(|&(freedom, g)| g * pressed[freedom]).sum();
                entries.push((i, j, value));
                if i != j {
                    entries.push((j, i, value));
                }
            }
        }
        entries
    }
}

#[cfg(test)]
#[allow(clippy::expect_used)]
mod tests {
    use crate::bridge::{BridgeDesign, Model, PreparedModule};

    /// Heave, pitch and roll of a module are read off its bottom with their signs, `z = 1`, `z = -(x - x_c)` and `z = y`, of the finite
    /// elements to rounding, and of the super-element whose masters move so: inner nodes of its bottom stay behind by what the water's
    /// springs press on them, 3e-5. Twin: a pitch of the other sign.
    #[test]
    fn rigid_motions_are_read_with_their_signs() {
        let text = include_str!("../../../../studies/bridges/smoke.json");
        let design: BridgeDesign = serde_json::from_str(text).expect("a design");
        let (middle_m, height_m) = (0.5 * design.module.length_m, design.module.depth_m);
        for (model, tolerance) in [(Model::Full, 1e-12), (Model::SuperElement, 1e-4)] {
            let module = PreparedModule::new(&design, model).expect("a module");
            // z, and x and y of what turns about axes in the bottom's plane
            let read = |z: &dyn Fn(f64, f64) -> f64, turned: [f64; 2]| {
                let mut u = vec![0.0; module.dofs()];
                for (node, place) in module.mesh.nodes.iter().enumerate() {
                    let motion = [
                        turned[1] * place.z,
                        -turned[0] * place.z,
                        z(place.x, place.y),
                        turned[0],
                        turned[1],
                        0.0,
                    ];
                    for (direction, value) in motion.into_iter().enumerate() {
                        if let Some(dof) = module.dof(crate::fem::NodeId(node), direction) {
                            u[dof] = value;
                        }
                    }
                }
                module.motions.each_ref().map(|row| row.dot(&u))
            };
            let near = |found: [f64; 3], expected: [f64; 3]| {
                found.iter().zip(expected).all(|(a, b)| (a - b).abs() < tolerance)
            };
            let (heave, pitch, roll) = (
                read(&|_, _| 1.0, [0.0, 0.0]),
                read(&|x, _| middle_m - x, [0.0, 1.0]),
                read(&|_, y| y, [1.0, 0.0]),
            );
            assert!(height_m > 0.0 && near(heave, [1.0, 0.0, 0.0]), "{model:?}: {heave:?}");
            assert!(near(pitch, [0.0, 1.0, 0.0]), "{model:?}: {pitch:?}");
            assert!(near(roll, [0.0, 0.0, 1.0]), "{model:?}: {roll:?}");
            assert!(!near(pitch, [0.0, -1.0, 0.0]), "the other sign passes");
        }
    }
}
