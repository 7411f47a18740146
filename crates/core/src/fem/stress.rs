//! The stress in a shell and the forces in a beam, from the motion of their nodes.
//!
//! Knows strain times stiffness at a point of an element, and what yields first. Does not know how the motion was found.

use super::shell::{MEMBRANE_DOFS, PLATE_DOFS};
use super::{Beam, Shell, membrane, plate};
use nalgebra::SMatrix;

/// Stress of a shell in the motion of its 24 degrees of freedom: membrane, then bending, see [`ShellStress`] `[Pa per m or
/// rad]`.
pub type ShellStressMatrix = SMatrix<f64, 6, 24>;

/// Forces of a beam in the motion of its 12 degrees of freedom, see [`BeamForces`] `[N or N m per m or rad]`.
pub type BeamForceMatrix = SMatrix<f64, 6, 12>;

/// Plane stress at a point of a shell, in the element's own axes 1 and 2.
///
/// At the height z above the mean plane, from -t/2 to t/2, the stress is `membrane + (2 z / t) bending`. Axis 3, along which
/// z counts, is the normal of [`super::QuadFrame`]. The top is at z = t/2.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ShellStress {
    /// `(s_11, s_22, s_12)` in the mean plane `[Pa]`, tension positive.
    pub membrane_pa: [f64; 3],
    /// `(s_11, s_22, s_12)` of bending at the top `[Pa]`; its opposite acts at the bottom.
    pub bending_pa: [f64; 3],
}

impl ShellStress {
    /// Stress at the top `[Pa]`.
    pub fn top_pa(&self) -> [f64; 3] {
        [0, 1, 2].map(|i| self.membrane_pa[i] + self.bending_pa[i])
    }

    /// Stress at the bottom `[Pa]`.
    pub fn bottom_pa(&self) -> [f64; 3] {
        [0, 1, 2].map(|i| self.membrane_pa[i] - self.bending_pa[i])
    }

    /// The larger of the von Mises stresses at top and bottom `[Pa]`: between them it is nowhere larger.
    pub fn von_mises_pa(&self) -> f64 {
        von_mises_pa(self.top_pa()).max(von_mises_pa(self.bottom_pa()))
    }
}

/// Von Mises stress of plane stress `(s_11, s_22, s_12)`: `sqrt(s_11^2 - s_11 s_22 + s_22^2 + 3 s_12^2)` `[Pa]`.
/// Equation (G3).
pub fn von_mises_pa([s_11, s_22, s_12]: [f64; 3]) -> f64 {
    (s_11 * s_11 - s_11 * s_22 + s_22 * s_22 + 3.0 * s_12 * s_12).sqrt()
}

/// Forces of a beam at the middle of its length, in its own axes: 1 along it, 2 towards its `up`, 3 across both.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct BeamForces {
    /// Axial force, tension positive `[N]`.
    pub axial_n: f64,
    /// Shear forces along axes 2 and 3, on the side of the second end `[N]`; the same everywhere along the beam.
    pub shear_n: [f64; 2],
    /// Torque about axis 1 `[N m]`.
    pub torque_newton_m: f64,
    /// Bending moments about axes 2 and 3 `[N m]`: the first stretches the side of axis 3, the second compresses the side of
    /// axis 2.
    pub bending_newton_m: [f64; 2],
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

impl Beam {
    /// Forces at the middle for each of its 12 degrees of freedom: force and torque are those at the second end, for nothing
    /// acts between the ends; the moments `E I_y` and `E I_z` times the difference of the ends' rotations over the length are
    /// the mean of those at the ends, and so those at the middle. Verified by `tests/analytic/fem_stress.rs`.
    /// Equation (G5).
    pub fn force_matrix(&self) -> BeamForceMatrix {
        let (k, axes) = (self.stiffness(), self.axes());
        let mut forces = BeamForceMatrix::zeros();
        let second_end = |first: usize| axes * k.fixed_rows::<3>(first);
        forces.fixed_rows_mut::<3>(0).copy_from(&second_end(6));
        forces.fixed_rows_mut::<1>(3).copy_from(&second_end(9).row(0));
        for (axis, stiffness) in [1, 2].into_iter().zip(self.bending_per_length()) {
            let row = 3 + axis;
            let share = axes.row(axis) * stiffness;
            forces.fixed_view_mut::<1, 3>(row, 3).copy_from(&-share);
            forces.fixed_view_mut::<1, 3>(row, 9).copy_from(&share);
        }
        forces
    }

    /// Forces where the nodes move by `u` `[m or rad]`.
    pub fn forces(matrix: &BeamForceMatrix, u: &[f64; 12]) -> BeamForces {
        let f = matrix * nalgebra::SVector::from(*u);
        BeamForces {
            axial_n: f[0],
            shear_n: [f[1], f[2]],
            torque_newton_m: f[3],
            bending_newton_m: [f[4], f[5]],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Uniaxial stress is its own von Mises stress, pure shear is the root of three times it, and pressure in the plane is
    /// itself: 1e-15, rounding. Twin: 5 % more shear.
    #[test]
    fn von_mises_of_states_that_are_known() {
        for (stress, expected) in [
            ([-7.0, 0.0, 0.0], 7.0),
            ([0.0, 3.0, 0.0], 3.0),
            ([0.0, 0.0, 2.0], 2.0 * 3.0_f64.sqrt()),
            ([4.0, 4.0, 0.0], 4.0),
            ([1.0, -1.0, 0.0], 3.0_f64.sqrt()),
        ] {
            assert!(
                (von_mises_pa(stress) - expected).abs() <= 1e-15 * expected,
                "{stress:?}"
            );
        }
        assert!(von_mises_pa([0.0, 0.0, 2.1]) > 1.04 * 2.0 * 3.0_f64.sqrt());
    }

    #[test]
    fn the_larger_of_the_two_sides_counts() {
        let stress = ShellStress {
            membrane_pa: [-2.0, 0.0, 0.0],
            bending_pa: [5.0, 0.0, 0.0],
        };
        assert_eq!((stress.top_pa()[0], stress.bottom_pa()[0]), (3.0, -7.0));
        assert_eq!(stress.von_mises_pa(), 7.0);
    }
}
