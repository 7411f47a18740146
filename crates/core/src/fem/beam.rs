//! The 2-node beam in space: Timoshenko bending about two axes, axial force, torsion.
//!
//! Knows its section and axis. Does not know assembly.

use super::shell::turn;
use super::stress::{BeamForceMatrix, BeamForces};
use super::{FemError, require};
use nalgebra::{Matrix3, SMatrix, Vector3};

/// A matrix of the beam's 12 degrees of freedom.
pub(crate) type BeamMatrix = SMatrix<f64, 12, 12>;

/// Section and material of a beam. Local x is the axis; `i_y` resists bending in the x-z plane, `i_z` in x-y.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BeamSection {
    /// Area `[m^2]`.
    pub area_m2: f64,
    /// Second moment about local y `[m^4]`.
    pub i_y_m4: f64,
    /// Second moment about local z `[m^4]`.
    pub i_z_m4: f64,
    /// Torsion constant `[m^4]`.
    pub torsion_m4: f64,
    /// Shear area in both directions `[m^2]`; none: no shear deformation.
    pub shear_area_m2: Option<f64>,
    /// Young's modulus `[Pa]`.
    pub youngs_modulus_pa: f64,
    /// Poisson's ratio.
    pub poissons_ratio: f64,
    /// Density `[kg/m^3]`.
    pub density_kg_m3: f64,
}

impl BeamSection {
    fn check(&self, element: usize) -> Result<(), FemError> {
        let (e, nu) = (self.youngs_modulus_pa, self.poissons_ratio);
        require(element, "Young's modulus", e, e > 0.0)?;
        require(element, "Poisson's ratio", nu, nu > -1.0 && nu <= 0.5)?;
        for (measure, value) in [
            ("area", self.area_m2),
            ("second moment about y", self.i_y_m4),
            ("second moment about z", self.i_z_m4),
            ("torsion constant", self.torsion_m4),
            ("density", self.density_kg_m3),
        ] {
            require(element, measure, value, value >= 0.0)?;
        }
        self.shear_area_m2
            .map_or(Ok(()), |a| require(element, "shear area", a, a > 0.0))
    }
}

/// A beam element.
#[derive(Debug, Clone, PartialEq)]
pub struct Beam {
    length: f64,
    axes: Matrix3<f64>,
    section: BeamSection,
}

/// Bending dofs `(v, theta)` of both ends within the beam's 12, and the sign that turns the rotation into `v,x`.
const BENDING_XY: ([usize; 4], f64) = ([1, 5, 7, 11], 1.0);
const BENDING_XZ: ([usize; 4], f64) = ([2, 4, 8, 10], -1.0);

/// Four-point Gauss rule on [0, 1]: exact for the products of cubics.
const GAUSS_4: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_93),
    (0.330_009_478_207_571_87, 0.326_072_577_431_273_07),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_93),
];

impl Beam {
    /// Beam number `element` between two ends; `up` fixes local y (in the plane of axis and `up`).
    ///
    /// # Errors
    /// [`FemError::Degenerate`] without length, with `up` along the axis or with a negative section.
    pub fn new(
        element: usize,
        ends: &[Vector3<f64>; 2],
        up: &Vector3<f64>,
        section: BeamSection,
    ) -> Result<Self, FemError> {
        section.check(element)?;
        let along = ends[1] - ends[0];
        let length = along.norm();
        require(element, "length", length, length > 0.0)?;
        let e1 = along / length;
        let across = e1.cross(up);
        let sine = across.norm() / up.norm();
        require(element, "sine of the angle between axis and up", sine, sine > 1e-9)?;
        let e3 = across.normalize();
        let e2 = e3.cross(&e1);
        Ok(Self {
            length,
            axes: Matrix3::from_rows(&[e1.transpose(), e2.transpose(), e3.transpose()]),
            section,
        })
    }

    /// The beam's own axes, as rows.
    pub(super) fn axes(&self) -> &Matrix3<f64> {
        &self.axes
    }

    /// `E I_y` and `E I_z` over the length `[N m]`.
    pub(super) fn bending_per_length(&self) -> [f64; 2] {
        let s = &self.section;
        [s.i_y_m4, s.i_z_m4].map(|i| s.youngs_modulus_pa * i / self.length)
    }

    /// `Phi = 12 E I / (G A_s L^2)`, 0 without shear deformation.
    /// Equation (E5).
    fn phi(&self, i: f64) -> f64 {
        let s = &self.section;
        let g = 0.5 * s.youngs_modulus_pa / (1.0 + s.poissons_ratio);
        s.shear_area_m2.map_or(0.0, |a| {
            12.0 * s.youngs_modulus_pa * i / (g * a * self.length * self.length)
        })
    }

    /// Stiffness (Przemieniecki: Theory of Matrix Structural Analysis, 1968, eq. 5.116); end loads are met exactly.
    /// Verified by `tests/convergence/fem_shells.rs`.
    pub fn stiffness(&self) -> BeamMatrix {
        let (s, l) = (&self.section, self.length);
        let e = s.youngs_modulus_pa;
        let g = 0.5 * e / (1.0 + s.poissons_ratio);
        let mut k = BeamMatrix::zeros();
        for (dof, value) in [(0, e * s.area_m2 / l), (3, g * s.torsion_m4 / l)] {
            k[(dof, dof)] = value;
            k[(dof + 6, dof + 6)] = value;
            k[(dof, dof + 6)] = -value;
            k[(dof + 6, dof)] = -value;
        }
        for ((dofs, sign), i) in [(BENDING_XY, s.i_z_m4), (BENDING_XZ, s.i_y_m4)] {
            let phi = self.phi(i);
            let c = e * i / ((1.0 + phi) * l.powi(3));
            let (a, b) = ((4.0 + phi) * l * l, (2.0 - phi) * l * l);
            let bending = [
                [12.0, 6.0 * l, -12.0, 6.0 * l],
                [6.0 * l, a, -6.0 * l, b],
                [-12.0, -6.0 * l, 12.0, -6.0 * l],
                [6.0 * l, b, -6.0 * l, a],
            ];
            add_bending(&mut k, &dofs, sign, |p, q| c * bending[p][q]);
        }
        turn(&k, &self.axes)
    }

    /// Consistent mass from the exact shape functions of the Timoshenko beam (Friedman, Kosmatka: Computers &
    /// Structures 47, 1993, 473-481), rotary inertia included. Frequencies converge with order 4 where shear is
    /// nothing, with order 2 where it is not. Verified by `tests/analytic/fem_vibration.rs`.
    pub fn mass_consistent(&self) -> BeamMatrix {
        let (s, l) = (&self.section, self.length);
        let mut m = BeamMatrix::zeros();
        let polar = s.i_y_m4 + s.i_z_m4;
        for (dof, per_length) in [(0, s.area_m2), (3, polar)] {
            let sixth = s.density_kg_m3 * per_length * l / 6.0;
            m[(dof, dof)] = 2.0 * sixth;
            m[(dof + 6, dof + 6)] = 2.0 * sixth;
            m[(dof, dof + 6)] = sixth;
            m[(dof + 6, dof)] = sixth;
        }
        for ((dofs, sign), i) in [(BENDING_XY, s.i_z_m4), (BENDING_XZ, s.i_y_m4)] {
            let phi = self.phi(i);
            for (xi, weight) in GAUSS_4 {
                let (n, r) = bending_shape(xi, l, phi);
                let w = s.density_kg_m3 * weight * l;
                add_bending(&mut m, &dofs, sign, |p, q| {
                    w * (s.area_m2 * n[p] * n[q] + i * r[p] * r[q])
                });
            }
        }
        turn(&m, &self.axes)
    }

    /// Lumped mass: half the beam's mass, its polar inertia and its rotary inertia at each end.
    pub(crate) fn mass_lumped(&self) -> BeamMatrix {
        let s = &self.section;
        let half = 0.5 * s.density_kg_m3 * self.length;
        let mut m = BeamMatrix::zeros();
        for end in [0, 6] {
            for dof in 0..3 {
                m[(end + dof, end + dof)] = half * s.area_m2;
            }
            m[(end + 3, end + 3)] = half * (s.i_y_m4 + s.i_z_m4);
            m[(end + 4, end + 4)] = half * s.i_y_m4;
            m[(end + 5, end + 5)] = half * s.i_z_m4;
        }
        turn(&m, &self.axes)
    }
}

/// Adds a 4 x 4 bending matrix in `(v, v,x)` to the beam's 12, rotations with `sign`.
fn add_bending(k: &mut BeamMatrix, dofs: &[usize; 4], sign: f64, value: impl Fn(usize, usize) -> f64) {
    let signs = [1.0, sign, 1.0, sign];
    for p in 0..4 {
        for q in 0..4 {
            k[(dofs[p], dofs[q])] += signs[p] * signs[q] * value(p, q);
        }
    }
}

/// Deflection and section rotation of the beam at `xi` in [0, 1] for unit end values `(v, theta)`.
fn bending_shape(xi: f64, l: f64, phi: f64) -> ([f64; 4], [f64; 4]) {
    let c = 1.0 / (1.0 + phi);
    let (x2, x3) = (xi * xi, xi * xi * xi);
    let n = [
        c * (2.0 * x3 - 3.0 * x2 - phi * xi + 1.0 + phi),
        c * l * (x3 - (2.0 + 0.5 * phi) * x2 + (1.0 + 0.5 * phi) * xi),
        -c * (2.0 * x3 - 3.0 * x2 - phi * xi),
        c * l * (x3 - (1.0 - 0.5 * phi) * x2 - 0.5 * phi * xi),
    ];
    let r = [
        6.0 * c / l * (x2 - xi),
        c * (3.0 * x2 - (4.0 + phi) * xi + 1.0 + phi),
        -6.0 * c / l * (x2 - xi),
        c * (3.0 * x2 - (2.0 - phi) * xi),
    ];
    (n, r)
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
