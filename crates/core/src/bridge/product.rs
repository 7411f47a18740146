//! Products with the bridge's matrices, module by module.
//!
//! Knows that modules of one kind share one matrix: it stays in the cache while the assembled one would not. Does not know
//! what the matrix is.

use super::modules::Modules;
use super::prepared::PreparedModule;
use super::row::Row;
use crate::fem::{FemError, SparseRow, SymmetricMatrix};
use faer::{Accum, Mat, Par, linalg::matmul::matmul};
use nalgebra::{DMatrix, DVector};

/// `y = sum over modules of P_j^T A_j P_j x`.
#[derive(Debug)]
pub(crate) struct ModuleProduct {
    dofs: usize,
    /// Modules by their matrix.
    groups: Vec<Group>,
    /// Springs or masses beside the modules: stiffness or mass, and row.
    beside: Vec<(f64, SparseRow)>,
    /// What couples all modules: rows G and a matrix X of `G^T X G`.
    coupled: Option<(Vec<SparseRow>, DMatrix<f64>)>,
}

/// Modules of one matrix.
#[derive(Debug)]
struct Group {
    /// For each module and each of its dofs the number in the bridge; `dofs` where held.
    map: Vec<Vec<usize>>,
    matrix: Matrix,
}

#[derive(Debug)]
enum Matrix {
    /// A condensed module's: all modules of the group in one dense product.
    Dense(Mat<f64>),
    /// A full module's.
    Sparse(SymmetricMatrix),
}

/// Share of entries stored above which a matrix is taken as dense.
const DENSE_ABOVE: f64 = 0.3;

impl Matrix {
    fn of(a: &SymmetricMatrix) -> Self {
        let n = a.order();
        if a.nnz() as f64 <= DENSE_ABOVE * (n * n) as f64 {
            return Self::Sparse(a.clone());
        }
        let mut dense = Mat::zeros(n, n);
        for (i, j, v) in a.entries() {
            dense[(i, j)] = v;
        }
        Self::Dense(dense)
    }

    fn entries(&self) -> Vec<(usize, usize, f64)> {
        match self {
            Self::Sparse(a) => a.entries().collect(),
            Self::Dense(a) => {
                let places = (0..a.ncols()).flat_map(|j| (0..a.nrows()).map(move |i| (i, j)));
                places.map(|(i, j)| (i, j, a[(i, j)])).collect()
            }
        }
    }
}

impl ModuleProduct {
    /// Of one of each module's matrices, numbered as in `row`.
    pub(super) fn new(modules: &Modules<'_>, row: &Row<'_>, matrix: fn(&PreparedModule) -> &SymmetricMatrix) -> Self {
        let dofs = row.dofs;
        let group = |(variant, module): (usize, &&PreparedModule)| {
            let own = row.map.iter().zip(&modules.of_module).filter(|(_, of)| **of == variant);
            let numbers = |map: &Vec<Option<usize>>| map.iter().map(|i| i.unwrap_or(dofs)).collect();
            Group {
                map: own.map(|(map, _)| numbers(map)).collect(),
                matrix: Matrix::of(matrix(module)),
            }
        };
        Self {
            dofs,
            groups: modules.variants.iter().enumerate().map(group).collect(),
            beside: Vec::new(),
            coupled: None,
        }
    }

    /// With springs or masses beside the modules: stiffness or mass, and row of each.
    pub(super) fn with(self, beside: Vec<(f64, SparseRow)>) -> Self {
        Self { beside, ..self }
    }

    /// With `G^T X G` of rows G beside the modules.
    pub(super) fn coupled(self, rows: &[SparseRow], x: &DMatrix<f64>) -> Self {
        Self {
            coupled: Some((rows.to_vec(), x.clone())),
            ..self
        }
    }

    /// The matrix itself, of modules alone.
    ///
    /// # Errors
    /// [`FemError::OutOfMemory`].
    pub(crate) fn of_modules(&self) -> Result<SymmetricMatrix, FemError> {
        let mut entries = Vec::new();
        for group in &self.groups {
            let own = group.matrix.entries();
            for map in &group.map {
                let placed = own.iter().map(|&(i, j, v)| (map[i], map[j], v));
                entries.extend(placed.filter(|&(i, j, _)| i != self.dofs && j != self.dofs));
            }
        }
        SymmetricMatrix::from_entries(self.dofs, &entries)
    }

    /// `y = A x` of the bridge.
    pub(crate) fn multiply(&self, x: &[f64], y: &mut [f64]) {
        y.fill(0.0);
        for group in &self.groups {
            group.add(self.dofs, x, y);
        }
        for (factor, row) in &self.beside {
            row.add_to(factor * row.dot(x), y);
        }
        if let Some((rows, matrix)) = &self.coupled {
            let moved = DVector::from_iterator(rows.len(), rows.iter().map(|row| row.dot(x)));
            for (row, force) in rows.iter().zip((matrix * moved).iter()) {
                row.add_to(*force, y);
            }
        }
    }
}

impl Group {
    /// `y += A x` of the group's modules.
    fn add(&self, dofs: usize, x: &[f64], y: &mut [f64]) {
        let n = self.map.first().map_or(0, Vec::len);
        let own = Mat::<f64>::from_fn(n, self.map.len(), |i, j| {
            let dof = self.map[j][i];
            if dof == dofs { 0.0 } else { x[dof] }
        });
        let mut forces = Mat::<f64>::zeros(n, self.map.len());
        match &self.matrix {
            Matrix::Dense(a) => matmul(forces.as_mut(), Accum::Replace, a.as_ref(), own.as_ref(), 1.0, Par::Seq),
            Matrix::Sparse(a) => a.multiply_columns(own.as_ref(), forces.as_mut()),
        }
        for (j, map) in self.map.iter().enumerate() {
            for (&dof, force) in map.iter().zip(forces.col(j).iter()) {
                if dof != dofs {
                    y[dof] += force;
                }
            }
        }
    }
}
