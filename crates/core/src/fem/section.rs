//! The section of a shell: thickness and material.
//!
//! Knows what membrane and plate share of the material. Does not know an element's shape.

use super::{FemError, require};
use nalgebra::Matrix3;

/// Plate of uniform thickness and material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShellSection {
    /// Thickness `[m]`.
    pub thickness_m: f64,
    /// Young's modulus `[Pa]`.
    pub youngs_modulus_pa: f64,
    /// Poisson's ratio.
    pub poissons_ratio: f64,
    /// Density `[kg/m^3]`.
    pub density_kg_m3: f64,
}

impl ShellSection {
    /// `G = E / (2 (1 + nu))` `[Pa]`.
    pub(crate) fn shear_modulus_pa(&self) -> f64 {
        0.5 * self.youngs_modulus_pa / (1.0 + self.poissons_ratio)
    }

    /// Plane-stress matrix D `[Pa]`.
    pub(super) fn plane_stress(&self) -> Matrix3<f64> {
        let (e, nu) = (self.youngs_modulus_pa, self.poissons_ratio);
        let c = e / (1.0 - nu * nu);
        Matrix3::new(c, c * nu, 0.0, c * nu, c, 0.0, 0.0, 0.0, 0.5 * c * (1.0 - nu))
    }

    /// Refuses what no material has.
    pub(super) fn check(&self, element: usize) -> Result<(), FemError> {
        let (t, e, nu, rho) = (
            self.thickness_m,
            self.youngs_modulus_pa,
            self.poissons_ratio,
            self.density_kg_m3,
        );
        require(element, "thickness", t, t > 0.0)?;
        require(element, "Young's modulus", e, e > 0.0)?;
        require(element, "Poisson's ratio", nu, nu > -1.0 && nu <= 0.5)?;
        require(element, "density", rho, rho >= 0.0)
    }
}
