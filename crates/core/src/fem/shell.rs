//! The 4-node flat shell: membrane and plate in the element's mean plane, turned into space.
//!
//! Knows how the two parts share the nodes' six degrees of freedom, and warping. Does not know assembly.

use super::frame::{GAUSS_2X2, QuadFrame};
use super::section::ShellSection;
use super::stress::{ShellStress, ShellStressMatrix};
use super::{FemError, membrane, plate};
use nalgebra::{Matrix3, SMatrix, Vector3};

/// A matrix of the element's 24 degrees of freedom, in global directions.
pub(crate) type ShellMatrix = SMatrix<f64, 24, 24>;

/// A shell element: its frame and section.
#[derive(Debug, Clone, PartialEq)]
pub struct Shell {
    /// Mean plane.
    pub frame: QuadFrame,
    /// Section.
    pub section: ShellSection,
}

/// Local dofs (u, v, theta_z) of the membrane and (w, theta_x, theta_y) of the plate within a node's six.
pub(super) const MEMBRANE_DOFS: [usize; 3] = [0, 1, 5];
pub(super) const PLATE_DOFS: [usize; 3] = [2, 3, 4];

impl Shell {
    /// Shell number `element` with the given corners.
    ///
    /// # Errors
    /// [`FemError::Degenerate`] for corners without a convex area or a section without stiffness.
    pub fn new(element: usize, corners: &[Vector3<f64>; 4], section: ShellSection) -> Result<Self, FemError> {
        section.check(element)?;
        Ok(Self {
            frame: QuadFrame::new(element, corners)?,
            section,
        })
    }

    /// Stiffness `[N/m, N, N m]`.
    ///
    /// A warped element's corners are joined to the mean plane by rigid links: with h the height above the plane, the
    /// projected corner moves by `u - h theta_y`, `v + h theta_x`. Verified by `tests/analytic/fem_patch.rs`,
    /// `tests/analytic/fem_macneal_harder.rs` and `tests/convergence/fem_shells.rs`.
    pub fn stiffness(&self) -> ShellMatrix {
        let membrane = membrane::stiffness(&self.frame, &self.section);
        let plate = plate::stiffness(&self.frame, &self.section);
        let mut local = ShellMatrix::zeros();
        for i in 0..4 {
            for j in 0..4 {
                for a in 0..3 {
                    for b in 0..3 {
                        local[(6 * i + MEMBRANE_DOFS[a], 6 * j + MEMBRANE_DOFS[b])] = membrane[(3 * i + a, 3 * j + b)];
                        local[(6 * i + PLATE_DOFS[a], 6 * j + PLATE_DOFS[b])] = plate[(3 * i + a, 3 * j + b)];
                    }
                }
            }
        }
        let links = self.links();
        turn(&(links.transpose() * local * links), &self.frame.axes)
    }

    /// The rigid links from the corners to the mean plane, in local directions.
    pub(super) fn links(&self) -> ShellMatrix {
        let mut links = ShellMatrix::identity();
        for (i, h) in self.frame.warp.iter().enumerate() {
            links[(6 * i, 6 * i + 4)] = -h;
            links[(6 * i + 1, 6 * i + 3)] = *h;
        }
        links
    }

    /// Consistent mass `integral of N^T diag(rho t, rho t^3/12) N dA` `[kg, kg m^2]`; drilling carries none. Verified by
    /// `tests/analytic/fem_vibration.rs`.
    pub fn mass_consistent(&self) -> ShellMatrix {
        let mut local = ShellMatrix::zeros();
        for (xi, eta) in GAUSS_2X2 {
            let at = self.frame.shape(xi, eta);
            for i in 0..4 {
                for j in 0..4 {
                    self.add_node_mass(&mut local, i, j, at.n[i] * at.n[j] * at.det);
                }
            }
        }
        turn(&local, &self.frame.axes)
    }

    /// Lumped mass: the nodes' shares `integral of N_i dA` on the diagonal blocks.
    pub(crate) fn mass_lumped(&self) -> ShellMatrix {
        let mut local = ShellMatrix::zeros();
        for (xi, eta) in GAUSS_2X2 {
            let at = self.frame.shape(xi, eta);
            for i in 0..4 {
                self.add_node_mass(&mut local, i, i, at.n[i] * at.det);
            }
        }
        turn(&local, &self.frame.axes)
    }

    fn add_node_mass(&self, local: &mut ShellMatrix, i: usize, j: usize, area: f64) {
        let t = self.section.thickness_m;
        let translation = self.section.density_kg_m3 * t * area;
        let rotation = translation * t * t / 12.0;
        for (a, mass) in [
            (0, translation),
            (1, translation),
            (2, translation),
            (3, rotation),
            (4, rotation),
        ] {
            local[(6 * i + a, 6 * j + a)] += mass;
        }
    }
}

/// `T^T k T` with T holding `axes` on its 3 x 3 diagonal blocks.
pub(super) fn turn<const N: usize>(local: &SMatrix<f64, N, N>, axes: &Matrix3<f64>) -> SMatrix<f64, N, N> {
    let mut global = SMatrix::<f64, N, N>::zeros();
    for i in (0..N).step_by(3) {
        for j in (0..N).step_by(3) {
            let block = axes.transpose() * local.fixed_view::<3, 3>(i, j) * axes;
            global.fixed_view_mut::<3, 3>(i, j).copy_from(&block);
        }
    }
    global
}

impl Shell {
    /// Stress at a point of the element, `xi` and `eta` from -1 to 1, for each of its 24 degrees of freedom.
    ///
    /// `membrane = D (B + B_a alpha)`, `bending = (t / 2) D B_b`, with alpha the amplitudes of the incompatible modes; these
    /// add nothing at the centre. Constant stress is met on any quadrilateral. Verified by `tests/analytic/fem_stress.rs`.
    /// Equations (G1), (G2).
    pub fn stress_matrix(&self, xi: f64, eta: f64) -> ShellStressMatrix {
        let d = self.section.plane_stress();
        let membrane = d * membrane::strain_at(&self.frame, &self.section, xi, eta);
        let bending = d * plate::curvature(&self.frame.shape(xi, eta)) * (0.5 * self.section.thickness_m);
        let mut local = ShellStressMatrix::zeros();
        for node in 0..4 {
            for dof in 0..3 {
                for i in 0..3 {
                    local[(i, 6 * node + MEMBRANE_DOFS[dof])] = membrane[(i, 3 * node + dof)];
                    local[(3 + i, 6 * node + PLATE_DOFS[dof])] = bending[(i, 3 * node + dof)];
                }
            }
        }
        let mut global = local * self.links();
        for first in (0..24).step_by(3) {
            let turned = global.fixed_columns::<3>(first) * self.frame.axes;
            global.fixed_columns_mut::<3>(first).copy_from(&turned);
        }
        global
    }

    /// Stress at the point of a matrix of [`Self::stress_matrix`] where the nodes move by `u` `[m or rad]`.
    pub fn stress(matrix: &ShellStressMatrix, u: &[f64; 24]) -> ShellStress {
        let s = matrix * nalgebra::SVector::from(*u);
        ShellStress {
            membrane_pa: [s[0], s[1], s[2]],
            bending_pa: [s[3], s[4], s[5]],
        }
    }
}
