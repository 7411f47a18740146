//! The super-element: a module condensed to its masters and a few fixed-master modes.
//!
//! Knows matrices and a list of masters. Does not know what the masters are for.

use crate::fem::{
    EigenPairs, Factor, FemError, SymmetricMatrix, allowed, diagonal, hold, lowest_modes, pattern, residual, sizes,
};
use faer::{Accum, ColRef, Mat, MatRef, Par, linalg::matmul::matmul};
use std::ops::Range;

/// `k' = T^T k T`, `m' = T^T m T` with `T = [I 0; -k22^-1 k21  Phi]` (masters 1, slaves 2) [36-44].
///
/// Phi are the lowest modes of the slaves with the masters held (Craig, Bampton: AIAA Journal 6, 1968, 1313-1319); none of
/// them is Guyan's condensation. Rayleigh damping condenses with its parts: `c' = a k' + b m'`.
#[derive(Debug, Clone)]
pub struct SuperElement {
    /// Masters, as dofs of the full module, in the order of the condensed dofs.
    pub masters: Vec<usize>,
    /// Condensed stiffness; masters first, then modes.
    pub k: SymmetricMatrix,
    /// Condensed mass.
    pub m: SymmetricMatrix,
    /// T: a row for each dof of the full module.
    pub transformation: Mat<f64>,
}

/// Shift of the fixed-master eigenproblem `[1/s^2]`: the square of 1 Hz, below any fixed-master mode of a module.
const SHIFT: f64 = 39.5;

impl SuperElement {
    /// Condenses stiffness `k` and mass `m` to `masters` and `modes` fixed-master modes.
    ///
    /// # Errors
    /// [`FemError`] where the slaves' stiffness is not positive definite: the masters leave a mechanism.
    /// Equation (P1).
    pub fn condense(
        k: &SymmetricMatrix,
        m: &SymmetricMatrix,
        masters: &[usize],
        modes: usize,
    ) -> Result<Self, FemError> {
        let parts = Parts::new(k.order(), masters);
        let n1 = masters.len();
        let modes = modes.min(parts.slaves.len());
        let k22 = parts.among_slaves(k)?;
        let following = parts.following(k, &k22)?;
        let fixed = if modes > 0 {
            Some(lowest_modes(&k22, &parts.among_slaves(m)?, modes, SHIFT)?)
        } else {
            None
        };
        let transformation = parts.transformation(following.as_ref(), fixed.as_ref(), modes);
        // k' has no coupling between masters and modes, and the modes' own block is diagonal: written, not computed.
        let static_part = transformation.as_ref().subcols(0, n1);
        let k11 = congruence(k, static_part);
        let mut entries = dense_entries(k11.as_ref());
        let lambda = fixed.iter().flat_map(|pairs| &pairs.lambda);
        entries.extend(lambda.enumerate().map(|(j, &l)| (n1 + j, n1 + j, l)));
        let condensed_k = SymmetricMatrix::from_entries(n1 + modes, &entries)?;
        let condensed_m = congruence(m, transformation.as_ref());
        let condensed_m = SymmetricMatrix::from_entries(n1 + modes, &dense_entries(condensed_m.as_ref()))?;
        let condensed = Self {
            masters: masters.to_vec(),
            k: condensed_k,
            m: condensed_m,
            transformation,
        };
        condensed.probe(k, m)?;
        Ok(condensed)
    }

    /// Whether this condenses stiffness `k` and mass `m`, for one motion z of its dofs each: the slaves of `k T z` are in
    /// balance and its masters feel `k' z`, the modes at rest; `T^T m T z` is `m' z`. Gives the larger backward error as a
    /// share of what [`Factor::probe`] allows. Verified by `tests/solvers/probe.rs`.
    ///
    /// # Errors
    /// [`FemError::BadFactor`] where one is above: this is no super-element of `k` and `m`.
    pub fn probe(&self, k: &SymmetricMatrix, m: &SymmetricMatrix) -> Result<f64, FemError> {
        let (n, n1, reduced) = (k.order(), self.masters.len(), self.k.order());
        let moved = |z: &[f64]| -> Vec<f64> {
            let mut u = vec![0.0; n];
            for (column, z) in self.transformation.col_iter().zip(z) {
                u.iter_mut().zip(column.iter()).for_each(|(u, t)| *u += t * z);
            }
            u
        };

        let own = sizes(diagonal(&self.k));
        let z: Vec<f64> = (0..reduced)
            .map(|j| if j < n1 { pattern(j) / own[j] } else { 0.0 })
            .collect();
        let (mut felt, mut balanced) = (vec![0.0; reduced], vec![0.0; n]);
        self.k.multiply(&z, &mut felt);
        for (&dof, felt) in self.masters.iter().zip(&felt) {
            balanced[dof] = *felt;
        }
        let error = residual(k, &sizes(diagonal(k)), &moved(&z), &balanced);
        let stiffness = hold("condensed stiffness", n, error, allowed(n))?;

        let own = sizes(diagonal(&self.m));
        let z: Vec<f64> = own.iter().enumerate().map(|(j, own)| pattern(j) / own).collect();
        let mut mu = vec![0.0; n];
        m.multiply(&moved(&z), &mut mu);
        let seen = |column: ColRef<'_, f64>| column.iter().zip(&mu).map(|(t, mu)| t * mu).sum();
        let felt: Vec<f64> = self.transformation.col_iter().map(seen).collect();
        let error = residual(&self.m, &own, &z, &felt);
        let mass = hold("condensed mass", n, error, allowed(n))?;
        Ok(stiffness.max(mass))
    }

    /// What the inertia of the slaves adds to their motion beyond T, at rest among themselves: for the acceleration z of the
    /// condensed dofs they move by `R z`, `R = -(k22^-1 - Phi Lambda^-1 Phi^T) (m T)_2`; masters by nothing. `k` and `m` are
    /// those that were condensed. Verified by `tests/solvers/stresses.rs`.
    ///
    /// # Errors
    /// [`FemError`] as [`Self::condense`].
    /// Equation (P2).
    pub fn inertial_correction(&self, k: &SymmetricMatrix, m: &SymmetricMatrix) -> Result<Mat<f64>, FemError> {
        let parts = Parts::new(k.order(), &self.masters);
        let (n1, reduced) = (self.masters.len(), self.k.order());
        let mut inertia = Mat::<f64>::zeros(k.order(), reduced);
        m.multiply_columns(self.transformation.as_ref(), inertia.as_mut());
        let of_slaves = |of: &Mat<f64>, columns: Range<usize>| {
            Mat::from_fn(parts.slaves.len(), columns.len(), |i, j| {
                of[(parts.slaves[i], columns.start + j)]
            })
        };
        let inertia = of_slaves(&inertia, 0..reduced);
        let mut moved = inertia.clone();
        Factor::new("stiffness of a module's slaves", &parts.among_slaves(k)?)?.solve_columns(moved.as_mut());
        // the modes' own part of it moves already
        let phi = of_slaves(&self.transformation, n1..reduced);
        let mut amplitudes = phi.transpose() * &inertia;
        for (j, lambda) in diagonal(&self.k).skip(n1).enumerate() {
            amplitudes
                .row_mut(j)
                .iter_mut()
                .for_each(|amplitude| *amplitude /= lambda);
        }
        moved -= &phi * &amplitudes;
        let row = |i: usize, j: usize| parts.slave[i].map_or(0.0, |slave| -moved[(slave, j)]);
        Ok(Mat::from_fn(k.order(), reduced, row))
    }
}

impl SuperElement {
    /// `T^T A T` of a matrix of the full module.
    ///
    /// # Errors
    /// [`FemError::OutOfMemory`].
    pub(crate) fn congruent(&self, a: &SymmetricMatrix) -> Result<SymmetricMatrix, FemError> {
        let congruent = congruence(a, self.transformation.as_ref());
        SymmetricMatrix::from_entries(congruent.ncols(), &dense_entries(congruent.as_ref()))
    }

    /// What a load moves beyond T by every dof of the full module, at rest and with the masters held:
    /// `(k22^-1 - Phi Lambda^-1 Phi^T) f_2`. `k` is the stiffness that was condensed.
    ///
    /// # Errors
    /// [`FemError`] as [`Self::condense`].
    pub fn static_remainder(&self, k: &SymmetricMatrix, load: &[f64]) -> Result<Vec<f64>, FemError> {
        let parts = Parts::new(k.order(), &self.masters);
        let own: Vec<f64> = parts.slaves.iter().map(|&dof| load[dof]).collect();
        let mut moved = own.clone();
        Factor::new("stiffness of a module's slaves", &parts.among_slaves(k)?)?.solve(&mut moved);
        let n1 = self.masters.len();
        for (j, lambda) in (n1..self.k.order()).zip(diagonal(&self.k).skip(n1)) {
            let phi = || parts.slaves.iter().map(|&dof| self.transformation[(dof, j)]);
            let amplitude = phi().zip(&own).map(|(phi, f)| phi * f).sum::<f64>() / lambda;
            moved.iter_mut().zip(phi()).for_each(|(u, phi)| *u -= amplitude * phi);
        }
        let mut all = vec![0.0; k.order()];
        parts.slaves.iter().zip(&moved).for_each(|(&dof, u)| all[dof] = *u);
        Ok(all)
    }
}

/// The dofs of a module in two parts: masters, which are kept, and slaves, which follow them.
struct Parts<'a> {
    masters: &'a [usize],
    slaves: Vec<usize>,
    /// For each dof its place among the slaves, where it is one.
    slave: Vec<Option<usize>>,
}

impl<'a> Parts<'a> {
    /// Parts `n` dofs into the masters and the rest.
    fn new(n: usize, masters: &'a [usize]) -> Self {
        let mut is_master = vec![false; n];
        for &dof in masters {
            is_master[dof] = true;
        }
        let slaves: Vec<usize> = (0..n).filter(|&i| !is_master[i]).collect();
        let mut slave = vec![None; n];
        for (place, &dof) in slaves.iter().enumerate() {
            slave[dof] = Some(place);
        }
        Self { masters, slaves, slave }
    }

    /// Gives the part of a matrix among the slaves.
    fn among_slaves(&self, a: &SymmetricMatrix) -> Result<SymmetricMatrix, FemError> {
        restrict(a, &self.slave, self.slaves.len())
    }

    /// Solves for the slaves' motion under a unit motion of each master, `-k22^-1 k21`: a row a slave, a column a master.
    fn following(&self, k: &SymmetricMatrix, k22: &SymmetricMatrix) -> Result<Mat<f64>, FemError> {
        let mut x = Mat::<f64>::zeros(self.slaves.len(), self.masters.len());
        for (j, &dof) in self.masters.iter().enumerate() {
            for (i, value) in k.column(dof) {
                if let Some(i) = self.slave[i] {
                    x[(i, j)] = -value;
                }
            }
        }
        Factor::new("stiffness of a module's slaves", k22)?.solve_columns(x.as_mut());
        Ok(x)
    }

    /// Writes T from the slaves' motion under the masters and the first `modes` shapes of the fixed-master modes.
    fn transformation(&self, following: MatRef<'_, f64>, fixed: Option<&EigenPairs>, modes: usize) -> Mat<f64> {
        let n1 = self.masters.len();
        let mut transformation = Mat::<f64>::zeros(self.slave.len(), n1 + modes);
        for (j, &dof) in self.masters.iter().enumerate() {
            transformation[(dof, j)] = 1.0;
        }
        for (i, &dof) in self.slaves.iter().enumerate() {
            for j in 0..n1 {
                transformation[(dof, j)] = following[(i, j)];
            }
        }
        if let Some(fixed) = fixed {
            for (i, &dof) in self.slaves.iter().enumerate() {
                for j in 0..modes {
                    transformation[(dof, n1 + j)] = fixed.shapes[(i, j)];
                }
            }
        }
        transformation
    }
}

/// The part of a matrix among the dofs that `place` keeps.
fn restrict(a: &SymmetricMatrix, place: &[Option<usize>], n: usize) -> Result<SymmetricMatrix, FemError> {
    let entries: Vec<_> = a
        .entries()
        .filter_map(|(i, j, v)| place[i].zip(place[j]).map(|(i, j)| (i, j, v)))
        .collect();
    SymmetricMatrix::from_entries(n, &entries)
}

/// `T^T A T`.
fn congruence(a: &SymmetricMatrix, t: MatRef<'_, f64>) -> Mat<f64> {
    let mut at = Mat::<f64>::zeros(t.nrows(), t.ncols());
    a.multiply_columns(t, at.as_mut());
    let mut result = Mat::<f64>::zeros(t.ncols(), t.ncols());
    matmul(
        result.as_mut(),
        Accum::Replace,
        t.transpose(),
        at.as_ref(),
        1.0,
        Par::Seq,
    );
    result
}

/// All entries of a dense matrix, made symmetric.
fn dense_entries(a: MatRef<'_, f64>) -> Vec<(usize, usize, f64)> {
    let n = a.ncols();
    (0..n)
        .flat_map(|j| (0..n).map(move |i| (i, j, 0.5 * (a[(i, j)] + a[(j, i)]))))
        .filter(|e| e.2 != 0.0)
        .collect()
}
