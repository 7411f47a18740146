//! Products with the bridge's matrices, module by module.
//!
//! Knows that all modules share one matrix: it stays in the cache while the assembled one would not. Does not know what
//! the matrix is.

use crate::fem::{SparseRow, SymmetricMatrix};
use faer::{Accum, Mat, Par, linalg::matmul::matmul};

/// `y = sum over modules of P_j^T A P_j x`.
#[derive(Debug)]
pub(crate) struct ModuleProduct {
    /// For each module and each of its dofs the number in the bridge; `dofs` where held.
    map: Vec<Vec<usize>>,
    dofs: usize,
    matrix: Matrix,
    /// Springs beside the modules: stiffness and row.
    springs: Vec<(f64, SparseRow)>,
}

#[derive(Debug)]
enum Matrix {
    /// A condensed module's: all modules in one dense product.
    Dense(Mat<f64>),
    /// A full module's.
    Sparse(SymmetricMatrix),
}

/// Share of entries stored above which a matrix is taken as dense.
const DENSE_ABOVE: f64 = 0.3;

impl ModuleProduct {
    /// Of the module's matrix and the numbering `map` (none where held) of a bridge of `dofs`.
    pub(super) fn new(a: &SymmetricMatrix, map: &[Vec<Option<usize>>], dofs: usize) -> Self {
        let n = a.order();
        let matrix = if a.nnz() as f64 > DENSE_ABOVE * (n * n) as f64 {
            let mut dense = Mat::zeros(n, n);
            for (i, j, v) in a.entries() {
                dense[(i, j)] = v;
            }
            Matrix::Dense(dense)
        } else {
            Matrix::Sparse(a.clone())
        };
        let map = map
            .iter()
            .map(|m| m.iter().map(|i| i.unwrap_or(dofs)).collect())
            .collect();
        Self {
            map,
            dofs,
            matrix,
            springs: Vec::new(),
        }
    }

    /// With springs beside the modules: stiffness and row of each.
    pub(super) fn with_springs(self, springs: Vec<(f64, SparseRow)>) -> Self {
        Self { springs, ..self }
    }

    /// `y = A x` of the bridge.
    pub(crate) fn multiply(&self, x: &[f64], y: &mut [f64]) {
        let n = self.map.first().map_or(0, Vec::len);
        let own = Mat::<f64>::from_fn(n, self.map.len(), |i, j| {
            let dof = self.map[j][i];
            if dof == self.dofs { 0.0 } else { x[dof] }
        });
        let mut forces = Mat::<f64>::zeros(n, self.map.len());
        match &self.matrix {
            Matrix::Dense(a) => matmul(forces.as_mut(), Accum::Replace, a.as_ref(), own.as_ref(), 1.0, Par::Seq),
            Matrix::Sparse(a) => a.multiply_columns(own.as_ref(), forces.as_mut()),
        }
        y.fill(0.0);
        for (j, map) in self.map.iter().enumerate() {
            for (&dof, force) in map.iter().zip(forces.col(j).iter()) {
                if dof != self.dofs {
                    y[dof] += force;
                }
            }
        }
        for (stiffness, row) in &self.springs {
            row.add_to(stiffness * row.dot(x), y);
        }
    }
}
