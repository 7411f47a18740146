//! The stress in a shell and the forces in a beam, from the motion of their nodes.
//!
//! Knows strain times stiffness at a point of an element, and what yields first. Does not know how the motion was found.

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
