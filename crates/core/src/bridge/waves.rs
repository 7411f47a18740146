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
