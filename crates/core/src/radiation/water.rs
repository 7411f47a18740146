//! The water under a chain of modules: what its table comes to, for whoever lets a bridge move in it.
//!
//! Knows a table's kernel, its added mass at infinite frequency and its states. Does not know bridges.

use super::realisation::{Fit, Realisation, RealisationError};
use super::{Kernel, RadiationTable, Scales, Window, added_mass_infinite};
use crate::input::InvalidInput;
use nalgebra::DMatrix;
use std::sync::OnceLock;

/// Least eigenvalue of the added mass at infinite frequency over the largest, in scaled freedoms: rounding of files.
const LEAST_MASS: f64 = -1e-3;

/// Added mass at infinite frequency and memory of the water under a chain of modules, shared read-only by all that moves in it.
#[derive(Debug)]
pub struct Radiation {
    scales: Scales,
    kernel: Kernel,
    infinite: DMatrix<f64>,
    key: String,
    states: OnceLock<Result<Realisation, RealisationError>>,
}

impl PartialEq for Radiation {
    /// Of one key.
    fn eq(&self, other: &Self) -> bool {
        self.key == other.key
    }
}

impl Radiation {
    /// The water of a table and the kernel that was made of it. Two waters of one `key` are one water.
    ///
    /// # Errors
    /// [`InvalidInput`] as of [`added_mass_infinite`], and on `added_mass` where a motion would have a mass below 0.
    pub fn new(kernel: Kernel, table: &RadiationTable, scales: Scales, key: String) -> Result<Self, InvalidInput> {
        let infinite = added_mass_infinite(&kernel, table, &scales, Window::TRANSFER)?;
        let eigenvalues = scales.scaled(&infinite).symmetric_eigenvalues();
        if eigenvalues.min() < LEAST_MASS * eigenvalues.max().max(0.0) {
            let found = format!("{:.3e} kg in one motion at infinite frequency", eigenvalues.min());
            return Err(InvalidInput::new(
                "added_mass",
                found,
                "added mass of at least 0 in every motion",
            ));
        }
        Ok(Self {
            scales,
            kernel,
            infinite,
            key,
            states: OnceLock::new(),
        })
    }

    /// The lengths that make its freedoms comparable.
    pub fn scales(&self) -> &Scales {
        &self.scales
    }

    /// The memory.
    pub fn kernel(&self) -> &Kernel {
        &self.kernel
    }

    /// The added mass at infinite frequency by Kramers and Kronig `[kg, kg m, kg m^2]`.
    pub fn infinite(&self) -> &DMatrix<f64> {
        &self.infinite
    }

    /// What tells this water from others.
    pub fn key(&self) -> &str {
        &self.key
    }

    /// Its states, made when first asked for: seconds for fifteen modules.
    ///
    /// # Errors
    /// [`RealisationError`].
    pub fn states(&self) -> Result<&Realisation, RealisationError> {
        let made = self
            .states
            .get_or_init(|| Realisation::new(&self.kernel, &self.scales, Fit::default()));
        made.as_ref().map_err(Clone::clone)
    }

    /// Added mass `[kg, kg m, kg m^2]` and damping `[N s/m, N s, N s m]` at a frequency above 0 `[rad/s]`, by the kernel:
    /// `A = A_inf + Im K(i w) / w`, `B = Re K(i w)`.
    pub fn at(&self, omega_rad_s: f64) -> [DMatrix<f64>; 2] {
        let transfer = self.kernel.transfer(omega_rad_s, Window::TRANSFER);
        let mass = transfer.map(|k| k.im / omega_rad_s);
        [&self.infinite + mass, transfer.map(|k| k.re)]
    }
}
